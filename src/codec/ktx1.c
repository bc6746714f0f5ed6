// KTX version 1 cubes of halves, or of 11, 11 and 10 bits.
#include "codec/ktx1.h"

#include "codec/pixel_format.h"

#include <string.h>

enum {
    ORDER = 0x04030201,
    GL_HALF_FLOAT = 0x140b,
    GL_RGB = 0x1907,
    GL_RGBA = 0x1908,
    GL_RGBA16F = 0x881a,
    GL_R11F_G11F_B10F = 0x8c3a,
};

// glType, glTypeSize, glFormat, glInternalFormat, glBaseInternalFormat. The packed one is as Filament's
// cmgen writes it, which its reader insists on; KTX means 0x8c3b, 4 and RGB by the first two and the last.
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
    ki_write_u32(w, 0); // depth
    ki_write_u32(w, 0); // no array
    ki_write_u32(w, 6);
    ki_write_u32(w, (uint32_t)level_count);
}

// Key and value each end in NUL; the pair's size comes before it, zeros up to 4 bytes behind it.
static void write_pair(ki_writer *w, const char *key, const char *value)
{
    size_t size = strlen(key) + strlen(value) + 2;
    ki_write_u32(w, (uint32_t)(4 + (size + 3) / 4 * 4));
    ki_write_u32(w, (uint32_t)size);
    ki_write(w, key, strlen(key) + 1);
    ki_write(w, value, strlen(value) + 1);
    ki_write_align(w, 4);
}

kiln_result ki_ktx1_encode(const kiln_map *map, int first, int count, kiln_format format,
                           const char *key, const char *value, ki_writer *writer, kiln_error *error)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(format);
    bool packed = format == KILN_FORMAT_B10G11R11;
    write_header(writer, packed ? packed_types : half_types, kiln_map_level_size(map, first),
                 count);
    if (key && value)
        write_pair(writer, key, value);
    else
        ki_write_u32(writer, 0);
    for (int k = first; k < first + count; k++) {
        // The size of a level of a cube is that of one face. Faces of 4 and 8 bytes a texel need no padding.
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
