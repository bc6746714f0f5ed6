// Closed forms: what they promise holds at points they have not seen, and they have no poles.
#include "kit/kit.h"

#include "math/math.h"
#include "table/fit.h"

static kiln_error error;

// -------------------------------------------------------------------------------------- the parts

// The residual is orthogonal to every column.
static void least_squares_are_least(void **state)
{
    (void)state;
    enum { ROWS = 50, COLUMNS = 7 };
    double a[ROWS * COLUMNS], b[ROWS], kept_a[ROWS * COLUMNS], kept_b[ROWS], x[COLUMNS];
    uint64_t seed = 3;
    for (int i = 0; i < ROWS * COLUMNS; i++)
        kept_a[i] = a[i] = 2 * random_number(&seed) - 1;
    for (int i = 0; i < ROWS; i++)
        kept_b[i] = b[i] = 2 * random_number(&seed) - 1;
    assert_true(ki_least_squares(a, b, ROWS, COLUMNS, x));
    for (int j = 0; j < COLUMNS; j++) {
        double dot = 0;
        for (int i = 0; i < ROWS; i++) {
            double residual = -kept_b[i];
            for (int k = 0; k < COLUMNS; k++)
                residual += kept_a[k * ROWS + i] * x[k];
            dot += residual * kept_a[j * ROWS + i];
        }
        CHECK_NEAR(dot, 0, 1e-13);
    }
    for (int i = 0; i < ROWS; i++)
        kept_a[ROWS + i] = 2 * kept_a[i];
    assert_false(ki_least_squares(kept_a, kept_b, ROWS, 2, x));
}

// q = 1 + b x + c x^2 with its least value at x = 0.3, where no coarse grid looks.
static kiln_fit_part denominator_with_minimum(double least)
{
    double c = (1 - least) / 0.09;
    return (kiln_fit_part){
        .rational = true, .x_count = 3, .y_count = 1, .q = {1, (float)(-0.6 * c), (float)c}};
}

static void poles_are_found(void **state)
{
    (void)state;
    kiln_fit_part touching = denominator_with_minimum(0), low = denominator_with_minimum(0.005),
                  high = denominator_with_minimum(0.02), below = denominator_with_minimum(-0.1);
    assert_false(ki_fit_positive(&touching));
    assert_false(ki_fit_positive(&low));
    assert_false(ki_fit_positive(&below));
    assert_true(ki_fit_positive(&high));
    kiln_fit_part corner = {.rational = true, .x_count = 2, .y_count = 2, .q = {1, 0.5f, 0.5f, 0}};
    assert_false(ki_fit_positive(&corner)); // 0 at (-1, -1)
    corner.q[2] = 0.45f;
    assert_true(ki_fit_positive(&corner));
}

// --------------------------------------------------------------------------------------- the forms

static void exact(const kiln_fit_def *def, double nov, double roughness, double *values)
{
    switch (def->kind) {
    case KILN_FIT_E:
        *values = kiln_energy(&def->model, roughness, nov);
        break;
    case KILN_FIT_E_AVERAGE:
        *values = kiln_energy_average(&def->model, roughness);
        break;
    case KILN_FIT_DFG:
        kiln_energy_split(&def->model, roughness, nov, values);
        break;
    default:
        *values = kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, roughness, nov);
    }
}

// Fresh points, in three densities: even, toward grazing views of all surfaces, and of smooth ones.
static double largest_error(const kiln_fit *fit, int count)
{
    double largest = 0, low = fit->def.roughness_min;
    uint64_t seed = 20;
    for (int i = 0; i < count; i++) {
        double u = random_number(&seed), v = random_number(&seed), wanted[2] = {0};
        double nov = i % 3 == 0 ? u : i % 3 == 1 ? u * u * u : u * u * u * v * v;
        float n = (float)nov, r = (float)(low + (1 - low) * (i % 3 == 2 ? v * v : v));
        float values[2] = {0};
        kiln_fit_evaluate(fit, n, r, values);
        exact(&fit->def, (double)n, (double)r, wanted);
        for (int k = 0; k < fit->part_count; k++)
            largest = fmax(largest, fabs((double)values[k] - wanted[k]));
    }
    return largest;
}

static kiln_fit hold(kiln_fit_def def, int most_coefficients)
{
    kiln_context *context = make_context(2);
    kiln_fit fit;
    CHECK_OK(kiln_fit_create(context, &def, &fit, &error));
    CHECK_BELOW(fit.max_error, def.error);
    CHECK_BELOW(fit.rms_error, fit.max_error);
    CHECK_BELOW(fit.coefficient_count, most_coefficients);
    CHECK_BELOW(largest_error(&fit, def.kind == KILN_FIT_E_AVERAGE ? 3000 : 30000),
                1.02 * fit.max_error);
    for (int k = 0; k < fit.part_count; k++)
        assert_true(ki_fit_positive(&fit.part[k]));
    kiln_context_destroy(context);
    return fit;
}

static void e_holds_its_error(void **state)
{
    (void)state;
    for (int g = KILN_G_SMITH; g <= KILN_G_SCHLICK_TEXT; g++)
        hold((kiln_fit_def){.model = {.g = (kiln_g)g}, .error = 1e-2}, 20);
    hold((kiln_fit_def){.error = 1e-3}, 49);
    hold((kiln_fit_def){.model = {.g = KILN_G_SCHLICK_K2}, .error = 1e-3}, 31);
    hold((kiln_fit_def){.model = {.g = KILN_G_SCHLICK_K2},
                        .error = 1e-3,
                        .form = KILN_FIT_POLYNOMIAL},
         64);
}

static void averages_hold_their_error(void **state)
{
    (void)state;
    for (int g = KILN_G_SMITH; g <= KILN_G_SCHLICK_TEXT; g++)
        hold((kiln_fit_def){.kind = KILN_FIT_E_AVERAGE, .model = {.g = (kiln_g)g}, .error = 1e-5},
             9);
}

static void the_split_sum_holds_its_error(void **state)
{
    (void)state;
    kiln_fit fit = hold((kiln_fit_def){.kind = KILN_FIT_DFG, .error = 1e-2}, 60);
    // E = A + B up to the rounding of floats.
    float ab[2], e = ki_fit_evaluate_part(&fit.def, &fit.part[0], 0.3f, 0.4f);
    kiln_fit_evaluate(&fit, 0.3f, 0.4f, ab);
    CHECK_NEAR((double)(ab[0] + ab[1]), (double)e, 1e-7);
}

static void sheen_holds_its_error(void **state)
{
    (void)state;
    hold((kiln_fit_def){.kind = KILN_FIT_SHEEN, .error = 1e-2, .roughness_min = 0.3}, 60);
}

static void ends_and_beyond_are_clamped(void **state)
{
    (void)state;
    kiln_fit fit = hold((kiln_fit_def){.error = 1e-2}, 20);
    float mirror, value, same;
    kiln_fit_evaluate(&fit, 0, 0, &mirror);
    CHECK_NEAR((double)mirror, 1, 1e-2);
    kiln_fit_evaluate(&fit, 2, 3, &value);
    kiln_fit_evaluate(&fit, 1, 1, &same);
    assert_true(value == same);
    kiln_fit_evaluate(&fit, -1, -1, &value);
    assert_true(value == mirror);
    kiln_fit_evaluate(&fit, NAN, NAN, &value);
    assert_true(value == mirror);
}

// The same bits whatever the threads.
static void threads_do_not_matter(void **state)
{
    (void)state;
    kiln_fit fits[2];
    kiln_fit_def def = {.model = {.g = KILN_G_SMITH_UNCORRELATED}, .error = 5e-3};
    for (int i = 0; i < 2; i++) {
        kiln_context *context = make_context(1 + 4 * i);
        CHECK_OK(kiln_fit_create(context, &def, &fits[i], &error));
        kiln_context_destroy(context);
    }
    assert_int_equal(fits[0].coefficient_count, fits[1].coefficient_count);
    assert_memory_equal(fits[0].part[0].p, fits[1].part[0].p, sizeof fits[0].part[0].p);
    assert_memory_equal(fits[0].part[0].q, fits[1].part[0].q, sizeof fits[0].part[0].q);
}

static void what_cannot_be_is_said(void **state)
{
    (void)state;
    kiln_context *context = make_context(2);
    kiln_fit fit;
    kiln_fit_def def = {.error = 1e-2, .max_coefficients = 16};
    assert_int_equal(kiln_fit_create(context, &def, &fit, &error), KILN_ERROR_UNSUPPORTED);
    CHECK_SAYS(error.message, "up to 16 coefficients has an error of 0.01 or less; the best");
    assert_int_equal(fit.part_count, 0);
    def = (kiln_fit_def){.error = 1e-9};
    assert_int_equal(kiln_fit_create(context, &def, &fit, &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "1e-09, it must be 1e-06 to 0.5");
    def = (kiln_fit_def){.max_coefficients = 161};
    assert_int_equal(kiln_fit_create(context, &def, &fit, &error), KILN_ERROR_ARGUMENT);
    def = (kiln_fit_def){.roughness_min = 1};
    assert_int_equal(kiln_fit_create(context, &def, &fit, &error), KILN_ERROR_ARGUMENT);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(least_squares_are_least),
        cmocka_unit_test(poles_are_found),
        cmocka_unit_test(e_holds_its_error),
        cmocka_unit_test(averages_hold_their_error),
        cmocka_unit_test(the_split_sum_holds_its_error),
        cmocka_unit_test(sheen_holds_its_error),
        cmocka_unit_test(ends_and_beyond_are_clamped),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(what_cannot_be_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
