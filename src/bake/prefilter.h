// The main recipe: every level of an environment from one analysis.
#ifndef KI_PREFILTER_H
#define KI_PREFILTER_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"
#include "tune/tune.h"

/// What a level leaves out by stopping at a degree, as part of the L2 norm for a lone bright point.
/// Bright points are kept out of the spectrum (spectrum.h), so the error of a real environment is a
/// small fraction of it.
extern const double ki_prefilter_tolerance;

/// Fills in the defaults and checks. `levels` receives the lobe of each level.
kiln_result ki_prefilter_resolve(const kiln_prefilter_def *def, kiln_prefilter_def *resolved,
                                 float roughness[KILN_MAX_LEVELS], kiln_lobe lobes[KILN_MAX_LEVELS],
                                 kiln_error *error);
/// Whether a lobe is a perfect mirror: such levels are resampled by area.
bool ki_is_mirror(const kiln_lobe *lobe);

/// A lobe's spectrum, up to a degree that its width suggests; the whole lobe's. Where KILN_MAX_DEGREE
/// does not suffice and `split` is true, the part of the lobe around its centre is left out.
kiln_result ki_lobe_spectrum(kiln_context *context, const kiln_lobe *lobe, double tolerance,
                             bool split, ki_zonal *zonal, ki_zonal_spectrum *spectrum,
                             kiln_error *error);

/// `source` (its shape and size are used) is what `panorama_size` rows of panorama will be made from,
/// or NULL where it is a panorama of these itself. `shown`, where levels are made for display, or NULL.
kiln_result ki_plan_create(kiln_context *context, int panorama_size, const kiln_map *source,
                           const kiln_prefilter_def *def, const ki_shown *shown, kiln_plan **plan,
                           kiln_error *error);
/// `panorama` has the plan's size; `source` as the plan was created with.
kiln_result ki_plan_execute(kiln_plan *plan, const kiln_map *panorama, const kiln_map *source,
                            kiln_map *map, kiln_error *error);
void ki_plan_destroy(kiln_plan *plan);

#endif
