// Babylon.js' environments: eight bytes, a JSON manifest that ends in NUL, and the images of a cube one
// after the other, level by level, face by face. Images are PNG in RGBD, their rows from the bottom up.
#include "codec/env.h"

#include "codec/rgbx.h"
#include "image/image.h"

static const uint8_t magic[8] = {0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36};

kiln_result ki_rgbd_png_encode(const float *texels, int n, float *scratch, ki_writer *w,
                               kiln_error *error)
{
    size_t row = (size_t)n;
    for (size_t y = 0; y < row; y++)
        for (size_t x = 0; x < row; x++)
            ki_rgbd_from_float(texels + 3 * ((row - 1 - y) * row + x), scratch + 4 * (y * row + x));
    return ki_png_encode(scratch, n, n, 4, KI_PNG_PLAIN8, w, error);
}

static void write_polynomial(ki_writer *w, double polynomial[9][3])
{
    static const char *const names[9] = {"x", "y", "z", "xx", "yy", "zz", "yz", "zx", "xy"};
    for (int i = 0; i < 9; i++) {
        ki_write_text(w, "%s\"%s\":[", i ? "," : "", names[i]);
        for (int c = 0; c < 3; c++) {
            ki_write_text(w, c ? "," : "");
            ki_write_number(w, polynomial[i][c]);
        }
        ki_write_text(w, "]");
    }
}

kiln_result ki_env_encode(const kiln_map *map, double lod_scale, double polynomial[9][3],
                          ki_writer *w, kiln_error *error)
{
    ki_writer images = {.context = w->context};
    size_t texels = (size_t)map->size * (size_t)map->size;
    float *scratch = ki_alloc_raw(w->context, texels, 4 * sizeof *scratch);
    kiln_result result = KILN_OK;
    if (!scratch)
        return ki_fail_memory(w->context, error, "an .env file", 16 * texels);
    ki_write(w, magic, sizeof magic);
    ki_write_text(w, "{\"version\":2,\"width\":%d,\"imageType\":\"image/png\",\"irradiance\":{",
                  map->size);
    write_polynomial(w, polynomial);
    ki_write_text(w, "},\"specular\":{\"lodGenerationScale\":");
    ki_write_number(w, lod_scale);
    ki_write_text(w, ",\"mipmaps\":[");
    for (int i = 0; i < 6 * map->level_count && result == KILN_OK; i++) {
        int n = kiln_map_level_size(map, i / 6);
        size_t begin = images.size;
        result = ki_rgbd_png_encode(map->level[i / 6] + 3 * (size_t)(i % 6) * (size_t)n * (size_t)n,
                                    n, scratch, &images, error);
        ki_write_text(w, "%s{\"length\":%zu,\"position\":%zu}", i ? "," : "", images.size - begin,
                      begin);
    }
    ki_write_text(w, "]}}");
    ki_write_u8(w, 0);
    ki_write(w, images.bytes, images.size);
    if (result == KILN_OK && (w->failed || images.failed))
        result = ki_fail_memory(w->context, error, "an .env file", images.size);
    ki_writer_free(&images);
    ki_free(scratch);
    return result;
}
