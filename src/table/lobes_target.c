// The lobe that taps approximate. In: a masking model, a roughness and n.v. Out: quadrature nodes
// over the lobe f(v, l) (n.l) / E with F = 1, the lobe's bands 0 to 2, and its covariance with each
// level's lobe as a function of the level's direction. Method: half vectors are placed in the cap
// of visible normals (brdf/sample.c), Gauss-Legendre along a radius and evenly around, up to the
// radius at which the mirrored view leaves the hemisphere. On these nodes the integrand is smooth.
#include "table/lobes.h"

#include "brdf/brdf.h"
#include "math/math.h"

#include <math.h>

// Mirrors the view at the half vector that belongs to xi. Returns false for light below the
// surface.
static bool mirror(double alpha, const double v[3], const double xi[2], double l[3])
{
    double h[3];
    ki_sample_visible(alpha, v, xi, h);
    double voh = v[0] * h[0] + v[1] * h[1] + v[2] * h[2];
    for (int c = 0; c < 3; c++)
        l[c] = 2 * voh * h[c] - v[c];
    return l[2] > 0;
}

// The largest x in [0, 1] such that light of xi = (phi, t^2) is above the surface for t < x.
static double horizon(double alpha, const double v[3], double phi)
{
    double low = 0, high = 1, l[3];
    if (mirror(alpha, v, (double[2]){phi, 1 - 1e-12}, l))
        return 1;
    for (int i = 0; i < 32; i++) {
        double middle = 0.5 * (low + high);
        *(mirror(alpha, v, (double[2]){phi, middle * middle}, l) ? &low : &high) = middle;
    }
    return low;
}

double ki_lobes_dominant(double roughness, double mirror)
{
    double alpha = roughness * roughness, f = (1 - alpha) * (sqrt(1 - alpha) + alpha);
    double sine, cosine;
    ki_sincos(mirror, &sine, &cosine);
    return ki_atan2(sine * f, 1 - f + cosine * f);
}

static double smallest_roughness(double roughness)
{
    return roughness > 0.01 ? roughness : 0.01;
}

// Sets nodes whose spokes are at (j + shift) / KI_LOBES_SPOKES of half a turn; the weights are not
// yet normalised. Returns their sum.
static double place_nodes(const kiln_model *model, double roughness, double nov, double shift,
                          ki_lobes_nodes *nodes)
{
    double x[KI_LOBES_RINGS], w[KI_LOBES_RINGS], sum = 0;
    ki_gauss_legendre(KI_LOBES_RINGS, x, w);
    double r = smallest_roughness(roughness), alpha = r * r;
    double v[3] = {-sqrt((1 - nov) * (1 + nov)), 0, nov};
    double g1 = ki_smith_g1_over_cosine(alpha, nov);
    nodes->count = 0;
    for (int j = 0; j < KI_LOBES_SPOKES; j++) {
        double phi = 0.5 * (j + shift) / KI_LOBES_SPOKES, end = horizon(alpha, v, phi);
        for (int i = 0; i < KI_LOBES_RINGS; i++) {
            double t = end * 0.5 * (1 + x[i]);
            double *l = nodes->direction[nodes->count];
            if (!mirror(alpha, v, (double[2]){phi, t * t}, l))
                continue;
            // The density of half vectors cancels D, so that f (n.l) / density = G / G1(v).
            double q = w[i] * end * t * l[2] * ki_visibility(model, r, nov, l[2]) / g1;
            nodes->weight[nodes->count++] = q;
            sum += q;
        }
    }
    return sum;
}

// Index and fraction of a chord's place in the tables of a chain, where `square` is the squared
// distance of two unit vectors.
static int table_place(double square, double *share)
{
    double place = KI_LOBES_STEPS * sqrt(0.5 * sqrt(ki_clamp(square, 0, 4)));
    int i = ki_min((int)place, KI_LOBES_STEPS - 1);
    *share = place - i;
    return i;
}

// Adds to out[level_count] the covariance of the lobe and of each level's lobe at an angle.
static void cover(const ki_lobes_chain *chain, const ki_lobes_nodes *nodes, double angle,
                  double *out)
{
    int levels = chain->level_count;
    double sine, cosine;
    ki_sincos(angle, &sine, &cosine);
    for (int i = 0; i < levels; i++)
        out[i] = 0;
    for (int n = 0; n < nodes->count; n++) {
        const double *l = nodes->direction[n];
        double dx = l[0] - sine, dz = l[2] - cosine, share, w = nodes->weight[n];
        int at = table_place(dx * dx + dz * dz + l[1] * l[1], &share);
        const double *low = chain->light + (size_t)at * (size_t)levels, *high = low + levels;
        for (int i = 0; i < levels; i++)
            out[i] += w * (low[i] + share * (high[i] - low[i]));
    }
}

// Adds the nodes' bands, times their weights.
static void add_bands(const ki_lobes_nodes *nodes, ki_lobes_bands *b)
{
    for (int n = 0; n < nodes->count; n++) {
        double x = nodes->direction[n][0], y = nodes->direction[n][1], z = nodes->direction[n][2];
        double w = nodes->weight[n];
        b->c[0] += w * z;
        b->c[1] += w * x;
        b->c[2] += w * (1.5 * z * z - 0.5);
        b->c[3] += w * 2 * x * z;
        b->c[4] += w * 0.5 * (x * x - y * y);
    }
}

void ki_lobes_nodes_make(const kiln_model *model, double roughness, double nov,
                         ki_lobes_nodes *nodes, ki_lobes_bands *bands)
{
    // Near grazing angles the cap's edge has a corner, and bands need three times the spokes.
    static const double shift[3] = {1.0 / 6, 5.0 / 6, 0.5};
    double sum = 0, all = 0;
    *bands = (ki_lobes_bands){0};
    for (int i = 0; i < 3; i++) {
        sum = place_nodes(model, roughness, nov, shift[i], nodes);
        all += sum;
        add_bands(nodes, bands);
    }
    for (int i = 0; i < 5; i++)
        bands->c[i] /= all;
    bands->c[5] = 1;
    for (int i = 0; i < nodes->count; i++)
        nodes->weight[i] /= sum;
}

void ki_lobes_target_make(const ki_lobes_chain *chain, const kiln_model *model, double roughness,
                          double nov, ki_lobes_nodes *nodes, ki_lobes_target *target)
{
    ki_lobes_nodes_make(model, roughness, nov, nodes, &target->bands);
    double r = smallest_roughness(roughness), reach = ki_clamp(0.1 + 8 * r * r, 0, 2.2);
    target->roughness = roughness;
    target->mirror = ki_acos(nov);
    target->from = ki_clamp(target->mirror - reach, -0.6, KI_PI / 2);
    double to = ki_clamp(target->mirror + reach, 0, KI_PI / 2);
    target->step = (to - target->from) / (KI_LOBES_ANGLES - 1);
    for (int a = 0; a < KI_LOBES_ANGLES; a++)
        cover(chain, nodes, target->from + a * target->step,
              target->covariance + (size_t)a * (size_t)chain->level_count);
}

double ki_lobes_target_norm(const ki_lobes_chain *chain, double roughness,
                            const ki_lobes_nodes *nodes)
{
    int cut = 0;
    while (cut < KI_LOBES_CUTS - 1 && (24 << (cut + 1)) * roughness * roughness < 24)
        cut++;
    const double *self = chain->self[cut];
    double norm = 0;
    for (int i = 0; i < nodes->count; i++) {
        const double *a = nodes->direction[i];
        double sum = 0;
        for (int j = 0; j <= i; j++) {
            const double *b = nodes->direction[j];
            double dx = a[0] - b[0], dz = a[2] - b[2], flat = dx * dx + dz * dz, near, far;
            double dy = a[1] - b[1], my = a[1] + b[1];
            int k = table_place(flat + dy * dy, &near), m = table_place(flat + my * my, &far);
            double pair =
                self[k] + near * (self[k + 1] - self[k]) + self[m] + far * (self[m + 1] - self[m]);
            sum += (j < i ? 1 : 0.5) * nodes->weight[j] * pair;
        }
        norm += nodes->weight[i] * sum;
    }
    return norm;
}
