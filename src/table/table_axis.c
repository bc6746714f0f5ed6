// Conversions between a table's arguments and its texel coordinates.
#include "table/table_axis.h"

#include "base/base.h"
#include "brdf/surface.h"
#include "math/math.h"

#include <math.h>

// One step of Newton's method improves the root of ki_pow, whose relative error is below 1e-14.
static double cube_root(double x)
{
    if (!(x > 0))
        return 0;
    double y = ki_pow(x, 1.0 / 3);
    return y - (y * y * y - x) / (3 * y * y);
}

double ki_axis_from_nov(const kiln_table_def *def, double roughness, double nov)
{
    switch (def->axis) {
    case KILN_AXIS_SQRT:
        return sqrt(nov);
    case KILN_AXIS_CBRT:
        return cube_root(nov);
    case KILN_AXIS_GRAZING: {
        double c = ki_grazing_scale(&def->model, roughness);
        return nov < 1 ? sqrt(nov * (1 + c) / (nov + c)) : 1;
    }
    default:
        return nov;
    }
}

double ki_texel_place(int index, int count, bool corners)
{
    return corners && count > 1 ? (double)index / (count - 1) : (index + 0.5) / count;
}

// Sets nov[i] to the n.v at the place u[i] in [0, 1] along an axis. c is ki_grazing_scale, which
// only KILN_AXIS_GRAZING reads.
static void to_nov(kiln_axis axis, double c, const double *u, int count, double *nov)
{
    switch (axis) {
    case KILN_AXIS_SQRT:
        for (int i = 0; i < count; i++)
            nov[i] = u[i] * u[i];
        break;
    case KILN_AXIS_CBRT:
        for (int i = 0; i < count; i++)
            nov[i] = u[i] * u[i] * u[i];
        break;
    case KILN_AXIS_GRAZING:
        // This form of n.v = c u^2 / (1 + c - u^2) is exactly 1 at u = 1.
        for (int i = 0; i < count; i++)
            nov[i] = u[i] * u[i] * c / (c + (1 - u[i] * u[i]));
        break;
    default:
        for (int i = 0; i < count; i++)
            nov[i] = u[i];
        break;
    }
}

double ki_axis_to_nov(const kiln_table_def *def, double roughness, double u)
{
    double nov;
    to_nov(def->axis, ki_grazing_scale(&def->model, roughness), &u, 1, &nov);
    return nov;
}

void ki_axis_columns(const kiln_table_def *def, double roughness, int from, int count, double *nov)
{
    for (int i = 0; i < count; i++)
        nov[i] = ki_texel_place(from + i, def->width, def->corners);
    to_nov(def->axis, ki_grazing_scale(&def->model, roughness), nov, count, nov);
}

ki_third ki_table_third(kiln_table_kind kind)
{
    switch (kind) {
    case KILN_TABLE_E_WALK:
        return KI_THIRD_F0;
    case KILN_TABLE_E_DIELECTRIC:
    case KILN_TABLE_GLASS:
        return KI_THIRD_IOR;
    default:
        return KI_THIRD_NONE;
    }
}

// For an ior, the place is w = 2 (ior - 1) / (ior + 1), which is twice the square root of F0.
double ki_third_to_w(ki_third third, double value)
{
    return third == KI_THIRD_IOR ? 2 * (value - 1) / (value + 1) : value;
}

double ki_third_from_w(ki_third third, double w)
{
    return third == KI_THIRD_IOR ? (2 + w) / (2 - w) : w;
}

double ki_texel_index(double place, int count, bool corners)
{
    return ki_clamp(corners ? place * (count - 1) : place * count - 0.5, 0, count - 1);
}
