// The integrator against a sum over every texel, and its parts against their laws.
#include "reference.h"
#include "internal.h"

#include "drawing.h"

enum { ROWS = 16 };

// Smooth, with one bright texel.
static void make_environment(kiln_map *map)
{
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, ROWS, 1, map, &error));
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double d[3];
        kiln_map_direction(map, 0, i, d);
        map->level[0][3 * i] = (float)(1 + d[0]);
        map->level[0][3 * i + 1] = (float)(1 + 0.5 * d[1]);
        map->level[0][3 * i + 2] = (float)(i == 77 ? 40 : 1 - 0.5 * d[2]);
    }
}

// The mean of 1 / pdf is the sphere, of radiance / pdf the total, of d radiance / pdf the first
// moment.
static void light_is_drawn_where_it_is(void **unused)
{
    (void)unused;
    enum { COUNT = 400000 };
    kiln_map map;
    view_light light;
    double texels = 0, first = 0;
    make_environment(&map);
    CHECK_OK(view_light_create(context, &map, 30, &light, &error));
    light_means means = draw_light(&light, COUNT, 1);
    // By a fine grid, turned as the light is: azimuth a is seen where the source has a + 30
    // degrees.
    enum { FINE = 512 };
    for (int y = 0; y < FINE; y++)
        for (int x = 0; x < 2 * FINE; x++) {
            double theta = pi * (y + 0.5) / FINE;
            double phi = pi * (x + 0.5) / FINE;
            double seen = fmod(phi / 6.28318530717959 + 0.5 + 30.0 / 360, 1);
            int texel = y * ROWS / FINE * 2 * ROWS + (int)(seen * 2 * ROWS);
            double w = sin(theta) * pow(pi / FINE, 2);
            double c = (double)map.level[0][3 * texel + 2];
            texels += w * c;
            first += w * c * sin(theta) * sin(phi);
        }
    CHECK_NEAR(means.sphere, 4 * pi, 0.03);
    CHECK_NEAR(means.total[2], texels, 0.003 * texels);
    CHECK_NEAR(means.moment[0][2], first, 0.01 * texels);
    view_light_free(&light);
    kiln_map_free(&map);
}

// Energy of the reflection model in uniform light, by the integrator: F = 1 gives all of it back.
static void white_balls_vanish_in_the_furnace(void **unused)
{
    (void)unused;
    view_options o = view_defaults(VIEW_SCENE_FURNACE);
    view_reference_def def = {.noise = 0.004};
    view_reference_report report;
    kiln_image image;
    double sum = 0, squares = 0;
    o.samples = 1;
    CHECK_OK(view_reference(context, &o, NULL, 48, 27, &def, &image, &report, &error));
    size_t half = (size_t)48 * 13 * 3, seen = 0;
    for (size_t i = 0; i < half; i++)
        if (image.pixels[i] != 1.0f) {
            sum += (double)image.pixels[i] - 1;
            squares += pow((double)image.pixels[i] - 1, 2);
            seen++;
        }
    assert_true(seen > 100 && report.pixel_count > 100);
    CHECK_BELOW(fabs(sum / (double)seen), 0.001);
    CHECK_BELOW(sqrt(squares / (double)seen), 1.5 * def.noise);
    CHECK_BELOW(report.noise, def.noise);
    assert_int_equal(report.noisy_count, 0);
    kiln_image_free(&image);
}

// The same with the walk in place of Kulla and Conty's lobe, for each ball and in the mean; and
// with a metal, whose albedo is the library's own walk's.
static void walks_lose_nothing(void **unused)
{
    (void)unused;
    static const double f0[] = {1, 0.6};
    static const double r[] = {0.3, 0.7, 1}, cosines[] = {0.15, 0.5, 0.95};
    enum { COUNT = 200000 };
    view_light white;
    view_random random;
    view_random_start(&random, 7);
    CHECK_OK(view_light_create(context, NULL, 0, &white, &error));
    for (int i = 0; i < 2 * 3 * 3; i++) {
        double nov = cosines[i / 3 % 3], sum[3] = {0};
        view_ball ball = {.roughness = r[i % 3], .f0 = {f0[i / 9], 1, 0}};
        view_point p = {.n = {0, 0, 1}, .t = {1, 0, 0}, .b = {0, 1, 0}};
        p.v[0] = sqrt(1 - nov * nov);
        p.v[2] = nov;
        view_walk walk = {.ball = &ball, .light = &white};
        for (int k = 0; k < COUNT; k++)
            view_walk_add(&walk, &p, &random, sum);
        kiln_walk_def def = {.f0 = f0[i / 9]};
        kiln_walk truth;
        kiln_walk_albedo(&def, ball.roughness, nov, &truth);
        CHECK_NEAR(sum[0] / COUNT, truth.albedo - truth.bounce[0], 0.003);
        CHECK_NEAR(sum[1] / COUNT, 1 - kiln_energy(&(kiln_model){0}, ball.roughness, nov), 0.003);
    }
    view_light_free(&white);
}

// ------------------------------------------------------------------------------------- brute force

static void normalize(double a[3])
{
    double size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int c = 0; c < 3; c++)
        a[c] /= size;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Single bounce of a metal plus, for Kulla and Conty, the lobe, summed over a grid of directions.
static void sum_all(const kiln_map *map, const view_ball *ball, const double n[3],
                    const double v[3], double total[3])
{
    enum { FINE = 256 };
    const kiln_model model = {0};
    double r = ball->roughness, average = kiln_energy_average(&model, r), nov = dot(n, v);
    double e_o = kiln_energy(&model, r, nov), e[FINE + 1], gold[FINE + 1][3];
    for (int i = 0; i <= FINE; i++) {
        e[i] = kiln_energy(&model, r, (double)i / FINE);
        view_metal_fresnel(VIEW_MATERIAL_GOLD, (double)i / FINE, gold[i]);
    }
    for (int y = 0; y < FINE; y++)
        for (int x = 0; x < 2 * FINE; x++) {
            double theta = pi * (y + 0.5) / FINE;
            double phi = pi * ((x + 0.5) / FINE - 1);
            double l[3] = {sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)};
            double nol = dot(n, l), h[3];
            int texel = y * ROWS / FINE * 2 * ROWS + x * ROWS / FINE;
            if (nol <= 0)
                continue;
            for (int c = 0; c < 3; c++)
                h[c] = l[c] + v[c];
            normalize(h);
            double w = sin(theta) * pow(pi / FINE, 2) * nol;
            double lobe = kiln_brdf_specular(&model, r, nov, nol, fmin(dot(n, h), 1));
            int i = (int)(nol * FINE) < FINE ? (int)(nol * FINE) : FINE - 1;
            double e_i = e[i] + (e[i + 1] - e[i]) * (nol * FINE - i);
            for (int c = 0; c < 3; c++) {
                double f = lobe * gold[(int)(dot(v, h) * FINE + 0.5)][c];
                if (ball->method == VIEW_METHOD_KULLA_CONTY)
                    f += kiln_kulla_conty(e_o, e_i, average) *
                         kiln_kulla_conty_fresnel(KILN_F_ADD_SECOND, ball->f_average[c], average);
                total[c] += w * f * (double)map->level[0][3 * texel + c];
            }
        }
}

static void the_integral_is_the_sum(void **unused)
{
    (void)unused;
    enum { WIDTH = 16, HEIGHT = 9 };
    view_options o = view_defaults(VIEW_SCENE_IBL);
    view_reference_def def = {.noise = 0.003, .batch_limit = 65536, .alone = true};
    kiln_map map;
    kiln_image image;
    view_ball balls[VIEW_MAX_BALLS];
    double eye[3], right[3], up[3], back[3], slope = tan(o.camera.fov / 2 * pi / 180);
    int count = view_balls(&o, balls), seen = 0;
    o.samples = 1;
    make_environment(&map);
    view_camera_axes(&o.camera, eye, right, up, back);
    CHECK_OK(view_reference(context, &o, &map, WIDTH, HEIGHT, &def, &image, NULL, &error));
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        double sx = (2 * (x + 0.5) / WIDTH - 1) * slope * WIDTH / HEIGHT;
        double sy = (1 - 2 * (y + 0.5) / HEIGHT) * slope, d[3];
        for (int c = 0; c < 3; c++)
            d[c] = sx * right[c] + sy * up[c] - back[c];
        normalize(d);
        for (int k = 0; k < count; k++) {
            // Rough ones: the grid is too coarse for the others.
            double from[3], n[3], v[3], wanted[3] = {0};
            for (int c = 0; c < 3; c++)
                from[c] = eye[c] - balls[k].centre[c];
            double b = dot(from, d), rest = b * b - dot(from, from) + 36 * 36;
            if (rest <= 0 || balls[k].roughness < 0.5)
                continue;
            for (int c = 0; c < 3; c++) {
                n[c] = (from[c] + (-b - sqrt(rest)) * d[c]) / 36;
                v[c] = -d[c];
            }
            sum_all(&map, &balls[k], n, v, wanted);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR((double)image.pixels[3 * i + c], wanted[c], 0.016 * (wanted[c] + 0.02));
            seen++;
        }
    }
    print_message("%d pixels\n", seen);
    assert_true(seen >= 8);
    kiln_image_free(&image);
    kiln_map_free(&map);
}

// By the cosine or the visible normals, one as often as the other; returns the density of both.
static double draw_direction(double roughness, const double v[3], double which, const double xi[2],
                             double l[3])
{
    double h[3];
    if (which < 0.5) {
        kiln_sample_cosine(xi, l);
    } else {
        kiln_sample_visible(roughness, v, xi, h);
        double voh = dot(v, h);
        for (int c = 0; c < 3; c++)
            l[c] = 2 * voh * h[c] - v[c];
    }
    for (int c = 0; c < 3; c++)
        h[c] = v[c] + l[c];
    normalize(h);
    double voh = fmax(dot(v, h), 0), noh = fmax(h[2], 0);
    double specular = kiln_pdf_reflection(kiln_pdf_visible(roughness, v[2], noh, voh), voh);
    return (kiln_pdf_cosine(fmax(l[2], 0)) + specular) / 2;
}

// Light among the balls, by the plainest of path tracers: no light is drawn, every path goes to its
// end.
static void trace(const view_ball *balls, int count, const view_energy *energy, double at[3],
                  double d[3], view_random *random, double sum[3])
{
    double weight[3] = {1, 1, 1};
    int last = -1;
    for (;;) {
        double reach = 1e30;
        view_point p = {.ball = -1};
        for (int k = 0; k < count; k++) {
            double from[3];
            for (int c = 0; c < 3; c++)
                from[c] = at[c] - balls[k].centre[c];
            double b = dot(from, d), rest = b * b - dot(from, from) + 36 * 36;
            double t = -b - sqrt(fmax(rest, 0));
            if (k != last && rest > 0 && t > 0 && t < reach) {
                reach = t;
                p.ball = k;
            }
        }
        if (p.ball < 0)
            break;
        const view_ball *ball = &balls[p.ball];
        last = p.ball;
        for (int c = 0; c < 3; c++) {
            at[c] += reach * d[c];
            p.n[c] = (at[c] - ball->centre[c]) / 36;
        }
        double side[3] = {fabs(p.n[0]) < 0.5, fabs(p.n[0]) >= 0.5, 0}, along = dot(side, p.n);
        for (int c = 0; c < 3; c++)
            p.t[c] = side[c] - along * p.n[c];
        normalize(p.t);
        for (int c = 0; c < 3; c++)
            p.b[c] = p.n[(c + 1) % 3] * p.t[(c + 2) % 3] - p.n[(c + 2) % 3] * p.t[(c + 1) % 3];
        p.v[0] = -dot(p.t, d);
        p.v[1] = -dot(p.b, d);
        p.v[2] = -dot(p.n, d);
        view_point_prepare(ball, energy, &p);
        double xi[2] = {view_random_next(random), view_random_next(random)}, l[3], f[3];
        double pdf = draw_direction(ball->roughness, p.v, view_random_next(random), xi, l);
        view_reflect(ball, energy, &p, l, f);
        for (int c = 0; c < 3; c++) {
            weight[c] *= f[c] / pdf;
            d[c] = l[0] * p.t[c] + l[1] * p.b[c] + l[2] * p.n[c];
        }
    }
    for (int c = 0; c < 3; c++) // white from above, dimmer from below
        sum[c] += weight[c] * (1 + 0.5 * (d[1] > 0));
}

// Chalk, whose light is that of all directions: the mean over all pixels that show balls.
static void balls_light_one_another(void **unused)
{
    (void)unused;
    enum { WIDTH = 48, HEIGHT = 28, PATHS = 6000 };
    view_options o = view_defaults(VIEW_SCENE_IBL);
    view_ball balls[VIEW_MAX_BALLS];
    view_energy energy;
    view_random random;
    kiln_map map;
    kiln_image image[3]; // alone, one bounce, all
    o.samples = 1;
    o.material = VIEW_MATERIAL_CHALK;
    int count = view_balls(&o, balls), seen = 0;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, ROWS, 1, &map, &error));
    for (size_t i = 0; i < 3 * kiln_map_texels(&map, 0); i++)
        map.level[0][i] = i < 3 * kiln_map_texels(&map, 0) / 2 ? 1.5F : 1;
    CHECK_OK(view_energy_create(context, &o, &energy, &error));
    for (int i = 0; i < 3; i++) {
        view_reference_def def = {.noise = 0.02, .alone = i == 0, .bounces = i == 1};
        CHECK_OK(view_reference(context, &o, &map, WIDTH, HEIGHT, &def, &image[i], NULL, &error));
    }
    view_random_start(&random, 3);
    double eye[3], right[3], up[3], back[3], sum[3] = {0}, got[3] = {0};
    double slope = tan(o.camera.fov / 2 * pi / 180);
    view_camera_axes(&o.camera, eye, right, up, back);
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        int x = (int)(i % WIDTH), y = (int)(i / WIDTH);
        double sx = (2 * (x + 0.5) / WIDTH - 1) * slope * WIDTH / HEIGHT;
        double sy = (1 - 2 * (y + 0.5) / HEIGHT) * slope;
        // The sky is 1 or 1.5 and as bright to all.
        if ((double)image[0].pixels[3 * i] == 1 || (double)image[0].pixels[3 * i] == 1.5)
            continue;
        seen++;
        for (int k = 0; k < 3; k++)
            got[k] += (double)image[k].pixels[3 * i];
        for (int k = 0; k < PATHS; k++) {
            double from[3], d[3];
            for (int c = 0; c < 3; c++) {
                from[c] = eye[c];
                d[c] = sx * right[c] + sy * up[c] - back[c];
            }
            normalize(d);
            trace(balls, count, &energy, from, d, &random, sum);
        }
    }
    print_message("%d pixels, %.4f: alone %.4f, once %.4f, all %.4f\n", seen, sum[0] / PATHS / seen,
                  got[0] / seen, got[1] / seen, got[2] / seen);
    assert_true(seen > 300);
    CHECK_NEAR(got[2], sum[0] / PATHS, 0.003 * got[2]);
    // the other settings differ by three times the tolerance at least
    assert_true(got[0] > 1.009 * got[2] && got[1] < 0.991 * got[2]);
    for (int i = 0; i < 3; i++)
        kiln_image_free(&image[i]);
    view_energy_free(&energy);
    kiln_map_free(&map);
}

// Threads share the rows, not the random numbers.
static void threads_do_not_matter(void **unused)
{
    (void)unused;
    view_options o = view_defaults(VIEW_SCENE_IBL);
    kiln_map map;
    kiln_image image[2];
    make_environment(&map);
    o.samples = 2;
    o.occlusion = true;
    for (int i = 0; i < 2; i++) {
        view_reference_def def = {.noise = 0.2, .thread_count = i ? 5 : 1};
        CHECK_OK(view_reference(context, &o, &map, 40, 20, &def, &image[i], NULL, &error));
    }
    assert_memory_equal(image[0].pixels, image[1].pixels, sizeof(float) * 40 * 20 * 3);
    kiln_image_free(&image[0]);
    kiln_image_free(&image[1]);
    kiln_map_free(&map);
}

static void it_can_be_stopped(void **unused)
{
    (void)unused;
    view_options o = view_defaults(VIEW_SCENE_FURNACE);
    countdown c = {0};
    view_reference_def def = {.noise = 1e-4, .progress = count_down, .progress_user = &c};
    kiln_image image;
    assert_int_equal(view_reference(context, &o, NULL, 640, 360, &def, &image, NULL, &error),
                     KILN_ERROR_CANCELLED);
    assert_null(image.pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_drawn_where_it_is),
        cmocka_unit_test(white_balls_vanish_in_the_furnace),
        cmocka_unit_test(walks_lose_nothing),
        cmocka_unit_test(the_integral_is_the_sum),
        cmocka_unit_test(balls_light_one_another),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(it_can_be_stopped),
    };
    return cmocka_run_group_tests_name("reference_picture", tests, set_up, tear_down);
}
