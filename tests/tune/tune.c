// Levels for what an engine shows: nearer to the truth than exact ones, by brute force. That their
// bits are the same for every instruction set and number of threads is held by the hash "tuned" of
// tests/golden.
#include "kit/kit.h"

static kiln_error error;

// A ramp with blobs, and with `sun` a texel that outshines it all.
static kiln_map make_environment(kiln_context *context, int size, bool sun)
{
    kiln_map map = make_panorama(context, size);
    uint64_t seed = 3;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < 2 * size; x++)
            for (int c = 0; c < 3; c++) {
                double d[3];
                panorama_direction(size, x + 0.5, y + 0.5, d);
                double wave = sin(9 * d[0] + c) * cos(7 * d[2]) + 0.3 * random_number(&seed);
                texel_at(&map, x, y)[c] = (float)(1.5 + d[1] + wave);
            }
    for (int c = 0; c < 3 && sun; c++)
        texel_at(&map, size + 5, size / 3)[c] = (float)(3e3 + 1e2 * c);
    return map;
}

static kiln_map bake(kiln_context *context, const kiln_map *source, const char *engine, int size,
                     int level_count, bool tuned, bool soft)
{
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    kiln_map map;
    CHECK_OK(
        kiln_engine_levels(kiln_engine_find(engine), size, level_count, roughness, &def, &error));
    def.tune_for = tuned ? kiln_engine_find(engine) : NULL;
    def.tune_soft = soft;
    CHECK_OK(kiln_prefilter(context, source, &def, &map, &error));
    return map;
}

static void white_stays_white(void **state)
{
    (void)state;
    kiln_context *context = make_context(0);
    kiln_map white = make_panorama(context, 32);
    fill_constant(&white, 1);
    static const char *const engines[] = {"three", "babylon", "filament"};
    for (int e = 0; e < 3; e++) {
        for (int soft = 0; soft < 2; soft++) {
            kiln_map map = bake(context, &white, engines[e], 64, 0, true, soft);
            for (int k = 0; k < map.level_count; k++)
                for (size_t i = 0; i < 3 * kiln_map_texels(&map, k); i++)
                    CHECK_NEAR((double)map.level[k][i], 1, 1e-6);
            kiln_map_free(&map);
        }
    }
    kiln_map_free(&white);
    kiln_context_destroy(context);
}

// A sun on black is the hardest: kernels have negative parts. The first level is the plain mirror,
// bit for bit, and no light is won or lost.
static void nothing_is_negative_under_a_sun(void **state)
{
    (void)state;
    kiln_context *context = make_context(0);
    kiln_map sun = make_panorama(context, 64);
    for (int c = 0; c < 3; c++)
        texel_at(&sun, 70, 20)[c] = 1e6F;
    static const char *const engines[] = {"three", "babylon"};
    for (int e = 0; e < 2; e++) {
        kiln_map plain = bake(context, &sun, engines[e], 64, 0, false, false);
        for (int soft = 0; soft < 2; soft++) {
            kiln_map map = bake(context, &sun, engines[e], 64, 0, true, soft);
            bool same =
                !memcmp(map.level[0], plain.level[0], 3 * kiln_map_texels(&map, 0) * sizeof(float));
            assert_true(same == !soft);
            for (int k = 0; k < map.level_count; k++) {
                double mean[2] = {0};
                for (size_t i = 0; i < kiln_map_texels(&map, k); i++) {
                    double d[3];
                    kiln_map_direction(&map, k, i, d);
                    double weight = pow(fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2]))), 3);
                    assert_true(map.level[k][3 * i] >= 0);
                    mean[0] += weight * (double)map.level[k][3 * i];
                    mean[1] += weight * (double)plain.level[k][3 * i];
                }
                // Coarse texels at their centres are not the mean of what is between them.
                if (map.size >> k >= 16)
                    CHECK_NEAR(mean[0] / mean[1], 1, 0.02);
            }
            kiln_map_free(&map);
        }
        kiln_map_free(&plain);
    }
    kiln_map_free(&sun);
    kiln_context_destroy(context);
}

// Half of the directions are spread evenly, half around the sun's as wide as the lobe.
enum { DIRECTIONS = 160, STEPS = 12 };

static void choose_directions(double alpha, int size, double (*directions)[3], double *weights)
{
    uint64_t seed = 11;
    double sun[3], reach = fmin(1, 6 * alpha * alpha + 1e-3); // 1 - cos
    int row = size / 3;
    panorama_direction(size, size + 5.5, row + 0.5, sun);
    for (int i = 0; i < DIRECTIONS; i++) {
        double d[3] = {0}, dot = 2;
        do {
            random_direction(&seed, d);
            dot = d[0] * sun[0] + d[1] * sun[1] + d[2] * sun[2];
            if (i % 2) {
                // Towards the sun until within reach, evenly over the cap.
                double versine = reach * random_number(&seed), side = 0;
                double s = sqrt(versine * (2 - versine));
                for (int k = 0; k < 3; k++)
                    d[k] -= dot * sun[k];
                side = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
                for (int k = 0; k < 3; k++)
                    d[k] = (1 - versine) * sun[k] + s * d[k] / side;
                dot = 1 - versine;
            }
        } while (!(i % 2) && dot > 1 - reach);
        memcpy(directions[i], d, sizeof d);
        weights[i] = i % 2 ? reach / 2 : 1 - reach / 2;
    }
}

// What is off and what the whole is, squared: over all directions, and farther than .1415 from the
// sun.
typedef struct sums {
    double off[2], whole[2];
} sums;

static sums compare_shown(int size, const double (*directions)[3], const double *weights,
                          const double (*shown)[3], const double (*truth)[3])
{
    double sun[3];
    int row = size / 3;
    panorama_direction(size, size + 5.5, row + 0.5, sun);
    sums sum = {0};
    for (int i = 0; i < DIRECTIONS; i++) {
        const double *at = directions[i];
        double dot = at[0] * sun[0] + at[1] * sun[1] + at[2] * sun[2];
        double away = dot < cos(0.1415) ? weights[i] : 0;
        for (int c = 0; c < 3; c++) {
            double d = shown[i][c] - truth[i][c];
            sum.off[0] += weights[i] * d * d;
            sum.whole[0] += weights[i] * truth[i][c] * truth[i][c];
            sum.off[1] += away * d * d;
            sum.whole[1] += away * truth[i][c] * truth[i][c];
        }
    }
    return sum;
}

// Relative rms over roughness, `from` to 1, of what is shown of each of two maps: everywhere, and
// farther than .1415 from the sun. The truth, by brute force, is computed once for both.
static void displayed_errors(kiln_context *context, const kiln_map *source, const char *engine,
                             const kiln_map maps[2], double from, double error_of[2][2])
{
    static double directions[DIRECTIONS][3], truth[DIRECTIONS][3], shown[DIRECTIONS][3],
        weights[DIRECTIONS];
    memset(error_of, 0, 2 * sizeof *error_of);
    for (int k = 0; k < STEPS; k++) {
        double r = from + (1 - from) * (k + 0.5) / STEPS;
        kiln_lobe lobe = kiln_lobe_ggx(r * r);
        choose_directions(r * r, source->size, directions, weights);
        CHECK_OK(kiln_reference_filter(context, source, &lobe, 0, (const double(*)[3])directions,
                                       DIRECTIONS, truth, &error));
        for (int m = 0; m < 2; m++) {
            CHECK_OK(kiln_engine_show(context, kiln_engine_find(engine), &maps[m], r,
                                      (const double(*)[3])directions, DIRECTIONS, shown, &error));
            sums sum = compare_shown(source->size, (const double(*)[3])directions, weights,
                                     (const double(*)[3])shown, (const double(*)[3])truth);
            for (int i = 0; i < 2; i++)
                error_of[m][i] += sum.off[i] / sum.whole[i] / STEPS;
        }
    }
    for (int m = 0; m < 2; m++)
        for (int i = 0; i < 2; i++)
            error_of[m][i] = sqrt(error_of[m][i]);
}

static void tuned_levels_show_less_error(void **state)
{
    (void)state;
    static const char *const engines[] = {"three", "babylon"};
    // With faces of 128 Babylon reads next to nothing but the mirror below .1.
    static const double from[] = {0.05, 0.1};
    kiln_context *context = make_context(0);
    for (int sun = 0; sun < 2; sun++) {
        kiln_map source = make_environment(context, 32, sun);
        for (int e = 0; e < 2; e++) {
            kiln_map maps[2];
            for (int tuned = 0; tuned < 2; tuned++)
                maps[tuned] = bake(context, &source, engines[e], 128, 0, tuned, false);
            double errors[2][2], *before = errors[0], *after = errors[1];
            displayed_errors(context, &source, engines[e], maps, from[e], errors);
            for (int i = 0; i < 2; i++) {
                print_message("%s, %s%s: %.4f, tuned %.4f\n", engines[e], sun ? "sunny" : "calm",
                              i ? ", away from it" : "", before[i], after[i]);
                assert_true(after[i] < 0.9 * before[i]);
            }
            kiln_map_free(&maps[0]);
            kiln_map_free(&maps[1]);
        }
        kiln_map_free(&source);
    }
    kiln_context_destroy(context);
}

// Light of 2^112 times the strength, whose sums are too large for floats, makes the same levels
// times 2^112.
static void strong_light_makes_strong_levels(void **state)
{
    (void)state;
    kiln_context *context = make_context(0);
    kiln_map weak = make_environment(context, 32, true),
             strong = make_environment(context, 32, true);
    for (size_t i = 0; i < 3 * kiln_map_texels(&strong, 0); i++)
        strong.level[0][i] *= 0x1p112F;
    kiln_map from_weak = bake(context, &weak, "three", 64, 0, true, true);
    kiln_map from_strong = bake(context, &strong, "three", 64, 0, true, true);
    for (int k = 0; k < from_weak.level_count; k++)
        for (size_t i = 0; i < 3 * kiln_map_texels(&from_weak, k); i++)
            assert_true(from_strong.level[k][i] == from_weak.level[k][i] * 0x1p112F);
    kiln_map_free(&from_weak);
    kiln_map_free(&from_strong);
    kiln_map_free(&weak);
    kiln_map_free(&strong);
    kiln_context_destroy(context);
}

// The same plan again, and another environment between: nothing of the last one stays.
static void a_plan_may_be_executed_again(void **state)
{
    (void)state;
    kiln_context *context = make_context(0);
    kiln_map source[2] = {make_environment(context, 32, true),
                          make_environment(context, 32, false)};
    kiln_bake_def def = {
        .levels = {.size = 32}, .engine = kiln_engine_find("three"), .tune = KILN_TUNE_SHARP};
    kiln_plan *plan;
    kiln_environment first, again;
    CHECK_OK(kiln_plan_create(context, KILN_SHAPE_PANORAMA, 32, &def, &plan, &error));
    CHECK_OK(kiln_plan_environment(plan, &first, &error));
    CHECK_OK(kiln_plan_environment(plan, &again, &error));
    CHECK_OK(kiln_plan_execute(plan, &source[0], &first, &error));
    CHECK_OK(kiln_plan_execute(plan, &source[1], &again, &error));
    CHECK_OK(kiln_plan_execute(plan, &source[0], &again, &error));
    for (int k = 0; k < first.levels.level_count; k++)
        assert_memory_equal(first.levels.level[k], again.levels.level[k],
                            3 * kiln_map_texels(&first.levels, k) * sizeof(float));
    kiln_environment_free(&first);
    kiln_environment_free(&again);
    kiln_plan_destroy(plan);
    kiln_map_free(&source[0]);
    kiln_map_free(&source[1]);
    kiln_context_destroy(context);
}

static void what_cannot_be_tuned_is_said(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    kiln_map source = make_environment(context, 16, false), map;
    kiln_engine stranger = {.name = "stranger"};
    kiln_prefilter_def def = {.size = 16, .tune_for = &stranger};
    assert_int_equal(kiln_prefilter(context, &source, &def, &map, &error), KILN_ERROR_ARGUMENT);
    def.tune_for = kiln_engine_find("three");
    def.size = 24;
    assert_int_equal(kiln_prefilter(context, &source, &def, &map, &error), KILN_ERROR_ARGUMENT);
    def.size = 16;
    def.lobe = KILN_LOBE_LAMBERT;
    assert_int_equal(kiln_prefilter(context, &source, &def, &map, &error), KILN_ERROR_ARGUMENT);
    kiln_map_free(&source);
    kiln_context_destroy(context);
}

static void a_failing_allocation_leaks_nothing(void **state)
{
    (void)state;
    failing f;
    kiln_context *context = failing_context(&f);
    kiln_map source = make_environment(context, 8, true), map;
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    CHECK_OK(kiln_engine_levels(kiln_engine_find("three"), 16, 3, roughness, &def, &error));
    def.tune_for = kiln_engine_find("three");
    def.tune_soft = true;
    def.tolerance = 0.01;
    long held = f.held, n = 0;
    kiln_result result;
    do {
        f.calls = 0;
        f.fail_at = ++n;
        result = kiln_prefilter(context, &source, &def, &map, &error);
        if (result != KILN_OK) {
            assert_int_equal(result, KILN_ERROR_MEMORY);
            assert_true(f.held == held);
        }
    } while (result != KILN_OK);
    assert_true(n > 50);
    f.fail_at = 0;
    kiln_map_free(&map);
    kiln_map_free(&source);
    kiln_context_destroy(context);
    assert_true(f.held == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(nothing_is_negative_under_a_sun),
        cmocka_unit_test(tuned_levels_show_less_error),
        cmocka_unit_test(strong_light_makes_strong_levels),
        cmocka_unit_test(a_plan_may_be_executed_again),
        cmocka_unit_test(what_cannot_be_tuned_is_said),
        cmocka_unit_test(a_failing_allocation_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
