// The search for compact lights in a map, in two parts: lights_search.c finds regions of bright
// texels, lights_measure.c turns a region into a light.
#ifndef KI_LIGHTS_H
#define KI_LIGHTS_H

#include "base/base.h"

#include <stdint.h>

enum {
    /// Most regions that are looked at, in the order of their brightest texels.
    KI_MOST_REGIONS = 512,
    KI_SH_COUNT = KILN_MAX_BANDS * KILN_MAX_BANDS
};

/// Connected texels of a light: `count` entries of a search's list from `first` on.
typedef struct ki_region {
    size_t first, count;
    kiln_light light;
    /// Harmonics of what was taken out minus those of the light's disc, relative to the norm of the
    /// map's harmonics.
    double mismatch[KI_SH_COUNT][3];
    bool negative[3]; ///< channels in which values below zero belong to the light too
} ki_region;

typedef struct ki_search {
    kiln_context *context;
    const kiln_map *map;
    size_t texel_count;
    /// For each texel the mean of its channels, and the number of its region counted from 1, 0 for
    /// none, or KI_REJECTED.
    float *brightness;
    uint16_t *owner;
    size_t *list; ///< texels of all regions, one region after the other
    size_t used;
    size_t *seed; ///< texels that are bright enough to begin a region
    size_t seed_count;
    /// Sum over all texels of radiance times solid angle, and the mean brightness of the map with
    /// its lights cut off.
    double light[3], base;
    /// Root of the sum of squares of the map's harmonics in five bands, as the mean of the
    /// channels.
    double norm;
    double brightest[3]; ///< greatest irradiance of any surface in each channel, within 4 %
    ki_region *region;   ///< room for KI_MOST_REGIONS
    int region_count;
} ki_search;

enum { KI_REJECTED = 65535 };

/// Largest mismatch of one light, and of the sum of all lights that are taken out, so that the
/// lights and the map that remains have the harmonics of the map to a thousandth.
extern const double ki_light_mismatch, ki_lights_mismatch;
/// Number of texels from which on a light has a shape. The edges of a light of fewer texels are
/// those of its texels, and say nothing of the source.
enum { KI_SHAPED = 9 };
/// Largest error of irradiance of one light, and of all lights together, as a part of the greatest
/// irradiance. The bound is a thousandth less 5 %, because few surfaces are tried and the greatest
/// irradiance is known within 4 %.
extern const double ki_light_error;

/// Fails unless the numbers are in the ranges that kiln_lights_def states.
kiln_result ki_lights_check(const kiln_lights_def *def, kiln_error *error);
/// Sets the light and the base of a map's level 0.
void ki_light_base(const kiln_map *map, double light[3], double *base);
/// Finds and measures the regions of a map. The caller frees the search, also on failure.
kiln_result ki_search_run(kiln_context *context, const kiln_map *map, ki_search *search,
                          kiln_error *error);
void ki_search_free(ki_search *search);

/// Measures what a region holds above its surroundings: sets region->light and region->mismatch. If
/// `target` is not NULL, writes the surroundings to the region's texels in level 0 of `target`.
void ki_region_measure(const ki_search *search, ki_region *region, kiln_map *target);
/// Adds to the errors of `count` surfaces, given by their normals, those of a measured region: the
/// irradiance by what is taken out of the region minus that by the light's disc, channel by
/// channel, as a part of search->brightest.
void ki_region_add_errors(const ki_search *search, const ki_region *region,
                          const double (*normals)[3], int count, double (*errors)[3]);
/// Returns whether the disc of a measured region replaces what is taken out of the region: the
/// errors of surfaces are at most ki_light_error, or the region has no shape.
bool ki_region_is_disc(const ki_search *search, const ki_region *region);
/// Adds the harmonics of a light's disc to coefficients.
void ki_light_add_sh(const kiln_light *light, double c[KI_SH_COUNT][3]);
/// Returns the largest magnitude of a mismatch.
double ki_mismatch_size(const double mismatch[KI_SH_COUNT][3]);

#endif
