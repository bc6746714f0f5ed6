// Euler's beta function.
#include "math/math.h"

// Stirling's series for log Gamma(x) - ((x - 1/2) log x - x + log(2 pi) / 2); error below 1e-13 for
// x >= 9. Abramowitz and Stegun 6.1.41.
static double stirling(double x)
{
    double y = 1 / (x * x);
    return (1.0 / 12 - y * (1.0 / 360 - y * (1.0 / 1260 - y * (1.0 / 1680 - y / 1188)))) / x;
}

// log Gamma(x) by raising x to 9 and more.
static double log_gamma(double x)
{
    double product = 1;
    while (x < 9) {
        product *= x;
        x += 1;
    }
    return (x - 0.5) * ki_log(x) - x + 0.91893853320467274178 + stirling(x) - ki_log(product);
}

// log(1 + x), x >= 0.
static double log1p_positive(double x)
{
    double u = 1 + x;
    return u > 1 ? ki_log(u) - ((u - 1) - x) / u : x;
}

double ki_beta(double a, double b)
{
    if (a < b) {
        double swap = a;
        a = b;
        b = swap;
    }
    if (a < 9)
        return ki_exp(log_gamma(a) + log_gamma(b) - log_gamma(a + b));
    // log Gamma(a) - log Gamma(a + b) without the difference of two great numbers.
    double rise = (a - 0.5) * log1p_positive(b / a) + b * (ki_log(a + b) - 1);
    return ki_exp(log_gamma(b) - rise + stirling(a) - stirling(a + b));
}
