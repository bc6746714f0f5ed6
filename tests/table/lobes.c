// Tables of lobes: what their taps and coefficients promise, against brute-force sums over the true
// lobe.
#include "math/math.h"
#include "table/table_text.h"

#include "kit/context.h"
#include "kit/stopping.h"

#include <math.h>

enum { SIZE = 10 };

// Tables with 1, 2 and 3 taps. That of two taps has uncorrelated masking.
static kiln_table tables[4];

static kiln_table make(int taps)
{
    static const float roughness[] = {0.05f, 0.3f, 0.55f, 0.8f, 1};
    kiln_table table;
    kiln_table_def def = {.kind = KILN_TABLE_LOBES,
                          .model.g = taps == 2 ? KILN_G_SMITH_UNCORRELATED : KILN_G_SMITH,
                          .width = SIZE,
                          .height = SIZE,
                          .tap_count = taps,
                          .level_count = 5};
    memcpy(def.level_roughness, roughness, sizeof roughness);
    CHECK_OK(kiln_table_create(context, &def, &table, &error));
    return table;
}

// Reads the taps (lean, level, weight) and the coefficients c10, c11, c20, c21, c22 and c00.
static void read(const kiln_table *table, double nov, double roughness, double (*tap)[3],
                 double *coefficient)
{
    double values[16], list[7];
    int taps = table->def.tap_count;
    kiln_table_lookup(table, nov, roughness, 0, values);
    for (int i = 0; i < taps; i++) {
        memcpy(tap[i], values + 4 * i, sizeof tap[i]);
        list[i] = values[4 * i + 3];
    }
    memcpy(list + taps, values + 4 * taps, 4 * sizeof *list);
    memcpy(coefficient, list, 5 * sizeof *coefficient);
    coefficient[5] = 1; // is stored only where there is room
    for (int i = 0; i < taps; i++)
        coefficient[5] -= tap[i][2];
    if (taps > 1)
        CHECK_NEAR(list[5], coefficient[5], 2e-7);
}

// Bands 1 and 2 of light weighted by a direction (x, y, z).
static void add_bands(double weight, double x, double y, double z, double *bands)
{
    bands[0] += weight * z;
    bands[1] += weight * x;
    bands[2] += weight * (1.5 * z * z - 0.5);
    bands[3] += weight * 2 * x * z;
    bands[4] += weight * 0.5 * (x * x - y * y);
}

// The true lobe's bands, by a product of Gauss rules over the hemisphere.
static void true_bands(const kiln_model *model, double roughness, double nov, double *bands)
{
    enum { RINGS = 160, SPOKES = 320 };
    static double node[RINGS], weight[RINGS];
    double v[3] = {-sqrt(1 - nov * nov), 0, nov}, sum = 0;
    ki_gauss_legendre(RINGS, node, weight);
    memset(bands, 0, 5 * sizeof *bands);
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SPOKES; j++) {
            double t = 0.5 * (1 + node[i]), z = 1 - t * t, s = sqrt(1 - z * z);
            double phi = KI_PI * (j + 0.5) / SPOKES, x = s * cos(phi), y = s * sin(phi);
            double hx = x + v[0], hz = z + v[2], noh = hz / sqrt(hx * hx + y * y + hz * hz);
            double w = weight[i] * t * z * kiln_brdf_specular(model, roughness, nov, z, noh);
            add_bands(w, x, y, z, bands);
            sum += w;
        }
    for (int i = 0; i < 5; i++)
        bands[i] /= sum;
}

// Degrees 1 and 2 of a level's lobe.
static void level_bands(double roughness, double k[2])
{
    enum { NODES = 2000 };
    kiln_lobe lobe = kiln_lobe_ggx(roughness * roughness);
    double sum = 0;
    k[0] = k[1] = 0;
    for (int i = 0; i < NODES; i++) {
        // Nodes are dense near the lobe's axis.
        double t = (i + 0.5) / NODES, one = t * t * t * t, x = 1 - one;
        double w = 4 * t * t * t * kiln_lobe_evaluate(&lobe, x);
        sum += w;
        k[0] += w * x;
        k[1] += w * (1.5 * x * x - 0.5);
    }
    k[0] /= sum;
    k[1] /= sum;
}

static void tap_bands(const kiln_table *table, double nov, const double *tap, double *bands)
{
    int level = (int)tap[1] < table->def.level_count - 1 ? (int)tap[1] : table->def.level_count - 2;
    double low[2], high[2], angle = acos(nov) - tap[0], share = tap[1] - level;
    level_bands((double)table->def.level_roughness[level], low);
    level_bands((double)table->def.level_roughness[level + 1], high);
    double one[5] = {0};
    add_bands(1, sin(angle), 0, cos(angle), one);
    for (int i = 0; i < 5; i++) {
        int degree = i < 2 ? 0 : 1;
        bands[i] += tap[2] * one[i] * (low[degree] + share * (high[degree] - low[degree]));
    }
}

static void bands_to_two_are_exact(void **state)
{
    (void)state;
    static const int places[][2] = {{1, 4}, {4, 5}, {8, 6}, {2, 9}, {9, 9}};
    for (int taps = 1; taps <= 3; taps++) {
        kiln_table table = tables[taps];
        for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
            double nov, roughness, third, tap[3][3] = {{0}}, coefficient[6], sum[5], truth[5];
            kiln_table_texel(&table, places[p][0], places[p][1], 0, &nov, &roughness, &third);
            read(&table, nov, roughness, tap, coefficient);
            memcpy(sum, coefficient, sizeof sum);
            for (int k = 0; k < taps; k++)
                tap_bands(&table, nov, tap[k], sum);
            true_bands(&table.def.model, roughness, nov, truth);
            for (int i = 0; i < 5; i++)
                CHECK_NEAR(sum[i], truth[i], 1e-4);
        }
    }
}

static void weights_are_not_negative(void **state)
{
    (void)state;
    for (int taps = 1; taps <= 3; taps++) {
        kiln_table table = tables[taps];
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++)
                for (int k = 0; k < taps; k++) {
                    size_t texel = ((size_t)k * SIZE + (size_t)y) * SIZE + (size_t)x;
                    const float *tap = table.image.pixels + 4 * texel;
                    assert_true(tap[2] >= 0);
                    assert_true(tap[1] >= 0 && tap[1] <= 4);
                    if (x == SIZE - 1)
                        CHECK_NEAR((double)tap[0], 0, 1e-6);
                }
    }
}

// Each further tap lowers the error, and one tap errs less than the split sum's lookups.
static void errors_fall_with_taps(void **state)
{
    (void)state;
    enum { COUNT = 9 };
    double nov[COUNT], roughness[COUNT], third, sum[4] = {0};
    kiln_lobes_error e[COUNT];
    for (int taps = 1; taps <= 3; taps++) {
        kiln_table table = tables[taps];
        for (int i = 0; i < COUNT; i++)
            kiln_table_texel(&table, 1 + 3 * (i % 3), 3 + 2 * (i / 3), 0, &nov[i], &roughness[i],
                             &third);
        CHECK_OK(kiln_lobes_errors(context, &table, nov, roughness, COUNT, e, &error));
        for (int i = 0; i < COUNT; i++) {
            assert_true(e[i].table < 0.75 * e[i].bent && e[i].table < 0.75 * e[i].straight);
            sum[taps] += e[i].table * e[i].table;
            if (taps == 1)
                sum[0] += e[i].bent * e[i].bent;
        }
    }
    if (!(sum[1] < 0.1 * sum[0] && sum[2] < 0.6 * sum[1] && sum[3] < 0.8 * sum[2]))
        fail_msg("squared errors: bent %g, by taps %g %g %g", sum[0], sum[1], sum[2], sum[3]);
}

// The table's axes keep the error at the centres between four texels nearly as small as that at the
// texels. Three taps vary most from texel to texel: their root mean square grows by 4 %.
static void errors_between_texels_are_those_at_texels(void **state)
{
    (void)state;
    enum { SIDE = 32, STEP = 3, ROWS = 9, COLUMNS = 10, COUNT = ROWS * COLUMNS };
    static double nov[2 * COUNT], roughness[2 * COUNT];
    static kiln_lobes_error e[2 * COUNT];
    const kiln_table_def def = {
        .kind = KILN_TABLE_LOBES, .tap_count = 3, .width = SIDE, .height = SIDE};
    kiln_table table;
    double third, at[2] = {0};
    CHECK_OK(kiln_table_create(context, &def, &table, &error));
    for (int i = 0; i < COUNT; i++) {
        int x = STEP * (i % COLUMNS), y = STEP * (1 + i / COLUMNS);
        double n[2], r[2];
        for (int k = 0; k < 2; k++)
            kiln_table_texel(&table, x + k, y + k, 0, &n[k], &r[k], &third);
        nov[2 * i] = n[0];
        roughness[2 * i] = r[0];
        nov[2 * i + 1] = 0.5 * (n[0] + n[1]);
        roughness[2 * i + 1] = 0.5 * (r[0] + r[1]);
    }
    CHECK_OK(kiln_lobes_errors(context, &table, nov, roughness, 2 * COUNT, e, &error));
    for (int i = 0; i < 2 * COUNT; i++)
        at[i % 2] += e[i].table * e[i].table;
    CHECK_BELOW(sqrt(at[1] / at[0]), 1.05);
    kiln_table_free(&table);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    kiln_table table = tables[2], again;
    kiln_context *other;
    CHECK_OK(kiln_context_create(&(kiln_context_def){.thread_count = 3}, &other, &error));
    CHECK_OK(kiln_table_create(other, &table.def, &again, &error));
    assert_memory_equal(table.image.pixels, again.image.pixels,
                        (size_t)SIZE * SIZE * 3 * 4 * sizeof(float));
    kiln_table_free(&again);
    kiln_context_destroy(other);
}

static void files_keep_the_chain(void **state)
{
    (void)state;
    kiln_table table = tables[2], back;
    const char *path = in_folder("lobes.ktx2");
    char text[KI_TABLE_TEXT];
    const kiln_table_save_def whole = {.format = KILN_TABLE_FORMAT_F32};
    CHECK_OK(kiln_table_save(context, &table, path, &whole, &error));
    CHECK_OK(kiln_table_load(context, path, &back, &error));
    assert_memory_equal(table.image.pixels, back.image.pixels,
                        (size_t)SIZE * SIZE * 3 * 4 * sizeof(float));
    ki_table_describe(&back.def, text);
    assert_string_equal(text, "kind=lobes d=ggx g=smith-uncorrelated sheen=ashikhmin axis=linear "
                              "corners=1 complement=0 flip=0 size=10x10x3 paths=0 taps=2 "
                              "levels=0.0500000007,0.300000012,0.550000012,0.800000012,1");
    kiln_table_free(&back);
    assert_int_equal(kiln_table_save(context, &table, in_folder("lobes.png"), NULL, &error),
                     KILN_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "below 0 and above 1"));
}

static void texts_of_lobes_are_parsed_strictly(void **state)
{
    (void)state;
    static const char start[] = "kind=lobes d=ggx g=smith sheen=ashikhmin axis=linear corners=1 "
                                "complement=0 flip=0 size=32x32x";
    static const char *const good[] = {"2 paths=0 taps=1 levels=7",
                                       "4 paths=0 taps=3 levels=0.5,1"};
    static const char *const bad[] = {
        "2 paths=0",
        "2 paths=0 taps=1",
        "2 paths=0 taps=1 levels=",
        "2 paths=0 taps=1 levels=1",
        "2 paths=0 taps=1 levels=17",
        "2 paths=0 taps=1 levels=0,",
        "2 paths=0 taps=1 levels=0,1,",
        "2 paths=0 taps=1 levels=0,1 ",
        "2 paths=0 taps=1 levels=1,0",
        "2 paths=0 taps=1 levels=0,1.1",
        "2 paths=0 taps=2 levels=7",
        "5 paths=0 taps=4 levels=7",
        "2 paths=9 taps=1 levels=7",
    };
    kiln_table_def def;
    char text[KI_TABLE_TEXT], again[KI_TABLE_TEXT];
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        snprintf(text, sizeof text, "%s%s", start, good[i]);
        assert_true(ki_table_parse(text, &def));
        ki_table_describe(&def, again);
        assert_string_equal(again, text);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        snprintf(text, sizeof text, "%s%s", start, bad[i]);
        if (ki_table_parse(text, &def))
            fail_msg("parsed: %s", text);
    }
    // more digits than kiln reads as a number
    char digits[400] = {0}, long_text[1000];
    memset(digits, '6', sizeof digits - 1);
    snprintf(long_text, sizeof long_text, "%s2 paths=0 taps=1 levels=0.%s,1", start, digits);
    assert_false(ki_table_parse(long_text, &def));
}

static void wrong_choices_are_refused(void **state)
{
    (void)state;
    static const struct {
        kiln_table_def def;
        const char *message;
    } cases[] = {
        {{.tap_count = 4}, "tap_count is 4, it must be 1 to 3, or 0"},
        {{.level_count = 1}, "level_count is 1, it must be 2 to 16, or 0"},
        {{.width = 65}, "the table is 65 x 32, both must be 2 to 64 for a table of lobes"},
        {{.depth = 2, .tap_count = 2},
         "depth of the table is 2, a table of lobes with 2 taps has 3 slices"},
        {{.axis = KILN_AXIS_GRAZING}, "axis of the table is 3, it must be 0 for a table of lobes"},
        {{.model.d = KILN_D_BECKMANN}, "a table of lobes needs the distribution GGX, but d is 1"},
        {{.level_count = 2, .level_roughness = {0.5f, 0.5f}},
         "roughness of level 1 is 0.5, it must be 0 to 1 and increase"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_table table;
        kiln_table_def def = cases[i].def;
        def.kind = KILN_TABLE_LOBES;
        assert_int_equal(kiln_table_create(context, &def, &table, &error), KILN_ERROR_ARGUMENT);
        assert_string_equal(error.message, cases[i].message);
        assert_null(table.image.pixels);
    }
}

static int begin(void **state)
{
    int result = set_up_folder(state);
    for (int taps = 1; taps <= 3; taps++)
        tables[taps] = make(taps);
    return result;
}

static int end(void **state)
{
    for (int taps = 1; taps <= 3; taps++)
        kiln_table_free(&tables[taps]);
    return tear_down_folder(state);
}

// Work that was told once to stop ends there, on two threads too, and neither goes on with numbers
// that were not computed nor returns them.
static void one_stop_is_enough(void **state)
{
    (void)state;
    enum { MOST = 12, POINTS = 2000 };
    single_stop o;
    kiln_context *own;
    kiln_table table;
    static double nov[POINTS], roughness[POINTS];
    static kiln_lobes_error errors[POINTS];
    kiln_table_def def = {.kind = KILN_TABLE_LOBES, .width = 32, .height = 32, .corners = true};
    kiln_context_def how = {.thread_count = 2, .progress = stop_once, .progress_user = &o};
    CHECK_OK(kiln_context_create(&how, &own, &error));
    for (int at = 1; at < MOST; at++) {
        o = (single_stop){.stop_at = at};
        assert_int_equal(kiln_table_create(own, &def, &table, &error), KILN_ERROR_CANCELLED);
        assert_int_equal(o.calls, at);
    }
    o = (single_stop){0};
    CHECK_OK(kiln_table_create(own, &def, &table, &error));
    for (int i = 0; i < POINTS; i++) {
        nov[i] = (i % 40 + 0.5) / 40;
        roughness[i] = 0.2 + 0.7 * i / POINTS;
    }
    for (int at = 1; at < 4; at++) {
        o = (single_stop){.stop_at = at};
        kiln_result result = kiln_lobes_errors(own, &table, nov, roughness, POINTS, errors, &error);
        assert_int_equal(result, o.calls < at ? KILN_OK : KILN_ERROR_CANCELLED);
        for (int i = 0; i < POINTS && result; i++)
            assert_true(errors[i].table == 0 && errors[i].bent == 0 && errors[i].straight == 0);
    }
    kiln_table_free(&table);
    kiln_context_destroy(own);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_to_two_are_exact),
        cmocka_unit_test(one_stop_is_enough),
        cmocka_unit_test(weights_are_not_negative),
        cmocka_unit_test(errors_fall_with_taps),
        cmocka_unit_test(errors_between_texels_are_those_at_texels),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(files_keep_the_chain),
        cmocka_unit_test(texts_of_lobes_are_parsed_strictly),
        cmocka_unit_test(wrong_choices_are_refused),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
