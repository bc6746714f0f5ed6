// The kernel ki_energy_row for GGX. In: one roughness and `count` cosines of the view. Out: the
// albedo E, or A and B of the split sum, for each cosine. Files that are compiled for one
// instruction set each define KI_ROW, the kernel's name, and include this file. The loops over
// sixteen nodes are plain C that compilers vectorise.
//
// With o the view, i the light, mu and mu_i the cosines of o and i to the normal, s = 1 - alpha^2
// and S = mu + mu_i, the integral over the azimuth phi has a closed form (derived in
// docs/theory/energy.md):
//
//     E = int_0^1 G / (4 mu) [int_0^2pi D dphi] dmu_i,
//     int D dphi = 2 alpha^2 (1 + 2 s S / Q + s^2 S P / Q^3),
//     P = sin^2 o + sin^2 i + alpha^2 S^2,
//     Q^2 = (s (mu_i - mu) - 2 alpha^2 mu)^2 + 4 alpha^2 sin^2 o.
//
// The integral over mu_i is cut into two intervals, at max(mu, alpha) / 2, and each interval into
// panels of a 16-point Gauss-Legendre rule. In the first interval mu_i = c (e^u - 1), with nodes
// evenly in u, where -c is the pole of G nearest to 0. In the second mu_i = m + d sinh t, with
// nodes evenly in t, which makes Q = s d cosh t for m = mu (1 + alpha^2) / s and d = 2 alpha sin o
// / s. For alpha > 0.7 the second interval is one panel, with nodes evenly in mu_i.
#include "brdf/energy.h"

#include "math/math.h"

#include <math.h>

enum { NODES = 16, HALF = NODES / 2 };

// Greatest length of a quadrature panel in the integration variables u and t. The integrand's poles
// are at least pi/2 away from the real axis, so that the 16-point rule's relative error is 1e-12 at
// this length.
#define PANEL 2.5

// Positive nodes of the 16-point Gauss-Legendre rule and their weights. The other eight nodes are
// the negatives. Abramowitz and Stegun, table 25.4.
static const double node[HALF] = {
    0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863, 0.6178762444026437484,
    0.7554044083550030339, 0.8656312023878317439, 0.9445750230732325761, 0.9894009349916499326};
static const double weight[HALF] = {
    0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382, 0.1495959888165767321,
    0.1246289712555338720, 0.0951585116824927848, 0.0622535239386478929, 0.0271524594117540949};

// The quantities that depend on the model, the roughness and the view only.
typedef struct view {
    kiln_g g;
    double alpha, alpha2, s; // roughness^2, alpha^2 and 1 - alpha^2
    double mu, sin2, sine;   // cosine mu of the view, 1 - mu^2 and its square root
    double k;                // k of Schlick's masking G1(x) = x / (x (1 - k) + k)
    double root;  // sqrt(alpha^2 + s mu^2), which is mu (1 + 2 Lambda) of Smith's masking
    double front; // the factor of masking G / mu that depends on the view and not on the light
    // cosine mu_i of the light at which the second of the two intervals of mu_i begins
    double split;
    double pole; // c, where the integrand's pole nearest to mu_i = 0 is at mu_i = -c
} view;

// The sixteen nodes of a quadrature panel: mu = mu_i, the cosine of the light; rest = 1 - mu_i;
// delta = mu_i minus the cosine of the view; q = Q of int D dphi; and the weight w. The two
// differences are kept because they have full precision where they are small.
typedef struct panel {
    double mu[NODES], rest[NODES], delta[NODES], q[NODES], w[NODES];
} panel;

static void view_set(view *v, const kiln_model *model, double roughness, double nov, bool split)
{
    v->g = model->g;
    v->alpha = roughness * roughness;
    v->alpha2 = v->alpha * v->alpha;
    v->s = (1 - v->alpha) * (1 + v->alpha);
    v->mu = nov;
    v->sin2 = (1 - nov) * (1 + nov);
    v->sine = sqrt(v->sin2);
    v->root = sqrt(v->alpha2 + v->s * nov * nov);
    v->k = v->g == KILN_G_SCHLICK_K2 ? v->alpha / 2 : (roughness + 1) * (roughness + 1) / 8;
    switch (v->g) {
    case KILN_G_SMITH:
        v->front = 2;
        v->pole = nov * v->alpha / v->root;
        break;
    case KILN_G_SMITH_UNCORRELATED:
        v->front = 4 / (nov + v->root);
        v->pole = v->alpha;
        break;
    default: // Schlick's masking with the k of either KILN_G_SCHLICK model
        v->front = 1 / (nov * (1 - v->k) + v->k);
        v->pole = v->k / (1 - v->k);
        break;
    }
    // The integrand of B of the split sum is singular, as a logarithm, where the light's cosine
    // mu_i is minus the view's cosine mu.
    if (split && v->pole > nov)
        v->pole = nov;
    v->split = (nov > v->alpha ? nov : v->alpha) / 2;
    // A pole of the integrand nearer to mu_i = 0, for the light's cosine mu_i, than 1e-12 of the
    // first interval's length has the same effect as one at that distance.
    v->pole = ki_clamp(v->pole, 1e-12 * v->split, 1);
}

// ------------------------------------------------------------------------------------------- nodes

// sinh and cosh of h times the eight positive quadrature nodes, |h| <= 1.25, by Taylor polynomials
// of degree 21 and 20. The first omitted term of each is below 1e-19.
static void hyperbolic(double h, double sinh_y[HALF], double cosh_y[HALF])
{
    for (int j = 0; j < HALF; j++) {
        double y = h * node[j], z = y * y;
        double p = 1.0 / 51090942171709440000.0, c = 1.0 / 2432902008176640000;
        p = p * z + 1.0 / 121645100408832000;
        c = c * z + 1.0 / 6402373705728000;
        p = p * z + 1.0 / 355687428096000;
        c = c * z + 1.0 / 20922789888000;
        p = p * z + 1.0 / 1307674368000;
        c = c * z + 1.0 / 87178291200;
        p = p * z + 1.0 / 6227020800;
        c = c * z + 1.0 / 479001600;
        p = p * z + 1.0 / 39916800;
        c = c * z + 1.0 / 3628800;
        p = p * z + 1.0 / 362880;
        c = c * z + 1.0 / 40320;
        p = p * z + 1.0 / 5040;
        c = c * z + 1.0 / 720;
        p = p * z + 1.0 / 120;
        c = c * z + 1.0 / 24;
        p = p * z + 1.0 / 6;
        c = c * z + 1.0 / 2;
        sinh_y[j] = y + y * (z * p);
        cosh_y[j] = 1 + z * c;
    }
}

// Sets delta, the light's cosine mu_i minus the view's, and Q, the root in int D dphi, at nodes
// whose mu_i is known. Called where the nodes are not evenly spaced in t with mu_i = m + d sinh t,
// for which Q is s d cosh t.
static void finish_nodes(const view *v, panel *p)
{
    double back = 2 * v->alpha2 * v->mu, wide = 4 * v->alpha2 * v->sin2;
    for (int j = 0; j < NODES; j++) {
        p->delta[j] = p->mu[j] - v->mu;
        double x = v->s * p->delta[j] - back;
        p->q[j] = sqrt(x * x + wide);
    }
}

// Sets the nodes of a panel of the first interval of the light's cosine mu_i, where mu_i = c (e^u -
// 1) with c = v->pole. The panel goes from u0 - h to u0 + h, and `centre` is e^u0. sinh_y and
// cosh_y are the functions of h times the eight positive quadrature nodes.
static void log_nodes(const view *v, double h, double centre, const double *sinh_y,
                      const double *cosh_y, panel *p)
{
    double c = v->pole;
    for (int j = 0; j < HALF; j++) {
        double low = centre * (cosh_y[j] - sinh_y[j]), high = centre * (cosh_y[j] + sinh_y[j]);
        p->mu[j] = c * (low - 1);
        p->mu[j + HALF] = c * (high - 1);
        p->w[j] = weight[j] * h * c * low;
        p->w[j + HALF] = weight[j] * h * c * high;
    }
    for (int j = 0; j < NODES; j++)
        p->rest[j] = 1 - p->mu[j];
    finish_nodes(v, p);
}

// Sets the nodes of the second interval of mu_i, the light's cosine, as one panel with nodes evenly
// in mu_i from v->split to 1. Only alpha > 0.7 uses this panel, where the integrand has no pole
// near the interval.
static void even_nodes(const view *v, panel *p)
{
    double h = (1 - v->split) / 2;
    for (int j = 0; j < HALF; j++) {
        p->rest[j] = h * (1 + node[j]);
        p->rest[j + HALF] = h * (1 - node[j]);
        p->w[j] = p->w[j + HALF] = weight[j] * h;
    }
    for (int j = 0; j < NODES; j++)
        p->mu[j] = 1 - p->rest[j];
    finish_nodes(v, p);
}

// The parameters of the substitution mu_i = m + d sinh t in the second interval of mu_i, the cosine
// of the light.
typedef struct stretch {
    double m_rest; // 1 - m, where m is the centre of the peak of D, as a cosine of the light
    double ahead;  // m - mu, where mu is the cosine of the view
    double d;      // width of the peak of D as a function of the light's cosine
} stretch;

// Sets the nodes of a panel of the second interval of the light's cosine mu_i, where mu_i = m + d
// sinh t. The panel goes from t0 - h to t0 + h, and `centre` is e^t0. sinh_y and cosh_y are the
// functions of h times the eight positive quadrature nodes.
static void sinh_nodes(const view *v, const stretch *x, double h, double centre,
                       const double *sinh_y, const double *cosh_y, panel *p)
{
    double sinh_c = (centre - 1 / centre) / 2, cosh_c = (centre + 1 / centre) / 2;
    double m = v->mu + x->ahead;
    for (int j = 0; j < HALF; j++) {
        double even = sinh_c * cosh_y[j], odd = cosh_c * sinh_y[j];
        double even_c = cosh_c * cosh_y[j], odd_c = sinh_c * sinh_y[j];
        double low = x->d * (even - odd), high = x->d * (even + odd);
        double low_c = x->d * (even_c - odd_c), high_c = x->d * (even_c + odd_c);
        p->mu[j] = m + low;
        p->mu[j + HALF] = m + high;
        // Rounding can make the difference 1 - mu_i negative where the light's cosine mu_i is near
        // 1.
        double rest_low = x->m_rest - low, rest_high = x->m_rest - high;
        p->rest[j] = rest_low > 0 ? rest_low : 0;
        p->rest[j + HALF] = rest_high > 0 ? rest_high : 0;
        p->delta[j] = x->ahead + low;
        p->delta[j + HALF] = x->ahead + high;
        p->q[j] = v->s * low_c;
        p->q[j + HALF] = v->s * high_c;
        p->w[j] = weight[j] * h * low_c;
        p->w[j + HALF] = weight[j] * h * high_c;
    }
}

// -------------------------------------------------------------------------------------- integrands

// Splits quadrature weight times G / (4 mu), with the masking G and the view's cosine mu, into a
// quotient top / bottom at each node, so that the integrand needs one division only.
static void masking(const view *v, const panel *p, double top[NODES], double bottom[NODES])
{
    double front = v->front / 4, k = v->k;
    for (int j = 0; j < NODES; j++)
        top[j] = p->w[j] * front * p->mu[j];
    switch (v->g) {
    case KILN_G_SMITH:
        for (int j = 0; j < NODES; j++) {
            double mu = p->mu[j];
            bottom[j] = mu * v->root + v->mu * sqrt(v->alpha2 + v->s * mu * mu);
        }
        break;
    case KILN_G_SMITH_UNCORRELATED:
        for (int j = 0; j < NODES; j++) {
            double mu = p->mu[j];
            bottom[j] = mu + sqrt(v->alpha2 + v->s * mu * mu);
        }
        break;
    default:
        for (int j = 0; j < NODES; j++)
            bottom[j] = p->mu[j] * (1 - k) + k;
        break;
    }
}

// Adds the terms of the albedo E at the sixteen nodes of a panel to eight sums, one for each lane
// of vectors.
static void add_e(const view *v, const panel *p, const double top[NODES],
                  const double bottom[NODES], double sum[HALF])
{
    double term[NODES];
    for (int j = 0; j < NODES; j++) {
        double mu = p->mu[j], total = v->mu + mu, a = v->s * total, q = p->q[j], q2 = q * q;
        double big_p = v->sin2 + p->rest[j] * (1 + mu) + v->alpha2 * (total * total);
        term[j] =
            top[j] * 2 * v->alpha2 * (q2 * (q + 2 * a) + v->s * a * big_p) / (bottom[j] * (q2 * q));
    }
    for (int j = 0; j < HALF; j++)
        sum[j] += term[j] + term[j + HALF];
}

// Number of steps after which the arithmetic-geometric mean of 1 and kc has converged to 1e-16.
static int mean_steps(double kc)
{
    return kc > 0.55 ? 4 : kc > 0.09 ? 5 : kc > 1.8e-3 ? 6 : kc > 8e-7 ? 7 : kc > 1.7e-13 ? 8 : 9;
}

// Complete elliptic integrals over x from 0 to pi/2, for kc and p, with Y^2 = cos^2 x + kc^2 sin^2
// x and
// W = cos^2 x + p sin^2 x:
//
//     cel = int Y / W dx,   slope = d cel / dp,   k = int 1 / Y dx,   e = int Y dx.
//
// cel is computed by Bulirsch's iteration (1965), which adds positive numbers only, and slope by
// the same iteration differentiated by p. k and e follow from the arithmetic-geometric mean of 1
// and kc: after n steps em and qc are 2^n times the arithmetic and the geometric mean.
typedef struct elliptic {
    double cel[NODES], slope[NODES], k[NODES], e[NODES];
} elliptic;

// Computes the complete elliptic integrals of `elliptic` for kc2 = kc^2 and p0 = p. A d before a
// variable's name denotes the derivative by p.
static void elliptic_integrals(const double kc2[NODES], const double p0[NODES], int steps,
                               elliptic *out)
{
    double a[NODES], da[NODES], b[NODES], db[NODES], p[NODES], dp[NODES];
    double em[NODES], qc[NODES], ee[NODES], sum[NODES];
    for (int j = 0; j < NODES; j++) {
        double root = sqrt(p0[j]), inverse = 1 / root;
        p[j] = root;
        dp[j] = 0.5 * inverse;
        a[j] = 1;
        da[j] = 0;
        b[j] = kc2[j] * inverse;
        db[j] = -b[j] * inverse * dp[j];
        em[j] = 1;
        qc[j] = ee[j] = sqrt(kc2[j]);
        sum[j] = 0.5 * (1 - kc2[j]);
    }
    // The integral e is k * (1 - sum). Step n, from 0 on, adds to sum 2^n times the square of half
    // the difference of the two means. As em and qc are 2^n times the means, the summand is
    // scale * (em - qc)^2 with scale = 2^n / (2^(n + 1))^2, which is 1 / 4 in step 0.
    double scale = 0.25;
    for (int step = 0; step < steps; step++, scale /= 2)
        for (int j = 0; j < NODES; j++) {
            double f = a[j], df = da[j], inverse = 1 / p[j];
            double d_inverse = -inverse * inverse * dp[j];
            a[j] += b[j] * inverse;
            da[j] += db[j] * inverse + b[j] * d_inverse;
            double g = ee[j] * inverse, dg = ee[j] * d_inverse;
            b[j] = 2 * (b[j] + f * g);
            db[j] = 2 * (db[j] + df * g + f * dg);
            p[j] += g;
            dp[j] += dg;
            double c = em[j] - qc[j];
            sum[j] += scale * c * c;
            em[j] += qc[j];
            qc[j] = 2 * sqrt(ee[j]);
            ee[j] = qc[j] * em[j];
        }
    double power = ldexp(1, steps);
    for (int j = 0; j < NODES; j++) {
        double inverse = 1 / (em[j] * (em[j] + p[j])), value = (b[j] + a[j] * em[j]) * inverse;
        out->cel[j] = KI_PI / 2 * value;
        out->slope[j] = KI_PI / 2 * (db[j] + da[j] * em[j] - value * em[j] * dp[j]) * inverse;
        out->k[j] = KI_PI / 2 * power / em[j];
        out->e[j] = out->k[j] * (1 - sum[j]);
    }
}

// Adds the terms of B at the sixteen nodes of a panel to eight sums, one for each lane of vectors.
// The integrand of B has D (1 - c)^5 where that of E has D, with c = o.h = sqrt(z) / 2 and z = 2 (1
// + o.i). With W = P + q cos phi, q = 2 sin o sin i and a = s S^2, which give z = W + a,
//
//     D (1 - c)^5 = alpha^2 / (pi W^2) [z^2 + 5/2 z^3 + 5/16 z^4 -
//                   sqrt(z) / 2 (5 z^2 + 5/2 z^3 + z^4 / 16)]
//
// is integrated over phi after z is replaced by W + a. The terms without sqrt(z) become powers of W
// from W^-2 to W^2, which integrate in closed form as for E (`even`). The terms with sqrt(z) become
// complete elliptic integrals (`odd`): i1, i3 and i5 of sqrt(z), sqrt(z)^3 and sqrt(z)^5, and j1
// and j2 of sqrt(z) / W and sqrt(z) / W^2.
static void add_b(const view *v, const panel *p, const double top[NODES],
                  const double bottom[NODES], double sum[HALF])
{
    double total_a[NODES], big_p[NODES], q[NODES], w1[NODES], kc2[NODES], p0[NODES];
    for (int j = 0; j < NODES; j++) {
        double mu = p->mu[j], total = v->mu + mu, s2 = total * total, sin2 = p->rest[j] * (1 + mu);
        double sine = sqrt(sin2), spread = p->delta[j] * total / (sine + v->sine + 1e-300);
        // P - q, the least value over phi of W = P + q cos phi
        double w0 = spread * spread + v->alpha2 * s2;
        total_a[j] = v->s * s2;
        big_p[j] = v->sin2 + sin2 + v->alpha2 * s2;
        q[j] = 2 * v->sine * sine;
        w1[j] = big_p[j] + q[j];
        kc2[j] = (w0 + total_a[j]) / (w1[j] + total_a[j]);
        p0[j] = w0 / w1[j];
    }
    elliptic x;
    elliptic_integrals(kc2, p0, mean_steps(sqrt(kc2[HALF - 1])), &x);
    double term[NODES];
    for (int j = 0; j < NODES; j++) {
        double a = total_a[j], a2 = a * a, y1 = w1[j] + a, root = 4 * sqrt(y1);
        double j1 = root / w1[j] * x.cel[j];
        double j2 = root / (w1[j] * w1[j]) * (x.cel[j] - 2 * q[j] / w1[j] * x.slope[j]);
        double i3 = (2 * (1 + kc2[j]) * x.e[j] - kc2[j] * x.k[j]) / 3;
        double i5 = (4 * (1 + kc2[j]) * i3 - 3 * kc2[j] * x.e[j]) / 5;
        double i1 = root * x.e[j];
        i3 *= root * y1;
        i5 *= root * y1 * y1;
        double odd = a2 * (5 + 2.5 * a + a2 / 16) * j2 + a * (10 + 7.5 * a + a2 / 4) * j1 +
                     (5 + 7.5 * a + 0.375 * a2) * i1 + (2.5 + 0.25 * a) * (i3 - a * i1) +
                     (i5 - 2 * a * i3 + a2 * i1) / 16;
        double inverse = 1 / (p->q[j] * (v->mu + p->mu[j])), b = big_p[j];
        double even = a2 * (1 + 2.5 * a + 0.3125 * a2) * b * inverse * inverse * inverse +
                      a * (2 + 7.5 * a + 1.25 * a2) * inverse + (1 + 7.5 * a + 1.875 * a2) +
                      (2.5 + 1.25 * a) * b + 0.3125 * (b * b + q[j] * q[j] / 2);
        term[j] = top[j] * v->alpha2 / KI_PI * (2 * KI_PI * even - odd / 2) / bottom[j];
    }
    for (int j = 0; j < HALF; j++)
        sum[j] += term[j] + term[j + HALF];
}

// --------------------------------------------------------------------------------------- integrals

// Adds the eight sums of the albedo E, or of B of the split sum, in an order that does not depend
// on the width of vectors.
static double sum_lanes(const double x[HALF])
{
    return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

static void add(const view *v, const panel *p, double e[HALF], double b[HALF], bool split)
{
    double top[NODES], bottom[NODES];
    masking(v, p, top, bottom);
    add_e(v, p, top, bottom, e);
    if (split)
        add_b(v, p, top, bottom, b);
}

// An interval of a quadrature variable x, cut into `count` panels of equal length. x is u or t, in
// which the light's cosine is mu_i = c (e^u - 1) or mu_i = m + d sinh t.
typedef struct tiling {
    double from;     // e^x at the lower end of the interval of x
    double ratio;    // e^x at the upper end of the interval over e^x at its lower end
    double h, ahead; // h: half the length of a panel in x; ahead: e^h
    int count;
} tiling;

// The integral for one cosine of the view: its constants, and its intervals `near` and `far` of
// mu_i, the cosine of the light.
typedef struct entry {
    view v;
    stretch x;
    tiling near, far;
} entry;

static void entry_set(entry *n, const kiln_model *model, double roughness, double nov, bool split)
{
    view *v = &n->v;
    view_set(v, model, roughness, nov, split);
    n->near = (tiling){.from = 1, .ratio = 1 + v->split / v->pole};
    n->far = (tiling){.from = 1, .ratio = 1};
    if (v->alpha > 0.7)
        return; // the function even_nodes computes the second interval for this alpha
    n->x.m_rest = ((1 - nov) - v->alpha2 * (1 + nov)) / v->s;
    n->x.ahead = 2 * v->alpha2 * nov / v->s;
    double d = 2 * v->alpha * v->sine / v->s;
    n->x.d = d > 1e-120 ? d : 1e-120;
    // e^t at both ends of the second interval of the light's cosine mu_i, from mu_i = m + d sinh t.
    double low = (v->split - nov - n->x.ahead) / n->x.d, high = n->x.m_rest / n->x.d;
    double root_low = sqrt(low * low + 1), root_high = sqrt(high * high + 1);
    double to = high > 0 ? high + root_high : 1 / (root_high - high);
    n->far.from = low > 0 ? low + root_low : 1 / (root_low - low);
    n->far.ratio = to / n->far.from;
}

static void tile(tiling *t)
{
    double length = ki_log(t->ratio);
    t->count = (int)ceil(length / PANEL);
    t->h = length / (2 * (t->count > 0 ? t->count : 1));
    t->ahead = ki_exp(t->h);
}

// Integrates over both intervals of the light's cosine mu_i. Sets out[0] to the albedo E and, with
// `split`, out[1] to B of the split sum.
static void integrate(const entry *n, bool split, double out[2])
{
    double e[HALF] = {0}, b[HALF] = {0}, sinh_y[HALF], cosh_y[HALF];
    const view *v = &n->v;
    panel p;
    double step = n->near.ahead * n->near.ahead, centre = n->near.from * n->near.ahead;
    hyperbolic(n->near.h, sinh_y, cosh_y);
    for (int i = 0; i < n->near.count; i++, centre *= step) {
        log_nodes(v, n->near.h, centre, sinh_y, cosh_y, &p);
        add(v, &p, e, b, split);
    }
    if (v->alpha > 0.7) {
        even_nodes(v, &p);
        add(v, &p, e, b, split);
    }
    step = n->far.ahead * n->far.ahead, centre = n->far.from * n->far.ahead;
    hyperbolic(n->far.h, sinh_y, cosh_y);
    for (int i = 0; i < n->far.count; i++, centre *= step) {
        sinh_nodes(v, &n->x, n->far.h, centre, sinh_y, cosh_y, &p);
        add(v, &p, e, b, split);
    }
    out[0] = sum_lanes(e);
    out[1] = sum_lanes(b);
    // B of the split sum tends to 0 for smooth surfaces at normal incidence, nov = 1, where
    // rounding can make it negative.
    out[1] = out[1] > 0 ? out[1] : 0;
}

// The albedo E and B of the split sum at roughness 0: all light goes to the mirror direction. The
// masking G is 1 there, except for KILN_G_SCHLICK_TEXT, whose k is not 0 at roughness 0.
static void mirror(const view *v, double out[2])
{
    double g1 = v->mu / (v->mu * (1 - v->k) + v->k), c = 1 - v->mu;
    out[0] = v->g == KILN_G_SCHLICK_TEXT ? g1 * g1 : 1;
    out[1] = out[0] * (c * c) * (c * c) * c;
}

// An entry is one cosine of the view. Entries are prepared in blocks, so that the processor
// overlaps the computation of their logarithms and exponentials.
void KI_ROW(const kiln_model *model, double roughness, const double *nov, int count, bool split,
            double *out)
{
    enum { BLOCK = 16 };
    bool mirrors = roughness < 1e-15;
    for (int from = 0; from < count; from += BLOCK) {
        entry block[BLOCK];
        int n = ki_min(BLOCK, count - from);
        for (int i = 0; i < n; i++)
            entry_set(&block[i], model, roughness, nov[from + i], split);
        for (int i = 0; i < n && !mirrors; i++) {
            tile(&block[i].near);
            tile(&block[i].far);
        }
        for (int i = 0; i < n; i++) {
            double both[2];
            if (mirrors)
                mirror(&block[i].v, both);
            else
                integrate(&block[i], split, both);
            if (split) {
                *out++ = both[0] - both[1];
                *out++ = both[1];
            } else {
                *out++ = both[0];
            }
        }
    }
}
