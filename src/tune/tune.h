// Levels for what an engine shows of them. It mixes two levels linearly, so exact ones show an exact
// result only at their own roughness; these show the least error over all, for this environment.
//
// At roughness r the engine shows (1 - t) c_i + t c_i+1, where the environment seen through GGX of
// alpha = r^2, T_r, is wanted. The c that make the sum over r of |shown - T_r|^2 / |T_r|^2 least are
// sums of T_r: with w = 1 / |T_r|^2 and the hat functions h_i(r), which are 1 - t and t,
//     sum_j A_ij c_j = sum_r w h_i T_r,    A_ij = sum_r w h_i h_j.
// A does not depend on the degree of a harmonic, so each level is the environment through one kernel, a
// mixture of GGX lobes and of the mirror whose weights, some negative, add up to 1. The environment
// enters by its power per degree, which gives |T_r|. In two norms at once (display_mix.h) there is such
// a system for each of their common axes.
#ifndef KI_TUNE_H
#define KI_TUNE_H

#include "sphere/level.h"

/// How an engine reads the levels.
typedef struct ki_shown {
    double (*level)(double roughness, int level_count, int size); ///< a fraction
    bool keep_last; ///< the last level is diffuse light too: it stays exact
    bool flat;      ///< it reads other pictures than this cube
    bool soft;      ///< level 0 may differ from the mirror
} ki_shown;

/// All that depends on the layout only.
typedef struct ki_display ki_display;

/// `def` is resolved: GGX, level 0 a mirror, the size a power of two.
kiln_result ki_display_create(kiln_context *context, const kiln_prefilter_def *def,
                              const float roughness[KILN_MAX_LEVELS], const ki_shown *shown,
                              ki_display **display, kiln_error *error);
void ki_display_destroy(ki_display *display);
/// The degree that the spectrum should have.
int ki_display_degree(const ki_display *display);
/// Whether a level is chosen here. The others, and level 0 in any case, are made before.
bool ki_display_fits(const ki_display *display, int level);
/// Writes the levels that are chosen here. `legendre` reaches the degree.
kiln_result ki_display_execute(ki_display *display, const ki_legendre *legendre,
                               const kiln_spectrum *spectrum, double rotation, kiln_map *map,
                               const ki_stage *stage, kiln_error *error);

#endif
