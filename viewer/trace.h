// What the reference is made of: the environment as a light to sample, the balls as reflectors.
#ifndef KILN_VIEWER_TRACE_H
#define KILN_VIEWER_TRACE_H

#include "viewer.h"

#include <kiln/brdf.h>

// ----------------------------------------------------------------------------------- random numbers

/// PCG-XSH-RR, O'Neill 2014: one stream a pixel, so that no thread can matter.
typedef struct view_random {
    uint64_t state, stream;
} view_random;

void view_random_start(view_random *random, uint64_t stream);
/// In [0, 1).
double view_random_next(view_random *random);

// ----------------------------------------------------------------------------------------- the light

typedef struct view_light {
    kiln_map panorama;   ///< one level
    double *row, *texel; ///< cumulated power: of the rows, and within each row
    double total;        ///< integral of r + g + b over the sphere
    double mean;         ///< radiance, of the three channels
    double cos_turn, sin_turn;
} view_light;

/// `rotation` as in view_options. NULL for a uniform white.
KILN_CHECKED kiln_result view_light_create(kiln_context *context, const kiln_map *source,
                                           double rotation, view_light *light, kiln_error *error);
void view_light_free(view_light *light);
void view_light_radiance(const view_light *light, const double d[3], double radiance[3]);
/// A direction with a density per steradian proportional to r + g + b.
void view_light_sample(const view_light *light, const double xi[2], double d[3]);
double view_light_pdf(const view_light *light, const double d[3]);

// --------------------------------------------------------------------------------------- reflectors

/// A point of a ball as a ray meets it.
typedef struct view_point {
    int ball; ///< -1 for none
    double ray[3], position[3];
    double n[3], t[3], b[3]; ///< normal and tangents
    double v[3];             ///< towards the camera, in (t, b, n)
    double specular[3];      ///< factor to the single-scattering lobe times Fresnel's reflectance
    double lobe[3];          ///< Kulla and Conty's lobe but for 1 - E of the light and pi
    double diffuse[3];       ///< the rest, as an albedo
} view_point;

enum { VIEW_CURVE = 256 };

/// E, A and B as the reference looks them up, to 1e-6, C to 1e-4; E_avg of each ball; the measured
/// metal's F at v.h = i / VIEW_CURVE.
typedef struct view_energy {
    kiln_model model;
    kiln_table e, split, edge;
    double average[VIEW_MAX_BALLS];
    double curve[VIEW_CURVE + 1][3];
} view_energy;

KILN_CHECKED kiln_result view_energy_create(kiln_context *context, const view_options *options,
                                            view_energy *energy, kiln_error *error);
void view_energy_free(view_energy *energy);

/// The ball's reflectance at v.h: Schlick's, or a metal's measured one.
void view_fresnel(const view_ball *ball, const view_energy *energy, double voh, double f[3]);
/// Fills specular, lobe and diffuse; ball, n, t, b and v are set.
void view_point_prepare(const view_ball *ball, const view_energy *energy, view_point *point);
/// The BRDF times the cosine for light from l in (t, b, n), with view_fresnel's F. A perfect mirror's peak
/// is left out.
void view_reflect(const view_ball *ball, const view_energy *energy, const view_point *point,
                  const double l[3], double f[3]);
/// Adds what bounces at least twice between the ball's microfacets, estimated by one walk.
typedef struct view_walk {
    const view_ball *ball;
    const view_light *light;
    const view_energy *energy; ///< for a measured metal's F
    /// What arrives from d; NULL for the light's radiance.
    void (*incoming)(void *user, const double d[3], view_random *random, double radiance[3]);
    void *user;
} view_walk;

void view_walk_add(const view_walk *walk, const view_point *point, view_random *random,
                   double sum[3]);

/// Radiance towards the camera from the assignment's light.
void view_reflect_light(const view_options *options, const view_ball *ball,
                        const view_energy *energy, const view_point *point, double radiance[3]);

#endif
