// Reading of JPEG files. In: the bytes of a file. Out: a picture of three linear floats a pixel in
// Rec. 709. Samples become linear light by the file's ICC profile, or by the curve of sRGB. A gain
// map in the file (ISO 21496-1, Ultra HDR) is applied in full. Exif's orientation is honoured.
#include "codec/codec.h"
#include "codec/gain_map.h"
#include "codec/icc.h"
#include "codec/jpeg_pixels.h"
#include "codec/report.h"
#include "codec/upright.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// greatest number of pictures of a file among which the gain map is searched
enum { PICTURES_MOST = 8 };

typedef struct jpeg_file {
    kiln_context *context;
    const char *name;
    ki_span file;
    ki_jpeg_head head, gain_head;
    ki_span gain_picture;
    ki_gain_map gain;
    bool has_gain;
    ki_file_color color;
} jpeg_file;

// ----------------------------------------------------------------------------------------- header

static kiln_result check_head(const ki_jpeg_head *head, const char *name, kiln_error *error)
{
    if (head->components != 1 && head->components != 3)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: the JPEG has %d components, as CMYK has, kiln reads 1 (grey) and 3 "
                       "(colours); convert it by: oiiotool IN -o OUT.png",
                       name, head->components);
    if (head->precision != 8)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: the JPEG has samples of %d bits, kiln reads those of 8 bits", name,
                       head->precision);
    if (head->width > KILN_MAX_SIZE || head->height > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: the picture is %d x %d, the limit is %d",
                       name, head->width, head->height, KILN_MAX_SIZE);
    return KILN_OK;
}

static void read_color(jpeg_file *f, kiln_load_report *report)
{
    size_t size;
    uint8_t *profile = ki_jpeg_profile(f->context, &f->head, &size);
    if (profile)
        ki_icc_read(profile, size, &f->color, report);
    else if (f->head.profile_parts)
        ki_note(report, KILN_NOTE_ASSUMPTION, true,
                "the ICC profile of %d parts is damaged, so sRGB was assumed",
                f->head.profile_parts);
    else
        ki_note(report, KILN_NOTE_ASSUMPTION, false,
                "no ICC profile says how values are coded, so sRGB was assumed");
}

// Finds the picture of the file that holds a gain map, and the gain map's numbers.
static kiln_result find_gain_map(jpeg_file *f, kiln_error *error)
{
    ki_span pictures[PICTURES_MOST];
    int count =
        ki_jpeg_other_pictures(f->file.bytes, f->file.size, &f->head, pictures, PICTURES_MOST);
    for (int i = 0; i < count && !f->has_gain; i++) {
        kiln_result result = ki_jpeg_read_head(f->context, pictures[i].bytes, pictures[i].size,
                                               f->name, &f->gain_head, error);
        if (result == KILN_ERROR_CANCELLED)
            return result;
        f->has_gain = result == KILN_OK && check_head(&f->gain_head, f->name, NULL) == KILN_OK &&
                      ki_gain_map_read(&f->gain_head, &f->gain);
        f->gain_picture = pictures[i];
    }
    return KILN_OK;
}

static void note_gain_map(jpeg_file *f, kiln_load_report *report)
{
    const ki_gain_map *g = &f->gain;
    double most = fmax(g->high[0], fmax(g->high[1], g->high[2]));
    if (!f->has_gain) {
        ki_note(report, KILN_NOTE_ASSUMPTION, true,
                "the file announces a gain map, but has none that kiln can read, so values end at "
                "1");
    } else if (g->base_headroom > g->other_headroom) {
        f->has_gain = false;
        ki_note(report, KILN_NOTE_CHOICE, false,
                "the gain map was not applied, because it leads to a picture of lower range");
    } else {
        ki_note(report, KILN_NOTE_CONVERSION, false,
                "a gain map of %d x %d was applied in full, with gains to 2^%.4g",
                f->gain_head.width, f->gain_head.height, most);
    }
}

static kiln_result read_head(jpeg_file *f, kiln_load_report *report, kiln_error *error)
{
    kiln_result result =
        ki_jpeg_read_head(f->context, f->file.bytes, f->file.size, f->name, &f->head, error);
    if (result == KILN_OK)
        result = check_head(&f->head, f->name, error);
    if (result == KILN_OK && ki_gain_map_announced(&f->head)) {
        result = find_gain_map(f, error);
        if (result == KILN_OK)
            note_gain_map(f, report);
    }
    if (result == KILN_OK)
        read_color(f, report);
    if (result == KILN_OK) {
        ki_note_pixel_aspect(report, "the JFIF header", f->head.aspect);
        ki_note_upright(f->head.orientation, report);
    }
    return result;
}

// --------------------------------------------------------------------------------------- pixels

enum { ROUND = 64 }; // rows after which the caller is asked whether to go on

// Converts samples to linear values. Returns false if the caller asks to stop.
static bool to_linear(const jpeg_file *f, const uint8_t *samples, kiln_image *image)
{
    float tables[3][256];
    size_t channels = (size_t)f->head.components, width = (size_t)f->head.width;
    float *to = image->pixels;
    for (int c = 0; c < 3; c++)
        ki_file_color_fill(&f->color, c, tables[c], 256);
    for (int y = 0; y < f->head.height; y++) {
        if (y % ROUND == ROUND - 1 && !ki_go_on(f->context))
            return false;
        for (size_t x = 0; x < width; x++, samples += channels, to += 3)
            for (size_t c = 0; c < 3; c++)
                to[c] = tables[c][samples[channels == 3 ? c : 0]];
    }
    return true;
}

static kiln_result apply_gain_map(jpeg_file *f, kiln_image *image, kiln_error *error)
{
    uint8_t *samples;
    const ki_jpeg_head *head = &f->gain_head;
    kiln_result result =
        ki_jpeg_samples(f->context, f->gain_picture, head, f->name, &samples, error);
    if (result == KILN_OK)
        result = ki_gain_map_apply(f->context, &f->gain, samples, head->width, head->height,
                                   head->components, image, error);
    ki_free(samples);
    return result;
}

static kiln_result read_pixels(jpeg_file *f, kiln_image *image, kiln_error *error)
{
    uint8_t *samples;
    *image = (kiln_image){.width = f->head.width, .height = f->head.height, .channels = 3};
    kiln_result result = ki_jpeg_samples(f->context, f->file, &f->head, f->name, &samples, error);
    if (result == KILN_OK)
        result = ki_image_allocate(f->context, image, error);
    if (result == KILN_OK && !to_linear(f, samples, image))
        result = ki_fail_cancelled(error, "reading");
    ki_free(samples);
    if (result == KILN_OK && f->has_gain)
        result = apply_gain_map(f, image, error);
    if (result == KILN_OK)
        result = ki_file_color_finish(f->context, &f->color, image, error);
    if (result == KILN_OK)
        result = ki_turn_upright(f->context, f->head.orientation, image, error);
    if (result != KILN_OK)
        kiln_image_free(image);
    return result;
}

static void describe(const jpeg_file *f, kiln_file_info *info)
{
    bool exchanged = f->head.orientation >= 5;
    snprintf(info->format, sizeof info->format, "jpeg");
    snprintf(info->encoding, sizeof info->encoding, "8 bits %s, %s%s%s",
             f->head.components == 3 ? "rgb" : "grey", f->color.profile ? "icc" : "srgb",
             f->has_gain ? ", gain map" : "", f->head.progressive ? ", progressive" : "");
    info->width = exchanged ? f->head.height : f->head.width;
    info->height = exchanged ? f->head.width : f->head.height;
    info->channel_count = f->head.components;
    info->level_count = 1;
}

kiln_result ki_jpeg_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, kiln_image *image, kiln_file_info *info,
                           kiln_load_report *report, kiln_error *error)
{
    if (image)
        *image = (kiln_image){0};
    jpeg_file *f = ki_alloc(context, 1, sizeof *f);
    if (!f)
        return ki_fail_memory(context, error, name, sizeof *f);
    f->context = context;
    f->name = name;
    f->file = (ki_span){bytes, size};
    kiln_result result = read_head(f, report, error);
    if (result == KILN_OK && info)
        describe(f, info);
    if (result == KILN_OK && image)
        result = read_pixels(f, image, error);
    ki_file_color_free(&f->color);
    ki_free(f);
    return result;
}
