// The norms in which tuned levels minimise their error: over the whole sphere (the first norm), and
// over the sphere without 8 degrees around each sun (the second norm). docs/theory/tuning.md.
#ifndef KI_TUNE_NORMS_H
#define KI_TUNE_NORMS_H

#include "tune/tune_mix.h"

/// The two norms of errors, as matrices over the lobes of mixtures. The scalar products of the
/// environment filtered by lobe i and by lobe j form a symmetric matrix in each norm: G for the
/// whole sphere, H away from suns. The generalised eigenvectors, H u = ratio G u, called axes, are
/// orthonormal in the norm of G and orthogonal in the norm of H, in which axis u has the squared
/// length `ratio`.
typedef struct ki_norms {
    int count; // number of lobes, which is also the number of axes (eigenvectors)
    // squared norm over the whole sphere of the environment filtered by each lobe, over the squared
    // mean radiance
    double whole[KI_MOST_LOBES];
    // squared norm away from suns of the environment filtered by each lobe, over the squared mean
    // radiance
    double away[KI_MOST_LOBES];
    // eigenvalue of each axis (eigenvector): the ratio of the axis' squared norm away from suns to
    // its squared norm over the whole sphere
    double ratio[KI_MOST_LOBES];
    // [axis][lobe]: the components of each axis (eigenvector): the weights of the lobes in the
    // mixture that the axis stands for
    double *along;
    // [axis][lobe]: scalar product, over the whole sphere, of the environment filtered by the
    // mixture of each axis and of the environment filtered by each lobe
    double *across;
} ki_norms;

/// Computes the norms of errors for an environment. `power` and `degree` are described at
/// ki_mixtures_find.
kiln_result ki_norms_create(kiln_context *context, const ki_nodes *nodes,
                            const kiln_spectrum *spectrum, const double (*power)[3], int degree,
                            ki_norms *norms, kiln_error *error);
void ki_norms_destroy(ki_norms *norms);

#endif
