// The albedo E, its average E_avg and the split sum's A and B: against integrals over half vectors,
// against closed forms, in a white furnace with Kulla and Conty's lobe, and through tables.
#include "kit/kit.h"
#include "kit/quadrature.h"

#include "brdf/brdf.h"
#include "brdf/energy.h"

enum { MASKINGS = 4 };

static const kiln_model models[MASKINGS] = {{KILN_D_GGX, KILN_G_SMITH},
                                            {KILN_D_GGX, KILN_G_SMITH_UNCORRELATED},
                                            {KILN_D_GGX, KILN_G_SCHLICK_K2},
                                            {KILN_D_GGX, KILN_G_SCHLICK_TEXT}};

// ------------------------------------------------------------------------ the two-dimensional rule

typedef struct point {
    double roughness, nov;
} point;

// The integrands of E and B over half vectors, for each masking. From dl = 4 (v.h) dh, int f (n.l)
// dl is int D G (v.h) / (n.v) dh.
static void densities(const void *user, const half *h, double *x)
{
    const point *p = user;
    double alpha = p->roughness * p->roughness, c = 1 - h->voh;
    // sin_h is more precise than the sine that follows from noh near 1.
    double spread = alpha * alpha * h->noh * h->noh + h->sin_h * h->sin_h;
    double d = alpha * alpha / (pi * spread * spread);
    for (size_t g = 0; g < MASKINGS; g++) {
        double e = d * ki_visibility(&models[g], p->roughness, p->nov, h->nol) * h->nol * h->voh;
        x[2 * g] = e;
        x[2 * g + 1] = e * c * c * c * c * c;
    }
}

static void compare(double roughness, double nov, double *worst)
{
    double sums[2 * MASKINGS] = {0};
    point p = {roughness, nov};
    half_integrate(nov, roughness * roughness, densities, &p, 2 * MASKINGS, sums);
    for (size_t g = 0; g < MASKINGS; g++) {
        double ab[2], e = kiln_energy(&models[g], roughness, nov);
        kiln_energy_split(&models[g], roughness, nov, ab);
        double off = fmax(fabs(e - sums[2 * g]), fabs(ab[1] - sums[2 * g + 1]));
        off = fmax(off, fabs(ab[0] - (sums[2 * g] - sums[2 * g + 1])));
        if (!(off <= 1e-8))
            fail_msg("g %zu, roughness %g, n.v %g: E %.12g and B %.12g, by half vectors %.12g and "
                     "%.12g",
                     g, roughness, nov, e, ab[1], sums[2 * g], sums[2 * g + 1]);
        *worst = fmax(*worst, off);
    }
}

static void agree_with_the_two_dimensional_rule(void **unused)
{
    (void)unused;
    static const double roughness[] = {1e-4, 1e-3, 0.01, 0.05,  0.1,   0.25, 0.5,
                                       0.7,  0.83, 0.84, 0.875, 0.999, 1};
    static const double nov[] = {0,   1e-9, 1e-6, 1e-4,   1e-3,     0.01, 0.1,
                                 0.3, 0.6,  0.9,  0.9999, 1 - 1e-9, 1};
    double worst = 0;
    uint64_t state = 20261124;
    for (size_t i = 0; i < sizeof roughness / sizeof *roughness; i++)
        for (size_t j = 0; j < sizeof nov / sizeof *nov; j++)
            compare(roughness[i], nov[j], &worst);
    for (int i = 0; i < 60; i++)
        compare(random_number(&state), random_number(&state), &worst);
    print_message("E, A and B: largest difference from the two-dimensional rule %.1e\n", worst);
}

// E at roughness 0 and at n.v = 0 is the limit from small roughness and from small n.v.
static void corners_are_limits(void **unused)
{
    (void)unused;
    for (int g = 0; g < MASKINGS; g++) {
        const kiln_model *m = &models[g];
        double k = 1.0 / 8;
        for (int i = 0; i < 14; i++) {
            double nov = 1e-3 * pow(1.7, i);
            double mirror = g == KILN_G_SCHLICK_TEXT ? pow(nov / (nov * (1 - k) + k), 2) : 1;
            double ab[2];
            kiln_energy_split(m, 0, nov, ab);
            CHECK_NEAR(kiln_energy(m, 0, nov), mirror, 1e-15);
            CHECK_NEAR(ab[1], mirror * pow(1 - nov, 5), 1e-15);
            CHECK_NEAR(kiln_energy(m, 1e-9, nov), mirror, 1e-8);
        }
        for (int i = 0; i < 11; i++) {
            double roughness = 1e-5 * pow(3, i), near = 1e-13 * roughness * roughness;
            CHECK_NEAR(kiln_energy(m, roughness, near), kiln_energy(m, roughness, 0), 1e-10);
        }
        // Roughness so small that alpha^2 underflows.
        for (int i = 0; i < 22; i++)
            for (int j = 0; j < 29; j++) {
                double roughness = pow(7, -i), nov = pow(11, -j);
                double e = kiln_energy(m, roughness, nov);
                assert_true(e >= 0 && e <= 1 + 1e-11);
            }
    }
    CHECK_NEAR(kiln_energy(&models[0], (double)NAN, (double)NAN), kiln_energy(&models[0], 0, 0), 0);
    CHECK_NEAR(kiln_energy(&models[0], -1, 2), kiln_energy(&models[0], 0, 1), 0);
}

static void roughness_one_is_known_in_closed_form(void **unused)
{
    (void)unused;
    double rest = 1 - log(2);
    for (int g = 0; g < MASKINGS; g++) {
        CHECK_NEAR(kiln_energy(&models[g], 1, 1), rest, 1e-12);
        double average = g == KILN_G_SMITH ? 4 * rest / 3 : 4 * rest * rest;
        CHECK_NEAR(kiln_energy_average(&models[g], 1), average, 1e-10);
    }
}

// ----------------------------------------------------------------------------------------- average

typedef struct mean {
    const kiln_model *model;
    double roughness;
} mean;

// The integrand of E_avg after the substitution nov = x^3, which makes nodes dense at grazing
// angles.
static double mean_density(void *data, double x)
{
    const mean *m = data;
    return 2 * kiln_energy(m->model, m->roughness, x * x * x) * x * x * x * 3 * x * x;
}

static void average_is_the_mean_over_the_cosine(void **unused)
{
    (void)unused;
    static const double roughness[] = {0, 0.003, 0.03, 0.1, 0.3, 0.6, 0.9, 1};
    for (int g = 0; g < MASKINGS; g++)
        for (size_t i = 0; i < sizeof roughness / sizeof *roughness; i++) {
            mean m = {&models[g], roughness[i]};
            CHECK_NEAR(kiln_energy_average(m.model, m.roughness),
                       integrate(mean_density, &m, 0, 1, 12), 1e-10);
        }
}

// ----------------------------------------------------------------------------------------- furnace

typedef struct furnace {
    const kiln_model *model;
    const kiln_table *table, *average; // NULL: exact values from kiln_energy and
                                       // kiln_energy_average
    double roughness, nov;
} furnace;

static double energy_of(const furnace *f, double nov)
{
    double e;
    if (!f->table)
        return kiln_energy(f->model, f->roughness, nov);
    kiln_table_lookup(f->table, nov, f->roughness, 0, &e);
    return e;
}

static double average_of(const furnace *f)
{
    double e;
    if (!f->average)
        return kiln_energy_average(f->model, f->roughness);
    kiln_table_lookup(f->average, 0, f->roughness, 0, &e);
    return e;
}

static double added_light(void *data, double x)
{
    const furnace *f = data;
    double nol = x * x * x;
    double lobe = kiln_kulla_conty(energy_of(f, f->nov), energy_of(f, nol), average_of(f));
    return lobe * nol * 2 * pi * 3 * x * x;
}

// In a white environment, the specular lobe with F = 1 and Kulla and Conty's lobe together return
// all light. Returns the absolute error.
static double furnace_error(furnace *f)
{
    double single = kiln_energy(f->model, f->roughness, f->nov);
    return fabs(single + integrate(added_light, f, 0, 1, 12) - 1);
}

static void furnace_closes(void **unused)
{
    (void)unused;
    double worst = 0;
    for (int g = 0; g < MASKINGS; g++)
        for (int i = 0; i < 13; i++)
            for (int j = 0; j < 7; j++) {
                furnace f = {
                    .model = &models[g], .roughness = 0.04 + 0.08 * i, .nov = 0.001 * pow(3, j)};
                worst = fmax(worst, furnace_error(&f));
            }
    print_message("furnace: exact to %.1e\n", worst);
    CHECK_BELOW(worst, 1e-10);
}

static void make(kiln_context *context, const kiln_table_def *def, kiln_table *table)
{
    kiln_error error;
    CHECK_OK(kiln_table_create(context, def, table, &error));
}

static void furnace_closes_through_a_table(void **unused)
{
    (void)unused;
    kiln_context *context = make_context(0);
    kiln_error error;
    for (int g = 0; g < MASKINGS; g++) {
        kiln_table_def def = {
            .model = models[g], .axis = KILN_AXIS_GRAZING, .corners = true, .complement = true};
        kiln_table table, average;
        make(context, &def, &table);
        CHECK_OK(kiln_table_average(context, &table, 0, &average, &error));
        double worst = 0;
        for (int i = 0; i < 26; i++)
            for (int j = 0; j < 17; j++) {
                furnace f = {&models[g], &table, &average, 0.04 + 0.0371 * i, 0.0005 * pow(1.6, j)};
                worst = fmax(worst, furnace_error(&f));
            }
        print_message("furnace through 128 x 128 texels, g %d: %.1e\n", g, worst);
        CHECK_BELOW(worst, 1e-3);
        kiln_table_free(&average);
        kiln_table_free(&table);
    }
    kiln_context_destroy(context);
}

// ------------------------------------------------------------------------------------------ tables

static void texels_are_the_integrals(void **unused)
{
    (void)unused;
    kiln_context *context = make_context(0);
    for (int i = 0; i < 4 * 2 * 2 * 3; i++) {
        kiln_table_def def = {.kind = (kiln_table_kind)(i % 3),
                              .model.g = (kiln_g)(i % 4),
                              .axis = (kiln_axis)(i / 12),
                              .corners = i & 1,
                              .flip = (i >> 1) & 1,
                              .width = 37,
                              .height = 20};
        kiln_table table;
        make(context, &def, &table);
        for (int y = 0; y < table.def.height; y++)
            for (int x = 0; x < table.def.width; x++) {
                double nov, roughness, third, value[2] = {0}, wanted[2] = {0};
                kiln_table_texel(&table, x, y, 0, &nov, &roughness, &third);
                kiln_table_lookup(&table, nov, roughness, third, value);
                if (def.kind == KILN_TABLE_DFG)
                    kiln_energy_split(&def.model, roughness, nov, wanted);
                else
                    wanted[0] = def.kind == KILN_TABLE_E
                                    ? kiln_energy(&def.model, roughness, nov)
                                    : kiln_energy_average(&def.model, roughness);
                for (int c = 0; c < table.image.channels; c++) {
                    int at = (y * table.def.width + x) * table.image.channels + c;
                    CHECK_NEAR((double)table.image.pixels[at], wanted[c], 6e-8);
                    // Below the least roughness of the grazing axis, a row's texels belong to
                    // another roughness than the lookup's.
                    if (roughness > 1e-3)
                        CHECK_NEAR(value[c], wanted[c], 1e-7);
                }
            }
        kiln_table_free(&table);
    }
    kiln_context_destroy(context);
}

// Large tables of E are computed by a Chebyshev series and not texel by texel.
static void large_tables_are_the_integrals_too(void **unused)
{
    (void)unused;
    kiln_context *context = make_context(0);
    for (int i = 0; i < 4 * MASKINGS; i++) {
        kiln_table_def def = {.model = models[i % MASKINGS],
                              .axis = (kiln_axis)(i / MASKINGS),
                              .corners = true,
                              .width = 211,
                              .height = 127};
        kiln_table table;
        double worst = 0;
        make(context, &def, &table);
        for (int at = 0; at < def.width * def.height; at++) {
            double nov, roughness, third;
            kiln_table_texel(&table, at % def.width, at / def.width, 0, &nov, &roughness, &third);
            double e = kiln_energy(&def.model, roughness, nov);
            worst = fmax(worst, fabs((double)table.image.pixels[at] - e));
        }
        CHECK_BELOW(worst, 1e-7);
        kiln_table_free(&table);
    }
    kiln_context_destroy(context);
}

static void same_bits_on_every_instruction_set(void **unused)
{
    (void)unused;
    static const kiln_cpu cpus[] = {KILN_CPU_SCALAR, KILN_CPU_SSE2, KILN_CPU_AVX2, KILN_CPU_AVX512};
    for (int kind = KILN_TABLE_E; kind <= KILN_TABLE_DFG; kind++)
        for (int g = 0; g < MASKINGS; g++) {
            kiln_table first = {0};
            for (size_t i = 0; i < sizeof cpus / sizeof *cpus; i++) {
                kiln_context *context = make_context_for(1 + (int)i, cpus[i]);
                kiln_table_def def = {.kind = (kiln_table_kind)kind, .model = models[g]};
                kiln_table table;
                make(context, &def, &table);
                size_t size = sizeof(float) * (size_t)table.image.width *
                              (size_t)table.image.height * (size_t)table.image.channels;
                if (i == 0) {
                    first.image.pixels = malloc(size);
                    assert_non_null(first.image.pixels);
                    memcpy(first.image.pixels, table.image.pixels, size);
                }
                assert_memory_equal(first.image.pixels, table.image.pixels, size);
                kiln_table_free(&table);
                kiln_context_destroy(context);
            }
            free(first.image.pixels);
        }
}

static void wrong_tables_are_named(void **unused)
{
    (void)unused;
    static const struct {
        kiln_table_def def;
        const char *says;
    } wrong[] = {
        {{.kind = (kiln_table_kind)99}, "kind of the table is 99"},
        {{.model.g = (kiln_g)7}, "the model has d 0 and g 7"},
        {{.axis = (kiln_axis)5}, "axis of the table is 5"},
        {{.width = 5000}, "width of the table is 5000, it must be 1 to 4096"},
        {{.height = -1}, "height of the table is -1"},
        {{.depth = 4}, "depth of the table is 4, it must be 1"},
        {{.kind = KILN_TABLE_DFG, .complement = true}, "this kind of table has 2"},
        {{.kind = KILN_TABLE_E_WALK, .axis = KILN_AXIS_CBRT},
         "it must be 3, or 0, for a table of random walks"},
    };
    kiln_context *context = make_context(0);
    kiln_error error;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        kiln_table table;
        assert_int_equal(kiln_table_create(context, &wrong[i].def, &table, &error),
                         KILN_ERROR_ARGUMENT);
        assert_null(table.image.pixels);
        if (!strstr(error.message, wrong[i].says))
            fail_msg("'%s' does not say '%s'", error.message, wrong[i].says);
    }
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agree_with_the_two_dimensional_rule),
        cmocka_unit_test(corners_are_limits),
        cmocka_unit_test(roughness_one_is_known_in_closed_form),
        cmocka_unit_test(average_is_the_mean_over_the_cosine),
        cmocka_unit_test(furnace_closes),
        cmocka_unit_test(furnace_closes_through_a_table),
        cmocka_unit_test(texels_are_the_integrals),
        cmocka_unit_test(large_tables_are_the_integrals_too),
        cmocka_unit_test(same_bits_on_every_instruction_set),
        cmocka_unit_test(wrong_tables_are_named),
    };
    return cmocka_run_group_tests_name("energy", tests, NULL, NULL);
}
