// The levels of an environment: a panorama is analysed once, and every level is computed from its
// spectrum.
#ifndef KI_PREFILTER_H
#define KI_PREFILTER_H

#include "image/resample.h"
#include "sphere/level.h"
#include "sphere/spectrum.h"
#include "sphere/zonal.h"
#include "tune/tune.h"

/// Fills in the defaults of a definition and checks its values. `lobes` receives the lobe of each
/// level, `roughness` its roughness.
kiln_result ki_prefilter_resolve(const kiln_prefilter_def *def, kiln_prefilter_def *resolved,
                                 float roughness[KILN_MAX_LEVELS], kiln_lobe lobes[KILN_MAX_LEVELS],
                                 kiln_error *error);
/// Returns whether a lobe is a perfect mirror. Mirror levels are resampled by area instead of
/// filtered.
bool ki_is_mirror(const kiln_lobe *lobe);

/// Everything that the levels need and that depends only on their sizes and the panorama's size. An
/// execution changes nothing in the prefilter.
typedef struct ki_prefilter {
    kiln_prefilter_def def; // definition with each default replaced by its value
    int source_size;        // number of rows of the panorama
    float roughness[KILN_MAX_LEVELS];
    ki_analysis *analysis;
    // Each level either is a mirror (`mirrors`), is filtered (`levels`) or is tuned (`tune`).
    // `direct` says that a mirror is resampled from the source itself, whose shape need not be a
    // panorama.
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

/// Prepares levels from panoramas of `panorama_size` rows. `source` has the shape and size of the
/// map that the panoramas are made from, or is NULL if the panorama itself is the source. `reading`
/// says how an engine reads tuned levels, or is NULL for exact levels.
kiln_result ki_prefilter_create(kiln_context *context, int panorama_size, const kiln_map *source,
                                const kiln_prefilter_def *def, const ki_reading *reading,
                                ki_prefilter **prefilter, kiln_error *error);
/// Allocates everything that executions need, except for the suns and tuned levels.
kiln_result ki_prefilter_workspace_create(kiln_context *context, const ki_prefilter *prefilter,
                                          ki_prefilter_workspace *workspace, kiln_error *error);
void ki_prefilter_workspace_free(ki_prefilter_workspace *workspace);
/// Computes the levels. `panorama` has the size that the prefilter was made for, `source` the shape
/// and size. The spectrum stays in the workspace until the next execution. `rehearses` is described
/// at ki_tune_execute; exact levels ignore it.
kiln_result ki_prefilter_execute(const ki_prefilter *prefilter, ki_prefilter_workspace *workspace,
                                 const kiln_map *panorama, const kiln_map *source, bool rehearses,
                                 kiln_map *map, kiln_error *error);
/// Returns the greatest number of bytes that an execution takes for `count` suns.
size_t ki_prefilter_suns_size(const ki_prefilter *prefilter, size_t count);
/// Frees a prefilter. `prefilter` may be NULL.
void ki_prefilter_destroy(ki_prefilter *prefilter);

#endif
