// The shares R and T of light from one direction that a rough boundary between two dielectrics
// reflects and transmits. In: model, roughness, ior and the cosine n.v. Out: R and T, by quadrature
// over half vectors. docs/theory/glass.md derives the integrals and states their errors.
//
// With half vectors h over the microfacets, F the exact Fresnel term and c = v.h,
//
//     R(v) = int D F c G(v, l) / (n.v) dh,            l = 2 c h - v,
//     T(v) = int D (1 - F) c G(v, l) / (n.v) dh,      l = (eta c - g) h - eta v,
//
// where eta = 1 / ior, and g = sqrt(1 - eta^2 (1 - c^2)) is the cosine of refraction at the
// microfacet. These are eqs. 20, 21, 38 and 40 of Walter et al. 2007, whose Jacobians between h and
// l cancel.
//
// The outer integral is over theta, the angle of h to n, and the inner over phi, the azimuth of h
// from v. c falls as phi grows, and the integrands differ from 0 while c is large enough, that is
// up to some phi = reach: the inner integral is over one arc. Light reaches l if
//
//     reflected       n.l = 2 c cos theta - n.v > 0
//     transmitted     c > 0 and -n.l = eta n.v - (eta c - g) cos theta > 0
//
// If v is in the denser medium (ior < 1), facets with c <= critical = sqrt(1 - ior^2) reflect all
// light: F = 1. With the albedo E(v) = int D c G(v, l) / (n.v) dh of the lobe with F = 1
// (energy.h), the code then computes R as E minus the same integral with 1 - F in place of F. That
// integral, like T, is over the facets with c > critical.
#include "brdf/dielectric.h"

#include "base/base.h"
#include "brdf/beckmann.h"
#include "brdf/brdf.h"
#include "brdf/energy.h"
#include "math/math.h"

#include <math.h>

// ior is clamped to [LEAST_IOR, 1 / LEAST_IOR].
#define LEAST_IOR (1.0 / 16)

typedef enum part { REFLECTED, TRANSMITTED } part;

// The quantities that depend on the model, the roughness, the ior and the view, but not on the half
// vector.
typedef struct boundary {
    kiln_model model;
    double roughness, alpha, ior, eta; // eta = 1 / ior
    double mu, sin_v, theta_v;         // n.v, and the sine and angle of v to n
    // Cosine v.h below which a microfacet reflects all light: sqrt(1 - ior^2), or 0 for v in the
    // thinner medium.
    double critical;
    double lambda_v; // Smith's Lambda(v), for masking in transmission
    // n.v (1 + 2 Lambda(v)) with Smith's Lambda, for GGX with KILN_G_SMITH; 0 for other models
    double root_v;
    double pole; // G, as a function of n.l, has its pole nearest to 0 at about n.l = -pole
    double most; // upper bound of G(v, l) / (n.v)
    // Part of the reflected or transmitted share that a ring of half vectors (all h at one angle to
    // n) must hold to get 16 quadrature nodes instead of 8.
    double coarse;
} boundary;

// Smith's Lambda of a direction with this cosine to n. It is limited to 1e9, which ki_beta can
// take.
static double lambda(const boundary *s, double cosine)
{
    if (s->model.d == KILN_D_BECKMANN)
        return fmin(1e9, ki_beckmann_lambda(s->alpha, cosine));
    double root = sqrt(cosine * cosine + s->alpha * s->alpha * ((1 - cosine) * (1 + cosine)));
    return fmin(1e9, (root / cosine - 1) / 2);
}

// G / (n.v) of transmitted light. The view is masked by the surface above a microfacet, and
// transmitted light by the surface below it. With Smith's heights, u uniform in [0, 1], G is
// therefore the integral of u^Lambda(v) (1 - u)^Lambda(l) du, a beta function (Heitz et al. 2016,
// Dupuy et al. 2016). The three maskings other than KILN_G_SMITH are products G1(v) G1(l), for
// transmission as for reflection.
static double transmitted_masking(const boundary *s, double nol)
{
    if (s->model.g == KILN_G_SMITH)
        return ki_beta(1 + s->lambda_v, 1 + lambda(s, nol)) / s->mu;
    return nol * ki_visibility(&s->model, s->roughness, s->mu, nol);
}

// The exact Fresnel reflectance of ki_fresnel_dielectric, with a single division. `contrast` is 1 -
// ior^2, c the cosine of incidence, and `beyond` is ior times the cosine of refraction.
static double fresnel(double contrast, double c, double beyond)
{
    double s2 = (1 - c) * (1 + c), product = c * beyond, sum2 = (c + beyond) * (c + beyond);
    double below = sum2 * (product + s2);
    return fmin(1, contrast * contrast * (product * product + s2 * s2) / (below * below));
}

// The masking G / (n.v) of reflected light, where n.l = nol. For GGX with KILN_G_SMITH the formula
// uses root_v, which depends on the view only.
static double reflected_masking(const boundary *s, double nol)
{
    if (s->root_v > 0) {
        double root = sqrt(nol * nol + s->alpha * s->alpha * ((1 - nol) * (1 + nol)));
        return 2 * nol / (nol * s->root_v + s->mu * root);
    }
    return nol * ki_visibility(&s->model, s->roughness, s->mu, nol);
}

// The integrand of the reflected share R or the transmitted share T, without its factor D, for a
// half vector with n.h = cos_h and v.h = c. If v is in the denser medium, the integrand of R has 1
// - F in place of F.
static double facet(const boundary *s, part what, double cos_h, double c)
{
    double contrast = (1 - s->ior) * (1 + s->ior), g2 = c * c - contrast;
    if (!(c > s->critical && g2 > 0))
        return 0;
    c = fmin(c, 1);
    double beyond = sqrt(g2), f = fresnel(contrast, c, beyond);
    if (what == REFLECTED) {
        double nol = fmin(1, 2 * c * cos_h - s->mu);
        return nol > 0 ? (s->critical > 0 ? 1 - f : f) * c * reflected_masking(s, nol) : 0;
    }
    double nol = fmin(1, s->eta * (s->mu - (c - beyond) * cos_h));
    return nol > 0 ? (1 - f) * c * transmitted_masking(s, nol) : 0;
}

// Returns the phi at which cos phi = y, clamped to [0, pi].
static double arc_end(double y)
{
    return y >= 1 ? 0 : y <= -1 ? KI_PI : ki_acos(y);
}

// The distance in phi from `reach`, the end of an arc of azimuths, to a singularity of the
// integrand beyond that end, where cos phi is y - more. y is cos phi at the end of the arc, or
// below -1 where the arc is the half circle.
static double arc_margin(double y, double reach, double more)
{
    double sine = ki_sin(reach);
    double margin =
        y < -1 ? sqrt(2 * (more - 1 - y)) : 2 * more / (sine + sqrt(sine * sine + 2 * more));
    return ki_clamp(margin, 1e-9, 1e3);
}

enum { NODES = 16 };

// cos x for x in [0, pi] with an error below 1e-13: 1 - 2 sin^2(x / 2) by the Taylor series of the
// sine.
static double arc_cosine(double x)
{
    double half = x / 2, y = half * half, p = 1.0 / 355687428096000;
    p = p * y - 1.0 / 1307674368000;
    p = p * y + 1.0 / 6227020800;
    p = p * y - 1.0 / 39916800;
    p = p * y + 1.0 / 362880;
    p = p * y - 1.0 / 5040;
    p = p * y + 1.0 / 120;
    p = p * y - 1.0 / 6;
    double sine = half + half * (y * p);
    return 1 - 2 * sine * sine;
}

// Integrates facet() over the arc 0 <= phi < reach of the half vectors h at one angle to n, whose
// sine and cosine are h[0] and h[1]. The integrand has a singularity at the distance `margin`
// beyond the arc's end, so the quadrature nodes are closer towards the end: margin + reach - phi =
// margin (1 + slope x)^16 with x evenly spaced in [0, 1]. The 16th power is nearly an exponential
// and costs four products. With `root` the integrand behaves as a square root at the end itself. x
// = y^2 with y evenly spaced removes this root. With `coarse` a panel has 8 nodes instead of 16.
static double integrate_arc(const boundary *s, part what, const double h[2], double reach,
                            double margin, bool root, bool coarse)
{
    if (!(reach > 0))
        return 0;
    double slope = sqrt(sqrt(sqrt(sqrt(1 + reach / margin)))) - 1, sum = 0;
    const double *nodes = coarse ? ki_gauss8_nodes : ki_gauss16_nodes;
    const double *weights = coarse ? ki_gauss8_weights : ki_gauss16_weights;
    int panels = 1 + (int)(slope / 0.17), count = coarse ? NODES / 2 : NODES;
    for (int i = 0; i < count * panels; i++) {
        int panel = i / count;
        double x = (panel + (1 + nodes[i % count]) / 2) / panels;
        double weight = weights[i % count];
        if (root) {
            weight *= 2 * x;
            x *= x;
        }
        double step = 1 + slope * x, p2 = step * step, p4 = p2 * p2, p8 = p4 * p4;
        double from_end = margin * (p8 * p8);
        double c = h[1] * s->mu + h[0] * s->sin_v * arc_cosine(reach + margin - from_end);
        sum += weight * from_end / step * facet(s, what, h[1], c);
    }
    return 16 * slope / panels * sum;
}

// The inner integral, over a ring of half vectors: all half vectors h at one angle to n, whose sine
// and cosine are h[0] and h[1]. Finds the end of the arc of azimuths from which light is reflected
// or transmitted, and the singularity nearest to that end. `coarse` marks a ring with little
// influence on the result.
static double ring(const boundary *s, part what, const double h[2], bool coarse)
{
    double k = s->sin_v * h[0], least = h[1] * s->mu; // v.h = least + k cos phi at azimuth phi
    double critical = (s->critical - least) / k, y, pole;
    if (what == REFLECTED) {
        y = (s->mu / (2 * h[1]) - least) / k;
        pole = s->pole / (2 * h[1] * k);
    } else {
        y = -least / k;
        pole = fmin(s->pole, 0.5 * sqrt(fabs(s->ior - 1)) + 1e-3) / (h[1] * k);
        // If v is in the denser medium, transmitted light has n.l = 0 at v.h = (m^2 + eta^2 - 1) /
        // (2 eta m), where m = eta n.v / cos theta, eta = 1 / ior, and theta is the angle of h to
        // n.
        double m = s->eta * s->mu / h[1], m2 = s->eta * s->eta - 1;
        y = s->critical > 0 && m * m < m2 ? ((m * m + m2) / (2 * s->eta * m) - least) / k : y;
        pole = s->critical > 0 ? s->pole / (h[1] * k) : pole;
    }
    if (!(s->critical > 0)) {
        double reach = arc_end(y);
        return integrate_arc(s, what, h, reach, arc_margin(y, reach, pole), false, coarse);
    }
    // If v is in the denser medium, 1 - F behaves as a square root near the critical angle. The arc
    // ends there, unless the condition n.l > 0 ends it earlier.
    if (y <= critical) {
        double reach = arc_end(critical);
        double margin = fmax(arc_margin(critical, reach, 0), reach / 20);
        return integrate_arc(s, what, h, reach, margin, true, coarse);
    }
    double reach = arc_end(y), margin = fmax(reach / 20, arc_margin(y, reach, y - critical));
    return integrate_arc(s, what, h, reach, fmin(margin, arc_margin(y, reach, pole)), true, coarse);
}

// D(h) sin theta, where theta is the angle of h to n, and h[0] and h[1] are its sine and cosine.
static double density(const boundary *s, const double h[2])
{
    double a2 = s->alpha * s->alpha, s2 = h[0] * h[0], c2 = h[1] * h[1];
    if (s->model.d == KILN_D_BECKMANN)
        return h[0] * ki_exp(-s2 / (a2 * c2)) / (KI_PI * a2 * c2 * c2);
    double d = a2 * c2 + s2;
    return h[0] * a2 / (KI_PI * d * d);
}

// The outer integral, over the angle theta of half vectors to n, between `from` and `to`. At these
// angles the arc of azimuths that ring() integrates over opens, closes or changes the condition
// that limits it. D is narrow, and theta = width sinh(x) spreads its peak over x. The arc's length
// behaves as a square root at both ends, so x is a polynomial of the quadrature variable with zero
// slope there.
static double integrate_rings(const boundary *s, part what, double from, double to)
{
    double width = fmin(s->alpha, fmax(s->mu, 0.1 * s->alpha)), sum = 0;
    double a = from / width, b = to / width;
    a = ki_log(a + sqrt(1 + a * a));
    b = ki_log(b + sqrt(1 + b * b));
    int panels = s->model.d == KILN_D_BECKMANN ? 2 + (int)(b - a) : 1 + (int)((b - a) / 2);
    for (int i = 0; i < NODES * panels; i++) {
        int panel = i / NODES;
        double x = (panel + (1 + ki_gauss16_nodes[i % NODES]) / 2) / panels;
        double weight = ki_gauss16_weights[i % NODES] / (2 * panels) * (b - a) * width / 2;
        weight *= from > 0 ? 6 * x * (1 - x) : 2 * (1 - x);
        x = from > 0 ? x * x * (3 - 2 * x) : x * (2 - x);
        double e = ki_exp(a + (b - a) * x), h[2];
        ki_sincos(width * (e - 1 / e) / 2, &h[0], &h[1]);
        weight *= (e + 1 / e) * density(s, h);
        double most = weight * 2 * KI_PI * (h[1] * s->mu + h[0] * s->sin_v) * s->most;
        if (most > 1e-10)
            sum += weight * ring(s, what, h, most < s->coarse);
    }
    return sum;
}

// Integrates the reflected share R or the transmitted share T over all half vectors: cuts the range
// of their angle theta to n at the angles where ring()'s arc of azimuths opens, closes or changes
// its limiting condition, and adds the integrals between the cuts.
static double integrate_part(const boundary *s, part what)
{
    double elevation = KI_PI / 2 - s->theta_v, start = 0, end = KI_PI / 2, cuts[6];
    int count = 0;
    cuts[count++] = what == REFLECTED ? elevation / 2 : elevation;
    if (what == REFLECTED) {
        // If the view is near the horizon, a cut near `end` separates the light that leaves at
        // grazing angles, n.l near 0, which is close to the pole of G.
        end = (KI_PI - elevation) / 2;
        cuts[count++] = elevation < 0.05 ? end - 8 * elevation : end;
    }
    if (s->critical > 0) {
        double total = ki_acos(s->critical), sine, cosine;
        end = fmin(end, s->theta_v + total);
        cuts[count++] = fabs(s->theta_v - total);
        double crossing = what == REFLECTED ? s->mu / (2 * s->critical) : s->mu / s->critical;
        if (crossing < 1)
            cuts[count++] = ki_acos(crossing);
        if (s->theta_v > total && what == REFLECTED)
            start = s->theta_v - total;
        if (s->theta_v > total && what == TRANSMITTED) {
            // The smallest theta at which refracted light can leave: there it runs along the
            // surface, turned by the view's elevation.
            ki_sincos(elevation, &sine, &cosine);
            start = s->theta_v - ki_atan2(sine, s->eta - cosine);
        }
    }
    double sum = 0, from = fmax(0, start);
    for (;;) { // takes the cuts of the range of theta, the angle of h to n, in increasing order
        double to = end;
        for (int i = 0; i < count; i++)
            if (cuts[i] > from && cuts[i] < to)
                to = cuts[i];
        if (to > from)
            sum += integrate_rings(s, what, from, to);
        if (!(to < end))
            return sum;
        from = to;
    }
}

// The reflected share R and the transmitted share T of a smooth boundary: the Fresnel term F and 1
// - F, times the masking G, which differs from 1 only for KILN_G_SCHLICK_TEXT.
static void smooth(const kiln_model *model, double ior, double nov, double rt[2])
{
    nov = nov > 1e-150 ? nov : 0; // the square of a smaller cosine would underflow
    double f = ki_fresnel_dielectric(ior, nov);
    double beyond = sqrt(fmax(0, 1 - (1 - nov) * (1 + nov) / (ior * ior)));
    rt[0] = f * ki_masking(model, 0, nov, nov);
    rt[1] = f < 1 ? (1 - f) * ki_masking(model, 0, nov, beyond) : 0;
}

// Fills `s` from arguments that are clamped to their ranges. Returns false for roughness below
// 1e-4, for which smooth() computes the shares R and T.
static bool prepare(const kiln_model *model, double roughness, double ior, double nov, boundary *s)
{
    *s = (boundary){.model = *model, .roughness = ki_clamp(roughness, 0, 1)};
    s->alpha = s->roughness * s->roughness;
    s->ior = ki_clamp(ior, LEAST_IOR, 1 / LEAST_IOR);
    s->eta = 1 / s->ior;
    s->mu = ki_clamp(nov, 1e-8 * s->alpha, 1);
    if (s->roughness < 1e-4)
        return false;
    s->sin_v = sqrt((1 - s->mu) * (1 + s->mu));
    s->theta_v = ki_acos(s->mu);
    s->critical = s->ior < 1 ? sqrt((1 - s->ior) * (1 + s->ior)) : 0;
    s->lambda_v = lambda(s, s->mu);
    if (model->d == KILN_D_GGX && model->g == KILN_G_SMITH)
        s->root_v = s->mu * (1 + 2 * s->lambda_v);
    s->most = 1 / fmax(s->mu, s->alpha / 8);
    s->coarse = model->d == KILN_D_BECKMANN ? 0 : 2e-3;
    s->pole = s->alpha;
    if (model->g == KILN_G_SMITH)
        s->pole = fmin(s->alpha, s->mu);
    if (model->g == KILN_G_SCHLICK_K2)
        s->pole = ki_schlick_k_ibl(s->alpha);
    if (model->g == KILN_G_SCHLICK_TEXT)
        s->pole = ki_schlick_k_direct(s->roughness);
    return true;
}

static double reflected(const boundary *s)
{
    double sum = integrate_part(s, REFLECTED);
    return s->critical > 0 ? fmax(0, ki_energy(&s->model, s->roughness, s->mu) - sum) : sum;
}

void kiln_glass(const kiln_model *model, double roughness, double ior, double nov, double rt[2])
{
    boundary s;
    if (!prepare(model, roughness, ior, nov, &s)) {
        smooth(model, s.ior, s.mu, rt);
        return;
    }
    rt[0] = reflected(&s);
    rt[1] = integrate_part(&s, TRANSMITTED);
}

double ki_dielectric_reflection(const kiln_model *model, double roughness, double ior, double nov)
{
    boundary s;
    double rt[2];
    if (prepare(model, roughness, ior, nov, &s))
        return reflected(&s);
    smooth(model, s.ior, s.mu, rt);
    return rt[0];
}

// The averages of the reflected and transmitted shares R and T under diffuse light, 2 int R mu dmu
// with mu = n.v. R and T change fast at grazing angles, at the critical angle, and where the cone
// of total reflection meets the horizon (n.v = ior). The integral is cut at these cosines, and a
// cubic substitution places more nodes near the cuts.
void kiln_glass_average(const kiln_model *model, double roughness, double ior, double rt[2])
{
    enum { PANELS = 2 };
    ior = ki_clamp(ior, LEAST_IOR, 1 / LEAST_IOR);
    double critical = ior < 1 ? sqrt((1 - ior) * (1 + ior)) : 0, open = ior < 1 ? ior : 0;
    double cuts[4] = {0, fmin(critical, open), fmax(critical, open), 1};
    rt[0] = rt[1] = 0;
    for (int i = 0; i < 3 * PANELS * NODES; i++) {
        int panel = i / NODES, third = panel / PANELS;
        double length = cuts[third + 1] - cuts[third], at[2];
        if (!(length > 0))
            continue;
        double x = (panel % PANELS + (1 + ki_gauss16_nodes[i % NODES]) / 2) / PANELS;
        double weight = ki_gauss16_weights[i % NODES] / (2 * PANELS) * 6 * x * (1 - x) * length;
        double mu = cuts[third] + length * (x * x * (3 - 2 * x));
        kiln_glass(model, roughness, ior, mu, at);
        for (int k = 0; k < 2; k++)
            rt[k] += 2 * mu * weight * at[k];
    }
}
