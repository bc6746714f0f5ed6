// Files of spherical harmonics: the texts that are written, and what is described of texts and of
// KTX2 files.
#include "codec/ktx1.h"

#include "kit/describe.h"

#include "kit/context.h"

static void check_text(const char *name, const kiln_sh *sh, const char *wanted)
{
    CHECK_OK(kiln_sh_save(context, sh, in_folder(name), &error));
    size_t size;
    char *text = (char *)read_file(in_folder(name), &size);
    assert_string_equal(text, wanted);
    free(text);
}

static void harmonics_are_text(void **state)
{
    (void)state;
    kiln_sh sh = {.bands = 2, .irradiance = true, .window = 1.5};
    for (int i = 0; i < 12; i++)
        sh.c[i / 3][i % 3] = (i - 4) / 8.0;
    check_text("a.json", &sh,
               "{\n  \"bands\": 2,\n  \"irradiance\": true,\n  \"window\": 1.5,\n"
               "  \"basis\": \"real orthonormal, no Condon-Shortley sign, l(l+1)+m\",\n"
               "  \"coefficients\": [\n    [-0.5, -0.375, -0.25],\n    [-0.125, 0, 0.125],\n"
               "    [0.25, 0.375, 0.5],\n    [0.625, 0.75, 0.875]\n  ]\n}\n");
    check_text("a.txt", &sh,
               "-0.5 -0.375 -0.25 ; Y0,0\n-0.125 0 0.125 ; Y1,-1\n0.25 0.375 0.5 ; Y1,0\n"
               "0.625 0.75 0.875 ; Y1,1\n");
    check_text("a.h", &sh,
               "// Spherical harmonics of irradiance, 2 bands, red green blue: real, orthonormal, "
               "no\n// Condon-Shortley sign, in the order l(l+1)+m. Hanning window of width 1.5.\n"
               "static const double kiln_sh_coefficients[4][3] = {\n"
               "    {-0.5, -0.375, -0.25}, // Y0,0\n    {-0.125, 0, 0.125}, // Y1,-1\n"
               "    {0.25, 0.375, 0.5}, // Y1,0\n    {0.625, 0.75, 0.875}, // Y1,1\n};\n");
    assert_int_equal(kiln_sh_save(context, &sh, in_folder("a.xml"), &error), KILN_ERROR_ARGUMENT);
    sh.bands = 6;
    assert_int_equal(kiln_sh_save(context, &sh, in_folder("a.txt"), &error), KILN_ERROR_ARGUMENT);
}

// Harmonics of irradiance in a file are described as what they are.
static void irradiance_is_not_called_radiance(void **state)
{
    (void)state;
    kiln_map map = make_steps(context, KILN_SHAPE_CUBE, 4, 1);
    for (int irradiance = 0; irradiance < 2; irradiance++) {
        const kiln_sh sh = {.bands = 2, .irradiance = irradiance, .c = {{1, 2, 3}, {4, 5, 6}}};
        const kiln_save_def def = {.sh = &sh};
        ki_writer w = {.context = context};
        kiln_file_info info;
        CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
        CHECK_OK(describe(w.bytes, w.size, "i.ktx2", &info));
        assert_int_equal(info.sh_bands, 2);
        assert_int_equal(info.sh_irradiance, irradiance);
        assert_true(info.sh[1][2] == 6);
        ki_writer_free(&w);
    }
    kiln_map_free(&map);
}

// Every text that kiln writes harmonics as, with each number of bands: what was saved is what is
// said.
static void harmonics_in_text_are_described(void **state)
{
    (void)state;
    static const char *const endings[3][2] = {{"json", "json"}, {"txt", "text"}, {"h", "c"}};
    for (int e = 0; e < 3; e++)
        for (int bands = 1; bands <= KILN_MAX_BANDS; bands++)
            for (int irradiance = 0; irradiance < 2; irradiance++) {
                char name[16], path[128];
                kiln_sh sh = {.bands = bands, .irradiance = irradiance, .window = 1.5 * irradiance};
                for (int i = 0; i < 3 * bands * bands; i++)
                    sh.c[i / 3][i % 3] = (i % 2 ? -1 : 1) * pow(10, i % 13 - 8) / 3;
                kiln_file_info info;
                snprintf(name, sizeof name, "sh.%s", endings[e][0]);
                snprintf(path, sizeof path, "%s", in_folder(name));
                CHECK_OK(kiln_sh_save(context, &sh, path, &error));
                CHECK_OK(kiln_file_describe(context, path, &info, &error));
                assert_string_equal(info.format, endings[e][1]);
                assert_string_equal(info.layout, "harmonics");
                assert_int_equal(info.width, bands * bands);
                assert_int_equal(info.sh_bands, bands);
                // Lines do not say what they are of.
                assert_int_equal(info.sh_irradiance, e == 1 ? 0 : irradiance);
                for (int i = 0; i < bands * bands; i++)
                    for (int c = 0; c < 3; c++)
                        CHECK_NEAR((double)info.sh[i][c], sh.c[i][c], 1e-7 * fabs(sh.c[i][c]));
            }
}

static void harmonics_in_text_are_checked(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {"{\"bands\": 2, \"coefficients\": [[1,2,3],[1,2,3]]}", "holds 2 complete coefficients"},
        {"{\"bands\": 1, \"coefficients\": [[1,2]]}", "damaged at byte 35"},
        {"{\"bands\": 1", "damaged at byte 11"},
        {"{\"bands\": 1}", "holds 0 complete coefficients"},
        {"1 2 3 ; Y0,0\n1 2\n", "holds 0 complete coefficients"},
        {"1 2 ; Y0,0\n", "holds 0 complete coefficients"},
        {"(1, 2, 3); // L00, irradiance, pre-scaled base\n(1, 2, 3)\n", "holds 0 complete"},
        {"// Spherical harmonics of radiance, 1 bands", "holds 0 complete coefficients"},
        {"// Spherical harmonics of radiance\nx = {\n{1, 2, x},", "holds 0 complete coefficients"},
        {"{\"json\": 1}", "do not begin like"},
        {"// other", "do not begin like"},
    };
    kiln_file_info info;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_result result = describe(cases[i].text, strlen(cases[i].text), "m.txt", &info);
        if (result != KILN_ERROR_FORMAT || !strstr(error.message, cases[i].sentence))
            fail_msg("%s gives %d: %s", cases[i].text, (int)result, error.message);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(harmonics_are_text),
        cmocka_unit_test(irradiance_is_not_called_radiance),
        cmocka_unit_test(harmonics_in_text_are_described),
        cmocka_unit_test(harmonics_in_text_are_checked),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_folder);
}
