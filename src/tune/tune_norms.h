// Two norms of what levels show: over the whole sphere, and away from suns.
#ifndef KI_TUNE_NORMS_H
#define KI_TUNE_NORMS_H

#include "tune/tune_mix.h"

/// The environment seen through a palette's lobes has scalar products in both norms. They have common
/// axes: in the first norm each is 1 long, in the second the root of its ratio, and all are at right
/// angles in both.
typedef struct ki_norms {
    int count;                                        // lobes, and axes
    double whole[KI_MOST_LOBES], away[KI_MOST_LOBES]; // of each lobe, squared; the mean's is 1
    double ratio[KI_MOST_LOBES];                      // of each axis
    double *along;                                    // [axis][lobe]: the axis as a mixture
    double *across; // [axis][lobe]: its scalar product with each lobe, in the first norm
} ki_norms;

/// `power` as for ki_palette_mix.
kiln_result ki_norms_create(kiln_context *context, const ki_palette *palette,
                            const kiln_spectrum *spectrum, const double (*power)[3],
                            ki_norms *norms, kiln_error *error);
void ki_norms_destroy(ki_norms *norms);

#endif
