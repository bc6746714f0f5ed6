// What the fit of lobes knows of a chain of levels. In: the roughness of each level. Out: tables of
// covariances as functions of the angle between two directions, and Legendre coefficients of
// degrees 1 and 2. Method: the light's coefficients of degree l are independent and have the
// variance v_l, so that light averaged by two lobes with Legendre coefficients k_l and h_l, in
// directions an angle a apart, has the covariance sum of (2 l + 1) / (4 pi) v_l k_l h_l P_l(cos a).
#include "table/lobes.h"

#include "math/math.h"
#include "sphere/zonal.h"

#include <math.h>

enum { ANGLES = KI_LOBES_STEPS + 1, DEGREES = KI_LOBES_DEGREE + 1 };

double ki_lobes_variance(int l)
{
    static const double power = 3, resolution = 200;
    return ki_pow(l, -power) * ki_exp(-(l / resolution) * (l / resolution));
}

// Cosine of the angle at index i of a table: the sine of half the angle is (i / KI_LOBES_STEPS)^2.
static double cosine_at(int i)
{
    double half = (double)i / KI_LOBES_STEPS;
    half *= half;
    return 1 - 2 * half * half;
}

// A series of Legendre polynomials to be tabulated: coefficients [DEGREES] that include the factor
// (2 l + 1) / (4 pi), and the place of the value at index 0 with the distance between values.
typedef struct series {
    double c[DEGREES];
    double *to;
    size_t stride;
} series;

typedef struct sums_job {
    series *series;
    int count;
} sums_job;

// Task of one thread: tabulates all series at index i.
static void sum_at(void *data, int i)
{
    const sums_job *job = data;
    double p[DEGREES], x = cosine_at(i);
    p[0] = 1;
    p[1] = x;
    for (int l = 1; l < KI_LOBES_DEGREE; l++)
        p[l + 1] = ((2 * l + 1) * x * p[l] - l * p[l - 1]) / (l + 1);
    for (int s = 0; s < job->count; s++) {
        double sum = 0;
        for (int l = 0; l < DEGREES; l++)
            sum += job->series[s].c[l] * p[l];
        job->series[s].to[(size_t)i * job->series[s].stride] = sum;
    }
}

// Sets the coefficients of a series: the variance of degree l times k[l] and h[l], either of which
// may be NULL for 1.
static void set_series(series *s, int first, const double *k, const double *h, double *to,
                       size_t stride)
{
    for (int l = 0; l < DEGREES; l++)
        s->c[l] = l < first ? 0
                            : (2 * l + 1) / (4 * KI_PI) * ki_lobes_variance(l) * (k ? k[l] : 1) *
                                  (h ? h[l] : 1);
    s->to = to;
    s->stride = stride;
}

// Places the nodes below the surface: Gauss-Legendre over the height, evenly around.
static void place_below(ki_lobes_chain *chain)
{
    enum { RINGS = KI_LOBES_BELOW_RINGS, SPOKES = KI_LOBES_BELOW_SPOKES };
    double x[RINGS], w[RINGS];
    ki_gauss_legendre(RINGS, x, w);
    for (int i = 0; i < KI_LOBES_BELOW; i++) {
        double z = -0.5 * (1 + x[i / SPOKES]), size = sqrt((1 - z) * (1 + z)), s, c;
        ki_sincos(KI_PI * (i % SPOKES + 0.5) / SPOKES, &s, &c);
        chain->below[i][0] = size * c;
        chain->below[i][1] = size * s;
        chain->below[i][2] = z;
        chain->below_area[i] = w[i / SPOKES] * KI_PI / SPOKES;
    }
}

// Sets k[DEGREES] to the Legendre coefficients of a level's lobe. A level of roughness 0 is the
// environment itself.
static kiln_result analyze(kiln_context *context, double roughness, double *k, kiln_error *error)
{
    for (int l = 0; l < DEGREES; l++)
        k[l] = 1;
    if (roughness < 0.01)
        return KILN_OK;
    ki_zonal zonal = {.lobe = kiln_lobe_ggx(roughness * roughness)};
    ki_zonal_spectrum spectrum;
    kiln_result result = ki_zonal_analyze(context, &zonal, 1e-6, KI_LOBES_DEGREE, &spectrum, error);
    for (int l = 0; l < DEGREES && !result; l++)
        k[l] = spectrum.k[l];
    if (!result)
        ki_zonal_free(&spectrum);
    return result;
}

// Factors that cut a series off at degree 24 << (cut + 1).
static void set_cut(int cut, double *factor)
{
    double limit = 24 << (cut + 1);
    for (int l = 0; l < DEGREES; l++) {
        double q = l / limit * (l / limit);
        factor[l] = ki_exp(-q * q);
    }
}

// Sets the series of a lobe from degree 3 on. The Gaussian blurs the lobe by about a degree, because
// the degrees of the sharpest levels do not end at KI_LOBES_DEGREE and their lobes would ring, and
// because the nodes below the surface at which the lobe is read lie some 20 degrees apart.
static void set_high(series *s, const double *k, double *to, size_t stride)
{
    static const double resolution = 60;
    for (int l = 0; l < DEGREES; l++)
        s->c[l] =
            l < 3 ? 0
                  : (2 * l + 1) / (4 * KI_PI) * k[l] * ki_exp(-(l / resolution) * (l / resolution));
    s->to = to;
    s->stride = stride;
}

static int set_all(ki_lobes_chain *chain, int first, double (*k)[DEGREES], series *s)
{
    size_t levels = (size_t)chain->level_count;
    int count = 0;
    double factor[DEGREES];
    for (int i = 0; i < chain->level_count; i++) {
        set_series(&s[count++], first, k[i], NULL, chain->light + i, levels);
        for (int j = 0; j <= i; j++)
            set_series(&s[count++], first, k[i], k[j],
                       chain->pair + (size_t)(i * (i + 1) / 2 + j) * ANGLES, 1);
    }
    for (int i = 0; i < chain->level_count; i++)
        set_high(&s[count++], k[i], chain->high + i, levels);
    for (int i = 0; i < KI_LOBES_CUTS; i++) {
        set_cut(i, factor);
        set_series(&s[count++], first, factor, NULL, chain->self[i], 1);
    }
    return count;
}

kiln_result ki_lobes_chain_create(kiln_context *context, const kiln_table_def *def, int first,
                                  ki_lobes_chain *chain, kiln_error *error)
{
    *chain = (ki_lobes_chain){.level_count = def->level_count};
    place_below(chain);
    size_t levels = (size_t)def->level_count, pairs = levels * (levels + 1) / 2;
    size_t tables = 2 * levels + pairs + KI_LOBES_CUTS, numbers = ANGLES * tables;
    double(*k)[DEGREES] = ki_alloc_raw(context, levels, sizeof *k);
    series *s = ki_alloc_raw(context, tables, sizeof *s);
    chain->light = ki_alloc_raw(context, numbers, sizeof *chain->light);
    kiln_result result = KILN_OK;
    if (!k || !s || !chain->light)
        result = ki_fail_memory(context, error, "the covariances of levels",
                                numbers * sizeof *chain->light);
    for (int i = 0; i < def->level_count && !result; i++) {
        chain->roughness[i] = (double)def->level_roughness[i];
        result = analyze(context, chain->roughness[i], k[i], error);
        for (int l = 0; l < 3 && !result; l++)
            chain->band[i][l] = k[i][l];
    }
    if (!result) {
        chain->pair = chain->light + ANGLES * levels;
        chain->high = chain->pair + ANGLES * pairs;
        for (size_t i = 0; i < KI_LOBES_CUTS; i++)
            chain->self[i] = chain->high + ANGLES * (levels + i);
        sums_job job = {s, set_all(chain, first, k, s)};
        ki_parallel_for(context, ANGLES, sum_at, &job);
    }
    ki_free(s);
    ki_free(k);
    if (result)
        ki_lobes_chain_free(chain);
    return result;
}

void ki_lobes_chain_free(ki_lobes_chain *chain)
{
    ki_free(chain->light);
    *chain = (ki_lobes_chain){0};
}

double ki_lobes_level(const ki_lobes_chain *chain, double roughness)
{
    const double *r = chain->roughness;
    if (roughness <= r[0])
        return 0;
    for (int i = 1; i < chain->level_count; i++)
        if (roughness <= r[i])
            return i - 1 + (roughness - r[i - 1]) / (r[i] - r[i - 1]);
    return chain->level_count - 1;
}
