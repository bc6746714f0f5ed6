// Texels of textures that other programs write. In: the number by which KTX2, DDS or KTX 1 name a
// format, and the bytes of a picture. Out: RGB floats of linear light. Channels of 8 and 16 bits
// are fractions of 255 and 65535, or stand for sRGB values if the format says so; alpha is left
// out.
#include "codec/texels.h"

#include "codec/report.h"
#include "image/pack.h"

#include <stdio.h>
#include <string.h>

typedef struct texel_row {
    uint32_t vk, dxgi; // Vulkan and DXGI number; 0 where there is none
    ki_texel_kind kind;
    int channels;
    bool blue_first;
} texel_row;

// The formats that kiln reads and does not write; ki_pixel_format has the others.
static const texel_row rows[] = {
    {23, 0, KI_TEXEL_U8, 3, false},  {29, 0, KI_TEXEL_SRGB8, 3, false},
    {30, 0, KI_TEXEL_U8, 3, true},   {36, 0, KI_TEXEL_SRGB8, 3, true},
    {37, 28, KI_TEXEL_U8, 4, false}, {43, 29, KI_TEXEL_SRGB8, 4, false},
    {44, 87, KI_TEXEL_U8, 4, true},  {50, 91, KI_TEXEL_SRGB8, 4, true},
    {51, 0, KI_TEXEL_U8, 4, false},  {57, 0, KI_TEXEL_SRGB8, 4, false},
    {0, 88, KI_TEXEL_U8, 4, true},   {0, 93, KI_TEXEL_SRGB8, 4, true},
    {84, 0, KI_TEXEL_U16, 3, false}, {91, 11, KI_TEXEL_U16, 4, false},
    {90, 0, KI_TEXEL_F16, 3, false}, {106, 6, KI_TEXEL_F32, 3, false},
};

enum { ROWS = sizeof rows / sizeof *rows };

static bool take_pixel(const ki_pixel_format *pixel, ki_texels *texels)
{
    *texels = (ki_texels){.channels = pixel ? pixel->channels : 0, .pixel = pixel};
    return pixel != NULL;
}

static bool take_row(const texel_row *row, ki_texels *texels)
{
    *texels = (ki_texels){row->kind, row->channels, row->blue_first, NULL};
    return true;
}

bool ki_texels_of_vk(uint32_t vk, ki_texels *texels)
{
    for (int i = 0; i < ROWS; i++)
        if (vk && rows[i].vk == vk)
            return take_row(&rows[i], texels);
    return take_pixel(ki_pixel_format_of_vk(vk), texels);
}

bool ki_texels_of_dxgi(uint32_t dxgi, ki_texels *texels)
{
    for (int i = 0; i < ROWS; i++)
        if (dxgi && rows[i].dxgi == dxgi)
            return take_row(&rows[i], texels);
    return take_pixel(ki_pixel_format_of_dxgi(dxgi), texels);
}

const char *ki_texels_name(const ki_texels *texels, char name[KI_TEXELS_NAME])
{
    static const char *const kinds[] = {"", "8", "8 srgb", "16", "16f", "32f"};
    if (texels->pixel)
        snprintf(name, KI_TEXELS_NAME, "%s", ki_format_names[texels->pixel->format]);
    else
        snprintf(name, KI_TEXELS_NAME, "%s%s%s", texels->blue_first ? "bgr" : "rgb",
                 texels->channels == 4 ? "a" : "", kinds[texels->kind]);
    return name;
}

static int channel_bytes(ki_texel_kind kind)
{
    return kind == KI_TEXEL_F32 ? 4 : kind == KI_TEXEL_F16 || kind == KI_TEXEL_U16 ? 2 : 1;
}

// Returns the number of bytes from a row to the next.
static uint64_t row_bytes(const ki_texels *texels, int width, int align)
{
    uint64_t tight = (uint64_t)width * (uint64_t)(texels->channels * channel_bytes(texels->kind));
    return (tight + (uint64_t)align - 1) / (uint64_t)align * (uint64_t)align;
}

uint64_t ki_texels_size(const ki_texels *texels, int width, int height, int align)
{
    if (texels->pixel)
        return ki_pixels_size(texels->pixel, width, height);
    return row_bytes(texels, width, align) * (uint64_t)height;
}

typedef struct read_job {
    const ki_texels *texels;
    const uint8_t *bytes;
    size_t row_bytes;
    int width;
    float *rgb;
    float of_byte[256]; // value of each byte, for formats of 8 bits
} read_job;

static float read_channel(const read_job *job, const uint8_t *at)
{
    uint16_t half;
    float value;
    switch (job->texels->kind) {
    case KI_TEXEL_U16:
        memcpy(&half, at, sizeof half);
        return (float)half / 65535;
    case KI_TEXEL_F16:
        ki_floats_from_half_bytes(at, 1, &value);
        return value;
    case KI_TEXEL_F32:
        memcpy(&value, at, sizeof value);
        return value;
    default:
        return job->of_byte[*at];
    }
}

// Task of one thread: converts one row.
static void read_row(void *data, int row)
{
    const read_job *job = data;
    const ki_texels *texels = job->texels;
    size_t channel = (size_t)channel_bytes(texels->kind),
           texel = channel * (size_t)texels->channels;
    const uint8_t *from = job->bytes + job->row_bytes * (size_t)row;
    float *to = job->rgb + 3 * (size_t)row * (size_t)job->width;
    for (int x = 0; x < job->width; x++, from += texel, to += 3)
        for (size_t c = 0; c < 3; c++)
            to[c] = read_channel(job, from + channel * (texels->blue_first ? 2 - c : c));
}

// A picture in a format of kiln_format, which is unpacked in strips of whole rows of blocks.
typedef struct unpack_job {
    const ki_pixel_format *pixel;
    const uint8_t *bytes;
    int width, height;
    float *rgb;
} unpack_job;

enum { STRIP = 64 }; // rows of a strip

// Task of one thread: unpacks one strip.
static void unpack_strip(void *data, int index)
{
    const unpack_job *job = data;
    int first = index * STRIP, count = ki_min(STRIP, job->height - first);
    ki_pixels_unpack(job->pixel, job->bytes + (size_t)ki_pixels_size(job->pixel, job->width, first),
                     job->width, count, job->rgb + 3 * (size_t)job->width * (size_t)first);
}

bool ki_texels_read(kiln_context *context, const ki_texels *texels, const uint8_t *bytes, int width,
                    int height, int align, float *rgb)
{
    if (texels->pixel) {
        unpack_job unpack = {texels->pixel, bytes, width, height, rgb};
        return ki_parallel_steps(context, NULL, (height + STRIP - 1) / STRIP, unpack_strip,
                                 &unpack);
    }
    read_job job = {texels, bytes, (size_t)row_bytes(texels, width, align), width, rgb, {0}};
    for (int i = 0; i < 256; i++)
        job.of_byte[i] =
            texels->kind == KI_TEXEL_SRGB8 ? ki_linear_from_srgb((float)i / 255) : (float)i / 255;
    return ki_parallel_steps(context, NULL, height, read_row, &job);
}

static void swap_texels(float *a, float *b)
{
    for (int c = 0; c < 3; c++) {
        float value = a[c];
        a[c] = b[c];
        b[c] = value;
    }
}

bool ki_texels_flip(kiln_context *context, float *rgb, int width, int height, bool left_right,
                    bool top_bottom)
{
    size_t w = (size_t)width, h = (size_t)height;
    for (size_t y = 0; y < h && left_right; y++) {
        if (y % STRIP == STRIP - 1 && !ki_go_on(context))
            return false;
        for (size_t x = 0; x < w / 2; x++)
            swap_texels(rgb + 3 * (y * w + x), rgb + 3 * (y * w + w - 1 - x));
    }
    for (size_t y = 0; y < h / 2 && top_bottom; y++) {
        if (y % STRIP == STRIP - 1 && !ki_go_on(context))
            return false;
        for (size_t x = 0; x < w; x++)
            swap_texels(rgb + 3 * (y * w + x), rgb + 3 * ((h - 1 - y) * w + x));
    }
    return true;
}

void ki_texels_note(const ki_texels *texels, bool stated, int level_count, kiln_load_report *report)
{
    if (texels->kind == KI_TEXEL_SRGB8 && !stated)
        ki_note(report, KILN_NOTE_ASSUMPTION, false,
                "values of 8 bits are taken as sRGB, since the file does not say what they are");
    if (texels->kind == KI_TEXEL_U8)
        ki_note(report, KILN_NOTE_ASSUMPTION, false,
                "values of 8 bits are taken as linear, as the file's format says; pictures for the "
                "screen are sRGB");
    if (level_count > 1)
        ki_note(report, KILN_NOTE_CHOICE, false, "level 0 of %d levels is the environment",
                level_count);
}
