// The parts of the fit behind tables of KILN_TABLE_LOBES. A GGX lobe f(v, l) (n.l) / E, seen at a
// cosine n.v, is approximated by a few taps of prefiltered levels and by six coefficients that make
// bands 0 to 2 exact. docs/theory/lobes.md derives the method.
//
// All directions that matter lie in the plane of incidence and are given by their angle in radians
// from the normal, positive on the side of the mirror direction. The error of an approximation is
// its mean square under light whose coefficients of degree l have the variance of ki_lobes_variance
// and are independent.
#ifndef KI_LOBES_H
#define KI_LOBES_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Intervals of the tables over the angle between two directions, highest degree of the spherical
/// harmonics that the error counts, and angles at which a target is tabulated.
enum { KI_LOBES_STEPS = 1024, KI_LOBES_DEGREE = 256, KI_LOBES_ANGLES = 160 };
/// Quadrature nodes over a lobe: rings of half vectors, and half vectors on one half of a ring.
enum {
    KI_LOBES_RINGS = 24,
    KI_LOBES_SPOKES = 32,
    KI_LOBES_NODES = KI_LOBES_RINGS * KI_LOBES_SPOKES
};
enum { KI_LOBES_CUTS = 5 };
/// Quadrature nodes over the hemisphere below the surface: rings, and nodes on one half of a ring.
enum {
    KI_LOBES_BELOW_RINGS = 4,
    KI_LOBES_BELOW_SPOKES = 5,
    KI_LOBES_BELOW = KI_LOBES_BELOW_RINGS * KI_LOBES_BELOW_SPOKES
};

/// Returns the variance of the light's coefficients of degree l >= 1: l^-3 times a Gaussian that
/// stands for a resolution of about 200 degrees. docs/theory/lobes.md says why l^-3.
double ki_lobes_variance(int l);

/// What the fit knows of a chain of levels: functions of the angle between two directions. Each
/// table has a place for the angle a at the index KI_LOBES_STEPS * sqrt(sin(a / 2)).
typedef struct ki_lobes_chain {
    int level_count;
    double roughness[KILN_MAX_LEVELS];
    /// Legendre coefficients of degrees 1 and 2 of each level's lobe.
    double band[KILN_MAX_LEVELS][3];
    /// Covariance, in the error's norm, of a level's lobe in one direction and of light from
    /// another direction: [KI_LOBES_STEPS + 1][level_count].
    double *light;
    /// Covariance of the lobes of two levels i >= j: table i (i + 1) / 2 + j of KI_LOBES_STEPS + 1
    /// numbers.
    double *pair;
    /// Lobe of each level without its degrees 0 to 2, per steradian: [KI_LOBES_STEPS + 1]
    /// [level_count].
    double *high;
    /// Unit directions below the surface in the frame of ki_lobes_nodes, with y > 0, and the solid
    /// angles for which they and their mirror images with -y stand together.
    double below[KI_LOBES_BELOW][3], below_area[KI_LOBES_BELOW];
    /// Covariance of light from two directions, cut off at degree 24 << (index + 1), for the norm
    /// of a target of a given width.
    double *self[KI_LOBES_CUTS];
} ki_lobes_chain;

/// Computes the tables of a chain. With `first` = 3 degrees 0 to 2 are left out of the error, with
/// `first` = 1 only degree 0.
kiln_result ki_lobes_chain_create(kiln_context *context, const kiln_table_def *def, int first,
                                  ki_lobes_chain *chain, kiln_error *error);
void ki_lobes_chain_free(ki_lobes_chain *chain);

/// Light directions with weights that sum to 1. Each node stands for itself and for its mirror
/// image with -y. The frame has x along the tangent towards the mirror direction and z along the
/// normal.
typedef struct ki_lobes_nodes {
    int count;
    double direction[KI_LOBES_NODES][3], weight[KI_LOBES_NODES];
} ki_lobes_nodes;

/// The six coefficients of bands 0 to 2 in the order c10, c11, c20, c21, c22, c00.
typedef struct ki_lobes_bands {
    double c[6];
} ki_lobes_bands;

/// What the fit knows of the lobe at one roughness and n.v.
typedef struct ki_lobes_target {
    double roughness, mirror; ///< mirror: angle of the mirror direction, acos(n.v)
    ki_lobes_bands bands;     ///< the lobe's own bands, c[5] = 1
    double from, step;        ///< angles at which `covariance` is tabulated
    /// Covariance of the lobe with each level's lobe: [KI_LOBES_ANGLES][level_count].
    double *covariance;
} ki_lobes_target;

/// Sets the nodes and the bands of the lobe of GGX with the model's masking and F = 1.
void ki_lobes_nodes_make(const kiln_model *model, double roughness, double nov,
                         ki_lobes_nodes *nodes, ki_lobes_bands *bands);
/// Sets everything in `target` except the pointer `covariance`, whose numbers are computed too.
void ki_lobes_target_make(const ki_lobes_chain *chain, const kiln_model *model, double roughness,
                          double nov, ki_lobes_nodes *nodes, ki_lobes_target *target);
/// The target's mean square under the chain's light.
double ki_lobes_target_norm(const ki_lobes_chain *chain, double roughness,
                            const ki_lobes_nodes *nodes);

/// Taps: the angle, the level with its fraction, and the weight of each.
typedef struct ki_lobes_taps {
    int count;
    double angle[KILN_MAX_TAPS], level[KILN_MAX_TAPS], weight[KILN_MAX_TAPS];
} ki_lobes_taps;

/// The error as a quadratic function of the weights w: w' a w - 2 b' w.
typedef struct ki_lobes_form {
    int count;
    double a[KILN_MAX_TAPS][KILN_MAX_TAPS], b[KILN_MAX_TAPS];
} ki_lobes_form;

/// Sets the form of the expected error for the angles and levels of taps.
void ki_lobes_form_make(const ki_lobes_chain *chain, const ki_lobes_target *target,
                        const ki_lobes_taps *taps, ki_lobes_form *form);
double ki_lobes_form_value(const ki_lobes_form *form, const double *weights);

/// What a search counts besides the expected error.
typedef struct ki_lobes_costs {
    double balance; ///< factor of (1 - sum of the weights)^2
    /// For each node below the surface: the factor of the squared lobe per steradian there, and the
    /// target's own bands 0 to 2 there, per steradian. The lobe of taps and correction is these bands
    /// plus the taps without their bands 0 to 2.
    double weight[KI_LOBES_BELOW], bands[KI_LOBES_BELOW];
} ki_lobes_costs;

/// Sets the costs for a number of taps.
void ki_lobes_costs_make(const ki_lobes_chain *chain, const ki_lobes_target *target, int count,
                         ki_lobes_costs *costs);
/// Adds the costs to a form.
void ki_lobes_form_add(const ki_lobes_chain *chain, const ki_lobes_costs *costs,
                       const ki_lobes_taps *taps, ki_lobes_form *form);
/// Returns the order of magnitude of the error.
double ki_lobes_scale(const ki_lobes_chain *chain, const ki_lobes_target *target);

/// Mean square of the taps minus twice their covariance with the target: the error without the
/// target's own norm.
double ki_lobes_taps_error(const ki_lobes_chain *chain, const ki_lobes_target *target,
                           const ki_lobes_taps *taps);
/// Mean square of bands 1 and 2 under the light of ki_lobes_variance.
double ki_lobes_bands_square(const ki_lobes_bands *bands);
/// The bands of the target minus those of the taps.
ki_lobes_bands ki_lobes_rest(const ki_lobes_chain *chain, const ki_lobes_target *target,
                             const ki_lobes_taps *taps);
/// Returns the level, with its fraction, of a roughness: linear between the roughnesses of levels.
double ki_lobes_level(const ki_lobes_chain *chain, double roughness);

/// Returns the angle of the dominant direction of Lagarde and de Rousiers 2014, section 4.9.3.
double ki_lobes_dominant(double roughness, double mirror);

/// A solution that a search should stay near: leans (angle from the mirror direction towards the
/// normal), levels and weights, with the strength of the pull relative to the error.
typedef struct ki_lobes_pull {
    double lean[KILN_MAX_TAPS], level[KILN_MAX_TAPS], weight[KILN_MAX_TAPS], strength;
} ki_lobes_pull;

/// Searches for taps of least error, from the angles and levels in *taps, by the simplex method of
/// Nelder and Mead; weights are those of least error, none negative, for each choice of angles and
/// levels. `pull` may be NULL. Returns the error with the pull.
double ki_lobes_search(const ki_lobes_chain *chain, const ki_lobes_target *target,
                       const ki_lobes_pull *pull, ki_lobes_taps *taps);

/// Replaces zeros in the def of a table of KILN_TABLE_LOBES by default values and checks the fields
/// that this kind of table has. Fails with KILN_ERROR_ARGUMENT.
kiln_result ki_lobes_complete(kiln_table_def *def, kiln_error *error);

/// Fits the table: fills the image of a table whose def is complete.
kiln_result ki_lobes_fill(kiln_context *context, kiln_table *table, kiln_error *error);

#endif
