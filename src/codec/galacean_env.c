// Galacean Engine's .env files. In: a cube and harmonics. Out: bytes of a file; or of a file that
// is read, its description or its cube. A file is 27 floats of harmonics, the size of a face in 16
// bits, and the texels of all faces, level by level down to a single texel, four bytes each. A file
// has no magic bytes, so that files are recognised by their length, which the size of a face
// decides.
#include "codec/galacean_env.h"

#include "codec/file_info.h"
#include "image/image.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HARMONICS = 9 * 3 * 4, HEAD = HARMONICS + 2 };

// The engine's basis functions have the Condon-Shortley sign: those of odd m are negative
// (AmbientLight._preComputeSH).
static const double sign[9] = {1, -1, 1, -1, 1, -1, 1, -1, 1};

// ----------------------------------------------------------------------------------------- writing

// Stores radiance as 5 a c. The bytes of the multiplier a are rounded up, so that no colour c is
// above 1.
static void put_texel(const float rgb[3], uint8_t texel[4])
{
    const double step = (double)KI_GALACEAN_MAX / 255;
    double largest = fmax(fmax((double)rgb[0], (double)rgb[1]), (double)rgb[2]);
    double multiplier = fmin(fmax(ceil(largest / step), 1), 255);
    for (int c = 0; c < 3; c++) {
        double share = fmin(fmax((double)rgb[c], 0) / (multiplier * step), 1);
        texel[c] = (uint8_t)floor(share * 255 + 0.5);
    }
    texel[3] = (uint8_t)multiplier;
}

static void write_float(ki_writer *w, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    ki_write_u32(w, bits);
}

kiln_result ki_galacean_env_encode(const kiln_map *map, const kiln_sh *sh, ki_writer *w,
                                   kiln_error *error)
{
    for (int i = 0; i < 27; i++)
        write_float(w, (float)(sign[i / 3] * sh->c[i / 3][i % 3]));
    ki_write_u16(w, (uint16_t)map->size);
    for (int k = 0; k < map->level_count; k++)
        for (size_t i = 0; i < kiln_map_texels(map, k); i++) {
            uint8_t texel[4];
            put_texel(map->level[k] + 3 * i, texel);
            ki_write(w, texel, sizeof texel);
        }
    return w->failed ? ki_fail_memory(w->context, error, "an .env file", w->size) : KILN_OK;
}

// ----------------------------------------------------------------------------------------- reading

// Returns the number of levels of a cube whose faces have `size` texels along an edge, a power of
// two, and 0 for other sizes. Sets *byte_count to the length of the cube's file.
static int count_levels(int size, size_t *byte_count)
{
    int count = 0;
    *byte_count = HEAD;
    if (size < 1 || size > KILN_MAX_SIZE || (size & (size - 1)))
        return 0;
    for (; size >> count; count++)
        *byte_count += (size_t)6 * 4 * (size_t)(size >> count) * (size_t)(size >> count);
    return count;
}

static double read_float(ki_reader *r)
{
    uint32_t bits = ki_read_u32(r);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static float roughness_of(int level, int level_count)
{
    return level ? (float)level / (float)(level_count - 1) : 0;
}

// Sets radiance to 5 a c, with a and c in [0, 1].
static void take_texel(const uint8_t texel[4], float rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(KI_GALACEAN_MAX * (double)texel[3] * (double)texel[c] / (255.0 * 255.0));
}

static int size_of(const uint8_t *bytes)
{
    return bytes[HARMONICS] + 256 * bytes[HARMONICS + 1];
}

bool ki_galacean_env_begins(const uint8_t *bytes, size_t size)
{
    size_t wanted;
    return size > HEAD && count_levels(size_of(bytes), &wanted) && size == wanted;
}

kiln_result ki_galacean_env_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                     const char *name, kiln_file_info *info, kiln_error *error)
{
    (void)context, (void)name, (void)error; // ki_galacean_env_begins has checked the file
    ki_reader r = ki_reader_make(bytes, size);
    for (int i = 0; i < 27; i++)
        info->sh[i / 3][i % 3] = ki_info_number(sign[i / 3] * read_float(&r));
    info->sh_bands = 3;
    size_t byte_count;
    snprintf(info->format, sizeof info->format, "galacean env");
    snprintf(info->encoding, sizeof info->encoding, "8 bits rgbm");
    snprintf(info->engine, sizeof info->engine, "galacean");
    info->width = info->height = size_of(bytes);
    info->face_count = 6;
    info->level_count = count_levels(info->width, &byte_count);
    info->channel_count = 3;
    for (int k = 0; k < info->level_count; k++)
        info->roughness[k] = roughness_of(k, info->level_count);
    return KILN_OK;
}

kiln_result ki_galacean_env_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                                   kiln_map *map, kiln_error *error)
{
    size_t byte_count;
    ki_reader r = ki_reader_make(bytes, size);
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE,
                      .size = size_of(bytes),
                      .level_count = count_levels(size_of(bytes), &byte_count)};
    kiln_result result = ki_map_allocate(context, map, error);
    if (result != KILN_OK)
        return result;
    ki_read_bytes(&r, HEAD);
    for (int k = 0; k < map->level_count; k++) {
        map->roughness[k] = roughness_of(k, map->level_count);
        for (size_t i = 0; i < kiln_map_texels(map, k); i++) {
            if (i % KI_ASK_EVERY == 0 && !ki_go_on(context)) {
                kiln_map_free(map);
                return ki_fail_cancelled(error, "reading");
            }
            take_texel(ki_read_bytes(&r, 4), map->level[k] + 3 * i);
        }
    }
    return KILN_OK;
}
