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

// -------------------------------------------------------------------------------------- irradiance

// number of surfaces that have one light on their horizon or close to the horizon
enum { CUT = 24 };

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

// Sets `at` to the direction that lies at an angle from d, whose cosine is `height`, and at the
// angle phi around d.
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

// Sets the direction of the surface that is brightest in a channel, by harmonics, among many
// directions.
static void find_brightest(const kiln_sh *irradiance, int channel, double d[3])
{
    double most = -1;
    uint64_t seed = 4;
    for (int i = 0; i < 4096; i++) {
        double at[3], value[3];
        random_direction(&seed, at);
        kiln_sh_evaluate(irradiance, at, value);
        if (value[channel] > most) {
            most = value[channel];
            memcpy(d, at, sizeof at);
        }
    }
}

// Sets the greatest irradiance of a surface in each channel: that of the surface which harmonics of
// five bands find, summed over texels as points.
static void find_most(kiln_context *context, const kiln_map *map, double most[3])
{
    kiln_error error;
    kiln_sh sh, irradiance;
    double normals[3][3];
    CHECK_OK(kiln_map_sh(context, map, KILN_MAX_BANDS, 0, &sh, &error));
    CHECK_OK(kiln_sh_filter(&sh, KILN_MAX_BANDS, true, 0, &irradiance, &error));
    for (int c = 0; c < 3; c++) {
        find_brightest(&irradiance, c, normals[c]);
        most[c] = 0;
    }
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double d[3], solid = ki_texel_solid_angle(map, i);
        kiln_map_direction(map, 0, i, d);
        for (int c = 0; c < 3; c++)
            most[c] +=
                solid * fmax(0, dot(d, normals[c])) * (double)map->level[0][3 * i + (size_t)c];
    }
}

typedef struct surface {
    double normal[3], taken[3]; // taken: irradiance by what was taken out
} surface;

// Adds to the surfaces' irradiance what was taken out of texel i of the map.
static void add_taken(const kiln_map *map, const kiln_map *left, size_t i, surface *surfaces,
                      int count)
{
    const float *rgb = map->level[0] + 3 * i, *rest = left->level[0] + 3 * i;
    ki_texel_nodes nodes;
    if (!memcmp(rgb, rest, 3 * sizeof *rgb))
        return;
    ki_texel_nodes_find(map, i, 4, &nodes);
    for (int n = 0; n < count; n++) {
        double weight = 0;
        for (int k = 0; k < nodes.count; k++)
            weight += nodes.weight[k] * fmax(0, dot(nodes.direction[k], surfaces[n].normal));
        for (int c = 0; c < 3; c++)
            surfaces[n].taken[c] += weight * ((double)rgb[c] - (double)rest[c]);
    }
}

// Sets surfaces that have light k on their horizon: CUT whose horizon passes through the light's
// centre, or half a radius above or below, and for every other light one whose horizon passes
// through both centres. Returns the number.
static int place_surfaces(const kiln_lights *lights, int k, surface *surfaces)
{
    const kiln_light *light = &lights->light[k];
    int count = 0;
    double radius = light->angular_radius * pi / 180;
    for (; count < CUT; count++) {
        surfaces[count] = (surface){0};
        turn_from(light->direction, sin((count % 3 - 1) * radius / 2), 2 * pi * count / CUT,
                  surfaces[count].normal);
    }
    for (int i = 0; i < lights->count; i++) {
        const double *a = light->direction, *b = lights->light[i].direction;
        double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
        double length = sqrt(dot(n, n));
        if (length > 0.01)
            surfaces[count++] = (surface){{n[0] / length, n[1] / length, n[2] / length}, {0}};
    }
    return count;
}

void check_light_irradiance(kiln_context *context, const kiln_map *map, const kiln_map *left,
                            const kiln_lights *lights)
{
    double most[3];
    find_most(context, map, most);
    for (int k = 0; k < lights->count; k++) {
        surface surfaces[CUT + KILN_MAX_LIGHTS];
        int count = place_surfaces(lights, k, surfaces);
        for (size_t i = 0; i < kiln_map_texels(map, 0); i++)
            add_taken(map, left, i, surfaces, count);
        for (int n = 0; n < count; n++) {
            double discs[3] = {0};
            for (int i = 0; i < lights->count; i++)
                add_disc(&lights->light[i], surfaces[n].normal, discs);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(discs[c], surfaces[n].taken[c], 1e-3 * most[c]);
        }
    }
}
