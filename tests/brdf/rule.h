// The double exponential quadrature rule, computed with libm, for reference integrals in tests.
#ifndef KILN_TEST_RULE_H
#define KILN_TEST_RULE_H

#include <math.h>

enum { HALF_NODES = 101 };
#define HALF_PI 1.57079632679489661923

// Sets the nodes and weights of the rule on (a, b). The nodes come doubly exponentially close to
// both ends. Takahasi and Mori 1974.
static void half_rule(double a, double b, double nodes[HALF_NODES], double weights[HALF_NODES])
{
    for (int i = 0; i < HALF_NODES; i++) {
        double h = 6.4 / (HALF_NODES - 1), t = -3.2 + i * h, u = HALF_PI * sinh(t);
        double from_end = (b - a) / (1 + exp(2 * fabs(u)));
        nodes[i] = t < 0 ? a + from_end : b - from_end;
        weights[i] = h * (b - a) / 2 * HALF_PI * cosh(t) / (cosh(u) * cosh(u));
    }
}

#endif
