// Reads tables: the arguments (n.v, roughness, F0 or ior) of a texel, and linear interpolation
// between texels.
#include "table/table.h"

#include "math/math.h"
#include "table/table_axis.h"

#include <math.h>

void kiln_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                      double *roughness, double *third)
{
    const kiln_table_def *def = &table->def;
    double v = ki_texel_place(y, def->height, def->corners);
    *roughness = def->flip ? 1 - v : v;
    if (def->axis == KILN_AXIS_GRAZING && *roughness < KI_GRAZING_MIN)
        *roughness = KI_GRAZING_MIN;
    *nov = ki_axis_to_nov(def, *roughness, ki_texel_place(x, def->width, def->corners));
    *third =
        ki_third_from_w(ki_table_third(def->kind), ki_texel_place(slice, def->depth, def->corners));
}

// The two texels of a table along one axis between which a place in [0, 1] lies. `index` is the
// offset of the lower texel in the table's pixels, index + step that of the upper (step is 0 at the
// last texel), and `share` the upper texel's weight.
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

// Interpolates one channel between eight texels; t points to the first of them.
static double mix_texels(const float *t, const between *x, const between *y, const between *z)
{
    double slice[2];
    for (size_t k = 0; k < 2; k++, t += z->step) {
        const float *b = t + y->step;
        double top = (double)t[0] + ((double)t[x->step] - (double)t[0]) * x->share;
        double bottom = (double)b[0] + ((double)b[x->step] - (double)b[0]) * x->share;
        slice[k] = top + (bottom - top) * y->share;
    }
    return slice[0] + (slice[1] - slice[0]) * z->share;
}

void kiln_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                       double *values)
{
    const kiln_table_def *def = &table->def;
    size_t channels = (size_t)table->image.channels, row = channels * (size_t)def->width;
    roughness = ki_clamp(roughness, 0, 1);
    double u = ki_axis_from_nov(def, roughness, ki_clamp(nov, 0, 1));
    between x = find(u, def->width, def->corners, channels);
    between y = find(def->flip ? 1 - roughness : roughness, def->height, def->corners, row);
    between z = find(ki_third_to_w(ki_table_third(def->kind), third), def->depth, def->corners,
                     row * (size_t)def->height);
    const float *texel = table->image.pixels + x.index + y.index;
    if (def->kind == KILN_TABLE_LOBES) {
        // Slices are no axis: every slice has four numbers of its own.
        size_t slice = row * (size_t)def->height;
        z = (between){0};
        for (size_t i = 0; i < channels * (size_t)def->depth; i++)
            values[i] = mix_texels(texel + i / channels * slice + i % channels, &x, &y, &z);
        return;
    }
    for (size_t c = 0; c < channels; c++) {
        values[c] = mix_texels(texel + z.index + c, &x, &y, &z);
        if (def->complement)
            values[c] = 1 - values[c];
    }
}
