// The public functions that compute a spectrum, from a map or from the rows of a panorama one after
// the other.
#include "sphere/spectrum.h"

#include "image/image.h"
#include "math/math.h"

struct kiln_stream {
    kiln_context *context;
    ki_analysis *analysis;
    ki_analysis_workspace *workspace;
};

void kiln_stream_cancel(kiln_stream *stream)
{
    if (!stream)
        return;
    ki_analysis_workspace_destroy(stream->workspace);
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
    kiln_stream *s = ki_alloc(context, 1, sizeof *s);
    if (!s)
        return ki_fail_memory(context, error, "a stream", sizeof *s);
    s->context = context;
    kiln_result result = ki_analysis_create(context, size, degree, &s->analysis, error);
    if (result == KILN_OK)
        result = ki_analysis_workspace_create(context, s->analysis, KI_ANALYSIS_ROWS, &s->workspace,
                                              error);
    if (result == KILN_OK)
        *stream = s;
    else
        kiln_stream_cancel(s);
    return result;
}

kiln_result kiln_stream_rows(kiln_stream *stream, const float *rows, int row_count,
                             kiln_error *error)
{
    return ki_analysis_add_rows(stream->analysis, stream->workspace, rows, row_count, error);
}

kiln_result kiln_stream_finish(kiln_stream *stream, kiln_spectrum **spectrum, kiln_error *error)
{
    kiln_result result = ki_spectrum_create(stream->context, stream->analysis, spectrum, error);
    if (result == KILN_OK)
        result = ki_analysis_finish(stream->analysis, stream->workspace, *spectrum, error);
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
