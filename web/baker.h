// The baker in the page: kiln's library behind functions of numbers, which baker.js calls. It makes
// the files that the command makes, in the file system that emscripten keeps in memory. What returns
// bool leaves a sentence in baker_message where it returns false, and what was there before stays.
#ifndef BAKER_H
#define BAKER_H

#include "view_numbers.h"

#include <emscripten.h>
#include <stdbool.h>
#include <stddef.h>

#define BAKER EMSCRIPTEN_KEEPALIVE

typedef struct baker baker;

BAKER baker *baker_create(void);
/// The sentence of the last failure.
BAKER const char *baker_message(const baker *b);
BAKER const char *baker_cpu(const baker *b);
/// Reads a file from memory. What was opened before stays where it fails.
BAKER bool baker_open(baker *b, const void *bytes, size_t size, const char *name);
BAKER bool baker_sky(baker *b, int size, double elevation, double azimuth, double turbidity);
BAKER int baker_source_shape(const baker *b);
BAKER int baker_source_size(const baker *b);
BAKER const float *baker_source_texels(const baker *b);
/// What `kiln bake --size --levels --rotate --exposure` does; 0 levels for all. What was baked
/// before stays where it fails.
BAKER bool baker_bake(baker *b, int size, int levels, double rotation, double exposure);
BAKER int baker_level_count(const baker *b);
BAKER int baker_level_size(const baker *b, int level);
BAKER double baker_roughness(const baker *b, int level);
/// Six faces of RGB floats.
BAKER const float *baker_texels(const baker *b, int level);
/// Coefficients [9][3] of the radiance.
BAKER const double *baker_harmonics(const baker *b);
/// Bakes what the view is lit by, as `kiln render` does: fewer levels, an irradiance cube; by the
/// textbook with so many samples a texel where that is above 0. It is read as level -1 for the irradiance and from 0 on.
BAKER bool baker_scenery(baker *b, int size, int samples);
BAKER int baker_scenery_levels(const baker *b);
BAKER int baker_scenery_size(const baker *b, int level);
BAKER double baker_scenery_roughness(const baker *b, int level);
BAKER const float *baker_scenery_texels(const baker *b, int level);
BAKER const double *baker_scenery_harmonics(const baker *b);

/// Integrates a view of what was opened, as `kiln render --reference` does, to a noise: RGB floats, row 0 at
/// the top.
BAKER bool baker_truth(baker *b, const double *numbers, int width, int height, double noise,
                       bool alone);
BAKER const float *baker_truth_texels(const baker *b);
BAKER double baker_truth_noise(const baker *b);

/// Writes a table of the reflection model, as `kiln tables --table` does by default: kind 0 is e, 1
/// eavg, 2 dfg.
BAKER bool baker_table(baker *b, const char *path, int kind);

/// The irradiance beside what was baked, as `kiln bake --irradiance` writes it.
BAKER bool baker_save_irradiance(baker *b, const char *path, int format);

/// Writes a file by its name's ending: .ktx2 (format: kiln_format), .dds, or the harmonics as
/// .json, .txt and .h.
BAKER bool baker_save(baker *b, const char *path, int format);

#endif
