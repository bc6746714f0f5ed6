// The laws of lights that are taken out of a map: the map that is left and the lights are together
// as bright as the map.
#ifndef KILN_KIT_LIGHTS_H
#define KILN_KIT_LIGHTS_H

#include <kiln/kiln.h>

/// Checks each harmonic of five bands to a thousandth of the RMS norm of the map's harmonics.
void check_light_harmonics(kiln_context *context, const kiln_map *map, const kiln_map *left,
                           const kiln_lights *lights);

/// Checks the irradiance of surfaces that have a light on their horizon or close to the horizon:
/// what was taken out and the discs differ by at most a thousandth of the greatest irradiance in
/// the map, channel by channel.
void check_light_irradiance(kiln_context *context, const kiln_map *map, const kiln_map *left,
                            const kiln_lights *lights);

#endif
