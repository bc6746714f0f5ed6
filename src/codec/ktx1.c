// KTX version 1. In: a cube to be stored as halves or as floats of 11, 11 and 10 bits. Out: bytes
// of a file; or of a file that is read, all levels of its cube or level 0 of its picture, and the
// engine, roughness and harmonics in its key-value pairs. A file is a header of 64 bytes, pairs of
// text, and the levels, largest first.
#include "codec/ktx1.h"

#include "codec/engine_text.h"
#include "codec/filament_sh.h"
#include "codec/file_info.h"
#include "codec/report.h"
#include "codec/texels.h"

#include <stdio.h>
#include <string.h>

enum {
    ORDER = 0x04030201,
    GL_HALF_FLOAT = 0x140b,
    GL_RGB = 0x1907,
    GL_RGBA = 0x1908,
    GL_RGBA16F = 0x881a,
    GL_R11F_G11F_B10F = 0x8c3a,
};

// The header's fields glType, glTypeSize, glFormat, glInternalFormat and glBaseInternalFormat for
// halves, and below for b10g11r11. The values for b10g11r11 are those that Filament's cmgen writes
// and Filament's reader requires. By the KTX specification glType would be 0x8c3b, glTypeSize 4 and
// glBaseInternalFormat RGB.
static const uint32_t half_types[5] = {GL_HALF_FLOAT, 2, GL_RGBA, GL_RGBA16F, GL_RGBA};
static const uint32_t packed_types[5] = {GL_R11F_G11F_B10F, 1, GL_RGB, GL_R11F_G11F_B10F,
                                         GL_R11F_G11F_B10F};

static const uint8_t magic[12] = {0xab, 'K', 'T', 'X', ' ', '1', '1', 0xbb, '\r', '\n', 0x1a, '\n'};

static void write_header(ki_writer *w, const uint32_t types[5], int size, int level_count)
{
    ki_write(w, magic, sizeof magic);
    ki_write_u32(w, ORDER);
    for (int i = 0; i < 5; i++)
        ki_write_u32(w, types[i]);
    ki_write_u32(w, (uint32_t)size);
    ki_write_u32(w, (uint32_t)size);
    ki_write_u32(w, 0); // depth, 0 because the texture is no volume
    ki_write_u32(w, 0); // number of array elements, 0 because the texture is no array
    ki_write_u32(w, 6);
    ki_write_u32(w, (uint32_t)level_count);
}

// ----------------------------------------------------------------------------------------- writing

// Begins a key-value pair of the metadata, and returns its position for end_pair. A pair is its
// size, its key and value, each with a terminating NUL, and zeros up to a multiple of 4 bytes. The
// caller writes the value before end_pair.
static size_t begin_pair(ki_writer *w, const char *key)
{
    size_t pair = w->size;
    ki_write_u32(w, 0);
    ki_write(w, key, strlen(key) + 1);
    return pair;
}

static void end_pair(ki_writer *w, size_t pair)
{
    ki_patch_u32(w, pair, (uint32_t)(w->size - pair - 4));
    ki_write_align(w, 4);
}

static void write_pairs(ki_writer *w, const kiln_map *map, const kiln_sh *sh, const char *engine)
{
    size_t start = w->size;
    ki_write_u32(w, 0);
    if (sh) {
        size_t pair = begin_pair(w, "sh");
        ki_filament_sh_write(w, sh, false);
        ki_write_u8(w, 0);
        end_pair(w, pair);
    }
    size_t pair = begin_pair(w, "KTXwriter");
    ki_write_text(w, "kiln %s", kiln_version());
    ki_write_u8(w, 0);
    end_pair(w, pair);
    pair = begin_pair(w, "kiln:engine");
    ki_engine_text_write(w, engine, "", map);
    end_pair(w, pair);
    ki_patch_u32(w, start, (uint32_t)(w->size - start - 4));
}

kiln_result ki_ktx1_encode(const kiln_map *map, const kiln_sh *sh, const char *engine,
                           kiln_format format, ki_writer *writer, kiln_error *error)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(format);
    bool packed = format == KILN_FORMAT_B10G11R11;
    write_header(writer, packed ? packed_types : half_types, map->size, map->level_count);
    write_pairs(writer, map, sh, engine);
    for (int k = 0; k < map->level_count; k++) {
        // By the KTX specification the size before a level of a cube is that of one face. Faces
        // with 4 or 8 bytes a texel need no padding to a multiple of 4.
        int n = kiln_map_level_size(map, k);
        size_t size = (size_t)ki_pixels_size(pixel, n, n);
        ki_write_u32(writer, (uint32_t)size);
        uint8_t *room = ki_write_room(writer, 6 * size);
        if (!room)
            return ki_fail_memory(writer->context, error, "a KTX file", writer->size);
        if (!ki_pixels_pack(writer->context, pixel, map->level[k], n, n, 6, room))
            return ki_fail_cancelled(error, "writing");
    }
    return KILN_OK;
}

// ----------------------------------------------------------------------------------------- reading

typedef struct header {
    ki_texels texels;
    uint32_t width, height, face_count, level_count, pair_bytes;
    // texels of each level in the file, and the multiple of bytes at which their rows end
    const uint8_t *level[KILN_MAX_LEVELS];
    int align[KILN_MAX_LEVELS];
    bool by_cmgen; // true: the header has the unusual values that Filament's cmgen writes
} header;

// Finds how the texels are stored. `types` are the fields from glType to glBaseInternalFormat.
static bool find_texels(const uint32_t types[5], ki_texels *texels)
{
    enum {
        UNSIGNED_BYTE = 0x1401,
        UNSIGNED_SHORT = 0x1403,
        FLOAT = 0x1406,
        HALF_FLOAT_OES = 0x8d61,
        BGR = 0x80e0,
        BGRA = 0x80e1,
        SRGB8 = 0x8c41,
        SRGB8_ALPHA8 = 0x8c43,
        RGB9_E5 = 0x8c3d,
        BC6H_UNSIGNED = 0x8e8f,
    };
    uint32_t type = types[0], format = types[2], internal = types[3];
    bool blue_first = format == BGR || format == BGRA,
         srgb = internal == SRGB8 || internal == SRGB8_ALPHA8;
    const ki_pixel_format *pixel =
        internal == GL_R11F_G11F_B10F ? ki_pixel_format_of(KILN_FORMAT_B10G11R11)
        : internal == RGB9_E5         ? ki_pixel_format_of(KILN_FORMAT_RGB9E5)
        : internal == BC6H_UNSIGNED   ? ki_pixel_format_of(KILN_FORMAT_BC6H)
                                      : NULL;
    *texels = (ki_texels){.channels = 3, .pixel = pixel};
    if (pixel)
        return true;
    texels->blue_first = blue_first;
    texels->channels = format == GL_RGBA || format == BGRA ? 4
                       : format == GL_RGB || format == BGR ? 3
                                                           : 0;
    texels->kind = type == UNSIGNED_BYTE    ? srgb ? KI_TEXEL_SRGB8 : KI_TEXEL_U8
                   : type == UNSIGNED_SHORT ? KI_TEXEL_U16
                   : type == FLOAT          ? KI_TEXEL_F32
                   : type == GL_HALF_FLOAT || type == HALF_FLOAT_OES ? KI_TEXEL_F16
                                                                     : KI_TEXEL_PIXEL;
    if (texels->kind == KI_TEXEL_F16 && texels->channels == 4 && !blue_first)
        *texels = (ki_texels){.channels = 4, .pixel = ki_pixel_format_of(KILN_FORMAT_RGBA16F)};
    return texels->channels && (texels->kind || texels->pixel);
}

static kiln_result check_order(uint32_t order, const char *name, kiln_error *error)
{
    enum { SWAPPED = 0x01020304 };
    if (order == SWAPPED)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is a KTX 1 file with the numbers of a big-endian machine; kiln reads "
                       "little-endian files, which all current tools write",
                       name);
    if (order != ORDER)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the KTX header is cut off or damaged", name);
    return KILN_OK;
}

static kiln_result check_header(const header *h, const char *name, kiln_error *error)
{
    bool cube = h->face_count == 6;
    uint32_t longest = h->width > h->height ? h->width : h->height;
    if (h->width < 1 || h->height < 1 || (cube && h->width != h->height) ||
        longest > KILN_MAX_SIZE || h->level_count > KILN_MAX_LEVELS ||
        longest >> (h->level_count - 1) == 0)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has %u levels of faces of %u x %u, which are not square, too large, or "
                       "too small for so many levels",
                       name, h->level_count, h->width, h->height);
    return KILN_OK;
}

static kiln_result read_header(ki_reader *r, const char *name, header *h, kiln_error *error)
{
    uint32_t types[5], counts[3];
    ki_read_bytes(r, sizeof magic);
    uint32_t order = ki_read_u32(r);
    for (int i = 0; i < 5; i++)
        types[i] = ki_read_u32(r);
    h->width = ki_read_u32(r);
    h->height = ki_read_u32(r);
    for (int i = 0; i < 3; i++) // skips the fields for depth, array elements and faces
        counts[i] = ki_read_u32(r);
    h->face_count = counts[2];
    h->by_cmgen = !memcmp(types, packed_types, sizeof types);
    h->level_count = ki_read_u32(r);
    h->level_count = h->level_count ? h->level_count : 1;
    h->pair_bytes = ki_read_u32(r);
    kiln_result result = check_order(r->failed ? 0 : order, name, error);
    if (result != KILN_OK)
        return result;
    if (!find_texels(types, &h->texels) || counts[0] || counts[1] > 1 ||
        (h->face_count != 6 && h->face_count != 1))
        return ki_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s: is a KTX 1 file of type 0x%x, internal format 0x%x and %u faces; kiln "
            "reads cubes and pictures of RGB and RGBA with 8 and 16 bits, with 16-bit and "
            "32-bit floats, and of the formats 0x8c3a, 0x8c3d and 0x8e8f",
            name, types[0], types[3], h->face_count);
    return check_header(h, name, error);
}

static void read_pair(const char *key, const char *value, kiln_file_info *info)
{
    if (!strcmp(key, "sh"))
        ki_filament_sh_read(value, info);
    else if (!strcmp(key, "KTXwriter"))
        ki_copy_printable(info->writer, sizeof info->writer, value);
    else if (!strcmp(key, "KTXorientation"))
        ki_copy_printable(info->orientation, sizeof info->orientation, value);
    else if (!strcmp(key, "kiln:engine"))
        ki_engine_text_read(value, info);
}

// Reads the key-value pairs of the metadata into `info`. Returns false if the pairs are longer or
// shorter than `size`, or if the caller asks to stop, which sets *stopped. Pairs whose value is not
// text, and pairs longer than KI_KTX_TEXT, are skipped.
static bool read_pairs(kiln_context *context, const uint8_t *bytes, size_t size,
                       kiln_file_info *info, bool *stopped)
{
    ki_reader r = ki_reader_make(bytes, size);
    for (unsigned count = 0; ki_reader_left(&r) >= 4; count++) {
        *stopped = count % 65536 == 0 && !ki_go_on(context);
        if (*stopped)
            return false;
        uint32_t length = ki_read_u32(&r);
        const uint8_t *pair = ki_read_bytes(&r, length);
        if (!pair)
            return false;
        const uint8_t *end = memchr(pair, 0, length);
        if (end && end + 1 < pair + length && pair[length - 1] == 0 && length <= KI_KTX_TEXT)
            read_pair((const char *)pair, (const char *)end + 1, info);
        ki_read_bytes(&r, (4 - length % 4) % 4);
    }
    return !r.failed;
}

// Returns the number of bytes of level k of a face, whose rows end at multiples of `align` bytes.
static uint64_t level_bytes(const header *h, uint32_t k, int align)
{
    int width = ki_max(1, (int)(h->width >> k)), height = ki_max(1, (int)(h->height >> k));
    return ki_texels_size(&h->texels, width, height, align);
}

// Finds the texels of all levels in the file. Returns false if they are not all there. The stated
// size is that of a face; some programs state the size of all six. Rows end at multiples of 4 bytes
// by the KTX specification; Filament's mipgen writes them without such an end, as the size shows.
static bool find_levels(ki_reader *r, header *h)
{
    for (uint32_t k = 0; k < h->level_count; k++) {
        uint64_t stated = ki_read_u32(r), tight = level_bytes(h, k, 1);
        int align = stated == tight || stated == h->face_count * tight ? 1 : 4;
        uint64_t size = level_bytes(h, k, align), all = h->face_count * size;
        // Six faces may have more bytes than a size_t of 32 bits counts.
        if ((stated != size && stated != all) || all > ki_reader_left(r))
            return false;
        h->align[k] = align;
        h->level[k] = ki_read_bytes(r, (size_t)all);
    }
    return true;
}

static void describe(const header *h, kiln_file_info *info)
{
    char name[KI_TEXELS_NAME];
    snprintf(info->format, sizeof info->format, "ktx1");
    snprintf(info->encoding, sizeof info->encoding, "%s", ki_texels_name(&h->texels, name));
    if (h->face_count == 6)
        snprintf(info->layout, sizeof info->layout, "cube");
    info->width = (int)h->width;
    info->height = (int)h->height;
    info->face_count = (int)h->face_count;
    info->level_count = (int)h->level_count;
    info->channel_count = h->texels.channels;
}

// Notes what is to be known about the levels and axes of a file.
static void note(const header *h, const kiln_file_info *info, kiln_load_report *report)
{
    ki_texels_note(&h->texels, true, (int)h->level_count, report);
    if (h->face_count == 6 && (h->by_cmgen || info->sh_bands || !strcmp(info->engine, "filament")))
        ki_note(report, KILN_NOTE_ASSUMPTION, false,
                "the cube is one for Filament, which shows +Z in the centre of a panorama; a turn "
                "by 180 degrees gives the axes of kiln");
}

// Reads level `k` of six faces, or of a picture.
static bool read_level(kiln_context *context, const header *h, int k, const kiln_file_info *info,
                       float *rgb)
{
    int w = ki_max(1, (int)(h->width >> k)), height = ki_max(1, (int)(h->height >> k));
    bool up = strstr(info->orientation, "T=u") != NULL,
         left = strstr(info->orientation, "S=l") != NULL;
    size_t bytes = (size_t)level_bytes(h, (uint32_t)k, h->align[k]);
    for (size_t face = 0; face < h->face_count; face++) {
        float *to = rgb + 3 * face * (size_t)w * (size_t)height;
        if (!ki_texels_read(context, &h->texels, h->level[k] + face * bytes, w, height, h->align[k],
                            to) ||
            !ki_texels_flip(context, to, w, height, left, up))
            return false;
    }
    return true;
}

// Reads all levels of six faces, or level 0 of a picture.
static kiln_result read_texels(kiln_context *context, const header *h, const kiln_file_info *info,
                               ki_decoded *decoded, kiln_error *error)
{
    bool cube = h->face_count == 6;
    int count = cube ? (int)h->level_count : 1;
    kiln_map *map = &decoded->map;
    kiln_image *image = &decoded->image;
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = (int)h->width, .level_count = count};
    *image = (kiln_image){.width = (int)h->width, .height = (int)h->height, .channels = 3};
    kiln_result result =
        cube ? ki_map_allocate(context, map, error) : ki_image_allocate(context, image, error);
    for (int k = 0; k < count && result == KILN_OK; k++) {
        float linear = count > 1 ? (float)k / (float)(count - 1) : 0;
        map->roughness[k] = info->roughness[k] >= 0 ? info->roughness[k] : linear;
        if (!read_level(context, h, k, info, cube ? map->level[k] : image->pixels))
            result = ki_fail_cancelled(error, "reading");
    }
    if (result == KILN_OK && (strstr(info->orientation, "T=u") || strstr(info->orientation, "S=l")))
        ki_note(&decoded->report, KILN_NOTE_CONVERSION, false,
                "the orientation \"%s\" was turned to rows from the top and columns from the left",
                info->orientation);
    if (result != KILN_OK || !cube)
        kiln_map_free(map);
    if (result != KILN_OK || cube)
        kiln_image_free(image);
    return result;
}

kiln_result ki_ktx1_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, ki_decoded *decoded, kiln_file_info *info,
                           kiln_error *error)
{
    ki_reader r = ki_reader_make(bytes, size);
    header h = {0};
    kiln_result result = read_header(&r, name, &h, error);
    if (result != KILN_OK)
        return result;
    const uint8_t *pairs = ki_read_bytes(&r, h.pair_bytes);
    bool stopped = false;
    bool good = pairs && read_pairs(context, pairs, h.pair_bytes, info, &stopped);
    if (stopped)
        return ki_fail_cancelled(error, "reading");
    if (!good)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: its %u bytes of key-value pairs are damaged",
                       name, h.pair_bytes);
    if (!find_levels(&r, &h))
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: its %u levels are cut off or damaged", name,
                       h.level_count);
    describe(&h, info);
    note(&h, info, decoded ? &decoded->report : &info->report);
    if (!decoded)
        return KILN_OK;
    return read_texels(context, &h, info, decoded, error);
}
