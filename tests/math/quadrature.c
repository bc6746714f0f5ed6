// Quadrature rules integrate what they must integrate exactly, and survive singular ends.
#include "kit/kit.h"

#include "math/math.h"

static void double_exponential_ignores_ends(void **unused)
{
    (void)unused;
    double nodes[81], weights[81], sums[4] = {0};
    ki_double_exponential(81, 3.2, nodes, weights);
    for (int i = 0; i < 81; i++) {
        assert_true(i == 0 || nodes[i] >= nodes[i - 1]);
        CHECK_NEAR(nodes[i] + nodes[80 - i], 1, 2e-16);
        sums[0] += weights[i];
        sums[1] += weights[i] * sqrt(nodes[i]);
        sums[2] -= weights[i] * log(nodes[i]);
        sums[3] += weights[i] * sqrt(nodes[80 - i]); // sqrt(1 - x)
    }
    CHECK_NEAR(sums[0], 1, 1e-14);
    CHECK_NEAR(sums[1], 2.0 / 3, 1e-14);
    CHECK_NEAR(sums[2], 1, 1e-13);
    CHECK_NEAR(sums[3], 2.0 / 3, 1e-14);
}

static void gauss_legendre_is_exact_to_its_degree(void **unused)
{
    (void)unused;
    static double nodes[512], weights[512];
    for (int count = 1; count <= 512; count = count < 40 ? count + 1 : 2 * count) {
        ki_gauss_legendre(count, nodes, weights);
        for (int power = 0; power <= 2 * count - 1; power += count > 40 ? 37 : 1) {
            double sum = 0;
            for (int i = 0; i < count; i++) {
                assert_true(i == 0 || nodes[i] > nodes[i - 1]);
                sum += weights[i] * pow(nodes[i], power);
            }
            CHECK_NEAR(sum, power % 2 ? 0 : 2.0 / (power + 1), 3e-15);
        }
    }
    ki_gauss_legendre(8, nodes, weights);
    for (int i = 0; i < 8; i++) {
        CHECK_NEAR(ki_gauss8_nodes[i], nodes[i], 4e-16);
        CHECK_NEAR(ki_gauss8_weights[i], weights[i], 1e-15);
    }
    ki_gauss_legendre(16, nodes, weights);
    for (int i = 0; i < 16; i++) {
        CHECK_NEAR(ki_gauss16_nodes[i], nodes[i], 4e-16);
        CHECK_NEAR(ki_gauss16_weights[i], weights[i], 4e-16);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(double_exponential_ignores_ends),
        cmocka_unit_test(gauss_legendre_is_exact_to_its_degree),
    };
    return cmocka_run_group_tests_name("math", tests, NULL, NULL);
}
