// The inner loops of the spherical-harmonic transforms, compiled from kernels.inl once for each
// instruction set.
//
// A vector has eight lanes on every instruction set. A lane holds a pair of latitude rings: a ring
// north of the equator and its mirror image south of the equator. Sums over lanes are taken in one
// fixed order, so that every instruction set gives the same bits.
#ifndef KI_KERNELS_H
#define KI_KERNELS_H

#include "base/base.h"
#include "sphere/mixture.h"

#include <stddef.h>

enum {
    KI_LANES = 8,
    // number of degrees that the kernel sum_degrees handles at once
    KI_DEGREES = 4,
    // number of doubles of a coefficient a_lm: real and imaginary parts of three colour channels
    KI_COMPONENTS = 6,
    // Number of weights of the interpolation between latitude rings, and between the points of a
    // ring.
    KI_TAPS = 8,
    // number of intervals into which a table of interpolation weights divides the fraction 0 to 1
    KI_TAP_STEPS = 256,
    // Number of doubles in a table of interpolation weights: eight weights for each of the
    // KI_TAP_STEPS + 1 fractions from 0 to 1.
    KI_TAP_TABLE = KI_TAPS * (KI_TAP_STEPS + 1)
};

/// One pass of a Stockham FFT of mixed radix.
typedef struct ki_fft_pass {
    // `length` of a pass is its radix times the `length` of the next pass. `stride` is the product
    // of the radices of the earlier passes.
    int radix, length, stride;
    // Twiddle factors exp(-2 pi i p j / length), p < length / radix, j = 1 .. radix - 1, as
    // [p][j - 1][real, imaginary].
    const double *twiddles;
    // Roots of unity exp(-2 pi i j / radix), [j][real, imaginary]. Passes of radix 2, 3 and 4 do
    // not read them.
    const double *roots;
} ki_fft_pass;

enum { KI_FFT_PASSES = 24 };

/// Plan of the forward Fourier transform of eight signals at once, one in each lane, of `length`
/// complex numbers each. Element i of the data is 16 doubles: the real parts of number i of the
/// eight signals, then the imaginary parts.
typedef struct ki_fft {
    int length, pass_count;
    ki_fft_pass pass[KI_FFT_PASSES];
    double *tables;
} ki_fft;

/// Suns, the texels that the analysis keeps out of the spectrum, as points on the sphere. A point
/// is a unit direction and its light: radiance times solid angle, divided by the lobe's integral. A
/// sun is summed for eight directions at once. Distances below are 1 - cos of the angle between the
/// sun and the nearest of the eight directions, and the first line that applies counts:
///
/// - Farther than `horizon` (in cos of the angle) below the horizon of every direction, where lobes
///   are 0: no point.
/// - Nearer than close_versine, where a narrow lobe changes within the sun's texel: close_count
///   points. For wide lobes close_versine is negative and close_count 0.
/// - Nearer than near_versine: near_count points.
/// - Within `horizon` of the horizon of a direction, where the lobe has a kink: near_count points,
///   or 4 with `few_across`. The error of the 4 points is at most 0.022 texels times the lobe's slope
///   at the horizon, in a band as wide as a texel.
/// - Nearer than far_versine: 4 points.
/// - Else: its one centre point.
typedef struct ki_sun_points {
    int count, near_count, close_count;
    bool few_across;
    double far_versine, near_versine, close_versine, horizon;
    // Points {x, y, z, r, g, b} of all suns: `centre` has 1 point for each sun, `pairs` 2 x 2
    // points, `near` near_count points, `close` close_count points.
    double (*centre)[6], (*pairs)[6], (*near)[6], (*close)[6];
} ki_sun_points;

typedef struct ki_kernels {
    /// Fourier-transforms `data` by the plan `fft`, with `work` as a second buffer of the same
    /// size. Returns the buffer, `data` or `work`, that holds the result.
    double *(*fft)(const ki_fft *fft, double *data, double *work);

    /// Adds weighted rows: accumulator[i] += weights[k] * (rows + offsets[k])[i] for i < count,
    /// with k = 0 .. row_count - 1 in this order. With `is_first`, the sums replace what it held.
    void (*add_weighted)(double *accumulator, bool is_first, const float *rows,
                         const ptrdiff_t *offsets, const double *weights, int row_count, int count);

    /// Sums the magnitudes of a row of `count` RGB texels by channel and returns the largest
    /// magnitude of the row.
    float (*sum_row)(const float *row, int count, double sum[3]);

    /// Splits one channel of the Fourier transforms of eight pairs of latitude rings, z[length]
    /// [2][lane], into the orders m = 0 .. degree. The northern ring of a pair is the real part of
    /// the transformed data, the southern ring the imaginary part. The parts of the pairs that are
    /// even and odd about the equator are multiplied by column[m] {real, imaginary}, the odd part
    /// also by `twice_cos` [lane], and written to orders[m * pitch], as `data` of `analyze` has them
    /// for one channel and one vector: at 0 and 8 the real and imaginary parts that are even, at 48
    /// and 56 those that are odd. Orders with first[m] > vector are left out.
    void (*split_orders)(const double *z, int length, int degree, const double *column,
                         const double *twice_cos, const int *first, int vector, double *orders,
                         size_t pitch);

    /// The reverse, before the Fourier transform of the synthesis: fills buffer[length][2][lane]
    /// from orders[m * pitch] as `synthesize` writes them, those with first[m] > vector being 0.
    /// Real and imaginary parts are swapped, which makes the forward transform an inverse
    /// transform: the result has southern rings, then northern rings.
    void (*join_orders)(const double *orders, size_t pitch, int degree, const int *first,
                        int vector, int length, double *buffer);

    /// Analyses one order m of `count` degrees on the latitude rings of the vectors first ..
    /// last - 1: out[k][12] is the sum over the rings of q_{m+2k} (legendre.h) times
    /// data[vector][12][lane], for 2 k < count. The data are six components (real and imaginary part
    /// of r, g, b) of the part that is even about the equator, then six of the odd part times
    /// 2 cos theta. The sums of the odd part become coefficients by ki_legendre_part_odd. With an odd
    /// `count` the last six numbers of `out` mean nothing. `steps` holds the steps of the order,
    /// `start` sin^m theta and `twice_cos` 2 cos theta of the rings, both [vector][lane]. The
    /// functions with k < skip[vector] are left out; the numbers in `skip` are even and do not
    /// increase. `state` is scratch memory, [vector][3][lane]. All arrays begin with vector 0.
    void (*analyze)(const double *steps, int count, const double *twice_cos, const double *start,
                    const double *data, const int *skip, int first, int last, double *state,
                    double *out);

    /// The transpose of `analyze`, for two neighbouring vectors of latitude rings: sums q_{m+2k}
    /// times coefficients[k][12] over k, without the functions with k < skip, which are negligible in
    /// both vectors. The coefficients are those of two degrees, the odd ones joined by
    /// ki_legendre_join_odd. With an odd `count` the last six must be 0. Writes [12][lane] for each
    /// vector: six sums that are even about the equator, then six sums times 2 cos theta, which are
    /// odd.
    void (*synthesize)(const double *steps, int count, const double *twice_cos, const double *start,
                       const double *coefficients, int skip, double *out0, double *out1);

    /// Sums the Fourier series over the orders m = 0 .. count - 1 at one point of each of eight
    /// latitude rings. `orders` is [m][pitch], as `synthesize` writes it for one vector. `cosine`
    /// and `sine` belong to the longitude phi of the points, and `sign` is 1 on northern and -1 on
    /// southern rings. Writes rgb[channel][lane].
    void (*sum_orders)(const double *orders, size_t pitch, int count, const double *cosine,
                       const double *sine, const double *sign, double *rgb);

    /// Interpolates `count` texels from a grid and adds them to rgb[i][3]. position[i] = {ring,
    /// column}, in grid steps and not negative; the first of the eight weights along each axis
    /// belongs to the integer part of the position. `grid` is [channel][rows][pitch], with `plane`
    /// floats in a channel. `ring_taps` and `column_taps` are tables of interpolation weights.
    void (*interpolate)(const float *grid, size_t plane, size_t pitch, const float *ring_taps,
                        const float *column_taps, const double *position, int count, float *rgb);

    /// Adds the light of the suns through a GGX lobe to sum[channel][lane], for eight unit
    /// directions [axis][lane]. The weight of the lobe is that of ki_lobe_weight.
    void (*suns_ggx)(const ki_sun_points *suns, double alpha, const double *directions,
                     double *sum);
    /// Adds the light of the suns as suns_ggx does, through a mixture of lobes.
    void (*suns_mixture)(const ki_sun_points *suns, const ki_mixture *mixture,
                         const double *directions, double *sum);

    /// Sums weights times Legendre polynomials over `count` quadrature nodes, a multiple of 4, for
    /// the degrees l to l + KI_DEGREES - 1: sums[k] is the sum of w[i] P_{l+k}(x[i]). p0 and p1
    /// hold P_{l-1} and P_l of each node, and are moved on by KI_DEGREES degrees.
    void (*sum_degrees)(const double *x, const double *w, ptrdiff_t count, int l, double *p0,
                        double *p1, double sums[KI_DEGREES]);
} ki_kernels;

/// Returns the kernels for the instruction set of the context.
const ki_kernels *ki_sphere_kernels(const kiln_context *context);

#endif
