// Any bytes into a decoder. A decoder that describes a file without reading its texels must succeed
// wherever reading succeeds; failures must name the file; texels must be finite after mending.
#include "fuzz.h"

#include "codec/codec.h"
#include "codec/env.h"
#include "codec/galacean_env.h"
#include "codec/gltf.h"
#include "image/mend.h"

#include <stdlib.h>
#include <string.h>

enum { MEMORY = 64 << 20 };

// A table holds finite numbers, and so does a picture or a cube after mending, unless none of its
// texels was a number.
static void check_texels(kiln_context *context, ki_decoded *decoded)
{
    kiln_error error = {0};
    kiln_load_report report = {0};
    kiln_image *image = &decoded->image;
    kiln_map *map = &decoded->map;
    kiln_result result = KILN_OK;
    if (decoded->is_map)
        result = ki_map_mend(context, "fuzz", KILN_NEGATIVE_KEEP, map, &report, &error);
    else if (!decoded->is_table)
        result = ki_image_mend(context, "fuzz", image, &report, &error);
    fuzz_must(result == KILN_OK || result == KILN_ERROR_FORMAT || result == KILN_ERROR_MEMORY);
    for (int k = 0; result == KILN_OK && decoded->is_map && k < map->level_count; k++)
        fuzz_must_be_finite(map->level[k], 3 * kiln_map_texels(map, k));
    if (result == KILN_OK && !decoded->is_map)
        fuzz_must_be_finite(image->pixels,
                            (size_t)image->width * (size_t)image->height * (size_t)image->channels);
}

static void check_failure(kiln_result result, const kiln_error *error)
{
    fuzz_must(result == KILN_ERROR_MEMORY || strstr(error->message, "fuzz"));
}

// Describes and reads the file. Returns whether it can be read; *described says whether it can be
// described.
static bool decode(kiln_context *context, const uint8_t *bytes, size_t size, kiln_file_info *info,
                   kiln_result *described)
{
    kiln_error error = {0};
    ki_decoded decoded;
    *described = ki_decode(context, bytes, size, "fuzz", NULL, info, &error);
    if (*described == KILN_OK)
        fuzz_check_info(info);
    kiln_file_info again;
    kiln_result result = ki_decode(context, bytes, size, "fuzz", &decoded, &again, &error);
    fuzz_must(result != KILN_OK || *described == KILN_OK);
    if (result == KILN_OK)
        check_texels(context, &decoded);
    else
        check_failure(result, &error);
    ki_decoded_free(&decoded);
    return result == KILN_OK;
}

// Every layer that is listed may be asked for.
static void read_layers(kiln_context *context, const uint8_t *bytes, size_t size,
                        const kiln_file_info *info)
{
    enum { MOST = 4 };
    kiln_error error = {0};
    ki_decoded decoded;
    for (int i = 0; i < info->layer_count && i < MOST; i++) {
        kiln_result result = ki_decode_layer(context, bytes, size, "fuzz", info->layer[i].name,
                                             &decoded, NULL, &error);
        if (result == KILN_OK)
            check_texels(context, &decoded);
        else
            check_failure(result, &error);
        ki_decoded_free(&decoded);
    }
}

// Puts a small picture onto the sphere in each layout.
static void lay_out(kiln_context *context, const uint8_t *bytes, size_t size)
{
    kiln_error error = {0};
    kiln_map map;
    for (int layout = KILN_LAYOUT_AUTO; layout <= KILN_LAYOUT_BALL; layout++) {
        const kiln_load_def def = {.layout = (kiln_layout)layout,
                                   .negative = size % 2 ? KILN_NEGATIVE_ZERO : KILN_NEGATIVE_KEEP};
        kiln_result result = kiln_map_decode(context, bytes, size, "fuzz", &def, &map, &error);
        if (result == KILN_OK)
            fuzz_must_be_finite(map.level[0], 3 * kiln_map_texels(&map, 0));
        else
            check_failure(result, &error);
        kiln_map_free(&map);
    }
}

// Reads the levels of a file that ki_decode only describes: of Babylon.js, glTF or Galacean Engine.
// A file of Galacean Engine has no magic bytes: bytes that begin like another format are of that
// format.
static void read_cube(kiln_context *context, const uint8_t *bytes, size_t size,
                      kiln_result described, const kiln_file_info *info)
{
    kiln_error error = {0};
    kiln_map map = {0};
    kiln_result result;
    if (ki_env_begins(bytes, size))
        result = ki_env_decode(context, bytes, size, "fuzz", &map, &error);
    else if (size >= 4 && !memcmp(bytes, "glTF", 4))
        result = ki_gltf_decode(context, bytes, size, "fuzz", &map, &error);
    else if (described == KILN_OK && !strcmp(info->format, "galacean env"))
        result = ki_galacean_env_decode(context, bytes, size, &map, &error);
    else
        return;
    fuzz_must(result != KILN_OK || described == KILN_OK);
    for (int k = 0; result == KILN_OK && k < map.level_count; k++) {
        fuzz_must_be_finite(map.level[k], 3 * kiln_map_texels(&map, k));
        fuzz_must(map.roughness[k] >= 0 && map.roughness[k] <= 1);
    }
    if (result != KILN_OK)
        check_failure(result, &error);
    kiln_map_free(&map);
}

void fuzz_decode(const uint8_t *bytes, size_t size)
{
    enum { SMALL = 32 };
    kiln_context *context = fuzz_context(MEMORY);
    kiln_file_info info;
    kiln_result described;
    if (decode(context, bytes, size, &info, &described)) {
        read_layers(context, bytes, size, &info);
        if (info.width <= 2 * SMALL && info.height <= SMALL)
            lay_out(context, bytes, size);
    }
    read_cube(context, bytes, size, described, &info);
    fuzz_end(context);
}

// A file of Galacean Engine has no magic bytes. The first byte of the input chooses the size of a
// face, and the file is made as long as this size demands.
void fuzz_galacean(const uint8_t *bytes, size_t size)
{
    enum { HARMONICS = 108, SIZES = 4 };
    int side = 1 << (size ? bytes[0] % SIZES : 0);
    size_t whole = HARMONICS + 2;
    for (int n = side; n; n /= 2)
        whole += (size_t)(24 * n * n);
    uint8_t *file = calloc(whole, 1);
    fuzz_must(file != NULL);
    if (size > 1)
        memcpy(file, bytes + 1, size - 1 < whole ? size - 1 : whole);
    file[HARMONICS] = (uint8_t)side;
    file[HARMONICS + 1] = 0;
    fuzz_must(ki_galacean_env_begins(file, whole));
    fuzz_decode(file, whole);
    free(file);
}

void fuzz_harmonics(const uint8_t *bytes, size_t size)
{
    static const struct {
        const char *first;
        size_t size;
    } begins[] = {{"{\"bands\"", 8},
                  {"// Spherical harmonics of ", 26},
                  {"0 0 0 ; Y0,0\n", 13},
                  {"(0, 0, 0); // L00, irradiance, pre-scaled base", 46}};
    uint8_t kind = size ? bytes[0] % 5 : 4;
    if (kind == 4) { // as it is
        uint8_t *copy = (uint8_t *)fuzz_text(bytes, size);
        fuzz_decode(copy, size);
        free(copy);
        return;
    }
    size_t first = begins[kind].size;
    uint8_t *text = malloc(size - 1 + first);
    fuzz_must(text != NULL);
    memcpy(text, begins[kind].first, first);
    memcpy(text + first, bytes + 1, size - 1);
    fuzz_decode(text, size - 1 + first);
    free(text);
}
