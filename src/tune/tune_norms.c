// Computes the two norms in which tuned levels minimise their error: over the whole sphere, and
// away from suns. In: the spectra of lobes and of the environment. Out: for each norm, the matrix
// of scalar products of the environment filtered by each pair of lobes; and the generalised
// eigenvectors of the two matrices, which make both matrices diagonal. The products over the whole
// sphere come from the power per degree. Away from suns, the suns' light is integrated over the
// tails of lobes. The generalised eigenproblem becomes an ordinary one by a Cholesky decomposition.
// docs/theory/tuning.md derives the method.
#include "tune/tune_norms.h"

#include "math/math.h"
#include "sphere/points.h"

#include <math.h>
#include <string.h>

// The relative amount that is added to the diagonal of each norm's matrix of scalar products. The
// lobes are nearly linearly dependent, and rounding could make the matrices indefinite.
static const double ridge = 1e-8;
// The angle around each sun within which errors do not count in the norm away from suns, in radians
// (8 degrees; a circle of a 200th of the sphere).
static const double aside = 0.1415;

// Adds to products[i][j] the scalar product of the environment filtered by lobe i and by lobe j:
// the sum over degrees l of power_l k_i,l k_j,l, divided by `mean`. k_i,l are the Legendre
// coefficients of lobe i; the last lobe is a mirror, with k = 1. `power` is NULL for a black
// environment, for which the products are those of uniform light.
static void add_power(const ki_nodes *nodes, const double (*power)[3], int degree, double mean,
                      double *products)
{
    int count = nodes->count + 2, mirror = nodes->count + 1;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            int last = degree;
            if (i < mirror)
                last = ki_min(last, nodes->spectra[i].degree);
            if (j < mirror)
                last = ki_min(last, nodes->spectra[j].degree);
            double sum = power ? 0 : mean;
            for (int l = 0; power && l <= last; l++) {
                double k = i < mirror ? nodes->spectra[i].k[l] : 1;
                k *= j < mirror ? nodes->spectra[j].k[l] : 1;
                sum += k * (power[l][0] + power[l][1] + power[l][2]);
            }
            products[i * count + j] += sum / mean;
        }
}

// Sets *sum to the sum over suns and channels of the squared light of a sun, its radiance times
// solid angle. Suns nearer to each other than `aside` count as one sun.
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
    // Suns near to each other form a group: each sun joins the first group that is nearer than
    // `aside`. A group keeps the direction of its first sun.
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

// Adds to products[i][j] the light that the tails of lobes i and j carry away from suns: `light`,
// the squared light of the suns, times the integral of the product of both lobes over the angles
// from `aside` to 90 degrees, by the midpoint rule in the logarithm of the angle. The mirror has no
// tail.
static void add_tails(const ki_nodes *nodes, double light, double *products)
{
    enum { STEPS = 128 };
    double reach = ki_log(0.5 * KI_PI / aside), tails[KI_MOST_LOBES] = {0};
    int count = nodes->count + 2;
    for (int s = 0; s < STEPS; s++) {
        double angle = aside * ki_exp(reach * (s + 0.5) / STEPS), sine, cosine;
        ki_sincos(angle, &sine, &cosine);
        double area = 2 * KI_PI * sine * angle * reach / STEPS;
        for (int i = 0; i <= nodes->count; i++) {
            ki_zonal zonal = {.lobe = kiln_lobe_ggx(nodes->roughness[i] * nodes->roughness[i])};
            tails[i] = ki_zonal_weight(&zonal, 1 - cosine) / nodes->spectra[i].integral;
        }
        for (int i = 0; i < count; i++)
            for (int j = 0; j < count; j++)
                products[i * count + j] += light * area * tails[i] * tails[j];
    }
}

// Cholesky decomposition in place: replaces the positive definite matrix a by the lower triangular
// L with L L' = a, and sets the elements above the diagonal to 0.
static void factor(int count, double *a)
{
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            double sum = j <= i ? a[i * count + j] : 0;
            for (int k = 0; k < j && j <= i; k++)
                sum -= a[i * count + k] * a[j * count + k];
            a[i * count + j] = i == j ? sqrt(sum) : j < i ? sum / a[j * count + j] : 0;
        }
}

// Replaces a symmetric matrix a by L^-1 a L^-T, where L is the lower triangular matrix `lower`.
static void divide(int count, const double *lower, double *a)
{
    for (int side = 0; side < 2; side++) {
        for (int j = 0; j < count; j++)
            for (int i = 0; i < count; i++) {
                double sum = a[i * count + j];
                for (int k = 0; k < i; k++)
                    sum -= lower[i * count + k] * a[k * count + j];
                a[i * count + j] = sum / lower[i * count + i];
            }
        for (int i = 0; i < count; i++)
            for (int j = 0; j < i; j++) {
                double swap = a[i * count + j];
                a[i * count + j] = a[j * count + i];
                a[j * count + i] = swap;
            }
    }
}

// Converts eigenvectors q of L^-1 H L^-T to the basis of lobes: along = L^-T q and across = L q. G
// and H are the matrices of the scalar products of filtered environments, G over the whole sphere
// and H away from suns, and L L' = G (L is `lower`).
static void turn_axes(ki_norms *n, const double *lower, const double *axes)
{
    size_t count = (size_t)n->count;
    for (size_t a = 0; a < count; a++) {
        const double *q = axes + a * count;
        double *along = n->along + a * count, *across = n->across + a * count;
        for (size_t i = count; i-- > 0;) {
            across[i] = 0;
            along[i] = q[i];
            for (size_t j = 0; j <= i; j++)
                across[i] += lower[i * count + j] * q[j];
            for (size_t j = i + 1; j < count; j++)
                along[i] -= lower[j * count + i] * along[j];
            along[i] /= lower[i * count + i];
        }
    }
}

kiln_result ki_norms_create(kiln_context *context, const ki_nodes *nodes,
                            const kiln_spectrum *spectrum, const double (*power)[3], int degree,
                            ki_norms *n, kiln_error *error)
{
    const double(*all)[3] = power + degree + 1;
    double light, mean = all[0][0] + all[0][1] + all[0][2];
    *n = (ki_norms){.count = nodes->count + 2};
    size_t count = (size_t)n->count, size = count * count;
    kiln_result result = square_suns(context, spectrum, &light, error);
    if (result != KILN_OK)
        return result;
    double *lower = ki_alloc(context, 3 * size, sizeof *lower);
    n->along = ki_alloc(context, 2 * size, sizeof *n->along);
    if (!lower || !n->along) {
        ki_free(lower);
        ki_norms_destroy(n);
        return ki_fail_memory(context, error, "a tuning's norms", 5 * size * sizeof *lower);
    }
    double *away = lower + size, *axes = away + size;
    n->across = n->along + size;
    // The scalar products are divided by the squared mean radiance, so that no unit of radiance
    // overflows. A black environment is treated as a white one.
    bool dark = !(mean > 0);
    add_power(nodes, dark ? NULL : all, degree, dark ? 1 : mean, lower);
    add_power(nodes, dark ? NULL : power, degree, dark ? 1 : mean, away);
    if (!dark)
        add_tails(nodes, light / mean, away);
    for (size_t i = 0; i < count; i++) {
        n->whole[i] = lower[i * count + i] *= 1 + ridge;
        n->away[i] = away[i * count + i] *= 1 + ridge;
    }
    factor(n->count, lower);
    divide(n->count, lower, away);
    ki_symmetric_axes(n->count, away, axes, n->ratio);
    for (size_t i = 0; i < count; i++)
        n->ratio[i] = fmax(n->ratio[i], 0);
    turn_axes(n, lower, axes);
    ki_free(lower);
    return KILN_OK;
}

void ki_norms_destroy(ki_norms *n)
{
    ki_free(n->along);
    n->along = n->across = NULL;
}
