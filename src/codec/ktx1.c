// KTX version 1. In: a cube to be stored as halves or as floats of 11, 11 and 10 bits. Out: bytes
// of a file; or of a file that is read, the engine, roughness and harmonics in its key-value pairs,
// while its texels are not read. A file is a header of 64 bytes, pairs of text, and the levels,
// largest first.
#include "codec/ktx1.h"

#include "codec/engine_text.h"
#include "codec/filament_sh.h"
#include "codec/file_info.h"
#include "codec/pixel_format.h"

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

// ------------------------------------------------------------------------------------------ reading

typedef struct header {
    const ki_pixel_format *pixel;
    uint32_t width, height, level_count, pair_bytes;
} header;

static kiln_result read_header(ki_reader *r, const char *name, header *h, kiln_error *error)
{
    uint32_t types[5], counts[4];
    ki_read_bytes(r, sizeof magic);
    uint32_t order = ki_read_u32(r);
    for (int i = 0; i < 5; i++)
        types[i] = ki_read_u32(r);
    h->width = ki_read_u32(r);
    h->height = ki_read_u32(r);
    for (int i = 0; i < 3; i++) // skips the fields for depth, array elements and faces
        counts[i] = ki_read_u32(r);
    h->level_count = ki_read_u32(r);
    h->pair_bytes = ki_read_u32(r);
    if (r->failed || order != ORDER)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the KTX header is cut off or damaged", name);
    h->pixel = !memcmp(types, half_types, sizeof types) ? ki_pixel_format_of(KILN_FORMAT_RGBA16F)
               : !memcmp(types, packed_types, sizeof types)
                   ? ki_pixel_format_of(KILN_FORMAT_B10G11R11)
                   : NULL;
    if (!h->pixel || counts[0] || counts[1] || counts[2] != 6)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is a KTX 1 file of type 0x%x, internal format 0x%x and %u faces; kiln "
                       "describes cubes of 16-bit floats and of floats with 11, 11 and 10 bits",
                       name, types[0], types[3], counts[2]);
    h->level_count = h->level_count ? h->level_count : 1;
    if (h->width < 1 || h->width != h->height || h->width > KILN_MAX_SIZE ||
        h->level_count > KILN_MAX_LEVELS || h->width >> (h->level_count - 1) == 0)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has %u levels of faces of %u x %u, which are not square, too large, or "
                       "too small for so many levels",
                       name, h->level_count, h->width, h->height);
    return KILN_OK;
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
// shorter than `size`. Pairs whose value is not text are skipped.
static bool read_pairs(const uint8_t *bytes, size_t size, kiln_file_info *info)
{
    ki_reader r = ki_reader_make(bytes, size);
    while (ki_reader_left(&r) >= 4) {
        uint32_t length = ki_read_u32(&r);
        const uint8_t *pair = ki_read_bytes(&r, length);
        if (!pair)
            return false;
        const uint8_t *end = memchr(pair, 0, length);
        if (end && end + 1 < pair + length && pair[length - 1] == 0)
            read_pair((const char *)pair, (const char *)end + 1, info);
        ki_read_bytes(&r, (4 - length % 4) % 4);
    }
    return !r.failed;
}

static bool has_levels(ki_reader *r, const header *h)
{
    for (uint32_t k = 0; k < h->level_count; k++) {
        uint64_t size = ki_pixels_size(h->pixel, (int)h->width >> k, (int)h->width >> k);
        // The bytes of six faces may exceed a size_t of 32 bits.
        if (ki_read_u32(r) != size || 6 * size > ki_reader_left(r))
            return false;
        ki_read_bytes(r, (size_t)(6 * size));
    }
    return true;
}

kiln_result ki_ktx1_describe(const uint8_t *bytes, size_t size, const char *name,
                             kiln_file_info *info, kiln_error *error)
{
    ki_reader r = ki_reader_make(bytes, size);
    header h = {0};
    kiln_result result = read_header(&r, name, &h, error);
    if (result != KILN_OK || !h.pixel)
        return result;
    const uint8_t *pairs = ki_read_bytes(&r, h.pair_bytes);
    if (!pairs || !read_pairs(pairs, h.pair_bytes, info))
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: its %u bytes of key-value pairs are damaged",
                       name, h.pair_bytes);
    if (!has_levels(&r, &h))
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: its %u levels are cut off or damaged", name,
                       h.level_count);
    snprintf(info->format, sizeof info->format, "ktx1");
    snprintf(info->encoding, sizeof info->encoding, "%s", ki_format_names[h.pixel->format]);
    snprintf(info->layout, sizeof info->layout, "cube");
    info->width = info->height = (int)h.width;
    info->face_count = 6;
    info->level_count = (int)h.level_count;
    info->channel_count = h.pixel->channels;
    return KILN_OK;
}
