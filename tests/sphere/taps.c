// Interpolation between rings keeps constants and follows waves.
#include "math/math.h"
#include "sphere/grid.h"

#include "kit/context.h"

static void taps_keep_constants_and_follow_waves(void **state)
{
    (void)state;
    enum { DEGREE = 200 };
    static double density[DEGREE + 1], taps[KI_TAPS * (KI_TAP_STEPS + 1)];
    ki_model_density(DEGREE, density);
    double step = KI_PI / 308, worst_low = 0, worst_middle = 0;
    ki_taps_design(step, density, DEGREE, taps);
    for (int n = 0; n <= 1000; n++) {
        double w[KI_TAPS], sum = 0, fraction = n / 1000.0;
        ki_taps_at(taps, fraction, w);
        for (int i = 0; i < KI_TAPS; i++)
            sum += w[i];
        CHECK_NEAR(sum, 1, 1e-12);
        for (int l = 1; l <= 100; l++) {
            double re = -cos(l * fraction * step), im = -sin(l * fraction * step);
            for (int i = 0; i < KI_TAPS; i++) {
                re += w[i] * cos(l * (i - 3) * step);
                im += w[i] * sin(l * (i - 3) * step);
            }
            double *worst = l <= 20 ? &worst_low : &worst_middle;
            *worst = fmax(*worst, sqrt(re * re + im * im));
        }
    }
    CHECK_BELOW(worst_low, 3e-6);    // up to a tenth of the degree
    CHECK_BELOW(worst_middle, 5e-4); // half of it, where GGX has fallen to e^-5
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(taps_keep_constants_and_follow_waves),
    };
    return cmocka_run_group_tests_name("sphere parts", tests, set_up, tear_down);
}
