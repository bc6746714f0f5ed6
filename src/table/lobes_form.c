// The error of taps as a quadratic function of their weights. In: a chain's tables, a target, the
// angles and levels of taps. Out: the matrix and the vector of the expected error, and of two costs
// that the expected light does not have: light from below the surface, and weights whose sum is not
// 1. The bands that taps leave to the harmonics are here too.
#include "table/lobes.h"

#include "math/math.h"

#include <math.h>

enum { STEPS = KI_LOBES_STEPS };

// -------------------------------------------------------------------------------------- covariances

// A level with its fraction: the hardware mixes level i and level i + 1 by the share of the latter.
static int split_level(const ki_lobes_chain *chain, double level, double *share)
{
    int i = ki_min((int)level, chain->level_count - 2);
    *share = level - i;
    return i;
}

// Catmull and Rom's cubic through y1 and y2 at the share t, which has the slopes of the parabolas
// through their neighbours.
static double cubic(double y0, double y1, double y2, double y3, double t)
{
    return y1 + 0.5 * t *
                    (y2 - y0 + t * (2 * y0 - 5 * y1 + 4 * y2 - y3 + t * (3 * (y1 - y2) + y3 - y0)));
}

// Covariance of the target and of a tap of weight 1.
static double target_with(const ki_lobes_chain *chain, const ki_lobes_target *target, double angle,
                          double level)
{
    ptrdiff_t levels = chain->level_count;
    int last = KI_LOBES_ANGLES - 1;
    double share, at = ki_clamp((angle - target->from) / target->step, 0, last), sum = 0;
    int a = ki_min((int)at, last - 1), i = split_level(chain, level, &share);
    int before = ki_max(a - 1, 0), after = ki_min(a + 2, last);
    for (int k = 0; k < 2; k++, i++) {
        const double *c = target->covariance + i;
        sum += (k ? share : 1 - share) * cubic(c[before * levels], c[a * levels],
                                               c[(a + 1) * levels], c[after * levels], at - a);
    }
    return sum;
}

// Covariance of two taps of weight 1.
static double tap_with(const ki_lobes_chain *chain, double angle, double level, double other,
                       double other_level)
{
    double share[2], half = 0.5 * (angle - other), sum = 0;
    double place = STEPS * sqrt(ki_sin(half < 0 ? -half : half));
    int at = ki_min((int)place, STEPS - 1);
    int i = split_level(chain, level, &share[0]), j = split_level(chain, other_level, &share[1]);
    for (int k = 0; k < 4; k++) {
        int high = ki_max(i + (k & 1), j + (k >> 1)), low = ki_min(i + (k & 1), j + (k >> 1));
        const double *pair = chain->pair + (size_t)(high * (high + 1) / 2 + low) * (STEPS + 1) + at;
        sum += (k & 1 ? share[0] : 1 - share[0]) * (k >> 1 ? share[1] : 1 - share[1]) *
               (pair[0] + (place - at) * (pair[1] - pair[0]));
    }
    return sum;
}

void ki_lobes_form_make(const ki_lobes_chain *chain, const ki_lobes_target *target,
                        const ki_lobes_taps *t, ki_lobes_form *f)
{
    f->count = t->count;
    for (int i = 0; i < t->count; i++) {
        f->b[i] = target_with(chain, target, t->angle[i], t->level[i]);
        for (int j = 0; j <= i; j++)
            f->a[i][j] = f->a[j][i] =
                tap_with(chain, t->angle[i], t->level[i], t->angle[j], t->level[j]);
    }
}

double ki_lobes_form_value(const ki_lobes_form *f, const double *w)
{
    double sum = 0;
    for (int i = 0; i < f->count; i++) {
        double row = -2 * f->b[i];
        for (int j = 0; j < f->count; j++)
            row += f->a[i][j] * w[j];
        sum += w[i] * row;
    }
    return sum;
}

double ki_lobes_taps_error(const ki_lobes_chain *chain, const ki_lobes_target *target,
                           const ki_lobes_taps *taps)
{
    ki_lobes_form f;
    ki_lobes_form_make(chain, target, taps, &f);
    return ki_lobes_form_value(&f, taps->weight);
}

double ki_lobes_scale(const ki_lobes_chain *chain, const ki_lobes_target *target)
{
    double level = ki_lobes_level(chain, target->roughness);
    return target_with(chain, target, target->mirror, level) +
           ki_lobes_bands_square(&target->bands);
}

// -------------------------------------------------------------------------------------------- costs

// Returns the cost of (1 - sum of the weights)^2 relative to the error. The light that the fit
// expects has no suns. Under such light alone the best taps may weigh little and leave the rest to
// bands 0 to 2, which show a sun as a wide blur with a dark ring. The unit of the cost is the part of
// the error that one tap in the dominant direction explains. How strong the cost must be was found by
// the errors of gold balls in eight panoramas (docs/theory/lobes.md). One tap and two taps need it at
// small roughness, three taps at any. Towards roughness 1, where bands 0 to 2 can describe nearly the
// whole lobe, two taps and three need a sum close to 1; a single tap cannot have one there, since its
// lobe is too narrow. The same holds for any number of taps of levels that are all much sharper than
// the lobe, so that the cost ends at a roughness of 1/8 above that of the widest level.
static double balance_of(const ki_lobes_chain *chain, const ki_lobes_target *target, int count)
{
    double angle = ki_lobes_dominant(target->roughness, target->mirror);
    double level = ki_lobes_level(chain, target->roughness);
    double with = target_with(chain, target, angle, level);
    double strength = count > 2 ? 1 : ki_clamp(1 - 1.5 * target->roughness, 0, 1);
    if (count > 1)
        strength += 1000 * ki_clamp(4 * target->roughness - 3, 0, 1);
    double widest = chain->roughness[chain->level_count - 1];
    strength *= ki_clamp(1 - 8 * (target->roughness - widest), 0, 1);
    return strength * with * with / tap_with(chain, angle, level, angle, level);
}

// Returns the strength of the cost of light from below the surface. Round lobes reach below the
// surface where the true lobe ends at the horizon, and bands 0 to 2 cannot end there either. The
// expected error counts this as any other difference of the lobes, but on the screen light from below
// is as large a part of the error as all other differences of the lobes (bench_lobe_parts). The
// numbers were found by the errors of gold balls in eight panoramas (docs/theory/lobes.md). Above a
// roughness of 0.35 the strength falls by a factor of 100 for each unit of roughness.
static double horizon_of(double roughness, int count)
{
    static const double strength[KILN_MAX_TAPS + 1] = {0, 1, 0.3, 0.01};
    double fall = count > 2 ? 1 : ki_exp(-4.6 * (roughness - 0.35));
    return strength[count] * (fall < 1 ? fall : 1);
}

void ki_lobes_costs_make(const ki_lobes_chain *chain, const ki_lobes_target *target, int count,
                         ki_lobes_costs *costs)
{
    const double *c = target->bands.c;
    double horizon = horizon_of(target->roughness, count);
    costs->balance = balance_of(chain, target, count);
    for (int i = 0; i < KI_LOBES_BELOW; i++) {
        double x = chain->below[i][0], y = chain->below[i][1], z = chain->below[i][2];
        double two = c[2] * (1.5 * z * z - 0.5) + 1.5 * (c[3] * x * z + c[4] * (x * x - y * y));
        costs->bands[i] = (c[5] + 3 * (c[0] * z + c[1] * x) + 5 * two) / (4 * KI_PI);
        costs->weight[i] = horizon * chain->below_area[i];
    }
}

// Sets `to` to the lobe per steradian, at the nodes below the surface, of a tap of weight 1 without
// its bands 0 to 2.
static void reach_below(const ki_lobes_chain *chain, double angle, double level,
                        double to[KI_LOBES_BELOW])
{
    size_t levels = (size_t)chain->level_count;
    double x, z, share;
    int low = split_level(chain, level, &share);
    ki_sincos(angle, &x, &z);
    for (int i = 0; i < KI_LOBES_BELOW; i++) {
        double cosine = x * chain->below[i][0] + z * chain->below[i][2];
        double place = STEPS * sqrt(sqrt(ki_clamp(0.5 * (1 - cosine), 0, 1)));
        int at = ki_min((int)place, STEPS - 1);
        const double *near = chain->high + (size_t)at * levels + low, *far = near + levels;
        double first = near[0] + (place - at) * (far[0] - near[0]);
        double second = near[1] + (place - at) * (far[1] - near[1]);
        to[i] = first + share * (second - first);
    }
}

void ki_lobes_form_add(const ki_lobes_chain *chain, const ki_lobes_costs *costs,
                       const ki_lobes_taps *t, ki_lobes_form *f)
{
    double below[KILN_MAX_TAPS][KI_LOBES_BELOW];
    for (int i = 0; i < t->count; i++) {
        reach_below(chain, t->angle[i], t->level[i], below[i]);
        f->b[i] += costs->balance;
        for (int n = 0; n < KI_LOBES_BELOW; n++)
            f->b[i] -= costs->weight[n] * costs->bands[n] * below[i][n];
        for (int j = 0; j <= i; j++) {
            double sum = costs->balance;
            for (int n = 0; n < KI_LOBES_BELOW; n++)
                sum += costs->weight[n] * below[i][n] * below[j][n];
            f->a[i][j] += sum;
            f->a[j][i] = f->a[i][j];
        }
    }
}

// -------------------------------------------------------------------------------------------- bands

double ki_lobes_bands_square(const ki_lobes_bands *b)
{
    double one = b->c[0] * b->c[0] + b->c[1] * b->c[1];
    double two = b->c[2] * b->c[2] + 0.75 * b->c[3] * b->c[3] + 3 * b->c[4] * b->c[4];
    return (3 * ki_lobes_variance(1) * one + 5 * ki_lobes_variance(2) * two) / (4 * KI_PI);
}

ki_lobes_bands ki_lobes_rest(const ki_lobes_chain *chain, const ki_lobes_target *target,
                             const ki_lobes_taps *taps)
{
    ki_lobes_bands rest = target->bands;
    for (int i = 0; i < taps->count; i++) {
        double share, x, z, w = taps->weight[i];
        int level = split_level(chain, taps->level[i], &share);
        const double *k = chain->band[level], *next = chain->band[level + 1];
        double first = w * (k[1] + share * (next[1] - k[1]));
        double second = w * (k[2] + share * (next[2] - k[2]));
        ki_sincos(taps->angle[i], &x, &z);
        rest.c[0] -= first * z;
        rest.c[1] -= first * x;
        rest.c[2] -= second * (1.5 * z * z - 0.5);
        rest.c[3] -= second * 2 * x * z;
        rest.c[4] -= second * 0.5 * x * x;
        rest.c[5] -= w;
    }
    return rest;
}
