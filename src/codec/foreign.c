// Pictures of formats that kiln does not read. In: the first bytes of a file. Out: an error message
// that names the format and a command that converts the file. Each row gives up to two strings and
// the places where the file has them.
#include "codec/foreign.h"

#include <string.h>

// Commands that convert a file with sRGB values, a file with any values, and a JPEG XL file.
static const char from_srgb[] = "oiiotool IN --colorconvert sRGB linear -o OUT.exr";
static const char as_stored[] =
    "oiiotool IN -o OUT.exr, with --colorconvert sRGB linear before -o if its values are sRGB";
static const char by_djxl[] = "djxl IN OUT.png";

typedef struct foreign {
    const char *format, *command;
    const char *first;
    size_t first_count;
    const char *second; // NULL if the format is recognised by one string
    size_t second_at, second_count;
} foreign;

static const foreign rows[] = {
    {"WebP", from_srgb, "RIFF", 4, "WEBP", 8, 4},
    {"AVIF", from_srgb, "\0\0\0", 3, "ftypavif", 4, 8},
    {"AVIF", from_srgb, "\0\0\0", 3, "ftypavis", 4, 8},
    {"HEIC", from_srgb, "\0\0\0", 3, "ftyphe", 4, 6},
    {"HEIF", from_srgb, "\0\0\0", 3, "ftypmif1", 4, 8},
    {"HEIF", from_srgb, "\0\0\0", 3, "ftypmsf1", 4, 8},
    {"TIFF", as_stored, "II*\0", 4, NULL, 0, 0},
    {"TIFF", as_stored, "MM\0*", 4, NULL, 0, 0},
    {"TIFF", as_stored, "II+\0", 4, NULL, 0, 0},
    {"TIFF", as_stored, "MM\0+", 4, NULL, 0, 0},
    {"JPEG XL", by_djxl, "\xff\x0a", 2, NULL, 0, 0},
    {"JPEG XL", by_djxl, "\0\0\0\x0cJXL \r\n\x87\n", 12, NULL, 0, 0},
    {"JPEG 2000", from_srgb, "\0\0\0\x0cjP  \r\n\x87\n", 12, NULL, 0, 0},
    {"Photoshop", as_stored, "8BPS", 4, NULL, 0, 0},
    {"GIF", from_srgb, "GIF8", 4, NULL, 0, 0},
    {"PFM", "oiiotool IN -o OUT.exr", "PF\n", 3, NULL, 0, 0},
};

static bool is_of(const foreign *row, const uint8_t *bytes, size_t size)
{
    return size >= row->first_count && !memcmp(bytes, row->first, row->first_count) &&
           (!row->second || (size >= row->second_at + row->second_count &&
                             !memcmp(bytes + row->second_at, row->second, row->second_count)));
}

kiln_result ki_refuse_foreign(const uint8_t *bytes, size_t size, const char *name,
                              kiln_error *error)
{
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (is_of(&rows[i], bytes, size))
            return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                           "%s: is a %s picture, which kiln does not read; convert it by: %s", name,
                           rows[i].format, rows[i].command);
    return KILN_OK;
}
