// Writes pictures for other programs to read: write FOLDER makes PNG files of every coding and
// number of channels, plain_N.exr with the values that their 8 bits stand for, fine_N.exr with
// those of 16 bits, and half_N.exr beside float_N.exr.
#include "codec/codec.h"
#include "image/pack.h"
#include "kit/random.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 230, HEIGHT = 171, COUNT = WIDTH * HEIGHT };

static kiln_context *context;
static kiln_error error;
static const char *folder;

static void must(kiln_result result)
{
    if (result != KILN_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
}

static void save(ki_writer *w, const char *name, int channels, const char *ending)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s_%d.%s", folder, name, channels, ending);
    FILE *file = fopen(path, "wb");
    bool good = file && fwrite(w->bytes, 1, w->size, file) == w->size;
    if (!file || fclose(file) != 0 || !good) {
        fprintf(stderr, "%s: cannot be written\n", path);
        exit(1);
    }
    ki_writer_free(w);
}

static void save_exr(const float *values, const char *name, int channels, bool half)
{
    ki_writer w = {.context = context};
    const ki_exr_options options = {.half = half, .roughness = -1};
    must(ki_exr_encode(values, WIDTH, HEIGHT, channels, &options, &w, &error));
    save(&w, name, channels, "exr");
}

static void save_png(const float *values, const char *name, int channels, ki_png_coding coding)
{
    ki_writer w = {.context = context};
    must(ki_png_encode(values, WIDTH, HEIGHT, channels, coding, &w, &error));
    save(&w, name, channels, "png");
}

// Slopes, noise and flat stretches. Alpha is 1, which no reader multiplies colours by.
static float value_at(int i, int c, int channels)
{
    if (channels % 2 == 0 && c == channels - 1)
        return 1;
    int x = i % WIDTH, y = i / WIDTH;
    uint64_t noise = random_hash((uint64_t)i * 4 + (uint64_t)c) >> 48;
    float slope = (float)(x + 2 * y + 40 * c) / (WIDTH + 2 * HEIGHT + 160);
    return x < 60 ? 0.25f * (float)c : y % 40 < 20 ? slope : (float)noise / 65535;
}

static void write_all(int channels)
{
    static float exact[COUNT * 4], stored[COUNT * 4], curved[COUNT * 4];
    int count = COUNT * channels;
    for (int i = 0; i < count; i++)
        exact[i] = value_at(i / channels, i % channels, channels);
    save_exr(exact, "float", channels, false);
    save_exr(exact, "half", channels, true);
    for (int i = 0; i < count; i++)
        stored[i] = (float)(int)(exact[i] * 65535 + 0.5f) / 65535;
    save_exr(stored, "fine", channels, false);
    save_png(stored, "fine", channels, KI_PNG_PLAIN16);
    for (int i = 0; i < count; i++) {
        stored[i] = (float)(int)(exact[i] * 255 + 0.5f) / 255;
        curved[i] = ki_linear_from_srgb(stored[i]);
    }
    save_exr(stored, "plain", channels, false);
    save_png(stored, "plain", channels, KI_PNG_PLAIN8);
    save_png(curved, "srgb", channels, KI_PNG_SRGB8); // whose bytes are the same
}

int main(int count, char **arguments)
{
    if (count != 2)
        return 2;
    folder = arguments[1];
    must(kiln_context_create(NULL, &context, &error));
    for (int channels = 1; channels <= 4; channels++)
        write_all(channels);
    kiln_context_destroy(context);
    return 0;
}
