// Writes a KTX2 cube of every format, with and without zstd, for check.mjs.
#include <kiln/kiln.h>

#include <stdio.h>

static const char *const names[] = {"rgba16f", "rgba32f", "rgb9e5", "b10g11r11"};

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
    kiln_context_destroy(context);
    if (error.result)
        fprintf(stderr, "%s\n", error.message);
    return error.result != KILN_OK;
}
