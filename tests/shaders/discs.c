// Discs of light: the real-time picture against the reference, the values of the ground, and the discs
// among the directions that the reference draws.
#include "headless.h"
#include "reference.h"
#include "trace.h"

#include "kit/context.h"

enum { WIDTH = 96, HEIGHT = 54 };

static view_headless *headless;
static view_renderer *renderer;

static int start(void **state)
{
    if (set_up(state) || view_headless_create(&headless, &error) ||
        view_create(context, view_headless_lookup, &renderer, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return -1;
    }
    return 0;
}

static int stop(void **state)
{
    view_destroy(renderer);
    view_headless_destroy(headless);
    return tear_down(state);
}

// A uniform grey environment, which the split sum shows exactly, and one light.
static const float grey = 0.05F;

static kiln_lights one_light(double elevation, double azimuth, double radius)
{
    kiln_lights lights = {.count = 1};
    double e = elevation * pi / 180, a = azimuth * pi / 180;
    lights.light[0] = (kiln_light){.direction = {cos(e) * sin(a), sin(e), -cos(e) * cos(a)},
                                   .irradiance = {3, 2.5, 2},
                                   .angular_radius = radius};
    return lights;
}

static void make_grey(kiln_map *map)
{
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 16, 1, map, &error));
    for (size_t i = 0; i < 3 * kiln_map_texels(map, 0); i++)
        map->level[0][i] = grey;
}

static void set(const kiln_map *map, const kiln_lights *lights)
{
    kiln_environment e;
    CHECK_OK(view_bake(context, map, 16, 0, &e, &error));
    CHECK_OK(
        view_set_environment(renderer, VIEW_SLOT_EXACT, &e.levels, &e.sh, &e.irradiance, &error));
    kiln_environment_free(&e);
    view_set_lights(renderer, lights);
}

// RMS of the pixels' relative differences from the reference, and the relative difference of the sums
// of all pixels.
typedef struct errors {
    double rms, sum, noise;
} errors;

static errors compare(const view_options *o, const kiln_lights *lights)
{
    view_reference_def def = {.noise = 0.02, .alone = true, .lights = lights};
    view_reference_report report;
    kiln_map map;
    kiln_image image, truth;
    double squares = 0, sum[2] = {0};
    make_grey(&map);
    set(&map, lights);
    CHECK_OK(view_picture(renderer, o, WIDTH, HEIGHT, true, &image, &error));
    CHECK_OK(view_reference(context, o, &map, WIDTH, HEIGHT, &def, &truth, &report, &error));
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        double a = (double)image.pixels[i], b = (double)truth.pixels[i];
        squares += pow((a - b) / (b + 0.02), 2) / (3 * WIDTH * HEIGHT);
        sum[0] += a;
        sum[1] += b;
    }
    kiln_image_free(&image);
    kiln_image_free(&truth);
    kiln_map_free(&map);
    errors to = {sqrt(squares), sum[0] / sum[1] - 1, report.noise};
    print_message("RMS %.4f, sum %.4f, noise %.4f\n", to.rms, to.sum, to.noise);
    return to;
}

static void discs_are_the_references(void **unused)
{
    (void)unused;
    static const double radii[] = {0.5, 4};
    static const view_material materials[] = {VIEW_MATERIAL_GOLD, VIEW_MATERIAL_PLASTIC};
    for (int m = 0; m < 2; m++)
        for (int i = 0; i < 2; i++) {
            kiln_lights lights = one_light(40, 130, radii[i]);
            view_options o = view_defaults(VIEW_SCENE_IBL);
            o.material = materials[m];
            o.samples = 1;
            o.ground = true;
            print_message("%s, radius %g degrees: ", view_material_name((int)o.material), radii[i]);
            errors e = compare(&o, &lights);
            CHECK_BELOW(e.rms, 0.04);
            CHECK_BELOW(fabs(e.sum), 0.005);
        }
}

// Ground that nothing shades reflects albedo / pi times the irradiance, and the umbra has no light of
// the disc.
static void the_ground_has_its_values(void **unused)
{
    (void)unused;
    kiln_lights lights = one_light(90, 0, 1);
    view_options o = view_defaults(VIEW_SCENE_IBL);
    view_ball balls[VIEW_MAX_BALLS];
    view_plane ground;
    kiln_map map;
    kiln_image image;
    o.samples = 1;
    o.ground = true;
    // From straight above the lowest row's end, whose shadow then lies under the balls.
    o.camera = (view_camera){.target = {0, -96, 0}, .elevation = 89, .distance = 3000, .fov = 45};
    assert_int_equal(view_balls(&o, balls), 10);
    assert_true(view_ground(&o, &ground));
    CHECK_NEAR(ground.height, -96, 1e-12);
    make_grey(&map);
    set(&map, &lights);
    CHECK_OK(view_picture(renderer, &o, WIDTH, HEIGHT, true, &image, &error));
    for (int c = 0; c < 3; c++) {
        double wanted = ground.albedo * ((double)grey + lights.light[0].irradiance[c] / pi);
        CHECK_NEAR((double)image.pixels[c], wanted, 2e-3 * wanted); // a corner
    }
    kiln_image_free(&image);
    view_options none = view_defaults(VIEW_SCENE_FURNACE);
    none.ground = true;
    assert_false(view_ground(&none, &ground));
    kiln_map_free(&map);
}

// The mean of radiance / pdf is the total, of d radiance / pdf the vector irradiance.
static void discs_are_drawn_as_bright_as_they_are(void **unused)
{
    (void)unused;
    enum { COUNT = 200000 };
    kiln_lights lights = one_light(30, 200, 4);
    view_options o = view_defaults(VIEW_SCENE_IBL);
    view_disc discs[KILN_MAX_LIGHTS];
    view_random random;
    view_light light;
    kiln_map map;
    double sum[3] = {0}, sphere = 0;
    o.rotation = 25;
    make_grey(&map);
    CHECK_OK(view_light_create(context, &map, o.rotation, &light, &error));
    int count = view_discs(&o, &lights, discs);
    assert_int_equal(count, 1);
    view_light_add(&light, discs, count);
    view_random_start(&random, 5);
    for (int i = 0; i < COUNT; i++) {
        double xi[2] = {view_random_next(&random), view_random_next(&random)}, d[3], c[3];
        view_light_sample(&light, xi, d);
        view_light_radiance(&light, d, c);
        double pdf = view_light_pdf(&light, d);
        sphere += 1 / pdf / COUNT;
        for (int k = 0; k < 3; k++)
            sum[k] += d[k] * c[0] / pdf / COUNT;
    }
    CHECK_NEAR(sphere, 4 * pi, 0.1);
    // The grey environment's vector irradiance is 0, and the light's is its irradiance.
    for (int k = 0; k < 3; k++)
        CHECK_NEAR(sum[k], 3 * discs[0].direction[k], 0.03);
    // At azimuth 200 the source has what the scene has at azimuth 175.
    CHECK_NEAR(discs[0].direction[0], cos(pi / 6) * sin(175 * pi / 180), 1e-12);
    CHECK_NEAR(discs[0].direction[2], -cos(pi / 6) * cos(175 * pi / 180), 1e-12);
    view_light_free(&light);
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(discs_are_the_references),
        cmocka_unit_test(the_ground_has_its_values),
        cmocka_unit_test(discs_are_drawn_as_bright_as_they_are),
    };
    return cmocka_run_group_tests_name("discs", tests, start, stop);
}
