// What the single-scattering lobe leaves out, put back.
#include "brdf/brdf.h"

#include "math/math.h"

double ki_kulla_conty(double e_o, double e_i, double e_average)
{
    double missing = 1 - e_average;
    return missing > 0 ? (1 - e_o) * (1 - e_i) / (KI_PI * missing) : 0;
}

// Each bounce keeps f of the light and lets E of that leave, so that the bounces bring
//
//     f E + f E f (1 - E) + f E f^2 (1 - E)^2 + ... = f E / (1 - f (1 - E)).
//
// The first of them is the specular lobe itself. Those from the second one on are f (1 - E) times
// the sum, and since the lobe that is coloured already has 1 - E, f times it.
double ki_kulla_conty_fresnel(kiln_f_add form, double f, double e_average)
{
    double rest = (1 - f) + f * e_average; // 1 - f (1 - E); E itself for f = 1
    if (!(rest > 0))                       // f = 1 and E = 0: everything returns in the end
        return 1;
    double sum = f * e_average / rest;
    return form == KILN_F_ADD_ASSIGNMENT ? sum : f * sum;
}

double ki_turquin(double f0, double e)
{
    return 1 + f0 * (1 - e) / e;
}

// With s = f0 a + b the albedo of the single bounce, m = 1 - a - b what F = 1 would miss, and f =
// (1 + 20 f0) / 21: the rest adds s f m / (1 - f m), as diffuse light. Fdez-Aguera 2019, section 3.
void ki_fdez_aguera(double f0, double a, double b, double *single, double *multiple)
{
    double f = (1 + 20 * f0) / 21, e = a + b, rest = (1 - f) + f * e; // 1 - f m
    *single = f0 * a + b;
    *multiple = rest > 0 ? *single * f * (1 - e) / rest : 1;
}
