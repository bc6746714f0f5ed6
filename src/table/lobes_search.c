// Searches for the taps that approximate a lobe best. In: a chain's tables, a target, a first
// guess. Out: angle, level and weight of each tap. Method: for given angles and levels the error is
// a quadratic function of the weights, whose least value solves a small linear system; the simplex
// method of Nelder and Mead 1965 moves angles and levels. A guess may pull on the solution, which
// keeps neighbouring texels of a table alike.
#include "table/lobes.h"

#include "math/math.h"

#include <math.h>
#include <string.h>

enum { STEPS = KI_LOBES_STEPS, PLACES = 2 * KILN_MAX_TAPS };

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

// The error as a quadratic function of the weights w: w' a w - 2 b' w.
typedef struct form {
    int count;
    double a[KILN_MAX_TAPS][KILN_MAX_TAPS], b[KILN_MAX_TAPS];
} form;

static void make_form(const ki_lobes_chain *chain, const ki_lobes_target *target,
                      const ki_lobes_taps *t, form *f)
{
    f->count = t->count;
    for (int i = 0; i < t->count; i++) {
        f->b[i] = target_with(chain, target, t->angle[i], t->level[i]);
        for (int j = 0; j <= i; j++)
            f->a[i][j] = f->a[j][i] =
                tap_with(chain, t->angle[i], t->level[i], t->angle[j], t->level[j]);
    }
}

static double form_value(const form *f, const double *w)
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
    form f;
    make_form(chain, target, taps, &f);
    return form_value(&f, taps->weight);
}

// Sets the weights of the `count` taps in the list `id` to those of least error, the other weights
// to 0. The diagonal is a little larger than the form's, so that equal taps share a weight.
static void solve(const form *f, const int *id, int count, double *w)
{
    double m[KILN_MAX_TAPS][KILN_MAX_TAPS + 1];
    double ridge = 0;
    for (int i = 0; i < f->count; i++) {
        w[i] = 0;
        ridge += 1e-5 * f->a[i][i];
    }
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++)
            m[i][j] = f->a[id[i]][id[j]] + (i == j ? ridge : 0);
        m[i][count] = f->b[id[i]];
    }
    for (int c = 0; c < count; c++)
        for (int i = 0; i < count; i++) {
            double q = i == c ? 0 : m[i][c] / m[c][c];
            for (int j = c; j <= count && i != c; j++)
                m[i][j] -= q * m[c][j];
        }
    for (int i = 0; i < count; i++)
        w[id[i]] = m[i][count] / m[i][i];
}

// Sets the weights of least error of which none is negative: the tap of the most negative weight is
// left out until no weight is negative.
static void weigh(const form *f, double *w)
{
    int id[KILN_MAX_TAPS] = {0}, count = f->count;
    for (int i = 0; i < count; i++)
        id[i] = i;
    while (count > 0) {
        solve(f, id, count, w);
        int worst = 0;
        for (int i = 1; i < count; i++)
            worst = w[id[i]] < w[id[worst]] ? i : worst;
        if (w[id[worst]] >= 0)
            return;
        w[id[worst]] = 0;
        memmove(id + worst, id + worst + 1, (size_t)(--count - worst) * sizeof *id);
    }
}

typedef struct search_job {
    const ki_lobes_chain *chain;
    const ki_lobes_target *target;
    const ki_lobes_pull *pull;
    int count;
    double scale;   // the error's order of magnitude
    double balance; // cost of a sum of weights that is not 1, see `balance_of`
} search_job;

// Returns the cost of (1 - sum of the weights)^2 relative to the error. The light that the fit
// expects has no suns. Under such light alone the best taps may weigh little and leave the rest to
// bands 0 to 2, which show a sun as a wide blur. The cost is as large as the part of the error that
// one tap in the dominant direction explains. It lowers the errors of rendered balls with three taps
// at any roughness, and those of one and two taps at small roughness only.
static double balance_of(const ki_lobes_chain *chain, const ki_lobes_target *target, int count)
{
    double angle = ki_lobes_dominant(target->roughness, target->mirror);
    double level = ki_lobes_level(chain, target->roughness);
    double with = target_with(chain, target, angle, level);
    double strength = count > 2 ? 1 : ki_clamp(1 - 2.5 * target->roughness, 0, 1);
    return strength * with * with / tap_with(chain, angle, level, angle, level);
}

static void add_balance(double balance, form *f)
{
    for (int i = 0; i < f->count; i++) {
        f->b[i] += balance;
        for (int j = 0; j < f->count; j++)
            f->a[i][j] += balance;
    }
}

static double pull_of(const ki_lobes_pull *pull, double mirror, const ki_lobes_taps *t)
{
    double sum = 0;
    for (int i = 0; i < t->count; i++) {
        double a = mirror - t->angle[i] - pull->lean[i], w = t->weight[i] - pull->weight[i];
        double l = 0.3 * (t->level[i] - pull->level[i]);
        sum += a * a + l * l + w * w;
    }
    return pull->strength * sum;
}

// Sets *t to the taps at the angles and levels of `place`, clamped to their ranges, and returns the
// error with the pull. Places out of range cost more the farther out they are.
static double judge(const search_job *job, const double *place, ki_lobes_taps *t)
{
    double highest = job->chain->level_count - 1, outside = 0;
    t->count = job->count;
    // At n.v = 1 there is no plane of incidence, and taps lie along the normal.
    double from = job->target->from, to = job->target->mirror > 1e-6 ? KI_PI / 2 : 0;
    from = to > 0 ? from : 0;
    for (int i = 0; i < job->count; i++) {
        double angle = *place++, level = *place++;
        t->angle[i] = ki_clamp(angle, from, to);
        t->level[i] = ki_clamp(level, 0, highest);
        outside += fabs(angle - t->angle[i]) + fabs(level - t->level[i]);
    }
    form f;
    make_form(job->chain, job->target, t, &f);
    add_balance(job->balance, &f);
    weigh(&f, t->weight);
    double pull = job->pull ? pull_of(job->pull, job->target->mirror, t) : 0;
    return form_value(&f, t->weight) + job->scale * (10 * outside + pull);
}

// A simplex of corners in the space of angles and levels.
typedef struct simplex {
    int sides; // dimensions; there is one corner more
    double corner[PLACES + 1][PLACES], value[PLACES + 1];
    int best, worst, second; // indices of the least, largest and second largest value
} simplex;

static void rank(simplex *s)
{
    s->best = s->worst = 0;
    for (int i = 1; i <= s->sides; i++) {
        s->best = s->value[i] < s->value[s->best] ? i : s->best;
        s->worst = s->value[i] > s->value[s->worst] ? i : s->worst;
    }
    s->second = s->best;
    for (int i = 0; i <= s->sides; i++)
        if (i != s->worst && s->value[i] > s->value[s->second])
            s->second = i;
}

// Moves the worst corner along the line through the centre of the others: to the centre for 0, to
// the mirror image for 1. Returns the value there, and keeps the corner if it is below `limit`.
static double move(const search_job *job, simplex *s, const double *centre, const double *from,
                   double by, double limit)
{
    double place[PLACES] = {0};
    ki_lobes_taps t;
    for (int i = 0; i < s->sides; i++)
        place[i] = centre[i] + by * (centre[i] - from[i]);
    double value = judge(job, place, &t);
    if (value < limit) {
        memcpy(s->corner[s->worst], place, sizeof place);
        s->value[s->worst] = value;
    }
    return value;
}

static void shrink(const search_job *job, simplex *s)
{
    ki_lobes_taps t;
    for (int i = 0; i <= s->sides; i++) {
        if (i == s->best)
            continue;
        for (int j = 0; j < s->sides; j++)
            s->corner[i][j] = 0.5 * (s->corner[i][j] + s->corner[s->best][j]);
        s->value[i] = judge(job, s->corner[i], &t);
    }
}

// One step of Nelder and Mead's method: reflection, then expansion or contraction.
static void step(const search_job *job, simplex *s)
{
    double centre[PLACES] = {0}, from[PLACES], worst = s->value[s->worst];
    memcpy(from, s->corner[s->worst], sizeof from);
    for (int i = 0; i <= s->sides; i++)
        for (int j = 0; j < s->sides && i != s->worst; j++)
            centre[j] += s->corner[i][j] / s->sides;
    double best = s->value[s->best], second = s->value[s->second];
    double mirrored = move(job, s, centre, from, 1, worst);
    if (mirrored < best)
        move(job, s, centre, from, 2, mirrored);
    else if (mirrored >= second) {
        double limit = mirrored < worst ? mirrored : worst;
        if (move(job, s, centre, from, mirrored < worst ? 0.5 : -0.5, limit) >= limit)
            shrink(job, s);
    }
}

static void begin(const search_job *job, const ki_lobes_taps *t, simplex *s)
{
    double alpha = job->target->roughness * job->target->roughness;
    double side = ki_clamp(0.15 * alpha, 0.002, 0.06);
    ki_lobes_taps unused;
    s->sides = 2 * t->count;
    for (int i = 0; i <= s->sides; i++) {
        for (int j = 0; j < s->sides; j++)
            s->corner[i][j] = j & 1 ? t->level[j / 2] : t->angle[j / 2];
        if (i > 0)
            s->corner[i][i - 1] += i & 1 ? side : 0.15;
        s->value[i] = judge(job, s->corner[i], &unused);
    }
}

double ki_lobes_search(const ki_lobes_chain *chain, const ki_lobes_target *target,
                       const ki_lobes_pull *pull, ki_lobes_taps *taps)
{
    search_job job = {chain, target, pull, taps->count, 0, 0};
    job.balance = balance_of(chain, target, taps->count);
    double level = ki_lobes_level(chain, target->roughness);
    job.scale =
        target_with(chain, target, target->mirror, level) + ki_lobes_bands_square(&target->bands);
    simplex s = {0};
    begin(&job, taps, &s);
    for (int i = 0; i < 200 * taps->count; i++) {
        rank(&s);
        if (s.value[s.worst] - s.value[s.best] < 1e-9 * job.scale)
            break;
        step(&job, &s);
    }
    rank(&s);
    return judge(&job, s.corner[s.best], taps);
}

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
