// The colours and places of EXR files: chromaticities, luminance and chroma, and environment maps.
// Witnesses are OpenEXR's own reader of luminance and chroma (RgbaInputFile), and files that
// OpenEXR's exrenvmap has written.
#include "codec/codec.h"
#include "exr_plain.h"
#include "image/image.h"
#include "image/pack.h"
#include "math/math.h"

#include <ImfCRgbaFile.h>

#include "kit/context.h"
#include "kit/random.h"

static const float rec709[8] = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
// ACES' primaries AP1 and AP0 (S-2014-004, ST 2065-1)
static const float acescg[8] = {0.713F, 0.293F, 0.165F, 0.830F, 0.128F, 0.044F, 0.32168F, 0.33767F};

// Loads a file with a report, which may be NULL.
static kiln_result load(const plain_file *file, kiln_load_report *report, kiln_map *map)
{
    ki_writer w = {.context = context};
    const kiln_load_def def = {.report = report};
    plain_write(file, &w);
    kiln_result result = kiln_map_decode(context, w.bytes, w.size, "a.exr", &def, map, &error);
    ki_writer_free(&w);
    return result;
}

static void check_note(const kiln_load_report *report, int index, kiln_note_kind kind,
                       const char *text)
{
    kiln_note note;
    assert_true(kiln_load_report_note(report, index, &note));
    assert_int_equal(note.kind, kind);
    assert_string_equal(note.text, text);
}

// ---------------------------------------------------------------------------------- chromaticities

static float color[3];

static float constant(int part, const char *channel, int x, int y)
{
    (void)part;
    (void)x;
    (void)y;
    return color[*channel == 'R' ? 0 : *channel == 'G' ? 1 : 2];
}

static plain_file constant_file(float red, float green, float blue)
{
    color[0] = red;
    color[1] = green;
    color[2] = blue;
    return (plain_file){.width = 4,
                        .height = 2,
                        .part_count = 1,
                        .parts = {{.channels = {"B", "G", "R"}}},
                        .value = constant};
}

static void check_color(const plain_file *file, double red, double green, double blue, double bound)
{
    const double wanted[3] = {red, green, blue};
    kiln_map map;
    CHECK_OK(load(file, NULL, &map));
    for (int c = 0; c < 3; c++)
        CHECK_NEAR((double)map.level[0][c], wanted[c], bound);
    kiln_map_free(&map);
}

// The matrix of ACES in Rec. 709 by Bradford, as the Academy's aces-dev has it in AP1 to Rec. 709
// (its utility transforms), to six digits.
static void primaries_become_those_of_rec709(void **state)
{
    (void)state;
    static const double matrix[3][3] = {{1.705051, -0.621792, -0.083259},
                                        {-0.130256, 1.140805, -0.010548},
                                        {-0.024003, -0.128969, 1.152972}};
    for (int k = 0; k < 3; k++) {
        plain_file file = constant_file(k == 0, k == 1, k == 2);
        file.chromaticities = acescg;
        check_color(&file, matrix[0][k], matrix[1][k], matrix[2][k], 2e-6);
    }
    // AP0, whose blue is no colour that can be seen.
    static const float ap0[8] = {0.7347F, 0.2653F, 0, 1, 0.0001F, -0.077F, 0.32168F, 0.33767F};
    plain_file wide = constant_file(1, 0, 0);
    wide.chromaticities = ap0;
    check_color(&wide, 2.521686, -0.276480, -0.015378, 2e-5);
    plain_file white = constant_file(3, 3, 3);
    white.chromaticities = acescg;
    check_color(&white, 3, 3, 3, 1e-6);
}

static void a_file_of_rec709_keeps_its_bits(void **state)
{
    (void)state;
    float near[8];
    memcpy(near, rec709, sizeof near);
    near[0] += 0.00019F;
    near[7] -= 0.00019F;
    const float *const stated[] = {NULL, rec709, near};
    for (int i = 0; i < 3; i++) {
        plain_file file = constant_file(0.1F, 1e-30F, 54321.125F);
        file.chromaticities = stated[i];
        kiln_load_report report = {0};
        kiln_map map;
        CHECK_OK(load(&file, &report, &map));
        for (int k = 0; k < 24; k++)
            assert_true(map.level[0][k] == color[k % 3]);
        assert_int_equal(report.note_count, 0);
        kiln_map_free(&map);
    }
}

// The colour with the chromaticity of D50 becomes white in a file whose neutral white is D50. Its
// red, green and blue are XYZ of D50, (0.96421, 1, 0.82519), times the matrix of IEC 61966-2-1.
static void the_adopted_neutral_becomes_white(void **state)
{
    (void)state;
    static const float d50[2] = {0.34567F, 0.35850F};
    plain_file file = constant_file(1.175955F, 0.975726F, 0.722041F);
    file.neutral = d50;
    check_color(&file, 1, 1, 1, 5e-4);
    kiln_load_report report = {0};
    kiln_map map;
    CHECK_OK(load(&file, &report, &map));
    check_note(
        &report, 0, KILN_NOTE_CONVERSION,
        "colours became Rec. 709: the file's red is (0.64, 0.33), green (0.3, 0.6), blue (0.15, "
        "0.06), neutral white (0.3457, 0.3585), adapted by Bradford");
    kiln_map_free(&map);
}

static float infinite_at_origin(int part, const char *channel, int x, int y)
{
    return *channel == 'R' && x == 0 && y == 0 ? INFINITY : constant(part, channel, x, y);
}

static void strange_colours_are_kept_or_refused(void **state)
{
    (void)state;
    // Outside the gamut of Rec. 709: negative numbers are data.
    plain_file file = constant_file(0, 1, 0);
    file.chromaticities = acescg;
    check_color(&file, -0.621792, 1.140805, -0.128969, 2e-6);
    // An infinite red becomes 65504; no colour can be computed for the texel, whose other channels
    // stay.
    kiln_load_report report = {0};
    kiln_map map;
    file = constant_file(0, 1, 1);
    file.chromaticities = acescg;
    file.value = infinite_at_origin;
    CHECK_OK(load(&file, &report, &map));
    CHECK_NEAR((double)map.level[0][0], 65504, 0);
    CHECK_NEAR((double)map.level[0][1], 1, 0);
    CHECK_NEAR((double)map.level[0][4], 1.140805 - 0.010548, 2e-6);
    assert_int_equal(report.infinite_count, 1);
    kiln_map_free(&map);
    // Three primaries on a line are no set of primaries.
    static const float line[8] = {0.1F, 0.1F, 0.2F, 0.2F, 0.3F, 0.3F, 0.3F, 0.3F};
    file = constant_file(1, 1, 1);
    file.chromaticities = line;
    assert_int_equal(load(&file, NULL, &map), KILN_ERROR_FORMAT);
    assert_string_equal(error.message,
                        "a.exr: its chromaticities, red (0.1, 0.1), green (0.2, 0.2), blue (0.3, "
                        "0.3), white (0.3, 0.3), neutral (0.3, 0.3), are no set of primaries");
}

static void the_luminance_of_white_is_told_and_not_applied(void **state)
{
    (void)state;
    static const float luminance = 80;
    plain_file file = constant_file(0.25F, 0.5F, 1);
    file.luminance = &luminance;
    check_color(&file, 0.25, 0.5, 1, 0);
    kiln_load_report report = {0};
    kiln_map map;
    CHECK_OK(load(&file, &report, &map));
    check_note(&report, 0, KILN_NOTE_ASSUMPTION,
               "the file states 80 cd/m2 for white (1, 1, 1); texels were not multiplied by this "
               "number, since light in kiln has the unit of the file");
    kiln_map_free(&map);
}

static void the_shape_of_pixels_is_told_and_ignored(void **state)
{
    (void)state;
    plain_file file = constant_file(0.25F, 0.5F, 1);
    kiln_load_report report;
    kiln_map map;
    CHECK_OK(load(&file, &report, &map));
    assert_int_equal(report.note_count, 0);
    kiln_map_free(&map);
    file.aspect = 2;
    CHECK_OK(load(&file, &report, &map));
    check_note(&report, 0, KILN_NOTE_ASSUMPTION,
               "the attribute pixelAspectRatio says that a pixel is 2 times as wide as high, which "
               "was ignored: pixels cover equal steps of the sphere");
    assert_int_equal(map.size, 2);
    kiln_map_free(&map);
}

// ---------------------------------------------------------------------------- luminance and chroma

enum { YC_W = 64, YC_H = 32 };

static ImfHalf half_of(double value)
{
    return ki_half_from_float((float)value);
}

// A smooth picture with noise and one bright red edge, at whose sides chroma must be interpolated.
static void fill_picture(ImfRgba *pixels)
{
    uint64_t seed = 5;
    for (int i = 0; i < YC_W * YC_H; i++) {
        int x = i % YC_W, y = i / YC_W;
        bool bright = x > 30 && x < 40 && y > 9 && y < 21;
        double base = 0.2 + 0.01 * x + random_between(&seed, 0, 0.05);
        pixels[i] = (ImfRgba){half_of(bright ? 40 : base), half_of(0.3 + 0.02 * y),
                              half_of(bright ? 0.1 : 1 - 0.01 * x), half_of(1)};
    }
}

static void must(int done)
{
    if (!done)
        fail_msg("OpenEXR: %s", ImfErrorMessage());
}

static void write_chroma(const char *path, const ImfRgba *pixels, int channels)
{
    ImfHeader *header = ImfNewHeader();
    ImfHeaderSetDataWindow(header, 0, 0, YC_W - 1, YC_H - 1);
    ImfHeaderSetDisplayWindow(header, 0, 0, YC_W - 1, YC_H - 1);
    ImfHeaderSetCompression(header, IMF_ZIP_COMPRESSION);
    ImfOutputFile *file = ImfOpenOutputFile(path, header, channels);
    assert_non_null(file);
    must(ImfOutputSetFrameBuffer(file, pixels, 1, YC_W));
    must(ImfOutputWritePixels(file, YC_H));
    must(ImfCloseOutputFile(file));
    ImfDeleteHeader(header);
}

static void read_witness(const char *path, ImfRgba *pixels)
{
    ImfInputFile *file = ImfOpenInputFile(path);
    assert_non_null(file);
    must(ImfInputSetFrameBuffer(file, pixels, 1, YC_W));
    must(ImfInputReadPixels(file, 0, YC_H - 1));
    must(ImfCloseInputFile(file));
}

// OpenEXR rounds to a half after each of its steps, so that a result differs by some halfs' last
// bits of the largest channel.
static void luminance_and_chroma_are_read_as_openexr_reads_them(void **state)
{
    (void)state;
    static ImfRgba pixels[YC_W * YC_H], wanted[YC_W * YC_H];
    const char *path = in_folder("chroma.exr");
    fill_picture(pixels);
    write_chroma(path, pixels, IMF_WRITE_YC);
    read_witness(path, wanted);
    kiln_image image;
    CHECK_OK(kiln_image_load(context, path, &image, &error));
    assert_int_equal(image.width, YC_W);
    assert_int_equal(image.height, YC_H);
    for (int i = 0; i < YC_W * YC_H; i++) {
        const double want[3] = {(double)ImfHalfToFloat(wanted[i].r),
                                (double)ImfHalfToFloat(wanted[i].g),
                                (double)ImfHalfToFloat(wanted[i].b)};
        double most = fmax(want[0], fmax(want[1], want[2]));
        for (int c = 0; c < 3; c++)
            if (!(fabs((double)image.pixels[3 * i + c] - want[c]) <= 4e-3 * most))
                fail_msg("channel %d of (%d, %d) is %g, OpenEXR reads %g", c, i % YC_W, i / YC_W,
                         (double)image.pixels[3 * i + c], want[c]);
    }
    kiln_image_free(&image);
    assert_int_equal(remove(path), 0);
}

static void grey_pictures_stay_exactly_grey(void **state)
{
    (void)state;
    static ImfRgba pixels[YC_W * YC_H], wanted[YC_W * YC_H]; // OpenEXR rounds luminance to 8 bits
    const char *path = in_folder("grey.exr");
    for (int i = 0; i < YC_W * YC_H; i++)
        pixels[i] = (ImfRgba){half_of(0.01 * i), half_of(0.01 * i), half_of(0.01 * i), half_of(1)};
    write_chroma(path, pixels, IMF_WRITE_YC);
    read_witness(path, wanted);
    kiln_image image;
    CHECK_OK(kiln_image_load(context, path, &image, &error));
    for (int i = 0; i < 3 * YC_W * YC_H; i++)
        assert_true(image.pixels[i] == ImfHalfToFloat(wanted[i / 3].g));
    kiln_image_free(&image);
    assert_int_equal(remove(path), 0);
}

// What the formula gives for the colour: Y, (R - Y) / Y and (B - Y) / Y.
static float chroma_of_color(int part, const char *channel, int x, int y)
{
    (void)part;
    (void)x;
    (void)y;
    // Luminance of ACEScg's red, green and blue, as S-2014-004 has it.
    double luminance = 0.2722287168 * (double)color[0] + 0.6740817658 * (double)color[1] +
                       0.0536895174 * (double)color[2];
    if (!strcmp(channel, "Y"))
        return (float)luminance;
    return (float)(((double)color[*channel == 'R' ? 0 : 2] - luminance) / luminance);
}

static void check_chroma(const float *chromaticities, int sampling, const int32_t display[4])
{
    plain_file plain = constant_file(0.5F, 0.25F, 0.75F), file = plain;
    kiln_map map;
    plain.chromaticities = chromaticities;
    CHECK_OK(load(&plain, NULL, &map));
    file.parts[0] = (plain_part){.channels = {"BY", "RY", "Y"}};
    file.value = chroma_of_color;
    file.chromaticities = chromaticities;
    file.sampling = sampling;
    if (display) {
        file.width = 12;
        file.height = 6;
        memcpy(file.display, display, sizeof file.display);
    }
    check_color(&file, (double)map.level[0][0], (double)map.level[0][1], (double)map.level[0][2],
                3e-6);
    kiln_map_free(&map);
}

// The weights of luminance are those of the file's primaries, with chroma in every texel or in
// every second; also where the display window cuts the data window.
static void luminance_has_the_weights_of_the_primaries(void **state)
{
    (void)state;
    static const int32_t display[4] = {3, 1, 10, 4};
    for (int sampling = 1; sampling <= 2; sampling++) {
        check_chroma(acescg, sampling, NULL);
        check_chroma(acescg, sampling, display);
    }
}

// -------------------------------------------------------------------------------- environment maps

// The radiance, in kiln's axes, that exrenvmap was given as a panorama of 256 x 128.
static double radiance(const double d[3], int c)
{
    return 1 + 0.5 * d[c] + 0.2 * d[(c + 1) % 3] * d[(c + 2) % 3];
}

static void check_radiance(const kiln_map *map, double bound)
{
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double d[3];
        kiln_map_direction(map, 0, i, d);
        for (int c = 0; c < 3; c++)
            if (!(fabs((double)map->level[0][3 * i + (size_t)c] - radiance(d, c)) <= bound))
                fail_msg("channel %d of texel %zu, at (%g, %g, %g), is %g, not %g", c, i, d[0],
                         d[1], d[2], (double)map->level[0][3 * i + (size_t)c], radiance(d, c));
    }
}

static void maps_of_exrenvmap_are_read_in_place(void **state)
{
    (void)state;
    static const struct {
        const char *path, *layout, *note;
        kiln_shape shape;
        int size;
    } files[] = {
        {KILN_GOOD_FILES "/envmap-cube.exr", "openexr-cube",
         "the file is a cube with OpenEXR's attribute envmap, whose outer texels lie on the "
         "border; "
         "texels were interpolated at kiln's places; --layout strip reads them as they are",
         KILN_SHAPE_CUBE, 16},
        {KILN_GOOD_FILES "/envmap-latlong.exr", "openexr-panorama",
         "the file is a panorama with OpenEXR's attribute envmap, whose outer texels lie on the "
         "border; texels were interpolated at kiln's places; --layout panorama reads them as they "
         "are",
         KILN_SHAPE_PANORAMA, 32},
    };
    for (int i = 0; i < 2; i++) {
        kiln_map map;
        kiln_file_info info;
        kiln_load_report report = {0};
        const kiln_load_def def = {.report = &report};
        CHECK_OK(kiln_map_load(context, files[i].path, &def, &map, &error));
        assert_int_equal(map.shape, files[i].shape);
        assert_int_equal(map.size, files[i].size);
        check_radiance(&map, 8e-3);
        check_note(&report, 0, KILN_NOTE_CONVERSION, files[i].note);
        kiln_map_free(&map);
        CHECK_OK(kiln_file_describe(context, files[i].path, &info, &error));
        assert_string_equal(info.layout, files[i].layout);
        check_note(&info.report, 0, KILN_NOTE_CONVERSION, files[i].note);
    }
}

// The radiance at texel (x, y) of a panorama of 128 x 64, whose first and last columns are both at
// the seam.
static float border_panorama(int part, const char *channel, int x, int y)
{
    (void)part;
    double longitude = KI_PI * (2.0 * x / 127 - 1), latitude = KI_PI * (0.5 - y / 63.0);
    const double d[3] = {cos(latitude) * sin(longitude), sin(latitude),
                         -cos(latitude) * cos(longitude)};
    return (float)radiance(d, *channel == 'R' ? 0 : *channel == 'G' ? 1 : 2);
}

static void a_declared_panorama_ends_at_its_border(void **state)
{
    (void)state;
    plain_file file = {.width = 128,
                       .height = 64,
                       .part_count = 1,
                       .parts = {{.channels = {"B", "G", "R"}}},
                       .envmap = 1,
                       .value = border_panorama};
    kiln_map map, plain;
    CHECK_OK(load(&file, NULL, &map));
    check_radiance(&map, 1e-3);
    kiln_map_free(&map);
    // Named a panorama by the caller, the texels are taken as they are, which errs by half a texel.
    ki_writer w = {.context = context};
    const kiln_load_def def = {.layout = KILN_LAYOUT_PANORAMA};
    plain_write(&file, &w);
    CHECK_OK(kiln_map_decode(context, w.bytes, w.size, "a.exr", &def, &plain, &error));
    ki_writer_free(&w);
    for (int i = 0; i < 128 * 64; i++)
        assert_true(plain.level[0][3 * i] == border_panorama(0, "R", i % 128, i / 128));
    kiln_map_free(&plain);
}

// kiln's own panoramas declare themselves too, and come back to the bit.
static void panoramas_of_kiln_are_read_as_they_are(void **state)
{
    (void)state;
    kiln_map map, back;
    const char *path = in_folder("own.exr");
    const kiln_save_def def = {.format = KILN_FORMAT_RGBA32F};
    CHECK_OK(kiln_sky(context, &(kiln_sky_def){.size = 16}, &map, &error));
    CHECK_OK(kiln_map_save(context, &map, path, &def, NULL, &error));
    CHECK_OK(kiln_map_load(context, path, NULL, &back, &error));
    assert_memory_equal(map.level[0], back.level[0], 16 * 32 * 3 * sizeof(float));
    kiln_map_free(&map);
    kiln_map_free(&back);
    assert_int_equal(remove(path), 0);
}

static void a_cube_of_other_proportions_is_refused(void **state)
{
    (void)state;
    plain_file file = constant_file(1, 1, 1);
    kiln_map map;
    file.envmap = 2;
    assert_int_equal(load(&file, NULL, &map), KILN_ERROR_FORMAT);
    assert_string_equal(
        error.message,
        "a.exr: is 4 x 2 pixels, the cube that its attribute envmap states must be N "
        "x 6 N; --layout reads the picture without the attribute");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(primaries_become_those_of_rec709),
        cmocka_unit_test(a_file_of_rec709_keeps_its_bits),
        cmocka_unit_test(the_adopted_neutral_becomes_white),
        cmocka_unit_test(strange_colours_are_kept_or_refused),
        cmocka_unit_test(the_luminance_of_white_is_told_and_not_applied),
        cmocka_unit_test(the_shape_of_pixels_is_told_and_ignored),
        cmocka_unit_test(luminance_and_chroma_are_read_as_openexr_reads_them),
        cmocka_unit_test(grey_pictures_stay_exactly_grey),
        cmocka_unit_test(luminance_has_the_weights_of_the_primaries),
        cmocka_unit_test(maps_of_exrenvmap_are_read_in_place),
        cmocka_unit_test(a_declared_panorama_ends_at_its_border),
        cmocka_unit_test(panoramas_of_kiln_are_read_as_they_are),
        cmocka_unit_test(a_cube_of_other_proportions_is_refused),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_empty_folder);
}
