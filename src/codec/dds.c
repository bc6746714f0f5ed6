// DDS files. In: a cube with its levels, or an engine's atlas. Out: bytes of a file; or of a file
// that is read, the cube or the flat picture. Cubes are written with the DX10 header. Files are
// read with that header, with the older codes of float formats, or with the masks of RGB and RGBA.
// DDS has no place for metadata. Each face is followed by its smaller levels.
#include "codec/codec.h"
#include "codec/file_info.h"
#include "codec/texels.h"
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
    if (!pixel || !pixel->dxgi)
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

// ----------------------------------------------------------------------------------------- reading

typedef struct dds_header {
    uint32_t width, height, levels;
    bool flat; // true: a 2-D texture, false: a cube
    char said[4 * RESERVED + 1];
    bool known;       // false: kiln does not read the pixel format
    bool stated;      // true: the pixel format says whether values of 8 bits are linear or sRGB
    uint32_t format;  // the header's number for the pixel format
    ki_texels texels; // how the texels are stored
} dds_header;

// Checks the pixel format, the size and the number of levels that the header states.
static kiln_result check_header(dds_header *h, const char *name, kiln_error *error)
{
    enum { DXGI_BC6H_SIGNED = 96 };
    if (!h->known && h->format == DXGI_BC6H_SIGNED)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: holds signed BC6H; kiln reads unsigned BC6H, and floats", name);
    if (!h->known)
        return ki_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s: has pixel format %u; kiln reads the DXGI formats 2, 6, 10, 11, 26, 28, "
            "29, 67, 87, 88, 91, 93 and 95, the older codes 36, 113 and 116, and RGB and "
            "RGBA of 8 bits by masks",
            name, h->format);
    if (h->width < 1 || h->height < 1 || (!h->flat && h->width != h->height) ||
        h->width > KILN_MAX_SIZE || h->height > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: %s %u x %u, they must be square with sides of 1 to %d", name,
                       h->flat ? "is" : "faces are", h->width, h->height, KILN_MAX_SIZE);
    h->levels = h->levels ? h->levels : 1;
    uint32_t longest = h->width > h->height ? h->width : h->height;
    if (h->levels > KILN_MAX_LEVELS || longest >> (h->levels - 1) == 0)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has %u levels, which is too many for faces of size %u", name, h->levels,
                       h->width);
    return KILN_OK;
}

// Finds the texels of the older header: a code, or the number of bits and the masks of the
// channels.
static void find_legacy(dds_header *h, uint32_t flags, uint32_t code, uint32_t bits,
                        const uint32_t masks[3])
{
    enum { FLAG_RGB = 0x40, RGBA16 = 36 };
    bool red_first = masks[0] == 0xff && masks[1] == 0xff00 && masks[2] == 0xff0000;
    bool blue_first = masks[0] == 0xff0000 && masks[1] == 0xff00 && masks[2] == 0xff;
    if ((flags & FORMAT_FOURCC) && code == RGBA16)
        h->texels = (ki_texels){KI_TEXEL_U16, 4, false, NULL};
    else if ((flags & FORMAT_FOURCC) && (code == LEGACY_RGBA16F || code == LEGACY_RGBA32F))
        ki_texels_of_dxgi(code == LEGACY_RGBA16F ? 10 : 2, &h->texels);
    else if ((flags & FLAG_RGB) && (bits == 24 || bits == 32) && (red_first || blue_first))
        h->texels = (ki_texels){KI_TEXEL_SRGB8, (int)bits / 8, blue_first, NULL};
    h->known = h->texels.channels > 0;
    h->format = code;
}

static kiln_result read_header(ki_reader *r, const char *name, dds_header *h, kiln_error *error)
{
    enum { CAPS2_VOLUME = 0x200000 };
    ki_read_bytes(r, 4);
    uint32_t header_size = ki_read_u32(r);
    ki_read_u32(r); // skips the flags, which many writers set wrongly
    h->height = ki_read_u32(r);
    h->width = ki_read_u32(r);
    ki_read_u32(r); // skips the pitch of a row or face
    ki_read_u32(r); // depth of a volume
    h->levels = ki_read_u32(r);
    const uint8_t *said = ki_read_bytes(r, sizeof h->said - 1);
    if (said)
        memcpy(h->said, said, sizeof h->said - 1);
    ki_read_u32(r);
    uint32_t flags = ki_read_u32(r), code = ki_read_u32(r), bits = ki_read_u32(r), masks[4];
    for (int i = 0; i < 4; i++)
        masks[i] = ki_read_u32(r);
    ki_read_u32(r);
    uint32_t caps2 = ki_read_u32(r);
    ki_read_bytes(r, 12);
    if (r->failed || header_size != HEADER_SIZE)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the DDS header is cut off or damaged", name);
    bool cube = (caps2 & CAPS2_CUBE) && (caps2 & CAPS2_ALL_FACES) == CAPS2_ALL_FACES;
    uint32_t count = 1, dimension = DIMENSION_2D;
    if ((flags & FORMAT_FOURCC) && code == fourcc("DX10")) {
        h->format = ki_read_u32(r);
        dimension = ki_read_u32(r);
        cube = ki_read_u32(r) & MISC_CUBE;
        count = ki_read_u32(r);
        ki_read_u32(r);
        h->stated = true;
        h->known = ki_texels_of_dxgi(h->format, &h->texels);
        if (r->failed)
            return ki_fail(error, KILN_ERROR_FORMAT, "%s: the DDS header is cut off", name);
    } else {
        find_legacy(h, flags, code, bits, masks);
    }
    h->flat = !cube && !(caps2 & (CAPS2_CUBE | CAPS2_VOLUME)) && dimension == DIMENSION_2D;
    if ((!cube && !h->flat) || count != 1)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: kiln reads DDS files of one cube with six faces or of one picture, and "
                       "this file holds something else",
                       name);
    return check_header(h, name, error);
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
    char name[KI_TEXELS_NAME];
    snprintf(info->format, sizeof info->format, "dds");
    snprintf(info->encoding, sizeof info->encoding, "%s", ki_texels_name(&h->texels, name));
    info->width = (int)h->width;
    info->height = (int)h->height;
    info->face_count = h->flat ? 1 : 6;
    info->level_count = (int)h->levels;
    info->channel_count = h->texels.channels;
    if (h->flat)
        describe_atlas(h, info);
}

// Returns the number of bytes of level k of a face.
static uint64_t level_bytes(const dds_header *h, int k)
{
    int width = ki_max(1, (int)h->width >> k), height = ki_max(1, (int)h->height >> k);
    return ki_texels_size(&h->texels, width, height, 1);
}

static kiln_result read_cube(kiln_context *context, const dds_header *h, ki_reader *r,
                             kiln_map *map, kiln_error *error)
{
    *map =
        (kiln_map){.shape = KILN_SHAPE_CUBE, .size = (int)h->width, .level_count = (int)h->levels};
    kiln_result result = ki_map_allocate(context, map, error);
    for (int i = 0; i < 6 * (int)h->levels && result == KILN_OK; i++) {
        int face = i / (int)h->levels, k = i % (int)h->levels, n = kiln_map_level_size(map, k);
        size_t texels = kiln_map_texels(map, k) / 6;
        const uint8_t *from = ki_read_bytes(r, (size_t)level_bytes(h, k));
        if (!ki_texels_read(context, &h->texels, from, n, n, 1,
                            map->level[k] + 3 * texels * (size_t)face))
            result = ki_fail_cancelled(error, "reading");
    }
    for (int k = 0; k < (int)h->levels && result == KILN_OK; k++)
        map->roughness[k] = h->levels > 1 ? (float)k / (float)(h->levels - 1) : 0;
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}

static kiln_result read_picture(kiln_context *context, const dds_header *h, ki_reader *r,
                                kiln_image *image, kiln_error *error)
{
    *image = (kiln_image){.width = (int)h->width, .height = (int)h->height, .channels = 3};
    kiln_result result = ki_image_allocate(context, image, error);
    const uint8_t *from = ki_read_bytes(r, (size_t)level_bytes(h, 0));
    if (result == KILN_OK &&
        !ki_texels_read(context, &h->texels, from, image->width, image->height, 1, image->pixels))
        result = ki_fail_cancelled(error, "reading");
    if (result != KILN_OK)
        kiln_image_free(image);
    return result;
}

kiln_result ki_dds_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, ki_decoded *decoded, kiln_file_info *info,
                          kiln_error *error)
{
    dds_header h = {0};
    ki_reader r = ki_reader_make(bytes, size);
    kiln_result result = read_header(&r, name, &h, error);
    if (result != KILN_OK)
        return result;
    uint64_t wanted = 0, faces = h.flat ? 1 : 6;
    for (int k = 0; k < (int)h.levels; k++)
        wanted += faces * level_bytes(&h, k);
    if (wanted > ki_reader_left(&r))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: its levels need %llu bytes, but only %zu bytes follow the header", name,
                       (unsigned long long)wanted, ki_reader_left(&r));
    describe(&h, info);
    ki_texels_note(&h.texels, h.stated, (int)h.levels, decoded ? &decoded->report : &info->report);
    if (!decoded)
        return KILN_OK;
    return h.flat ? read_picture(context, &h, &r, &decoded->image, error)
                  : read_cube(context, &h, &r, &decoded->map, error);
}
