// DDS files. In: a cube with its levels, or an engine's atlas. Out: bytes of a file; or of a file
// that is read, the cube. Cubes are written with the DX10 header, and read with that header or with
// the two older codes of float formats. DDS has no place for metadata. Each face is followed by its
// smaller levels.
#include "codec/codec.h"
#include "codec/file_info.h"
#include "codec/pixel_format.h"
#include "image/pack.h"

#include <stdio.h>
#include <string.h>

enum {
    HEADER_SIZE = 124,
    // the flags that say which header fields are set: caps, height, width, format and number of
    // levels
    FLAGS = 0x1 | 0x2 | 0x4 | 0x1000 | 0x20000,
    FLAG_PITCH = 0x8, // flag: the field "pitch" holds the bytes of a row of texels
    // flag: the field "pitch" holds the bytes of a whole face, as for formats of blocks
    FLAG_LINEAR = 0x80000,
    FORMAT_SIZE = 32,
    FORMAT_FOURCC = 0x4,
    // flags of the picture: a texture, with more than one surface, with levels
    CAPS = 0x8 | 0x1000 | 0x400000,
    CAPS2_CUBE = 0x200,
    CAPS2_ALL_FACES = 0xfc00,
    DIMENSION_2D = 3,
    MISC_CUBE = 0x4,
    LEGACY_RGBA16F = 113,
    LEGACY_RGBA32F = 116,
    RESERVED_AT = 32, // offset of the eleven reserved words in the file
    RESERVED = 11,
};

static uint32_t fourcc(const char code[4])
{
    uint32_t value;
    memcpy(&value, code, 4);
    return value;
}

static kiln_result check(const kiln_map *map, const kiln_save_def *def, kiln_error *error)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(def->format);
    if (map->shape != KILN_SHAPE_CUBE)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "a DDS file holds a cube only, convert the map by kiln_map_convert");
    if (!pixel || !pixel->vk)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "format is %d, it must be 0 to %d",
                       (int)def->format, (int)KILN_FORMAT_BC6H);
    if (map->smallest > 1 && map->size >> (map->level_count - 1) < map->smallest)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "each level of a DDS file has half the size of the previous level, which "
                       "the map's smallest of %d prevents",
                       map->smallest);
    if (def->zstd)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "zstd is %d, it must be 0 because DDS files are not compressed", def->zstd);
    return KILN_OK;
}

static void write_zeros(ki_writer *w, int count)
{
    for (int i = 0; i < count; i++)
        ki_write_u32(w, 0);
}

static void write_header(const kiln_map *map, const ki_pixel_format *pixel, ki_writer *w)
{
    int rows = pixel->block > 1 ? map->size : 1;
    ki_write(w, "DDS ", 4);
    ki_write_u32(w, HEADER_SIZE);
    ki_write_u32(w, FLAGS | (pixel->block > 1 ? FLAG_LINEAR : FLAG_PITCH));
    ki_write_u32(w, (uint32_t)map->size);
    ki_write_u32(w, (uint32_t)map->size);
    ki_write_u32(w, (uint32_t)ki_pixels_size(pixel, map->size, rows));
    ki_write_u32(w, 0); // depth, which only volume textures have
    ki_write_u32(w, (uint32_t)map->level_count);
    write_zeros(w, RESERVED);
    ki_write_u32(w, FORMAT_SIZE);
    ki_write_u32(w, FORMAT_FOURCC);
    ki_write(w, "DX10", 4);
    // number of bits and the bit masks of the channels, which only formats without a code have
    write_zeros(w, 5);
    ki_write_u32(w, CAPS);
    ki_write_u32(w, CAPS2_CUBE | CAPS2_ALL_FACES);
    write_zeros(w, 3);
    ki_write_u32(w, pixel->dxgi);
    ki_write_u32(w, DIMENSION_2D);
    ki_write_u32(w, MISC_CUBE);
    ki_write_u32(w, 1); // array size: one cube
    ki_write_u32(w, 0); // alpha mode: unknown
}

kiln_result ki_dds_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *w,
                          kiln_error *error)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(def->format);
    kiln_result result = check(map, def, error);
    if (result != KILN_OK || !pixel)
        return result;
    write_header(map, pixel, w);
    for (int i = 0; i < 6 * map->level_count; i++) {
        int face = i / map->level_count, k = i % map->level_count, n = kiln_map_level_size(map, k);
        size_t texels = kiln_map_texels(map, k) / 6;
        uint8_t *room = ki_write_room(w, (size_t)ki_pixels_size(pixel, n, n));
        if (!room)
            return ki_fail_memory(w->context, error, "a DDS file", w->size);
        if (!ki_pixels_pack(w->context, pixel, map->level[k] + 3 * texels * (size_t)face, n, n, 1,
                            room))
            return ki_fail_cancelled(error, "writing");
    }
    return KILN_OK;
}

// Writes an atlas, one flat picture with all levels, with the older header of DDS. Its format code
// 113 stands for four halves a texel. Readers ignore the header's reserved words, in which kiln
// stores its version and the name of the engine, for example "kiln 0.2.0 playcanvas-dds".
kiln_result ki_dds_encode_atlas(const kiln_image *image, const char *engine, ki_writer *w,
                                kiln_error *error)
{
    uint32_t size = (uint32_t)image->width;
    size_t start = w->size, count = 4 * (size_t)size * size;
    const uint32_t header[31] = {HEADER_SIZE,   0x100f,         size,
                                 size,          8 * size,       [18] = FORMAT_SIZE,
                                 FORMAT_FOURCC, LEGACY_RGBA16F, [26] = 0x1000};
    char said[4 * RESERVED + 1];
    snprintf(said, sizeof said, "kiln %s %s", kiln_version(), engine);
    ki_write(w, "DDS ", 4);
    for (int i = 0; i < 31; i++)
        ki_write_u32(w, header[i]);
    uint8_t *room = ki_write_room(w, 2 * count);
    if (!room)
        return ki_fail_memory(w->context, error, "a DDS file", w->size);
    memcpy(w->bytes + start + RESERVED_AT, said, strlen(said));
    ki_halfs_from_floats(image->pixels, count, (uint16_t *)(void *)room);
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------ reading

typedef struct dds_header {
    uint32_t width, height, levels;
    // True: the file is only described and no texels are read. Flat pictures are then accepted too.
    bool describing;
    bool flat;
    char said[4 * RESERVED + 1];
    const ki_pixel_format *pixel;
} dds_header;

// Checks the size, the number of levels and the pixel format that the header states. `format` is
// the header's number for the pixel format, which the error message names.
static kiln_result check_header(dds_header *h, uint32_t format, const char *name, kiln_error *error)
{
    if (!h->pixel)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has pixel format %u; kiln reads the DXGI formats 2, 10, 26, 67 and 95 "
                       "and the older codes 113 and 116",
                       name, format);
    if (h->width < 1 || h->width != h->height || h->width > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: faces are %u x %u, they must be square with sides of 1 to %d", name,
                       h->width, h->height, KILN_MAX_SIZE);
    h->levels = h->levels ? h->levels : 1;
    if (h->levels > KILN_MAX_LEVELS || h->width >> (h->levels - 1) == 0)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has %u levels, which is too many for faces of size %u", name, h->levels,
                       h->width);
    return KILN_OK;
}

static kiln_result read_header(ki_reader *r, const char *name, dds_header *h, kiln_error *error)
{
    ki_read_bytes(r, 4);
    uint32_t header_size = ki_read_u32(r);
    ki_read_u32(r); // skips the flags, which many writers set wrongly
    h->height = ki_read_u32(r);
    h->width = ki_read_u32(r);
    ki_read_u32(r); // skips the pitch of a row or face
    ki_read_u32(r); // skips the depth of a volume texture
    h->levels = ki_read_u32(r);
    const uint8_t *said = ki_read_bytes(r, sizeof h->said - 1);
    if (said)
        memcpy(h->said, said, sizeof h->said - 1);
    ki_read_u32(r);
    uint32_t format_flags = ki_read_u32(r), code = ki_read_u32(r);
    ki_read_bytes(r, 20);
    ki_read_u32(r);
    uint32_t caps2 = ki_read_u32(r);
    ki_read_bytes(r, 12);
    if (r->failed || header_size != HEADER_SIZE)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the DDS header is cut off or damaged", name);
    bool cube = (caps2 & CAPS2_CUBE) && (caps2 & CAPS2_ALL_FACES) == CAPS2_ALL_FACES;
    uint32_t format = 0, cubes = 1;
    if ((format_flags & FORMAT_FOURCC) && code == fourcc("DX10")) {
        format = ki_read_u32(r);
        ki_read_u32(r);
        cube = ki_read_u32(r) & MISC_CUBE;
        cubes = ki_read_u32(r);
        ki_read_u32(r);
        h->pixel = ki_pixel_format_of_dxgi(format);
        if (r->failed)
            return ki_fail(error, KILN_ERROR_FORMAT, "%s: the DDS header is cut off", name);
    } else if (format_flags & FORMAT_FOURCC) {
        h->pixel = code == LEGACY_RGBA16F   ? ki_pixel_format_of(KILN_FORMAT_RGBA16F)
                   : code == LEGACY_RGBA32F ? ki_pixel_format_of(KILN_FORMAT_RGBA32F)
                                            : NULL;
        format = code;
    } else {
        h->pixel = NULL;
    }
    h->flat = h->describing && !cube && !caps2;
    if ((!cube && !h->flat) || cubes != 1)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: kiln reads DDS files of one cube with six faces, and this file holds "
                       "something else",
                       name);
    return check_header(h, format, name, error);
}

// Fills in `info` from the text "kiln VERSION ENGINE" in an atlas that kiln wrote.
static void describe_atlas(const dds_header *h, kiln_file_info *info)
{
    const char *engine = strrchr(h->said, ' ');
    if (strncmp(h->said, "kiln ", 5) != 0 || engine < h->said + 5)
        return;
    char writer[sizeof h->said] = "";
    memcpy(writer, h->said, (size_t)(engine - h->said));
    ki_copy_printable(info->writer, sizeof info->writer, writer);
    ki_copy_printable(info->engine, sizeof info->engine, engine + 1);
    snprintf(info->layout, sizeof info->layout, "atlas");
}

static void describe(const dds_header *h, kiln_file_info *info)
{
    snprintf(info->format, sizeof info->format, "dds");
    snprintf(info->encoding, sizeof info->encoding, "%s", ki_format_names[h->pixel->format]);
    info->width = info->height = (int)h->width;
    info->face_count = h->flat ? 1 : 6;
    info->level_count = (int)h->levels;
    info->channel_count = h->pixel->channels;
    if (h->flat)
        describe_atlas(h, info);
}

kiln_result ki_dds_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, ki_decoded *decoded, kiln_file_info *info,
                          kiln_error *error)
{
    dds_header h = {.describing = !decoded};
    ki_reader r = ki_reader_make(bytes, size);
    kiln_result result = read_header(&r, name, &h, error);
    if (result != KILN_OK || !h.pixel)
        return result;
    uint64_t wanted = 0, faces = h.flat ? 1 : 6;
    for (uint32_t k = 0; k < h.levels; k++)
        wanted += faces * ki_pixels_size(h.pixel, (int)h.width >> k, (int)h.width >> k);
    if (wanted > ki_reader_left(&r))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: its levels need %llu bytes, but only %zu bytes follow the header", name,
                       (unsigned long long)wanted, ki_reader_left(&r));
    describe(&h, info);
    if (!decoded)
        return KILN_OK;

    kiln_map *map = &decoded->map;
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = (int)h.width, .level_count = (int)h.levels};
    result = ki_map_allocate(context, map, error);
    if (result != KILN_OK)
        return result;
    for (int face = 0; face < 6; face++) {
        for (int k = 0; k < map->level_count; k++) {
            int n = kiln_map_level_size(map, k);
            size_t texels = kiln_map_texels(map, k) / 6;
            const uint8_t *from = ki_read_bytes(&r, (size_t)ki_pixels_size(h.pixel, n, n));
            ki_pixels_unpack(h.pixel, from, n, n, map->level[k] + 3 * texels * (size_t)face);
        }
    }
    for (int k = 0; k < map->level_count; k++)
        map->roughness[k] = map->level_count > 1 ? (float)k / (float)(map->level_count - 1) : 0;
    return KILN_OK;
}
