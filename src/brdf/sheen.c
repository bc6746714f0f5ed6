// The directional albedo E of Charlie sheen, a reflection lobe for cloth, by double exponential
// quadrature. In: masking, roughness, n.v. Out: E. With Ashikhmin's masking the inner integral over
// the azimuth has a closed form, and E is an integral over the angle of the half vector. With
// Estevez and Kulla's masking E is a double integral over light directions. docs/theory/sheen.md
// derives both.
#include "brdf/sheen.h"

#include "base/base.h"
#include "math/math.h"

#include <math.h>

// Width of the distribution D in units of sqrt(alpha) radians: half vectors that are more than FALL
// sqrt(alpha) above the horizon have less than 1e-14 of D's value at the horizon.
#define FALL 8.0

double ki_sheen_d(double alpha, double noh)
{
    double sin2 = fmax(0, (1 - noh) * (1 + noh));
    return (2 + 1 / alpha) * ki_pow(sin2, 0.5 / alpha) / (2 * KI_PI);
}

// -------------------------------------------------------------------------------------- visibility

// Estevez and Kulla's fit of Smith's Lambda for sheen (2017, eq. 3 and its table): Lambda(x) =
// exp(a / (1 + b x^c) + d x + e) for a cosine x below 1/2, continued above 1/2 by a point
// reflection of the exponent. The coefficients a to e are interpolated between those of alpha = 0
// (`smooth`) and alpha = 1 (`rough`).
static double lambda_exponent(const double c[5], double x)
{
    return c[0] / (1 + c[1] * ki_pow(x, c[2])) + c[3] * x + c[4];
}

static void lambda_coefficients(double alpha, double c[5])
{
    static const double smooth[5] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    static const double rough[5] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
    double w = (1 - alpha) * (1 - alpha);
    for (int k = 0; k < 5; k++)
        c[k] = w * smooth[k] + (1 - w) * rough[k];
}

static double lambda(const double c[5], double cosine)
{
    if (cosine < 0.5)
        return ki_exp(lambda_exponent(c, cosine));
    return ki_exp(2 * lambda_exponent(c, 0.5) - lambda_exponent(c, 1 - cosine));
}

double ki_sheen_visibility(kiln_sheen sheen, double alpha, double nov, double nol)
{
    if (sheen == KILN_SHEEN_ASHIKHMIN)
        return 1 / (4 * (nol + nov - nol * nov));
    double c[5];
    lambda_coefficients(alpha, c);
    return 1 / ((1 + lambda(c, nov) + lambda(c, nol)) * (4 * nov * nol));
}

// ----------------------------------------------------------------- albedo with Ashikhmin's masking

enum { STEPS = 61 };

// Returns atan(sqrt w) / sqrt w for w > -1. For w < 0 the function continues as artanh(sqrt -w) /
// sqrt -w. `rest` is 1 + w, which the caller knows more precisely than a sum would be.
static double arc_ratio(double w, double rest)
{
    if (fabs(w) < 1e-4)
        return 1 - w * (1.0 / 3 - w * (1.0 / 5 - w / 7));
    double y = sqrt(fabs(w));
    return w > 0 ? ki_atan2(y, 1) / y : ki_log((1 + y) * (1 + y) / rest) / (2 * y);
}

// The inner integral of the albedo with Ashikhmin's masking, for half vectors h at the angle theta
// to the normal, with mu = n.v:
//
//     int (v.h) (n.l) / (n.l + mu - (n.l) mu) dphi
//
// over the azimuths |phi| <= reach at which n.l >= 0, where
// v.h = mu cos theta + sin theta_v sin theta cos phi and n.l = 2 cos theta (v.h) - mu. Its closed
// form needs K = int_0^reach dphi / ((1 - mu) n.l + mu). For mu > 1/2 the terms of the closed form
// cancel, and Gauss's rule replaces it.
static double ashikhmin_azimuth(double theta, double theta_v, double mu)
{
    double sine, cosine, sin_v = sqrt((1 - mu) * (1 + mu));
    ki_sincos(theta, &sine, &cosine);
    // n.l for the half vector at azimuth phi = 0, its greatest value
    double nearest = fmax(0, ki_cos(theta_v - 2 * theta));
    double farthest = ki_cos(theta_v + 2 * theta);
    // The arc of azimuths ends at phi = reach, where n.l = 0: cos reach = -cot theta_v cot 2 theta.
    // t2 is tan^2(reach / 2).
    bool circle = !(farthest < 0);
    double t2 = circle ? 0 : nearest / -farthest;
    double reach = circle ? KI_PI : 2 * ki_atan2(sqrt(t2), 1), q = sin_v * sine;
    if (mu > 0.5) {
        double sum = 0;
        for (int i = 0; i < 16; i++) {
            double voh = mu * cosine + q * ki_cos(reach * (1 + ki_gauss16_nodes[i]) / 2);
            double nol = fmax(0, 2 * cosine * voh - mu);
            sum += ki_gauss16_weights[i] * voh * nol / (nol * (1 - mu) + mu);
        }
        return sum * reach;
    }
    double near = (1 - mu) * nearest + mu, far = (1 - mu) * farthest + mu, k;
    if (circle)
        k = KI_PI / sqrt(near * far);
    else
        k = 2 / near * sqrt(t2) * arc_ratio(far / near * t2, mu * (1 + t2) / near);
    double c = 2 * cosine * (1 - mu);
    double sin_reach = circle ? 0 : 2 * sqrt(t2) / (1 + t2);
    return 2 / (1 - mu) *
           (mu * cosine * reach + q * sin_reach - mu * reach / c + mu * mu * mu * k / c);
}

// The albedo with Ashikhmin's masking, as an integral over half vectors h:
//
//     E(v) = int D (v.h) (n.l) / (n.l + n.v - (n.l)(n.v)) dh.
//
// The range of theta, the angle of h to the normal, is cut at half the view's elevation. Below the
// cut every azimuth of h mirrors the view to above the horizon. Above the cut only an arc of
// azimuths does, and the arc's length falls to 0.
static double ashikhmin_albedo(double alpha, double mu)
{
    double nodes[STEPS], weights[STEPS], sum = 0;
    ki_double_exponential(STEPS, 3.2, nodes, weights);
    double elevation = ki_asin(mu), theta_v = KI_PI / 2 - elevation;
    double least = KI_PI / 2 - FALL * sqrt(alpha);
    double cuts[3] = {0, elevation / 2, (KI_PI - elevation) / 2};
    for (int k = 0; k < 3; k++)
        cuts[k] = fmax(cuts[k], least);
    for (int part = 0; part < 2; part++)
        for (int i = 0; i < STEPS; i++) {
            double length = cuts[part + 1] - cuts[part], theta = cuts[part] + length * nodes[i];
            double power = ki_pow(ki_sin(theta), 1 / alpha + 1);
            sum += weights[i] * length * power * ashikhmin_azimuth(theta, theta_v, mu);
        }
    return sum * (2 + 1 / alpha) / (2 * KI_PI);
}

// --------------------------------------------------------- albedo with Estevez and Kulla's masking

enum { LIGHT_STEPS = 41, AZIMUTH_STEPS = 41 };

// The mean of sin(theta_h)^(1/alpha) over the light's azimuth phi, counted from the mirror
// direction, where
//
//     tan^2 theta_h = (d^2 + 4 sin theta_v sin theta_l sin^2(phi / 2)) / s^2
//
// with d = sin theta_v - sin theta_l and s = n.v + n.l. `product` is sin theta_v sin theta_l. Where
// tan^2 theta_h is below `cot2` the power is taken as 0. turn[] and weights[] are a quadrature rule
// on [0, 1].
static double mean_fibre(double alpha, double cot2, double d2, double product, double s2,
                         const double turn[AZIMUTH_STEPS], const double weights[AZIMUTH_STEPS])
{
    double first = (s2 * cot2 - d2) / (4 * product), mean = 0;
    if (first >= 1)
        return 0;
    first = first > 0 ? ki_asin(sqrt(first)) : 0;
    for (int j = 0; j < AZIMUTH_STEPS; j++) {
        double sine = ki_sin(first + (KI_PI / 2 - first) * turn[j]);
        double flat = d2 + 4 * product * sine * sine;
        mean += weights[j] * ki_pow(flat / (flat + s2), 0.5 / alpha);
    }
    return mean * (1 - first / (KI_PI / 2));
}

// The albedo with Estevez and Kulla's masking, as an integral over light directions:
//
//     E(v) = int D / (4 (n.v) (1 + Lambda(v) + Lambda(l))) dphi d(n.l).
//
// The range of n.l is cut at n.v, where D is not smooth in the mirror direction, and at 1/2, where
// the two pieces of Lambda's fit meet. The fit is singular, as a power, at n.l = 0 and 1, which the
// double exponential rule tolerates.
static double estevez_albedo(double alpha, double mu)
{
    double c[5], nodes[LIGHT_STEPS], weights[LIGHT_STEPS];
    double turn[AZIMUTH_STEPS], turn_weights[AZIMUTH_STEPS];
    ki_double_exponential(LIGHT_STEPS, 2.7, nodes, weights);
    ki_double_exponential(AZIMUTH_STEPS, 2.7, turn, turn_weights);
    lambda_coefficients(alpha, c);
    double lambda_v = lambda(c, mu), sin_v = sqrt((1 - mu) * (1 + mu)), sum = 0;
    double cuts[4] = {0, fmin(mu, 0.5), fmax(mu, 0.5), 1}, cot2 = 0;
    // The range of n.l ends where every half vector is more than FALL sqrt(alpha) above the
    // horizon, so that D is negligible.
    double fall = FALL * sqrt(alpha);
    if (fall < KI_PI / 2) {
        double sine, cosine, highest = 2 * fall - ki_asin(mu);
        ki_sincos(fall, &sine, &cosine);
        cot2 = cosine / sine * (cosine / sine);
        for (int k = 1; k < 4; k++)
            cuts[k] = fmin(cuts[k], highest < KI_PI / 2 ? fmax(0, ki_sin(highest)) : 1);
    }
    for (int part = 0; part < 3; part++) {
        double length = cuts[part + 1] - cuts[part];
        for (int i = 0; i < LIGHT_STEPS && length > 0; i++) {
            double nol = cuts[part] + length * nodes[i], sin_l = sqrt((1 - nol) * (1 + nol));
            double d = sin_v - sin_l, s = mu + nol;
            sum += weights[i] * length / (1 + lambda_v + lambda(c, nol)) *
                   mean_fibre(alpha, cot2, d * d, sin_v * sin_l, s * s, turn, turn_weights);
        }
    }
    return sum * (2 + 1 / alpha) / (4 * mu);
}

double kiln_sheen_albedo(kiln_sheen sheen, double roughness, double nov)
{
    roughness = ki_clamp(roughness, 0.01, 1);
    if (sheen == KILN_SHEEN_ESTEVEZ)
        return estevez_albedo(roughness * roughness, ki_clamp(nov, 1e-4, 1));
    return ashikhmin_albedo(roughness * roughness, ki_clamp(nov, 1e-12, 1));
}
