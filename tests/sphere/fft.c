// The fast Fourier transform of every length against the sum that defines the transform.
#include "sphere/fft.h"
#include "math/math.h"

#include "kit/context.h"

static void fft_is_the_transform(void **state)
{
    (void)state;
    static const int lengths[] = {1,  2,  3,  4,  5,   6,   7,   8,   9,   10,  11,  12,  13,
                                  15, 16, 18, 20, 24,  30,  32,  35,  48,  49,  60,  64,  77,
                                  96, 97, 98, 99, 100, 120, 128, 144, 194, 250, 256, 1000};
    const ki_kernels *kernels = ki_sphere_kernels(context);
    for (size_t n = 0; n < sizeof lengths / sizeof *lengths; n++) {
        int length = lengths[n];
        size_t count = 16 * (size_t)length;
        ki_fft fft;
        assert_true(ki_fft_create(context, length, &fft));
        double *data = calloc(2 * count, sizeof *data), *copy = calloc(count, sizeof *data);
        uint64_t seed = (uint64_t)length;
        for (size_t i = 0; i < count; i++)
            copy[i] = data[i] = random_between(&seed, -1, 1);
        const double *out = kernels->fft(&fft, data, data + count);
        for (int k = 0; k < length; k += 1 + length / 37)
            for (int lane = 0; lane < 8; lane++) {
                double re = 0, im = 0;
                for (int j = 0; j < length; j++) {
                    double angle = -2 * KI_PI * (double)((int64_t)j * k % length) / length;
                    double c = cos(angle), s = sin(angle);
                    double xr = copy[16 * j + lane], xi = copy[16 * j + 8 + lane];
                    re += xr * c - xi * s;
                    im += xr * s + xi * c;
                }
                CHECK_NEAR(out[16 * k + lane], re, 2e-15 * length);
                CHECK_NEAR(out[16 * k + 8 + lane], im, 2e-15 * length);
            }
        free(data);
        free(copy);
        ki_fft_destroy(&fft);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fft_is_the_transform),
    };
    return cmocka_run_group_tests_name("sphere parts", tests, set_up, tear_down);
}
