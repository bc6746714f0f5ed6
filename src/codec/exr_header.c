// EXR headers and tables of chunks, where OpenEXRCore is left out: its functions that exr.c calls, by
// the file format's description ("Reading and Writing OpenEXR Image Files", "OpenEXR File Layout").
// Nothing here is trusted: every size is checked against what is left of the file.
#include "base/bytes.h"
#include "codec/exr.h"

#include <string.h>

enum {
    MAX_PARTS = 64,
    MAX_CHANNELS = 1024,
    TILED = 0x200,
    DEEP = 0x800,
    MULTIPART = 0x1000,
    KEPT = 3, // attributes that are handed out
};

typedef struct kept {
    const char *name;
    char *copy;
    exr_attr_string_t string;
    exr_attribute_t attribute;
    float number;
} kept;

typedef struct header_part {
    exr_attr_chlist_t list;
    exr_attr_box2i_t data, display;
    exr_storage_t storage;
    int compression;
    bool has_data, has_display, has_compression, has_storage, has_tiles;
    uint32_t tile_width, tile_height;
    int32_t chunk_count; // -1 where the header does not say
    uint64_t table;      // where the offsets begin
    kept kept[KEPT];
} header_part;

struct exr_header {
    kiln_context *memory;
    bool starved; // an allocation failed
    uint8_t *bytes;
    size_t size;
    bool multipart;
    int part_count;
    header_part part[MAX_PARTS];
};

static const char *const kept_names[KEPT] = {"software", "kilnShape", "kilnRoughness"};

// Text up to its NUL, or NULL.
static const char *read_text(ki_reader *r)
{
    size_t left = ki_reader_left(r);
    const uint8_t *end = left ? memchr(r->at, 0, left) : NULL;
    return end ? (const char *)ki_read_bytes(r, (size_t)(end - r->at) + 1) : NULL;
}

static bool read_channels(exr_context_t h, ki_reader *r, exr_attr_chlist_t *list)
{
    ki_free(list->entries);
    list->num_channels = 0;
    list->entries = ki_alloc(h->memory, MAX_CHANNELS, sizeof *list->entries);
    h->starved |= !list->entries;
    while (list->entries && ki_reader_left(r) > 1) {
        const char *name = read_text(r);
        exr_attr_chlist_entry_t *entry = &list->entries[list->num_channels];
        if (!name || !name[0] || list->num_channels == MAX_CHANNELS)
            return false;
        *entry = (exr_attr_chlist_entry_t){.name = {(int32_t)strlen(name), name}};
        entry->pixel_type = (exr_pixel_type_t)ki_read_u32(r);
        entry->p_linear = (uint8_t)ki_read_u32(r); // one byte and three that are reserved
        entry->x_sampling = (int32_t)ki_read_u32(r);
        entry->y_sampling = (int32_t)ki_read_u32(r);
        list->num_channels++;
        if (r->failed || (unsigned)entry->pixel_type >= EXR_PIXEL_LAST_TYPE ||
            entry->x_sampling < 1 || entry->y_sampling < 1)
            return false;
    }
    return list->num_channels > 0;
}

static exr_attr_box2i_t read_box(ki_reader *r)
{
    exr_attr_box2i_t box;
    box.min.x = (int32_t)ki_read_u32(r);
    box.min.y = (int32_t)ki_read_u32(r);
    box.max.x = (int32_t)ki_read_u32(r);
    box.max.y = (int32_t)ki_read_u32(r);
    return box;
}

static bool names(const uint8_t *bytes, size_t size, const char *text)
{
    return strlen(text) == size && !memcmp(bytes, text, size);
}

static void read_storage(const uint8_t *bytes, size_t size, header_part *p)
{
    static const char *const types[] = {"scanlineimage", "tiledimage", "deepscanline", "deeptile"};
    for (int i = 0; i < 4; i++)
        if (names(bytes, size, types[i])) {
            p->storage = (exr_storage_t)i;
            p->has_storage = true;
        }
}

// A string's text has no NUL in the file: kept as a copy.
static bool keep(exr_context_t h, const char *name, const char *type, const uint8_t *bytes,
                 size_t size, header_part *p)
{
    for (int i = 0; i < KEPT; i++) {
        kept *k = &p->kept[i];
        if (strcmp(name, kept_names[i]) != 0 || k->name)
            continue;
        if (!strcmp(type, "float") && size == 4) {
            memcpy(&k->number, bytes, 4);
            k->attribute.type = EXR_ATTR_FLOAT;
        } else if (!strcmp(type, "string") && size < 4096) {
            k->copy = ki_alloc(h->memory, size + 1, 1);
            if (!k->copy) {
                h->starved = true;
                return false;
            }
            memcpy(k->copy, bytes, size);
            k->string = (exr_attr_string_t){(int32_t)size, k->copy};
            k->attribute = (exr_attribute_t){EXR_ATTR_STRING, &k->string};
        } else {
            continue;
        }
        k->name = kept_names[i];
    }
    return true;
}

static bool read_attribute(exr_context_t h, const char *name, const char *type,
                           const uint8_t *bytes, size_t size, header_part *p)
{
    ki_reader r = ki_reader_make(bytes, size);
    if (!strcmp(name, "channels"))
        return !strcmp(type, "chlist") && read_channels(h, &r, &p->list);
    if (!strcmp(name, "compression") && size == 1) {
        p->compression = bytes[0];
        p->has_compression = true;
    } else if (!strcmp(name, "dataWindow") && size == 16) {
        p->data = read_box(&r);
        p->has_data = true;
    } else if (!strcmp(name, "displayWindow") && size == 16) {
        p->display = read_box(&r);
        p->has_display = true;
    } else if (!strcmp(name, "tiles") && size == 9) {
        p->tile_width = ki_read_u32(&r);
        p->tile_height = ki_read_u32(&r);
        p->has_tiles = true;
    } else if (!strcmp(name, "chunkCount") && size == 4) {
        p->chunk_count = (int32_t)ki_read_u32(&r);
    } else if (!strcmp(name, "type") && !strcmp(type, "string")) {
        read_storage(bytes, size, p);
    }
    return keep(h, name, type, bytes, size, p);
}

// One header, up to the NUL that ends it.
static bool read_part(exr_context_t h, ki_reader *r, uint32_t flags, header_part *p)
{
    p->chunk_count = -1;
    p->storage = flags & DEEP    ? EXR_STORAGE_DEEP_SCANLINE
                 : flags & TILED ? EXR_STORAGE_TILED
                                 : EXR_STORAGE_SCANLINE;
    for (;;) {
        const char *name = read_text(r);
        if (!name)
            return false;
        if (!name[0])
            break;
        const char *type = read_text(r);
        uint32_t size = ki_read_u32(r);
        const uint8_t *bytes = type && size <= ki_reader_left(r) ? ki_read_bytes(r, size) : NULL;
        if (!bytes || r->failed || !read_attribute(h, name, type, bytes, size, p))
            return false;
    }
    return p->list.num_channels > 0 && p->has_data && p->has_display && p->has_compression;
}

static int lines_of(const header_part *p)
{
    static const int lines[EXR_COMPRESSION_LAST_TYPE] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return p->compression < EXR_COMPRESSION_LAST_TYPE ? lines[p->compression] : 0;
}

// Chunks of a part, of a tiled one with levels those of level 0, which come first; 0 for none.
static int64_t count_chunks(const header_part *p)
{
    int64_t width = (int64_t)p->data.max.x - p->data.min.x + 1;
    int64_t height = (int64_t)p->data.max.y - p->data.min.y + 1;
    int64_t across = 1, down;
    if (p->chunk_count >= 0)
        return p->chunk_count;
    if (width < 1 || height < 1)
        return 0;
    if (p->storage == EXR_STORAGE_TILED) {
        if (!p->has_tiles || !p->tile_width || !p->tile_height)
            return 0;
        across = (width + p->tile_width - 1) / p->tile_width;
        down = (height + p->tile_height - 1) / p->tile_height;
    } else {
        int lines = lines_of(p);
        down = lines ? (height + lines - 1) / lines : 0;
    }
    return across * down <= INT32_MAX ? across * down : 0;
}

static exr_result_t parse(exr_context_t h)
{
    ki_reader r = ki_reader_make(h->bytes, h->size);
    ki_read_u32(&r); // the first bytes, which are known
    uint32_t version = ki_read_u32(&r);
    if (r.failed || (version & 0xff) != 2)
        return EXR_ERR_BAD_HEADER;
    h->multipart = version & MULTIPART;
    do {
        if (h->part_count == MAX_PARTS || !read_part(h, &r, version, &h->part[h->part_count]))
            return h->starved ? EXR_ERR_OUT_OF_MEMORY : EXR_ERR_BAD_HEADER;
        h->part_count++;
    } while (h->multipart && ki_reader_left(&r) && *r.at);
    if (h->multipart)
        ki_read_u8(&r);
    uint64_t table = h->size - ki_reader_left(&r);
    for (int i = 0; i < h->part_count; i++) {
        h->part[i].table = table;
        table += 8 * (uint64_t)count_chunks(&h->part[i]);
    }
    return r.failed ? EXR_ERR_BAD_HEADER : EXR_ERR_SUCCESS;
}

exr_result_t exr_start_read(exr_context_t *context, const char *name,
                            const exr_context_initializer_t *init)
{
    (void)name;
    exr_context_t h = *context = ki_alloc(init->memory, 1, sizeof *h);
    if (!h)
        return EXR_ERR_OUT_OF_MEMORY;
    h->memory = init->memory;
    int64_t size = init->size_fn(h, init->user_data);
    h->size = size > 0 ? (size_t)size : 0;
    h->bytes = ki_alloc_raw(h->memory, h->size + 1, 1);
    if (!h->bytes)
        return EXR_ERR_OUT_OF_MEMORY;
    if (init->read_fn(h, init->user_data, h->bytes, h->size, 0, NULL) != size)
        return EXR_ERR_BAD_HEADER;
    return parse(h);
}

void exr_finish(exr_context_t *context)
{
    exr_context_t h = *context;
    for (int i = 0; h && i < MAX_PARTS; i++) {
        ki_free(h->part[i].list.entries);
        for (int k = 0; k < KEPT; k++)
            ki_free(h->part[i].kept[k].copy);
    }
    if (h)
        ki_free(h->bytes);
    ki_free(h);
    *context = NULL;
}

const char *exr_get_default_error_message(exr_result_t code)
{
    return code == EXR_ERR_OUT_OF_MEMORY ? "out of memory"
           : code == EXR_ERR_BAD_CHUNK   ? "a chunk is damaged"
                                         : "an attribute is missing, cut off or out of its range";
}

// --------------------------------------------------------------------------------------- questions

exr_result_t exr_get_count(exr_const_context_t h, int *count)
{
    *count = h->part_count;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_storage(exr_const_context_t h, int part, exr_storage_t *storage)
{
    *storage = h->part[part].storage;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_channels(exr_const_context_t h, int part, const exr_attr_chlist_t **list)
{
    *list = &h->part[part].list;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_data_window(exr_const_context_t h, int part, exr_attr_box2i_t *box)
{
    *box = h->part[part].data;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_display_window(exr_const_context_t h, int part, exr_attr_box2i_t *box)
{
    *box = h->part[part].display;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_compression(exr_const_context_t h, int part, exr_compression_t *compression)
{
    *compression = (exr_compression_t)h->part[part].compression;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_chunk_count(exr_const_context_t h, int part, int32_t *count)
{
    *count = (int32_t)count_chunks(&h->part[part]);
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_scanlines_per_chunk(exr_const_context_t h, int part, int32_t *lines)
{
    *lines = lines_of(&h->part[part]);
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_tile_sizes(exr_const_context_t h, int part, int level_x, int level_y,
                                int32_t *width, int32_t *height)
{
    (void)level_x, (void)level_y;
    const header_part *p = &h->part[part];
    if (!p->has_tiles || p->tile_width > INT32_MAX || p->tile_height > INT32_MAX)
        return EXR_ERR_BAD_HEADER;
    *width = (int32_t)p->tile_width;
    *height = (int32_t)p->tile_height;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_get_attribute_by_name(exr_const_context_t h, int part, const char *name,
                                       const exr_attribute_t **attribute)
{
    for (int k = 0; k < KEPT; k++) {
        const kept *found = &h->part[part].kept[k];
        if (found->name && !strcmp(found->name, name)) {
            *attribute = &found->attribute;
            return EXR_ERR_SUCCESS;
        }
    }
    return EXR_ERR_BAD_HEADER;
}

exr_result_t exr_attr_get_float(exr_const_context_t h, int part, const char *name, float *value)
{
    for (int k = 0; k < KEPT; k++) {
        const kept *found = &h->part[part].kept[k];
        if (found->name && !strcmp(found->name, name) && found->attribute.type == EXR_ATTR_FLOAT) {
            *value = found->number;
            return EXR_ERR_SUCCESS;
        }
    }
    return EXR_ERR_BAD_HEADER;
}

// ------------------------------------------------------------------------------------------ chunks

// A reader at a chunk, by its number in the table; failed where there is none.
static ki_reader find_chunk(exr_const_context_t h, int part, int64_t index)
{
    const header_part *p = &h->part[part];
    ki_reader nowhere = {.failed = true};
    uint64_t entry = p->table + 8 * (uint64_t)index;
    if (index < 0 || index >= count_chunks(p) || entry > h->size || h->size - entry < 8)
        return nowhere;
    ki_reader r = ki_reader_make(h->bytes + entry, 8);
    uint64_t offset = ki_read_u64(&r);
    if (offset >= h->size)
        return nowhere;
    r = ki_reader_make(h->bytes + offset, h->size - (size_t)offset);
    if (h->multipart && ki_read_u32(&r) != (uint32_t)part)
        return nowhere;
    return r;
}

static exr_result_t finish_chunk(exr_const_context_t h, ki_reader *r, exr_chunk_info_t *info)
{
    info->packed_size = ki_read_u32(r);
    info->data_offset = h->size - ki_reader_left(r);
    bool good = !r->failed && info->packed_size <= ki_reader_left(r);
    return good ? EXR_ERR_SUCCESS : EXR_ERR_BAD_CHUNK;
}

exr_result_t exr_read_scanline_chunk_info(exr_const_context_t h, int part, int y,
                                          exr_chunk_info_t *info)
{
    const header_part *p = &h->part[part];
    int lines = lines_of(p);
    if (!lines)
        return EXR_ERR_BAD_CHUNK;
    int64_t index = ((int64_t)y - p->data.min.y) / lines, first = p->data.min.y + index * lines;
    ki_reader r = find_chunk(h, part, index);
    if ((int32_t)ki_read_u32(&r) != first || r.failed)
        return EXR_ERR_BAD_CHUNK;
    int64_t left = p->data.max.y - first + 1;
    *info = (exr_chunk_info_t){.width = p->data.max.x - p->data.min.x + 1,
                               .height = left < lines ? (int32_t)left : lines};
    return finish_chunk(h, &r, info);
}

exr_result_t exr_read_tile_chunk_info(exr_const_context_t h, int part, int x, int y, int level_x,
                                      int level_y, exr_chunk_info_t *info)
{
    const header_part *p = &h->part[part];
    int64_t width = (int64_t)p->data.max.x - p->data.min.x + 1;
    int64_t height = (int64_t)p->data.max.y - p->data.min.y + 1;
    int64_t across = (width + p->tile_width - 1) / p->tile_width;
    ki_reader r = find_chunk(h, part, y * across + x);
    const int wanted[4] = {x, y, level_x, level_y};
    for (int i = 0; i < 4; i++)
        if ((int32_t)ki_read_u32(&r) != wanted[i])
            return EXR_ERR_BAD_CHUNK;
    int64_t right = width - (int64_t)x * p->tile_width,
            below = height - (int64_t)y * p->tile_height;
    *info =
        (exr_chunk_info_t){.width = (int32_t)(right < p->tile_width ? right : p->tile_width),
                           .height = (int32_t)(below < p->tile_height ? below : p->tile_height)};
    return finish_chunk(h, &r, info);
}
