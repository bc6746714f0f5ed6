// Finds the weights of the lobes of which each tuned level is a mixture, by least squares over
// roughness in two norms. The first norm is over the whole sphere. Under a sun, that norm measures
// little but the sun's own spot. The second norm therefore leaves out 8 degrees around each sun:
// most of a surface reflects the sky outside of that circle, where only the tails of lobes carry
// the sun's light. docs/theory/tuning.md.
#ifndef KI_TUNE_MIX_H
#define KI_TUNE_MIX_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// KI_LOBES: number of lobes between each two levels. KI_MOST_LOBES: greatest number of lobes of a
/// mixture, with the lobe of the last level and the mirror.
enum { KI_LOBES = 4, KI_MOST_LOBES = KI_LOBES * KILN_MAX_LEVELS + 2 };

/// The lobes of which levels are mixtures. Lobes 0 to count - 1 are GGX at quadrature nodes of
/// roughness from 0.05 to 1, lobe [count] is GGX at the last level's roughness, and lobe [count +
/// 1] is a mirror.
typedef struct ki_nodes {
    int count, level_count;
    double roughness[KI_MOST_LOBES];
    double width[KI_MOST_LOBES]; // weight of the node in the Gauss quadrature over roughness
    double level[KI_MOST_LOBES]; // fractional level that the engine reads at the node's roughness
    ki_zonal_spectrum spectra[KI_MOST_LOBES];
    int nearest[KILN_MAX_LEVELS]; // node whose roughness is nearest to that of the exact level
    bool tuned[KILN_MAX_LEVELS];  // false: the level stays exact
} ki_nodes;

typedef struct ki_mixtures {
    // weight of each lobe in the mixture of each level
    double weights[KILN_MAX_LEVELS][KI_MOST_LOBES];
    /// A_i,i+1 / A_ii of the normal equations: the factor by which level i makes up for an error of
    /// level i + 1.
    double coupling[KILN_MAX_LEVELS];
} ki_mixtures;

/// Sets the fields count, level_count, roughness, width and level: nodes of a Gauss rule in each
/// interval of roughness in which the engine reads the same two levels. `level` maps roughness to a
/// fractional level.
void ki_nodes_place(ki_nodes *nodes, double (*level)(double roughness, int level_count, int size),
                    int level_count, int size);

/// Sets the weights and couplings for an environment. `power` has the power of each degree and
/// channel of its spectrum, [2][degree + 1]: first without its suns, then with the suns.
kiln_result ki_mixtures_find(kiln_context *context, const ki_nodes *nodes,
                             const kiln_spectrum *spectrum, const double (*power)[3],
                             ki_mixtures *mixtures, kiln_error *error);

#endif
