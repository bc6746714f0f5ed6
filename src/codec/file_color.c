// Colours of files. In: stored samples, and what the file says about them. Out: linear light in
// Rec. 709, where 1 is the white of sRGB, or of a reference white of 203 cd/m2 for PQ and HLG
// (ITU-R BT.2408). Method: a table gives the linear value of each sample; the picture is then
// converted texel by texel where the primaries are not Rec. 709's.  HLG stores light as a camera
// sees it. ITU-R BT.2100 shows that light on a display with the peak 1000 cd/m2 by the system gamma
// 1.2, so that HLG and PQ of the same picture give the same values.
#include "codec/file_color.h"

#include "image/pack.h"
#include "math/math.h"

#include <stdio.h>
#include <string.h>

// Luminance in cd/m2 of the reference white, which becomes 1, and of the largest values that PQ and
// HLG store.
static const double reference_white = 203, pq_peak = 10000, hlg_peak = 1000;

// ---------------------------------------------------------------------------------------- curves

static double parametric(const ki_curve *k, double x)
{
    double base = k->a * x + k->b;
    if (x < k->d)
        return k->c * x + k->f;
    return (base > 0 ? ki_pow(base, k->g) : 0) + k->e;
}

static double table_value(const ki_curve *k, double x)
{
    double at = x * (double)(k->count - 1);
    size_t i = (size_t)at, next = i + 1 < k->count ? i + 1 : i;
    double low = k->table[2 * i] << 8 | k->table[2 * i + 1];
    double high = k->table[2 * next] << 8 | k->table[2 * next + 1];
    return (low + (high - low) * (at - (double)i)) / 65535;
}

static double from_pq(double x)
{
    double power = ki_pow(x, 1 / 78.84375), above = power - 0.8359375;
    return above > 0 ? ki_pow(above / (18.8515625 - 18.6875 * power), 1 / 0.1593017578125) : 0;
}

static double from_hlg(double x)
{
    return x <= 0.5 ? x * x / 3 : (ki_exp((x - 0.55991073) / 0.17883277) + 0.28466892) / 12;
}

double ki_curve_linear(const ki_curve *curve, double sample)
{
    double x = ki_clamp(sample, 0, 1);
    switch (curve->kind) {
    case KI_CURVE_PARAMETRIC:
        return parametric(curve, x);
    case KI_CURVE_TABLE:
        return table_value(curve, x);
    case KI_CURVE_PQ:
        return from_pq(x) * (pq_peak / reference_white);
    case KI_CURVE_HLG:
        return from_hlg(x);
    default:
        return (double)ki_linear_from_srgb((float)x);
    }
}

void ki_file_color_fill(const ki_file_color *color, int channel, float *table, int count)
{
    for (int i = 0; i < count; i++) {
        double x = (double)((float)i / (float)(count - 1));
        if (color->narrow)
            x = (x * 255 - 16) / 219;
        table[i] = (float)ki_curve_linear(&color->curve[channel], x);
    }
}

// --------------------------------------------------------------------------------------- setting

void ki_file_color_free(ki_file_color *color)
{
    ki_free(color->profile);
    *color = (ki_file_color){0};
}

void ki_file_color_set_curve(ki_file_color *color, const ki_curve *curve)
{
    for (int c = 0; c < 3; c++)
        color->curve[c] = *curve;
}

bool ki_file_color_set_primaries(ki_file_color *color, const ki_primaries *primaries)
{
    if (!ki_rec709_from_rgb(primaries, NULL, &color->to_rec709) ||
        !ki_luminance_weights(primaries, color->luminance))
        return false;
    color->converts = !ki_matrix_is_identity(&color->to_rec709);
    return true;
}

typedef struct known_primaries {
    int number;
    const char *name;
    ki_primaries primaries;
} known_primaries;

static const known_primaries known_sets[] = {
    {1, "Rec. 709", {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}}},
    {5, "BT.601 625", {{0.64, 0.33, 0.29, 0.60, 0.15, 0.06, 0.3127, 0.3290}}},
    {6, "BT.601 525", {{0.630, 0.340, 0.310, 0.595, 0.155, 0.070, 0.3127, 0.3290}}},
    {9, "Rec. 2020", {{0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}}},
    {11, "DCI P3", {{0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.314, 0.351}}},
    {12, "Display P3", {{0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}}},
};

typedef struct known_transfer {
    int number;
    const char *name;
    ki_curve curve;
} known_transfer;

// Numbers of KI_CURVE_PARAMETRIC for the transfer function of ITU-R BT.709, from stored samples to
// linear light.
#define BT709_CURVE                                                                                \
    {                                                                                              \
        .kind = KI_CURVE_PARAMETRIC, .g = 1 / 0.45, .a = 1 / 1.099, .b = 0.099 / 1.099,            \
        .c = 1 / 4.5, .d = 0.081                                                                   \
    }

static const known_transfer known_transfers[] = {
    {1, "the curve of BT.709", BT709_CURVE},
    {4, "gamma 2.2", {.kind = KI_CURVE_PARAMETRIC, .g = 2.2, .a = 1}},
    {5, "gamma 2.8", {.kind = KI_CURVE_PARAMETRIC, .g = 2.8, .a = 1}},
    {6, "the curve of BT.709", BT709_CURVE},
    {8, "linear values", {.kind = KI_CURVE_PARAMETRIC, .g = 1, .a = 1}},
    {13, "the curve of sRGB", {.kind = KI_CURVE_SRGB}},
    {14, "the curve of BT.709", BT709_CURVE},
    {15, "the curve of BT.709", BT709_CURVE},
    {16, "PQ, where 203 cd/m2 is 1", {.kind = KI_CURVE_PQ}},
    {18, "HLG, where 203 cd/m2 is 1", {.kind = KI_CURVE_HLG}},
};

const char ki_cicp_known[] =
    "kiln reads primaries 1, 5, 6, 9, 11 and 12, transfer functions 1, 4, 5, "
    "6, 8, 13, 14, 15, 16 and 18, and matrix 0";

bool ki_file_color_set_cicp(ki_file_color *color, const uint8_t numbers[4],
                            char what[KI_COLOR_NAME])
{
    const known_primaries *set = NULL;
    const known_transfer *transfer = NULL;
    for (size_t i = 0; i < sizeof known_sets / sizeof *known_sets; i++)
        if (known_sets[i].number == numbers[0])
            set = &known_sets[i];
    for (size_t i = 0; i < sizeof known_transfers / sizeof *known_transfers; i++)
        if (known_transfers[i].number == numbers[1])
            transfer = &known_transfers[i];
    if (!set || !transfer || numbers[2] || numbers[3] > 1)
        return false;
    ki_file_color_set_curve(color, &transfer->curve);
    ki_file_color_set_primaries(color, &set->primaries);
    color->hlg = transfer->curve.kind == KI_CURVE_HLG;
    color->narrow = !numbers[3];
    snprintf(what, KI_COLOR_NAME, "%s and %s%s", set->name, transfer->name,
             color->narrow ? ", narrow range" : "");
    return true;
}

// --------------------------------------------------------------------------------------- pictures

typedef struct hlg_job {
    const ki_file_color *color;
    kiln_image *image;
} hlg_job;

// Task of one thread: applies the system gamma of HLG, which turns the light of the scene into that
// of a display, to one row.
static void show_row(void *data, int row)
{
    const hlg_job *job = data;
    const double *weights = job->color->luminance;
    float *rgb = job->image->pixels + 3 * (size_t)job->image->width * (size_t)row;
    for (int x = 0; x < job->image->width; x++, rgb += 3) {
        double luminance =
            weights[0] * (double)rgb[0] + weights[1] * (double)rgb[1] + weights[2] * (double)rgb[2];
        double scale = luminance > 0 ? ki_pow(luminance, 0.2) * (hlg_peak / reference_white) : 0;
        for (int c = 0; c < 3; c++)
            rgb[c] = (float)((double)rgb[c] * scale);
    }
}

kiln_result ki_file_color_finish(kiln_context *context, const ki_file_color *color,
                                 kiln_image *image, kiln_error *error)
{
    hlg_job job = {color, image};
    if (color->hlg && !ki_parallel_steps(context, NULL, image->height, show_row, &job))
        return ki_fail_cancelled(error, "reading");
    if (color->converts && !ki_image_transform(context, &color->to_rec709, image))
        return ki_fail_cancelled(error, "reading");
    return KILN_OK;
}
