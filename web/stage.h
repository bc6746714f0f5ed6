// Renderer for the web page: C functions over numbers and pointers, which stage.mjs calls. They
// draw in a WebGL 2 context. A function that returns false leaves an error message in
// stage_message.
#ifndef STAGE_H
#define STAGE_H

#include "view_numbers.h"

#include <emscripten.h>
#include <stdbool.h>

#define STAGE EMSCRIPTEN_KEEPALIVE

typedef struct stage stage;

/// Creates a stage that does not draw yet. Names, default views and balls can be asked for.
/// Returns NULL if memory runs out.
STAGE stage *stage_create(void);
/// Compiles the shaders in the WebGL 2 context that emscripten knows by the handle `gl`; 0 stands
/// for a browser without WebGL 2. All functions that draw need a started stage.
STAGE bool stage_start(stage *s, int gl);
STAGE const char *stage_message(const stage *s);
STAGE const char *stage_gl_name(const stage *s);
/// Returns the array of view numbers (view_numbers.h) that stage_draw, stage_furnace and
/// stage_error read.
STAGE double *stage_numbers(stage *s);
/// Sets the array of view numbers to the scene's defaults.
STAGE void stage_defaults(stage *s, int scene);
/// Returns the name of entry `index` of the scenes (kind 0), methods (1), materials (2), debug
/// views (3) or ways to look reflections up (4); NULL for an index beyond the last entry.
STAGE const char *stage_word(int kind, int index);

/// Allocates an environment: six faces of RGB floats for each level (stage_texels; level -1 is the
/// irradiance cube) and nine harmonics of three doubles. stage_light uploads it once it is filled:
/// slot 0 for the exact environment, slot 1 for the sampled one.
STAGE bool stage_room(stage *s, int size, int levels, int irradiance_size);
STAGE float *stage_texels(stage *s, int level);
STAGE double *stage_harmonics(stage *s);
STAGE void stage_roughness(stage *s, int level, double roughness);
STAGE bool stage_light(stage *s, int slot);
/// Shows lights as discs: `count` lights of seven numbers each, as baker_light gives them. Lights
/// beyond KILN_MAX_LIGHTS are left out.
STAGE void stage_discs(stage *s, const double *numbers, int count);

/// Computes the balls of the view in stage_numbers and returns their number.
STAGE int stage_balls(stage *s);
/// Returns ball `index` of the last stage_balls as ten numbers: the centre, the radius, the
/// roughness, how metallic the ball is, the index of its method, and its linear colour, which is
/// the reflectance of a metal and the diffuse albedo of another material.
STAGE const double *stage_ball(const stage *s, int index);

/// Draws the view in stage_numbers. The first view with reflections by one, two or three lookups
/// takes about a second longer, for their table.
STAGE bool stage_draw(stage *s, int width, int height);
/// Renders the furnace; off[0] receives the largest difference from 1 and off[1] the RMS, of the
/// balls with compensation.
STAGE bool stage_furnace(stage *s, int width, int height, double *off);

/// Allocates a reference picture of this size: RGB floats, row 0 at the top.
STAGE float *stage_truth(stage *s, int width, int height);
/// Draws the view in the size of the reference picture and compares the two. stage_colours then
/// returns the error's colours, 0 to 1. off[0] receives the RMS and off[1] the largest difference,
/// both over the reference's mean; off[2] receives the RMS in steps of 255 on the screen.
STAGE bool stage_error(stage *s, double *off);
STAGE const float *stage_colours(const stage *s);

#endif
