#include "codec/texel.h"

#include "codec/bc6h.h"
#include "image/pack.h"

#include <float.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are written as memory is");

const char *const ki_format_names[] = {"auto", "rgba16f", "rgba32f", "rgb9e5", "b10g11r11",
                                       "bc6h", "rgbm",    "rgbd",    "rgbp",   NULL};

const ki_texel ki_texels[KI_TEXELS] = {
    {KILN_FORMAT_RGBA16F, 97, 10, 8, 2, 1, 4},
    {KILN_FORMAT_RGBA32F, 109, 2, 16, 4, 1, 4},
    {KILN_FORMAT_RGB9E5, 123, 67, 4, 4, 1, 3},
    {KILN_FORMAT_B10G11R11, 122, 26, 4, 4, 1, 3},
    {KILN_FORMAT_BC6H, 143, 95, KI_BC6H_BYTES, 1, 4, 3},
};

const ki_texel *ki_texel_of_format(kiln_format format)
{
    if (format == KILN_FORMAT_AUTO)
        return &ki_texels[0];
    for (size_t i = 0; i < KI_TEXELS; i++)
        if (ki_texels[i].format == format)
            return &ki_texels[i];
    return NULL;
}

const ki_texel *ki_texel_of_vk(uint32_t vk)
{
    for (size_t i = 0; i < KI_TEXELS; i++)
        if (ki_texels[i].vk == vk)
            return &ki_texels[i];
    return NULL;
}

const ki_texel *ki_texel_of_dxgi(uint32_t dxgi)
{
    for (size_t i = 0; i < KI_TEXELS; i++)
        if (ki_texels[i].dxgi == dxgi)
            return &ki_texels[i];
    return NULL;
}

enum { STRETCH = 64 };

static void pack_floats(const float *rgb, size_t count, uint8_t *bytes)
{
    for (size_t i = 0; i < count; i++) {
        const float texel[4] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 1};
        memcpy(bytes + 16 * i, texel, sizeof texel);
    }
}

static void pack(const ki_texel *texel, const float *rgb, size_t count, uint8_t *bytes)
{
    if (texel->format == KILN_FORMAT_RGBA32F) {
        pack_floats(rgb, count, bytes);
        return;
    }
    for (size_t done = 0; done < count; done += STRETCH) {
        size_t n = count - done < STRETCH ? count - done : STRETCH;
        const float *from = rgb + 3 * done;
        if (texel->format == KILN_FORMAT_RGBA16F) {
            uint16_t halfs[4 * STRETCH];
            ki_pack_rgba16f(from, n, halfs);
            memcpy(bytes + 8 * done, halfs, 8 * n);
            continue;
        }
        uint32_t words[STRETCH] = {0};
        for (size_t i = 0; i < n; i++)
            words[i] = texel->format == KILN_FORMAT_RGB9E5 ? ki_rgb9e5_from_float(from + 3 * i)
                                                           : ki_b10g11r11_from_float(from + 3 * i);
        memcpy(bytes + 4 * done, words, 4 * n);
    }
}

enum { PIECE = 1 << 16 };

typedef struct pack_job {
    const ki_texel *texel;
    const float *rgb;
    size_t count;
    uint8_t *bytes;
} pack_job;

static void pack_piece(void *data, int index)
{
    const pack_job *job = data;
    size_t first = (size_t)index * PIECE, left = job->count - first;
    pack(job->texel, job->rgb + 3 * first, left < PIECE ? left : PIECE,
         job->bytes + (size_t)job->texel->bytes * first);
}

uint64_t ki_texels_size(const ki_texel *texel, int width, int height)
{
    int edge = texel->block;
    uint64_t columns = (uint64_t)((width + edge - 1) / edge);
    return columns * (uint64_t)((height + edge - 1) / edge) * (uint64_t)texel->bytes;
}

bool ki_texels_pack(kiln_context *context, const ki_texel *texel, const float *rgb, int width,
                    int height, int count, uint8_t *bytes)
{
    if (texel->format == KILN_FORMAT_BC6H)
        return ki_bc6h_encode(context, rgb, width, height, count, bytes);
    pack_job job = {texel, rgb, (size_t)width * (size_t)height * (size_t)count, bytes};
    return ki_parallel_steps(context, NULL, (int)((job.count + PIECE - 1) / PIECE), pack_piece,
                             &job);
}

static float sane(float value, float largest)
{
    value = value > 0 ? value : 0;
    return value < largest ? value : largest;
}

static void unpack(const ki_texel *texel, const uint8_t *bytes, size_t count, float *rgb)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t *from = bytes + (size_t)texel->bytes * i;
        float value[4] = {0}, largest[3] = {0};
        uint32_t word;
        uint16_t halfs[4];
        switch (texel->format) {
        case KILN_FORMAT_RGBA32F:
            memcpy(value, from, sizeof value);
            largest[0] = largest[1] = largest[2] = FLT_MAX;
            break;
        case KILN_FORMAT_RGB9E5:
            memcpy(&word, from, sizeof word);
            ki_float_from_rgb9e5(word, value);
            largest[0] = largest[1] = largest[2] = KI_RGB9E5_MAX;
            break;
        case KILN_FORMAT_B10G11R11:
            memcpy(&word, from, sizeof word);
            ki_float_from_b10g11r11(word, value);
            largest[0] = largest[1] = 65024;
            largest[2] = KI_B10G11R11_MAX;
            break;
        case KILN_FORMAT_RGBA16F:
        default:
            memcpy(halfs, from, sizeof halfs);
            ki_floats_from_halfs(halfs, 4, value);
            largest[0] = largest[1] = largest[2] = KI_HALF_MAX;
            break;
        }
        for (int c = 0; c < 3; c++)
            rgb[3 * i + (size_t)c] = sane(value[c], largest[c]);
    }
}

void ki_texels_unpack(const ki_texel *texel, const uint8_t *bytes, int width, int height,
                      float *rgb)
{
    if (texel->format == KILN_FORMAT_BC6H)
        ki_bc6h_decode(bytes, width, height, rgb);
    else
        unpack(texel, bytes, (size_t)width * (size_t)height, rgb);
}
