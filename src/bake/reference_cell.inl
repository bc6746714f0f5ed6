// The mean of a lobe over one texel, for the brute-force filter of reference.c. In: the direction
// of the lobe's axis, and the rectangle in (theta, phi) of a texel or a part of one. Out: the mean
// of lobe times sin theta. A rectangle is cut into four if the lobe changes too fast across it, and
// so are its parts. A part that is not cut gets 4 x 4 Gauss-Legendre nodes.
#include "bake/reference_state.h"

#include "base/lanes.inl"
#include "sphere/lobe.h"
#include "sphere/lobe.inl"

#include <math.h>

// Weights of the Gauss-Legendre rule of four nodes, scaled to the sum 1. The nodes are quad_node in
// reference.c.
static const double quad_weight[4] = {0.17392742256872692869, 0.32607257743127307131,
                                      0.32607257743127307131, 0.17392742256872692869};

// Returns the length in radians over which the lobe changes at this distance from its peak.
static double length_of_change(const ki_reference *r, double distance)
{
    if (r->rational)
        return sqrt(r->lobe_width * r->lobe_width + distance * distance);
    if (r->lobe.kind == KILN_LOBE_CHARLIE && distance < r->lobe_width)
        // the Charlie lobe is a power of the distance from its axis, and not always a smooth one
        return distance;
    if (r->lobe.kind == KILN_LOBE_CUSTOM && distance > 4 * r->lobe_width)
        return distance / 4;
    return r->lobe_width;
}

// Replaces 1 - cos theta of `count` directions by the lobe's weights there (ki_lobe_weight).
// Vectors compute a power for every direction, also below the horizon, where scalar code leaves the
// power out.
static void weigh(const kiln_lobe *lobe, double *restrict values, int count)
{
    if (KI_WIDTH > 1 && lobe->kind == KILN_LOBE_CHARLIE) {
        double exponent = 0.5 / lobe->parameter;
        for (int i = 0; i < count; i++)
            values[i] = charlie_weight(exponent, values[i]);
    } else if (KI_WIDTH > 1 && lobe->kind == KILN_LOBE_PHONG) {
        double exponent = lobe->parameter;
        for (int i = 0; i < count; i++)
            values[i] = phong_weight(exponent, values[i]);
    } else {
        for (int i = 0; i < count; i++)
            values[i] = ki_lobe_weight(lobe, values[i]);
    }
}

// Replaces 1 - cos theta at 4 x 4 nodes by the weights of the GGX lobe with alpha^2 = a2.
static void weigh_ggx(double a2, double values[4][4])
{
    double slope = 0.5 * (1 - a2);
    for (int k = 0; k < 4; k++)
        for (int h = 0; h < 4; h += KI_WIDTH) {
            vec far = load(values[k] + h), ratio = a2 / (a2 + slope * far);
            store(values[k] + h, positive(1 - far) * ratio * ratio);
        }
}

// Sets far[k][i] to 1 - cos of the angle between the direction d and node (i, k) of a cell, where i
// counts the nodes in theta and k the nodes in phi. 1 - cos of the angle between the directions d
// and l is |d - l|^2 / 2, which is precise for small angles. Sets sines[i] to sin theta of the
// nodes.
static void node_distances(const double d[3], const ki_cell_geometry *cell, double sin_theta,
                           double cos_theta, double sin_phi, double cos_phi, double far[4][4],
                           double sines[4])
{
    for (int h = 0; h < 4; h += KI_WIDTH) {
        vec tc = load(cell->theta_cos + h), ts = load(cell->theta_sin + h);
        vec st = sin_theta * tc + cos_theta * ts, ct = cos_theta * tc - sin_theta * ts;
        vec dy = d[1] - ct;
        store(sines + h, st);
        for (int k = 0; k < 4; k++) {
            double px = sin_phi * cell->phi_cos[k] + cos_phi * cell->phi_sin[k];
            double pz = sin_phi * cell->phi_sin[k] - cos_phi * cell->phi_cos[k];
            vec dx = d[0] - st * px, dz = d[2] - st * pz;
            store(far[k] + h, 0.5 * (dx * dx + dy * dy + dz * dz));
        }
    }
}

// Returns the mean over a cell's rectangle in (theta, phi) of k sin theta, where k is the lobe with
// the axis d, by 4 x 4 Gauss-Legendre nodes.
static double cell_nodes(const ki_reference *r, const double d[3], const ki_cell_geometry *cell,
                         double sin_theta, double cos_theta, double sin_phi, double cos_phi)
{
    double weight[4][4], sines[4], rows[4];
    node_distances(d, cell, sin_theta, cos_theta, sin_phi, cos_phi, weight, sines);
    if (r->rational)
        weigh_ggx(r->a2, weight);
    else
        weigh(&r->lobe, weight[0], 16);
    for (int h = 0; h < 4; h += KI_WIDTH) {
        vec line = splat(0);
        for (int k = 0; k < 4; k++)
            line += quad_weight[k] * load(weight[k] + h);
        store(rows + h, load(quad_weight + h) * load(sines + h) * line);
    }
    return ((rows[0] + rows[1]) + rows[2]) + rows[3];
}

// Returns the mean that cell_nodes computes, but cuts the cell into four as long as the lobe
// changes too fast across the cell.
static double cell_mean(const ki_reference *r, const double d[3], int depth, double sin_theta,
                        double cos_theta, double sin_phi, double cos_phi)
{
    const ki_cell_geometry *cell = &r->cells[depth];
    double dx = d[0] - sin_theta * sin_phi, dy = d[1] - cos_theta;
    double dz = d[2] + sin_theta * cos_phi;
    double chord2 = dx * dx + dy * dy + dz * dz;

    double width = sin_theta + 0.5 * cell->theta_size;
    width = cell->phi_size * (width < 1 ? width : 1);
    double size = cell->theta_size > width ? cell->theta_size : width;
    double reach = 0.51 * sqrt(cell->theta_size * cell->theta_size + width * width);
    double distance = sqrt(chord2) - reach;
    bool cut = size > r->rule.quads * length_of_change(r, distance > 0 ? distance : 0);
    cut |= r->kink && size > r->rule.edge && fabs(1 - 0.5 * chord2) < reach;
    if (!cut || depth == r->depth_limit)
        return cell_nodes(r, d, cell, sin_theta, cos_theta, sin_phi, cos_phi);

    double total = 0;
    for (int i = 0; i < 2; i++) {
        double sign = i ? 1 : -1;
        double ts = sign * cell->theta_quarter_sin, tc = cell->theta_quarter_cos;
        double st = sin_theta * tc + cos_theta * ts, ct = cos_theta * tc - sin_theta * ts;
        for (int k = 0; k < 2; k++) {
            double ps = (k ? 1 : -1) * cell->phi_quarter_sin, pc = cell->phi_quarter_cos;
            total += cell_mean(r, d, depth + 1, st, ct, sin_phi * pc + cos_phi * ps,
                               cos_phi * pc - sin_phi * ps);
        }
    }
    return 0.25 * total;
}
