// Interpolation between rings keeps constants and follows waves.
#include "math/math.h"
#include "sphere/grid.h"
#include "sphere/legendre.h"

#include "kit/context.h"

enum { DEGREE = 200 };

// Checks the weights for rings that are `step` radians apart. The errors are those of waves up to a
// tenth of the degree, and up to a half of it, where GGX has fallen to e^-5.
static void check_taps(double step, double most_low, double most_middle)
{
    static double density[DEGREE + 1], taps[KI_TAPS * (KI_TAP_STEPS + 1)];
    double worst_low = 0, worst_middle = 0;
    ki_model_density(DEGREE, density);
    ki_taps_design(step, density, DEGREE, taps);
    for (int n = 0; n <= 1000; n++) {
        double w[KI_TAPS], sum = 0, fraction = n / 1000.0;
        ki_taps_at(taps, fraction, w);
        for (int i = 0; i < KI_TAPS; i++)
            sum += w[i];
        CHECK_NEAR(sum, 1, 1e-12);
        for (int l = 1; l <= DEGREE / 2; l++) {
            double re = -cos(l * fraction * step), im = -sin(l * fraction * step);
            for (int i = 0; i < KI_TAPS; i++) {
                re += w[i] * cos(l * (i - 3) * step);
                im += w[i] * sin(l * (i - 3) * step);
            }
            double *worst = l <= DEGREE / 10 ? &worst_low : &worst_middle;
            *worst = fmax(*worst, sqrt(re * re + im * im));
        }
    }
    CHECK_BELOW(worst_low, most_low);
    CHECK_BELOW(worst_middle, most_middle);
}

static void taps_keep_constants_and_follow_waves(void **state)
{
    (void)state;
    static const struct {
        ki_ring_excess excess;
        double low, middle;
    } cases[] = {{KI_FEW_RINGS, 1e-5, 1.5e-3}, {KI_MANY_RINGS, 3e-6, 5e-4}};
    for (int i = 0; i < 2; i++) {
        ki_rings rings;
        assert_true(ki_rings_create_grid(context, DEGREE, cases[i].excess, &rings));
        check_taps(KI_PI / (2 * rings.pair_count), cases[i].low, cases[i].middle);
        ki_rings_destroy(&rings);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(taps_keep_constants_and_follow_waves),
    };
    return cmocka_run_group_tests_name("sphere parts", tests, set_up, tear_down);
}
