// The sums of reference.c over the rows of a panorama, compiled once for each instruction set. In:
// up to KI_REFERENCE_GROUP directions. Out: the filtered radiance in these directions. Method: for
// each row and direction, the lobe's means over the texels are computed with 1 or 2 x 2 nodes a
// texel, or by reference_cell.inl near the lobe's peak and horizon, and are then multiplied by the
// radiance and summed.
//
// The including file defines KI_WIDTH, the number of doubles in a native vector (1, 2 or 4), and
// KI_RUN_GROUP, the name of the function ki_reference_group of its instruction set. Each sum has
// one fixed order, so that every instruction set gives the same bits.
#include "bake/reference_cell.inl"
#include "image/image.h"
#include "math/math.h"

#include <string.h>

// number of columns for which lobes other than GGX are evaluated together
enum { COLUMNS = 64 };

// The lobe's axis d, and sums over the rows for the light that the lobe gathers. d . w for a
// texel's direction w is d[1] cos theta + sin theta `along`, where theta, the angle of w to +Y, is
// constant in a row, and `along` depends on the column.
typedef struct ray_sums {
    double d[3], sin_theta;
    // Column of the axis' azimuth, in texels; texel centres are whole numbers.
    double column;
    // d[0] sin phi - d[2] cos phi at each column's azimuth phi: for the mean of sine and cosine
    // over the column, and for two Gauss nodes.
    double *along[3];
    // sums of weight times radiance for three channels, and the sum of the weights
    double sum[4];
} ray_sums;

// A range of columns about the azimuth of the lobe's axis, which may extend over the picture's
// edge.
typedef struct span {
    int first, last;
} span;

// Returns the range of columns of one row in which the direction of a texel's centre has a cosine
// above `threshold` to the lobe's axis, that of `ray`.
static span columns_above(const ki_reference *r, const ray_sums *ray, const ki_row_geometry *row,
                          double threshold)
{
    double p = ray->d[1] * row->cos_centre, q = ray->sin_theta * row->sin_centre;
    double half;
    if (p - q > threshold)
        half = r->width;
    else if (!(p + q > threshold))
        return (span){0, -1};
    else
        half = ki_acos(ki_clamp((threshold - p) / q, -1, 1)) * (r->width / (2 * KI_PI));
    span s = {(int)ceil(ray->column - half), (int)floor(ray->column + half)};
    if (half >= 0.5 * r->width || s.last - s.first + 1 > r->width) {
        s.first = (int)ceil(ray->column - 0.5 * r->width);
        s.last = s.first + r->width - 1;
    }
    return s;
}

static int wrap(const ki_reference *r, int x)
{
    return x < 0 ? x + r->width : x >= r->width ? x - r->width : x;
}

// Sets weight[x] to the mean of the lobe over the texel in column x, by 2 x 2 Gauss nodes.
static void fill_pairs(const ki_reference *r, const ray_sums *ray, const ki_row_geometry *row,
                       int first, int last, double *restrict weight)
{
    const double *restrict ea = ray->along[1], *restrict eb = ray->along[2];
    double p0 = ray->d[1] * row->cos_pair[0], p1 = ray->d[1] * row->cos_pair[1];
    double q0 = row->sin_pair[0], q1 = row->sin_pair[1];
    double w0 = 0.5 * q0 / (q0 + q1), w1 = 0.5 * q1 / (q0 + q1);
    for (int from = first, n; !r->rational && from <= last; from += n) {
        double node[4][COLUMNS];
        n = ki_min(COLUMNS, last - from + 1);
        for (int i = 0; i < n; i++) {
            double a = ea[from + i], b = eb[from + i];
            node[0][i] = 1 - (p0 + q0 * a);
            node[1][i] = 1 - (p0 + q0 * b);
            node[2][i] = 1 - (p1 + q1 * a);
            node[3][i] = 1 - (p1 + q1 * b);
        }
        for (int k = 0; k < 4; k++)
            weigh(&r->lobe, node[k], n);
        for (int i = 0; i < n; i++)
            weight[from + i] = w0 * (node[0][i] + node[1][i]) + w1 * (node[2][i] + node[3][i]);
    }
    if (!r->rational)
        return;
    double a2 = r->a2, high = 0.5 * (1 + a2), slope = 0.5 * (1 - a2);
    for (int x = first; x <= last; x++) {
        double ca = p0 + q0 * ea[x], cb = p0 + q0 * eb[x];
        double cc = p1 + q1 * ea[x], cd = p1 + q1 * eb[x];
        double da = high - slope * ca, db = high - slope * cb;
        double dc = high - slope * cc, dd = high - slope * cd;
        // The quotients a2 / d of the four nodes share one division, because a division takes
        // longer than products.
        double scale = a2 / ((da * db) * (dc * dd));
        double ra = scale * db * (dc * dd), rb = scale * da * (dc * dd);
        double rc = scale * (da * db) * dd, rd = scale * (da * db) * dc;
        ca = ca > 0 ? ca : 0;
        cb = cb > 0 ? cb : 0;
        cc = cc > 0 ? cc : 0;
        cd = cd > 0 ? cd : 0;
        weight[x] = w0 * (ca * (ra * ra) + cb * (rb * rb)) + w1 * (cc * (rc * rc) + cd * (rd * rd));
    }
}

// Sets weight[x] to the lobe at the mean direction of the texel in column x. This value equals the
// lobe's mean over the texel if the lobe is linear in the cosine of the angle to the lobe's axis.
static void fill_means(const ki_reference *r, const ray_sums *ray, const ki_row_geometry *row,
                       int first, int last, double *restrict weight)
{
    const double *restrict e = ray->along[0];
    double p = ray->d[1] * row->cos_mean, q = row->sin_mean;
    if (!r->rational) {
        for (int x = first; x <= last; x++)
            weight[x] = 1 - (p + q * e[x]);
        if (first <= last)
            weigh(&r->lobe, weight + first, last - first + 1);
        return;
    }
    double a2 = r->a2, high = 0.5 * (1 + a2), slope = 0.5 * (1 - a2);
    for (int x = first; x <= last; x++) {
        double c = p + q * e[x], ratio = a2 / (high - slope * c);
        weight[x] = (c > 0 ? c : 0) * ratio * ratio;
    }
}

// Adds weight times radiance for the columns first .. last to the sums of `ray`. Sums in four lanes
// that start at `first`, so that the bits do not depend on the instruction set.
static void gather(ray_sums *ray, const double *weight, const double *const plane[3], int first,
                   int last, double area)
{
    enum { LANES = 4 };
    vec lane[4][LANES / KI_WIDTH];
    for (int c = 0; c < 4; c++)
        for (int h = 0; h < LANES / KI_WIDTH; h++)
            lane[c][h] = splat(0);
    int x = first;
    for (; x + LANES - 1 <= last; x += LANES)
        for (int h = 0; h < LANES / KI_WIDTH; h++) {
            ptrdiff_t at = x + h * KI_WIDTH;
            vec w = load(weight + at);
            for (int c = 0; c < 3; c++)
                lane[c][h] += w * load(plane[c] + at);
            lane[3][h] += w;
        }
    double sum[4];
    for (int c = 0; c < 4; c++) {
        double part[LANES];
        memcpy(part, lane[c], sizeof part);
        sum[c] = (part[0] + part[1]) + (part[2] + part[3]);
    }
    for (; x <= last; x++) {
        for (int c = 0; c < 3; c++)
            sum[c] += weight[x] * plane[c][x];
        sum[3] += weight[x];
    }
    for (int c = 0; c < 4; c++)
        ray->sum[c] += area * sum[c];
}

static void refine(const ki_reference *r, const ray_sums *ray, const ki_row_geometry *row, span s,
                   double *weight)
{
    double step = 2 * KI_PI / r->width, step_theta = KI_PI / r->height;
    // cell_mean returns the mean of lobe times sin theta over (theta, phi). This factor
    // turns that mean into the lobe's mean over the texel's solid angle.
    double scale = step * step_theta / row->area;
    for (int i = s.first; i <= s.last; i++) {
        int x = wrap(r, i);
        double sine, cosine;
        ki_sincos(2 * KI_PI * ((x + 0.5) / r->width - 0.5), &sine, &cosine);
        weight[x] = scale * cell_mean(r, ray->d, 0, row->sin_centre, row->cos_centre, sine, cosine);
    }
}

// Returns true if, for every texel of a row, the lobe's value at one direction is near enough to
// the lobe's mean over the texel; otherwise texels need 2 x 2 nodes. The decision is made for the
// point of the row that is nearest to the lobe's peak. Texels nearer to the peak than some angle
// need more than 2 x 2 nodes; *near receives the cosine of this angle.
static bool means_suffice(const ki_reference *r, const ray_sums *ray, const ki_row_geometry *row,
                          double *near)
{
    double theta_size = KI_PI / r->height;
    double width = 2 * KI_PI / r->width * row->sin_centre;
    double size = theta_size > width ? theta_size : width;
    double c = ray->d[1] * row->cos_centre + ray->sin_theta * row->sin_centre;
    double nearest = ki_acos(ki_clamp(c, -1, 1)) - 0.5 * theta_size;

    // 2 x 2 nodes suffice where the lobe changes over this length in radians or a greater one
    double length = size / r->rule.pairs;
    *near = 2;
    if (r->rational) {
        double reach2 = length * length - r->lobe_width * r->lobe_width;
        if (reach2 > 0)
            *near = ki_cos(ki_clamp(sqrt(reach2) + size, 0, KI_PI));
    } else if (r->lobe.kind == KILN_LOBE_CUSTOM) {
        if (length > r->lobe_width)
            *near = ki_cos(ki_clamp(4 * length + size, 0, KI_PI));
    } else if (length > r->lobe_width) {
        *near = -2;
    } else if (r->lobe.kind == KILN_LOBE_CHARLIE) {
        *near = ki_cos(ki_clamp(length + size, 0, KI_PI));
    }
    return r->linear || size < r->rule.centre * length_of_change(r, nearest > 0 ? nearest : 0);
}

static void row_of_ray(const ki_reference *r, ray_sums *ray, const ki_row_geometry *row,
                       const double *const plane[3], double *weight)
{
    double width = 2 * KI_PI / r->width * (row->sin_centre + KI_PI / r->height);
    double margin = 0.51 * sqrt(width * width + (KI_PI / r->height) * (KI_PI / r->height));
    span outer = columns_above(r, ray, row, r->cut - margin);
    if (outer.last < outer.first)
        return;

    double near;
    bool means = means_suffice(r, ray, row, &near);
    // The range of columns in which the lobe is above 0 is summed in three pieces: left of the
    // picture's edge, inside the picture, and right of its edge.
    int w = r->width;
    span piece[3] = {{outer.first + w, ki_min(outer.last, -1) + w},
                     {ki_max(outer.first, 0), ki_min(outer.last, w - 1)},
                     {ki_max(outer.first, w) - w, outer.last - w}};
    span inner = columns_above(r, ray, row, near - margin);
    bool all = inner.first <= outer.first && inner.last >= outer.last;
    for (int k = 0; k < 3 && !all; k++) {
        if (means)
            fill_means(r, ray, row, piece[k].first, piece[k].last, weight);
        else
            fill_pairs(r, ray, row, piece[k].first, piece[k].last, weight);
    }
    if (inner.last >= inner.first)
        refine(r, ray, row,
               (span){ki_max(inner.first, outer.first), ki_min(inner.last, outer.last)}, weight);
    if (r->kink && !all) {
        span whole = columns_above(r, ray, row, r->cut + margin);
        if (whole.last < whole.first)
            whole = (span){outer.last + 1, outer.last};
        refine(r, ray, row, (span){outer.first, ki_min(whole.first - 1, outer.last)}, weight);
        refine(r, ray, row, (span){ki_max(whole.last + 1, outer.first), outer.last}, weight);
    }
    for (int k = 0; k < 3; k++)
        if (piece[k].first <= piece[k].last)
            gather(ray, weight, plane, piece[k].first, piece[k].last, row->area);
}

static void start_ray(const ki_reference *r, ray_sums *ray, const double direction[3],
                      double *along)
{
    memcpy(ray->d, direction, sizeof ray->d);
    ray->sin_theta = sqrt(direction[0] * direction[0] + direction[2] * direction[2]);
    double u, v;
    ki_direction_panorama(direction, &u, &v);
    ray->column = u * r->width - 0.5;
    memset(ray->sum, 0, sizeof ray->sum);
    for (int k = 0; k < 3; k++) {
        const double *sine = r->columns[(size_t)k * 2], *cosine = r->columns[(size_t)k * 2 + 1];
        ray->along[k] = along + (size_t)k * (size_t)r->width;
        for (int x = 0; x < r->width; x++)
            ray->along[k][x] = direction[0] * sine[x] - direction[2] * cosine[x];
    }
}

void KI_RUN_GROUP(void *data, int index)
{
    const ki_reference *r = data;
    size_t width = (size_t)r->width;
    int first = index * KI_REFERENCE_GROUP, count = ki_min(KI_REFERENCE_GROUP, r->count - first);
    double *scratch = r->scratch + (size_t)index * r->scratch_size;
    double *plane[3] = {scratch, scratch + width, scratch + 2 * width};
    double *weight = scratch + 3 * width;
    ray_sums rays[KI_REFERENCE_GROUP];
    for (int i = 0; i < count; i++)
        start_ray(r, &rays[i], r->directions[first + i], scratch + (4 + 3 * (size_t)i) * width);

    for (int y = 0; y < r->height; y++) {
        const float *texel = r->texels + (size_t)y * width * 3;
        for (size_t x = 0; x < width; x++)
            for (size_t c = 0; c < 3; c++)
                plane[c][x] = (double)texel[3 * x + c];
        for (int i = 0; i < count; i++)
            row_of_ray(r, &rays[i], &r->rows[y], (const double *const *)plane, weight);
    }
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            r->values[first + i][c] = rays[i].sum[3] > 0 ? rays[i].sum[c] / rays[i].sum[3] : 0;
}
