// Sine, cosine, exponential, logarithm, power and arcus functions. In and out: doubles. Method:
// each function reduces its argument to a short interval and sums a Taylor or a similar power
// series there. The functions use only + - * / and sqrt, so that they give the same bits on every
// machine. math.h states the errors.
#include "math/math.h"

#include "math/power.inl"

#include <math.h>

// ------------------------------------------------------------------------------------ sine, cosine

// Sine and cosine on [-pi/4, pi/4] by Taylor polynomials. The first omitted terms are x^19/19! for
// the sine and x^18/18! for the cosine, each below 1e-17.
static double sine_near_zero(double x)
{
    double y = x * x;
    double p = 1.0 / 355687428096000;
    p = p * y - 1.0 / 1307674368000;
    p = p * y + 1.0 / 6227020800;
    p = p * y - 1.0 / 39916800;
    p = p * y + 1.0 / 362880;
    p = p * y - 1.0 / 5040;
    p = p * y + 1.0 / 120;
    p = p * y - 1.0 / 6;
    return x + x * (y * p);
}

static double cosine_near_zero(double x)
{
    double y = x * x;
    double p = 1.0 / 20922789888000;
    p = p * y - 1.0 / 87178291200;
    p = p * y + 1.0 / 479001600;
    p = p * y - 1.0 / 3628800;
    p = p * y + 1.0 / 40320;
    p = p * y - 1.0 / 720;
    p = p * y + 1.0 / 24;
    p = p * y - 1.0 / 2;
    return 1 + y * p;
}

// Reduces x to r = x - n pi/2 in [-pi/4, pi/4] by Cody and Waite's method: pi/2 is a sum of three
// parts, the first two of 33 bits, so that n times each of those two is exact.
void ki_sincos(double x, double *sine, double *cosine)
{
    static const double part1 = 1.57079632673412561417e+00;
    static const double part2 = 6.07710050630396597660e-11;
    static const double part3 = 2.02226624879595063154e-21;
    double n = floor(x * (2 / KI_PI) + 0.5);
    double r = ((x - n * part1) - n * part2) - n * part3;
    double s = sine_near_zero(r), c = cosine_near_zero(r);
    switch ((int64_t)n & 3) {
    case 0:
        *sine = s;
        *cosine = c;
        break;
    case 1:
        *sine = c;
        *cosine = -s;
        break;
    case 2:
        *sine = -s;
        *cosine = -c;
        break;
    default:
        *sine = -c;
        *cosine = s;
        break;
    }
}

double ki_sin(double x)
{
    double s, c;
    ki_sincos(x, &s, &c);
    return s;
}

double ki_cos(double x)
{
    double s, c;
    ki_sincos(x, &s, &c);
    return c;
}

// --------------------------------------------------------------------------------- exponent, power

double ki_exp(double x)
{
    return exponential(x);
}

double ki_log(double x)
{
    return logarithm(x);
}

double ki_pow(double x, double y)
{
    if (y == 0 || x == 1)
        return 1;
    if (!(x > 0))
        return y > 0 ? 0 : 1.7976931348623157e308;
    return ki_exp(y * ki_log(x));
}

// -------------------------------------------------------------------------------------- arctangent

// arctan x for 0 <= x <= 1. With c the multiple of 1/4 nearest to x, arctan x = arctan c + arctan
// r, where r = (x - c) / (1 + x c) is at most 0.125 in absolute value. arctan r is its power series
// to r^17.
static double arctangent(double x)
{
    static const double at[] = {0, 0.24497866312686415417, 0.46364760900080611621,
                                0.64350110879328438680, 0.78539816339744830962};
    int k = (int)(x * 4 + 0.5);
    double c = k * 0.25;
    double r = (x - c) / (1 + x * c), y = r * r, p = 1.0 / 17;
    for (int n = 15; n >= 3; n -= 2)
        p = 1.0 / n - p * y;
    return at[k] + (r - r * y * p);
}

double ki_atan2(double y, double x)
{
    double ax = fabs(x), ay = fabs(y), angle;
    if (ax == 0 && ay == 0)
        return 0;
    if (ay <= ax)
        angle = arctangent(ay / ax);
    else
        angle = KI_PI / 2 - arctangent(ax / ay);
    if (x < 0)
        angle = KI_PI - angle;
    return y < 0 ? -angle : angle;
}

double ki_asin(double x)
{
    double cosine2 = (1 - x) * (1 + x);
    return ki_atan2(x, cosine2 > 0 ? sqrt(cosine2) : 0);
}

double ki_acos(double x)
{
    double sine2 = (1 - x) * (1 + x);
    return ki_atan2(sine2 > 0 ? sqrt(sine2) : 0, x);
}
