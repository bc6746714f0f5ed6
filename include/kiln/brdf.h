// kiln: how surfaces reflect and transmit light: reflection models as functions of numbers, tables
// of their integrals, and closed forms for shaders.
//
// The sections follow one another in this order:
//   microfacet models -> compensation of lost energy -> tables -> closed forms -> files of tables.
// The functions of numbers are exact, or their comment states the error. Tables and closed forms
// hold the same functions for shaders. <kiln/kiln.h>, which this header includes, states the
// conventions and declares the functions for environments; neither header needs the functions of
// the other.
// SPDX-License-Identifier: MIT
#ifndef KILN_BRDF_H
#define KILN_BRDF_H

#include <kiln/kiln.h>

#ifdef __cplusplus
extern "C" {
#endif

// ------------------------------------------------------------------------------ microfacet models

/// Distribution D of the microfacet normals.
typedef enum kiln_d {
    KILN_D_GGX,     ///< GGX: Trowbridge and Reitz 1975, Walter et al. 2007
    KILN_D_BECKMANN ///< Gaussian slopes (Beckmann), with Smith's masking for this distribution
} kiln_d;

/// Masking and shadowing G of the microfacets: Smith's, or Schlick's approximation with one of its
/// two common definitions of k.
typedef enum kiln_g {
    KILN_G_SMITH,              ///< height-correlated Smith (Heitz 2014, eq. 99); the default
    KILN_G_SMITH_UNCORRELATED, ///< uncorrelated Smith: the product G1(v) G1(l)
    KILN_G_SCHLICK_K2,         ///< Schlick with k = roughness^2 / 2 (Karis 2013, image-based light)
    /// Schlick with k = (roughness + 1)^2 / 8 (Karis 2013, point lights).
    KILN_G_SCHLICK_TEXT
} kiln_g;

/// A microfacet reflection model. {0} is GGX with height-correlated Smith masking.
typedef struct kiln_model {
    kiln_d d;
    kiln_g g;
} kiln_model;

// The following functions of numbers cannot fail: an argument outside its range is clamped to the
// range. nov, nol and noh are the cosines n.v, n.l and n.h, and voh is v.h = l.h, all in [0, 1].
// alpha = roughness^2. At roughness 0 a function returns its limit for fixed cosines as roughness
// tends to 0. At a cosine of 0 it returns the limit as the cosine tends to 0.

/// Returns D per steradian, normalised by int D(h) (n.h) dh = 1. Infinite at roughness 0 and noh 1.
KILN_API double kiln_brdf_d(kiln_d d, double roughness, double noh);
/// Returns G in [0, 1], which is symmetric in nov and nol. Schlick's two forms of G do not depend
/// on the distribution D.
KILN_API double kiln_brdf_g(const kiln_model *model, double roughness, double nov, double nol);
/// Returns the specular lobe for F = 1, D G / (4 nov nol), per steradian. Where nov or nol is 0,
/// the limit of G / (nov nol) is used, which is finite. Where both cosines are 0, the result is
/// infinite for models whose limit is infinite.
KILN_API double kiln_brdf_specular(const kiln_model *model, double roughness, double nov,
                                   double nol, double noh);

/// Returns Schlick's (1994) Fresnel reflectance f0 + (1 - f0) (1 - voh)^5.
KILN_API double kiln_fresnel_schlick(double f0, double voh);
/// Returns a metal's Fresnel reflectance: Schlick's reduced by a voh (1 - voh)^6 (Lazanyi and
/// Szirmay-Kalos 2005). The number a is chosen so that F equals `f82` at voh = 1 / 7, which is 82
/// degrees (Kutz et al. 2021). The result is clamped to [0, 1].
KILN_API double kiln_fresnel_f82(double f0, double f82, double voh);
/// Returns the reflectance of a dielectric for unpolarised light. ior is n_transmitted /
/// n_incident, 0 to 1e8. Total internal reflection gives 1.
KILN_API double kiln_fresnel_dielectric(double ior, double voh);
/// Returns the reflectance of a conductor for unpolarised light. The complex index n + i k is
/// relative to the medium outside; n and k are each 0 to 1e8.
KILN_API double kiln_fresnel_conductor(double n, double k, double voh);
/// Sets the index n + i k of a metal from its reflectivity at normal incidence (0 to 0.9999) and
/// its edge tint (0 to 1), by Gulbrandsen 2014. The formulas are factored so that k loses no
/// digits, and the index gives the reflectivity again.
KILN_API void kiln_gulbrandsen(double reflectivity, double edge_tint, double *n, double *k);

/// Returns the average of Schlick's reflectance, F_avg = 2 int F(mu) mu dmu from 0 to 1, which is
/// exactly (1 + 20 f0) / 21.
KILN_API double kiln_fresnel_schlick_average(double f0);
/// Returns F_avg of kiln_fresnel_f82, (1 + 20 f0) / 21 - a / 126. The formula is exact where no
/// value is clamped: for f0 of at least 0.2 and f82 from f0 to Schlick's F at 82 degrees.
KILN_API double kiln_fresnel_f82_average(double f0, double f82);
/// Returns F_avg of kiln_fresnel_dielectric by Walsh's closed form (1926), with reciprocity for ior
/// < 1. Error below 1e-14.
KILN_API double kiln_fresnel_dielectric_average(double ior);
/// Returns F_avg of kiln_fresnel_conductor by adaptive quadrature. Error below 1e-12.
KILN_API double kiln_fresnel_conductor_average(double n, double k);
/// Returns Kulla and Conty's fit (Imageworks 2017) to the F_avg of a dielectric, for ior 0 to 400.
/// The fit errs by at most 0.0065 for ior above 1 and by 0.0029 below 1.
KILN_API double kiln_fresnel_dielectric_average_fit(double ior);
/// Returns Kulla and Conty's polynomial for the F_avg of a conductor in Gulbrandsen's parameters.
/// The polynomial errs by at most 0.10, and by 0.014 RMS.
KILN_API double kiln_fresnel_conductor_average_fit(double reflectivity, double edge_tint);

// Samplers take xi uniform in [0, 1)^2 and use the normal n = (0, 0, 1); densities are per
// steradian. A sampled half vector h gives the light direction l = 2 (v.h) h - v. If l is below the
// surface, the sample counts with weight 0.

/// Samples a light direction l with the density (n.l) / pi.
KILN_API void kiln_sample_cosine(const double xi[2], double l[3]);
KILN_API double kiln_pdf_cosine(double nol);
/// Samples a half vector h with the density D(h) (n.h). Walter et al. 2007, eqs. 28 and 35.
KILN_API void kiln_sample_half_vector(kiln_d d, double roughness, const double xi[2], double h[3]);
KILN_API double kiln_pdf_half_vector(kiln_d d, double roughness, double noh);
/// Samples a half vector h among the GGX normals visible from the unit vector v (v[2] >= 0), with
/// the density G1(v) D(h) (v.h) / (n.v). Heitz 2018, by the spherical caps of Dupuy and Benyoub
/// 2023.
KILN_API void kiln_sample_visible(double roughness, const double v[3], const double xi[2],
                                  double h[3]);
KILN_API double kiln_pdf_visible(double roughness, double nov, double noh, double voh);
/// Returns the density of l = 2 (v.h) h - v if h has the density `pdf`: pdf / (4 voh).
KILN_API double kiln_pdf_reflection(double pdf, double voh);

// Albedo of a rough surface for light that bounces once, with later bounces lost: a white surface
// in a white furnace lacks 1 - E. The functions compute one-dimensional integrals with errors below
// 1e-11, or 1e-8 for Beckmann. Arguments outside [0, 1] are clamped. The values at roughness 0 are
// limits as roughness tends to 0, and the values at nov 0 are limits of those as nov tends to 0.
// Source: docs/theory/energy.md.

/// Returns the directional albedo for F = 1, E(n.v) = int f (n.l) dl, where f is the specular lobe.
KILN_API double kiln_energy(const kiln_model *model, double roughness, double nov);
/// Returns the average albedo for F = 1, E_avg = 2 int_0^1 E(mu) mu dmu.
KILN_API double kiln_energy_average(const kiln_model *model, double roughness);
/// Sets ab to A and B of the split sum: with Schlick's F the directional albedo is f0 A + B.
KILN_API void kiln_energy_split(const kiln_model *model, double roughness, double nov,
                                double ab[2]);

/// Masking of Charlie sheen, a model of cloth.
typedef enum kiln_sheen {
    /// 1 / (4 (n.l + n.v - n.l n.v)), as in Filament and most viewers; the default.
    KILN_SHEEN_ASHIKHMIN,
    KILN_SHEEN_ESTEVEZ ///< Estevez and Kulla's fit of Lambda, as in KHR_materials_sheen
} kiln_sheen;

/// Returns the directional albedo of Charlie sheen of colour 1 with alpha = roughness^2 and
/// roughness at least 0.01. The albedo exceeds 1 at grazing angles, since neither masking conserves
/// energy. Source: docs/theory/sheen.md.
KILN_API double kiln_sheen_albedo(kiln_sheen sheen, double roughness, double nov);

/// Computes the albedo of rough glass with the exact Fresnel reflectance. Of the light that arrives
/// at n.v, one microfacet reflects the share rt[0] and transmits the share rt[1]; the remaining
/// share is lost to further bounces. ior is n on the far side / n on the side of v, so it is below
/// 1 from inside the glass; it is clamped to [1/16, 16]. KILN_G_SMITH masks transmitted light by
/// Heitz's beta function, the other models by the product of two G1. Error below 2e-6, or 6e-6 from
/// inside with an ior close to 1 and n.v below 1e-3. Source: docs/theory/glass.md.
KILN_API void kiln_glass(const kiln_model *model, double roughness, double ior, double nov,
                         double rt[2]);
/// Sets rt to the averages 2 int R mu dmu and 2 int T mu dmu of the reflected and transmitted
/// shares R and T of kiln_glass. Reciprocity: T_avg(ior) = ior^2 T_avg(1 / ior).
KILN_API void kiln_glass_average(const kiln_model *model, double roughness, double ior,
                                 double rt[2]);

// ------------------------------------------------------------------------- compensation of energy

// The specular lobe omits light that bounces more than once between the microfacets. The functions
// of this section restore that light from the lobe's albedo for F = 1, E(mu), and its average E_avg
// = 2 int E mu dmu. Source: docs/theory/compensation.md.

/// Factor that colours the added lobe, in terms of f = F_avg.
typedef enum kiln_f_add {
    /// f^2 E_avg / (1 - f (1 - E_avg)), f = F_avg: sums all bounces from the second on
    KILN_F_ADD_SECOND,
    /// F E_avg / (1 - f (1 - E_avg)), f = F_avg: sums all bounces from the first on, as in courses.
    KILN_F_ADD_ASSIGNMENT
} kiln_f_add;

/// Returns Kulla and Conty's (2017) added lobe for F = 1: (1 - e_o) (1 - e_i) / (pi (1 -
/// e_average)). The lobe is reciprocal, and its cosine integral over i is 1 - e_o. Returns 0 where
/// e_average is 1 and no light is missing.
KILN_API double kiln_kulla_conty(double e_o, double e_i, double e_average);
/// Returns the factor by which kiln_kulla_conty is multiplied for a Fresnel term of average
/// f_average.
KILN_API double kiln_kulla_conty_fresnel(kiln_f_add form, double f_average, double e_average);
/// Returns Turquin's (2019) factor for the specular lobe, 1 + f0 (1 - e) / e, where e = E(n.v).
KILN_API double kiln_turquin(double f0, double e);
/// Computes Fdez-Aguera's (2019) factors for image-based light: prefiltered radiance is multiplied
/// by *single, irradiance / pi by *multiple. f0 a + b is the split sum's albedo, and e = a + b its
/// value for f0 = 1.
KILN_API void kiln_fdez_aguera(double f0, double a, double b, double *single, double *multiple);
/// Returns the factor by which the specular lobe reaches the albedo of the random walk: 1 + added /
/// e_single. e_single is f0 a + b; `added` is a value of KILN_TABLE_E_WALK, or the difference
/// albedo - bounce[0] of kiln_walk_albedo.
KILN_API double kiln_compensate_walk(double e_single, double added);

/// Fresnel reflectance of the microfacets in a random walk.
typedef enum kiln_walk_fresnel {
    KILN_WALK_SCHLICK,  ///< Schlick's reflectance with f0
    KILN_WALK_CONSTANT, ///< the constant f0; 1 for a white furnace
    KILN_WALK_CONDUCTOR ///< the exact reflectance of a conductor with n and k
} kiln_walk_fresnel;

/// Parameters of a random walk between microfacets. {0} selects Schlick's reflectance with f0 = 0
/// and 65536 paths.
typedef struct kiln_walk_def {
    kiln_walk_fresnel fresnel;
    double f0;      ///< reflectance at normal incidence, 0 to 1
    double n, k;    ///< complex index of a conductor, as for kiln_fresnel_conductor
    int path_count; ///< number of paths, rounded up to a power of 2, 32 to 2^24; 0 for 65536
    uint32_t seed;  ///< selects other random paths; results then differ by about the standard error
} kiln_walk_def;

enum { KILN_WALK_BOUNCES = 16 };

/// The share of light that a surface reflects with all bounces, as estimated by a random walk.
typedef struct kiln_walk {
    double albedo;
    /// Standard error of the albedo, from 16 independent groups of paths.
    double standard_error;
    /// Albedo by the number of bounces: 1, 2, ...; the last entry counts all further bounces.
    double bounce[KILN_WALK_BOUNCES];
    int path_count; ///< number of paths that were walked
} kiln_walk;

/// Estimates the albedo with all bounces by a random walk between the microfacets of GGX (Heitz,
/// Hanika, d'Eon and Dachsbacher 2016), as ground truth for the compensations above. The part with
/// a single bounce is the height-correlated Smith model. Results are bit-identical on every
/// machine. Source, cost and error: docs/theory/walk.md.
KILN_API void kiln_walk_albedo(const kiln_walk_def *def, double roughness, double nov,
                               kiln_walk *walk);

// ------------------------------------------------------------------------------------------ tables

enum { KILN_MAX_TABLE = 4096 };

/// The function that a table holds. Columns u run along n.v, rows v along roughness, and slices w
/// of 3-D tables along a third argument: F0, or an ior from 1 to 3 with w = 2 (ior - 1) / (ior +
/// 1). That w equals 2 sqrt(F0), and ior = (2 + w) / (2 - w).
typedef enum kiln_table_kind {
    KILN_TABLE_E,                ///< E, the directional albedo for F = 1; one channel
    KILN_TABLE_E_AVERAGE,        ///< E_avg = 2 int E(mu) mu dmu; one channel, one texel wide
    KILN_TABLE_DFG,              ///< A and B: specular albedo = F0 A + B
    KILN_TABLE_DFG_MULTISCATTER, ///< B, A + B and the albedo of sheen, in Filament's order
    KILN_TABLE_SHEEN,            ///< directional albedo of Charlie sheen; one channel
    KILN_TABLE_E_DIELECTRIC,     ///< E of a rough dielectric's reflection, with w along the ior
    /// Shares of light that rough glass reflects and transmits from outside, then both from inside;
    /// four channels.
    KILN_TABLE_GLASS,
    /// The part of the albedo that is due to light reflected twice or more between microfacets,
    /// computed by random walks, with w along F0. The albedo of all bounces is F0 A + B plus the
    /// table's value, with an error below 2e-3.
    KILN_TABLE_E_WALK,
    /// The lobe of a GGX surface as 1 to 3 taps of prefiltered levels and six coefficients for the
    /// environment's harmonics; four channels and one slice more than taps. See kiln_table_lookup
    /// and docs/theory/lobes.md.
    KILN_TABLE_LOBES
} kiln_table_kind;

/// Greatest number of taps of KILN_TABLE_LOBES, and of numbers that kiln_table_lookup sets.
enum { KILN_MAX_TAPS = 3, KILN_MAX_TABLE_VALUES = 16 };

/// How n.v depends on u. The nonlinear axes place more texels at grazing angles, where E changes
/// fast.
typedef enum kiln_axis {
    KILN_AXIS_LINEAR, ///< u = n.v
    KILN_AXIS_SQRT,   ///< u = (n.v)^(1/2)
    KILN_AXIS_CBRT,   ///< u = (n.v)^(1/3)
    /// The most exact axis for E by far: u = sqrt(n.v (1 + c) / (n.v + c)). c is alpha, or k / (1 -
    /// k) for KILN_G_SCHLICK_TEXT, so that the fast change near n.v = 0 covers the same part of
    /// every row.
    KILN_AXIS_GRAZING
} kiln_axis;

/// Return the names of these choices in files and on the command line, in the order of the enum,
/// with NULL after the last name.
KILN_API const char *const *kiln_d_names(void);
KILN_API const char *const *kiln_g_names(void);
KILN_API const char *const *kiln_sheen_names(void);
KILN_API const char *const *kiln_table_kind_names(void);
KILN_API const char *const *kiln_axis_names(void);

/// Parameters of a table. {0} selects E of the default model, 128 x 128 texels, u = n.v, texel
/// centres at (i + 1/2) / n.
typedef struct kiln_table_def {
    kiln_table_kind kind;
    kiln_model model;
    /// Masking of sheen; only for KILN_TABLE_SHEEN.
    kiln_sheen sheen;
    /// Size of the table in texels, 1 to KILN_MAX_TABLE. 0 selects 128 x 128, or 32 x 32 x 32 for a
    /// 3-D table, or 40 x 32 x 20 for KILN_TABLE_E_WALK. A table of E_avg is one texel wide.
    int width, height, depth;
    /// How the column's coordinate u depends on n.v. KILN_TABLE_E_WALK always has KILN_AXIS_GRAZING
    /// and `corners`.
    kiln_axis axis;
    /// true: texel i of n lies at i / (n - 1) of each axis; false: at (i + 1/2) / n.
    bool corners;
    bool complement; ///< true: stores 1 - value, since 1 - E keeps its precision where E is near 1
    /// true: row 0 holds roughness 1 instead of 0, for loaders that flip pictures vertically
    bool flip;
    /// Number of random walks per texel, only for KILN_TABLE_E_WALK, rounded as in kiln_walk_def; 0
    /// for 8192.
    int path_count;
    /// Number of taps, only for KILN_TABLE_LOBES, 1 to KILN_MAX_TAPS; 0 for 1.
    int tap_count;
    /// Number of levels of the prefiltered environment that taps read, only for KILN_TABLE_LOBES, 2
    /// to KILN_MAX_LEVELS; 0 for 7.
    int level_count;
    /// Roughness of each level, increasing, 0 to 1, only for KILN_TABLE_LOBES. All 0 stands for
    /// equal steps from 0 to 1.
    float level_roughness[KILN_MAX_LEVELS];
} kiln_table_def;

/// A table. `image` holds the slices one below the other: width x (height * depth) texels.
typedef struct kiln_table {
    kiln_table_def def; ///< parameters of the table, with each default replaced by its value
    kiln_image image;
} kiln_table;

/// Computes a table. Texels are the integrals rounded to floats; large tables of E come from a
/// series whose error is at most 7e-8. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_table_create(kiln_context *context,
                                                    const kiln_table_def *def, kiln_table *table,
                                                    kiln_error *error);
KILN_API void kiln_table_free(kiln_table *table);
/// Computes E_avg from the values that lookups in a table of E return, instead of from E. Kulla and
/// Conty's lobe with this average restores exactly the light that the table lacks, so that the
/// error of the white furnace is at most the error of the lookup. The result has `height` texels, 0
/// for 1024.
KILN_API KILN_CHECKED kiln_result kiln_table_average(kiln_context *context, const kiln_table *table,
                                                     int height, kiln_table *average,
                                                     kiln_error *error);
/// Sets *nov, *roughness and *third to the arguments for which a texel holds the value.
KILN_API void kiln_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                               double *roughness, double *third);
/// Sets `values`, one number for each channel, to the table's value interpolated between texels as
/// graphics hardware does. A stored complement is undone. `third` is used only by tables with a
/// third argument. Tables of KILN_TABLE_LOBES give the 4 (tap_count + 1) numbers of all slices: for
/// each tap the lean, the level, the weight and one coefficient, then four coefficients.
KILN_API void kiln_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                                double *values);

/// Expected errors of three lookups of reflected light, relative to the standard deviation of the
/// reflected light itself: 0.1 stands for 10 %. Expectations are over environments whose harmonics
/// of degree l are independent and have the variance l^-3, for which tables are fitted.
typedef struct kiln_lobes_error {
    double straight; ///< the split sum's lookup in the mirror direction
    double bent;     ///< the same in the dominant direction of Lagarde and de Rousiers (2014)
    double table;    ///< the taps and coefficients of the table
} kiln_lobes_error;

/// Sets errors[i] to the expected errors at nov[i] and roughness[i], i < count, of lookups in a
/// table of KILN_TABLE_LOBES. Between texels the table is interpolated. Source:
/// docs/theory/lobes.md.
KILN_API KILN_CHECKED kiln_result kiln_lobes_errors(kiln_context *context, const kiln_table *table,
                                                    const double *nov, const double *roughness,
                                                    int count, kiln_lobes_error *errors,
                                                    kiln_error *error);

// ------------------------------------------------------------------------------------ closed forms

/// The function of n.v and roughness that a closed form approximates.
typedef enum kiln_fit_kind {
    KILN_FIT_E,         ///< E, the directional albedo for F = 1
    KILN_FIT_E_AVERAGE, ///< E_avg, a function of roughness alone
    KILN_FIT_DFG,       ///< A and B of the split sum
    KILN_FIT_SHEEN      ///< albedo of Charlie sheen with KILN_SHEEN_ASHIKHMIN
} kiln_fit_kind;

typedef enum kiln_fit_form {
    KILN_FIT_AUTO, ///< polynomial or rational, whichever has fewer coefficients
    KILN_FIT_POLYNOMIAL,
    KILN_FIT_RATIONAL
} kiln_fit_form;

/// Parameters of a closed form. {0} selects E of the default model with an error of at most 1e-3.
typedef struct kiln_fit_def {
    kiln_fit_kind kind;
    kiln_model model;
    kiln_fit_form form;
    double error; ///< largest absolute error of the form, 1e-6 to 0.5; 0 for 1e-3
    /// Smallest roughness for which the closed form is fitted, 0 to 0.9, at least 0.1 for sheen.
    /// The form clamps a smaller roughness to this value.
    double roughness_min;
    /// Largest number of coefficients of each part of the form, 1 to KILN_MAX_FIT; 0 for
    /// KILN_MAX_FIT.
    int max_coefficients;
} kiln_fit_def;

enum { KILN_MAX_FIT = 160, KILN_MAX_FIT_TERMS = 12 };

/// Which function of n.v and roughness the argument x of P and Q in a kiln_fit_part is, before it
/// is scaled to [-1, 1]: none (P and Q depend on the roughness alone), t, sqrt(t), n.v or
/// sqrt(n.v). Here t = n.v (1 + c) / (n.v + c), with the c of KILN_AXIS_GRAZING.
typedef enum kiln_fit_axis {
    KILN_FIT_AXIS_NONE,
    KILN_FIT_AXIS_T,
    KILN_FIT_AXIS_SQRT_T,
    KILN_FIT_AXIS_NOV,
    KILN_FIT_AXIS_SQRT_NOV
} kiln_fit_axis;

/// A rational function P(x, y) / Q(x, y). x is the function of n.v and roughness that `axis` names.
/// y is linear in the roughness: -1 at roughness_min of the kiln_fit_def, 1 at roughness 1. p[j *
/// x_count + i] is the coefficient of x^i y^j in P. Q has the same powers, q[0] = 1 and no zero on
/// the square [-1, 1]^2, which kiln proves. Without `rational`, Q is 1 and q is not used.
typedef struct kiln_fit_part {
    kiln_fit_axis axis;
    bool rational;
    int x_count, y_count;
    float p[KILN_MAX_FIT], q[KILN_MAX_FIT];
} kiln_fit_part;

/// A closed form. KILN_FIT_DFG has two parts: with F5 = (1 - n.v)^5, B = F5 part[0] + part[1] and A
/// = part[0] - B, so that part[0] is E. The other kinds are part[0] alone.
typedef struct kiln_fit {
    kiln_fit_def def; ///< parameters of the form, with each default replaced by its value
    int part_count;
    kiln_fit_part part[2];
    int coefficient_count;
    /// absolute errors of the closed form, evaluated in floats, against the exact integrals
    double max_error, rms_error;
} kiln_fit;

/// Finds the closed form with the fewest coefficients whose error is at most def->error at some
/// 40000 points. The error is that of the float arithmetic in the code that kiln_fit_save writes.
/// `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_fit_create(kiln_context *context, const kiln_fit_def *def,
                                                  kiln_fit *fit, kiln_error *error);
/// Evaluates a closed form. `values` receives A and B for KILN_FIT_DFG, else one number.
KILN_API void kiln_fit_evaluate(const kiln_fit *fit, float nov, float roughness, float *values);
/// Writes a closed form as a C function (.h) or a GLSL ES 3.00 function (.glsl). `name` is the
/// identifier of the function; NULL for kiln_e, kiln_e_average, kiln_dfg or kiln_sheen.
KILN_API KILN_CHECKED kiln_result kiln_fit_save(kiln_context *context, const kiln_fit *fit,
                                                const char *name, const char *path,
                                                kiln_error *error);

// -------------------------------------------------------------------------------- files of tables

/// How the numbers of a table are stored.
typedef enum kiln_table_format {
    /// 16-bit floats in KTX2 and .inc, 16-bit integers in PNG, else 32-bit floats.
    KILN_TABLE_FORMAT_AUTO = 0,
    KILN_TABLE_FORMAT_F32,
    KILN_TABLE_FORMAT_F16,
    KILN_TABLE_FORMAT_U16, ///< 0 to 1 in 65535 steps; other values are clamped
    KILN_TABLE_FORMAT_U8,  ///< 0 to 1 in 255 steps; other values are clamped
    /// Babylon.js' format: a PNG with three channels x, stored as (x D)^(1 / 2.2), and D as the
    /// fourth. Values are at most 255.
    KILN_TABLE_FORMAT_RGBD
} kiln_table_format;

/// Options for saving a table. {0} selects the default of each option.
typedef struct kiln_table_save_def {
    kiln_table_format format;
    int zstd;         ///< zstd compression level of a KTX2 file, 1 to 22; 0 for no compression
    const char *name; ///< beginning of the names in .h and .glsl; NULL for the file's own name
} kiln_table_save_def;

/// Fails, with the error of kiln_table_save, if a table cannot be saved to this path with the
/// options `def`, which may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_table_save_check(const char *path,
                                                        const kiln_table_save_def *def,
                                                        kiln_error *error);

/// Writes a table to a file, which appears complete or not at all. The ending of `path` decides the
/// format; docs/tables.md describes each:
///   .ktx2          a 2-D texture, or a 3-D texture for a table with slices
///   .exr .hdr .png slices one below the other; two channels are red and green
///   .raw .bin      the numbers alone, little-endian
///   .h             a C array of floats, at most 4194304 of them
///   .inc           16-bit floats as hexadecimal numbers with commas, as Filament's cmgen writes
///   .glsl          a constant array and its lookup function, at most 65536 bytes
/// `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_table_save(kiln_context *context, const kiln_table *table,
                                                  const char *path, const kiln_table_save_def *def,
                                                  kiln_error *error);
/// Loads a table from a KTX2 file that kiln wrote.
KILN_API KILN_CHECKED kiln_result kiln_table_load(kiln_context *context, const char *path,
                                                  kiln_table *table, kiln_error *error);
/// Writes source code that looks up values in tables with the parameters `def`, the def of a
/// kiln_table. The ending .h gives a C99 and C++ function on an array of floats. The ending .glsl
/// gives a GLSL ES 3.00 function on a texture, whose sampler must filter linearly and clamp to the
/// edge. For KILN_TABLE_LOBES the functions also return the taps' directions and the weights of
/// nine harmonics (C) or reflected light (.glsl and .wgsl, from the table as a 3-D texture). Names
/// begin with `name`; NULL for the file's own name without "_lookup".
KILN_API KILN_CHECKED kiln_result kiln_table_lookup_save(kiln_context *context,
                                                         const kiln_table_def *def,
                                                         const char *path, const char *name,
                                                         kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
