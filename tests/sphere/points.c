// Light of suns that is summed over a few points for each sun, compared with a sum over 48 x 48
// points of the sun's texel. Errors are relative to what the sun gives in the lobe's own direction.
#include "sphere/points.h"
#include "math/math.h"
#include "sphere/lobe.h"

#include "kit/context.h"
#include "kit/random.h"

enum { FINE = 48, LANES = 8 };

// Returns the mean weight of the lobe around `direction` over the area of a sun's texel.
static double average(const ki_zonal *zonal, const ki_sun *sun, int size, const double *direction)
{
    double sum = 0, sines = 0, step = KI_PI / size;
    for (int j = 0; j < FINE; j++) {
        double theta = (sun->row + (j + 0.5) / FINE) * step, sine = sin(theta);
        for (int i = 0; i < FINE; i++) {
            double phi = (sun->column + (i + 0.5) / FINE) * step, square = 0;
            const double point[3] = {-sine * sin(phi), cos(theta), sine * cos(phi)};
            for (int c = 0; c < 3; c++)
                square += (point[c] - direction[c]) * (point[c] - direction[c]);
            sum += sine * ki_zonal_weight(zonal, 0.5 * square);
        }
        sines += FINE * sine;
    }
    return sum / sines;
}

// Eight directions within about `spread` of the angle `away` from the sun's centre.
static void aim(const ki_sun *sun, int size, double away, double spread, uint64_t *seed,
                double *directions)
{
    double theta = (sun->row + 0.5) * KI_PI / size, phi = (sun->column + 0.5) * KI_PI / size;
    double turn = 2 * KI_PI * random_number(seed);
    for (int j = 0; j < LANES; j++) {
        double angle = away + spread * (random_number(seed) - 0.5);
        double around = turn + spread * (random_number(seed) - 0.5);
        double x = sin(angle) * cos(around), y = sin(angle) * sin(around), z = cos(angle);
        // x, y and z along the directions of growing theta and phi and of the sun itself
        directions[j] = -(x * cos(theta) + z * sin(theta)) * sin(phi) - y * cos(phi);
        directions[8 + j] = z * cos(theta) - x * sin(theta);
        directions[16 + j] = (x * cos(theta) + z * sin(theta)) * cos(phi) - y * sin(phi);
    }
}

// Returns the greatest error, relative to the peak, in directions whose angles to a sun are `from` to
// `to` radians. Three suns in different rows are tried.
static double greatest_error(const ki_zonal *zonal, int size, double from, double to)
{
    const float radiance[3] = {3, 5, 7};
    double worst = 0, step = KI_PI / size;
    uint64_t seed = 11;
    for (int row = size / 8; row < size; row += size / 3) {
        ki_sun sun = {.row = row, .column = 5 * row % (2 * size)};
        memcpy(sun.radiance, radiance, sizeof radiance);
        kiln_spectrum spectrum = {.context = context, .size = size, .suns = &sun, .sun_count = 1};
        double solid = step * 2 * sin((row + 0.5) * step) * sin(step / 2);
        double peak = solid * ki_zonal_weight(zonal, 0);
        ki_points points;
        CHECK_OK(ki_points_create(&spectrum, zonal, 1, 0, &points, &error));
        for (int i = 0; i <= 24; i++) {
            double directions[3 * LANES], sum[3 * LANES] = {0};
            aim(&sun, size, from + (to - from) * i / 24, 2 * step, &seed, directions);
            ki_points_add(&points, directions, sum);
            for (int j = 0; j < LANES; j++) {
                const double d[3] = {directions[j], directions[8 + j], directions[16 + j]};
                double wanted = solid * average(zonal, &sun, size, d);
                for (int c = 0; c < 3; c++)
                    worst = fmax(worst, fabs(sum[8 * c + j] / (double)radiance[c] - wanted) / peak);
            }
        }
        ki_points_destroy(&points);
    }
    return worst;
}
// Checks the errors of a lobe. At the horizon, where the lobe has a kink, points may miss a part of
// it. Directions whose horizon is more than a texel above the sun see nothing of the sun.
static void check_errors(const ki_zonal *zonal, int size, double horizon)
{
    double step = KI_PI / size;
    CHECK_BELOW(greatest_error(zonal, size, 0, 6 * step), 3e-5);
    CHECK_BELOW(greatest_error(zonal, size, 6 * step, 30 * step), 1e-5);
    CHECK_BELOW(greatest_error(zonal, size, 30 * step, 1.5), 1e-5);
    CHECK_BELOW(greatest_error(zonal, size, KI_PI / 2 - 2 * step, KI_PI / 2 + 2 * step), horizon);
    CHECK_BELOW(greatest_error(zonal, size, KI_PI / 2 + 4 * step, 3.1), 1e-300);
}

static void suns_are_summed_through_single_lobes(void **state)
{
    (void)state;
    static const double alphas[] = {0.02, 0.1, 1};
    for (int i = 0; i < 6; i++) {
        ki_zonal zonal = {.lobe = kiln_lobe_ggx(alphas[i / 2])};
        check_errors(&zonal, 256 << i % 2, 1e-4);
    }
    ki_zonal lambert = {.lobe = kiln_lobe_lambert()};
    check_errors(&lambert, 256, 1e-4);
}

// Through mixtures, four points stand for a sun near the horizon where its texel is small. The
// bound is that of the comment at choose_point_counts.
static void suns_are_summed_through_mixtures(void **state)
{
    (void)state;
    static const double alphas[2][2] = {{0.05, 0.3}, {0.7, 1}},
                        weights[2][2] = {{1.2, -0.2}, {-0.2, 1.2}};
    for (int i = 0; i < 4; i++) {
        static ki_mixture mixture;
        double integrals[2];
        for (int k = 0; k < 2; k++) {
            ki_zonal part = {.lobe = kiln_lobe_ggx(alphas[i / 2][k])};
            ki_zonal_spectrum spectrum;
            CHECK_OK(ki_zonal_analyze(context, &part, 0, 200, &spectrum, &error));
            integrals[k] = spectrum.integral;
            ki_zonal_free(&spectrum);
        }
        ki_mixture_create(&mixture, alphas[i / 2], weights[i / 2], integrals, 2);
        ki_zonal zonal = {.lobe = kiln_lobe_ggx(alphas[i / 2][0]), .mixture = &mixture};
        check_errors(&zonal, 256 << i % 2, 2.2e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(suns_are_summed_through_single_lobes),
        cmocka_unit_test(suns_are_summed_through_mixtures),
    };
    return cmocka_run_group_tests_name("light of suns over points", tests, set_up, tear_down);
}
