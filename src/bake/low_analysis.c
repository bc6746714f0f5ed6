// Analyses of a panorama to a low degree. In: a map of any shape. Out: the first bands of its
// spherical harmonics, or the plan of an analysis that a bake executes for irradiance and
// harmonics.
#include "bake/low_analysis.h"

#include "image/image.h"
#include "sphere/sh.h"

void ki_low_free(ki_low_workspace *w)
{
    kiln_spectrum_destroy(w->spectrum);
    ki_analysis_workspace_destroy(w->analysis);
    *w = (ki_low_workspace){0};
}

kiln_result ki_low_create(kiln_context *context, int size, int degree, ki_analysis **analysis,
                          ki_low_workspace *w, kiln_error *error)
{
    kiln_result result = ki_analysis_create(context, size, degree, analysis, error);
    if (result == KILN_OK)
        result = ki_analysis_workspace_create(context, *analysis, KI_ANALYSIS_WHOLE, &w->analysis,
                                              error);
    if (result == KILN_OK)
        result = ki_spectrum_create(context, *analysis, &w->spectrum, error);
    return result;
}

int ki_panorama_rows(kiln_shape shape, int size)
{
    return shape == KILN_SHAPE_PANORAMA ? size : ki_min(2 * size, KILN_MAX_SIZE / 2);
}

kiln_result kiln_map_sh(kiln_context *context, const kiln_map *map, int bands, double rotation,
                        kiln_sh *sh, kiln_error *error)
{
    *sh = (kiln_sh){0};
    kiln_map converted = {0};
    ki_analysis *analysis = NULL;
    ki_low_workspace low = {0};
    kiln_result result = ki_map_check(map, error);
    if (result == KILN_OK)
        result = ki_sh_check_bands(bands, 0, rotation, error);
    if (result == KILN_OK && map->shape != KILN_SHAPE_PANORAMA) {
        result = kiln_map_convert(context, map, KILN_SHAPE_PANORAMA,
                                  ki_panorama_rows(map->shape, map->size), 0, &converted, error);
        map = &converted;
    }
    if (result == KILN_OK)
        result = ki_low_create(context, map->size, KI_SH_DEGREE, &analysis, &low, error);
    if (result == KILN_OK &&
        !ki_analysis_execute(analysis, low.analysis, map->level[0], low.spectrum))
        result = ki_fail_cancelled(error, "analysing");
    if (result == KILN_OK)
        result = ki_sh_project(low.spectrum, bands, NULL, rotation, sh, error);
    ki_low_free(&low);
    ki_analysis_destroy(analysis);
    kiln_map_free(&converted);
    return result;
}
