// kiln: the methods that rendering courses teach, with their default sizes and their errors, to
// learn from and to compare with exact results. The first section has the LearnOpenGL textbook's
// sums for irradiance, prefiltered radiance and the split-sum table, the second the tables of the
// fourth assignment of the course GAMES202.
// SPDX-License-Identifier: MIT
#ifndef KILN_COURSE_H
#define KILN_COURSE_H

#include <kiln/brdf.h>

#ifdef __cplusplus
extern "C" {
#endif

// ---------------------------------------------------------------------------- the textbook methods

/// Parameters of a textbook method. {0} selects the textbook's own sizes. See
/// docs/theory/textbook.md.
typedef struct kiln_textbook_def {
    /// shape of the computed map; KILN_SHAPE_AUTO for a panorama, as in the textbook
    kiln_shape shape;
    int size;         ///< rows of a panorama, or texels along a side of a face; 0 for 64
    int level_count;  ///< number of levels, only for kiln_textbook_prefilter; 0 for all
    int phi_count;    ///< steps of phi for irradiance, at most 65536; 0 for 100
    int theta_count;  ///< steps of theta for irradiance, at most 65536; 0 for 100
    int sample_count; ///< Hammersley points for prefiltering, at most 1048576; 0 for 1024
} kiln_textbook_def;

/// Computes irradiance / pi by the textbook's uniform sum over (phi, theta), which keeps white near
/// 1 (0.99992 with 100 x 100 steps). The texel in column i and row j of a panorama is evaluated
/// where the textbook does, at i / (width - 1) and j / (height - 1), up to half a texel from the
/// texel's centre. The result may be negative where the source is.
KILN_API KILN_CHECKED kiln_result kiln_textbook_irradiance(kiln_context *context,
                                                           const kiln_map *panorama,
                                                           const kiln_textbook_def *def,
                                                           kiln_map *map, kiln_error *error);
/// Computes prefiltered radiance by GGX importance sampling with Hammersley points, N = V = R,
/// weights n.l and the nearest texel of the source. Level k has roughness k / (level_count - 1).
/// The texels of a panorama are evaluated where kiln_textbook_irradiance evaluates them. The result
/// may be negative where the source is.
KILN_API KILN_CHECKED kiln_result kiln_textbook_prefilter(kiln_context *context,
                                                          const kiln_map *panorama,
                                                          const kiln_textbook_def *def,
                                                          kiln_map *map, kiln_error *error);
/// Computes the split-sum table (A, B) with two channels. Column i has n.v = i / (size - 1).
/// Roughness runs from 1 in row 0, at the top, to 0 in the last row, in steps of 1 / (size - 1).
/// Where n.v is 0 the textbook divides 0 by 0; kiln evaluates the estimator at n.v = 1e-4 instead,
/// close to its limit. `size` is 2 to 4096, `sample_count` at most 1048576; 0 for 1024.
KILN_API KILN_CHECKED kiln_result kiln_textbook_brdf(kiln_context *context, int size,
                                                     int sample_count, kiln_image *table,
                                                     kiln_error *error);

// ------------------------------------------------------------------------ the GAMES202 assignment

/// Method by which GAMES202's fourth assignment (2021) computes E(mu), with its own sizes, samples
/// and errors. See docs/theory/assignment.md.
typedef enum kiln_assignment_method {
    KILN_ASSIGNMENT_MONTE_CARLO, ///< cosine-distributed light in jittered strata (SplitMix64)
    KILN_ASSIGNMENT_IMPORTANCE,  ///< GGX half vectors from Hammersley points: bonus task 1
    /// A + B of the split sum, by GGX half vectors from Hammersley points: bonus task 2
    KILN_ASSIGNMENT_SPLIT_SUM
} kiln_assignment_method;

/// The masking G that the assignment combines with GGX.
typedef enum kiln_assignment_g {
    /// Schlick's with k = roughness^2 / 2, as in the assignment's figures.
    KILN_ASSIGNMENT_G_FIGURES = 0,
    /// Schlick's with k = (roughness + 1)^2 / 8, as in the assignment's text.
    KILN_ASSIGNMENT_G_TEXT,
    KILN_ASSIGNMENT_G_SMITH,       ///< the height-correlated Smith masking, KILN_G_SMITH
    KILN_ASSIGNMENT_G_UNCORRELATED ///< the uncorrelated Smith masking, KILN_G_SMITH_UNCORRELATED
} kiln_assignment_g;

/// Returns the kiln_g that names the same masking for the exact functions and tables.
KILN_API kiln_g kiln_assignment_masking(kiln_assignment_g g);

/// Parameters of the assignment's tables. {0} selects the assignment's own: 128 x 128 texels, 1024
/// samples each, k = roughness^2 / 2.
typedef struct kiln_assignment_def {
    int size; ///< texels along each side of the table, 2 to 1024; 0 for 128
    /// Samples per texel, at most 1048576; 0 for 1024. Monte Carlo uses the largest square number
    /// up to this.
    int sample_count;
    kiln_assignment_g g;
    /// Monte Carlo, true: D's denominator unchanged; false: clamped to at least 1e-4.
    bool unclamped;
    /// True: row 0 holds roughness 0, as in figure 3; false: row 0 holds roughness 1.
    bool unflipped;
    uint64_t seed; ///< seed of Monte Carlo's random numbers
} kiln_assignment_def;

/// Computes a table of E with F = 1: size x size texels, one channel, not yet truncated to bytes.
/// Column x has mu = (x + 1/2) / size, from left to right. Row y from the bottom has roughness = (y
/// + 1/2) / size. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_assignment_energy(kiln_context *context,
                                                         kiln_assignment_method method,
                                                         const kiln_assignment_def *def,
                                                         kiln_image *table, kiln_error *error);
/// Computes E_avg from a table of E: every texel of a row is 2 mean(E mu), the mean being over that
/// row of `energy`.
KILN_API KILN_CHECKED kiln_result kiln_assignment_average(kiln_context *context,
                                                          const kiln_image *energy,
                                                          kiln_image *average, kiln_error *error);
/// Truncates every value to the one that remains after (uint8)(255 x): saved as PNG, the value
/// gives that byte exactly.
KILN_API void kiln_assignment_truncate(kiln_image *image);

/// Statistics of the differences between two tables, `table` minus `exact`, over all texels.
typedef struct kiln_difference {
    double max, rms; ///< largest absolute difference and root mean square
    double mean;     ///< mean difference, with its sign
} kiln_difference;

/// Compares two tables of one channel and equal size. `map`, which may be NULL, receives an sRGB
/// picture of the error on a logarithmic scale from white (1e-4) to dark (1): blue where `table` is
/// too dark, red where `table` is too bright.
KILN_API KILN_CHECKED kiln_result kiln_assignment_compare(kiln_context *context,
                                                          const kiln_image *table,
                                                          const kiln_image *exact,
                                                          kiln_difference *difference,
                                                          kiln_image *map, kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
