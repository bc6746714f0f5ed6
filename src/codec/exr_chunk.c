// The chunks of an EXR file. In: a parsed header and the bytes of the file. Out: the place, size
// and box of each chunk, and its samples, decompressed by the file's method. A chunk is a tile, or
// as many scan lines as the method compresses together. All sizes are checked against the file's.
#include "base/bytes.h"
#include "codec/exr.h"

#include <string.h>

typedef struct method {
    const char *name;
    int lines; // number of scan lines in a chunk
    /// Greatest number of bytes that one packed byte can become, by which the size of the file
    /// bounds the size of the picture. RLE makes at most 128 bytes of 2, deflate 1032 of 1, PIZ 255
    /// samples of 9 bits, B44 16 samples of 3 bytes. DWA makes at most 516 bytes of block means of
    /// a deflated byte, and each mean a block of 256 bytes.
    size_t growth;
    ki_exr_decompress *decompress;
} method;

static const method methods[KI_EXR_COMPRESSIONS] = {
    [KI_EXR_NONE] = {"uncompressed", 1, 1, NULL},
    [KI_EXR_RLE] = {"rle", 1, 64, ki_exr_decompress_rle},
    [KI_EXR_ZIPS] = {"zips", 1, 1032, ki_exr_decompress_zip},
    [KI_EXR_ZIP] = {"zip", 16, 1032, ki_exr_decompress_zip},
    [KI_EXR_PIZ] = {"piz", 32, 512, ki_exr_decompress_piz},
    [KI_EXR_PXR24] = {"pxr24", 16, 1032 * 4 / 3, ki_exr_decompress_pxr24},
    [KI_EXR_B44] = {"b44", 32, 11, ki_exr_decompress_b44},
    [KI_EXR_B44A] = {"b44a", 32, 11, ki_exr_decompress_b44},
    [KI_EXR_DWAA] = {"dwaa", 32, 1 << 17, ki_exr_decompress_dwa},
    [KI_EXR_DWAB] = {"dwab", 256, 1 << 17, ki_exr_decompress_dwa},
};

const char *ki_exr_compression_name(int compression)
{
    return methods[compression].name;
}

// Returns the number of scan lines that a compression method puts in a chunk; 0 for an unknown
// method.
static int chunk_lines(int compression)
{
    return compression < KI_EXR_COMPRESSIONS ? methods[compression].lines : 0;
}

// ----------------------------------------------------------------------------------------- finding

// The size of the data window, and of the chunks into which it is cut: tiles or groups of lines.
typedef struct grid {
    // size in pixels of the data window and of a chunk; 0 if the header is wrong
    int64_t width, height, chunk_width, chunk_height;
    int64_t across, down;
} grid;

static grid make_grid(const ki_exr_part *p)
{
    grid g = {.width = (int64_t)p->data.right - p->data.left + 1,
              .height = (int64_t)p->data.bottom - p->data.top + 1};
    g.chunk_width = p->tiled ? p->tile_width : g.width;
    g.chunk_height = p->tiled ? (int64_t)p->tile_height : chunk_lines(p->compression);
    if (g.width < 1 || g.height < 1 || !g.chunk_width || !g.chunk_height)
        return (grid){0};
    g.across = (g.width + g.chunk_width - 1) / g.chunk_width;
    g.down = (g.height + g.chunk_height - 1) / g.chunk_height;
    return g;
}

int ki_exr_chunk_height(const ki_exr_part *part)
{
    return part->tiled
               ? (int)(part->tile_height < KILN_MAX_SIZE ? part->tile_height : KILN_MAX_SIZE)
               : chunk_lines(part->compression);
}

// Returns the number of entries in a part's table of chunk offsets. In a part with mip levels only
// the entries of level 0 count, which come first. Returns 0 if the header is wrong.
static int32_t chunk_count(const ki_exr_part *part)
{
    grid g = make_grid(part);
    if (part->stated_chunks >= 0)
        return part->stated_chunks;
    return g.across && g.down <= INT32_MAX / g.across ? (int32_t)(g.across * g.down) : 0;
}

static size_t most_from(int compression, size_t packed_size)
{
    size_t growth = methods[compression].growth;
    return packed_size > SIZE_MAX / growth - 64 ? SIZE_MAX
                                                : packed_size * growth + (growth > 1 ? 64 : 0);
}

typedef struct search {
    const ki_exr_header *header;
    const ki_exr_part *part;
    int part_index, entry_count;
    grid grid;
    uint64_t table; // position in the file of the part's table of chunk offsets
    uint64_t left;  // bytes of the file that belong to no chunk so far
} search;

// Greatest number of bytes before a packed chunk: its part, for a tile four numbers, and its size.
enum { HEAD = 24 };

// Reads what stands before the packed bytes of a chunk at `offset` into `head`. Returns a reader of
// these bytes, which has failed if the file cannot be read.
static ki_reader read_head(const search *s, uint64_t offset, uint8_t head[HEAD])
{
    const ki_exr_header *h = s->header;
    size_t size = h->size - offset < HEAD ? (size_t)(h->size - offset) : HEAD;
    ki_reader r = ki_reader_make(head, size);
    if (!h->file)
        memcpy(head, h->bytes + offset, size);
    else
        r.failed = !ki_file_read_at(h->file, offset, head, size);
    return r;
}

// Returns a reader of the chunk that entry `index` of the offset table points to, after the numbers
// that identify the chunk. *offset is the position of the chunk in the file. The reader has failed
// if the table is too short, or the chunk does not identify itself as that at tile or line group
// (`column`, `row`).
static ki_reader open_chunk(const search *s, int64_t index, int column, int row, uint64_t *offset,
                            uint8_t head[HEAD])
{
    const ki_exr_header *h = s->header;
    ki_reader nowhere = {.failed = true};
    uint64_t entry = s->table + 8 * (uint64_t)index;
    if (index >= s->entry_count || entry > h->held || h->held - entry < 8)
        return nowhere;
    ki_reader r = ki_reader_make(h->bytes + entry, 8);
    *offset = ki_read_u64(&r);
    if (*offset >= h->size)
        return nowhere;
    r = read_head(s, *offset, head);
    bool same = !h->multipart || ki_read_u32(&r) == (uint32_t)s->part_index;
    // a tile's chunk begins with its column, its row, and its mip level in x and y
    if (s->part->tiled) {
        same = same && ki_read_u32(&r) == (uint32_t)column && ki_read_u32(&r) == (uint32_t)row &&
               ki_read_u32(&r) == 0 && ki_read_u32(&r) == 0;
    } else {
        int64_t y = s->part->data.top + row * s->grid.chunk_height;
        same = same && (int32_t)ki_read_u32(&r) == y;
    }
    return same ? r : nowhere;
}

static kiln_result find_chunk(search *s, const char *name, int column, int row, ki_exr_chunk *c,
                              kiln_error *error)
{
    const grid *g = &s->grid;
    const ki_exr_header *h = s->header;
    int64_t index = row * g->across + column;
    int64_t x = column * g->chunk_width, y = row * g->chunk_height;
    int width = (int)(g->width - x < g->chunk_width ? g->width - x : g->chunk_width);
    int height = (int)(g->height - y < g->chunk_height ? g->height - y : g->chunk_height);
    uint64_t offset = 0;
    uint8_t head[HEAD];
    ki_reader r = open_chunk(s, index, column, row, &offset, head);
    c->packed_size = ki_read_u32(&r);
    c->at = r.failed ? h->size : offset + (uint64_t)(r.at - head);
    // Each byte of the file belongs to one chunk at most: a chunk larger than what the chunks
    // before it have left shows that chunks overlap.
    if (r.failed || c->packed_size > h->size - c->at || c->packed_size > s->left)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: chunk %lld is missing or damaged", name,
                       (long long)index);
    c->packed = h->file ? NULL : h->bytes + c->at;
    s->left -= c->packed_size;
    c->box = (ki_exr_box){s->part->data.left + (int)x, s->part->data.top + (int)y, width, height,
                          s->part->channels,           s->part->channel_count};
    c->size = ki_exr_box_size(&c->box);
    if (!c->size || c->packed_size > c->size ||
        c->size > most_from(s->part->compression, c->packed_size))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: chunk %lld has %zu bytes, which cannot hold its %d x %d pixels", name,
                       (long long)index, c->packed_size, width, height);
    return KILN_OK;
}

kiln_result ki_exr_find_chunks(kiln_context *context, const ki_exr_header *header, int part,
                               const char *name, ki_exr_chunk **chunks, int *count,
                               kiln_error *error)
{
    const ki_exr_part *p = &header->parts[part];
    search s = {header, p, part, chunk_count(p), make_grid(p), header->tables, header->size};
    for (int i = 0; i < part; i++)
        s.table += 8 * (uint64_t)chunk_count(&header->parts[i]);
    *chunks = NULL;
    *count = 0;
    int64_t needed = s.grid.across * s.grid.down;
    if (needed < 1 || s.entry_count < needed || (uint64_t)s.entry_count > header->size / 8)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: its table of %d chunks does not fit into the file's %llu bytes or is "
                       "shorter than the %lld chunks of the picture",
                       name, s.entry_count, (unsigned long long)header->size, (long long)needed);
    ki_exr_chunk *found = ki_alloc_raw(context, (size_t)needed, sizeof *found);
    if (!found)
        return ki_fail_memory(context, error, name, (size_t)needed * sizeof *found);
    for (int row = 0; row < s.grid.down; row++)
        for (int column = 0; column < s.grid.across; column++) {
            kiln_result result = KILN_OK;
            if (*count % 4096 == 4095 && !ki_progress(context, "reading", 0))
                result = ki_fail_cancelled(error, "reading");
            else
                result = find_chunk(&s, name, column, row, &found[*count], error);
            if (result != KILN_OK) {
                ki_free(found);
                *count = 0;
                return result;
            }
            ++*count;
        }
    *chunks = found;
    return KILN_OK;
}

// --------------------------------------------------------------------------------------- unpacking

// A chunk may be one pixel, and takes time by itself: PIZ fills tables of 2^16 entries, and DWA
// compares the channels' names with each other. This time is counted as that of so many
// decompressed bytes, and as 8 more for each pair of channels.
enum { FIXED_COST = 1 << 17 };

const uint8_t *ki_exr_chunk_samples(ki_exr_workspace *work, int compression,
                                    const ki_exr_chunk *chunk, uint8_t *raw, kiln_result *result)
{
    *result = KILN_OK;
    // A chunk that compression would not make smaller is stored uncompressed.
    if (chunk->packed_size == chunk->size)
        return chunk->packed;
    const method *m = &methods[compression];
    size_t channels = (size_t)chunk->box.channel_count;
    if (!ki_exr_go_on(work, FIXED_COST + 8 * channels * channels)) {
        *result = KILN_ERROR_CANCELLED;
        return NULL;
    }
    *result = m->decompress ? m->decompress(work, &chunk->box, chunk->packed, chunk->packed_size,
                                            raw, chunk->size)
                            : KILN_ERROR_FORMAT;
    if (*result == KILN_ERROR_FORMAT && ki_was_stopped(&work->asker))
        *result = KILN_ERROR_CANCELLED;
    return *result == KILN_OK ? raw : NULL;
}
