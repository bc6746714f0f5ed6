// The inner loops of the spherical engine, compiled once an instruction set from kernels.inl.
//
// A vector has eight lanes on every instruction set and a lane is a pair of rings, one north of
// the equator and its mirror image south of it; sums over lanes are taken in one fixed order. So
// every path gives the same bits.
#ifndef KI_KERNELS_H
#define KI_KERNELS_H

#include "base/base.h"

#include <stddef.h>

enum {
    KI_LANES = 8,
    KI_COMPONENTS = 6,  // real and imaginary parts of three channels
    KI_TAPS = 8,        // of the interpolation between rings, and between a ring's points
    KI_TAP_STEPS = 256, // fractions the taps are tabulated for
    KI_TAP_TABLE = KI_TAPS * (KI_TAP_STEPS + 1) // taps in a table, with both ends
};

/// One pass of a Stockham FFT.
typedef struct ki_fft_pass {
    int radix, length, stride; // of this pass: `length` = radix * the next one's length
    const double *twiddles;    // [length / radix][radix - 1][2]
    const double *roots;       // generic radices: [radix][2], else NULL
} ki_fft_pass;

enum { KI_FFT_PASSES = 24 };

/// A forward transform of `length` complex numbers in eight lanes. Elements are 16 doubles: eight
/// real, eight imaginary parts.
typedef struct ki_fft {
    int length, pass_count;
    ki_fft_pass pass[KI_FFT_PASSES];
    double *tables;
} ki_fft;

/// Suns as points, each a direction and a radiance times solid angle. Eight directions at a time use
/// one point where all are farther than far_versine (1 - cos) from the sun, four beyond near_versine;
/// else, and where the sun is within `horizon` (in cos) of the edge of a lobe, near_count points.
typedef struct ki_sun_points {
    int count, near_count;
    double far_versine, near_versine, horizon;
    double (*centre)[6], (*pairs)[6], (*near)[6]; // [count], [count][4], [count][near_count]
} ki_sun_points;

typedef struct ki_kernels {
    /// Transforms `data` with `work` as the second buffer; returns whichever holds the result.
    double *(*fft)(const ki_fft *fft, double *data, double *work);

    /// accumulator[i] += weights[k] * (rows + offsets[k])[i], k = 0 .. row_count-1 in this order.
    void (*spread)(double *accumulator, const float *rows, const ptrdiff_t *offsets,
                   const double *weights, int row_count, int count);

    /// Sums a row of `count` RGB texels by channel; returns its largest value.
    float (*sum_row)(const float *row, int count, double sum[3]);

    /// One order of the analysis: out[l - m][6] = sum over the vectors first .. last-1 and their
    /// lanes of q_l times the even (l - m even) or odd half of data[vector][12][8].
    /// `f` holds the recurrence's coefficients of l = m .., `twice_cos` and `start` [vector][8] the
    /// rings' 2 cos theta and sin^m theta, `state` is scratch [vector][2][8].
    void (*analyze)(const double *f, int count, const double *twice_cos, const double *start,
                    const double *data, int first, int last, double *state, double *out);

    /// The transpose, for one vector: out[12][8] = sum over l of q_l times coefficients[l - m][6],
    /// even (l - m) in the first six, odd in the others. Two neighbouring vectors at once.
    void (*synthesize)(const double *f, int count, const double *twice_cos, const double *start,
                       const double *coefficients, double *out0, double *out1);

    /// Sums orders 0 .. count-1 at one point of each ring of a vector: orders [m][pitch] as `synthesize`
    /// writes them; cosine, sine of each point's phi; sign 1 on northern rings, -1 on southern.
    /// rgb[channel][lane].
    void (*sum_orders)(const double *orders, size_t pitch, int count, const double *cosine,
                       const double *sine, const double *sign, double *rgb);

    /// Interpolates `count` texels: position[i] = {ring, column} in units of the grid's spacing, not
    /// negative. `grid` is [3][rows][pitch]; taps start at the integer part. Adds to rgb[i][3].
    void (*interpolate)(const float *grid, size_t plane, size_t pitch, const float *ring_taps,
                        const float *column_taps, const double *position, int count, float *rgb);

    /// sum[channel][lane] += light of the suns through the GGX lobe, for eight directions [3][8]. See
    /// ki_lobe_weight.
    void (*suns_ggx)(const ki_sun_points *suns, double alpha, const double *directions,
                     double *sum);
} ki_kernels;

/// The kernels of the context's instruction set.
const ki_kernels *ki_sphere_kernels(const kiln_context *context);

#endif
