#include "codec/rgbx_png.h"

#include "codec/codec.h"

#include <string.h>

kiln_result ki_rgbx_png_encode(const kiln_image *image, ki_rgbx *pack, bool upward,
                               ki_writer *writer, kiln_error *error)
{
    size_t width = (size_t)image->width, height = (size_t)image->height;
    float *packed = ki_alloc_raw(writer->context, width * height, 4 * sizeof *packed);
    if (!packed)
        return ki_fail_memory(writer->context, error, "a PNG", 16 * width * height);
    for (size_t y = 0; y < height; y++) {
        const float *from = image->pixels + 3 * width * (upward ? height - 1 - y : y);
        for (size_t x = 0; x < width; x++)
            pack(from + 3 * x, packed + 4 * (y * width + x));
    }
    kiln_result result =
        ki_png_encode(packed, image->width, image->height, 4, KI_PNG_PLAIN8, writer, error);
    ki_free(packed);
    return result;
}

kiln_result ki_rgbd_png_decode_face(kiln_context *context, const uint8_t *bytes, size_t size,
                                    const char *name, int index, kiln_map *map, kiln_error *error)
{
    kiln_image image;
    int level = index / 6, n = kiln_map_level_size(map, level);
    size_t row = 3 * (size_t)n;
    kiln_result result =
        ki_png_decode_as(context, bytes, size, name, ki_float_from_rgbd, &image, NULL, NULL, error);
    if (result != KILN_OK)
        return result;
    if (image.width != n || image.height != n)
        result = ki_fail(error, KILN_ERROR_FORMAT,
                         "%s: image %d is %d x %d, a face of level %d must be %d x %d", name, index,
                         image.width, image.height, level, n, n);
    float *face = map->level[level] + (size_t)(index % 6) * (size_t)n * row;
    for (int y = 0; y < n && result == KILN_OK; y++)
        memcpy(face + (size_t)y * row, image.pixels + (size_t)(n - 1 - y) * row,
               row * sizeof *face);
    kiln_image_free(&image);
    return result;
}

kiln_result ki_rgbd_png_check_size(int size, uint64_t byte_count, const char *name,
                                   kiln_error *error)
{
    // Deflate makes at most 1032 bytes of one byte, and a texel has four bytes.
    uint64_t wanted = 24 * (uint64_t)size * (uint64_t)size;
    return wanted / 1032 <= byte_count
               ? KILN_OK
               : ki_fail(error, KILN_ERROR_FORMAT,
                         "%s: its images have %llu bytes, too few for six faces of size %d", name,
                         (unsigned long long)byte_count, size);
}
