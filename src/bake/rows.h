// A bake while the rows of a panorama pass by: each row is read, analysed, resampled to the mirror
// levels and forgotten.
#ifndef KI_ROWS_H
#define KI_ROWS_H

#include "image/resample.h"
#include "sphere/spectrum.h"

/// An analysis of the rows that pass by, with its workspace (made for whole panoramas) and its
/// spectrum.
typedef struct ki_row_analysis {
    const ki_analysis *analysis;
    ki_analysis_workspace *workspace;
    kiln_spectrum *spectrum;
} ki_row_analysis;

/// A mirror level that is resampled from the rows that pass by. `plan` satisfies
/// ki_resample_has_bands.
typedef struct ki_row_mirror {
    const ki_resample_plan *plan;
    float *target;
    ki_buffer buffer; ///< reserved for the plan
} ki_row_mirror;

/// What becomes of the rows. `mirror` and `exposure` change each row before it is used.
typedef struct ki_row_work {
    bool mirror;
    double exposure; ///< exposure in stops: rows are multiplied by 2^exposure
    ki_row_analysis analysis[2];
    int analysis_count;
    ki_row_mirror mirrors[KILN_MAX_LEVELS];
    int mirror_count;
} ki_row_work;

/// Reads all rows of a panorama, the rows around suns twice, and does the work: writes the spectra
/// and the mirror levels with the same bits as from the whole panorama.
kiln_result ki_rows_pass(kiln_context *context, const kiln_rows *rows, const ki_row_work *work,
                         kiln_error *error);

#endif
