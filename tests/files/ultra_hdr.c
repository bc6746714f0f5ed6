// Ultra HDR files: the values that are read again, the parts of the file, and a build without JPEG.
#include "codec/ultra_hdr.h"

#include "codec/gain_map.h"
#include "image/pack.h"

#include "kit/context.h"

enum { WIDTH = 256, HEIGHT = 16 };

static ki_writer encode(const kiln_image *image)
{
    ki_writer w = {.context = context};
    CHECK_OK(ki_ultra_hdr_encode(image, "a.jpg", &w, &error));
    return w;
}

static kiln_image make_image(void)
{
    kiln_image image = {.width = WIDTH, .height = HEIGHT, .channels = 3};
    CHECK_OK(ki_image_allocate(context, &image, &error));
    return image;
}

static kiln_image read_again(const ki_writer *w)
{
    kiln_image image;
    kiln_load_report report = {0};
    CHECK_OK(ki_jpeg_decode(context, w->bytes, w->size, "a.jpg", &image, NULL, &report, &error));
    return image;
}

// A ramp of 24 stops around a middle grey, from 6e-5 to 1024 times a colour.
static void a_ramp_keeps_its_values(void **state)
{
    (void)state;
    static const float color[3] = {1, 0.8f, 0.6f};
    kiln_image image = make_image();
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.pixels[i] = color[i % 3] * exp2f(24.0f * (float)(i / 3 % WIDTH) / (WIDTH - 1) - 14);
    ki_writer w = encode(&image);
    kiln_image again = read_again(&w);
    // A JPEG of this quality changes codes of sRGB by 3 at most. Above 0.6 the picture is brighter
    // than 0.36 in its darkest channel, where 3 codes are 4 %.
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        float wanted = image.pixels[i], shown = again.pixels[i];
        float codes = 255 * fabsf(ki_srgb_from_linear(shown) - ki_srgb_from_linear(wanted));
        bool dark = image.pixels[i - i % 3] <= 0.6f;
        if (!(dark ? codes <= 3.01f : fabsf(shown - wanted) < 0.04f * wanted))
            fail_msg("%g became %g", (double)wanted, (double)shown);
    }
    kiln_image_free(&again);
    kiln_image_free(&image);
    ki_writer_free(&w);
}

// White of any radiance, also where its mean is far from a middle grey.
static void one_value_is_kept(void **state)
{
    (void)state;
    static const float values[] = {0, 1e-4f, 0.02f, 0.18f, 0.7f, 1, 40, 30000};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        kiln_image image = make_image();
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
            image.pixels[i] = values[k];
        ki_writer w = encode(&image);
        kiln_image again = read_again(&w);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
            CHECK_NEAR((double)again.pixels[i], (double)values[k], 0.02 * (double)values[k]);
        kiln_image_free(&again);
        kiln_image_free(&image);
        ki_writer_free(&w);
    }
}

static void negative_values_become_black(void **state)
{
    (void)state;
    kiln_image image = make_image();
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.pixels[i] = i % 3 ? -5.0f : 0.5f;
    ki_writer w = encode(&image);
    kiln_image again = read_again(&w);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        CHECK_NEAR((double)again.pixels[i], i % 3 ? 0 : 0.5, 0.01);
    kiln_image_free(&again);
    kiln_image_free(&image);
    ki_writer_free(&w);
}

// The index of pictures, the directory and the numbers of the gain map say where and what things
// are.
static void the_parts_are_where_the_file_says(void **state)
{
    (void)state;
    kiln_image image = make_image();
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.pixels[i] = i / 3 % 7 ? 0.1f : 6.25f;
    ki_writer w = encode(&image);
    ki_jpeg_head head, second;
    ki_span pictures[4];
    ki_gain_map map;
    char length[40];
    CHECK_OK(ki_jpeg_read_head(context, w.bytes, w.size, "a.jpg", &head, &error));
    assert_true(ki_gain_map_announced(&head) && head.pictures.bytes);
    assert_int_equal(ki_jpeg_other_pictures(w.bytes, w.size, &head, pictures, 4), 1);
    assert_ptr_equal(pictures[0].bytes, w.bytes + head.end);
    assert_ptr_equal(pictures[0].bytes + pictures[0].size, w.bytes + w.size);
    snprintf(length, sizeof length, "Item:Length=\"%zu\"", pictures[0].size);
    char *xmp = test_malloc(head.xmp.size + 1);
    memcpy(xmp, head.xmp.bytes, head.xmp.size);
    xmp[head.xmp.size] = 0;
    assert_non_null(strstr(xmp, length));
    test_free(xmp);
    CHECK_OK(
        ki_jpeg_read_head(context, pictures[0].bytes, pictures[0].size, "a.jpg", &second, &error));
    assert_int_equal(second.components, 1);
    assert_true(second.width == WIDTH && second.height == HEIGHT);
    assert_true(ki_gain_map_read(&second, &map));
    for (int c = 0; c < 3; c++) {
        // The largest value, 6.25, is shown as less than 0.95.
        assert_true(map.low[c] == 0 && map.high[c] > 2.7 && map.high[c] < 3);
        assert_true(map.base_offset[c] == 0 && map.other_offset[c] == 0 && map.gamma[c] == 1);
    }
    assert_true(map.base_headroom == 0 && map.other_headroom == map.high[0]);
    kiln_image_free(&image);
    ki_writer_free(&w);
}

static void a_build_without_jpeg_says_the_way_out(void **state)
{
    (void)state;
    kiln_image image = make_image();
    ki_writer w = {.context = context};
    assert_int_equal(ki_ultra_hdr_encode(&image, "a.jpg", &w, &error), KILN_ERROR_UNSUPPORTED);
    assert_string_equal(error.message,
                        "a.jpg: this build of kiln has no JPEG, which the CMake option KILN_JPEG "
                        "adds; or write an .hdr panorama by: kiln bake IN --shape panorama "
                        "--roughness 0 -o NAME.hdr");
    kiln_image_free(&image);
    ki_writer_free(&w);
}

int main(void)
{
    const struct CMUnitTest with[] = {cmocka_unit_test(a_ramp_keeps_its_values),
                                      cmocka_unit_test(one_value_is_kept),
                                      cmocka_unit_test(negative_values_become_black),
                                      cmocka_unit_test(the_parts_are_where_the_file_says)};
    const struct CMUnitTest without[] = {cmocka_unit_test(a_build_without_jpeg_says_the_way_out)};
    return KILN_TEST_JPEG ? cmocka_run_group_tests_name("ultra_hdr", with, set_up, tear_down)
                          : cmocka_run_group_tests_name("ultra_hdr", without, set_up, tear_down);
}
