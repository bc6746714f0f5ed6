// The brute-force sum, against laws and against sums that are plainer still.
#include "bake/reference.h"

#include "kit/context.h"

static const double alphas[] = {1, 0.5, 0.2, 0.05, 0.01, 1e-3, 1e-4};
enum { ALPHAS = sizeof alphas / sizeof *alphas, DIRECTIONS = 12 };

static double directions[DIRECTIONS][3];

static int set_up_directions(void **state)
{
    uint64_t seed = 1;
    for (int i = 0; i < DIRECTIONS; i++)
        random_direction(&seed, directions[i]);
    // The places where the formulas are delicate.
    static const double special[6][3] = {{0, 1, 0},  {0, -1, 0}, {0, 0, 1},
                                         {0, 0, -1}, {1, 0, 0},  {0.6, 0.8, 0}};
    memcpy(directions, special, sizeof special);
    return set_up(state);
}

static void filter(const kiln_map *map, kiln_lobe lobe, double rotation, double (*values)[3])
{
    CHECK_OK(kiln_reference_filter(context, map, &lobe, rotation, (const double(*)[3])directions,
                                   DIRECTIONS, values, &error));
}

// Noise of 1 to 2, with a sun of 1e4 in one texel.
static void fill(kiln_map *map, uint64_t seed)
{
    fill_noise(map, seed, 1, 2);
    size_t sun = (size_t)(random_number(&seed) * (double)kiln_map_texels(map, 0));
    map->level[0][3 * sun] = 1e4F;
}

static double bump(void *user, double c)
{
    (void)user;
    return exp(30 * (c - 1));
}

static kiln_lobe lobe_number(int i)
{
    if (i < ALPHAS)
        return kiln_lobe_ggx(alphas[i]);
    switch (i - ALPHAS) {
    case 0:
        return kiln_lobe_lambert();
    case 1:
        return kiln_lobe_charlie(0.3);
    case 2:
        return kiln_lobe_phong(1);
    case 3:
        return kiln_lobe_phong(500);
    default:
        return kiln_lobe_custom(bump, NULL, 0.18);
    }
}

enum { LOBES = ALPHAS + 5 };

static void constant_stays_constant(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 16);
    for (size_t i = 0; i < 3 * kiln_map_texels(&map, 0); i++)
        map.level[0][i] = 0.7F + 0.1F * (float)(i % 3);
    for (int k = 0; k < LOBES; k++) {
        double values[DIRECTIONS][3];
        filter(&map, lobe_number(k), 33, values);
        for (int i = 0; i < DIRECTIONS; i++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(values[i][c], (double)map.level[0][c], 1e-12);
    }
    kiln_map_free(&map);
}

static void alpha_one_is_lambert(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 32);
    fill(&map, 7);
    double ggx[DIRECTIONS][3], lambert[DIRECTIONS][3], phong[DIRECTIONS][3];
    filter(&map, kiln_lobe_ggx(1), 0, ggx);
    filter(&map, kiln_lobe_lambert(), 0, lambert);
    filter(&map, kiln_lobe_phong(1), 0, phong);
    for (int i = 0; i < DIRECTIONS; i++)
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR(ggx[i][c], lambert[i][c], 1e-13 * lambert[i][c]);
            CHECK_NEAR(phong[i][c], lambert[i][c], 2e-6 * lambert[i][c]);
        }
    kiln_map_free(&map);
}

// Turning by k columns is moving the picture by k columns, to the left.
static void rotation_by_columns_moves_the_picture(void **state)
{
    (void)state;
    enum { SIZE = 16, STEP = 5 };
    kiln_map map = make_panorama(context, SIZE), moved = make_panorama(context, SIZE);
    fill(&map, 11);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < 2 * SIZE; x++)
            memcpy(texel_at(&moved, x, y), texel_at(&map, (x + STEP) % (2 * SIZE), y),
                   3 * sizeof(float));
    for (int k = 0; k < LOBES; k++) {
        double a[DIRECTIONS][3], b[DIRECTIONS][3];
        filter(&map, lobe_number(k), STEP * 180.0 / SIZE, a);
        filter(&moved, lobe_number(k), 0, b);
        // The same but for rounding, which may decide where a texel is cut.
        for (int i = 0; i < DIRECTIONS; i++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(a[i][c], b[i][c], 2e-6 * b[i][c]);
    }
    kiln_map_free(&moved);
    kiln_map_free(&map);
}

// Its own convergence: every node count and every radius made finer.
static void finer_rules_agree(void **state)
{
    (void)state;
    static const ki_reference_rule finer[] = {
        {.centre = 1.0 / 1200, .pairs = 1.0 / 40, .quads = 0.25, .edge = 0.00125},
        {.centre = 1e-9, .pairs = 1e-9, .quads = 0.3, .edge = 0.0015},
    };
    for (int size = 12; size <= 96; size *= 8) {
        kiln_map map = make_panorama(context, size);
        fill(&map, (uint64_t)size);
        for (int k = 0; k < (size < 20 ? LOBES : ALPHAS); k++) {
            kiln_lobe lobe = lobe_number(k);
            double base[DIRECTIONS][3], fine[DIRECTIONS][3];
            filter(&map, lobe, 0, base);
            for (int f = 0; f < 2; f++) {
                CHECK_OK(ki_reference_integrate(context, &map, &lobe, 0,
                                                (const double(*)[3])directions, DIRECTIONS,
                                                &finer[f], fine, &error));
                for (int i = 0; i < DIRECTIONS; i++)
                    for (int c = 0; c < 3; c++)
                        CHECK_NEAR(base[i][c], fine[i][c], 2e-6 * fine[i][c]);
            }
        }
        kiln_map_free(&map);
    }
}

// 8 x 8 and 16 x 16, extrapolated for the midpoint rule's h^2: against code that shares nothing.
static void plain_sums_converge_to_it(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 16);
    fill(&map, 5);
    static const struct {
        double alpha, bound;
    } cases[] = {{1, 2e-4}, {0.5, 2e-4}, {0.2, 2e-4}, {0.1, 5e-4}};
    for (int k = 0; k < 4; k++) {
        double values[DIRECTIONS][3], worst8 = 0, worst16 = 0;
        filter(&map, kiln_lobe_ggx(cases[k].alpha), 0, values);
        for (int i = 0; i < DIRECTIONS; i++) {
            double a = ggx_mean(&map, 32, 16, cases[k].alpha, directions[i], 8);
            double b = ggx_mean(&map, 32, 16, cases[k].alpha, directions[i], 16);
            CHECK_NEAR(b + (b - a) / 3, values[i][0], cases[k].bound * values[i][0]);
            worst8 = fmax(worst8, fabs(a / values[i][0] - 1));
            worst16 = fmax(worst16, fabs(b / values[i][0] - 1));
        }
        CHECK_BELOW(worst16, 0.5 * worst8);
    }
    kiln_map_free(&map);
}

static double tail_bound(double alpha, double distance)
{
    // GGX beyond a distance well above its width: (2 alpha / distance)^2, with room for the sun.
    return 4 * alpha * alpha / (distance * distance);
}

static void alpha_zero_is_a_mirror(void **state)
{
    (void)state;
    enum { SIZE = 16 };
    kiln_map map = make_panorama(context, SIZE);
    uint64_t seed = 3;
    fill_noise(&map, 4, 0, 1);
    double saved[DIRECTIONS][3], values[DIRECTIONS][3];
    memcpy(saved, directions, sizeof saved);
    size_t texel[DIRECTIONS];
    for (int i = 0; i < DIRECTIONS; i++) {
        texel[i] = (size_t)(random_number(&seed) * 2 * SIZE * SIZE);
        kiln_map_direction(&map, 0, texel[i], directions[i]);
    }
    filter(&map, kiln_lobe_ggx(0), 0, values);
    for (int i = 0; i < DIRECTIONS; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(values[i][c], (double)map.level[0][3 * texel[i] + (size_t)c], 0);
    // Narrow lobes come near to it: texel centres are at least pi / SIZE / 2 sin theta from edges.
    double alpha = 1e-4;
    for (int k = 0; k < 6; k++, alpha /= 10) {
        filter(&map, kiln_lobe_ggx(alpha), 0, values);
        for (int i = 0; i < DIRECTIONS; i++) {
            double edge = pi / SIZE / 2 * sqrt(1 - directions[i][1] * directions[i][1]);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(values[i][c], (double)map.level[0][3 * texel[i] + (size_t)c],
                           2 * tail_bound(alpha, edge) + 1e-15);
        }
    }
    memcpy(directions, saved, sizeof saved);
    kiln_map_free(&map);
}

// Lambert's second coefficient is two thirds of its first. Constant texels add their own size
// squared.
static void lambert_of_a_gradient_is_two_thirds(void **state)
{
    (void)state;
    enum { SIZE = 128 };
    kiln_map map = make_panorama(context, SIZE);
    fill_gradient(&map, 0, 1);
    double values[DIRECTIONS][3];
    filter(&map, kiln_lobe_lambert(), 0, values);
    for (int i = 0; i < DIRECTIONS; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(values[i][c], 2 + directions[i][c] * 2 / 3, (pi / SIZE) * (pi / SIZE) / 6);
    kiln_map_free(&map);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 32);
    fill(&map, 9);
    double one[DIRECTIONS][3], many[DIRECTIONS][3];
    kiln_lobe lobe = kiln_lobe_ggx(0.1);
    filter(&map, lobe, 0, many);
    for (int threads = 1; threads <= 8; threads *= 2) {
        kiln_context *other = make_context(threads);
        CHECK_OK(kiln_reference_filter(other, &map, &lobe, 0, (const double(*)[3])directions,
                                       DIRECTIONS, one, &error));
        assert_memory_equal(one, many, sizeof one);
        kiln_context_destroy(other);
    }
    kiln_map_free(&map);
}

static void instruction_sets_change_no_bit(void **state)
{
    (void)state;
    kiln_map map =
        make_panorama(context, 27); // rows of 54 texels, which is no multiple of a vector
    fill(&map, 10);
    double wanted[DIRECTIONS][3], values[DIRECTIONS][3];
    for (int i = 0; i < ALPHAS + 5; i++) {
        kiln_lobe lobe = lobe_number(i);
        for (int cpu = KILN_CPU_SCALAR; cpu <= KILN_CPU_AVX512; cpu++) {
            kiln_context *other = make_context_for(2, (enum kiln_cpu)cpu);
            CHECK_OK(kiln_reference_filter(other, &map, &lobe, 5, (const double(*)[3])directions,
                                           DIRECTIONS, values, &error));
            if (cpu == KILN_CPU_SCALAR)
                memcpy(wanted, values, sizeof wanted);
            assert_memory_equal(values, wanted, sizeof wanted);
            kiln_context_destroy(other);
        }
    }
    kiln_map_free(&map);
}

static void wrong_arguments_are_named(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 16), cube;
    kiln_lobe lobe = kiln_lobe_ggx(0.5), wrong = kiln_lobe_ggx(1.5);
    double d[1][3] = {{0, 2, 0}}, up[1][3] = {{0, 1, 0}}, value[1][3] = {{5, 5, 5}};
    const double(*two)[3] = (const double(*)[3])d, (*one)[3] = (const double(*)[3])up;
    assert_int_equal(kiln_reference_filter(context, &map, &lobe, 0, two, 1, value, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "direction 0 is (0, 2, 0)");
    CHECK_NEAR(value[0][0], 0, 0);
    d[0][1] = (double)NAN;
    assert_int_equal(kiln_reference_filter(context, &map, &lobe, 0, two, 1, value, &error),
                     KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_reference_filter(context, &map, &wrong, 0, one, 1, value, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "1.5");
    assert_int_equal(kiln_reference_filter(context, &map, &lobe, HUGE_VAL, one, 1, value, &error),
                     KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_reference_filter(context, &map, &lobe, 0, one, -1, value, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_OK(kiln_reference_filter(context, &map, &lobe, 0, one, 0, value, &error));
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 4, 1, &cube, &error));
    assert_int_equal(kiln_reference_filter(context, &cube, &lobe, 0, one, 1, value, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "cube");
    kiln_map_free(&cube);
    kiln_map_free(&map);
}

static bool stop_at_once(void *user, const char *stage, double fraction)
{
    (void)user;
    assert_string_equal(stage, "reference");
    assert_true(fraction >= 0 && fraction <= 1);
    return false;
}

static void stopping_and_small_memory_fail_cleanly(void **state)
{
    (void)state;
    kiln_context *other = NULL;
    kiln_context_def def = {.thread_count = 1, .progress = stop_at_once};
    CHECK_OK(kiln_context_create(&def, &other, &error));
    kiln_map map = make_panorama(other, 16);
    kiln_lobe lobe = kiln_lobe_lambert();
    double values[DIRECTIONS][3] = {{1}};
    assert_int_equal(kiln_reference_filter(other, &map, &lobe, 0, (const double(*)[3])directions,
                                           DIRECTIONS, values, &error),
                     KILN_ERROR_CANCELLED);
    CHECK_NEAR(values[0][0], 0, 0);
    kiln_map_free(&map);
    kiln_context_destroy(other);

    // Every amount of memory that does not suffice gives a sentence and no leak.
    for (size_t limit = 20000;; limit += 4000) {
        def = (kiln_context_def){.thread_count = 1, .memory_limit = limit};
        CHECK_OK(kiln_context_create(&def, &other, &error));
        map = make_panorama(other, 16);
        size_t before, after, peak;
        kiln_context_memory(other, &before, &peak);
        kiln_result result = kiln_reference_filter(
            other, &map, &lobe, 0, (const double(*)[3])directions, DIRECTIONS, values, &error);
        kiln_context_memory(other, &after, &peak);
        assert_int_equal(before, after);
        kiln_map_free(&map);
        kiln_context_destroy(other);
        if (result == KILN_OK)
            break;
        assert_int_equal(result, KILN_ERROR_MEMORY);
        assert_true(limit < 2000000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_stays_constant),
        cmocka_unit_test(alpha_one_is_lambert),
        cmocka_unit_test(rotation_by_columns_moves_the_picture),
        cmocka_unit_test(finer_rules_agree),
        cmocka_unit_test(plain_sums_converge_to_it),
        cmocka_unit_test(alpha_zero_is_a_mirror),
        cmocka_unit_test(lambert_of_a_gradient_is_two_thirds),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(instruction_sets_change_no_bit),
        cmocka_unit_test(wrong_arguments_are_named),
        cmocka_unit_test(stopping_and_small_memory_fail_cleanly),
    };
    return cmocka_run_group_tests(tests, set_up_directions, tear_down);
}
