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

// Numbers of surfaces: CUT have a light on their horizon or close to the horizon; the others face the largest light and
// every way.
enum { CUT = 24, EVERY_WAY = 4, FACING = 1 + EVERY_WAY };

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

// Raises `most` to the greatest irradiance of a surface in each channel, by texels as points.
static void find_most(const kiln_map *map, const kiln_light *largest, double most[3])
{
    double normals[FACING][3], whole[FACING][3] = {{0}};
    uint64_t seed = 4;
    turn_from(largest->direction, 1, 0, normals[0]);
    for (int i = 1; i < FACING; i++)
        random_direction(&seed, normals[i]);
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double d[3], solid = ki_texel_solid_angle(map, i);
        kiln_map_direction(map, 0, i, d);
        for (int n = 0; n < FACING; n++)
            for (int c = 0; c < 3; c++)
                whole[n][c] +=
                    solid * fmax(0, dot(d, normals[n])) * (double)map->level[0][3 * i + (size_t)c];
    }
    for (int c = 0; c < 3; c++)
        for (int n = 0; n < FACING; n++)
            most[c] = fmax(most[c], whole[n][c]);
}

// Adds to the surfaces' irradiance what was taken out of texel i of the map.
static void add_taken(const kiln_map *map, const kiln_map *left, size_t i,
                      const double normals[CUT][3], double taken[CUT][3])
{
    const float *rgb = map->level[0] + 3 * i, *rest = left->level[0] + 3 * i;
    ki_texel_nodes nodes;
    if (!memcmp(rgb, rest, 3 * sizeof *rgb))
        return;
    ki_texel_nodes_find(map, i, 4, &nodes);
    for (int n = 0; n < CUT; n++) {
        double weight = 0;
        for (int k = 0; k < nodes.count; k++)
            weight += nodes.weight[k] * fmax(0, dot(nodes.direction[k], normals[n]));
        for (int c = 0; c < 3; c++)
            taken[n][c] += weight * ((double)rgb[c] - (double)rest[c]);
    }
}

void check_light_irradiance(const kiln_map *map, const kiln_map *left, const kiln_lights *lights,
                            double bound)
{
    double most[3] = {0};
    find_most(map, &lights->light[0], most);
    for (int k = 0; k < lights->count; k++) {
        double normals[CUT][3], taken[CUT][3] = {{0}};
        const kiln_light *light = &lights->light[k];
        for (int n = 0; n < CUT;
             n++) // its centre on the horizon, and half a radius above and below
            turn_from(light->direction, sin((n % 3 - 1) * light->angular_radius / 2 * pi / 180),
                      2 * pi * n / CUT, normals[n]);
        for (size_t i = 0; i < kiln_map_texels(map, 0); i++)
            add_taken(map, left, i, (const double(*)[3])normals, taken);
        for (int n = 0; n < CUT; n++) {
            double discs[3] = {0};
            for (int i = 0; i < lights->count; i++)
                add_disc(&lights->light[i], normals[n], discs);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(discs[c], taken[n][c], bound * most[c]);
        }
    }
}
