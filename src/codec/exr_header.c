// EXR headers. In: the bytes of a file. Out: its parts with their channels, windows and
// compression. The format is described in "Reading and Writing OpenEXR Image Files" and "OpenEXR
// File Layout". Input is not trusted: every size is checked against the rest of the file, and names
// point into the file's bytes.
//
// kiln has its own EXR reader because OpenEXRCore is not available on every system that kiln
// supports (Windows, static musl, WebAssembly), and because versions of that library differ in what
// they read: the one of Debian 12 cannot read DWA. The tests compare this reader with OpenEXRCore.
#include "base/bytes.h"
#include "codec/exr.h"

#include <string.h>

// flags in the four bytes that also hold the file's version
enum { TILED = 0x200, DEEP = 0x800, MULTIPART = 0x1000 };

// -------------------------------------------------------------------------------------- attributes

// Returns a name up to its NUL, or NULL if there is no NUL within the length that names may have.
static const char *read_text(ki_reader *r)
{
    size_t left = ki_reader_left(r), most = KI_EXR_MAX_NAME + 1;
    const uint8_t *end = left ? memchr(r->at, 0, left < most ? left : most) : NULL;
    return end ? (const char *)ki_read_bytes(r, (size_t)(end - r->at) + 1) : NULL;
}

typedef struct attribute {
    const char *name, *type;
    const uint8_t *bytes;
    size_t size;
} attribute;

// Reads the next attribute of a header. Returns false at the NUL that ends the header, where
// a->name is "", and after the end of the file, where a->name is NULL.
static bool next_attribute(ki_reader *r, attribute *a)
{
    *a = (attribute){.name = read_text(r)};
    if (!a->name || !a->name[0])
        return false;
    a->type = read_text(r);
    a->size = ki_read_u32(r);
    a->bytes = a->type ? ki_read_bytes(r, a->size) : NULL;
    if (!a->bytes)
        a->name = NULL;
    return a->name != NULL;
}

const uint8_t *ki_exr_attribute(const ki_exr_part *part, const char *name, const char *type,
                                size_t *size)
{
    ki_reader r =
        ki_reader_make(part->attributes, (size_t)(part->attributes_end - part->attributes));
    attribute a;
    while (next_attribute(&r, &a))
        if (!strcmp(a.name, name) && !strcmp(a.type, type)) {
            *size = a.size;
            return a.bytes;
        }
    return NULL;
}

// ---------------------------------------------------------------------------------------- channels

static bool read_channel(ki_reader *r, ki_exr_channel *c)
{
    *c = (ki_exr_channel){.name = read_text(r)};
    uint32_t type = ki_read_u32(r);
    // the field is one byte, which three reserved bytes follow
    c->linear = (ki_read_u32(r) & 0xff) != 0;
    uint32_t x = ki_read_u32(r), y = ki_read_u32(r);
    if (!c->name || !c->name[0] || r->failed || type >= KI_EXR_TYPES || x < 1 || y < 1 ||
        x > KI_EXR_MAX_SAMPLING || y > KI_EXR_MAX_SAMPLING)
        return false;
    c->type = (int)type;
    c->bytes = type == KI_EXR_HALF ? 2 : 4;
    c->x_sampling = (int)x;
    c->y_sampling = (int)y;
    return true;
}

// What ends the reading of a header before its end.
typedef enum stop { GO_ON, STARVED, CANCELLED } stop;

enum { STEP = 1024 }; // number of attributes or channels after which the caller may stop the work

// Reads a list of channels, which ends with a NUL. Returns NULL on success, else a text that says
// what is wrong.
static const char *read_channels(kiln_context *context, const attribute *a, ki_exr_part *p,
                                 stop *stopped)
{
    static const char wrong[] = "its list of channels is damaged, or has a name of more than "
                                "255 bytes or samples more than 16 pixels apart";
    ki_exr_channel channel;
    ki_reader counting = ki_reader_make(a->bytes, a->size), r = counting;
    int count = 0;
    while (ki_reader_left(&counting) > 1) {
        if (!read_channel(&counting, &channel))
            return wrong;
        if (++count % STEP == 0 && !ki_progress(context, "reading", 0)) {
            *stopped = CANCELLED;
            return wrong;
        }
    }
    if (p->channels || count == 0 || strcmp(a->type, "chlist") != 0)
        return wrong;
    p->channels = ki_alloc_raw(context, (size_t)count, sizeof *p->channels);
    if (!p->channels) {
        *stopped = STARVED;
        return wrong;
    }
    for (p->channel_count = 0; p->channel_count < count; p->channel_count++) {
        if (p->channel_count % STEP == STEP - 1 && !ki_progress(context, "reading", 0)) {
            *stopped = CANCELLED;
            return wrong;
        }
        read_channel(&r, &p->channels[p->channel_count]);
    }
    return NULL;
}

// ------------------------------------------------------------------------------------------- parts

static ki_exr_window read_window(ki_reader *r)
{
    ki_exr_window w;
    w.left = (int32_t)ki_read_u32(r);
    w.top = (int32_t)ki_read_u32(r);
    w.right = (int32_t)ki_read_u32(r);
    w.bottom = (int32_t)ki_read_u32(r);
    return w;
}

static bool is(const attribute *a, const char *name, size_t size)
{
    return a->size == size && !strcmp(a->name, name);
}

static bool holds(const attribute *a, const char *text)
{
    return strlen(text) == a->size && !memcmp(a->bytes, text, a->size);
}

static void read_storage(const attribute *a, ki_exr_part *p)
{
    static const char *const types[] = {"scanlineimage", "tiledimage", "deepscanline", "deeptile"};
    for (int i = 0; i < 4; i++)
        if (holds(a, types[i])) {
            p->tiled = i % 2;
            p->deep = i >= 2;
        }
}

enum { HAS_COMPRESSION = 1, HAS_DATA = 2, HAS_DISPLAY = 4 };

// Takes what kiln needs from an attribute. Returns the attribute's flag if it is one of the three
// that every part must have (compression, data window, display window), or 0.
static int read_attribute(const attribute *a, ki_exr_part *p)
{
    ki_reader r = ki_reader_make(a->bytes, a->size);
    if (is(a, "compression", 1)) {
        p->compression = a->bytes[0];
        return HAS_COMPRESSION;
    }
    if (is(a, "dataWindow", 16)) {
        p->data = read_window(&r);
        return HAS_DATA;
    }
    if (is(a, "displayWindow", 16)) {
        p->display = read_window(&r);
        return HAS_DISPLAY;
    }
    if (is(a, "tiles", 9)) {
        p->tile_width = ki_read_u32(&r);
        p->tile_height = ki_read_u32(&r);
    } else if (is(a, "chunkCount", 4)) {
        p->stated_chunks = (int32_t)ki_read_u32(&r);
    } else if (!strcmp(a->name, "type") && !strcmp(a->type, "string")) {
        read_storage(a, p);
    } else if (!strcmp(a->name, "name") && !strcmp(a->type, "string")) {
        p->name = (const char *)a->bytes;
        p->name_length = a->size;
    }
    return 0;
}

// Reads the header of one part, up to the NUL that ends it. Returns NULL on success, else a text
// that says what is wrong.
static const char *read_part(kiln_context *context, ki_reader *r, uint32_t flags, ki_exr_part *p,
                             stop *stopped)
{
    int found = 0;
    size_t count = 0;
    attribute a;
    *p = (ki_exr_part){.attributes = r->at, .stated_chunks = -1};
    p->tiled = flags & TILED;
    p->deep = flags & DEEP;
    while (next_attribute(r, &a)) {
        const char *wrong = NULL;
        if (!strcmp(a.name, "channels"))
            wrong = read_channels(context, &a, p, stopped);
        else
            found |= read_attribute(&a, p);
        if (++count % STEP == 0 && !ki_progress(context, "reading", 0))
            *stopped = CANCELLED;
        if (!wrong && count > KI_EXR_MAX_ATTRIBUTES)
            wrong = "it has more than 1048576 attributes";
        if (wrong || *stopped)
            return wrong ? wrong : "";
    }
    if (!a.name)
        return "it ends within an attribute, or an attribute has a name of more than 255 bytes";
    p->attributes_end = r->at;
    return !p->channels                 ? "it has no attribute channels"
           : !(found & HAS_COMPRESSION) ? "it has no attribute compression"
           : !(found & HAS_DATA)        ? "it has no attribute dataWindow"
           : !(found & HAS_DISPLAY)     ? "it has no attribute displayWindow"
                                        : NULL;
}

// Makes room for one more part in the header's array of parts.
static bool grow(kiln_context *context, ki_exr_header *h)
{
    size_t count = (size_t)h->part_count;
    // the array is full only when the count is a power of two; the room is then doubled
    if (count & (count - 1))
        return true;
    ki_exr_part *parts = ki_alloc(context, count ? 2 * count : 1, sizeof *parts);
    if (!parts)
        return false;
    if (count)
        memcpy(parts, h->parts, count * sizeof *parts);
    ki_free(h->parts);
    h->parts = parts;
    return true;
}

static const char *read_parts(kiln_context *context, ki_exr_header *h, stop *stopped)
{
    ki_reader r = ki_reader_make(h->bytes, h->held);
    ki_read_u32(&r); // the magic number, which is already checked
    uint32_t version = ki_read_u32(&r);
    if (r.failed || (version & 0xff) != 2)
        return "its version is not 2";
    h->multipart = version & MULTIPART;
    do {
        if (h->part_count == KI_EXR_MAX_PARTS)
            return "it has more than 1024 parts";
        if (!grow(context, h))
            *stopped = STARVED;
        else if (!ki_progress(context, "reading", 0))
            *stopped = CANCELLED;
        if (*stopped)
            return "";
        const char *wrong = read_part(context, &r, version, &h->parts[h->part_count++], stopped);
        if (wrong)
            return wrong;
    } while (h->multipart && ki_reader_left(&r) && *r.at);
    if (h->multipart)
        ki_read_u8(&r);
    h->tables = h->held - ki_reader_left(&r);
    return r.failed ? "it ends too early" : NULL;
}

kiln_result ki_exr_read_header(kiln_context *context, const uint8_t *bytes, size_t size,
                               const char *name, ki_exr_header *header, kiln_error *error)
{
    *header = (ki_exr_header){.bytes = bytes, .held = size, .size = size};
    stop stopped = GO_ON;
    const char *wrong = read_parts(context, header, &stopped);
    if (stopped == CANCELLED)
        return ki_fail_cancelled(error, "reading");
    if (stopped == STARVED)
        return ki_fail(error, KILN_ERROR_MEMORY, "out of memory: %s: reading the EXR header", name);
    if (wrong)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the EXR header is damaged: %s", name, wrong);
    return KILN_OK;
}

void ki_exr_header_free(ki_exr_header *header)
{
    for (int i = 0; i < header->part_count; i++)
        ki_free(header->parts[i].channels);
    ki_free(header->parts);
    *header = (ki_exr_header){0};
}
