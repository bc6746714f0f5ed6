// Files of formats that kiln does not read are named, with a way to convert them. The first bytes
// are those of each format's specification.
#include "codec/codec.h"

#include "kit/context.h"

#define SRGB "oiiotool IN --colorconvert sRGB linear -o OUT.exr"
#define STORED                                                                                     \
    "oiiotool IN -o OUT.exr, with --colorconvert sRGB linear before -o if its values are sRGB"

static void formats_are_recognised_by_their_first_bytes(void **state)
{
    static const struct {
        const char *bytes;
        size_t size;
        const char *format, *command;
    } rows[] = {{"RIFF\x10\0\0\0WEBPVP8 ", 16, "WebP", SRGB},
                {"\0\0\0\x20"
                 "ftypavif\0\0\0\0",
                 16, "AVIF", SRGB},
                {"\0\0\0\x18"
                 "ftypheic\0\0\0\0",
                 16, "HEIC", SRGB},
                {"\0\0\0\x18"
                 "ftypmif1\0\0\0\0",
                 16, "HEIF", SRGB},
                {"II*\0\x08\0\0\0", 8, "TIFF", STORED},
                {"MM\0*\0\0\0\x08", 8, "TIFF", STORED},
                {"II+\0\x08\0\0\0", 8, "TIFF", STORED},
                {"\xff\x0a\xfa\x7f", 4, "JPEG XL", "djxl IN OUT.png"},
                {"\0\0\0\x0cJXL \r\n\x87\n", 12, "JPEG XL", "djxl IN OUT.png"},
                {"8BPS\0\1", 6, "Photoshop", STORED},
                {"GIF89a", 6, "GIF", SRGB},
                {"PF\n2 1\n", 7, "PFM", "oiiotool IN -o OUT.exr"}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char wanted[256];
        ki_decoded decoded;
        kiln_file_info info;
        snprintf(wanted, sizeof wanted,
                 "a: is a %s picture, which kiln does not read; convert it by: %s", rows[i].format,
                 rows[i].command);
        const uint8_t *bytes = (const uint8_t *)rows[i].bytes;
        assert_int_equal(ki_decode(context, bytes, rows[i].size, "a", &decoded, NULL, &error),
                         KILN_ERROR_UNSUPPORTED);
        assert_string_equal(error.message, wanted);
        assert_int_equal(ki_decode(context, bytes, rows[i].size, "a", NULL, &info, &error),
                         KILN_ERROR_UNSUPPORTED);
        assert_string_equal(error.message, wanted);
        // Fewer bytes than the mark are of no known format.
        assert_int_equal(ki_decode(context, bytes, 1, "a", &decoded, NULL, &error),
                         KILN_ERROR_FORMAT);
    }
}

// RIFF and boxes of ISO files that are no pictures stay unknown.
static void other_files_stay_unknown(void **state)
{
    static const char *const others[] = {"RIFF1234WAVEfmt ", "....ftypavif....", "PFx", "II**"};
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        ki_decoded decoded;
        assert_int_equal(ki_decode(context, (const uint8_t *)others[i], strlen(others[i]), "a",
                                   &decoded, NULL, &error),
                         KILN_ERROR_FORMAT);
        CHECK_SAYS(error.message, "bytes do not begin like a file of");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_are_recognised_by_their_first_bytes),
        cmocka_unit_test(other_files_stay_unknown),
    };
    return cmocka_run_group_tests_name("foreign", tests, set_up, tear_down);
}
