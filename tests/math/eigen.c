// Eigenvalues and axes of constructed symmetric matrices are found.
#include "kit/kit.h"

#include "math/math.h"

static uint64_t seed = 1;

// A diagonal matrix with known eigenvalues is multiplied from both sides by random reflections. The
// function returns the eigenvalues, and unit vectors that are eigenvectors of the matrix.
static void axes_of_symmetric_matrices(void **unused)
{
    (void)unused;
    enum { COUNT = 34 };
    static double a[COUNT][COUNT], original[COUNT][COUNT], axes[COUNT][COUNT], values[COUNT];
    // The eigenvalues fall from 1 to 1e-8.
    for (int i = 0; i < COUNT; i++)
        a[i][i] = pow(10, -8.0 * i / (COUNT - 1));
    for (int turn = 0; turn < 20; turn++) {
        double v[COUNT], norm2 = 0;
        for (int i = 0; i < COUNT; i++) {
            v[i] = random_between(&seed, -0.5, 0.5);
            norm2 += v[i] * v[i];
        }
        for (int side = 0; side < 2; side++)
            for (int i = 0; i < COUNT; i++) {
                double dot = 0;
                for (int k = 0; k < COUNT; k++)
                    dot += 2 / norm2 * v[k] * (side ? a[i][k] : a[k][i]);
                for (int k = 0; k < COUNT; k++)
                    *(side ? &a[i][k] : &a[k][i]) -= dot * v[k];
            }
    }
    memcpy(original, a, sizeof a);
    ki_symmetric_axes(COUNT, &a[0][0], &axes[0][0], values);
    for (int i = 0; i < COUNT; i++) {
        double nearest = 1;
        for (int k = 0; k < COUNT; k++) {
            double dot = 0, product = 0;
            for (int j = 0; j < COUNT; j++) {
                dot += axes[i][j] * axes[k][j];
                product += original[k][j] * axes[i][j];
            }
            CHECK_NEAR(dot, i == k, 1e-13);
            CHECK_NEAR(product, values[i] * axes[i][k], 1e-14);
            nearest = fmin(nearest, fabs(values[i] - pow(10, -8.0 * k / (COUNT - 1))));
        }
        CHECK_NEAR(nearest, 0, 1e-13);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axes_of_symmetric_matrices),
    };
    return cmocka_run_group_tests_name("math", tests, NULL, NULL);
}
