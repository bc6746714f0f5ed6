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
// poles lie at that distance. Most texels are computed a row at a time with 1 or 2 x 2 nodes
// (reference_rows.inl). Texels near the peak or crossed by the lobe's horizon are computed singly:
// each is cut into four as often as needed, and each cell gets 4 x 4 nodes (reference_cell.inl).
#include "bake/reference_state.h"

#include "base/vector.h"
#include "image/image.h"
#include "math/math.h"
#include "sphere/lobe.h"

#include <math.h>
#include <string.h>

enum {
    GROUP = KI_REFERENCE_GROUP,
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
    ki_task *run = KI_FASTEST(context, ki_reference_group);
    int groups = r->count / GROUP + (r->count % GROUP > 0);
    for (int done = 0; done < groups; done += BATCH) {
        if (!ki_progress(context, stage, (double)done / groups))
            return ki_fail_cancelled(error, stage);
        ki_reference batch = *r;
        batch.directions += (ptrdiff_t)done * GROUP;
        batch.values += (ptrdiff_t)done * GROUP;
        batch.count -= done * GROUP;
        ki_parallel_for(context, ki_min(BATCH, groups - done), run, &batch);
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
