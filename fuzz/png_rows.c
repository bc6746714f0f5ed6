// Rows of a PNG, with any filters, of any colour type, depth, interlacing and palette: packed into
// a file that is whole, they must be read.
#include "fuzz.h"

#include "codec/codec.h"
#include "codec/deflate.h"

#include <stdlib.h>
#include <string.h>

static void add_chunk(ki_writer *w, const char *type, const uint8_t *bytes, size_t size)
{
    static ki_crc32_table table;
    if (!table.sums[0][1])
        ki_crc32_fill(&table);
    ki_write_u32(w, __builtin_bswap32((uint32_t)size));
    size_t start = w->size;
    ki_write(w, type, 4);
    ki_write(w, bytes, size);
    if (!w->failed)
        ki_write_u32(w, __builtin_bswap32(ki_crc32(&table, 0, w->bytes + start, size + 4)));
}

void fuzz_png_rows(const uint8_t *data, size_t size)
{
    static const uint8_t kinds[15][2] = {{0, 1}, {0, 2},  {0, 4},  {0, 8}, {0, 16},
                                         {2, 8}, {2, 16}, {3, 1},  {3, 2}, {3, 4},
                                         {3, 8}, {4, 8},  {4, 16}, {6, 8}, {6, 16}};
    enum { HEAD = 6 };
    if (size < HEAD)
        return;
    const uint8_t *kind = kinds[data[0] % 15];
    size_t colors = 3 * (1 + (size_t)data[4] % 256), pieces = 1 + data[5] % 4;
    uint8_t head[13] = {0,          0,       0, (uint8_t)(1 + data[1] % 40),
                        0,          0,       0, (uint8_t)(1 + data[2] % 40),
                        kind[1],    kind[0], 0, 0,
                        data[3] & 1};
    kiln_context *context;
    kiln_context_def def = {.thread_count = 1, .memory_limit = (size_t)64 << 20};
    if (kiln_context_create(&def, &context, NULL) != KILN_OK)
        return;
    uint8_t palette[768];
    for (size_t i = 0; i < sizeof palette; i++)
        palette[i] = data[i % size];
    // Any row is whole: what is missing are zeros.
    size_t rows = 40 * 2 * (40 * 8 + 1), given = size - HEAD < rows ? size - HEAD : rows;
    uint8_t *raw = calloc(rows, 1), *packed = malloc(ki_deflate_bound(rows));
    ki_deflater *deflater = ki_deflater_create(context);
    fuzz_must(raw && packed && deflater);
    memcpy(raw, data + HEAD, given);
    size_t length = ki_deflate(deflater, raw, rows, packed, ki_deflate_bound(rows));
    fuzz_must(length > 0);
    ki_writer w = {.context = context};
    ki_write(&w, "\x89PNG\r\n\x1a\n", 8);
    add_chunk(&w, "IHDR", head, sizeof head);
    add_chunk(&w, "PLTE", palette, colors);
    for (size_t i = 0; i < pieces; i++)
        add_chunk(&w, "IDAT", packed + length * i / pieces,
                  length * (i + 1) / pieces - length * i / pieces);
    kiln_image image;
    kiln_result result = ki_png_decode(context, w.bytes, w.size, "fuzz", &image, NULL, NULL, NULL);
    // The only thing that can be wrong is a filter.
    for (size_t i = 0; result == KILN_OK && i < 3 * (size_t)image.width * (size_t)image.height; i++)
        fuzz_must(image.pixels[i] >= 0 && image.pixels[i] <= 1);
    kiln_image_free(&image);
    ki_writer_free(&w);
    ki_deflater_free(deflater);
    free(raw);
    free(packed);
    kiln_context_destroy(context);
}
