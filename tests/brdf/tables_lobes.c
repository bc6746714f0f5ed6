// Each texel of tables of sheen, multiscatter DFG and rough glass has the value of the public
// function at the arguments that kiln_table_texel returns.
#include "kit/kit.h"

#include <kiln/brdf.h>

static void check_texel(const kiln_table *table, int x, int y, int slice)
{
    const kiln_table_def *def = &table->def;
    int channels = table->image.channels;
    double nov, roughness, third, wanted[4] = {0};
    kiln_table_texel(table, x, y, slice, &nov, &roughness, &third);
    switch (def->kind) {
    case KILN_TABLE_SHEEN:
        wanted[0] = kiln_sheen_albedo(def->sheen, roughness, nov);
        break;
    case KILN_TABLE_DFG_MULTISCATTER: {
        double ab[2];
        kiln_energy_split(&def->model, roughness, nov, ab);
        wanted[0] = ab[1];
        wanted[1] = ab[0] + ab[1];
        wanted[2] = kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, roughness, nov);
        break;
    }
    case KILN_TABLE_E_DIELECTRIC:
        kiln_glass(&def->model, roughness, third, nov, wanted);
        break;
    default:
        kiln_glass(&def->model, roughness, third, nov, wanted);
        kiln_glass(&def->model, roughness, 1 / third, nov, wanted + 2);
        break;
    }
    size_t row = (size_t)slice * (size_t)def->height + (size_t)y;
    const float *texel =
        table->image.pixels + (row * (size_t)def->width + (size_t)x) * (size_t)channels;
    for (int c = 0; c < channels; c++)
        CHECK_NEAR((double)texel[c], wanted[c], 1e-6 * fmax(1, wanted[c]));
}

static void tables_hold_the_integrals(void **unused)
{
    (void)unused;
    static const struct {
        kiln_table_kind kind;
        int channels, depth;
    } kinds[] = {{KILN_TABLE_SHEEN, 1, 1},
                 {KILN_TABLE_DFG_MULTISCATTER, 3, 1},
                 {KILN_TABLE_E_DIELECTRIC, 1, 3},
                 {KILN_TABLE_GLASS, 4, 3}};
    kiln_context *context = make_context(0);
    kiln_error error;
    for (int i = 0; i < 8; i++) {
        kiln_table_def def = {.kind = kinds[i / 2].kind,
                              .sheen = (kiln_sheen)(i % 2),
                              .model.g = i % 2 ? KILN_G_SMITH_UNCORRELATED : KILN_G_SMITH,
                              .width = 5,
                              .height = 4,
                              .depth = kinds[i / 2].depth,
                              .axis = i % 2 ? KILN_AXIS_SQRT : KILN_AXIS_LINEAR,
                              .corners = i % 2 == 1};
        kiln_table table;
        CHECK_OK(kiln_table_create(context, &def, &table, &error));
        assert_int_equal(table.image.channels, kinds[i / 2].channels);
        for (int t = 0; t < 5 * 4 * def.depth; t++)
            check_texel(&table, t % 5, t / 5 % 4, t / 20);
        kiln_table_free(&table);
    }
    // The first slice is ior 1, without a boundary, and the last is ior 3.
    kiln_table_def def = {
        .kind = KILN_TABLE_GLASS, .width = 2, .height = 2, .depth = 2, .corners = true};
    kiln_table table;
    CHECK_OK(kiln_table_create(context, &def, &table, &error));
    const float *first = table.image.pixels + 4, *last = first + 16; // n.v 1, roughness 0
    CHECK_NEAR((double)first[0], 0, 0);
    CHECK_NEAR((double)first[1], 1, 0);
    CHECK_NEAR((double)last[0], 0.25, 1e-7);
    CHECK_NEAR((double)last[3], 0.75, 1e-7);
    kiln_table_free(&table);
    def = (kiln_table_def){.kind = KILN_TABLE_SHEEN, .sheen = (kiln_sheen)2};
    assert_int_equal(kiln_table_create(context, &def, &table, &error), KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "sheen is 2, it must be 0 to 1");
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_hold_the_integrals),
    };
    return cmocka_run_group_tests_name("tables of lobes", tests, NULL, NULL);
}
