// Binary glTF 2.0: 12 bytes of header, a chunk of JSON that ends in spaces, a chunk of bytes that ends in
// zeros. The images of a light of EXT_lights_image_based are PNG in RGBD, level by level, face by face.
// The extension's figure has v upward and glTF has it downward: rows are from the bottom up.
#include "codec/gltf.h"

#include "codec/decimal.h"
#include "codec/rgbx_png.h"
#include "image/image.h"

enum {
    MAGIC = 0x46546c67,
    VERSION = 2,
    HEADER = 12,
    CHUNK_JSON = 0x4e4f534a,
    CHUNK_BIN = 0x4e4942
};

static kiln_result write_images(const kiln_map *map, ki_writer *json, ki_writer *images,
                                kiln_error *error)
{
    kiln_result result = KILN_OK;
    ki_write_text(json, "\"bufferViews\":[");
    for (int i = 0; i < 6 * map->level_count && result == KILN_OK; i++) {
        int n = kiln_map_level_size(map, i / 6);
        size_t begin = images->size;
        const kiln_image face = {
            n, n, 3, map->level[i / 6] + 3 * (size_t)(i % 6) * (size_t)n * (size_t)n, NULL};
        result = ki_rgbx_png_encode(&face, ki_rgbd_from_float, true, images, error);
        ki_write_text(json, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", i ? "," : "",
                      begin, images->size - begin);
        ki_write_align(images, 4);
    }
    ki_write_text(json, "],\"buffers\":[{\"byteLength\":%zu}],\"images\":[", images->size);
    for (int i = 0; i < 6 * map->level_count; i++)
        ki_write_text(json, "%s{\"bufferView\":%d,\"mimeType\":\"image/png\"}", i ? "," : "", i);
    ki_write_text(json, "]");
    return result;
}

static void write_light(const kiln_map *map, double irradiance[9][3], ki_writer *json)
{
    ki_write_text(json, "{\"intensity\":1,\"rotation\":[0,0,0,1],\"irradianceCoefficients\":[");
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++) {
            ki_write_text(json, "%s", c ? "," : i ? ",[" : "[");
            ki_write_number(json, irradiance[i][c]);
            ki_write_text(json, c == 2 ? "]" : "");
        }
    ki_write_text(json, "],\"specularImageSize\":%d,\"specularImages\":[", map->size);
    for (int i = 0; i < 6 * map->level_count; i++)
        ki_write_text(json, "%s%d%s", i % 6 ? "," : i ? ",[" : "[", i, i % 6 == 5 ? "]" : "");
    ki_write_text(json, "]}");
}

kiln_result ki_gltf_encode(const kiln_map *map, double irradiance[9][3], ki_writer *w,
                           kiln_error *error)
{
    ki_writer json = {.context = w->context}, images = json;
    ki_write_text(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"kiln %s\"},",
                  kiln_version());
    kiln_result result = write_images(map, &json, &images, error);
    ki_write_text(&json, ",\"extensionsUsed\":[\"EXT_lights_image_based\"],"
                         "\"extensions\":{\"EXT_lights_image_based\":{\"lights\":[");
    write_light(map, irradiance, &json);
    ki_write_text(&json, "]}},\"scene\":0,\"scenes\":[{\"extensions\":{\"EXT_lights_image_based\":"
                         "{\"light\":0}}}]}");
    while (json.size % 4 && !json.failed)
        ki_write_u8(&json, ' ');
    const size_t size = HEADER + 8 + json.size + 8 + images.size;
    ki_write_u32(w, MAGIC);
    ki_write_u32(w, VERSION);
    ki_write_u32(w, (uint32_t)size);
    ki_write_u32(w, (uint32_t)json.size);
    ki_write_u32(w, CHUNK_JSON);
    ki_write(w, json.bytes, json.size);
    ki_write_u32(w, (uint32_t)images.size);
    ki_write_u32(w, CHUNK_BIN);
    ki_write(w, images.bytes, images.size);
    if (result == KILN_OK && (w->failed || json.failed || images.failed))
        result = ki_fail_memory(w->context, error, "a glTF file", size);
    ki_writer_free(&json);
    ki_writer_free(&images);
    return result;
}
