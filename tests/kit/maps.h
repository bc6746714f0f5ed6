// Contexts and maps for tests: made without a return code to look at, filled, and compared.
#ifndef KILN_KIT_MAPS_H
#define KILN_KIT_MAPS_H

#include <kiln/kiln.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// A context with this number of threads; 0 means as many as there are cores.
kiln_context *make_context(int threads);

/// A context with this number of threads that uses one instruction set.
kiln_context *make_context_for(int threads, enum kiln_cpu cpu);

/// A black map; level_count 0 makes all levels down to one texel.
kiln_map make_map(kiln_context *context, kiln_shape shape, int size, int level_count);

/// A black panorama of one level.
kiln_map make_panorama(kiln_context *context, int size);

/// A map of one level of noise, uniform in (0, 1).
kiln_map make_noise(kiln_context *context, kiln_shape shape, int size, uint64_t seed);

/// A map whose first 2048 values of a level all differ, from 0 to 256 in steps of 1/8, which half
/// floats hold exactly. Level k has the roughness k / (level_count - 1).
kiln_map make_steps(kiln_context *context, kiln_shape shape, int size, int level_count);

/// What kiln_bake makes of a sky of 32 rows: levels of size 16, irradiance of size 4, three bands.
kiln_environment make_sky_bake(kiln_context *context);

/// Number of floats in a level.
size_t value_count(const kiln_map *map, int level);

/// Sets every value of level 0.
void fill_constant(kiln_map *map, float value);

/// Sets every value of level 0 to noise, uniform in (low, high).
void fill_noise(kiln_map *map, uint64_t seed, double low, double high);

/// Sets the colour of every texel of a level to factor (2 + d), where d is the texel's direction:
/// three linear functions on the sphere, all positive.
void fill_gradient(kiln_map *map, int level, double factor);

/// The texel in column x, row y of level 0 of a panorama.
float *texel_at(const kiln_map *map, int x, int y);

/// Unit direction of the point (x, y) of a panorama, in texels; x and y may have fractions.
void panorama_direction(int size, double x, double y, double d[3]);

/// Whether two maps have the same shape, sizes, roughnesses and bits of all levels.
bool same_map(const kiln_map *a, const kiln_map *b);

/// Checks that two maps have the same levels, bit by bit, at least as many as the first map has.
void check_same_levels(const kiln_map *a, const kiln_map *b);

/// Hash of the bits of all levels, FNV-1a.
uint64_t hash_map(const kiln_map *map);

/// The largest |a - b| / (|b| + base) over a level.
double largest_difference(const kiln_map *a, const kiln_map *b, int level, double base);

#endif
