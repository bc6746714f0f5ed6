// The inner loops of the spherical-harmonic transforms, compiled from kernels.inl once for each
// instruction set.
//
// A vector has eight lanes on every instruction set. A lane holds a pair of latitude rings: a ring
// north of the equator and its mirror image south of the equator. Sums over lanes are taken in one
// fixed order, so that every instruction set gives the same bits.
#ifndef KI_KERNELS_H
#define KI_KERNELS_H

#include "base/base.h"

#include <stddef.h>

enum {
    KI_LANES = 8,
    KI_COMPONENTS = 6, // real and imaginary parts of the three colour channels
    // Number of weights of the interpolation between latitude rings, and between the points of a
    // ring.
    KI_TAPS = 8,
    // number of intervals into which a table of interpolation weights divides the fraction 0 to 1
    KI_TAP_STEPS = 256,
    // Number of doubles in a table of interpolation weights, which has entries for the fractions 0
    // and 1 too.
    KI_TAP_TABLE = KI_TAPS * (KI_TAP_STEPS + 1)
};

/// One pass of a Stockham FFT of mixed radix.
typedef struct ki_fft_pass {
    // The passes follow one another: `length` of a pass is its radix times the `length` of the next
    // pass.
    int radix, length, stride;
    const double *twiddles; // twiddle factors, [length / radix][radix - 1][2]
    const double *roots;    // roots of unity, [radix][2], read by radices other than 2, 3, 4
} ki_fft_pass;

enum { KI_FFT_PASSES = 24 };

/// A forward transform of `length` complex numbers in eight lanes. An element of the data is 16
/// doubles: eight real parts, then eight imaginary parts.
typedef struct ki_fft {
    int length, pass_count;
    ki_fft_pass pass[KI_FFT_PASSES];
    double *tables;
} ki_fft;

/// Suns, the texels that the analysis keeps out of the spectrum, as points with a direction and
/// radiance times solid angle. For eight directions at once, a sun counts as its one centre point
/// if the directions are all farther than far_versine (1 - cos of the angle) from the sun, and as 4
/// points if they are farther than near_versine. Otherwise, or if the horizon of a direction is
/// within `horizon` (in cos of the angle) of the sun, the sun counts as near_count points.
typedef struct ki_sun_points {
    int count, near_count;
    double far_versine, near_versine, horizon;
    // arrays of `count` centre points, `count` sets of 4 points, and `count` sets of near_count
    // points
    double (*centre)[6], (*pairs)[6], (*near)[6];
} ki_sun_points;

typedef struct ki_kernels {
    /// Transforms `data`, with `work` as a second buffer of the same size. Returns the buffer that
    /// holds the result.
    double *(*fft)(const ki_fft *fft, double *data, double *work);

    /// Adds weighted rows: accumulator[i] += weights[k] * (rows + offsets[k])[i] for i < count,
    /// with k = 0 .. row_count - 1 in this order.
    void (*add_weighted)(double *accumulator, const float *rows, const ptrdiff_t *offsets,
                         const double *weights, int row_count, int count);

    /// Sums the magnitudes of a row of `count` RGB texels by channel and returns the largest
    /// magnitude of the row.
    float (*sum_row)(const float *row, int count, double sum[3]);

    /// Sums one order m of the analysis: out[l - m][6] is the sum, over the lanes of the vectors
    /// first .. last - 1, of q_l times the half of data[vector][12][8] that is even about the
    /// equator (l - m even) or odd (l - m odd). `f` holds the coefficients of the recurrence of q_l
    /// from l = m on. `twice_cos` and `start`, both [vector][8], hold 2 cos theta and sin^m theta
    /// of the rings. `state` is scratch, [vector][2][8].
    void (*analyze)(const double *f, int count, const double *twice_cos, const double *start,
                    const double *data, int first, int last, double *state, double *out);

    /// The transpose of `analyze`, for two neighbouring vectors: out[12][8] is the sum over l of
    /// q_l times coefficients[l - m][6]. Terms with even l - m are summed in the first six rows,
    /// terms with odd l - m in the other six.
    void (*synthesize)(const double *f, int count, const double *twice_cos, const double *start,
                       const double *coefficients, double *out0, double *out1);

    /// Sums the orders m = 0 .. count - 1 at one point of each latitude ring of a vector. `orders`
    /// is [m][pitch], as `synthesize` writes it. `cosine` and `sine` belong to phi of each point,
    /// and `sign` is 1 on northern and -1 on southern rings. Writes rgb[channel][lane].
    void (*sum_orders)(const double *orders, size_t pitch, int count, const double *cosine,
                       const double *sine, const double *sign, double *rgb);

    /// Interpolates `count` texels and adds them to rgb[i][3]. position[i] = {ring, column} is not
    /// negative and in units of the grid's spacing. `grid` is [3][rows][pitch]; the first of the
    /// eight weights belongs to the integer part of the position.
    void (*interpolate)(const float *grid, size_t plane, size_t pitch, const float *ring_taps,
                        const float *column_taps, const double *position, int count, float *rgb);

    /// Adds the light of the suns through a GGX lobe, for eight directions [3][8], to
    /// sum[channel][lane]. The weight of the lobe is that of ki_lobe_weight.
    void (*suns_ggx)(const ki_sun_points *suns, double alpha, const double *directions,
                     double *sum);
} ki_kernels;

/// Returns the kernels for the instruction set of the context.
const ki_kernels *ki_sphere_kernels(const kiln_context *context);

#endif
