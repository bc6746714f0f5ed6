// Samplers draw directions with the densities that the pdf functions return: the samples in bins of
// the sphere are compared with integrals of the pdf over the bins.
#include "kit/kit.h"

#include "brdf/brdf.h"

enum { DISTRIBUTIONS = KILN_D_BECKMANN + 1 };

enum { ROWS = 12, COLUMNS = 16, BINS = ROWS * COLUMNS, SAMPLES = 200000, CELLS = 64 };

typedef struct sampler {
    void (*sample)(const struct sampler *s, const double xi[2], double w[3]);
    double (*pdf)(const struct sampler *s, const double w[3]);
    double roughness, v[3];
    kiln_d d;
    // true: bins cover the whole sphere, uniform in z. false: bins cover the upper hemisphere,
    // uniform in y with tan^2 theta = alpha^2 (1 / t - 1), t = (1 - y)^2.
    bool sphere;
    double area; // integral of the density before it is divided by `area`
} sampler;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The cosine z to the normal at the coordinate y in [0, 1] of the bins. Sets *slope to |dz / dy|.
static double place(const sampler *s, double y, double *slope)
{
    if (s->sphere) {
        *slope = 2;
        return 1 - 2 * y;
    }
    double a2 = pow(s->roughness, 4), t = (1 - y) * (1 - y), d = t + a2 * (1 - t);
    *slope = a2 / (d * sqrt(d));
    return (1 - y) / sqrt(d);
}

static double place_of(const sampler *s, double z)
{
    if (s->sphere)
        return (1 - z) / 2;
    double t = (1 - z) * (1 + z) / (z * z), a2 = pow(s->roughness, 4);
    return 1 - sqrt(a2 / (a2 + t));
}

// Sets share[] to the integral of the pdf over each bin, by the midpoint rule. Returns the sum of
// all shares.
static double expected_shares(const sampler *s, double share[BINS])
{
    double total = 0;
    for (int bin = 0; bin < BINS; bin++) {
        int row = bin / COLUMNS, column = bin % COLUMNS;
        share[bin] = 0;
        for (int i = 0; i < CELLS; i++)
            for (int j = 0; j < CELLS; j++) {
                double slope, y = (row + (i + 0.5) / CELLS) / ROWS;
                double phi = 2 * pi * (column + (j + 0.5) / CELLS) / COLUMNS;
                double z = place(s, y, &slope), sine = sqrt(1 - z * z);
                double w[3] = {sine * cos(phi), sine * sin(phi), z};
                share[bin] += s->pdf(s, w) * slope * 2 * pi / (BINS * CELLS * CELLS);
            }
        total += share[bin];
    }
    return total;
}

// Checks a sampler by Pearson's chi^2 test. If the density is right, chi^2 of K bins has the mean K
// - 1 and the variance 2 (K - 1). Bins in which fewer than 20 samples are expected are combined
// into one.
static void check_sampler(const sampler *s, double bound)
{
    static double share[BINS];
    static int count[BINS];
    memset(count, 0, sizeof count);
    CHECK_NEAR(expected_shares(s, share), 1, bound);
    uint64_t random = 88172645463325252u;
    for (int i = 0; i < SAMPLES; i++) {
        double xi[2], w[3];
        xi[0] = random_number(&random);
        xi[1] = random_number(&random);
        s->sample(s, xi, w);
        CHECK_NEAR(dot(w, w), 1, 1e-12);
        double phi = atan2(w[1], w[0]) / (2 * pi);
        int row = (int)(place_of(s, w[2]) * ROWS), column = (int)((phi + (phi < 0)) * COLUMNS);
        count[(row < ROWS ? row : ROWS - 1) * COLUMNS + (column < COLUMNS ? column : 0)]++;
    }
    double chi = 0, rare = 0;
    int bins = 1, rare_count = 0;
    for (int bin = 0; bin < BINS; bin++) {
        double wanted = share[bin] * SAMPLES;
        if (wanted < 20) {
            rare += wanted;
            rare_count += count[bin];
            continue;
        }
        chi += (count[bin] - wanted) * (count[bin] - wanted) / wanted;
        bins++;
    }
    chi += (rare_count - rare) * (rare_count - rare) / (rare + 1);
    assert_true(bins > 10);
    CHECK_BELOW(chi, bins - 1 + 5 * sqrt(2.0 * (bins - 1)));
}

// ----------------------------------------------------------------------------------------- cosine

static void sample_cosine(const sampler *s, const double xi[2], double w[3])
{
    (void)s;
    kiln_sample_cosine(xi, w);
}

static double pdf_cosine(const sampler *s, const double w[3])
{
    (void)s;
    return kiln_pdf_cosine(w[2]);
}

static void cosine(void **state)
{
    (void)state;
    check_sampler(&(sampler){.sample = sample_cosine, .pdf = pdf_cosine, .roughness = 1}, 1e-12);
}

// ------------------------------------------------------------------------------------ half vectors

static void sample_half(const sampler *s, const double xi[2], double w[3])
{
    kiln_sample_half_vector(s->d, s->roughness, xi, w);
}

static double pdf_half(const sampler *s, const double w[3])
{
    return kiln_pdf_half_vector(s->d, s->roughness, w[2]);
}

static void half_vectors(void **state)
{
    (void)state;
    for (int i = 0; i < DISTRIBUTIONS; i++)
        for (int r = 1; r <= 5; r++)
            check_sampler(&(sampler){.sample = sample_half,
                                     .pdf = pdf_half,
                                     .roughness = r / 5.0,
                                     .d = i ? KILN_D_BECKMANN : KILN_D_GGX},
                          i ? 1e-5 : 1e-11);
}

// --------------------------------------------------------------------------------- visible normals

static void sample_visible(const sampler *s, const double xi[2], double w[3])
{
    kiln_sample_visible(s->roughness, s->v, xi, w);
}

static double pdf_visible(const sampler *s, const double w[3])
{
    return kiln_pdf_visible(s->roughness, s->v[2], w[2], dot(s->v, w));
}

static void sample_reflection(const sampler *s, const double xi[2], double w[3])
{
    double h[3];
    kiln_sample_visible(s->roughness, s->v, xi, h);
    for (int c = 0; c < 3; c++)
        w[c] = 2 * dot(s->v, h) * h[c] - s->v[c];
}

static double pdf_reflection(const sampler *s, const double w[3])
{
    double h[3] = {s->v[0] + w[0], s->v[1] + w[1], s->v[2] + w[2]}, length = sqrt(dot(h, h));
    for (int c = 0; c < 3; c++)
        h[c] /= length;
    double voh = dot(s->v, h);
    return h[2] > 0 ? kiln_pdf_reflection(pdf_visible(s, h), voh) : 0;
}

static void visible_normals(void **state)
{
    (void)state;
    static const double cosines[] = {1, 0.8, 0.4, 0.1, 0.01, 0};
    for (int i = 0; i < 6; i++)
        for (int r = 1; r <= 5; r += 2) {
            double z = cosines[i], sine = sqrt(1 - z * z);
            sampler s = {.sample = sample_visible,
                         .pdf = pdf_visible,
                         .roughness = r / 5.0,
                         .v = {0.6 * sine, -0.8 * sine, z}};
            check_sampler(&s, 1e-3); // the density has an edge at v.h = 0
            s.sample = sample_reflection;
            s.pdf = pdf_reflection;
            s.sphere = true;
            if (r >= 3)
                check_sampler(&s, 1e-2);
        }
}

// For a view from below, as of rays that go up inside the microsurface, visible normals have the
// density max(v.h, 0) D(h), divided by its integral.
static void sample_below(const sampler *s, const double xi[2], double w[3])
{
    ki_sample_visible(s->roughness * s->roughness, s->v, xi, w);
}

static double pdf_below(const sampler *s, const double w[3])
{
    return fmax(dot(s->v, w), 0) * kiln_brdf_d(KILN_D_GGX, s->roughness, w[2]) / s->area;
}

static void normals_seen_from_below(void **state)
{
    (void)state;
    static const double cosines[] = {0, -0.1, -0.5, -0.9};
    static double share[BINS];
    for (int i = 0; i < 4; i++)
        for (int r = 3; r <= 5; r++) {
            double z = cosines[i], sine = sqrt(1 - z * z);
            sampler s = {.sample = sample_below,
                         .pdf = pdf_below,
                         .roughness = r / 5.0,
                         .v = {0.6 * sine, -0.8 * sine, z},
                         .area = 1};
            s.area = expected_shares(&s, share);
            // The integral is the projected area cos theta (1 + Lambda(v)) of the microfacets that
            // v sees, where Lambda(v) + Lambda(-v) = -1.
            double a2 = pow(s.roughness, 4);
            CHECK_NEAR(s.area, (z + sqrt(z * z + a2 * (1 - z * z))) / 2, 1e-3 * s.area);
            check_sampler(&s, 1e-12);
        }
}

// At roughness 0 every sampled half vector is the normal.
static void mirrors(void **state)
{
    (void)state;
    double v[3] = {0.6, 0, 0.8}, h[3], xi[2] = {0.3, 0.9};
    for (int i = 0; i < 2; i++) {
        kiln_sample_half_vector(i ? KILN_D_BECKMANN : KILN_D_GGX, 0, xi, h);
        assert_true(h[0] == 0 && h[1] == 0 && h[2] == 1);
    }
    kiln_sample_visible(0, v, xi, h);
    assert_true(h[0] == 0 && h[1] == 0 && h[2] == 1);
    kiln_sample_visible(0, (double[]){1, 0, 0}, xi, h);
    assert_true(h[0] == 0 && h[1] == 0 && h[2] == 1);
    // A random number of 1, which generators of floats return by rounding, does no harm.
    kiln_sample_half_vector(KILN_D_BECKMANN, 0.5, (double[]){1, 1}, h);
    CHECK_NEAR(h[0] * h[0] + h[1] * h[1] + h[2] * h[2], 1, 1e-14);
    assert_true(kiln_pdf_visible(0, 0.8, 0.9, 0.7) == 0 && kiln_pdf_half_vector(0, 0, 0.5) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cosine),          cmocka_unit_test(half_vectors),
        cmocka_unit_test(visible_normals), cmocka_unit_test(normals_seen_from_below),
        cmocka_unit_test(mirrors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
