// The levels of an environment: a panorama is analysed once, and every level is computed from its
// spectrum.
#ifndef KI_PREFILTER_H
#define KI_PREFILTER_H

#include "image/resample.h"
#include "sphere/level.h"
#include "sphere/spectrum.h"
#include "sphere/zonal.h"
#include "tune/tune.h"

/// Writes `def` with its default values filled in to *resolved and checks them. `lobes` receives
/// the lobe of each level, `roughness` its roughness.
kiln_result ki_prefilter_resolve(const kiln_prefilter_def *def, kiln_prefilter_def *resolved,
                                 float roughness[KILN_MAX_LEVELS], kiln_lobe lobes[KILN_MAX_LEVELS],
                                 kiln_error *error);
/// Returns whether a lobe is a perfect mirror. Mirror levels are resampled by area instead of
/// filtered.
bool ki_is_mirror(const kiln_lobe *lobe);

/// The plan of prefiltered levels: everything that depends only on their sizes and the panorama's
/// size. An execution changes nothing in the plan.
typedef struct ki_prefilter {
    kiln_prefilter_def def; // definition of the levels, with each default replaced by its value
    // The turn by rotation, pitch, roll and up of the definition. If the turn is not about +Y
    // alone, def.rotation is 0 afterwards.
    ki_tilt tilt;
    int source_size; // number of rows of the panorama that is analysed
    float roughness[KILN_MAX_LEVELS];
    ki_analysis *analysis;
    // Each level either is a mirror, resampled by `mirrors`, or is filtered by `levels`, or is
    // tuned by `tune`. `direct` says that a mirror level is resampled from the source itself, whose
    // shape need not be a panorama.
    ki_resample_plan *mirrors[KILN_MAX_LEVELS];
    bool direct[KILN_MAX_LEVELS];
    ki_level *levels[KILN_MAX_LEVELS];
    ki_tune *tune; // plan of the tuned levels, or NULL
} ki_prefilter;

/// The memory that executions of one prefilter use, one execution after the other. {0} is an empty
/// workspace.
typedef struct ki_prefilter_workspace {
    kiln_context *context; // context whose threads run the executions
    ki_analysis_workspace *analysis;
    kiln_spectrum *spectrum; // spectrum of the panorama in the last execution
    ki_level_workspace levels;
    ki_buffer resampling;
} ki_prefilter_workspace;

/// Prepares the levels that are filtered from panoramas of `panorama_size` rows. `source` has the
/// shape and size of the map that the panoramas are made from, or is NULL if the panorama itself is
/// the source. `reading` says how an engine reads the levels, for which they are tuned, or is NULL
/// for exact levels.
kiln_result ki_prefilter_create(kiln_context *context, int panorama_size, const kiln_map *source,
                                const kiln_prefilter_def *def, const ki_reading *reading,
                                ki_prefilter **prefilter, kiln_error *error);
/// Allocates the memory that executions of a prefilter work on, except for the suns and for tuned
/// levels.
kiln_result ki_prefilter_workspace_create(kiln_context *context, const ki_prefilter *prefilter,
                                          ki_prefilter_workspace *workspace, kiln_error *error);
void ki_prefilter_workspace_free(ki_prefilter_workspace *workspace);
/// Lets the analysis use the memory in which levels are interpolated afterwards.
/// ki_prefilter_execute does this itself; allocates nothing after the workspace was made.
kiln_result ki_prefilter_begin(const ki_prefilter *prefilter, ki_prefilter_workspace *workspace,
                               kiln_error *error);
/// Computes the levels of `map`. `panorama` and `source` have the sizes that the prefilter was made
/// for. The spectrum of the panorama stays in the workspace until the next execution. `rehearses`
/// is described at ki_tune_execute; exact levels ignore it.
kiln_result ki_prefilter_execute(const ki_prefilter *prefilter, ki_prefilter_workspace *workspace,
                                 const kiln_map *panorama, const kiln_map *source, bool rehearses,
                                 kiln_map *map, kiln_error *error);
/// Computes the levels of `map` as ki_prefilter_execute does, from the spectrum that is already in
/// the workspace. `panorama` and `source` may be NULL if the mirror levels are already in `map` and
/// no level needs the panorama.
kiln_result ki_prefilter_levels(const ki_prefilter *prefilter, ki_prefilter_workspace *workspace,
                                const kiln_map *panorama, const kiln_map *source, bool rehearses,
                                kiln_map *map, kiln_error *error);
/// Returns whether the levels can be computed while the rows of a panorama pass by: each mirror
/// level is resampled row by row, and no other level needs the panorama.
bool ki_prefilter_takes_rows(const ki_prefilter *prefilter);
/// Returns the greatest number of bytes that an execution allocates for `count` suns, bright texels
/// that are kept out of the spectrum.
size_t ki_prefilter_suns_size(const ki_prefilter *prefilter, size_t count);
/// Frees a prefilter. `prefilter` may be NULL.
void ki_prefilter_destroy(ki_prefilter *prefilter);

#endif
