// Writes Ultra HDR files. In: a picture of linear values. Out: a JPEG file that programs without
// gain maps show as a picture of low dynamic range, followed by a grey JPEG of the same size, the
// gain map, by which the picture becomes one of high dynamic range.
//
// Method: for every pixel a tone curve decides the gain, a factor for the three channels. The gain
// map is compressed and decompressed, and the picture is divided by the gains that readers will
// see. Rounding of the gain map therefore costs nothing, and the picture's own rounding remains.
//
// The parts of the file are those of Google's "Ultra HDR Image Format" 1.0: XMP packets with the
// file's directory and the numbers of the gain map, and an index of the pictures (CIPA DC-007).
#include "codec/ultra_hdr.h"

#include "base/bytes.h"
#include "codec/decimal.h"
#include "codec/jpeg_pixels.h"
#include "image/pack.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

enum {
    GAIN_QUALITY = 100, // since what the gain map loses must fit into the picture's range
    BASE_QUALITY = 95,
};

// The tone curve: values up to KNEE stay as they are, and greater values approach CEILING. The
// distance from CEILING to 1 is for the rounding of gains.
static const double KNEE = 0.6, CEILING = 0.95;
static const double LOG2 = 0.693147180559945309417;

typedef struct ultra_hdr {
    kiln_context *context;
    const kiln_image *image;
    const char *name;
    double exposure; // log2 of the factor between the image and what the tone curve sees
    double
        range; // the gain map's samples 0 to 255 stand for gains of 2^-exposure times 1 to 2^range
    uint8_t *gains, *base; // samples: of one channel, and of red, green and blue
    ki_writer gain_file, base_file;
} ultra_hdr;

static size_t pixel_count(const ultra_hdr *u)
{
    return (size_t)u->image->width * (size_t)u->image->height;
}

static double largest_channel(const float rgb[3])
{
    return fmax(fmax((double)rgb[0], (double)rgb[1]), fmax((double)rgb[2], 0));
}

// ------------------------------------------------------------------------------------------- gains

// Returns log2 of the gain that the tone curve asks for, where the largest channel is `value`.
static double find_gain(double value)
{
    if (value <= KNEE)
        return 0;
    double room = CEILING - KNEE;
    double shown = KNEE + room * (1 - ki_exp(-(value - KNEE) / room));
    return ki_log(value / shown) / LOG2;
}

// Sets `exposure`, in stops, and `range`, in stops above 1. Pictures whose geometric mean is more
// than NEAR stops from a middle grey of 0.18 are made darker or brighter for the tone curve. Other
// pictures keep an exposure of 0, since gains of 1 need no decoding.
static void measure(ultra_hdr *u)
{
    enum { NEAR = 2 };
    double sum = 0, largest = 0;
    size_t count = 0;
    for (size_t i = 0; i < pixel_count(u); i++) {
        double value = largest_channel(u->image->pixels + 3 * i);
        largest = fmax(largest, value);
        if (value > 0) {
            sum += ki_log(value) / LOG2;
            count++;
        }
    }
    double middle = ki_log(0.18) / LOG2, wanted = count ? middle - sum / (double)count : 0;
    u->exposure = fabs(wanted) <= NEAR ? 0 : floor(wanted + 0.5);
    u->exposure = ki_clamp(u->exposure, -16, 16);
    u->range = fmax(find_gain(largest * ki_exp(u->exposure * LOG2)), 1);
}

static void fill_gains(ultra_hdr *u)
{
    double scale = ki_exp(u->exposure * LOG2);
    for (size_t i = 0; i < pixel_count(u); i++) {
        double gain = find_gain(scale * largest_channel(u->image->pixels + 3 * i));
        u->gains[i] = (uint8_t)floor(gain / u->range * 255 + 0.5);
    }
}

// Replaces the gains by those that readers of the compressed gain map see.
static kiln_result reread_gains(ultra_hdr *u, kiln_error *error)
{
    ki_jpeg_head head;
    uint8_t *samples = NULL;
    const ki_span file = {u->gain_file.bytes, u->gain_file.size};
    kiln_result result =
        ki_jpeg_read_head(u->context, file.bytes, file.size, u->name, &head, error);
    if (result == KILN_OK)
        result = ki_jpeg_samples(u->context, file, &head, u->name, &samples, error);
    if (result == KILN_OK)
        memcpy(u->gains, samples, pixel_count(u));
    ki_free(samples);
    return result;
}

static void fill_base(ultra_hdr *u)
{
    double factor[256];
    for (int k = 0; k < 256; k++)
        factor[k] = ki_exp((u->exposure - k * u->range / 255) * LOG2);
    for (size_t i = 0; i < 3 * pixel_count(u); i++) {
        double value = (double)u->image->pixels[i] * factor[u->gains[i / 3]];
        float stored = ki_srgb_from_linear((float)ki_clamp(value, 0, 1));
        u->base[i] = (uint8_t)(stored * 255 + 0.5f);
    }
}

// -------------------------------------------------------------------------------------------- file

static void write_u16(ki_writer *w, size_t value)
{
    ki_write_u8(w, (uint8_t)(value >> 8));
    ki_write_u8(w, (uint8_t)value);
}

static void write_u32(ki_writer *w, size_t value)
{
    write_u16(w, value >> 16 & 0xffff);
    write_u16(w, value & 0xffff);
}

// Writes the segment of an XMP packet.
static void write_xmp(ki_writer *w, const ki_writer *description)
{
    static const char name[] = "http://ns.adobe.com/xap/1.0/"; // with its NUL
    static const char begin[] = "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
                                "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">";
    static const char end[] = "</rdf:RDF></x:xmpmeta>";
    write_u16(w, 0xffe1);
    write_u16(w, 2 + sizeof name + strlen(begin) + description->size + strlen(end));
    ki_write(w, name, sizeof name);
    ki_write(w, begin, strlen(begin));
    ki_write(w, description->bytes, description->size);
    ki_write(w, end, strlen(end));
}

static void write_number(ki_writer *w, const char *name, double value)
{
    ki_write_text(w, " hdrgm:%s=\"", name);
    ki_write_number(w, value);
    ki_write_text(w, "\"");
}

// Writes the numbers by which readers apply the gain map.
static void describe_gains(const ultra_hdr *u, ki_writer *w)
{
    ki_write_text(w, "<rdf:Description xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" "
                     "hdrgm:Version=\"1.0\"");
    write_number(w, "GainMapMin", -u->exposure);
    write_number(w, "GainMapMax", u->range - u->exposure);
    write_number(w, "Gamma", 1);
    write_number(w, "OffsetSDR", 0);
    write_number(w, "OffsetHDR", 0);
    write_number(w, "HDRCapacityMin", 0);
    write_number(w, "HDRCapacityMax", fmax(u->range - u->exposure, 1));
    ki_write_text(w, " hdrgm:BaseRenditionIsHDR=\"False\"/>");
}

// Writes the directory of the file's pictures, of which the second has `gain_size` bytes.
static void describe_pictures(ki_writer *w, size_t gain_size)
{
    ki_write_text(
        w,
        "<rdf:Description xmlns:Container=\"http://ns.google.com/photos/1.0/container/\" "
        "xmlns:Item=\"http://ns.google.com/photos/1.0/container/item/\" "
        "xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" hdrgm:Version=\"1.0\">"
        "<Container:Directory><rdf:Seq><rdf:li rdf:parseType=\"Resource\">"
        "<Container:Item Item:Semantic=\"Primary\" Item:Mime=\"image/jpeg\"/></rdf:li>"
        "<rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Semantic=\"GainMap\" "
        "Item:Mime=\"image/jpeg\" Item:Length=\"%zu\"/></rdf:li></rdf:Seq></Container:Directory>"
        "</rdf:Description>",
        gain_size);
}

// One row of the index: a tag, its type, the number of values, and the values or where they lie.
static void write_tag(ki_writer *w, size_t tag, size_t type, size_t count, size_t value)
{
    write_u16(w, tag);
    write_u16(w, type);
    write_u32(w, count);
    write_u32(w, value);
}

enum { INDEX_SIZE = 90 }; // number of bytes of the index's segment, with its marker

// Writes the segment with the index of the two pictures. Offsets count from the index's "MM", which
// is 8 bytes behind `at`, the position of the segment in the file.
static void write_index(ki_writer *w, size_t at, size_t base_size, size_t gain_size)
{
    enum { UNDEFINED = 7, LONG = 4, PRIMARY = 0x030000, ENTRIES = 50 };
    write_u16(w, 0xffe2);
    write_u16(w, INDEX_SIZE - 2);
    ki_write(w, "MPF", 4); // with its NUL
    ki_write(w, "MM\0*", 4);
    write_u32(w, 8);
    write_u16(w, 3);
    write_tag(w, 0xb000, UNDEFINED, 4, 0x30313030); // version "0100"
    write_tag(w, 0xb001, LONG, 1, 2);
    write_tag(w, 0xb002, UNDEFINED, 32, ENTRIES);
    write_u32(w, 0); // no further index
    write_u32(w, PRIMARY);
    write_u32(w, base_size);
    write_u32(w, 0); // the first picture's offset
    write_u32(w, 0);
    write_u32(w, 0);
    write_u32(w, gain_size);
    write_u32(w, base_size - at - 8);
    write_u32(w, 0);
}

enum { JFIF_END = 20 }; // the position after a JPEG's first segment, which libjpeg writes

// Writes the whole file, of which the picture and the gain map are compressed already.
static void write_file(const ultra_hdr *u, ki_writer *w)
{
    ki_writer xmp = {.context = u->context}, gain_head = xmp, base_head = xmp;
    describe_gains(u, &xmp);
    write_xmp(&gain_head, &xmp);
    size_t gain_size = u->gain_file.size + gain_head.size;
    xmp.size = 0;
    describe_pictures(&xmp, gain_size);
    write_xmp(&base_head, &xmp);
    size_t base_size = u->base_file.size + base_head.size + INDEX_SIZE;
    write_index(&base_head, JFIF_END + base_head.size, base_size, gain_size);
    ki_write(w, u->base_file.bytes, JFIF_END);
    ki_write(w, base_head.bytes, base_head.size);
    ki_write(w, u->base_file.bytes + JFIF_END, u->base_file.size - JFIF_END);
    ki_write(w, u->gain_file.bytes, JFIF_END);
    ki_write(w, gain_head.bytes, gain_head.size);
    ki_write(w, u->gain_file.bytes + JFIF_END, u->gain_file.size - JFIF_END);
    w->failed |= xmp.failed | gain_head.failed | base_head.failed;
    ki_writer_free(&xmp);
    ki_writer_free(&gain_head);
    ki_writer_free(&base_head);
}

static kiln_result encode(ultra_hdr *u, ki_writer *w, kiln_error *error)
{
    int width = u->image->width, height = u->image->height;
    measure(u);
    fill_gains(u);
    kiln_result result =
        ki_jpeg_write(u->gains, width, height, 1, GAIN_QUALITY, u->name, &u->gain_file, error);
    if (result == KILN_OK)
        result = reread_gains(u, error);
    if (result != KILN_OK)
        return result;
    fill_base(u);
    result = ki_jpeg_write(u->base, width, height, 3, BASE_QUALITY, u->name, &u->base_file, error);
    if (result == KILN_OK)
        write_file(u, w);
    return result == KILN_OK && w->failed ? ki_fail_memory(u->context, error, u->name, w->size)
                                          : result;
}

kiln_result ki_ultra_hdr_encode(const kiln_image *image, const char *name, ki_writer *w,
                                kiln_error *error)
{
    ultra_hdr u = {.context = w->context, .image = image, .name = name};
    u.gain_file.context = u.base_file.context = w->context;
    size_t count = pixel_count(&u);
    u.gains = ki_alloc_raw(w->context, count, 1);
    u.base = ki_alloc_raw(w->context, count, 3);
    kiln_result result = u.gains && u.base ? encode(&u, w, error)
                                           : ki_fail_memory(w->context, error, name, 4 * count);
    ki_writer_free(&u.gain_file);
    ki_writer_free(&u.base_file);
    ki_free(u.gains);
    ki_free(u.base);
    return result;
}
