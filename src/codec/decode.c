// Which format a file has is told by its first bytes.
#include "codec/codec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *ki_layout_name(int width, int height)
{
    int64_t w = width, h = height;
    if (w == 2 * h)
        return "panorama";
    if (3 * w == 4 * h || 4 * w == 3 * h)
        return "cross";
    if (w == 6 * h || 6 * w == h)
        return "strip";
    return NULL;
}

const char *ki_parse_number(const char *text, double *value)
{
    while (*text == ' ' || *text == '\t')
        text++;
    bool negative = *text == '-';
    text += *text == '-' || *text == '+';
    double mantissa = 0;
    int digits = 0, exponent = 0;
    for (; *text >= '0' && *text <= '9'; text++, digits++)
        mantissa = mantissa * 10 + (*text - '0');
    if (*text == '.')
        for (text++; *text >= '0' && *text <= '9'; text++, digits++, exponent--)
            mantissa = mantissa * 10 + (*text - '0');
    if (!digits || digits > 300)
        return NULL;
    if (*text == 'e' || *text == 'E') {
        const char *at = text + 1;
        bool down = *at == '-';
        at += *at == '-' || *at == '+';
        int power = 0;
        const char *first = at;
        for (; *at >= '0' && *at <= '9' && power < 1000; at++)
            power = power * 10 + (*at - '0');
        if (at > first) {
            exponent += down ? -power : power;
            text = at;
        }
    }
    for (; exponent > 0 && mantissa < 1e300; exponent--)
        mantissa *= 10;
    double divisor = 1;
    for (; exponent < 0 && divisor < 1e300; exponent++)
        divisor *= 10;
    mantissa /= divisor;
    *value = negative ? -mantissa : mantissa;
    return text;
}

// Whatever the program's locale is.
static void write_with_point(ki_writer *writer, char *text)
{
    char *comma = strchr(text, ',');
    if (comma)
        *comma = '.';
    ki_write_text(writer, "%s", text);
}

void ki_write_number(ki_writer *writer, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.9g", value);
    write_with_point(writer, text);
}

void ki_write_float(ki_writer *writer, float value)
{
    char text[40];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value)
            break;
    }
    write_with_point(writer, text);
    if (!strpbrk(text, ".e"))
        ki_write_text(writer, ".0");
}

void ki_describe_table(kiln_file_info *info, const char *text)
{
    size_t i = 0;
    for (; i + 1 < sizeof info->table && text[i] >= ' ' && text[i] <= '~'; i++)
        info->table[i] = text[i];
    info->table[i] = 0;
}

static bool starts(const uint8_t *bytes, size_t size, const char *magic, size_t length)
{
    return size >= length && !memcmp(bytes, magic, length);
}

static void clear_info(kiln_file_info *info, size_t size)
{
    memset(info, 0, sizeof *info);
    info->byte_count = size;
    info->face_count = info->depth = 1;
    for (int k = 0; k < KILN_MAX_LEVELS; k++)
        info->roughness[k] = -1;
}

kiln_result ki_decode(kiln_context *context, const uint8_t *bytes, size_t size, const char *name,
                      ki_decoded *decoded, kiln_file_info *info, kiln_error *error)
{
    if (decoded)
        *decoded = (ki_decoded){0};
    kiln_file_info unused;
    if (!info)
        info = &unused;
    clear_info(info, size);
    kiln_image *image = decoded ? &decoded->image : NULL;
    kiln_map *map = decoded ? &decoded->map : NULL;
    kiln_result result;
    if (starts(bytes, size, "\x76\x2f\x31\x01", 4)) {
        result = ki_exr_decode(context, bytes, size, name, image, info, error);
    } else if (starts(bytes, size, "#?", 2)) {
        result = ki_hdr_decode(context, bytes, size, name, image, info, error);
    } else if (starts(bytes, size, "\x89PNG\r\n\x1a\n", 8)) {
        result = ki_png_decode(context, bytes, size, name, image, info, error);
    } else if (starts(bytes, size, "\xabKTX 20\xbb\r\n\x1a\n", 12)) {
        result = ki_ktx2_decode(context, bytes, size, name, map, image, info, error);
    } else if (starts(bytes, size, "DDS ", 4)) {
        result = ki_dds_decode(context, bytes, size, name, map, info, error);
    } else {
        result =
            ki_fail(error, KILN_ERROR_FORMAT,
                    "%s: its %zu bytes do not begin as EXR, HDR, PNG, KTX2 or DDS do", name, size);
    }
    if (result != KILN_OK) {
        memset(info, 0, sizeof *info);
        if (decoded)
            *decoded = (ki_decoded){0};
        return result;
    }
    bool is_map = info->face_count == 6;
    const char *layout = is_map ? "cube" : ki_layout_name(info->width, info->height);
    if (!info->layout[0]) // unless the file says it
        snprintf(info->layout, sizeof info->layout, "%s", layout ? layout : "image");
    if (decoded) {
        decoded->is_map = is_map;
        decoded->is_table = !strcmp(info->layout, "table");
    }
    return KILN_OK;
}

void ki_decoded_free(ki_decoded *decoded)
{
    kiln_image_free(&decoded->image);
    kiln_map_free(&decoded->map);
    decoded->is_map = decoded->is_table = false;
}
