// The assignment's tables as pictures: averages, the order of rows, bytes, differences and colours.
#include "image/pack.h"

#include <kiln/course.h>
#include <unistd.h>

#include "kit/context.h"

static kiln_image make(kiln_assignment_method method, const kiln_assignment_def *def)
{
    kiln_image table;
    CHECK_OK(kiln_assignment_energy(context, method, def, &table, &error));
    return table;
}

static void averages_are_twice_the_mean(void **state)
{
    (void)state;
    enum { SIZE = 32 };
    kiln_image e = make(KILN_ASSIGNMENT_IMPORTANCE, &(kiln_assignment_def){.size = SIZE}), average;
    CHECK_OK(kiln_assignment_average(context, &e, &average, &error));
    assert_int_equal(average.width, SIZE);
    assert_int_equal(average.height, SIZE);
    for (int y = 0; y < SIZE; y++) {
        const float *row = average.pixels + (size_t)y * SIZE;
        double mean = 0;
        for (int x = 0; x < SIZE; x++) {
            assert_true(row[x] == row[0]);
            mean += (double)e.pixels[y * SIZE + x] * (x + 0.5) / SIZE / SIZE;
        }
        CHECK_NEAR((double)row[0], 2 * mean, 1e-7);
        double exact =
            kiln_energy_average(&(kiln_model){.g = KILN_G_SCHLICK_K2}, (SIZE - y - 0.5) / SIZE);
        CHECK_NEAR((double)row[0], exact, 2e-3);
    }
    kiln_image_free(&average);
    // E = 1 gives 1, E = mu 2/3 - 1 / 6 n^2: the midpoint rule.
    for (int i = 0; i < SIZE * SIZE; i++)
        e.pixels[i] = i < SIZE ? 1 : ((float)(i % SIZE) + 0.5F) / SIZE;
    CHECK_OK(kiln_assignment_average(context, &e, &average, &error));
    CHECK_NEAR((double)average.pixels[0], 1, 1e-7);
    CHECK_NEAR((double)average.pixels[SIZE], 2.0 / 3 - 1.0 / (6 * SIZE * SIZE), 1e-7);
    kiln_image_free(&average);
    kiln_image_free(&e);
}

static void top_row_is_rough(void **state)
{
    (void)state;
    enum { SIZE = 12 };
    for (int m = KILN_ASSIGNMENT_MONTE_CARLO; m <= KILN_ASSIGNMENT_SPLIT_SUM; m++) {
        kiln_assignment_def def = {.size = SIZE};
        kiln_image up = make((kiln_assignment_method)m, &def);
        def.unflipped = true;
        kiln_image down = make((kiln_assignment_method)m, &def);
        for (int y = 0; y < SIZE; y++)
            assert_memory_equal(up.pixels + (size_t)y * SIZE,
                                down.pixels + (size_t)(SIZE - 1 - y) * SIZE, SIZE * sizeof(float));
        // The corners: roughness near 1 at the top, mu near 0 at the left.
        kiln_model model = {.g = KILN_G_SCHLICK_K2};
        double r = (SIZE - 0.5) / SIZE, mu = 0.5 / SIZE;
        CHECK_NEAR((double)up.pixels[0], kiln_energy(&model, r, mu), 0.02);
        CHECK_NEAR((double)up.pixels[SIZE - 1], kiln_energy(&model, r, 1 - mu), 0.01);
        kiln_image_free(&down);
        kiln_image_free(&up);
    }
}

// A PNG holds (uint8)(255 x) of a truncated picture.
static void bytes_are_cut(void **state)
{
    (void)state;
    enum { COUNT = 1024 };
    kiln_image image, back;
    CHECK_OK(kiln_image_create(context, COUNT, 1, 1, &image, &error));
    float values[COUNT] = {0};
    for (int i = 0; i < 256; i++) {
        float edge = (float)i / 255;
        float *four = values + (size_t)i * 4;
        four[0] = edge;
        four[1] = nextafterf(edge, 2);
        four[2] = nextafterf(edge, -2);
        four[3] = ((float)i + 0.99F) / 255;
    }
    values[2] = -1;
    values[COUNT - 1] = 7; // noise exceeds 1
    memcpy(image.pixels, values, sizeof values);
    kiln_assignment_truncate(&image);
    char path[64];
    snprintf(path, sizeof path, "/tmp/kiln-assignment-%ld.png", (long)getpid());
    CHECK_OK(kiln_image_save(context, &image, path, &error));
    CHECK_OK(kiln_image_load(context, path, &back, &error));
    remove(path);
    for (int i = 0; i < COUNT; i++) {
        double x = fmin(fmax((double)values[i], 0), 1);
        unsigned char byte = (unsigned char)(x * 255);
        assert_true(back.pixels[3 * (size_t)i] == ki_linear_from_srgb((float)byte / 255));
    }
    kiln_image_free(&back);
    kiln_image_free(&image);
}

static double lightness(const float rgb[3])
{
    double linear[3];
    for (int c = 0; c < 3; c++)
        linear[c] = (double)ki_linear_from_srgb(rgb[c]);
    return 116 * cbrt(0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]) - 16;
}

static void differences_are_measured(void **state)
{
    (void)state;
    kiln_image a, b, map;
    kiln_difference d;
    CHECK_OK(kiln_image_create(context, 2, 2, 1, &a, &error));
    CHECK_OK(kiln_image_create(context, 2, 2, 1, &b, &error));
    a.pixels[0] = 0.5F;
    b.pixels[3] = 0.25F;
    CHECK_OK(kiln_assignment_compare(context, &a, &b, &d, &map, &error));
    CHECK_NEAR(d.max, 0.5, 0);
    CHECK_NEAR(d.mean, 0.0625, 0);
    CHECK_NEAR(d.rms, sqrt((0.25 + 0.0625) / 4), 1e-15);
    assert_true(map.pixels[0] > map.pixels[2]);  // too bright is red
    assert_true(map.pixels[9] < map.pixels[11]); // too dark is blue
    CHECK_BELOW(95, lightness(map.pixels + 3));  // none is white
    kiln_image_free(&map);
    kiln_image_free(&b);
    kiln_image_free(&a);
}

// Each decade is darker by about as much, on both sides.
static void colours_darken_evenly(void **state)
{
    (void)state;
    enum { COUNT = 41 };
    for (int sign = -1; sign <= 1; sign += 2) {
        kiln_image off, none, map;
        kiln_difference d;
        CHECK_OK(kiln_image_create(context, COUNT, 1, 1, &off, &error));
        CHECK_OK(kiln_image_create(context, COUNT, 1, 1, &none, &error));
        for (int i = 0; i < COUNT; i++)
            off.pixels[i] = (float)(sign * pow(10, i / 10.0 - 4));
        CHECK_OK(kiln_assignment_compare(context, &off, &none, &d, &map, &error));
        for (int i = 1; i < COUNT; i++) {
            double step =
                lightness(map.pixels + 3 * (size_t)(i - 1)) - lightness(map.pixels + 3 * (size_t)i);
            CHECK_NEAR(step, 2, 0.9);
        }
        kiln_image_free(&map);
        kiln_image_free(&none);
        kiln_image_free(&off);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(averages_are_twice_the_mean),
        cmocka_unit_test(top_row_is_rough),
        cmocka_unit_test(bytes_are_cut),
        cmocka_unit_test(differences_are_measured),
        cmocka_unit_test(colours_darken_evenly),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
