// KTX2 cubes, by the Khronos specification 2.0.4: level index largest first, levels stored smallest
// first, zstd for each level where asked for.
#include "codec/codec.h"
#include "codec/texel.h"
#include "codec/zstd.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

static const uint8_t identifier[12] = {0xab, 'K',  'T',  'X',  ' ',  '2',
                                       '0',  0xbb, '\r', '\n', 0x1a, '\n'};

enum { HEADER_SIZE = 80, INDEX_ENTRY = 24, SCHEME_NONE = 0, SCHEME_ZSTD = 2 };

// ---------------------------------------------------------------------------------- data format

// Khronos Data Format 1.3, basic descriptor block, one sample for each channel (and, for the shared
// exponent, one more).
enum {
    MODEL_RGBSDA = 1,
    PRIMARIES_BT709 = 1,
    TRANSFER_LINEAR = 1,
    ALPHA = 15,
    EXPONENT = 0x20,
    SIGNED = 0x40,
    FLOAT = 0x80,
};

typedef struct sample {
    int offset, bits, channel;
    uint32_t lower, upper;
} sample;

static int find_samples(const ki_texel *texel, sample samples[6])
{
    const uint32_t minus_one = 0xbf800000, one = 0x3f800000;
    switch (texel->format) {
    case KILN_FORMAT_RGB9E5:
        // Upper and lower as the specification's table of this format states them.
        for (int c = 0; c < 3; c++) {
            samples[2 * (size_t)c] = (sample){9 * c, 9, c, 0, 8448};
            samples[2 * (size_t)c + 1] = (sample){27, 5, c | EXPONENT, 15, 31};
        }
        return 6;
    case KILN_FORMAT_B10G11R11:
        samples[0] = (sample){0, 11, 0 | FLOAT, 0, one};
        samples[1] = (sample){11, 11, 1 | FLOAT, 0, one};
        samples[2] = (sample){22, 10, 2 | FLOAT, 0, one};
        return 3;
    case KILN_FORMAT_AUTO:
    case KILN_FORMAT_RGBA16F:
    case KILN_FORMAT_RGBA32F:
        break;
    }
    int bits = 2 * texel->bytes;
    for (int c = 0; c < 4; c++)
        samples[c] =
            (sample){bits * c, bits, (c == 3 ? ALPHA : c) | FLOAT | SIGNED, minus_one, one};
    return 4;
}

static void write_format(ki_writer *w, const ki_texel *texel)
{
    sample samples[6];
    int count = find_samples(texel, samples);
    uint32_t block = 24 + 16 * (uint32_t)count;
    ki_write_u32(w, 4 + block);
    ki_write_u32(w, 0);               // vendor Khronos, basic format
    ki_write_u32(w, 2 | block << 16); // version 1.3
    ki_write_u8(w, MODEL_RGBSDA);
    ki_write_u8(w, PRIMARIES_BT709);
    ki_write_u8(w, TRANSFER_LINEAR);
    ki_write_u8(w, 0);  // straight alpha
    ki_write_u32(w, 0); // texel blocks of 1 x 1 x 1 x 1
    ki_write_u32(w, (uint32_t)texel->bytes);
    ki_write_u32(w, 0);
    for (int i = 0; i < count; i++) {
        const sample *s = &samples[i];
        ki_write_u32(w, (uint32_t)s->offset | (uint32_t)(s->bits - 1) << 16 |
                            (uint32_t)s->channel << 24);
        ki_write_u32(w, 0); // position
        ki_write_u32(w, s->lower);
        ki_write_u32(w, s->upper);
    }
}

// ------------------------------------------------------------------------------------ key and value

// An entry whose value is text; begin returns where its length is patched in.
static size_t begin_entry(ki_writer *w, const char *key)
{
    size_t start = w->size;
    ki_write_u32(w, 0);
    ki_write(w, key, strlen(key) + 1);
    return start;
}

static void end_entry(ki_writer *w, size_t start)
{
    ki_write_u8(w, 0);
    ki_patch_u32(w, start, (uint32_t)(w->size - start - 4));
    ki_write_align(w, 4);
}

// Keys in the order of their bytes.
static void write_metadata(ki_writer *w, const kiln_map *map, const kiln_save_def *def)
{
    size_t entry = begin_entry(w, "KTXorientation");
    ki_write_text(w, "rd");
    end_entry(w, entry);
    entry = begin_entry(w, "KTXwriter");
    ki_write_text(w, "kiln %s", kiln_version());
    end_entry(w, entry);
    if (def->lobe) {
        entry = begin_entry(w, "kiln:lobe");
        ki_write(w, def->lobe, strlen(def->lobe));
        end_entry(w, entry);
    }
    entry = begin_entry(w, "kiln:roughness");
    for (int k = 0; k < map->level_count; k++) {
        ki_write_text(w, k ? " " : "");
        ki_write_number(w, (double)map->roughness[k]);
    }
    end_entry(w, entry);
    if (def->sh) {
        const kiln_sh *sh = def->sh;
        entry = begin_entry(w, "kiln:sh");
        ki_write_text(w, "bands %d\nirradiance %d\nwindow ", sh->bands, sh->irradiance);
        ki_write_number(w, sh->window);
        for (int i = 0; i < sh->bands * sh->bands; i++)
            for (int c = 0; c < 3; c++) {
                ki_write_text(w, c ? " " : "\n");
                ki_write_number(w, sh->c[i][c]);
            }
        end_entry(w, entry);
    }
}

static void read_sh(const char *text, kiln_file_info *info)
{
    double bands = 0;
    if (strncmp(text, "bands ", 6) != 0 || !ki_parse_number(text + 6, &bands) || bands < 1 ||
        bands > KILN_MAX_BANDS)
        return;
    for (int line = 0; line < 3 && text; line++) { // past the line of the window
        text = strchr(text, '\n');
        text = text ? text + 1 : NULL;
    }
    int count = (int)bands * (int)bands;
    for (int i = 0; i < 3 * count; i++) {
        double value = 0;
        text = text ? ki_parse_number(text + (*text == '\n'), &value) : NULL;
        info->sh[i / 3][i % 3] = (float)value;
    }
    if (text) // all were there
        info->sh_bands = (int)bands;
    else
        memset(info->sh, 0, sizeof info->sh);
}

static void read_entry(const char *key, const char *value, kiln_file_info *info)
{
    if (!strcmp(key, "KTXorientation"))
        snprintf(info->orientation, sizeof info->orientation, "%.15s", value);
    if (!strcmp(key, "KTXwriter"))
        snprintf(info->writer, sizeof info->writer, "%.63s", value);
    if (!strcmp(key, "kiln:sh"))
        read_sh(value, info);
    if (strcmp(key, "kiln:roughness") != 0)
        return;
    for (int k = 0; k < KILN_MAX_LEVELS; k++) {
        double roughness;
        value = ki_parse_number(value, &roughness);
        if (!value || !(roughness >= 0) || !(roughness <= 1))
            return;
        info->roughness[k] = (float)roughness;
    }
}

// Entries whose value is not text that ends within the entry are passed over.
static void read_metadata(const uint8_t *bytes, size_t size, kiln_file_info *info)
{
    ki_reader r = ki_reader_make(bytes, size);
    while (ki_reader_left(&r) >= 4) {
        uint32_t length = ki_read_u32(&r);
        const uint8_t *entry = ki_read_bytes(&r, length);
        if (!entry)
            return;
        const uint8_t *end = memchr(entry, 0, length);
        if (end && end + 1 < entry + length && entry[length - 1] == 0)
            read_entry((const char *)entry, (const char *)end + 1, info);
        ki_read_bytes(&r, (4 - length % 4) % 4);
    }
}

// ----------------------------------------------------------------------------------------- writing

static kiln_result write_level(ki_writer *w, const kiln_map *map, int level, const ki_texel *texel,
                               int zstd, size_t entry, uint64_t file_start, kiln_error *error)
{
    size_t texels = kiln_map_texels(map, level), size = texels * (size_t)texel->bytes;
    // The alignment is the least common multiple of the texel's bytes and 4.
    if (!zstd)
        ki_write_align(w, (size_t)ki_max(4, texel->bytes));
    uint64_t start = w->size;
    size_t bound = zstd ? ki_zstd_bound(size) : size, packed = size;
    uint8_t *room = ki_write_room(w, bound);
    uint8_t *plain = zstd && room ? ki_alloc_raw(w->context, size, 1) : room;
    kiln_result result = plain ? KILN_OK : KILN_ERROR_MEMORY;
    if (plain && !ki_texels_pack_many(w->context, texel, map->level[level], texels, plain))
        result = KILN_ERROR_CANCELLED;
    if (zstd && result == KILN_OK)
        result = ki_zstd_pack(w->context, plain, size, zstd, room, bound, &packed);
    if (zstd)
        ki_free(plain);
    if (result == KILN_ERROR_CANCELLED)
        return ki_fail_cancelled(error, "writing");
    if (result != KILN_OK)
        return ki_fail_memory(w->context, error, "a level of a KTX2 file", size + bound);
    w->size -= bound - packed;
    ki_patch_u64(w, entry, start - file_start);
    ki_patch_u64(w, entry + 8, w->size - start);
    ki_patch_u64(w, entry + 16, size);
    return KILN_OK;
}

kiln_result ki_ktx2_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                           kiln_error *error)
{
    const ki_texel *texel = ki_texel_of_format(def->format);
    if (map->shape != KILN_SHAPE_CUBE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "a KTX2 file holds a cube, not another shape");
    if (!texel)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "format is %d, it must be 0 to %d",
                       (int)def->format, (int)KILN_FORMAT_B10G11R11);
    if (def->zstd < 0 || def->zstd > 22)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "zstd is %d, it must be 0 to 22", def->zstd);
    kiln_result known = def->zstd ? ki_zstd_known("a KTX2 file", error) : KILN_OK;
    if (known != KILN_OK)
        return known;
    ki_writer *w = writer;
    size_t start = w->size;
    ki_write(w, identifier, sizeof identifier);
    ki_write_u32(w, texel->vk);
    ki_write_u32(w, (uint32_t)texel->type_size);
    ki_write_u32(w, (uint32_t)map->size);
    ki_write_u32(w, (uint32_t)map->size);
    ki_write_u32(w, 0); // depth
    ki_write_u32(w, 0); // layers
    ki_write_u32(w, 6); // faces
    ki_write_u32(w, (uint32_t)map->level_count);
    ki_write_u32(w, def->zstd ? SCHEME_ZSTD : SCHEME_NONE);
    size_t index = w->size;
    for (int i = 0; i < 4; i++) // offsets and lengths of format and metadata
        ki_write_u32(w, 0);
    ki_write_u64(w, 0); // no global data of the compression
    ki_write_u64(w, 0);
    size_t levels = w->size;
    for (int i = 0; i < 3 * map->level_count; i++)
        ki_write_u64(w, 0);
    ki_patch_u32(w, index, (uint32_t)(w->size - start));
    size_t begin = w->size;
    write_format(w, texel);
    ki_patch_u32(w, index + 4, (uint32_t)(w->size - begin));
    ki_patch_u32(w, index + 8, (uint32_t)(w->size - start));
    begin = w->size;
    write_metadata(w, map, def);
    ki_patch_u32(w, index + 12, (uint32_t)(w->size - begin));
    if (w->failed)
        return ki_fail_memory(w->context, error, "a KTX2 file", w->size);
    for (int k = map->level_count - 1; k >= 0; k--) {
        kiln_result result = write_level(w, map, k, texel, def->zstd,
                                         levels + INDEX_ENTRY * (size_t)k, start, error);
        if (result != KILN_OK)
            return result;
    }
    return KILN_OK;
}

// ----------------------------------------------------------------------------------------- reading

typedef struct ktx_header {
    uint32_t vk, width, height, depth, layers, faces, levels, scheme;
    uint32_t metadata_offset, metadata_size;
    const ki_texel *texel;
} ktx_header;

typedef struct ktx_level {
    const uint8_t *bytes;
    size_t size, plain_size;
} ktx_level;

static kiln_result read_header(ki_reader *r, const char *name, ktx_header *h, kiln_error *error)
{
    ki_read_bytes(r, sizeof identifier);
    h->vk = ki_read_u32(r);
    ki_read_u32(r); // type size
    h->width = ki_read_u32(r);
    h->height = ki_read_u32(r);
    h->depth = ki_read_u32(r);
    h->layers = ki_read_u32(r);
    h->faces = ki_read_u32(r);
    h->levels = ki_read_u32(r);
    h->scheme = ki_read_u32(r);
    ki_read_u32(r); // the format's descriptor; vkFormat says the same
    ki_read_u32(r);
    h->metadata_offset = ki_read_u32(r);
    h->metadata_size = ki_read_u32(r);
    ki_read_u64(r);
    ki_read_u64(r);
    if (r->failed)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the KTX2 header is cut off", name);
    if (h->faces != 6 || h->layers > 1 || h->depth != 0)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has %u faces, %u layers and depth %u, only single cubes are read", name,
                       h->faces, h->layers, h->depth);
    h->texel = ki_texel_of_vk(h->vk);
    if (!h->texel)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has vkFormat %u; 97, 109, 122 and 123 are read", name, h->vk);
    if (h->scheme != SCHEME_NONE && h->scheme != SCHEME_ZSTD)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has supercompression scheme %u; 0 and 2 (zstd) are read", name,
                       h->scheme);
    kiln_result known = h->scheme == SCHEME_ZSTD ? ki_zstd_known(name, error) : KILN_OK;
    if (known != KILN_OK)
        return known;
    if (h->width < 1 || h->width != h->height || h->width > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: faces are %u x %u, they must be square and 1 to %d", name, h->width,
                       h->height, KILN_MAX_SIZE);
    h->levels = h->levels ? h->levels : 1;
    if (h->levels > KILN_MAX_LEVELS || h->width >> (h->levels - 1) == 0)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: has %u levels for a size of %u", name,
                       h->levels, h->width);
    return KILN_OK;
}

// Every level's place and size is checked before memory is asked for.
static kiln_result find_levels(ki_reader *r, const uint8_t *bytes, size_t size, const char *name,
                               const ktx_header *h, ktx_level *levels, kiln_error *error)
{
    for (uint32_t k = 0; k < h->levels; k++) {
        uint64_t offset = ki_read_u64(r), length = ki_read_u64(r), plain = ki_read_u64(r);
        uint64_t edge = h->width >> k, wanted = 6 * edge * edge * (uint64_t)h->texel->bytes;
        if (r->failed || offset > size || length > size - offset)
            return ki_fail(error, KILN_ERROR_FORMAT,
                           "%s: level %u has %llu bytes at %llu, the file has %zu", name, k,
                           (unsigned long long)length, (unsigned long long)offset, size);
        levels[k] = (ktx_level){bytes + offset, (size_t)length, (size_t)wanted};
        uint64_t stated = length;
        if (h->scheme == SCHEME_ZSTD &&
            !ki_zstd_stated_size(levels[k].bytes, levels[k].size, &stated))
            return ki_fail(error, KILN_ERROR_FORMAT,
                           "%s: level %u is no zstd frame that states its size", name, k);
        if (plain != wanted || stated != wanted)
            return ki_fail(error, KILN_ERROR_FORMAT,
                           "%s: level %u holds %llu bytes, its six faces need %llu", name, k,
                           (unsigned long long)(plain != wanted ? plain : stated),
                           (unsigned long long)wanted);
        // zstd makes a byte into 43691 at most, a block of 128 KiB from three.
        if (wanted / 43691 > length)
            return ki_fail(error, KILN_ERROR_FORMAT, "%s: level %u is damaged", name, k);
    }
    return KILN_OK;
}

static kiln_result read_level(kiln_context *context, const char *name, const ktx_header *h,
                              const ktx_level *level, int k, kiln_map *map, kiln_error *error)
{
    const uint8_t *plain = level->bytes;
    uint8_t *unpacked = NULL;
    kiln_result result = KILN_OK;
    if (h->scheme == SCHEME_ZSTD) {
        unpacked = ki_alloc_raw(context, level->plain_size, 1);
        if (!unpacked)
            return ki_fail_memory(context, error, name, level->plain_size);
        const char *fault = ki_zstd_unpack(level->bytes, level->size, unpacked, level->plain_size);
        if (fault)
            result =
                ki_fail(error, KILN_ERROR_FORMAT, "%s: level %d is damaged: %s", name, k, fault);
        plain = unpacked;
    }
    if (result == KILN_OK)
        ki_texels_unpack(h->texel, plain, kiln_map_texels(map, k), map->level[k]);
    ki_free(unpacked);
    return result;
}

static void describe(const ktx_header *h, kiln_file_info *info)
{
    snprintf(info->format, sizeof info->format, "ktx2");
    snprintf(info->encoding, sizeof info->encoding, "%s%s", h->texel->name,
             h->scheme == SCHEME_ZSTD ? ", zstd" : "");
    info->width = info->height = (int)h->width;
    info->face_count = 6;
    info->level_count = (int)h->levels;
    info->channel_count = h->texel->bytes == 4 ? 3 : 4;
}

kiln_result ki_ktx2_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, kiln_map *map, kiln_file_info *info, kiln_error *error)
{
    if (map)
        *map = (kiln_map){0};
    ktx_header h = {0};
    ktx_level levels[KILN_MAX_LEVELS];
    ki_reader r = ki_reader_make(bytes, size);
    kiln_result result = read_header(&r, name, &h, error);
    if (result != KILN_OK || !h.texel)
        return result;
    describe(&h, info);
    if (h.metadata_offset <= size && h.metadata_size <= size - h.metadata_offset)
        read_metadata(bytes + h.metadata_offset, h.metadata_size, info);
    result = find_levels(&r, bytes, size, name, &h, levels, error);
    if (result != KILN_OK || !map)
        return result;

    *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = (int)h.width, .level_count = (int)h.levels};
    result = ki_map_allocate(context, map, error);
    for (int k = 0; k < (int)h.levels && result == KILN_OK; k++) {
        float linear = h.levels > 1 ? (float)k / (float)(h.levels - 1) : 0;
        map->roughness[k] = info->roughness[k] >= 0 ? info->roughness[k] : linear;
        result = read_level(context, name, &h, &levels[k], k, map, error);
    }
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}
