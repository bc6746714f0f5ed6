// PIZ, PXR24 and B44 where OpenEXRCore is left out, by the format's description and its reference.
#include "codec/exr.h"

#include "base/bytes.h"

#include <string.h>

// ---------------------------------------------------------------------------------------------- PIZ

// A pair of Haar's coefficients, mean and difference, back to its values: of 14 bits, or of 16 modulo
// 2^16.
static inline void pair14(uint16_t mean, uint16_t difference, uint16_t *a, uint16_t *b)
{
    int m = (int16_t)mean, d = (int16_t)difference;
    int16_t first = (int16_t)(m + (d & 1) + (d >> 1));
    *a = (uint16_t)first;
    *b = (uint16_t)(int16_t)(first - d);
}

static inline void pair16(uint16_t mean, uint16_t difference, uint16_t *a, uint16_t *b)
{
    *b = (uint16_t)(mean - (difference >> 1));
    *a = (uint16_t)(difference + *b - 0x8000);
}

static inline void pair(bool wide, uint16_t mean, uint16_t difference, uint16_t *a, uint16_t *b)
{
    if (wide)
        pair16(mean, difference, a, b);
    else
        pair14(mean, difference, a, b);
}

// Undoes the wavelet of one plane in place: `width` values `step` apart, `height` rows `row` apart.
static void undo_wavelet(uint16_t *plane, int width, ptrdiff_t step, int height, ptrdiff_t row,
                         bool wide)
{
    int small = ki_min(width, height), two = 1;
    while (two <= small)
        two *= 2;
    for (two /= 2; two >= 2; two /= 2) {
        int one = two / 2;
        ptrdiff_t right = step * one, below = row * one;
        int y = 0, x;
        for (; y + two <= height; y += two) {
            uint16_t *at = plane + row * y, m0, m1, d0, d1;
            for (x = 0; x + two <= width; x += two, at += step * two) {
                pair(wide, at[0], at[below], &m0, &d0);
                pair(wide, at[right], at[below + right], &m1, &d1);
                pair(wide, m0, m1, &at[0], &at[right]);
                pair(wide, d0, d1, &at[below], &at[below + right]);
            }
            if (width & one) {
                pair(wide, at[0], at[below], &m0, &d0);
                at[0] = m0;
                at[below] = d0;
            }
        }
        if (height & one) {
            uint16_t *at = plane + row * y, m, d;
            for (x = 0; x + two <= width; x += two, at += step * two) {
                pair(wide, at[0], at[right], &m, &d);
                at[0] = m;
                at[right] = d;
            }
        }
    }
}

// The values that occur, as a bitmap from byte `first` to `last`; table[i] is the i-th. Returns the
// greatest i.
static int read_values(ki_reader *r, uint16_t *table)
{
    uint8_t bitmap[8192] = {0};
    uint32_t ends = ki_read_u32(r), first = ends & 0xffff, last = ends >> 16;
    if (last >= sizeof bitmap)
        return -1;
    if (first <= last) {
        const uint8_t *bytes = ki_read_bytes(r, last - first + 1);
        if (!bytes)
            return -1;
        memcpy(bitmap + first, bytes, last - first + 1);
    }
    int count = 0;
    for (int value = 0; value < 65536; value++)
        if (value == 0 || bitmap[value >> 3] >> (value & 7) & 1)
            table[count++] = (uint16_t)value;
    memset(table + count, 0, (65536 - (size_t)count) * sizeof *table);
    return count - 1;
}

static int down(const ki_exr_box *box, const ki_exr_channel *c)
{
    return ki_exr_samples(box->y, box->height, c->y_sampling);
}

static int across(const ki_exr_box *box, const ki_exr_channel *c)
{
    return ki_exr_samples(box->x, box->width, c->x_sampling);
}

// Planes, channel after channel, to the lines of a box.
static void lines_from_planes(const ki_exr_box *box, const uint8_t *planes, uint8_t *raw)
{
    const uint8_t *plane[KI_EXR_MAX_CHANNELS];
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        plane[c] = planes;
        planes +=
            (size_t)across(box, channel) * (size_t)down(box, channel) * (size_t)channel->bytes;
    }
    for (int y = box->y; y < box->y + box->height; y++)
        for (int c = 0; c < box->channel_count; c++) {
            const ki_exr_channel *channel = &box->channels[c];
            if (!ki_exr_line_has(channel, y))
                continue;
            size_t bytes = (size_t)across(box, channel) * (size_t)channel->bytes;
            memcpy(raw, plane[c], bytes);
            raw += bytes;
            plane[c] += bytes;
        }
}

static bool undo_piz(kiln_context *context, const ki_exr_box *box, const uint8_t *packed,
                     size_t packed_size, uint8_t *raw, size_t size)
{
    size_t count = size / 2;
    uint16_t *values = ki_alloc_raw(context, count + 65536, sizeof *values);
    if (!values)
        return false;
    uint16_t *table = values + count;
    ki_reader r = ki_reader_make(packed, packed_size);
    int greatest = read_values(&r, table);
    uint32_t length = ki_read_u32(&r);
    const uint8_t *huffman = ki_read_bytes(&r, length);
    bool good = greatest >= 0 && huffman &&
                ki_exr_undo_huffman(context, huffman, length, values, count) == KILN_OK;
    if (good) {
        uint16_t *plane = values;
        for (int c = 0; c < box->channel_count; c++) {
            const ki_exr_channel *channel = &box->channels[c];
            int width = across(box, channel), height = down(box, channel);
            int words = channel->bytes / 2;
            for (int k = 0; k < words; k++)
                undo_wavelet(plane + k, width, words, height, (ptrdiff_t)width * words,
                             greatest >= 1 << 14);
            plane += (ptrdiff_t)width * height * words;
        }
        for (size_t i = 0; i < count; i++)
            values[i] = table[values[i]];
        lines_from_planes(box, (const uint8_t *)values, raw);
    }
    ki_free(values);
    return good;
}

// -------------------------------------------------------------------------------------------- PXR24

// Of each line and channel the highest bytes, then the next, of differences; a float without its
// lowest byte.
static bool undo_pxr24(kiln_context *context, const ki_exr_box *box, const uint8_t *packed,
                       size_t packed_size, uint8_t *raw, size_t size)
{
    size_t plain_size = 0;
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        size_t bytes = channel->type == EXR_PIXEL_FLOAT ? 3 : (size_t)channel->bytes;
        plain_size += bytes * (size_t)across(box, channel) * (size_t)down(box, channel);
    }
    uint8_t *plain = ki_alloc_raw(context, size, 1);
    bool good = plain && ki_exr_inflate(packed, packed_size, plain, plain_size);
    const uint8_t *from = plain;
    for (int y = box->y; good && y < box->y + box->height; y++)
        for (int c = 0; c < box->channel_count; c++) {
            const ki_exr_channel *channel = &box->channels[c];
            if (!ki_exr_line_has(channel, y))
                continue;
            size_t width = (size_t)across(box, channel), bytes = (size_t)channel->bytes;
            size_t planes = channel->type == EXR_PIXEL_FLOAT ? 3 : bytes;
            uint32_t value = 0;
            for (size_t x = 0; x < width; x++, raw += bytes) {
                uint32_t difference = 0;
                for (size_t k = 0; k < planes; k++)
                    difference = difference << 8 | from[k * width + x];
                value += difference;
                uint32_t stored = channel->type == EXR_PIXEL_FLOAT ? value << 8 : value;
                memcpy(raw, &stored, bytes);
            }
            from += planes * width;
        }
    ki_free(plain);
    return good;
}

// ---------------------------------------------------------------------------------------------- B44

// Sixteen halfs: the first, then 15 differences of 6 bits, down the first column and to the right
// from there; or three bytes where all are one.
static size_t undo_block(const uint8_t *bytes, size_t left, uint16_t s[16])
{
    static const uint8_t to[15] = {4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
    if (left < 3)
        return 0;
    int shift = bytes[2] >> 2;
    bool flat = shift >= 13;
    if (!flat && left < 14)
        return 0;
    s[0] = (uint16_t)(bytes[0] << 8 | bytes[1]);
    for (int i = 0, bit = 22; i < 15; i++, bit += 6) {
        uint16_t before = s[i < 3 ? to[i] - 4 : to[i] - 1];
        if (flat) {
            s[to[i]] = s[0];
            continue;
        }
        int two = bytes[bit / 8] << 8 | (bit / 8 < 13 ? bytes[bit / 8 + 1] : 0);
        int difference = (two >> (10 - bit % 8) & 63) - 32;
        s[to[i]] = (uint16_t)(before + difference * (1 << shift));
    }
    for (int i = 0; i < 16; i++)
        s[i] = s[i] & 0x8000 ? s[i] & 0x7fff : (uint16_t)~s[i];
    return flat ? 3 : 14;
}

static bool undo_b44(kiln_context *context, const ki_exr_box *box, const uint8_t *packed,
                     size_t packed_size, uint8_t *raw, size_t size)
{
    uint8_t *planes = ki_alloc_raw(context, size, 1), *plane = planes;
    ki_reader r = ki_reader_make(packed, packed_size);
    bool good = planes != NULL;
    for (int c = 0; good && c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        int width = across(box, channel), height = down(box, channel);
        size_t bytes = (size_t)width * (size_t)height * (size_t)channel->bytes;
        if (channel->type != EXR_PIXEL_HALF) {
            const uint8_t *from = ki_read_bytes(&r, bytes);
            good = from != NULL;
            if (good)
                memcpy(plane, from, bytes);
        }
        good = good && !(channel->type == EXR_PIXEL_HALF && channel->linear);
        for (int y = 0; good && channel->type == EXR_PIXEL_HALF && y < height; y += 4)
            for (int x = 0; good && x < width; x += 4) {
                uint16_t block[16] = {0};
                size_t used = undo_block(r.at, ki_reader_left(&r), block);
                good = used && ki_read_bytes(&r, used);
                for (int j = 0; j < ki_min(4, height - y); j++)
                    memcpy(plane + 2 * ((size_t)(y + j) * (size_t)width + (size_t)x),
                           block + (ptrdiff_t)4 * j, 2 * (size_t)ki_min(4, width - x));
            }
        plane += bytes;
    }
    if (good)
        lines_from_planes(box, planes, raw);
    ki_free(planes);
    return good;
}

bool ki_exr_undo_other(kiln_context *context, exr_const_context_t core, int part,
                       const exr_chunk_info_t *info, const ki_exr_box *box, int compression,
                       const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size)
{
    (void)core, (void)part, (void)info;
    if (compression == EXR_COMPRESSION_PIZ)
        return undo_piz(context, box, packed, packed_size, raw, size);
    if (compression == EXR_COMPRESSION_PXR24)
        return undo_pxr24(context, box, packed, packed_size, raw, size);
    return undo_b44(context, box, packed, packed_size, raw, size);
}
