// Estimates the light that bounces at least twice between microfacets, by a random walk in GGX's
// microsurface (Heitz, Hanika, d'Eon and Dachsbacher 2016). In: a point of a ball, the light that
// arrives there. Out: an unbiased estimate of the radiance towards the camera, added to a sum. The
// compensation methods of view_method approximate this radiance.
//
// The state of the walk is a direction w, a height, given by the share c of the microsurface's
// heights below it, and a weight. A ray along w leaves the microsurface with the probability
// c^Lambda(w). Otherwise, with u uniform in (0, 1), it meets a microfacet at the height whose share
// is c / (1 - u (1 - c^Lambda(w)))^(1 / Lambda(w)) (equation 13 of the paper). The microfacet's
// normal is drawn from the normals visible from -w. The microfacet mirrors w and multiplies the
// weight by Fresnel's reflectance. Each bounce adds its expected light along two directions: the
// mirrored w, and a direction drawn from the environment. The balance heuristic weights the two.
#include "internal.h"
#include "trace.h"

#include <math.h>

enum { MAX_BOUNCES = 64 };

typedef struct ray {
    double w[3];  // direction of travel, in the frame (t, b, n)
    double below; // share of the microsurface's heights that lie below the ray's height
    double weight[3];
} ray;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// sqrt(cosine^2 + alpha^2 sine^2), which Smith's Lambda contains: Heitz 2014, equation 72.
static double root(double alpha, double cosine)
{
    return sqrt(cosine * cosine + alpha * alpha * (1 - cosine) * (1 + cosine));
}

// Smith's Lambda of a direction with this cosine to the normal. The cosine may be negative: Lambda
// is then below -1.
static double lambda(double alpha, double cosine)
{
    return (root(alpha, cosine) / cosine - 1) / 2;
}

// Probability that a ray with this cosine leaves the microsurface without another bounce.
static double leaving(double alpha, double below, double cosine)
{
    return cosine > 0 ? pow(below, lambda(alpha, cosine)) : 0;
}

// Draws h from the normals visible from direction v, which may point below the horizon, after Dupuy
// and Benyoub 2023.
static void draw_normal(double alpha, const double v[3], view_random *random, double h[3])
{
    double s[3] = {alpha * v[0], alpha * v[1], v[2]}, size = sqrt(dot(s, s));
    double phi = 6.283185307179586 * view_random_next(random);
    double z = (1 - view_random_next(random)) * (1 + s[2] / size) - s[2] / size;
    double sine = sqrt(fmax(0, 1 - z * z));
    h[0] = alpha * (sine * cos(phi) + s[0] / size);
    h[1] = alpha * (sine * sin(phi) + s[1] / size);
    h[2] = z + s[2] / size;
    size = sqrt(dot(h, h));
    for (int c = 0; c < 3; c++)
        h[c] /= size;
}

// Moves the ray to the next microfacet. The weight keeps the probability that the ray does not
// leave. Returns false where that probability rounds to 0.
static bool advance(double alpha, view_random *random, ray *r)
{
    double cosine = fmin(fmax(r->w[2], -1 + 1e-12), 1 - 1e-12);
    if (fabs(cosine) < 1e-9)
        return true; // a horizontal ray keeps its height
    double l = lambda(alpha, cosine), out = leaving(alpha, r->below, cosine);
    for (int c = 0; c < 3; c++)
        r->weight[c] *= 1 - out;
    r->below /= pow(1 - view_random_next(random) * (1 - out), 1 / l);
    r->below = fmin(r->below, 1);
    return out < 1;
}

// Density per steradian of l among the mirror images of -w about its visible normals. `voh`
// receives the cosine between l and the half vector.
static double phase(double roughness, const double w[3], const double l[3], double *voh)
{
    double h[3], size = 0, alpha = roughness * roughness;
    for (int c = 0; c < 3; c++) {
        h[c] = l[c] - w[c];
        size += h[c] * h[c];
    }
    size = sqrt(size);
    *voh = size / 2;
    if (!(size > 0) || h[2] <= 0)
        return 0;
    // Area that the microsurface projects towards -w: (1 + Lambda(-w)) cos(-w).
    double shown = (-w[2] + root(alpha, -w[2])) / 2;
    return shown > 0 ? kiln_brdf_d(KILN_D_GGX, roughness, fmin(h[2] / size, 1)) / (4 * shown) : 0;
}

// Adds the light that arrives from l and leaves after one more bounce, divided by the sum of the
// densities with which the walk and the environment's sampling would have chosen l.
static void count(const view_walk *walk, const view_point *p, const ray *before, const double l[3],
                  view_random *random, double sum[3])
{
    double d[3], radiance[3], f[3], voh = 0, r = walk->ball->roughness;
    double out = leaving(r * r, before->below, l[2]);
    double density = out > 0 ? phase(r, before->w, l, &voh) : 0;
    if (!(density > 0))
        return;
    for (int c = 0; c < 3; c++)
        d[c] = l[0] * p->t[c] + l[1] * p->b[c] + l[2] * p->n[c];
    double share = density * out / (density + view_light_pdf(walk->light, d));
    if (walk->incoming)
        walk->incoming(walk->user, d, random, radiance);
    else
        view_light_radiance(walk->light, d, radiance);
    view_fresnel(walk->ball, walk->energy, fmin(voh, 1), f);
    for (int c = 0; c < 3; c++)
        sum[c] += before->weight[c] * f[c] * share * radiance[c];
}

void view_walk_add(const view_walk *walk, const view_point *p, view_random *random, double sum[3])
{
    const view_ball *ball = walk->ball;
    double alpha = ball->roughness * ball->roughness;
    ray r = {.w = {-p->v[0], -p->v[1], -p->v[2]}, .below = 1, .weight = {1, 1, 1}};
    if (alpha <= 0)
        return;
    advance(alpha, random, &r);
    for (int bounce = 1; bounce <= MAX_BOUNCES; bounce++) {
        double v[3] = {-r.w[0], -r.w[1], -r.w[2]}, h[3], l[3], f[3];
        draw_normal(alpha, v, random, h);
        double voh = dot(v, h);
        for (int c = 0; c < 3; c++)
            l[c] = 2 * voh * h[c] - v[c];
        if (bounce > 1) { // the single-scattering lobe already contains the first bounce
            double xi[2] = {view_random_next(random), view_random_next(random)}, d[3];
            view_light_sample(walk->light, xi, d);
            const double drawn[3] = {dot(d, p->t), dot(d, p->b), dot(d, p->n)};
            count(walk, p, &r, drawn, random, sum);
            count(walk, p, &r, l, random, sum);
        }
        view_fresnel(ball, walk->energy, fmin(voh, 1), f);
        for (int c = 0; c < 3; c++) {
            r.w[c] = l[c];
            r.weight[c] *= f[c];
        }
        if (!advance(alpha, random, &r))
            return;
        // Russian roulette: a ray whose largest weight is below 1/4 continues with a probability of
        // 4 times that weight.
        double most = fmax(r.weight[0], fmax(r.weight[1], r.weight[2]));
        double chance = fmin(1, 4 * most);
        if (view_random_next(random) >= chance)
            return;
        for (int c = 0; c < 3; c++)
            r.weight[c] /= chance;
    }
}
