// kiln: what a surface does to light, as functions of numbers, tables and closed forms.
//
// Read from top to bottom:
//   microfacet models -> compensation of energy -> tables -> closed forms -> files of tables.
// Each function of numbers is exact, or says what it errs by; tables and closed forms hold such
// functions for shaders. <kiln/kiln.h>, which this header includes, has the conventions and the
// environment's half of image-based lighting; neither needs the other's functions.
// SPDX-License-Identifier: MIT
#ifndef KILN_BRDF_H
#define KILN_BRDF_H

#include <kiln/kiln.h>

#ifdef __cplusplus
extern "C" {
#endif

// ------------------------------------------------------------------------------ microfacet models

/// The distribution of normals.
typedef enum kiln_d {
    KILN_D_GGX,     ///< Trowbridge and Reitz 1975, Walter et al. 2007
    KILN_D_BECKMANN ///< Gaussian slopes, with Smith's masking of its own
} kiln_d;

/// Masking and shadowing, Smith's or Schlick's approximation with one of the two k in use.
typedef enum kiln_g {
    KILN_G_SMITH,              ///< height-correlated Smith (Heitz 2014, eq. 99); the default
    KILN_G_SMITH_UNCORRELATED, ///< G1(v) G1(l)
    KILN_G_SCHLICK_K2,         ///< k = roughness^2 / 2 (Karis 2013, image-based light)
    KILN_G_SCHLICK_TEXT        ///< k = (roughness + 1)^2 / 8 (Karis 2013, point lights)
} kiln_g;

/// {0} is a good default: GGX with height-correlated Smith shadowing.
typedef struct kiln_model {
    kiln_d d;
    kiln_g g;
} kiln_model;

// Functions of numbers, which cannot fail: arguments outside their range are clamped into it.
// nov, nol and noh are the cosines n.v, n.l and n.h, voh is v.h = l.h, all in [0, 1]; alpha =
// roughness^2. Roughness 0 is the limit from above at fixed cosines, a cosine of 0 the limit after
// that.

/// D, per steradian: int D(h) (n.h) dh = 1. Infinite at roughness 0 and noh 1.
KILN_API double kiln_brdf_d(kiln_d d, double roughness, double noh);
/// G in [0, 1], symmetric. Schlick's two do not depend on the distribution.
KILN_API double kiln_brdf_g(const kiln_model *model, double roughness, double nov, double nol);
/// The specular lobe with F = 1, D G / (4 nov nol), per steradian. Finite at nov = 0 or nol = 0,
/// where G / (nov nol) has a limit; infinite where both are 0 and the model's limit is.
KILN_API double kiln_brdf_specular(const kiln_model *model, double roughness, double nov,
                                   double nol, double noh);

/// Schlick 1994: f0 + (1 - f0) (1 - voh)^5.
KILN_API double kiln_fresnel_schlick(double f0, double voh);
/// A metal's: Schlick's less a dip towards the edge, a voh (1 - voh)^6 (Lazanyi and Szirmay-Kalos
/// 2005), with a such that F is `f82` at voh = 1 / 7, 82 degrees (Kutz et al. 2021). Cut to [0, 1].
KILN_API double kiln_fresnel_f82(double f0, double f82, double voh);
/// Unpolarised light on a dielectric of ior = n_transmitted / n_incident, 0 to 1e8. Total
/// reflection is 1.
KILN_API double kiln_fresnel_dielectric(double ior, double voh);
/// On a conductor of complex index n + i k relative to the medium outside, each 0 to 1e8.
KILN_API double kiln_fresnel_conductor(double n, double k, double voh);
/// The index of the metal with a reflectivity at normal incidence (0 to 0.9999) and an edge tint (0
/// to 1). Gulbrandsen 2014, factored so that k loses no digits; the reflectivity comes out again.
KILN_API void kiln_gulbrandsen(double reflectivity, double edge_tint, double *n, double *k);

/// F_avg = 2 int F(mu) mu dmu from 0 to 1. Schlick's is exactly (1 + 20 f0) / 21.
KILN_API double kiln_fresnel_schlick_average(double f0);
/// (1 + 20 f0) / 21 - a / 126, exact where nothing is cut: f0 of 0.2 or more, f82 from
/// f0 to Schlick's F.
KILN_API double kiln_fresnel_f82_average(double f0, double f82);
/// Exact (Walsh 1926, and reciprocity for ior < 1), to 1e-14.
KILN_API double kiln_fresnel_dielectric_average(double ior);
/// By adaptive quadrature, to 1e-12.
KILN_API double kiln_fresnel_conductor_average(double n, double k);
/// Kulla and Conty's fit (Imageworks 2017) to the dielectric's for ior 0 to 400: off by up to 0.0065
/// above 1, by 0.0029 below.
KILN_API double kiln_fresnel_dielectric_average_fit(double ior);
/// Their polynomial to the conductor's in Gulbrandsen's parameters: off by up to 0.10, by 0.014 RMS.
KILN_API double kiln_fresnel_conductor_average_fit(double reflectivity, double edge_tint);

// Samplers: xi in [0, 1)^2 uniform; n = (0, 0, 1); pdfs are per steradian. Light from a half
// vector: l = 2 (v.h) h - v, which may be below the surface (its share is lost, the weight 0).

/// l with the density (n.l) / pi.
KILN_API void kiln_sample_cosine(const double xi[2], double l[3]);
KILN_API double kiln_pdf_cosine(double nol);
/// h with the density D(h) (n.h). Walter et al. 2007, eqs. 28 and 35.
KILN_API void kiln_sample_half_vector(kiln_d d, double roughness, const double xi[2], double h[3]);
KILN_API double kiln_pdf_half_vector(kiln_d d, double roughness, double noh);
/// h among GGX's normals visible from the unit vector v (v[2] >= 0), with the density G1(v) D(h)
/// (v.h) / (n.v). Heitz 2018, by the spherical caps of Dupuy and Benyoub 2023.
KILN_API void kiln_sample_visible(double roughness, const double v[3], const double xi[2],
                                  double h[3]);
KILN_API double kiln_pdf_visible(double roughness, double nov, double noh, double voh);
/// The density of l = 2 (v.h) h - v where h has the density `pdf`: pdf / (4 voh).
KILN_API double kiln_pdf_reflection(double pdf, double voh);

// What a rough surface reflects in all, with every bounce after the first lost: the furnace test's
// missing light is 1 - E. Exact, by one-dimensional integrals; errors below 1e-11, with Beckmann's D
// 1e-8. Arguments outside [0, 1] are clamped; roughness 0 and nov 0 are limits, roughness first.
// Source: docs/theory/energy.md.

/// E(n.v) = int f (n.l) dl with F = 1: the directional albedo.
KILN_API double kiln_energy(const kiln_model *model, double roughness, double nov);
/// E_avg = 2 int_0^1 E(mu) mu dmu.
KILN_API double kiln_energy_average(const kiln_model *model, double roughness);
/// A and B of the split sum: with Schlick's F the directional albedo is f0 A + B.
KILN_API void kiln_energy_split(const kiln_model *model, double roughness, double nov,
                                double ab[2]);

/// Masking of Charlie sheen.
typedef enum kiln_sheen {
    KILN_SHEEN_ASHIKHMIN, ///< 1 / (4 (n.l + n.v - n.l n.v)), Filament's and most viewers'; the default
    KILN_SHEEN_ESTEVEZ    ///< Estevez and Kulla's fit of Lambda, as KHR_materials_sheen gives it
} kiln_sheen;

/// The directional albedo of Charlie sheen of colour 1, alpha = roughness^2, roughness at least 0.01.
/// It exceeds 1 at grazing angles: neither masking conserves energy. Source: docs/theory/sheen.md.
KILN_API double kiln_sheen_albedo(kiln_sheen sheen, double roughness, double nov);

/// Rough glass, exact Fresnel: rt[0] of the light from n.v is reflected and rt[1] transmitted by one
/// microfacet; the rest is lost to further bounces. ior = n beyond / n on the side of v: below 1 from
/// the inside; clamped to [1/16, 16]. Error below 2e-6, from the inside with ior next to 1 and n.v below
/// 1e-3 6e-6. KILN_G_SMITH hides transmitted light by Heitz's beta function, the others by the
/// product. Source: docs/theory/glass.md.
KILN_API void kiln_glass(const kiln_model *model, double roughness, double ior, double nov,
                         double rt[2]);
/// 2 int R mu dmu and 2 int T mu dmu. Reciprocity: T_avg(ior) = ior^2 T_avg(1 / ior).
KILN_API void kiln_glass_average(const kiln_model *model, double roughness, double ior,
                                 double rt[2]);

// ------------------------------------------------------------------------- compensation of energy

// The specular lobe leaves out light that bounces more than once between the microfacets. With E(mu)
// its albedo for F = 1 and E_avg = 2 int E mu dmu, these put it back. See docs/theory/compensation.md.

/// Which factor colours the added lobe; f = F_avg.
typedef enum kiln_f_add {
    KILN_F_ADD_SECOND,    ///< f^2 E_avg / (1 - f (1 - E_avg)): all bounces from the second one on
    KILN_F_ADD_ASSIGNMENT ///< f E_avg / (1 - f (1 - E_avg)), as taught: the first one too
} kiln_f_add;

/// Kulla and Conty 2017, F = 1: (1 - e_o) (1 - e_i) / (pi (1 - e_average)), reciprocal; its cosine
/// integral over i is 1 - e_o. Where e_average is 1 nothing is missing, and it is 0.
KILN_API double kiln_kulla_conty(double e_o, double e_i, double e_average);
/// The factor to that lobe for other Fresnel terms.
KILN_API double kiln_kulla_conty_fresnel(kiln_f_add form, double f_average, double e_average);
/// Turquin 2019: the factor 1 + f0 (1 - e) / e to the specular lobe, e = E(n.v).
KILN_API double kiln_turquin(double f0, double e);
/// Fdez-Aguera 2019 for image-based light: prefiltered radiance is multiplied by `single`,
/// irradiance / pi by `multiple`, where f0 a + b is the split sum's albedo and e = a + b.
KILN_API void kiln_fdez_aguera(double f0, double a, double b, double *single, double *multiple);
/// The factor to the specular lobe that brings its albedo to the random walk's: 1 + added / e_single,
/// where e_single = f0 a + b and `added` is what KILN_TABLE_E_WALK shows, or kiln_walk_albedo's
/// albedo - bounce[0].
KILN_API double kiln_compensate_walk(double e_single, double added);

/// The F of a walk's microfacets.
typedef enum kiln_walk_fresnel {
    KILN_WALK_SCHLICK,  ///< of f0
    KILN_WALK_CONSTANT, ///< f0 itself; 1 is the white furnace
    KILN_WALK_CONDUCTOR ///< exact, of n and k
} kiln_walk_fresnel;

/// {0} is a good default: Schlick's F of f0 = 0, 65536 paths.
typedef struct kiln_walk_def {
    kiln_walk_fresnel fresnel;
    double f0;      ///< 0 to 1
    double n, k;    ///< as for kiln_fresnel_conductor
    int path_count; ///< rounded up to a power of 2, 32 to 2^24; 0 for 65536
    uint32_t seed;  ///< other paths; their difference is as the standard error says
} kiln_walk_def;

enum { KILN_WALK_BOUNCES = 16 };

/// The share of the light that comes back, with all bounces.
typedef struct kiln_walk {
    double albedo;
    double standard_error;            ///< of the albedo, from 16 independent parts
    double bounce[KILN_WALK_BOUNCES]; ///< the albedo by the number of bounces: 1, 2, ..., the rest
    int path_count;                   ///< walked
} kiln_walk;

/// Ground truth for all of these: a random walk between the microfacets of GGX (Heitz, Hanika, d'Eon
/// and Dachsbacher 2016), whose single bounce is the height-correlated Smith model. The same bits
/// everywhere. Source, cost and error: docs/theory/walk.md.
KILN_API void kiln_walk_albedo(const kiln_walk_def *def, double roughness, double nov,
                               kiln_walk *walk);

// ------------------------------------------------------------------------------------------ tables

enum { KILN_MAX_TABLE = 4096 };

/// What a table holds. u runs along n.v, v along roughness, w (slices) along the third argument: F0
/// itself, or for an ior from 1 to 3 w = 2 (ior - 1) / (ior + 1), which is 2 sqrt(F0), so
/// ior = (2 + w) / (2 - w).
typedef enum kiln_table_kind {
    KILN_TABLE_E,                ///< E, one channel: the directional albedo of F = 1
    KILN_TABLE_E_AVERAGE,        ///< E_avg, one channel, one texel wide: 2 int E(mu) mu dmu
    KILN_TABLE_DFG,              ///< A, B: specular albedo = F0 A + B
    KILN_TABLE_DFG_MULTISCATTER, ///< B, A + B and the cloth's albedo, as Filament orders them
    KILN_TABLE_SHEEN,            ///< directional albedo of Charlie sheen, one channel
    KILN_TABLE_E_DIELECTRIC,     ///< E of a rough dielectric's reflection, w along the ior
    KILN_TABLE_GLASS,            ///< reflected, transmitted from outside, the same from inside
    KILN_TABLE_E_WALK ///< what later bounces add by random walk, w along F0: the albedo with all
                      ///< bounces E(n.v, roughness, F0) is F0 A + B + this, to 2e-3
} kiln_table_kind;

/// How n.v runs along u: the warped axes resolve the grazing layer, where E changes fast.
typedef enum kiln_axis {
    KILN_AXIS_LINEAR, ///< u = n.v
    KILN_AXIS_SQRT,   ///< u = (n.v)^(1/2)
    KILN_AXIS_CBRT,   ///< u = (n.v)^(1/3)
    KILN_AXIS_GRAZING ///< u = sqrt(n.v (1 + c) / (n.v + c)), for E: errs least by far. c is alpha,
                      ///< for Schlick's text k / (1 - k), so that every row has its layer alike
} kiln_axis;

/// What files and the command call these choices: names in the order of the enum, NULL behind the last.
KILN_API const char *const *kiln_d_names(void);
KILN_API const char *const *kiln_g_names(void);
KILN_API const char *const *kiln_sheen_names(void);
KILN_API const char *const *kiln_table_kind_names(void);
KILN_API const char *const *kiln_axis_names(void);

/// {0} is a good default: E of the default model, 128 x 128, u = n.v, texel centres.
typedef struct kiln_table_def {
    kiln_table_kind kind;
    kiln_model model;
    kiln_sheen sheen; ///< KILN_TABLE_SHEEN only
    /// 1 to KILN_MAX_TABLE; 0 for 128 x 128, 32 x 32 x 32 where there is w,
    /// 40 x 32 x 20 of the walk. E_avg is one texel wide.
    int width, height, depth;
    kiln_axis axis;  ///< KILN_TABLE_E_WALK has the grazing one and corners, without being asked
    bool corners;    ///< texel i stands at i / (n - 1), else at (i + 1/2) / n, of each axis
    bool complement; ///< 1 - value: 1 - E keeps its precision where E is near 1
    bool flip;       ///< row 0 holds roughness 1, for loaders that turn pictures over
    int path_count; ///< random walks a texel, KILN_TABLE_E_WALK only, as in kiln_walk_def; 0 for 8192
} kiln_table_def;

/// A table, its slices one below the other in `image`: width x (height * depth).
typedef struct kiln_table {
    kiln_table_def def; ///< as made: nothing is left 0 for a default
    kiln_image image;
} kiln_table;

/// Fills a table; `def` may be NULL. Texels are the integrals rounded to floats; large tables of E come
/// from a series that is within 7e-8 of it.
KILN_API KILN_CHECKED kiln_result kiln_table_create(kiln_context *context,
                                                    const kiln_table_def *def, kiln_table *table,
                                                    kiln_error *error);
KILN_API void kiln_table_free(kiln_table *table);
/// E_avg of what looking up a table of E shows, rather than of E: with it Kulla and Conty's lobe gives
/// back exactly what the table says is missing, and the furnace errs by no more than the lookup.
/// `height` texels, 0 for 1024.
KILN_API KILN_CHECKED kiln_result kiln_table_average(kiln_context *context, const kiln_table *table,
                                                     int height, kiln_table *average,
                                                     kiln_error *error);
/// What a texel stands for.
KILN_API void kiln_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                               double *roughness, double *third);
/// The value between texels, interpolated as graphics hardware does, with the complement undone.
/// `third` counts where the kind has one. `values` receives the table's channels.
KILN_API void kiln_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                                double *values);

// ------------------------------------------------------------------------------------ closed forms

/// What a closed form stands for, in n.v and roughness.
typedef enum kiln_fit_kind {
    KILN_FIT_E,         ///< E
    KILN_FIT_E_AVERAGE, ///< E_avg, of roughness alone
    KILN_FIT_DFG,       ///< A and B of the split sum
    KILN_FIT_SHEEN      ///< albedo of Charlie sheen, KILN_SHEEN_ASHIKHMIN
} kiln_fit_kind;

typedef enum kiln_fit_form {
    KILN_FIT_AUTO, ///< whichever has fewer coefficients
    KILN_FIT_POLYNOMIAL,
    KILN_FIT_RATIONAL
} kiln_fit_form;

/// {0} is a good default: E of the default model to 1e-3.
typedef struct kiln_fit_def {
    kiln_fit_kind kind;
    kiln_model model;
    kiln_fit_form form;
    double error;         ///< largest wanted anywhere, 1e-6 to 0.5; 0 for 1e-3
    double roughness_min; ///< 0 to 0.9, below which the form is not asked for and its argument
                          ///< clamped; sheen at least 0.1
    int max_coefficients; ///< of a part, 1 to KILN_MAX_FIT; 0 for KILN_MAX_FIT
} kiln_fit_def;

enum { KILN_MAX_FIT = 160, KILN_MAX_FIT_TERMS = 12 };

/// x of a part, scaled to [-1, 1]: t = n.v (1 + c) / (n.v + c), with c as on KILN_AXIS_GRAZING.
typedef enum kiln_fit_axis {
    KILN_FIT_AXIS_NONE,
    KILN_FIT_AXIS_T,
    KILN_FIT_AXIS_SQRT_T,
    KILN_FIT_AXIS_NOV,
    KILN_FIT_AXIS_SQRT_NOV
} kiln_fit_axis;

/// P(x, y) / Q(x, y), y the roughness scaled to [-1, 1]; the coefficient of x^i y^j is
/// p[j * x_count + i]. Q has the same powers, q[0] = 1 and no zero on the square, which is proven;
/// a polynomial has no q.
typedef struct kiln_fit_part {
    kiln_fit_axis axis;
    bool rational;
    int x_count, y_count;
    float p[KILN_MAX_FIT], q[KILN_MAX_FIT];
} kiln_fit_part;

/// A closed form: its one part; or for KILN_FIT_DFG, with F5 = (1 - n.v)^5, B = F5 part[0] + part[1]
/// and A = part[0] - B, so that part[0] is E.
typedef struct kiln_fit {
    kiln_fit_def def; ///< as made: nothing is left 0 for a default
    int part_count;
    kiln_fit_part part[2];
    int coefficient_count;
    double max_error, rms_error; ///< measured in floats against the integrals
} kiln_fit;

/// Finds the form with the fewest coefficients that errs by def->error at most at some 40000 points,
/// evaluated in floats as the code that kiln_fit_save writes does. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_fit_create(kiln_context *context, const kiln_fit_def *def,
                                                  kiln_fit *fit, kiln_error *error);
/// `values` receives two numbers, A and B, for KILN_FIT_DFG, else one.
KILN_API void kiln_fit_evaluate(const kiln_fit *fit, float nov, float roughness, float *values);
/// Writes a function of that name, as C (.h) or GLSL ES 3.00 (.glsl). `name` is an identifier; NULL
/// for kiln_e, kiln_e_average, kiln_dfg or kiln_sheen.
KILN_API KILN_CHECKED kiln_result kiln_fit_save(kiln_context *context, const kiln_fit *fit,
                                                const char *name, const char *path,
                                                kiln_error *error);

// -------------------------------------------------------------------------------- files of tables

/// How a table's numbers are stored.
typedef enum kiln_table_format {
    KILN_TABLE_FORMAT_AUTO = 0, ///< halves in KTX2 and .inc, 16 bits in PNG, else floats
    KILN_TABLE_FORMAT_F32,
    KILN_TABLE_FORMAT_F16,
    KILN_TABLE_FORMAT_U16, ///< 0 to 1 in 65535 steps, clamped
    KILN_TABLE_FORMAT_U8,  ///< 0 to 1 in 255 steps, clamped
    KILN_TABLE_FORMAT_RGBD ///< PNG of three channels, each (c D)^(1 / 2.2), and D: to 255, Babylon.js'
} kiln_table_format;

/// {0} is a good default.
typedef struct kiln_table_save_def {
    kiln_table_format format;
    int zstd;         ///< KTX2: compression level 1 to 22, 0 for none
    const char *name; ///< what names in .h and .glsl begin with; NULL for the file's own name
} kiln_table_save_def;

/// Fails, as kiln_table_save would, where a file of that ending cannot be saved so. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_table_save_check(const char *path,
                                                        const kiln_table_save_def *def,
                                                        kiln_error *error);

/// Writes a table whole or not at all. By ending (docs/tables.md says what is in each):
///   .ktx2          a 2-D texture, or a 3-D one where there are slices
///   .exr .hdr .png slices one below the other; two channels are red and green
///   .raw .bin      the numbers alone, little-endian
///   .h             a C array of floats, at most 4194304 of them
///   .inc           halves as hexadecimal numbers with commas, as Filament's cmgen writes its table
///   .glsl          a constant array and its lookup, at most 65536 bytes
/// `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_table_save(kiln_context *context, const kiln_table *table,
                                                  const char *path, const kiln_table_save_def *def,
                                                  kiln_error *error);
/// Reads a KTX2 table that kiln wrote.
KILN_API KILN_CHECKED kiln_result kiln_table_load(kiln_context *context, const char *path,
                                                  kiln_table *table, kiln_error *error);
/// Writes source code that looks up tables made with this def (of a kiln_table): .h, a C99 and C++
/// function on an array of floats; .glsl, a GLSL ES 3.00 function on a texture, which the sampler
/// must filter linearly and clamp at the edge. Names begin with `name`; NULL for the file's own name
/// without "_lookup".
KILN_API KILN_CHECKED kiln_result kiln_table_lookup_save(kiln_context *context,
                                                         const kiln_table_def *def,
                                                         const char *path, const char *name,
                                                         kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
