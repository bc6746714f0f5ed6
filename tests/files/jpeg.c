// JPEG: samples are those of libjpeg-turbo, made linear by sRGB or by an ICC profile; gain maps by
// XMP and by ISO 21496-1 are applied by their formula, which is computed here by libm; and what is
// refused. All files are made here.
#include "codec/codec.h"
#include "image/color.h"

#include "kit/context.h"
#include "kit/notes.h"
#include "kit/stopping.h"

#include <jpeglib.h>

enum { W = 32, H = 16 };

typedef struct picture {
    int width, height, channels;
    uint8_t samples[W * H * 4];
} picture;

// A smooth picture, which differs at each corner.
static picture gradient(int width, int height, int channels)
{
    picture p = {width, height, channels, {0}};
    for (int i = 0; i < width * height * channels; i++) {
        int x = i / channels % width, y = i / channels / width, c = i % channels;
        p.samples[i] = (uint8_t)(20 + 200 * x / width + (c + 1) * 10 * y / height);
    }
    return p;
}

// Encodes rows that are `step` samples apart; 0 repeats the first row.
static ki_writer encode(const uint8_t *rows, int width, int height, int channels, int step,
                        bool progressive)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = (JDIMENSION)width;
    jpeg.image_height = (JDIMENSION)height;
    jpeg.input_components = channels;
    jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    if (progressive)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < height; y++) {
        JSAMPROW row = (JSAMPROW)rows + (ptrdiff_t)y * step;
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    ki_writer w = {.context = context};
    ki_write(&w, bytes, size);
    free(bytes);
    return w;
}

static ki_writer make(const picture *p, bool progressive)
{
    return encode(p->samples, p->width, p->height, p->channels, p->width * p->channels,
                  progressive);
}

// The samples of a file as libjpeg-turbo itself decodes them.
static picture witness(const ki_writer *w)
{
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    picture p = {0};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, w->bytes, w->size);
    jpeg_read_header(&jpeg, TRUE);
    jpeg_start_decompress(&jpeg);
    p.width = (int)jpeg.output_width;
    p.height = (int)jpeg.output_height;
    p.channels = jpeg.output_components;
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = p.samples + (size_t)jpeg.output_scanline * (size_t)(p.width * p.channels);
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    jpeg_destroy_decompress(&jpeg);
    return p;
}

// Inserts a segment behind the marker SOI.
static void add_segment(ki_writer *w, int marker, const void *data, size_t size)
{
    assert_non_null(ki_write_room(w, size + 4));
    memmove(w->bytes + size + 6, w->bytes + 2, w->size - size - 6);
    w->bytes[2] = 0xff;
    w->bytes[3] = (uint8_t)marker;
    w->bytes[4] = (uint8_t)((size + 2) >> 8);
    w->bytes[5] = (uint8_t)(size + 2);
    memcpy(w->bytes + 6, data, size);
}

static double srgb(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

// Decodes a file and checks that its samples, as many as `samples` says, are those in `wanted`,
// which libjpeg-turbo itself gave. Then stops the decoding at some of its questions whether to go
// on, and returns the number of these questions.
static int check_samples(const ki_writer *w, const uint8_t *wanted, size_t samples)
{
    single_stop c = {0};
    kiln_context *own;
    kiln_context_def def = {.thread_count = 1, .progress = stop_once, .progress_user = &c};
    ki_decoded decoded;
    kiln_file_info info;
    CHECK_OK(kiln_context_create(&def, &own, &error));
    CHECK_OK(ki_decode(own, w->bytes, w->size, "a.jpg", &decoded, &info, &error));
    for (size_t i = 0; i < samples; i++)
        assert_float_equal(decoded.image.pixels[i], srgb(wanted[i] / 255.0), 1e-6);
    ki_decoded_free(&decoded);
    int calls = c.calls;
    for (int stop = 1; stop <= calls; stop += 1 + stop / 8) {
        c = (single_stop){.stop_at = stop};
        assert_int_equal(ki_decode(own, w->bytes, w->size, "a.jpg", &decoded, &info, &error),
                         KILN_ERROR_CANCELLED);
        assert_int_equal(c.calls, stop);
    }
    kiln_context_destroy(own);
    return calls;
}

// libjpeg is given a file in parts of 2^20 bytes, and each part is a question. The picture of noise
// has more bytes than that; before it stand 3 megabytes of comments.
static void long_files_can_be_stopped(void **state)
{
    (void)state;
    enum { SIDE = 1400, SAMPLES = 3 * SIDE * SIDE, COMMENTS = 50, COMMENT = 65533 };
    uint8_t *samples = malloc(SAMPLES), *wanted = malloc(SAMPLES), *comment = calloc(COMMENT, 1);
    uint32_t random = 1;
    for (int i = 0; i < SAMPLES; i++)
        samples[i] = (uint8_t)((random = random * 1664525 + 1013904223) >> 24);
    ki_writer w = encode(samples, SIDE, SIDE, 3, 3 * SIDE, false);
    assert_true(w.size > 1 << 20);
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, w.bytes, w.size);
    jpeg_read_header(&jpeg, TRUE);
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < SIDE) {
        JSAMPROW row = wanted + (size_t)jpeg.output_scanline * 3 * SIDE;
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    jpeg_destroy_decompress(&jpeg);
    int less = check_samples(&w, wanted, SAMPLES);
    for (int i = 0; i < COMMENTS; i++)
        add_segment(&w, 0xfe, comment, COMMENT);
    assert_true(check_samples(&w, wanted, SAMPLES) >= less + COMMENTS * COMMENT / (1 << 20));
    ki_writer_free(&w);
    free(samples);
    free(wanted);
    free(comment);
}

static double sample_of(const picture *p, int x, int y, int c)
{
    return p->samples[(y * p->width + x) * p->channels + (p->channels == 1 ? 0 : c)] / 255.0;
}

static void samples_become_linear_by_srgb(void **state)
{
    static const char *const encodings[2][2] = {
        {"8 bits grey, srgb", "8 bits grey, srgb, progressive"},
        {"8 bits rgb, srgb", "8 bits rgb, srgb, progressive"}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        picture p = gradient(W, H, i / 2 ? 3 : 1);
        ki_writer w = make(&p, i % 2);
        picture held = witness(&w);
        ki_decoded decoded;
        kiln_file_info info;
        CHECK_OK(ki_decode(context, w.bytes, w.size, "a.jpg", &decoded, &info, &error));
        assert_string_equal(info.format, "jpeg");
        assert_string_equal(info.encoding, encodings[i / 2][i % 2]);
        assert_int_equal(decoded.image.width, W);
        assert_int_equal(decoded.image.height, H);
        for (int k = 0; k < 3 * W * H; k++) {
            double wanted = srgb(sample_of(&held, k / 3 % W, k / 3 / W, k % 3));
            CHECK_NEAR((double)decoded.image.pixels[k], wanted, wanted * 4e-7);
        }
        check_note(&decoded.report, 0, KILN_NOTE_ASSUMPTION, false,
                   "no ICC profile says how values are coded, so sRGB was assumed");
        ki_decoded_free(&decoded);
        ki_writer_free(&w);
    }
}

// ------------------------------------------------------------------------------------- gain maps

typedef struct gain {
    double low[3], high[3], gamma[3], base_offset[3], other_offset[3];
} gain;

// Checks every value of a file against the formula, with the witness's samples of both pictures,
// which have the same size.
static void check_gain(const ki_writer *w, const picture *base, const picture *map, const gain *g,
                       const char *text)
{
    ki_decoded decoded;
    kiln_file_info info;
    CHECK_OK(ki_decode(context, w->bytes, w->size, "a.jpg", &decoded, NULL, &error));
    for (int i = 0; i < 3 * W * H; i++) {
        int x = i / 3 % W, y = i / 3 / W, c = i % 3;
        double share = pow(sample_of(map, x, y, c), 1 / g->gamma[c]);
        double factor = pow(2, g->low[c] + (g->high[c] - g->low[c]) * share);
        double wanted =
            (srgb(sample_of(base, x, y, c)) + g->base_offset[c]) * factor - g->other_offset[c];
        CHECK_NEAR((double)decoded.image.pixels[i], wanted, 2e-6 * factor);
    }
    check_note(&decoded.report, 0, KILN_NOTE_CONVERSION, false, text);
    CHECK_OK(ki_decode(context, w->bytes, w->size, "a.jpg", NULL, &info, &error));
    check_note(&info.report, 0, KILN_NOTE_CONVERSION, false, text);
    assert_string_equal(info.encoding, "8 bits rgb, srgb, gain map");
    ki_decoded_free(&decoded);
}

static void add_xmp(ki_writer *w, const char *text)
{
    char data[2048];
    size_t name = sizeof "http://ns.adobe.com/xap/1.0/";
    memcpy(data, "http://ns.adobe.com/xap/1.0/", name);
    snprintf(data + name, sizeof data - name,
             "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
             "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description "
             "xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" %s</rdf:RDF></x:xmpmeta>",
             text);
    add_segment(w, 0xe1, data, name + strlen(data + name));
}

static void put_u32(ki_writer *w, uint32_t value)
{
    for (int i = 3; i >= 0; i--)
        ki_write_u8(w, (uint8_t)(value >> (8 * i)));
}

// Adds the index of two pictures, of which the second lies behind the first, to the first.
static void add_index(ki_writer *w, size_t second_size)
{
    ki_writer d = {.context = context};
    // A TIFF file with the entries of version, number and places: 4 + 8 + 2 + 3 * 12 + 4 bytes.
    enum { ENTRIES = 50, SIZE = 4 + ENTRIES + 32 };
    ki_write(&d, "MPF\0MM\0*\0\0\0\x08\0\3", 14);
    ki_write(&d,
             "\xb0\0\0\7\0\0\0\4"
             "0100",
             12);
    ki_write(&d, "\xb0\1\0\4\0\0\0\1\0\0\0\2", 12);
    ki_write(&d, "\xb0\2\0\7\0\0\0\x20\0\0\0", 11);
    ki_write_u8(&d, ENTRIES);
    put_u32(&d, 0);
    size_t first = w->size + SIZE + 4, tiff = 2 + 4 + 4;
    put_u32(&d, 0x030000);
    put_u32(&d, (uint32_t)first);
    put_u32(&d, 0);
    put_u32(&d, 0);
    put_u32(&d, 0);
    put_u32(&d, (uint32_t)second_size);
    put_u32(&d, (uint32_t)(first + 3 - tiff)); // three bytes lie between both pictures
    put_u32(&d, 0);
    assert_int_equal(d.size, SIZE);
    add_segment(w, 0xe2, d.bytes, d.size);
    ki_writer_free(&d);
}

// Ultra HDR: the numbers as attributes, and as elements with three values; the second picture is
// found by the index, with bytes between both pictures.
static void gain_maps_by_xmp_are_applied(void **state)
{
    static const struct {
        const char *xmp;
        int channels;
        gain g;
        const char *text;
    } rows[] = {
        {"hdrgm:Version=\"1.0\" hdrgm:GainMapMin=\"-0.5\" hdrgm:GainMapMax=\"3\" "
         "hdrgm:Gamma=\"1.5\" hdrgm:OffsetSDR=\"0.015625\" hdrgm:OffsetHDR=\"0.03125\" "
         "hdrgm:HDRCapacityMin=\"0\" hdrgm:HDRCapacityMax=\"3\" "
         "hdrgm:BaseRenditionIsHDR=\"False\"/>",
         1,
         {{-0.5, -0.5, -0.5},
          {3, 3, 3},
          {1.5, 1.5, 1.5},
          {0.015625, 0.015625, 0.015625},
          {0.03125, 0.03125, 0.03125}},
         "a gain map of 32 x 16 was applied in full, with gains to 2^3"},
        {"hdrgm:Version='1.0' hdrgm:HDRCapacityMax='4.5'>"
         "<hdrgm:GainMapMax>\n <rdf:Seq><rdf:li>1.5</rdf:li><rdf:li>2.5</rdf:li>"
         "<rdf:li>4.5</rdf:li></rdf:Seq></hdrgm:GainMapMax>"
         "<hdrgm:GainMapMin>0.25</hdrgm:GainMapMin></rdf:Description>",
         3,
         {{0.25, 0.25, 0.25},
          {1.5, 2.5, 4.5},
          {1, 1, 1},
          {1.0 / 64, 1.0 / 64, 1.0 / 64},
          {1.0 / 64, 1.0 / 64, 1.0 / 64}},
         "a gain map of 32 x 16 was applied in full, with gains to 2^4.5"},
    };
    (void)state;
    for (int i = 0; i < 2; i++) {
        picture p = gradient(W, H, 3), m = gradient(W, H, rows[i].channels);
        ki_writer base = make(&p, false), map = make(&m, false);
        picture held = witness(&base), gains = witness(&map);
        add_xmp(&map, rows[i].xmp);
        add_xmp(&base, "hdrgm:Version=\"1.0\"/>");
        add_index(&base, map.size);
        ki_write(&base, "abc", 3);
        ki_write(&base, map.bytes, map.size);
        check_gain(&base, &held, &gains, &rows[i].g, rows[i].text);
        ki_writer_free(&base);
        ki_writer_free(&map);
    }
}

// Adds the numbers of ISO 21496-1 with a common denominator of 1000, or with denominators of 100
// and 3 in turn.
static void add_iso(ki_writer *w, const gain *g, int channels, bool common, double base_headroom,
                    double other_headroom)
{
    ki_writer d = {.context = context};
    int turn = 0;
    ki_write(&d, "urn:iso:std:iso:ts:21496:-1", 28);
    put_u32(&d, 0);
    ki_write_u8(&d, (uint8_t)((channels == 3 ? 128 : 0) | 64 | (common ? 8 : 0)));
    if (common)
        put_u32(&d, 1000);
    double values[17] = {base_headroom, other_headroom};
    int count = 2;
    for (int c = 0; c < channels; c++) {
        const double five[5] = {g->low[c], g->high[c], g->gamma[c], g->base_offset[c],
                                g->other_offset[c]};
        memcpy(values + count, five, sizeof five);
        count += 5;
    }
    for (int i = 0; i < count; i++) {
        int below = common ? 1000 : turn++ % 2 ? 300 : 100;
        put_u32(&d, (uint32_t)(int32_t)floor(values[i] * below + 0.5));
        if (!common)
            put_u32(&d, (uint32_t)below);
    }
    add_segment(w, 0xe2, d.bytes, d.size);
    ki_writer_free(&d);
}

// Both forms of the numbers, with a map that directly follows the picture. XMP with other numbers
// beside them has no say.
static void gain_maps_by_iso_21496_are_applied(void **state)
{
    static const gain three = {
        {-0.1, 0.2, 0.3}, {2.5, 3.5, 4}, {1, 0.8, 2.2}, {0.01, 0.02, 0.03}, {0.02, 0.01, -0.04}};
    static const gain one = {
        {0.1, 0.1, 0.1}, {3, 3, 3}, {1, 1, 1}, {0.02, 0.02, 0.02}, {0.02, 0.02, 0.02}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        int channels = i / 2 ? 3 : 1;
        picture p = gradient(W, H, 3), m = gradient(W, H, channels);
        ki_writer base = make(&p, false), map = make(&m, false);
        picture held = witness(&base), gains = witness(&map);
        add_xmp(&map, "hdrgm:Version=\"1.0\" hdrgm:GainMapMax=\"9\" hdrgm:HDRCapacityMax=\"9\"/>");
        add_iso(&map, channels == 3 ? &three : &one, channels, i % 2, 0, 4);
        add_segment(&base, 0xe2, "urn:iso:std:iso:ts:21496:-1\0\0\0\0\0", 32);
        ki_write(&base, map.bytes, map.size);
        check_gain(&base, &held, &gains, channels == 3 ? &three : &one,
                   channels == 3 ? "a gain map of 32 x 16 was applied in full, with gains to 2^4"
                                 : "a gain map of 32 x 16 was applied in full, with gains to 2^3");
        ki_writer_free(&base);
        ki_writer_free(&map);
    }
}

// A map of a quarter of the size is read between the centres of its samples. A map whose samples
// grow evenly by a step has the same slope after that, up to its outermost centres.
static void small_gain_maps_are_read_between_samples(void **state)
{
    static const gain g = {{0}, {4, 4, 4}, {1, 1, 1}, {0}, {0}};
    picture p = {.width = W, .height = H, .channels = 3}, m = gradient(W / 4, H / 4, 1);
    ki_decoded decoded;
    (void)state;
    memset(p.samples, 255, sizeof p.samples);
    ki_writer base = make(&p, false), map = make(&m, false);
    picture gains = witness(&map);
    add_iso(&map, &g, 1, true, 0, 4);
    add_segment(&base, 0xe2, "urn:iso:std:iso:ts:21496:-1\0\0\0\0\0", 32);
    ki_write(&base, map.bytes, map.size);
    CHECK_OK(ki_decode(context, base.bytes, base.size, "a.jpg", &decoded, NULL, &error));
    for (int i = 0; i < W * H; i++) {
        int column = i % W, line = i / W, last_column = W / 4 - 1, last_line = H / 4 - 1;
        double x = fmin(fmax((column + 0.5) / 4 - 0.5, 0), last_column);
        double y = fmin(fmax((line + 0.5) / 4 - 0.5, 0), last_line), sum = 0;
        for (int v = 0; v < H / 4; v++)
            for (int u = 0; u < W / 4; u++)
                sum += fmax(0, 1 - fabs(x - u)) * fmax(0, 1 - fabs(y - v)) *
                       sample_of(&gains, u, v, 0);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)decoded.image.pixels[3 * i + c], pow(2, 4 * sum), 2e-5);
    }
    ki_decoded_free(&decoded);
    ki_writer_free(&base);
    ki_writer_free(&map);
}

// A base picture that already has the high range stays as it is, and a gain map that is announced
// but missing, or has unusable numbers, is told of with a warning.
static void what_is_not_applied_is_told_of(void **state)
{
    static const gain down = {{-3, -3, -3}, {0}, {1, 1, 1}, {0}, {0}};
    static const gain wild = {{-3, -3, -3}, {900, 900, 900}, {1, 1, 1}, {0}, {0}};
    static const char missing[] =
        "the file announces a gain map, but has none that kiln can read, so values end at 1";
    (void)state;
    for (int i = 0; i < 3; i++) {
        picture p = gradient(W, H, 3);
        ki_writer base = make(&p, false), map = make(&p, false);
        picture held = witness(&base);
        ki_decoded decoded;
        add_iso(&map, i ? &wild : &down, 1, true, 3, 0);
        add_xmp(&base, "hdrgm:Version=\"1.0\"/>");
        if (i < 2)
            ki_write(&base, map.bytes, map.size);
        CHECK_OK(ki_decode(context, base.bytes, base.size, "a.jpg", &decoded, NULL, &error));
        check_note(&decoded.report, 0, i ? KILN_NOTE_ASSUMPTION : KILN_NOTE_CHOICE, i > 0,
                   i ? missing
                     : "the gain map was not applied, because it leads to a picture of lower "
                       "range");
        for (int k = 0; k < 3 * W * H; k++) {
            double wanted = srgb(sample_of(&held, k / 3 % W, k / 3 / W, k % 3));
            CHECK_NEAR((double)decoded.image.pixels[k], wanted, wanted * 4e-7);
        }
        ki_decoded_free(&decoded);
        ki_writer_free(&base);
        ki_writer_free(&map);
    }
}

// -------------------------------------------------------------------------------- other segments

// A profile of grey with the gamma 2, in two segments.
static void icc_profiles_in_parts_are_honoured(void **state)
{
    uint8_t profile[160] = {0, 0, 0, 160}, part[128];
    (void)state;
    memcpy(profile + 16, "GRAY", 4);
    memcpy(profile + 36, "acsp", 4);
    profile[131] = 1; // number of tags: kTRC of 14 bytes at 144
    memcpy(profile + 132, "kTRC\0\0\0\x90\0\0\0\x0e", 12);
    memcpy(profile + 144, "curv\0\0\0\0\0\0\0\1\2\0", 14);
    for (int broken = 0; broken < 2; broken++) {
        picture p = gradient(W, H, 1);
        ki_writer w = make(&p, false);
        picture held = witness(&w);
        ki_decoded decoded;
        for (uint8_t i = broken ? 1 : 0; i < 2; i++) {
            memcpy(part, "ICC_PROFILE", 12);
            part[12] = (uint8_t)(i + 1);
            part[13] = 2;
            memcpy(part + 14, profile + 80 * i, 80);
            add_segment(&w, 0xe2, part, 94);
        }
        CHECK_OK(ki_decode(context, w.bytes, w.size, "a.jpg", &decoded, NULL, &error));
        for (int i = 0; i < 3 * W * H; i++) {
            double x = sample_of(&held, i / 3 % W, i / 3 / W, 0);
            double wanted = broken ? srgb(x) : x * x;
            CHECK_NEAR((double)decoded.image.pixels[i], wanted, wanted * 4e-7);
        }
        check_note(&decoded.report, 0, broken ? KILN_NOTE_ASSUMPTION : KILN_NOTE_CONVERSION, broken,
                   broken ? "the ICC profile of 2 parts is damaged, so sRGB was assumed"
                          : "values were converted to linear Rec. 709 by the ICC profile "
                            "\"without a name\"");
        ki_decoded_free(&decoded);
        ki_writer_free(&w);
    }
}

// The first segment JFIF states the shape of pixels by pixels per unit along x and y.
static void shapes_of_pixels_are_told_of(void **state)
{
    static const struct {
        uint8_t unit, x[2], y[2];
        const char *aspect; // NULL for pixels that are square or have no shape
    } rows[] = {{0, {0, 1}, {0, 2}, "2"},
                {0, {0, 4}, {0, 1}, "0.25"},
                {1, {0, 72}, {1, 72}, "4.556"},
                {2, {9, 9}, {9, 9}, NULL},
                {0, {0, 0}, {0, 7}, NULL}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        picture p = gradient(W, H, 3);
        ki_writer w = make(&p, false);
        kiln_file_info info;
        uint8_t jfif[14] = {'J', 'F', 'I', 'F', 0, 1, 2};
        char wanted[160];
        add_segment(&w, 0xe1, jfif, sizeof jfif); // no such segment, by its marker
        jfif[7] = rows[i].unit;
        memcpy(jfif + 8, rows[i].x, 2);
        memcpy(jfif + 10, rows[i].y, 2);
        add_segment(&w, 0xe0, jfif, sizeof jfif);
        CHECK_OK(ki_decode(context, w.bytes, w.size, "a.jpg", NULL, &info, &error));
        assert_int_equal(info.report.note_count, rows[i].aspect ? 2 : 1);
        if (rows[i].aspect) {
            snprintf(wanted, sizeof wanted,
                     "the JFIF header says that a pixel is %s times as wide as high, which was "
                     "ignored: pixels cover equal steps of the sphere",
                     rows[i].aspect);
            check_note(&info.report, 1, KILN_NOTE_ASSUMPTION, false, wanted);
        }
        ki_writer_free(&w);
    }
}

// Where the stored picture's first row and first column are in the upright picture, for the eight
// orientations of Exif: 1 top left, 2 top right, 3 bottom right, 4 bottom left, 5 left top, 6 right
// top, 7 right bottom, 8 left bottom.
static void exif_orientations_are_honoured(void **state)
{
    static const char *const first[8] = {"top left", "top right", "bottom right", "bottom left",
                                         "left top", "right top", "right bottom", "left bottom"};
    (void)state;
    for (int o = 1; o <= 8; o++) {
        picture p = gradient(W, H, 3);
        ki_writer w = make(&p, false);
        picture held = witness(&w);
        ki_decoded decoded;
        uint8_t exif[32] = "Exif\0\0II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0";
        exif[24] = (uint8_t)(9 - o);
        add_segment(&w, 0xe1, exif, sizeof exif); // the second segment, which has no say
        exif[24] = (uint8_t)o;
        add_segment(&w, 0xe1, exif, sizeof exif);
        CHECK_OK(ki_decode(context, w.bytes, w.size, "a.jpg", &decoded, NULL, &error));
        int width = o < 5 ? W : H, height = o < 5 ? H : W;
        assert_int_equal(decoded.image.width, width);
        assert_int_equal(decoded.image.height, height);
        bool right = strstr(first[o - 1], "right") != NULL;
        bool bottom = strstr(first[o - 1], "bottom") != NULL;
        for (int i = 0; i < 3 * W * H; i++) {
            int row = i / 3 / W, column = i / 3 % W; // as stored
            // from 5 on the first row is a side, and the first column is at the top or bottom
            int x = o < 5 ? column : row, y = o < 5 ? row : column;
            x = right ? width - 1 - x : x;
            y = bottom ? height - 1 - y : y;
            double wanted = srgb(sample_of(&held, column, row, i % 3));
            CHECK_NEAR((double)decoded.image.pixels[3 * (y * width + x) + i % 3], wanted,
                       wanted * 4e-7);
        }
        ki_decoded_free(&decoded);
        ki_writer_free(&w);
    }
}

// Six faces in a folder, each of one grey.
static void faces_may_be_jpeg(void **state)
{
    static const char *const names[6] = {"px.jpg", "nx.jpg", "py.jpg",
                                         "ny.jpg", "pz.jpg", "nz.jpg"};
    kiln_map map;
    double greys[6];
    (void)state;
    for (int face = 0; face < 6; face++) {
        picture p = {.width = 8, .height = 8, .channels = 1};
        memset(p.samples, 40 * face + 10, sizeof p.samples);
        ki_writer w = make(&p, false);
        picture held = witness(&w);
        greys[face] = srgb(sample_of(&held, 3, 3, 0));
        write_file(in_folder(names[face]), w.bytes, w.size);
        ki_writer_free(&w);
    }
    CHECK_OK(kiln_map_load(context, folder_path(), NULL, &map, &error));
    assert_int_equal(map.size, 8);
    for (int i = 0; i < 6 * 3 * 64; i++)
        CHECK_NEAR((double)map.level[0][i], greys[i / 192], 1e-6);
    kiln_map_free(&map);
    folder_empty();
}

static void refused(const ki_writer *w, const char *part)
{
    ki_decoded decoded;
    assert_int_not_equal(ki_decode(context, w->bytes, w->size, "bad.jpg", &decoded, NULL, &error),
                         KILN_OK);
    CHECK_SAYS(error.message, part);
}

static void what_is_not_read_is_said(void **state)
{
    (void)state;
    picture p = gradient(W, H, 4);
    ki_writer w = make(&p, false);
    refused(&w, "bad.jpg: the JPEG has 4 components, as CMYK has, kiln reads 1 (grey) and 3 "
                "(colours); convert it by: oiiotool IN -o OUT.png");
    ki_writer_free(&w);
    p = gradient(W, H, 3);
    w = make(&p, false);
    size_t size = w.size;
    w.size = size - 40;
    refused(&w, "bad.jpg: the JPEG is damaged: Premature end of JPEG file");
    w.size = 100;
    refused(&w, "bad.jpg: the JPEG is damaged: no segment of its 100 bytes gives the picture's "
                "size");
    w.size = size;
    for (size_t i = 0; i + 1 < size; i++)
        if (w.bytes[i] == 0xff && w.bytes[i + 1] == 0xc0) {
            w.bytes[i + 4] = 12;
            break;
        }
    refused(&w, "bad.jpg: the JPEG has samples of 12 bits, kiln reads those of 8 bits");
    ki_writer_free(&w);
}

// Returns the place of the scan with this number, from 0, or of the marker behind it.
static size_t find_scan(const ki_writer *w, int number, bool behind)
{
    bool inside = false;
    for (size_t i = 2; i + 1 < w->size; i++) {
        if (w->bytes[i] != 0xff || !w->bytes[i + 1])
            continue;
        if (inside)
            return i;
        if (w->bytes[i + 1] != 0xda || number--)
            continue;
        if (!behind)
            return i;
        inside = true;
    }
    fail_msg("no scan");
    return 0;
}

// A scan of a picture of one colour has few bytes, but costs the time of a picture. A file with the
// second scan 2000 times is refused after the scans that its size pays for; 20 times are read.
static void scans_are_limited_by_the_size(void **state)
{
    enum { SIZE = 4096 };
    static const uint8_t row[SIZE];
    (void)state;
    ki_writer w = encode(row, SIZE, SIZE, 1, 0, true);
    size_t scan = find_scan(&w, 1, false), end = find_scan(&w, 1, true);
    for (int times = 20; times <= 2000; times *= 100) {
        ki_writer many = {.context = context};
        ki_write(&many, w.bytes, scan);
        for (int i = 0; i < times; i++)
            ki_write(&many, w.bytes + scan, end - scan);
        ki_write(&many, w.bytes + end, w.size - end);
        ki_decoded decoded;
        if (times == 20) {
            CHECK_OK(ki_decode(context, many.bytes, many.size, "a.jpg", &decoded, NULL, &error));
            CHECK_NEAR((double)decoded.image.pixels[0], 0, 0);
            ki_decoded_free(&decoded);
        } else {
            refused(&many, "scans or more, too many for its 16777216 pixels and its size");
        }
        ki_writer_free(&many);
    }
    ki_writer_free(&w);
}

// The index of pictures may state any number of entries; those that the segment holds are read.
static void an_index_ends_with_its_segment(void **state)
{
    (void)state;
    picture p = gradient(W, H, 3);
    ki_writer base = make(&p, false);
    ki_decoded decoded;
    add_xmp(&base, "hdrgm:Version=\"1.0\"/>");
    add_index(&base, 100);
    for (size_t i = 0; i + 8 < 100; i++)
        if (!memcmp(base.bytes + i, "\xb0\2\0\7", 4))
            base.bytes[i + 4] = 0xf6; // the number of bytes is 4 thousand million
    CHECK_OK(ki_decode(context, base.bytes, base.size, "a.jpg", &decoded, NULL, &error));
    check_note(&decoded.report, 0, KILN_NOTE_ASSUMPTION, true,
               "the file announces a gain map, but has none that kiln can read, so values end at "
               "1");
    ki_decoded_free(&decoded);
    ki_writer_free(&base);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_become_linear_by_srgb),
        cmocka_unit_test(gain_maps_by_xmp_are_applied),
        cmocka_unit_test(gain_maps_by_iso_21496_are_applied),
        cmocka_unit_test(small_gain_maps_are_read_between_samples),
        cmocka_unit_test(what_is_not_applied_is_told_of),
        cmocka_unit_test(icc_profiles_in_parts_are_honoured),
        cmocka_unit_test(shapes_of_pixels_are_told_of),
        cmocka_unit_test(exif_orientations_are_honoured),
        cmocka_unit_test(faces_may_be_jpeg),
        cmocka_unit_test(what_is_not_read_is_said),
        cmocka_unit_test(long_files_can_be_stopped),
        cmocka_unit_test(scans_are_limited_by_the_size),
        cmocka_unit_test(an_index_ends_with_its_segment),
    };
    return cmocka_run_group_tests_name("jpeg", tests, set_up_folder, tear_down_folder);
}
