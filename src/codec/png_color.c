// What the samples of a PNG mean. In: the chunks beside the picture's data. Out: curves and a
// matrix to linear Rec. 709, or the coding by which kiln stored radiance in four bytes; the
// orientation. By the third edition of the specification (W3C, "Portable Network Graphics", section
// 11.3.2), the first of these chunks decides: cICP, iCCP, sRGB, then gAMA and cHRM. A file without
// any of them counts as sRGB. kiln's own text chunk "kiln:texels" comes before all.
#include "codec/png_color.h"

#include "base/bytes.h"
#include "codec/deflate.h"
#include "codec/icc.h"
#include "codec/jpeg_head.h"
#include "codec/png.h"
#include "codec/report.h"
#include "codec/upright.h"

#include <stdio.h>
#include <string.h>

enum { PROFILE_MOST = 1 << 24 }; // number of bytes of the largest ICC profile that is read

// The content of one kind of chunk; NULL if the file has no such chunk.
typedef struct content {
    const uint8_t *bytes;
    size_t size;
} content;

typedef struct found {
    content cicp, iccp, srgb, gama, chrm, text, exif, phys, actl, trns;
} found;

static uint32_t u32_at(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static bool is_own_text(const uint8_t *data, size_t size)
{
    size_t key = sizeof KI_PNG_TEXELS_KEY;
    return size > key && !memcmp(data, KI_PNG_TEXELS_KEY, key);
}

// Returns where the content of a chunk of this type is kept, or NULL if the chunk says nothing
// about the picture or has too few bytes.
static content *place_of(found *f, const uint8_t *type, const uint8_t *data, size_t size)
{
    const struct {
        const char *type;
        size_t least;
        content *place;
    } rows[] = {{"cICP", 4, &f->cicp}, {"iCCP", 3, &f->iccp},  {"sRGB", 1, &f->srgb},
                {"gAMA", 4, &f->gama}, {"cHRM", 32, &f->chrm}, {"tEXt", 1, &f->text},
                {"eXIf", 8, &f->exif}, {"pHYs", 9, &f->phys},  {"acTL", 8, &f->actl},
                {"tRNS", 1, &f->trns}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!memcmp(type, rows[i].type, 4) && size >= rows[i].least &&
            (rows[i].place != &f->text || is_own_text(data, size)))
            return rows[i].place;
    return NULL;
}

// Finds the chunks that say something about the picture. Only eXIf may stand after the data, and
// the others are not looked for there.
static kiln_result find_chunks(kiln_context *context, ki_reader *r, found *f,
                               kiln_load_report *report, kiln_error *error)
{
    enum { CHUNKS = 1 << 14 }; // number of chunks after which the caller is asked whether to go on
    ki_asker asker = ki_asker_make(context);
    ki_crc32_table table;
    ki_crc32_fill(&table);
    ki_read_bytes(r, 8);
    bool before = true;
    for (int i = 1;; i++) {
        const uint8_t *head = ki_read_bytes(r, 8);
        size_t size = head ? u32_at(head) : 0;
        const uint8_t *data = ki_read_bytes(r, size), *sum = ki_read_bytes(r, 4);
        if (!head || !sum)
            return KILN_OK;
        before = before && memcmp(head + 4, "IDAT", 4) != 0;
        if (i % CHUNKS == 0 && !ki_may_go_on(&asker))
            return ki_fail_cancelled(error, "reading");
        content *place = place_of(f, head + 4, data, size);
        if (!place || place->bytes || (!before && place != &f->exif))
            continue;
        uint32_t computed = ki_crc32_long(&asker, &table, head + 4, size + 4);
        if (ki_was_stopped(&asker))
            return ki_fail_cancelled(error, "reading");
        if (ki_checksum_agrees(computed, u32_at(sum)))
            *place = (content){data, size};
        else
            ki_note(report, KILN_NOTE_ASSUMPTION, true,
                    "the chunk %.4s has a wrong CRC and was ignored", (const char *)head + 4);
    }
}

// ------------------------------------------------------------------------------------------ chunks

static bool read_own(const found *f, ki_png_meaning *meaning, kiln_load_report *report)
{
    static const struct {
        const char *name, *formula;
        ki_from_rgbx *unpack;
    } codings[] = {{"rgbm", "(8 a c)^2", ki_float_from_rgbm},
                   {"rgbd", "c^2.2 / a", ki_float_from_rgbd},
                   {"rgbp", "((8 - 7 a) c)^2", ki_float_from_rgbp}};
    size_t key = sizeof KI_PNG_TEXELS_KEY;
    for (size_t i = 0; f->text.bytes && i < sizeof codings / sizeof *codings; i++)
        if (f->text.size == key + 4 && !memcmp(f->text.bytes + key, codings[i].name, 4)) {
            meaning->unpack = codings[i].unpack;
            meaning->name = codings[i].name;
            ki_note(report, KILN_NOTE_CONVERSION, false,
                    "radiance was decoded from %s, %s for a colour c and alpha a", codings[i].name,
                    codings[i].formula);
            return true;
        }
    return false;
}

static kiln_result read_cicp(const found *f, const char *name, ki_png_meaning *meaning,
                             kiln_load_report *report, kiln_error *error)
{
    char what[KI_COLOR_NAME];
    const uint8_t *n = f->cicp.bytes;
    if (!ki_file_color_set_cicp(&meaning->color, n, what))
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: its chunk cICP has the numbers %d, %d, %d and %d, but %s; convert the "
                       "picture to OpenEXR with linear values of Rec. 709",
                       name, n[0], n[1], n[2], n[3], ki_cicp_known);
    bool srgb = n[0] == 1 && n[1] == 13 && n[3];
    meaning->name = srgb ? "srgb" : "cicp";
    if (!srgb)
        ki_note(report, KILN_NOTE_CONVERSION, false,
                "values were converted to linear Rec. 709 from %s, as the chunk cICP says", what);
    return KILN_OK;
}

// Decompresses the ICC profile in the chunk iCCP, which is a name, a NUL, the method 0 and zlib
// data. The first four bytes of a profile are its size. Returns NULL if the chunk is damaged,
// or if the caller wants to stop.
static uint8_t *unpack_profile(const ki_asker *asker, const found *f, size_t *size)
{
    const uint8_t *bytes = f->iccp.bytes, *end = memchr(bytes, 0, f->iccp.size);
    size_t before = end ? (size_t)(end - bytes) + 2 : f->iccp.size;
    uint8_t first[4];
    if (before >= f->iccp.size || end[1])
        return NULL;
    const uint8_t *packed = bytes + before;
    size_t packed_size = f->iccp.size - before;
    if (ki_inflate_long(asker, packed, packed_size, first, sizeof first, true) != KILN_OK)
        return NULL;
    *size = u32_at(first);
    if (*size < sizeof first || *size > PROFILE_MOST || *size / 1032 > f->iccp.size)
        return NULL;
    uint8_t *profile = ki_alloc_raw(asker->context, *size, 1);
    if (profile && ki_inflate_long(asker, packed, packed_size, profile, *size, false) != KILN_OK) {
        ki_free(profile);
        return NULL;
    }
    return profile;
}

static kiln_result read_iccp(kiln_context *context, const found *f, ki_png_meaning *meaning,
                             kiln_load_report *report, kiln_error *error)
{
    size_t size = 0;
    ki_asker asker = ki_asker_make(context);
    uint8_t *profile = unpack_profile(&asker, f, &size);
    if (ki_was_stopped(&asker)) {
        ki_free(profile);
        return ki_fail_cancelled(error, "reading");
    }
    if (profile) {
        ki_icc_read(profile, size, &meaning->color, report);
        meaning->name = "icc";
    } else {
        ki_note(report, KILN_NOTE_ASSUMPTION, true,
                "the ICC profile in the chunk iCCP is damaged, so sRGB was assumed");
    }
    return KILN_OK;
}

static void read_gamma(const found *f, ki_png_meaning *meaning, kiln_load_report *report)
{
    double stored = u32_at(f->gama.bytes) / 100000.0;
    ki_curve curve = {.kind = KI_CURVE_PARAMETRIC, .g = 1 / stored, .a = 1};
    if (stored < 0.01 || stored > 100) {
        ki_note(report, KILN_NOTE_ASSUMPTION, true,
                "the chunk gAMA says %.5g, which is no usable gamma, so sRGB was assumed", stored);
        return;
    }
    ki_file_color_set_curve(&meaning->color, &curve);
    meaning->name = "gamma";
    ki_note(report, KILN_NOTE_CONVERSION, false,
            "values were raised to the power %.5g, as the chunk gAMA of %.5g says", 1 / stored,
            stored);
}

// Reads the chunk cHRM, which has the white point before the primaries.
static void read_chromaticities(const found *f, ki_png_meaning *meaning, kiln_load_report *report)
{
    ki_primaries p;
    for (int i = 0; i < 8; i++)
        p.xy[(i + 6) % 8] = u32_at(f->chrm.bytes + 4 * (size_t)i) / 100000.0;
    if (!ki_file_color_set_primaries(&meaning->color, &p))
        ki_note(report, KILN_NOTE_ASSUMPTION, true,
                "the chunk cHRM names no usable primaries, so those of Rec. 709 were assumed");
    else if (meaning->color.converts)
        ki_note(report, KILN_NOTE_CONVERSION, false,
                "colours were converted to Rec. 709 from the primaries (%.4g, %.4g), (%.4g, %.4g), "
                "(%.4g, %.4g) and the white (%.4g, %.4g)",
                p.xy[0], p.xy[1], p.xy[2], p.xy[3], p.xy[4], p.xy[5], p.xy[6], p.xy[7]);
}

// Reads the orientation (eXIf) and whether colours are transparent (tRNS). Notes that kiln ignores
// the other frames of an animation (acTL) and the shape of pixels (pHYs).
static void read_picture(const found *f, ki_png_meaning *meaning, kiln_load_report *report)
{
    meaning->orientation =
        f->exif.bytes ? ki_exif_orientation((ki_span){f->exif.bytes, f->exif.size}) : 1;
    ki_note_upright(meaning->orientation, report);
    meaning->transparent = f->trns.bytes != NULL;
    if (f->actl.bytes && u32_at(f->actl.bytes) > 1)
        ki_note(report, KILN_NOTE_CHOICE, false,
                "the file is an animation of %u frames, of which the still picture was read",
                (unsigned)u32_at(f->actl.bytes));
    // The chunk pHYs has the pixels per unit along x and y.
    uint32_t x = f->phys.bytes ? u32_at(f->phys.bytes) : 1;
    uint32_t y = f->phys.bytes ? u32_at(f->phys.bytes + 4) : 1;
    if (x && y)
        ki_note_pixel_aspect(report, "the chunk pHYs", (double)y / (double)x);
}

kiln_result ki_png_read_meaning(kiln_context *context, const uint8_t *bytes, size_t size,
                                const char *name, ki_png_meaning *meaning, kiln_load_report *report,
                                kiln_error *error)
{
    found f = {0};
    ki_reader r = ki_reader_make(bytes, size);
    *meaning = (ki_png_meaning){.name = "srgb", .orientation = 1};
    kiln_result result = find_chunks(context, &r, &f, report, error);
    if (result != KILN_OK)
        return result;
    read_picture(&f, meaning, report);
    if (read_own(&f, meaning, report))
        return KILN_OK;
    if (f.cicp.bytes)
        return read_cicp(&f, name, meaning, report, error);
    if (f.iccp.bytes)
        return read_iccp(context, &f, meaning, report, error);
    if (f.srgb.bytes)
        return KILN_OK;
    if (f.gama.bytes)
        read_gamma(&f, meaning, report);
    if (f.chrm.bytes)
        read_chromaticities(&f, meaning, report);
    if (!f.gama.bytes)
        ki_note(report, KILN_NOTE_ASSUMPTION, false,
                "no chunk says how values are coded, so the curve of sRGB was assumed");
    return KILN_OK;
}
