// Elementary and special functions, quadrature rules and small dense linear algebra. They give the
// same bits on every machine, since they use only + - * / and sqrt, whose results IEEE 754 fixes to
// the last bit. An error of 1 ulp is one unit in the last place of the result. Tests compare the
// functions with libm.
#ifndef KI_MATH_H
#define KI_MATH_H

#include <stdbool.h>
#include <stddef.h>

#define KI_PI 3.14159265358979323846

/// Sine and cosine of x in radians, |x| < 1e5. The error is below 2 ulp, or below 1e-16 near the
/// zeros.
void ki_sincos(double x, double *sine, double *cosine);
double ki_sin(double x);
double ki_cos(double x);
/// exp x with an error below 2 ulp. Returns 0 for x < -745, and the largest double for x > 709.
double ki_exp(double x);
/// The natural logarithm of x > 0 with an error below 2 ulp.
double ki_log(double x);
/// x^y = exp(y log x) for x >= 0. The relative error is below 4e-16 (1 + |y log x|).
double ki_pow(double x, double y);
/// The angle of the point (x, y) in [-pi, pi], 0 for (0, 0), with an error below 3 ulp.
double ki_atan2(double y, double x);
/// arcsin x in [-pi/2, pi/2] for x in [-1, 1], with an error below 3 ulp.
double ki_asin(double x);
/// arccos x in [0, pi] for x in [-1, 1], with an error below 3 ulp.
double ki_acos(double x);
/// The error function erf x = 2 / sqrt(pi) int_0^x exp(-t^2) dt, with an error below 2 ulp.
double ki_erf(double x);
/// The scaled complement of erf, exp(x^2) (1 - erf x), for x >= 0, with an error below 5 ulp.
/// Unlike 1 - erf x, it does not underflow for large x.
double ki_erfcx(double x);
/// Euler's beta function Gamma(a) Gamma(b) / Gamma(a + b) for a and b from 1 to 1e9. The relative
/// error is below the greater of 1e-12 and 1e-15 min(a, b) (1 + log max(a, b)).
double ki_beta(double a, double b);

/// Sets `nodes`, increasing, and `weights` to those of the Gauss-Legendre rule of `count` nodes on
/// [-1, 1], which is exact for polynomials to degree 2 count - 1. The errors of nodes and weights
/// are below 4e-16 for count <= 4096.
void ki_gauss_legendre(int count, double *nodes, double *weights);
/// The Gauss-Legendre rules of ki_gauss_legendre with 8 and with 16 nodes, as constants.
extern const double ki_gauss8_nodes[8], ki_gauss8_weights[8];
extern const double ki_gauss16_nodes[16], ki_gauss16_weights[16];
/// Sets `nodes` and `weights` to those of the double exponential rule of `count` nodes on [0, 1];
/// count is odd. The nodes are so dense near both ends that singularities of the integrand there do
/// no harm. The first node is at exp(-pi sinh reach): 4e-17 for reach = 3.2, 8e-11 for reach = 2.7.
/// nodes[count - 1 - i] is 1 - nodes[i], the distance of node i from 1; near 1 this is more precise
/// than the difference.
void ki_double_exponential(int count, double reach, double *nodes, double *weights);

/// Sets x[columns] to the vector that minimises |A x - b|, for rows >= columns. a is A, stored
/// column after column, and b has `rows` numbers; both are overwritten. Returns false, with x
/// undefined, if the columns of A are linearly dependent to 14 digits.
bool ki_least_squares(double *a, double *b, int rows, int columns, double *x);

/// Sets values[count] to the eigenvalues of the symmetric matrix a, count x count, in no order, and
/// row i of `axes`, count x count, to the unit eigenvector of values[i]. `a` is overwritten.
void ki_symmetric_axes(int count, double *a, double *axes, double *values);

#endif
