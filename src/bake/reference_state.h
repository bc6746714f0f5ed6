// What an integration by brute force works with: shared by reference.c, which sums over rows, and
// reference_cell.c, which integrates the lobe over single texels.
#ifndef KI_REFERENCE_STATE_H
#define KI_REFERENCE_STATE_H

#include "bake/reference.h"

enum {
    // Deepest level of cutting: the 2^48th part of a texel is smaller than a double resolves.
    KI_REFERENCE_DEPTH = 48
};

typedef struct ki_row_geometry {
    double cos_centre, sin_centre;
    // Means over the solid angle of the row's texels of the cosine and sine of the angle to +Y.
    double cos_mean, sin_mean;
    double cos_pair[2], sin_pair[2];
    double area; // solid angle of one texel of the row in steradians
} ki_row_geometry;

// Geometry that is the same for all cells of one depth of cutting. A texel has depth 0.
typedef struct ki_cell_geometry {
    double theta_size, phi_size;
    // Cosine and sine of the nodes' offsets from the centre of a cell.
    double theta_cos[4], theta_sin[4], phi_cos[4], phi_sin[4];
    double theta_quarter_cos, theta_quarter_sin, phi_quarter_cos, phi_quarter_sin;
} ki_cell_geometry;

typedef struct ki_reference {
    const float *texels;
    int width, height;
    ki_row_geometry *rows;
    // Means of sin phi and cos phi over each column, then sine and cosine of phi at its two
    // nodes.
    double *columns[6];
    ki_cell_geometry cells[KI_REFERENCE_DEPTH + 1];

    kiln_lobe lobe;
    bool rational; // true: GGX, or Lambert, which is GGX with alpha = 1
    // True: the lobe is linear in the cosine of the angle to the lobe's axis. The lobe at a texel's
    // mean direction is then exactly the mean of the lobe over the texel.
    bool linear;
    double a2;  // alpha^2 of a GGX lobe
    double cut; // cosine of the angle to the axis below which the lobe is 0 or negligible
    bool kink;  // true: the lobe has an edge where the cosine is `cut`
    double lobe_width;
    int depth_limit;
    ki_reference_rule rule;

    const double (*directions)[3]; // unit directions, turned by the rotation
    double (*values)[3];
    int count;
    double *scratch; // scratch memory, one piece for each group of directions in a batch
    size_t scratch_size;
} ki_reference;

/// Returns the length over which the lobe changes at a distance from its peak, both in radians.
double ki_reference_scale(const ki_reference *r, double distance);
/// Returns the mean of lobe times sin theta over a cell of this depth of cutting, for the unit
/// direction d. The angles theta and phi are those of the cell's centre.
double ki_reference_cell(const ki_reference *r, const double d[3], int depth, double sin_theta,
                         double cos_theta, double sin_phi, double cos_phi);

#endif
