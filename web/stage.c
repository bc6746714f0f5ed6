// The web page's renderer (stage.h), compiled to WebAssembly. In: a view as numbers, environments,
// a reference picture. Out: the view on a WebGL 2 canvas, the furnace's residual, and the error
// against the reference. viewer/renderer.c draws and viewer/compare.c compares.
//
#include "stage.h"

#include "reference.h"
#include "viewer.h"

#include <emscripten/html5.h>
#include <stdio.h>
#include <stdlib.h>

struct stage {
    kiln_context *context;
    kiln_error error;
    view_renderer *renderer;
    kiln_environment coming;
    kiln_image truth;
    double numbers[STAGE_NUMBERS];
    double balls[VIEW_MAX_BALLS][10]; // of the last stage_balls: see stage_ball
};

stage *stage_create(void)
{
    stage *s = calloc(1, sizeof *s);
    kiln_context_def def = {.thread_count = 1};
    if (s && kiln_context_create(&def, &s->context, &s->error)) {
        free(s);
        return NULL;
    }
    return s;
}

bool stage_start(stage *s, int gl)
{
    if (gl <= 0 || emscripten_webgl_make_context_current(gl)) {
        snprintf(s->error.message, sizeof s->error.message,
                 "this browser offers no WebGL 2, which is needed to draw the balls");
        return false;
    }
    return view_create(s->context, NULL, &s->renderer, &s->error) == KILN_OK;
}

const char *stage_message(const stage *s)
{
    return s->error.message;
}

const char *stage_gl_name(const stage *s)
{
    return s->renderer ? view_gl_name(s->renderer) : "";
}

double *stage_numbers(stage *s)
{
    return s->numbers;
}

const char *stage_word(int kind, int index)
{
    enum { KINDS = 5 };
    static const char *(*const names[KINDS])(int) = {view_scene_name, view_method_name,
                                                     view_material_name, view_debug_name,
                                                     view_reflections_name};
    return kind < 0 || kind >= KINDS ? NULL : names[kind](index);
}

// ------------------------------------------------------------------------------------------- views

void stage_defaults(stage *s, int scene)
{
    view_options o = view_defaults((view_scene)scene);
    view_to_numbers(&o, s->numbers);
}

int stage_balls(stage *s)
{
    view_ball balls[VIEW_MAX_BALLS];
    view_options options = view_from_numbers(s->numbers);
    int count = view_balls(&options, balls);
    for (int i = 0; i < count; i++) {
        double *n = s->balls[i];
        for (int c = 0; c < 3; c++)
            n[c] = balls[i].centre[c];
        n[3] = balls[i].radius;
        n[4] = balls[i].roughness;
        n[5] = balls[i].metallic;
        n[6] = (double)balls[i].method;
        for (int c = 0; c < 3; c++)
            n[7 + c] = balls[i].metallic > 0 ? balls[i].f0[c] : balls[i].albedo[c];
    }
    return count;
}

const double *stage_ball(const stage *s, int index)
{
    return s->balls[index];
}

bool stage_draw(stage *s, int width, int height)
{
    view_options options = view_from_numbers(s->numbers);
    if (view_prepare(s->renderer, &options, &s->error))
        return false;
    view_draw(s->renderer, &options, width, height);
    return true;
}

bool stage_furnace(stage *s, int width, int height, double *off)
{
    view_options options = view_from_numbers(s->numbers);
    return !view_furnace_residual(s->renderer, &options, width, height, &off[0], &off[1],
                                  &s->error);
}

// ------------------------------------------------------------------------------------- environment

bool stage_room(stage *s, int size, int levels, int irradiance_size)
{
    kiln_environment_free(&s->coming);
    return !kiln_map_create(s->context, KILN_SHAPE_CUBE, size, levels, &s->coming.levels,
                            &s->error) &&
           !kiln_map_create(s->context, KILN_SHAPE_CUBE, irradiance_size, 1, &s->coming.irradiance,
                            &s->error);
}

float *stage_texels(stage *s, int level)
{
    return level < 0 ? s->coming.irradiance.level[0] : s->coming.levels.level[level];
}

double *stage_harmonics(stage *s)
{
    return &s->coming.sh.c[0][0];
}

void stage_roughness(stage *s, int level, double roughness)
{
    s->coming.levels.roughness[level] = (float)roughness;
}

bool stage_light(stage *s, int slot)
{
    s->coming.sh.bands = 3;
    bool good = !view_set_environment(s->renderer, (view_slot)slot, &s->coming.levels,
                                      &s->coming.sh, &s->coming.irradiance, &s->error);
    kiln_environment_free(&s->coming);
    return good;
}

void stage_discs(stage *s, const double *numbers, int count)
{
    kiln_lights lights = {.count = count < KILN_MAX_LIGHTS ? count : KILN_MAX_LIGHTS};
    for (int i = 0; i < lights.count; i++) {
        const double *n = numbers + 7 * (size_t)i;
        lights.light[i] = (kiln_light){.direction = {n[0], n[1], n[2]},
                                       .irradiance = {n[3], n[4], n[5]},
                                       .angular_radius = n[6]};
    }
    view_set_lights(s->renderer, &lights);
}

// --------------------------------------------------------------------------------------- the error

float *stage_truth(stage *s, int width, int height)
{
    kiln_image_free(&s->truth);
    return kiln_image_create(s->context, width, height, 3, &s->truth, &s->error) ? NULL
                                                                                 : s->truth.pixels;
}

bool stage_error(stage *s, double *off)
{
    view_options options = view_from_numbers(s->numbers);
    kiln_image image;
    if (view_picture(s->renderer, &options, s->truth.width, s->truth.height, true, &image,
                     &s->error))
        return false;
    view_error e = view_compare(&options, &image, &s->truth, true);
    kiln_image_free(&s->truth);
    s->truth = image;
    off[0] = e.rms;
    off[1] = e.largest;
    off[2] = e.screen;
    return true;
}

const float *stage_colours(const stage *s)
{
    return s->truth.pixels;
}
