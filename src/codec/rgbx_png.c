#include "codec/rgbx_png.h"

#include "codec/codec.h"

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
