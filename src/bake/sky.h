// An analytic daylight sky: docs/theory/sky.md.
#ifndef KI_SKY_H
#define KI_SKY_H

#include "base/base.h"

/// Everything about a sky that does not depend on the direction looked in. Angles in radians,
/// radiance in linear Rec. 709, kcd/m^2 by channel.
typedef struct ki_sky {
    double sun[3];          // direction
    double sun_theta;       // from the zenith
    double sun_azimuth;     // from -Z toward +X
    double sun_radiance[3]; // of the whole disc
    double ground[3];       // radiance
    double perez[3][5];     // A to E for Y, x, y
    double zenith[3];       // Y, x, y over Perez's function there
    double fade;            // of the twilight, 1 by day
} ki_sky;

/// Radius of the sun's disc: half of 0.533 degrees.
extern const double ki_sun_radius;

/// Degrees; the ranges of kiln_sky_def.
void ki_sky_prepare(ki_sky *sky, double elevation, double azimuth, double turbidity, double albedo);
/// The sky without the sun's disc in a unit direction at or above the horizon.
void ki_sky_radiance(const ki_sky *sky, const double direction[3], double rgb[3]);
/// Sky, sun and ground onto level 0 of a panorama.
kiln_result ki_sky_paint(kiln_context *context, const ki_sky *sky, kiln_map *map,
                         kiln_error *error);

#endif
