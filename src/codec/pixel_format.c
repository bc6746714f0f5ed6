#include "codec/pixel_format.h"

#include "codec/bc6h.h"
#include "image/pack.h"

#include <float.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are written as memory is");

const char *const ki_format_names[] = {"auto", "rgba16f", "rgba32f", "rgb9e5", "b10g11r11",
                                       "bc6h", "rgbm",    "rgbd",    "rgbp",   NULL};

const char *const *kiln_format_names(void)
{
    return ki_format_names;
}

// By their own enum; the first row, for KILN_FORMAT_AUTO, is that of RGBA16F. The last three are for PNG and have no number of Vulkan's or DXGI's.
static const ki_pixel_format formats[] = {
    {KILN_FORMAT_RGBA16F, KI_HALF_MAX, 97, 10, 8, 2, 1, 4, NULL},
    {KILN_FORMAT_RGBA16F, KI_HALF_MAX, 97, 10, 8, 2, 1, 4, NULL},
    {KILN_FORMAT_RGBA32F, 0, 109, 2, 16, 4, 1, 4, NULL},
    {KILN_FORMAT_RGB9E5, KI_RGB9E5_MAX, 123, 67, 4, 4, 1, 3, NULL},
    {KILN_FORMAT_B10G11R11, KI_B10G11R11_MAX, 122, 26, 4, 4, 1, 3, NULL},
    {KILN_FORMAT_BC6H, KI_HALF_MAX, 143, 95, KI_BC6H_BYTES, 1, 4, 3, NULL},
    {KILN_FORMAT_RGBM, KI_RGBM_MAX, 0, 0, 4, 1, 1, 4, ki_rgbm_from_float},
    {KILN_FORMAT_RGBD, KI_RGBD_MAX, 0, 0, 4, 1, 1, 4, ki_rgbd_from_float},
    {KILN_FORMAT_RGBP, KI_RGBP_MAX, 0, 0, 4, 1, 1, 4, ki_rgbp_from_float},
};

enum { FORMATS = sizeof formats / sizeof *formats };
_Static_assert(FORMATS == KILN_FORMAT_RGBP + 1, "a row for each format");
_Static_assert(sizeof ki_format_names / sizeof *ki_format_names == FORMATS + 1, "and a name");

const ki_pixel_format *ki_pixel_format_of(kiln_format format)
{
    return (unsigned)format < FORMATS ? &formats[format] : NULL;
}

const ki_pixel_format *ki_pixel_format_of_vk(uint32_t vk)
{
    for (int i = KILN_FORMAT_RGBA16F; i <= KILN_FORMAT_BC6H; i++)
        if (formats[i].vk == vk)
            return &formats[i];
    return NULL;
}

const ki_pixel_format *ki_pixel_format_of_dxgi(uint32_t dxgi)
{
    for (int i = KILN_FORMAT_RGBA16F; i <= KILN_FORMAT_BC6H; i++)
        if (formats[i].dxgi == dxgi)
            return &formats[i];
    return NULL;
}

double kiln_format_limit(kiln_format format)
{
    const ki_pixel_format *found = ki_pixel_format_of(format);
    return found ? found->limit : 0;
}

enum { STRETCH = 64 };

static void pack_floats(const float *rgb, size_t count, uint8_t *bytes)
{
    for (size_t i = 0; i < count; i++) {
        const float texel[4] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 1};
        memcpy(bytes + 16 * i, texel, sizeof texel);
    }
}

static void pack(const ki_pixel_format *pixel, const float *rgb, size_t count, uint8_t *bytes)
{
    if (pixel->format == KILN_FORMAT_RGBA32F) {
        pack_floats(rgb, count, bytes);
        return;
    }
    for (size_t done = 0; done < count; done += STRETCH) {
        size_t n = count - done < STRETCH ? count - done : STRETCH;
        const float *from = rgb + 3 * done;
        if (pixel->format == KILN_FORMAT_RGBA16F) {
            uint16_t halfs[4 * STRETCH];
            ki_pack_rgba16f(from, n, halfs);
            memcpy(bytes + 8 * done, halfs, 8 * n);
            continue;
        }
        uint32_t words[STRETCH] = {0};
        for (size_t i = 0; i < n; i++)
            words[i] = pixel->format == KILN_FORMAT_RGB9E5 ? ki_rgb9e5_from_float(from + 3 * i)
                                                           : ki_b10g11r11_from_float(from + 3 * i);
        memcpy(bytes + 4 * done, words, 4 * n);
    }
}

enum { PIECE = 1 << 16 };

typedef struct pack_job {
    const ki_pixel_format *pixel;
    const float *rgb;
    size_t count;
    uint8_t *bytes;
} pack_job;

static void pack_piece(void *data, int index)
{
    const pack_job *job = data;
    size_t first = (size_t)index * PIECE, left = job->count - first;
    pack(job->pixel, job->rgb + 3 * first, left < PIECE ? left : PIECE,
         job->bytes + (size_t)job->pixel->bytes * first);
}

uint64_t ki_pixels_size(const ki_pixel_format *pixel, int width, int height)
{
    int edge = pixel->block;
    uint64_t columns = (uint64_t)((width + edge - 1) / edge);
    return columns * (uint64_t)((height + edge - 1) / edge) * (uint64_t)pixel->bytes;
}

bool ki_pixels_pack(kiln_context *context, const ki_pixel_format *pixel, const float *rgb,
                    int width, int height, int count, uint8_t *bytes)
{
    if (pixel->format == KILN_FORMAT_BC6H)
        return ki_bc6h_encode(context, rgb, width, height, count, bytes);
    pack_job job = {pixel, rgb, (size_t)width * (size_t)height * (size_t)count, bytes};
    return ki_parallel_steps(context, NULL, (int)((job.count + PIECE - 1) / PIECE), pack_piece,
                             &job);
}

static float sane(float value, float largest)
{
    value = value > 0 ? value : 0;
    return value < largest ? value : largest;
}

static void unpack(const ki_pixel_format *pixel, const uint8_t *bytes, size_t count, float *rgb)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t *from = bytes + (size_t)pixel->bytes * i;
        float value[4] = {0}, largest[3] = {0};
        uint32_t word;
        uint16_t halfs[4];
        switch (pixel->format) {
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

void ki_pixels_unpack(const ki_pixel_format *pixel, const uint8_t *bytes, int width, int height,
                      float *rgb)
{
    if (pixel->format == KILN_FORMAT_BC6H)
        ki_bc6h_decode(bytes, width, height, rgb);
    else
        unpack(pixel, bytes, (size_t)width * (size_t)height, rgb);
}
