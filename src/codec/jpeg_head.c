// The segments of JPEG files. In: bytes. Out: size and kind of the picture, the shape of its
// pixels, and the places of its Exif orientation, XMP packet, ICC profile, gain-map numbers and
// further pictures. Method: segments are walked one after the other (ITU-T T.81, annex B); the data
// of a scan are passed by a search for the next marker. Each byte is visited once.
#include "codec/jpeg_head.h"

#include <string.h>

enum {
    SOI = 0xd8,
    EOI = 0xd9,
    SOS = 0xda,
    APP0 = 0xe0,
    APP1 = 0xe1,
    APP2 = 0xe2,
    RST0 = 0xd0,
    RST7 = 0xd7,
    TEM = 0x01,
};

static unsigned u16_at(const uint8_t *at)
{
    return (unsigned)(at[0] << 8 | at[1]);
}

// ------------------------------------------------------------------------------------------- TIFF

// The beginning of a TIFF file of either byte order. Exif data and a JPEG file's index of pictures
// have this form.
typedef struct tiff {
    ki_span span;
    bool low_first;
} tiff;

static uint32_t tiff_number(const tiff *t, size_t at, int bytes)
{
    uint32_t value = 0;
    if (at > t->span.size || t->span.size - at < (size_t)bytes)
        return 0;
    for (int i = 0; i < bytes; i++)
        value = value << 8 | t->span.bytes[at + (size_t)(t->low_first ? bytes - 1 - i : i)];
    return value;
}

static bool open_tiff(ki_span span, tiff *t)
{
    *t = (tiff){span, span.size >= 8 && span.bytes[0] == 'I'};
    return span.size >= 8 && (!memcmp(span.bytes, "II*\0", 4) || !memcmp(span.bytes, "MM\0*", 4));
}

// Returns the position of a tag's entry in the first directory of a TIFF file, or 0 if the
// directory has no such entry.
static size_t find_entry(const tiff *t, unsigned tag)
{
    size_t at = tiff_number(t, 4, 4);
    unsigned count = tiff_number(t, at, 2);
    for (unsigned i = 0; i < count; i++) {
        size_t entry = at + 2 + 12 * (size_t)i;
        if (entry + 12 > t->span.size)
            return 0;
        if (tiff_number(t, entry, 2) == tag)
            return entry;
    }
    return 0;
}

int ki_exif_orientation(ki_span exif)
{
    tiff t;
    size_t entry = open_tiff(exif, &t) ? find_entry(&t, 0x0112) : 0;
    unsigned value = entry ? tiff_number(&t, entry + 8, 2) : 1;
    return value >= 1 && value <= 8 ? (int)value : 1;
}

// --------------------------------------------------------------------------------------- segments

// Returns whether a segment begins with a name of `count` bytes, and sets *rest to the bytes after
// the name.
static bool is_named(ki_span segment, const char *name, size_t count, ki_span *rest)
{
    if (segment.size < count || memcmp(segment.bytes, name, count) != 0)
        return false;
    *rest = (ki_span){segment.bytes + count, segment.size - count};
    return true;
}

#define NAMED(segment, name, rest) is_named(segment, name, sizeof(name), rest)

// Reads the segment JFIF (ITU-T T.871, 10.1), which states the pixels per unit of length along x
// and y, whichever the unit is. The first such segment counts; numbers of 0 state nothing.
static void read_app0(ki_jpeg_head *head, ki_span segment)
{
    enum { DENSITY = 3 }; // place of the two numbers, after the version and the unit
    ki_span rest;
    if (head->aspect != 0 || !NAMED(segment, "JFIF", &rest) || rest.size < DENSITY + 4)
        return;
    unsigned x = u16_at(rest.bytes + DENSITY), y = u16_at(rest.bytes + DENSITY + 2);
    head->aspect = x && y ? (double)y / (double)x : 1;
}

static void read_app1(ki_jpeg_head *head, ki_span segment)
{
    ki_span rest;
    if (!head->orientation && is_named(segment, "Exif\0\0", 6, &rest))
        head->orientation = ki_exif_orientation(rest);
    else if (!head->xmp.bytes && NAMED(segment, "http://ns.adobe.com/xap/1.0/", &rest))
        head->xmp = rest;
}

// Reads a segment APP2, which may hold a part of an ICC profile. The parts of a profile of more
// than one segment are numbered from 1.
static void read_app2(ki_jpeg_head *head, ki_span segment)
{
    ki_span rest;
    if (!head->iso.bytes && NAMED(segment, "urn:iso:std:iso:ts:21496:-1", &rest)) {
        head->iso = rest;
    } else if (!head->pictures.bytes && NAMED(segment, "MPF", &rest)) {
        head->pictures = rest;
    } else if (NAMED(segment, "ICC_PROFILE", &rest) && rest.size >= 2 && rest.bytes[0]) {
        head->profile[rest.bytes[0] - 1] = (ki_span){rest.bytes + 2, rest.size - 2};
        head->profile_parts = rest.bytes[1];
    }
}

// Reads the header of a frame, which states the size of the picture and how it is coded, by any of
// the processes of JPEG.
static void read_frame(ki_jpeg_head *head, int marker, ki_span segment)
{
    if (segment.size < 6 || head->components)
        return;
    head->precision = segment.bytes[0];
    head->height = (int)u16_at(segment.bytes + 1);
    head->width = (int)u16_at(segment.bytes + 3);
    head->components = segment.bytes[5];
    head->progressive = marker == 0xc2 || marker == 0xc6 || marker == 0xca || marker == 0xce;
}

static bool is_frame(int marker)
{
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

static void read_segment(ki_jpeg_head *head, int marker, ki_span segment)
{
    if (marker == APP0)
        read_app0(head, segment);
    else if (marker == APP1)
        read_app1(head, segment);
    else if (marker == APP2)
        read_app2(head, segment);
    else if (is_frame(marker))
        read_frame(head, marker, segment);
}

// Advances *at to the code of the next marker, which is one byte after its 0xff, or to `size` if
// there is none. Returns false if the caller of the library wants to stop.
static bool find_marker(kiln_context *context, const uint8_t *bytes, size_t size, size_t *at)
{
    enum { PART = 1 << 20 };
    for (int i = 1; *at < size; i++) {
        if (i % PART == 0 && !ki_go_on(context))
            return false;
        const uint8_t *found = memchr(bytes + *at, 0xff, size - *at);
        *at = found ? (size_t)(found - bytes) + 1 : size;
        if (*at < size && bytes[*at] && bytes[*at] != 0xff &&
            !(bytes[*at] >= RST0 && bytes[*at] <= RST7))
            break;
    }
    return true;
}

kiln_result ki_jpeg_read_head(kiln_context *context, const uint8_t *bytes, size_t size,
                              const char *name, ki_jpeg_head *head, kiln_error *error)
{
    // number of segments after which the caller is asked whether to go on
    enum { SEGMENTS = 1 << 14 };
    *head = (ki_jpeg_head){.end = size};
    size_t at = 2;
    for (int i = 1; at < size; i++) {
        if ((i % SEGMENTS == 0 && !ki_go_on(context)) || !find_marker(context, bytes, size, &at))
            return ki_fail_cancelled(error, "reading");
        int marker = at < size ? bytes[at++] : EOI;
        if (marker == EOI)
            break;
        if (marker == SOI || marker == TEM)
            continue;
        if (size - at < 2 || u16_at(bytes + at) < 2 || u16_at(bytes + at) > size - at)
            break;
        read_segment(head, marker, (ki_span){bytes + at + 2, u16_at(bytes + at) - 2});
        at += u16_at(bytes + at);
    }
    head->end = at;
    head->orientation = head->orientation ? head->orientation : 1;
    head->aspect = head->aspect != 0 ? head->aspect : 1;
    if (!head->components || !head->width || !head->height)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the JPEG is damaged: no segment of its %zu bytes gives the picture's "
                       "size",
                       name, size);
    return KILN_OK;
}

// ------------------------------------------------------------------------------ parts of the file

static bool begins_picture(const uint8_t *bytes, size_t size, size_t at)
{
    return at < size && size - at >= 4 && bytes[at] == 0xff && bytes[at + 1] == SOI;
}

int ki_jpeg_other_pictures(const uint8_t *bytes, size_t size, const ki_jpeg_head *head,
                           ki_span *pictures, int most)
{
    tiff t;
    int found = 0;
    size_t entry = open_tiff(head->pictures, &t) ? find_entry(&t, 0xb002) : 0;
    if (!entry && most > 0 && begins_picture(bytes, size, head->end)) {
        pictures[0] = (ki_span){bytes + head->end, size - head->end};
        return 1;
    }
    size_t start = entry ? (size_t)(head->pictures.bytes - bytes) : 0;
    size_t table = entry ? tiff_number(&t, entry + 8, 4) : 0;
    size_t count = entry ? tiff_number(&t, entry + 4, 4) / 16 : 0;
    for (size_t i = 1; i < count && table + 16 * i < t.span.size && found < most; i++) {
        size_t length = tiff_number(&t, table + 16 * i + 4, 4);
        size_t place = start + tiff_number(&t, table + 16 * i + 8, 4);
        if (begins_picture(bytes, size, place))
            pictures[found++] =
                (ki_span){bytes + place, length < size - place ? length : size - place};
    }
    return found;
}

uint8_t *ki_jpeg_profile(kiln_context *context, const ki_jpeg_head *head, size_t *size)
{
    *size = 0;
    for (int i = 0; i < head->profile_parts; i++) {
        if (!head->profile[i].bytes)
            return NULL;
        *size += head->profile[i].size;
    }
    uint8_t *profile = *size ? ki_alloc_raw(context, *size, 1) : NULL;
    size_t at = 0;
    for (int i = 0; profile && i < head->profile_parts; i++) {
        memcpy(profile + at, head->profile[i].bytes, head->profile[i].size);
        at += head->profile[i].size;
    }
    return profile;
}
