// Each tuned level is the environment through a mixture of GGX lobes. Here the weights of the mixtures are
// found: by least squares over roughness, in two norms. The first norm is over the whole sphere; under a
// sun its value is almost only the sun's own spot. The second leaves out 8 degrees around each sun, because
// most of a surface reflects the sky beyond, where only the tails of lobes carry the sun's light.
#ifndef KI_TUNE_MIX_H
#define KI_TUNE_MIX_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// Lobes between each two levels, and in all: with the last level's and the mirror.
enum { KI_LOBES = 4, KI_MOST_LOBES = KI_LOBES * KILN_MAX_LEVELS + 2 };

/// The lobes that levels are mixtures of: GGX at quadrature nodes of roughness from .05 to 1, GGX at the
/// last level's roughness [count], and a mirror [count + 1].
typedef struct ki_nodes {
    int count, level_count;
    double roughness[KI_MOST_LOBES];
    double width[KI_MOST_LOBES]; // weight of the Gauss rule over roughness
    double level[KI_MOST_LOBES]; // that the shader reads at this roughness, a fraction
    ki_zonal_spectrum spectra[KI_MOST_LOBES];
    int nearest[KILN_MAX_LEVELS]; // node to the exact level's roughness
    bool tuned[KILN_MAX_LEVELS];  // other levels stay exact, level 0 a mirror
} ki_nodes;

typedef struct ki_mixtures {
    double weights[KILN_MAX_LEVELS][KI_MOST_LOBES];
    /// A_i,i+1 / A_ii of the normal equations: by how much of its error level i makes up for level i + 1.
    double coupling[KILN_MAX_LEVELS];
} ki_mixtures;

/// Writes count, roughness, width and level: a Gauss rule for each interval of roughness in which the
/// shader reads the same two levels.
void ki_nodes_place(ki_nodes *nodes, double (*level)(double roughness, int level_count, int size),
                    int level_count, int size);

/// `power` is the spectrum's power per degree, [2][degree + 1]: without its suns, and with them.
kiln_result ki_mixtures_find(kiln_context *context, const ki_nodes *nodes,
                             const kiln_spectrum *spectrum, const double (*power)[3],
                             ki_mixtures *mixtures, kiln_error *error);

#endif
