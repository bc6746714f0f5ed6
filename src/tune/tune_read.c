// Computes the texels of a cube level such that the level, interpolated bilinearly, comes nearest
// to a finer cube, the goal. In: the goal. Out: texels >= 0. Method: a linear least-squares
// problem, by conjugate gradients.
//
// The points are the directions of the goal's texels. B x are the values that bilinear reads of the
// texels x give at the points; each read has four taps. W is the diagonal matrix of the points'
// solid angles. The normal equations B' W B x = B' W goal are solved by conjugate gradients,
// preconditioned by the diagonal of B' W B. The condition number of B' W B is about 9, so that
// STEPS steps suffice. Texels that become negative are fixed at 0, and the equations of the
// remaining texels are solved again, in up to ROUNDS rounds.
//
// The matrix B' W B connects each texel with itself and its eight neighbours. The points of a face
// read only texels of that face's plane and of its rim (tune_faces.h), and they lie alike on all
// faces. The matrix is therefore the sum, over the faces, of one matrix for a plane, whose rows are
// computed once and serve 18 planes. What a plane's product adds to its rim belongs to the texels
// that the rim repeats, and is added there.
#include "tune/tune_read.h"

#include "tune/tune_faces.h"

#include <math.h>
#include <string.h>

// Levels with faces of at most SMALL texels are one task, others a task for each plane.
enum { STEPS = 14, ROUNDS = 3, SMALL = 32 };

// The steps end when the squared residual, weighted by the inverse diagonal, is this part of what
// it was before the first step.
static const double near = 1e-5;

// Elements of the symmetric matrix for a plane: of each texel with itself and with the four
// neighbours that come after it in memory. Its elements with the four neighbours before it are
// stored at these neighbours.
enum { SELF, EAST, SOUTH_WEST, SOUTH, SOUTH_EAST, NEIGHBOURS };

typedef struct reads {
    kiln_context *context;
    ki_faces faces;
    const float *goal; // RGB texels of the goal's faces
    int edge;          // texels along the edge of a face of the goal
    ki_face_tap *taps; // [edge]: the two texels between which each point of a row or column lies
    // [edge * edge]: solid angle of the points of a face, up to a constant factor
    double *solid;
    double *matrix; // planes, one for each of the elements above
    // Planes of a cube (tune_faces.h). `right` is B' W goal; `share` is B' W 1, the weight of each
    // texel in the mean of what is read; `inverse` is 1 over the diagonal of the matrix, and 0 for
    // texels that are fixed at 0.
    double *right, *share, *inverse;
    // The solution, the residual of the equations, the search direction, and the matrix times that
    // direction or, after a step, the residual times `inverse`.
    double *x, *residual, *direction, *product;
    double *lines;          // [KI_PLANES][width]: a line of texels for each task
    double sums[KI_PLANES]; // a sum over each plane, which tasks write
    double length[3], turn[3];
} reads;

// CLEARED: number of cubes that begin as zeros: those that are added to before they are written,
// and those that multiply_plane reads beyond their planes.
enum { CUBES = 7, CLEARED = 3 };

static kiln_result allocate(reads *r, kiln_error *error)
{
    kiln_context *k = r->context;
    const ki_faces *f = &r->faces;
    size_t edge = (size_t)r->edge, each = ki_faces_count(f);
    r->taps = ki_alloc_raw(k, edge, sizeof *r->taps);
    r->solid = ki_alloc_raw(k, edge * edge, sizeof *r->solid);
    r->matrix = ki_alloc(k, NEIGHBOURS * f->stride + f->guard, sizeof *r->matrix);
    r->lines = ki_alloc_raw(k, KI_PLANES * (size_t)f->width, sizeof *r->lines);
    double **cubes[CUBES] = {&r->right,   &r->x,        &r->direction, &r->share,
                             &r->inverse, &r->residual, &r->product};
    bool done = r->taps && r->solid && r->matrix && r->lines;
    for (int i = 0; i < CUBES; i++) {
        *cubes[i] =
            i < CLEARED ? ki_alloc(k, each, sizeof(double)) : ki_alloc_raw(k, each, sizeof(double));
        done = done && *cubes[i];
    }
    return done ? KILN_OK
                : ki_fail_memory(k, error, "a level's reads", CUBES * each * sizeof(double));
}

static void release(reads *r)
{
    ki_faces_destroy(&r->faces);
    ki_free(r->taps);
    ki_free(r->solid);
    ki_free(r->matrix);
    ki_free(r->lines);
    double *const cubes[CUBES] = {r->right,    r->share,     r->inverse, r->x,
                                  r->residual, r->direction, r->product};
    for (int i = 0; i < CUBES; i++)
        ki_free(cubes[i]);
}

// ------------------------------------------------------------------------------------------ set up

static double *matrix_plane(const reads *r, int neighbour)
{
    return ki_faces_plane(&r->faces, r->matrix, neighbour);
}

static void place_points(reads *r)
{
    double ratio = (double)r->edge / r->faces.size;
    ki_face_taps_set(&r->faces, r->edge, r->taps);
    double *solid = r->solid;
    for (int y = 0; y < r->edge; y++)
        for (int x = 0; x < r->edge; x++) {
            // A texel's solid angle is proportional to 1 / d^3, where d is the distance from the
            // cube's centre to the texel on a face at distance 1.
            double s = (2 * x + 1.0) / r->edge - 1, t = (2 * y + 1.0) / r->edge - 1;
            double squared = 1 + s * s + t * t;
            *solid++ = 1 / (squared * sqrt(squared) * ratio * ratio);
        }
}

static void add_scaled(double *to, const double *from, double factor, int count)
{
    for (int i = 0; i < count; i++)
        to[i] += factor * from[i];
}

// Adds a row of points to the elements of the matrix of the two rows of texels between which the
// points lie. `own` and `east` receive the row's sums over columns, for the products of each
// texel's weights with themselves and with those of the eastern neighbour.
static void add_matrix_row(reads *r, int y, double *own, double *east)
{
    int width = r->faces.width;
    const double *solid = r->solid + (size_t)r->edge * (size_t)y;
    memset(own, 0, (size_t)width * sizeof *own);
    memset(east, 0, (size_t)width * sizeof *east);
    for (int x = 0; x < r->edge; x++) {
        const ki_face_tap *tap = &r->taps[x];
        double a = tap->share[0], b = tap->share[1];
        own[tap->first] += solid[x] * a * a;
        own[tap->first + 1] += solid[x] * b * b;
        east[tap->first] += solid[x] * a * b;
    }
    double a = r->taps[y].share[0], b = r->taps[y].share[1];
    size_t row = (size_t)r->taps[y].first * (size_t)width, next = row + (size_t)width;
    add_scaled(matrix_plane(r, SELF) + row, own, a * a, width);
    add_scaled(matrix_plane(r, SELF) + next, own, b * b, width);
    add_scaled(matrix_plane(r, EAST) + row, east, a * a, width);
    add_scaled(matrix_plane(r, EAST) + next, east, b * b, width);
    add_scaled(matrix_plane(r, SOUTH) + row, own, a * b, width);
    add_scaled(matrix_plane(r, SOUTH_EAST) + row, east, a * b, width);
    add_scaled(matrix_plane(r, SOUTH_WEST) + row + 1, east, a * b, width - 1);
}

static void make_matrix(reads *r)
{
    for (int y = 0; y < r->edge; y++)
        add_matrix_row(r, y, r->lines, r->lines + r->faces.width);
}

// Adds a row of points of a face and channel, times the points' solid angles, to the two rows of
// texels between which the points lie. `from` is the goal at the first point; `line` receives the
// sums over columns; `plane` is the texels' plane.
static void gather_row(const reads *r, const float *from, int y, double *line, double *plane)
{
    int width = r->faces.width;
    const double *solid = r->solid + (size_t)r->edge * (size_t)y;
    memset(line, 0, (size_t)width * sizeof *line);
    for (ptrdiff_t x = 0; x < r->edge; x++) {
        const ki_face_tap *tap = &r->taps[x];
        double value = (double)from[3 * x] * solid[x];
        line[tap->first] += tap->share[0] * value;
        line[tap->first + 1] += tap->share[1] * value;
    }
    double *to = plane + (size_t)r->taps[y].first * (size_t)width;
    add_scaled(to, line, r->taps[y].share[0], width);
    add_scaled(to + width, line, r->taps[y].share[1], width);
}

// Task of one thread: computes a plane of B' W goal, in which the rim has what belongs to the
// texels of other faces.
static void gather_plane(void *data, int plane)
{
    const reads *r = data;
    size_t edge = (size_t)r->edge, first = 3 * edge * edge * (size_t)(plane / 3);
    double *line = r->lines + (size_t)plane * (size_t)r->faces.width;
    double *to = ki_faces_plane(&r->faces, r->right, plane);
    for (int y = 0; y < r->edge; y++)
        gather_row(r, r->goal + first + 3 * edge * (size_t)y + plane % 3, y, line, to);
}

// ---------------------------------------------------------------------------------- the equations

// Runs a task for each plane.
static void for_planes(reads *r, ki_task *task)
{
    if (r->faces.size > SMALL) {
        ki_parallel_for(r->context, KI_PLANES, task, r);
        return;
    }
    for (int plane = 0; plane < KI_PLANES; plane++)
        task(r, plane);
}

static void for_rims(const reads *r, double *planes,
                     void (*use)(const ki_faces *faces, double *planes, int plane))
{
    for (int plane = 0; plane < KI_PLANES; plane++)
        use(&r->faces, planes, plane);
}

// Multiplies a plane by the matrix: each texel's element with itself and with its eight neighbours.
static void multiply_plane(const reads *r, const double *restrict from, double *restrict to)
{
    const double *restrict self = matrix_plane(r, SELF), *restrict east = matrix_plane(r, EAST);
    const double *restrict south = matrix_plane(r, SOUTH);
    const double *restrict left = matrix_plane(r, SOUTH_WEST);
    const double *restrict right = matrix_plane(r, SOUTH_EAST);
    ptrdiff_t w = r->faces.width, count = (ptrdiff_t)r->faces.plane;
    for (ptrdiff_t i = 0; i < count; i++) {
        double row = self[i] * from[i] + (east[i] * from[i + 1] + east[i - 1] * from[i - 1]);
        double below =
            south[i] * from[i + w] + (left[i] * from[i + w - 1] + right[i] * from[i + w + 1]);
        double above = south[i - w] * from[i - w] +
                       (left[i - w + 1] * from[i - w + 1] + right[i - w - 1] * from[i - w - 1]);
        to[i] = row + (below + above);
    }
}

// Returns the sum of a_i b_i.
static double dot(const double *a, const double *b, size_t count)
{
    enum { LANES = 8 };
    double lanes[LANES] = {0}, sum = 0;
    size_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (size_t k = 0; k < LANES; k++)
            lanes[k] += a[i + k] * b[i + k];
    for (; i < count; i++)
        sum += a[i] * b[i];
    return sum + (((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
                  ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7])));
}

static void add_up(const reads *r, double sum[3])
{
    memset(sum, 0, 3 * sizeof *sum);
    for (int plane = 0; plane < KI_PLANES; plane++)
        sum[plane % 3] += r->sums[plane];
}

// Rows of one plane: texels of one row of a face in each of the cubes that the solver uses.
typedef struct row {
    const double *right, *share;
    double *inverse, *x, *residual, *direction, *product;
} row;

static row row_at(const reads *r, int plane, int y)
{
    const ki_faces *f = &r->faces;
    size_t at =
        (size_t)(ki_faces_plane(f, r->x, plane) - r->x) + (size_t)(y + 1) * (size_t)f->width + 1;
    return (row){r->right + at,    r->share + at,     r->inverse + at, r->x + at,
                 r->residual + at, r->direction + at, r->product + at};
}

// Task of one thread: computes the next search direction of the conjugate-gradient method in a
// plane, and copies it to the rims that repeat the plane's texels.
static void turn_direction(void *data, int plane)
{
    reads *r = data;
    double turn = r->turn[plane % 3];
    for (int y = 0; y < r->faces.size; y++) {
        row at = row_at(r, plane, y);
        for (int x = 0; x < r->faces.size; x++)
            at.direction[x] = at.product[x] + turn * at.direction[x];
    }
    ki_faces_fill_rims(&r->faces, r->direction, plane);
}

// Task of one thread: multiplies the search direction in a plane by the matrix, without what other
// planes add to it, and sums the direction times the product.
static void multiply_direction(void *data, int plane)
{
    reads *r = data;
    const double *from = ki_faces_plane(&r->faces, r->direction, plane);
    double *to = ki_faces_plane(&r->faces, r->product, plane);
    multiply_plane(r, from, to);
    r->sums[plane] = dot(from, to, r->faces.plane);
}

// Task of one thread: moves the texels of a plane along the search direction and updates their
// residual. Sums the squared residual over the diagonal of the matrix.
static void take_step(void *data, int plane)
{
    reads *r = data;
    double length = r->length[plane % 3];
    r->sums[plane] = 0;
    ki_faces_add_rims(&r->faces, r->product, plane);
    for (int y = 0; y < r->faces.size; y++) {
        row at = row_at(r, plane, y);
        for (int x = 0; x < r->faces.size; x++) {
            at.x[x] += length * at.direction[x];
            at.residual[x] -= length * at.product[x];
            at.product[x] = at.residual[x] * at.inverse[x];
        }
        r->sums[plane] += dot(at.residual, at.product, (size_t)r->faces.size);
    }
}

// Task of one thread: sets the residual of a plane, right - matrix x, and sums it as take_step
// does.
static void begin_steps(void *data, int plane)
{
    reads *r = data;
    r->sums[plane] = 0;
    ki_faces_add_rims(&r->faces, r->product, plane);
    for (int y = 0; y < r->faces.size; y++) {
        row at = row_at(r, plane, y);
        for (int x = 0; x < r->faces.size; x++) {
            at.residual[x] = at.right[x] - at.product[x];
            at.product[x] = at.residual[x] * at.inverse[x];
        }
        r->sums[plane] += dot(at.residual, at.product, (size_t)r->faces.size);
    }
}

// Task of one thread: multiplies the texels x of a plane by the matrix.
static void multiply_texels(void *data, int plane)
{
    reads *r = data;
    multiply_plane(r, ki_faces_plane(&r->faces, r->x, plane),
                   ki_faces_plane(&r->faces, r->product, plane));
}

// -------------------------------------------------------------------------------------- the solver

// Solves the normal equations by at most STEPS steps of preconditioned conjugate gradients in each
// colour channel. Texels with `inverse` 0 keep the value 0 and have no equation.
static void solve(reads *r)
{
    double first[3], norm[3], next[3], along[3];
    for_rims(r, r->x, ki_faces_fill_rims);
    for_planes(r, multiply_texels);
    for_planes(r, begin_steps);
    add_up(r, norm);
    memcpy(first, norm, sizeof first);
    memset(r->turn, 0, sizeof r->turn);
    bool far = true;
    for (int i = 0; i < STEPS && far; i++) {
        for_planes(r, turn_direction);
        for_planes(r, multiply_direction);
        add_up(r, along);
        for (int c = 0; c < 3; c++)
            r->length[c] = along[c] > 0 ? norm[c] / along[c] : 0;
        for_planes(r, take_step);
        add_up(r, next);
        far = false;
        for (int c = 0; c < 3; c++) {
            far = far || next[c] > near * first[c];
            r->turn[c] = norm[c] > 0 ? next[c] / norm[c] : 0;
            norm[c] = next[c];
        }
    }
}

// Task of one thread: sets the negative texels of a plane to 0, fixes them at 0 for the next round,
// and sums their number.
static void hold(void *data, int plane)
{
    reads *r = data;
    r->sums[plane] = 0;
    for (int y = 0; y < r->faces.size; y++) {
        row at = row_at(r, plane, y);
        for (int x = 0; x < r->faces.size; x++) {
            if (at.x[x] >= 0)
                continue;
            at.x[x] = at.inverse[x] = 0;
            r->sums[plane]++;
        }
    }
}

// Task of one thread: sets in a plane the inverse diagonal of the matrix, and as the first guess of
// the solution the weighted mean of the goal over the points that read each texel.
static void begin_plane(void *data, int plane)
{
    reads *r = data;
    ki_faces_add_rims(&r->faces, r->inverse, plane);
    ki_faces_add_rims(&r->faces, r->right, plane);
    ki_faces_add_rims(&r->faces, r->share, plane);
    for (int y = 0; y < r->faces.size; y++) {
        row at = row_at(r, plane, y);
        for (int x = 0; x < r->faces.size; x++) {
            double guess = at.right[x] / at.share[x];
            at.inverse[x] = 1 / at.inverse[x];
            at.x[x] = guess > 0 ? guess : 0;
        }
    }
}

// Sets up the equations. The weights of a read add up to 1, so that B' W 1 is the matrix times 1.
static void set_up(reads *r)
{
    place_points(r);
    make_matrix(r);
    double *ones = ki_faces_plane(&r->faces, r->x, 0), *self = matrix_plane(r, SELF);
    for (size_t i = 0; i < r->faces.plane; i++)
        ones[i] = 1;
    for (int plane = 0; plane < KI_PLANES; plane++) {
        multiply_plane(r, ones, ki_faces_plane(&r->faces, r->share, plane));
        memcpy(ki_faces_plane(&r->faces, r->inverse, plane), self, r->faces.plane * sizeof *self);
    }
    for_planes(r, gather_plane);
    for_planes(r, begin_plane);
}

// Task of one thread: sums the right-hand side over a plane, which for each channel gives the mean
// of the goal, up to the factor that sum_shown has too.
static void sum_goal(void *data, int plane)
{
    reads *r = data;
    double sum = 0;
    for (int y = 0; y < r->faces.size; y++) {
        row at = row_at(r, plane, y);
        for (int x = 0; x < r->faces.size; x++)
            sum += at.right[x];
    }
    r->sums[plane] = sum;
}

// Task of one thread: sums the texels of a plane times their weights in the mean of what is read.
static void sum_shown(void *data, int plane)
{
    reads *r = data;
    r->sums[plane] = 0;
    for (int y = 0; y < r->faces.size; y++) {
        row at = row_at(r, plane, y);
        r->sums[plane] += dot(at.x, at.share, (size_t)r->faces.size);
    }
}

// Writes the solution, scaled such that the mean of what is read is the goal's, as RGB texels.
static void write_texels(reads *r, float *texels)
{
    double goal[3], shown[3];
    size_t n = (size_t)r->faces.size;
    for_planes(r, sum_goal);
    add_up(r, goal);
    for_planes(r, sum_shown);
    add_up(r, shown);
    for (int plane = 0; plane < KI_PLANES; plane++) {
        int c = plane % 3;
        double scale = goal[c] > 0 && shown[c] > 0 ? goal[c] / shown[c] : 1;
        for (int y = 0; y < r->faces.size; y++) {
            const double *x = row_at(r, plane, y).x;
            float *to = texels + 3 * n * (n * (size_t)(plane / 3) + (size_t)y) + c;
            for (size_t i = 0; i < n; i++)
                to[3 * i] = (float)(x[i] * scale);
        }
    }
}

kiln_result ki_solve_texels(kiln_context *context, const kiln_map *goal, kiln_map *map, int index,
                            kiln_error *error)
{
    reads r = {.context = context, .goal = goal->level[0], .edge = goal->size};
    kiln_result result = ki_faces_create(context, kiln_map_level_size(map, index), &r.faces, error);
    if (result == KILN_OK)
        result = allocate(&r, error);
    if (result == KILN_OK) {
        set_up(&r);
        double held[3] = {1};
        for (int i = 0; i < ROUNDS && held[0] + held[1] + held[2] > 0; i++) {
            solve(&r);
            for_planes(&r, hold);
            add_up(&r, held);
        }
        write_texels(&r, map->level[index]);
    }
    release(&r);
    return result;
}
