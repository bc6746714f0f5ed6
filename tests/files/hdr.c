// Radiance HDR: flat and both run lengths, all orientations, EXPOSURE, and what is written.
#include "codec/codec.h"

#include "kit/context.h"

enum { W = 13, H = 7 };

// A texel of the upright picture: runs in every component.
static void texel(int x, int y, uint8_t rgbe[4])
{
    rgbe[0] = (uint8_t)(x < 5 ? 100 : 100 + x);
    rgbe[1] = (uint8_t)(20 * y);
    rgbe[2] = (uint8_t)(x * y);
    rgbe[3] = (uint8_t)(126 + y % 4);
}

static double value(const uint8_t rgbe[4], int c)
{
    return rgbe[c] * ldexp(1, rgbe[3] - 136);
}

enum coding { FLAT, OLD, NEW };

static void write_line(ki_writer *w, enum coding coding, uint8_t (*line)[4], int count)
{
    if (coding == FLAT) {
        ki_write(w, line, 4 * (size_t)count);
    } else if (coding == OLD) {
        for (int x = 0; x < count;) {
            int run = 1;
            while (x + run < count && !memcmp(line[x], line[x + run], 4))
                run++;
            ki_write(w, line[x], 4);
            if (run > 1)
                ki_write(w, (const uint8_t[4]){1, 1, 1, (uint8_t)(run - 1)}, 4);
            x += run;
        }
    } else {
        ki_write(w, (const uint8_t[4]){2, 2, (uint8_t)(count >> 8), (uint8_t)count}, 4);
        for (int c = 0; c < 4; c++)
            for (int x = 0; x < count;) {
                int run = 1;
                while (x + run < count && line[x + run][c] == line[x][c])
                    run++;
                ki_write_u8(w, (uint8_t)(run > 2 ? 128 + run : 1));
                ki_write_u8(w, line[x][c]);
                x += run > 2 ? run : 1;
            }
    }
}

static void make(ki_writer *w, const char *header, const char *first, const char *second,
                 enum coding coding)
{
    bool columns = first[1] == 'X';
    int lines = columns ? W : H, length = columns ? H : W;
    ki_write_text(w, "#?RADIANCE\n%s\n%s %d %s %d\n", header, first, lines, second, length);
    for (int i = 0; i < lines; i++) {
        uint8_t line[W][4];
        for (int k = 0; k < length; k++) {
            // +Y runs upwards: its place 0 is the lowest row.
            int x = columns ? i : k, y = columns ? k : i;
            const char *xs = columns ? first : second, *ys = columns ? second : first;
            texel(xs[0] == '+' ? x : W - 1 - x, ys[0] == '-' ? y : H - 1 - y, line[k]);
        }
        write_line(w, coding, line, length);
    }
}

static void check_picture(const ki_writer *w, double factor)
{
    ki_decoded decoded;
    kiln_file_info info;
    CHECK_OK(ki_decode(context, w->bytes, w->size, "made.hdr", &decoded, &info, &error));
    assert_int_equal(decoded.image.width, W);
    assert_int_equal(decoded.image.height, H);
    for (int i = 0; i < W * H; i++) {
        uint8_t rgbe[4];
        texel(i % W, i / W, rgbe);
        for (int c = 0; c < 3; c++) {
            double wanted = value(rgbe, c) * factor;
            CHECK_NEAR((double)decoded.image.pixels[3 * i + c], wanted, wanted * 1e-7);
        }
    }
    ki_decoded_free(&decoded);
}

static void all_orientations_and_codings(void **state)
{
    (void)state;
    static const char *const orientations[8][2] = {{"-Y", "+X"}, {"-Y", "-X"}, {"+Y", "+X"},
                                                   {"+Y", "-X"}, {"+X", "-Y"}, {"-X", "-Y"},
                                                   {"+X", "+Y"}, {"-X", "+Y"}};
    for (int o = 0; o < 8; o++)
        for (int coding = FLAT; coding <= NEW; coding++) {
            if (coding == NEW && o >= 4)
                continue; // lines of fewer than eight texels have no new runs
            ki_writer w = {.context = context};
            make(&w, "FORMAT=32-bit_rle_rgbe\n", orientations[o][0], orientations[o][1],
                 (enum coding)coding);
            check_picture(&w, 1);
            ki_writer_free(&w);
        }
}

// Radiance multiplies texels by each EXPOSURE when it is applied: dividing gives radiance back.
static void exposure_is_undone(void **state)
{
    (void)state;
    ki_writer w = {.context = context};
    make(&w, "# a comment\nEXPOSURE=2.5\r\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 4e0\n", "-Y", "+X",
         NEW);
    check_picture(&w, 0.1);
    ki_writer_free(&w);
}

// Old runs of more than 255 texels continue in the next count.
static void old_runs_may_be_long(void **state)
{
    (void)state;
    ki_writer w = {.context = context};
    enum { LONG = 1 + 3 + 2 * 256 };
    ki_write_text(&w, "#?RGBE\n\n-Y 1 +X %d\n", LONG + 1);
    ki_write(&w, (const uint8_t[16]){9, 8, 7, 130, 1, 1, 1, 3, 1, 1, 1, 2, 5, 6, 7, 131}, 16);
    ki_decoded decoded;
    CHECK_OK(ki_decode(context, w.bytes, w.size, "made.hdr", &decoded, NULL, &error));
    const float *pixel = decoded.image.pixels;
    for (int x = 0; x < LONG; x++, pixel += 3)
        CHECK_NEAR((double)*pixel, 9 * ldexp(1, -6), 0);
    CHECK_NEAR((double)*pixel, 5 * ldexp(1, -5), 0);
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

static void refused(const char *text, kiln_result wanted, const char *sentence)
{
    ki_decoded decoded;
    assert_int_equal(
        ki_decode(context, (const uint8_t *)text, strlen(text), "bad.hdr", &decoded, NULL, &error),
        wanted);
    assert_string_equal(error.message, sentence);
}

static void what_is_not_read_is_said(void **state)
{
    (void)state;
    refused("#?RADIANCE\nFORMAT=32-bit_rle_abcd\n\n-Y 1 +X 1\nabcd", KILN_ERROR_UNSUPPORTED,
            "bad.hdr: the HDR format is \"32-bit_rle_abcd\", kiln reads 32-bit_rle_rgbe and "
            "32-bit_rle_xyze");
    refused("#?RADIANCE\n\n-Y 40000 +X 80000\nabcd", KILN_ERROR_UNSUPPORTED,
            "bad.hdr: the picture is 80000 x 40000, the limit is 32768");
    refused("#?RADIANCE\n\n-Y 2 +X 1\nabcd", KILN_ERROR_FORMAT,
            "bad.hdr: line 1 of 2 is damaged, at byte 26");
    refused(
        "#?RADIANCE\n\n-Y 2 +Y 1\nabcd", KILN_ERROR_FORMAT,
        "bad.hdr: the HDR resolution line is \"-Y 2 +Y 1\", it must be like \"-Y 512 +X 1024\"");
    refused("#?RADIANCE\nEXPOSURE=-1\n\n-Y 1 +X 1\nabcd", KILN_ERROR_FORMAT,
            "bad.hdr: the HDR header has the line \"EXPOSURE=-1\", which is no usable exposure");
    refused("#?RADIANCE\n", KILN_ERROR_FORMAT,
            "bad.hdr: the HDR header does not end within the file's 11 bytes");
}

// A byte's mantissa of 128 to 255 is rounded by at most half a step: 1/256 of the largest channel.
static void what_is_written_comes_back(void **state)
{
    (void)state;
    static const int widths[] = {3, 8, 200};
    for (int i = 0; i < 3; i++) {
        int width = widths[i];
        float pixels[200 * 5 * 3];
        for (int k = 0; k < width * 5 * 3; k++)
            pixels[k] = k % 50 < 20 ? 0.25f : ldexpf((float)(k * 37 % 101), k % 40 - 20);
        pixels[0] = 1e38f;
        pixels[4] = -1;
        pixels[5] = NAN;
        pixels[8] = 255.6f; // rounds up to 256, and so to the next exponent
        ki_writer w = {.context = context};
        CHECK_OK(ki_hdr_encode(pixels, width, 5, &w, &error));
        ki_decoded decoded;
        kiln_file_info info;
        CHECK_OK(ki_decode(context, w.bytes, w.size, "back.hdr", &decoded, &info, &error));
        assert_string_equal(info.writer, "kiln 0.2.0");
        assert_string_equal(info.encoding, width < 8 ? "rgbe, uncompressed" : "rgbe, rle");
        for (int k = 0; k < width * 5; k++) {
            double most = 0;
            for (int c = 0; c < 3; c++)
                most = fmax(most, (double)pixels[3 * k + c]);
            for (int c = 0; c < 3; c++) {
                double wanted = fmax(0, (double)pixels[3 * k + c]);
                CHECK_NEAR((double)decoded.image.pixels[3 * k + c], wanted, most / 256);
            }
        }
        ki_decoded_free(&decoded);
        ki_writer_free(&w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_orientations_and_codings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(exposure_is_undone, set_up, tear_down),
        cmocka_unit_test_setup_teardown(old_runs_may_be_long, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_not_read_is_said, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_written_comes_back, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
