// Channels and boxes of samples as EXR files store them: the number of samples and bytes, and the
// order of the samples.
#include "codec/exr.h"

#include <string.h>

const char *ki_exr_suffix(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? dot + 1 : name;
}

static int floor_divide(int a, int b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

// Returns the number of multiples of `sampling` among the `count` integers from `start` on; `start`
// may be negative.
static int multiples(int start, int count, int sampling)
{
    if (sampling == 1)
        return count;
    return floor_divide(start + count - 1, sampling) - floor_divide(start - 1, sampling);
}

int ki_exr_columns(const ki_exr_box *box, const ki_exr_channel *channel)
{
    return multiples(box->x, box->width, channel->x_sampling);
}

int ki_exr_rows(const ki_exr_box *box, const ki_exr_channel *channel)
{
    return multiples(box->y, box->height, channel->y_sampling);
}

bool ki_exr_line_has(const ki_exr_channel *channel, int y)
{
    return y % channel->y_sampling == 0;
}

size_t ki_exr_box_size(const ki_exr_box *box)
{
    size_t size = 0;
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        size_t bytes;
        if (!ki_mul_size((size_t)ki_exr_columns(box, channel), (size_t)ki_exr_rows(box, channel),
                         &bytes) ||
            !ki_mul_size(bytes, (size_t)channel->bytes, &bytes) || size > SIZE_MAX - bytes)
            return 0;
        size += bytes;
    }
    return size;
}

void ki_exr_lines_from_planes(const ki_exr_box *box, const uint8_t *planes, uint8_t *raw)
{
    const uint8_t *plane[KI_EXR_MAX_CHANNELS];
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        plane[c] = planes;
        planes += (size_t)ki_exr_columns(box, channel) * (size_t)ki_exr_rows(box, channel) *
                  (size_t)channel->bytes;
    }
    for (int y = box->y; y < box->y + box->height; y++)
        for (int c = 0; c < box->channel_count; c++) {
            const ki_exr_channel *channel = &box->channels[c];
            if (!ki_exr_line_has(channel, y))
                continue;
            size_t bytes = (size_t)ki_exr_columns(box, channel) * (size_t)channel->bytes;
            memcpy(raw, plane[c], bytes);
            raw += bytes;
            plane[c] += bytes;
        }
}
