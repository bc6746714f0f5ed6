// Monte Carlo integration of a view. In: view_options and an unfiltered environment. Out: a picture
// of linear radiance, whose pixels reach a wanted standard error, and a report of that noise.
//
// A pixel is the mean over the same n x n rays as in the real-time picture. Where a ray meets a
// ball, one batch draws three directions l: from the environment's power (density p1), from the
// visible normals (p2) and from the cosine (p3). The balance heuristic (Veach 1997, section 9.2.2)
// weights them:
//
//     L(v) = int f(v, l) L(l) (n.l) dl  ~  sum over the three l of  f L (n.l) / (p1 + p2 + p3)
//
// Where l meets another ball, L is the light that the other ball reflects, estimated by one of the
// three kinds of draw chosen at random, until the path leaves the scene. A pixel is the mean of as
// many batches as its wanted standard error needs.
#include "reference.h"

#include "internal.h"
#include "trace.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_RAYS = 64, FIRST_TRIAL = 32, MAX_THREADS = 256, SURE = 8 };

typedef struct job {
    const view_options *options;
    int width, height, side;
    double noise;
    int batch_limit, bounces;
    bool alone;
    // true for a ball whose bounces after the first between microfacets are computed by
    // view_walk_add
    bool walks[VIEW_MAX_BALLS + 1];
    double eye[3], right[3], up[3], back[3], slope;
    // the balls, then the ground, whose lobes find_ground sets
    view_ball balls[VIEW_MAX_BALLS + 1];
    int ball_count;
    bool has_ground;
    view_plane ground;
    view_light light;
    view_energy energy;
    kiln_image *image, *deviation; // deviation: NULL if the caller wants none
    // one report for each row of pixels, which holds sums where the final report has means
    view_reference_report *rows;
    atomic_int next;
    atomic_bool stop;
} job;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// -------------------------------------------------------------------------------------------- rays

static void ray_at(const job *j, double x, double y, double d[3])
{
    double sx = 2 * x / j->width - 1, sy = 1 - 2 * y / j->height;
    double wide = j->slope * j->width / j->height, size = 0;
    for (int c = 0; c < 3; c++) {
        d[c] = sx * wide * j->right[c] + sy * j->slope * j->up[c] - j->back[c];
        size += d[c] * d[c];
    }
    for (int c = 0; c < 3; c++)
        d[c] /= sqrt(size);
}

// Distance from `from` along the unit vector d to the ball; negative where the ray misses the ball.
// `closest` is the point of the ray's line nearest to the ball's centre, relative to that centre.
static double meet(const view_ball *ball, const double from[3], const double d[3],
                   double closest[3])
{
    double offset[3];
    for (int c = 0; c < 3; c++)
        offset[c] = from[c] - ball->centre[c];
    double along = dot(offset, d);
    for (int c = 0; c < 3; c++)
        closest[c] = offset[c] - along * d[c];
    double rest = ball->radius * ball->radius - dot(closest, closest);
    return rest > 0 ? -along - sqrt(rest) : -1;
}

// Two unit tangents of the unit normal n, without a branch: Duff et al. 2017.
static void tangents(const double n[3], double t[3], double b[3])
{
    double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), c = n[0] * n[1] * a;
    t[0] = 1 + sign * n[0] * n[0] * a;
    t[1] = sign * c;
    t[2] = -sign * n[0];
    b[0] = c;
    b[1] = sign + n[1] * n[1] * a;
    b[2] = -n[1];
}

// Finds the nearest ball that a ray from `from` along d meets, except ball `leaves`, on which the
// ray starts (-1: the ray starts on no ball). p->ball is -1 if the ray meets no ball.
static void find_point(const job *j, const double from[3], const double d[3], int leaves,
                       view_point *p)
{
    double reach = 1e30, closest[3], found[3] = {0};
    p->ball = -1;
    memcpy(p->ray, d, sizeof p->ray);
    for (int i = 0; i < j->ball_count; i++) {
        if (i == leaves)
            continue;
        double t = meet(&j->balls[i], from, d, closest);
        if (t > 0 && t < reach) {
            reach = t;
            p->ball = i;
            memcpy(found, closest, sizeof found);
        }
    }
    if (p->ball < 0)
        return;
    const view_ball *ball = &j->balls[p->ball];
    double half_chord = sqrt(ball->radius * ball->radius - dot(found, found));
    for (int c = 0; c < 3; c++) {
        p->position[c] = ball->centre[c] + found[c] - half_chord * d[c];
        p->n[c] = (found[c] - half_chord * d[c]) / ball->radius;
    }
    tangents(p->n, p->t, p->b);
    p->v[0] = -dot(p->t, d);
    p->v[1] = -dot(p->b, d);
    p->v[2] = half_chord / ball->radius;
    view_point_prepare(ball, &j->energy, p);
}

// Makes p the point where a ray from the eye meets the ground, if the ray met no ball. Only rays
// from the eye meet the ground.
static void find_ground(const job *j, const double d[3], view_point *p)
{
    double above = j->eye[1] - j->ground.height;
    if (p->ball >= 0 || !j->has_ground || above <= 0 || d[1] >= 0)
        return;
    *p = (view_point){.ball = j->ball_count, .n = {0, 1, 0}};
    tangents(p->n, p->t, p->b);
    memcpy(p->ray, d, sizeof p->ray);
    for (int c = 0; c < 3; c++) {
        p->position[c] = j->eye[c] - d[c] * above / d[1];
        p->diffuse[c] = j->ground.albedo;
    }
    p->v[0] = -dot(p->t, d);
    p->v[1] = -dot(p->b, d);
    p->v[2] = -d[1];
}

// ------------------------------------------------------------------------------------------- light

static bool is_shaded(const job *j, const view_point *p, const double d[3])
{
    double closest[3];
    for (int i = 0; i < j->ball_count; i++)
        if (i != p->ball && meet(&j->balls[i], p->position, d, closest) > 0)
            return true;
    return false;
}

static void estimate_one(const job *j, const view_point *p, int depth, view_random *random,
                         double sum[3]);

// Radiance that arrives at p from direction d. The path has met `depth` balls, p's included.
static void incoming(const job *j, const view_point *p, int depth, const double d[3],
                     view_random *random, double radiance[3])
{
    view_point from = {.ball = -1};
    radiance[0] = radiance[1] = radiance[2] = 0;
    bool shade = j->options->occlusion || p->ball == j->ball_count; // balls always shade the ground
    if (j->alone && shade && is_shaded(j, p, d))
        return;
    if (!j->alone)
        find_point(j, p->position, d, p->ball, &from);
    if (from.ball < 0) {
        view_light_radiance(&j->light, d, radiance);
        return;
    }
    // Russian roulette: a path that has met SURE balls continues with probability 0.75.
    double chance = depth < SURE ? 1 : 0.75;
    if (depth == j->bounces || (chance < 1 && view_random_next(random) >= chance))
        return;
    estimate_one(j, &from, depth + 1, random, radiance);
    for (int c = 0; c < 3; c++)
        radiance[c] /= chance;
}

static void to_world(const view_point *p, const double l[3], double d[3])
{
    for (int c = 0; c < 3; c++)
        d[c] = l[0] * p->t[c] + l[1] * p->b[c] + l[2] * p->n[c];
}

static double pdf_specular(const view_ball *ball, const view_point *p, const double l[3])
{
    double h[3], size = 0;
    for (int c = 0; c < 3; c++) {
        h[c] = l[c] + p->v[c];
        size += h[c] * h[c];
    }
    size = sqrt(size);
    if (ball->roughness <= 0 || l[2] <= 0)
        return 0;
    double voh = fmin(size / 2, 1), noh = fmin(h[2] / size, 1);
    return kiln_pdf_reflection(kiln_pdf_visible(ball->roughness, p->v[2], noh, voh), voh);
}

// The point where a path is reflected, with what its draws need.
typedef struct vertex {
    const job *j;
    const view_point *p;
    int depth;
    // weight of one draw: 1 if all three kinds of draw are made, 3 if only one kind is drawn
    double share;
} vertex;

// Adds the light that arrives from l, divided by the sum of the three densities with which the
// kinds of draw would have chosen l.
static void add(const vertex *v, const double l[3], view_random *random, double sum[3])
{
    const job *j = v->j;
    const view_point *p = v->p;
    const view_ball *ball = &j->balls[p->ball];
    double f[3], radiance[3], d[3];
    if (l[2] <= 0)
        return;
    to_world(p, l, d);
    view_reflect(ball, &j->energy, p, l, f);
    double pdf = view_light_pdf(&j->light, d) + pdf_specular(ball, p, l) + kiln_pdf_cosine(l[2]);
    if (!(pdf > 0))
        return;
    incoming(j, p, v->depth, d, random, radiance);
    for (int c = 0; c < 3; c++)
        sum[c] += v->share * f[c] * radiance[c] / pdf;
}

static void draw(view_random *random, double xi[2])
{
    xi[0] = view_random_next(random);
    xi[1] = view_random_next(random);
}

static void reflect(const double v[3], const double h[3], double l[3])
{
    double voh = dot(v, h);
    for (int c = 0; c < 3; c++)
        l[c] = 2 * voh * h[c] - v[c];
}

static void add_light(const vertex *v, view_random *random, double sum[3])
{
    double xi[2], d[3];
    draw(random, xi);
    view_light_sample(&v->j->light, xi, d);
    const double l[3] = {dot(d, v->p->t), dot(d, v->p->b), dot(d, v->p->n)};
    add(v, l, random, sum);
}

static void add_specular(const vertex *v, view_random *random, double sum[3])
{
    const view_point *p = v->p;
    const view_ball *ball = &v->j->balls[p->ball];
    double xi[2], h[3], l[3], d[3], f[3], radiance[3], up[3] = {0, 0, 1};
    draw(random, xi);
    if (ball->roughness > 0) {
        kiln_sample_visible(ball->roughness, p->v, xi, h);
        reflect(p->v, h, l);
        add(v, l, random, sum);
        return;
    }
    // A perfect mirror reflects one direction only, which no random draw hits.
    reflect(p->v, up, l);
    to_world(p, l, d);
    incoming(v->j, p, v->depth, d, random, radiance);
    view_fresnel(ball, &v->j->energy, p->v[2], f);
    for (int c = 0; c < 3; c++)
        sum[c] += v->share * f[c] * radiance[c] * p->specular[c];
}

static void add_diffuse(const vertex *v, view_random *random, double sum[3])
{
    double xi[2], l[3];
    draw(random, xi);
    kiln_sample_cosine(xi, l);
    add(v, l, random, sum);
}

static void walk_incoming(void *user, const double d[3], view_random *random, double radiance[3])
{
    const vertex *v = user;
    incoming(v->j, v->p, v->depth, d, random, radiance);
}

static void add_walk(vertex *v, view_random *random, double sum[3])
{
    const job *j = v->j;
    view_walk walk = {&j->balls[v->p->ball], &j->light, &j->energy, walk_incoming, v};
    if (j->walks[v->p->ball])
        view_walk_add(&walk, v->p, random, sum);
}

static void estimate(const job *j, const view_point *p, view_random *random, double sum[3])
{
    vertex v = {j, p, 1, 1};
    add_light(&v, random, sum);
    add_specular(&v, random, sum);
    add_diffuse(&v, random, sum);
    add_walk(&v, random, sum);
}

static void estimate_one(const job *j, const view_point *p, int depth, view_random *random,
                         double sum[3])
{
    vertex v = {j, p, depth, 3};
    double which = 3 * view_random_next(random);
    if (which < 1)
        add_light(&v, random, sum);
    else if (which < 2)
        add_specular(&v, random, sum);
    else
        add_diffuse(&v, random, sum);
    add_walk(&v, random, sum);
}

// ------------------------------------------------------------------------------------------ pixels

// Computes the radiance of rays that need no integration: the sky behind the balls, and balls under
// the GAMES202 assignment's light. Returns false for a ball in an environment.
static bool shines(const job *j, const view_point *p, double radiance[3])
{
    radiance[0] = radiance[1] = radiance[2] = 0;
    bool light = j->options->scene == VIEW_SCENE_ASSIGNMENT;
    if (p->ball < 0 && !light)
        view_light_radiance(&j->light, p->ray, radiance);
    else if (p->ball >= 0 && light)
        view_reflect_light(j->options, &j->balls[p->ball], &j->energy, p, radiance);
    return p->ball < 0 || light;
}

typedef struct tally {
    double mean[3], squares[3]; // Welford's running mean, and the sum of squared deviations from it
    int count;
} tally;

static void note(tally *t, const double x[3])
{
    t->count++;
    for (int c = 0; c < 3; c++) {
        double from = x[c] - t->mean[c];
        t->mean[c] += from / t->count;
        t->squares[c] += from * (x[c] - t->mean[c]);
    }
}

// Standard error of the mean, relative to the mean plus `floor`, in the worst channel. The floor
// keeps black pixels from being sampled for ever.
static double noise_of(const tally *t, double floor)
{
    double worst = 0;
    for (int c = 0; c < 3; c++)
        worst = fmax(worst, sqrt(t->squares[c] / (t->count - 1.0) / t->count) /
                                (fabs(t->mean[c]) + floor + 1e-30));
    return worst;
}

// The rays of a pixel that meet a ball or the ground, and what the other rays see.
typedef struct rays {
    view_point points[MAX_RAYS];
    int waiting, count; // rays that meet something, and all rays
    double fixed[3];    // part of the pixel's radiance that needs no integration
} rays;

static void cast_rays(const job *j, int x, int y, rays *r)
{
    r->waiting = 0;
    r->count = j->side * j->side;
    r->fixed[0] = r->fixed[1] = r->fixed[2] = 0;
    for (int i = 0; i < r->count; i++) {
        double d[3], radiance[3];
        int across = i % j->side, down = i / j->side;
        view_point *p = &r->points[r->waiting];
        ray_at(j, x + (across + 0.5) / j->side, y + (down + 0.5) / j->side, d);
        find_point(j, j->eye, d, -1, p);
        find_ground(j, d, p);
        if (!shines(j, p, radiance))
            r->waiting++;
        for (int c = 0; c < 3; c++)
            r->fixed[c] += radiance[c] / r->count;
    }
}

// Draws `count` batches, and starts the tally with them.
static void draw_batches(const job *j, const rays *r, int count, view_random *random, tally *t)
{
    *t = (tally){0};
    while (t->count < count) {
        double sum[3] = {0};
        for (int i = 0; i < r->waiting; i++)
            estimate(j, &r->points[i], random, sum);
        for (int c = 0; c < 3; c++)
            sum[c] = sum[c] / r->count + r->fixed[c];
        note(t, sum);
    }
}

// Draws as many batches as the wanted noise needs. Trials of 32, 128, 512 ... batches tell how many
// these are, and the pixel's mean contains the last batches only: a mean of the batches that also
// decided the number of batches would be biased, since few batches suffice where the estimated
// variance happens to be small, and this variance depends on the estimated mean.
static void integrate(const job *j, const rays *r, view_random *random, tally *t,
                      view_reference_report *report)
{
    // The standard error is itself estimated, with an error of 10 % or so: aim below the wanted
    // noise.
    const double small = 0.02 * j->light.mean, aim = 0.9 * j->noise;
    double needed;
    int trial = FIRST_TRIAL < j->batch_limit ? FIRST_TRIAL : j->batch_limit;
    for (;; trial *= 4) {
        draw_batches(j, r, trial, random, t);
        report->batches += trial;
        double noise = noise_of(t, small);
        needed = ceil(trial * (noise / aim) * (noise / aim));
        if (needed <= 4.0 * trial || 4.0 * trial >= j->batch_limit)
            break;
    }
    int count = (int)fmin(fmax(needed, FIRST_TRIAL), j->batch_limit);
    draw_batches(j, r, count, random, t);
    double noise = noise_of(t, small);
    report->noise += noise * noise;
    report->batches += count;
    report->pixel_count++;
    report->noisy_count += needed > j->batch_limit;
}

static void pixel(job *j, int x, int y, view_reference_report *report, float *out, float *deviation)
{
    rays r;
    tally t = {0};
    view_random random;
    view_random_start(&random, (uint64_t)y * (uint64_t)j->width + (uint64_t)x);
    cast_rays(j, x, y, &r);
    if (r.waiting)
        integrate(j, &r, &random, &t, report);
    for (int c = 0; c < 3; c++)
        out[c] = (float)(r.waiting ? t.mean[c] : r.fixed[c]);
    for (int c = 0; c < 3 && deviation && r.waiting; c++)
        deviation[c] = (float)sqrt(t.squares[c] / (t.count - 1.0) / t.count);
}

// ----------------------------------------------------------------------------------------- threads

static bool take_row(job *j)
{
    int y = atomic_fetch_add(&j->next, 1);
    if (y >= j->height || atomic_load(&j->stop))
        return false;
    for (int x = 0; x < j->width && !atomic_load(&j->stop); x++) {
        size_t at = ((size_t)y * (size_t)j->width + (size_t)x) * 3;
        pixel(j, x, y, &j->rows[y], j->image->pixels + at,
              j->deviation ? j->deviation->pixels + at : NULL);
    }
    return true;
}

static void *help(void *data)
{
    while (take_row(data))
        ;
    return NULL;
}

// Renders the rows with several threads. The calling thread renders too, and reports progress.
static bool run(job *j, const view_reference_def *def)
{
    pthread_t threads[MAX_THREADS];
    int wanted = def->thread_count, count = 0;
    if (wanted < 1)
        wanted = (int)sysconf(_SC_NPROCESSORS_ONLN);
    wanted = wanted > MAX_THREADS ? MAX_THREADS : wanted;
    while (count < wanted - 1 && pthread_create(&threads[count], NULL, help, j) == 0)
        count++;
    do {
        double part = fmin(1, (double)atomic_load(&j->next) / j->height);
        if (def->progress && !def->progress(def->progress_user, "reference", part))
            atomic_store(&j->stop, true);
    } while (take_row(j));
    for (int i = 0; i < count; i++)
        pthread_join(threads[i], NULL);
    return !atomic_load(&j->stop);
}

static void sum_up(const job *j, view_reference_report *report)
{
    view_reference_report all = {0};
    for (int y = 0; y < j->height; y++) {
        all.noise += j->rows[y].noise;
        all.batches += j->rows[y].batches;
        all.pixel_count += j->rows[y].pixel_count;
        all.noisy_count += j->rows[y].noisy_count;
    }
    if (all.pixel_count) {
        all.noise = sqrt(all.noise / (double)all.pixel_count);
        all.batches /= (double)all.pixel_count;
    }
    *report = all;
}

kiln_result view_reference(kiln_context *context, const view_options *options,
                           const kiln_map *source, int width, int height,
                           const view_reference_def *def, kiln_image *image,
                           view_reference_report *report, kiln_error *error)
{
    static const double degree = 0.017453292519943295;
    const view_reference_def none = {0};
    def = def ? def : &none;
    *image = (kiln_image){0};
    if (def->deviation)
        *def->deviation = (kiln_image){0};
    bool white = options->scene == VIEW_SCENE_FURNACE;
    job j = {
        .options = options,
        .width = width,
        .height = height,
        .side = options->samples < 1   ? 1
                : options->samples > 8 ? 8
                                       : options->samples,
        .noise = def->noise > 0 ? def->noise : 0.01,
        .batch_limit = def->batch_limit > 1 ? def->batch_limit : 16384,
        .bounces = def->bounces,
        // in the furnace scene the two rows of balls do not reflect each other, so that each ball
        // sees white alone
        .alone = def->alone || white,
        .slope = tan(options->camera.fov / 2 * degree),
        .image = image,
        .deviation = def->deviation,
    };
    view_camera_axes(&options->camera, j.eye, j.right, j.up, j.back);
    j.ball_count = view_balls(options, j.balls);
    j.has_ground = view_ground(options, &j.ground);
    j.balls[j.ball_count] = (view_ball){.roughness = 1, .method = VIEW_METHOD_SINGLE};
    for (int i = 0; i < j.ball_count && def->walk; i++) {
        j.walks[i] = j.balls[i].method != VIEW_METHOD_SINGLE;
        j.balls[i].method = VIEW_METHOD_SINGLE;
    }
    kiln_result result = kiln_image_create(context, width, height, 3, image, error);
    if (result == KILN_OK && def->deviation)
        result = kiln_image_create(context, width, height, 3, def->deviation, error);
    j.rows = result == KILN_OK ? calloc((size_t)height, sizeof *j.rows) : NULL;
    if (result == KILN_OK && !j.rows)
        result = view_fail(error, KILN_ERROR_MEMORY, "out of memory");
    if (result == KILN_OK)
        result =
            view_light_create(context, white ? NULL : source, options->rotation, &j.light, error);
    if (result == KILN_OK) {
        view_disc discs[KILN_MAX_LIGHTS];
        view_light_add(&j.light, discs, view_discs(options, def->lights, discs));
        result = view_energy_create(context, options, &j.energy, error);
    }
    if (result == KILN_OK && !run(&j, def))
        result = view_fail(error, KILN_ERROR_CANCELLED, "cancelled during reference");
    if (result == KILN_OK && report)
        sum_up(&j, report);
    if (result != KILN_OK)
        kiln_image_free(image);
    if (result != KILN_OK && def->deviation)
        kiln_image_free(def->deviation);
    view_energy_free(&j.energy);
    view_light_free(&j.light);
    free(j.rows);
    return result;
}
