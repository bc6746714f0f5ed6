// The levels of an environment: one analysis of a panorama, and every level from its spectrum.
#ifndef KI_PREFILTER_H
#define KI_PREFILTER_H

#include "image/resample.h"
#include "sphere/level.h"
#include "sphere/spectrum.h"
#include "sphere/zonal.h"
#include "tune/tune.h"

/// Fills in the defaults and checks. `levels` receives the lobe of each level.
kiln_result ki_prefilter_resolve(const kiln_prefilter_def *def, kiln_prefilter_def *resolved,
                                 float roughness[KILN_MAX_LEVELS], kiln_lobe lobes[KILN_MAX_LEVELS],
                                 kiln_error *error);
/// Whether a lobe is a perfect mirror: such levels are resampled by area.
bool ki_is_mirror(const kiln_lobe *lobe);

/// All that the levels of one size need, from panoramas of one size.
typedef struct ki_prefilter {
    kiln_context *context;
    kiln_prefilter_def def; // resolved
    int source_size;        // rows of the panorama
    float roughness[KILN_MAX_LEVELS];
    ki_analysis *analysis;
    ki_intake *intake;
    kiln_spectrum *spectrum; // of the last execution
    // Each level has a mirror, or a level, or is one of the tuned levels. A mirror may show the
    // source itself, of another shape than a panorama.
    ki_resample_plan *mirrors[KILN_MAX_LEVELS];
    bool direct[KILN_MAX_LEVELS];
    ki_level *levels[KILN_MAX_LEVELS];
    ki_tune *tune; // of the tuned levels, or NULL
} ki_prefilter;

/// `source` (its shape and size are used) is what `panorama_size` rows of panorama will be made from,
/// or NULL where the panorama itself is the source. `reading`, for tuned levels, or NULL.
kiln_result ki_prefilter_create(kiln_context *context, int panorama_size, const kiln_map *source,
                                const kiln_prefilter_def *def, const ki_reading *reading,
                                ki_prefilter **prefilter, kiln_error *error);
/// `panorama` has the prefilter's size; `source` is as it was created with. The spectrum stays in the
/// prefilter.
kiln_result ki_prefilter_execute(ki_prefilter *prefilter, const kiln_map *panorama,
                                 const kiln_map *source, kiln_map *map, kiln_error *error);
/// May be NULL.
void ki_prefilter_destroy(ki_prefilter *prefilter);

#endif
