// EXR's PXR24: for each line and channel the differences of the samples, deflated; all highest
// bytes come first, then all next bytes. A float is stored without its lowest byte.
#include "codec/exr.h"

#include <string.h>

static size_t stored_bytes(const ki_exr_channel *channel)
{
    return channel->type == KI_EXR_FLOAT ? 3 : (size_t)channel->bytes;
}

// Decodes one line of one channel with `width` samples. `from` holds the samples' bytes in order of
// significance: the most significant byte of every sample, then the next byte of every sample, and
// so on.
static void undo_line(const uint8_t *from, size_t width, const ki_exr_channel *channel,
                      uint8_t *raw)
{
    size_t bytes = (size_t)channel->bytes, ranks = stored_bytes(channel);
    uint32_t value = 0;
    for (size_t x = 0; x < width; x++, raw += bytes) {
        uint32_t difference = 0;
        for (size_t k = 0; k < ranks; k++)
            difference = difference << 8 | from[k * width + x];
        value += difference;
        uint32_t stored = channel->type == KI_EXR_FLOAT ? value << 8 : value;
        memcpy(raw, &stored, bytes);
    }
}

kiln_result ki_exr_decompress_pxr24(ki_exr_workspace *work, const ki_exr_box *box,
                                    const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                    size_t size)
{
    (void)size;
    size_t plain_size = 0;
    for (int c = 0; c < box->channel_count; c++)
        plain_size += stored_bytes(&box->channels[c]) *
                      (size_t)ki_exr_columns(box, &box->channels[c]) *
                      (size_t)ki_exr_rows(box, &box->channels[c]);
    if (!ki_exr_inflate(work, packed, packed_size, work->scratch, plain_size))
        return KILN_ERROR_FORMAT;
    const uint8_t *from = work->scratch;
    ki_exr_run runs[KI_EXR_MAX_CHANNELS];
    int count = ki_exr_list_runs(box, runs);
    for (int y = box->y; y < box->y + box->height; y++)
        for (int i = 0; i < count; i++) {
            const ki_exr_channel *channel = &box->channels[runs[i].channel];
            if (!ki_exr_line_has(channel, y))
                continue;
            size_t width = runs[i].bytes / (size_t)channel->bytes;
            undo_line(from, width, channel, raw);
            from += stored_bytes(channel) * width;
            raw += runs[i].bytes;
            if (!ki_exr_go_on(work, runs[i].bytes))
                return KILN_ERROR_FORMAT;
        }
    return KILN_OK;
}
