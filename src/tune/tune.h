// Tunes the levels of a prefiltered environment to how an engine interpolates between them. In: the
// spectrum of the environment in spherical harmonics, and how the engine maps roughness to levels.
// Out: the texels of the tuned levels. Between two levels an engine interpolates linearly, though
// lobes do not change linearly with roughness. Exact levels therefore show an exact result only at
// their own roughness. Tuned levels minimise the error over all roughnesses, for the given
// environment.
//
// At roughness r the engine shows (1 - t) c_i + t c_i+1, where c_i is level i and t the fraction of
// the level. The exact result T_r is the environment filtered by GGX of alpha = r^2. The levels
// that minimise the sum over r of |shown - T_r|^2 / |T_r|^2 solve, with the weights w_r = 1 /
// |T_r|^2 and the hat functions h_i(r), which are 1 - t and t in the two intervals next to level i
// and 0 elsewhere,
//
//     sum_j A_ij c_j = sum_r w_r h_i(r) T_r,    A_ij = sum_r w_r h_i(r) h_j(r).
//
// A is the same for all harmonics. Therefore each level is the environment filtered by one kernel,
// a mixture of GGX lobes and of a mirror, whose weights (some negative) sum to 1. The environment
// enters through |T_r| only, which follows from its power per degree. tune_mix.h minimises the
// sum of two such errors, whose norms |.| are over the whole sphere and over the sphere away from
// suns. This gives one such system for each generalised eigenvector of the two norms' matrices of
// scalar products. docs/theory/tuning.md derives the method and lists its errors.
#ifndef KI_TUNE_H
#define KI_TUNE_H

#include "sphere/level.h"

/// How an engine reads the levels of a prefiltered environment.
typedef struct ki_reading {
    /// fractional level that the engine reads at a roughness
    double (*level)(double roughness, int level_count, int size);
    bool keep_last; ///< the engine reads diffuse light from the last level, which stays exact
    bool flat;      ///< the engine reads a picture made from the cube, not the cube's own texels
    bool soft;      ///< level 0 is tuned too, and may differ from the unfiltered environment
} ki_reading;

/// The plan of a tuning: the part that depends on the sizes and roughnesses of levels, but not on
/// the environment. An execution changes nothing in the plan.
typedef struct ki_tune ki_tune;

/// Prepares tuning for a map of the sizes and number of levels in `def`. The fields of `def` are
/// complete (0 no longer stands for a default value): the lobe is GGX, level 0 the unfiltered
/// environment (a mirror), and the size a power of two. roughness[] has the roughness of each level
/// where levels are exact. `tilt` turns the environment before the rotation is applied.
kiln_result ki_tune_create(kiln_context *context, const kiln_prefilter_def *def,
                           const ki_tilt *tilt, const float roughness[KILN_MAX_LEVELS],
                           const ki_reading *reading, ki_tune **tune, kiln_error *error);
void ki_tune_destroy(ki_tune *tune);
/// Returns the degree of spherical harmonics that ki_tune_execute needs of the spectrum.
int ki_tune_degree(const ki_tune *tune);
/// Returns true if `level` is tuned. Before ki_tune_execute is called, the map must hold the exact
/// content of all levels that are not tuned, and of level 0 in any case.
bool ki_tune_makes(const ki_tune *tune, int level);
/// Writes the tuned levels to `map`. `legendre` reaches at least the degree ki_tune_degree. The
/// environment is turned by `rotation` degrees about +Y. With `rehearses`, every level is computed
/// to the highest degree that any environment may need, so that the execution takes as much memory
/// as with any other environment, except for the suns. Threads and memory are those of the
/// spectrum's context.
kiln_result ki_tune_execute(const ki_tune *tune, const ki_legendre *legendre,
                            const kiln_spectrum *spectrum, double rotation, bool rehearses,
                            kiln_map *map, kiln_error *error);

/// Returns the greatest number of bytes that ki_tune_execute allocates for `count` suns of a
/// panorama of `source_size` rows.
size_t ki_tune_suns_size(const ki_tune *tune, int source_size, size_t count);

#endif
