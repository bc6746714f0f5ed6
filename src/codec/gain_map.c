// Gain maps. In: numbers in a binary segment of ISO 21496-1, or in attributes or elements
// hdrgm:NAME of an XMP packet (Adobe's "Gain Map" specification, which Ultra HDR uses); samples of
// the map; linear values of the base picture. Out: linear values with the map applied in full, as
// for a display that can show all of them.
#include "codec/gain_map.h"

#include "base/bytes.h"
#include "codec/decimal.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// -------------------------------------------------------------------------------------------- ISO

static uint32_t read_u32(ki_reader *r)
{
    return __builtin_bswap32(ki_read_u32(r));
}

// Reads a fraction: a numerator, and a denominator unless `common`, the denominator of all
// fractions of the gain map, is not 0.
static double read_fraction(ki_reader *r, bool is_signed, uint32_t common)
{
    uint32_t above = read_u32(r), below = common ? common : read_u32(r);
    double value = is_signed ? (double)(int32_t)above : (double)above;
    return below ? value / below : (double)NAN;
}

static bool read_iso(ki_span span, ki_gain_map *map)
{
    enum { SEVERAL_CHANNELS = 128, COMMON_DENOMINATOR = 8 };
    ki_reader r = ki_reader_make(span.bytes, span.size);
    // Skips two versions of the format of ISO 21496-1, two bytes each: the least version that a
    // reader must know, and the version that the writer used. kiln reads least version 0 only.
    ki_read_bytes(&r, 4);
    int flags = ki_read_u8(&r), count = flags & SEVERAL_CHANNELS ? 3 : 1;
    uint32_t common = flags & COMMON_DENOMINATOR ? read_u32(&r) : 0;
    if (r.failed || span.bytes[0] || span.bytes[1] || (flags & COMMON_DENOMINATOR && !common))
        return false;
    map->base_headroom = read_fraction(&r, false, common);
    map->other_headroom = read_fraction(&r, false, common);
    for (int c = 0; c < 3; c++) {
        if (c >= count) {
            map->low[c] = map->low[0];
            map->high[c] = map->high[0];
            map->gamma[c] = map->gamma[0];
            map->base_offset[c] = map->base_offset[0];
            map->other_offset[c] = map->other_offset[0];
            continue;
        }
        map->low[c] = read_fraction(&r, true, common);
        map->high[c] = read_fraction(&r, true, common);
        map->gamma[c] = read_fraction(&r, false, common);
        map->base_offset[c] = read_fraction(&r, true, common);
        map->other_offset[c] = read_fraction(&r, true, common);
    }
    return !r.failed;
}

// -------------------------------------------------------------------------------------------- XMP

static const uint8_t *find_text(const uint8_t *at, const uint8_t *end, const char *text)
{
    size_t length = strlen(text);
    while (at && (size_t)(end - at) >= length) {
        at = memchr(at, text[0], (size_t)(end - at) - length + 1);
        if (!at || !memcmp(at, text, length))
            return at;
        at++;
    }
    return NULL;
}

static const uint8_t *skip_spaces(const uint8_t *at, const uint8_t *end)
{
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r'))
        at++;
    return at;
}

// Reads a decimal number that ends before the end of the XMP packet.
static bool parse(const uint8_t *at, const uint8_t *end, double *value)
{
    char text[40];
    size_t count = (size_t)(end - at) < sizeof text - 1 ? (size_t)(end - at) : sizeof text - 1;
    memcpy(text, at, count);
    text[count] = 0;
    return ki_parse_number(text, value) != NULL;
}

// Finds "hdrgm:NAME" in an XMP packet, where NAME is not the beginning of a longer name, and
// returns a pointer to the text after NAME, or NULL.
static const uint8_t *find_name(ki_span xmp, const char *name)
{
    const uint8_t *end = xmp.bytes + xmp.size;
    for (const uint8_t *at = find_text(xmp.bytes, end, name); at;
         at = find_text(at + 1, end, name)) {
        const uint8_t *after = skip_spaces(at + strlen(name), end);
        if (after < end && (*after == '=' || *after == '>'))
            return after;
    }
    return NULL;
}

// Reads one or three values of an XMP packet: an attribute NAME="1.5", an element <NAME>1.5</NAME>
// or a list of three <rdf:li>1.5</rdf:li>. Returns false, and leaves the values as they are, if the
// packet has no such name.
static bool read_xmp_values(ki_span xmp, const char *name, double values[3])
{
    const uint8_t *end = xmp.bytes + xmp.size, *at = find_name(xmp, name);
    int count = 0;
    if (!at)
        return false;
    const uint8_t *after = skip_spaces(at + 1, end);
    if (*at == '=') {
        count = after < end && parse(after + 1, end, &values[0]);
    } else if (after < end && *after != '<') {
        count = parse(after, end, &values[0]);
    } else {
        const uint8_t *stop = find_text(after, end, name);
        for (after = find_text(after, end, "<rdf:li>"); count < 3 && after && stop && after < stop;
             after = find_text(after, end, "<rdf:li>"))
            count += parse(after += 8, end, &values[count]) ? 1 : 3;
    }
    if (count == 1)
        values[1] = values[2] = values[0];
    return count == 1 || count == 3;
}

static bool says_true(ki_span xmp, const char *name)
{
    const uint8_t *end = xmp.bytes + xmp.size, *at = find_name(xmp, name);
    at = at ? skip_spaces(at + 1, end) : NULL;
    if (at && at < end && (*at == '"' || *at == '\''))
        at++;
    return at && end - at >= 4 && !memcmp(at, "True", 4);
}

static bool read_xmp(ki_span xmp, ki_gain_map *map)
{
    double capacity_low[3] = {0}, capacity_high[3] = {0};
    for (int c = 0; c < 3; c++) {
        map->low[c] = 0;
        map->gamma[c] = 1;
        map->base_offset[c] = map->other_offset[c] = 1.0 / 64;
    }
    if (!read_xmp_values(xmp, "hdrgm:GainMapMax", map->high))
        return false;
    read_xmp_values(xmp, "hdrgm:GainMapMin", map->low);
    read_xmp_values(xmp, "hdrgm:Gamma", map->gamma);
    read_xmp_values(xmp, "hdrgm:OffsetSDR", map->base_offset);
    read_xmp_values(xmp, "hdrgm:OffsetHDR", map->other_offset);
    read_xmp_values(xmp, "hdrgm:HDRCapacityMin", capacity_low);
    if (!read_xmp_values(xmp, "hdrgm:HDRCapacityMax", capacity_high))
        memcpy(capacity_high, map->high, sizeof capacity_high);
    bool base_is_hdr = says_true(xmp, "hdrgm:BaseRenditionIsHDR");
    map->base_headroom = base_is_hdr ? capacity_high[0] : capacity_low[0];
    map->other_headroom = base_is_hdr ? capacity_low[0] : capacity_high[0];
    return true;
}

// ---------------------------------------------------------------------------------------- reading

bool ki_gain_map_announced(const ki_jpeg_head *head)
{
    return head->iso.bytes || (head->xmp.bytes && find_name(head->xmp, "hdrgm:Version"));
}

// Returns whether a gain map's numbers can be used. Gains up to 2^32 and offsets up to 64 are far
// beyond those of any camera, and keep values finite.
static bool is_usable(const ki_gain_map *map)
{
    for (int c = 0; c < 3; c++)
        if (!(fabs(map->low[c]) <= 32) || !(fabs(map->high[c]) <= 32) ||
            !(map->gamma[c] >= 0.01 && map->gamma[c] <= 100) ||
            !(fabs(map->base_offset[c]) <= 64) || !(fabs(map->other_offset[c]) <= 64))
            return false;
    return fabs(map->base_headroom) <= 32 && fabs(map->other_headroom) <= 32;
}

bool ki_gain_map_read(const ki_jpeg_head *head, ki_gain_map *map)
{
    *map = (ki_gain_map){0};
    if (head->iso.bytes && read_iso(head->iso, map) && is_usable(map))
        return true;
    return head->xmp.bytes && read_xmp(head->xmp, map) && is_usable(map);
}

// --------------------------------------------------------------------------------------- applying

typedef struct gain_job {
    const ki_gain_map *map;
    const uint8_t *samples;
    int width, height, channels;
    kiln_image *image;
} gain_job;

// The two samples of the gain map, in a row or a column, between which a texel's centre lies, and
// the weight of the second in the interpolation.
typedef struct between {
    int first, second;
    double share;
} between;

static between place_of(int texel, int count, int samples)
{
    double at = ki_clamp((texel + 0.5) * samples / count - 0.5, 0, samples - 1);
    int first = (int)at;
    return (between){first, ki_min(first + 1, samples - 1), at - first};
}

static double mix(double a, double b, double share)
{
    return a + (b - a) * share;
}

static double sample_at(const gain_job *job, between x, between y, int channel)
{
    size_t step = (size_t)job->channels, line = step * (size_t)job->width;
    const uint8_t *a = job->samples + line * (size_t)y.first + (size_t)channel;
    const uint8_t *b = job->samples + line * (size_t)y.second + (size_t)channel;
    double above = mix(a[step * (size_t)x.first], a[step * (size_t)x.second], x.share);
    double below = mix(b[step * (size_t)x.first], b[step * (size_t)x.second], x.share);
    return mix(above, below, y.share) / 255;
}

static float apply_gain(const ki_gain_map *m, int c, double value, double sample)
{
    double share = m->gamma[c] == 1 ? sample : ki_pow(sample, 1 / m->gamma[c]);
    double gain = ki_exp(mix(m->low[c], m->high[c], share) * 0.693147180559945309417);
    return (float)((value + m->base_offset[c]) * gain - m->other_offset[c]);
}

// Task of one thread: applies the gain map to one row of the image.
static void apply_row(void *data, int row)
{
    const gain_job *job = data;
    between y = place_of(row, job->image->height, job->height);
    float *rgb = job->image->pixels + 3 * (size_t)job->image->width * (size_t)row;
    for (int i = 0; i < job->image->width; i++, rgb += 3) {
        between x = place_of(i, job->image->width, job->width);
        double sample = 0;
        for (int c = 0; c < 3; c++) {
            if (c == 0 || job->channels == 3)
                sample = sample_at(job, x, y, c);
            rgb[c] = apply_gain(job->map, c, (double)rgb[c], sample);
        }
    }
}

kiln_result ki_gain_map_apply(kiln_context *context, const ki_gain_map *map, const uint8_t *samples,
                              int width, int height, int channels, kiln_image *image,
                              kiln_error *error)
{
    gain_job job = {map, samples, width, height, channels, image};
    return ki_parallel_steps(context, NULL, image->height, apply_row, &job)
               ? KILN_OK
               : ki_fail_cancelled(error, "reading");
}
