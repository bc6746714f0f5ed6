// Writes KTX2 cubes and tables of every format, with and without zstd, for check.mjs and
// libktx.mjs, and for oiiotool a DDS of random blocks, with what kiln reads of it.
#include "kit/random.h"

#include <kiln/brdf.h>

#include <stdio.h>

static const char *const names[] = {"rgba16f", "rgba32f", "rgb9e5", "b10g11r11", "bc6h", "uastc"};

// Number i of a table is i / 1024.
static kiln_result write_table(kiln_context *context, const char *folder, int index,
                               kiln_error *error)
{
    static const struct {
        kiln_table_kind kind;
        const char *name;
        int channels, depth;
    } kinds[] = {{KILN_TABLE_E, "e", 1, 1},         {KILN_TABLE_DFG, "dfg", 2, 1},
                 {KILN_TABLE_GLASS, "glass", 4, 1}, {KILN_TABLE_DFG_MULTISCATTER, "multi", 3, 1},
                 {KILN_TABLE_GLASS, "glass", 4, 5}, {KILN_TABLE_E_WALK, "walk", 1, 5}};
    static const char *const formats[] = {"auto", "f32", "f16", "u16", "u8"};
    int kind = index / 10, format = index % 5, zstd = index / 5 % 2;
    int channels = kinds[kind].channels, depth = kinds[kind].depth;
    kiln_table table = {.def = {.kind = kinds[kind].kind,
                                .width = 7,
                                .height = 3,
                                .depth = depth,
                                .axis = KILN_AXIS_CBRT,
                                .corners = true}};
    kiln_result result = kiln_image_create(context, 7, 3 * depth, channels, &table.image, error);
    for (int i = 0; result == KILN_OK && i < 21 * depth * channels; i++)
        table.image.pixels[i] = (float)i / 1024;
    char path[512];
    snprintf(path, sizeof path, "%s/table-%s-%s-%s-%d-%d.ktx2", folder, kinds[kind].name,
             formats[format], zstd ? "zstd" : "plain", channels, depth);
    kiln_table_save_def def = {.format = (kiln_table_format)format, .zstd = zstd ? 5 : 0};
    if (result == KILN_OK)
        result = kiln_table_save(context, &table, path, &def, error);
    kiln_table_free(&table);
    return result;
}

enum { BLOCKS = 32, SIZE = 4 * BLOCKS }; // along an edge

// Whatever bits blocks may have: six faces of one level, and the same as a picture, face below
// face.
static kiln_result write_blocks(kiln_context *context, const char *folder, kiln_error *error)
{
    char dds[512], exr[512];
    snprintf(dds, sizeof dds, "%s/blocks.dds", folder);
    snprintf(exr, sizeof exr, "%s/blocks.exr", folder);
    kiln_map map, back = {0};
    kiln_save_def def = {.format = KILN_FORMAT_BC6H};
    kiln_result result = kiln_map_create(context, KILN_SHAPE_CUBE, SIZE, 1, &map, error);
    if (result == KILN_OK)
        result = kiln_map_save(context, &map, dds, &def, NULL, error);
    kiln_map_free(&map);
    FILE *file = result == KILN_OK ? fopen(dds, "r+b") : NULL;
    if (!file)
        return result ? result : KILN_ERROR_IO;
    uint64_t seed = 1;
    fseek(file, 148, SEEK_SET);
    for (int i = 0; i < 6 * BLOCKS * BLOCKS * 16; i++)
        fputc((int)(random_bits(&seed) & 0xff), file);
    fclose(file);
    result = kiln_map_load(context, dds, NULL, &back, error);
    kiln_image image = {SIZE, 6 * SIZE, 3, back.level[0], NULL};
    if (result == KILN_OK)
        result = kiln_image_save(context, &image, exr, error);
    kiln_map_free(&back);
    return result;
}

// The flat picture that three.js up to r186 reads, in UASTC HDR.
static kiln_result write_flat(kiln_context *context, const char *folder, kiln_error *error)
{
    char path[512];
    kiln_map sky = {0};
    kiln_environment made = {0};
    const kiln_bake_def def = {.levels = {.size = 64},
                               .engine = kiln_engine_find("three-cubeuv"),
                               .tune = KILN_TUNE_NONE,
                               .irradiance_size = KILN_NO_IRRADIANCE};
    snprintf(path, sizeof path, "%s/cubeuv.ktx2", folder);
    kiln_result result =
        kiln_sky(context, &(kiln_sky_def){.size = 64, .elevation = 20}, &sky, error);
    if (result == KILN_OK)
        result = kiln_bake(context, &sky, &def, &made, error);
    if (result == KILN_OK)
        result = kiln_engine_save(context, def.engine, &made.levels, &made.sh, KILN_FORMAT_UASTC,
                                  path, NULL, error);
    kiln_environment_free(&made);
    kiln_map_free(&sky);
    return result;
}

int main(int argc, char **argv)
{
    kiln_context *context;
    kiln_error error = {0};
    if (argc != 2 || kiln_context_create(NULL, &context, &error))
        return 2;
    kiln_sh sh = {.bands = 2, .c = {{1, 2, 3}, {-0.5, 0, 0.125}}};
    for (int i = 0; i < 24; i++) {
        int size = i < 12 ? 8 : 5, levels = i < 12 ? 4 : 2, format = i % 6, zstd = i / 6 % 2;
        kiln_map map;
        if (kiln_map_create(context, KILN_SHAPE_CUBE, size, levels, &map, &error))
            break;
        for (int k = 0; k < levels; k++) {
            map.roughness[k] = (float)k / 8;
            for (size_t t = 0; t < kiln_map_texels(&map, k); t++) {
                map.level[k][3 * t] = (float)t + (float)k / 4;
                map.level[k][3 * t + 1] = 2 * (float)t;
                map.level[k][3 * t + 2] = 0.5f;
            }
        }
        char path[512];
        snprintf(path, sizeof path, "%s/%s-%s-%d-%d.ktx2", argv[1], names[format],
                 zstd ? "zstd" : "plain", size, levels);
        kiln_save_def def = {.format = format == 5 ? KILN_FORMAT_UASTC
                                                   : (kiln_format)(KILN_FORMAT_RGBA16F + format),
                             .zstd = zstd ? 5 : 0,
                             .sh = &sh,
                             .lobe = "ggx"};
        kiln_result result = kiln_map_save(context, &map, path, &def, NULL, &error);
        kiln_map_free(&map);
        if (result)
            break;
    }
    for (int i = 0; i < 60 && error.result == KILN_OK; i++)
        if (write_table(context, argv[1], i, &error))
            break;
    if (!error.result && write_flat(context, argv[1], &error))
        error.result = error.result ? error.result : KILN_ERROR_IO;
    if (!error.result && write_blocks(context, argv[1], &error))
        error.result = error.result ? error.result : KILN_ERROR_IO;
    kiln_context_destroy(context);
    if (error.result)
        fprintf(stderr, "%s\n", error.message);
    return error.result != KILN_OK;
}
