// Random walks of light between the microfacets of a GGX surface. The walks give the albedo with
// every bounce, which is the reference for the methods of compensation. docs/theory/walk.md.
#ifndef KI_WALK_H
#define KI_WALK_H

#include <kiln/brdf.h>

#include <stdint.h>

/// A ray in GGX's microsurface, followed by a random walk. The azimuth of its direction does not
/// matter and is kept at 0.
typedef struct ki_ray {
    double sine, cosine; ///< direction of travel (sine, 0, cosine), where +z leaves the surface
    double depth;        ///< -log of the share of the surface's heights below the ray; 0 at the top
    double inside;       ///< share of the ray's light that has not left the surface
} ki_ray;

/// Starts a ray that comes down at the cosine nov, at the first microfacet it meets. alpha > 0, and
/// xi is uniform in [0, 1).
ki_ray ki_walk_enter(double alpha, double nov, double xi);
/// Mirrors the ray at a random microfacet that it sees. Returns v.h there: the cosine between the
/// reversed ray and the microfacet's normal. xi is uniform in [0, 1)^2.
double ki_walk_bounce(double alpha, const double xi[2], ki_ray *ray);
/// Moves the ray to the next microfacet. Returns the share of light that leaves the surface on the
/// way. If less than 0.1 would stay inside, a random number decides whether all of the ray's light
/// leaves or none of the light leaves.
double ki_walk_on(double alpha, double xi, ki_ray *ray);

/// Greatest number of values of f0 in one call of ki_walk_column.
enum { KI_WALK_COLUMN = 64 };

/// Sets added[i] to the albedo of all bounces after the first, for a GGX surface with
/// height-correlated Smith masking and Schlick's F of f0[i]. The albedo with every bounce is then
/// f0 A + B + added, with A and B of the split sum. count is at most KI_WALK_COLUMN; f0[],
/// roughness and nov are in [0, 1]; path_count is that of kiln_walk_def. One set of walks serves
/// all f0, because the angles of a walk do not depend on F. added is exactly 1 - E for f0 = 1.
/// Every call with the same seed draws the same random numbers, so that the error changes smoothly
/// along a table. A path takes 0.25 us. Any thread may call. The errors are listed in
/// docs/theory/walk.md.
void ki_walk_column(double roughness, double nov, const double *f0, int count, int path_count,
                    uint32_t seed, double *added);

#endif
