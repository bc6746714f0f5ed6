// The spectrum of a lobe (docs/theory/spectral.md). In: a lobe, whole or with its centre left out,
// a tolerance and the highest degree. Out: its Legendre coefficients k_l divided by the lobe's
// integral, and the degree at which the coefficients may be cut off. Method: Gauss-Legendre
// quadrature over panels of theta that are narrow where the lobe is, with P_l by its recurrence in
// l.
#include "sphere/zonal.h"

#include "math/math.h"
#include "sphere/kernels.h"
#include "sphere/lobe.h"

#include <math.h>

const double ki_lobe_tolerance = 1.5e-4;

enum { PANEL_NODES = 24 };

double ki_zonal_step(const ki_zonal *zonal, double one_minus_cos)
{
    if (zonal->outer <= 0)
        return 1;
    // theta = 2 asin(sqrt((1 - cos theta) / 2)). The step is a polynomial in t of degree 13 that
    // rises from 0 to 1, with six derivatives that are 0 at both ends.
    double theta = 2 * ki_asin(sqrt(ki_clamp(0.5 * one_minus_cos, 0, 1)));
    double t = ki_clamp((theta - zonal->inner) / (zonal->outer - zonal->inner), 0, 1);
    double t2 = t * t, t4 = t2 * t2;
    return t4 * t2 * t *
           (1716 - t * (9009 - t * (20020 - t * (24024 - t * (16380 - t * (6006 - t * 924))))));
}

double ki_zonal_weight(const ki_zonal *zonal, double one_minus_cos)
{
    if (zonal->mixture)
        return ki_mixture_weight(zonal->mixture, one_minus_cos);
    double step = ki_zonal_step(zonal, one_minus_cos);
    return step > 0 ? step * ki_lobe_weight(&zonal->lobe, one_minus_cos) : 0;
}

// Panels of theta for quadrature, whose lengths double from a sixteenth of the lobe's width up to
// pi. A panel ends at pi / 2, where lobes have a kink, and where the step that leaves out the
// lobe's centre begins and ends. No panel is longer than `longest`, which is short enough for
// PANEL_NODES Gauss nodes to integrate the Legendre polynomial of the highest degree.
typedef struct panels {
    double longest;
    double *edges;
    int count, room;
} panels;

static void add_panels(panels *p, double from, double to)
{
    int pieces = (int)ceil((to - from) / p->longest);
    for (int i = 1; i <= pieces; i++) {
        if (p->edges)
            p->edges[p->count] = i == pieces ? to : from + (to - from) * i / pieces;
        p->count++;
    }
}

static void make_panels(panels *p, const ki_zonal *zonal, double width)
{
    double cuts[] = {zonal->inner, zonal->outer, KI_PI / 2, KI_PI};
    if (p->edges)
        p->edges[0] = 0;
    p->count = 1;
    double at = 0, next = width / 16;
    while (at < KI_PI) {
        double to = next < KI_PI ? next : KI_PI;
        for (int i = 0; i < 4; i++)
            if (cuts[i] > at && cuts[i] < to)
                to = cuts[i];
        add_panels(p, at, to);
        at = to;
        if (at >= next)
            next *= 2;
    }
}

kiln_result ki_zonal_analyze(kiln_context *context, const ki_zonal *zonal, double tolerance,
                             int limit, ki_zonal_spectrum *spectrum, kiln_error *error)
{
    kiln_result result = KILN_OK;
    const ki_kernels *kernels = ki_sphere_kernels(context);
    *spectrum = (ki_zonal_spectrum){0};
    double rule[PANEL_NODES], rule_weights[PANEL_NODES];
    ki_gauss_legendre(PANEL_NODES, rule, rule_weights);

    panels p = {.longest = 16.0 / limit};
    if (zonal->outer > 0 && p.longest > (zonal->outer - zonal->inner) / 2)
        p.longest = (zonal->outer - zonal->inner) / 2;
    double width = ki_clamp(ki_lobe_width(&zonal->lobe), 1e-7, 1);
    make_panels(&p, zonal, width);
    size_t count = (size_t)(p.count - 1) * PANEL_NODES;
    double *nodes = ki_alloc_raw(context, count, 4 * sizeof *nodes);
    p.edges = ki_alloc_raw(context, (size_t)p.count, sizeof *p.edges);
    spectrum->k = ki_alloc(context, (size_t)limit + 1, sizeof *spectrum->k);
    if (!nodes || !p.edges || !spectrum->k) {
        result = ki_fail_memory(context, error, "a lobe's spectrum", 4 * count * sizeof *nodes);
        goto done;
    }
    make_panels(&p, zonal, width);

    // Arrays over the quadrature nodes: x = cos theta, w = weight of the lobe times solid angle,
    // and the Legendre polynomials P_{l-1} and P_l of x.
    double *x = nodes, *w = x + count, *p0 = w + count, *p1 = p0 + count;
    double whole = 0, sum = 0, squares = 0;
    size_t n = 0;
    for (int i = 0; i + 1 < p.count; i++) {
        double half = (p.edges[i + 1] - p.edges[i]) / 2;
        for (int j = 0; j < PANEL_NODES; j++, n++) {
            double sine, cosine, theta = p.edges[i] + half * (1 + rule[j]);
            ki_sincos(theta / 2, &sine, &cosine);
            double versine = 2 * sine * sine, solid = 2 * KI_PI * 2 * sine * cosine * half;
            double lobe = ki_lobe_weight(&zonal->lobe, versine);
            double weight = lobe * ki_zonal_step(zonal, versine);
            solid *= rule_weights[j];
            x[n] = 1 - versine;
            w[n] = weight * solid;
            p0[n] = 1;
            p1[n] = x[n];
            whole += lobe * solid;
            sum += w[n];
            squares += weight * weight * solid;
        }
    }
    if (!(whole > 0 && whole < 1e300 && squares < 1e300)) {
        result = ki_fail(error, KILN_ERROR_ARGUMENT,
                         "the lobe's integral is %g, it must be positive and finite", whole);
        goto done;
    }
    spectrum->integral = whole;
    spectrum->k[0] = sum / whole;

    // By Parseval, the integral of the squared weight is the sum of (2l + 1) / (4 pi) k_l^2. `left`
    // is 4 pi times what the degrees above l contribute to it. Once `left` meets the tolerance, at
    // most a quarter more degrees are computed: the coefficients of most lobes fall exponentially,
    // so that the error may fall to a quarter of the tolerance at little cost.
    double left = squares * 4 * KI_PI - sum * sum;
    double stop = tolerance * tolerance * squares * 4 * KI_PI;
    int l = 1, last = limit;
    double sums[KI_DEGREES] = {0};
    for (; l <= last; l++) {
        if (left <= stop && last == limit)
            last = ki_min(limit, ki_max(l + l / 4, KI_LEAST_DEGREE));
        if (left <= stop / 16 && l > ki_min(limit, KI_LEAST_DEGREE))
            break;
        if ((l - 1) % KI_DEGREES == 0)
            kernels->sum_degrees(x, w, (ptrdiff_t)count, l, p0, p1, sums);
        double k = sums[(l - 1) % KI_DEGREES];
        spectrum->k[l] = k / whole;
        left -= (2 * l + 1) * k * k;
    }
    spectrum->degree = l - 1;
    spectrum->truncation = left > 0 ? sqrt(left / (squares * 4 * KI_PI)) : 0;
done:
    ki_free(nodes);
    ki_free(p.edges);
    if (result != KILN_OK)
        ki_zonal_free(spectrum);
    return result;
}

void ki_zonal_free(ki_zonal_spectrum *spectrum)
{
    ki_free(spectrum->k);
    *spectrum = (ki_zonal_spectrum){0};
}

kiln_result ki_lobe_spectrum(kiln_context *context, const kiln_lobe *lobe, double tolerance,
                             bool split, ki_zonal *zonal, ki_zonal_spectrum *spectrum,
                             kiln_error *error)
{
    *zonal = (ki_zonal){.lobe = *lobe};
    // First guess of the degree that the tolerance needs. The guess for the widest lobes is higher,
    // because their kink at the horizon makes their coefficients fall slowly.
    double width = ki_lobe_width(lobe), guess = (width < 1 ? 160 : 320) + 14 / width;
    // The Charlie lobe is narrow at the horizon and not around its centre, so that leaving the
    // centre out of the spectrum would not help.
    split = split && lobe->kind != KILN_LOBE_CHARLIE;
    int limit = guess < KILN_MAX_DEGREE ? (int)guess : KILN_MAX_DEGREE;
    if (guess < 2 * KILN_MAX_DEGREE || !split) {
        kiln_result result = ki_zonal_analyze(context, zonal, tolerance, limit, spectrum, error);
        if (result != KILN_OK || spectrum->truncation <= tolerance)
            return result;
        if (limit < KILN_MAX_DEGREE) {
            ki_zonal_free(spectrum);
            result = ki_zonal_analyze(context, zonal, tolerance, KILN_MAX_DEGREE, spectrum, error);
        }
        // A kink of the lobe at the horizon makes coefficients that fall slowly but are small.
        // Leaving the centre of the lobe out of the spectrum would not shorten that tail.
        if (result != KILN_OK || spectrum->truncation <= 10 * tolerance || !split)
            return result;
        ki_zonal_free(spectrum);
    }
    zonal->inner = 0.01;
    zonal->outer = 0.05;
    return ki_zonal_analyze(context, zonal, tolerance, KILN_MAX_DEGREE, spectrum, error);
}
