// Laws of the ways to look reflections up: a white furnace stays white, and more lookups have
// smaller errors against the reference. The reflections of all ways have one environment and one
// reference.
#include "reflections.h"

#include "reference.h"

#include "drawing.h"

enum { WIDTH = 48, HEIGHT = 27, BAKED = 32, TABLE = 12 };

// Smooth light with a lamp, a window and a dark floor, which leans and stretches reflections.
static void make_environment(kiln_map *map)
{
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 32, 1, map, &error));
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double d[3];
        kiln_map_direction(map, 0, i, d);
        double lamp = 3 * exp(-20 * (1 - (0.6 * d[0] + 0.5 * d[1] + 0.62 * d[2])));
        double window = d[1] > 0.1 && d[1] < 0.6 && d[0] < -0.3 ? 1.5 : 0;
        for (size_t c = 0; c < 3; c++)
            map->level[0][3 * i + c] = (float)(d[1] < -0.1 ? 0.1 : 0.3 + lamp + window);
    }
}

static void light_up(const kiln_map *map)
{
    kiln_environment e;
    CHECK_OK(view_bake(context, map, BAKED, 0, &e, &error));
    CHECK_OK(
        view_set_environment(renderer, VIEW_SLOT_EXACT, &e.levels, &e.sh, &e.irradiance, &error));
    kiln_environment_free(&e);
}

// Mean over the balls with one bounce and a roughness of 0.35 to 0.95, without the reference's
// noise.
static double mean_of(const view_options *o, const view_error *e, const view_error *noise)
{
    view_ball balls[VIEW_MAX_BALLS];
    double sum = 0, count = 0;
    for (int i = 0; i < view_balls(o, balls); i++)
        if (balls[i].method == VIEW_METHOD_SINGLE && balls[i].roughness > 0.3) {
            double all = e->ball_screen[i], of_noise = noise->ball_screen[i];
            sum += sqrt(fmax(all * all - of_noise * of_noise, 0));
            count++;
        }
    return sum / count;
}

void more_lookups_have_smaller_errors(void **unused)
{
    (void)unused;
    // as parts of the error of bent reflections
    static const double at_most[VIEW_REFLECTIONS_COUNT] = {[VIEW_REFLECTIONS_ONE] = 0.6,
                                                           [VIEW_REFLECTIONS_TWO] = 0.5,
                                                           [VIEW_REFLECTIONS_THREE] = 0.45};
    view_options o = view_defaults(VIEW_SCENE_IBL);
    kiln_map map;
    kiln_image truth, deviation;
    o.one_row = true;
    o.samples = 1;
    o.lobes_size = TABLE;
    make_environment(&map);
    light_up(&map);
    view_reference_def def = {.noise = 0.08, .alone = true, .deviation = &deviation};
    CHECK_OK(view_reference(context, &o, &map, WIDTH, HEIGHT, &def, &truth, NULL, &error));
    view_error noise = view_noise(&o, &truth, &deviation);
    double error_of[VIEW_REFLECTIONS_COUNT];
    for (int way = 0; way < VIEW_REFLECTIONS_COUNT; way++) {
        kiln_image image;
        o.reflections = (view_reflections)way;
        CHECK_OK(view_picture(renderer, &o, WIDTH, HEIGHT, true, &image, &error));
        view_error e = view_compare(&o, &image, &truth, false);
        error_of[way] = mean_of(&o, &e, &noise);
        print_message("%-9s %.2f of 255\n", view_reflections_name(way), error_of[way]);
        kiln_image_free(&image);
    }
    CHECK_BELOW(error_of[VIEW_REFLECTIONS_BENT], 0.7 * error_of[VIEW_REFLECTIONS_STRAIGHT]);
    for (int way = VIEW_REFLECTIONS_ONE; way < VIEW_REFLECTIONS_COUNT; way++)
        CHECK_BELOW(error_of[way], at_most[way] * error_of[VIEW_REFLECTIONS_BENT]);
    kiln_image_free(&deviation);
    kiln_image_free(&truth);
    kiln_map_free(&map);
}

// The weights of taps need not sum to 1: the harmonics add what the taps lack.
void the_furnace_stays_white(void **unused)
{
    (void)unused;
    view_options o = view_defaults(VIEW_SCENE_FURNACE);
    o.lobes_size = TABLE;
    for (int way = 0; way < VIEW_REFLECTIONS_COUNT; way++) {
        double largest, rms;
        o.reflections = (view_reflections)way;
        CHECK_OK(view_furnace_residual(renderer, &o, 160, 90, &largest, &rms, &error));
        print_message("%-9s largest %.2e, RMS %.2e\n", view_reflections_name(way), largest, rms);
        CHECK_BELOW(largest, 1e-4);
    }
}

// view_noise against the difference of two independent pictures of the reference.
void the_noise_is_that_of_the_reference(void **unused)
{
    (void)unused;
    view_options o = view_defaults(VIEW_SCENE_IBL);
    kiln_map map;
    kiln_image a, b, deviation;
    o.samples = 1;
    make_environment(&map);
    view_reference_def def = {.noise = 0.1, .alone = true, .deviation = &deviation};
    CHECK_OK(view_reference(context, &o, &map, WIDTH, HEIGHT, &def, &a, NULL, &error));
    def = (view_reference_def){.noise = 0.03, .alone = true};
    CHECK_OK(view_reference(context, &o, &map, WIDTH, HEIGHT, &def, &b, NULL, &error));
    double told = view_noise(&o, &a, &deviation).screen;
    double seen = view_compare(&o, &a, &b, false).screen;
    print_message("noise %.2f of 255, as the standard errors say %.2f\n", seen, told);
    CHECK_NEAR(told, seen, 0.15 * seen);
    kiln_image_free(&deviation);
    kiln_image_free(&b);
    kiln_image_free(&a);
    kiln_map_free(&map);
}
