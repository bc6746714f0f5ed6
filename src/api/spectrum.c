// Spectra and what is read off them.
#include "sphere/spectrum.h"

#include "bake/prefilter.h"
#include "image/image.h"
#include "math/math.h"
#include "sphere/grid.h"
#include "sphere/level.h"
#include "sphere/lobe.h"
#include "sphere/sh.h"

#include <math.h>
#include <string.h>

struct kiln_stream {
    kiln_context *context;
    ki_analysis *analysis;
    ki_intake *intake;
};

void kiln_stream_cancel(kiln_stream *stream)
{
    if (!stream)
        return;
    ki_intake_destroy(stream->intake);
    ki_analysis_destroy(stream->analysis);
    ki_free(stream);
}

kiln_result kiln_stream_begin(kiln_context *context, int size, int degree, kiln_stream **stream,
                              kiln_error *error)
{
    *stream = NULL;
    if (size < 1 || size > KILN_MAX_SIZE / 2)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "size is %d rows, it must be 1 to %d", size,
                       KILN_MAX_SIZE / 2);
    if (degree < 0 || degree > KILN_MAX_DEGREE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "degree is %d, it must be 0 to %d", degree,
                       KILN_MAX_DEGREE);
    if (degree == 0)
        degree = ki_min(2 * size, KILN_MAX_DEGREE);
    degree = ki_max(degree, 8);
    double *density = ki_alloc(context, (size_t)degree + 1, sizeof *density);
    kiln_stream *s = ki_alloc(context, 1, sizeof *s);
    if (!density || !s) {
        ki_free(density);
        ki_free(s);
        return ki_fail_memory(context, error, "a stream", sizeof *s);
    }
    s->context = context;
    ki_model_density(degree, density);
    kiln_result result = ki_analysis_create(context, size, degree, density, &s->analysis, error);
    if (result == KILN_OK)
        result = ki_intake_create(s->analysis, false, &s->intake, error);
    ki_free(density);
    if (result == KILN_OK)
        *stream = s;
    else
        kiln_stream_cancel(s);
    return result;
}

kiln_result kiln_stream_rows(kiln_stream *stream, const float *rows, int row_count,
                             kiln_error *error)
{
    return ki_intake_rows(stream->intake, rows, row_count, error);
}

kiln_result kiln_stream_finish(kiln_stream *stream, kiln_spectrum **spectrum, kiln_error *error)
{
    kiln_result result = ki_spectrum_create(stream->analysis, spectrum, error);
    if (result == KILN_OK)
        result = ki_intake_finish(stream->intake, *spectrum, error);
    if (result != KILN_OK) {
        kiln_spectrum_destroy(*spectrum);
        *spectrum = NULL;
    }
    kiln_stream_cancel(stream);
    return result;
}

kiln_result kiln_spectrum_analyze(kiln_context *context, const kiln_map *map, int degree,
                                  kiln_spectrum **spectrum, kiln_error *error)
{
    *spectrum = NULL;
    kiln_map converted = {0};
    kiln_stream *stream = NULL;
    kiln_result result = ki_map_check(map, error);
    if (result == KILN_OK && map->shape != KILN_SHAPE_PANORAMA) {
        result = kiln_map_convert(context, map, KILN_SHAPE_PANORAMA,
                                  ki_min(2 * map->size, KILN_MAX_SIZE / 2), 0, &converted, error);
        map = &converted;
    }
    if (result == KILN_OK)
        result = kiln_stream_begin(context, map->size, degree, &stream, error);
    if (result == KILN_OK)
        result = kiln_stream_rows(stream, map->level[0], map->size, error);
    if (result == KILN_OK)
        result = kiln_stream_finish(stream, spectrum, error);
    else
        kiln_stream_cancel(stream);
    kiln_map_free(&converted);
    return result;
}

int kiln_spectrum_degree(const kiln_spectrum *spectrum)
{
    return spectrum->degree;
}

kiln_result kiln_spectrum_filter(kiln_context *context, const kiln_spectrum *spectrum,
                                 const kiln_lobe *lobe, double rotation, kiln_map *map, int level,
                                 kiln_error *error)
{
    kiln_result result = ki_map_check(map, error);
    if (result != KILN_OK || (result = ki_lobe_check(lobe, error)) != KILN_OK)
        return result;
    if (level < 0 || level >= map->level_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "level is %d, the map has %d", level,
                       map->level_count);
    if (!(fabs(rotation) <= 1e6))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "rotation is %g degrees, it must be within 1e6",
                       rotation);
    ki_zonal zonal;
    ki_zonal_spectrum zonal_spectrum;
    ki_legendre legendre = {0};
    ki_level *plan = NULL;
    result = ki_lobe_spectrum(context, lobe, ki_prefilter_tolerance, false, &zonal, &zonal_spectrum,
                              error);
    if (result != KILN_OK)
        return result;
    double rest = zonal_spectrum.rest;
    if (zonal_spectrum.degree > spectrum->degree || rest > 10 * ki_prefilter_tolerance) {
        result = ki_fail(error, KILN_ERROR_ARGUMENT,
                         "the lobe needs a spectrum of degree %s%d, this one has %d",
                         rest > 10 * ki_prefilter_tolerance ? "above " : "", zonal_spectrum.degree,
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
                             kiln_map_level_size(map, level), &plan, error);
    if (result == KILN_OK)
        result = ki_level_execute(plan, spectrum, NULL, rotation, map, level, NULL, error);
    ki_level_destroy(plan);
    ki_legendre_destroy(&legendre);
    return result;
}

kiln_result kiln_spectrum_sh(const kiln_spectrum *spectrum, int bands, bool irradiance,
                             double window, double rotation, kiln_sh *sh, kiln_error *error)
{
    *sh = (kiln_sh){0};
    kiln_sh radiance = {0};
    kiln_result result = ki_sh_check_bands(bands, window, rotation, error);
    if (result == KILN_OK)
        result = ki_sh_project(spectrum, bands, rotation, &radiance, error);
    if (result == KILN_OK)
        result = kiln_sh_filter(&radiance, bands, irradiance, window, sh, error);
    return result;
}

void kiln_sh_evaluate(const kiln_sh *sh, const double direction[3], double value[3])
{
    ki_sh_evaluate(sh, direction, value);
}
