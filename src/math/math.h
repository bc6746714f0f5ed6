// Elementary functions that give the same bits on every machine (only + - * / and sqrt are used,
// and those are exact by IEEE 754), and quadrature. Errors are tested against libm.
#ifndef KI_MATH_H
#define KI_MATH_H

#include <stdbool.h>
#include <stddef.h>

#define KI_PI 3.14159265358979323846

/// Error below 2 ulp for |x| < 1e5, absolute below 1e-16 near the zeros.
void ki_sincos(double x, double *sine, double *cosine);
double ki_sin(double x);
double ki_cos(double x);
/// Below 2 ulp; 0 for x < -745, the largest double above 709.
double ki_exp(double x);
/// Below 2 ulp; x > 0.
double ki_log(double x);
/// exp(y log x): relative error below 4e-16 * (1 + |y log x|); x >= 0.
double ki_pow(double x, double y);
/// Below 3 ulp.
double ki_atan2(double y, double x);
double ki_asin(double x);
double ki_acos(double x);
/// Below 2 ulp.
double ki_erf(double x);
/// exp(x^2) (1 - erf x), which neither vanishes nor overflows; below 5 ulp, x >= 0.
double ki_erfcx(double x);
/// Gamma(a) Gamma(b) / Gamma(a + b), a and b from 1 to 1e9; relative error below 1e-12, or
/// 1e-15 min(a, b) (1 + log max(a, b)) where that is more.
double ki_beta(double a, double b);

/// Gauss-Legendre nodes, increasing, and weights on [-1, 1]; exact to degree 2 count - 1. Error
/// of nodes and weights below 4e-16 for count <= 4096.
void ki_gauss_legendre(int count, double *nodes, double *weights);
/// The same for count = 8 and 16, for composite rules.
extern const double ki_gauss8_nodes[8], ki_gauss8_weights[8];
extern const double ki_gauss16_nodes[16], ki_gauss16_weights[16];
/// The double exponential rule on [0, 1], count odd: nodes crowd at both ends, whose singularities
/// are then no trouble, down to exp(-pi sinh reach) of the length: 4e-17 for reach = 3.2, 8e-11 for
/// 2.7. nodes[count - 1 - i] is the distance of node i from 1 without rounding.
void ki_double_exponential(int count, double reach, double *nodes, double *weights);

/// x that makes |A x - b| least, rows >= columns. A is stored column after column; A and b are
/// overwritten. False where the columns are dependent to 14 digits.
bool ki_least_squares(double *a, double *b, int rows, int columns, double *x);

/// Eigenvalues of a symmetric matrix, count x count, and the unit vectors that go with them, the rows of
/// `axes`. `a` is overwritten.
void ki_symmetric_axes(int count, double *a, double *axes, double *values);

#endif
