// Writes tables to files and reads them back from KTX2. In: a table, a path and a format. Out: a
// file, whose kind follows from the ending of its name: KTX2, EXR, HDR, PNG, plain numbers or
// source code. docs/tables.md lists the endings and formats.
#include "base/file.h"
#include "codec/components.h"
#include "codec/formats.h"
#include "codec/rgbx_png.h"
#include "image/pack.h"
#include "table/lobes.h"
#include "table/table.h"
#include "table/table_source.h"
#include "table/table_text.h"

#include <math.h>
#include <string.h>

// ------------------------------------------------------------------------------------------ checks

static kiln_result check_def(const kiln_table_def *def, kiln_error *error)
{
    if ((unsigned)def->kind > KILN_TABLE_LOBES || (unsigned)def->model.d > KILN_D_BECKMANN ||
        (unsigned)def->model.g > KILN_G_SCHLICK_TEXT || (unsigned)def->axis > KILN_AXIS_GRAZING ||
        (unsigned)def->sheen > KILN_SHEEN_ESTEVEZ)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the table's kind, d, g, axis and sheen are %d, %d, %d, %d and %d, of which "
                       "one is unknown",
                       (int)def->kind, (int)def->model.d, (int)def->model.g, (int)def->axis,
                       (int)def->sheen);
    if (def->width < 1 || def->width > KILN_MAX_TABLE || def->height < 1 ||
        def->height > KILN_MAX_TABLE || def->depth < 1 || def->depth > KILN_MAX_TABLE ||
        def->path_count < 0)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the table is %d x %d x %d with %d paths, its sides must be 1 to %d and its "
                       "paths 0 or more",
                       def->width, def->height, def->depth, def->path_count, KILN_MAX_TABLE);
    kiln_table_def complete = *def;
    return def->kind == KILN_TABLE_LOBES ? ki_lobes_complete(&complete, error) : KILN_OK;
}

static kiln_result check_table(const kiln_table *table, kiln_error *error)
{
    const kiln_table_def *def = &table->def;
    const kiln_image *image = &table->image;
    kiln_result result = check_def(def, error);
    if (result != KILN_OK)
        return result;
    int channels = ki_table_channels(def->kind);
    if (!image->pixels || image->width != def->width ||
        (int64_t)image->height != (int64_t)def->height * def->depth || image->channels != channels)
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "the table's image is %d x %d with %d channels%s, it must be %d x %lld with %d",
            image->width, image->height, image->channels, image->pixels ? "" : " and no pixels",
            def->width, (long long)def->height * def->depth, channels);
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)channels;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(image->pixels[i]))
            return ki_fail(error, KILN_ERROR_ARGUMENT, "number %zu of the table is not finite", i);
    return KILN_OK;
}

// ----------------------------------------------------------------------------------------- formats

static kiln_result find_format(const char *path, const kiln_table_save_def *def,
                               const ki_file_format **file, kiln_table_format *format,
                               kiln_error *error)
{
    static const char *const names[] = {"", "f32", "f16", "u16", "u8", "rgbd"};
    char list[KI_ENDINGS_TEXT];
    *file = ki_file_format_of_path(path);
    if (!ki_file_holds(*file, KI_HOLDS_TABLE))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: must end in %s", path,
                       ki_list_endings(KI_HOLDS_TABLE, NULL, list));
    if ((unsigned)def->format > KILN_TABLE_FORMAT_RGBD)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "format is %d, it must be 0 to %d",
                       (int)def->format, (int)KILN_TABLE_FORMAT_RGBD);
    if (def->format && !((*file)->table_formats & 1U << def->format))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: a %s file has no format %s", path,
                       kiln_path_ending(path), names[def->format]);
    *format = def->format ? def->format : (*file)->table_format;
    return ki_check_zstd(path, *file, def->zstd, error);
}

// Fails if a format cannot hold the numbers of a kind of table.
static kiln_result check_numbers(const kiln_table_def *def, kiln_table_format format,
                                 const char *path, kiln_error *error)
{
    if (def->kind == KILN_TABLE_LOBES && format != KILN_TABLE_FORMAT_F16 &&
        format != KILN_TABLE_FORMAT_F32)
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "%s: a table of lobes has numbers below 0 and above 1, choose the format f16 "
            "or f32 and a file that has it, such as .ktx2 or .exr",
            path);
    return KILN_OK;
}

// ---------------------------------------------------------------------------------------- pictures

// Creates a copy of an image with three channels. One channel is copied to all three; of two
// channels the third becomes 0.
static kiln_result widen(kiln_context *context, const kiln_image *image, kiln_image *rgb,
                         kiln_error *error)
{
    kiln_result result = kiln_image_create(context, image->width, image->height, 3, rgb, error);
    size_t count = result ? 0 : (size_t)image->width * (size_t)image->height;
    int last = image->channels - 1;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            rgb->pixels[3 * i + (size_t)c] =
                c <= last || last == 0
                    ? image->pixels[i * (size_t)image->channels + (size_t)ki_min(c, last)]
                    : 0;
    return result;
}

static kiln_result encode_exr(const kiln_table *table, kiln_table_format format, ki_writer *w,
                              kiln_error *error)
{
    const kiln_image *image = &table->image;
    char text[KI_TABLE_TEXT];
    ki_table_describe(&table->def, text);
    const ki_exr_options options = {
        .half = format == KILN_TABLE_FORMAT_F16, .roughness = -1, .table = text};
    return ki_exr_encode(image->pixels, image->width, image->height, image->channels, &options, w,
                         error);
}

static kiln_result encode_hdr(const kiln_table *table, const char *path, ki_writer *w,
                              kiln_error *error)
{
    kiln_image rgb = {0};
    int channels = table->image.channels;
    if (channels == 4)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: an HDR file has three channels, but the table has 4", path);
    kiln_result result = channels == 3 ? KILN_OK : widen(w->context, &table->image, &rgb, error);
    const kiln_image *image = channels == 3 ? &table->image : &rgb;
    if (result == KILN_OK)
        result = ki_hdr_encode(image->pixels, image->width, image->height, w, error);
    kiln_image_free(&rgb);
    return result;
}

// Writes a table as a PNG. KILN_TABLE_FORMAT_RGBD stores three numbers, which may exceed 1, in four
// channels of 8 bits.
static kiln_result encode_png(const kiln_table *table, kiln_table_format format, const char *path,
                              ki_writer *w, kiln_error *error)
{
    kiln_image rgb = {0};
    int channels = table->image.channels;
    if (format == KILN_TABLE_FORMAT_RGBD && channels != 3)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: the format rgbd has three channels, but the table has %d", path,
                       channels);
    if (format == KILN_TABLE_FORMAT_RGBD)
        return ki_rgbx_png_encode(&table->image, ki_rgbd_from_float, false, w, error);
    kiln_result result = channels == 2 ? widen(w->context, &table->image, &rgb, error) : KILN_OK;
    const kiln_image *image = channels == 2 ? &rgb : &table->image;
    if (result == KILN_OK)
        result = ki_png_encode(image->pixels, image->width, image->height, image->channels,
                               format == KILN_TABLE_FORMAT_U8 ? KI_PNG_PLAIN8 : KI_PNG_PLAIN16, w,
                               error);
    kiln_image_free(&rgb);
    return result;
}

// Writes the numbers of a table, row after row, without a header.
static kiln_result encode_raw(const kiln_table *table, kiln_table_format format, ki_writer *w,
                              kiln_error *error)
{
    const kiln_image *image = &table->image;
    size_t row_values = (size_t)image->width * (size_t)image->channels;
    size_t row = row_values * (size_t)ki_component_bytes(format);
    uint8_t *room = ki_write_room(w, row * (size_t)image->height);
    for (int y = 0; room && y < image->height; y++) {
        if (y % 64 == 0 && !ki_go_on(w->context))
            return ki_fail_cancelled(error, "writing");
        ki_components_pack(format, image->pixels + (size_t)y * row_values, row_values, 1, 1,
                           room + (size_t)y * row);
    }
    return KILN_OK;
}

static void encode_inc(const kiln_table *table, ki_writer *w)
{
    const kiln_image *image = &table->image;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    char text[KI_TABLE_TEXT];
    ki_table_describe(&table->def, text);
    ki_write_text(w, "// kiln %s: %s\n// halves, texel by texel, the first row first\n",
                  kiln_version(), text);
    for (size_t i = 0; i < count; i++)
        ki_write_text(w, "0x%04x,%s", (unsigned)ki_half_from_float(image->pixels[i]),
                      (i + 1) % 12 && i + 1 < count ? " " : "\n");
}

static kiln_result encode_code(const kiln_table *table, kiln_table_format format, const char *path,
                               const char *wanted_name, ki_writer *w, kiln_error *error)
{
    ki_source_name name;
    kiln_result result = ki_source_name_make(path, wanted_name, &name, error);
    if (result != KILN_OK)
        return result;
    if (table->def.kind == KILN_TABLE_LOBES && !ki_ends_with(path, ".h"))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: a table of lobes is no constant array in GLSL; save a texture as .ktx2 "
                       "and its lookup as .glsl",
                       path);
    return ki_ends_with(path, ".h") ? ki_table_write_header(table, path, name.text, w, error)
                                    : ki_table_write_glsl(table, format, path, name.text, w, error);
}

static kiln_result encode_ktx2(const kiln_table *table, kiln_table_format format, int zstd,
                               ki_writer *w, kiln_error *error)
{
    char text[KI_TABLE_TEXT];
    ki_table_describe(&table->def, text);
    return ki_ktx2_encode_table(&table->image, table->def.depth, text, format, zstd, w, error);
}

static kiln_result encode(const kiln_table *table, const char *path, const kiln_table_save_def *def,
                          ki_writer *w, kiln_error *error)
{
    const ki_file_format *file;
    kiln_table_format format = KILN_TABLE_FORMAT_F32;
    kiln_result result = find_format(path, def, &file, &format, error);
    if (result == KILN_OK)
        result = check_numbers(&table->def, format, path, error);
    if (result != KILN_OK)
        return result;
    if (!strcmp(file->name, "ktx2"))
        return encode_ktx2(table, format, def->zstd, w, error);
    if (!strcmp(file->name, "exr"))
        return encode_exr(table, format, w, error);
    if (!strcmp(file->name, "hdr"))
        return encode_hdr(table, path, w, error);
    if (!strcmp(file->name, "png"))
        return encode_png(table, format, path, w, error);
    if (!strcmp(file->name, "raw"))
        return encode_raw(table, format, w, error);
    if (file->holds & KI_HOLDS_CODE)
        return encode_code(table, format, path, def->name, w, error);
    encode_inc(table, w);
    return KILN_OK;
}

// ------------------------------------------------------------------------------ saving and loading

static kiln_result put(kiln_result result, const char *path, ki_writer *w, kiln_error *error)
{
    if (result == KILN_OK && w->failed)
        result = ki_fail_memory(w->context, error, path, w->size);
    if (result == KILN_OK)
        result = ki_file_write(w->context, path, w->bytes, w->size, error);
    ki_writer_free(w);
    return result;
}

kiln_result kiln_table_save_check(const char *path, const kiln_table_save_def *def,
                                  kiln_error *error)
{
    const ki_file_format *file;
    kiln_table_format format;
    return find_format(path, def ? def : &(kiln_table_save_def){0}, &file, &format, error);
}

kiln_result kiln_table_save(kiln_context *context, const kiln_table *table, const char *path,
                            const kiln_table_save_def *def, kiln_error *error)
{
    static const kiln_table_save_def defaults = {0};
    kiln_result result = check_table(table, error);
    if (result != KILN_OK)
        return result;
    if (!ki_progress(context, "writing", 0))
        return ki_fail_cancelled(error, "writing");
    ki_writer w = {.context = context};
    result = encode(table, path, def ? def : &defaults, &w, error);
    return put(result, path, &w, error);
}

static kiln_result find_language(const kiln_table_def *def, const char *path, ki_language *language,
                                 kiln_error *error)
{
    static const char *const endings[] = {".h", ".glsl", ".wgsl"};
    bool lobes = def->kind == KILN_TABLE_LOBES;
    for (int i = 0; i < 2 + lobes; i++)
        if (ki_ends_with(path, endings[i])) {
            *language = (ki_language)i;
            return KILN_OK;
        }
    return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: must end in .h or .glsl%s", path,
                   lobes ? " or .wgsl" : "");
}

kiln_result kiln_table_lookup_save(kiln_context *context, const kiln_table_def *def,
                                   const char *path, const char *name, kiln_error *error)
{
    ki_language language = KI_LANGUAGE_C;
    kiln_result result = find_language(def, path, &language, error);
    ki_source_name made;
    if (result == KILN_OK)
        result = check_def(def, error);
    if (result == KILN_OK)
        result = ki_source_name_make(path, name, &made, error);
    if (result != KILN_OK)
        return result;
    ki_writer w = {.context = context};
    ki_table_write_lookup(def, language, made.text, &w);
    return put(KILN_OK, path, &w, error);
}

// Drops the fourth channel of a table's image. Files store tables of three channels with a fourth
// one as padding.
static void narrow(kiln_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        memmove(image->pixels + 3 * i, image->pixels + 4 * i, 3 * sizeof(float));
    image->channels = 3;
}

// Checks that a decoded file holds a table and that the file's description of the table agrees with
// its image. Moves the image to `table`.
static kiln_result take(const char *path, ki_decoded *decoded, const kiln_file_info *info,
                        kiln_table *table, kiln_error *error)
{
    kiln_image *image = &decoded->image;
    kiln_table_def def;
    if (!decoded->is_table)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: holds a %s (%s) and not a table", path,
                       info->layout, info->format);
    if (!ki_table_parse(info->table, &def))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: describes its table as \"%s\", which kiln does not understand", path,
                       info->table);
    if (def.width != info->width || def.height != info->height || def.depth != info->depth)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has %d x %d x %d texels, but describes its table as %d x %d x %d", path,
                       info->width, info->height, info->depth, def.width, def.height, def.depth);
    int channels = ki_table_channels(def.kind);
    if (image->channels != channels + (channels == 3))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has %d channels, but its kind of table has %d", path, image->channels,
                       channels);
    if (channels == 3)
        narrow(image);
    *table = (kiln_table){def, *image};
    *image = (kiln_image){0};
    return KILN_OK;
}

kiln_result kiln_table_load(kiln_context *context, const char *path, kiln_table *table,
                            kiln_error *error)
{
    *table = (kiln_table){0};
    ki_decoded decoded;
    kiln_file_info info;
    kiln_result result = ki_decode_file(context, path, NULL, &decoded, &info, error);
    if (result != KILN_OK)
        return result;
    result = take(path, &decoded, &info, table, error);
    ki_decoded_free(&decoded);
    return result;
}
