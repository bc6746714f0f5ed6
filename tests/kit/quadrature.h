// Quadrature for reference integrals of reflection models, independent of the library's own
// integrators.
#ifndef KILN_KIT_QUADRATURE_H
#define KILN_KIT_QUADRATURE_H

/// The integral of f over [from, to], by `panels` equal panels of 24 Gauss nodes each.
double integrate(double (*f)(void *data, double x), void *data, double from, double to, int panels);

enum { HALF_NODES = 101 };
#define HALF_PI 1.57079632679489661923

/// Sets the nodes and weights of the double exponential rule on (a, b), computed with libm. The
/// nodes come doubly exponentially close to both ends. Takahasi and Mori 1974.
void half_rule(double a, double b, double nodes[HALF_NODES], double weights[HALF_NODES]);

// A half vector h: n.h, the sine of its angle to n, v.h, and n.l of the light l that h mirrors the
// view to.
typedef struct half {
    double noh, sin_h, voh, nol;
} half;

enum { HALF_VALUES = 8 };

/// Adds to sums[x_count] the integrals of the x_count <= HALF_VALUES values of f over all half
/// vectors that mirror the view to above the horizon, where n.v = nov. `width` is the angle over
/// which f changes first.
void half_integrate(double nov, double width, void (*f)(const void *user, const half *h, double *x),
                    const void *user, int x_count, double *sums);

#endif
