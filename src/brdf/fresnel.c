// Fresnel reflectances of unpolarised light, and their averages over diffuse light. In: indices of
// refraction or reflectances, and the cosine of incidence. Out: the reflectance F by Schlick's
// approximation, by its form for metals with a value at 82 degrees, and by the exact formulas for
// dielectrics and conductors; or the average 2 int F(mu) mu dmu. Method of the averages: a closed
// form for dielectrics, adaptive quadrature for conductors, and Kulla and Conty's fits for both.
// docs/theory/fresnel.md derives the formulas.
#include "brdf/brdf.h"

#include "base/base.h"
#include "brdf/arguments.h"
#include "math/math.h"

#include <math.h>

double ki_schlick_fresnel(double voh)
{
    double c = 1 - voh, c2 = c * c;
    return c2 * c2 * c;
}

// Fresnel's formulas for the reflectance (R_s + R_p) / 2 of a dielectric. With c = cos theta, s^2 =
// 1 - c^2 and g^2 = ior^2 - s^2:
//
//     R_s = ((c - g) / (c + g))^2,      R_p = R_s ((c g - s^2) / (c g + s^2))^2,
//
// and c - g = (1 - ior^2) / (c + g). Born and Wolf 1999, section 1.5.2.
double ki_fresnel_dielectric(double ior, double c)
{
    double contrast = (1 - ior) * (1 + ior), s2 = (1 - c) * (1 + c);
    double g2 = c * c - contrast;
    if (!(g2 > 0))
        // F is 1 for total reflection, and 0 for ior = 1 at c = 0, where both media are the same
        return contrast > 0;
    double g = sqrt(g2), r = contrast / ((c + g) * (c + g)), p = (c * g - s2) / (c * g + s2);
    double f = r * r * (1 + p * p) / 2;
    return f < 1 ? f : 1;
}

// The formulas of ki_fresnel_dielectric with a complex g = a + i b, where g^2 = (n + i k)^2 - s^2
// and the squares in R_s and R_p become squared absolute values. The larger of a and b is the root
// of a sum; the smaller follows from a b = n k, so that nothing cancels.
double ki_fresnel_conductor(double n, double k, double c)
{
    double s2 = (1 - c) * (1 + c);
    double real = (n - 1) * (n + 1) - k * k + c * c, size = sqrt(real * real + 4 * n * n * k * k);
    double a, b, larger = sqrt((size + fabs(real)) / 2);
    // g = 0 in two cases: for n < 1 and k = 0 at the critical angle, where F is 1, and for n = 1, k
    // = 0 at c = 0
    if (!(larger > 0))
        return n < 1;
    if (real > 0) {
        a = larger;
        b = n * k / larger;
    } else {
        a = n * k / larger;
        b = larger;
    }
    double bc = b * c, s = ((c - a) * (c - a) + b * b) / ((c + a) * (c + a) + b * b);
    double p = ((a * c - s2) * (a * c - s2) + bc * bc) / ((a * c + s2) * (a * c + s2) + bc * bc);
    double f = s * (1 + p) / 2;
    return f < 1 ? f : 1;
}

// Gulbrandsen 2014, with r the reflectivity at normal incidence. As the edge tint grows from 0 to
// 1, n goes from n_max = (1 + sqrt r) / (1 - sqrt r) to n_min = (1 - r) / (1 + r). k follows from
// the reflectivity by (1 - r) k^2 = r (n + 1)^2 - (n - 1)^2. The right side cancels where k is
// small, so the code uses its factored form
//
//     k^2 = (n_max - n) (n - 1 / n_max).
void kiln_gulbrandsen(double reflectivity, double edge_tint, double *n, double *k)
{
    double r = ki_clamp(reflectivity, 0, 0.9999), root = sqrt(r);
    double n_max = (1 + root) / (1 - root), n_min = (1 - r) / (1 + r);
    double less = ki_unit(edge_tint) * (n_max - n_min);
    *n = n_max - less;
    double k2 = less * (*n - 1 / n_max);
    *k = sqrt(k2 > 0 ? k2 : 0);
}

// Solves F(1 / 7) = f82 for edge in F = f0 + (1 - f0) (1 - voh)^5 - edge voh (1 - voh)^6. The last
// term is largest at voh = 1 / 7.
double ki_f82_edge(double f0, double f82)
{
    double edge = 6.0 / 7, power = edge * edge * edge * edge * edge;
    return (f0 + (1 - f0) * power - f82) * 7 / (power * edge);
}

double kiln_fresnel_f82(double f0, double f82, double voh)
{
    f0 = ki_unit(f0);
    f82 = ki_unit(f82);
    voh = ki_unit(voh);
    double power = ki_schlick_fresnel(voh);
    double f = f0 + (1 - f0) * power - ki_f82_edge(f0, f82) * voh * (power * (1 - voh));
    return ki_clamp(f, 0, 1);
}

double kiln_fresnel_schlick(double f0, double voh)
{
    double f = ki_unit(f0);
    return f + (1 - f) * ki_schlick_fresnel(ki_unit(voh));
}

double kiln_fresnel_dielectric(double ior, double voh)
{
    return ki_fresnel_dielectric(ki_index(ior), ki_unit(voh));
}

double kiln_fresnel_conductor(double n, double k, double voh)
{
    return ki_fresnel_conductor(ki_index(n), ki_index(k), ki_unit(voh));
}

// ---------------------------------------------------------------------------------------- averages

double kiln_fresnel_f82_average(double f0, double f82)
{
    double f = ki_unit(f0);
    return (1 + 20 * f) / 21 - ki_f82_edge(f, ki_unit(f82)) / 126;
}

double kiln_fresnel_schlick_average(double f0)
{
    return (1 + 20 * ki_unit(f0)) / 21;
}

// The term R(q) of Walsh's closed form (1926) for the average 2 int F mu dmu of a dielectric. For n
// > 1 and q = (n - 1) / (n + 1) the average is
//
//     q (2 + q) / 6 + 2 q^2 (1 + q)^2 ln q / (1 + q^2)^3 + R(q),
//     R = 1/2 - (1 - q) (1 + q)^3 (1 + 2 q - q^2) / (4 q (1 + q^2)^2)
//             + (1 - q)^2 (1 + q)^4 (1 + 6 q^2 + q^4) ln n / (8 q^2 (1 + q^2)^3).
//
// The terms of R have poles at q = 0 that cancel each other. For q < 0.1 the code therefore uses
// R's Taylor series, whose first omitted term is 120 q^18. The argument p is 1 - q.
static double walsh_term(double n, double q, double p)
{
    static const double series[] = {1.0 / 3,
                                    11.0 / 3,
                                    -23.0 / 15,
                                    -191.0 / 15,
                                    101.0 / 35,
                                    2993.0 / 105,
                                    -251.0 / 63,
                                    -15899.0 / 315,
                                    17819.0 / 3465,
                                    272897.0 / 3465,
                                    -94231.0 / 15015,
                                    -5104037.0 / 45045,
                                    334331.0 / 45045,
                                    771541.0 / 5005,
                                    -728393.0 / 85085,
                                    -17125533.0 / 85085,
                                    141193733.0 / 14549535};
    double q2 = q * q, d = 1 + q2, u = 1 + q;
    if (q < 0.1) {
        double sum = 0;
        for (int i = (int)(sizeof series / sizeof *series) - 1; i >= 0; i--)
            sum = (sum + series[i]) * q;
        return sum;
    }
    double u3 = u * u * u;
    return 0.5 - p * u3 * (1 + 2 * q - q2) / (4 * q * d * d) +
           p * p * (u3 * u) * (1 + 6 * q2 + q2 * q2) * ki_log(n) / (8 * q2 * (d * d * d));
}

double kiln_fresnel_dielectric_average(double ior)
{
    ior = ki_index(ior);
    // By reciprocity the averages of transmitted light from the two sides of the boundary are
    // related: 1 - F_avg(ior) = ior^2 (1 - F_avg(1 / ior)).
    if (ior < 1)
        return ior > 0 ? 1 - ior * ior * (1 - kiln_fresnel_dielectric_average(1 / ior)) : 1;
    double q = (ior - 1) / (ior + 1), p = 2 / (ior + 1), d = 1 + q * q; // p = 1 - q
    if (!(q > 0))
        return 0;
    double middle = 2 * (q * q) * ((1 + q) * (1 + q)) * ki_log(q) / (d * d * d);
    return q * (2 + q) / 6 + middle + walsh_term(ior, q, p);
}

enum { NODES = 16, DEPTH = 40 };

// The integral 2 int F mu dmu of a conductor n + i k between the kink of F and one end of [0, 1]. F
// behaves as a square root at its kink, which the substitution mu = kink + (end - kink) t^2 with t
// in [0, 1] removes.
typedef struct average {
    double n, k, kink, end, node[NODES], weight[NODES];
} average;

// Returns the integral of 2 F(mu) mu dmu over mu = kink + (end - kink) t^2 with t between the
// values `from` and `to`, by one Gauss-Legendre rule in t.
static double panel(const average *f, double from, double to)
{
    double sum = 0, half = (to - from) / 2, length = f->end - f->kink;
    for (int i = 0; i < NODES; i++) {
        double t = from + half * (1 + f->node[i]), mu = f->kink + length * (t * t);
        sum += f->weight[i] * ki_fresnel_conductor(f->n, f->k, mu) * mu * t;
    }
    return sum * 4 * half * fabs(length);
}

// Adaptive quadrature of 2 int F(mu) mu dmu with mu = kink + (end - kink) t^2, over an interval of
// t. Halves the interval until, at two depths in succession, the sum over the halves agrees to
// 1e-14 with the integral `whole` over the whole interval.
static double refine(const average *f, double from, double to, double whole, bool agreed, int depth)
{
    double middle = (from + to) / 2;
    double left = panel(f, from, middle), right = panel(f, middle, to);
    bool agree = fabs(left + right - whole) <= 1e-14;
    if (depth == 0 || (agreed && agree))
        return left + right;
    return refine(f, from, middle, left, agree, depth - 1) +
           refine(f, middle, to, right, agree, depth - 1);
}

double kiln_fresnel_conductor_average(double n, double k)
{
    n = ki_index(n);
    k = ki_index(k);
    average f = {.n = n, .k = k, .end = 1};
    ki_gauss_legendre(NODES, f.node, f.weight);
    // F has a kink at the critical angle, mu^2 = 1 - n^2 + k^2, beyond which g^2 of
    // ki_fresnel_conductor has a negative real part. The kink is sharp for small k. For small n it
    // is at mu near 1, and the cone of directions inside the critical angle is so narrow that no
    // quadrature node would fall into the cone.
    double kink2 = (1 - n) * (1 + n) + k * k;
    f.kink = kink2 > 0 && kink2 < 1 ? sqrt(kink2) : 0;
    double sum = refine(&f, 0, 1, panel(&f, 0, 1), false, DEPTH);
    f.end = 0;
    if (f.kink > 0)
        sum += refine(&f, 0, 1, panel(&f, 0, 1), false, DEPTH);
    return sum < 1 ? sum : 1;
}

// The fits of a dielectric's average reflectance by Kulla and Conty 2017, one for ior > 1 and one
// for ior <= 1.
double kiln_fresnel_dielectric_average_fit(double ior)
{
    ior = ki_clamp(ior, 0, 400);
    if (ior > 1)
        return (ior - 1) / (4.08567 + 1.00071 * ior);
    return 0.997118 + ior * (0.1014 + ior * (-0.965241 - 0.130607 * ior));
}

// The fit of a conductor's average reflectance by Kulla and Conty 2017, page 26: a polynomial in
// the reflectivity r and the edge tint g.
double kiln_fresnel_conductor_average_fit(double reflectivity, double edge_tint)
{
    double r = ki_unit(reflectivity), g = ki_unit(edge_tint), r2 = r * r, g2 = g * g;
    return 0.087237 + 0.0230685 * g - 0.0864902 * g2 + 0.0774594 * (g2 * g) + 0.782654 * r -
           0.136432 * r2 + 0.278708 * (r2 * r) + 0.19744 * (r * g) + 0.0360605 * (g2 * r) -
           0.2586 * (g * r2);
}
