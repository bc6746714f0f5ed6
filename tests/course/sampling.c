// The samples of the textbook's methods: radical inverses, half vectors that follow GGX, and
// Schlick's masking.
#include "brdf/brdf.h"

#include "kit/context.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radical_inverse_mirrors_bits),
        cmocka_unit_test(ggx_is_a_distribution),
        cmocka_unit_test(half_vectors_follow_the_distribution),
        cmocka_unit_test(shadowing_is_schlicks),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
