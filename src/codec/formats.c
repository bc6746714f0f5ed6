// The table of file formats, one row for each, and its lookups: the reader for some bytes by the
// first of these bytes, and the writer and limits for a path by its ending. In: bytes or a path.
// Out: decoded texels, encoded files, or the row of a format.
#include "codec/formats.h"

#include "base/file.h"
#include "codec/cesium_sh.h"
#include "codec/env.h"
#include "codec/file_info.h"
#include "codec/foreign.h"
#include "codec/galacean_env.h"
#include "codec/gltf.h"
#include "codec/ktx1.h"
#include "codec/layout.h"
#include "codec/pixel_format.h"
#include "codec/png.h"
#include "codec/png_text.h"
#include "codec/rgbx_png.h"
#include "codec/sh_describe.h"
#include "codec/zstd.h"
#include "image/pack.h"

#include <stdio.h>
#include <string.h>

// ---------------------------------------------------------------------------------------- pictures

static kiln_result write_exr(const kiln_image *image, const ki_picture_about *about, ki_writer *w,
                             kiln_error *error)
{
    const ki_exr_options options = {.half = about->radiance && about->format != KILN_FORMAT_RGBA32F,
                                    .panorama = about->panorama,
                                    .octahedron = about->octahedron,
                                    .roughness = about->roughness};
    return ki_exr_encode(image->pixels, image->width, image->height, image->channels, &options, w,
                         error);
}

static kiln_result write_hdr(const kiln_image *image, const ki_picture_about *about, ki_writer *w,
                             kiln_error *error)
{
    (void)about;
    return ki_hdr_encode(image->pixels, image->width, image->height, w, error);
}

static kiln_result read_png(kiln_context *context, const uint8_t *bytes, size_t size,
                            const char *name, kiln_image *image, kiln_file_info *info,
                            kiln_load_report *report, kiln_error *error)
{
    kiln_result result = ki_png_decode(context, bytes, size, name, image, info, report, error);
    if (result == KILN_OK)
        ki_png_read_texts(bytes, size, info);
    return result;
}

static kiln_result write_png(const kiln_image *image, const ki_picture_about *about, ki_writer *w,
                             kiln_error *error)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(about->format);
    if (pixel && pixel->rgbx) {
        size_t start = w->size;
        kiln_result result = ki_rgbx_png_encode(image, pixel->rgbx, false, w, error);
        if (result == KILN_OK)
            ki_png_add_text(w, start, KI_PNG_TEXELS_KEY, ki_format_names[about->format]);
        return result == KILN_OK && w->failed ? ki_fail_memory(w->context, error, "a PNG", w->size)
                                              : result;
    }
    return ki_png_encode(image->pixels, image->width, image->height, image->channels,
                         about->radiance ? KI_PNG_SRGB8 : KI_PNG_PLAIN8, w, error);
}

// ------------------------------------------------------------------------------------------- table

#define PIXELS(name) (1U << KILN_FORMAT_##name)
#define TABLES(name) (1U << KILN_TABLE_FORMAT_##name)

enum {
    GPU_FORMATS =
        PIXELS(RGBA16F) | PIXELS(RGBA32F) | PIXELS(RGB9E5) | PIXELS(B10G11R11) | PIXELS(BC6H),
    PLAIN_TABLES = TABLES(F32) | TABLES(F16) | TABLES(U16) | TABLES(U8),
    PICTURES = KI_HOLDS_PICTURE | KI_HOLDS_TABLE,
};

static const ki_file_format formats[] = {
    {.name = "ktx2",
     .endings = {".ktx2"},
     .first = "\xabKTX 20\xbb\r\n\x1a\n",
     .first_count = 12,
     .holds = KI_HOLDS_CUBE | KI_HOLDS_TABLE,
     .pixel_formats = GPU_FORMATS | PIXELS(UASTC),
     .table_formats = PLAIN_TABLES,
     .table_format = KILN_TABLE_FORMAT_F16,
     .zstd = true,
     .limit = KI_HALF_MAX,
     .read = ki_ktx2_decode,
     .write_cube = ki_ktx2_encode},
    {.name = "dds",
     .endings = {".dds"},
     .first = "DDS ",
     .first_count = 4,
     .holds = KI_HOLDS_CUBE,
     .pixel_formats = GPU_FORMATS,
     .limit = KI_HALF_MAX,
     .read = ki_dds_decode,
     .write_cube = ki_dds_encode},
    {.name = "exr",
     .endings = {".exr"},
     .first = "\x76\x2f\x31\x01",
     .first_count = 4,
     .holds = PICTURES,
     .pixel_formats = PIXELS(RGBA16F) | PIXELS(RGBA32F),
     .table_formats = TABLES(F32) | TABLES(F16),
     .table_format = KILN_TABLE_FORMAT_F32,
     .limit = KI_HALF_MAX,
     .read_layer = ki_exr_decode,
     .write_picture = write_exr},
    {.name = "hdr",
     .endings = {".hdr"},
     .first = "#?",
     .first_count = 2,
     .holds = PICTURES,
     .table_format = KILN_TABLE_FORMAT_F32,
     .read_picture = ki_hdr_decode,
     .write_picture = write_hdr},
    {.name = "png",
     .endings = {".png"},
     .first = "\x89PNG\r\n\x1a\n",
     .first_count = 8,
     .holds = PICTURES,
     .pixel_formats = PIXELS(RGBM) | PIXELS(RGBD) | PIXELS(RGBP),
     .table_formats = TABLES(U16) | TABLES(U8) | TABLES(RGBD),
     .table_format = KILN_TABLE_FORMAT_U16,
     .limit = 1,
     .read_picture = read_png,
     .write_picture = write_png},
    {.name = "jpeg",
     .endings = {".jpg", ".jpeg"},
     .holds = KI_READS_PICTURE,
     .first = "\xff\xd8\xff",
     .first_count = 3,
     .read_picture = ki_jpeg_decode},
    {.name = "ktx1",
     .endings = {".ktx"},
     .first = "\xabKTX 11\xbb\r\n\x1a\n",
     .first_count = 12,
     .read = ki_ktx1_decode},
    {.name = "env",
     .endings = {".env"},
     .first = "\x86\x16\x87\x96\xf6\xd6\x96\x36",
     .first_count = 8,
     .describe = ki_env_describe},
    {.name = "glb",
     .endings = {".glb"},
     .first = "glTF",
     .first_count = 4,
     .describe = ki_gltf_describe},
    {.name = "json",
     .endings = {".json"},
     .begins = ki_sh_json_begins,
     .holds = KI_HOLDS_SH,
     .describe = ki_sh_json_describe},
    {.name = "cesium json",
     .endings = {".json"},
     .begins = ki_cesium_sh_begins,
     .describe = ki_cesium_sh_describe},
    {.name = "text",
     .endings = {".txt"},
     .begins = ki_sh_lines_begin,
     .holds = KI_HOLDS_SH,
     .describe = ki_sh_lines_describe},
    {.name = "raw",
     .endings = {".raw", ".bin"},
     .holds = KI_HOLDS_TABLE,
     .table_formats = PLAIN_TABLES,
     .table_format = KILN_TABLE_FORMAT_F32},
    {.name = "c",
     .endings = {".h"},
     .begins = ki_sh_array_begins,
     .describe = ki_sh_array_describe,
     .holds = KI_HOLDS_TABLE | KI_HOLDS_SH | KI_HOLDS_CODE,
     .table_formats = TABLES(F32),
     .table_format = KILN_TABLE_FORMAT_F32},
    {.name = "inc",
     .endings = {".inc"},
     .holds = KI_HOLDS_TABLE,
     .table_formats = TABLES(F16),
     .table_format = KILN_TABLE_FORMAT_F16},
    {.name = "glsl",
     .endings = {".glsl"},
     .holds = KI_HOLDS_TABLE | KI_HOLDS_CODE,
     .table_formats = PLAIN_TABLES,
     .table_format = KILN_TABLE_FORMAT_F32},
    // Files without magic bytes, which are recognised by their length.
    {.name = "galacean env",
     .endings = {".env"},
     .begins = ki_galacean_env_begins,
     .describe = ki_galacean_env_describe},
};

enum { FORMATS = sizeof formats / sizeof *formats };

// ----------------------------------------------------------------------------------------- endings

static const ki_file_format *find(const char *path, const char **ending)
{
    for (int i = 0; i < FORMATS; i++)
        for (int k = 0; formats[i].endings[k]; k++)
            if (ki_ends_with(path, formats[i].endings[k])) {
                *ending = formats[i].endings[k];
                return &formats[i];
            }
    *ending = "";
    return NULL;
}

const ki_file_format *ki_file_format_of_path(const char *path)
{
    const char *ending;
    return find(path, &ending);
}

kiln_result ki_check_zstd(const char *path, const ki_file_format *file, int level,
                          kiln_error *error)
{
    if (level < 0 || level > 22)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "zstd is %d, it must be 0 to 22", level);
    if (level && !file->zstd)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: only .ktx2 files are compressed by zstd",
                       path);
    return level ? ki_zstd_known(path, error) : KILN_OK;
}

const char *kiln_path_ending(const char *path)
{
    const char *ending;
    find(path, &ending);
    return ki_ends_with(path, "/") ? "/" : ending;
}

// Joins a list of endings to text, with spaces between them and `last`, for example " or ", before
// the last ending.
static const char *join(const char *const *list, int count, const char *last,
                        char text[KI_ENDINGS_TEXT])
{
    text[0] = 0;
    for (int i = 0; i < count; i++) {
        size_t length = strlen(text);
        const char *between = !i ? "" : i < count - 1 ? " " : last;
        snprintf(text + length, KI_ENDINGS_TEXT - length, "%s%s", between, list[i]);
    }
    return text;
}

const char *ki_list_endings(unsigned holds, const char *more, char text[KI_ENDINGS_TEXT])
{
    const char *list[3 * FORMATS];
    int count = 0;
    for (int i = 0; i < FORMATS; i++)
        for (int k = 0; ki_file_holds(&formats[i], holds) && formats[i].endings[k]; k++)
            list[count++] = formats[i].endings[k];
    if (more)
        list[count++] = more;
    return join(list, count, " or ", text);
}

const char *ki_list_endings_of_format(kiln_format format, char text[KI_ENDINGS_TEXT])
{
    const char *list[FORMATS];
    int count = 0;
    for (int i = 0; i < FORMATS; i++)
        if (formats[i].pixel_formats & 1U << format)
            list[count++] = formats[i].endings[0];
    return join(list, count, " and ", text);
}

// ----------------------------------------------------------------------------------------- reading

static bool begins(const ki_file_format *format, const uint8_t *bytes, size_t size)
{
    size_t count = (size_t)format->first_count;
    if (format->begins)
        return format->begins(bytes, size);
    return format->first && size >= count && !memcmp(bytes, format->first, count);
}

static const ki_file_format *find_bytes(const uint8_t *bytes, size_t size)
{
    for (int i = 0; i < FORMATS; i++)
        if (begins(&formats[i], bytes, size))
            return &formats[i];
    return NULL;
}

static kiln_result read_bytes(kiln_context *context, const uint8_t *bytes, size_t size,
                              const char *name, const char *layer, ki_decoded *decoded,
                              kiln_file_info *info, kiln_error *error)
{
    const ki_file_format *format = find_bytes(bytes, size);
    if (!format && ki_refuse_foreign(bytes, size, name, error))
        return KILN_ERROR_UNSUPPORTED;
    if (!format)
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "%s: its %zu bytes do not begin like a file of EXR, HDR, PNG, JPEG, KTX2, KTX or DDS",
            name, size);
    if (layer && !format->read_layer)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is a %s file, which has no layers, leave out --layer %.64s", name,
                       format->name, layer);
    if (format->describe && decoded)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is a %s file, which kiln writes and describes but does not read", name,
                       format->endings[0]);
    kiln_load_report *report = decoded ? &decoded->report : &info->report;
    if (format->describe)
        return format->describe(context, bytes, size, name, info, error);
    if (format->read)
        return format->read(context, bytes, size, name, decoded, info, error);
    if (format->read_layer)
        return format->read_layer(context, bytes, size, name, layer,
                                  decoded ? &decoded->image : NULL, info, report, error);
    return format->read_picture(context, bytes, size, name, decoded ? &decoded->image : NULL, info,
                                report, error);
}

kiln_result ki_decode(kiln_context *context, const uint8_t *bytes, size_t size, const char *name,
                      ki_decoded *decoded, kiln_file_info *info, kiln_error *error)
{
    return ki_decode_layer(context, bytes, size, name, NULL, decoded, info, error);
}

kiln_result ki_decode_layer(kiln_context *context, const uint8_t *bytes, size_t size,
                            const char *name, const char *layer, ki_decoded *decoded,
                            kiln_file_info *info, kiln_error *error)
{
    kiln_file_info unused = {0};
    info = info ? info : &unused;
    if (decoded)
        *decoded = (ki_decoded){0};
    ki_file_info_clear(info, size);
    kiln_result result = read_bytes(context, bytes, size, name, layer, decoded, info, error);
    if (result != KILN_OK) {
        memset(info, 0, sizeof *info);
        if (decoded)
            *decoded = (ki_decoded){0};
        return result;
    }
    bool is_map = info->face_count == 6;
    const char *layout = is_map ? "cube" : ki_layout_name(info->width, info->height);
    if (!info->layout[0]) // such a file does not state the layout of its picture
        snprintf(info->layout, sizeof info->layout, "%s", layout ? layout : "image");
    if (decoded) {
        decoded->is_map = is_map;
        decoded->is_table = !strcmp(info->layout, "table");
    }
    return KILN_OK;
}

kiln_result ki_decode_file(kiln_context *context, const char *path, const char *layer,
                           ki_decoded *decoded, kiln_file_info *info, kiln_error *error)
{
    uint8_t *bytes;
    size_t size;
    kiln_result result = ki_file_read(context, path, &bytes, &size, error);
    if (result != KILN_OK)
        return result;
    result = ki_decode_layer(context, bytes, size, path, layer, decoded, info, error);
    ki_free(bytes);
    return result;
}

void ki_decoded_free(ki_decoded *decoded)
{
    kiln_image_free(&decoded->image);
    kiln_map_free(&decoded->map);
    decoded->is_map = decoded->is_table = false;
}
