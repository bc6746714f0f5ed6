// Microfacet theory as functions of plain numbers, for the inner loops of integrals, tables and
// random walks: normal distributions D, masking G, Fresnel reflectances F, and samplers. Vectors
// are unit vectors in a frame whose +z axis is the surface normal n. The arguments nov, nol, noh
// and voh are the cosines n.v, n.l, n.h and v.h of the view v, the light l and the half vector h,
// each in [0, 1]. alpha is roughness squared. No function checks its arguments, which its callers
// keep in range. Where a public function kiln_X computes the same as ki_X, all that kiln_X adds is
// to clamp its arguments (arguments.h).
#ifndef KI_BRDF_H
#define KI_BRDF_H

#include <kiln/brdf.h>

#include <stdint.h>

/// Van der Corput's sequence in [0, 1): the bits of `index` mirrored about the binary point.
double ki_radical_inverse(uint32_t index);
/// Sets xi to point `index` of the Hammersley set of `count` points in [0, 1)^2: (index / count,
/// ki_radical_inverse(index)).
void ki_hammersley(uint32_t index, uint32_t count, double xi[2]);

/// D of Trowbridge and Reitz, called GGX: alpha^2 / (pi ((n.h)^2 (alpha^2 - 1) + 1)^2), by Walter
/// et al. 2007, eq. 33. D is infinite at alpha = 0 and noh = 1.
double ki_ggx_d(double alpha, double noh);
/// Maps xi, uniform in [0, 1)^2, to a half vector h with the density D(h) (n.h) per steradian for
/// GGX's D. Walter et al. 2007, eqs. 35 and 36.
void ki_ggx_half_vector(double alpha, const double xi[2], double h[3]);

/// Schlick's masking of one direction, G1 = nox / (nox (1 - k) + k), where nox is n.v or n.l.
double ki_smith_g1_schlick(double k, double nox);
/// Schlick's masking G = G1(nov) G1(nol) of view and light, taken as independent of each other.
double ki_smith_g_schlick(double k, double nov, double nol);
/// Schlick's k for image-based light: alpha / 2 = roughness^2 / 2. Karis 2013.
double ki_schlick_k_ibl(double alpha);
/// Schlick's k for point lights: (roughness + 1)^2 / 8. Karis 2013.
double ki_schlick_k_direct(double roughness);

/// The value of the distribution D that `d` names, per steradian.
double ki_brdf_d(kiln_d d, double roughness, double noh);
/// G / (nov nol) for the model's masking G. The quotient is finite, except perhaps where both
/// cosines are 0, or where roughness and one cosine are 0.
double ki_visibility(const kiln_model *model, double roughness, double nov, double nol);
/// Returns the model's masking G in [0, 1]. Where a cosine is 0, G is its limit at that cosine.
double ki_masking(const kiln_model *model, double roughness, double nov, double nol);
/// Smith's masking of one direction for GGX over that direction's cosine: G1 / nox = 1 / (nox (1 +
/// Lambda)), where nox is n.v or n.l. The quotient is finite at nox = 0.
double ki_smith_g1_over_cosine(double alpha, double nox);

/// (1 - voh)^5, the factor of Schlick's Fresnel term F = f0 + (1 - f0) (1 - voh)^5 that depends on
/// the angle.
double ki_schlick_fresnel(double voh);
/// The coefficient `edge` of kiln_fresnel_f82, whose F is Schlick's F - edge voh (1 - voh)^6.
double ki_f82_edge(double f0, double f82);
/// Exact reflectance of a dielectric for unpolarised light. ior is n_transmitted / n_incident, and
/// c is the cosine of the angle of incidence. Total reflection returns 1.
double ki_fresnel_dielectric(double ior, double c);
/// Exact reflectance of a conductor of complex index n + i k for unpolarised light; c is the cosine
/// of the angle of incidence.
double ki_fresnel_conductor(double n, double k, double c);

/// Maps xi, uniform in [0, 1)^2, to a direction l with the density (n.l) / pi per steradian.
void ki_sample_cosine(const double xi[2], double l[3]);
/// Maps xi, uniform in [0, 1)^2, to a half vector h with the density D(h) (n.h) per steradian for
/// Beckmann's D. Walter et al. 2007, eqs. 28 and 29.
void ki_beckmann_half_vector(double alpha, const double xi[2], double h[3]);
/// Maps xi, uniform in [0, 1)^2, to a half vector h that v sees: its density per steradian is
/// max(v.h, 0) D(h) / int max(v.h, 0) D(h) dh for GGX's D. v is any unit vector except (0, 0, -1).
void ki_sample_visible(double alpha, const double v[3], const double xi[2], double h[3]);

#endif
