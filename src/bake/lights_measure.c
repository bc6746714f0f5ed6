// What a region of bright texels holds, as a light. In: a map and a region. Out: a disc light, the
// texels that remain, and how well the disc replaces what was taken out.
//
// Every texel of the region receives what surrounds the region: the mean of the texels along its
// border, each weighted by 1 / distance^2, or the texel's own value where this is smaller. The
// light is the difference d_i in each texel, so that the sum of both is the map, whatever the
// surroundings are. With the solid angle w_i and the direction v_i of texel i, the light is
//
//     F = sum d_i w_i v_i         the vector irradiance; its direction is the centroid, its length
//                                 the irradiance of a surface that faces the light
//     r = 3/2 sum d_i w_i |v_i - F / |F|| / sum d_i w_i     the angular radius of a uniform disc
//                                 with the same mean distance from its centre
//
// Harmonics of degree 1 of this disc agree with those of the texels, and those of other degrees are
// compared. The mean distance decides how much of the light a surface receives whose horizon cuts
// through the light. Faint glow around a sun widens the disc less than the root mean square of the
// distance would. Light that is longer than wide, or brighter in the middle, gives such surfaces
// another irradiance than the disc does, by up to a thousandth of the map's greatest irradiance.
#include "bake/lights.h"

#include "image/texel.h"
#include "math/math.h"
#include "sphere/sh.h"

#include <math.h>

const double ki_light_mismatch = 6e-4, ki_lights_mismatch = 8e-4;
const double ki_light_error = 9.5e-4;

// greatest number of texels along the border of a region that are used, spread evenly
enum { MOST_BORDER = 256 };

typedef struct ring {
    double direction[MOST_BORDER][3], rgb[MOST_BORDER][3];
    int count;
} ring;

// Visits the texels that touch a region and belong to no region. If `border` is NULL, only counts
// them; otherwise adds every `stride`-th of them to *border. Returns their number; a texel that
// touches several texels of the region counts several times.
static size_t walk_border(const ki_search *search, const ki_region *region, size_t stride,
                          ring *border)
{
    size_t seen = 0;
    for (size_t i = 0; i < region->count; i++) {
        size_t neighbors[4];
        ki_texel_neighbors(search->map, search->list[region->first + i], neighbors);
        for (int k = 0; k < 4; k++) {
            if (search->owner[neighbors[k]] || seen++ % stride || !border)
                continue;
            const float *texel = search->map->level[0] + 3 * neighbors[k];
            kiln_map_direction(search->map, 0, neighbors[k], border->direction[border->count]);
            for (int c = 0; c < 3; c++)
                border->rgb[border->count][c] = fmax(0, (double)texel[c]);
            border->count++;
        }
    }
    return seen;
}

static void find_border(const ki_search *search, const ki_region *region, ring *border)
{
    border->count = 0;
    size_t count = walk_border(search, region, 1, NULL);
    if (count)
        walk_border(search, region, (count + MOST_BORDER - 1) / MOST_BORDER, border);
}

// Returns the length of the chord between two unit vectors, which is about their angle.
static double distance(const double a[3], const double b[3])
{
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrt(x * x + y * y + z * z);
}

static void surroundings(const ring *border, const double direction[3], double rgb[3])
{
    double sum = 0, all[3] = {0};
    for (int i = 0; i < border->count; i++) {
        double away = distance(border->direction[i], direction);
        double weight = 1 / (away * away + 1e-30);
        sum += weight;
        for (int c = 0; c < 3; c++)
            all[c] += weight * border->rgb[i][c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = sum > 0 ? all[c] / sum : 0;
}

// Sums over the light that is taken out of a region: radiance times solid angle.
typedef struct region_sums {
    double flux[3];      // light of each channel
    double vector[3][3]; // [channel][axis]: vector irradiance, the sum of light times direction
    // sum over all channels of light times its distance from the centre of the region's light
    double distance;
    double harmonics[KI_SH_COUNT][3];
} region_sums;

static void add_texel(const ki_texel_nodes *nodes, const double taken[3], region_sums *sums)
{
    for (int i = 0; i < nodes->count; i++) {
        double y[KI_SH_COUNT], weight = nodes->weight[i];
        ki_sh_basis(nodes->direction[i], y);
        for (int c = 0; c < 3; c++) {
            sums->flux[c] += weight * taken[c];
            for (int k = 0; k < 3; k++)
                sums->vector[c][k] += weight * taken[c] * nodes->direction[i][k];
            for (int k = 0; k < KI_SH_COUNT; k++)
                sums->harmonics[k][c] += weight * taken[c] * y[k];
        }
    }
}

// Takes one texel apart into what remains and what is taken out. Values below zero inside of a
// light are errors of lossy compression, whose counterpart is in the light: `negative` says in
// which channels these are replaced too.
static void split(const float *texel, const double around[3], const bool negative[3],
                  double left[3], double taken[3])
{
    for (int c = 0; c < 3; c++) {
        double value = (double)texel[c];
        bool replaced = value > around[c] || (value < 0 && negative[c]);
        left[c] = replaced ? (double)(float)around[c] : value;
        taken[c] = value - left[c];
    }
}

// Splits one texel of a region and finds its nodes.
static void visit(const ki_search *search, size_t index, const ring *border, const bool negative[3],
                  double left[3], double taken[3], ki_texel_nodes *nodes)
{
    // On small maps a sun is a single texel, whose distances need more nodes.
    int side = search->map->size < 1024 ? 4 : 2;
    double direction[3], around[3];
    kiln_map_direction(search->map, 0, index, direction);
    surroundings(border, direction, around);
    split(search->map->level[0] + 3 * index, around, negative, left, taken);
    ki_texel_nodes_find(search->map, index, side, nodes);
}

static void sum_region(const ki_search *search, const ki_region *region, const ring *border,
                       const bool negative[3], region_sums *sums)
{
    *sums = (region_sums){0};
    for (size_t i = 0; i < region->count; i++) {
        double left[3], taken[3];
        ki_texel_nodes nodes;
        visit(search, search->list[region->first + i], border, negative, left, taken, &nodes);
        add_texel(&nodes, taken, sums);
    }
}

// Adds up the distances of the light from its centre. Writes what remains to `target`, unless it is
// NULL.
static void sum_distances(const ki_search *search, const ki_region *region, const ring *border,
                          const bool negative[3], kiln_map *target, region_sums *sums)
{
    for (size_t i = 0; i < region->count; i++) {
        size_t index = search->list[region->first + i];
        double left[3], taken[3];
        ki_texel_nodes nodes;
        visit(search, index, border, negative, left, taken, &nodes);
        double all = taken[0] + taken[1] + taken[2];
        for (int n = 0; n < nodes.count; n++)
            sums->distance +=
                all * nodes.weight[n] * distance(nodes.direction[n], region->light.direction);
        for (int c = 0; c < 3 && target; c++)
            target->level[0][3 * index + (size_t)c] = (float)left[c];
    }
}

static void set_light(const ki_search *search, const region_sums *sums, kiln_light *light)
{
    double all = search->light[0] + search->light[1] + search->light[2], length = 0;
    for (int k = 0; k < 3; k++) {
        light->direction[k] = sums->vector[0][k] + sums->vector[1][k] + sums->vector[2][k];
        length += light->direction[k] * light->direction[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++)
        light->direction[k] = length > 0 ? light->direction[k] / length : 0;
    for (int c = 0; c < 3; c++) {
        const double *v = sums->vector[c], *d = light->direction;
        light->irradiance[c] = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
    }
    light->share = (sums->flux[0] + sums->flux[1] + sums->flux[2]) / all;
}

// Compares the harmonics of what was taken out of a region with those of the light's disc.
static void compare_harmonics(const ki_search *search, const region_sums *sums, ki_region *region)
{
    double disc[KI_SH_COUNT][3] = {{0}};
    ki_light_add_sh(&region->light, disc);
    for (int k = 0; k < KI_SH_COUNT; k++)
        for (int c = 0; c < 3; c++)
            region->mismatch[k][c] = (sums->harmonics[k][c] - disc[k][c]) / search->norm;
}

void ki_region_measure(const ki_search *search, ki_region *region, kiln_map *target)
{
    ring border;
    region_sums sums;
    bool *negative = region->negative;
    kiln_light *light = &region->light;
    negative[0] = negative[1] = negative[2] = true;
    find_border(search, region, &border);
    sum_region(search, region, &border, negative, &sums);
    set_light(search, &sums, light);
    for (int c = 0; c < 3; c++)
        negative[c] = light->irradiance[c] >= 0;
    if (!negative[0] || !negative[1] || !negative[2]) {
        // A channel holds more below zero than above. The values below zero stay in this channel.
        sum_region(search, region, &border, negative, &sums);
        set_light(search, &sums, light);
    }
    sum_distances(search, region, &border, negative, target, &sums);
    double flux = sums.flux[0] + sums.flux[1] + sums.flux[2];
    double radius = flux > 0 ? 1.5 * sums.distance / flux : 0;
    light->angular_radius = ki_clamp(radius * (180 / KI_PI), 0, 45);
    light->texel_count = region->count;
    compare_harmonics(search, &sums, region);
}

// ---------------------------------------------------------------------------------------- horizons

// Returns the irradiance by a disc, whose centre stands `height` radii over the horizon, as a part
// of that of a surface that faces the disc. A disc that the horizon cuts is taken as flat. The
// integral of height + y over the part of the unit disc above y = -height is height A + M, where A
// is the area of that part and M its moment 2/3 (1 - height^2)^(3/2).
static double cut_disc(double height, double radius)
{
    if (fabs(height) >= 1)
        return fmax(0, height) * ki_sin(radius);
    double width = sqrt(1 - height * height);
    double area = KI_PI - ki_acos(height) + height * width;
    double moment = 2.0 / 3 * width * width * width;
    return ki_sin(radius) * (height * area + moment) / KI_PI;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void ki_region_add_errors(const ki_search *search, const ki_region *region,
                          const double (*normals)[3], int count, double (*errors)[3])
{
    ring border;
    const kiln_light *light = &region->light;
    // The irradiance of a disc without a radius would be that of a point; a millionth of a degree
    // is.
    double radius = fmax(light->angular_radius, 1e-6) * (KI_PI / 180), scale[3];
    for (int c = 0; c < 3; c++)
        scale[c] = search->brightest[c] > 0 ? 1 / search->brightest[c] : 0;
    find_border(search, region, &border);
    for (size_t i = 0; i < region->count; i++) {
        double left[3], taken[3];
        ki_texel_nodes nodes;
        visit(search, search->list[region->first + i], &border, region->negative, left, taken,
              &nodes);
        for (int n = 0; n < count; n++) {
            double sum = 0;
            for (int k = 0; k < nodes.count; k++)
                sum += nodes.weight[k] * fmax(0, dot(nodes.direction[k], normals[n]));
            for (int c = 0; c < 3; c++)
                errors[n][c] += sum * taken[c] * scale[c];
        }
    }
    for (int n = 0; n < count; n++) {
        double part = cut_disc(dot(light->direction, normals[n]) / ki_sin(radius), radius);
        for (int c = 0; c < 3; c++)
            errors[n][c] -= part * light->irradiance[c] * scale[c];
    }
}

// Returns the largest magnitude of a region's errors over channels and over surfaces whose horizons
// pass through the centre of the light or up to three quarters of its radius above and below.
static double largest_error(const ki_search *search, const ki_region *region)
{
    enum { SIDES = 24, HEIGHTS = 7, SURFACES = SIDES * HEIGHTS };
    const double *d = region->light.direction;
    double normals[SURFACES][3], errors[SURFACES][3] = {{0}}, most = 0;
    // Two unit vectors at right angles to the direction and to each other (Duff and others, 2017).
    double side = d[2] < 0 ? -1 : 1, m = -1 / (side + d[2]);
    const double a[3] = {1 + side * d[0] * d[0] * m, side * d[0] * d[1] * m, -side * d[0]};
    const double b[3] = {d[0] * d[1] * m, side + d[1] * d[1] * m, -d[1]};
    for (int i = 0; i < SURFACES; i++) {
        int step = i % HEIGHTS - HEIGHTS / 2;
        double sine, cosine, up, out, height = 0.25 * step;
        ki_sincos(height * region->light.angular_radius * (KI_PI / 180), &up, &out);
        ki_sincos(2 * KI_PI * i / SURFACES, &sine, &cosine);
        for (int k = 0; k < 3; k++)
            normals[i][k] = up * d[k] + out * (cosine * a[k] + sine * b[k]);
    }
    ki_region_add_errors(search, region, (const double(*)[3])normals, SURFACES, errors);
    for (int i = 0; i < SURFACES; i++)
        for (int c = 0; c < 3; c++)
            most = fmax(most, fabs(errors[i][c]));
    return most;
}

bool ki_region_is_disc(const ki_search *search, const ki_region *region)
{
    return region->count < KI_SHAPED || largest_error(search, region) <= ki_light_error;
}

double ki_mismatch_size(const double mismatch[KI_SH_COUNT][3])
{
    double most = 0;
    for (int k = 0; k < KI_SH_COUNT; k++)
        for (int c = 0; c < 3; c++)
            most = fmax(most, fabs(mismatch[k][c]));
    return most;
}

// By the Funk-Hecke theorem the coefficient of a disc of radiance L is
//     L Y_lm(direction) 2 pi int_cos(radius)^1 P_l(x) dx,
// and the integral is (P_{l-1} - P_{l+1}) / (2 l + 1) at cos(radius).
void ki_light_add_sh(const kiln_light *light, double c[KI_SH_COUNT][3])
{
    double sine, x, y[KI_SH_COUNT];
    // A disc much smaller than a texel has the harmonics of a point.
    ki_sincos(fmax(light->angular_radius, 1e-3) * (KI_PI / 180), &sine, &x);
    ki_sh_basis(light->direction, y);
    double before = 1, at = x; // P_{l-1} and P_l; for l = 0 the integral is 1 - x
    double factor = 2 * (1 - x) / (sine * sine);
    for (int l = 0; l < KILN_MAX_BANDS; l++) {
        if (l > 0) {
            double after = ((2 * l + 1) * x * at - l * before) / (l + 1);
            factor = 2 * (before - after) / ((2 * l + 1) * sine * sine);
            before = at;
            at = after;
        }
        for (int k = l * l; k < (l + 1) * (l + 1); k++)
            for (int n = 0; n < 3; n++)
                c[k][n] += factor * y[k] * light->irradiance[n];
    }
}
