// The mixtures that levels for an engine are: of lobes at nodes of roughness, by least squares in two
// norms. The first is over the whole sphere. Under a sun that is the sun's own spot and little else, so
// the second leaves out what is near suns, where most of a surface looks: only the lobes' tails reach it.
#ifndef KI_TUNE_MIX_H
#define KI_TUNE_MIX_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// Lobes between each two levels, and in all: with the last level's and the mirror.
enum { KI_LOBES = 4, KI_MOST_LOBES = KI_LOBES * KILN_MAX_LEVELS + 2 };

/// What a level is mixed of: GGX at nodes of roughness from .05 to 1, GGX at the last level's roughness
/// [count], and a mirror [count + 1].
typedef struct ki_palette {
    int count, level_count;
    double roughness[KI_MOST_LOBES];
    double width[KI_MOST_LOBES]; // of the rule over roughness
    double level[KI_MOST_LOBES]; // what the shader reads there
    ki_zonal_spectrum spectra[KI_MOST_LOBES];
    int nearest[KILN_MAX_LEVELS]; // node to a level's own roughness
    bool fitted[KILN_MAX_LEVELS]; // the others stay exact, and level 0 a mirror
} ki_palette;

typedef struct ki_mixtures {
    double weights[KILN_MAX_LEVELS][KI_MOST_LOBES];
    /// Of level i + 1 in level i's equation, relative to its own: what i should make up for.
    double coupling[KILN_MAX_LEVELS];
} ki_mixtures;

/// Writes count, roughness, width, level: cut where the shader comes to another pair of levels.
void ki_palette_lay(ki_palette *palette,
                    double (*level)(double roughness, int level_count, int size), int level_count,
                    int size);

/// `power` is the spectrum's per degree, [2][degree + 1]: without its suns, and with them.
kiln_result ki_palette_mix(kiln_context *context, const ki_palette *palette,
                           const kiln_spectrum *spectrum, const double (*power)[3],
                           ki_mixtures *mixtures, kiln_error *error);

#endif
