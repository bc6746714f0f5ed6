// Panoramas from flat pictures. In: a square light probe, which is an angular map or the photograph
// of a mirror ball, or a picture with sides of any ratio that covers the sphere as a panorama does.
// Out: a panorama of two to one.
//
// A texel of the picture is uniformly bright, as everywhere in kiln. A stretched panorama holds
// exact means over solid angles, from the parts of rows and columns that overlap. A panorama from a
// probe holds means of GRID x GRID points in each texel, which stand for equal solid angles.
//
// With u to the right and v upwards, both in [-1, 1], the point at radius r = sqrt(u^2 + v^2) of a
// probe shows the direction d for which
//   angular map:  r = angle(d, -Z) / pi           and (u, v) is parallel to (d.x, d.y)
//   mirror ball:  r = sin(angle(d, +Z) / 2)       and (u, v) is parallel to (d.x, d.y)
// The second line follows from the reflection of the view (0, 0, -1) at the normal (u, v, sqrt(1 -
// r^2)) of the ball. Source of both: P. Debevec, "Light Probe Image Gallery" and "Rendering
// Synthetic Objects into Real Scenes" (1998).
#include "image/flat.h"

#include "math/math.h"

#include <math.h>

enum { GRID = 6 }; // number of points along each side of a texel, at which the probe is read

static int rows_for(int most)
{
    return ki_max(1, ki_min(most, KILN_MAX_SIZE / 2));
}

// ------------------------------------------------------------------------------------------ probes

typedef struct probe_job {
    const kiln_image *image;
    ki_probe probe;
    kiln_map *map;
} probe_job;

// Returns the radius in [0, 1] at which a probe shows directions with this z.
static double radius_of(ki_probe probe, double z)
{
    double cosine = ki_clamp(z, -1, 1);
    return probe == KI_PROBE_ANGULAR ? ki_acos(-cosine) / KI_PI : sqrt((1 - cosine) / 2);
}

// Returns the probe's texel at radius r in the direction (x, y) from the centre of the disc. A
// texel whose centre lies outside the disc may hold what is behind the probe, so that the next
// texel towards the centre is taken.
static const float *texel_at(const kiln_image *image, double r, double x, double y)
{
    int n = image->width;
    for (int tries = 0;; tries++, r -= 1.0 / n) {
        int column = ki_min(ki_max((int)((1 + r * x) / 2 * n), 0), n - 1);
        int row = ki_min(ki_max((int)((1 - r * y) / 2 * n), 0), n - 1);
        double u = (2 * column + 1.0) / n - 1, v = (2 * row + 1.0) / n - 1;
        if (u * u + v * v <= 1 || tries == 4)
            return image->pixels + 3 * ((size_t)row * (size_t)n + (size_t)column);
    }
}

static const float *look_up(const probe_job *job, double height, double sine, double cosine)
{
    double level = sqrt(1 - height * height), x = level * sine, z = -level * cosine;
    double across = sqrt(x * x + height * height), r = radius_of(job->probe, z);
    return texel_at(job->image, r, across > 0 ? x / across : 1, across > 0 ? height / across : 0);
}

// Task of one thread: computes one row of the panorama.
static void fill_row(void *data, int row)
{
    const probe_job *job = data;
    int rows = job->map->size;
    double top = ki_cos(row * KI_PI / rows), bottom = ki_cos((row + 1) * KI_PI / rows);
    float *to = job->map->level[0] + 6 * (size_t)row * (size_t)rows;
    for (int column = 0; column < 2 * rows; column++, to += 3) {
        double sum[3] = {0};
        for (int i = 0; i < GRID; i++) {
            double sine, cosine;
            ki_sincos(((column + (i + 0.5) / GRID) / rows - 1) * KI_PI, &sine, &cosine);
            for (int k = 0; k < GRID; k++) {
                double height = ki_clamp(top + (bottom - top) * (k + 0.5) / GRID, -1, 1);
                const float *rgb = look_up(job, height, sine, cosine);
                for (int c = 0; c < 3; c++)
                    sum[c] += (double)rgb[c];
            }
        }
        for (int c = 0; c < 3; c++)
            to[c] = (float)(sum[c] / (GRID * GRID));
    }
}

kiln_result ki_panorama_from_probe(kiln_context *context, const kiln_image *image, ki_probe probe,
                                   kiln_map *map, kiln_error *error)
{
    *map =
        (kiln_map){.shape = KILN_SHAPE_PANORAMA, .size = rows_for(image->width), .level_count = 1};
    kiln_result result = ki_map_allocate(context, map, error);
    probe_job job = {image, probe, map};
    if (result == KILN_OK && !ki_parallel_steps(context, NULL, map->size, fill_row, &job)) {
        kiln_map_free(map);
        result = ki_fail_cancelled(error, "reading");
    }
    return result;
}

// -------------------------------------------------------------------------------------- stretching

typedef struct stretch_job {
    const kiln_image *image;
    kiln_map *map;
} stretch_job;

// Returns in which of `count` equal parts of [0, 1] the number `at` lies.
static int interval_of(double at, int count)
{
    return ki_min((int)(at * count), count - 1);
}

// Adds a part of a row of the picture, times `weight`, to `sum`: the texels between the fractions
// `left` and `right` of the width, by the share of each that lies between them. Adds the texels'
// weights to *total.
static void add_row(const kiln_image *image, int row, double weight, double left, double right,
                    double sum[3], double *total)
{
    int w = image->width;
    for (int x = interval_of(left, w); x < w && x < right * w; x++) {
        double part = weight * (fmin(right * w, x + 1) - fmax(left * w, x));
        const float *rgb = image->pixels + 3 * ((size_t)row * (size_t)w + (size_t)x);
        if (!(part > 0))
            continue;
        for (int c = 0; c < 3; c++)
            sum[c] += part * (double)rgb[c];
        *total += part;
    }
}

// Task of one thread: computes one row of the panorama.
static void stretch_row(void *data, int row)
{
    const stretch_job *job = data;
    int rows = job->map->size, h = job->image->height;
    double top = (double)row / rows, bottom = (row + 1.0) / rows;
    float *to = job->map->level[0] + 6 * (size_t)row * (size_t)rows;
    for (int column = 0; column < 2 * rows; column++, to += 3) {
        double sum[3] = {0}, total = 0, left = column / (2.0 * rows);
        for (int y = interval_of(top, h); y < h && y < bottom * h; y++) {
            double begin = fmax(top, (double)y / h), end = fmin(bottom, (y + 1.0) / h);
            if (end > begin)
                add_row(job->image, y, ki_cos(begin * KI_PI) - ki_cos(end * KI_PI), left,
                        (column + 1) / (2.0 * rows), sum, &total);
        }
        for (int c = 0; c < 3; c++)
            to[c] = (float)(sum[c] / total);
    }
}

kiln_result ki_panorama_stretch(kiln_context *context, const kiln_image *image, kiln_map *map,
                                kiln_error *error)
{
    int rows = rows_for(ki_max(image->height, (image->width + 1) / 2));
    *map = (kiln_map){.shape = KILN_SHAPE_PANORAMA, .size = rows, .level_count = 1};
    kiln_result result = ki_map_allocate(context, map, error);
    stretch_job job = {image, map};
    if (result == KILN_OK && !ki_parallel_steps(context, NULL, rows, stretch_row, &job)) {
        kiln_map_free(map);
        result = ki_fail_cancelled(error, "reading");
    }
    return result;
}
