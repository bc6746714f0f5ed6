// The environment as a light source. In: a map of any shape and its rotation. Out: the radiance
// from a direction, and directions drawn with a density proportional to |r| + |g| + |b|, since
// texels may be negative, by inverting the cumulated power of the panorama's rows and then of one
// row's texels. The random numbers of view_random are here too.
#include "internal.h"
#include "trace.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

// ---------------------------------------------------------------------------------- random numbers

void view_random_start(view_random *random, uint64_t stream)
{
    *random = (view_random){.state = 0x853c49e6748fea9bu + stream * 0x9e3779b97f4a7c15u,
                            .stream = stream << 1 | 1};
    for (int i = 0; i < 4; i++)
        view_random_next(random);
}

static uint32_t next(view_random *random)
{
    uint64_t old = random->state;
    random->state = old * 6364136223846793005u + random->stream;
    uint32_t mixed = (uint32_t)((old >> 18 ^ old) >> 27), turn = (uint32_t)(old >> 59);
    return mixed >> turn | mixed << (-turn & 31);
}

double view_random_next(view_random *random)
{
    return (next(random) + 0.5) / 4294967296.0;
}

// --------------------------------------------------------------------------------------- the light

static double power(const float *texel)
{
    return fabs((double)texel[0]) + fabs((double)texel[1]) + fabs((double)texel[2]);
}

// cos(theta) at the upper border of row y minus cos(theta) at its lower border. This difference is
// proportional to the solid angle of the row's texels.
static double row_height(int size, int y)
{
    return cos(pi * y / size) - cos(pi * (y + 1) / size);
}

static void cumulate(view_light *light)
{
    int size = light->panorama.size, width = 2 * size;
    const float *pixels = light->panorama.level[0];
    for (int y = 0; y < size; y++) {
        const float *row = pixels + (size_t)y * (size_t)width * 3;
        double *sums = light->texel + (size_t)y * ((size_t)width + 1);
        for (int x = 0; x < width; x++)
            sums[x + 1] = sums[x] + power(row + 3 * (size_t)x);
        double area = row_height(size, y) * 2 * pi / width;
        light->row[y + 1] = light->row[y] + sums[width] * area;
    }
    light->total = light->row[size];
    light->mean = light->total / (3 * 4 * pi);
}

kiln_result view_light_create(kiln_context *context, const kiln_map *source, double rotation,
                              view_light *light, kiln_error *error)
{
    *light =
        (view_light){.cos_turn = cos(rotation * pi / 180), .sin_turn = sin(rotation * pi / 180)};
    kiln_map white = {0};
    kiln_result result = KILN_OK;
    if (!source) {
        result = kiln_map_create(context, KILN_SHAPE_PANORAMA, 1, 1, &white, error);
        for (int i = 0; i < 6 && result == KILN_OK; i++)
            white.level[0][i] = 1;
        source = &white;
    }
    int size = source->shape == KILN_SHAPE_PANORAMA ? source->size : 2 * source->size;
    if (result == KILN_OK)
        result = kiln_map_convert(context, source, KILN_SHAPE_PANORAMA, size, 0, &light->panorama,
                                  error);
    if (result == KILN_OK) {
        light->row = calloc((size_t)size + 1, sizeof(double));
        light->texel = calloc((size_t)size * (2 * (size_t)size + 1), sizeof(double));
        if (light->row && light->texel)
            cumulate(light);
        else
            result = view_fail(error, KILN_ERROR_MEMORY, "out of memory: an environment of %d rows",
                               size);
    }
    kiln_map_free(&white);
    if (result != KILN_OK)
        view_light_free(light);
    return result;
}

void view_light_free(view_light *light)
{
    kiln_map_free(&light->panorama);
    free(light->row);
    free(light->texel);
    *light = (view_light){0};
}

void view_light_add(view_light *light, const view_disc *discs, int count)
{
    for (int i = 0; i < count && light->disc_count < KILN_MAX_LIGHTS; i++) {
        int at = light->disc_count++;
        const double *c = discs[i].radiance;
        double solid = 2 * pi * discs[i].sine * discs[i].sine / (1 + discs[i].cosine);
        light->disc[at] = discs[i];
        light->disc_power[at] = (fabs(c[0]) + fabs(c[1]) + fabs(c[2])) * solid;
        light->total += light->disc_power[at];
    }
    light->mean = light->total / (3 * 4 * pi);
}

// Adds the radiance of the discs around d.
static void add_discs(const view_light *light, const double d[3], double radiance[3])
{
    for (int i = 0; i < light->disc_count; i++) {
        const view_disc *disc = &light->disc[i];
        const double *l = disc->direction;
        if (d[0] * l[0] + d[1] * l[1] + d[2] * l[2] >= disc->cosine)
            for (int c = 0; c < 3; c++)
                radiance[c] += disc->radiance[c];
    }
}

static const float *texel_at(const view_light *light, const double d[3])
{
    int size = light->panorama.size, width = 2 * size;
    double x = d[0] * light->cos_turn - d[2] * light->sin_turn;
    double z = d[2] * light->cos_turn + d[0] * light->sin_turn;
    double u = atan2(x, -z) / (2 * pi) + 0.5, v = acos(fmax(-1, fmin(1, d[1]))) / pi;
    int column = (int)(u * width), row = (int)(v * size);
    column = column < 0 ? 0 : column >= width ? width - 1 : column;
    row = row < 0 ? 0 : row >= size ? size - 1 : row;
    return light->panorama.level[0] + ((size_t)row * (size_t)width + (size_t)column) * 3;
}

void view_light_radiance(const view_light *light, const double d[3], double radiance[3])
{
    const float *texel = texel_at(light, d);
    for (int c = 0; c < 3; c++)
        radiance[c] = (double)texel[c];
    add_discs(light, d, radiance);
}

double view_light_pdf(const view_light *light, const double d[3])
{
    double discs[3] = {0};
    if (!(light->total > 0))
        return 0;
    add_discs(light, d, discs); // no radiance of a disc is negative
    return (power(texel_at(light, d)) + discs[0] + discs[1] + discs[2]) / light->total;
}

// Binary search in sums that never fall: returns the last i < count with sums[i] <= value. `rest`
// receives where `value` lies between sums[i] (0) and sums[i + 1] (1).
static int find(const double *sums, int count, double value, double *rest)
{
    int low = 0, high = count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (sums[middle] <= value)
            low = middle;
        else
            high = middle;
    }
    double step = sums[low + 1] - sums[low];
    *rest = step > 0 ? fmin((value - sums[low]) / step, 1) : 0.5;
    return low;
}

// Draws a direction in a disc, uniformly.
static void sample_disc(const view_disc *disc, const double xi[2], double d[3])
{
    const double *n = disc->direction;
    double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), phi = 2 * pi * xi[0];
    const double t[3] = {1 + sign * n[0] * n[0] * a, sign * n[0] * n[1] * a, -sign * n[0]};
    const double b[3] = {n[0] * n[1] * a, sign + n[1] * n[1] * a, -n[1]};
    double less = xi[1] * disc->sine * disc->sine / (1 + disc->cosine); // 1 - cosine
    double sine = sqrt(less * (2 - less));
    for (int c = 0; c < 3; c++)
        d[c] = (1 - less) * n[c] + sine * (cos(phi) * t[c] + sin(phi) * b[c]);
}

void view_light_sample(const view_light *light, const double xi[2], double d[3])
{
    int size = light->panorama.size, width = 2 * size;
    double down, across, value = xi[1] * light->total;
    // the discs come first in the cumulated power, then the rows of the panorama
    for (int i = 0; i < light->disc_count; i++) {
        if (value < light->disc_power[i]) {
            sample_disc(&light->disc[i], (double[2]){xi[0], value / light->disc_power[i]}, d);
            return;
        }
        value -= light->disc_power[i];
    }
    int y = find(light->row, size, value, &down);
    const double *sums = light->texel + (size_t)y * ((size_t)width + 1);
    int x = find(sums, width, xi[0] * sums[width], &across);
    double phi = 2 * pi * ((x + across) / width - 0.5);
    double cosine = cos(pi * y / size) - down * row_height(size, y);
    double sine = sqrt(fmax(0, 1 - cosine * cosine));
    double ex = sine * sin(phi), ez = -sine * cos(phi);
    d[0] = ex * light->cos_turn + ez * light->sin_turn;
    d[1] = cosine;
    d[2] = ez * light->cos_turn - ex * light->sin_turn;
}
