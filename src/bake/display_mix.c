#include "bake/display_mix.h"

#include "math/math.h"
#include "sphere/points.h"

#include <math.h>
#include <string.h>

// The least roughness that counts.
static const double least_roughness = 0.05;
// What a level costs where no roughness shows it: it should be what it is in the exact chain.
static const double prior = 1e-3;
// Level 0 free: the share of the mirror in it, as if so much roughness showed it alone.
static const double mirror_share = 1e-3;
// Weights below this are left out.
static const double least_weight = 1e-5;
// Added to both norms' diagonals, relatively: the lobes are nearly dependent.
static const double ridge = 1e-8;
// Radians around a sun that the second norm leaves out, a 200th of the sphere.
static const double aside = 0.1415;
// What the second norm counts beside the first.
static const double far_share = 30;
// And the light it is relative to where there is next to none, a tenth of the mean, squared.
static const double dark = 0.01;

void ki_palette_lay(ki_palette *p, double (*level)(double, int, int), int level_count, int size)
{
    static const double x[KI_LOBES] = {-0.86113631159405257522, -0.33998104358485626480,
                                       0.33998104358485626480, 0.86113631159405257522};
    static const double w[KI_LOBES] = {0.34785484513745385737, 0.65214515486254614263,
                                       0.65214515486254614263, 0.34785484513745385737};
    double from = least_roughness;
    p->level_count = level_count;
    while (from < 1 && p->count + KI_LOBES <= KI_MOST_LOBES - 2) {
        // The largest roughness that is shown by the same two levels, by halving.
        double next = floor(level(from + 1e-9, level_count, size)) + 1, low = from, high = 1;
        if (level(1, level_count, size) <= next)
            low = 1;
        for (int i = 0; i < 60 && low < 1; i++) {
            double middle = 0.5 * (low + high);
            *(level(middle, level_count, size) <= next ? &low : &high) = middle;
        }
        for (int i = 0; i < KI_LOBES && low > from; i++) {
            int n = p->count++;
            p->roughness[n] = from + 0.5 * (1 + x[i]) * (low - from);
            p->width[n] = 0.5 * w[i] * (low - from);
            p->level[n] = ki_clamp(level(p->roughness[n], level_count, size), 0, level_count - 1);
        }
        from = low > from ? low : from + 1e-6;
    }
}

// ------------------------------------------------------------------------------------------- norms

typedef double matrix[KI_MOST_LOBES][KI_MOST_LOBES];

/// The scalar products of the lobes in both norms, and their common axes: `whole` = L L',
/// `away` = L Q diag(ratio) Q' L'.
typedef struct norms {
    int count;
    matrix whole, away, lower, axes;
    double ratio[KI_MOST_LOBES];
    double tails[KI_MOST_LOBES]; // of each lobe at one angle
} norms;

// Sum over degrees of power k_i k_j; the last lobe is a mirror.
static void add_power(norms *n, const ki_palette *p, const double (*power)[3], int degree,
                      double mean, matrix products)
{
    int mirror = p->count + 1;
    for (int i = 0; i < n->count; i++)
        for (int j = 0; j <= i; j++) {
            int last = degree;
            if (i < mirror)
                last = ki_min(last, p->spectra[i].degree);
            if (j < mirror)
                last = ki_min(last, p->spectra[j].degree);
            double sum = 0;
            for (int l = 0; l <= last; l++) {
                double k = i < mirror ? p->spectra[i].k[l] : 1;
                k *= j < mirror ? p->spectra[j].k[l] : 1;
                sum += k * (power[l][0] + power[l][1] + power[l][2]);
            }
            products[i][j] = products[j][i] = sum / mean;
        }
}

// The squares of the suns' light, of neighbours together.
static kiln_result square_suns(kiln_context *context, const kiln_spectrum *spectrum, double *sum,
                               kiln_error *error)
{
    ki_zonal any = {.lobe = kiln_lobe_ggx(1)};
    ki_points points;
    *sum = 0;
    if (!spectrum->sun_count)
        return KILN_OK;
    kiln_result result = ki_points_create(spectrum, &any, 1, 0, &points, error);
    if (result != KILN_OK)
        return result;
    // Each goes to the first that is near enough, whose direction stays.
    double(*suns)[6] = ki_alloc(context, (size_t)spectrum->sun_count, sizeof *suns);
    int count = 0;
    for (int i = 0; i < spectrum->sun_count && suns; i++) {
        const double *sun = points.suns.centre[i];
        int to = 0;
        for (; to < count; to++)
            if (ki_acos(ki_clamp(sun[0] * suns[to][0] + sun[1] * suns[to][1] + sun[2] * suns[to][2],
                                 -1, 1)) < aside)
                break;
        if (to == count)
            memcpy(suns[count++], sun, 3 * sizeof *sun);
        for (int c = 3; c < 6; c++)
            suns[to][c] += sun[c];
    }
    for (int i = 0; i < count; i++)
        for (int c = 3; c < 6; c++)
            *sum += suns[i][c] * suns[i][c];
    ki_points_destroy(&points);
    result = suns ? KILN_OK
                  : ki_fail_memory(context, error, "the suns",
                                   (size_t)spectrum->sun_count * sizeof *suns);
    ki_free(suns);
    return result;
}

// The light of suns seen from afar: the integral over the sphere, without what is near, of the tails'
// products, by a midpoint rule over the angle's logarithm. A mirror has no tail.
static void add_tails(norms *n, const ki_palette *p, double light)
{
    enum { STEPS = 128 };
    double reach = ki_log(0.5 * KI_PI / aside);
    for (int s = 0; s < STEPS; s++) {
        double angle = aside * ki_exp(reach * (s + 0.5) / STEPS), sine, cosine;
        ki_sincos(angle, &sine, &cosine);
        double area = 2 * KI_PI * sine * angle * reach / STEPS;
        for (int i = 0; i <= p->count; i++) {
            ki_zonal zonal = {.lobe = kiln_lobe_ggx(p->roughness[i] * p->roughness[i])};
            n->tails[i] = ki_zonal_weight(&zonal, 1 - cosine) / p->spectra[i].integral;
        }
        for (int i = 0; i <= p->count; i++)
            for (int j = 0; j <= p->count; j++)
                n->away[i][j] += light * area * n->tails[i] * n->tails[j];
    }
}

// L of `whole`, and L^-1 away L^-T into `to`.
static void factor(norms *n, matrix to)
{
    int count = n->count;
    for (int i = 0; i < count; i++)
        for (int j = 0; j <= i; j++) {
            double sum = n->whole[i][j];
            for (int k = 0; k < j; k++)
                sum -= n->lower[i][k] * n->lower[j][k];
            n->lower[i][j] = i == j ? sqrt(sum) : sum / n->lower[j][j];
        }
    memcpy(to, n->away, sizeof n->away);
    // From both sides.
    for (int side = 0; side < 2; side++) {
        for (int j = 0; j < count; j++)
            for (int i = 0; i < count; i++) {
                double sum = to[i][j];
                for (int k = 0; k < i; k++)
                    sum -= n->lower[i][k] * to[k][j];
                to[i][j] = sum / n->lower[i][i];
            }
        for (int i = 0; i < count; i++)
            for (int j = 0; j < i; j++) {
                double swap = to[i][j];
                to[i][j] = to[j][i];
                to[j][i] = swap;
            }
    }
}

// Eigenvectors, the columns of `axes`, and eigenvalues of a symmetric matrix by Jacobi's rotations.
static void find_axes(norms *n, matrix a)
{
    enum { SWEEPS = 12 };
    int count = n->count;
    memset(n->axes, 0, sizeof n->axes);
    for (int i = 0; i < count; i++)
        n->axes[i][i] = 1;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int i = 1; i < count; i++)
            for (int j = 0; j < i; j++) {
                if (fabs(a[i][j]) <= 1e-300)
                    continue;
                double slope = (a[i][i] - a[j][j]) / (2 * a[i][j]);
                double t = (slope < 0 ? -1 : 1) / (fabs(slope) + sqrt(slope * slope + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < count; k++) {
                    double x = a[k][j], y = a[k][i];
                    a[k][j] = c * x - s * y;
                    a[k][i] = s * x + c * y;
                }
                for (int k = 0; k < count; k++) {
                    double x = a[j][k], y = a[i][k];
                    a[j][k] = c * x - s * y;
                    a[i][k] = s * x + c * y;
                }
                for (int k = 0; k < count; k++) {
                    double x = n->axes[k][j], y = n->axes[k][i];
                    n->axes[k][j] = c * x - s * y;
                    n->axes[k][i] = s * x + c * y;
                }
            }
    for (int i = 0; i < count; i++)
        n->ratio[i] = fmax(a[i][i], 0);
}

static kiln_result measure(kiln_context *context, const ki_palette *p,
                           const kiln_spectrum *spectrum, const double (*power)[3], norms *n,
                           kiln_error *error)
{
    const double(*all)[3] = power + spectrum->degree + 1, black[1][3] = {{1}};
    double light, mean = all[0][0] + all[0][1] + all[0][2];
    n->count = p->count + 2;
    kiln_result result = square_suns(context, spectrum, &light, error);
    if (result != KILN_OK)
        return result;
    // Relative to the mean radiance, so that no unit overflows; black is as good as white.
    if (mean > 0) {
        add_power(n, p, all, spectrum->degree, mean, n->whole);
        add_power(n, p, power, spectrum->degree, mean, n->away);
        add_tails(n, p, light / mean);
    } else {
        add_power(n, p, black, 0, 1, n->whole);
        add_power(n, p, black, 0, 1, n->away);
    }
    for (int i = 0; i < n->count; i++) {
        n->whole[i][i] *= 1 + ridge;
        n->away[i][i] *= 1 + ridge;
    }
    matrix *ratio = ki_alloc(context, 1, sizeof *ratio);
    if (!ratio)
        return ki_fail_memory(context, error, "a display's norms", sizeof *ratio);
    factor(n, *ratio);
    find_axes(n, *ratio);
    ki_free(ratio);
    return KILN_OK;
}

// --------------------------------------------------------------------------------------- equations

typedef struct equations {
    double diagonal[KILN_MAX_LEVELS], next[KILN_MAX_LEVELS];
    double right[KILN_MAX_LEVELS][KI_MOST_LOBES];
    double weights[KILN_MAX_LEVELS][KI_MOST_LOBES]; // their solution
} equations;

// `w`: what a unit of roughness counts at each node, and last for the mirror.
static void lay_equations(const ki_palette *p, const double *w, double *coupling, equations *e)
{
    int last = p->level_count - 1, mirror = p->count + 1;
    memset(e, 0, sizeof *e);
    for (int n = 0; n < p->count; n++) {
        int i = ki_min((int)p->level[n], last);
        double t = p->level[n] - i, weight = w[n] * p->width[n];
        e->diagonal[i] += weight * (1 - t) * (1 - t);
        e->right[i][n] += weight * (1 - t);
        if (i < last) {
            e->diagonal[i + 1] += weight * t * t;
            e->next[i] += weight * t * (1 - t);
            e->right[i + 1][n] += weight * t;
        }
    }
    for (int i = 0; i <= last; i++) {
        double own =
            i ? prior * (e->diagonal[i] + e->next[i] + e->next[i - 1]) : mirror_share * w[mirror];
        e->diagonal[i] += own;
        e->right[i][i ? p->nearest[i] : mirror] += own;
    }
    for (int i = 0; i <= last && coupling; i++)
        coupling[i] = e->diagonal[i] > 0 ? e->next[i] / e->diagonal[i] : 0;
    // What stays as it is goes to the right.
    for (int i = 0; i <= last; i++) {
        if (p->fitted[i])
            continue;
        int as = i == 0 ? mirror : i == last ? p->count : p->nearest[i];
        memset(e->right[i], 0, sizeof e->right[i]);
        e->right[i][as] = e->diagonal[i] = 1;
        if (i > 0)
            e->right[i - 1][as] -= e->next[i - 1];
        if (i < last && p->fitted[i + 1])
            e->right[i + 1][as] -= e->next[i];
        if (i > 0)
            e->next[i - 1] = 0;
        e->next[i] = 0;
    }
}

static void solve_equations(const ki_palette *p, equations *e)
{
    int last = p->level_count - 1, count = p->count + 2;
    for (int i = 0; i < last; i++) {
        double factor = e->next[i] / e->diagonal[i];
        e->diagonal[i + 1] -= factor * e->next[i];
        for (int n = 0; n < count; n++)
            e->right[i + 1][n] -= factor * e->right[i][n];
    }
    for (int i = last; i >= 0; i--)
        for (int n = 0; n < count; n++) {
            double after = i < last ? e->next[i] * e->weights[i + 1][n] : 0;
            e->weights[i][n] = (e->right[i][n] - after) / e->diagonal[i];
        }
}

// Adds the part of a solution that lies on axis `k`: L^-T q q' L' times it.
static void add_part(const norms *n, int k, const equations *e, int level_count, ki_mixtures *to)
{
    double across[KI_MOST_LOBES], along[KI_MOST_LOBES];
    int count = n->count;
    for (int i = count - 1; i >= 0; i--) {
        across[i] = 0;
        along[i] = n->axes[i][k];
        for (int j = 0; j <= i; j++)
            across[i] += n->lower[i][j] * n->axes[j][k];
        for (int j = i + 1; j < count; j++)
            along[i] -= n->lower[j][i] * along[j];
        along[i] /= n->lower[i][i];
    }
    for (int i = 0; i < level_count; i++) {
        double part = 0;
        for (int j = 0; j < count; j++)
            part += across[j] * e->weights[i][j];
        for (int j = 0; j < count; j++)
            to->weights[i][j] += part * along[j];
    }
}

// Weights of next to nothing are left out; white stays white.
static void finish(const ki_palette *p, ki_mixtures *mixtures)
{
    int count = p->count + 2;
    for (int i = 0; i < p->level_count; i++) {
        double sum = 0, *weights = mixtures->weights[i];
        for (int n = 0; n < count; n++) {
            if (fabs(weights[n]) < least_weight)
                weights[n] = 0;
            sum += weights[n];
        }
        for (int n = 0; n < count; n++)
            weights[n] /= sum;
    }
}

kiln_result ki_palette_mix(kiln_context *context, const ki_palette *p,
                           const kiln_spectrum *spectrum, const double (*power)[3],
                           ki_mixtures *mixtures, kiln_error *error)
{
    norms *n = ki_alloc(context, 1, sizeof *n);
    if (!n)
        return ki_fail_memory(context, error, "a display's norms", sizeof *n);
    kiln_result result = measure(context, p, spectrum, power, n, error);
    memset(mixtures, 0, sizeof *mixtures);
    for (int k = 0; k < n->count && result == KILN_OK; k++) {
        // A roughness counts by the inverse of its own light, in each norm.
        double w[KI_MOST_LOBES];
        equations e;
        for (int i = 0; i < n->count; i++)
            w[i] = 1 / n->whole[i][i];
        if (k == 0)
            lay_equations(p, w, mixtures->coupling, &e);
        for (int i = 0; i < n->count; i++)
            w[i] += far_share * n->ratio[k] / (n->away[i][i] + dark);
        lay_equations(p, w, NULL, &e);
        solve_equations(p, &e);
        add_part(n, k, &e, p->level_count, mixtures);
    }
    if (result == KILN_OK)
        finish(p, mixtures);
    ki_free(n);
    return result;
}
