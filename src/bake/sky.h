// An analytic daylight sky. Source: docs/theory/sky.md.
#ifndef KI_SKY_H
#define KI_SKY_H

#include "base/base.h"

/// Everything about a sky that does not depend on the viewing direction. Angles are in radians,
/// radiance is linear Rec. 709 in kcd/m^2 per channel.
typedef struct ki_sky {
    double sun[3];          // unit direction of the sun
    double sun_theta;       // angle of the sun from the zenith
    double sun_azimuth;     // azimuth of the sun from -Z toward +X
    double sun_radiance[3]; // radiance of the sun's disc
    double ground[3];       // radiance of the ground
    double perez[3][5]; // coefficients A to E of Perez's function for each of Y, x and y of CIE xyY
    // Luminance Y and chromaticities x and y of the zenith, each divided by Perez's function at the
    // zenith.
    double zenith[3];
    double fade; // factor on the sky's radiance for twilight; 1 by day
} ki_sky;

/// Angular radius of the sun's disc in radians: half of 0.533 degrees.
extern const double ki_sun_radius;

/// Prepares a sky from the sun's elevation and azimuth in degrees, the turbidity and the albedo of
/// the ground, each within the range that kiln_sky_def states.
void ki_sky_prepare(ki_sky *sky, double elevation, double azimuth, double turbidity, double albedo);
/// Computes the radiance of the sky, without the sun's disc, in a unit direction at or above the
/// horizon.
void ki_sky_radiance(const ki_sky *sky, const double direction[3], double rgb[3]);
/// Writes sky, sun's disc and ground to level 0 of a panorama.
kiln_result ki_sky_paint(kiln_context *context, const ki_sky *sky, kiln_map *map,
                         kiln_error *error);

#endif
