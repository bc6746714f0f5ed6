// Light that a filtered environment receives by sums over points instead of harmonics
// (docs/theory/spectral.md). In: the suns that the analysis kept out of the spectrum, or the
// panorama around a direction for a lobe with its centre left out; and the lobe. Out: radiance that
// is added to texels, eight directions at a time. Method: each sun becomes 1, 4 or more points in
// proportion to how fast the lobe changes across its texel; texels near a direction are integrated
// over cells cut until the lobe is smooth in each.
#include "sphere/points.h"

#include "image/image.h"
#include "math/math.h"
#include "sphere/lobe.h"

#include <math.h>
#include <string.h>

enum { MOST_CELLS = 24, CLOSE = 4 };

// Nodes, then weights of the Gauss-Legendre rules on [-1/2, 1/2] with two and with four nodes.
static const double gauss_two[2][2] = {{-0.28867513459481288225, 0.28867513459481288225},
                                       {0.5, 0.5}};
static const double gauss_four[2][4] = {{-0.43056815579702628761, -0.16999052179242813170,
                                         0.16999052179242813170, 0.43056815579702628761},
                                        {0.17392742256872692869, 0.32607257743127307131,
                                         0.32607257743127307131, 0.17392742256872692869}};

// Returns 1 - cos of the angle between two unit directions, precise for small angles.
static double versine(const double *a, const double *b)
{
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return 0.5 * (x * x + y * y + z * z);
}

// Divides a sun's texel into n^2 points that share its solid angle. `nodes` in [0, 1] lie across
// each side of the texel. A point's share is the product of its `weights` times sin theta, scaled
// so that the shares add up to the solid angle. The light of the points is divided by `integral`,
// the lobe's integral.
static void divide(const ki_sun *sun, int size, int n, const double *nodes, const double *weights,
                   double rotation, double integral, double (*points)[6])
{
    double step = KI_PI / size, sines = 0;
    for (int j = 0; j < n; j++)
        sines += weights[j] * ki_sin((sun->row + nodes[j]) * step);
    double solid = step * 2 * ki_sin((sun->row + 0.5) * step) * ki_sin(step / 2);
    for (int j = 0; j < n; j++) {
        double sine, cosine;
        ki_sincos((sun->row + nodes[j]) * step, &sine, &cosine);
        double row = solid * weights[j] * sine / (sines * integral);
        for (int i = 0; i < n; i++, points++) {
            double s, c, turned[3];
            ki_sincos((sun->column + nodes[i]) * step, &s, &c);
            // The signs of x, y and z are those that ki_panorama_direction defines.
            ki_turn((double[3]){-sine * s, cosine, sine * c}, -rotation, turned);
            for (int k = 0; k < 3; k++) {
                (*points)[k] = turned[k];
                (*points)[3 + k] = row * weights[i] * (double)sun->radiance[k];
            }
        }
    }
}

// Decides how many points represent a sun, that is a bright texel kept out of the spectrum. Let h
// be the size of the texel, k the lobe, and s the distance from the sun or the width of the lobe,
// over which k varies. The relative error of one point is about (h/s)^2 / 24 times s^2 k'' / k,
// which is 20 in the tail of GGX. The error of two by two Gauss nodes is (h/s)^4 / 4320 times s^4
// k'''' / k, which is 840; that of four by four nodes is about 1e-4 (h/s)^8, which is below 1e-8
// from CLOSE texels on. Nearer, where a lobe may be narrower than the texel, cells of half the
// lobe's width have four by four nodes each.
static void choose_point_counts(const ki_zonal *zonal, int size, ki_sun_points *suns)
{
    double texel = KI_PI / size, width = ki_lobe_width(&zonal->lobe);
    // The Charlie lobe is steep where its horizon cuts through a texel. A sun's texel is therefore
    // divided into at least 4 cells along each side.
    int least = zonal->lobe.kind == KILN_LOBE_CHARLIE ? 4 : 1;
    int n = 4 * (int)ki_clamp(ceil(texel / width / 0.5), least, MOST_CELLS);
    suns->near_count = 16 * least * least;
    bool narrow = n > 4 * least;
    suns->close_count = narrow ? n * n : 0;
    suns->close_versine = narrow ? 1 - ki_cos(fmin(KI_PI, CLOSE * texel)) : -1;
    suns->near_versine = texel > 0.04 * width ? 1 - ki_cos(fmin(KI_PI, 24 * texel)) : -1;
    suns->far_versine = width > 128 * texel ? -1 : 1 - ki_cos(fmin(KI_PI, 128 * texel));
    suns->horizon = texel;
    // For texels of this size, the error of four points at the horizon of the widest lobe of a
    // mixture is below 2.2e-4 of the lobe's peak. Levels of 1024 x 512 texels' panoramas changed by
    // at most 1.2e-5 of their RMS when the 16 points of `near` were replaced by four.
    suns->few_across = zonal->mixture && texel < 0.01;
}

size_t ki_points_size(const ki_zonal *zonal, int size, size_t count)
{
    ki_sun_points suns = {0};
    choose_point_counts(zonal, size, &suns);
    return ki_block_size(count, sizeof *suns.centre) +
           ki_block_size(count, 4 * sizeof *suns.pairs) +
           ki_block_size(count, (size_t)suns.near_count * sizeof *suns.near) +
           ki_block_size(count, (size_t)suns.close_count * sizeof *suns.close);
}

// Divides every sun into near_count or close_count points.
static void divide_finely(const kiln_spectrum *spectrum, int point_count, double rotation,
                          double integral, double (*points)[6])
{
    double nodes[4 * MOST_CELLS], weights[4 * MOST_CELLS];
    int n = 4;
    while (n * n < point_count)
        n += 4;
    for (int i = 0; i < n; i++) {
        int cell = i / 4, k = i % 4, cells = n / 4;
        nodes[i] = (cell + 0.5 + gauss_four[0][k]) / cells;
        weights[i] = gauss_four[1][k] / cells;
    }
    for (int i = 0; i < spectrum->sun_count; i++)
        divide(&spectrum->suns[i], spectrum->size, n, nodes, weights, rotation, integral,
               points + (size_t)point_count * (size_t)i);
}

kiln_result ki_points_create(const kiln_spectrum *spectrum, const ki_zonal *zonal, double integral,
                             double rotation, ki_points *points, kiln_error *error)
{
    static const double middle[1] = {0.5}, whole[1] = {1}, half[2] = {0.5, 0.5};
    static const double pair[2] = {0.21132486540518711775, 0.78867513459481288225};
    kiln_context *context = spectrum->context;
    *points = (ki_points){.kernels = ki_sphere_kernels(context),
                          .zonal = *zonal,
                          .suns = {.count = spectrum->sun_count}};
    ki_sun_points *suns = &points->suns;
    if (!suns->count)
        return KILN_OK;
    choose_point_counts(zonal, spectrum->size, suns);
    size_t count = (size_t)suns->count, near_count = (size_t)suns->near_count;
    size_t close_count = (size_t)suns->close_count;
    suns->centre = ki_alloc_raw(context, count, sizeof *suns->centre);
    suns->pairs = ki_alloc_raw(context, count * 4, sizeof *suns->pairs);
    suns->near = ki_alloc_raw(context, count * near_count, sizeof *suns->near);
    suns->close = ki_alloc_raw(context, count * close_count, sizeof *suns->close);
    if (!suns->centre || !suns->pairs || !suns->near || !suns->close) {
        ki_points_destroy(points);
        return ki_fail_memory(context, error, "the suns",
                              count * (near_count + close_count) * sizeof *suns->near);
    }
    for (size_t i = 0; i < count; i++) {
        const ki_sun *sun = &spectrum->suns[i];
        int size = spectrum->size;
        divide(sun, size, 1, middle, whole, rotation, integral, suns->centre + i);
        divide(sun, size, 2, pair, half, rotation, integral, suns->pairs + 4 * i);
    }
    divide_finely(spectrum, suns->near_count, rotation, integral, suns->near);
    if (close_count)
        divide_finely(spectrum, suns->close_count, rotation, integral, suns->close);
    return KILN_OK;
}

void ki_points_destroy(ki_points *points)
{
    ki_free(points->suns.centre);
    ki_free(points->suns.pairs);
    ki_free(points->suns.near);
    ki_free(points->suns.close);
    *points = (ki_points){0};
}

// Sets *list to the points that represent sun i for one direction, and returns their number: as the
// kernel suns_ggx chooses them, but at least 4 points.
static int choose_points(const ki_sun_points *suns, size_t i, const double *direction,
                         const double (**list)[6])
{
    double away = versine(direction, suns->centre[i]);
    if (away < suns->close_versine) {
        *list = (const double(*)[6])suns->close + (size_t)suns->close_count * i;
        return suns->close_count;
    }
    if (away < suns->near_versine || fabs(1 - away) < suns->horizon) {
        *list = (const double(*)[6])suns->near + (size_t)suns->near_count * i;
        return suns->near_count;
    }
    *list = (const double(*)[6])suns->pairs + 4 * i;
    return 4;
}

void ki_points_add(const ki_points *points, const double *directions, double *sum)
{
    const ki_sun_points *suns = &points->suns;
    const kiln_lobe *lobe = &points->zonal.lobe;
    if (points->zonal.mixture) {
        points->kernels->suns_mixture(suns, points->zonal.mixture, directions, sum);
        return;
    }
    bool ggx = lobe->kind == KILN_LOBE_GGX && points->zonal.outer <= 0;
    if (ggx || lobe->kind == KILN_LOBE_LAMBERT) {
        points->kernels->suns_ggx(suns, ggx ? lobe->parameter : 1, directions, sum);
        return;
    }
    // Suns through lobes other than GGX and Lambert are rare, so the eight directions are summed
    // one by one, without vectors.
    for (size_t i = 0; i < (size_t)suns->count; i++)
        for (int j = 0; j < KI_LANES; j++) {
            const double direction[3] = {directions[j], directions[8 + j], directions[16 + j]};
            const double(*list)[6];
            int count = choose_points(suns, i, direction, &list);
            for (int n = 0; n < count; n++) {
                double weight = ki_zonal_weight(&points->zonal, versine(direction, list[n]));
                for (int c = 0; c < 3; c++)
                    sum[8 * c + j] += weight * list[n][3 + c];
            }
        }
}

// -------------------------------------------------------------------------------- narrow lobes

// What integrate_cell needs to integrate weight * (1 - step) of a very narrow lobe over a square
// cell of a texel, that is the lobe's centre, which the spectrum leaves out. A cell is cut in four
// until it is small relative to its distance from `direction` and to the lobe's width. It is then
// integrated with four by four Gauss nodes, or with two by two nodes if it is very small.
typedef struct cell_sum {
    const ki_zonal *zonal;
    double direction[3], width;
} cell_sum;

static double integrate_cell(const cell_sum *sum, double phi, double theta, double size, int depth)
{
    double sine, cosine, s, c, total = 0;
    ki_sincos(theta, &sine, &cosine);
    ki_sincos(phi, &s, &c);
    const double centre[3] = {-sine * s, cosine, sine * c};
    double distance = sqrt(2 * versine(centre, sum->direction));
    double scale = fmax(distance - 0.75 * size, 0.3 * sum->width);
    if (depth < 40 && size > 0.5 * scale) {
        for (int k = 0; k < 4; k++)
            total += integrate_cell(sum, phi + (k % 2 ? 0.25 : -0.25) * size,
                                    theta + (k / 2 ? 0.25 : -0.25) * size, size / 2, depth + 1);
        return total;
    }
    int n = size > 0.1 * scale ? 4 : 2;
    const double *offsets = n == 4 ? gauss_four[0] : gauss_two[0];
    const double *weights = n == 4 ? gauss_four[1] : gauss_two[1];
    for (int j = 0; j < n; j++) {
        ki_sincos(theta + offsets[j] * size, &sine, &cosine);
        for (int i = 0; i < n; i++) {
            ki_sincos(phi + offsets[i] * size, &s, &c);
            const double at[3] = {-sine * s, cosine, sine * c};
            double away = versine(at, sum->direction);
            total += weights[i] * weights[j] * sine * ki_lobe_weight(&sum->zonal->lobe, away) *
                     (1 - ki_zonal_step(sum->zonal, away));
        }
    }
    return total * size * size;
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
    // Largest difference in longitude between the direction and a point within the angle `reach` of
    // the direction. If the disc of these points contains a pole, all longitudes occur.
    double span = KI_PI;
    if (theta - reach > 0 && theta + reach < KI_PI)
        span = ki_asin(fmin(1, ki_sin(reach) / sine));
    int columns = 2 * size, from = (int)floor((phi - span) / step),
        to = (int)floor((phi + span) / step);
    if (to - from >= columns) {
        from = 0;
        to = columns - 1;
    }
    for (int j = first; j <= last; j++) {
        const float *row = panorama->level[0] + 3 * (size_t)columns * (size_t)j;
        for (int i = from; i <= to; i++) {
            int column = ((i % columns) + columns) % columns;
            double weight =
                integrate_cell(&sum, (i + 0.5) * step, (j + 0.5) * step, step, 0) / integral;
            for (int c = 0; c < 3; c++)
                rgb[c] += weight * (double)row[3 * column + c];
        }
    }
}
