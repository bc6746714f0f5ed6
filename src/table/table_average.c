// The average E_avg under diffuse light of the albedo E in a table, which is read by linear
// interpolation between its texels.
#include "table/table.h"

#include "math/math.h"
#include "table/table_axis.h"

// E_avg = 2 int E(mu) mu dmu at one roughness of an interpolated table of the albedo E, by
// Gauss-Legendre quadrature between neighbouring columns, where the interpolated E is smooth.
static double average_row(const kiln_table *table, double roughness)
{
    enum { NODES = 6 };
    const kiln_table_def *def = &table->def;
    double node[NODES], weight[NODES], sum = 0, from = 0;
    ki_gauss_legendre(NODES, node, weight);
    for (int x = 0; x <= def->width; x++) {
        double u = x < def->width ? ki_texel_place(x, def->width, def->corners) : 1;
        double to = ki_axis_to_nov(def, roughness, u), half = (to - from) / 2;
        for (int i = 0; i < NODES; i++) {
            double nov = from + half * (1 + node[i]), e = 0;
            kiln_table_lookup(table, nov, roughness, 0, &e);
            sum += 2 * weight[i] * half * nov * e;
        }
        from = to;
    }
    return sum;
}

typedef struct average_job {
    const kiln_table *table;
    kiln_table *average;
} average_job;

static void average_task(void *data, int row)
{
    const average_job *job = data;
    double nov, roughness, third;
    kiln_table_texel(job->average, 0, row, 0, &nov, &roughness, &third);
    double e = average_row(job->table, roughness);
    job->average->image.pixels[row] = (float)(job->average->def.complement ? 1 - e : e);
}

static kiln_result fill_averages(kiln_context *context, const kiln_table *table,
                                 kiln_table *average, kiln_error *error)
{
    average_job job = {table, average};
    ki_progress_range range = {"average", 0, 1};
    bool whole = ki_parallel_steps(context, &range, average->def.height, average_task, &job);
    return whole ? KILN_OK : ki_fail_cancelled(error, "average");
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
                         "the average needs a table of kind E, but the table's kind is %d",
                         (int)table->def.kind);
    if (!result)
        result = ki_table_complete(&average->def, error);
    if (!result)
        result = kiln_image_create(context, 1, average->def.height, 1, &average->image, error);
    if (!result)
        result = fill_averages(context, table, average, error);
    if (result)
        kiln_table_free(average);
    return result;
}
