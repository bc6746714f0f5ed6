// The daylight sky as the caller sees it.
#include "bake/sky.h"

#include <math.h>

static kiln_result check_range(const char *name, double value, double low, double high,
                               kiln_error *error)
{
    if (!(value >= low && value <= high))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s of the sky is %g, it must be %g to %g", name,
                       value, low, high);
    return KILN_OK;
}

// An option whose 0 stands for a default and whose KILN_ZERO for 0.
static double or_default(double value, double standard)
{
    if (value == KILN_ZERO)
        return 0;
    return value != 0 ? value : standard;
}

kiln_result kiln_sky(kiln_context *context, const kiln_sky_def *def, kiln_map *map,
                     kiln_error *error)
{
    kiln_sky_def d = def ? *def : (kiln_sky_def){0};
    *map = (kiln_map){0};
    d.size = d.size ? d.size : 512;
    d.elevation = or_default(d.elevation, 30);
    d.turbidity = d.turbidity != 0 ? d.turbidity : 3;
    d.albedo = or_default(d.albedo, 0.2);
    kiln_result result = check_range("size", d.size, 16, 8192, error);
    if (!result)
        result = check_range("elevation", d.elevation, -5, 90, error);
    if (!result)
        result = check_range("turbidity", d.turbidity, 1.7, 10, error);
    if (!result)
        result = check_range("albedo", d.albedo, 0, 1, error);
    if (!result && !isfinite(d.azimuth))
        result = ki_fail(error, KILN_ERROR_ARGUMENT, "azimuth of the sky is %g, it must be finite",
                         d.azimuth);
    if (!result)
        result = kiln_map_create(context, KILN_SHAPE_PANORAMA, d.size, 1, map, error);
    if (result)
        return result;

    ki_sky sky;
    ki_sky_prepare(&sky, d.elevation, d.azimuth, d.turbidity, d.albedo);
    result = ki_sky_paint(context, &sky, map, error);
    if (result)
        kiln_map_free(map);
    return result;
}
