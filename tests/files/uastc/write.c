// Writes blocks of UASTC HDR for the comparison with other decoders: uastc_write FOLDER
// In: nothing. Out: blocks.ktx2, a picture of COLUMNS x ROWS blocks, first random blocks of every
// mode, then what the encoder makes of noise, slopes and edges; blocks.rgb, the texels of that
// picture as kiln decodes them; blocks.modes, the mode of each block.
#include "codec/ktx2.h"
#include "codec/uastc.h"
#include "kit/kit.h"

#include <stdio.h>

enum { COLUMNS = 64, ROWS = 96, BLOCKS = COLUMNS * ROWS, RANDOM = 24 * 128, BYTES = 16 * BLOCKS };

static void random_block(uint64_t *seed, int mode, uint8_t *bytes)
{
    ki_uastc_block b, back;
    do {
        b = (ki_uastc_block){.mode = mode};
        for (int c = 0; c < 3; c++)
            b.solid[c] = (uint16_t)(random_bits(seed) % 0x7c00);
        if (mode != KI_UASTC_SOLID) {
            const ki_uastc_mode *m = &ki_uastc_modes[mode];
            b.partition = (int)(random_bits(seed) % KI_UASTC_PARTITIONS);
            for (int i = 0; i < 12; i++)
                b.value[i / 6][i % 6] =
                    (uint8_t)ki_uastc_quantize((int)(random_bits(seed) % 256), m->values, 0);
            for (int i = 0; i < 16; i++)
                b.index[i] = (uint8_t)(random_bits(seed) % ki_uastc_levels[m->weights]);
        }
        ki_uastc_pack(&b, bytes);
    } while (!ki_uastc_unpack(bytes, &back));
}

// A block of noise around a colour, of a slope, or of an edge between two colours.
static void encoded_block(uint64_t *seed, int kind, uint8_t *bytes)
{
    float rgb[16][3], color[2][3];
    for (int c = 0; c < 6; c++)
        color[c / 3][c % 3] = (float)exp2((double)(random_bits(seed) % 30000) / 1000 - 14);
    float range = (float)(random_bits(seed) % 1000) / 500;
    for (int i = 0; i < 16; i++)
        for (int c = 0; c < 3; c++) {
            float noise = 1 + range * (float)(random_bits(seed) % 1000) / 1000;
            int steps = i % 4 + i / 4;
            float slope = 1 + range * (float)steps;
            rgb[i][c] = kind == 0   ? color[0][c] * noise
                        : kind == 1 ? color[0][c] * slope
                                    : color[i % 4 > i / 4][c] * noise;
        }
    ki_uastc_row_scalar(rgb[0], 4, 4, 0, bytes);
}

static void write_bytes(const char *folder, const char *name, const void *bytes, size_t size)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file)) {
        fprintf(stderr, "%s: cannot be written\n", path);
        exit(1);
    }
}

static bool copy_blocks(kiln_context *context, const void *data, int level, uint8_t *bytes)
{
    (void)context;
    (void)level;
    memcpy(bytes, data, BYTES);
    return true;
}

int main(int argc, char **argv)
{
    static uint8_t bytes[BYTES], modes[BLOCKS];
    static float rgb[16 * BLOCKS][3];
    uint64_t seed = 11;
    if (argc != 2)
        return 2;
    for (int i = 0; i < BLOCKS; i++) {
        ki_uastc_block b;
        if (i < RANDOM)
            random_block(&seed, i / (RANDOM / 24), bytes + (size_t)(16 * i));
        else
            encoded_block(&seed, i % 3, bytes + (size_t)(16 * i));
        if (!ki_uastc_unpack(bytes + (size_t)(16 * i), &b))
            return 1;
        modes[i] = (uint8_t)b.mode;
    }
    ki_uastc_decode(bytes, 4 * COLUMNS, 4 * ROWS, rgb[0]);
    kiln_context *context = make_context(1);
    ki_writer w = {.context = context};
    ki_ktx2_file file = {.vk = 1000066000,
                         .type_size = 1,
                         .texel_size = 16,
                         .block = 4,
                         .model = 167,
                         .width = 4 * COLUMNS,
                         .height = 4 * ROWS,
                         .face_count = 1,
                         .level_count = 1,
                         .sample_count = 1,
                         .samples = {{0, 128, KI_KTX2_FLOAT, 0, 0x3f800000}}};
    ki_ktx2_writer k;
    ki_ktx2_begin(&w, &file, &k);
    ki_ktx2_write_common(&w, "rd");
    kiln_error error;
    if (ki_ktx2_end_metadata(&k, &error) ||
        ki_ktx2_write_level(&k, 0, BYTES, copy_blocks, bytes, &error))
        return 1;
    write_bytes(argv[1], "blocks.ktx2", w.bytes, w.size);
    write_bytes(argv[1], "blocks.rgb", rgb, sizeof rgb);
    write_bytes(argv[1], "blocks.modes", modes, sizeof modes);
    ki_writer_free(&w);
    kiln_context_destroy(context);
    return 0;
}
