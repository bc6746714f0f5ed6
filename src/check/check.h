// What the checks of other tools' files share: findings in words, the orientation of a map, and the
// roughness of its levels.
#ifndef KI_CHECK_H
#define KI_CHECK_H

#include "base/base.h"
#include "engine/engine.h"

#include <kiln/check.h>

/// Adds a sentence (printf's format) to the findings, unless these are full.
void ki_find(kiln_findings *findings, kiln_finding_kind kind, bool fault, const char *format, ...)
    KI_PRINTF(4, 5);

// ------------------------------------------------------------------------------------- orientation

/// The axes under which nothing is turned.
extern const ki_axes ki_axes_none;
/// Sets `turned` to the direction of the panorama that a file with these axes shows at `direction`.
void ki_axes_apply(const ki_axes *axes, const double direction[3], double turned[3]);
/// Returns the axes that undo a turn by `axes`.
ki_axes ki_axes_inverse(const ki_axes *axes);
bool ki_axes_equal(const ki_axes *a, const ki_axes *b);
/// Returns number `index`, 0 to 47, of the signed permutations, of which 0 turns nothing.
ki_axes ki_axes_numbered(int index);
/// Returns how a file with the axes `found` is turned where axes `expected` are wanted.
ki_axes ki_axes_shown(const ki_axes *found, const ki_axes *expected);
/// Finds under which of the 48 axes a map is most like `source`. Of axes that are equally good,
/// `expected` is preferred, then those of engines.
kiln_result ki_find_axes(kiln_context *context, const kiln_map *source, const kiln_map *map,
                         const ki_axes *expected, ki_axes *axes, kiln_error *error);
/// Returns whether an engine reads cubes under these axes.
bool ki_axes_known(const ki_axes *axes);
/// Adds a sentence that says how a file with the axes `found` is turned, and a fault if `expected`
/// is not NULL and differs.
void ki_say_axes(const ki_axes *found, const ki_axes *expected, kiln_findings *findings);
/// Copies a map to the directions of the panorama. Allocates the levels of `turned`. Only cubes are
/// turned about axes other than y.
kiln_result ki_map_unturn(kiln_context *context, const kiln_map *map, const ki_axes *axes,
                          kiln_map *turned, kiln_error *error);

/// Returns a map of one level that shares the texels of a level of `map`.
kiln_map ki_single_level(const kiln_map *map, int level);
/// Returns the solid angle of a texel of level 0 up to a factor that is the same for all texels.
double ki_weight_of(const kiln_map *map, size_t index);
/// Returns the mean of all values of level 0, weighted by solid angle.
double ki_map_mean(const kiln_map *map);

// ---------------------------------------------------------------------------------------- mapping

/// What is known about the roughness of levels.
typedef struct ki_mapping {
    double wanted[KILN_MAX_LEVELS]; ///< roughness that the levels should have
    double found[KILN_MAX_LEVELS];  ///< roughness that they are most like; -1 where unknown
    double least[KILN_MAX_LEVELS];  ///< smaller roughnesses cannot be told from this roughness
    double brightness;              ///< factor by which all values are too bright
} ki_mapping;

/// Finds for each level the roughness whose exact level is most like the level, and the factor of
/// brightness. `map` has the panorama's directions.
kiln_result ki_find_roughness(kiln_context *context, const kiln_map *source, const kiln_map *map,
                              kiln_lobe_kind lobe, ki_mapping *mapping, kiln_error *error);
/// Sets the wanted roughness by the definition, or by the mapping that fits best, and says which
/// mapping was found.
void ki_want_roughness(const kiln_map *map, const kiln_check_levels_def *def, ki_mapping *mapping,
                       kiln_findings *findings);
/// Says which mistake explains the roughnesses that were found, if they are not those wanted.
void ki_judge_mapping(int count, const ki_mapping *mapping, kiln_findings *findings);

// ---------------------------------------------------------------------------------------- measures

/// A level, and the exact level that it is compared with.
typedef struct ki_pair {
    kiln_map is, exact; ///< maps of one level of the same shape and size
    double mean, norm;  ///< mean and root mean square of the exact level, by solid angle
} ki_pair;

/// Makes a pair of level `level` of two maps.
ki_pair ki_pair_make(const kiln_map *is, const kiln_map *exact, int level);
/// Fills in the errors of a level: rms, largest, bias, energy, seam and the counts.
void ki_measure_level(const ki_pair *pair, kiln_check_level *report);
/// Look for the faults that only the texels show, and say what they find.
void ki_judge_shift(const ki_pair *pairs, const kiln_check_levels_report *report,
                    kiln_findings *findings);
void ki_judge_clamp(const ki_pair *pair, kiln_findings *findings);

#endif
