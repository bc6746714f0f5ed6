// The error function erf, and its scaled complement erfcx x = exp(x^2) (1 - erf x).
#include "math/math.h"

#include <math.h>

// (1 + 2 x) erfcx x is smooth in y = (x - 3) / (x + 3) for x in [0, infinity), and is evaluated as
// a Chebyshev series in y. The terms left out are below 3e-18. This form is Shepherd and
// Laframboise's (Math. Comp. 36, 1981); the coefficients were computed with 40 digits.
double ki_erfcx(double x)
{
    static const double c[] = {
        1.1775625741965600463,      5.3539045396156767694e-3,   -9.3775503422842090522e-2,
        5.4366525557443220495e-2,   -1.8976596707845207386e-2,  4.4534260614627115695e-3,
        -6.3355317105531469398e-4,  1.7661719523171591851e-5,   1.2841532864056670734e-5,
        -2.0072285659059914438e-6,  -1.8075227904148371024e-7,  7.5498283438250928278e-8,
        1.8856685238386027905e-9,   -2.6995190497983639975e-9,  -1.4600791199391049408e-11,
        1.0361607445969489676e-10,  1.4757159766234730087e-12,  -4.2773400643969108248e-12,
        -2.0792249285979899778e-13, 1.8134502003176962422e-13,  1.9734255745447388335e-14,
        -7.2879437375926731568e-15, -1.5169878690228115682e-15, 2.3514112258781403525e-16,
        1.0006111691821667611e-16};
    double y = x > 1e300 ? 1 : (x - 3) / (x + 3), b1 = 0, b2 = 0;
    for (int k = (int)(sizeof c / sizeof *c) - 1; k > 0; k--) {
        double b0 = 2 * y * b1 - b2 + c[k];
        b2 = b1;
        b1 = b0;
    }
    return (y * b1 - b2 + c[0]) / (1 + 2 * x);
}

double ki_erf(double x)
{
    double a = fabs(x), y = x * x;
    if (a < 0.75) {
        // For small x, erf x = 2 / sqrt(pi) times the sum over n of (-1)^n x^(2n+1) / (n! (2n+1)).
        // The first omitted term is below 2e-18.
        double term = 1, sum = 0;
        for (int n = 1; n <= 14; n++) {
            term *= -y / n;
            sum += term / (2 * n + 1);
        }
        return 1.12837916709551257390 * (x + x * sum);
    }
    double complement = a < 6 ? ki_exp(-y) * ki_erfcx(a) : 0;
    return x < 0 ? complement - 1 : 1 - complement;
}
