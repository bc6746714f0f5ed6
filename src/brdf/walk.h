// A random walk between the microfacets: the albedo with every bounce, as ground truth.
#ifndef KI_WALK_H
#define KI_WALK_H

#include <kiln/brdf.h>

#include <stdint.h>

/// A ray in GGX's microsurface. Its azimuth does not matter and stays 0: (sine, 0, cosine).
typedef struct ki_ray {
    double sine, cosine; ///< of the direction it travels, from +z
    double depth;        ///< -log of the share of heights below it: 0 on top
    double inside;       ///< its weight: the share that has not left yet
} ki_ray;

/// A ray that comes down along nov until it meets a microfacet. alpha > 0.
ki_ray ki_walk_enter(double alpha, double nov, double xi);
/// The bounce: returns v.h at the microfacet, and turns the ray.
double ki_walk_bounce(double alpha, const double xi[2], ki_ray *ray);
/// On to the next microfacet. Returns the weight that leaves the microsurface instead; where little
/// would stay, all or nothing does.
double ki_walk_on(double alpha, double xi, ki_ray *ray);

enum { KI_WALK_COLUMN = 64 };

/// What the bounces after the first add to the albedo f0 A + B of `count` (to KI_WALK_COLUMN) Schlick
/// surfaces, f0[] in [0, 1], for roughness and nov in [0, 1] and height-correlated Smith's GGX, from
/// one set of walks: their angles do not depend on F. Exact for f0 = 1, where it is 1 - E. The same
/// numbers are drawn at every (roughness, nov), so that what error there is changes smoothly along a
/// table. path_count as in kiln_walk_def; 0.25 us each. Any thread. Error: docs/theory/walk.md.
void ki_walk_column(double roughness, double nov, const double *f0, int count, int path_count,
                    uint32_t seed, double *added);

/// One surface with any of the def's Fresnel terms; as kiln_walk_albedo, arguments in range.
void ki_walk_albedo(const kiln_walk_def *def, double roughness, double nov, kiln_walk *walk);

#endif
