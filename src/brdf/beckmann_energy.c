// A and B of the split sum (albedo = F0 A + B) for Beckmann's distribution, by quadrature over the
// light's elevation and azimuth: model, roughness and n.v in; the integrals A and B out, to 1e-8.
#include "brdf/beckmann.h"

#include "base/base.h"
#include "brdf/brdf.h"
#include "math/math.h"

#include <math.h>

// Integrals of a Gaussian exp(-x^2) stop at x^2 = CUT2, where the Gaussian is 2e-12.
#define CUT2 27.0

// Integrates over the azimuth phi of the light at fixed elevations of view and light. phi is 0 in
// the mirror direction. With S = nov + nol,
//
//     tan^2 theta_h = tan^2((theta_v - theta_l) / 2) + 4 sin theta_v sin theta_l sin^2(phi/2) / S^2
//     v.h = S / (2 cos theta_h)
//
// and the arguments tan2 = tan^2((theta_v - theta_l) / 2), spread = 4 sin theta_v sin theta_l / S^2
// and s = S. D is therefore a Gaussian of sin(phi/2). Where the Gaussian is wide, the trapezoidal
// rule runs over the whole circle; where it is narrow, Gauss's rule runs over |phi| up to its cut.
// Adds weight * int D dphi to sum[0] and weight * int D (1 - v.h)^5 dphi to sum[1].
static void integrate_azimuth(double alpha, double tan2, double spread, double s, double weight,
                              double sum[2])
{
    enum { STEPS = 16 };
    double a2 = alpha * alpha, fall = spread / a2, scale = weight / (KI_PI * a2);
    double half = fall > CUT2 ? ki_asin(sqrt(CUT2 / fall)) : KI_PI / 2, e = 0, b = 0;
    bool circle = !(fall > CUT2);
    for (int i = 0; i <= STEPS - (circle ? 0 : 1); i++) {
        double x = circle ? half * i / STEPS : half * (1 + ki_gauss16_nodes[i]) / 2;
        double w = circle ? (i % STEPS ? 2.0 : 1.0) / STEPS : ki_gauss16_weights[i];
        double sine = ki_sin(x), t = tan2 + spread * sine * sine;
        double d = w * ki_exp(-t / a2) * (1 + t) * (1 + t);
        e += d;
        b += d * ki_schlick_fresnel(fmin(1, s * sqrt(1 + t) / 2));
    }
    // x is phi / 2 in [0, half]: by symmetry and the factor 2, int dphi = 4 int dx. The interval
    // has length `half`, and the weights w sum to 2, which leaves a factor of 2 * half.
    sum[0] += scale * 2 * half * e;
    sum[1] += scale * 2 * half * b;
}

// Integrates over light directions:
//
//     E(v) = int int D G / (4 nov) dphi dnol,
//
// and B, which is the same integral with the factor (1 - v.h)^5; A is E - B. integrate_azimuth
// computes the inner integral, over the azimuth phi. The outer integral runs over the light's
// elevation psi_l, in which D is a Gaussian about the view's elevation psi_v with a width of 2
// alpha. The range of psi_l ends where D is below 2e-12 of its peak. If the horizon lies inside
// that range, the pole of G near psi_l = -psi_v comes close, and the nodes are spaced evenly in
// log(psi_l + psi_v).
void ki_beckmann_energy(const kiln_model *model, double roughness, double nov, double ab[2])
{
    roughness = ki_clamp(roughness, 0, 1);
    nov = ki_clamp(nov, 0, 1);
    double alpha = roughness * roughness, f5 = ki_schlick_fresnel(nov);
    if (alpha < 1e-8) {
        double g = 1;
        if (model->g == KILN_G_SCHLICK_TEXT)
            g = ki_smith_g_schlick(ki_schlick_k_direct(roughness), nov, nov);
        ab[0] = g * (1 - f5);
        ab[1] = g * f5;
        return;
    }
    nov = fmax(nov, 1e-10 * alpha);
    double psi_v = ki_asin(nov), sine_v = sqrt((1 - nov) * (1 + nov));
    double reach = 2 * ki_atan2(sqrt(CUT2) * alpha, 1);
    double low = -reach, high = fmin(reach, KI_PI / 2 - psi_v);
    bool logarithmic = psi_v < reach;
    if (logarithmic) {
        low = ki_log(psi_v);
        high = ki_log(2 * psi_v + high);
    }
    int panels = logarithmic ? 2 + (int)((high - low) / 1.5) : 3;
    double sum[2] = {0};
    for (int i = 0; i < 16 * panels; i++) {
        double step = (high - low) / (2 * panels), weight = ki_gauss16_weights[i % 16] * step;
        int panel = i / 16;
        double x = low + step * (2 * panel + 1 + ki_gauss16_nodes[i % 16]);
        double delta = x;
        if (logarithmic) {
            double total = ki_exp(x);
            delta = total - 2 * psi_v;
            weight *= total;
        }
        // nol = sin(psi_v + delta) by the addition theorem: rounding the sum psi_v + delta would
        // lose the digits of delta where the lobe is narrow.
        double half_sine, half_cosine;
        ki_sincos(delta / 2, &half_sine, &half_cosine);
        double tangent = half_sine / half_cosine, turn = 2 * half_sine * half_cosine;
        double straight = 1 - 2 * half_sine * half_sine;
        double nol = fmax(0, nov * straight + sine_v * turn);
        double sine_l = fmax(0, sine_v * straight - nov * turn);
        double s = nov + nol;
        weight *= sine_l * nol * ki_visibility(model, roughness, nov, nol) / 4;
        integrate_azimuth(alpha, tangent * tangent, 4 * sine_v * sine_l / (s * s), s, weight, sum);
    }
    ab[0] = sum[0] - sum[1];
    ab[1] = sum[1];
}
