// The program bench_lobe_parts: where the errors of reflections from a few lookups come from. In:
// panoramas. Out: lines of CSV, one for each panorama and way to look reflections up, with RMS errors
// on the screen in steps of 255, each the mean over gold balls of roughness 0.35 to 0.95. The lookups
// are those of the renderer, and all else is computed at the same points, without random samples and
// so without noise:
//
//   all      the lookups, against brute force over the environment with the metal's own F
//   fresnel  brute force over the lobe with F = 1, which serves both parts of the split sum, against
//            brute force with F
//   levels   the lookups, against brute force over the lobes of the same levels in the same
//            directions: what texels, their interpolation and small tables of albedo cost
//   table    the lookups, against those of a table of 64 x 64 texels
//   horizon  what the levels' lobes and the correction take from below the surface
//   shape    brute force over these lobes above the surface, against that over the true lobe with F = 1
//
// Parts that are independent add up by their squares. The guard against negative sums is part of
// `all` and `levels` only.
#include "headless.h"
#include "viewer.h"

#include "lobe_sum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 192, HEIGHT = 108, BAKED = 512, SIDE = 128, TEXELS = 6 * SIDE * SIDE };
enum { SMALL = 32, PARTS = 6, WAYS = KILN_MAX_TAPS + 1 };

static const double pi = 3.14159265358979323846;
static kiln_error error;

static void check(kiln_result result)
{
    if (result) {
        fprintf(stderr, "bench_lobe_parts: %s\n", error.message);
        exit(1);
    }
}

// The environment as directions with light, and its levels.
typedef struct scene {
    kiln_environment baked;
    kiln_image seen[WAYS], fine[WAYS]; // pictures by the lookups of small tables and of large ones
    double direction[TEXELS][3], area[TEXELS], light[TEXELS][3];
    lobe_levels lobes;
} scene;

// A point of a ball in the frame of the scene.
typedef struct point {
    int ball;
    double n[3], v[3], t[3], nov; // t: the tangent in the plane of incidence
} point;

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// ---------------------------------------------------------------------------------- the environment

// Averages level 0 to SIDE texels along a face.
static void collect(scene *s)
{
    const kiln_map *map = &s->baked.levels;
    size_t count = kiln_map_texels(map, 0), block = (size_t)(map->size / SIDE);
    memset(s->area, 0, sizeof s->area);
    memset(s->light, 0, sizeof s->light);
    memset(s->direction, 0, sizeof s->direction);
    for (size_t i = 0; i < count; i++) {
        size_t x = i % (size_t)map->size / block, y = i / (size_t)map->size / block;
        size_t at = y * SIDE + x;
        double d[3], most;
        kiln_map_direction(map, 0, i, d);
        most = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
        double area = 4.0 / map->size / map->size * most * most * most;
        s->area[at] += area;
        for (size_t c = 0; c < 3; c++) {
            s->light[at][c] += area * (double)map->level[0][3 * i + c];
            s->direction[at][c] += area * d[c];
        }
    }
    for (size_t i = 0; i < TEXELS; i++) {
        double size = sqrt(dot(s->direction[i], s->direction[i]));
        for (size_t c = 0; c < 3; c++)
            s->direction[i][c] /= size;
    }
}

// --------------------------------------------------------------------------------------- the points

// Sets the point of a ball that the centre of a pixel shows. Returns false where there is none.
static bool find_point(const view_options *o, int x, int y, point *p)
{
    view_ball balls[VIEW_MAX_BALLS];
    int count = view_balls(o, balls);
    double eye[3], right[3], up[3], back[3], d[3], slope = tan(o->camera.fov * pi / 360);
    view_camera_axes(&o->camera, eye, right, up, back);
    double sx = (2 * (x + 0.5) / WIDTH - 1) * slope * WIDTH / HEIGHT;
    double sy = (1 - 2 * (y + 0.5) / HEIGHT) * slope;
    for (int c = 0; c < 3; c++)
        d[c] = sx * right[c] + sy * up[c] - back[c];
    double size = sqrt(dot(d, d));
    for (p->ball = 0; p->ball < count; p->ball++) {
        const view_ball *ball = balls + p->ball;
        double from[3], closest[3], along;
        for (int c = 0; c < 3; c++) {
            d[c] = d[c] / size;
            from[c] = eye[c] - ball->centre[c];
        }
        size = 1;
        along = dot(from, d);
        for (int c = 0; c < 3; c++)
            closest[c] = from[c] - along * d[c];
        double rest = ball->radius * ball->radius - dot(closest, closest);
        if (rest <= 0)
            continue;
        double half = sqrt(rest);
        p->nov = half / ball->radius;
        for (int c = 0; c < 3; c++) {
            p->n[c] = (closest[c] - half * d[c]) / ball->radius;
            p->v[c] = -d[c];
            p->t[c] = p->nov * p->n[c] - p->v[c];
        }
        double sine = sqrt(dot(p->t, p->t));
        for (int c = 0; c < 3; c++)
            p->t[c] /= sine; // no pixel's centre shows a ball exactly along its normal
        return ball->roughness > 0.3 && ball->method == VIEW_METHOD_SINGLE;
    }
    return false;
}

// Brute force over the lobe: radiance with F = 1 and with the metal's F, and the albedo with F.
static void integrate(const scene *s, const view_ball *ball, const point *p, double plain[3],
                      double metal[3], double albedo[3])
{
    static const kiln_model model = {0};
    double sum = 0, nov = p->nov, energy = kiln_energy(&model, ball->roughness, nov);
    for (int c = 0; c < 3; c++)
        plain[c] = metal[c] = albedo[c] = 0;
    for (int i = 0; i < TEXELS; i++) {
        const double *l = s->direction[i];
        double nol = dot(p->n, l), h2 = 2 + 2 * dot(p->v, l), noh = nol + nov;
        if (nol <= 0)
            continue;
        double f = nol * kiln_brdf_specular(&model, ball->roughness, nov, nol, noh / sqrt(h2));
        double voh = 0.5 * sqrt(h2);
        sum += f * s->area[i];
        for (int c = 0; c < 3; c++) {
            double with = f * kiln_fresnel_f82(ball->f0[c], ball->f82[c], voh);
            plain[c] += f * s->light[i][c];
            metal[c] += with * s->light[i][c];
            albedo[c] += with * s->area[i];
        }
    }
    for (int c = 0; c < 3; c++) {
        plain[c] *= albedo[c] / sum * energy / sum;
        albedo[c] *= energy / sum;
        metal[c] *= energy / sum;
    }
}

// ------------------------------------------------------------------------------------------ lookups

// Reads a table, or the bent lookup of one level where `table` is NULL: its direction is
// n + f (r - n), where r is the mirror direction.
static lobe_sum look_up(const scene *s, const kiln_table *table, double roughness, double nov)
{
    double values[KILN_MAX_TABLE_VALUES] = {0};
    if (table) {
        kiln_table_lookup(table, nov, roughness, 0, values);
        return lobe_sum_make(values, table->def.tap_count, nov);
    }
    double alpha = roughness * roughness, f = (1 - alpha) * (sqrt(1 - alpha) + alpha);
    values[0] = acos(nov) - atan2(f * sqrt(1 - nov * nov), 1 - f + f * nov);
    values[1] =
        roughness * (s->baked.levels.level_count - 1); // levels have equal steps of roughness
    values[2] = 1;
    return lobe_sum_make(values, 1, nov);
}

// Brute force over the lobes of the levels and the correction: above the surface and below.
static void spread(const scene *s, const lobe_sum *sum, const point *p, double above[3],
                   double below[3])
{
    for (int c = 0; c < 3; c++)
        above[c] = below[c] = 0;
    for (int i = 0; i < TEXELS; i++) {
        double z = dot(p->n, s->direction[i]), x = dot(p->t, s->direction[i]);
        double d[3] = {x, sqrt(fmax(1 - x * x - z * z, 0)), z}; // the sum is even in y
        double f = lobe_sum_at(&s->lobes, sum, d), *to = z > 0 ? above : below;
        for (int c = 0; c < 3; c++)
            to[c] += f * s->light[i][c];
    }
}

// ------------------------------------------------------------------------------------------- errors

// Adds the squared difference of two radiances on the screen.
static double differ(const double a[3], const double b[3])
{
    double x[3], y[3], sum = 0;
    view_tone(VIEW_SCENE_IBL, a, x);
    view_tone(VIEW_SCENE_IBL, b, y);
    for (int c = 0; c < 3; c++)
        sum += 255.0 * 255 / 3 * (x[c] - y[c]) * (x[c] - y[c]);
    return sum;
}

typedef struct sums {
    double part[WAYS][PARTS], count;
} sums;

static void widen(const kiln_image *image, size_t pixel, double to[3])
{
    for (size_t c = 0; c < 3; c++)
        to[c] = (double)image->pixels[3 * pixel + c];
}

static void measure_point(const scene *s, size_t pixel, const kiln_table *tables,
                          const view_ball *ball, const point *p, sums *to)
{
    double plain[3], metal[3], albedo[3];
    integrate(s, ball, p, plain, metal, albedo);
    to->count++;
    for (int way = 0; way < WAYS; way++) {
        double seen[3], better[3], above[3], below[3], both[3];
        lobe_sum sum = look_up(s, way ? &tables[way] : NULL, ball->roughness, p->nov);
        widen(&s->seen[way], pixel, seen);
        widen(&s->fine[way], pixel, better);
        spread(s, &sum, p, above, below);
        for (int c = 0; c < 3; c++) {
            above[c] = fmax(above[c], 0) * albedo[c];
            both[c] = fmax(above[c] + below[c] * albedo[c], 0);
        }
        double parts[PARTS] = {differ(seen, metal),  differ(plain, metal), differ(seen, both),
                               differ(seen, better), differ(both, above),  differ(above, plain)};
        for (int i = 0; i < PARTS; i++)
            to->part[way][i] += parts[i];
    }
}

// Draws the pictures of all lookups, one ray a pixel.
static void draw(view_renderer *renderer, const view_options *view, scene *s)
{
    const kiln_environment *e = &s->baked;
    check(view_set_environment(renderer, VIEW_SLOT_EXACT, &e->levels, &e->sh, &e->irradiance,
                               &error));
    for (int i = 0; i < 2 * WAYS; i++) {
        view_options o = *view;
        o.reflections = (view_reflections)(VIEW_REFLECTIONS_BENT + i / 2);
        o.lobes_size = SMALL << i % 2;
        check(view_picture(renderer, &o, WIDTH, HEIGHT, true,
                           i % 2 ? &s->fine[i / 2] : &s->seen[i / 2], &error));
    }
}

static void measure(kiln_context *context, view_renderer *renderer, const char *path, scene *s,
                    const kiln_table *tables)
{
    static const char *const names[WAYS] = {"bent", "one", "two", "three"};
    view_options o = view_defaults(VIEW_SCENE_IBL);
    o.samples = 1;
    o.camera.fov = 45; // a wide lens, as for the tables of docs/theory/realtime.md
    o.camera.distance = 330;
    view_ball balls[VIEW_MAX_BALLS];
    static sums of[VIEW_MAX_BALLS];
    int count = view_balls(&o, balls);
    kiln_map source;
    check(kiln_map_load(context, path, NULL, &source, &error));
    check(view_bake(context, &source, BAKED, 0, &s->baked, &error));
    kiln_map_free(&source);
    collect(s);
    lobe_levels_make(s->baked.levels.roughness, s->baked.levels.level_count, &s->lobes);
    draw(renderer, &o, s);
    memset(of, 0, sizeof of);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        point p;
        if (find_point(&o, i % WIDTH, i / WIDTH, &p))
            measure_point(s, (size_t)i, tables, balls + p.ball, &p, of + p.ball);
    }
    const char *file = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    for (int way = 0; way < WAYS; way++) {
        printf("%.*s,%s", (int)strcspn(file, "."), file, names[way]);
        for (int part = 0; part < PARTS; part++) {
            double sum = 0, measured = 0;
            for (int i = 0; i < count; i++)
                if (of[i].count > 0) {
                    sum += sqrt(of[i].part[way][part] / of[i].count);
                    measured++;
                }
            printf(",%.2f", sum / measured);
        }
        puts("");
    }
    fflush(stdout);
    for (int way = 0; way < WAYS; way++) {
        kiln_image_free(&s->seen[way]);
        kiln_image_free(&s->fine[way]);
    }
    kiln_environment_free(&s->baked);
}

int main(int argc, char **argv)
{
    static scene s;
    kiln_context *context;
    kiln_table tables[WAYS];
    view_headless *headless;
    view_renderer *renderer;
    if (argc < 2) {
        fputs("bench_lobe_parts PANORAMA...\n", stderr);
        return 2;
    }
    check(kiln_context_create(NULL, &context, &error));
    check(view_headless_create(&headless, &error));
    check(view_create(context, view_headless_lookup, &renderer, &error));
    for (int taps = 1; taps < WAYS; taps++) {
        const kiln_table_def def = {.kind = KILN_TABLE_LOBES,
                                    .tap_count = taps,
                                    .level_count = 7,
                                    .width = SMALL,
                                    .height = SMALL};
        check(kiln_table_create(context, &def, &tables[taps], &error));
    }
    puts("panorama,reflections,all,fresnel,levels,table,horizon,shape");
    for (int i = 1; i < argc; i++)
        measure(context, renderer, argv[i], &s, tables);
    for (int taps = 1; taps < WAYS; taps++)
        kiln_table_free(&tables[taps]);
    view_destroy(renderer);
    view_headless_destroy(headless);
    kiln_context_destroy(context);
    return 0;
}
