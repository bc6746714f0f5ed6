// The mean of a lobe over one texel, for the brute-force filter of reference.c. In: the direction
// of the lobe's axis, and the rectangle in (theta, phi) of a texel or a part of one. Out: the mean
// of lobe times sin theta. A rectangle is cut into four if the lobe changes too fast across it, and
// so are its parts. A part that is not cut gets 4 x 4 Gauss-Legendre nodes.
#include "bake/reference_state.h"

#include "sphere/lobe.h"

#include <math.h>

// Weights of the Gauss-Legendre rule of four nodes, scaled to the sum 1. The nodes are quad_node in
// reference.c.
static const double quad_weight[4] = {0.17392742256872692869, 0.32607257743127307131,
                                      0.32607257743127307131, 0.17392742256872692869};

// Returns the length in radians over which the lobe changes at this distance from its peak.
double ki_reference_scale(const ki_reference *r, double distance)
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

// Returns the mean over a cell's rectangle in (theta, phi) of k sin theta, where k is the lobe with
// the axis d, by 4 x 4 Gauss-Legendre nodes.
static double cell_nodes(const ki_reference *r, const double d[3], const ki_cell_geometry *cell,
                         double sin_theta, double cos_theta, double sin_phi, double cos_phi)
{
    double px[4], pz[4], far[4][4], weight[4][4], total = 0;
    for (int k = 0; k < 4; k++) {
        px[k] = sin_phi * cell->phi_cos[k] + cos_phi * cell->phi_sin[k];
        pz[k] = sin_phi * cell->phi_sin[k] - cos_phi * cell->phi_cos[k];
    }
    double sines[4];
    for (int i = 0; i < 4; i++) {
        double st = sin_theta * cell->theta_cos[i] + cos_theta * cell->theta_sin[i];
        double ct = cos_theta * cell->theta_cos[i] - sin_theta * cell->theta_sin[i];
        double dy = d[1] - ct;
        sines[i] = st;
        // far: 1 - cos of the angle between the directions d and l is |d - l|^2 / 2, which is
        // precise for small angles.
        for (int k = 0; k < 4; k++) {
            double dx = d[0] - st * px[k], dz = d[2] - st * pz[k];
            far[i][k] = 0.5 * (dx * dx + dy * dy + dz * dz);
        }
    }
    if (r->rational) {
        double a2 = r->a2, slope = 0.5 * (1 - a2);
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 4; k++) {
                double c = 1 - far[i][k], ratio = a2 / (a2 + slope * far[i][k]);
                weight[i][k] = (c > 0 ? c : 0) * ratio * ratio;
            }
    } else {
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 4; k++)
                weight[i][k] = ki_lobe_weight(&r->lobe, far[i][k]);
    }
    for (int i = 0; i < 4; i++) {
        double line = 0;
        for (int k = 0; k < 4; k++)
            line += quad_weight[k] * weight[i][k];
        total += quad_weight[i] * sines[i] * line;
    }
    return total;
}

// Returns the mean that cell_nodes computes, but cuts the cell into four as long as the lobe
// changes too fast across the cell.
double ki_reference_cell(const ki_reference *r, const double d[3], int depth, double sin_theta,
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
    bool cut = size > r->rule.quads * ki_reference_scale(r, distance > 0 ? distance : 0);
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
            total += ki_reference_cell(r, d, depth + 1, st, ct, sin_phi * pc + cos_phi * ps,
                                       cos_phi * pc - sin_phi * ps);
        }
    }
    return 0.25 * total;
}
