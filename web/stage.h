// The view in the page: the renderer on a canvas, behind functions of numbers, which stage.mjs calls.
// What returns bool leaves a sentence in stage_message where it returns false.
#ifndef STAGE_H
#define STAGE_H

#include "view_numbers.h"

#include <emscripten.h>
#include <stdbool.h>

#define STAGE EMSCRIPTEN_KEEPALIVE

typedef struct stage stage;

/// The canvas by its CSS selector. Without WebGL 2 the stage is made all the same, with a sentence;
/// stage_ready tells.
STAGE stage *stage_create(const char *canvas);
STAGE bool stage_ready(const stage *s);
STAGE const char *stage_message(const stage *s);
STAGE const char *stage_gl_name(const stage *s);
/// What stage_draw draws, and what the functions below write.
STAGE double *stage_numbers(stage *s);
/// Sets the numbers to a scene's own.
STAGE void stage_defaults(stage *s, int scene);
/// Words for scenes (0), methods, materials and debug views (3); NULL beyond the last.
STAGE const char *stage_word(int kind, int index);

/// Room for an environment: six faces of RGB floats of `level`, or the irradiance's where that is -1;
/// nine harmonics of three doubles. Then stage_light puts it into the scene: slot 0 is exact, 1 the
/// textbook's.
STAGE bool stage_room(stage *s, int size, int levels, int irradiance_size);
STAGE float *stage_texels(stage *s, int level);
STAGE double *stage_harmonics(stage *s);
STAGE void stage_roughness(stage *s, int level, double roughness);
STAGE bool stage_light(stage *s, int slot);

STAGE void stage_draw(stage *s, int width, int height);
/// Largest and RMS difference from 1 of the furnace's compensated balls, in numbers 0 and 1 of `off`.
STAGE bool stage_furnace(stage *s, int width, int height, double *off);

/// Room for the truth of a picture of this size: RGB floats, row 0 at the top.
STAGE float *stage_truth(stage *s, int width, int height);
/// Draws the view at that size and compares. stage_colours then are those of its error, 0 to 1, and `off`
/// receives RMS and largest relative to the truth's mean, and the RMS of 255 on a screen.
STAGE bool stage_error(stage *s, double *off);
STAGE const float *stage_colours(const stage *s);

#endif
