// The data of an integration by brute force, shared by reference.c, which prepares the
// tables, reference_rows.inl, which sums over rows, and reference_cell.inl, which integrates the
// lobe over single texels.
#ifndef KI_REFERENCE_STATE_H
#define KI_REFERENCE_STATE_H

#include "bake/reference.h"

enum {
    // number of directions for which one pass over the panorama's rows sums
    KI_REFERENCE_GROUP = 8,
    // Greatest number of times that a texel is halved along both sides: the 2^48th part of a texel
    // is smaller than a double resolves.
    KI_REFERENCE_DEPTH = 48
};

typedef struct ki_row_geometry {
    double cos_centre, sin_centre;
    // Means of cos theta and sin theta over the solid angle of the row, where theta is the angle to
    // +Y.
    double cos_mean, sin_mean;
    double cos_pair[2], sin_pair[2];
    double area; // solid angle of each texel of the row in steradians
} ki_row_geometry;

// Geometry that is the same for all cells of one depth of cutting. A texel is a cell of depth 0,
// and a cell's quarters are one deeper.
typedef struct ki_cell_geometry {
    double theta_size, phi_size;
    // Cosine and sine of the offsets of the four Gauss nodes from the centre of a cell, in theta
    // and in phi.
    double theta_cos[4], theta_sin[4], phi_cos[4], phi_sin[4];
    double theta_quarter_cos, theta_quarter_sin, phi_quarter_cos, phi_quarter_sin;
} ki_cell_geometry;

typedef struct ki_reference {
    const float *texels;
    int width, height;
    ki_row_geometry *rows;
    // For each column: means of sin phi and cos phi over its width, then sine and cosine of phi at
    // the first Gauss node, then at the second.
    double *columns[6];
    ki_cell_geometry cells[KI_REFERENCE_DEPTH + 1];

    kiln_lobe lobe;
    // true: the lobe is GGX, or Lambert, which is GGX with alpha = 1
    bool rational;
    // True: the lobe is linear in the cosine of the angle to the lobe's axis. The lobe at a texel's
    // mean direction is then exactly the mean of the lobe over the texel.
    bool linear;
    double a2;  // alpha^2 of a GGX lobe
    double cut; // cosine of the angle to the lobe's axis below which the lobe is 0 or negligible
    bool kink;  // true: the lobe has a kink where the cosine of the angle to its axis is `cut`
    double lobe_width;
    int depth_limit;
    ki_reference_rule rule;

    const double (*directions)[3]; // unit directions of the lobe's axis, turned by the rotation
    double (*values)[3];
    int count;
    double *scratch; // scratch memory, one piece for each group of directions that a batch computes
    size_t scratch_size;
} ki_reference;

/// Computes values[first ..] for the directions of group `index`, which starts at first = index *
/// KI_REFERENCE_GROUP and has at most KI_REFERENCE_GROUP directions. `data` is a ki_reference.
/// There is one function for each instruction set, and all of them give the same bits.
ki_task ki_reference_group_scalar, ki_reference_group_simd128, ki_reference_group_avx2,
    ki_reference_group_avx512;

#endif
