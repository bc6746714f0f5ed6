// The albedo of a GGX surface with every bounce between its microfacets, by random walks. In:
// Fresnel term, roughness, n.v, number of paths. Out: the albedo, its parts by the number of
// bounces, a standard error. docs/theory/walk.md derives the method, that of Heitz, Hanika, d'Eon
// and Dachsbacher 2016.
//
// A ray's depth in the microsurface is x = -log C1(height), where C1 is the share of the
// microsurface below that height. In x the distribution of heights does not matter. A ray of
// direction w meets microfacets at random, on average Lambda(w) of them per unit of x if w goes up,
// and 1 + Lambda(-w) per unit if w goes down. Of the rays that go up from x, the share exp(-x
// Lambda(w)) leaves the surface.
#include "brdf/walk.h"

#include "brdf/arguments.h"
#include "brdf/brdf.h"
#include "brdf/energy.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

enum {
    // number of independent estimates of the albedo, whose variance gives the standard error
    REPLICATES = 16,
    // number of random numbers of a path that come from a lattice; the path's further random
    // numbers come from a hash of its index
    DIMENSIONS = 16,
    MAX_BOUNCES = 1024 // number of bounces at which a path is stopped
};

// If less than TAIL of a ray's light would stay inside the surface, a random number decides whether
// the ray stays or leaves as a whole.
static const double TAIL = 0.1;

// ----------------------------------------------------------------------------------------- the ray

// sqrt(c^2 + alpha^2 sine^2), which is c (1 + 2 Lambda) with Smith's Lambda of GGX for a direction
// of cosine c. Heitz 2014, eq. 72.
static double stretched(double alpha, double sine, double c)
{
    return sqrt(c * c + alpha * alpha * (sine * sine));
}

ki_ray ki_walk_enter(double alpha, double nov, double xi)
{
    ki_ray ray = {.sine = sqrt((1 - nov) * (1 + nov)), .cosine = -nov, .inside = 1};
    // The mean depth of the first microfacet is 1 / (1 + Lambda(v)) = 2 nov / (nov + stretched).
    ray.depth = -ki_log(1 - xi) * (2 * nov / (nov + stretched(alpha, ray.sine, nov)));
    return ray;
}

double ki_walk_bounce(double alpha, const double xi[2], ki_ray *ray)
{
    double v[3] = {-ray->sine, 0, -ray->cosine}, h[3];
    ki_sample_visible(alpha, v, xi, h);
    double voh = v[0] * h[0] + v[2] * h[2];
    double x = 2 * voh * h[0] - v[0], y = 2 * voh * h[1], z = 2 * voh * h[2] - v[2];
    double flat = x * x + y * y, length = sqrt(flat + z * z);
    ray->sine = sqrt(flat) / length;
    ray->cosine = z / length;
    return ki_clamp(voh, 0, 1);
}

double ki_walk_on(double alpha, double xi, ki_ray *ray)
{
    double c = ray->cosine, root = stretched(alpha, ray->sine, c);
    if (!(c > 0)) {
        ray->depth -= ki_log(1 - xi) * (-2 * c / (root - c));
        return 0;
    }
    double lambda = alpha * alpha * (ray->sine * ray->sine) / (2 * c * (root + c));
    double share = ki_exp(-lambda * ray->depth), leaves = ray->inside * share;
    if (ray->inside - leaves > TAIL) {
        // Moves the ray to the depth of its next microfacet, under the condition that the ray does
        // not leave.
        ray->depth += ki_log(1 - xi * (1 - share)) / lambda;
        ray->inside -= leaves;
    } else if (xi < 1 - share) {
        ray->depth += ki_log(1 - xi) / lambda;
        leaves = 0;
    } else {
        leaves = ray->inside;
        ray->inside = 0;
    }
    ray->depth = ray->depth > 0 ? ray->depth : 0;
    return leaves;
}

// ---------------------------------------------------------------------------------- random numbers

// The generating vector of a rank-1 lattice, a set of quasi-random points, with 2^k points for k up
// to 20. It was found by component-by-component search (Cools, Kuo and Nuyens 2006). The numbers
// are from Kuo's file lattice-32001-1024-1048576.3600.
static const uint32_t generators[DIMENSIONS] = {1,      182667, 469891, 498753, 110745, 446247,
                                                250185, 118627, 245333, 283199, 408519, 391023,
                                                246327, 126539, 399185, 461527};

// A rank-1 lattice (a set of quasi-random points) shifted at random: coordinate d of point i is i *
// step[d] + shift[d], modulo 1.
typedef struct lattice {
    // step of each coordinate from a lattice point to the next, in units of 2^-32
    uint32_t step[DIMENSIONS];
    uint32_t shift[DIMENSIONS]; // random shift of each coordinate of the lattice, in units of 2^-32
    // seed of the hash that makes the shifts, and those random numbers of a path that do not come
    // from the lattice
    uint64_t key;
} lattice;

// A hash of 64 bits: the finaliser of splitmix64 (Steele, Lea and Flood 2014).
static uint64_t mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

static void make_lattice(uint32_t seed, int replicate, int bits, lattice *l)
{
    l->key = mix(((uint64_t)seed << 32) | (uint32_t)replicate);
    for (int d = 0; d < DIMENSIONS; d++) {
        l->step[d] = generators[d] << (32 - bits);
        l->shift[d] = (uint32_t)(mix(l->key + (uint64_t)d) >> 32);
    }
}

// Returns random number `d` of path `index`, in (0, 1). For d < DIMENSIONS the number is a
// coordinate of the path's lattice point, for larger d a hash of `index` and d. The map x -> 1 - |2
// x - 1| of the lattice's coordinates makes integrands periodic (Hickernell 2002), which lowers the
// variance of the albedo by a factor of three.
static double coordinate(const lattice *l, uint32_t index, int d)
{
    if (d >= DIMENSIONS)
        return ((double)(mix(mix(l->key ^ index) + (uint64_t)d) >> 12) + 0.5) / 4503599627370496.0;
    uint32_t x = index * l->step[d] + l->shift[d];
    x = x >> 31 ? ~(x << 1) : x << 1;
    return ((double)x + 0.5) * (1.0 / 4294967296.0);
}

// log2 of the number of paths in each of the REPLICATES estimates, 1 to 20, so that all estimates
// together have at least path_count paths, if 20 is enough.
static int lattice_bits(int path_count)
{
    int bits = 1;
    while (bits < 20 && (REPLICATES << bits) < path_count)
        bits++;
    return bits;
}

// ------------------------------------------------------------------------------------------ albedo

// Receives each bounce of a path: the index of the bounce from 0, v.h at its microfacet, and the
// share of the path's light that leaves the surface after the bounce.
typedef void visit(void *data, int bounce, double voh, double leaves);

// Follows the path that uses lattice point `index` from the view until it has left the surface, and
// reports each bounce to `seen`.
static void walk_path(double alpha, double nov, const lattice *l, uint32_t index, visit *seen,
                      void *data)
{
    ki_ray ray = ki_walk_enter(alpha, nov, coordinate(l, index, 0));
    for (int bounce = 0; bounce < MAX_BOUNCES && ray.inside > 0; bounce++) {
        int d = 1 + 3 * bounce;
        double xi[2] = {coordinate(l, index, d), coordinate(l, index, d + 1)};
        double voh = ki_walk_bounce(alpha, xi, &ray);
        seen(data, bounce, voh, ki_walk_on(alpha, coordinate(l, index, d + 2), &ray));
    }
}

// Running sums of the light that leaves the surface, over a set of random paths, for one Fresnel
// term.
typedef struct series {
    const kiln_walk_def *def;
    double throughput; // product of F over the current path's bounces so far
    // sum of the light that left after each number of bounces, the last entry for all higher
    // numbers
    double bounce[KILN_WALK_BOUNCES];
} series;

static double fresnel(const kiln_walk_def *def, double voh)
{
    switch (def->fresnel) {
    case KILN_WALK_CONSTANT:
        return def->f0;
    case KILN_WALK_CONDUCTOR:
        return ki_fresnel_conductor(def->n, def->k, voh);
    case KILN_WALK_SCHLICK:
        break;
    }
    return def->f0 + (1 - def->f0) * ki_schlick_fresnel(voh);
}

static void add_bounce(void *data, int bounce, double voh, double leaves)
{
    series *s = data;
    s->throughput = (bounce ? s->throughput : 1) * fresnel(s->def, voh);
    s->bounce[bounce < KILN_WALK_BOUNCES ? bounce : KILN_WALK_BOUNCES - 1] +=
        s->throughput * leaves;
}

void kiln_walk_albedo(const kiln_walk_def *def, double roughness, double nov, kiln_walk *walk)
{
    kiln_walk_def d = *def;
    d.f0 = ki_unit(d.f0);
    d.n = ki_index(d.n);
    d.k = ki_index(d.k);
    nov = ki_unit(nov);
    double clamped = ki_roughness(roughness), alpha = clamped * clamped, squares = 0,
           sums[REPLICATES];
    *walk = (kiln_walk){0};
    if (!(alpha > 1e-100)) { // a surface so smooth is a mirror, which reflects light once
        walk->albedo = walk->bounce[0] = fresnel(&d, nov);
        return;
    }
    int bits = lattice_bits(d.path_count ? d.path_count : 65536);
    double scale = 1.0 / (1 << bits);
    for (int r = 0; r < REPLICATES; r++) {
        lattice l;
        series s = {.def = &d};
        make_lattice(d.seed, r, bits, &l);
        for (uint32_t i = 0; i < 1u << bits; i++)
            walk_path(alpha, nov, &l, i, add_bounce, &s);
        sums[r] = 0;
        for (int b = 0; b < KILN_WALK_BOUNCES; b++) {
            sums[r] += s.bounce[b] * scale;
            walk->bounce[b] += s.bounce[b] * scale / REPLICATES;
        }
        walk->albedo += sums[r] / REPLICATES;
    }
    for (int r = 0; r < REPLICATES; r++)
        squares += (sums[r] - walk->albedo) * (sums[r] - walk->albedo);
    walk->standard_error = sqrt(squares / (REPLICATES * (REPLICATES - 1)));
    walk->path_count = REPLICATES << bits;
}

// Running sums of the light that leaves the surface, over a set of random paths, for Schlick's
// Fresnel terms of `count` values of f0.
typedef struct column {
    const double *f0;
    int count;
    double throughput[KI_WALK_COLUMN]; // product of F over the current path's bounces so far
    double sum[KI_WALK_COLUMN];        // light that left after the second or a later bounce
    // light that would have left after the second or a later bounce for F = 1
    double weight;
} column;

static void add_bounces(void *data, int bounce, double voh, double leaves)
{
    column *c = data;
    double s = ki_schlick_fresnel(voh);
    if (bounce == 0) {
        for (int k = 0; k < c->count; k++)
            c->throughput[k] = c->f0[k] + (1 - c->f0[k]) * s;
        return;
    }
    c->weight += leaves;
    for (int k = 0; k < c->count; k++) {
        c->throughput[k] *= c->f0[k] + (1 - c->f0[k]) * s;
        c->sum[k] += leaves * c->throughput[k];
    }
}

void ki_walk_column(double roughness, double nov, const double *f0, int count, int path_count,
                    uint32_t seed, double *added)
{
    double alpha = roughness * roughness, ab[2];
    column c = {.f0 = f0, .count = count};
    int bits = lattice_bits(path_count ? path_count : 65536);
    for (int r = 0; r < REPLICATES && alpha > 1e-100; r++) {
        lattice l;
        make_lattice(seed, r, bits, &l);
        for (uint32_t i = 0; i < 1u << bits; i++)
            walk_path(alpha, nov, &l, i, add_bounces, &c);
    }
    // For F = 1 the light of the bounces after the first is 1 - E, where the albedo E = A + B of
    // the single bounce is known exactly. The walk provides only the factor by which the Fresnel
    // terms darken that light.
    ki_energy_split(&(kiln_model){0}, roughness, nov, ab);
    // If no path had a second bounce, the factor by which the Fresnel terms darken the further
    // bounces is taken as f squared, where f is the factor by which the Fresnel term darkens the
    // first bounce.
    double e = ab[0] + ab[1], missing = e < 1 ? 1 - e : 0;
    for (int k = 0; k < count; k++) {
        double f = (f0[k] * ab[0] + ab[1]) / e;
        added[k] = missing * (c.weight > 0 ? c.sum[k] / c.weight : f * f);
    }
}
