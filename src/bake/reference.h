// Reference values by brute force: an environment filtered by a lobe, integrated texel by texel.
#ifndef KI_REFERENCE_H
#define KI_REFERENCE_H

#include "base/base.h"

/// Says with how many nodes the lobe is integrated over a cell, which is a texel or a part of a
/// texel. `centre`, `pairs` and `quads` are limits of the ratio of the cell's size to the length
/// over which the lobe changes there; `edge` is an angle. {0} stands for the default values.
typedef struct ki_reference_rule {
    /// Greatest ratio of a cell's size to the lobe's length of change at which the lobe is
    /// evaluated once, at the texel's mean direction; default 1/300.
    double centre;
    /// Greatest ratio of a cell's size to the lobe's length of change for 2 x 2 Gauss-Legendre
    /// nodes; default 1/20.
    double pairs;
    /// Greatest ratio of a cell's size to the lobe's length of change for 4 x 4 Gauss-Legendre
    /// nodes; default 1/2. A cell with a greater ratio is cut into four.
    double quads;
    /// Size in radians above which a cell is cut into four where the lobe's horizon crosses it;
    /// default 0.0025, or up to 0.01 for narrow GGX lobes.
    double edge;
} ki_reference_rule;

/// Computes for each direction (of any length but 0) the sum over a panorama's texels of radiance
/// times the integral of the lobe over the texel, divided by the sum of these integrals. Texels are
/// constant over their exact solid angle. `rule` may be NULL for the default rule, with which the
/// integrals have a relative error of at most 1e-5 wherever they matter. `rotation` is in degrees
/// as in ki_turn. GGX with alpha < 1e-9 is a mirror: the value is the texel that the direction
/// hits.
kiln_result ki_reference_integrate(kiln_context *context, const kiln_map *panorama,
                                   const kiln_lobe *lobe, double rotation,
                                   const double (*directions)[3], int count,
                                   const ki_reference_rule *rule, double (*values)[3],
                                   kiln_error *error);

#endif
