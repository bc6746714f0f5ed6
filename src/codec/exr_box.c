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

int ki_exr_list_runs(const ki_exr_box *box, ki_exr_run runs[KI_EXR_MAX_CHANNELS])
{
    int count = 0;
    for (int c = 0; c < box->channel_count; c++) {
        size_t columns = (size_t)ki_exr_columns(box, &box->channels[c]);
        if (columns)
            runs[count++] = (ki_exr_run){c, columns * (size_t)box->channels[c].bytes};
    }
    return count;
}

size_t ki_exr_count_lines(const ki_exr_box *box)
{
    size_t count = 0;
    for (int c = 0; c < box->channel_count; c++)
        if (ki_exr_columns(box, &box->channels[c]))
            count += (size_t)ki_exr_rows(box, &box->channels[c]);
    return count;
}

void ki_exr_find_lines(const ki_exr_box *box, size_t *offset,
                       const size_t *lines[KI_EXR_MAX_CHANNELS])
{
    ki_exr_run runs[KI_EXR_MAX_CHANNELS];
    size_t *found[KI_EXR_MAX_CHANNELS], at = 0;
    int count = ki_exr_list_runs(box, runs);
    for (int c = 0; c < box->channel_count; c++)
        lines[c] = NULL;
    for (int i = 0; i < count; i++) {
        lines[runs[i].channel] = found[i] = offset;
        offset += ki_exr_rows(box, &box->channels[runs[i].channel]);
    }
    for (int y = box->y; y < box->y + box->height; y++)
        for (int i = 0; i < count; i++)
            if (ki_exr_line_has(&box->channels[runs[i].channel], y)) {
                *found[i]++ = at;
                at += runs[i].bytes;
            }
}

bool ki_exr_lines_from_planes(ki_exr_workspace *work, const ki_exr_box *box, const uint8_t *planes,
                              uint8_t *raw)
{
    const uint8_t *plane[KI_EXR_MAX_CHANNELS];
    ki_exr_run runs[KI_EXR_MAX_CHANNELS];
    int count = ki_exr_list_runs(box, runs);
    for (int i = 0; i < count; i++) {
        plane[i] = planes;
        planes += (size_t)ki_exr_rows(box, &box->channels[runs[i].channel]) * runs[i].bytes;
    }
    for (int y = box->y; y < box->y + box->height; y++)
        for (int i = 0; i < count; i++) {
            if (!ki_exr_line_has(&box->channels[runs[i].channel], y))
                continue;
            memcpy(raw, plane[i], runs[i].bytes);
            raw += runs[i].bytes;
            plane[i] += runs[i].bytes;
            if (!ki_exr_go_on(work, runs[i].bytes))
                return false;
        }
    return true;
}
