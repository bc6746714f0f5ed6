#include "kit/lights.h"

#include "image/texel.h"

#include "kit/kit.h"

enum { COEFFICIENTS = KILN_MAX_BANDS * KILN_MAX_BANDS };

void check_light_harmonics(kiln_context *context, const kiln_map *map, const kiln_map *left,
                           const kiln_lights *lights)
{
    kiln_error error;
    kiln_sh whole, rest, taken;
    double squares = 0;
    CHECK_OK(kiln_map_sh(context, map, KILN_MAX_BANDS, 0, &whole, &error));
    CHECK_OK(kiln_map_sh(context, left, KILN_MAX_BANDS, 0, &rest, &error));
    CHECK_OK(kiln_lights_sh(lights, KILN_MAX_BANDS, &taken, &error));
    for (int k = 0; k < COEFFICIENTS; k++)
        for (int c = 0; c < 3; c++)
            squares += whole.c[k][c] * whole.c[k][c];
    for (int k = 0; k < COEFFICIENTS; k++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(rest.c[k][c] + taken.c[k][c], whole.c[k][c], 1e-3 * sqrt(squares / 3));
}

// --------------------------------------------------------------------------------------- irradiance

// Number of surfaces: one faces the largest light, CUT have the light on their horizon or close to the horizon, and
// the others face every way.
enum { CUT = 24, EVERY_WAY = 4, NORMALS = 1 + CUT + EVERY_WAY };

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Finds unit vectors a and b that are perpendicular to each other and to d.
static void find_frame(const double d[3], double a[3], double b[3])
{
    bool upright = fabs(d[0]) + fabs(d[1]) < 0.1;
    a[0] = upright ? 0 : d[1];
    a[1] = upright ? d[2] : -d[0];
    a[2] = upright ? -d[1] : 0;
    double length = sqrt(dot(a, a));
    for (int k = 0; k < 3; k++)
        a[k] /= length;
    for (int k = 0; k < 3; k++)
        b[k] = d[(k + 1) % 3] * a[(k + 2) % 3] - d[(k + 2) % 3] * a[(k + 1) % 3];
}

// Sets `at` to the direction that lies at an angle from d, whose cosine is `height`, and at the angle phi around d.
static void turn_from(const double d[3], double height, double phi, double at[3])
{
    double a[3], b[3], away = sqrt(1 - height * height);
    find_frame(d, a, b);
    for (int k = 0; k < 3; k++)
        at[k] = height * d[k] + away * (cos(phi) * a[k] + sin(phi) * b[k]);
}

// Adds the irradiance of a surface from a disc, by a sum over points of equal area on the disc.
static void add_disc(const kiln_light *light, const double normal[3], double irradiance[3])
{
    enum { RINGS = 48, POINTS = 96 };
    double radius = light->angular_radius * pi / 180, sine = sin(radius), sum = 0;
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < POINTS; j++) {
            double at[3];
            turn_from(light->direction, 1 - (i + 0.5) / RINGS * (1 - cos(radius)),
                      2 * pi * (j + 0.5) / POINTS, at);
            sum += fmax(0, dot(at, normal));
        }
    double solid = 2 * pi * (1 - cos(radius)) / (RINGS * POINTS);
    for (int c = 0; c < 3; c++)
        irradiance[c] += light->irradiance[c] / (pi * sine * sine) * sum * solid;
}

static void choose_normals(const kiln_light *light, double normals[NORMALS][3])
{
    uint64_t seed = 4;
    turn_from(light->direction, 1, 0, normals[0]);
    for (int i = 0; i < CUT;
         i++) // the light's centre on the horizon, and half a radius above and below
        turn_from(light->direction, sin((i % 3 - 1) * light->angular_radius / 2 * pi / 180),
                  2 * pi * i / CUT, normals[1 + i]);
    for (int i = 1 + CUT; i < NORMALS; i++)
        random_direction(&seed, normals[i]);
}

// Adds the irradiance of all surfaces from texel i of the map: exact where the map differs from the map that is left,
// from the centre of the texel elsewhere. `taken` is the part that is not left.
static void add_texel(const kiln_map *map, const kiln_map *left, size_t i,
                      const double normals[NORMALS][3], double whole[NORMALS][3],
                      double taken[NORMALS][3])
{
    const float *rgb = map->level[0] + 3 * i, *rest = left->level[0] + 3 * i;
    ki_texel_nodes nodes = {.count = 1};
    if (memcmp(rgb, rest, 3 * sizeof *rgb) != 0) {
        ki_texel_nodes_find(map, i, 4, &nodes);
    } else {
        kiln_map_direction(map, 0, i, nodes.direction[0]);
        nodes.weight[0] = ki_texel_solid_angle(map, i);
    }
    for (int n = 0; n < NORMALS; n++) {
        double weight = 0;
        for (int k = 0; k < nodes.count; k++)
            weight += nodes.weight[k] * fmax(0, dot(nodes.direction[k], normals[n]));
        for (int c = 0; c < 3; c++) {
            whole[n][c] += weight * (double)rgb[c];
            taken[n][c] += weight * ((double)rgb[c] - (double)rest[c]);
        }
    }
}

void check_light_irradiance(const kiln_map *map, const kiln_map *left, const kiln_lights *lights)
{
    double normals[NORMALS][3], whole[NORMALS][3] = {{0}}, taken[NORMALS][3] = {{0}}, most[3] = {0};
    choose_normals(&lights->light[0], normals);
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++)
        add_texel(map, left, i, (const double(*)[3])normals, whole, taken);
    for (int n = 0; n < NORMALS; n++)
        for (int c = 0; c < 3; c++)
            most[c] = fmax(most[c], whole[n][c]);
    for (int n = 0; n < NORMALS; n++) {
        double discs[3] = {0};
        for (int i = 0; i < lights->count; i++)
            add_disc(&lights->light[i], normals[n], discs);
        for (int c = 0; c < 3; c++) {
            if (fabs(discs[c] - taken[n][c]) > 5e-4 * most[c])
                fprintf(stderr, "OFF n %d c %d %.2e radius %g share %g count %d texels %zu\n", n, c,
                        fabs(discs[c] - taken[n][c]) / most[c], lights->light[0].angular_radius,
                        lights->light[0].share, lights->count, lights->light[0].texel_count);
        }
    }
}
