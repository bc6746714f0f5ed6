// kiln_check_levels on levels that kiln baked, as they are or with one planted fault each: right
// levels pass, and each fault is named in words and nothing else is called a fault.
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

// ------------------------------------------------------------------------------------ right levels

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

// Files for engines, read as any other tool's: the axes and levels of the engine are those
// expected, and the errors are those of the files' formats.
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
                {"gltf", "g.glb", "g.glb", KILN_FORMAT_AUTO, 0.006},
                {"galacean", "a.env", "a.env", KILN_FORMAT_AUTO, 0.02},
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

// Without a statement, the axes and the roughness of the levels are those of the engines that have
// both.
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

// Writes the file `w.` with its ending: the file `name` with `to` in place of the first `from`, of
// the same length.
static const char *edited(const char *name, const char *from, const char *to)
{
    static unsigned char bytes[1 << 18];
    static char wrong[16];
    FILE *file = fopen(in_folder(name), "rb");
    assert_non_null(file);
    size_t size = fread(bytes, 1, sizeof bytes, file), length = strlen(from), at = 0;
    fclose(file);
    assert_int_equal(strlen(to), length);
    while (at + length < size && memcmp(bytes + at, from, length) != 0)
        at++;
    assert_true(at + length < size);
    memcpy(bytes + at, to, length);
    snprintf(wrong, sizeof wrong, "w%s", strchr(name, '.'));
    file = fopen(in_folder(wrong), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    return wrong;
}

// Files that engines_files_are_right wrote, each with a few bytes changed.
static void wrong_files_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *file, *from, *to;
        kiln_result wanted;
        const char *words;
    } rows[] = {
        {"b.env", "image/png", "image/jpg", KILN_ERROR_UNSUPPORTED,
         "w.env: its images are image/jpg, kiln reads"},
        {"b.env", "IHDR", "IHDX", KILN_ERROR_FORMAT, "w.env: the PNG is damaged"},
        {"b.env", "\"width\":64", "\"width\":96", KILN_ERROR_FORMAT,
         "image 0 is 64 x 64, a face of level 0 must be 96 x 96"},
        {"g.glb", "image/png", "image/jpg", KILN_ERROR_UNSUPPORTED,
         "w.glb: its light has images of another format"},
        {"g.glb", "IHDR", "IHDX", KILN_ERROR_FORMAT, "w.glb: the PNG is damaged"},
        {"g.glb", "[0,0,0,1]", "[0,1,0,0]", KILN_ERROR_UNSUPPORTED, "w.glb: its light is rotated"},
        {"g.glb", "\"intensity\":1", "\"intensity\":-", KILN_ERROR_FORMAT, "its JSON is damaged"},
        {"g.glb", "\"specularImageSize\":64", "\"specularImageSize\":96", KILN_ERROR_FORMAT,
         "image 0 is 64 x 64, a face of level 0 must be 96 x 96"},
        {"g.glb", "\"bufferView\":17,", "\"bufferView\":99,", KILN_ERROR_FORMAT,
         "image 17 of its light does not lie in the buffer"},
        {"g.glb", "\"specularImages\":[[0", "\"specularImages\":[[9", KILN_ERROR_FORMAT,
         "image 0 is 32 x 32, a face of level 0 must be 64 x 64"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_map map;
        const char *wrong = edited(rows[i].file, rows[i].from, rows[i].to);
        kiln_result result = kiln_levels_load(context, in_folder(wrong), NULL, NULL, &map, &error);
        if (result != rows[i].wanted || !strstr(error.message, rows[i].words))
            fail_msg("%s gives %d: %s", rows[i].to, (int)result, error.message);
        assert_int_equal(map.level_count, 0);
    }
}

// The intensity of a light of glTF multiplies all radiance.
static void the_intensity_of_a_light_counts(void **state)
{
    (void)state;
    kiln_map one, five;
    CHECK_OK(kiln_levels_load(context, in_folder("g.glb"), NULL, NULL, &one, &error));
    CHECK_OK(kiln_levels_load(context,
                              in_folder(edited("g.glb", "\"intensity\":1", "\"intensity\":5")),
                              NULL, NULL, &five, &error));
    for (int k = 0; k < one.level_count; k++)
        for (size_t i = 0; i < value_count(&one, k); i++)
            assert_true(fabsf(five.level[k][i] - 5 * one.level[k][i]) <= 1e-6F * five.level[k][i]);
    kiln_map_free(&one);
    kiln_map_free(&five);
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

// ---------------------------------------------------------------------------------- planted faults

static void a_mirror_image_is_named(void **state)
{
    (void)state;
    kiln_map map = baked(&(kiln_prefilter_def){0});
    kiln_map_mirror(&map);
    kiln_check_levels_report report = checked(&map, "gltf", false);
    expect_one_fault(&report.findings, KILN_FINDING_AXES, "mirrored: left and right are swapped");
    CHECK_BELOW(report.worst, 1e-4);
    // What is shown of the file is the mirror image; what the file holds is the environment.
    kiln_map shown, held, right = baked(&(kiln_prefilter_def){0});
    CHECK_OK(
        kiln_levels_unturn(context, &map, report.wanted_axis, report.wanted_sign, &shown, &error));
    CHECK_OK(kiln_levels_unturn(context, &map, report.axis, report.sign, &held, &error));
    check_same_levels(&shown, &map);
    check_same_levels(&held, &right);
    kiln_map_free(&right);
    kiln_map_free(&held);
    kiln_map_free(&shown);
    kiln_map_free(&map);
}

// A picture of differences: a face that is too bright is red, one that is too dark is blue, and
// nothing is grey.
static void the_picture_has_the_colour_of_the_error(void **state)
{
    (void)state;
    kiln_map map = make_map(context, KILN_SHAPE_CUBE, 16, 2);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 256; i++) {
            map.level[0][3 * i + c] = 2;             // +X
            map.level[0][3 * (256 + i) + c] = -0.5F; // -X
        }
    kiln_image picture;
    CHECK_OK(kiln_check_picture(context, &map, &picture, &error));
    assert_int_equal(picture.width, 256);
    assert_int_equal(picture.height, 2 * 128);
    const float *right = picture.pixels + 3 * (64 * 256 + 192), *left = right - 3 * 128;
    const float *ahead = right - 3 * 64, *below = right + 3 * 128 * 256;
    // The root mean square is sqrt((4 + 1/4) / 6) = 0.84: 2 is 0.79 of three times that, and 1/2 is
    // 0.2.
    CHECK_NEAR((double)right[0], 0.5 + 0.5 * 0.79, 0.01);
    CHECK_NEAR((double)right[2], 0.5 - 0.5 * 0.79, 0.01);
    CHECK_NEAR((double)left[2], 0.5 + 0.5 * 0.198, 0.01);
    CHECK_NEAR((double)left[0], 0.5 - 0.5 * 0.198, 0.01);
    for (int c = 0; c < 3; c++) {
        CHECK_NEAR((double)ahead[c], 0.5, 0);
        CHECK_NEAR((double)below[c], 0.5, 0);
    }
    kiln_image_free(&picture);
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

// The panorama is read half a texel to the right, which turns everything by 90 / 128 degrees about
// y.
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
        cmocka_unit_test(wrong_files_are_refused),
        cmocka_unit_test(the_intensity_of_a_light_counts),
        cmocka_unit_test(unstated_levels_are_recognised),
        cmocka_unit_test(faces_of_each_level_are_loaded),
        cmocka_unit_test(a_mirror_image_is_named),
        cmocka_unit_test(the_picture_has_the_colour_of_the_error),
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
