// Compensation of lost energy. The specular lobe models one bounce at a microfacet and so loses the
// light of all further bounces. The functions here return the lost light.
// docs/theory/compensation.md compares the functions.
#include "brdf/brdf.h"

#include "brdf/arguments.h"
#include "math/math.h"

double ki_kulla_conty(double e_o, double e_i, double e_average)
{
    double missing = 1 - e_average;
    return missing > 0 ? (1 - e_o) * (1 - e_i) / (KI_PI * missing) : 0;
}

// The factor follows from a geometric series in which E is e_average. A bounce reflects the share f
// of the light that reaches it; of that light, the share E leaves and 1 - E meets a microfacet
// again. All bounces together return
//
//     sum = f E + f E f (1 - E) + f E f^2 (1 - E)^2 + ... = f E / (1 - f (1 - E)).
//
// The bounces from the second on return f (1 - E) sum. The lobe ki_kulla_conty already carries the
// factor 1 - E, so that its colour is f sum. KILN_F_ADD_ASSIGNMENT uses `sum`, which counts the
// first bounce too.
double ki_kulla_conty_fresnel(kiln_f_add form, double f, double e_average)
{
    double rest = (1 - f) + f * e_average; // 1 - f (1 - E) without cancellation near f = 1
    if (!(rest > 0)) // f = 1 and E = 0: no light is absorbed, and the limit of the factor is 1
        return 1;
    double sum = f * e_average / rest;
    return form == KILN_F_ADD_ASSIGNMENT ? sum : f * sum;
}

double ki_turquin(double f0, double e)
{
    return 1 + f0 * (1 - e) / e;
}

// The single bounce has the albedo s = f0 a + b, the lobe for F = 1 loses m = 1 - a - b, and f = (1
// + 20 f0) / 21 is the average of Schlick's F. The further bounces add s f m / (1 - f m), taken as
// diffuse light. Fdez-Aguera 2019, section 3.
void ki_fdez_aguera(double f0, double a, double b, double *single, double *multiple)
{
    // rest is 1 - f m, written as a sum that does not cancel
    double f = (1 + 20 * f0) / 21, e = a + b, rest = (1 - f) + f * e;
    *single = f0 * a + b;
    *multiple = rest > 0 ? *single * f * (1 - e) / rest : 1;
}

double kiln_kulla_conty(double e_o, double e_i, double e_average)
{
    return ki_kulla_conty(ki_unit(e_o), ki_unit(e_i), ki_unit(e_average));
}

double kiln_kulla_conty_fresnel(kiln_f_add form, double f_average, double e_average)
{
    return ki_kulla_conty_fresnel(form, ki_unit(f_average), ki_unit(e_average));
}

double kiln_turquin(double f0, double e)
{
    // Every lobe that reflects light has an albedo above 1e-6, and this bound keeps the factor
    // finite.
    return ki_turquin(ki_unit(f0), ki_clamp(e, 1e-6, 1));
}

void kiln_fdez_aguera(double f0, double a, double b, double *single, double *multiple)
{
    double a1 = ki_unit(a), b1 = ki_unit(b);
    ki_fdez_aguera(ki_unit(f0), a1, b1 < 1 - a1 ? b1 : 1 - a1, single, multiple);
}

double kiln_compensate_walk(double e_single, double added)
{
    return 1 + ki_unit(added) / ki_clamp(e_single, 1e-6, 1);
}
