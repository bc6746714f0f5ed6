// A context, a screen that nobody sees and a renderer for a whole test program, and a law of
// lights:
//     cmocka_run_group_tests(tests, start_drawing, stop_drawing)
// Include this header last, because it includes kit/context.h.
#ifndef KILN_SHADERS_DRAWING_H
#define KILN_SHADERS_DRAWING_H

#include "headless.h"
#include "trace.h"
#include "viewer.h"

#include "kit/context.h"

extern view_headless *headless;
extern view_renderer *renderer;

int start_drawing(void **state);
int stop_drawing(void **state);

/// What `count` directions drawn from a light give, each divided by its probability density: the
/// solid angle of all directions, which is 4 pi; the radiance of red, green and blue integrated
/// over them; and the same times the direction, as [axis][channel].
typedef struct light_means {
    double sphere, total[3], moment[3][3];
} light_means;

/// Fails if a drawn direction is not of length 1. `seed` starts the random numbers.
light_means draw_light(const view_light *light, int count, uint64_t seed);

#endif
