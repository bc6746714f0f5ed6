// kiln_spectrum_filter: computes one level of a map from a spectrum and a lobe.
#include "image/light.h"
#include "sphere/level.h"
#include "sphere/lobe.h"

#include <math.h>

kiln_result kiln_spectrum_filter(kiln_context *context, const kiln_spectrum *spectrum,
                                 const kiln_lobe *lobe, double rotation, kiln_map *map, int level,
                                 kiln_error *error)
{
    kiln_result result = ki_map_check(map, error);
    if (result != KILN_OK || (result = ki_lobe_check(lobe, error)) != KILN_OK)
        return result;
    if (level < 0 || level >= map->level_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "level is %d, it must be less than the map's level count of %d", level,
                       map->level_count);
    if (!(fabs(rotation) <= 1e6))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "rotation is %g degrees, it must be from -1e6 to 1e6", rotation);
    ki_zonal zonal;
    ki_zonal_spectrum zonal_spectrum;
    ki_legendre legendre = {0};
    ki_level *plan = NULL;
    ki_level_workspace workspace = {0};
    result =
        ki_lobe_spectrum(context, lobe, ki_lobe_tolerance, false, &zonal, &zonal_spectrum, error);
    if (result != KILN_OK)
        return result;
    double truncation = zonal_spectrum.truncation;
    if (zonal_spectrum.degree > spectrum->degree || truncation > 10 * ki_lobe_tolerance) {
        result = ki_fail(error, KILN_ERROR_ARGUMENT,
                         "the lobe needs a spectrum of degree %s%d, but the spectrum has degree %d",
                         truncation > 10 * ki_lobe_tolerance ? "above " : "", zonal_spectrum.degree,
                         spectrum->degree);
        ki_zonal_free(&zonal_spectrum);
        return result;
    }
    if (!ki_legendre_create(context, ki_max(zonal_spectrum.degree, 8), &legendre)) {
        ki_zonal_free(&zonal_spectrum);
        return ki_fail_memory(context, error, "a level's plan",
                              ki_coefficient_count(spectrum->degree) * sizeof(double));
    }
    result = ki_level_create(context, &legendre, &zonal, &zonal_spectrum, map->shape,
                             kiln_map_level_size(map, level), NULL, &plan, error);
    if (result == KILN_OK)
        result = ki_level_reserve(context, plan, &workspace, error);
    if (result == KILN_OK)
        result =
            ki_level_execute(plan, &workspace, spectrum, NULL, rotation, map, level, NULL, error);
    ki_level_workspace_free(&workspace);
    kiln_cut unused;
    if (result == KILN_OK)
        ki_cut_negative(context, map, level, 1, &unused);
    ki_level_destroy(plan);
    ki_legendre_destroy(&legendre);
    return result;
}
