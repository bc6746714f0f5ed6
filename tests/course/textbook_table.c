// The textbook's table is the split sum, by quadrature, and its first column a limit.
#include <kiln/course.h>

#include "kit/context.h"

// The split sum's integrals over the light's hemisphere, by a midpoint rule in the light's own
// angles: nothing of the sampler.
static void table_quadrature(double roughness, double nov, double ab[2])
{
    enum { N = 600 };
    double alpha = roughness * roughness, k = alpha / 2, v[2] = {sqrt(1 - nov * nov), nov};
    ab[0] = ab[1] = 0;
    for (int j = 0; j < N; j++) {
        double theta = pi / 2 * (j + 0.5) / N, nol = cos(theta), s = sin(theta);
        for (int i = 0; i < N; i++) {
            double phi = pi * (i + 0.5) / N; // symmetric
            double l[3] = {s * cos(phi), s * sin(phi), nol};
            double h[3] = {l[0] + v[0], l[1], l[2] + v[1]};
            double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
            double noh = h[2] / length, voh = (v[0] * h[0] + v[1] * h[2]) / length;
            double q = noh * noh * (alpha * alpha - 1) + 1;
            double d = alpha * alpha / (pi * q * q);
            double g = nov / (nov * (1 - k) + k) * nol / (nol * (1 - k) + k);
            double f = pow(1 - voh, 5);
            double part = d * g / (4 * nov) * s * (pi / 2 / N) * (2 * pi / N);
            ab[0] += (1 - f) * part;
            ab[1] += f * part;
        }
    }
}

static void table_is_the_split_sum(void **state)
{
    (void)state;
    enum { SIZE = 11 };
    static const int counts[] = {0, 65536};
    static const double bounds[] = {4e-3, 5e-4};
    for (int k = 0; k < 2; k++) {
        kiln_image table;
        CHECK_OK(kiln_textbook_brdf(context, SIZE, counts[k], &table, &error));
        assert_int_equal(table.channels, 2);
        for (int j = 3; j < SIZE; j += 7 - k)
            for (int i = 1; i < SIZE; i += 3) {
                double ab[2];
                table_quadrature(j / 10.0, i / 10.0, ab);
                const float *texel = table.pixels + 2 * (size_t)((SIZE - 1 - j) * SIZE + i);
                CHECK_NEAR((double)texel[0], ab[0], bounds[k]);
                CHECK_NEAR((double)texel[1], ab[1], bounds[k]);
            }
        // Roughness 0, the last row: nothing is lost, F alone.
        for (int i = 1; i < SIZE; i++) {
            const float *texel = table.pixels + 2 * (size_t)((SIZE - 1) * SIZE + i);
            double f = pow(1 - i / 10.0, 5);
            CHECK_NEAR((double)texel[0], 1 - f, 1e-6);
            CHECK_NEAR((double)texel[1], f, 1e-6);
        }
        // Column 0 is a number, and the limit of its neighbours.
        for (int j = 0; j < SIZE; j++) {
            const float *texel = table.pixels + 2 * (size_t)(j * SIZE);
            for (int c = 0; c < 2; c++)
                assert_true(texel[c] >= 0 && texel[c] <= 1);
        }
        kiln_image_free(&table);
    }
}

static void column_zero_is_the_limit(void **state)
{
    (void)state;
    kiln_image table;
    CHECK_OK(kiln_textbook_brdf(context, 2, 65536, &table, &error));
    // Roughness 1 is row 0. At n.v = 1e-4 the quadrature agrees; the limit itself is 1e-4 away.
    double ab[2];
    table_quadrature(1, 1e-4, ab);
    CHECK_NEAR((double)table.pixels[0], ab[0], 1e-3);
    CHECK_NEAR((double)table.pixels[1], ab[1], 1e-3);
    kiln_image_free(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_is_the_split_sum),
        cmocka_unit_test(column_zero_is_the_limit),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
