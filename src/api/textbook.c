// The textbook's methods and the brute-force reference as the caller sees them.
#include "course/textbook.h"
#include "bake/reference.h"
#include "image/image.h"
#include "sphere/lobe.h"

#include <kiln/course.h>
#include <math.h>
#include <string.h>

static kiln_result check_panorama(const kiln_map *panorama, kiln_error *error)
{
    kiln_result result = ki_map_check(panorama, error);
    if (!result && panorama->shape != KILN_SHAPE_PANORAMA)
        result = ki_fail(error, KILN_ERROR_ARGUMENT,
                         "the source is a %s, it must be a panorama (kiln_map_convert makes one)",
                         panorama->shape == KILN_SHAPE_CUBE ? "cube" : "octahedron");
    return result;
}

// ---------------------------------------------------------------------------------------- textbook

enum { MAX_STEPS = 1 << 16, MAX_SAMPLES = 1 << 20, MAX_TABLE = 4096 };

static kiln_result check_count(const char *name, int count, int limit, kiln_error *error)
{
    if (count < 0 || count > limit)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s is %d, it must be 1 to %d, or 0", name,
                       count, limit);
    return KILN_OK;
}

// Fills the defaults in and makes the map that the result goes to.
static kiln_result start(kiln_context *context, const kiln_map *panorama,
                         const kiln_textbook_def *given, int level_count, kiln_textbook_def *def,
                         kiln_map *map, kiln_error *error)
{
    kiln_result result = check_panorama(panorama, error);
    *map = (kiln_map){0};
    *def = given ? *given : (kiln_textbook_def){0};
    if (!result)
        result = check_count("phi_count", def->phi_count, MAX_STEPS, error);
    if (!result)
        result = check_count("theta_count", def->theta_count, MAX_STEPS, error);
    if (!result)
        result = check_count("sample_count", def->sample_count, MAX_SAMPLES, error);
    if (result)
        return result;
    if (def->shape == KILN_SHAPE_AUTO)
        def->shape = KILN_SHAPE_PANORAMA;
    def->size = def->size ? def->size : 64;
    def->phi_count = def->phi_count ? def->phi_count : 100;
    def->theta_count = def->theta_count ? def->theta_count : 100;
    def->sample_count = def->sample_count ? def->sample_count : 1024;
    return kiln_map_create(context, def->shape, def->size, level_count, map, error);
}

kiln_result kiln_textbook_irradiance(kiln_context *context, const kiln_map *panorama,
                                     const kiln_textbook_def *def, kiln_map *map, kiln_error *error)
{
    kiln_textbook_def d;
    kiln_result result = start(context, panorama, def, 1, &d, map, error);
    if (!result)
        result = ki_textbook_irradiance(context, panorama, d.phi_count, d.theta_count, map, error);
    if (result)
        kiln_map_free(map);
    return result;
}

kiln_result kiln_textbook_prefilter(kiln_context *context, const kiln_map *panorama,
                                    const kiln_textbook_def *def, kiln_map *map, kiln_error *error)
{
    kiln_textbook_def d;
    kiln_result result = start(context, panorama, def, def ? def->level_count : 0, &d, map, error);
    if (!result)
        result = ki_textbook_prefilter(context, panorama, d.sample_count, map, error);
    if (result)
        kiln_map_free(map);
    return result;
}

kiln_result kiln_textbook_brdf(kiln_context *context, int size, int sample_count, kiln_image *table,
                               kiln_error *error)
{
    *table = (kiln_image){0};
    if (size < 2 || size > MAX_TABLE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "size of the table is %d, it must be 2 to %d",
                       size, MAX_TABLE);
    kiln_result result = check_count("sample_count", sample_count, MAX_SAMPLES, error);
    if (!result)
        result = kiln_image_create(context, size, size, 2, table, error);
    if (!result)
        result = ki_textbook_brdf(context, sample_count ? sample_count : 1024, table, error);
    if (result)
        kiln_image_free(table);
    return result;
}

// --------------------------------------------------------------------------------------- reference

static kiln_result check_directions(const double (*directions)[3], int count, kiln_error *error)
{
    for (int i = 0; i < count; i++) {
        const double *d = directions[i];
        double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(fabs(length - 1) < 1e-3))
            return ki_fail(error, KILN_ERROR_ARGUMENT,
                           "direction %d is (%g, %g, %g) of length %g, it must be 1 to 0.001", i,
                           d[0], d[1], d[2], length);
    }
    return KILN_OK;
}

kiln_result kiln_reference_filter(kiln_context *context, const kiln_map *panorama,
                                  const kiln_lobe *lobe, double rotation,
                                  const double (*directions)[3], int count, double (*values)[3],
                                  kiln_error *error)
{
    kiln_result result = KILN_OK;
    if (count < 0)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "count is %d, it must not be negative", count);
    if (!isfinite(rotation))
        result = ki_fail(error, KILN_ERROR_ARGUMENT, "rotation is %g, it must be finite", rotation);
    if (!result)
        result = check_panorama(panorama, error);
    if (!result)
        result = ki_lobe_check(lobe, error);
    if (!result)
        result = check_directions(directions, count, error);
    if (result) {
        if (count > 0)
            memset(values, 0, (size_t)count * sizeof *values);
        return result;
    }
    return ki_reference_filter(context, panorama, lobe, rotation, directions, count, values, error);
}
