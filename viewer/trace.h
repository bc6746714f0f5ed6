// The two parts of the reference integrator: the environment as a light source to sample, and the
// balls' reflection model. view_reference (reference.c) combines them.
#ifndef KILN_VIEWER_TRACE_H
#define KILN_VIEWER_TRACE_H

#include "viewer.h"

#include <kiln/brdf.h>

// ---------------------------------------------------------------------------------- random numbers

/// The generator PCG-XSH-RR of O'Neill 2014. Each pixel has a stream of its own: the picture does
/// not depend on which thread draws which pixel.
typedef struct view_random {
    uint64_t state, stream;
} view_random;

void view_random_start(view_random *random, uint64_t stream);
/// Returns a random number, uniformly distributed in (0, 1).
double view_random_next(view_random *random);

// --------------------------------------------------------------------------------------- the light

typedef struct view_light {
    kiln_map panorama; ///< the environment as a panorama of one level
    /// cumulated |r| + |g| + |b|. row: of all rows above each row, times the solid angle of a
    /// texel; texel: of all texels to the left of each texel in its row
    double *row, *texel;
    double total; ///< integral of |r| + |g| + |b| over the sphere, discs included
    double mean;  ///< mean of |r|, |g| and |b| over the sphere
    double cos_turn, sin_turn;
    int disc_count;
    view_disc disc[KILN_MAX_LIGHTS]; ///< lights that shine beside the panorama
    /// integral of each disc's |r| + |g| + |b| over the sphere
    double disc_power[KILN_MAX_LIGHTS];
} view_light;

/// Makes an environment a light source that can be sampled. `rotation` is view_options.rotation. A
/// NULL `source` means a uniform white environment.
KILN_CHECKED kiln_result view_light_create(kiln_context *context, const kiln_map *source,
                                           double rotation, view_light *light, kiln_error *error);
void view_light_free(view_light *light);
/// Adds discs to the light.
void view_light_add(view_light *light, const view_disc *discs, int count);
void view_light_radiance(const view_light *light, const double d[3], double radiance[3]);
/// Draws a direction with a density per steradian proportional to |r| + |g| + |b|.
void view_light_sample(const view_light *light, const double xi[2], double d[3]);
double view_light_pdf(const view_light *light, const double d[3]);

// -------------------------------------------------------------------------------------- reflectors

/// The point where a ray meets a ball.
typedef struct view_point {
    int ball; ///< index of the ball; -1 if the ray meets no ball
    double ray[3], position[3];
    double n[3], t[3], b[3]; ///< unit normal and two unit tangents, in the world
    double v[3];             ///< unit vector towards the camera, in the frame (t, b, n)
    /// factor by which the single-scattering lobe is multiplied, besides Fresnel's reflectance
    double specular[3];
    double lobe[3];    ///< factor of Kulla and Conty's lobe, which is lobe (1 - E(n.l)) / pi
    double diffuse[3]; ///< albedo of the diffuse light
} view_point;

enum { VIEW_CURVE = 256 };

/// Directional albedo data of a view. `e` holds E, `split` holds A and B, exact to 1e-6; the table
/// of the split sum's third term is exact to 1e-4. `average` is E_avg of each ball. `curve` is the
/// measured metal's F at v.h = i / VIEW_CURVE.
typedef struct view_energy {
    kiln_model model;
    kiln_table e, split, edge;
    double average[VIEW_MAX_BALLS];
    double curve[VIEW_CURVE + 1][3];
} view_energy;

KILN_CHECKED kiln_result view_energy_create(kiln_context *context, const view_options *options,
                                            view_energy *energy, kiln_error *error);
void view_energy_free(view_energy *energy);

/// Sets f to the ball's Fresnel reflectance at v.h: Schlick's formula, or the measured metal's
/// curve.
void view_fresnel(const view_ball *ball, const view_energy *energy, double voh, double f[3]);
/// Computes the factors `specular`, `lobe` and `diffuse` of a point whose ball, n, t, b and v are
/// set.
void view_point_prepare(const view_ball *ball, const view_energy *energy, view_point *point);
/// Computes the BRDF times n.l, with the Fresnel reflectance of view_fresnel, for light from l,
/// given in the frame (t, b, n). The peak of a perfect mirror (roughness 0) is left out.
void view_reflect(const view_ball *ball, const view_energy *energy, const view_point *point,
                  const double l[3], double f[3]);
/// The arguments of view_walk_add, which adds an estimate, by one random walk, of the light that
/// bounces at least twice between the ball's microfacets.
typedef struct view_walk {
    const view_ball *ball;
    const view_light *light;
    /// directional albedo data of the view, with the F of a measured metal
    const view_energy *energy;
    /// Returns the radiance that arrives from direction d. NULL: the radiance is that of the
    /// environment `light`.
    void (*incoming)(void *user, const double d[3], view_random *random, double radiance[3]);
    void *user;
} view_walk;

void view_walk_add(const view_walk *walk, const view_point *point, view_random *random,
                   double sum[3]);

/// Radiance that the point reflects towards the camera from the GAMES202 assignment's directional
/// light.
void view_reflect_light(const view_options *options, const view_ball *ball,
                        const view_energy *energy, const view_point *point, double radiance[3]);

#endif
