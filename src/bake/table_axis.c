#include "bake/table_axis.h"

#include "base/base.h"
#include "brdf/brdf.h"
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

double ki_axis_scale(const kiln_model *model, double roughness)
{
    double r = roughness > KI_GRAZING_MIN ? roughness : KI_GRAZING_MIN;
    if (model->g == KILN_G_SCHLICK_TEXT) {
        double k = ki_schlick_k_direct(r);
        return k / (1 - k);
    }
    return r * r;
}

double ki_axis_from_nov(const kiln_table_def *def, double roughness, double nov)
{
    switch (def->axis) {
    case KILN_AXIS_SQRT:
        return sqrt(nov);
    case KILN_AXIS_CBRT:
        return cube_root(nov);
    case KILN_AXIS_GRAZING: {
        double c = ki_axis_scale(&def->model, roughness);
        return nov < 1 ? sqrt(nov * (1 + c) / (nov + c)) : 1;
    }
    default:
        return nov;
    }
}

double ki_axis_to_nov(const kiln_table_def *def, double roughness, double u)
{
    switch (def->axis) {
    case KILN_AXIS_SQRT:
        return u * u;
    case KILN_AXIS_CBRT:
        return u * u * u;
    case KILN_AXIS_GRAZING: {
        double c = ki_axis_scale(&def->model, roughness), t = u * u;
        return u < 1 ? t * c / (c + (1 - t)) : 1;
    }
    default:
        return u;
    }
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
