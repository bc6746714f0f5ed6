// The harmonics of a spectrum's suns, and the power of each degree with the suns and without them.
// In: a spectrum and its list of suns. Out: coefficients, or sums of their squares. Method: the
// harmonics of a sun are integrated by Gauss quadrature over the height of the sun's texel, and
// exactly over its width. Suns in one row of the panorama have the Legendre functions in common, so
// that their light is summed before it is multiplied by these. Orders are handled one after the
// other, so that the coefficients of one order need to be stored only.
#include "sphere/spectrum.h"

#include "math/math.h"
#include "sphere/kernels.h"

#include <string.h>

enum { NODES = 4 }; // quadrature nodes over the height of a texel

// The suns of one row of the panorama, from `first` to before `end`, and the quadrature nodes over
// the height of the row. `start` is the node's weight times the solid angle and sin^m theta of the
// order m that comes next.
typedef struct sun_row {
    int first, end;
    double sine[NODES], twice_cos[NODES], start[NODES];
} sun_row;

// Returns the rows that hold suns, and sets *count to their number. The list of suns is sorted by
// row.
static sun_row *place_nodes(const kiln_spectrum *s, int *count)
{
    sun_row *all = ki_alloc_raw(s->context, (size_t)s->sun_count, sizeof *all);
    double step = KI_PI / s->size, x[NODES], weights[NODES];
    ki_gauss_legendre(NODES, x, weights);
    *count = 0;
    for (int i = 0; i < s->sun_count && all; i++) {
        sun_row *row = &all[*count];
        if (i == 0 || s->suns[i].row != s->suns[i - 1].row) {
            row->first = i;
            for (int n = 0; n < NODES; n++) {
                double sine, cosine;
                ki_sincos(step * (s->suns[i].row + 0.5 + 0.5 * x[n]), &sine, &cosine);
                row->sine[n] = sine;
                row->twice_cos[n] = 2 * cosine;
                row->start[n] = step * step * 0.5 * weights[n] * sine;
            }
        }
        row->end = i + 1;
        if (i + 1 == s->sun_count || s->suns[i + 1].row != s->suns[i].row)
            ++*count;
    }
    return all;
}

// Adds the light of a row of suns at `count` degrees of one order. `light` has the real and
// imaginary part of each channel's radiance, turned to the suns' longitudes. q_l of legendre.h is
// linear in q_m, so that its recurrence carries the nodes' weights.
static void add_order(const sun_row *nodes, const double light[KI_COMPONENTS], int count,
                      const double *f, const double *scale, double *out)
{
    double q[NODES], before[NODES] = {0};
    memcpy(q, nodes->start, sizeof q);
    for (int l = 0; l < count; l++, out += KI_COMPONENTS) {
        double p = ((q[0] + q[1]) + (q[2] + q[3])) * scale[l];
        for (int n = 0; n < NODES; n++) {
            double next = nodes->twice_cos[n] * q[n] - f[l + 1] * before[n];
            before[n] = q[n];
            q[n] = next;
        }
        for (int c = 0; c < KI_COMPONENTS; c++)
            out[c] += p * light[c];
    }
}

// Sums the light of a row of suns in order m: the real and imaginary part of each channel's
// radiance, averaged over the width of the texels.
static void sum_light(const kiln_spectrum *s, const sun_row *row, int m,
                      double light[KI_COMPONENTS])
{
    double step = KI_PI / s->size, half = m * step / 2, width = m ? ki_sin(half) / half : 1;
    memset(light, 0, KI_COMPONENTS * sizeof *light);
    for (int i = row->first; i < row->end; i++) {
        const ki_sun *sun = &s->suns[i];
        double re, im;
        ki_sincos(-(sun->column + 0.5) * m * step, &im, &re);
        for (size_t c = 0; c < 3; c++) {
            light[2 * c] += re * width * (double)sun->radiance[c];
            light[2 * c + 1] += im * width * (double)sun->radiance[c];
        }
    }
}

// Adds the suns' harmonics of order m, of `count` degrees from m on, to `out`, and makes the nodes
// ready for the order m + 1.
static void add_suns(const kiln_spectrum *s, sun_row *rows, int row_count, int m, int count,
                     const double *f, const double *scale, double *out)
{
    for (sun_row *row = rows; row < rows + row_count; row++) {
        double light[KI_COMPONENTS], most = 0;
        sum_light(s, row, m, light);
        add_order(row, light, count, f, scale, out);
        for (int n = 0; n < NODES; n++) {
            row->start[n] *= row->sine[n];
            most = most > row->start[n] ? most : row->start[n];
        }
        if (most <
            1e-280) // far below a rounding error at every degree, and slow as denormal numbers
            memset(row->start, 0, sizeof row->start);
    }
}

// What one order needs: the recurrence's coefficients, and the coefficients a_lm of the order.
typedef struct order {
    double start; // scale of the order's first degree
    double *f, *scale, *row;
} order;

static bool create_order(kiln_context *context, int degree, order *o)
{
    size_t count = (size_t)degree + 1 + KI_LEGENDRE_PADDING;
    *o = (order){.f = ki_alloc_raw(context, 2 * count, sizeof *o->f),
                 .row = ki_alloc_raw(context, KI_COMPONENTS * count, sizeof *o->row)};
    o->scale = o->f ? o->f + count : NULL;
    return o->f && o->row;
}

static void destroy_order(order *o)
{
    ki_free(o->f);
    ki_free(o->row);
}

kiln_result ki_spectrum_add_suns(const kiln_spectrum *spectrum, int degree, double *a,
                                 kiln_error *error)
{
    order o;
    bool good = create_order(spectrum->context, degree, &o);
    int row_count;
    sun_row *rows = place_nodes(spectrum, &row_count);
    for (int m = 0; m <= degree && good && rows; m++) {
        ki_legendre_order(degree, m, &o.start, o.f, o.scale);
        add_suns(spectrum, rows, row_count, m, degree - m + 1, o.f, o.scale,
                 a + ki_coefficient_row(degree, m));
    }
    good = good && rows;
    destroy_order(&o);
    ki_free(rows);
    return good ? KILN_OK
                : ki_fail_memory(spectrum->context, error, "the suns' coefficients",
                                 (size_t)spectrum->sun_count * sizeof *rows);
}

// Adds to power[l], for the degrees of order m, the squares of the coefficients in `row`.
// Coefficients of the orders m > 0 stand for those of order -m too.
static void add_squares(const double *row, int m, int degree, double (*power)[3])
{
    for (int l = m; l <= degree; l++, row += KI_COMPONENTS)
        for (size_t c = 0; c < 3; c++)
            power[l][c] +=
                (m ? 2 : 1) * (row[2 * c] * row[2 * c] + row[2 * c + 1] * row[2 * c + 1]);
}

kiln_result ki_spectrum_power(const kiln_spectrum *spectrum, int degree, double (*calm)[3],
                              double (*all)[3], kiln_error *error)
{
    order o;
    size_t size = ((size_t)degree + 1) * sizeof *all;
    bool good = create_order(spectrum->context, degree, &o);
    int row_count;
    sun_row *rows = place_nodes(spectrum, &row_count);
    int known = ki_min(degree, spectrum->degree);
    memset(calm, 0, size);
    memset(all, 0, size);
    for (int m = 0; m <= degree && good && rows; m++) {
        memset(o.row, 0, KI_COMPONENTS * ((size_t)(degree - m) + 1) * sizeof *o.row);
        if (m <= known)
            memcpy(o.row, spectrum->a + ki_coefficient_row(spectrum->degree, m),
                   KI_COMPONENTS * ((size_t)(known - m) + 1) * sizeof *o.row);
        add_squares(o.row, m, known, calm);
        ki_legendre_order(degree, m, &o.start, o.f, o.scale);
        if (spectrum->sun_count)
            add_suns(spectrum, rows, row_count, m, degree - m + 1, o.f, o.scale, o.row);
        add_squares(o.row, m, degree, all);
    }
    good = good && rows;
    destroy_order(&o);
    ki_free(rows);
    return good ? KILN_OK
                : ki_fail_memory(spectrum->context, error, "a spectrum's power",
                                 ((size_t)degree + 1) * KI_COMPONENTS * sizeof *o.row);
}

size_t ki_suns_power_size(size_t count)
{
    return ki_block_size(count, sizeof(sun_row));
}
