#include "math/math.h"

const double ki_gauss8_nodes[8] = {-0.96028985649753623168, -0.79666647741362673959,
                                   -0.52553240991632898582, -0.18343464249564980494,
                                   0.18343464249564980494,  0.52553240991632898582,
                                   0.79666647741362673959,  0.96028985649753623168};
const double ki_gauss8_weights[8] = {
    0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734, 0.36268378337836198297,
    0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915};
const double ki_gauss16_nodes[16] = {
    -0.9894009349916499326,  -0.94457502307323257608,  -0.86563120238783174388,
    -0.7554044083550030339,  -0.61787624440264374845,  -0.45801677765722738634,
    -0.28160355077925891323, -0.095012509837637440185, 0.095012509837637440185,
    0.28160355077925891323,  0.45801677765722738634,   0.61787624440264374845,
    0.7554044083550030339,   0.86563120238783174388,   0.94457502307323257608,
    0.9894009349916499326};
const double ki_gauss16_weights[16] = {
    0.027152459411754094852, 0.062253523938647892863, 0.09515851168249278481,
    0.12462897125553387205,  0.14959598881657673208,  0.16915651939500253819,
    0.18260341504492358887,  0.18945061045506849629,  0.18945061045506849629,
    0.18260341504492358887,  0.16915651939500253819,  0.14959598881657673208,
    0.12462897125553387205,  0.09515851168249278481,  0.062253523938647892863,
    0.027152459411754094852};

// The nodes are the zeros of the Legendre polynomial P_n with n = count. Newton's method finds each
// from the asymptotic guess cos(pi (i + 3/4) / (n + 1/2)). The weight of node x is 2 / ((1 - x^2)
// P_n'(x)^2), by Abramowitz and Stegun, 25.4.29.
void ki_gauss_legendre(int count, double *nodes, double *weights)
{
    for (int i = 0; i < (count + 1) / 2; i++) {
        double x = ki_cos(KI_PI * (i + 0.75) / (count + 0.5));
        double slope = 1;
        for (int step = 0; step < 8; step++) {
            double p0 = 1, p1 = x;
            for (int l = 2; l <= count; l++) {
                double p2 = ((2 * l - 1) * x * p1 - (l - 1) * p0) / l;
                p0 = p1;
                p1 = p2;
            }
            slope = count * (x * p1 - p0) / (x * x - 1);
            double change = p1 / slope;
            x -= change;
            if (change < 1e-16 && change > -1e-16)
                break;
        }
        if (2 * i + 1 == count)
            x = 0;
        double weight = 2 / ((1 - x * x) * slope * slope);
        nodes[count - 1 - i] = x;
        nodes[i] = -x;
        weights[i] = weights[count - 1 - i] = weight;
    }
}

// The double exponential rule is the trapezoidal rule in t on [-reach, reach] after the
// substitution x = 1 / (1 + exp(-pi sinh t)), by Takahasi and Mori 1974.
void ki_double_exponential(int count, double reach, double *nodes, double *weights)
{
    double step = 2 * reach / (count - 1);
    for (int i = 0; i <= count / 2; i++) {
        double e = ki_exp(-reach + i * step); // e^t of node i, where t <= 0
        double u = ki_exp(KI_PI / 2 * (e - 1 / e)), x = u / (1 + u);
        nodes[i] = x;
        nodes[count - 1 - i] = 1 - x;
        weights[i] = weights[count - 1 - i] = step * KI_PI / 2 * (e + 1 / e) * x / (1 + u);
    }
}
