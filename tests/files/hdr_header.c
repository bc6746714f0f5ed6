// The header of Radiance HDR files: what scales values, names colours or may contain blanks, and
// files whose texels look like run-lengths. All pictures are made here.
#include "codec/codec.h"
#include "image/color.h"

#include "kit/context.h"
#include "kit/notes.h"

enum { W = 3, H = 2 };

static const uint8_t texels[W * H][4] = {{128, 64, 32, 129}, {10, 20, 30, 128}, {200, 100, 50, 130},
                                         {0, 0, 255, 127},   {77, 77, 77, 131}, {1, 2, 3, 128}};

static double value(int i, int c)
{
    return texels[i][c] * ldexp(1, texels[i][3] - 136);
}

// Decodes a flat picture with these lines of header and this line of resolution.
static kiln_result decode(const char *header, const char *resolution, ki_decoded *decoded,
                          kiln_file_info *info)
{
    ki_writer w = {.context = context};
    ki_write_text(&w, "#?RADIANCE\n%s\n%s\n", header, resolution);
    ki_write(&w, texels, sizeof texels);
    kiln_result result = ki_decode(context, w.bytes, w.size, "a.hdr", decoded, info, &error);
    ki_writer_free(&w);
    return result;
}

// Checks that each value is the stored one divided by `divisor`, and that `count` notes exist, of
// which the first is `text`. The description of the file has the same notes.
static void check_divided(const char *header, const double divisor[3], int count,
                          kiln_note_kind kind, bool warning, const char *text)
{
    ki_decoded decoded;
    kiln_file_info info;
    CHECK_OK(decode(header, "-Y 2 +X 3", &decoded, NULL));
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 3; c++) {
            double wanted = value(i, c) / divisor[c];
            CHECK_NEAR((double)decoded.image.pixels[3 * i + c], wanted, wanted * 1e-7);
        }
    assert_int_equal(decoded.report.note_count, count);
    if (count)
        check_note(&decoded.report, 0, kind, warning, text);
    ki_decoded_free(&decoded);
    CHECK_OK(decode(header, "-Y 2 +X 3", NULL, &info));
    assert_int_equal(info.report.note_count, count);
    if (count)
        check_note(&info.report, 0, kind, warning, text);
}

static void exposure_and_correction_are_divided_out(void **state)
{
    static const double one[3] = {1, 1, 1}, ten[3] = {10, 10, 10}, corr[3] = {2, 4, 0.5};
    static const double both[3] = {2.5 * 2 * 3, 2.5 * 4 * 3, 2.5 * 0.5 * 5};
    (void)state;
    check_divided("", one, 0, 0, false, NULL);
    check_divided("EXPOSURE=1\nVIEW= -vp 0 0 1 -vh 90\n\tEXPOSURE=7\nGAMMA=1.0\nCOLORCORR=1 1 1\n",
                  one, 0, 0, false, NULL);
    check_divided("EXPOSURE=2.5\nEXPOSURE= \t4e0 \n", ten, 1, KILN_NOTE_CONVERSION, false,
                  "values were divided by the header's exposure of 10");
    check_divided("COLORCORR= 2 4 0.5\n", corr, 1, KILN_NOTE_CONVERSION, false,
                  "values were divided by the header's colour correction of 2, 4 and 0.5");
    check_divided("COLORCORR= 2 4 0.5\nEXPOSURE=2.5\r\nCOLORCORR=3\t3 5\n", both, 2,
                  KILN_NOTE_CONVERSION, false,
                  "values were divided by the header's exposure of 2.5");
    check_divided("PIXASPECT=1\nPIXASPECT=2\nPIXASPECT= 0.5\n", one, 0, 0, false, NULL);
    check_divided(
        "PIXASPECT=2\nPIXASPECT=2\n", one, 1, KILN_NOTE_ASSUMPTION, false,
        "the header's PIXASPECT says that a pixel is 0.25 times as wide as high, which was "
        "ignored: pixels cover equal steps of the sphere");
    check_divided("EXPOSURE=0\n", one, 1, KILN_NOTE_ASSUMPTION, true,
                  "the header's EXPOSURE of 0 was taken as 1");
    check_divided("EXPOSURE=0\nEXPOSURE=10\n", ten, 2, KILN_NOTE_ASSUMPTION, true,
                  "the header's EXPOSURE of 0 was taken as 1");
}

// Lines that would change what the texels mean, but are not honoured, and how often they stand.
static void what_is_ignored_is_said(void **state)
{
    static const double one[3] = {1, 1, 1};
    (void)state;
    check_divided("GAMMA=2.2\n", one, 1, KILN_NOTE_ASSUMPTION, true,
                  "the header's line \"GAMMA=2.2\" was ignored: values were taken as linear light");
    check_divided("GAMMA=1\nGAMMA=x\033[2J\n", one, 1, KILN_NOTE_ASSUMPTION, true,
                  "the header's line \"GAMMA=x?[2J\" was ignored: values were taken as linear "
                  "light");
    check_divided("VIEW= -vtv -vp 0 0 1\nVIEW= -vtv\n", one, 1, KILN_NOTE_ASSUMPTION, false,
                  "the header's VIEW says that the picture is a perspective view (-vtv), which was "
                  "ignored: the layout does not follow from VIEW");
    check_divided("VIEW= -vtl -vh 360 -vta -vv 360\n", one, 1, KILN_NOTE_ASSUMPTION, false,
                  "the header's VIEW says that the picture is an angular fisheye (-vta), which was "
                  "ignored: the layout does not follow from VIEW");
    check_divided("VIEW= -vt\nVIEW= -vtx\nVIEW=\nXVIEW= -vtv\n", one, 0, 0, false, NULL);
}

static void check_colors(const char *header, const ki_matrix3 *a, const char *text)
{
    ki_decoded decoded;
    kiln_file_info info;
    CHECK_OK(decode(header, "-Y 2 +X 3", &decoded, &info));
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 3; c++) {
            double wanted =
                a->m[c][0] * value(i, 0) + a->m[c][1] * value(i, 1) + a->m[c][2] * value(i, 2);
            CHECK_NEAR((double)decoded.image.pixels[3 * i + c], wanted, 5e-6);
        }
    if (text)
        check_note(&decoded.report, 0, KILN_NOTE_CONVERSION, false, text);
    else
        assert_int_equal(decoded.report.note_count, 0);
    ki_decoded_free(&decoded);
}

// The matrix of primaries is that of ki_rec709_from_rgb, which has tests with published numbers.
// The matrix of XYZ is written here to its seventh digit.
static void colors_are_converted_to_rec709(void **state)
{
    static const ki_matrix3 one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    static const ki_primaries radiance = {{0.64, 0.33, 0.29, 0.60, 0.15, 0.06, 1.0 / 3, 1.0 / 3}};
    static const ki_primaries wide = {{0.7, 0.3, 0.2, 0.75, 0.14, 0.05, 0.3127, 0.329}};
    // XYZ with the white X = Y = Z to Rec. 709, each row of which sums to 1
    static const ki_matrix3 xyz = {{{3.1466577, -1.6664638, -0.4801939},
                                    {-0.9955216, 1.9557567, 0.0397649},
                                    {0.0635948, -0.2145632, 1.1509684}}};
    ki_matrix3 a;
    (void)state;
    check_colors("PRIMARIES= 0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n", &one, NULL);
    assert_true(ki_rec709_from_rgb(&radiance, NULL, &a));
    check_colors("PRIMARIES=.6400 .3300 .2900 .6000 .1500 .0600 .333333 .333333\n", &a,
                 "colours were converted to Rec. 709 from the primaries (0.64, 0.33), (0.29, 0.6), "
                 "(0.15, 0.06) and the white (0.3333, 0.3333)");
    assert_true(ki_rec709_from_rgb(&wide, NULL, &a));
    check_colors("PRIMARIES= 0.7 0.3 0.2 0.75 0.14 0.05 0.3127 0.329\n", &a,
                 "colours were converted to Rec. 709 from the primaries (0.7, 0.3), (0.2, 0.75), "
                 "(0.14, 0.05) and the white (0.3127, 0.329)");
    check_colors("FORMAT=32-bit_rle_xyze\n", &xyz,
                 "colours were converted to Rec. 709 from CIE XYZ, whose white is X = Y = Z");
    check_colors("FORMAT= 32-bit_rle_rgbe \n", &one, NULL);
}

static void blanks_may_surround_the_resolution(void **state)
{
    static const char *const lines[] = {"-Y 2 +X 3 ", "  -Y 2 +X 3", "-Y 2\t+X 3\t ",
                                        "-Y   2 +X   3\r", "-Y2+X3"};
    (void)state;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        ki_decoded decoded;
        CHECK_OK(decode("", lines[i], &decoded, NULL));
        assert_int_equal(decoded.image.width, W);
        assert_int_equal(decoded.image.height, H);
        CHECK_NEAR((double)decoded.image.pixels[3 * 5 + 2], value(5, 2), 0);
        ki_decoded_free(&decoded);
    }
}

static void what_cannot_be_honoured_is_refused(void **state)
{
    static const char *const bad[][3] = {
        {"EXPOSURE=abc\n", "-Y 2 +X 3",
         "a.hdr: the HDR header has the line \"EXPOSURE=abc\", which is no usable exposure"},
        {"COLORCORR=1 2\n", "-Y 2 +X 3",
         "a.hdr: the HDR header has the line \"COLORCORR=1 2\", which is no usable colour "
         "correction"},
        {"COLORCORR=1 -2 1\n", "-Y 2 +X 3",
         "a.hdr: the HDR header has the line \"COLORCORR=1 -2 1\", which is no usable colour "
         "correction"},
        {"PRIMARIES=0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3\n", "-Y 2 +X 3",
         "a.hdr: the HDR header has the line \"PRIMARIES=0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3\", which "
         "is no set of primaries that spans its white"},
        {"FORMAT=ascii\n", "-Y 2 +X 3",
         "a.hdr: the HDR format is \"ascii\", kiln reads 32-bit_rle_rgbe and 32-bit_rle_xyze"},
        {"", "-Y 2 +X 3 4",
         "a.hdr: the HDR resolution line is \"-Y 2 +X 3 4\", it must be like \"-Y 512 +X 1024\""},
        {"", "Y 2 X 3",
         "a.hdr: the HDR resolution line is \"Y 2 X 3\", it must be like \"-Y 512 +X 1024\""},
        {"", "-Y\x1b[2J",
         "a.hdr: the HDR resolution line is \"-Y\", it must be like \"-Y 512 +X 1024\""},
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        ki_decoded decoded;
        assert_int_not_equal(decode(bad[i][0], bad[i][1], &decoded, NULL), KILN_OK);
        assert_string_equal(error.message, bad[i][2]);
    }
}

// ------------------------------------------------------------------------------------ run-lengths

static void check_texels(const ki_writer *w, const uint8_t *wanted, int width, int height,
                         const char *text)
{
    ki_decoded decoded;
    CHECK_OK(ki_decode(context, w->bytes, w->size, "a.hdr", &decoded, NULL, &error));
    assert_int_equal(decoded.image.width, width);
    assert_int_equal(decoded.image.height, height);
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)decoded.image.pixels[3 * i + c],
                       wanted[4 * i + c] * ldexp(1, wanted[4 * i + 3] - 136), 0);
    assert_int_equal(decoded.report.note_count, text ? 1 : 0);
    if (text)
        check_note(&decoded.report, 0, KILN_NOTE_CHOICE, false, text);
    ki_decoded_free(&decoded);
}

// Flat pictures whose texels are the marks of new and old run-lengths: (2, 2, width) at the start
// of a line, and (1, 1, 1, n).
static void flat_texels_may_look_like_run_lengths(void **state)
{
    enum { WIDTH = 9, COUNT = 2 * WIDTH };
    uint8_t picture[COUNT][4];
    (void)state;
    for (int old = 0; old < 2; old++) {
        for (int i = 0; i < COUNT; i++)
            memcpy(picture[i], (const uint8_t[4]){(uint8_t)(5 * i), 9, (uint8_t)i, 128}, 4);
        memcpy(picture[old ? 4 : WIDTH],
               old ? (const uint8_t[4]){1, 1, 1, 3} : (const uint8_t[4]){2, 2, 0, WIDTH}, 4);
        ki_writer w = {.context = context};
        ki_write_text(&w, "#?RADIANCE\n\n-Y 2 +X %d\n", WIDTH);
        ki_write(&w, picture, sizeof picture);
        check_texels(&w, picture[0], WIDTH, 2,
                     "texels that look like run-lengths were read as texels, because the file has "
                     "the 72 bytes of a flat picture");
        ki_writer_free(&w);
    }
}

// Lines of 4 texels may have no new runs. A picture whose first texel is (2, 2, 0, 4) is flat if
// the file has the size of a flat picture; with another size the lines are runs.
static void short_lines_are_flat_or_runs(void **state)
{
    static const uint8_t flat[4][4] = {
        {2, 2, 0, 4}, {9, 8, 7, 128}, {6, 5, 4, 128}, {3, 2, 1, 128}};
    static const uint8_t runs[] = {2, 2, 0, 4, 132, 9, 4, 1, 2, 3, 4, 132, 7, 132, 128};
    static const uint8_t held[4][4] = {
        {9, 1, 7, 128}, {9, 2, 7, 128}, {9, 3, 7, 128}, {9, 4, 7, 128}};
    ki_writer w = {.context = context};
    (void)state;
    ki_write_text(&w, "#?RADIANCE\n\n-Y 1 +X 4\n");
    ki_write(&w, flat, sizeof flat);
    check_texels(&w, flat[0], 4, 1, NULL);
    w.size -= sizeof flat;
    ki_write(&w, runs, sizeof runs);
    check_texels(
        &w, held[0], 4, 1,
        "lines of 4 texels were read as run-lengths, which lines of 8 to 32767 texels have");
    ki_writer_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exposure_and_correction_are_divided_out),
        cmocka_unit_test(what_is_ignored_is_said),
        cmocka_unit_test(colors_are_converted_to_rec709),
        cmocka_unit_test(blanks_may_surround_the_resolution),
        cmocka_unit_test(what_cannot_be_honoured_is_refused),
        cmocka_unit_test(flat_texels_may_look_like_run_lengths),
        cmocka_unit_test(short_lines_are_flat_or_runs),
    };
    return cmocka_run_group_tests_name("hdr_header", tests, set_up, tear_down);
}
