// The sweep over the functions that can fail: contexts, maps, spectra, bakes, files, tables and
// courses. Each argument and each field of a definition takes every number in turn, the others keep
// their defaults.
#include "sweep.h"

#include <kiln/check.h>
#include <kiln/course.h>

// Sizes and numbers of samples for the methods of courses: large valid ones take long, because
// these methods look at the clock between rows only.
static const int counts[] = {INT_MIN, -1, 0, 1, 2, 3, 16, 1 << 21, 1 << 30, INT_MAX - 1, INT_MAX};
enum { COUNTS = sizeof counts / sizeof *counts };

static kiln_context *c;
static kiln_map cube, panorama;

// Sweeps one field of a definition of this type: `call` uses `def`, `after` cleans up.
#define FIELD(type, field, values, count, call, empty, after)                                      \
    FIELD_OF(type, (type){0}, field, values, count, call, empty, after)
/// The same, but the other fields are those of `start`.
#define FIELD_OF(type, start, field, values, count, call, empty, after)                            \
    for (int field_at = 0; field_at < (count); field_at++) {                                       \
        type def = start;                                                                          \
        def.field = (__typeof__(def.field))(values)[field_at];                                     \
        SWEEP(call, empty);                                                                        \
        after;                                                                                     \
    }
#define INT_FIELD(type, field, call, empty, after)                                                 \
    FIELD(type, field, ints, INTS, call, empty, after)
#define REAL_FIELD(type, field, call, empty, after)                                                \
    FIELD(type, field, reals, REALS, call, empty, after)

static int begin(void **state)
{
    (void)state;
    kiln_error error;
    c = sweep_context();
    sweep_prepare();
    CHECK_OK(kiln_map_create(c, KILN_SHAPE_CUBE, 8, 0, &cube, &error));
    CHECK_OK(kiln_map_create(c, KILN_SHAPE_PANORAMA, 8, 1, &panorama, &error));
    return 0;
}

static int finish(void **state)
{
    (void)state;
    size_t held = 1;
    kiln_map_free(&cube);
    kiln_map_free(&panorama);
    kiln_context_memory(c, NULL, NULL);
    kiln_context_memory(c, &held, NULL);
    kiln_context_destroy(c);
    printf("%ld calls\n", sweep_count);
    return held != 0;
}

static void contexts(void **state)
{
    (void)state;
    kiln_context *made = NULL;
    INT_FIELD(kiln_context_def, cpu, kiln_context_create(&def, &made, &e), made == NULL,
              kiln_context_destroy(made));
    EACH_INT (n) {
        kiln_context_def def = {.thread_count = n > 3 && n <= 256 ? 4 : n};
        int running = 0, wanted = 0;
        SWEEP(kiln_context_create(&def, &made, &e), made == NULL);
        if (made) {
            assert_non_null(kiln_context_cpu(made));
            kiln_context_threads(made, &running, &wanted);
            kiln_context_threads(made, NULL, NULL);
            assert_true(running >= 1 && running <= wanted);
            assert_true(n == 0 || wanted == def.thread_count);
        }
        kiln_context_destroy(made);
    }
    kiln_context_destroy(NULL);
}

static void maps(void **state)
{
    (void)state;
    kiln_map m;
    kiln_image image;
    EACH_INT (a)
        EACH_INT (b) {
            for (int shape = 0; shape < 5; shape++) {
                SWEEP(kiln_map_create(c, (kiln_shape)shape, a, b, &m, &e), !m.owner && !m.size);
                kiln_map_free(&m);
            }
            SWEEP(kiln_map_create(c, (kiln_shape)a, b, 1, &m, &e), !m.owner && !m.size);
            kiln_map_free(&m);
            EACH_INT (d) {
                SWEEP(kiln_image_create(c, a, b, d, &image, &e), !image.owner && !image.pixels);
                kiln_image_free(&image);
            }
            SWEEP(kiln_map_convert(c, &cube, (kiln_shape)a, b, 0, &m, &e), !m.owner && !m.size);
            kiln_map_free(&m);
        }
    EACH_REAL (x) {
        SWEEP(kiln_map_convert(c, &cube, KILN_SHAPE_PANORAMA, 8, x, &m, &e), !m.owner);
        kiln_map_free(&m);
        kiln_map_expose(&panorama, x > -1e6 && x < 1e6 ? x : 0);
    }
    memset(panorama.level[0], 0, kiln_map_texels(&panorama, 0) * 3 * sizeof(float));
    kiln_map_mirror(&cube);
    kiln_map_cut_negative(c, &cube, NULL);
    double direction[3];
    for (size_t i = 0; i < kiln_map_texels(&cube, 0); i++) {
        kiln_map_direction(&cube, 0, i, direction);
        CHECK_NEAR(direction[0] * direction[0] + direction[1] * direction[1] +
                       direction[2] * direction[2],
                   1, 1e-12);
    }
    EACH_INT (level) {
        kiln_map wild = cube; // a map that the caller filled with other numbers
        wild.owner = NULL;
        wild.size = level;
        assert_true(level < 1 || kiln_map_level_size(&cube, 0) == 8);
        if (level < 1 || level > KILN_MAX_SIZE) // else the caller vouches for the texels
            SWEEP(kiln_map_convert(c, &wild, KILN_SHAPE_CUBE, 4, 0, &m, &e), !m.owner);
        kiln_map_free(&m);
        wild = cube;
        wild.owner = NULL;
        wild.level_count = level;
        if (level < 1 || level > cube.level_count) // else all levels are there
            SWEEP(kiln_map_convert(c, &wild, KILN_SHAPE_CUBE, 4, 0, &m, &e), !m.owner);
        kiln_map_free(&m);
    }
    kiln_map_free(NULL);
    kiln_image_free(NULL);
}

static void loads(void **state)
{
    (void)state;
    kiln_map m;
    kiln_image image;
    kiln_file_info info;
    kiln_note note;
    kiln_load_report report = {0};
    kiln_cut cut = {0};
    uint8_t bytes[64] = {0};
    static const char *const faces[6] = {"", "a", "/", "%s", "{face}", "."};
    static const char *const paths[] = {"", "/", "%s", "{face}", "%d%d%d", "a/%n", "\xff\xfe"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        SWEEP(kiln_map_load(c, paths[i], NULL, &m, &e), !m.owner);
        SWEEP(kiln_image_load(c, paths[i], &image, &e), !image.owner);
        SWEEP(kiln_file_describe(c, paths[i], &info, &e), !info.width);
        SWEEP(kiln_map_decode(c, bytes, i, paths[i], NULL, &m, &e), !m.owner);
    }
    SWEEP(kiln_map_decode(c, NULL, 0, "empty", NULL, &m, &e), !m.owner);
    int order[6];
    assert_true(kiln_faces_order(faces, order));
    for (int i = 0; i < 6; i++)
        assert_int_equal(order[i], i);
    SWEEP(kiln_map_load_faces(c, faces, NULL, &m, &e), !m.owner);
    INT_FIELD(kiln_load_def, layout, kiln_map_decode(c, bytes, 64, "x", &def, &m, &e), !m.owner, );
    INT_FIELD(kiln_load_def, negative, kiln_map_decode(c, bytes, 64, "x", &def, &m, &e),
              !m.owner, );
    EACH_INT (n) {
        // Only sizes whose pixels `bytes` holds are valid.
        kiln_pixels p = {.data = bytes, .width = n, .height = 1, .channels = 3};
        if (n < 2)
            SWEEP(kiln_map_from_pixels(c, &p, &m, &e), !m.owner);
        p = (kiln_pixels){.data = bytes, .width = 2, .height = n < 2 ? n : 1, .channels = n};
        if (n < 4)
            SWEEP(kiln_map_from_pixels(c, &p, &m, &e), !m.owner);
        kiln_map_free(&m);
        p = (kiln_pixels){.data = bytes, .width = 2, .height = 1, .channels = 3, .row_stride = n};
        SWEEP(kiln_map_from_pixels(c, &p, &m, &e), !m.owner);
        kiln_map_free(&m);
        p.layout = (kiln_layout)n;
        p.row_stride = 0;
        SWEEP(kiln_map_from_pixels(c, &p, &m, &e), !m.owner);
        kiln_map_free(&m);
        p.layout = 0;
        p.type = (kiln_pixel_type)n;
        SWEEP(kiln_map_from_pixels(c, &p, &m, &e), !m.owner);
        kiln_map_free(&m);
        assert_false(kiln_load_report_note(&report, n, &note));
    }
    (void)kiln_cut_note(&report, &cut, &note);
}

static void spectra(void **state)
{
    (void)state;
    kiln_spectrum *spectrum = NULL;
    kiln_stream *stream = NULL;
    kiln_map m;
    kiln_sh sh, other;
    kiln_error error;
    EACH_INT (n) {
        SWEEP(kiln_spectrum_analyze(c, &cube, n, &spectrum, &e), !spectrum);
        kiln_spectrum_destroy(spectrum);
        EACH_INT (d) {
            SWEEP(kiln_stream_begin(c, n, d, &stream, &e), !stream);
            kiln_stream_cancel(stream);
        }
        sweep_prepare();
        CHECK_OK(kiln_stream_begin(c, 4, 4, &stream, &error));
        if (n <= 4)
            SWEEP(kiln_stream_rows(stream, panorama.level[0], n, &e), true);
        SWEEP(kiln_stream_finish(stream, &spectrum, &e), !spectrum);
        kiln_spectrum_destroy(spectrum);
        SWEEP(kiln_map_sh(c, &cube, n, 0, &sh, &e), !sh.bands);
    }
    sweep_prepare();
    CHECK_OK(kiln_spectrum_analyze(c, &cube, 8, &spectrum, &error));
    assert_int_equal(kiln_spectrum_degree(spectrum), 8);
    double power[9][3];
    SWEEP(kiln_spectrum_power(spectrum, power, &e), true);
    CHECK_OK(kiln_map_create(c, KILN_SHAPE_CUBE, 4, 2, &m, &error));
    EACH_REAL (x) {
        EACH_INT (kind) {
            kiln_lobe lobe = {.kind = (kiln_lobe_kind)kind, .parameter = x};
            SWEEP(kiln_spectrum_filter(c, spectrum, &lobe, 0, &m, 1, &e), true);
            SWEEP(kiln_spectrum_filter(c, spectrum, &lobe, x, &m, kind, &e), true);
        }
        EACH_INT (bands) {
            SWEEP(kiln_spectrum_sh(spectrum, bands, false, x, 0, &sh, &e), !sh.bands);
            SWEEP(kiln_spectrum_sh(spectrum, bands, true, 0, x, &sh, &e), !sh.bands);
            kiln_sh radiance = {.bands = bands};
            SWEEP(kiln_sh_filter(&radiance, 3, true, x, &other, &e), !other.bands);
            radiance.bands = 3;
            SWEEP(kiln_sh_filter(&radiance, bands, true, x, &other, &e), !other.bands);
        }
        SWEEP(kiln_map_sh(c, &cube, 3, x, &sh, &e), !sh.bands);
    }
    kiln_map_free(&m);
    kiln_spectrum_destroy(spectrum);
    kiln_spectrum_destroy(NULL);
    kiln_stream_cancel(NULL);
}

// Black rows of a panorama with as many rows as the int at `user`.
static kiln_result read_black(void *user, int first, int count, float *rgb, kiln_error *error)
{
    int size = *(const int *)user;
    (void)error;
    assert_true(first >= 0 && count >= 1 && count <= size - first);
    memset(rgb, 0, 6 * (size_t)size * (size_t)count * sizeof *rgb);
    return KILN_OK;
}

static void bakes_of_rows(void **state)
{
    (void)state;
    kiln_environment made;
    const kiln_bake_def small = {.levels.size = 4, .irradiance_size = 4};
    EACH_INT (n) {
        int eight = 8, size = n;
        const kiln_rows all[] = {{size, read_black, &size, 0, 0},
                                 {eight, read_black, &eight, n, 1},
                                 {eight, read_black, &eight, 3, n}};
        for (int i = 0; i < 3; i++) {
            SWEEP(kiln_bake_rows(c, &all[i], &small, &made, &e), !made.levels.owner);
            kiln_environment_free(&made);
        }
    }
    INT_FIELD(kiln_load_def, layout, kiln_bake_file(c, "none.exr", &def, &small, NULL, &made, &e),
              !made.levels.owner, kiln_environment_free(&made));
    INT_FIELD(kiln_load_def, negative, kiln_bake_file(c, "none.exr", &def, &small, NULL, &made, &e),
              !made.levels.owner, kiln_environment_free(&made));
}

static void bakes(void **state)
{
    (void)state;
    kiln_map m;
    kiln_environment made;
    kiln_plan *plan = NULL;
    int eight = 8;
    const kiln_rows rows = {eight, read_black, &eight, 0, 0};
#define SKY(kind, field)                                                                           \
    kind(kiln_sky_def, field, kiln_sky(c, &def, &m, &e), !m.owner, kiln_map_free(&m))
    SKY(INT_FIELD, size);
    SKY(REAL_FIELD, elevation);
    SKY(REAL_FIELD, azimuth);
    SKY(REAL_FIELD, turbidity);
    SKY(REAL_FIELD, albedo);
#define LEVELS(kind, field)                                                                        \
    kind(kiln_prefilter_def, field, kiln_prefilter(c, &panorama, &def, &m, &e), !m.owner,          \
         kiln_map_free(&m))
    LEVELS(INT_FIELD, shape);
    LEVELS(INT_FIELD, size);
    LEVELS(INT_FIELD, level_count);
    LEVELS(INT_FIELD, smallest);
    LEVELS(INT_FIELD, lobe);
    LEVELS(REAL_FIELD, rotation);
    LEVELS(REAL_FIELD, tolerance);
#define BAKE(kind, field)                                                                          \
    kind(kiln_bake_def, field, kiln_bake(c, &panorama, &def, &made, &e), !made.levels.owner,       \
         kiln_environment_free(&made))                                                             \
        kind(kiln_bake_def, field, kiln_plan_create(c, KILN_SHAPE_PANORAMA, 8, &def, &plan, &e),   \
             !plan, kiln_plan_destroy(plan))                                                       \
            kind(kiln_bake_def, field, kiln_bake_rows(c, &rows, &def, &made, &e),                  \
                 !made.levels.owner, kiln_environment_free(&made))
    BAKE(INT_FIELD, levels.size);
    BAKE(INT_FIELD, tune);
    BAKE(REAL_FIELD, exposure);
    BAKE(INT_FIELD, irradiance_size);
    BAKE(INT_FIELD, sh_bands);
    BAKE(INT_FIELD, sun);
    BAKE(REAL_FIELD, clamp);
    BAKE(INT_FIELD, lights.count);
    BAKE(REAL_FIELD, lights.share);
    EACH_REAL (x) {
        float roughness[2] = {0, (float)x};
        kiln_prefilter_def def = {.size = 4, .level_count = 2, .roughness = roughness};
        SWEEP(kiln_prefilter(c, &panorama, &def, &m, &e), !m.owner);
        kiln_map_free(&m);
    }
    EACH_INT (shape)
        EACH_INT (size) {
            SWEEP(kiln_plan_create(c, (kiln_shape)shape, size, NULL, &plan, &e), !plan);
            kiln_plan_destroy(plan);
        }
    kiln_bake_def small = {.levels.size = 4, .irradiance_size = 4};
    sweep_prepare();
    kiln_error error;
    CHECK_OK(kiln_plan_create(c, KILN_SHAPE_PANORAMA, 8, &small, &plan, &error));
    SWEEP(kiln_plan_environment(plan, &made, &e), !made.levels.owner);
    SWEEP(kiln_plan_execute(plan, &cube, &made, &e), true); // another shape than the plan's
    SWEEP(kiln_plan_execute(plan, &panorama, &made, &e), true);
    assert_non_null(kiln_plan_spectrum(plan));
    kiln_plan_destroy(plan);
    kiln_environment_free(&made);
    kiln_plan_destroy(NULL);
    kiln_environment_free(NULL);
    EACH_REAL (x) {
        double direction[1][3] = {{x, 0, 0}}, value[1][3] = {{1, 1, 1}};
        kiln_lobe lobe = kiln_lobe_ggx(x);
        SWEEP(kiln_reference_filter(c, &panorama, &lobe, x, (const double(*)[3])direction, 1, value,
                                    &e),
              value[0][0] == 0);
        lobe = kiln_lobe_ggx(0.5);
        SWEEP(kiln_reference_filter(c, &panorama, &lobe, 0, (const double(*)[3])direction, 1, value,
                                    &e),
              value[0][0] == 0);
    }
    EACH_INT (n) {
        double direction[1][3] = {{1, 0, 0}}, value[1][3];
        kiln_lobe lobe = kiln_lobe_lambert();
        if (n < 2)
            SWEEP(kiln_reference_filter(c, &panorama, &lobe, 0, (const double(*)[3])direction, n,
                                        value, &e),
                  true);
    }
}

static void lights(void **state)
{
    (void)state;
    kiln_lights found;
    kiln_sh sh;
    kiln_clamp clamp;
    memset(cube.level[0], 0, kiln_map_texels(&cube, 0) * 3 * sizeof(float));
#define LIGHTS(kind, field)                                                                        \
    kind(kiln_lights_def, field, kiln_lights_find(c, &panorama, &def, &found, &e), !found.count, ) \
        kind(kiln_lights_def, field, kiln_lights_extract(c, &cube, &def, &found, &e),              \
             !found.count, )
    LIGHTS(INT_FIELD, count);
    LIGHTS(REAL_FIELD, share);
    EACH_REAL (x)
        SWEEP(kiln_map_clamp(c, &cube, x, &clamp, &e), clamp.limit == 0);
    EACH_INT (n) {
        found.count = 0;
        SWEEP(kiln_lights_sh(&found, n, &sh, &e), sh.bands == 0);
        found.count = n;
        if (n < 0 || n > KILN_MAX_LIGHTS)
            SWEEP(kiln_lights_sh(&found, 3, &sh, &e), sh.bands == 0);
        if (n < 0 || n > KILN_MAX_LIGHTS)
            SWEEP(kiln_lights_save(c, &found, "none/lights.json", &e), true);
    }
}

static void checks(void **state)
{
    (void)state;
    kiln_check_levels_report report;
    kiln_map rest;
    kiln_image picture;
    INT_FIELD(kiln_check_levels_def, lobe,
              kiln_check_levels(c, &panorama, &cube, &def, &report, &rest, &e),
              !report.level_count && !rest.level_count, kiln_map_free(&rest));
    kiln_map wrong = cube;
    EACH_REAL (x) {
        const kiln_check_levels_def def = {.stated = true};
        wrong.roughness[1] = (float)x;
        SWEEP(kiln_check_levels(c, &panorama, &wrong, &def, &report, NULL, &e),
              !report.level_count);
    }
    EACH_INT (n) {
        wrong = cube;
        wrong.level_count = n > KILN_MAX_LEVELS || n < 4 ? n : 4;
        SWEEP(kiln_check_levels(c, &panorama, &wrong, NULL, &report, NULL, &e),
              !report.level_count);
        SWEEP(kiln_check_picture(c, &wrong, &picture, &e), !picture.pixels);
        kiln_image_free(&picture);
        SWEEP(kiln_levels_unturn(c, &wrong, (const int[]){0, 1, 2}, (const int[]){1, 1, 1}, &rest,
                                 &e),
              !rest.level_count);
        kiln_map_free(&rest);
        SWEEP(kiln_levels_unturn(c, &cube, (const int[]){0, n < 3 ? n : 1, 2},
                                 (const int[]){1, 1, n}, &rest, &e),
              !rest.level_count);
        kiln_map_free(&rest);
    }
    SWEEP(kiln_levels_load(c, "none.ktx2", NULL, NULL, &rest, &e), !rest.level_count);
    kiln_check_table_report table;
    kiln_image image, numbers;
    bool flip;
    kiln_error error;
    CHECK_OK(kiln_image_create(c, 16, 16, 1, &image, &error));
    EACH_REAL (x) {
        image.pixels[3] = (float)x;
        SWEEP(kiln_check_table(c, &image, false, &table, &e), !table.channels);
    }
    EACH_INT (n) {
        kiln_image odd = image;
        odd.width = n < 16 ? n : 16;
        SWEEP(kiln_check_table(c, &odd, true, &table, &e), !table.channels);
        odd = image;
        odd.channels = n > 1 && n < 5 ? 1 : n;
        SWEEP(kiln_check_table(c, &odd, true, &table, &e), !table.channels);
    }
    kiln_image_free(&image);
    SWEEP(kiln_table_numbers_load(c, "none.png", &numbers, &flip, &e), !numbers.pixels);
    kiln_check_shown_report shown;
    const kiln_engine *three = kiln_engine_find("three");
    EACH_INT (n) {
        wrong = cube;
        wrong.level_count = n > KILN_MAX_LEVELS || n < 4 ? n : 4;
        SWEEP(kiln_check_shown(c, &panorama, &wrong, three, &shown, &e), !shown.direction_count);
    }
    SWEEP(kiln_check_shown(c, &panorama, &cube, NULL, &shown, &e), !shown.direction_count);
    // Numbers that are not finite are never right, whatever the tolerance, nor is an empty report.
    EACH_REAL (x) {
        const kiln_check_levels_report odd = {.level_count = 1, .worst = x};
        shown = (kiln_check_shown_report){.all = x, .displayed = x, .direction_count = 1};
        assert_true(isfinite(x) || x < 0 || !kiln_check_right(&odd, &shown, 1));
        assert_false(kiln_check_right(&(kiln_check_levels_report){.worst = x}, &shown, 1));
    }
    kiln_check_sh_report bands;
    kiln_sh sh = {.bands = 3};
    EACH_REAL (x) {
        sh.c[2][1] = x;
        SWEEP(kiln_check_sh(c, &panorama, &sh, NULL, &bands, &e), !bands.bands);
        sh.c[2][1] = 1;
        sh.window = x;
        SWEEP(kiln_check_sh(c, &panorama, &sh, NULL, &bands, &e), !bands.bands);
        sh.window = 0;
    }
    EACH_INT (n) {
        sh.bands = n;
        SWEEP(kiln_check_sh(c, &panorama, &sh, NULL, &bands, &e), !bands.bands);
    }
}

static void saves(void **state)
{
    (void)state;
    kiln_files files;
    kiln_save_report report = {0};
    uint8_t packed[16];
    kiln_sh sh = {.bands = 3};
    kiln_image image;
    kiln_error error;
#define SAVE(field, name)                                                                          \
    INT_FIELD(kiln_save_def, field, kiln_map_encode(c, &cube, name, &def, &files, &report, &e),    \
              !files.file, kiln_files_free(&files))                                                \
    INT_FIELD(kiln_save_def, field, kiln_map_save_check(name, KILN_SHAPE_CUBE, &def, &e), true, )
    SAVE(format, "a.ktx2");
    SAVE(format, "a.dds");
    SAVE(format, "a.exr");
    SAVE(format, "a.png");
    SAVE(zstd, "a.ktx2");
    EACH_INT (n) {
        SWEEP(kiln_map_save_check("a.ktx2", (kiln_shape)n, NULL, &e), true);
        (void)kiln_map_packed_size(&cube, n, KILN_FORMAT_AUTO);
        (void)kiln_map_packed_size(&cube, 0, (kiln_format)n);
        SWEEP(kiln_map_pack(c, &cube, n, KILN_FORMAT_AUTO, packed, 0, sizeof packed, &e), true);
        SWEEP(kiln_map_pack(c, &cube, 0, (kiln_format)n, packed, 0, sizeof packed, &e), true);
        SWEEP(kiln_map_pack(c, &cube, 0, 0, packed, (size_t)(ptrdiff_t)n, sizeof packed, &e), true);
        kiln_sh wild = {.bands = n};
        SWEEP(kiln_sh_save(c, &wild, "/nowhere/a.json", &e), true);
    }
    SWEEP(kiln_sh_save(c, &sh, "/nowhere/a.yaml", &e), true);
    SWEEP(kiln_map_save(c, &cube, "/nowhere/a.ktx2", NULL, &report, &e), !report.file_count);
    CHECK_OK(kiln_image_create(c, 2, 2, 3, &image, &error));
    SWEEP(kiln_image_save(c, &image, "/nowhere/a.png", &e), true);
    kiln_assignment_truncate(&image);
    kiln_image_free(&image);
    kiln_files_free(NULL);

    kiln_environment environment = {.levels = cube, .sh = sh};
    environment.levels.owner = NULL;
    kiln_environment_report whole;
#define ENVIRONMENT(field)                                                                         \
    INT_FIELD(kiln_environment_save_def, field,                                                    \
              kiln_environment_encode(c, &environment, "a.ktx2", &def, &files, &whole, &e),        \
              !files.file, kiln_files_free(&files))
    ENVIRONMENT(format);
    ENVIRONMENT(zstd);
    SWEEP(kiln_environment_save(c, &environment, "/nowhere/a.ktx2", NULL, NULL, &e), true);
}

static void engines(void **state)
{
    (void)state;
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    kiln_sh sh = {.bands = 3};
    kiln_save_report report = {0};
    kiln_files files;
    for (int i = -1; i < 0 || kiln_engine_at(i); i++) {
        const kiln_engine *engine = kiln_engine_at(i); // NULL first
        EACH_INT (a) {
            EACH_INT (b)
                SWEEP(kiln_engine_levels(engine, a, b, roughness, &def, &e), !def.size);
            kiln_format format = (kiln_format)a;
            SWEEP(kiln_engine_format(engine, &format, &e), true);
            SWEEP(
                kiln_engine_encode(c, engine, &cube, &sh, (kiln_format)a, "a", &files, &report, &e),
                !files.file);
            kiln_files_free(&files);
            double one[1][3] = {{1, 0, 0}}, value[1][3];
            if (a < 2)
                SWEEP(
                    kiln_engine_show(c, engine, &cube, 0.5, (const double(*)[3])one, a, value, &e),
                    true);
        }
        EACH_REAL (x) {
            double one[1][3] = {{x, x, x}}, value[1][3] = {{1, 1, 1}};
            SWEEP(kiln_engine_show(c, engine, &cube, x, (const double(*)[3])one, 1, value, &e),
                  value[0][0] == 0);
            SWEEP(kiln_engine_show(c, engine, &cube, 0.5, (const double(*)[3])one, 1, value, &e),
                  value[0][0] == 0);
        }
        SWEEP(kiln_engine_save(c, engine, &cube, &sh, 0, "/nowhere/a", &report, &e), true);
    }
}

// Tables of lobes, and the errors that are expected of them at all numbers of n.v and roughness.
static void lobes(void **state)
{
    (void)state;
    kiln_table table;
    kiln_error error;
    static const kiln_table_def small = {.kind = KILN_TABLE_LOBES, .width = 4, .height = 4};
#define LOBES(field, values, count)                                                                \
    FIELD_OF(kiln_table_def, small, field, values, count, kiln_table_create(c, &def, &table, &e),  \
             !table.image.owner, kiln_table_free(&table))
    LOBES(tap_count, ints, INTS);
    LOBES(level_count, ints, INTS);
    LOBES(level_roughness[0], reals, REALS);
    LOBES(level_roughness[1], reals, REALS);
    double nov[REALS * REALS], roughness[REALS * REALS];
    kiln_lobes_error errors[REALS * REALS];
    for (int i = 0; i < REALS * REALS; i++) {
        nov[i] = reals[i % REALS];
        roughness[i] = reals[i / REALS];
    }
    sweep_prepare();
    CHECK_OK(kiln_table_create(c, &small, &table, &error));
    CHECK_OK(kiln_lobes_errors(c, &table, nov, roughness, REALS * REALS, errors, &error));
    for (int i = 0; i < REALS * REALS; i++)
        assert_true(errors[i].straight >= 0 && errors[i].bent >= 0 && errors[i].table >= 0);
#define ERRORS_OF(field)                                                                           \
    for (int at = 0; at < INTS; at++) {                                                            \
        kiln_table other = table;                                                                  \
        other.def.field = (__typeof__(other.def.field))ints[at];                                   \
        if (other.def.field <= table.def.field)                                                    \
            SWEEP(kiln_lobes_errors(c, &other, nov, roughness, 1, errors, &e),                     \
                  errors[0].table == 0);                                                           \
    }
    ERRORS_OF(kind);
    ERRORS_OF(tap_count);
    ERRORS_OF(level_count);
    EACH_INT (n)
        SWEEP(kiln_lobes_errors(c, &table, nov, roughness, n < 2 ? n : 2, errors, &e),
              errors[0].table == 0);
    kiln_table_free(&table);
}

static void tables(void **state)
{
    (void)state;
    kiln_table table, average;
    kiln_fit fit;
    kiln_error error;
#define TABLE(field)                                                                               \
    INT_FIELD(kiln_table_def, field, kiln_table_create(c, &def, &table, &e), !table.image.owner,   \
              kiln_table_free(&table))                                                             \
    INT_FIELD(kiln_table_def, field, kiln_table_lookup_save(c, &def, "/nowhere/a.h", "a", &e),     \
              true, )
    TABLE(kind);
    TABLE(model.d);
    TABLE(model.g);
    TABLE(sheen);
    TABLE(width);
    TABLE(height);
    TABLE(depth);
    TABLE(axis);
    TABLE(path_count);
#define FIT(kind, field)                                                                           \
    kind(kiln_fit_def, field, kiln_fit_create(c, &def, &fit, &e), !fit.part_count, )
    FIT(INT_FIELD, kind);
    FIT(INT_FIELD, model.d);
    FIT(INT_FIELD, model.g);
    FIT(INT_FIELD, form);
    FIT(INT_FIELD, max_coefficients);
    FIT(REAL_FIELD, error);
    FIT(REAL_FIELD, roughness_min);
#define SAVE_TABLE(field)                                                                          \
    INT_FIELD(kiln_table_save_def, field, kiln_table_save_check("a.ktx2", &def, &e), true, )       \
    INT_FIELD(kiln_table_save_def, field, kiln_table_save(c, &table, "/nowhere/a.png", &def, &e),  \
              true, )
    sweep_prepare();
    CHECK_OK(kiln_table_create(c, &(kiln_table_def){.width = 4, .height = 4}, &table, &error));
    SAVE_TABLE(format);
    SAVE_TABLE(zstd);
    double nov, roughness, third, values[4];
    EACH_INT (n) {
        SWEEP(kiln_table_average(c, &table, n, &average, &e), !average.image.owner);
        kiln_table_free(&average);
        kiln_table_texel(&table, n >= 0 && n < 4 ? n : 0, 0, 0, &nov, &roughness, &third);
        assert_true(nov >= 0 && nov <= 1 && roughness >= 0 && roughness <= 1);
    }
    fit = (kiln_fit){.part_count = 1,
                     .part[0] = {.axis = KILN_FIT_AXIS_NOV, .x_count = 1, .y_count = 1}};
    EACH_REAL (x)
        EACH_REAL (y) {
            float value[2];
            kiln_table_lookup(&table, x, y, x, values);
            assert_true(values[0] >= 0 && values[0] <= 1);
            kiln_fit_evaluate(&fit, (float)x, (float)y, value);
            assert_true(value[0] == 0);
        }
    SWEEP(kiln_fit_save(c, &fit, "1 no name", "/nowhere/a.h", &e), true);
    kiln_table_free(&table);
    kiln_table_free(NULL);
    SWEEP(kiln_table_load(c, "/nowhere/a.ktx2", &table, &e), !table.image.owner);
}

static void courses(void **state)
{
    (void)state;
    kiln_map m;
    kiln_image image, average, picture;
    kiln_difference difference;
    kiln_error error;
    static const kiln_textbook_def few = {
        .size = 4, .phi_count = 4, .theta_count = 4, .sample_count = 4};
    static const kiln_assignment_def small = {.size = 4, .sample_count = 4};
#define TEXTBOOK(field)                                                                            \
    FIELD_OF(kiln_textbook_def, few, field, counts, COUNTS,                                        \
             kiln_textbook_irradiance(c, &panorama, &def, &m, &e), !m.owner, kiln_map_free(&m))    \
    FIELD_OF(kiln_textbook_def, few, field, counts, COUNTS,                                        \
             kiln_textbook_prefilter(c, &panorama, &def, &m, &e), !m.owner, kiln_map_free(&m))
    TEXTBOOK(shape);
    TEXTBOOK(size);
    TEXTBOOK(level_count);
    TEXTBOOK(phi_count);
    TEXTBOOK(theta_count);
    TEXTBOOK(sample_count);
    for (int i = 0; i < COUNTS * COUNTS; i++) {
        int size = counts[i / COUNTS], samples = counts[i % COUNTS];
        SWEEP(kiln_textbook_brdf(c, size, samples, &image, &e), !image.owner);
        kiln_image_free(&image);
    }
    EACH_INT (a) {
        SWEEP(kiln_assignment_energy(c, (kiln_assignment_method)a, &small, &image, &e),
              !image.owner);
        kiln_image_free(&image);
    }
#define ASSIGNMENT(field)                                                                          \
    FIELD_OF(kiln_assignment_def, small, field, counts, COUNTS,                                    \
             kiln_assignment_energy(c, 0, &def, &image, &e), !image.owner,                         \
             kiln_image_free(&image))
    ASSIGNMENT(size);
    ASSIGNMENT(sample_count);
    ASSIGNMENT(g);
    ASSIGNMENT(seed);
    CHECK_OK(kiln_image_create(c, 2, 2, 1, &image, &error));
    SWEEP(kiln_assignment_average(c, &image, &average, &e), !average.owner);
    SWEEP(kiln_assignment_compare(c, &image, &average, &difference, &picture, &e), !picture.owner);
    kiln_image_free(&picture);
    SWEEP(kiln_assignment_compare(c, &image, &image, &difference, NULL, &e), true);
    kiln_image_free(&average);
    kiln_image_free(&image);
}

int main(void)
{
#define SWEPT(test) cmocka_unit_test_setup_teardown(test, begin, finish)
    const struct CMUnitTest tests[] = {
        SWEPT(contexts),      SWEPT(maps),   SWEPT(loads),   SWEPT(spectra), SWEPT(bakes),
        SWEPT(bakes_of_rows), SWEPT(lights), SWEPT(checks),  SWEPT(saves),   SWEPT(engines),
        SWEPT(lobes),         SWEPT(tables), SWEPT(courses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
