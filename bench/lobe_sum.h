// The lobes of an environment's levels and what a table of KILN_TABLE_LOBES makes of them, as values
// per steradian, for bench_lobes and bench_lobe_parts.
#ifndef KILN_BENCH_LOBE_SUM_H
#define KILN_BENCH_LOBE_SUM_H

#include <kiln/brdf.h>

enum { LOBE_ANGLES = 4096 };

/// The lobe of each level per steradian, at the index LOBE_ANGLES * sqrt((1 - cosine) / 2).
typedef struct lobe_levels {
    int count;
    double value[KILN_MAX_LEVELS][LOBE_ANGLES + 1];
} lobe_levels;

/// Tabulates the lobes of levels of these roughnesses. The lobe of a level below a roughness of 0.01
/// is 0, since that level is the environment itself and its lobe too narrow for the table.
void lobe_levels_make(const float *roughness, int count, lobe_levels *levels);

/// A sum of taps and their correction in the frame with x along the tangent towards the mirror
/// direction and z along the normal.
typedef struct lobe_sum {
    int count;
    double x[KILN_MAX_TAPS], z[KILN_MAX_TAPS]; ///< directions of the taps
    double level[KILN_MAX_TAPS], weight[KILN_MAX_TAPS];
    double c[6]; ///< c10, c11, c20, c21, c22 and c00, which is 1 minus all weights
} lobe_sum;

/// Returns the sum that the numbers of kiln_table_lookup describe for a table of `taps` taps. One tap
/// with the weight 1 and no correction is the split sum's lookup.
lobe_sum lobe_sum_make(const double *values, int taps, double nov);

/// Returns the sum's value per steradian in the unit direction d.
double lobe_sum_at(const lobe_levels *levels, const lobe_sum *sum, const double d[3]);

#endif
