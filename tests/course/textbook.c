// The textbook's methods do what they say, and err where docs/theory/textbook.md says they do.
#include "brdf/brdf.h"

#include <kiln/course.h>

#include "kit/context.h"

// ------------------------------------------------------------------------------------------- brdf

static void radical_inverse_mirrors_bits(void **state)
{
    (void)state;
    static const double wanted[] = {0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875};
    for (uint32_t i = 0; i < 8; i++)
        CHECK_NEAR(ki_radical_inverse(i), wanted[i], 0);
    CHECK_NEAR(ki_radical_inverse(0xffffffffu), 1 - 1 / 4294967296.0, 0);
    // The first 2^k points are one in each of 2^k equal parts.
    bool taken[1024] = {false};
    for (uint32_t i = 0; i < 1024; i++) {
        int part = (int)(ki_radical_inverse(i) * 1024);
        assert_false(taken[part]);
        taken[part] = true;
    }
}

// int D(h) (n.h) dh = 1, in s = sin^2 theta: pi int D ds.
static void ggx_is_a_distribution(void **state)
{
    (void)state;
    for (int k = 1; k <= 10; k++) {
        double sum = 0, alpha = k / 10.0;
        enum { N = 20000 };
        for (int i = 0; i < N; i++) {
            double t = (i + 0.5) / N; // s = t^2: finer near the peak
            sum += pi * ki_ggx_d(alpha, sqrt(1 - t * t)) * 2 * t / N;
        }
        CHECK_NEAR(sum, 1, 1e-5);
    }
    CHECK_NEAR(ki_ggx_d(0.3, 1), 1 / (pi * 0.09), 1e-12);
    CHECK_NEAR(ki_ggx_d(1, 0.4), 1 / pi, 1e-15);
    // Tiny lobes keep their digits: D at tan^2 theta = alpha^2 is a quarter of the peak over cos^4.
    double alpha = 1e-5, noh = 1 / sqrt(1 + alpha * alpha);
    CHECK_NEAR(ki_ggx_d(alpha, noh) * pi * alpha * alpha, 0.25, 1e-5);
}

// The share of half vectors within tan^2 theta <= alpha^2 x / (1 - x) is x.
static void half_vectors_follow_the_distribution(void **state)
{
    (void)state;
    enum { N = 4096 };
    static const double alphas[] = {0.01, 0.1, 0.4, 1};
    for (int k = 0; k < 4; k++) {
        for (int part = 1; part < 20; part += 2) {
            double alpha = alphas[k], x = part / 20.0;
            int within = 0;
            for (uint32_t i = 0; i < N; i++) {
                double xi[2], h[3];
                ki_hammersley(i, N, xi);
                ki_ggx_half_vector(alpha, xi, h);
                CHECK_NEAR(h[0] * h[0] + h[1] * h[1] + h[2] * h[2], 1, 1e-14);
                double t2 = (h[0] * h[0] + h[1] * h[1]) / (h[2] * h[2]);
                within += t2 <= alpha * alpha * x / (1 - x);
            }
            CHECK_NEAR((double)within / N, x, 1.5 / N);
        }
    }
    double xi[2] = {0.3, 0.9}, h[3];
    ki_ggx_half_vector(0, xi, h);
    CHECK_NEAR(h[2], 1, 0);
    CHECK_NEAR(h[0], 0, 0);
}

static void shadowing_is_schlicks(void **state)
{
    (void)state;
    CHECK_NEAR(ki_smith_g1_schlick(0, 0.3), 1, 0);
    CHECK_NEAR(ki_smith_g1_schlick(0.5, 1), 1, 0);
    CHECK_NEAR(ki_smith_g1_schlick(0.5, 0.5), 0.5 / 0.75, 1e-15);
    CHECK_NEAR(ki_smith_g_schlick(0.5, 0.5, 1), 0.5 / 0.75, 1e-15);
    CHECK_NEAR(ki_schlick_k_ibl(0.36), 0.18, 0);
    CHECK_NEAR(ki_schlick_k_direct(1), 0.5, 0);
    CHECK_NEAR(ki_schlick_fresnel(0.5), 1.0 / 32, 0);
}

// ------------------------------------------------------------------------------------------- maps

// A picture that is 2 + d in direction d, channel by channel.
static kiln_map gradient(int size)
{
    kiln_map map = make_panorama(context, size);
    fill_gradient(&map, 0, 1);
    return map;
}

static kiln_map noise(int size)
{
    kiln_map map = make_panorama(context, size);
    fill_noise(&map, 17, 0, 1);
    return map;
}

static kiln_map white(int size)
{
    kiln_map map = make_panorama(context, size);
    fill_constant(&map, 1);
    return map;
}

// Where a texel of the result looks, in kiln's axes: the textbook's panoramas put texels at
// i / (width - 1) and j / (height - 1).
static void looked(const kiln_map *map, int level, size_t index, double d[3])
{
    int size = kiln_map_level_size(map, level), width = 2 * size;
    if (map->shape != KILN_SHAPE_PANORAMA) {
        kiln_map_direction(map, level, index, d);
        return;
    }
    size_t row = index / (size_t)width;
    double u = (double)(index % (size_t)width) / (width - 1);
    double v = size > 1 ? (double)row / (size - 1) : 0.5;
    panorama_direction(size, u * width, v * size, d);
}

// The picture as the textbook reads it, size - 1 rows of 2 size - 1 columns stretched over the
// sphere, seen through GGX: n x n equal areas a texel.
static double stretched_sum(const kiln_map *map, double alpha, const double d[3], int n)
{
    double sum = 0, all = 0, a2 = alpha * alpha;
    int rows = map->size - 1, columns = 2 * map->size - 1;
    for (int y = 0; y < rows; y++) {
        double top = cos(pi * y / rows), bottom = cos(pi * (y + 1) / rows);
        for (int x = 0; x < columns; x++) {
            double weight = 0;
            for (int j = 0; j < n; j++) {
                double z = top + (bottom - top) * (j + 0.5) / n, s = sqrt(1 - z * z);
                for (int i = 0; i < n; i++) {
                    double phi = 2 * pi * (x + (i + 0.5) / n) / columns - pi;
                    double c = d[0] * s * sin(phi) + d[1] * z - d[2] * s * cos(phi);
                    double q = a2 + (1 - a2) * 0.5 * (1 - c);
                    weight += c > 0 ? c * (a2 / q) * (a2 / q) : 0;
                }
            }
            weight *= top - bottom;
            sum += weight * (double)texel_at(map, x, y)[0];
            all += weight;
        }
    }
    return sum / all;
}

// The sum over theta is a trapezoid rule: white becomes (pi / 2n) cot(pi / 2n), 0.99992 for 100.
static void white_irradiance_is_the_trapezoids(void **state)
{
    (void)state;
    kiln_map source = white(8);
    static const int counts[] = {0, 1 + 2, 10, 250};
    for (int k = 0; k < 4; k++) {
        int n = counts[k] ? counts[k] : 100;
        kiln_map map;
        kiln_textbook_def def = {.size = 4, .theta_count = counts[k], .phi_count = counts[k]};
        CHECK_OK(kiln_textbook_irradiance(context, &source, &def, &map, &error));
        assert_int_equal(map.shape, KILN_SHAPE_PANORAMA);
        assert_int_equal(map.level_count, 1);
        double wanted = pi / (2 * n) / tan(pi / (2 * n));
        for (size_t i = 0; i < 3 * kiln_map_texels(&map, 0); i++)
            CHECK_NEAR((double)map.level[0][i], wanted, 1e-6);
        kiln_map_free(&map);
    }
    kiln_map_free(&source);
}

static void white_prefiltered_stays_white(void **state)
{
    (void)state;
    kiln_map source = white(8), map;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_textbook_def def = {.shape = (kiln_shape)shape, .size = 8, .sample_count = 64};
        CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
        assert_int_equal(map.level_count, 4);
        for (int level = 0; level < 4; level++) {
            CHECK_NEAR((double)map.roughness[level], level / 3.0, 1e-7);
            for (size_t i = 0; i < 3 * kiln_map_texels(&map, level); i++)
                CHECK_NEAR((double)map.level[level][i], 1, 1e-7);
        }
        kiln_map_free(&map);
    }
    kiln_map_free(&source);
}

// Directions arrive where they belong, on every shape. The bounds are the textbook's own: a mirror
// reads texels whose centres are up to 1.5 texels away both ways, half for rounding down and one for
// the stretching, on a picture whose slope is 1.
static double worst_on_gradient(kiln_shape shape, int source_size, bool irradiance)
{
    kiln_map source = gradient(source_size), map;
    kiln_textbook_def def = {.shape = shape, .size = 6, .level_count = irradiance ? 0 : 2};
    if (irradiance)
        CHECK_OK(kiln_textbook_irradiance(context, &source, &def, &map, &error));
    else
        CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
    double worst = 0;
    for (int level = 0; level < map.level_count; level++) {
        // A mirror keeps the gradient, Lambert (also GGX with roughness 1) two thirds of it.
        double slope = irradiance || level == 1 ? 2.0 / 3 : 1;
        for (size_t i = 0; i < kiln_map_texels(&map, level); i++) {
            double d[3];
            looked(&map, level, i, d);
            for (size_t c = 0; c < 3; c++)
                worst = fmax(worst, fabs((double)map.level[level][3 * i + c] - 2 - slope * d[c]));
        }
    }
    kiln_map_free(&map);
    kiln_map_free(&source);
    return worst;
}

static void gradients_keep_their_direction(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
        for (int size = 32; size <= 512; size *= 4) {
            CHECK_BELOW(worst_on_gradient((kiln_shape)shape, size, true), pi / size + 1e-3);
            CHECK_BELOW(worst_on_gradient((kiln_shape)shape, size, false),
                        1.5 * sqrt(2) * pi / size + 1e-3);
        }
}

// With more steps the uniform sum nears the integral of the picture that it reads.
static void irradiance_converges(void **state)
{
    (void)state;
    kiln_map source = noise(8);
    double worst[3] = {0};
    for (int k = 0; k < 3; k++) {
        static const int counts[] = {10, 100, 1000};
        static const double bounds[] = {0.1, 0.01, 0.001};
        kiln_map map;
        kiln_textbook_def def = {.shape = KILN_SHAPE_OCTAHEDRON,
                                 .size = 2,
                                 .phi_count = counts[k],
                                 .theta_count = counts[k]};
        CHECK_OK(kiln_textbook_irradiance(context, &source, &def, &map, &error));
        for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
            double d[3];
            looked(&map, 0, i, d);
            double wanted = stretched_sum(&source, 1, d, 32);
            worst[k] = fmax(worst[k], fabs((double)map.level[0][3 * i] / wanted - 1));
        }
        CHECK_BELOW(worst[k], bounds[k]);
        kiln_map_free(&map);
    }
    CHECK_BELOW(worst[2], 0.2 * worst[0]);
    kiln_map_free(&source);
}

static void prefilter_converges(void **state)
{
    (void)state;
    kiln_map source = noise(8);
    double rms[3] = {0};
    for (int k = 0; k < 3; k++) {
        static const int counts[] = {64, 1024, 65536};
        static const double bounds[] = {0.1, 0.02, 0.002};
        kiln_map map;
        // Roughness 0, 1/3, 2/3, 1: the last three are compared.
        kiln_textbook_def def = {
            .shape = KILN_SHAPE_OCTAHEDRON, .size = 8, .level_count = 4, .sample_count = counts[k]};
        CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
        int count = 0;
        for (int level = 1; level < 4; level++) {
            double alpha = level * level / 9.0;
            for (size_t i = 0; i < kiln_map_texels(&map, level); i += 3, count++) {
                double d[3];
                looked(&map, level, i, d);
                double wanted = stretched_sum(&source, alpha, d, 24);
                double off = (double)map.level[level][3 * i] / wanted - 1;
                rms[k] += off * off;
                CHECK_BELOW(fabs(off), 2 * bounds[k]);
            }
        }
        rms[k] = sqrt(rms[k] / count);
        CHECK_BELOW(rms[k], bounds[k]);
        kiln_map_free(&map);
    }
    CHECK_BELOW(rms[1], 0.5 * rms[0]);
    CHECK_BELOW(rms[2], 0.2 * rms[1]);
    kiln_map_free(&source);
}

// Roughness 0 reads the texel that it looks at.
static void level_zero_is_the_nearest_texel(void **state)
{
    (void)state;
    enum { SIZE = 16 };
    kiln_map source = noise(SIZE), map;
    kiln_textbook_def def = {.size = SIZE, .level_count = 1, .sample_count = 4};
    CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
    // The textbook looks at the texels' very edges, so rounding may take the one before; u = 1 is the
    // last column, which nothing else reads.
    int same = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < 2 * SIZE; x++) {
            const float *texel = texel_at(&map, x, y);
            bool found = false;
            for (int b = y ? y - 1 : 0; b <= y; b++)
                for (int a = -1; a <= 1; a++) {
                    // The poles lose their azimuth, the last column is the first.
                    bool seam = x == 0 || x == 2 * SIZE - 1;
                    if (a == 1 && !seam)
                        continue;
                    int column = a == 1 ? 2 * SIZE - 1 : (x + a + 2 * SIZE - 1) % (2 * SIZE - 1);
                    const float *other = texel_at(&source, column, b);
                    found |= texel[0] == other[0] && texel[1] == other[1] && texel[2] == other[2];
                }
            same += found || y == 0 || y == SIZE - 1;
        }
    assert_int_equal(same, 2 * SIZE * SIZE);
    kiln_map_free(&map);
    kiln_map_free(&source);
}

// ------------------------------------------------------------------------------------------- table

// The split sum's integrals over the light's hemisphere, by a midpoint rule in the light's own
// angles: nothing of the sampler.
static void table_quadrature(double roughness, double nov, double ab[2])
{
    enum { N = 600 };
    double alpha = roughness * roughness, k = alpha / 2, v[2] = {sqrt(1 - nov * nov), nov};
    ab[0] = ab[1] = 0;
    for (int j = 0; j < N; j++) {
        double theta = pi / 2 * (j + 0.5) / N, nol = cos(theta), s = sin(theta);
        for (int i = 0; i < N; i++) {
            double phi = pi * (i + 0.5) / N; // symmetric
            double l[3] = {s * cos(phi), s * sin(phi), nol};
            double h[3] = {l[0] + v[0], l[1], l[2] + v[1]};
            double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
            double noh = h[2] / length, voh = (v[0] * h[0] + v[1] * h[2]) / length;
            double q = noh * noh * (alpha * alpha - 1) + 1;
            double d = alpha * alpha / (pi * q * q);
            double g = nov / (nov * (1 - k) + k) * nol / (nol * (1 - k) + k);
            double f = pow(1 - voh, 5);
            double part = d * g / (4 * nov) * s * (pi / 2 / N) * (2 * pi / N);
            ab[0] += (1 - f) * part;
            ab[1] += f * part;
        }
    }
}

static void table_is_the_split_sum(void **state)
{
    (void)state;
    enum { SIZE = 11 };
    static const int counts[] = {0, 65536};
    static const double bounds[] = {4e-3, 5e-4};
    for (int k = 0; k < 2; k++) {
        kiln_image table;
        CHECK_OK(kiln_textbook_brdf(context, SIZE, counts[k], &table, &error));
        assert_int_equal(table.channels, 2);
        for (int j = 3; j < SIZE; j += 7 - k)
            for (int i = 1; i < SIZE; i += 3) {
                double ab[2];
                table_quadrature(j / 10.0, i / 10.0, ab);
                const float *texel = table.pixels + 2 * (size_t)((SIZE - 1 - j) * SIZE + i);
                CHECK_NEAR((double)texel[0], ab[0], bounds[k]);
                CHECK_NEAR((double)texel[1], ab[1], bounds[k]);
            }
        // Roughness 0, the last row: nothing is lost, F alone.
        for (int i = 1; i < SIZE; i++) {
            const float *texel = table.pixels + 2 * (size_t)((SIZE - 1) * SIZE + i);
            double f = pow(1 - i / 10.0, 5);
            CHECK_NEAR((double)texel[0], 1 - f, 1e-6);
            CHECK_NEAR((double)texel[1], f, 1e-6);
        }
        // Column 0 is a number, and the limit of its neighbours.
        for (int j = 0; j < SIZE; j++) {
            const float *texel = table.pixels + 2 * (size_t)(j * SIZE);
            for (int c = 0; c < 2; c++)
                assert_true(texel[c] >= 0 && texel[c] <= 1);
        }
        kiln_image_free(&table);
    }
}

static void column_zero_is_the_limit(void **state)
{
    (void)state;
    kiln_image table;
    CHECK_OK(kiln_textbook_brdf(context, 2, 65536, &table, &error));
    // Roughness 1 is row 0. At n.v = 1e-4 the quadrature agrees; the limit itself is 1e-4 away.
    double ab[2];
    table_quadrature(1, 1e-4, ab);
    CHECK_NEAR((double)table.pixels[0], ab[0], 1e-3);
    CHECK_NEAR((double)table.pixels[1], ab[1], 1e-3);
    kiln_image_free(&table);
}

// ------------------------------------------------------------------------------------------- rest

static void threads_change_no_bit(void **state)
{
    (void)state;
    kiln_map source = noise(16), first, again;
    kiln_textbook_def def = {.shape = KILN_SHAPE_CUBE, .size = 4};
    CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &first, &error));
    for (int threads = 1; threads <= 8; threads *= 8) {
        kiln_context *other = make_context(threads);
        CHECK_OK(kiln_textbook_prefilter(other, &source, &def, &again, &error));
        for (int level = 0; level < first.level_count; level++)
            assert_memory_equal(first.level[level], again.level[level],
                                3 * sizeof(float) * kiln_map_texels(&first, level));
        kiln_map_free(&again);
        kiln_context_destroy(other);
    }
    kiln_map_free(&first);
    kiln_map_free(&source);
}

static void wrong_arguments_are_named(void **state)
{
    (void)state;
    kiln_map source = noise(8), map = {.size = 5};
    kiln_image table = {.width = 5};
    kiln_textbook_def def = {.phi_count = -1};
    assert_int_equal(kiln_textbook_irradiance(context, &source, &def, &map, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "phi_count is -1");
    assert_int_equal(map.size, 0);
    def = (kiln_textbook_def){.sample_count = 1 << 21};
    assert_int_equal(kiln_textbook_prefilter(context, &source, &def, &map, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "2097152");
    def = (kiln_textbook_def){.size = -3};
    assert_int_equal(kiln_textbook_prefilter(context, &source, &def, &map, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "-3");
    assert_int_equal(kiln_textbook_brdf(context, 1, 0, &table, &error), KILN_ERROR_ARGUMENT);
    assert_int_equal(table.width, 0);
    assert_int_equal(kiln_textbook_brdf(context, 8, -1, &table, &error), KILN_ERROR_ARGUMENT);
    kiln_map cube;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 4, 1, &cube, &error));
    assert_int_equal(kiln_textbook_irradiance(context, &cube, NULL, &map, &error),
                     KILN_ERROR_ARGUMENT);
    kiln_map_free(&cube);
    kiln_map_free(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radical_inverse_mirrors_bits),
        cmocka_unit_test(ggx_is_a_distribution),
        cmocka_unit_test(half_vectors_follow_the_distribution),
        cmocka_unit_test(shadowing_is_schlicks),
        cmocka_unit_test(white_irradiance_is_the_trapezoids),
        cmocka_unit_test(white_prefiltered_stays_white),
        cmocka_unit_test(gradients_keep_their_direction),
        cmocka_unit_test(irradiance_converges),
        cmocka_unit_test(prefilter_converges),
        cmocka_unit_test(level_zero_is_the_nearest_texel),
        cmocka_unit_test(table_is_the_split_sum),
        cmocka_unit_test(column_zero_is_the_limit),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(wrong_arguments_are_named),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
