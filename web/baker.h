// Baker for the web page: C functions over numbers and pointers, which baker.mjs calls. They write
// the same files as the command, into emscripten's file system in memory. A function that returns
// false leaves an error message in baker_message.
#ifndef BAKER_H
#define BAKER_H

#include "view_numbers.h"

#include <emscripten.h>
#include <stdbool.h>
#include <stddef.h>

#define BAKER EMSCRIPTEN_KEEPALIVE

typedef struct baker baker;

BAKER baker *baker_create(void);
/// Returns the error message of the last function that failed.
BAKER const char *baker_message(const baker *b);
BAKER const char *baker_cpu(const baker *b);
/// Decodes an image file from memory as the source. On failure the previous source stays.
BAKER bool baker_open(baker *b, const void *bytes, size_t size, const char *name);
BAKER bool baker_sky(baker *b, int size, double elevation, double azimuth, double turbidity);
BAKER int baker_source_shape(const baker *b);
BAKER int baker_source_size(const baker *b);
/// Returns level 0 of the source: RGB floats, row after row, of a cube six faces.
BAKER const float *baker_source_texels(const baker *b);
/// Sets the options of all later bakes, as `kiln bake` has them: --rotate YAW,PITCH,ROLL,
/// --exposure, --sun (a kiln_sun) with --lights (0 for 1) and the radiance of clamp=, 0 for auto.
BAKER void baker_options(baker *b, double yaw, double pitch, double roll, double exposure, int sun,
                         int light_count, double clamp);
/// Sets --up (a kiln_up) and --mirror of all later bakes. Is called after baker_options, which sets
/// both to none.
BAKER void baker_place(baker *b, int up, bool mirror);
/// Bakes as `kiln bake --size --levels` does, where 0 levels means all levels. On failure the
/// previous bake stays.
BAKER bool baker_bake(baker *b, int size, int levels);
/// Takes lights out of the source or clamps the source, as the options say. baker_scenery and
/// baker_truth then have the rest in the source, and baker_truth has the lights as discs. Before
/// that, turns the source about all axes but the vertical one, and mirrors the source, as the
/// options say; the view turns about the vertical axis. Until another source is opened, baker_bake
/// would bake the rest, and turn what is turned already.
BAKER bool baker_sun(baker *b);
/// Returns the number of lights that baker_sun took out of the source, and light `index` as seven
/// numbers: the direction to the light in the source, the irradiance of red, green and blue, and
/// the angular radius in degrees.
BAKER int baker_light_count(const baker *b);
BAKER const double *baker_light(baker *b, int index);
BAKER int baker_level_count(const baker *b);
BAKER int baker_level_size(const baker *b, int level);
BAKER double baker_roughness(const baker *b, int level);
/// Returns sentence number `index`, without a full stop, about what was found in the source and
/// what the last bake cut off and took out; NULL after the last sentence. The text stays until the
/// next call.
BAKER const char *baker_note(baker *b, int index);
/// Returns the six faces of a baked level, as RGB floats.
BAKER const float *baker_texels(const baker *b, int level);
/// Returns the spherical harmonics of the baked radiance: coefficients [9][3].
BAKER const double *baker_harmonics(const baker *b);
/// Bakes the textures that light the view, as `kiln render` does: levels down to 8 texels a side
/// and an irradiance cube. With `samples` above 0 the levels come from importance sampling with
/// that many samples a texel. The functions below number the irradiance cube as level -1.
BAKER bool baker_scenery(baker *b, int size, int samples);
BAKER int baker_scenery_levels(const baker *b);
BAKER int baker_scenery_size(const baker *b, int level);
BAKER double baker_scenery_roughness(const baker *b, int level);
BAKER const float *baker_scenery_texels(const baker *b, int level);
BAKER const double *baker_scenery_harmonics(const baker *b);

/// For checker.c: the context, the error and the source of a baker.
kiln_context *baker_context(baker *b);
kiln_error *baker_error(baker *b);
const kiln_map *baker_source(const baker *b);
/// Replaces the levels of the scenery, which belongs to the baker afterwards.
void baker_take_levels(baker *b, kiln_map *levels);

/// Integrates a view of the source until pixels reach the relative standard error `noise`, as `kiln
/// render --reference` does. The picture is RGB floats, row 0 at the top.
BAKER bool baker_truth(baker *b, const double *numbers, int width, int height, double noise,
                       bool alone);
BAKER const float *baker_truth_texels(const baker *b);
BAKER double baker_truth_noise(const baker *b);

/// Writes a table of the reflection model, as `kiln tables --table` does by default. Kind 0 is E,
/// kind 1 is E_avg, kind 2 is (A, B).
BAKER bool baker_table(baker *b, const char *path, int kind);

/// Returns a text of engine `index` of kiln's list: its name (0), title (1), files (2) or ending
/// (3); NULL for an index beyond the last engine.
BAKER const char *baker_engine_text(int index, int what);
/// Returns a number of an engine: its default size (0), 1 if levels are tuned by default (1), and
/// its formats as kiln_format (2 to 5), with 0 after the last.
BAKER int baker_engine_number(int index, int what);
/// Returns the name of a kiln_format; NULL for the number after the last format.
BAKER const char *baker_format_name(int format);
/// Bakes the source for an engine as `kiln bake --for` does, and encodes the files. `size` 0 is the
/// engine's own, `tune` a kiln_tune, `format` a kiln_format of the engine or 0. `name` is the path
/// of the output; `lights_name` that of the lights' file, or empty. The functions below return the
/// files, and a sentence about values that the files cannot hold, or NULL.
BAKER bool baker_engine_files(baker *b, int index, int size, int tune, int format, const char *name,
                              const char *lights_name);
BAKER int baker_file_count(const baker *b);
BAKER const char *baker_file_name(const baker *b, int index);
BAKER const unsigned char *baker_file_bytes(const baker *b, int index);
BAKER size_t baker_file_size(const baker *b, int index);
BAKER const char *baker_files_note(baker *b);

/// The histogram's bin k, from 0 to BAKER_STOPS - 1, is for radiances from 2^(k + BAKER_FIRST_STOP)
/// to 2^(k + 1 + BAKER_FIRST_STOP). Smaller radiances are in the first bin, greater ones in the
/// last.
enum { BAKER_STOPS = 40, BAKER_FIRST_STOP = -14 };
/// Returns the part of the source's texels that falls into each bin by its largest channel. Texels
/// of a panorama count by their solid angle.
BAKER const double *baker_histogram(baker *b);
/// Returns the largest value of the source.
BAKER double baker_largest(const baker *b);

/// Writes the irradiance cube of the last bake, as `kiln bake --irradiance` does.
BAKER bool baker_save_irradiance(baker *b, const char *path, int format);

/// Writes the lights that the last bake took out, as `kiln bake --lights-file` does.
BAKER bool baker_save_lights(baker *b, const char *path);

/// Writes the last bake; the ending of the name selects what: .ktx2 and .dds hold the levels, with
/// `format` a kiln_format; .json, .txt and .h hold the harmonics.
BAKER bool baker_save(baker *b, const char *path, int format);

#endif
