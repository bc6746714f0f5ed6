// The window shows what the headless renderer draws (with --screen, where there is one), and keys
// and mouse do what they say.
#include "window.h"
#include "controls.h"
#include "headless.h"

#include "kit/context.h"

// ---------------------------------------------------------------------------------------- controls

static void a_whole_turn_leads_back(void **unused)
{
    (void)unused;
    view_options o = view_defaults(VIEW_SCENE_IBL), start = o;
    for (int i = 0; i < 16; i++) {
        view_orbit(&o, 90, i < 8 ? 3 : -3, 720);
        view_turn(&o, 90, 720);
    }
    CHECK_NEAR(o.camera.azimuth, start.camera.azimuth, 1e-9);
    CHECK_NEAR(o.camera.elevation, start.camera.elevation, 1e-9);
    CHECK_NEAR(o.rotation, start.rotation, 1e-9);
    view_orbit(&o, 0, 1e6, 720);
    CHECK_NEAR(o.camera.elevation, 89, 0);
    view_zoom(&o, 1e6);
    CHECK_NEAR(o.camera.distance, 60, 0);
    view_zoom(&o, -1e6);
    CHECK_NEAR(o.camera.distance, 4000, 0);
}

static void keys_do_what_they_say(void **unused)
{
    (void)unused;
    static const bool all[VIEW_SCENE_COUNT] = {true, true, true, true, true};
    static const bool few[VIEW_SCENE_COUNT] = {true};
    view_options o = view_defaults(VIEW_SCENE_ASSIGNMENT);
    assert_false(view_key(&o, '2', few));
    assert_int_equal(o.scene, VIEW_SCENE_ASSIGNMENT);
    for (int i = 0; i < VIEW_SCENE_COUNT; i++) {
        assert_true(view_key(&o, (char)('1' + i), all));
        assert_int_equal(o.scene, i);
    }
    view_options before = o;
    for (int i = 0; i < VIEW_METHOD_COUNT; i++)
        view_key(&o, 'm', all);
    for (int i = 0; i < VIEW_MATERIAL_COUNT; i++)
        view_key(&o, 'n', all);
    for (int i = 0; i < VIEW_DEBUG_COUNT; i++)
        view_key(&o, 'd', all);
    view_key(&o, 'r', all);
    view_key(&o, 'e', all);
    assert_memory_equal(&o, &before, sizeof o);
    // Each line names its keys first, and none of them does nothing.
    for (const char *key = "[]+-bovi "; *key; key++)
        assert_true(view_key(&o, *key, all));
    assert_false(view_key(&o, 'x', all));
}

// ------------------------------------------------------------------------------------------ window

static int on_screen;

static kiln_result light_slot(view_renderer *renderer, view_slot slot, kiln_error *why)
{
    kiln_sky_def def = {.size = 64};
    kiln_map sky = {0};
    kiln_environment e = {.sh = {.bands = 0}};
    kiln_result result = kiln_sky(context, &def, &sky, why);
    if (result == KILN_OK) {
        kiln_map_expose(&sky, -4);
        result = view_bake(context, &sky, 32, slot == VIEW_SLOT_TEXTBOOK ? 1024 : 0, &e, why);
    }
    if (result == KILN_OK)
        result = view_set_environment(renderer, slot, &e.levels, &e.sh, &e.irradiance, why);
    kiln_environment_free(&e);
    kiln_map_free(&sky);
    return result;
}

static kiln_result light_up(void *user, view_renderer *renderer, kiln_error *why)
{
    (void)user;
    return light_slot(renderer, VIEW_SLOT_EXACT, why);
}

static int textbook_count;

static kiln_result light_by_textbook(void *user, view_renderer *renderer, bool wait, double *done,
                                     kiln_error *why)
{
    (void)user;
    assert_true(wait); // a screenshot is of the whole
    *done = 1;
    textbook_count++;
    return light_slot(renderer, VIEW_SLOT_TEXTBOOK, why);
}

enum { WIDTH = 480, HEIGHT = 270 };

static void draw_headless(const view_options *o, kiln_image *image)
{
    view_headless *headless;
    view_renderer *renderer;
    CHECK_OK(view_headless_create(&headless, &error));
    CHECK_OK(view_create(context, view_headless_lookup, &renderer, &error));
    CHECK_OK(light_up(NULL, renderer, &error));
    CHECK_OK(light_by_textbook(NULL, renderer, true, &(double){0}, &error));
    CHECK_OK(view_picture(renderer, o, WIDTH, HEIGHT, false, image, &error));
    view_destroy(renderer);
    view_headless_destroy(headless);
}

static void the_window_shows_the_headless_picture(void **unused)
{
    (void)unused;
    if (!on_screen)
        skip();
    for (int scene = 0; scene < VIEW_SCENE_COUNT; scene++) {
        view_options o = view_defaults((view_scene)scene);
        kiln_image seen = {0}, wanted = {0};
        view_window_def def = {.width = WIDTH,
                               .height = HEIGHT,
                               .options = o,
                               .prepare = light_up,
                               .has_environment = true,
                               .textbook = light_by_textbook,
                               .screenshot = &seen};
        textbook_count = 0;
        CHECK_OK(view_window(context, &def, &error));
        assert_int_equal(textbook_count, scene == VIEW_SCENE_COMPARE); // only when it is wanted
        assert_int_equal(seen.width, WIDTH);
        assert_int_equal(seen.height, HEIGHT);
        draw_headless(&o, &wanted);
        double squares = 0, largest = 0;
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT * 3; i++) {
            double off = 255 * fabs((double)seen.pixels[i] - (double)wanted.pixels[i]);
            squares += off * off;
            largest = fmax(largest, off);
        }
        double rms = sqrt(squares / (WIDTH * HEIGHT * 3));
        print_message("%s: RMS %.3f of 255, largest %.3f\n", view_scene_name(scene), rms, largest);
        CHECK_BELOW(rms, 0.5);
        CHECK_BELOW(largest, 2); // silhouettes too
        kiln_image_free(&seen);
        kiln_image_free(&wanted);
    }
}

// Without a screen there is a sentence.
static void no_screen_is_said(void **unused)
{
    (void)unused;
    if (on_screen)
        skip();
    kiln_image seen = {0};
    view_window_def def = {.options = view_defaults(VIEW_SCENE_ASSIGNMENT), .screenshot = &seen};
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    assert_int_equal(view_window(context, &def, &error), KILN_ERROR_UNSUPPORTED);
    CHECK_SAYS(error.message, "GLFW");
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_whole_turn_leads_back),
        cmocka_unit_test(keys_do_what_they_say),
        cmocka_unit_test(the_window_shows_the_headless_picture),
        cmocka_unit_test(no_screen_is_said),
    };
    on_screen = argc > 1 && !strcmp(argv[1], "--screen");
    return cmocka_run_group_tests_name("window", tests, set_up, tear_down);
}
