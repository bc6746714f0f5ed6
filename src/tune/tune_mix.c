#include "tune/tune_norms.h"

#include "math/math.h"

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

// Adds what of a solution lies on an axis.
static void add_part(const ki_norms *n, size_t axis, const equations *e, int level_count,
                     ki_mixtures *to)
{
    const double *across = n->across + axis * (size_t)n->count;
    const double *along = n->along + axis * (size_t)n->count;
    for (int i = 0; i < level_count; i++) {
        double part = 0;
        for (int j = 0; j < n->count; j++)
            part += across[j] * e->weights[i][j];
        for (int j = 0; j < n->count; j++)
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
    ki_norms n;
    kiln_result result = ki_norms_create(context, p, spectrum, power, &n, error);
    if (result != KILN_OK)
        return result;
    memset(mixtures, 0, sizeof *mixtures);
    for (int k = 0; k < n.count; k++) {
        // A roughness counts by the inverse of its own light, in each norm.
        double w[KI_MOST_LOBES] = {0};
        equations e;
        for (int i = 0; i < n.count; i++)
            w[i] = 1 / n.whole[i];
        if (k == 0)
            lay_equations(p, w, mixtures->coupling, &e);
        for (int i = 0; i < n.count; i++)
            w[i] += far_share * n.ratio[k] / (n.away[i] + dark);
        lay_equations(p, w, NULL, &e);
        solve_equations(p, &e);
        add_part(&n, (size_t)k, &e, p->level_count, mixtures);
    }
    finish(p, mixtures);
    ki_norms_destroy(&n);
    return KILN_OK;
}
