// Microfacet functions of numbers. The normal is n = (0, 0, 1); nov, nol, noh are cosines with the
// view, light and half vectors in [0, 1]; alpha is roughness squared.
#ifndef KI_BRDF_H
#define KI_BRDF_H

#include <kiln/brdf.h>

#include <stdint.h>

/// The bits of `index` mirrored about the binary point: van der Corput's sequence in [0, 1).
double ki_radical_inverse(uint32_t index);
/// Point `index` of `count` of the Hammersley set, xi in [0, 1)^2: (index / count, radical inverse).
void ki_hammersley(uint32_t index, uint32_t count, double xi[2]);

/// Trowbridge and Reitz's distribution, GGX: alpha^2 / (pi ((n.h)^2 (alpha^2 - 1) + 1)^2).
/// Walter et al. 2007, eq. 33. Infinite where alpha is 0 and noh 1.
double ki_ggx_d(double alpha, double noh);
/// A half vector with the density D(h) (n.h), from xi: Walter et al. 2007, eqs. 35 and 36.
void ki_ggx_half_vector(double alpha, const double xi[2], double h[3]);

/// Schlick's one-sided shadowing, nox / (nox (1 - k) + k).
double ki_smith_g1_schlick(double k, double nox);
/// The uncorrelated product for view and light.
double ki_smith_g_schlick(double k, double nov, double nol);
/// k for image-based light, alpha / 2 = roughness^2 / 2. Karis 2013.
double ki_schlick_k_ibl(double alpha);
/// k for point lights, (roughness + 1)^2 / 8. Karis 2013.
double ki_schlick_k_direct(double roughness);

/// D by its name.
double ki_brdf_d(kiln_d d, double roughness, double noh);
/// G / (nov nol), finite unless both are 0 or roughness is and one of them.
double ki_visibility(const kiln_model *model, double roughness, double nov, double nol);
/// G, with its limits where a cosine is 0.
double ki_masking(const kiln_model *model, double roughness, double nov, double nol);
/// GGX's G1 / nox = 1 / (nox (1 + Lambda)).
double ki_smith_g1_over_cosine(double alpha, double nox);

/// (1 - voh)^5, the varying part of Schlick's Fresnel F = f0 + (1 - f0) (1 - voh)^5.
double ki_schlick_fresnel(double voh);
/// Schlick's F less dip voh (1 - voh)^6, so that F = f82 at voh = 1 / 7, and that dip.
double ki_fresnel_f82(double f0, double f82, double voh);
double ki_f82_dip(double f0, double f82);
/// ior is n_transmitted / n_incident, c the cosine.
double ki_fresnel_dielectric(double ior, double c);
double ki_fresnel_conductor(double n, double k, double c);
void ki_gulbrandsen(double reflectivity, double edge_tint, double *n, double *k);
/// 2 int F(mu) mu dmu.
double ki_fresnel_dielectric_average(double ior);
double ki_fresnel_conductor_average(double n, double k);
double ki_fresnel_dielectric_average_fit(double ior);
double ki_fresnel_conductor_average_fit(double reflectivity, double edge_tint);

void ki_sample_cosine(const double xi[2], double l[3]);
/// A half vector with the density D(h) (n.h) of Beckmann's D: Walter et al. 2007, eqs. 28 and 29.
void ki_beckmann_half_vector(double alpha, const double xi[2], double h[3]);
/// A half vector with the density max(v.h, 0) D(h) / int max(v.h, 0) D(h) dh of GGX. v is any unit
/// vector but (0, 0, -1).
void ki_sample_visible(double alpha, const double v[3], const double xi[2], double h[3]);

double ki_kulla_conty(double e_o, double e_i, double e_average);
double ki_kulla_conty_fresnel(kiln_f_add form, double f, double e_average);
double ki_turquin(double f0, double e);
void ki_fdez_aguera(double f0, double a, double b, double *single, double *multiple);

#endif
