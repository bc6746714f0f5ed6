// OpenEXR files as they are read: what OpenEXRCore writes in every compression, windows, channels,
// strange values, and what cannot be read is said. Threads do not matter, and memory is little more
// than the picture.
#include "codec/codec.h"
#include "exr_make.h"
#include "image/pack.h"

#include <float.h>

#include "kit/context.h"

// Smooth with some noise below, different for every channel, never negative.
static float ramp(int x, int y, const char *channel)
{
    uint32_t noise = ((uint32_t)x * 7919U + (uint32_t)y * 104729U + (uint32_t)channel[0]) % 61U;
    return (float)(channel[strlen(channel) - 1] - 'A') + 0.125f * (float)x + 0.25f * (float)y +
           (float)noise / 256 + 64;
}

static const exr_make_channel half_rgb[3] = {{"B", EXR_PIXEL_HALF, 0, false},
                                             {"G", EXR_PIXEL_HALF, 0, false},
                                             {"R", EXR_PIXEL_HALF, 0, false}};

static const exr_make_channel float_rgb[3] = {{"B", EXR_PIXEL_FLOAT, 0, false},
                                              {"G", EXR_PIXEL_FLOAT, 0, false},
                                              {"R", EXR_PIXEL_FLOAT, 0, false}};

static const exr_make_channel mixed_rgb[4] = {{"A", EXR_PIXEL_UINT, 0, false},
                                              {"B", EXR_PIXEL_HALF, 0, false},
                                              {"G", EXR_PIXEL_FLOAT, 0, false},
                                              {"R", EXR_PIXEL_UINT, 0, false}};

static kiln_image decode(const exr_make *make, kiln_file_info *info)
{
    size_t size;
    uint8_t *bytes = exr_make_file(make, &size);
    ki_decoded decoded;
    CHECK_OK(ki_decode(context, bytes, size, "made.exr", &decoded, info, &error));
    assert_false(decoded.is_map);
    free(bytes);
    return decoded.image;
}

static float stored(float value, exr_pixel_type_t type)
{
    if (type == EXR_PIXEL_HALF)
        return ki_float_from_half(ki_half_from_float(value));
    return type == EXR_PIXEL_UINT ? (float)(uint32_t)value : value;
}

// Every texel against what was written, relative bounds.
static void check_ramp(const kiln_image *image, const exr_make *make, double bound)
{
    static const char *const names[3] = {"R", "G", "B"};
    assert_int_equal(image->channels, 3);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) {
                const exr_make_channel *from = NULL;
                for (int i = 0; i < make->channel_count; i++)
                    if (!strcmp(make->channels[i].name, names[c]))
                        from = &make->channels[i];
                float wanted =
                    from ? stored(ramp(x + make->x, y + make->y, names[c]), from->type) : 0;
                float got = image->pixels[3 * (y * image->width + x) + c];
                if (!(fabs((double)got - (double)wanted) <= bound * (double)wanted))
                    fail_msg("%s of (%d, %d) in %d x %d, compression %d, tiles %d: %g, not %g",
                             names[c], x, y, image->width, image->height, (int)make->compression,
                             make->tile_width, (double)got, (double)wanted);
            }
}

static void check_compression(exr_compression_t compression, const exr_make_channel *channels,
                              int count, double bound)
{
    static const int sizes[][2] = {{1, 1}, {37, 70}, {64, 3}, {300, 31}};
    // A single texel grows by B44, which OpenEXRCore then writes but cannot read.
    bool b44 = compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A;
    for (size_t i = b44; i < sizeof sizes / sizeof *sizes; i++)
        for (int tiled = 0; tiled < 2; tiled++) {
            exr_make make = {.width = sizes[i][0],
                             .height = sizes[i][1],
                             .compression = compression,
                             .tile_width = tiled ? 20 : 0,
                             .tile_height = tiled ? 12 : 0,
                             .channels = channels,
                             .channel_count = count,
                             .value = ramp};
            kiln_file_info info;
            kiln_image image = decode(&make, &info);
            assert_int_equal(info.width, make.width);
            assert_int_equal(info.height, make.height);
            check_ramp(&image, &make, bound);
            kiln_image_free(&image);
        }
}

static void lossless_compressions_come_back(void **state)
{
    (void)state;
    static const exr_compression_t lossless[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                                 EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                                 EXR_COMPRESSION_PIZ};
    for (size_t i = 0; i < sizeof lossless / sizeof *lossless; i++) {
        check_compression(lossless[i], half_rgb, 3, 0);
        check_compression(lossless[i], float_rgb, 3, 0);
        check_compression(lossless[i], mixed_rgb, 4, 0);
    }
}

// PXR24 keeps halfs and integers, and 15 bits of a float's mantissa. B44 keeps floats
// and integers; of halfs, 6 bits of the differences within 4 x 4 texels.
static void lossy_compressions_come_back_near(void **state)
{
    (void)state;
    check_compression(EXR_COMPRESSION_PXR24, half_rgb, 3, 0);
    check_compression(EXR_COMPRESSION_PXR24, float_rgb, 3, 1.0 / (1 << 15));
    check_compression(EXR_COMPRESSION_PXR24, mixed_rgb, 4, 1.0 / (1 << 15));
    check_compression(EXR_COMPRESSION_B44, mixed_rgb, 4, 1.0 / 64);
    check_compression(EXR_COMPRESSION_B44, half_rgb, 3, 1.0 / 64);
    check_compression(EXR_COMPRESSION_B44A, half_rgb, 3, 1.0 / 64);
}

static void load_pair(const char *name, kiln_image *image, kiln_image *wanted)
{
    char path[512];
    snprintf(path, sizeof path, KILN_GOOD_FILES "/%s.exr", name);
    CHECK_OK(kiln_image_load(context, path, image, &error));
    snprintf(path, sizeof path, KILN_GOOD_FILES "/%s-plain.exr", name);
    CHECK_OK(kiln_image_load(context, path, wanted, &error));
    assert_int_equal(image->width, wanted->width);
    assert_int_equal(image->height, wanted->height);
}

// OpenEXR's own decoder wrote the plain files. A transformed value is rounded to a half twice, so
// that a last bit may turn on the order of a sum: 1/256 relative, for few samples.
static void dwa_is_what_the_reference_decodes(void **state)
{
    (void)state;
    static const char *const names[] = {"dwaa-half", "dwab-float", "dwaa-layers"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        kiln_image image, wanted;
        load_pair(names[i], &image, &wanted);
        int count = 3 * image.width * image.height, differing = 0;
        double sum = 0;
        for (int k = 0; k < count; k++) {
            double got = (double)image.pixels[k], want = (double)wanted.pixels[k];
            CHECK_NEAR(got, want, fabs(want) / 256 + 1e-6);
            differing += got != want;
            sum += want;
        }
        CHECK_BELOW((double)differing / count, 0.01);
        CHECK_BELOW(1e-3, sum / count); // they are not all black
        kiln_image_free(&image);
        kiln_image_free(&wanted);
    }
}

static void check_refused(const exr_make *make, kiln_result wanted, const char *sentence)
{
    size_t size;
    uint8_t *bytes = exr_make_file(make, &size);
    ki_decoded decoded;
    assert_int_equal(ki_decode(context, bytes, size, "made.exr", &decoded, NULL, &error), wanted);
    assert_null(decoded.image.pixels);
    assert_string_equal(error.message, sentence);
    free(bytes);
}

// Rip levels halve width and height independently. OpenEXRCore 3.1.5 cannot write such levels, and
// the files are from OpenEXR's C++ library, as the plain files are. Each level but the first holds
// the value 9. The files stand in a folder of their own: cut in a later level, which is not read,
// they are still read.
static void the_first_rip_level_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double bound; // relative; a value of DWA is rounded to a half twice
    } files[] = {{"../levels/rip-zip", 0}, {"../levels/rip-dwaa", 1.0 / 256}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        kiln_image image, wanted;
        load_pair(files[i].name, &image, &wanted);
        assert_int_equal(image.width, 37);
        assert_int_equal(image.height, 30);
        CHECK_NEAR((double)wanted.pixels[0], 0.5, 0.5 / 64);
        for (int k = 0; k < 3 * image.width * image.height; k++)
            CHECK_NEAR((double)image.pixels[k], (double)wanted.pixels[k],
                       files[i].bound * (double)wanted.pixels[k]);
        kiln_image_free(&image);
        kiln_image_free(&wanted);
    }
}

static void the_display_window_is_the_picture(void **state)
{
    (void)state;
    // The data begins left of and above the display window and ends inside it.
    exr_make make = {.width = 30,
                     .height = 40,
                     .x = -8,
                     .y = -11,
                     .display = {{{{-3, 2}}}, {{{40, 50}}}},
                     .compression = EXR_COMPRESSION_ZIP,
                     .channels = half_rgb,
                     .channel_count = 3,
                     .value = ramp};
    for (int tiled = 0; tiled < 2; tiled++) {
        make.tile_width = make.tile_height = 16 * tiled;
        kiln_image image = decode(&make, NULL);
        assert_int_equal(image.width, 44);
        assert_int_equal(image.height, 49);
        for (int y = 0; y < image.height; y++)
            for (int x = 0; x < image.width; x++) {
                int fx = x - 3, fy = y + 2;
                bool inside = fx < make.x + make.width && fy < make.y + make.height;
                float wanted = inside ? stored(ramp(fx, fy, "G"), EXR_PIXEL_HALF) : 0;
                assert_true(image.pixels[3 * (y * image.width + x) + 1] == wanted);
            }
        kiln_image_free(&image);
    }
    // No overlap at all is refused.
    make.display = (exr_attr_box2i_t){{{{100, 100}}}, {{{103, 101}}}};
    make.tile_width = make.tile_height = 0;
    check_refused(&make, KILN_ERROR_FORMAT,
                  "made.exr: none of the 8 pixels of its display window lies in its data window");
}

static void pixels_outside_the_data_window_are_counted(void **state)
{
    (void)state;
    exr_make make = {.width = 20,
                     .height = 8,
                     .x = 6,
                     .y = 4,
                     .display = {{{{0, 0}}}, {{{31, 15}}}},
                     .compression = EXR_COMPRESSION_ZIP,
                     .channels = half_rgb,
                     .channel_count = 3,
                     .value = ramp};
    size_t size;
    uint8_t *bytes = exr_make_file(&make, &size);
    kiln_load_report report;
    kiln_load_def def = {.report = &report};
    kiln_note note;
    kiln_map map;
    CHECK_OK(kiln_map_decode(context, bytes, size, "made.exr", &def, &map, &error));
    assert_int_equal(report.missing_count, 32 * 16 - 20 * 8);
    assert_true(kiln_load_report_note(&report, 0, &note));
    assert_true(note.warning);
    assert_string_equal(note.text,
                        "352 of 512 texels are outside the file's data window and black");
    assert_false(kiln_load_report_note(&report, 1, &note));
    kiln_map_free(&map);
    free(bytes);
}

static void missing_and_extra_channels(void **state)
{
    (void)state;
    static const exr_make_channel red_only[] = {{"R", EXR_PIXEL_HALF, 0, false},
                                                {"Z", EXR_PIXEL_FLOAT, 0, false}};
    static const exr_make_channel grey[] = {{"Y", EXR_PIXEL_FLOAT, 0, false}};
    static const exr_make_channel layer[] = {{"A", EXR_PIXEL_HALF, 0, false},
                                             {"beauty.B", EXR_PIXEL_HALF, 0, false},
                                             {"beauty.G", EXR_PIXEL_HALF, 0, false},
                                             {"beauty.R", EXR_PIXEL_HALF, 0, false}};
    // A channel of a quarter of the samples lies between the others.
    static const exr_make_channel sampled[] = {{"A", EXR_PIXEL_HALF, 2, false},
                                               {"B", EXR_PIXEL_HALF, 0, false},
                                               {"G", EXR_PIXEL_HALF, 0, false},
                                               {"R", EXR_PIXEL_HALF, 0, false}};
    exr_make make = {.width = 24,
                     .height = 20,
                     .compression = EXR_COMPRESSION_ZIP,
                     .channels = red_only,
                     .channel_count = 2,
                     .value = ramp};
    kiln_image image = decode(&make, NULL);
    check_ramp(&image, &make, 0);
    kiln_image_free(&image);

    make.channels = grey;
    make.channel_count = 1;
    kiln_file_info info;
    image = decode(&make, &info);
    for (int i = 0; i < 24 * 20; i++)
        for (int c = 0; c < 3; c++)
            assert_true(image.pixels[3 * i + c] == ramp(i % 24, i / 24, "Y"));
    assert_string_equal(info.encoding, "float grey, zip");
    kiln_image_free(&image);

    make.channels = layer;
    make.channel_count = 4;
    image = decode(&make, NULL);
    const float *pixel = image.pixels;
    for (int i = 0; i < 24 * 20; i++, pixel += 3)
        assert_true(*pixel == stored(ramp(i % 24, i / 24, "beauty.R"), EXR_PIXEL_HALF));
    kiln_image_free(&image);

    static const exr_compression_t both[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_ZIP};
    for (int i = 0; i < 2; i++) {
        make.compression = both[i];
        make.channels = sampled;
        image = decode(&make, NULL);
        check_ramp(&image, &make, 0);
        kiln_image_free(&image);
    }

    // The second part is the first with colour.
    make.channels = half_rgb;
    make.channel_count = 3;
    make.part_count = 2;
    image = decode(&make, NULL);
    check_ramp(&image, &make, 0);
    kiln_image_free(&image);
}

static float strange(int x, int y, const char *channel)
{
    (void)y;
    (void)channel;
    const float values[4] = {NAN, -1, INFINITY, -INFINITY};
    return values[x];
}

// Decoders keep every value; ki_map_mend replaces those that are no radiance.
static void strange_values_are_kept(void **state)
{
    (void)state;
    exr_make make = {.width = 4,
                     .height = 1,
                     .compression = EXR_COMPRESSION_NONE,
                     .channels = half_rgb,
                     .channel_count = 3,
                     .value = strange};
    const exr_make_channel *const channels[] = {half_rgb, float_rgb};
    for (int k = 0; k < 2; k++) {
        make.channels = channels[k];
        kiln_image image = decode(&make, NULL);
        for (int c = 0; c < 3; c++) {
            assert_true(isnan(image.pixels[c]));
            assert_true(image.pixels[3 + c] == -1);
            assert_true(image.pixels[6 + c] == INFINITY);
            assert_true(image.pixels[9 + c] == -INFINITY);
        }
        kiln_image_free(&image);
    }
}

static void what_is_not_read_is_said(void **state)
{
    (void)state;
    static const exr_make_channel depth[] = {{"Z", EXR_PIXEL_FLOAT, 0, false}};
    static const exr_make_channel chroma[] = {{"BY", EXR_PIXEL_HALF, 4, false},
                                              {"RY", EXR_PIXEL_HALF, 2, false},
                                              {"Y", EXR_PIXEL_HALF, 0, false}};
    static const exr_make_channel sampled[] = {{"R", EXR_PIXEL_HALF, 2, false},
                                               {"Z", EXR_PIXEL_HALF, 0, false}};
    exr_make make = {.width = 8,
                     .height = 4,
                     .compression = EXR_COMPRESSION_NONE,
                     .channels = depth,
                     .channel_count = 1,
                     .value = ramp};
    check_refused(&make, KILN_ERROR_UNSUPPORTED,
                  "made.exr: has no channel R, G, B or Y; its channels are Z; --layer CHANNEL "
                  "reads one of them as grey");
    // Chroma has either a sample for each pixel or one for 2 x 2 pixels, in both channels alike.
    make.channels = chroma;
    make.channel_count = 3;
    check_refused(&make, KILN_ERROR_UNSUPPORTED,
                  "made.exr: channel BY has one sample for 4 x 4 pixels, kiln reads one sample for "
                  "each pixel only, or one for 2 x 2 pixels in both RY and BY");
    make.channels = sampled;
    make.channel_count = 2;
    check_refused(&make, KILN_ERROR_UNSUPPORTED,
                  "made.exr: channel R has one sample for 2 x 2 pixels, kiln reads one sample for "
                  "each pixel only, or one for 2 x 2 pixels in both RY and BY");
    make.channels = half_rgb;
    make.channel_count = 3;
    make.display = (exr_attr_box2i_t){{{{0, 0}}}, {{{69999, 34999}}}};
    check_refused(&make, KILN_ERROR_UNSUPPORTED,
                  "made.exr: displayWindow is 70000 x 35000, the limit is 32768");
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    kiln_image images[2];
    kiln_context *contexts[2];
    for (int i = 0; i < 2; i++) {
        contexts[i] = make_context(i ? 7 : 1);
        CHECK_OK(
            kiln_image_load(contexts[i], KILN_GOOD_FILES "/dwab-float.exr", &images[i], &error));
    }
    assert_int_equal(images[0].width, images[1].width);
    assert_int_equal(images[0].height, images[1].height);
    assert_memory_equal(images[0].pixels, images[1].pixels,
                        sizeof(float) * 3 * (size_t)images[0].width * (size_t)images[0].height);
    for (int i = 0; i < 2; i++) {
        kiln_image_free(&images[i]);
        kiln_context_destroy(contexts[i]);
    }
}

// 8192 x 4096 half floats: the picture itself, 384 MiB, and little more.
static void memory_is_the_picture(void **state)
{
    (void)state;
    enum { WIDE = 8192, HIGH = 4096 };
    ki_writer w = {.context = context};
    float *pixels = ki_alloc(context, (size_t)WIDE * HIGH, 3 * sizeof(float));
    assert_non_null(pixels);
    ki_exr_options options = {.half = true, .roughness = -1};
    CHECK_OK(ki_exr_encode(pixels, WIDE, HIGH, 3, &options, &w, &error));
    ki_free(pixels);
    kiln_context *fresh = make_context(2);
    kiln_map map;
    CHECK_OK(kiln_map_decode(fresh, w.bytes, w.size, "large.exr", NULL, &map, &error));
    size_t peak;
    kiln_context_memory(fresh, NULL, &peak);
    size_t picture = (size_t)WIDE * HIGH * 3 * sizeof(float);
    CHECK_BELOW((double)peak, (double)picture + (16 << 20));
    kiln_map_free(&map);
    kiln_context_destroy(fresh);
    ki_writer_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(lossless_compressions_come_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lossy_compressions_come_back_near, set_up, tear_down),
        cmocka_unit_test_setup_teardown(dwa_is_what_the_reference_decodes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_first_rip_level_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_display_window_is_the_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(pixels_outside_the_data_window_are_counted, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(missing_and_extra_channels, set_up, tear_down),
        cmocka_unit_test_setup_teardown(strange_values_are_kept, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_not_read_is_said, set_up, tear_down),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test_setup_teardown(memory_is_the_picture, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
