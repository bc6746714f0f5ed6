// The sweep over the functions of numbers, which cannot fail: reflection models, samplers, tables,
// lobes, harmonics and engines.
#include "sweep.h"

#include <kiln/course.h>

static bool is_share(double x)
{
    return x >= 0 && x <= 1;
}

static void names_end(void **state)
{
    (void)state;
    const char *const *const lists[] = {kiln_d_names(),     kiln_g_names(),
                                        kiln_sheen_names(), kiln_table_kind_names(),
                                        kiln_axis_names(),  kiln_format_names()};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        int count = 0;
        while (lists[i][count])
            assert_true(strlen(lists[i][count++]) > 0);
        assert_in_range(count, 2, 16);
    }
    assert_true(strlen(kiln_version()) >= 5);
    static const char *const paths[] = {"", ".", "/", ".exr", "a.EXR", "a.exr/", "a.\xff", "%s%d"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        assert_non_null(kiln_path_ending(paths[i]));
        EACH_INT (format)
            assert_true(kiln_map_save_limit(paths[i], (kiln_format)format) >= 0);
    }
    EACH_INT (n) {
        assert_true(kiln_format_limit((kiln_format)n) >= 0);
        const kiln_engine *engine = kiln_engine_at(n);
        assert_true(engine ? kiln_engine_find(engine->name) == engine : n < 0 || n > 5);
        kiln_g g = kiln_assignment_masking((kiln_assignment_g)n);
        assert_in_range(g, KILN_G_SMITH, KILN_G_SCHLICK_TEXT);
    }
}

// Every string of up to two bytes and every code point: the text that remains is UTF-8 that a
// terminal shows.
static void text_is_cleaned(void **state)
{
    (void)state;
    unsigned code;
    bool shown;
    for (int i = 0; i < 1 << 16; i++) {
        char text[3] = {(char)(i & 255), (char)(i >> 8), 0};
        kiln_text_clean(text);
        for (const char *at = text; *at; at += kiln_text_step(at, &code, &shown))
            assert_true(kiln_text_step(at, &code, &shown) >= 1 && shown);
    }
    static const struct {
        const char *text;
        int length;
        unsigned code;
        bool shown;
    } steps[] = {{"A", 1, 'A', true},
                 {"\n", 1, '\n', false},
                 {"\x7f", 1, 0x7f, false},
                 {"\xc2\x9b", 2, 0x9b, false},
                 {"\xc3\xa9", 2, 0xe9, true},
                 {"\xe2\x80\xae", 3, 0x202e, false},
                 {"\xe6\xbc\xa2", 3, 0x6f22, true},
                 {"\xf0\x9f\x98\x80", 4, 0x1f600, true},
                 {"\xff", 1, 0xfffd, false},
                 {"\xc0\x80", 1, 0xfffd, false},         // an overlong zero
                 {"\xed\xa0\x80", 1, 0xfffd, false},     // a surrogate
                 {"\xf4\x90\x80\x80", 1, 0xfffd, false}, // above U+10FFFF
                 {"\xe6\xbc", 1, 0xfffd, false}};        // cut off
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        assert_int_equal(kiln_text_step(steps[i].text, &code, &shown), steps[i].length);
        assert_int_equal(code, steps[i].code);
        assert_int_equal(shown, steps[i].shown);
    }
    char text[] = "caf\xc3\xa9\x1b[0m\xe6\xbc";
    kiln_text_clean(text);
    assert_string_equal(text, "caf\xc3\xa9?[0m??");
}

static void shares_stay_shares(void **state)
{
    (void)state;
    EACH_REAL (x) {
        assert_true(is_share(kiln_fresnel_schlick_average(x)));
        assert_true(is_share(kiln_fresnel_dielectric_average(x)));
        assert_true(isfinite(kiln_fresnel_dielectric_average_fit(x)));
        assert_true(kiln_pdf_cosine(x) >= 0);
        EACH_REAL (y) {
            double two[2];
            kiln_model model = {0};
            assert_true(is_share(kiln_fresnel_schlick(x, y)));
            assert_true(is_share(kiln_fresnel_dielectric(x, y)));
            assert_true(isfinite(kiln_fresnel_f82_average(x, y)));
            assert_true(is_share(kiln_fresnel_conductor_average(x, y)));
            assert_true(isfinite(kiln_fresnel_conductor_average_fit(x, y)));
            assert_true(isfinite(kiln_turquin(x, y)));
            assert_true(isfinite(kiln_compensate_walk(x, y)));
            assert_true(kiln_pdf_reflection(x, y) >= 0);
            assert_true(kiln_energy(&model, x, y) <= 1 + 1e-8);
            kiln_energy_split(&model, x, y, two);
            assert_true(two[0] >= 0 && two[1] >= 0);
            assert_true(kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, x, y) >= 0);
            kiln_gulbrandsen(x, y, &two[0], &two[1]);
            assert_true(isfinite(two[0]) && isfinite(two[1]));
            EACH_REAL (z) {
                assert_true(is_share(kiln_fresnel_f82(x, y, z)));
                assert_true(is_share(kiln_fresnel_conductor(x, y, z)));
                assert_true(kiln_kulla_conty(x, y, z) >= 0);
                kiln_fdez_aguera(x, y, z, &two[0], &two[1]);
                assert_true(two[0] >= 0 && two[1] >= 0);
            }
        }
        assert_true(kiln_energy_average(&(kiln_model){0}, x) <= 1 + 1e-8);
    }
    double rt[2];
    EACH_REAL (r)
        EACH_REAL (ior) {
            kiln_glass(&(kiln_model){0}, r, ior, ior, rt);
            assert_true(rt[0] >= 0 && rt[1] >= 0);
        }
    EACH_REAL (i) {
        kiln_glass_average(&(kiln_model){0}, i, 1.5, rt);
        assert_true(rt[0] >= 0 && rt[1] >= 0);
    }
}

// Choices that are no choice, as a cast from a file's number gives, select some choice.
static void choices_out_of_range_do_no_harm(void **state)
{
    (void)state;
    EACH_INT (a)
        EACH_INT (b) {
            kiln_model model = {(kiln_d)a, (kiln_g)b};
            assert_true(kiln_brdf_d(model.d, 0.5, 0.5) >= 0);
            assert_true(is_share(kiln_brdf_g(&model, 0.5, 0.5, 0.5)));
            assert_true(kiln_brdf_specular(&model, 0.5, 0.5, 0.5, 0.5) >= 0);
            assert_true(kiln_energy(&model, 0.5, 0.5) <= 1 + 1e-8);
            assert_true(kiln_pdf_half_vector(model.d, 0.5, 0.5) >= 0);
            assert_true(kiln_kulla_conty_fresnel((kiln_f_add)a, 0.5, 0.5) >= 0);
            assert_true(kiln_sheen_albedo((kiln_sheen)b, 0.5, 0.5) >= 0);
        }
}

static void samples_are_directions(void **state)
{
    (void)state;
    static const double v[3] = {0.6, 0, 0.8};
    EACH_REAL (x)
        EACH_REAL (y) {
            double xi[2] = {x, y}, h[3];
            if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) // the header asks for [0, 1)
                continue;
            kiln_sample_cosine(xi, h);
            CHECK_NEAR(h[0] * h[0] + h[1] * h[1] + h[2] * h[2], 1, 1e-12);
            EACH_REAL (r) {
                kiln_sample_half_vector(KILN_D_GGX, r, xi, h);
                CHECK_NEAR(h[0] * h[0] + h[1] * h[1] + h[2] * h[2], 1, 1e-12);
                kiln_sample_visible(r, v, xi, h);
                CHECK_NEAR(h[0] * h[0] + h[1] * h[1] + h[2] * h[2], 1, 1e-12);
                assert_true(kiln_pdf_visible(r, x, y, r) >= 0);
            }
        }
    kiln_walk walk;
    EACH_REAL (f0) {
        kiln_walk_def def = {.f0 = f0, .n = f0, .k = f0, .path_count = 32};
        EACH_INT (kind) {
            def.fresnel = (kiln_walk_fresnel)kind;
            kiln_walk_albedo(&def, f0, f0, &walk);
            assert_true(walk.albedo >= 0 && walk.albedo <= 1 + 1e-12);
        }
    }
    EACH_INT (n) {
        if (n > 1 << 16) // valid, but long
            continue;
        kiln_walk_albedo(&(kiln_walk_def){.path_count = n}, 0.5, 0.5, &walk);
        assert_in_range(walk.path_count, 32, 1 << 17);
    }
}

static double constant(void *user, double cosine)
{
    (void)user;
    assert_true(cosine >= -1 && cosine <= 1);
    return 1;
}

static void lobes_weigh_every_angle(void **state)
{
    (void)state;
    EACH_REAL (parameter)
        EACH_REAL (cosine) {
            const kiln_lobe lobes[] = {kiln_lobe_ggx(parameter), kiln_lobe_lambert(),
                                       kiln_lobe_charlie(parameter), kiln_lobe_phong(parameter),
                                       kiln_lobe_custom(constant, NULL, parameter)};
            for (size_t i = 0; i < sizeof lobes / sizeof *lobes; i++)
                if (cosine >= -1 && cosine <= 1)
                    (void)kiln_lobe_evaluate(&lobes[i], cosine);
        }
    kiln_sh sh = {.bands = KILN_MAX_BANDS};
    EACH_REAL (x)
        EACH_REAL (y) {
            double value[3];
            kiln_sh_evaluate(&sh, (double[3]){x, y, x}, value);
        }
    assert_non_null(kiln_engine_find("three"));
    assert_null(kiln_engine_find(""));
    assert_null(kiln_engine_ending(NULL, KILN_FORMAT_AUTO));
    for (int i = 0; kiln_engine_at(i); i++)
        EACH_INT (format)
            assert_non_null(kiln_engine_ending(kiln_engine_at(i), (kiln_format)format));
}

static void an_engine_reads_a_level_that_exists(void **state)
{
    (void)state;
    assert_true(kiln_engine_level(NULL, 0.5, 256, 9) == -1);
    for (int i = 0; kiln_engine_at(i); i++)
        EACH_REAL (roughness)
            EACH_INT (size)
                EACH_INT (levels) {
                    double level = kiln_engine_level(kiln_engine_at(i), roughness, size, levels);
                    bool good = roughness >= 0 && roughness <= 1 && size >= 1 &&
                                size <= KILN_MAX_SIZE && levels >= 1 && levels <= KILN_MAX_LEVELS;
                    if (!(level == -1 ||
                          (good && isfinite(level) && fabs(level) <= 2 * KILN_MAX_LEVELS)))
                        fail_msg("%s: roughness %g, size %d, %d levels: level %g",
                                 kiln_engine_at(i)->name, roughness, size, levels, level);
                }
    CHECK_NEAR(kiln_engine_level(kiln_engine_find("gltf"), 0.5, 256, 9), 4, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_end),
        cmocka_unit_test(text_is_cleaned),
        cmocka_unit_test(shares_stay_shares),
        cmocka_unit_test(choices_out_of_range_do_no_harm),
        cmocka_unit_test(samples_are_directions),
        cmocka_unit_test(lobes_weigh_every_angle),
        cmocka_unit_test(an_engine_reads_a_level_that_exists),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
