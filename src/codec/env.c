// Babylon.js' environments: eight bytes, a JSON manifest that ends in NUL, and the images of a cube one
// after the other, level by level, face by face. Images are PNG in RGBD, their rows from the bottom up.
#include "codec/env.h"

#include "codec/decimal.h"
#include "codec/rgbx_png.h"
#include "image/image.h"

static const uint8_t magic[8] = {0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36};

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
    kiln_result result = KILN_OK;
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
        const kiln_image face = {
            n, n, 3, map->level[i / 6] + 3 * (size_t)(i % 6) * (size_t)n * (size_t)n, NULL};
        result = ki_rgbx_png_encode(&face, ki_rgbd_from_float, true, &images, error);
        ki_write_text(w, "%s{\"length\":%zu,\"position\":%zu}", i ? "," : "", images.size - begin,
                      begin);
    }
    ki_write_text(w, "]}}");
    ki_write_u8(w, 0);
    ki_write(w, images.bytes, images.size);
    if (result == KILN_OK && (w->failed || images.failed))
        result = ki_fail_memory(w->context, error, "an .env file", images.size);
    ki_writer_free(&images);
    return result;
}
