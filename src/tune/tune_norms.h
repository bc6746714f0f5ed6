// Two norms of what levels show: over the whole sphere, and away from suns.
#ifndef KI_TUNE_NORMS_H
#define KI_TUNE_NORMS_H

#include "tune/tune_mix.h"

/// The scalar products of the environment seen through each pair of lobes form a symmetric matrix in each
/// norm, G and H. Their generalised eigenbasis, H u = ratio G u, is orthonormal in the first norm and
/// orthogonal in the second, where axis u has the squared length `ratio`.
typedef struct ki_norms {
    int count; // of lobes, and of axes
    double whole[KI_MOST_LOBES],
        away[KI_MOST_LOBES];     // squared norms of each lobe's result, / mean^2
    double ratio[KI_MOST_LOBES]; // eigenvalue of each axis
    double *along;               // [axis][lobe]: the axis as a mixture
    double *across; // [axis][lobe]: its scalar product with each lobe, in the first norm
} ki_norms;

/// `power` as for ki_mixtures_find.
kiln_result ki_norms_create(kiln_context *context, const ki_nodes *nodes,
                            const kiln_spectrum *spectrum, const double (*power)[3],
                            ki_norms *norms, kiln_error *error);
void ki_norms_destroy(ki_norms *norms);

#endif
