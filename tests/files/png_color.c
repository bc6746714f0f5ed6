// What chunks of PNG files say about colours. Pictures and ICC profiles are made here; the wanted
// values are computed from the formulas of the standards by libm.
#include "codec/codec.h"
#include "codec/deflate.h"
#include "codec/png.h"
#include "codec/png_text.h"
#include "image/color.h"

#include "kit/context.h"

enum { W = 8, H = 4, SAMPLES = 3 * W * H, HEAD = 8 + 25 };

// The samples as shares of the largest: greys, then colours.
static float stored(int i)
{
    return (float)(i < 3 * W ? (i / 3) * 36 : i * 131 % 256) / 255;
}

static void put_u32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

// Inserts a chunk behind IHDR.
static void add_chunk(ki_writer *w, const char *type, const void *data, size_t size)
{
    ki_crc32_table table;
    ki_crc32_fill(&table);
    assert_non_null(ki_write_room(w, size + 12));
    uint8_t *at = w->bytes + HEAD;
    memmove(at + size + 12, at, w->size - size - 12 - HEAD);
    put_u32(at, (uint32_t)size);
    memcpy(at + 4, type, 4);
    memcpy(at + 8, data, size);
    put_u32(at + 8 + size, ki_crc32(&table, 0, at + 4, size + 4));
}

static void add_u32s(ki_writer *w, const char *type, const uint32_t *values, size_t count)
{
    uint8_t data[32];
    for (size_t i = 0; i < count; i++)
        put_u32(data + 4 * i, values[i]);
    add_chunk(w, type, data, 4 * count);
}

static void add_gamma(ki_writer *w, double value)
{
    const uint32_t stored_value = (uint32_t)(value * 100000 + 0.5);
    add_u32s(w, "gAMA", &stored_value, 1);
}

// White comes first in this chunk.
static void add_primaries(ki_writer *w, const ki_primaries *p)
{
    uint32_t values[8];
    for (int i = 0; i < 8; i++)
        values[i] = (uint32_t)(p->xy[(i + 6) % 8] * 100000 + 0.5);
    add_u32s(w, "cHRM", values, 8);
}

static void add_cicp(ki_writer *w, int primaries, int transfer, int matrix, int full)
{
    const uint8_t data[4] = {(uint8_t)primaries, (uint8_t)transfer, (uint8_t)matrix, (uint8_t)full};
    add_chunk(w, "cICP", data, 4);
}

static ki_writer make(ki_png_coding coding)
{
    ki_writer w = {.context = context};
    float pixels[SAMPLES];
    for (int i = 0; i < SAMPLES; i++)
        pixels[i] = stored(i);
    CHECK_OK(ki_png_encode(pixels, W, H, 3, coding, &w, &error));
    return w;
}

typedef double curve(double x);

static double srgb(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static double linear(double x)
{
    return x;
}

static double gamma_2(double x)
{
    return x * x;
}

static double gamma_22(double x)
{
    return pow(x, 1 / 0.45455);
}

static double bt709(double x)
{
    return x < 0.081 ? x / 4.5 : pow((x + 0.099) / 1.099, 1 / 0.45);
}

// SMPTE ST 2084, in units of 203 cd/m2.
static double pq(double x)
{
    double m1 = 2610.0 / 16384, m2 = 2523.0 / 4096 * 128, c1 = 3424.0 / 4096,
           c2 = 2413.0 / 4096 * 32, c3 = 2392.0 / 4096 * 32, p = pow(x, 1 / m2);
    return 10000 * pow(fmax(p - c1, 0) / (c2 - c3 * p), 1 / m1) / 203;
}

// The scene's light of ITU-R BT.2100's HLG.
static double hlg(double x)
{
    double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a);
    return x <= 0.5 ? x * x / 3 : (exp((x - c) / a) + b) / 12;
}

// A note that must be there, or no note at all.
typedef struct wanted_note {
    kiln_note_kind kind;
    bool warning;
    const char *text; // NULL for no note
} wanted_note;

static void check_note(const kiln_load_report *report, const wanted_note *wanted)
{
    kiln_note note;
    assert_int_equal(report->note_count, wanted->text ? 1 : 0);
    if (!wanted->text)
        return;
    assert_true(kiln_load_report_note(report, 0, &note));
    assert_string_equal(note.text, wanted->text);
    assert_int_equal(note.kind, wanted->kind);
    assert_int_equal(note.warning, wanted->warning);
}

// Checks every value, the notes of loading and of the description, and frees the file.
static void check(ki_writer *w, curve *to_linear, const ki_primaries *primaries,
                  const char *encoding, const wanted_note *note)
{
    ki_decoded decoded;
    kiln_file_info info;
    ki_matrix3 a;
    assert_true(ki_rec709_from_rgb(primaries, NULL, &a));
    CHECK_OK(ki_decode(context, w->bytes, w->size, "a.png", &decoded, NULL, &error));
    for (int i = 0; i < W * H; i++) {
        double v[3];
        for (int c = 0; c < 3; c++)
            v[c] = to_linear((double)stored(3 * i + c));
        double most = fmax(v[0], fmax(v[1], v[2]));
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)decoded.image.pixels[3 * i + c],
                       a.m[c][0] * v[0] + a.m[c][1] * v[1] + a.m[c][2] * v[2], 2e-6 * most + 1e-9);
    }
    check_note(&decoded.report, note);
    ki_decoded_free(&decoded);
    CHECK_OK(ki_decode(context, w->bytes, w->size, "a.png", NULL, &info, &error));
    check_note(&info.report, note);
    assert_string_equal(info.encoding, encoding);
    ki_writer_free(w);
}

static const ki_primaries display_p3 = {{0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329}};
static const wanted_note nothing = {0, false, NULL};

static void gamma_and_primaries_are_honoured(void **state)
{
    static const wanted_note assumed = {
        KILN_NOTE_ASSUMPTION, false,
        "no chunk says how values are coded, so the curve of sRGB was assumed"};
    static const wanted_note power_1 = {
        KILN_NOTE_CONVERSION, false,
        "values were raised to the power 1, as the chunk gAMA of 1 says"};
    static const wanted_note power_22 = {
        KILN_NOTE_CONVERSION, false,
        "values were raised to the power 2.2, as the chunk gAMA of 0.45455 says"};
    (void)state;
    for (int deep = 0; deep < 2; deep++) {
        ki_png_coding coding = deep ? KI_PNG_PLAIN16 : KI_PNG_PLAIN8;
        ki_writer w = make(coding);
        check(&w, srgb, &ki_rec709, deep ? "16 bits rgb, srgb" : "8 bits rgb, srgb", &assumed);
        w = make(coding);
        add_gamma(&w, 1);
        check(&w, linear, &ki_rec709, deep ? "16 bits rgb, gamma" : "8 bits rgb, gamma", &power_1);
        w = make(coding);
        add_gamma(&w, 0.45455);
        add_primaries(&w, &ki_rec709);
        check(&w, gamma_22, &ki_rec709, deep ? "16 bits rgb, gamma" : "8 bits rgb, gamma",
              &power_22);
    }
}

// Both kinds of notes are told of, and the values have both conversions.
static void other_primaries_are_converted(void **state)
{
    (void)state;
    ki_matrix3 a;
    ki_decoded decoded;
    kiln_note note;
    ki_writer w = make(KI_PNG_PLAIN16);
    add_gamma(&w, 0.5);
    add_primaries(&w, &display_p3);
    assert_true(ki_rec709_from_rgb(&display_p3, NULL, &a));
    CHECK_OK(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error));
    for (int i = 0; i < SAMPLES; i++) {
        double wanted = 0;
        for (int k = 0; k < 3; k++)
            wanted += a.m[i % 3][k] * pow((double)stored(i / 3 * 3 + k), 2);
        CHECK_NEAR((double)decoded.image.pixels[i], wanted, 1e-6);
    }
    assert_int_equal(decoded.report.note_count, 2);
    assert_true(kiln_load_report_note(&decoded.report, 1, &note));
    assert_string_equal(note.text,
                        "colours were converted to Rec. 709 from the primaries (0.68, 0.32), "
                        "(0.265, 0.69), (0.15, 0.06) and the white (0.3127, 0.329)");
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

// Each chunk stands before those that have precedence over it: the values are those of the last.
static void chunks_have_the_precedence_of_the_third_edition(void **state)
{
    static const wanted_note cicp = {
        KILN_NOTE_CONVERSION, false,
        "values were converted to linear Rec. 709 from Rec. 709 and linear values, as the chunk "
        "cICP says"};
    static const wanted_note damaged = {
        KILN_NOTE_ASSUMPTION, true,
        "the ICC profile in the chunk iCCP is damaged, so sRGB was assumed"};
    const uint8_t intent = 0;
    (void)state;
    ki_writer w = make(KI_PNG_PLAIN8);
    add_gamma(&w, 1);
    add_primaries(&w, &display_p3);
    add_chunk(&w, "sRGB", &intent, 1);
    check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", &nothing);
    w = make(KI_PNG_PLAIN8);
    add_chunk(&w, "sRGB", &intent, 1);
    add_chunk(&w, "iCCP", "name\0\0nothing", 13);
    check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", &damaged);
    w = make(KI_PNG_PLAIN8);
    add_gamma(&w, 0.5);
    add_chunk(&w, "sRGB", &intent, 1);
    add_chunk(&w, "iCCP", "name\0\0nothing", 13);
    add_cicp(&w, 1, 8, 0, 1);
    check(&w, linear, &ki_rec709, "8 bits rgb, cicp", &cicp);
}

static void cicp_names_curves_and_primaries(void **state)
{
    static const struct {
        int primaries, transfer;
        const char *name;
        const ki_primaries *set;
        curve *to_linear;
    } rows[] = {{9, 16, "Rec. 2020 and PQ, where 203 cd/m2 is 1", &ki_rec2020, pq},
                {1, 16, "Rec. 709 and PQ, where 203 cd/m2 is 1", &ki_rec709, pq},
                {12, 13, "Display P3 and the curve of sRGB", &display_p3, srgb},
                {12, 8, "Display P3 and linear values", &display_p3, linear},
                {9, 1, "Rec. 2020 and the curve of BT.709", &ki_rec2020, bt709}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[160];
        const wanted_note note = {KILN_NOTE_CONVERSION, false, text};
        snprintf(text, sizeof text,
                 "values were converted to linear Rec. 709 from %s, as the chunk cICP says",
                 rows[i].name);
        ki_writer w = make(KI_PNG_PLAIN16);
        add_cicp(&w, rows[i].primaries, rows[i].transfer, 0, 1);
        check(&w, rows[i].to_linear, rows[i].set, "16 bits rgb, cicp", &note);
    }
    ki_writer w = make(KI_PNG_PLAIN8);
    add_cicp(&w, 1, 13, 0, 1);
    check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", &nothing);
}

// Known points: PQ's largest value is 10000 cd/m2, the signal 0.5081 is 100 cd/m2 and 0.5807 is 203
// cd/m2. HLG's largest white is 1000 cd/m2, and a signal of 0.75 is 203 cd/m2 (ITU-R BT.2408).
static void pq_and_hlg_have_the_light_of_a_display(void **state)
{
    static const struct {
        int transfer;
        double signal, wanted, bound;
    } rows[] = {{16, 1, 10000.0 / 203, 1e-4}, {16, 0.5080784, 100.0 / 203, 1e-4},
                {16, 0.5806889, 1, 1e-4},     {18, 1, 1000.0 / 203, 1e-4},
                {18, 0.75, 1, 0.003},         {18, 0, 0, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const float pixel[3] = {(float)rows[i].signal, (float)rows[i].signal,
                                (float)rows[i].signal};
        ki_decoded decoded;
        ki_writer w = {.context = context};
        CHECK_OK(ki_png_encode(pixel, 1, 1, 3, KI_PNG_PLAIN16, &w, &error));
        add_cicp(&w, 9, rows[i].transfer, 0, 1);
        CHECK_OK(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error));
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)decoded.image.pixels[c], rows[i].wanted, rows[i].bound);
        ki_decoded_free(&decoded);
        ki_writer_free(&w);
    }
    // Colours of HLG: the system gamma acts on the luminance of Rec. 2020.
    ki_matrix3 a;
    ki_decoded decoded;
    ki_writer w = make(KI_PNG_PLAIN16);
    add_cicp(&w, 9, 18, 0, 1);
    assert_true(ki_rec709_from_rgb(&ki_rec2020, NULL, &a));
    CHECK_OK(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error));
    for (int i = 0; i < W * H; i++) {
        double v[3], y;
        for (int c = 0; c < 3; c++)
            v[c] = hlg((double)stored(3 * i + c));
        y = 0.2627 * v[0] + 0.6780 * v[1] + 0.0593 * v[2];
        for (int c = 0; c < 3; c++) {
            double sum = a.m[c][0] * v[0] + a.m[c][1] * v[1] + a.m[c][2] * v[2];
            CHECK_NEAR((double)decoded.image.pixels[3 * i + c], sum * pow(y, 0.2) * 1000 / 203,
                       2e-4);
        }
    }
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

static void narrow_range_is_expanded(void **state)
{
    (void)state;
    const float pixels[] = {16.0F / 255, 235.0F / 255, 126.0F / 255};
    ki_decoded decoded;
    ki_writer w = {.context = context};
    CHECK_OK(ki_png_encode(pixels, 1, 1, 3, KI_PNG_PLAIN8, &w, &error));
    add_cicp(&w, 1, 8, 0, 0);
    CHECK_OK(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error));
    CHECK_NEAR((double)decoded.image.pixels[0], 0, 1e-7);
    CHECK_NEAR((double)decoded.image.pixels[1], 1, 1e-6);
    CHECK_NEAR((double)decoded.image.pixels[2], 110.0 / 219, 1e-6);
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

static void unknown_colours_are_refused(void **state)
{
    static const int numbers[][4] = {{2, 13, 0, 1}, {9, 2, 0, 1}, {9, 16, 9, 1}, {9, 16, 0, 2}};
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        char wanted[512];
        ki_decoded decoded;
        ki_writer w = make(KI_PNG_PLAIN8);
        add_cicp(&w, numbers[i][0], numbers[i][1], numbers[i][2], numbers[i][3]);
        snprintf(wanted, sizeof wanted,
                 "a.png: its chunk cICP has the numbers %d, %d, %d and %d, but kiln reads "
                 "primaries 1, 5, 6, 9, 11 and 12, transfer functions 1, 4, 5, 6, 8, 13, 14, 15, "
                 "16 and 18, and matrix 0; convert the picture to OpenEXR with linear values of "
                 "Rec. 709",
                 numbers[i][0], numbers[i][1], numbers[i][2], numbers[i][3]);
        assert_int_equal(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error),
                         KILN_ERROR_UNSUPPORTED);
        assert_string_equal(error.message, wanted);
        ki_writer_free(&w);
    }
}

// A chunk that says nothing usable is told of with a warning.
static void useless_chunks_are_told_of(void **state)
{
    static const ki_primaries line = {{0.3, 0.3, 0.4, 0.4, 0.5, 0.5, 0.4, 0.4}};
    const uint8_t zeros[4] = {0};
    (void)state;
    const wanted_note gamma = {
        KILN_NOTE_ASSUMPTION, true,
        "the chunk gAMA says 0, which is no usable gamma, so sRGB was assumed"};
    ki_writer w = make(KI_PNG_PLAIN8);
    add_chunk(&w, "gAMA", zeros, 4);
    check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", &gamma);
    w = make(KI_PNG_SRGB8);
    ki_writer_free(&w);
    w = make(KI_PNG_PLAIN8);
    const uint8_t intent = 0;
    add_primaries(&w, &line);
    add_chunk(&w, "sRGB", &intent, 1);
    check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", &nothing);
    w = make(KI_PNG_PLAIN8);
    add_chunk(&w, "sRGB", &intent, 1);
    add_cicp(&w, 9, 16, 0, 1);
    w.bytes[HEAD + 8 + 4] ^= 1; // the CRC of the chunk cICP
    const wanted_note crc = {KILN_NOTE_ASSUMPTION, true,
                             "the chunk cICP has a wrong CRC and was ignored"};
    check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", &crc);
}

// ---------------------------------------------------------------------------------- ICC profiles

typedef struct profile {
    uint8_t bytes[4096];
    size_t size;
    int tags;
} profile;

// Adds a tag with its data at the end. Room for 12 tags lies behind the header.
static void add_tag(profile *p, const char *name, const uint8_t *data, size_t size)
{
    uint8_t *tag = p->bytes + 132 + 12 * p->tags++;
    memcpy(tag, name, 4);
    put_u32(tag + 4, (uint32_t)p->size);
    put_u32(tag + 8, (uint32_t)size);
    memcpy(p->bytes + p->size, data, size);
    p->size += (size + 3) / 4 * 4;
    put_u32(p->bytes + 128, (uint32_t)p->tags);
    put_u32(p->bytes, (uint32_t)p->size);
}

static uint32_t fixed(double value)
{
    return (uint32_t)(int32_t)floor(value * 65536 + 0.5);
}

// The columns of Display P3 and of sRGB relative to D50, as profiles in use have them.
static const double p3_columns[3][3] = {
    {0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}};
static const double srgb_columns[3][3] = {
    {0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.71410}};

static void begin_profile(profile *p, const char *space, const char *name)
{
    uint8_t text[32] = "desc";
    *p = (profile){.size = 132 + 12 * 12};
    memcpy(p->bytes + 16, space, 4);
    memcpy(p->bytes + 20, "XYZ ", 4);
    memcpy(p->bytes + 36, "acsp", 4);
    memcpy(text + 12, name, strlen(name));
    add_tag(p, "desc", text, sizeof text);
}

static void add_columns(profile *p, const double columns[3][3])
{
    static const char *const names[3] = {"rXYZ", "gXYZ", "bXYZ"};
    for (int c = 0; c < 3; c++) {
        uint8_t data[20] = "XYZ ";
        for (int i = 0; i < 3; i++)
            put_u32(data + 8 + 4 * i, fixed(columns[c][i]));
        add_tag(p, names[c], data, sizeof data);
    }
}

static void add_curves(profile *p, const uint8_t *data, size_t size)
{
    static const char *const names[3] = {"rTRC", "gTRC", "bTRC"};
    for (int c = 0; c < 3; c++)
        add_tag(p, names[c], data, size);
}

static void add_parametric(profile *p, int function, const double *numbers, int count)
{
    uint8_t data[12 + 28] = "para";
    data[9] = (uint8_t)function;
    for (int i = 0; i < count; i++)
        put_u32(data + 12 + 4 * i, fixed(numbers[i]));
    add_curves(p, data, 12 + 4 * (size_t)count);
}

static void add_profile(ki_writer *w, const profile *p)
{
    uint8_t data[8192] = "icc";
    ki_deflater *deflater = ki_deflater_create(context);
    size_t size = ki_deflate(deflater, p->bytes, p->size, data + 5, sizeof data - 5);
    assert_true(size > 0);
    add_chunk(w, "iCCP", data, size + 5);
    ki_deflater_free(deflater);
}

// Loads the picture with this profile, and checks its values against the columns of a matrix.
static void check_profile(const profile *p, curve *to_linear, const ki_primaries *primaries,
                          const char *text)
{
    ki_matrix3 a;
    ki_decoded decoded;
    kiln_note note;
    ki_writer w = make(KI_PNG_PLAIN16);
    add_profile(&w, p);
    assert_true(ki_rec709_from_rgb(primaries, NULL, &a));
    CHECK_OK(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error));
    for (int i = 0; i < SAMPLES; i++) {
        double wanted = 0;
        for (int k = 0; k < 3; k++)
            wanted += a.m[i % 3][k] * to_linear((double)stored(i / 3 * 3 + k));
        CHECK_NEAR((double)decoded.image.pixels[i], wanted, 6e-4);
    }
    assert_int_equal(decoded.report.note_count, text ? 1 : 0);
    if (text) {
        assert_true(kiln_load_report_note(&decoded.report, 0, &note));
        assert_string_equal(note.text, text);
    }
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

static void icc_profiles_of_matrices_and_curves_are_honoured(void **state)
{
    static const double srgb_numbers[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    static const double square[] = {2};
    profile p;
    uint8_t table[12 + 2 * 257] = "curv";
    (void)state;
    begin_profile(&p, "RGB ", "Display P3");
    add_columns(&p, p3_columns);
    add_parametric(&p, 3, srgb_numbers, 5);
    check_profile(&p, srgb, &display_p3,
                  "values were converted to linear Rec. 709 by the ICC profile \"Display P3\"");
    begin_profile(&p, "RGB ", "square\x1b[2J");
    add_columns(&p, srgb_columns);
    add_parametric(&p, 0, square, 1);
    check_profile(&p, gamma_2, &ki_rec709,
                  "values were converted to linear Rec. 709 by the ICC profile \"square\"");
    // The gamma 2 as a number of 8 and 8 bits, and as a table.
    put_u32(table + 8, 1);
    table[12] = 2;
    begin_profile(&p, "RGB ", "number");
    add_columns(&p, srgb_columns);
    add_curves(&p, table, 14);
    check_profile(&p, gamma_2, &ki_rec709,
                  "values were converted to linear Rec. 709 by the ICC profile \"number\"");
    put_u32(table + 8, 257);
    for (int i = 0; i <= 256; i++) {
        int value = (int)(pow(i / 256.0, 2) * 65535 + 0.5);
        table[12 + 2 * i] = (uint8_t)(value >> 8);
        table[13 + 2 * i] = (uint8_t)value;
    }
    begin_profile(&p, "RGB ", "table");
    add_columns(&p, p3_columns);
    add_curves(&p, table, sizeof table);
    check_profile(&p, gamma_2, &display_p3,
                  "values were converted to linear Rec. 709 by the ICC profile \"table\"");
}

// A profile of 3 MB, which do not become fewer by compression. Data of more than 2 MB are inflated
// another way than shorter ones.
static void large_profiles_are_honoured(void **state)
{
    enum { SIZE = 3 << 20 };
    static const double square[] = {2};
    profile p;
    kiln_note note;
    ki_decoded decoded;
    uint32_t random = 1;
    size_t bound = 5 + ki_deflate_bound(SIZE);
    uint8_t *plain = malloc(SIZE), *data = malloc(bound);
    ki_deflater *deflater = ki_deflater_create(context);
    ki_writer w = make(KI_PNG_PLAIN16);
    (void)state;
    assert_true(plain && data && deflater);
    begin_profile(&p, "RGB ", "large");
    add_columns(&p, p3_columns);
    add_parametric(&p, 0, square, 1);
    for (size_t i = 0; i < SIZE; i++)
        plain[i] = (uint8_t)((random = random * 1664525 + 1013904223) >> 24);
    memcpy(plain, p.bytes, p.size);
    put_u32(plain, SIZE);
    memcpy(data, "icc\0\0", 5);
    size_t size = ki_deflate(deflater, plain, SIZE, data + 5, bound - 5);
    assert_true(size > 1 << 21);
    add_chunk(&w, "iCCP", data, size + 5);
    CHECK_OK(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error));
    assert_int_equal(decoded.report.note_count, 1);
    assert_true(kiln_load_report_note(&decoded.report, 0, &note));
    assert_string_equal(note.text,
                        "values were converted to linear Rec. 709 by the ICC profile \"large\"");
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
    ki_deflater_free(deflater);
    free(plain);
    free(data);
}

// The profile of sRGB itself gives the bits of a file with the chunk sRGB, and no note.
static void the_profile_of_srgb_changes_nothing(void **state)
{
    static const double numbers[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    const uint8_t intent = 0;
    profile p;
    ki_decoded by_profile, by_chunk;
    (void)state;
    begin_profile(&p, "RGB ", "sRGB");
    add_columns(&p, srgb_columns);
    add_parametric(&p, 3, numbers, 5);
    ki_writer a = make(KI_PNG_PLAIN8), b = make(KI_PNG_PLAIN8);
    add_profile(&a, &p);
    add_chunk(&b, "sRGB", &intent, 1);
    CHECK_OK(ki_decode(context, a.bytes, a.size, "a.png", &by_profile, NULL, &error));
    CHECK_OK(ki_decode(context, b.bytes, b.size, "b.png", &by_chunk, NULL, &error));
    assert_memory_equal(by_profile.image.pixels, by_chunk.image.pixels, SAMPLES * sizeof(float));
    assert_int_equal(by_profile.report.note_count, 0);
    ki_decoded_free(&by_profile);
    ki_decoded_free(&by_chunk);
    ki_writer_free(&a);
    ki_writer_free(&b);
}

// The numbers of PQ in a tag go before curves that cannot hold PQ's values.
static void a_tag_cicp_goes_before_curves(void **state)
{
    static const double one[] = {1};
    const uint8_t data[12] = {'c', 'i', 'c', 'p', 0, 0, 0, 0, 1, 8, 0, 1};
    profile p;
    (void)state;
    begin_profile(&p, "RGB ", "numbers");
    add_columns(&p, p3_columns);
    add_parametric(&p, 0, one, 1);
    check_profile(&p, linear, &display_p3,
                  "values were converted to linear Rec. 709 by the ICC profile \"numbers\"");
    add_tag(&p, "cicp", data, sizeof data);
    check_profile(&p, linear, &ki_rec709,
                  "values were converted to linear Rec. 709 by the ICC profile \"numbers\"");
}

static void profiles_that_kiln_cannot_use_count_as_srgb(void **state)
{
    profile p;
    (void)state;
    begin_profile(&p, "RGB ", "tables");
    add_tag(&p, "A2B0", (const uint8_t *)"mft2", 4);
    check_profile(&p, srgb, &ki_rec709,
                  "the ICC profile \"tables\" has only look-up tables of several dimensions, so "
                  "sRGB was assumed");
    begin_profile(&p, "CMYK", "press");
    check_profile(&p, srgb, &ki_rec709,
                  "the ICC profile \"press\" is not of RGB or grey, so sRGB was assumed");
    begin_profile(&p, "RGB ", "empty");
    check_profile(&p, srgb, &ki_rec709,
                  "the ICC profile \"empty\" has no curves and matrix, so sRGB was assumed");
    begin_profile(&p, "RGB ", "far");
    add_columns(&p, srgb_columns);
    put_u32(p.bytes + 132 + 12 + 4, 0xffffff00); // the place of rXYZ lies behind the end
    check_profile(&p, srgb, &ki_rec709,
                  "the ICC profile \"far\" has no curves and matrix, so sRGB was assumed");
    put_u32(p.bytes + 128, 0xffffffff); // more tags than the profile has room for
    check_profile(&p, srgb, &ki_rec709,
                  "the ICC profile \"far\" has no curves and matrix, so sRGB was assumed");
}

// -------------------------------------------------------------------------- radiance in four bytes

// A picture that kiln saved as RGBM, RGBD or RGBP loads as radiance. A byte of a root is off by
// half a step, 1/510 of the texel's scale; the scale is near the largest root of the texel, and is
// at least 1 in RGBD and RGBP.
static void radiance_in_four_bytes_is_read_back(void **state)
{
    static const struct {
        kiln_format format;
        const char *encoding, *text;
        double largest;
    } rows[] = {{KILN_FORMAT_RGBM, "8 bits rgb with alpha, rgbm",
                 "radiance was decoded from rgbm, (8 a c)^2 for a colour c and alpha a", 60},
                {KILN_FORMAT_RGBD, "8 bits rgb with alpha, rgbd",
                 "radiance was decoded from rgbd, c^2.2 / a for a colour c and alpha a", 200},
                {KILN_FORMAT_RGBP, "8 bits rgb with alpha, rgbp",
                 "radiance was decoded from rgbp, ((8 - 7 a) c)^2 for a colour c and alpha a", 60}};
    (void)state;
    for (int r = 0; r < 3; r++) {
        kiln_map map, back;
        kiln_load_report report;
        const kiln_load_def load = {.report = &report};
        const kiln_save_def save = {.format = rows[r].format};
        CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 16, 1, &map, &error));
        for (int i = 0; i < 3 * 32 * 16; i++)
            map.level[0][i] = (float)(rows[r].largest * pow(2, -(i % 97) / 8.0));
        const char *path = in_folder("a.png");
        CHECK_OK(kiln_map_save(context, &map, path, &save, NULL, &error));
        CHECK_OK(kiln_map_load(context, path, &load, &back, &error));
        for (int i = 0; i < 32 * 16; i++) {
            const float *a = map.level[0] + 3 * i, *b = back.level[0] + 3 * i;
            double most = fmax((double)a[0], fmax((double)a[1], (double)a[2]));
            for (int c = 0; c < 3; c++)
                CHECK_NEAR((double)b[c], (double)a[c], (most + sqrt(most)) / 150);
        }
        kiln_file_info info;
        CHECK_OK(kiln_file_describe(context, path, &info, &error));
        assert_string_equal(info.encoding, rows[r].encoding);
        const wanted_note note = {KILN_NOTE_CONVERSION, false, rows[r].text};
        check_note(&report, &note);
        check_note(&info.report, &note);
        kiln_map_free(&map);
        kiln_map_free(&back);
        folder_empty();
    }
}

static void radiance_needs_four_bytes(void **state)
{
    ki_decoded decoded;
    (void)state;
    ki_writer w = make(KI_PNG_PLAIN16);
    ki_png_add_text(&w, 0, KI_PNG_TEXELS_KEY, "rgbm");
    assert_int_equal(ki_decode(context, w.bytes, w.size, "a.png", &decoded, NULL, &error),
                     KILN_ERROR_FORMAT);
    assert_string_equal(error.message,
                        "a.png: says that its texels are rgbm, which has four channels of 8 bits, "
                        "but the picture has 3 channels of 16 bits");
    ki_writer_free(&w);
}

// -------------------------------------------------------------------------- the picture as a whole

static void add_at_end(ki_writer *w, const char *type, const uint8_t *data, size_t size)
{
    ki_crc32_table table;
    uint8_t number[4];
    ki_crc32_fill(&table);
    w->size -= 12; // the chunk IEND
    uint8_t end[12];
    memcpy(end, w->bytes + w->size, sizeof end);
    size_t start = w->size + 4;
    put_u32(number, (uint32_t)size);
    ki_write(w, number, 4);
    ki_write(w, type, 4);
    ki_write(w, data, size);
    put_u32(number, ki_crc32(&table, 0, w->bytes + start, size + 4));
    ki_write(w, number, 4);
    ki_write(w, end, sizeof end);
}

// Where the stored picture's first row and first column are in the upright picture, for the
// orientations of Exif; the chunk may stand before and after the data.
static void orientations_are_honoured(void **state)
{
    static const char *const first[8] = {"top left", "top right", "bottom right", "bottom left",
                                         "left top", "right top", "right bottom", "left bottom"};
    const uint8_t intent = 0;
    (void)state;
    for (int o = 1; o <= 8; o++)
        for (int behind = 0; behind < 2; behind++) {
            uint8_t exif[26] = "MM\0*\0\0\0\x08\0\1\1\x12\0\3\0\0\0\1\0\0\0\0\0\0";
            char text[80];
            ki_decoded decoded;
            kiln_file_info info;
            ki_writer w = make(KI_PNG_PLAIN16);
            exif[19] = (uint8_t)o;
            add_chunk(&w, "sRGB", &intent, 1);
            if (behind)
                add_at_end(&w, "eXIf", exif, sizeof exif);
            else
                add_chunk(&w, "eXIf", exif, sizeof exif);
            CHECK_OK(ki_decode(context, w.bytes, w.size, "a.png", &decoded, &info, &error));
            int width = o < 5 ? W : H, height = o < 5 ? H : W;
            assert_int_equal(decoded.image.width, width);
            assert_int_equal(decoded.image.height, height);
            assert_int_equal(info.width, width);
            assert_int_equal(info.height, height);
            bool right = strstr(first[o - 1], "right") != NULL;
            bool bottom = strstr(first[o - 1], "bottom") != NULL;
            for (int i = 0; i < SAMPLES; i++) {
                int row = i / 3 / W, column = i / 3 % W;
                int x = o < 5 ? column : row, y = o < 5 ? row : column;
                x = right ? width - 1 - x : x;
                y = bottom ? height - 1 - y : y;
                double wanted = srgb((double)stored(i));
                CHECK_NEAR((double)decoded.image.pixels[3 * (y * width + x) + i % 3], wanted,
                           2e-6 * wanted + 1e-9);
            }
            snprintf(text, sizeof text, "the picture was turned upright by Exif's orientation %d",
                     o);
            const wanted_note turned = {KILN_NOTE_CONVERSION, false, text};
            check_note(&decoded.report, o == 1 ? &nothing : &turned);
            ki_decoded_free(&decoded);
            ki_writer_free(&w);
        }
}

static void what_is_ignored_is_said(void **state)
{
    static const wanted_note animation = {
        KILN_NOTE_CHOICE, false,
        "the file is an animation of 3 frames, of which the still picture was read"};
    static const wanted_note aspect = {
        KILN_NOTE_ASSUMPTION, false,
        "the chunk pHYs says that a pixel is 0.5 times as wide as high, which was ignored: pixels "
        "cover equal steps of the sphere"};
    static const wanted_note alpha = {KILN_NOTE_CHOICE, false,
                                      "alpha was ignored: every pixel counts as opaque"};
    static const uint32_t frames[2] = {3, 0}, one_frame[2] = {1, 0};
    static const uint8_t phys[9] = {0, 0, 0, 200, 0, 0, 0, 100, 0}, key[6] = {0},
                         square[9] = {0, 0, 11, 19, 0, 0, 11, 19, 1};
    static const struct {
        const char *type;
        const void *data;
        size_t size;
        const wanted_note *note;
    } rows[] = {
        {"pHYs", phys, 9, &aspect}, {"pHYs", square, 9, &nothing}, {"tRNS", key, 6, &alpha}};
    const uint8_t intent = 0;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        ki_writer w = make(KI_PNG_PLAIN8);
        add_chunk(&w, "sRGB", &intent, 1);
        add_chunk(&w, rows[i].type, rows[i].data, rows[i].size);
        check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", rows[i].note);
    }
    for (int i = 0; i < 2; i++) {
        ki_writer w = make(KI_PNG_PLAIN8);
        add_chunk(&w, "sRGB", &intent, 1);
        add_u32s(&w, "acTL", i ? one_frame : frames, 2);
        check(&w, srgb, &ki_rec709, "8 bits rgb, srgb", i ? &nothing : &animation);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gamma_and_primaries_are_honoured),
        cmocka_unit_test(other_primaries_are_converted),
        cmocka_unit_test(chunks_have_the_precedence_of_the_third_edition),
        cmocka_unit_test(cicp_names_curves_and_primaries),
        cmocka_unit_test(pq_and_hlg_have_the_light_of_a_display),
        cmocka_unit_test(narrow_range_is_expanded),
        cmocka_unit_test(unknown_colours_are_refused),
        cmocka_unit_test(useless_chunks_are_told_of),
        cmocka_unit_test(icc_profiles_of_matrices_and_curves_are_honoured),
        cmocka_unit_test(large_profiles_are_honoured),
        cmocka_unit_test(the_profile_of_srgb_changes_nothing),
        cmocka_unit_test(a_tag_cicp_goes_before_curves),
        cmocka_unit_test(profiles_that_kiln_cannot_use_count_as_srgb),
        cmocka_unit_test(radiance_in_four_bytes_is_read_back),
        cmocka_unit_test(radiance_needs_four_bytes),
        cmocka_unit_test(orientations_are_honoured),
        cmocka_unit_test(what_is_ignored_is_said),
    };
    return cmocka_run_group_tests_name("png_color", tests, set_up_folder, tear_down_folder);
}
