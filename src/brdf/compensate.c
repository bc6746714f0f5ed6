// Compensation of lost energy. The specular lobe models one bounce at a microfacet and so loses the
// light of all further bounces. The functions here return the lost light.
// docs/theory/compensation.md compares the functions.
#include "brdf/brdf.h"

#include "brdf/arguments.h"
#include "math/math.h"

double kiln_kulla_conty(double e_o, double e_i, double e_average)
{
    double missing = 1 - ki_unit(e_average);
    return missing > 0 ? (1 - ki_unit(e_o)) * (1 - ki_unit(e_i)) / (KI_PI * missing) : 0;
}

// The factor follows from a geometric series in which E is e_average. A bounce reflects the share f
// of the light that reaches it; of that light, the share E leaves and 1 - E meets a microfacet
// again. All bounces together return
//
//     sum = f E + f E f (1 - E) + f E f^2 (1 - E)^2 + ... = f E / (1 - f (1 - E)).
//
// The bounces from the second on return f (1 - E) sum. The lobe kiln_kulla_conty already carries
// the factor 1 - E, so that its colour is f sum. KILN_F_ADD_ASSIGNMENT uses `sum`, which counts the
// first bounce too.
double kiln_kulla_conty_fresnel(kiln_f_add form, double f_average, double e_average)
{
    double f = ki_unit(f_average), e = ki_unit(e_average);
    double divisor = (1 - f) + f * e; // 1 - f (1 - E), as a sum that does not cancel near f = 1
    // f = 1 and E = 0: no bounce absorbs light or lets it leave, and the limit of the factor is 1
    if (!(divisor > 0))
        return 1;
    double sum = f * e / divisor;
    return form == KILN_F_ADD_ASSIGNMENT ? sum : f * sum;
}

double kiln_turquin(double f0, double e)
{
    // The bound of 1e-6 on the albedo keeps Turquin's factor 1 + f0 (1 - e) / e finite. The albedo
    // of every lobe that reflects light is above that bound.
    double albedo = ki_clamp(e, 1e-6, 1);
    return 1 + ki_unit(f0) * (1 - albedo) / albedo;
}

// The single bounce has the albedo s = f0 a + b, where a and b are those of the split sum. The lobe
// for F = 1 loses m = 1 - a - b, and f = (1 + 20 f0) / 21 is the average of Schlick's F. The
// further bounces add s f m / (1 - f m), taken as diffuse light. Fdez-Aguera 2019, section 3.
void kiln_fdez_aguera(double f0, double a, double b, double *single, double *multiple)
{
    f0 = ki_unit(f0);
    a = ki_unit(a);
    b = ki_unit(b) < 1 - a ? ki_unit(b) : 1 - a;
    // The divisor is 1 - f m, where m = 1 - a - b is the light that the lobe for F = 1 loses. It is
    // written as a sum that does not cancel.
    double f = (1 + 20 * f0) / 21, e = a + b, divisor = (1 - f) + f * e;
    *single = f0 * a + b;
    *multiple = divisor > 0 ? *single * f * (1 - e) / divisor : 1;
}

double kiln_compensate_walk(double e_single, double added)
{
    return 1 + ki_unit(added) / ki_clamp(e_single, 1e-6, 1);
}
