// The ground truth: an environment seen through a lobe, integrated texel by texel.
#ifndef KI_REFERENCE_H
#define KI_REFERENCE_H

#include "base/base.h"

/// How fine a texel is cut, as ratios of its size to the length over which the lobe changes there.
/// {0} stands for the defaults.
typedef struct ki_reference_rule {
    double centre; ///< below it one value at the texel's mean direction; default 1/300
    double pairs;  ///< below it 2 x 2 Gauss-Legendre nodes; default 1/20
    double quads;  ///< below it 4 x 4, else the cell is cut into four; default 1/2
    double edge; ///< radians: larger cells that the lobe's horizon crosses are cut; default 0.0025
} ki_reference_rule;

/// For each direction (any length but 0): the sum over the texels of a panorama of radiance times
/// the integral of the lobe over the texel, divided by the sum of those integrals. The panorama is
/// its texels, each uniformly bright over its exact solid angle. `rule` may be NULL; with the
/// defaults the integrals are right to 1e-5 relative or better wherever they matter.
/// `rotation` as in ki_turn. GGX with alpha < 1e-9 is a mirror: the texel that the direction hits.
kiln_result ki_reference_integrate(kiln_context *context, const kiln_map *panorama,
                                   const kiln_lobe *lobe, double rotation,
                                   const double (*directions)[3], int count,
                                   const ki_reference_rule *rule, double (*values)[3],
                                   kiln_error *error);

#endif
