// The daylight sky keeps its laws for every sun and every haze.

#include "bake/sky.h"

#include "kit/context.h"

static const double elevations[] = {-5, -3, -1, -0.2, 0, 0.1, 1, 5, 20, 45, 70, 89.9, 90};
static const double turbidities[] = {1.7, 2, 3, 5, 7, 10};
enum {
    ELEVATIONS = sizeof elevations / sizeof *elevations,
    TURBIDITIES = sizeof turbidities / sizeof *turbidities
};

static kiln_map sky_of(int size, double elevation, double azimuth, double turbidity)
{
    kiln_map map;
    kiln_sky_def def = {.size = size,
                        .elevation = elevation != 0 ? elevation : KILN_ZERO,
                        .azimuth = azimuth,
                        .turbidity = turbidity};
    CHECK_OK(kiln_sky(context, &def, &map, &error));
    return map;
}

static double luminance(const float *rgb)
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static double luminance_of(const double *rgb)
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static double texel_area(int size, int row)
{
    return (cos(pi * row / size) - cos(pi * (row + 1) / size)) * pi / size;
}

static void no_texel_is_negative_or_not_a_number(void **state)
{
    (void)state;
    for (int i = 0; i < ELEVATIONS; i++)
        for (int k = 0; k < TURBIDITIES; k++)
            for (int size = 16; size <= 33; size += 17) {
                kiln_map map = sky_of(size, elevations[i], 40, turbidities[k]);
                for (size_t t = 0; t < kiln_map_texels(&map, 0); t++) {
                    const float *texel = map.level[0] + 3 * t;
                    for (int c = 0; c < 3; c++)
                        if (!(texel[c] >= 0 && texel[c] < 1e7F))
                            fail_msg("texel %zu is %g at elevation %g, turbidity %g", t,
                                     (double)texel[c], elevations[i], turbidities[k]);
                    // Nothing is black: the darkest dusk still has light everywhere.
                    assert_true(luminance(texel) > 1e-5);
                }
                kiln_map_free(&map);
            }
}

// Left of the sun is as right of it: with the sun at -Z, column x and width - 1 - x.
static void symmetric_about_the_sun(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    for (int i = 0; i < ELEVATIONS; i++) {
        kiln_map map = sky_of(SIZE, elevations[i], 0, 3);
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++)
                for (int c = 0; c < 3; c++) {
                    double a = (double)texel_at(&map, x, y)[c];
                    double b = (double)texel_at(&map, 2 * SIZE - 1 - x, y)[c];
                    CHECK_NEAR(a, b, 1e-6 * b);
                }
        kiln_map_free(&map);
    }
}

// Turning the sun by a whole number of columns moves the picture.
static void azimuth_moves_the_picture(void **state)
{
    (void)state;
    enum { SIZE = 32, STEP = 9 };
    kiln_map a = sky_of(SIZE, 25, 0, 3), b = sky_of(SIZE, 25, STEP * 180.0 / SIZE, 3);
    kiln_map c = sky_of(SIZE, 25, STEP * 180.0 / SIZE - 720, 3);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < 2 * SIZE; x++)
            for (int k = 0; k < 3; k++) {
                double from = (double)texel_at(&a, x, y)[k];
                int moved = (x + STEP) % (2 * SIZE);
                CHECK_NEAR((double)texel_at(&b, moved, y)[k], from, 1e-6 * from);
                CHECK_NEAR((double)texel_at(&c, moved, y)[k], from, 1e-6 * from);
            }
    kiln_map_free(&c);
    kiln_map_free(&b);
    kiln_map_free(&a);
}

static void brightest_at_the_sun(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 5; k++) {
            double elevation = 2 + 12 * i, azimuth = -170 + 77 * k;
            kiln_map map = sky_of(SIZE, elevation, azimuth, 3);
            size_t best = 0, width = 2 * (size_t)SIZE;
            for (size_t t = 1; t < kiln_map_texels(&map, 0); t++)
                if (luminance(map.level[0] + 3 * t) > luminance(map.level[0] + 3 * best))
                    best = t;
            double y = (90 - elevation) / 180 * SIZE, x = (azimuth / 180 + 1) * SIZE;
            // The texel that holds the sun's centre, or most of the disc: the disc is a tenth of a
            // texel wide, more where texels are narrow.
            double radius = 0.2665 / 180 * SIZE;
            size_t row = best / width;
            assert_true(fabs((double)row + 0.5 - y) <= 0.5 + radius);
            CHECK_BELOW(fabs((double)(best % width) + 0.5 - x),
                        0.5 + radius / cos(elevation * pi / 180));
            kiln_map_free(&map);
        }
}

// What the disc adds to a picture, over the sphere: radiance times the disc's solid angle.
static double disc_energy(const ki_sky *sky, int size, double cosine_power)
{
    ki_sky dark = *sky;
    memset(dark.sun_radiance, 0, sizeof dark.sun_radiance);
    kiln_map with = make_panorama(context, size), without = make_panorama(context, size);
    CHECK_OK(ki_sky_paint(context, sky, &with, &error));
    CHECK_OK(ki_sky_paint(context, &dark, &without, &error));
    double sum = 0;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < 2 * size; x++) {
            double cosine = cos(pi * (y + 0.5) / size);
            sum += texel_area(size, y) * pow(fabs(cosine), cosine_power) *
                   ((double)texel_at(&with, x, y)[0] - (double)texel_at(&without, x, y)[0]);
        }
    kiln_map_free(&without);
    kiln_map_free(&with);
    return sum;
}

static void sun_energy_does_not_depend_on_the_size(void **state)
{
    (void)state;
    static const int sizes[] = {16, 17, 64, 255, 512};
    static const double high[] = {0.27, 1, 30, 60, 89, 89.8, 90};
    double solid_angle = 2 * pi * (1 - cos(ki_sun_radius));
    CHECK_NEAR(solid_angle, 6.796e-5, 1e-8);
    for (int i = 0; i < 7; i++)
        for (int k = 0; k < 5; k++) {
            ki_sky sky;
            ki_sky_prepare(&sky, high[i], 177, 3, 0.2);
            CHECK_NEAR(disc_energy(&sky, sizes[k], 0) / (sky.sun_radiance[0] * solid_angle), 1,
                       1e-4);
        }
    // The centre on the horizon: half of it.
    ki_sky sky;
    ki_sky_prepare(&sky, 0, -91, 3, 0.2);
    sky.sun_radiance[0] = 1e6;
    for (int k = 0; k < 5; k++)
        CHECK_NEAR(disc_energy(&sky, sizes[k], 0) / (1e6 * solid_angle), 0.5, 1e-3);
    // Below it: nothing.
    ki_sky_prepare(&sky, -0.27, 5, 3, 0.2);
    CHECK_NEAR(disc_energy(&sky, 64, 0), 0, 0);
}

// A fine picture shows the disc itself: its radiance inside, no sun outside.
static void the_disc_is_a_disc(void **state)
{
    (void)state;
    enum { SIZE = 2048 };
    ki_sky sky;
    ki_sky_prepare(&sky, 50, 0, 3, 0.2);
    kiln_map map = sky_of(SIZE, 50, 0, 3);
    double half_texel = pi / SIZE * 0.75;
    int inside = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = SIZE - 60; x < SIZE + 60; x++) {
            double d[3], rgb[3];
            panorama_direction(SIZE, x + 0.5, y + 0.5, d);
            double gamma = acos(fmin(1, d[0] * sky.sun[0] + d[1] * sky.sun[1] + d[2] * sky.sun[2]));
            const float *texel = texel_at(&map, x, y);
            if (gamma < ki_sun_radius - half_texel) {
                CHECK_NEAR((double)texel[1] / sky.sun_radiance[1], 1, 1e-3);
                inside++;
            } else if (gamma > ki_sun_radius + half_texel && d[1] > 0) {
                ki_sky_radiance(&sky, d, rgb);
                CHECK_NEAR((double)texel[1], rgb[1], 1e-5 * rgb[1]);
            }
        }
    assert_true(inside > 12);
    kiln_map_free(&map);
}

// The ground is Lambert: its radiance is albedo / pi times what a picture's upper half sends down.
static void ground_reflects_what_arrives(void **state)
{
    (void)state;
    enum { SIZE = 256 };
    static const double high[] = {-4, 3, 30, 80};
    for (int i = 0; i < 4; i++) {
        kiln_map map = sky_of(SIZE, high[i], 20, 4);
        double sum = 0;
        for (int y = 0; y < SIZE / 2; y++)
            for (int x = 0; x < 2 * SIZE; x++)
                sum += texel_area(SIZE, y) * cos(pi * (y + 0.5) / SIZE) *
                       (double)texel_at(&map, x, y)[0];
        double ground = (double)texel_at(&map, 0, SIZE - 1)[0];
        // The sun's cosine is that of its texel's centre: half a texel at 3 degrees is a tenth.
        CHECK_NEAR(ground / (0.2 / pi * sum), 1, high[i] == 3 ? 0.12 : 0.01);
        for (int y = SIZE / 2; y < SIZE; y++)
            CHECK_NEAR((double)texel_at(&map, 7, y)[0], ground, 1e-6 * ground);
        kiln_map_free(&map);
    }
    kiln_map black;
    CHECK_OK(kiln_sky(context, &(kiln_sky_def){.size = 16, .albedo = KILN_ZERO}, &black, &error));
    CHECK_NEAR((double)texel_at(&black, 0, 15)[0], 0, 0);
    kiln_map_free(&black);
}

// By the paper's figures: about 100 klx from a high clear sun; less with haze, redder when low.
static void sun_is_as_bright_as_it_should_be(void **state)
{
    (void)state;
    ki_sky sky;
    double solid_angle = 2 * pi * (1 - cos(ki_sun_radius)), before = 1e9;
    for (int k = 0; k < TURBIDITIES; k++) {
        ki_sky_prepare(&sky, 70, 0, turbidities[k], 0.2);
        double klx = luminance_of(sky.sun_radiance) * solid_angle;
        assert_true(klx < before && klx > 35 && klx < 110);
        before = klx;
    }
    double ratio = 0;
    for (int elevation = 80; elevation >= 0; elevation -= 10) {
        ki_sky_prepare(&sky, elevation, 0, 3, 0.2);
        double redness = sky.sun_radiance[0] / sky.sun_radiance[1];
        assert_true(redness > ratio);
        ratio = redness;
    }
}

// The Perez function's own normalisation: the zenith has the luminance of the paper's formula.
static void zenith_is_the_papers(void **state)
{
    (void)state;
    static const double up[3] = {0, 1, 0};
    for (int elevation = 5; elevation < 90; elevation += 20)
        for (int t = 2; t <= 8; t += 2) {
            ki_sky sky;
            double rgb[3], theta = (90 - elevation) * pi / 180;
            ki_sky_prepare(&sky, elevation, 0, t, 0.2);
            ki_sky_radiance(&sky, up, rgb);
            double chi = (4.0 / 9 - t / 120.0) * (pi - 2 * theta);
            double wanted = (4.0453 * t - 4.9710) * tan(chi) - 0.2155 * t + 2.4192;
            CHECK_NEAR(luminance_of(rgb), wanted, 1e-3 * wanted);
        }
}

// Dusk falls without a jump and without end of light.
static void night_falls_smoothly(void **state)
{
    (void)state;
    static const double d[3] = {0.6, 0.64, -0.48};
    double before = 0, first = 0;
    for (int i = 60; i >= -100; i--) {
        double elevation = i / 20.0;
        ki_sky sky;
        double rgb[3];
        ki_sky_prepare(&sky, elevation, 0, 3, 0.2);
        ki_sky_radiance(&sky, d, rgb);
        double now = luminance_of(rgb);
        if (before > 0) {
            assert_true(now < before);
            assert_true(now > 0.94 * before);
        } else {
            first = now;
        }
        before = now;
    }
    assert_true(before < 0.05 * first && before > 0);
}

static void wrong_arguments_are_named(void **state)
{
    (void)state;
    kiln_map map = {.size = 9};
    const struct {
        kiln_sky_def def;
        const char *word;
    } cases[] = {
        {{.size = 8}, "size of the sky is 8"},
        {{.size = 9000}, "9000"},
        {{.elevation = -6}, "elevation of the sky is -6"},
        {{.elevation = (double)NAN}, "elevation"},
        {{.turbidity = 1}, "turbidity of the sky is 1, it must be 1.7 to 10"},
        {{.albedo = 1.5}, "albedo"},
        {{.azimuth = HUGE_VAL}, "azimuth"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(kiln_sky(context, &cases[i].def, &map, &error), KILN_ERROR_ARGUMENT);
        CHECK_SAYS(error.message, cases[i].word);
        assert_int_equal(map.size, 0);
    }
    CHECK_OK(kiln_sky(context, NULL, &map, &error));
    assert_int_equal(map.size, 512);
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_texel_is_negative_or_not_a_number),
        cmocka_unit_test(symmetric_about_the_sun),
        cmocka_unit_test(azimuth_moves_the_picture),
        cmocka_unit_test(brightest_at_the_sun),
        cmocka_unit_test(sun_energy_does_not_depend_on_the_size),
        cmocka_unit_test(the_disc_is_a_disc),
        cmocka_unit_test(ground_reflects_what_arrives),
        cmocka_unit_test(sun_is_as_bright_as_it_should_be),
        cmocka_unit_test(zenith_is_the_papers),
        cmocka_unit_test(night_falls_smoothly),
        cmocka_unit_test(wrong_arguments_are_named),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
