// Tables as the caller sees them.
#include "table/table.h"
#include "table/table_text.h"

const char *const *kiln_d_names(void)
{
    return ki_d_names;
}

const char *const *kiln_g_names(void)
{
    return ki_g_names;
}

const char *const *kiln_sheen_names(void)
{
    return ki_sheen_names;
}

const char *const *kiln_table_kind_names(void)
{
    return ki_kind_names;
}

const char *const *kiln_axis_names(void)
{
    return ki_axis_names;
}

kiln_result kiln_table_create(kiln_context *context, const kiln_table_def *def, kiln_table *table,
                              kiln_error *error)
{
    *table = (kiln_table){.def = def ? *def : (kiln_table_def){0}};
    kiln_result result = ki_table_complete(&table->def, error);
    if (!result)
        result = kiln_image_create(context, table->def.width, table->def.height * table->def.depth,
                                   ki_table_channels(table->def.kind), &table->image, error);
    if (!result)
        result = ki_table_fill(context, table, error);
    if (result)
        kiln_table_free(table);
    return result;
}

void kiln_table_free(kiln_table *table)
{
    if (!table)
        return;
    kiln_image_free(&table->image);
    *table = (kiln_table){0};
}

kiln_result kiln_table_average(kiln_context *context, const kiln_table *table, int height,
                               kiln_table *average, kiln_error *error)
{
    *average = (kiln_table){.def = table->def};
    average->def.kind = KILN_TABLE_E_AVERAGE;
    average->def.axis = KILN_AXIS_LINEAR;
    average->def.height = height ? height : 1024;
    kiln_result result = KILN_OK;
    if (table->def.kind != KILN_TABLE_E || !table->image.pixels)
        result = ki_fail(error, KILN_ERROR_ARGUMENT,
                         "the average is that of a table of E, not of "
                         "kind %d",
                         (int)table->def.kind);
    if (!result)
        result = ki_table_complete(&average->def, error);
    if (!result)
        result = kiln_image_create(context, 1, average->def.height, 1, &average->image, error);
    if (!result)
        result = ki_table_average(context, table, average, error);
    if (result)
        kiln_table_free(average);
    return result;
}

void kiln_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                      double *roughness, double *third)
{
    ki_table_texel(table, x, y, slice, nov, roughness, third);
}

void kiln_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                       double *values)
{
    ki_table_lookup(table, nov, roughness, third, values);
}
