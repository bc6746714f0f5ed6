// Converts samples of an EXR file (half, float or unsigned integer) to the pixels of a picture,
// three floats each, which keep negative, infinite and not-a-number values. A channel that is not
// in the file is 0.
#include "base/vector.h"
#include "codec/exr.h"
#include "image/convert.h"

#include <string.h>

enum { STRETCH = 256 }; // number of samples of a line that are converted at a time

static void to_floats(kiln_context *context, const uint8_t *restrict samples, int type, int count,
                      float *restrict values)
{
    if (type == KI_EXR_HALF) {
        KI_FASTEST(context, ki_widen_halfs)(samples, (size_t)count, values);
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

// Converts one line of the channels that become red, green and blue to RGB texels. samples[c] is
// NULL where the file has no channel for colour c.
static void put_line(kiln_context *context, const uint8_t *const samples[3],
                     const ki_exr_channel *const channel[3], int count, float *rgb)
{
    float values[3][STRETCH];
    const float *const colors[3] = {values[0], values[1], values[2]};
    for (int c = 0; c < 3; c++)
        if (!samples[c])
            memset(values[c], 0, sizeof values[c]);
    for (int x = 0; x < count; x += STRETCH) {
        int n = ki_min(STRETCH, count - x);
        for (int c = 0; c < 3; c++)
            if (samples[c])
                to_floats(context, samples[c] + (size_t)x * (size_t)channel[c]->bytes,
                          channel[c]->type, n, values[c]);
        KI_FASTEST(context, ki_join_colors)(colors, (size_t)n, rgb + 3 * (size_t)x);
    }
}

// Converts one line of a channel that has a sample for each `sampling` columns, the first of them
// at column `first`, to one channel of RGB.
static void put_samples(kiln_context *context, const uint8_t *samples,
                        const ki_exr_channel *channel, int first, int count, float *rgb)
{
    int sampling = channel->x_sampling, n = (count - first + sampling - 1) / sampling;
    for (int i = 0; i < n; i++) {
        float value;
        to_floats(context, samples + (size_t)i * (size_t)channel->bytes, channel->type, 1, &value);
        rgb[3 * ((size_t)first + (size_t)i * (size_t)sampling)] = value;
    }
}

// Returns the remainder of a division that rounds down: 0 to b - 1.
static int modulo(int a, int b)
{
    return (a % b + b) % b;
}

// The lines of the chosen channels in a box: where a line begins, or NULL.
typedef struct sources {
    const uint8_t *start[3];
} sources;

// Finds where the chosen channels begin on line `y`, whose bytes begin at `raw`. Returns the end of
// the line.
static const uint8_t *find_sources(const ki_exr_picture *p, const ki_exr_box *box,
                                   const ki_exr_run *runs, int count, int y, const uint8_t *raw,
                                   sources *found)
{
    *found = (sources){{NULL}};
    for (int i = 0; i < count; i++) {
        if (!ki_exr_line_has(&box->channels[runs[i].channel], y))
            continue;
        for (int k = 0; k < 3; k++)
            if (p->source[k] == runs[i].channel)
                found->start[k] = raw;
        raw += runs[i].bytes;
    }
    return raw;
}

// Writes line `y` of a box to the columns from `left` to `right` - 1 of the picture.
static void put_sources(kiln_context *context, const ki_exr_picture *p, const ki_exr_box *box,
                        const sources *found, int y, int left, int right)
{
    size_t row = (size_t)(y - p->top);
    const uint8_t *samples[3] = {NULL};
    const ki_exr_channel *channel[3] = {NULL};
    float *rgb = p->pixels + 3 * (row * (size_t)p->width + (size_t)(left - p->left));
    for (int k = 0; k < 3; k++) {
        if (!found->start[k])
            continue;
        channel[k] = &box->channels[p->source[k]];
        if (channel[k]->x_sampling == 1)
            samples[k] = found->start[k] + (size_t)(left - box->x) * (size_t)channel[k]->bytes;
    }
    put_line(context, samples, channel, right - left, rgb);
    for (int k = 0; k < 3; k++)
        if (found->start[k] && !samples[k])
            put_samples(context, found->start[k], channel[k],
                        modulo(-box->x, channel[k]->x_sampling), right - left, rgb + k);
}

kiln_result ki_exr_put_box(ki_exr_workspace *work, const ki_exr_picture *p, const ki_exr_box *box,
                           const uint8_t *raw)
{
    int left = ki_max(box->x, p->left), right = ki_min(box->x + box->width, p->left + p->width);
    ki_exr_run runs[KI_EXR_MAX_CHANNELS];
    int count = ki_exr_list_runs(box, runs);
    for (int y = box->y; y < box->y + box->height; y++) {
        sources found;
        raw = find_sources(p, box, runs, count, y, raw, &found);
        if (y < p->top || y - p->top >= p->height || left >= right)
            continue;
        put_sources(work->context, p, box, &found, y, left, right);
        if (!ki_exr_go_on(work, 3 * sizeof(float) * (size_t)(right - left)))
            return KILN_ERROR_CANCELLED;
    }
    return KILN_OK;
}
