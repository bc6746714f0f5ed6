// kiln: the methods that courses teach, with their defaults and their errors, to learn from and to
// compare exact results with: the textbook's sums for irradiance, prefiltered radiance and the
// split-sum table, and the tables of GAMES202's fourth assignment.
// SPDX-License-Identifier: MIT
#ifndef KILN_COURSE_H
#define KILN_COURSE_H

#include <kiln/brdf.h>

#ifdef __cplusplus
extern "C" {
#endif

// ------------------------------------------------------------------------- the textbook, by its name

/// The methods that courses teach, with their defaults and their errors, to learn from and to
/// compare with. See docs/theory/textbook.md.
typedef struct kiln_textbook_def {
    kiln_shape shape; ///< of the result; KILN_SHAPE_AUTO for a panorama, as in the textbook
    int size;         ///< rows or edge; 0 for 64
    int level_count;  ///< prefilter only; 0 for all
    int phi_count;    ///< irradiance: steps of phi, to 65536; 0 for 100
    int theta_count;  ///< irradiance: steps of theta, to 65536; 0 for 100
    int sample_count; ///< prefilter: Hammersley points, to 1048576; 0 for 1024
} kiln_textbook_def;

/// Irradiance / pi as the textbook's uniform sum over (phi, theta) gives it: white stays near 1
/// (0.99992 with 100 x 100). A panorama's texels look where the textbook's do, at i / (width - 1) and
/// j / (height - 1), which is up to half a texel from their centres.
KILN_API KILN_CHECKED kiln_result kiln_textbook_irradiance(kiln_context *context,
                                                           const kiln_map *panorama,
                                                           const kiln_textbook_def *def,
                                                           kiln_map *map, kiln_error *error);
/// GGX importance sampling on Hammersley points with N = V = R, weighted by n.l, nearest texels;
/// roughness level / (level_count - 1). A panorama's texels as for kiln_textbook_irradiance.
KILN_API KILN_CHECKED kiln_result kiln_textbook_prefilter(kiln_context *context,
                                                          const kiln_map *panorama,
                                                          const kiln_textbook_def *def,
                                                          kiln_map *map, kiln_error *error);
/// The 1024-sample split-sum table: x is n.v = i/(size-1), y is roughness = j/(size-1), row 0 at
/// the top holds roughness 1; two channels (A, B). Where n.v is 0 the textbook divides 0 by 0; here
/// the estimator's limit n.v -> 0 is evaluated, at n.v = 1e-4. `size` 2 to 4096; `sample_count` to
/// 1048576, 0 for 1024.
KILN_API KILN_CHECKED kiln_result kiln_textbook_brdf(kiln_context *context, int size,
                                                     int sample_count, kiln_image *table,
                                                     kiln_error *error);

// ----------------------------------------------------------------------- the assignment, by its name

/// How GAMES202's fourth assignment (2021) computes E(mu), with its sizes, its samples and its
/// errors. See docs/theory/assignment.md.
typedef enum kiln_assignment_method {
    KILN_ASSIGNMENT_MONTE_CARLO, ///< light drawn by its cosine, in jittered strata (SplitMix64)
    KILN_ASSIGNMENT_IMPORTANCE,  ///< GGX's half vectors on Hammersley points: its bonus 1
    KILN_ASSIGNMENT_SPLIT_SUM    ///< the sums A and B on the same points, added: its bonus 2
} kiln_assignment_method;

/// The masking of the assignment's E, with GGX's D.
typedef enum kiln_assignment_g {
    KILN_ASSIGNMENT_G_FIGURES = 0, ///< Schlick's with k = roughness^2 / 2, as in its figures
    KILN_ASSIGNMENT_G_TEXT,        ///< Schlick's with k = (roughness + 1)^2 / 8, as in its text
    KILN_ASSIGNMENT_G_SMITH,       ///< the height-correlated one, KILN_G_SMITH
    KILN_ASSIGNMENT_G_UNCORRELATED ///< KILN_G_SMITH_UNCORRELATED
} kiln_assignment_g;

/// The same masking as the exact functions and tables name it.
KILN_API kiln_g kiln_assignment_masking(kiln_assignment_g g);

/// {0} is the assignment's own: 128 x 128 texels, 1024 samples each, k = roughness^2 / 2.
typedef struct kiln_assignment_def {
    int size;         ///< 2 to 1024; 0 for 128
    int sample_count; ///< to 1048576; 0 for 1024. Monte Carlo takes the largest square up to it
    kiln_assignment_g g;
    bool unclamped; ///< Monte Carlo: D's denominator as it is; false: at least 1e-4
    bool unflipped; ///< row 0 holds roughness 0, as in figure 3; else the top row is roughness 1
    uint64_t seed;  ///< of Monte Carlo's numbers
} kiln_assignment_def;

/// E with F = 1, size x size, one channel, before it is cut to bytes: mu = (x + 1/2) / size from left
/// to right, roughness = (y + 1/2) / size upwards. `def` may be NULL.
KILN_API KILN_CHECKED kiln_result kiln_assignment_energy(kiln_context *context,
                                                         kiln_assignment_method method,
                                                         const kiln_assignment_def *def,
                                                         kiln_image *table, kiln_error *error);
/// E_avg of such a table: each row is 2 mean(E mu) of that row, in every texel.
KILN_API KILN_CHECKED kiln_result kiln_assignment_average(kiln_context *context,
                                                          const kiln_image *energy,
                                                          kiln_image *average, kiln_error *error);
/// Cuts every value to what (uint8)(255 x) keeps of it: saved as PNG, it is that byte.
KILN_API void kiln_assignment_truncate(kiln_image *image);

/// Of the texels of two tables, the one minus the other.
typedef struct kiln_difference {
    double max, rms; ///< of its size
    double mean;     ///< with its sign
} kiln_difference;

/// Tables of one channel, alike in size. `map`, which may be NULL, receives a picture (sRGB) of the
/// error by decades from 1e-4, white, to 1, dark: blue where `table` is too dark, red where too
/// bright.
KILN_API KILN_CHECKED kiln_result kiln_assignment_compare(kiln_context *context,
                                                          const kiln_image *table,
                                                          const kiln_image *exact,
                                                          kiln_difference *difference,
                                                          kiln_image *map, kiln_error *error);

#ifdef __cplusplus
}
#endif
#endif
