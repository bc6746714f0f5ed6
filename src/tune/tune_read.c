// Computes the texels of a cube level such that the level, interpolated bilinearly, comes nearest
// to a finer cube, the goal. In: the goal. Out: texels >= 0. Method: a linear least-squares
// problem, by conjugate gradients.
#include "tune/tune_read.h"

#include "image/image.h"

#include <math.h>
#include <string.h>

// The points are the directions of the goal's texels. B x are the values that bilinear reads of the
// texels x give at the points; each read has four taps. W is the diagonal matrix of the points'
// solid angles. The normal equations B' W B x = B' W goal are solved by conjugate gradients,
// preconditioned by the diagonal of B' W B. The condition number of B' W B is about 9, so that
// STEPS steps suffice. Texels that become negative are fixed at 0, and the equations of the
// remaining texels are solved again, in up to ROUNDS rounds. Tasks process CHUNK texels or points.
enum { STEPS = 14, ROUNDS = 3, CHUNK = 2048 };

// The steps end when the squared residual, weighted by the inverse diagonal, is this part of what it was
// before the first step.
static const double near = 1e-5;

typedef struct tap {
    // in `taps` the index of the texel that a point reads, in `reverse` the index of the point that
    // reads a texel
    uint32_t at;
    float weight;
} tap;

typedef struct reads {
    kiln_context *context;
    const kiln_map *goal;
    size_t texel_count, point_count;
    // the matrix B: the four texels that a bilinear read at each point uses, with their weights
    tap (*taps)[4];
    // index in `reverse` of the first point that reads each texel, [texel_count + 1]
    uint32_t *start;
    // the transpose of `taps`: the points that read each texel, with their weights
    tap *reverse;
    // solid angle of each point of one cube face, up to a constant factor
    float *solid;
    // at each point, the value that is read from the texels, or the goal minus that value, times
    // the point's solid angle
    double (*shown)[3];
    // For each texel and channel: the solution x; the residual of the normal equations; the search
    // direction; the matrix B' W B times that direction; the diagonal of the matrix (for each
    // texel); and whether the texel is fixed at 0.
    double (*x)[3], (*residual)[3], (*direction)[3], (*product)[3], *diagonal;
    bool (*held)[3];
    // [chunk][2][channel]: for each chunk of texels or points, two sums that a task has written;
    // show_points, gather, take_step and hold say which.
    double (*sums)[2][3];
} reads;

static int chunks(size_t count)
{
    return (int)((count + CHUNK - 1) / CHUNK);
}

static size_t chunk_end(int index, size_t count)
{
    size_t end = ((size_t)index + 1) * CHUNK;
    return end < count ? end : count;
}

static void add_up(const reads *r, size_t count, int which, double sum[3])
{
    for (int c = 0; c < 3; c++) {
        sum[c] = 0;
        for (int i = 0; i < chunks(count); i++)
            sum[c] += r->sums[i][which][c];
    }
}

// ------------------------------------------------------------------------------------------ set up

// Task of one thread: sets the four taps and the solid angle of each point of a chunk. The points
// are the directions of the goal's texels.
static void make_taps(void *data, int index)
{
    reads *r = data;
    size_t face = r->point_count / 6;
    int size = (int)(sqrt((double)r->texel_count / 6) + 0.5);
    size_t edge = (size_t)r->goal->size;
    for (size_t p = (size_t)index * CHUNK; p < chunk_end(index, r->point_count); p++) {
        double s = (2 * (double)(p % edge) + 1) / (double)edge - 1, weights[4];
        size_t row = p % face / edge;
        double t = (2 * (double)row + 1) / (double)edge - 1;
        size_t texels[4];
        ki_face_taps(size, (int)(p / face), s, t, texels, weights);
        for (int i = 0; i < 4; i++)
            r->taps[p][i] = (tap){(uint32_t)texels[i], (float)weights[i]};
        // A texel's solid angle is proportional to 1 / d^3, where d is the distance from the cube's
        // centre to the texel on a face at distance 1.
        double squared = 1 + s * s + t * t;
        if (p < face)
            r->solid[p] = (float)(1 / (squared * sqrt(squared)));
    }
}

// Fills `reverse`: for each texel, the points that read it, in the order of the points.
static void transpose_taps(reads *r)
{
    for (size_t p = 0; p < r->point_count; p++)
        for (int i = 0; i < 4; i++)
            r->start[r->taps[p][i].at + 1]++;
    for (size_t t = 0; t < r->texel_count; t++)
        r->start[t + 1] += r->start[t];
    for (size_t p = 0; p < r->point_count; p++)
        for (int i = 0; i < 4; i++) {
            const tap *to = &r->taps[p][i];
            r->reverse[r->start[to->at]++] = (tap){(uint32_t)p, to->weight};
        }
    for (size_t t = r->texel_count; t > 0; t--)
        r->start[t] = r->start[t - 1];
    r->start[0] = 0;
}

static bool allocate(reads *r)
{
    kiln_context *k = r->context;
    size_t texels = r->texel_count, points = r->point_count;
    r->taps = ki_alloc_raw(k, points, sizeof *r->taps);
    r->start = ki_alloc(k, texels + 1, sizeof *r->start);
    r->reverse = ki_alloc_raw(k, 4 * points, sizeof *r->reverse);
    r->solid = ki_alloc_raw(k, points / 6, sizeof *r->solid);
    r->shown = ki_alloc_raw(k, points, sizeof *r->shown);
    r->x = ki_alloc_raw(k, texels, sizeof *r->x);
    r->residual = ki_alloc_raw(k, texels, sizeof *r->residual);
    r->direction = ki_alloc(k, texels, sizeof *r->direction);
    r->product = ki_alloc_raw(k, texels, sizeof *r->product);
    r->diagonal = ki_alloc(k, texels, sizeof *r->diagonal);
    r->held = ki_alloc(k, texels, sizeof *r->held);
    r->sums = ki_alloc(k, (size_t)chunks(points), sizeof *r->sums);
    return r->taps && r->start && r->reverse && r->solid && r->shown && r->x && r->residual &&
           r->direction && r->product && r->diagonal && r->held && r->sums;
}

static void release(reads *r)
{
    ki_free(r->taps);
    ki_free(r->start);
    ki_free(r->reverse);
    ki_free(r->solid);
    ki_free(r->shown);
    ki_free(r->x);
    ki_free(r->residual);
    ki_free(r->direction);
    ki_free(r->product);
    ki_free(r->diagonal);
    ki_free(r->held);
    ki_free(r->sums);
}

// Task of one thread: for a chunk of texels, sets the diagonal of the normal equations' matrix, and
// as the first guess of the solution the weighted mean of the goal over the points that read the
// texel.
static void begin(void *data, int index)
{
    reads *r = data;
    size_t face = r->point_count / 6;
    for (size_t t = (size_t)index * CHUNK; t < chunk_end(index, r->texel_count); t++) {
        double weights = 0, sum[3] = {0};
        for (uint32_t i = r->start[t]; i < r->start[t + 1]; i++) {
            size_t p = r->reverse[i].at;
            double share = (double)r->reverse[i].weight,
                   weight = share * (double)r->solid[p % face];
            r->diagonal[t] += share * weight;
            weights += weight;
            for (size_t c = 0; c < 3; c++)
                sum[c] += weight * (double)r->goal->level[0][3 * p + c];
        }
        for (int c = 0; c < 3; c++)
            r->x[t][c] = sum[c] / weights > 0 ? sum[c] / weights : 0;
    }
}

// -------------------------------------------------------------------------------------- the solver

typedef struct product {
    reads *r;
    const double (*from)[3]; // RGB of each texel
    double (*to)[3];
    // true: `to` is the residual B' W (goal - B from) of the normal equations; false: the product
    // B' W B from. B are the weights of bilinear reads, W the points' solid angles.
    bool residual;
} product;

// Task of one thread: reads the texels `from` at a chunk of points, and sets `shown` to the value
// read or to the goal minus that value, times the point's solid angle. Writes to r->sums the sums
// over the chunk of the goal and of the value read, both times solid angle.
static void show_points(void *data, int index)
{
    const product *a = data;
    reads *r = a->r;
    size_t face = r->point_count / 6;
    double(*sums)[3] = r->sums[index];
    memset(sums, 0, sizeof r->sums[index]);
    for (size_t p = (size_t)index * CHUNK; p < chunk_end(index, r->point_count); p++) {
        double solid = (double)r->solid[p % face];
        const tap *taps = r->taps[p];
        for (size_t c = 0; c < 3; c++) {
            double shown = 0, goal = (double)r->goal->level[0][3 * p + c];
            for (int i = 0; i < 4; i++)
                shown += (double)taps[i].weight * a->from[taps[i].at][c];
            sums[0][c] += solid * goal;
            sums[1][c] += solid * shown;
            r->shown[p][c] = solid * (a->residual ? goal - shown : shown);
        }
    }
}

// Task of one thread: sets a chunk of texels of `to` to the sums of `shown` over the points that
// read each texel, times the weights of the reads. Writes to r->sums the sums over the chunk of
// `to` times `from`, and of `to` squared over the diagonal of the normal equations' matrix.
static void gather(void *data, int index)
{
    const product *a = data;
    reads *r = a->r;
    double(*sums)[3] = r->sums[index];
    memset(sums, 0, sizeof r->sums[index]);
    for (size_t t = (size_t)index * CHUNK; t < chunk_end(index, r->texel_count); t++) {
        double sum[3] = {0};
        for (uint32_t i = r->start[t]; i < r->start[t + 1]; i++)
            for (int c = 0; c < 3; c++)
                sum[c] += (double)r->reverse[i].weight * r->shown[r->reverse[i].at][c];
        for (int c = 0; c < 3; c++) {
            a->to[t][c] = r->held[t][c] ? 0 : sum[c];
            sums[0][c] += a->to[t][c] * a->from[t][c];
            sums[1][c] += a->to[t][c] * a->to[t][c] / r->diagonal[t];
        }
    }
}

static void multiply(reads *r, const double (*from)[3], double (*to)[3], bool residual)
{
    product a = {r, from, to, residual};
    ki_parallel_for(r->context, chunks(r->point_count), show_points, &a);
    ki_parallel_for(r->context, chunks(r->texel_count), gather, &a);
}

typedef struct step {
    reads *r;
    double length[3], turn[3];
} step;

// Task of one thread: moves a chunk of texels along the search direction of the conjugate-gradient
// method and updates their residual. Writes to r->sums, as the second sum, that of the squared
// residual over the diagonal of the matrix.
static void take_step(void *data, int index)
{
    const step *s = data;
    reads *r = s->r;
    double(*sums)[3] = r->sums[index];
    memset(sums, 0, sizeof r->sums[index]);
    for (size_t t = (size_t)index * CHUNK; t < chunk_end(index, r->texel_count); t++)
        for (int c = 0; c < 3; c++) {
            r->x[t][c] += s->length[c] * r->direction[t][c];
            r->residual[t][c] -= s->length[c] * r->product[t][c];
            sums[1][c] += r->residual[t][c] * r->residual[t][c] / r->diagonal[t];
        }
}

// Task of one thread: computes the next search direction of the conjugate-gradient method for a
// chunk of texels.
static void turn_direction(void *data, int index)
{
    const step *s = data;
    reads *r = s->r;
    for (size_t t = (size_t)index * CHUNK; t < chunk_end(index, r->texel_count); t++)
        for (int c = 0; c < 3; c++)
            r->direction[t][c] =
                r->residual[t][c] / r->diagonal[t] + s->turn[c] * r->direction[t][c];
}

// Solves the normal equations B' W B x = B' W goal for the texels x, by STEPS steps of
// preconditioned conjugate gradients in each colour channel. B is the matrix of the weights of
// bilinear reads, W the diagonal matrix of the points' solid angles. Texels with `held` set keep
// the value 0 and have no equation.
static void solve(reads *r)
{
    int texel_chunks = chunks(r->texel_count);
    double first[3], norm[3], next[3], along[3];
    step s = {.r = r};
    multiply(r, (const double(*)[3])r->x, r->residual, true);
    add_up(r, r->texel_count, 1, norm);
    memcpy(first, norm, sizeof first);
    ki_parallel_for(r->context, texel_chunks, turn_direction, &s);
    bool far = true;
    for (int i = 0; i < STEPS && far; i++) {
        multiply(r, (const double(*)[3])r->direction, r->product, false);
        add_up(r, r->texel_count, 0, along);
        for (int c = 0; c < 3; c++)
            s.length[c] = along[c] > 0 ? norm[c] / along[c] : 0;
        ki_parallel_for(r->context, texel_chunks, take_step, &s);
        add_up(r, r->texel_count, 1, next);
        far = false;
        for (int c = 0; c < 3; c++) {
            far = far || next[c] > near * first[c];
            s.turn[c] = norm[c] > 0 ? next[c] / norm[c] : 0;
            norm[c] = next[c];
        }
        ki_parallel_for(r->context, texel_chunks, turn_direction, &s);
    }
}

// Task of one thread: sets the negative texels of a chunk to 0, fixes them at 0 for the next round,
// and writes their number to r->sums.
static void hold(void *data, int index)
{
    reads *r = data;
    r->sums[index][0][0] = 0;
    for (size_t t = (size_t)index * CHUNK; t < chunk_end(index, r->texel_count); t++)
        for (int c = 0; c < 3; c++) {
            r->direction[t][c] = 0;
            if (r->x[t][c] >= 0)
                continue;
            r->x[t][c] = 0;
            r->held[t][c] = true;
            r->sums[index][0][0]++;
        }
}

kiln_result ki_solve_texels(kiln_context *context, const kiln_map *goal, kiln_map *map, int index,
                            kiln_error *error)
{
    reads r = {.context = context,
               .goal = goal,
               .texel_count = kiln_map_texels(map, index),
               .point_count = kiln_map_texels(goal, 0)};
    if (!allocate(&r)) {
        release(&r);
        return ki_fail_memory(context, error, "a level's reads", r.point_count * sizeof *r.taps);
    }
    ki_parallel_for(context, chunks(r.point_count), make_taps, &r);
    transpose_taps(&r);
    ki_parallel_for(context, chunks(r.texel_count), begin, &r);
    double held[3] = {1};
    for (int i = 0; i < ROUNDS && held[0] > 0; i++) {
        solve(&r);
        ki_parallel_for(context, chunks(r.texel_count), hold, &r);
        add_up(&r, r.texel_count, 0, held);
    }
    product whole = {&r, (const double(*)[3])r.x, NULL, false};
    double sums[2][3];
    ki_parallel_for(context, chunks(r.point_count), show_points, &whole);
    add_up(&r, r.point_count, 0, sums[0]);
    add_up(&r, r.point_count, 1, sums[1]);
    for (int c = 0; c < 3; c++) {
        double scale = sums[0][c] > 0 && sums[1][c] > 0 ? sums[0][c] / sums[1][c] : 1;
        for (size_t t = 0; t < r.texel_count; t++)
            map->level[index][3 * t + (size_t)c] = (float)(r.x[t][c] * scale);
    }
    release(&r);
    return KILN_OK;
}
