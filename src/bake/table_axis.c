#include "bake/table_axis.h"

#include "base/base.h"
#include "math/math.h"

#include <math.h>

// Newton's method from a power within 1e-14.
static double cube_root(double x)
{
    if (!(x > 0))
        return 0;
    double y = ki_pow(x, 1.0 / 3);
    return y - (y * y * y - x) / (3 * y * y);
}

double ki_axis_from_nov(kiln_axis axis, double nov)
{
    return axis == KILN_AXIS_LINEAR ? nov : axis == KILN_AXIS_SQRT ? sqrt(nov) : cube_root(nov);
}

double ki_axis_to_nov(kiln_axis axis, double u)
{
    return axis == KILN_AXIS_LINEAR ? u : axis == KILN_AXIS_SQRT ? u * u : u * u * u;
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

// w = 2 (ior - 1) / (ior + 1), twice the root of F0.
double ki_third_to_w(ki_third third, double value)
{
    return third == KI_THIRD_IOR ? 2 * (value - 1) / (value + 1) : value;
}

double ki_third_from_w(ki_third third, double w)
{
    return third == KI_THIRD_IOR ? (2 + w) / (2 - w) : w;
}

double ki_texel_place(int index, int count, bool corners)
{
    return corners && count > 1 ? (double)index / (count - 1) : (index + 0.5) / count;
}

double ki_texel_index(double place, int count, bool corners)
{
    return ki_clamp(corners ? place * (count - 1) : place * count - 0.5, 0, count - 1);
}
