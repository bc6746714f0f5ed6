#include "sphere/points.h"

#include "image/image.h"
#include "math/math.h"
#include "sphere/lobe.h"

#include <math.h>
#include <string.h>

enum { MOST_CELLS = 24, GATHER = 512 };

// Two Gauss nodes on [-1, 1].
static const double node = 0.57735026918962576451;

// Writes 4 cells^2 points that share a texel's solid angle: cells of equal area, two by two Gauss
// nodes in each.
static void divide(const ki_sun *sun, int size, int cells, double rotation, double integral,
                   double (*points)[6])
{
    double step = KI_PI / size, top = ki_cos(sun->row * step), bottom = ki_cos((sun->row + 1) * step);
    double area = step * (top - bottom) / (4.0 * cells * cells * integral);
    int n = 2 * cells, at = 0;
    for (int j = 0; j < n; j++) {
        double v = (j / 2 + 0.5 + (j % 2 ? node : -node) / 2) / cells;
        double cosine = top + (bottom - top) * v, sine = sqrt(fmax(0, (1 - cosine) * (1 + cosine)));
        for (int i = 0; i < n; i++, at++) {
            double u = (sun->column + (i / 2 + 0.5 + (i % 2 ? node : -node) / 2) / cells) / (2.0 * size);
            double s, c, unturned[3];
            // See ki_panorama_direction.
            ki_sincos(2 * KI_PI * u, &s, &c);
            unturned[0] = -sine * s;
            unturned[1] = cosine;
            unturned[2] = sine * c;
            ki_turn(unturned, -rotation, points[at]);
            for (int k = 0; k < 3; k++)
                points[at][3 + k] = area * (double)sun->radiance[k];
        }
    }
}

kiln_result ki_points_create(const kiln_spectrum *spectrum, const ki_zonal *zonal, double integral,
                             double rotation, ki_points *points, kiln_error *error)
{
    kiln_context *context = spectrum->context;
    *points = (ki_points){.kernels = ki_sphere_kernels(context),
                          .zonal = *zonal,
                          .sun_count = spectrum->sun_count,
                          .far_count = 4,
                          .near_count = 4};
    if (!spectrum->sun_count)
        return KILN_OK;
    double texel = KI_PI / spectrum->size, width = ki_lobe_width(&zonal->lobe);
    int cells = (int)ki_clamp(ceil(texel / width / 0.3), 1, MOST_CELLS);
    points->near_count = 4 * cells * cells;
    points->near_versine = cells > 1 ? 1 - ki_cos(fmin(KI_PI, 12 * texel)) : 0;
    size_t suns = (size_t)spectrum->sun_count;
    points->centres = ki_alloc_raw(context, suns, sizeof *points->centres);
    points->far = ki_alloc_raw(context, suns * 4, sizeof *points->far);
    points->near = ki_alloc_raw(context, suns * (size_t)points->near_count, sizeof *points->near);
    if (!points->centres || !points->far || !points->near) {
        ki_points_destroy(points);
        return ki_fail_memory(context, error, "the suns",
                              suns * (size_t)points->near_count * sizeof *points->near);
    }
    for (int i = 0; i < spectrum->sun_count; i++) {
        const ki_sun *sun = &spectrum->suns[i];
        double centre[3];
        ki_panorama_direction((sun->column + 0.5) / (2.0 * spectrum->size),
                              (sun->row + 0.5) / spectrum->size, centre);
        ki_turn(centre, -rotation, points->centres[i]);
        divide(sun, spectrum->size, 1, rotation, integral, points->far + 4 * (size_t)i);
        divide(sun, spectrum->size, cells, rotation, integral,
               points->near + (size_t)points->near_count * (size_t)i);
    }
    return KILN_OK;
}

void ki_points_destroy(ki_points *points)
{
    ki_free(points->centres);
    ki_free(points->far);
    ki_free(points->near);
    *points = (ki_points){0};
}

static void add_points(const ki_points *points, const double *directions, const double (*list)[6],
                       int count, double *sum)
{
    const kiln_lobe *lobe = &points->zonal.lobe;
    if (lobe->kind == KILN_LOBE_LAMBERT) {
        points->kernels->points_ggx(1, directions, list, count, sum);
        return;
    }
    if (lobe->kind == KILN_LOBE_GGX && points->zonal.outer <= 0) {
        points->kernels->points_ggx(lobe->parameter, directions, list, count, sum);
        return;
    }
    for (int i = 0; i < count; i++)
        for (int j = 0; j < KI_LANES; j++) {
            double x = directions[j] - list[i][0], y = directions[8 + j] - list[i][1],
                   z = directions[16 + j] - list[i][2];
            double weight = ki_zonal_weight(&points->zonal, 0.5 * (x * x + y * y + z * z));
            for (int c = 0; c < 3; c++)
                sum[8 * c + j] += weight * list[i][3 + c];
        }
}

void ki_points_add(const ki_points *points, const double *directions, double *sum)
{
    if (points->near_versine <= 0) {
        add_points(points, directions, (const double(*)[6])points->far, 4 * points->sun_count, sum);
        return;
    }
    for (int i = 0; i < points->sun_count; i++) {
        double nearest = 2;
        for (int j = 0; j < KI_LANES; j++) {
            double x = directions[j] - points->centres[i][0],
                   y = directions[8 + j] - points->centres[i][1],
                   z = directions[16 + j] - points->centres[i][2];
            nearest = fmin(nearest, 0.5 * (x * x + y * y + z * z));
        }
        if (nearest > points->near_versine)
            add_points(points, directions, (const double(*)[6])points->far + 4 * (size_t)i, 4, sum);
        else
            add_points(points, directions,
                       (const double(*)[6])points->near +
                           (size_t)points->near_count * (size_t)i,
                       points->near_count, sum);
    }
}

// -------------------------------------------------------------------------------- narrow lobes

// The integral over a cell of a texel of lobe * (1 - step), the cell divided in four until it is
// small against its distance and the lobe's width.
typedef struct cell_sum {
    const ki_zonal *zonal;
    double direction[3], width;
} cell_sum;

static double integrate_cell(const cell_sum *sum, double phi, double dphi, double z, double dz,
                             int depth)
{
    double sine, cosine, ring = sqrt(fmax(0, (1 - z) * (1 + z)));
    ki_sincos(phi, &sine, &cosine);
    double x = -ring * sine - sum->direction[0], y = z - sum->direction[1],
           w = ring * cosine - sum->direction[2];
    double versine = 0.5 * (x * x + y * y + w * w), distance = sqrt(2 * versine);
    double extent = fmax(dphi * ring, dz / fmax(ring, dz));
    if (depth < 40 && extent > 0.5 * fmax(distance - 0.5 * extent, 0.3 * sum->width)) {
        double total = 0;
        for (int k = 0; k < 4; k++)
            total += integrate_cell(sum, phi + (k % 2 ? 0.25 : -0.25) * dphi, dphi / 2,
                                    z + (k / 2 ? 0.25 : -0.25) * dz, dz / 2, depth + 1);
        return total;
    }
    double total = 0;
    for (int k = 0; k < 4; k++) {
        double zk = z + (k / 2 ? 0.5 : -0.5) * node * dz, r = sqrt(fmax(0, (1 - zk) * (1 + zk)));
        ki_sincos(phi + (k % 2 ? 0.5 : -0.5) * node * dphi, &sine, &cosine);
        x = -r * sine - sum->direction[0];
        y = zk - sum->direction[1];
        w = r * cosine - sum->direction[2];
        versine = 0.5 * (x * x + y * y + w * w);
        total += ki_lobe_weight(&sum->zonal->lobe, versine) *
                 (1 - ki_zonal_step(sum->zonal, versine));
    }
    return total * 0.25 * dphi * dz;
}

void ki_surroundings_add(const kiln_map *panorama, const ki_zonal *zonal, double integral,
                         const double direction[3], double rgb[3])
{
    int size = panorama->size;
    double step = KI_PI / size, reach = zonal->outer;
    cell_sum sum = {zonal, {direction[0], direction[1], direction[2]}, ki_lobe_width(&zonal->lobe)};
    double sine = sqrt(direction[0] * direction[0] + direction[2] * direction[2]);
    double theta = ki_atan2(sine, direction[1]), phi = ki_atan2(-direction[0], direction[2]);
    int first = (int)fmax(0, floor((theta - reach) / step));
    int last = (int)fmin(size - 1, floor((theta + reach) / step));
    // The widest meridian angle within reach; all columns where a pole is.
    double span = KI_PI;
    if (theta - reach > 0 && theta + reach < KI_PI)
        span = ki_asin(fmin(1, ki_sin(reach) / sine));
    int columns = 2 * size, from = (int)floor((phi - span) / step), to = (int)floor((phi + span) / step);
    if (to - from >= columns) {
        from = 0;
        to = columns - 1;
    }
    for (int j = first; j <= last; j++) {
        double top = ki_cos(j * step), bottom = ki_cos((j + 1) * step);
        const float *row = panorama->level[0] + 3 * (size_t)columns * (size_t)j;
        for (int i = from; i <= to; i++) {
            int column = ((i % columns) + columns) % columns;
            double weight = integrate_cell(&sum, (i + 0.5) * step, step, 0.5 * (top + bottom),
                                           top - bottom, 0) / integral;
            for (int c = 0; c < 3; c++)
                rgb[c] += weight * (double)row[3 * column + c];
        }
    }
}
