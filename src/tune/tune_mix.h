// Finds the weights of the lobes of which each tuned level is a mixture, by least squares over
// roughness in two norms. The first norm is over the whole sphere. Under a sun, that norm measures
// little but the sun's own spot. The second norm therefore leaves out 8 degrees around each sun:
// most of a surface reflects the sky outside of that circle, where only the tails of lobes carry
// the sun's light. docs/theory/tuning.md.
#ifndef KI_TUNE_MIX_H
#define KI_TUNE_MIX_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// KI_LOBES: number of lobes with roughnesses between those of two neighbouring levels.
/// KI_MOST_LOBES: greatest number of lobes of a mixture, which includes the lobe of the last level
/// and the mirror.
enum { KI_LOBES = 4, KI_MOST_LOBES = KI_LOBES * KILN_MAX_LEVELS + 2 };

/// The lobes of which levels are mixtures. Lobes 0 to count - 1 are GGX at quadrature nodes of
/// roughness from 0.05 to 1, lobe [count] is GGX at the last level's roughness, and lobe [count +
/// 1] is a mirror.
typedef struct ki_nodes {
    int count, level_count;
    double roughness[KI_MOST_LOBES];
    // weight of each node in the Gauss quadrature over roughness
    double width[KI_MOST_LOBES];
    double level[KI_MOST_LOBES]; // fractional level that the engine reads at each node's roughness
    ki_zonal_spectrum spectra[KI_MOST_LOBES];
    // for each level, the node whose roughness is nearest to the roughness of the exact level
    int nearest[KILN_MAX_LEVELS];
    // whether each level is tuned; if not, it is the exactly filtered environment
    bool tuned[KILN_MAX_LEVELS];
} ki_nodes;

typedef struct ki_mixtures {
    // weight of each lobe in the mixture of each level
    double weights[KILN_MAX_LEVELS][KI_MOST_LOBES];
    /// A_i,i+1 / A_ii of the normal equations' matrix A (tune.h): the factor by which level i makes
    /// up for an error of level i + 1.
    double coupling[KILN_MAX_LEVELS];
} ki_mixtures;

/// Sets the fields count, level_count, roughness, width and level: the nodes of a Gauss rule in
/// each interval of roughness in which the engine reads the same pair of levels. `level` maps
/// roughness to a fractional level.
void ki_nodes_place(ki_nodes *nodes, double (*level)(double roughness, int level_count, int size),
                    int level_count, int size);

/// Finds the mixture of lobes of each level, and the couplings of levels, for an environment.
/// `power` has the environment's power of each degree and channel, [2][degree + 1][channel]:
/// first without its suns, then with the suns.
kiln_result ki_mixtures_find(kiln_context *context, const ki_nodes *nodes,
                             const kiln_spectrum *spectrum, const double (*power)[3], int degree,
                             ki_mixtures *mixtures, kiln_error *error);

#endif
