// The two norms in which tuned levels minimise their error: over the whole sphere, and over the
// sphere without 8 degrees around each sun. docs/theory/tuning.md.
#ifndef KI_TUNE_NORMS_H
#define KI_TUNE_NORMS_H

#include "tune/tune_mix.h"

/// The two norms in the basis of lobes. The scalar products of the environment filtered by lobe i
/// and by lobe j form a symmetric matrix in each norm: G for the whole sphere, H away from suns.
/// The generalised eigenvectors, H u = ratio G u, called axes, are orthonormal in the first norm
/// and orthogonal in the second, in which axis u has the squared length `ratio`.
typedef struct ki_norms {
    int count; // number of lobes, which is also the number of axes
    // squared first norm of the environment filtered by each lobe, over the squared mean radiance
    double whole[KI_MOST_LOBES];
    // squared second norm of the environment filtered by each lobe, over the squared mean radiance
    double away[KI_MOST_LOBES];
    double ratio[KI_MOST_LOBES]; // eigenvalue of each axis
    double *along;               // [axis][lobe]: the axis as a mixture of lobes
    double *across;              // [axis][lobe]: scalar product of axis and lobe in the first norm
} ki_norms;

/// Computes the norms for an environment. `power` is that of ki_mixtures_find.
kiln_result ki_norms_create(kiln_context *context, const ki_nodes *nodes,
                            const kiln_spectrum *spectrum, const double (*power)[3],
                            ki_norms *norms, kiln_error *error);
void ki_norms_destroy(ki_norms *norms);

#endif
