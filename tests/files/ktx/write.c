// Writes KTX2 cubes and tables of every format, with and without zstd, for check.mjs.
#include <kiln/kiln.h>

#include <stdio.h>

static const char *const names[] = {"rgba16f", "rgba32f", "rgb9e5", "b10g11r11"};

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

int main(int argc, char **argv)
{
    kiln_context *context;
    kiln_error error = {0};
    if (argc != 2 || kiln_context_create(NULL, &context, &error))
        return 2;
    kiln_sh sh = {.bands = 2, .c = {{1, 2, 3}, {-0.5, 0, 0.125}}};
    for (int i = 0; i < 16; i++) {
        int size = i < 8 ? 8 : 5, levels = i < 8 ? 4 : 2, format = i % 4, zstd = i / 4 % 2;
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
        kiln_save_def def = {.format = (kiln_format)(KILN_FORMAT_RGBA16F + format),
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
    kiln_context_destroy(context);
    if (error.result)
        fprintf(stderr, "%s\n", error.message);
    return error.result != KILN_OK;
}
