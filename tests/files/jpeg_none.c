// A build without libjpeg-turbo describes JPEG files, and says what reads them.
#include "codec/codec.h"

#include "kit/context.h"

static void jpeg_is_refused_with_the_way_out(void **state)
{
    // the marker SOI, a frame of 8 bits, 5 x 7 pixels and 1 component, and the marker EOI
    static const uint8_t bytes[] = {0xff, 0xd8, 0xff, 0xc0, 0,  11, 8,    0,   7,
                                    0,    5,    1,    1,    17, 0,  0xff, 0xd9};
    ki_decoded decoded;
    kiln_file_info info;
    (void)state;
    assert_int_equal(ki_decode(context, bytes, sizeof bytes, "a.jpg", &decoded, NULL, &error),
                     KILN_ERROR_UNSUPPORTED);
    assert_string_equal(error.message,
                        "a.jpg: this build of kiln has no JPEG, which the CMake option KILN_JPEG "
                        "adds; or convert the picture by: oiiotool IN --colorconvert sRGB linear "
                        "-o OUT.exr");
    CHECK_OK(ki_decode(context, bytes, sizeof bytes, "a.jpg", NULL, &info, &error));
    assert_int_equal(info.width, 5);
    assert_int_equal(info.height, 7);
    assert_string_equal(info.encoding, "8 bits grey, srgb");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(jpeg_is_refused_with_the_way_out)};
    return cmocka_run_group_tests_name("jpeg", tests, set_up, tear_down);
}
