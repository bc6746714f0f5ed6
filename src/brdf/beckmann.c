#include "brdf/beckmann.h"

#include "base/base.h"
#include "brdf/brdf.h"
#include "math/math.h"

#include <float.h>
#include <math.h>

double ki_beckmann_d(double alpha, double noh)
{
    if (!(noh > 0))
        return 0;
    double a2 = alpha * alpha, c2 = noh * noh;
    double tan2 = (1 - noh) * (1 + noh) / c2;
    if (!(a2 > 0))
        return tan2 > 0 ? 0 : DBL_MAX;
    return ki_exp(-tan2 / a2) / (KI_PI * a2 * c2 * c2);
}

double ki_beckmann_lambda(double alpha, double cosine)
{
    double sine = sqrt(fmax(0, (1 - cosine) * (1 + cosine)));
    if (!(cosine > 0))
        return DBL_MAX;
    double a = cosine / fmax(alpha * sine, cosine * 1e-2);
    // Smith's Lambda is below 1e-18 for a > 6.
    if (a > 6)
        return 0;
    return ki_exp(-a * a) * (1 / (a * 1.77245385090551602730) - ki_erfcx(a)) / 2;
}
