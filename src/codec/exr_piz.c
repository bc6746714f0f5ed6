// EXR's PIZ. In: the packed bytes of a chunk. Out: the lines of its box. Samples, as 16-bit
// numbers, were replaced by their rank among the values that occur, transformed by a Haar wavelet
// plane by plane, and Huffman-coded (exr_huffman.c). The format is described in "Reading and
// Writing OpenEXR Image Files" and defined by the original implementation.
#include "codec/exr.h"

#include "base/bytes.h"

#include <string.h>

// Recover the values a and b from their mean and their difference, the coefficients of PIZ's Haar
// wavelet: pair14 for values below 2^14, pair16 for 16 bits with differences modulo 2^16.
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
static bool undo_wavelet(ki_exr_workspace *work, uint16_t *plane, int width, ptrdiff_t step,
                         int height, ptrdiff_t row, bool wide)
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
            if (!ki_exr_go_on(work, (size_t)(width / one) * 2 * sizeof *at))
                return false;
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
    return true;
}

// Reads which of the 65536 possible values occur: a bitmap of which the file holds the bytes
// `first` to `last`. table[i] becomes the i-th value that occurs; 0 always counts. Returns the
// greatest i, or -1 if the data are damaged.
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

static bool undo_wavelets(ki_exr_workspace *work, const ki_exr_box *box, uint16_t *plane, bool wide)
{
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        int width = ki_exr_columns(box, channel), height = ki_exr_rows(box, channel);
        int words = channel->bytes / 2;
        for (int k = 0; k < words; k++)
            if (!undo_wavelet(work, plane + k, width, words, height, (ptrdiff_t)width * words,
                              wide))
                return false;
        plane += (ptrdiff_t)width * height * words;
    }
    return true;
}

// Replaces ranks by the values of those ranks.
static bool undo_ranks(ki_exr_workspace *work, const uint16_t *table, uint16_t *values,
                       size_t count)
{
    enum { PART = 1 << 20 };
    for (size_t at = 0, end = 0; at < count; at = end) {
        end = count - at < PART ? count : at + PART;
        for (size_t i = at; i < end; i++)
            values[i] = table[values[i]];
        if (!ki_exr_go_on(work, (end - at) * sizeof *values))
            return false;
    }
    return true;
}

kiln_result ki_exr_decompress_piz(ki_exr_workspace *work, const ki_exr_box *box,
                                  const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                  size_t size)
{
    size_t count = size / 2;
    uint16_t *values = (uint16_t *)(void *)work->scratch;
    uint16_t *table = ki_alloc_raw(work->context, 65536, sizeof *table);
    if (!table)
        return KILN_ERROR_MEMORY;
    ki_reader r = ki_reader_make(packed, packed_size);
    int greatest = read_values(&r, table);
    uint32_t length = ki_read_u32(&r);
    const uint8_t *huffman = ki_read_bytes(&r, length);
    kiln_result result = KILN_ERROR_FORMAT;
    if (greatest >= 0 && huffman)
        result = ki_exr_unpack_huffman(work, huffman, length, values, count);
    if (result == KILN_OK && !(undo_wavelets(work, box, values, greatest >= 1 << 14) &&
                               undo_ranks(work, table, values, count) &&
                               ki_exr_lines_from_planes(work, box, work->scratch, raw)))
        result = KILN_ERROR_FORMAT;
    ki_free(table);
    return result;
}
