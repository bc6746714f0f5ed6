// The program bench_shading: time of a frame of 1920 x 1080 that one metal ball fills, for each way
// to look reflections up. In: a panorama. Out: lines of CSV with the milliseconds of processor time
// and of wall-clock time of the fastest frame, and the lookups of the environment's cube at each
// pixel. Where OpenGL is software (Mesa's llvmpipe), processor time is the time of the shader.
#include "headless.h"
#include "viewer.h"

#include "gl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 1920, HEIGHT = 1080, ROUNDS = 5, BALL = 7 };

typedef struct times {
    double cpu, wall;
} times;

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void bind_frame(const view_gl *gl)
{
    GLuint buffer, frame;
    gl->GenRenderbuffers(1, &buffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, WIDTH, HEIGHT);
    gl->GenFramebuffers(1, &frame);
    gl->BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
}

// Draws one frame; reading a pixel waits for its end.
static times draw(const view_gl *gl, view_renderer *renderer, const view_options *o)
{
    unsigned char pixel[4];
    times t = {seconds(CLOCK_PROCESS_CPUTIME_ID), seconds(CLOCK_MONOTONIC)};
    view_draw(renderer, o, WIDTH, HEIGHT);
    gl->ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    return (times){1e3 * (seconds(CLOCK_PROCESS_CPUTIME_ID) - t.cpu),
                   1e3 * (seconds(CLOCK_MONOTONIC) - t.wall)};
}

// A view in which the ball of roughness 0.55 with a single bounce covers every pixel.
static view_options close_up(void)
{
    view_options o = view_defaults(VIEW_SCENE_IBL);
    view_ball balls[VIEW_MAX_BALLS];
    view_balls(&o, balls);
    memcpy(o.camera.target, balls[BALL].centre, sizeof o.camera.target);
    o.camera.elevation = 0;
    o.camera.distance = 60;
    o.camera.fov = 40;
    o.samples = 1;
    return o;
}

// Draws every way in turn, so that a change of the machine's speed concerns all of them.
static kiln_result measure(const view_gl *gl, view_renderer *renderer, kiln_error *error)
{
    view_options o = close_up();
    times best[VIEW_REFLECTIONS_COUNT];
    for (int round = 0; round <= ROUNDS; round++)
        for (int way = 0; way < VIEW_REFLECTIONS_COUNT; way++) {
            o.reflections = (view_reflections)way;
            kiln_result result = view_prepare(renderer, &o, error);
            if (result)
                return result;
            times t = draw(gl, renderer, &o);
            if (round < 2 || t.cpu < best[way].cpu) // round 0 compiles and uploads
                best[way].cpu = t.cpu;
            if (round < 2 || t.wall < best[way].wall)
                best[way].wall = t.wall;
        }
    printf("reflections,lookups,cpu_ms,wall_ms,cpu_over_straight\n");
    for (int way = 0; way < VIEW_REFLECTIONS_COUNT; way++)
        printf("%s,%d,%.1f,%.1f,%.3f\n", view_reflections_name(way),
               way > VIEW_REFLECTIONS_ONE ? way - VIEW_REFLECTIONS_ONE + 1 : 1, best[way].cpu,
               best[way].wall, best[way].cpu / best[VIEW_REFLECTIONS_STRAIGHT].cpu);
    return KILN_OK;
}

int main(int argc, char **argv)
{
    kiln_context *context = NULL;
    kiln_error error = {0};
    kiln_map source = {0};
    kiln_environment e = {0};
    view_headless *headless = NULL;
    view_renderer *renderer = NULL;
    view_gl gl;
    const char *missing = NULL;
    if (argc != 2) {
        fputs("usage: bench_shading PANORAMA\n", stderr);
        return 2;
    }
    kiln_result result = kiln_context_create(NULL, &context, &error);
    if (!result)
        result = kiln_map_load(context, argv[1], NULL, &source, &error);
    if (!result)
        result = view_bake(context, &source, 512, 0, &e, &error);
    if (!result)
        result = view_headless_create(&headless, &error);
    if (!result)
        result = view_create(context, view_headless_lookup, &renderer, &error);
    if (!result)
        result = view_set_environment(renderer, VIEW_SLOT_EXACT, &e.levels, &e.sh, &e.irradiance,
                                      &error);
    if (!result && view_gl_load(&gl, view_headless_lookup, &missing)) {
        bind_frame(&gl);
        printf("# %s, %d x %d, one ray a pixel, every pixel gold of roughness 0.55\n",
               view_gl_name(renderer), WIDTH, HEIGHT);
        result = measure(&gl, renderer, &error);
    }
    if (result)
        fprintf(stderr, "bench_shading: %s\n", error.message);
    view_destroy(renderer);
    view_headless_destroy(headless);
    kiln_environment_free(&e);
    kiln_map_free(&source);
    kiln_context_destroy(context);
    return result != KILN_OK;
}
