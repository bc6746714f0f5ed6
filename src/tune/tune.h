// Tunes levels for what an engine shows of them: an environment's spectrum goes in, the texels of levels
// come out. An engine mixes two levels linearly, so exact levels show an exact result only at their own
// roughness; tuned ones show the least error over all roughnesses, for this environment.
//
// At roughness r the engine shows (1 - t) c_i + t c_i+1, where the environment seen through GGX of
// alpha = r^2, T_r, is wanted. The c that make the sum over r of |shown - T_r|^2 / |T_r|^2 least are
// sums of T_r: with w = 1 / |T_r|^2 and the hat functions h_i(r), which are 1 - t and t,
//     sum_j A_ij c_j = sum_r w h_i T_r,    A_ij = sum_r w h_i h_j.
// A does not depend on the degree of a harmonic, so each level is the environment through one kernel, a
// mixture of GGX lobes and of the mirror whose weights, some negative, add up to 1. The environment
// enters by its power per degree, which gives |T_r|. In two norms at once (tune_mix.h) there is such
// a system for each axis of their common eigenbasis. Source: docs/theory/tuning.md.
#ifndef KI_TUNE_H
#define KI_TUNE_H

#include "sphere/level.h"

/// How an engine reads the levels.
typedef struct ki_reading {
    double (*level)(double roughness, int level_count, int size); ///< a fraction
    bool keep_last; ///< the last level is diffuse light too: it stays exact
    bool flat;      ///< it reads other pictures than this cube
    bool soft;      ///< level 0 may differ from the mirror
} ki_reading;

/// What depends on the sizes and roughnesses of levels only, not on the environment.
typedef struct ki_tune ki_tune;

/// `def` is resolved: GGX, level 0 a mirror, the size a power of two.
kiln_result ki_tune_create(kiln_context *context, const kiln_prefilter_def *def,
                           const float roughness[KILN_MAX_LEVELS], const ki_reading *reading,
                           ki_tune **tune, kiln_error *error);
void ki_tune_destroy(ki_tune *tune);
/// The degree that the spectrum should have.
int ki_tune_degree(const ki_tune *tune);
/// Whether a level is tuned. Levels that are not, and level 0 in any case, must be in the map already when
/// ki_tune_execute is called.
bool ki_tune_makes(const ki_tune *tune, int level);
/// Writes the tuned levels. `legendre` has been made for ki_tune_degree or more.
kiln_result ki_tune_execute(ki_tune *tune, const ki_legendre *legendre,
                            const kiln_spectrum *spectrum, double rotation, kiln_map *map,
                            const ki_stage *stage, kiln_error *error);

#endif
