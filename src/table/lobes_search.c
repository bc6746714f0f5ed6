// Searches for the taps that approximate a lobe best. In: a chain's tables, a target, a first
// guess. Out: angle, level and weight of each tap. Method: for given angles and levels the error is
// a quadratic function of the weights, whose least value solves a small linear system; the simplex
// method of Nelder and Mead 1965 moves angles and levels. A guess may pull on the solution, which
// keeps neighbouring texels of a table alike.
#include "table/lobes.h"

#include "math/math.h"

#include <math.h>
#include <string.h>

enum { PLACES = 2 * KILN_MAX_TAPS };

// Sets the weights of the `count` taps in the list `id` to those of least error, the other weights
// to 0. The diagonal is a little larger than the form's, so that equal taps share a weight.
static void solve(const ki_lobes_form *f, const int *id, int count, double *w)
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
static void weigh(const ki_lobes_form *f, double *w)
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
    double scale; // the error's order of magnitude
    ki_lobes_costs costs;
} search_job;

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
    ki_lobes_form f;
    ki_lobes_form_make(job->chain, job->target, t, &f);
    ki_lobes_form_add(job->chain, &job->costs, t, &f);
    weigh(&f, t->weight);
    double pull = job->pull ? pull_of(job->pull, job->target->mirror, t) : 0;
    return ki_lobes_form_value(&f, t->weight) + job->scale * (10 * outside + pull);
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
    search_job job = {.chain = chain, .target = target, .pull = pull, .count = taps->count};
    ki_lobes_costs_make(chain, target, taps->count, &job.costs);
    job.scale = ki_lobes_scale(chain, target);
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
