// Tables as the caller sees them.
#include "bake/table.h"
#include "bake/table_axis.h"
#include "image/image.h"

#include <math.h>

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

void kiln_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                      double *roughness, double *third)
{
    const kiln_table_def *def = &table->def;
    double v = ki_texel_place(y, def->height, def->corners);
    *roughness = def->flip ? 1 - v : v;
    *nov = ki_axis_to_nov(def, *roughness, ki_texel_place(x, def->width, def->corners));
    *third =
        ki_third_from_w(ki_table_third(def->kind), ki_texel_place(slice, def->depth, def->corners));
}

// A place between two texels: the lower one, the step to the other (0 at the end) and its share.
typedef struct between {
    size_t index, step;
    double share;
} between;

static between find(double place, int count, bool corners, size_t stride)
{
    double index = ki_texel_index(place > 0 ? place < 1 ? place : 1 : 0, count, corners);
    double low = floor(index);
    return (between){(size_t)low * stride, low < count - 1 ? stride : 0, index - low};
}

void kiln_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                       double *values)
{
    const kiln_table_def *def = &table->def;
    size_t channels = (size_t)table->image.channels, row = channels * (size_t)def->width;
    double u = ki_axis_from_nov(def, roughness, ki_clamp(nov, 0, 1));
    between x = find(u, def->width, def->corners, channels);
    between y = find(def->flip ? 1 - roughness : roughness, def->height, def->corners, row);
    between z = find(ki_third_to_w(ki_table_third(def->kind), third), def->depth, def->corners,
                     row * (size_t)def->height);
    const float *texel = table->image.pixels + x.index + y.index + z.index;
    for (size_t c = 0; c < channels; c++, texel++) {
        double slice[2];
        for (size_t k = 0; k < 2; k++) {
            const float *t = texel + k * z.step;
            double top = (double)t[0] + ((double)t[x.step] - (double)t[0]) * x.share;
            t += y.step;
            double bottom = (double)t[0] + ((double)t[x.step] - (double)t[0]) * x.share;
            slice[k] = top + (bottom - top) * y.share;
        }
        values[c] = slice[0] + (slice[1] - slice[0]) * z.share;
        if (def->complement)
            values[c] = 1 - values[c];
    }
}
