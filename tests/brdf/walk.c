// The random walk between microfacets conserves energy, is reciprocal, agrees with the exact albedo
// of a single bounce, and returns a correct standard error.
#include "kit/kit.h"

#include "brdf/walk.h"

static const double roughnesses[] = {0.05, 0.25, 0.5, 0.75, 1};
static const double cosines[] = {0, 0.01, 0.1, 0.3, 0.6, 1};

enum { R = 5, MU = 6 };

static kiln_walk walk(kiln_walk_def def, double roughness, double nov)
{
    kiln_walk w;
    kiln_walk_albedo(&def, roughness, nov, &w);
    return w;
}

// All light returns if nothing absorbs: with F = 1, with Schlick's F of f0 = 1, and from a
// conductor with a very large k.
static void white_furnace_stays_white(void **state)
{
    (void)state;
    static const double r[] = {0, 1e-60, 1e-8, 0.01, 0.3, 1}, mu[] = {0, 1e-12, 1e-3, 0.5, 1};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 5; j++) {
            kiln_walk_def def = {.fresnel = KILN_WALK_CONSTANT, .f0 = 1, .path_count = 1024};
            kiln_walk w = walk(def, r[i], mu[j]);
            CHECK_NEAR(w.albedo, 1, 1e-14);
            CHECK_NEAR(w.standard_error, 0, 1e-14);
            double sum = 0;
            for (int b = 0; b < KILN_WALK_BOUNCES; b++)
                sum += w.bounce[b];
            CHECK_NEAR(sum, w.albedo, 1e-14);
            def.fresnel = KILN_WALK_SCHLICK;
            CHECK_NEAR(walk(def, r[i], mu[j]).albedo, 1, 1e-14);
            def.fresnel = KILN_WALK_CONDUCTOR;
            def.k = 1e8;
            CHECK_NEAR(walk(def, r[i], mu[j]).albedo, 1, 1e-13);
        }
}

// Sets *mean and *deviation to the mean and the standard deviation of the albedo over SEEDS seeds,
// or with `single` of the first bounce's share.
enum { SEEDS = 16 };

static void over_seeds(kiln_walk_def def, double roughness, double nov, bool single, double *mean,
                       double *deviation)
{
    double x[SEEDS], square = 0;
    *mean = 0;
    for (int i = 0; i < SEEDS; i++) {
        def.seed = 100 + (uint32_t)i;
        kiln_walk w = walk(def, roughness, nov);
        x[i] = single ? w.bounce[0] : w.albedo;
        *mean += x[i] / SEEDS;
    }
    for (int i = 0; i < SEEDS; i++)
        square += (x[i] - *mean) * (x[i] - *mean);
    *deviation = sqrt(square / (SEEDS - 1));
}

// The first bounce has the exact albedo, E for F = 1 and f0 A + B for Schlick's F, within four
// standard errors. By Student's t of 15 degrees of freedom a correct value misses that once in 900.
// If fewer than 16 of all N paths have a second bounce, the error is that of a Poisson
// distribution.
static void single_bounce_is_the_exact_albedo(void **state)
{
    (void)state;
    const kiln_model model = {0};
    double worst = 0;
    for (int i = 0; i < R; i++)
        for (int j = 0; j < MU; j++) {
            double r = roughnesses[i], nov = cosines[j], ab[2], mean, deviation;
            kiln_energy_split(&model, r, nov, ab);
            kiln_walk_def white = {.fresnel = KILN_WALK_CONSTANT, .f0 = 1, .path_count = 4096};
            over_seeds(white, r, nov, true, &mean, &deviation);
            double paths = 4096.0 * SEEDS, missing = fabs(1 - (ab[0] + ab[1]));
            double rare = missing < 16 / paths ? sqrt(missing / paths) : 0;
            CHECK_NEAR(mean, ab[0] + ab[1], 4 * (deviation / sqrt(SEEDS) + rare) + 1e-14);
            worst = fmax(worst, fabs(mean - (ab[0] + ab[1])));
            over_seeds((kiln_walk_def){.f0 = 0.2, .path_count = 4096}, r, nov, true, &mean,
                       &deviation);
            CHECK_NEAR(mean, 0.2 * ab[0] + ab[1], 4 * (deviation / sqrt(SEEDS) + rare) + 1e-7);
        }
    printf("single bounce against the exact E, 65536 paths: %.1e at worst\n", worst);
    CHECK_BELOW(worst, 1e-3);
}

// standard_error agrees with the standard deviation of the albedo over seeds.
static void standard_error_is_honest(void **state)
{
    (void)state;
    double spread = 0, said = 0;
    for (int i = 1; i < R; i++)
        for (int j = 1; j < MU; j++) {
            kiln_walk_def def = {.f0 = 0.4, .path_count = 2048};
            double mean, deviation;
            over_seeds(def, roughnesses[i], cosines[j], false, &mean, &deviation);
            spread += deviation * deviation;
            for (uint32_t s = 0; s < SEEDS; s++) {
                def.seed = s;
                double e = walk(def, roughnesses[i], cosines[j]).standard_error;
                said += e * e / SEEDS;
            }
        }
    // 20 settings with 15 degrees of freedom each: the ratio has a standard deviation of 8 %.
    CHECK_NEAR(spread / said, 1, 0.4);
}

// A constant F = f multiplies the light of the n-th bounce by f^n, because a walk's angles do not
// depend on F.
static void bounces_scale_with_constant_f(void **state)
{
    (void)state;
    kiln_walk_def def = {.fresnel = KILN_WALK_CONSTANT, .f0 = 1, .path_count = 4096};
    kiln_walk one = walk(def, 0.9, 0.4);
    def.f0 = 0.7;
    kiln_walk f = walk(def, 0.9, 0.4);
    for (int b = 0; b < KILN_WALK_BOUNCES - 1; b++)
        CHECK_NEAR(f.bounce[b], pow(0.7, b + 1) * one.bounce[b], 1e-14);
    assert_true(one.bounce[0] > one.bounce[1] && one.bounce[2] > one.bounce[9]);
}

static void albedo_grows_with_f0(void **state)
{
    (void)state;
    for (int i = 0; i < R; i++)
        for (int j = 0; j < MU; j++) {
            double last = 0, ab[2];
            kiln_energy_split(&(kiln_model){0}, roughnesses[i], cosines[j], ab);
            for (int k = 0; k <= 10; k++) {
                kiln_walk_def def = {.f0 = k / 10.0, .path_count = 1024};
                kiln_walk w = walk(def, roughnesses[i], cosines[j]);
                assert_true(w.albedo > last && w.albedo <= 1 + 1e-14);
                assert_true(w.albedo >= w.bounce[0]);
                last = w.albedo;
            }
        }
    // At roughness 0 there is one bounce.
    kiln_walk w = walk((kiln_walk_def){.f0 = 0.3}, 0, 0.5);
    CHECK_NEAR(w.albedo, kiln_fresnel_schlick(0.3, 0.5), 0);
    assert_true(w.standard_error == 0 && w.bounce[1] == 0);
    assert_int_equal(walk((kiln_walk_def){.path_count = 1}, 0.5, 0.5).path_count, 32);
    assert_int_equal(walk((kiln_walk_def){.path_count = 1025}, 0.5, 0.5).path_count, 2048);
}

// The flux from one band of directions to another equals the flux back, for the first bounce and
// for all later bounces. Bands are equal in mu^2; n.v = mu is drawn with the density 2 mu, as in
// diffuse light.
static void walks_are_reciprocal(void **state)
{
    (void)state;
    enum { BANDS = 5, PATHS = 400000 };
    static const double alphas[] = {0.1, 0.5, 1};
    for (int a = 0; a < 3; a++) {
        double flux[BANDS][BANDS][2] = {{{0}}}, square[BANDS][BANDS] = {{0}};
        uint64_t random = 0x9e3779b97f4a7c15u;
        for (int i = 0; i < PATHS; i++) {
            double y = random_number(&random);
            int from = (int)(y * BANDS);
            ki_ray ray = ki_walk_enter(alphas[a], sqrt(y), random_number(&random));
            for (int bounce = 0; ray.inside > 0; bounce++) {
                double xi[3];
                for (int c = 0; c < 3; c++)
                    xi[c] = random_number(&random);
                (void)ki_walk_bounce(alphas[a], xi, &ray);
                double leaves = ki_walk_on(alphas[a], xi[2], &ray);
                int to = (int)(fmax(ray.cosine, 0) * fmax(ray.cosine, 0) * BANDS);
                to = to < BANDS ? to : BANDS - 1;
                flux[from][to][bounce > 0] += leaves / PATHS;
                if (bounce > 0)
                    square[from][to] += leaves * leaves / PATHS;
            }
        }
        for (int i = 0; i < BANDS; i++)
            for (int j = 0; j < i; j++) {
                // A path can add light to a band several times. The variance of one addition is
                // therefore doubled.
                double many = sqrt(2 * (square[i][j] + square[j][i]) / PATHS);
                CHECK_NEAR(flux[i][j][1], flux[j][i][1], 4 * many);
                double one = sqrt((flux[i][j][0] + flux[j][i][0]) / PATHS);
                CHECK_NEAR(flux[i][j][0], flux[j][i][0], 4 * one);
            }
    }
}

// The results are bit-identical for every compiler and instruction set.
static void bits_are_the_same_everywhere(void **state)
{
    (void)state;
    kiln_walk_def def = {.f0 = 0.4, .path_count = 8192, .seed = 3};
    kiln_walk w = walk(def, 0.8, 0.3);
    CHECK_NEAR(w.albedo, 0.34402024545172366, 0);
    CHECK_NEAR(w.standard_error, 0.00023440542660087366, 0);
    CHECK_NEAR(w.bounce[3], 0.00037945916449243347, 0);
    def.fresnel = KILN_WALK_CONDUCTOR;
    def.n = 0.2;
    def.k = 3;
    CHECK_NEAR(walk(def, 0.3, 0.05).albedo, 0.9415966679090807, 0);
}

// ki_walk_column agrees with kiln_walk_albedo of each f0.
static void columns_agree_with_walks(void **state)
{
    (void)state;
    static const double f0[] = {0, 0.04, 0.5, 0.9, 1};
    for (int i = 0; i < R; i++)
        for (int j = 0; j < MU; j++) {
            double column[5], again[5], ab[2];
            kiln_energy_split(&(kiln_model){0}, roughnesses[i], cosines[j], ab);
            ki_walk_column(roughnesses[i], cosines[j], f0, 5, 16384, 1, column);
            for (int k = 0; k < 5; k++) {
                kiln_walk w = walk((kiln_walk_def){.f0 = f0[k], .path_count = 16384, .seed = 2},
                                   roughnesses[i], cosines[j]);
                // The tolerance allows for the errors of both, of which the column's is smaller.
                CHECK_NEAR(f0[k] * ab[0] + ab[1] + column[k], w.albedo,
                           5 * sqrt(2) * w.standard_error + 1e-5);
            }
            CHECK_NEAR(ab[0] + ab[1] + column[4], 1, 1e-14);
            ki_walk_column(roughnesses[i], cosines[j], f0, 5, 16384, 1, again);
            assert_memory_equal(column, again, sizeof column);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_stays_white),
        cmocka_unit_test(single_bounce_is_the_exact_albedo),
        cmocka_unit_test(standard_error_is_honest),
        cmocka_unit_test(bounces_scale_with_constant_f),
        cmocka_unit_test(albedo_grows_with_f0),
        cmocka_unit_test(walks_are_reciprocal),
        cmocka_unit_test(bits_are_the_same_everywhere),
        cmocka_unit_test(columns_agree_with_walks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
