// kiln_reference_filter: checks the caller's arguments and computes the reference values.
#include "bake/reference.h"

#include "image/image.h"
#include "sphere/lobe.h"

#include <math.h>
#include <string.h>

static kiln_result check_directions(const double (*directions)[3], int count, kiln_error *error)
{
    for (int i = 0; i < count; i++) {
        const double *d = directions[i];
        double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(fabs(length - 1) < 1e-3))
            return ki_fail(
                error, KILN_ERROR_ARGUMENT,
                "direction %d is (%g, %g, %g) of length %g, its length must be within 0.001 of 1",
                i, d[0], d[1], d[2], length);
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
        result = ki_map_check_panorama(panorama, error);
    if (!result)
        result = ki_lobe_check(lobe, error);
    if (!result)
        result = check_directions(directions, count, error);
    if (result) {
        if (count > 0)
            memset(values, 0, (size_t)count * sizeof *values);
        return result;
    }
    return ki_reference_integrate(context, panorama, lobe, rotation, directions, count, NULL,
                                  values, error);
}
