// The plan of an analysis (docs/theory/spectral.md), which analysis.c executes. In: the number of
// rows of a panorama, and the highest degree of its spherical-harmonic coefficients. Out: the
// tables that an analysis needs, above all the weights with which each row of the panorama
// contributes to the latitude rings, which are the transpose of an interpolation with eight
// weights.
#include "sphere/spectrum.h"

#include "math/math.h"
#include "sphere/grid.h"

#include <math.h>
#include <string.h>

// ---------------------------------------------------------------------------------------- the plan

enum { ROW_NODES = 6 };

// Computes the weights with which one row of the panorama contributes to the latitude rings from
// ring *first on. The weight of a ring is the integral over the row, from theta0 to theta1, of the
// ring's interpolating function times sin theta. Rings k < 0 or k >= ring_count lie beyond a pole.
// Returns the number of weights; with `weights` NULL the weights are only counted.
static int weigh_row(double theta0, double theta1, int ring_count, const double *taps,
                     const double rule[2][ROW_NODES], int *first, double *weights)
{
    // latitude ring k lies at theta = (k + 1/2) / scale
    double scale = ring_count / KI_PI;
    int low = (int)floor(theta0 * scale - 0.5), high = (int)floor(theta1 * scale - 0.5);
    *first = low - 3;
    int count = high - low + KI_TAPS;
    if (!weights)
        return count;
    memset(weights, 0, (size_t)count * sizeof *weights);
    for (int k = low; k <= high; k++) {
        double a = fmax(theta0, (k + 0.5) / scale), b = fmin(theta1, (k + 1.5) / scale);
        for (int n = 0; n < ROW_NODES && b > a; n++) {
            double theta = a + (b - a) * 0.5 * (1 + rule[0][n]), tap[KI_TAPS];
            double weight = rule[1][n] * (b - a) * 0.5 * ki_sin(theta);
            ki_taps_at(taps, ki_clamp(theta * scale - 0.5 - k, 0, 1), tap);
            for (int i = 0; i < KI_TAPS; i++)
                weights[k - low + i] += weight * tap[i];
        }
    }
    return count;
}

// Returns the index of the latitude ring with which a ring k < 0 or k >= count, beyond a pole,
// coincides. *half_turn says whether the ring lies beyond a pole: its points are then half a turn
// away in longitude.
static int real_ring(int ring, int count, bool *half_turn)
{
    *half_turn = ring < 0 || ring >= count;
    return ring < 0 ? -1 - ring : ring >= count ? 2 * count - 1 - ring : ring;
}

// Fills in the weights with which rows contribute to latitude rings, sorted by ring: the first pass
// counts the weights of each ring, the second pass stores them. Returns false when memory runs out.
static bool plan_row_weights(kiln_context *context, ki_analysis *a, const double *taps)
{
    int size = a->size, rings = 2 * a->rings.pair_count, first;
    double rule[2][ROW_NODES];
    ki_gauss_legendre(ROW_NODES, rule[0], rule[1]);
    const double(*nodes)[ROW_NODES] = (const double(*)[ROW_NODES])rule;
    // A row contributes to at most as many latitude rings as its height covers, rings / size, and
    // at each end to half as many as the interpolation has weights.
    int most = rings / size + KI_TAPS + 2;
    double *weights = ki_alloc_raw(context, (size_t)most, sizeof *weights);
    int *filled = ki_alloc(context, (size_t)rings, sizeof *filled);
    a->ring_start = ki_alloc(context, (size_t)rings + 1, sizeof *a->ring_start);
    bool good = weights && filled && a->ring_start;
    for (int pass = 0; good && pass < 2; pass++) {
        for (int j = 0; j < size; j++) {
            int count = weigh_row(j * KI_PI / size, (j + 1) * KI_PI / size, rings, taps, nodes,
                                  &first, pass ? weights : NULL);
            for (int i = 0; i < count; i++) {
                bool half_turn;
                int ring = real_ring(first + i, rings, &half_turn);
                if (pass)
                    a->row_weights[a->ring_start[ring] + filled[ring]++] =
                        (ki_row_weight){j, half_turn, weights[i]};
                else
                    a->ring_start[ring + 1]++;
            }
        }
        for (int k = 0; !pass && k < rings; k++)
            a->ring_start[k + 1] += a->ring_start[k];
        if (!pass)
            a->row_weights =
                ki_alloc_raw(context, (size_t)a->ring_start[rings], sizeof *a->row_weights);
        good = a->row_weights != NULL;
    }
    ki_free(weights);
    ki_free(filled);
    return good;
}

kiln_result ki_analysis_create(kiln_context *context, int size, int degree, ki_analysis **analysis,
                               kiln_error *error)
{
    ki_analysis *a = *analysis = ki_alloc(context, 1, sizeof *a);
    double *taps = ki_alloc_raw(context, KI_TAP_TABLE, sizeof *taps);
    double *density = ki_alloc_raw(context, (size_t)degree + 1, sizeof *density);
    if (!a || !taps || !density)
        goto failed;
    a->kernels = ki_sphere_kernels(context);
    a->size = size;
    a->degree = degree;
    a->column = ki_alloc_raw(context, (size_t)degree + 1, 2 * sizeof(double));
    a->solid = ki_alloc_raw(context, (size_t)size, sizeof *a->solid);
    if (!a->column || !a->solid || !ki_legendre_create(context, degree, &a->legendre) ||
        !ki_rings_create_grid(context, degree, KI_MANY_RINGS, &a->rings) ||
        !ki_fft_create(context, 2 * size, &a->fft))
        goto failed;

    // Integrates exp(-i m phi) over the columns of texels, each d radians wide. The integral over
    // column x is exp(-i m x d) times exp(-i m d / 2) d sinc(m d / 2). The Fourier transform
    // supplies the first factor, which depends on x. `column` holds the product of the others, with
    // sinc(y) = sin(y) / y.
    double d = KI_PI / size;
    for (int m = 0; m <= degree; m++) {
        double sine, cosine, width = m ? ki_sin(m * d / 2) * 2 / m : d;
        double *column = a->column + 2 * (size_t)m;
        ki_sincos(-m * d / 2, &sine, &cosine);
        column[0] = cosine * width;
        column[1] = sine * width;
    }
    // The solid angle of a texel is its width in longitude times the difference of cos theta
    // between its upper and lower edge.
    for (int row = 0; row < size; row++)
        a->solid[row] = d * (2 * ki_sin((row + 0.5) * d) * ki_sin(d / 2));
    ki_model_density(degree, density);
    ki_taps_design(KI_PI / (2 * a->rings.pair_count), density, degree, taps);
    if (!plan_row_weights(context, a, taps))
        goto failed;
    ki_free(density);
    ki_free(taps);
    return KILN_OK;
failed:
    ki_free(density);
    ki_free(taps);
    ki_analysis_destroy(a);
    *analysis = NULL;
    return ki_fail_memory(context, error, "the analysis' tables",
                          (size_t)degree * (size_t)degree * 16);
}

void ki_analysis_destroy(ki_analysis *analysis)
{
    if (!analysis)
        return;
    ki_legendre_destroy(&analysis->legendre);
    ki_rings_destroy(&analysis->rings);
    ki_fft_destroy(&analysis->fft);
    ki_free(analysis->column);
    ki_free(analysis->solid);
    ki_free(analysis->ring_start);
    ki_free(analysis->row_weights);
    ki_free(analysis);
}

kiln_result ki_spectrum_create(kiln_context *context, const ki_analysis *analysis,
                               kiln_spectrum **spectrum, kiln_error *error)
{
    kiln_spectrum *s = *spectrum = ki_alloc(context, 1, sizeof *s);
    if (s) {
        *s =
            (kiln_spectrum){.context = context, .degree = analysis->degree, .size = analysis->size};
        s->a = ki_alloc_raw(context, ki_coefficient_count(s->degree), sizeof *s->a);
        s->suns = ki_alloc_raw(context, KI_MAX_SUNS, sizeof *s->suns);
    }
    if (s && s->a && s->suns)
        return KILN_OK;
    kiln_spectrum_destroy(s);
    *spectrum = NULL;
    return ki_fail_memory(context, error, "a spectrum",
                          ki_coefficient_count(analysis->degree) * sizeof(double));
}

void kiln_spectrum_destroy(kiln_spectrum *spectrum)
{
    if (!spectrum)
        return;
    ki_free(spectrum->a);
    ki_free(spectrum->suns);
    ki_free(spectrum);
}

int kiln_spectrum_degree(const kiln_spectrum *spectrum)
{
    return spectrum->degree;
}
