#include "sphere/lobe.h"

#include "math/math.h"
#include "sphere/lobe.inl"

#include <math.h>

kiln_lobe kiln_lobe_ggx(double alpha)
{
    return (kiln_lobe){.kind = KILN_LOBE_GGX, .parameter = alpha};
}

kiln_lobe kiln_lobe_lambert(void)
{
    return (kiln_lobe){.kind = KILN_LOBE_LAMBERT};
}

kiln_lobe kiln_lobe_charlie(double alpha)
{
    return (kiln_lobe){.kind = KILN_LOBE_CHARLIE, .parameter = alpha};
}

kiln_lobe kiln_lobe_phong(double exponent)
{
    return (kiln_lobe){.kind = KILN_LOBE_PHONG, .parameter = exponent};
}

kiln_lobe kiln_lobe_custom(double (*evaluate)(void *user, double cos_theta), void *user,
                           double width)
{
    return (kiln_lobe){
        .kind = KILN_LOBE_CUSTOM, .parameter = width, .evaluate = evaluate, .user = user};
}

double kiln_lobe_evaluate(const kiln_lobe *lobe, double cos_theta)
{
    return ki_lobe_evaluate(lobe, cos_theta);
}

double ki_lobe_evaluate(const kiln_lobe *lobe, double cos_theta)
{
    return ki_lobe_weight(lobe, 1 - cos_theta);
}

double ki_lobe_weight(const kiln_lobe *lobe, double one_minus_cos)
{
    double c = 1 - one_minus_cos;
    switch (lobe->kind) {
    case KILN_LOBE_GGX: {
        if (!(c > 0))
            return 0;
        // The weight is D(h) cos theta with normal, view and reflection alike, N = V = R, and c =
        // cos theta. The half vector h of N and the light has cos^2 theta_h = (1 + c) / 2. D(h) is
        // divided by its value at c = 1, so that the weight stays in the range of doubles for tiny
        // alphas.
        double a2 = lobe->parameter * lobe->parameter;
        double d = a2 + (1 - a2) * (0.5 * one_minus_cos);
        return d > 0 ? c * (a2 / d) * (a2 / d) : 1;
    }
    case KILN_LOBE_LAMBERT:
        return c > 0 ? c : 0;
    case KILN_LOBE_CHARLIE:
        return c > 0 ? charlie_weight(0.5 / lobe->parameter, one_minus_cos) : 0;
    case KILN_LOBE_PHONG:
        return c > 0 ? phong_weight(lobe->parameter, one_minus_cos) : 0;
    case KILN_LOBE_CUSTOM:
        return lobe->evaluate(lobe->user, c < -1 ? -1 : c > 1 ? 1 : c);
    }
    return 0;
}

kiln_result ki_lobe_check(const kiln_lobe *lobe, kiln_error *error)
{
    double low = 0, high = 0;
    const char *name = "";
    switch (lobe->kind) {
    case KILN_LOBE_GGX:
        name = "alpha of the GGX lobe";
        low = 0;
        high = 1;
        break;
    case KILN_LOBE_LAMBERT:
        return KILN_OK;
    case KILN_LOBE_CHARLIE:
        name = "alpha of the Charlie lobe";
        low = 0.01;
        high = 1;
        break;
    case KILN_LOBE_PHONG:
        name = "exponent of the Phong lobe";
        low = 1;
        high = 100000;
        break;
    case KILN_LOBE_CUSTOM:
        if (!lobe->evaluate)
            return ki_fail(error, KILN_ERROR_ARGUMENT, "a custom lobe needs a function");
        name = "width of the custom lobe";
        low = 1e-4;
        high = KI_PI + 1e-9;
        break;
    default:
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the lobe's kind is %d, which kiln does not know", (int)lobe->kind);
    }
    if (!(lobe->parameter >= low && lobe->parameter <= high))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s is %g, it must be %g to %g", name,
                       lobe->parameter, low, high);
    return KILN_OK;
}

double ki_lobe_width(const kiln_lobe *lobe)
{
    switch (lobe->kind) {
    case KILN_LOBE_GGX:
        return ki_clamp(2 * lobe->parameter, 1e-9, 1);
    case KILN_LOBE_CHARLIE:
        // From the horizon towards its axis, the Charlie lobe falls like (1 - c)^(1 / (2 alpha)),
        // where c is the cosine of the angle to the axis and alpha the lobe's parameter.
        return ki_clamp(2 * lobe->parameter, 0.02, 1);
    case KILN_LOBE_PHONG:
        return ki_clamp(1 / sqrt(lobe->parameter), 1e-3, 1);
    case KILN_LOBE_CUSTOM:
        return lobe->parameter;
    case KILN_LOBE_LAMBERT:
        break;
    }
    return 1;
}
