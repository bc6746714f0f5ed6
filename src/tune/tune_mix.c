// Finds the mixtures of lobes of tuned levels. In: quadrature nodes over roughness and the
// environment's spectrum. Out: the weight of each lobe in each level. The normal equations of the
// least-squares problem in tune.h are tridiagonal in the levels. The error is the sum of two
// squared norms of the same difference, one over the whole sphere and one away from suns. Each norm
// is given by a matrix of scalar products (tune_norms.h). Both matrices become diagonal in the
// basis of their generalised eigenvectors ("axes"). The equations are solved once for each axis,
// and the components of the solutions along their axes are added. docs/theory/tuning.md derives the
// method.
#include "tune/tune_norms.h"

#include "math/math.h"

#include <math.h>
#include <string.h>

// Smallest roughness at which errors count for the tuning.
static const double least_roughness = 0.05;
// Regularisation: the weight of the equation that a level equals its exact content, relative to the
// weight of the roughnesses at which an engine reads the level. Without that equation, a level that
// hardly any roughness in [0.05, 1] reads would be undetermined.
static const double prior = 1e-3;
// The weight of the equation that level 0 equals the mirror (the unfiltered environment), where
// level 0 is tuned. It is as large as the weight of errors over an interval of roughness of length
// 1e-3.
static const double mirror_weight = 1e-3;
// Weights of lobes in a mixture that are smaller than this in absolute value are set to 0.
static const double least_weight = 1e-5;
// The weight of errors over the sphere without 8 degrees around each sun, relative to errors over
// the whole sphere.
static const double far_weight = 30;
// Errors away from suns are divided by the light there. This constant is added to the square of
// that light, in units of the squared mean radiance. Without it, the errors of a black sky around a
// lamp would outweigh all other errors.
static const double dark = 0.01;

void ki_nodes_place(ki_nodes *nodes, double (*level)(double, int, int), int level_count, int size)
{
    static const double x[KI_LOBES] = {-0.86113631159405257522, -0.33998104358485626480,
                                       0.33998104358485626480, 0.86113631159405257522};
    static const double w[KI_LOBES] = {0.34785484513745385737, 0.65214515486254614263,
                                       0.65214515486254614263, 0.34785484513745385737};
    double from = least_roughness;
    nodes->level_count = level_count;
    while (from < 1 && nodes->count + KI_LOBES <= KI_MOST_LOBES - 2) {
        // Finds by bisection the largest roughness at which the engine reads the same two levels as
        // at roughness `from`.
        double next = floor(level(from + 1e-9, level_count, size)) + 1, low = from, high = 1;
        if (level(1, level_count, size) <= next)
            low = 1;
        for (int i = 0; i < 60 && low < 1; i++) {
            double middle = 0.5 * (low + high);
            *(level(middle, level_count, size) <= next ? &low : &high) = middle;
        }
        for (int i = 0; i < KI_LOBES && low > from; i++) {
            int n = nodes->count++;
            nodes->roughness[n] = from + 0.5 * (1 + x[i]) * (low - from);
            nodes->width[n] = 0.5 * w[i] * (low - from);
            nodes->level[n] =
                ki_clamp(level(nodes->roughness[n], level_count, size), 0, level_count - 1);
        }
        from = low > from ? low : from + 1e-6;
    }
}

// --------------------------------------------------------------------------------------- equations

typedef struct equations {
    // A_ii for each level i of the tridiagonal matrix A of the normal equations (tune.h)
    double diagonal[KILN_MAX_LEVELS];
    // A_i,i+1 of the tridiagonal matrix A of the normal equations (tune.h)
    double next[KILN_MAX_LEVELS];
    // right-hand side of the equation of each level: the coefficient of each lobe
    double right[KILN_MAX_LEVELS][KI_MOST_LOBES];
    // the solution: the weight of each lobe in the mixture of each level
    double weights[KILN_MAX_LEVELS][KI_MOST_LOBES];
} equations;

// Fills the normal equations of the levels' mixtures. They are tridiagonal, because a roughness
// reads two neighbouring levels, and have one right-hand side for each lobe. w[] is the weight of
// errors per unit of roughness at each node; its last element is that of errors of the mirror, at
// level 0. If `coupling` is not NULL, sets coupling[i] to A_i,i+1 / A_ii.
static void set_up_equations(const ki_nodes *nodes, const double *w, double *coupling, equations *e)
{
    int last = nodes->level_count - 1, mirror = nodes->count + 1;
    memset(e, 0, sizeof *e);
    for (int n = 0; n < nodes->count; n++) {
        int i = ki_min((int)nodes->level[n], last);
        double t = nodes->level[n] - i, weight = w[n] * nodes->width[n];
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
            i ? prior * (e->diagonal[i] + e->next[i] + e->next[i - 1]) : mirror_weight * w[mirror];
        e->diagonal[i] += own;
        e->right[i][i ? nodes->nearest[i] : mirror] += own;
    }
    for (int i = 0; i <= last && coupling; i++)
        coupling[i] = e->diagonal[i] > 0 ? e->next[i] / e->diagonal[i] : 0;
    // Levels that are not tuned are known: their terms in the equations of other levels move to the
    // right-hand sides.
    for (int i = 0; i <= last; i++) {
        if (nodes->tuned[i])
            continue;
        int as = i == 0 ? mirror : i == last ? nodes->count : nodes->nearest[i];
        memset(e->right[i], 0, sizeof e->right[i]);
        e->right[i][as] = e->diagonal[i] = 1;
        if (i > 0)
            e->right[i - 1][as] -= e->next[i - 1];
        if (i < last && nodes->tuned[i + 1])
            e->right[i + 1][as] -= e->next[i];
        if (i > 0)
            e->next[i - 1] = 0;
        e->next[i] = 0;
    }
}

static void solve_equations(const ki_nodes *nodes, equations *e)
{
    int last = nodes->level_count - 1, count = nodes->count + 2;
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

// Adds to the mixtures `to` the component of the mixtures e->weights along the eigenvector number
// `axis` of tune_norms.h. The component is the eigenvector times the scalar product, over the whole
// sphere, of the environment filtered by the eigenvector's mixture of lobes and of the environment
// filtered by the level's mixture.
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

// Sets the tiny weights of lobes in mixtures to 0, because each weight costs the evaluation of a
// lobe. Scales the remaining weights of a mixture to sum to 1, so that a white environment stays
// white.
static void finish(const ki_nodes *nodes, ki_mixtures *mixtures)
{
    int count = nodes->count + 2;
    for (int i = 0; i < nodes->level_count; i++) {
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

kiln_result ki_mixtures_find(kiln_context *context, const ki_nodes *nodes,
                             const kiln_spectrum *spectrum, const double (*power)[3], int degree,
                             ki_mixtures *mixtures, kiln_error *error)
{
    ki_norms n;
    kiln_result result = ki_norms_create(context, nodes, spectrum, power, degree, &n, error);
    if (result != KILN_OK)
        return result;
    memset(mixtures, 0, sizeof *mixtures);
    for (int k = 0; k < n.count; k++) {
        // The weight of a roughness r is 1 / |T_r|^2 in each norm, where T_r is the environment
        // filtered exactly for r. The errors that are minimised are therefore relative errors.
        double w[KI_MOST_LOBES] = {0};
        equations e;
        for (int i = 0; i < n.count; i++)
            w[i] = 1 / n.whole[i];
        if (k == 0)
            set_up_equations(nodes, w, mixtures->coupling, &e);
        for (int i = 0; i < n.count; i++)
            w[i] += far_weight * n.ratio[k] / (n.away[i] + dark);
        set_up_equations(nodes, w, NULL, &e);
        solve_equations(nodes, &e);
        add_part(&n, (size_t)k, &e, nodes->level_count, mixtures);
    }
    finish(nodes, mixtures);
    ki_norms_destroy(&n);
    return KILN_OK;
}
