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

// NODES: number of quadrature nodes over the height of a texel. VECTOR_ROWS: number of rows of suns
// whose nodes are the lanes of a vector, as latitude rings are in an analysis. VECTOR_SIZE: number of
// doubles that are stored for a vector: in each lane the sine of theta, 2 cos theta, and the node's
// weight times the solid angle and sin^m theta of the order m that comes next; then twelve data of the
// kernel `analyze` and its state of three.
enum {
    NODES = 4,
    VECTOR_ROWS = KI_LANES / NODES,
    VECTOR_SIZE = (3 + 2 * KI_COMPONENTS + 3) * KI_LANES
};

// The suns of one row of the panorama, from `first` to before `end`.
typedef struct sun_row {
    int first, end;
} sun_row;

// The rows that hold suns, and what one order needs.
typedef struct order {
    sun_row *rows;
    int row_count, vector_count;
    double *vectors;                                 // what is stored for all vectors
    double *sine, *twice_cos, *start, *data, *state; // the parts of `vectors`
    int *skip;                 // zeros for the kernel `analyze`, which then leaves no function out
    double first_scale;        // the scale of the order's first degree
    double *f, *scale, *steps; // coefficients of the recurrence
    double *row, *sums;        // coefficients a_lm of the order, and those of the suns
} order;

static void destroy_order(order *o)
{
    ki_free(o->rows);
    ki_free(o->vectors);
    ki_free(o->skip);
    ki_free(o->f);
    ki_free(o->row);
    *o = (order){0};
}

// Finds the rows that hold suns. The list of suns is sorted by row.
static void find_rows(const kiln_spectrum *s, order *o)
{
    for (int i = 0; i < s->sun_count; i++) {
        if (i == 0 || s->suns[i].row != s->suns[i - 1].row)
            o->rows[o->row_count++].first = i;
        o->rows[o->row_count - 1].end = i + 1;
    }
    o->vector_count = (o->row_count + VECTOR_ROWS - 1) / VECTOR_ROWS;
}

// Places the quadrature nodes of all rows. The lanes of a row that is missing in the last vector stay
// 0.
static void place_nodes(const kiln_spectrum *s, order *o)
{
    double step = KI_PI / s->size, x[NODES], weights[NODES];
    ki_gauss_legendre(NODES, x, weights);
    for (int i = 0; i < NODES * o->row_count; i++) {
        int row = s->suns[o->rows[i / NODES].first].row, n = i % NODES;
        double cosine;
        ki_sincos(step * (row + 0.5 + 0.5 * x[n]), &o->sine[i], &cosine);
        o->twice_cos[i] = 2 * cosine;
        o->start[i] = step * step * 0.5 * weights[n] * o->sine[i];
    }
}

static bool create_order(const kiln_spectrum *s, int degree, order *o)
{
    kiln_context *context = s->context;
    size_t count = (size_t)degree + 1 + KI_LEGENDRE_PADDING, suns = (size_t)s->sun_count;
    *o = (order){.rows = ki_alloc(context, suns, sizeof *o->rows),
                 .f = ki_alloc_raw(context, 3 * count, sizeof *o->f),
                 .row = ki_alloc_raw(context, 2 * KI_COMPONENTS * count, sizeof *o->row)};
    if (!o->rows || !o->f || !o->row)
        return false;
    find_rows(s, o);
    size_t vectors = (size_t)o->vector_count, lanes = vectors * KI_LANES;
    o->vectors = ki_alloc(context, vectors, VECTOR_SIZE * sizeof *o->vectors);
    o->skip = ki_alloc(context, vectors, sizeof *o->skip);
    if (!o->vectors || !o->skip)
        return false;
    o->scale = o->f + count;
    o->steps = o->scale + count;
    o->sums = o->row + KI_COMPONENTS * count;
    o->sine = o->vectors;
    o->twice_cos = o->sine + lanes;
    o->start = o->twice_cos + lanes;
    o->data = o->start + lanes;
    o->state = o->data + 2 * KI_COMPONENTS * lanes;
    place_nodes(s, o);
    return true;
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

// Adds the suns' harmonics of order m up to `degree` to `out`, and makes the nodes ready for the order
// m + 1. The kernel multiplies the light by q_l of legendre.h, which is linear in q_m and therefore
// carries the nodes' weights.
static void add_suns(const kiln_spectrum *s, order *o, int m, int degree, double *out)
{
    ki_legendre_steps(degree, m, o->f, o->steps);
    for (size_t r = 0; r < (size_t)o->row_count; r++) {
        double light[KI_COMPONENTS];
        size_t vector = r / VECTOR_ROWS;
        sum_light(s, &o->rows[r], m, light);
        for (size_t i = NODES * r; i < NODES * (r + 1); i++)
            for (size_t c = 0; c < KI_COMPONENTS; c++) {
                double *to = o->data + KI_LANES * (2 * KI_COMPONENTS * vector + c) + i % KI_LANES;
                to[0] = light[c];
                to[KI_COMPONENTS * KI_LANES] = light[c] * o->twice_cos[i];
            }
    }
    int count = degree - m + 1;
    ki_sphere_kernels(s->context)
        ->analyze(o->steps, count, o->twice_cos, o->start, o->data, o->skip, 0, o->vector_count,
                  o->state, o->sums);
    ki_legendre_part_odd(degree, m, o->sums);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < KI_COMPONENTS; c++)
            out[KI_COMPONENTS * i + c] += o->sums[KI_COMPONENTS * i + c] * o->scale[i];
    for (int i = 0; i < NODES * o->row_count; i++) {
        double next = o->start[i] * o->sine[i];
        // Smaller numbers are far below a rounding error at every degree, and denormal ones are slow.
        o->start[i] = next > 1e-280 ? next : 0;
    }
}

kiln_result ki_spectrum_add_suns(const kiln_spectrum *spectrum, int degree, double *a,
                                 kiln_error *error)
{
    order o;
    bool good = create_order(spectrum, degree, &o);
    for (int m = 0; m <= degree && good && spectrum->sun_count; m++) {
        ki_legendre_order(degree, m, &o.first_scale, o.f, o.scale);
        add_suns(spectrum, &o, m, degree, a + ki_coefficient_row(degree, m));
    }
    destroy_order(&o);
    return good ? KILN_OK
                : ki_fail_memory(spectrum->context, error, "the suns' coefficients",
                                 ki_suns_power_size((size_t)spectrum->sun_count));
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
    bool good = create_order(spectrum, degree, &o);
    int known = ki_min(degree, spectrum->degree);
    memset(calm, 0, size);
    memset(all, 0, size);
    for (int m = 0; m <= degree && good; m++) {
        memset(o.row, 0, KI_COMPONENTS * ((size_t)(degree - m) + 1) * sizeof *o.row);
        if (m <= known)
            memcpy(o.row, spectrum->a + ki_coefficient_row(spectrum->degree, m),
                   KI_COMPONENTS * ((size_t)(known - m) + 1) * sizeof *o.row);
        add_squares(o.row, m, known, calm);
        ki_legendre_order(degree, m, &o.first_scale, o.f, o.scale);
        if (spectrum->sun_count)
            add_suns(spectrum, &o, m, degree, o.row);
        add_squares(o.row, m, degree, all);
    }
    destroy_order(&o);
    return good ? KILN_OK
                : ki_fail_memory(spectrum->context, error, "a spectrum's power",
                                 ((size_t)degree + 1) * KI_COMPONENTS * sizeof *o.row);
}

size_t ki_suns_power_size(size_t count)
{
    size_t vectors = (count + VECTOR_ROWS - 1) / VECTOR_ROWS;
    return ki_block_size(count, sizeof(sun_row)) +
           ki_block_size(vectors, VECTOR_SIZE * sizeof(double)) +
           ki_block_size(vectors, sizeof(int));
}
