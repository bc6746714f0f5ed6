// Analyses of a panorama to a low degree, for irradiance and harmonics, which need no more.
#ifndef KI_LOW_ANALYSIS_H
#define KI_LOW_ANALYSIS_H

#include "sphere/spectrum.h"

enum {
    /// Degree for irradiance. The cosine lobe is cut off at degree 303, where its terms are below
    /// 1e-7 of the sum.
    KI_IRRADIANCE_DEGREE = 320,
    /// Smallest degree of an analysis; the harmonics need degree KILN_MAX_BANDS - 1.
    KI_SH_DEGREE = 8,
};

/// What executions of a low analysis work on, and the spectrum of the last execution.
typedef struct ki_low_workspace {
    ki_analysis_workspace *analysis;
    kiln_spectrum *spectrum;
} ki_low_workspace;

/// Creates an analysis of panoramas of `size` rows to a degree up to KI_IRRADIANCE_DEGREE, and its
/// workspace. The caller frees the two, also on failure.
kiln_result ki_low_create(kiln_context *context, int size, int degree, ki_analysis **analysis,
                          ki_low_workspace *w, kiln_error *error);
void ki_low_free(ki_low_workspace *w);
/// Returns the number of rows of the panorama for a source. A cube of n texels gets 2 n rows, since
/// half a turn crosses two faces.
int ki_panorama_rows(kiln_shape shape, int size);

#endif
