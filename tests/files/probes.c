// Light probes, mirror balls and panoramas of any sides: what is drawn into them by their formulas
// comes back in its own directions.
#include "codec/codec.h"

#include "kit/context.h"
#include "kit/random.h"

// The direction that a point of a probe or ball shows, from docs/conventions.md. Returns false
// outside the disc.
static bool direction_of(kiln_layout layout, double u, double v, double d[3])
{
    double r = sqrt(u * u + v * v), c = sqrt(fmax(0, 1 - r * r));
    if (layout == KILN_LAYOUT_PROBE) {
        d[0] = r > 0 ? u / r * sin(pi * r) : 0;
        d[1] = r > 0 ? v / r * sin(pi * r) : 0;
        d[2] = -cos(pi * r);
    } else {
        d[0] = 2 * u * c;
        d[1] = 2 * v * c;
        d[2] = 1 - 2 * r * r;
    }
    return r <= 1;
}

// Three functions of low degree, all positive.
static void smooth(const double d[3], double rgb[3])
{
    rgb[0] = 2 + d[0] + 0.5 * d[1];
    rgb[1] = 2 + d[2] + d[0] * d[1];
    rgb[2] = 2 - d[1] + 0.5 * (3 * d[2] * d[2] - 1);
}

static void load(const float *pixels, int width, int height, kiln_layout layout,
                 kiln_load_report *report, kiln_map *map)
{
    const kiln_pixels p = {.data = pixels,
                           .width = width,
                           .height = height,
                           .channels = 3,
                           .layout = layout,
                           .report = report};
    CHECK_OK(kiln_map_from_pixels(context, &p, map, &error));
}

// Draws a probe of n x n texels; texels outside the disc have the value `outside`.
static float *draw(kiln_layout layout, int n, float outside)
{
    float *pixels = calloc((size_t)n * (size_t)n, 3 * sizeof *pixels);
    for (int i = 0; i < n * n; i++) {
        double d[3], rgb[3];
        int x = i % n, y = i / n;
        bool inside = direction_of(layout, 2 * (x + 0.5) / n - 1, 1 - 2 * (y + 0.5) / n, d);
        smooth(d, rgb);
        for (int c = 0; c < 3; c++)
            pixels[3 * i + c] = inside ? (float)rgb[c] : outside;
    }
    return pixels;
}

// The bounds are a step of one texel of the picture, which is the error of a picture whose texels
// are uniform; at the rim of a ball one texel spans up to 2 acos(1 - 2 / n) from the point behind
// the ball.
static void a_smooth_function_comes_back(void **state)
{
    (void)state;
    enum { N = 128 };
    static const struct {
        kiln_layout layout;
        double angle; // from -Z, beyond which the bound holds
        double bound, harmonics;
    } cases[] = {{KILN_LAYOUT_PROBE, 0, 0.08, 3e-4}, {KILN_LAYOUT_BALL, 0.5, 0.10, 4e-3}};
    for (int i = 0; i < 2; i++) {
        float *pixels = draw(cases[i].layout, N, 1e6f);
        kiln_map map, exact;
        kiln_load_report report;
        load(pixels, N, N, cases[i].layout, &report, &map);
        assert_int_equal(map.shape, KILN_SHAPE_PANORAMA);
        assert_int_equal(map.size, N);
        assert_int_equal(report.note_count, 1);
        CHECK_SAYS(report.note[0].text, "of 128 x 128 texels became a panorama of 256 x 128");
        exact = make_panorama(context, N);
        double worst = 0, behind = 0;
        for (size_t k = 0; k < kiln_map_texels(&map, 0); k++) {
            double d[3], rgb[3];
            kiln_map_direction(&map, 0, k, d);
            smooth(d, rgb);
            for (size_t c = 0; c < 3; c++) {
                exact.level[0][3 * k + c] = (float)rgb[c];
                double off = fabs((double)map.level[0][3 * k + c] - rgb[c]);
                worst = fmax(worst, acos(fmax(-1, -d[2])) >= cases[i].angle ? off : 0);
                behind = fmax(behind, off);
            }
        }
        CHECK_BELOW(worst, cases[i].bound);
        CHECK_BELOW(behind, 0.6);
        kiln_sh found, wanted;
        CHECK_OK(kiln_map_sh(context, &map, 4, 0, &found, &error));
        CHECK_OK(kiln_map_sh(context, &exact, 4, 0, &wanted, &error));
        for (int k = 0; k < 16; k++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(found.c[k][c], wanted.c[k][c], cases[i].harmonics * wanted.c[0][0]);
        kiln_map_free(&exact);
        kiln_map_free(&map);
        free(pixels);
    }
}

static void a_constant_stays(void **state)
{
    (void)state;
    enum { W = 23, H = 17 };
    float pixels[3 * W * W];
    for (int i = 0; i < 3 * W * W; i++)
        pixels[i] = 0.7f;
    static const struct {
        kiln_layout layout;
        int height, rows;
    } cases[] = {{KILN_LAYOUT_PROBE, W, W}, {KILN_LAYOUT_BALL, W, W}, {KILN_LAYOUT_PANORAMA, H, H}};
    for (int i = 0; i < 3; i++) {
        kiln_map map;
        load(pixels, W, cases[i].height, cases[i].layout, NULL, &map);
        assert_int_equal(map.size, cases[i].rows);
        for (size_t k = 0; k < value_count(&map, 0); k++)
            CHECK_NEAR((double)map.level[0][k], 0.7, 1e-6);
        kiln_map_free(&map);
    }
}

// A single bright texel: its light is its value times its solid angle, which follows from the
// formulas.
static void a_lamp_keeps_its_light_and_direction(void **state)
{
    (void)state;
    enum { N = 64 };
    for (int i = 0; i < 2; i++) {
        kiln_layout layout = i ? KILN_LAYOUT_BALL : KILN_LAYOUT_PROBE;
        float *pixels = calloc((size_t)N * N, 3 * sizeof *pixels);
        int x = 44, y = 21;
        pixels[3 * (y * N + x)] = 1000;
        kiln_map map;
        load(pixels, N, N, layout, NULL, &map);
        double u = 2 * (x + 0.5) / N - 1, v = 1 - 2 * (y + 0.5) / N, r = sqrt(u * u + v * v), d[3];
        direction_of(layout, u, v, d);
        double area = 4.0 / (N * N); // in (u, v)
        double wanted = 1000 * area * (i ? 4 : pi * sin(pi * r) / r);
        kiln_sh sh;
        CHECK_OK(kiln_map_sh(context, &map, 2, 0, &sh, &error));
        double light = sh.c[0][0] / 0.28209479177387814;
        CHECK_NEAR(light / wanted, 1, 0.02);
        const int places[3] = {3, 1, 2}; // the coefficients of x, y and z
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(sh.c[places[c]][0] / 0.4886025119029199 / light, d[c], 0.004);
        kiln_map_free(&map);
        free(pixels);
    }
}

// Rows and columns cover equal angles, whatever their number, and light is preserved.
static void a_panorama_is_stretched(void **state)
{
    (void)state;
    enum { W = 12, H = 5 };
    float pixels[3 * W * H];
    uint64_t random = 7;
    for (int i = 0; i < 3 * W * H; i++)
        pixels[i] = (float)random_number(&random);
    kiln_map map;
    kiln_load_report report;
    load(pixels, W, H, KILN_LAYOUT_PANORAMA, &report, &map);
    assert_int_equal(map.size, 6);
    assert_int_equal(report.texel_count, 72);
    assert_true(report.note[0].warning && report.note[0].kind == KILN_NOTE_CONVERSION);
    CHECK_SAYS(
        report.note[0].text,
        "the picture of 12 x 5 texels was stretched over the whole sphere to a panorama of 12 x 6");
    // Row 1 of 6 lies from 30 to 60 degrees: 6 degrees of row 0, which ends at 36, and 24 of row 1.
    double a = cos(pi / 6) - cos(pi / 5), b = cos(pi / 5) - cos(pi / 3);
    for (int x = 0; x < W; x++)
        for (int c = 0; c < 3; c++) {
            double wanted =
                (a * (double)pixels[3 * x + c] + b * (double)pixels[3 * (W + x) + c]) / (a + b);
            CHECK_NEAR((double)texel_at(&map, x, 1)[c], wanted, 1e-6);
        }
    double light = 0, made = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            light += (cos(pi * y / H) - cos(pi * (y + 1) / H)) * (double)pixels[3 * (W * y + x)];
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < W; x++)
            made += (cos(pi * y / 6) - cos(pi * (y + 1) / 6)) * (double)texel_at(&map, x, y)[0];
    CHECK_NEAR(made, light, 1e-5 * light);
    kiln_map_free(&map);
}

// A texel that is no number is mended in the picture itself, and counted there.
static void bad_texels_do_not_spread(void **state)
{
    (void)state;
    enum { N = 16 };
    float pixels[3 * N * N];
    for (int i = 0; i < 3 * N * N; i++)
        pixels[i] = 0.5f;
    pixels[3 * (N * 5 + 6)] = NAN;
    pixels[3 * (N * 9 + 4)] = INFINITY;
    kiln_map map;
    kiln_load_report report;
    load(pixels, N, N, KILN_LAYOUT_PROBE, &report, &map);
    assert_int_equal(report.nan_count, 1);
    assert_int_equal(report.infinite_count, 1);
    for (size_t i = 0; i < value_count(&map, 0); i++)
        assert_true(map.level[0][i] >= 0.5f && map.level[0][i] <= 65504);
    // Texel (4, 9) became 65504, and the light is that of this texel and of a constant.
    double u = 2 * 4.5 / N - 1, v = 1 - 2 * 9.5 / N, r = sqrt(u * u + v * v);
    double light = 0.5 * 4 * pi + (65504 - 0.5) * 4 / (N * N) * pi * sin(pi * r) / r;
    kiln_sh sh;
    CHECK_OK(kiln_map_sh(context, &map, 1, 0, &sh, &error));
    CHECK_NEAR(sh.c[0][0] / 0.28209479177387814 / light, 1, 0.02);
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_smooth_function_comes_back),
        cmocka_unit_test(a_constant_stays),
        cmocka_unit_test(a_lamp_keeps_its_light_and_direction),
        cmocka_unit_test(a_panorama_is_stretched),
        cmocka_unit_test(bad_texels_do_not_spread),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
