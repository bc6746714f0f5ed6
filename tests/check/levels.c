// kiln_check_levels on levels that kiln baked, as they are or with one planted fault each: right levels pass, and each
// fault is named in words and nothing else is called a fault.
#include "image/image.h"

#include <kiln/check.h>

#include "blobs.h"
#include "findings.h"

enum { SIZE = 64, LEVELS = 5 };

static kiln_map scene, calm; // with a sun, and without one
static const kiln_map *source = &scene;

static int begin(void **state)
{
    int failed = set_up_folder(state);
    scene = blobs(true);
    calm = blobs(false);
    return failed;
}

static int end(void **state)
{
    kiln_map_free(&scene);
    kiln_map_free(&calm);
    return tear_down_folder(state);
}

static kiln_map baked(const kiln_prefilter_def *def)
{
    kiln_map map;
    kiln_prefilter_def full = *def;
    full.size = full.size ? full.size : SIZE;
    full.level_count = full.level_count ? full.level_count : LEVELS;
    CHECK_OK(kiln_prefilter(context, &scene, &full, &map, &error));
    return map;
}

static kiln_check_levels_report checked(const kiln_map *map, const char *engine, bool stated)
{
    kiln_check_levels_report report;
    const kiln_check_levels_def def = {.engine = engine ? kiln_engine_find(engine) : NULL,
                                       .stated = stated};
    CHECK_OK(kiln_check_levels(context, source, map, &def, &report, NULL, &error));
    assert_int_equal(report.level_count, map->level_count);
    return report;
}

static void expect_right(const kiln_check_levels_report *report, double worst)
{
    for (int i = 0; i < report->findings.count; i++)
        if (report->findings.finding[i].fault)
            fail_msg("a right file is called wrong: %s", report->findings.finding[i].text);
    CHECK_BELOW(report->worst, worst);
    for (int k = 0; k < report->level_count; k++) {
        CHECK_BELOW(report->level[k].proof, 1e-4);
        CHECK_NEAR(report->level[k].energy, 1, worst);
        assert_true(report->level[k].largest >= report->level[k].rms);
        CHECK_BELOW(fabs(report->level[k].bias), worst);
    }
}

// ---------------------------------------------------------------------------------------------------- right levels

static void exact_floats_are_right(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){0});
    kiln_check_levels_report report = checked(&map, NULL, true);
    expect_right(&report, 1e-4);
    assert_true(report.level[1].proof_count > 0);
    CHECK_NEAR(report.brightness, 1, 0);
    for (int k = 1; k < LEVELS; k++)
        CHECK_NEAR(report.level[k].found, (double)map.roughness[k], 0.02);
    kiln_map_free(&map);
}

static void other_shapes_are_right(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_map map = baked(&(kiln_prefilter_def){.shape = (kiln_shape)shape, .level_count = 3});
        kiln_check_levels_report report = checked(&map, NULL, true);
        expect_right(&report, 1e-4);
        kiln_map_free(&map);
    }
}

// Files for engines, read as any other tool's: the axes and levels of the engine are those expected, and the errors are
// those of the files' formats.
static void engines_files_are_right(void **state)
{
    (void)state;
    static const struct {
        const char *engine, *output, *file;
        kiln_format format;
        double worst;
    } rows[] = {{"three", "t.ktx2", "t.ktx2", KILN_FORMAT_RGBA16F, 4e-4},
                {"filament", "f", "f_ibl.ktx", KILN_FORMAT_B10G11R11, 0.016},
                {"babylon", "b.env", "b.env", KILN_FORMAT_AUTO, 0.006},
                {"unity", "u.dds", "u.dds", KILN_FORMAT_BC6H, 0.12}};
    source = &calm; // files of these engines cannot hold the sun
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const kiln_bake_def def = {
            .levels = {.size = rows[i].format == KILN_FORMAT_BC6H ? 128 : SIZE},
            .engine = kiln_engine_find(rows[i].engine),
            .tune = KILN_TUNE_NONE,
            .irradiance_size = KILN_NO_IRRADIANCE};
        kiln_environment made;
        kiln_map map;
        CHECK_OK(kiln_bake(context, source, &def, &made, &error));
        CHECK_OK(kiln_engine_save(context, def.engine, &made.levels, &made.sh, rows[i].format,
                                  in_folder(rows[i].output), NULL, &error));
        CHECK_OK(kiln_levels_load(context, in_folder(rows[i].file), NULL, NULL, &map, &error));
        assert_int_equal(map.level_count, made.levels.level_count);
        kiln_check_levels_report report = checked(&map, rows[i].engine, false);
        expect_right(&report, rows[i].worst);
        kiln_environment_free(&made);
        kiln_map_free(&map);
    }
    source = &scene;
}

// Without a statement, the axes and the roughness of the levels are those of the engines that have both.
static void unstated_levels_are_recognised(void **state)
{
    (void)state;
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    CHECK_OK(kiln_engine_levels(kiln_engine_find("filament"), SIZE, 3, roughness, &def, &error));
    def.rotation = 180;
    kiln_map map = baked(&def);
    kiln_check_levels_report report = checked(&map, NULL, false);
    expect_right(&report, 1e-4);
    assert_int_equal(report.findings.count, 2);
    CHECK_SAYS(report.findings.finding[0].text, "the axes are those of filament");
    CHECK_SAYS(report.findings.finding[1].text, "filament: r = 1 - sqrt(1 - k / (n - 1))");
    assert_int_equal(report.sign[0], -1);
    kiln_map_free(&map);
}

// Replaces the first `from` in an .env file by `to`, of the same length, and checks what the loader says.
static void expect_env_error(const char *from, const char *to, kiln_result wanted,
                             const char *words)
{
    static unsigned char bytes[1 << 18];
    kiln_map map;
    FILE *file = fopen(in_folder("b.env"), "rb");
    assert_non_null(file);
    size_t size = fread(bytes, 1, sizeof bytes, file), length = strlen(from), at = 0;
    fclose(file);
    while (at + length < size && memcmp(bytes + at, from, length) != 0)
        at++;
    assert_true(at + length < size);
    memcpy(bytes + at, to, length);
    file = fopen(in_folder("w.env"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    assert_int_equal(kiln_levels_load(context, in_folder("w.env"), NULL, NULL, &map, &error),
                     wanted);
    CHECK_SAYS(error.message, words);
    assert_int_equal(map.level_count, 0);
}

static void wrong_env_files_are_refused(void **state)
{
    (void)state;
    expect_env_error("image/png", "image/jpg", KILN_ERROR_UNSUPPORTED,
                     "its images are image/jpg, kiln reads");
    expect_env_error("IHDR", "IHDX", KILN_ERROR_FORMAT, "w.env: the PNG is damaged");
    expect_env_error("\"width\":64", "\"width\":96", KILN_ERROR_FORMAT,
                     "image 0 is 64 x 64, a face of level 0 must be 96 x 96");
}

static void faces_of_each_level_are_loaded(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){.level_count = 3}), loaded;
    kiln_load_report report;
    CHECK_OK(kiln_map_save(context, &map, in_folder("m{level}_{face}.exr"),
                           &(kiln_save_def){.format = KILN_FORMAT_RGBA32F}, NULL, &error));
    CHECK_OK(kiln_levels_load(context, in_folder("m%d_%s.exr"), NULL, &report, &loaded, &error));
    check_same_levels(&map, &loaded);
    assert_int_equal(report.texel_count, 6 * (64 * 64 + 32 * 32 + 16 * 16));
    CHECK_NEAR((double)loaded.roughness[1], 0.5, 0);
    kiln_map_free(&loaded);
    CHECK_OK(kiln_levels_load(context, in_folder(""), NULL, NULL, &loaded, &error));
    check_same_levels(&map, &loaded);
    kiln_map_free(&loaded);
    assert_int_equal(
        kiln_levels_load(context, in_folder("none_{level}.exr"), NULL, NULL, &loaded, &error),
        KILN_ERROR_IO);
    CHECK_SAYS(error.message, "there is no file of level 0");
    kiln_map_free(&map);
}

// -------------------------------------------------------------------------------------------------- planted faults

static void a_mirror_image_is_named(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){0});
    kiln_map_mirror(&map);
    kiln_check_levels_report report = checked(&map, "gltf", false);
    expect_one_fault(&report.findings, KILN_FINDING_AXES, "mirrored: left and right are swapped");
    CHECK_BELOW(report.worst, 1e-4);
    kiln_map_free(&map);
}

static void a_quarter_turn_is_named(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){.rotation = 90});
    kiln_check_levels_report report = checked(&map, "gltf", false);
    expect_one_fault(&report.findings, KILN_FINDING_AXES, "turned by 90 degrees about +Y");
    CHECK_BELOW(report.worst, 1e-4);
    kiln_map_free(&map);
}

// Levels that are filtered for other roughnesses than they state.
static void wrong_roughness_is_named(void **state)
{
    (void)state;
    static const struct {
        float filtered[LEVELS];
        const char *words;
    } rows[] = {{{0.25F, 0.5F, 0.75F, 1, 1}, "of the next level and is too blurred"},
                {{0, 0, 0.25F, 0.5F, 0.75F}, "of the level before and is too sharp"},
                {{0, 0.0625F, 0.25F, 0.5625F, 1}, "alpha = r^4 in place of r^2"},
                {{0, 0.5F, 0.7071F, 0.866F, 1}, "alpha = r in place of r^2"},
                {{0, 0.25F, 0.5F, 0.55F, 1}, "level 3 should be filtered for roughness 0.750"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_map map = baked(&(kiln_prefilter_def){.roughness = rows[i].filtered});
        for (int k = 0; k < LEVELS; k++)
            map.roughness[k] = (float)k / (LEVELS - 1);
        kiln_check_levels_report report = checked(&map, NULL, true);
        expect_one_fault(&report.findings, KILN_FINDING_MAPPING, rows[i].words);
        CHECK_BELOW(0.02, report.worst);
        kiln_map_free(&map);
    }
}

// Every face is read half a texel to the right of each texel's place.
static void a_shift_of_half_a_texel_is_named(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){0}), from = baked(&(kiln_prefilter_def){0});
    for (int k = 0; k < LEVELS; k++) {
        int n = kiln_map_level_size(&map, k);
        for (int i = 0; i < 6 * n * n; i++) {
            double at[3], rgb[3];
            ki_face_direction(i / (n * n), (2 * (i % n) + 2.0) / n - 1,
                              (2 * (i / n % n) + 1.0) / n - 1, at);
            ki_cube_read(&from, k, at, rgb);
            for (int c = 0; c < 3; c++)
                map.level[k][3 * i + c] = (float)rgb[c];
        }
    }
    kiln_check_levels_report report = checked(&map, NULL, true);
    expect_one_fault(&report.findings, KILN_FINDING_SHIFT,
                     "their texels lie half a texel too far left");
    kiln_map_free(&map);
    kiln_map_free(&from);
}

// The panorama is read half a texel to the right, which turns everything by 90 / 128 degrees about y.
static void a_shifted_panorama_is_named(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){.rotation = 90.0 / SCENE_ROWS});
    kiln_check_levels_report report = checked(&map, NULL, true);
    expect_one_fault(&report.findings, KILN_FINDING_SHIFT, "the environment is turned by");
    kiln_map_free(&map);
}

static void a_clamped_sun_is_named(void **state)
{
    (void)state;
    kiln_map clamped = blobs(true), map;
    CHECK_OK(kiln_map_clamp(context, &clamped, 20, NULL, &error));
    CHECK_OK(kiln_prefilter(context, &clamped,
                            &(kiln_prefilter_def){.size = SIZE, .level_count = LEVELS}, &map,
                            &error));
    kiln_check_levels_report report = checked(&map, NULL, true);
    expect_one_fault(&report.findings, KILN_FINDING_CLAMPED, "bright light was clamped");
    kiln_map_free(&map);
    kiln_map_free(&clamped);
}

static void other_brightness_is_named(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){0});
    kiln_map_expose(&map, 1);
    kiln_check_levels_report report = checked(&map, NULL, true);
    expect_one_fault(&report.findings, KILN_FINDING_BRIGHTNESS, "all values are 2 times as bright");
    CHECK_BELOW(report.worst, 1e-4);
    kiln_map_free(&map);
}

static void single_wrong_texels_are_counted(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){0});
    map.level[2][3 * 100] = 40;
    kiln_check_levels_report report = checked(&map, NULL, true);
    expect_one_fault(&report.findings, KILN_FINDING_FIREFLY,
                     "1 texels are more than twice as bright");
    assert_int_equal(report.level[2].firefly_count, 1);
    kiln_map_free(&map);

    map = baked(&(kiln_prefilter_def){0});
    map.level[1][3 * 50 + 1] = -0.01F;
    report = checked(&map, NULL, true);
    expect_one_fault(&report.findings, KILN_FINDING_NEGATIVE, "1 texels are below zero");
    assert_int_equal(report.level[1].negative_count, 1);
    kiln_map_free(&map);
}

// One face is darker by a tenth: its borders are seams.
static void seams_are_named(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){0});
    for (int k = 1; k < LEVELS; k++)
        for (size_t i = 0; i < value_count(&map, k) / 6; i++)
            map.level[k][i] *= 0.8F;
    kiln_check_levels_report report = checked(&map, NULL, true);
    expect_one_fault(&report.findings, KILN_FINDING_SEAM,
                     "the errors jump at the edges of the faces");
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_floats_are_right),
        cmocka_unit_test(other_shapes_are_right),
        cmocka_unit_test(engines_files_are_right),
        cmocka_unit_test(wrong_env_files_are_refused),
        cmocka_unit_test(unstated_levels_are_recognised),
        cmocka_unit_test(faces_of_each_level_are_loaded),
        cmocka_unit_test(a_mirror_image_is_named),
        cmocka_unit_test(a_quarter_turn_is_named),
        cmocka_unit_test(wrong_roughness_is_named),
        cmocka_unit_test(a_shift_of_half_a_texel_is_named),
        cmocka_unit_test(a_shifted_panorama_is_named),
        cmocka_unit_test(a_clamped_sun_is_named),
        cmocka_unit_test(other_brightness_is_named),
        cmocka_unit_test(single_wrong_texels_are_counted),
        cmocka_unit_test(seams_are_named),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
