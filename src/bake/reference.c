// Filtering by brute force with a controlled error. In: a panorama, a lobe and directions. Out: the
// filtered radiance in each direction.
//
// For a direction d the wanted value is
//
//     sum over texels t of  L_t I_t  /  sum of I_t,     I_t = integral over t of k(d . w) dw,
//
// where L_t is the radiance of texel t and k the lobe. I_t is computed by a product Gauss-Legendre
// rule in (theta, phi). The number of nodes depends on the distance of the texel from the peak of
// the lobe: GGX changes over the length sqrt(width^2 + distance^2), because its nearest complex
// poles lie at that distance. Most texels are computed a row at a time with 1 or 2 x 2 nodes.
// Texels near the peak or crossed by the lobe's horizon are computed singly: each is cut into four
// as often as needed, and each cell gets 4 x 4 nodes.
#include "bake/reference_state.h"

#include "image/image.h"
#include "math/math.h"
#include "sphere/lobe.h"

#include <math.h>
#include <string.h>

enum {
    GROUP = 8,  // number of directions for which one pass over the panorama's rows sums
    BATCH = 16, // number of groups of directions between two progress reports
};

// Nodes of the Gauss-Legendre rules on [-1, 1]: the positive one of two nodes, and all of four
// nodes.
static const double pair_node = 0.57735026918962576451;
static const double quad_node[4] = {-0.86113631159405257522, -0.33998104358485626480,
                                    0.33998104358485626480, 0.86113631159405257522};

// ------------------------------------------------------------------------------------------- setup

static void set_rows(ki_reference *r)
{
    double step = KI_PI / r->height;
    for (int y = 0; y < r->height; y++) {
        ki_row_geometry *row = &r->rows[y];
        double s0, c0, s1, c1, centre = step * (y + 0.5);
        ki_sincos(step * y, &s0, &c0);
        ki_sincos(step * (y + 1), &s1, &c1);
        ki_sincos(centre, &row->sin_centre, &row->cos_centre);
        // The row's height is the difference of the cosines of its edges.
        // cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2) avoids the cancellation of that
        // difference.
        double height = 2 * row->sin_centre * ki_sin(step / 2);
        row->area = height * (2 * KI_PI / r->width);
        // Means of cos theta and sin theta over the solid angle of the row.
        row->cos_mean = row->cos_centre * ki_cos(step / 2);
        row->sin_mean = (step - (s1 * c1 - s0 * c0)) / (2 * height);
        for (int k = 0; k < 2; k++)
            ki_sincos(centre + (k ? 1 : -1) * pair_node * step / 2, &row->sin_pair[k],
                      &row->cos_pair[k]);
    }
}

static void set_columns(ki_reference *r)
{
    double step = 2 * KI_PI / r->width;
    double mean = ki_sin(step / 2) / (step / 2);
    for (int x = 0; x < r->width; x++) {
        double centre = 2 * KI_PI * ((x + 0.5) / r->width - 0.5);
        ki_sincos(centre, &r->columns[0][x], &r->columns[1][x]);
        r->columns[0][x] *= mean;
        r->columns[1][x] *= mean;
        for (int k = 0; k < 2; k++)
            ki_sincos(centre + (k ? 1 : -1) * pair_node * step / 2, &r->columns[2 + 2 * k][x],
                      &r->columns[3 + 2 * k][x]);
    }
}

static void set_cells(ki_reference *r)
{
    double theta = KI_PI / r->height, phi = 2 * KI_PI / r->width;
    for (int d = 0; d <= KI_REFERENCE_DEPTH; d++, theta /= 2, phi /= 2) {
        ki_cell_geometry *cell = &r->cells[d];
        cell->theta_size = theta;
        cell->phi_size = phi;
        for (int k = 0; k < 4; k++) {
            ki_sincos(quad_node[k] * theta / 2, &cell->theta_sin[k], &cell->theta_cos[k]);
            ki_sincos(quad_node[k] * phi / 2, &cell->phi_sin[k], &cell->phi_cos[k]);
        }
        ki_sincos(theta / 4, &cell->theta_quarter_sin, &cell->theta_quarter_cos);
        ki_sincos(phi / 4, &cell->phi_quarter_sin, &cell->phi_quarter_cos);
    }
}

static void set_lobe(ki_reference *r, const kiln_lobe *lobe)
{
    r->lobe = *lobe;
    r->lobe_width = ki_lobe_width(lobe);
    r->rational = lobe->kind == KILN_LOBE_GGX || lobe->kind == KILN_LOBE_LAMBERT;
    r->depth_limit = lobe->kind == KILN_LOBE_CHARLIE ? 6 : KI_REFERENCE_DEPTH;
    r->kink = lobe->kind != KILN_LOBE_CUSTOM;
    r->cut = r->kink ? 0 : -2;
    if (r->rational) {
        double alpha = lobe->kind == KILN_LOBE_GGX ? lobe->parameter : 1;
        r->a2 = alpha * alpha;
        r->lobe_width = 2 * alpha;
        r->linear = alpha == 1;
    } else if (lobe->kind == KILN_LOBE_PHONG) {
        // Where cos^n theta, the lobe with exponent n, is below e^-60 = 1e-26 of its peak, the lobe
        // is left out.
        double cut = ki_exp(-60 / lobe->parameter);
        if (cut > 0.01) {
            r->cut = cut;
            r->kink = false;
        }
    }
}

static void set_rule(ki_reference *r, const ki_reference_rule *rule)
{
    r->rule.centre = rule->centre > 0 ? rule->centre : 1.0 / 300;
    r->rule.pairs = rule->pairs > 0 ? rule->pairs : 1.0 / 20;
    r->rule.quads = rule->quads > 0 ? rule->quads : 0.5;
    r->rule.edge = rule->edge;
    if (!(rule->edge > 0)) {
        // Default size of cells that the lobe's horizon crosses. Relative to its integral, a GGX
        // lobe at the horizon has at most 4 alpha^2 / (1 + alpha^2)^2 times the weight of the
        // Lambert lobe, so that larger cells may cross the horizon of a narrow lobe.
        r->rule.edge = 0.0025;
        if (r->rational)
            r->rule.edge = ki_clamp(0.0025 * (1 + r->a2) / (2 * sqrt(r->a2)), 0, 0.01);
    }
}

// -------------------------------------------------------------------------------------- row by row

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
    if (!r->rational) {
        for (int x = first; x <= last; x++) {
            double a = p0 + q0 * ea[x], b = p0 + q0 * eb[x];
            double c = p1 + q1 * ea[x], d = p1 + q1 * eb[x];
            weight[x] = w0 * (ki_lobe_weight(&r->lobe, 1 - a) + ki_lobe_weight(&r->lobe, 1 - b)) +
                        w1 * (ki_lobe_weight(&r->lobe, 1 - c) + ki_lobe_weight(&r->lobe, 1 - d));
        }
        return;
    }
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
            weight[x] = ki_lobe_weight(&r->lobe, 1 - (p + q * e[x]));
        return;
    }
    double a2 = r->a2, high = 0.5 * (1 + a2), slope = 0.5 * (1 - a2);
    for (int x = first; x <= last; x++) {
        double c = p + q * e[x], ratio = a2 / (high - slope * c);
        weight[x] = (c > 0 ? c : 0) * ratio * ratio;
    }
}

typedef double lanes __attribute__((vector_size(32), aligned(8)));

// Adds weight times radiance for the columns first .. last to the sums of `ray`. Sums in four lanes
// that start at `first`, so that the bits do not depend on the instruction set.
static void gather(ray_sums *ray, const double *weight, const double *const plane[3], int first,
                   int last, double area)
{
    lanes red = {0}, green = {0}, blue = {0}, all = {0};
    int x = first;
    for (; x + 3 <= last; x += 4) {
        lanes w, l0, l1, l2;
        memcpy(&w, weight + x, sizeof w);
        memcpy(&l0, plane[0] + x, sizeof l0);
        memcpy(&l1, plane[1] + x, sizeof l1);
        memcpy(&l2, plane[2] + x, sizeof l2);
        red += w * l0;
        green += w * l1;
        blue += w * l2;
        all += w;
    }
    double sum[4] = {
        (red[0] + red[1]) + (red[2] + red[3]), (green[0] + green[1]) + (green[2] + green[3]),
        (blue[0] + blue[1]) + (blue[2] + blue[3]), (all[0] + all[1]) + (all[2] + all[3])};
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
    // ki_reference_cell returns the mean of lobe times sin theta over (theta, phi). This factor
    // turns that mean into the lobe's mean over the texel's solid angle.
    double scale = step * step_theta / row->area;
    for (int i = s.first; i <= s.last; i++) {
        int x = wrap(r, i);
        double sine, cosine;
        ki_sincos(2 * KI_PI * ((x + 0.5) / r->width - 0.5), &sine, &cosine);
        weight[x] =
            scale * ki_reference_cell(r, ray->d, 0, row->sin_centre, row->cos_centre, sine, cosine);
    }
}

// Returns true if in a row the lobe need be evaluated only once for each texel; otherwise texels
// need 2 x 2 nodes. The decision is for the part of the row that is nearest to the lobe's peak.
// *near receives the cosine of the distance from the peak below which even 2 x 2 nodes do not
// suffice.
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
    return r->linear || size < r->rule.centre * ki_reference_scale(r, nearest > 0 ? nearest : 0);
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

static void run_group(void *data, int index)
{
    const ki_reference *r = data;
    size_t width = (size_t)r->width;
    int first = index * GROUP, count = ki_min(GROUP, r->count - first);
    double *scratch = r->scratch + (size_t)index * r->scratch_size;
    double *plane[3] = {scratch, scratch + width, scratch + 2 * width};
    double *weight = scratch + 3 * width;
    ray_sums rays[GROUP];
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

// ------------------------------------------------------------------------------------------- whole

static void mirror(const kiln_map *panorama, const double direction[3], double value[3])
{
    double u, v;
    ki_direction_panorama(direction, &u, &v);
    int height = panorama->size, width = 2 * height;
    int x = ki_min((int)(u * width), width - 1), y = ki_min((int)(v * height), height - 1);
    const float *texel = panorama->level[0] + 3 * ((size_t)y * (size_t)width + (size_t)x);
    for (int c = 0; c < 3; c++)
        value[c] = (double)texel[c];
}

// Normalises `count` directions and turns them by `rotation` degrees about +Y.
static void set_directions(double (*to)[3], const double (*from)[3], int count, double rotation)
{
    for (int i = 0; i < count; i++) {
        double length =
            sqrt(from[i][0] * from[i][0] + from[i][1] * from[i][1] + from[i][2] * from[i][2]);
        double unit[3] = {from[i][0] / length, from[i][1] / length, from[i][2] / length};
        ki_turn(unit, rotation, to[i]);
    }
}

static kiln_result integrate(kiln_context *context, ki_reference *r, kiln_error *error)
{
    static const char stage[] = "reference";
    int groups = r->count / GROUP + (r->count % GROUP > 0);
    for (int done = 0; done < groups; done += BATCH) {
        if (!ki_progress(context, stage, (double)done / groups))
            return ki_fail_cancelled(error, stage);
        ki_reference batch = *r;
        batch.directions += (ptrdiff_t)done * GROUP;
        batch.values += (ptrdiff_t)done * GROUP;
        batch.count -= done * GROUP;
        ki_parallel_for(context, ki_min(BATCH, groups - done), run_group, &batch);
    }
    return ki_progress(context, stage, 1) ? KILN_OK : ki_fail_cancelled(error, stage);
}

kiln_result ki_reference_integrate(kiln_context *context, const kiln_map *panorama,
                                   const kiln_lobe *lobe, double rotation,
                                   const double (*directions)[3], int count,
                                   const ki_reference_rule *rule, double (*values)[3],
                                   kiln_error *error)
{
    kiln_result result = KILN_OK;
    size_t width = 2 * (size_t)panorama->size;
    double(*turned)[3] = NULL, *columns = NULL;
    ki_reference *r = ki_alloc(context, 1, sizeof *r);
    int groups = ki_min(BATCH, count / GROUP + (count % GROUP > 0));
    if (count < 1)
        goto done;
    turned = ki_alloc(context, (size_t)count, sizeof *turned);
    columns = ki_alloc(context, 6 * width, sizeof *columns);
    if (r) {
        r->texels = panorama->level[0];
        r->width = 2 * panorama->size;
        r->height = panorama->size;
        r->rows = ki_alloc_raw(context, (size_t)r->height, sizeof *r->rows);
        r->scratch_size = (4 + 3 * (size_t)GROUP) * width;
        r->scratch = ki_alloc_raw(context, (size_t)groups * r->scratch_size, sizeof(double));
    }
    if (!turned || !columns || !r || !r->rows || !r->scratch) {
        result = ki_fail_memory(context, error, "the reference's scratch",
                                (size_t)groups * (4 + 3 * (size_t)GROUP) * width * sizeof(double));
        goto done;
    }
    set_directions(turned, directions, count, rotation);
    if (lobe->kind == KILN_LOBE_GGX && lobe->parameter < 1e-9) {
        for (int i = 0; i < count; i++)
            mirror(panorama, (const double *)turned[i], values[i]);
        goto done;
    }
    for (size_t k = 0; k < 6; k++)
        r->columns[k] = columns + k * width;
    set_rows(r);
    set_columns(r);
    set_cells(r);
    set_lobe(r, lobe);
    set_rule(r, rule ? rule : &(ki_reference_rule){0});
    r->directions = (const double(*)[3])turned;
    r->values = values;
    r->count = count;
    result = integrate(context, r, error);
done:
    if (r) {
        ki_free(r->scratch);
        ki_free(r->rows);
    }
    ki_free(r);
    ki_free(columns);
    ki_free(turned);
    if (result && count > 0)
        memset(values, 0, (size_t)count * sizeof *values);
    return result;
}
