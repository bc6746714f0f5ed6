// Prints the errors of the real-time picture. In: RMS errors of each ball for each way to look
// reflections up. Out: a table or JSON on standard output, in steps of 255 of what a screen shows.
#include "render_error.h"

#include "json.h"

#include <stdio.h>

static void print_figures(const render_errors *e, int ball)
{
    printf(" %6.2f", ball < 0 ? e->noise.screen : e->noise.ball_screen[ball]);
    for (int way = 0; way < VIEW_REFLECTIONS_COUNT; way++)
        printf(" %8.2f", ball < 0 ? e->by[way].screen : e->by[way].ball_screen[ball]);
    putchar('\n');
}

void render_print_errors(const view_options *o, const render_errors *e)
{
    view_ball balls[VIEW_MAX_BALLS];
    int count = view_balls(o, balls);
    puts("RMS errors on the screen in steps of 255, by ball and by --reflections:");
    printf("  %9s %8s  %-12s %6s", "roughness", "metallic", "method", "noise");
    for (int way = 0; way < VIEW_REFLECTIONS_COUNT; way++)
        printf(" %8s", view_reflections_name(way));
    putchar('\n');
    for (int i = 0; i < count; i++) {
        printf("  %9.3g %8.3g  %-12s", balls[i].roughness, balls[i].metallic,
               view_method_name((int)balls[i].method));
        print_figures(e, i);
    }
    printf("  %-32s", "all balls");
    print_figures(e, -1);
}

static void write_figures(json *j, const view_error *e)
{
    json_array(j, "rms");
    for (int i = 0; i < e->ball_count; i++)
        json_rounded(j, NULL, e->ball_screen[i], 6);
    json_end(j);
    json_rounded(j, "all", e->screen, 6);
}

static void write_way(json *j, const view_options *o, int way, const view_error *e)
{
    view_ball balls[VIEW_MAX_BALLS];
    int count = view_balls(o, balls);
    json_object(j, view_reflections_name(way));
    json_array(j, "roughness");
    for (int i = 0; i < count; i++)
        json_number(j, NULL, balls[i].roughness);
    json_end(j);
    json_array(j, "method");
    for (int i = 0; i < count; i++)
        json_text(j, NULL, view_method_name((int)balls[i].method));
    json_end(j);
    write_figures(j, e);
    json_end(j);
}

void render_print_json(const char *name, const view_options *o, int width, int height,
                       const render_errors *e)
{
    json j = {0};
    json_object(&j, NULL);
    json_text(&j, "environment", name ? name : "");
    json_text(&j, "scene", view_scene_name((int)o->scene));
    json_text(&j, "material", view_material_name((int)o->material));
    json_number(&j, "width", width);
    json_number(&j, "height", height);
    json_rounded(&j, "reference_noise", e->reference.noise, 6);
    json_object(&j, "noise");
    write_figures(&j, &e->noise);
    json_end(&j);
    json_object(&j, "reflections");
    for (int way = 0; way < VIEW_REFLECTIONS_COUNT; way++)
        write_way(&j, o, way, &e->by[way]);
    json_end(&j);
    json_end(&j);
}
