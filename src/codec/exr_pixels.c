// Converts samples of an EXR file (half, float or unsigned integer) to the pixels of a picture,
// three floats each, which keep negative, infinite and not-a-number values. A channel that is not
// in the file is 0.
#include "base/vector.h"
#include "codec/exr.h"
#include "image/pack.h"

#include <string.h>

enum { STRETCH = 256 }; // number of samples of a line that are converted at a time

static void to_floats(const uint8_t *restrict samples, int type, int count, float *restrict values)
{
    if (type == KI_EXR_HALF) {
        ki_floats_from_half_bytes(samples, (size_t)count, values);
    } else if (type == KI_EXR_FLOAT) {
        memcpy(values, samples, (size_t)count * sizeof *values);
    } else {
        for (int i = 0; i < count; i++) {
            uint32_t integer;
            memcpy(&integer, samples + 4 * (size_t)i, 4);
            values[i] = (float)integer;
        }
    }
}

// Interleaves a line of red, green and blue to RGB texels, four texels at a time.
static void interleave(const float *restrict r, const float *restrict g, const float *restrict b,
                       int count, float *restrict rgb)
{
    int i = 0;
    for (; i + 4 <= count; i += 4) {
        ki_float4 red, green, blue, out[3];
        memcpy(&red, r + i, sizeof red);
        memcpy(&green, g + i, sizeof green);
        memcpy(&blue, b + i, sizeof blue);
        ki_float4 low = KI_SHUFFLE4(red, green, 0, 4, 1, 5);
        ki_float4 high = KI_SHUFFLE4(red, green, 2, 6, 3, 7);
        ki_float4 one = KI_SHUFFLE4(low, blue, 2, 3, 5, -1);
        out[0] = KI_SHUFFLE4(low, blue, 0, 1, 4, 2);
        out[1] = KI_SHUFFLE4(one, high, 1, 2, 4, 5);
        out[2] = KI_SHUFFLE4(blue, high, 2, 6, 7, 3);
        memcpy(rgb + 3 * (size_t)i, out, sizeof out);
    }
    for (; i < count; i++) {
        float *texel = rgb + 3 * (size_t)i;
        texel[0] = r[i];
        texel[1] = g[i];
        texel[2] = b[i];
    }
}

// Converts one line of the channels that become red, green and blue to RGB texels. samples[c] is
// NULL where the file has no channel for colour c.
static void put_line(const uint8_t *const samples[3], const ki_exr_channel *const channel[3],
                     int count, float *rgb)
{
    float values[3][STRETCH];
    for (int c = 0; c < 3; c++)
        if (!samples[c])
            memset(values[c], 0, sizeof values[c]);
    for (int x = 0; x < count; x += STRETCH) {
        int n = ki_min(STRETCH, count - x);
        for (int c = 0; c < 3; c++)
            if (samples[c])
                to_floats(samples[c] + (size_t)x * (size_t)channel[c]->bytes, channel[c]->type, n,
                          values[c]);
        interleave(values[0], values[1], values[2], n, rgb + 3 * (size_t)x);
    }
}

// Converts one line of a channel that has a sample for each `sampling` columns, the first of them at
// column `first`, to one channel of RGB.
static void put_samples(const uint8_t *samples, const ki_exr_channel *channel, int first, int count,
                        float *rgb)
{
    int sampling = channel->x_sampling, n = (count - first + sampling - 1) / sampling;
    for (int i = 0; i < n; i++) {
        float value;
        to_floats(samples + (size_t)i * (size_t)channel->bytes, channel->type, 1, &value);
        rgb[3 * ((size_t)first + (size_t)i * (size_t)sampling)] = value;
    }
}

// Returns the remainder of a division that rounds down: 0 to b - 1.
static int modulo(int a, int b)
{
    return (a % b + b) % b;
}

void ki_exr_put_box(const ki_exr_picture *p, const ki_exr_box *box, const uint8_t *raw)
{
    int left = ki_max(box->x, p->left), right = ki_min(box->x + box->width, p->left + p->width);
    for (int y = box->y; y < box->y + box->height; y++) {
        const uint8_t *start[KI_EXR_MAX_CHANNELS];
        for (int c = 0; c < box->channel_count; c++) {
            const ki_exr_channel *channel = &box->channels[c];
            start[c] = raw;
            if (ki_exr_line_has(channel, y))
                raw += (size_t)ki_exr_columns(box, channel) * (size_t)channel->bytes;
        }
        int row = y - p->top;
        if (row < 0 || row >= p->height || left >= right)
            continue;
        const uint8_t *samples[3] = {NULL};
        const ki_exr_channel *channel[3] = {NULL};
        float *rgb = p->pixels + 3 * ((size_t)row * (size_t)p->width + (size_t)(left - p->left));
        for (int k = 0; k < 3; k++) {
            const ki_exr_channel *c = p->source[k] < 0 ? NULL : &box->channels[p->source[k]];
            if (!c || c->x_sampling != 1 || c->y_sampling != 1)
                continue;
            channel[k] = c;
            samples[k] = start[p->source[k]] + (size_t)(left - box->x) * (size_t)c->bytes;
        }
        put_line(samples, channel, right - left, rgb);
        for (int k = 0; k < 3; k++) {
            const ki_exr_channel *c = p->source[k] < 0 ? NULL : &box->channels[p->source[k]];
            if (c && !channel[k] && ki_exr_line_has(c, y))
                put_samples(start[p->source[k]], c, modulo(-box->x, c->x_sampling), right - left,
                            rgb + k);
        }
    }
}
