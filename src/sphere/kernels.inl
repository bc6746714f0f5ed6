// The bodies of the inner loops that kernels.h declares: the FFT, the distribution of rows onto
// latitude rings, the sums with associated Legendre functions (docs/theory/spectral.md), and the
// interpolation of texels. In and out: arrays of doubles in groups of eight lanes.
//
// The including file defines KI_WIDTH, the number of doubles in a native vector (1, 2, 4 or 8);
// KI_BLOCK, the number of functions of one order that the analysis sums at once (1 or 2, as many as
// the registers hold); and KI_TABLE, the name of the table of kernels.
#include "sphere/kernels.h"

#include "base/lanes.inl"
#include "base/vector.h"

#include <math.h>
#include <string.h>

enum { PARTS = KI_LANES / KI_WIDTH };

#if KI_WIDTH == 1
enum { FLOATS = 1 };
typedef float floats;
#else
enum { FLOATS = KI_WIDTH < 4 ? 4 : 8 };
typedef float floats __attribute__((vector_size(4 * FLOATS), may_alias));
#endif

// Loads KI_WIDTH floats and converts them to doubles. GCC makes one instruction of a list of all
// lanes, and three to five of __builtin_convertvector.
static inline vec widen(const float *p)
{
#if KI_WIDTH == 1
    return (double)*p;
#elif KI_WIDTH == 2
    return (vec){(double)p[0], (double)p[1]};
#elif KI_WIDTH == 4
    return (vec){(double)p[0], (double)p[1], (double)p[2], (double)p[3]};
#else
    return (vec){(double)p[0], (double)p[1], (double)p[2], (double)p[3],
                 (double)p[4], (double)p[5], (double)p[6], (double)p[7]};
#endif
}

static inline floats load_floats(const float *p)
{
    floats v;
    memcpy(&v, p, sizeof v);
    return v;
}

static inline double sum_lanes(const double *v)
{
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

#if KI_WIDTH >= 4
typedef double four __attribute__((vector_size(32), may_alias));

static inline four load_four(const double *p)
{
    four v;
    memcpy(&v, p, sizeof v);
    return v;
}
#endif

// Adds the lanes h to h + KI_WIDTH - 1 of a vector to an array of four, in which lanes i and i + 4
// are summed. The lanes come in increasing order.
static inline void fold_lanes(double to[4], int h, vec v)
{
#if KI_WIDTH == 8
    (void)h;
    four low = KI_LOWER_DOUBLES4(v), high = KI_UPPER_DOUBLES4(v), sum = low + high;
    memcpy(to, &sum, sizeof sum);
#else
    if (h >= 4)
        v += load(to + h - 4);
    store(to + h % 4, v);
#endif
}

// Sums four arrays that fold_lanes has filled, with the result of sum_lanes for each.
static inline void sum_folded(const double v[4][4], double sums[4])
{
#if KI_WIDTH >= 4
    four a = load_four(v[0]), b = load_four(v[1]), c = load_four(v[2]), d = load_four(v[3]);
    four ac = KI_SHUFFLE_DOUBLES4(a, c, 0, 1, 4, 5) + KI_SHUFFLE_DOUBLES4(a, c, 2, 3, 6, 7);
    four bd = KI_SHUFFLE_DOUBLES4(b, d, 0, 1, 4, 5) + KI_SHUFFLE_DOUBLES4(b, d, 2, 3, 6, 7);
    four sum = KI_SHUFFLE_DOUBLES4(ac, bd, 0, 4, 2, 6) + KI_SHUFFLE_DOUBLES4(ac, bd, 1, 5, 3, 7);
    memcpy(sums, &sum, sizeof sum);
#else
    for (int i = 0; i < 4; i++)
        sums[i] = (v[i][0] + v[i][2]) + (v[i][1] + v[i][3]);
#endif
}

// --------------------------------------------------------------------------------------------- FFT

// Multiplies the complex number (re, im) by the twiddle factor w and stores the product.
static inline void store_twisted(double *to, vec re, vec im, const double *w)
{
    vec wr = splat(w[0]), wi = splat(w[1]);
    store(to, re * wr - im * wi);
    store(to + 8, re * wi + im * wr);
}

static void pass2(const ki_fft_pass *pass, const double *x, double *y)
{
    ptrdiff_t m = pass->length / 2, s = pass->stride;
    for (ptrdiff_t p = 0; p < m; p++) {
        const double *w = pass->twiddles + 2 * p;
        for (ptrdiff_t q = 0; q < s; q++) {
            const double *a = x + 16 * (q + s * p), *b = a + 16 * s * m;
            double *to = y + 16 * (q + s * 2 * p);
            for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
                vec ar = load(a + h), ai = load(a + 8 + h), br = load(b + h), bi = load(b + 8 + h);
                store(to + h, ar + br);
                store(to + 8 + h, ai + bi);
                store_twisted(to + 16 * s + h, ar - br, ai - bi, w);
            }
        }
    }
}

static void pass3(const ki_fft_pass *pass, const double *x, double *y)
{
    const double half_root3 = 0.86602540378443864676;
    ptrdiff_t m = pass->length / 3, s = pass->stride;
    for (ptrdiff_t p = 0; p < m; p++) {
        const double *w = pass->twiddles + 4 * p;
        for (ptrdiff_t q = 0; q < s; q++) {
            const double *a = x + 16 * (q + s * p), *b = a + 16 * s * m, *c = b + 16 * s * m;
            double *to = y + 16 * (q + s * 3 * p);
            for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
                vec ar = load(a + h), ai = load(a + 8 + h);
                vec br = load(b + h), bi = load(b + 8 + h);
                vec cr = load(c + h), ci = load(c + 8 + h);
                vec tr = br + cr, ti = bi + ci;
                vec ur = ar - tr * 0.5, ui = ai - ti * 0.5;
                vec vr = (bi - ci) * half_root3, vi = (cr - br) * half_root3;
                store(to + h, ar + tr);
                store(to + 8 + h, ai + ti);
                store_twisted(to + 16 * s + h, ur + vr, ui + vi, w);
                store_twisted(to + 32 * s + h, ur - vr, ui - vi, w + 2);
            }
        }
    }
}

static void pass4(const ki_fft_pass *pass, const double *x, double *y)
{
    ptrdiff_t m = pass->length / 4, s = pass->stride, apart = 16 * s * m;
    for (ptrdiff_t p = 0; p < m; p++) {
        const double *w = pass->twiddles + 6 * p;
        for (ptrdiff_t q = 0; q < s; q++) {
            const double *a = x + 16 * (q + s * p);
            double *to = y + 16 * (q + s * 4 * p);
            for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
                vec ar = load(a + h), ai = load(a + 8 + h);
                vec br = load(a + apart + h), bi = load(a + apart + 8 + h);
                vec cr = load(a + 2 * apart + h), ci = load(a + 2 * apart + 8 + h);
                vec dr = load(a + 3 * apart + h), di = load(a + 3 * apart + 8 + h);
                vec t0r = ar + cr, t0i = ai + ci, t1r = ar - cr, t1i = ai - ci;
                vec t2r = br + dr, t2i = bi + di, t3r = bi - di, t3i = dr - br;
                store(to + h, t0r + t2r);
                store(to + 8 + h, t0i + t2i);
                store_twisted(to + 16 * s + h, t1r + t3r, t1i + t3i, w);
                store_twisted(to + 32 * s + h, t0r - t2r, t0i - t2i, w + 2);
                store_twisted(to + 48 * s + h, t1r - t3r, t1i - t3i, w + 4);
            }
        }
    }
}

// A pass of an FFT of any radix, used for radices other than 2, 3 and 4: sums by the definition of
// the Fourier transform.
static void pass_any(const ki_fft_pass *pass, const double *x, double *y)
{
    ptrdiff_t r = pass->radix, m = pass->length / r, s = pass->stride, apart = 16 * s * m;
    for (ptrdiff_t p = 0; p < m; p++) {
        for (ptrdiff_t q = 0; q < s; q++) {
            const double *a = x + 16 * (q + s * p);
            for (ptrdiff_t j = 0; j < r; j++) {
                static const double one[2] = {1, 0};
                double *to = y + 16 * (q + s * (r * p + j));
                const double *w = j ? pass->twiddles + 2 * (p * (r - 1) + j - 1) : one;
                for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
                    vec re = load(a + h), im = load(a + 8 + h);
                    ptrdiff_t turn = 0;
                    for (ptrdiff_t k = 1; k < r; k++) {
                        turn += j;
                        turn -= turn >= r ? r : 0;
                        vec wr = splat(pass->roots[2 * turn]),
                            wi = splat(pass->roots[2 * turn + 1]);
                        vec br = load(a + apart * k + h);
                        vec bi = load(a + apart * k + 8 + h);
                        re += br * wr - bi * wi;
                        im += br * wi + bi * wr;
                    }
                    store_twisted(to + h, re, im, w);
                }
            }
        }
    }
}

static double *fft(const ki_fft *plan, double *data, double *work)
{
    for (int i = 0; i < plan->pass_count; i++) {
        const ki_fft_pass *pass = &plan->pass[i];
        switch (pass->radix) {
        case 2:
            pass2(pass, data, work);
            break;
        case 3:
            pass3(pass, data, work);
            break;
        case 4:
            pass4(pass, data, work);
            break;
        default:
            pass_any(pass, data, work);
            break;
        }
        double *other = data;
        data = work;
        work = other;
    }
    return data;
}

// ------------------------------------------------------------------------------------------ rings

static void add_weighted(double *accumulator, bool is_first, const float *rows,
                         const ptrdiff_t *offsets, const double *weights, int row_count, int count)
{
    // number of native vectors that are summed at once, which hides the latency of additions
    enum { AT_ONCE = 4 };
    int i = 0;
    for (; i + AT_ONCE * KI_WIDTH <= count; i += AT_ONCE * KI_WIDTH) {
        vec sum[AT_ONCE];
        for (ptrdiff_t n = 0; n < AT_ONCE; n++)
            sum[n] = is_first ? splat(0) : load(accumulator + i + n * KI_WIDTH);
        for (int k = 0; k < row_count; k++)
            for (ptrdiff_t n = 0; n < AT_ONCE; n++)
                sum[n] += weights[k] * widen(rows + offsets[k] + i + n * KI_WIDTH);
        for (ptrdiff_t n = 0; n < AT_ONCE; n++)
            store(accumulator + i + n * KI_WIDTH, sum[n]);
    }
    for (; i + KI_WIDTH <= count; i += KI_WIDTH) {
        vec sum = is_first ? splat(0) : load(accumulator + i);
        for (int k = 0; k < row_count; k++)
            sum += weights[k] * widen(rows + offsets[k] + i);
        store(accumulator + i, sum);
    }
    for (; i < count; i++) {
        accumulator[i] = is_first ? 0 : accumulator[i];
        for (int k = 0; k < row_count; k++)
            accumulator[i] += weights[k] * (double)rows[offsets[k] + i];
    }
}

static float sum_row(const float *row, int count, double sum[3])
{
    enum { AT_ONCE = 3 * KI_LANES };
    double sums[AT_ONCE] = {0};
    float peaks[AT_ONCE] = {0};
    int i = 0;
    for (; i + KI_LANES <= count; i += KI_LANES, row += AT_ONCE)
        for (int j = 0; j < AT_ONCE; j++) {
            float value = fabsf(row[j]);
            sums[j] += (double)value;
            peaks[j] = value > peaks[j] ? value : peaks[j];
        }
    for (int j = 0; j < 3 * (count - i); j++) {
        float value = fabsf(row[j]);
        sums[j] += (double)value;
        peaks[j] = value > peaks[j] ? value : peaks[j];
    }
    float peak = 0;
    for (int c = 0; c < 3; c++)
        sum[c] = 0;
    for (int j = 0; j < AT_ONCE; j++) {
        sum[j % 3] += sums[j];
        peak = peaks[j] > peak ? peaks[j] : peak;
    }
    return peak;
}

// ---------------------------------------------------------------------------------------- Legendre

// Moves the recurrence of the functions q_{m+2k} (legendre.h) from one k to the next. `step` has the
// two coefficients of the step. Returns the next value, and keeps the present one in *before.
static inline vec next_even(const double *step, vec squared, vec now, vec *before)
{
    vec next = (squared - splat(step[0])) * now - splat(step[1]) * *before;
    *before = now;
    return next;
}

// Moves the recurrence by KI_BLOCK steps on vectors of rings where the functions are negligible.
static inline void skip_block(const double *steps, double *state, ptrdiff_t first, ptrdiff_t end)
{
    for (ptrdiff_t g = first; g < end; g++)
        for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
            double *st = state + 24 * g + h;
            vec now = load(st), before = load(st + 8), squared = load(st + 16);
            for (int k = 0; k < KI_BLOCK; k++)
                now = next_even(steps + 2 * k, squared, now, &before);
            store(st, now);
            store(st + 8, before);
        }
}

// Sums KI_BLOCK functions times the data of the latitude rings of some vectors, and moves the
// recurrence on. The function is not inlined, since GCC 12 does not keep all sums in registers
// otherwise.
__attribute__((noinline)) static void sum_block(const double *steps, const double *data,
                                                ptrdiff_t count, double *state,
                                                double sums[KI_BLOCK][2 * KI_COMPONENTS][4])
{
    for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
        vec acc[KI_BLOCK][2 * KI_COMPONENTS];
        for (int b = 0; b < KI_BLOCK; b++)
            for (int c = 0; c < 2 * KI_COMPONENTS; c++)
                acc[b][c] = splat(0);
        for (ptrdiff_t g = 0; g < count; g++) {
            double *st = state + 24 * g + h;
            const double *in = data + 96 * g + h;
            vec q0 = load(st), before = load(st + 8), squared = load(st + 16);
            vec q = next_even(steps, squared, q0, &before);
#if KI_BLOCK == 2
            vec q1 = q;
            q = next_even(steps + 2, squared, q1, &before);
#endif
            store(st, q);
            store(st + 8, before);
            for (ptrdiff_t c = 0; c < 2 * KI_COMPONENTS; c++) {
                vec value = load(in + 8 * c);
                acc[0][c] += q0 * value;
#if KI_BLOCK == 2
                acc[1][c] += q1 * value;
#endif
            }
        }
        for (int b = 0; b < KI_BLOCK; b++)
            for (int c = 0; c < 2 * KI_COMPONENTS; c++)
                fold_lanes(sums[b][c], h, acc[b][c]);
    }
}

// Does the work of the kernel `analyze` for a part of its vectors. The sums are added to `out`, or
// replace what it held with `is_first`.
static void analyze_part(const double *steps, int count, const double *data, const int *skip,
                         int first, int last, bool is_first, double *state, double *out)
{
    ptrdiff_t begin = last; // the first vector of rings where the functions are not negligible
    for (int k = 0; 2 * k < count; k += KI_BLOCK, steps += 2 * KI_BLOCK) {
        double sums[KI_BLOCK][2 * KI_COMPONENTS][4];
        while (begin > first && skip[begin - 1] <= k)
            begin--;
        skip_block(steps, state, first, begin);
        sum_block(steps, data + 96 * begin, last - begin, state + 24 * begin, sums);
        double *to = out + 2 * KI_COMPONENTS * k;
        for (int b = 0; b < KI_BLOCK && 2 * (k + b) < count; b++)
            for (int c = 0; c < 2 * KI_COMPONENTS; c += 4, to += 4) {
                double sum[4];
                sum_folded((const double(*)[4])sums[b] + c, sum);
                for (int i = 0; i < 4; i++)
                    to[i] = is_first ? sum[i] : to[i] + sum[i];
            }
    }
}

static void analyze(const double *steps, int count, const double *twice_cos, const double *start,
                    const double *data, const int *skip, int first, int last, double *state,
                    double *out)
{
    // Greatest number of vectors whose data and state, 960 bytes each, are read again and again for
    // one degree after the other: they fit in a first cache of 32 KiB.
    enum { MOST = 24 };
    for (ptrdiff_t g = first; g < last; g++)
        for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
            double *st = state + 24 * g + h;
            vec x = load(twice_cos + 8 * g + h);
            store(st, load(start + 8 * g + h));
            store(st + 8, splat(0));
            store(st + 16, x * x);
        }
    int parts = ki_max(1, (last - first + MOST - 1) / MOST), from = first;
    for (int part = 0; part < parts; part++) {
        int to = first + (last - first) * (part + 1) / parts;
        analyze_part(steps, count, data, skip, from, to, part == 0, state, out);
        from = to;
    }
}

// Number of vectors of rings that the synthesis sums in one loop, as many as the registers hold.
// Two hide the latency of the recurrence better than one.
enum { RING_VECTORS = KI_WIDTH == 8 ? 2 : 1 };

// Sums the products of the functions of one order and coefficients on RING_VECTORS * KI_WIDTH pairs
// of latitude rings, as the kernel `synthesize` of kernels.h does. All sums stay in registers. The
// function after the next is computed before the products with the present one, which do not wait
// for it.
static inline void synthesize_lanes(const double *steps, int count, const double *twice_cos,
                                    const double *start, const double *b, int skip,
                                    double *const out[RING_VECTORS])
{
    enum { N = RING_VECTORS, C = 2 * KI_COMPONENTS };
    vec squared[N], now[N], next[N], sums[N][C];
    for (ptrdiff_t n = 0; n < N; n++) {
        for (int c = 0; c < C; c++)
            sums[n][c] = splat(0);
        vec x = load(twice_cos + 8 * n), nothing = splat(0);
        squared[n] = x * x;
        now[n] = load(start + 8 * n);
        next[n] = next_even(steps, squared[n], now[n], &nothing);
    }
    int k = 0;
    for (; k < skip && 2 * k < count; k++, b += C) {
        steps += 2;
        for (int n = 0; n < N; n++)
            next[n] = next_even(steps, squared[n], next[n], &now[n]);
    }
    for (; 2 * k < count; k++, b += C) {
        steps += 2;
        for (int n = 0; n < N; n++) {
            vec q = now[n];
            next[n] = next_even(steps, squared[n], next[n], &now[n]);
            for (int c = 0; c < C; c++)
                sums[n][c] += q * splat(b[c]);
        }
    }
    for (ptrdiff_t n = 0; n < N; n++)
        for (ptrdiff_t c = 0; c < KI_COMPONENTS; c++) {
            store(out[n] + 8 * c, sums[n][c]);
            store(out[n] + 48 + 8 * c, sums[n][KI_COMPONENTS + c] * load(twice_cos + 8 * n));
        }
}

static void synthesize(const double *steps, int count, const double *twice_cos, const double *start,
                       const double *b, int skip, double *out0, double *out1)
{
#if KI_WIDTH == 8
    double *const out[2] = {out0, out1};
    synthesize_lanes(steps, count, twice_cos, start, b, skip, out);
#else
    for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
        double *const first[1] = {out0 + h}, *const second[1] = {out1 + h};
        synthesize_lanes(steps, count, twice_cos + h, start + h, b, skip, first);
        synthesize_lanes(steps, count, twice_cos + 8 + h, start + 8 + h, b, skip, second);
    }
#endif
}

static void split_orders(const double *z, int length, int degree, const double *column,
                         const double *twice_cos, const int *first, int vector, double *orders,
                         size_t pitch)
{
    for (int m = 0, i = 0; m <= degree; m++, i = i + 1 == length ? 0 : i + 1) {
        if (vector < first[m])
            continue;
        const double *p = z + 16 * (size_t)i, *q = z + 16 * (size_t)(i ? length - i : 0);
        double *even = orders + pitch * (size_t)m, *odd = even + 48;
        double fr = column[2 * (size_t)m] * 0.5, fi = column[2 * (size_t)m + 1] * 0.5;
        for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
            vec pr = load(p + h), pi = load(p + 8 + h), qr = load(q + h), qi = load(q + 8 + h);
            vec nr = pr + qr, ni = pi - qi, sr = pi + qi, si = qr - pr;
            vec er = nr + sr, ei = ni + si, dr = nr - sr, di = ni - si;
            store(even + h, er * fr - ei * fi);
            store(even + 8 + h, er * fi + ei * fr);
            vec x = load(twice_cos + h);
            store(odd + h, (dr * fr - di * fi) * x);
            store(odd + 8 + h, (dr * fi + di * fr) * x);
        }
    }
}

static void join_orders(const double *orders, size_t pitch, int degree, const int *first,
                        int vector, int length, double *buffer)
{
    // between the highest positive and the highest negative order
    memset(buffer + 16 * (size_t)(degree + 1), 0,
           16 * (size_t)(length - 2 * degree - 1) * sizeof *buffer);
    for (int m = 0; m <= degree; m++) {
        double *plus = buffer + 16 * (size_t)m, *minus = buffer + 16 * (size_t)(m ? length - m : 0);
        if (vector < first[m]) {
            memset(plus, 0, 16 * sizeof *buffer);
            memset(minus, 0, 16 * sizeof *buffer);
            continue;
        }
        const double *even = orders + pitch * (size_t)m, *odd = even + 48;
        for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
            vec er = load(even + h), ei = load(even + 8 + h), dr = load(odd + h),
                di = load(odd + 8 + h);
            vec nr = er + dr, ni = ei + di, sr = er - dr, si = ei - di;
            if (m == 0) {
                store(plus + h, sr);
                store(plus + 8 + h, nr);
                continue;
            }
            store(plus + h, ni + sr);
            store(plus + 8 + h, nr - si);
            store(minus + h, sr - ni);
            store(minus + 8 + h, nr + si);
        }
    }
}

static void sum_orders(const double *orders, size_t pitch, int count, const double *cosine,
                       const double *sine, const double *sign, double *rgb)
{
    for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
        vec c = load(cosine + h), s = load(sine + h), side = load(sign + h);
        vec re = splat(1), im = splat(0), sums[3];
        for (ptrdiff_t k = 0; k < 3; k++)
            sums[k] = (load(orders + 16 * k + h) + side * load(orders + 48 + 16 * k + h)) * 0.5;
        for (int m = 1; m < count; m++) {
            const double *even = orders + pitch * (size_t)m + h, *odd = even + 48;
            vec turned = re * c - im * s;
            im = re * s + im * c;
            re = turned;
            for (ptrdiff_t k = 0; k < 3; k++) {
                vec a = load(even + 16 * k) + side * load(odd + 16 * k);
                vec b = load(even + 16 * k + 8) + side * load(odd + 16 * k + 8);
                sums[k] += a * re - b * im;
            }
        }
        for (ptrdiff_t k = 0; k < 3; k++)
            store(rgb + 8 * k + h, sums[k] * 2.0);
    }
}

// ----------------------------------------------------------------------------------------- texels

enum { TAP_VECTORS = KI_TAPS / FLOATS }; // number of native vectors of eight weights

// Interpolates the eight weights at a fraction in [0, 1] of the way between two grid points,
// linearly between two entries of the table that ki_taps_design wrote.
static inline void taps_at(const float *table, double fraction, floats taps[TAP_VECTORS])
{
    double at = fraction * KI_TAP_STEPS;
    int step = (int)at;
    float t = (float)(at - step);
    const float *a = table + KI_TAPS * (ptrdiff_t)step, *b = a + KI_TAPS;
    for (ptrdiff_t i = 0; i < TAP_VECTORS; i++) {
        floats low = load_floats(a + FLOATS * i);
        taps[i] = low + t * (load_floats(b + FLOATS * i) - low);
    }
}

static inline float sum_taps(const floats v[TAP_VECTORS])
{
#if KI_WIDTH == 1
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
#else
    typedef float four_floats __attribute__((vector_size(16), may_alias));
    four_floats half[2];
    memcpy(half, v, sizeof half);
    four_floats sum = half[0] + half[1];
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
#endif
}

// The next row of texels on a side of a cube needs rings that no texel has needed before, about two
// rings further south. They are fetched to the cache ahead of time. The address may lie behind the
// grid, where nothing is read, so it is computed as an integer.
static void interpolate(const float *grid, size_t plane, size_t pitch, const float *ring_taps,
                        const float *column_taps, const double *position, int count, float *rgb)
{
    for (int i = 0; i < count; i++, position += 2) {
        size_t ring = (size_t)position[0], column = (size_t)position[1];
        floats along[TAP_VECTORS], across[TAP_VECTORS], sum[TAP_VECTORS];
        float weight[KI_TAPS];
        taps_at(ring_taps, position[0] - (double)ring, across);
        taps_at(column_taps, position[1] - (double)column, along);
        memcpy(weight, across, sizeof weight);
        const float *corner = grid + ring * pitch + column;
        for (int c = 0; c < 3; c++, corner += plane) {
            size_t ahead = ((KI_TAPS + 1) * pitch + KI_TAPS / 2) * sizeof *corner;
            __builtin_prefetch((const void *)((uintptr_t)corner + ahead));
            for (ptrdiff_t h = 0; h < TAP_VECTORS; h++) {
                const float *p = corner + FLOATS * h;
                sum[h] = load_floats(p) * weight[0];
                for (int k = 1; k < KI_TAPS; k++)
                    sum[h] += load_floats(p + (size_t)k * pitch) * weight[k];
                sum[h] *= along[h];
            }
            rgb[3 * i + c] += sum_taps(sum);
        }
    }
}

static inline vec versine(const double *directions, int h, const double *p)
{
    vec x = load(directions + h) - p[0], y = load(directions + 8 + h) - p[1],
        z = load(directions + 16 + h) - p[2];
    return ((x * x + y * y) + z * z) * 0.5;
}

// Adds the light of `count` points through a GGX lobe of alpha^2 = a2, for eight directions. Every
// lane runs the same arithmetic.
static inline void add_points(double a2, const double *directions, const double (*points)[6],
                              int count, double *sum)
{
    double half_b = 0.5 * (1 - a2);
    for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
        vec red = load(sum + h), green = load(sum + 8 + h), blue = load(sum + 16 + h);
        for (int i = 0; i < count; i++) {
            vec v = versine(directions, h, points[i]);
            vec ratio = a2 / (a2 + v * half_b);
            vec weight = positive(1 - v) * (ratio * ratio);
            red += weight * points[i][3];
            green += weight * points[i][4];
            blue += weight * points[i][5];
        }
        store(sum + h, red);
        store(sum + 8 + h, green);
        store(sum + 16 + h, blue);
    }
}

// A ball that holds the eight unit directions of a call. The cosine of the angle from any of them to
// a sun differs from the scalar product of the sun's direction and `centre` by at most `radius`.
typedef struct bound {
    double centre[3], radius;
} bound;

static inline bound bound_directions(const double *directions)
{
    bound b;
    double squared = 0;
    for (ptrdiff_t k = 0; k < 3; k++)
        b.centre[k] = sum_lanes(directions + 8 * k) / KI_LANES;
    for (ptrdiff_t j = 0; j < KI_LANES; j++) {
        double x = directions[j] - b.centre[0], y = directions[8 + j] - b.centre[1],
               z = directions[16 + j] - b.centre[2], distance = x * x + y * y + z * z;
        squared = distance > squared ? distance : squared;
    }
    // The second term is greater than the rounding errors of the cosines that are compared.
    b.radius = sqrt(squared) + 1e-12;
    return b;
}

// Chooses the points that represent a sun for eight directions, as kernels.h describes. Returns
// their number. Most suns lie far from the bound of the directions, on one side of the horizon, and
// need no distance for each direction.
static inline int choose_points(const ki_sun_points *suns, int i, const double *directions,
                                const bound *b, const double (**points)[6])
{
    size_t sun = (size_t)i;
    const double *centre = suns->centre[i];
    double cosine = centre[0] * b->centre[0] + centre[1] * b->centre[1] + centre[2] * b->centre[2];
    double surely = 1 - cosine - b->radius; // no direction is nearer
    *points = (const double(*)[6])suns->centre + sun;
    if (cosine + b->radius <= -suns->horizon)
        return 0;
    if (cosine - b->radius >= suns->horizon && surely >= suns->far_versine &&
        surely >= suns->near_versine && surely >= suns->close_versine)
        return 1;
    vec least = splat(4), least_above = splat(4);
    for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
        vec distance = versine(directions, h, centre), below = 1 - distance;
        least = lesser(distance, least);
        least_above = lesser(positive(below) + positive(-below), least_above);
    }
    double distances[KI_WIDTH], above[KI_WIDTH], nearest = 4, edge = 4;
    store(distances, least);
    store(above, least_above);
    for (int j = 0; j < KI_WIDTH; j++) {
        nearest = distances[j] < nearest ? distances[j] : nearest;
        edge = above[j] < edge ? above[j] : edge;
    }
    if (nearest >= 1 + suns->horizon)
        return 0;
    if (nearest < suns->close_versine) {
        *points = (const double(*)[6])suns->close + (size_t)suns->close_count * sun;
        return suns->close_count;
    }
    bool across = edge < suns->horizon;
    if ((across && !suns->few_across) || nearest < suns->near_versine) {
        *points = (const double(*)[6])suns->near + (size_t)suns->near_count * sun;
        return suns->near_count;
    }
    if (!across && !(nearest < suns->far_versine))
        return 1;
    *points = (const double(*)[6])suns->pairs + 4 * sun;
    return 4;
}

static void suns_ggx(const ki_sun_points *suns, double alpha, const double *directions, double *sum)
{
    bound b = bound_directions(directions);
    for (int i = 0; i < suns->count; i++) {
        const double(*points)[6];
        int count = choose_points(suns, i, directions, &b, &points);
        add_points(alpha * alpha, directions, points, count, sum);
    }
}

#if KI_WIDTH >= 4
// Loads four cubics, and sets c[k] to the coefficients k of all of them.
static inline void load_four_cubics(const double (*cubics)[4], const int64_t *row, four c[4])
{
    four r0 = load_four(cubics[row[0]]), r1 = load_four(cubics[row[1]]);
    four r2 = load_four(cubics[row[2]]), r3 = load_four(cubics[row[3]]);
    four even01 = KI_SHUFFLE_DOUBLES4(r0, r1, 0, 4, 2, 6);
    four even23 = KI_SHUFFLE_DOUBLES4(r2, r3, 0, 4, 2, 6);
    four odd01 = KI_SHUFFLE_DOUBLES4(r0, r1, 1, 5, 3, 7);
    four odd23 = KI_SHUFFLE_DOUBLES4(r2, r3, 1, 5, 3, 7);
    c[0] = KI_SHUFFLE_DOUBLES4(even01, even23, 0, 1, 4, 5);
    c[1] = KI_SHUFFLE_DOUBLES4(odd01, odd23, 0, 1, 4, 5);
    c[2] = KI_SHUFFLE_DOUBLES4(even01, even23, 2, 3, 6, 7);
    c[3] = KI_SHUFFLE_DOUBLES4(odd01, odd23, 2, 3, 6, 7);
}
#endif

// Loads the cubic row[j] for each lane j, and sets c[k] to the coefficients k of all lanes. Each
// cubic is loaded whole, with fewer instructions than loading each coefficient by itself.
static inline void load_cubics(const double (*cubics)[4], const int64_t *row, vec c[4])
{
#if KI_WIDTH == 1
    for (int k = 0; k < 4; k++)
        c[k] = cubics[row[0]][k];
#elif KI_WIDTH == 2
    for (int k = 0; k < 4; k += 2) {
        vec a = load(cubics[row[0]] + k), b = load(cubics[row[1]] + k);
        c[k] = KI_SHUFFLE_DOUBLES2(a, b, 0, 2);
        c[k + 1] = KI_SHUFFLE_DOUBLES2(a, b, 1, 3);
    }
#elif KI_WIDTH == 4
    load_four_cubics(cubics, row, c);
#else
    four low[4], high[4];
    load_four_cubics(cubics, row, low);
    load_four_cubics(cubics, row + 4, high);
    for (int k = 0; k < 4; k++)
        c[k] = (vec)KI_JOIN_DOUBLES4(low[k], high[k]);
#endif
}

// Returns the weight of a mixture where 1 - cos of the angle is v: ki_mixture_weight in each lane.
// The argument t of the cubics is found from the bits of a number in [1, 2), since few instruction
// sets convert integers of 64 bits to doubles.
static inline vec mixture_weight(const ki_mixture *mixture, vec v)
{
    const int rest = 52 - KI_MIXTURE_STEP_BITS;
    const int64_t first = (int64_t)(1023 + KI_MIXTURE_FIRST) << KI_MIXTURE_STEP_BITS;
    const int64_t low = (INT64_C(1) << rest) - 1, one = INT64_C(1023) << 52;
    int64_t index[KI_WIDTH];
#if KI_WIDTH == 1
    typedef int64_t mask;
    vec x = (v < 1 ? v : 0) + 0x1p-20, t;
    mask bits;
    memcpy(&bits, &x, sizeof bits);
#else
    vec x = (vec)((mask)v & (mask)(v < 1)) + 0x1p-20, t;
    mask bits = (mask)x;
#endif
    mask row = (bits >> rest) - first, argument = ((bits & low) << KI_MIXTURE_STEP_BITS) | one;
    memcpy(index, &row, sizeof index);
    memcpy(&t, &argument, sizeof t);
    t -= 1;
    vec c[4];
    load_cubics(mixture->cubic, index, c);
    return positive(1 - v) * (c[0] + t * (c[1] + t * (c[2] + t * c[3])));
}

static void suns_mixture(const ki_sun_points *suns, const ki_mixture *mixture,
                         const double *directions, double *sum)
{
    bound b = bound_directions(directions);
    for (int i = 0; i < suns->count; i++) {
        const double(*points)[6];
        int count = choose_points(suns, i, directions, &b, &points);
        for (int h = 0; h < KI_LANES; h += KI_WIDTH) {
            vec red = load(sum + h), green = load(sum + 8 + h), blue = load(sum + 16 + h);
            for (int n = 0; n < count; n++) {
                vec weight = mixture_weight(mixture, versine(directions, h, points[n]));
                red += weight * points[n][3];
                green += weight * points[n][4];
                blue += weight * points[n][5];
            }
            store(sum + h, red);
            store(sum + 8 + h, green);
            store(sum + 16 + h, blue);
        }
    }
}

// Sums are taken in four lanes on every instruction set: lane j has the nodes i with i % 4 = j.
static void sum_degrees(const double *x, const double *w, ptrdiff_t count, int l, double *p0,
                        double *p1, double sums[KI_DEGREES])
{
#if KI_WIDTH > 4
    typedef double part __attribute__((vector_size(32), may_alias));
#else
    typedef vec part;
#endif
    enum { LANES = 4, STEP = KI_WIDTH > 4 ? 4 : KI_WIDTH };
    double a[KI_DEGREES], b[KI_DEGREES], lanes[KI_DEGREES][LANES];
    for (int k = 0; k < KI_DEGREES; k++) {
        a[k] = (2 * (l + k) + 1.0) / (l + k + 1);
        b[k] = (double)(l + k) / (l + k + 1);
    }
    for (ptrdiff_t h = 0; h < LANES; h += STEP) {
        part sum[KI_DEGREES];
        memset(sum, 0, sizeof sum);
        for (ptrdiff_t i = h; i < count; i += LANES) {
            part cosine, weight, before, now;
            memcpy(&cosine, x + i, sizeof cosine);
            memcpy(&weight, w + i, sizeof weight);
            memcpy(&before, p0 + i, sizeof before);
            memcpy(&now, p1 + i, sizeof now);
            for (int k = 0; k < KI_DEGREES; k++) {
                part next = a[k] * cosine * now - b[k] * before;
                sum[k] += weight * now;
                before = now;
                now = next;
            }
            memcpy(p0 + i, &before, sizeof before);
            memcpy(p1 + i, &now, sizeof now);
        }
        for (int k = 0; k < KI_DEGREES; k++)
            memcpy(&lanes[k][h], &sum[k], sizeof sum[k]);
    }
    for (int k = 0; k < KI_DEGREES; k++)
        sums[k] = (lanes[k][0] + lanes[k][2]) + (lanes[k][1] + lanes[k][3]);
}

const ki_kernels KI_TABLE = {fft,         add_weighted, sum_row,      split_orders,
                             join_orders, analyze,      synthesize,   sum_orders,
                             interpolate, suns_ggx,     suns_mixture, sum_degrees};
