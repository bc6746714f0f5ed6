// Associated Legendre functions are orthonormal, and the rings that each order leaves out hold
// nothing.
#include "sphere/legendre.h"
#include "math/math.h"
#include "sphere/grid.h"

#include "kit/context.h"

// Integrals of products over the sphere: orthonormal means 1 for a function with itself, 0 for two
// of the same order.
static void legendre_functions_are_orthonormal(void **state)
{
    (void)state;
    enum { DEGREE = 60, NODES = 64 };
    ki_legendre legendre;
    assert_true(ki_legendre_create(context, DEGREE, &legendre));
    double nodes[NODES], weights[NODES];
    ki_gauss_legendre(NODES, nodes, weights);
    for (int m = 0; m <= DEGREE; m += 7) {
        static double p[DEGREE + 1][NODES];
        const double *f = legendre.f + ki_legendre_row(&legendre, m);
        const double *scale = legendre.scale + ki_legendre_row(&legendre, m);
        for (int i = 0; i < NODES; i++) {
            double q = pow(1 - nodes[i] * nodes[i], m / 2.0), before = 0;
            for (int l = m; l <= DEGREE; l++) {
                p[l][i] = q * scale[l - m];
                double next = 2 * nodes[i] * q - f[l - m + 1] * before;
                before = q;
                q = next;
            }
        }
        for (int a = m; a <= DEGREE; a++)
            for (int b = m; b <= DEGREE; b++) {
                double sum = 0;
                for (int i = 0; i < NODES; i++)
                    sum += weights[i] * p[a][i] * p[b][i];
                CHECK_NEAR(2 * KI_PI * sum, a == b ? 1 : 0, 1e-12);
            }
    }
    ki_legendre_destroy(&legendre);
}

// Skipped orders must not matter: the largest |P_lm| on the rings left out stays below 1e-12 of
// what it reaches elsewhere (about sqrt(degree)).
static void skipped_rings_hold_nothing(void **state)
{
    (void)state;
    static const int degrees[] = {9, 64, 364, 1600};
    static const ki_ring_excess excesses[] = {KI_FEW_RINGS, KI_MANY_RINGS};
    for (int n = 0; n < 8; n++) {
        int degree = degrees[n / 2];
        ki_rings rings;
        ki_legendre legendre;
        assert_true(ki_rings_create_grid(context, degree, excesses[n % 2], &rings));
        assert_true(ki_legendre_create(context, degree, &legendre));
        double most = 0;
        for (int m = 0; m <= degree; m += 1 + degree / 60) {
            const double *f = legendre.f + ki_legendre_row(&legendre, m);
            const double *scale = legendre.scale + ki_legendre_row(&legendre, m);
            if (rings.first[m] == 0)
                continue;
            int k = 8 * rings.first[m] - 1; // the ring left out that is nearest the equator
            double x = rings.twice_cos[k];
            double q = rings.start[(size_t)m * 8 * (size_t)rings.vector_count + (size_t)k];
            double before = 0;
            for (int l = m; l <= degree; l++) {
                most = fmax(most, fabs(q * scale[l - m]));
                double next = x * q - f[l - m + 1] * before;
                before = q;
                q = next;
            }
        }
        CHECK_BELOW(most, 1e-12);
        ki_rings_destroy(&rings);
        ki_legendre_destroy(&legendre);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(legendre_functions_are_orthonormal),
        cmocka_unit_test(skipped_rings_hold_nothing),
    };
    return cmocka_run_group_tests_name("sphere parts", tests, set_up, tear_down);
}
