// Evaluates closed forms of the reflection model's integrals in floats. The source code that
// fit_code.c writes has the same operations in the same order.
#include "table/fit.h"

#include <math.h>

static float clamp(float x, float low)
{
    return x > low ? x < 1 ? x : 1 : low;
}

// t = nov (1 + c) / (nov + c), with c about alpha: ki_grazing_scale without its lower bound. The
// albedo E changes fast for n.v below c; in t that range has the same width at every roughness.
static float axis_t(const kiln_fit_def *def, float nov, float roughness)
{
    float c = roughness * roughness;
    if (def->model.g == KILN_G_SCHLICK_TEXT) {
        float k = (roughness + 1) * (roughness + 1) * 0.125f;
        c = k / (1 - k);
    }
    float s = nov + c;
    return s > 0 ? nov * (1 + c) / s : 1;
}

// Returns the argument x in [-1, 1] of the polynomials P and Q of one part of a closed form. `axis`
// says which function of n.v and roughness x is.
static float axis_x(const kiln_fit_def *def, kiln_fit_axis axis, float nov, float roughness)
{
    switch (axis) {
    case KILN_FIT_AXIS_T:
        return 2 * axis_t(def, nov, roughness) - 1;
    case KILN_FIT_AXIS_SQRT_T:
        return 2 * sqrtf(axis_t(def, nov, roughness)) - 1;
    case KILN_FIT_AXIS_NOV:
        return 2 * nov - 1;
    case KILN_FIT_AXIS_SQRT_NOV:
        return 2 * sqrtf(nov) - 1;
    default:
        return 0;
    }
}

// Evaluates a polynomial of the part's shape, P or Q, by Horner's rule: in x for each power of y,
// then in y. c has a row of x_count coefficients for each power of y.
static float horner(const kiln_fit_part *part, const float *c, float x, float y)
{
    float value = 0;
    for (int j = part->y_count - 1; j >= 0; j--) {
        const float *row = c + (size_t)j * (size_t)part->x_count;
        float sum = row[part->x_count - 1];
        for (int i = part->x_count - 2; i >= 0; i--)
            sum = row[i] + x * sum;
        value = j == part->y_count - 1 ? sum : sum + y * value;
    }
    return value;
}

float ki_fit_evaluate_part(const kiln_fit_def *def, const kiln_fit_part *part, float nov,
                           float roughness)
{
    float low = (float)def->roughness_min;
    float r = clamp(roughness, low), x = axis_x(def, part->axis, clamp(nov, 0), r);
    float y = low > 0 ? (r - low) * (2 / (1 - low)) - 1 : 2 * r - 1;
    float value = horner(part, part->p, x, y);
    return part->rational ? value / horner(part, part->q, x, y) : value;
}

void kiln_fit_evaluate(const kiln_fit *fit, float nov, float roughness, float *values)
{
    values[0] = ki_fit_evaluate_part(&fit->def, &fit->part[0], nov, roughness);
    if (fit->part_count == 1)
        return;
    float g = 1 - clamp(nov, 0), g2 = g * g;
    values[1] =
        values[0] * (g2 * g2 * g) + ki_fit_evaluate_part(&fit->def, &fit->part[1], nov, roughness);
    values[0] -= values[1];
}
