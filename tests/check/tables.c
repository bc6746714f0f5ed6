// kiln_check_table on tables that kiln computed, as they are or with one planted fault each.
#include <kiln/check.h>

#include "kit/context.h"

#include "findings.h"

enum { N = 64 };

static kiln_table made(const kiln_table_def *def)
{
    kiln_table table;
    kiln_table_def full = *def;
    full.width = full.width ? full.width : N;
    full.height = full.height ? full.height : N;
    CHECK_OK(kiln_table_create(context, &full, &table, &error));
    return table;
}

static kiln_check_table_report checked(const kiln_image *image, bool flip)
{
    kiln_check_table_report report;
    CHECK_OK(kiln_check_table(context, image, flip, &report, &error));
    return report;
}

// An image of the same size whose texel (x, y) is that of `from` at (u, v).
static kiln_image ordered(const kiln_image *from, bool transposed, bool columns, bool rows)
{
    kiln_image to;
    size_t n = (size_t)from->channels;
    CHECK_OK(kiln_image_create(context, from->width, from->height, from->channels, &to, &error));
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++) {
            int u = transposed ? y : columns ? from->width - 1 - x : x;
            int v = transposed ? x : rows ? from->height - 1 - y : y;
            memcpy(to.pixels + n * (size_t)(y * from->width + x),
                   from->pixels + n * (size_t)(v * from->width + u), n * sizeof(float));
        }
    return to;
}

// ------------------------------------------------------------------------------------ right tables

static void right_tables_are_right(void **state)
{
    (void)state;
    static const struct {
        kiln_table_def def;
        kiln_table_content content[3];
    } rows[] = {
        {{.kind = KILN_TABLE_DFG}, {KILN_HOLDS_A, KILN_HOLDS_B}},
        {{.kind = KILN_TABLE_DFG, .width = 48, .height = 32}, {KILN_HOLDS_A, KILN_HOLDS_B}},
        {{.kind = KILN_TABLE_DFG_MULTISCATTER}, {KILN_HOLDS_B, KILN_HOLDS_E, KILN_HOLDS_SHEEN}},
        {{.kind = KILN_TABLE_E, .complement = true}, {KILN_HOLDS_COMPLEMENT}},
        {{.kind = KILN_TABLE_E, .axis = KILN_AXIS_SQRT}, {KILN_HOLDS_E}},
        {{.kind = KILN_TABLE_DFG, .corners = true}, {KILN_HOLDS_A, KILN_HOLDS_B}},
        {{.kind = KILN_TABLE_DFG, .flip = true}, {KILN_HOLDS_A, KILN_HOLDS_B}},
        {{.kind = KILN_TABLE_DFG, .model = {KILN_D_GGX, KILN_G_SCHLICK_K2}},
         {KILN_HOLDS_A, KILN_HOLDS_B}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const kiln_table_def *def = &rows[i].def;
        kiln_table table = made(def);
        kiln_check_table_report report = checked(&table.image, def->flip);
        assert_int_equal(report.findings.fault_count, 0);
        CHECK_BELOW(report.rms, 1e-6);
        assert_int_equal(report.corners, def->corners);
        assert_int_equal(report.axis, def->axis);
        assert_int_equal(report.model.g, def->model.g);
        for (int c = 0; c < table.image.channels; c++)
            assert_int_equal(report.content[c], rows[i].content[c]);
        kiln_table_free(&table);
    }
}

static void files_are_read_as_stored(void **state)
{
    (void)state;
    static const char *const names[] = {"t.png", "t.exr", "t.ktx2"};
    static const double bounds[] = {1e-5, 1e-6, 2e-4};
    kiln_table table = made(&(kiln_table_def){.kind = KILN_TABLE_DFG, .flip = true});
    for (int i = 0; i < 3; i++) {
        kiln_image image;
        bool flip;
        CHECK_OK(kiln_table_save(context, &table, in_folder(names[i]), NULL, &error));
        CHECK_OK(kiln_table_numbers_load(context, in_folder(names[i]), &image, &flip, &error));
        assert_int_equal(flip, i > 0); // PNG files do not state the parameters of a table
        kiln_check_table_report report = checked(&image, true);
        assert_int_equal(report.findings.fault_count, 0);
        CHECK_BELOW(report.rms, bounds[i]);
        kiln_image_free(&image);
    }
    kiln_table_free(&table);
}

// ---------------------------------------------------------------------------------- planted faults

static void orders_are_named(void **state)
{
    (void)state;
    static const char *const words[] = {"rows and columns are transposed", "n.v is flipped",
                                        "roughness is flipped"};
    kiln_table table = made(&(kiln_table_def){.kind = KILN_TABLE_DFG});
    for (int i = 0; i < 3; i++) {
        kiln_image image = ordered(&table.image, i == 0, i == 1, i == 2);
        kiln_check_table_report report = checked(&image, false);
        expect_one_fault(&report.findings, KILN_FINDING_ORDER, words[i]);
        CHECK_BELOW(report.rms, 1e-6);
        kiln_image_free(&image);
    }
    kiln_table_free(&table);
}

static void a_gamma_curve_is_named(void **state)
{
    (void)state;
    kiln_table table = made(&(kiln_table_def){.kind = KILN_TABLE_DFG});
    for (size_t i = 0; i < 2 * N * N; i++) {
        double x = (double)table.image.pixels[i];
        table.image.pixels[i] =
            (float)(x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055);
    }
    kiln_check_table_report report = checked(&table.image, false);
    expect_one_fault(&report.findings, KILN_FINDING_ENCODING, "gamma-encoded");
    CHECK_BELOW(report.rms, 1e-5);
    kiln_table_free(&table);
}

// Sets texel (x, y) to A and B at n.v = (x + right) / n and roughness (y + down) / n.
static void fill_places(kiln_image *image, double right, double down)
{
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++) {
            double ab[2];
            kiln_energy_split(&(kiln_model){0}, fmin(1, (y + down) / N), fmin(1, (x + right) / N),
                              ab);
            for (int c = 0; c < 2; c++)
                image->pixels[2 * (y * N + x) + c] = (float)ab[c];
        }
}

static void texels_beside_their_places_are_named(void **state)
{
    (void)state;
    static const struct {
        double right, down;
        const char *words;
    } rows[] = {{0, 0.5, "n.v is half a texel off"},
                {1, 0.5, "n.v is half a texel off"},
                {0.5, 1, "roughness is half a texel off"},
                {0.5, 1.5, "roughness is one texel off"}};
    kiln_image image;
    CHECK_OK(kiln_image_create(context, N, N, 2, &image, &error));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        fill_places(&image, rows[i].right, rows[i].down);
        kiln_check_table_report report = checked(&image, false);
        expect_one_fault(&report.findings, KILN_FINDING_SHIFT, rows[i].words);
        CHECK_BELOW(5e-4, report.rms);
    }
    kiln_image_free(&image);
}

static void other_pictures_are_no_tables(void **state)
{
    (void)state;
    kiln_image image;
    kiln_check_table_report report;
    CHECK_OK(kiln_image_create(context, N, N, 1, &image, &error));
    for (int i = 0; i < N * N; i++)
        image.pixels[i] = (float)(i % N) / N;
    report = checked(&image, false);
    expect_one_fault(&report.findings, KILN_FINDING_CONTENT,
                     "not those of a table that kiln knows");
    image.pixels[77] = NAN;
    assert_int_equal(kiln_check_table(context, &image, false, &report, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "number 77 of the table is not finite");
    image.height = 4;
    assert_int_equal(kiln_check_table(context, &image, false, &report, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "must have 12 to 4096 texels");
    image.height = N;
    kiln_image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(right_tables_are_right),
        cmocka_unit_test(files_are_read_as_stored),
        cmocka_unit_test(orders_are_named),
        cmocka_unit_test(a_gamma_curve_is_named),
        cmocka_unit_test(texels_beside_their_places_are_named),
        cmocka_unit_test(other_pictures_are_no_tables),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_folder);
}
