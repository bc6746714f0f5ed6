// The part of a filtered environment that is summed over texels instead of transformed: the suns
// (bright texels kept out of the spectrum), and the surroundings of a direction for lobes too
// narrow for the spectrum.
#ifndef KI_POINTS_H
#define KI_POINTS_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// The suns of a spectrum, bright texels kept out of it, as points on the sphere. The narrower the
/// lobe, the more points represent a sun.
typedef struct ki_points {
    const ki_kernels *kernels;
    ki_zonal zonal;
    ki_sun_points suns;
} ki_points;

kiln_result ki_points_create(const kiln_spectrum *spectrum, const ki_zonal *zonal, double integral,
                             double rotation, ki_points *points, kiln_error *error);
void ki_points_destroy(ki_points *points);
/// Returns the number of bytes that ki_points_create allocates for `count` suns of a panorama of
/// `size` rows.
size_t ki_points_size(const ki_zonal *zonal, int size, size_t count);
/// Adds the light of the suns in eight unit directions, [axis][lane], to sum[channel][lane].
void ki_points_add(const ki_points *points, const double *directions, double *sum);

/// Adds the light near the lobe's axis that the spectrum of `zonal` leaves out: the sum over the
/// texels within the angle `outer` of `direction` of radiance * weight * (1 - step) / integral,
/// where ki_zonal_step is the step. `outer` of `zonal` must be above 0.
void ki_surroundings_add(const kiln_map *panorama, const ki_zonal *zonal, double integral,
                         const double direction[3], double rgb[3]);

#endif
