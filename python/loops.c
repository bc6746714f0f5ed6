// Loops over arrays for the functions of kiln that take an object and numbers; header.py writes
// those for the functions of numbers alone. `count` is the number of elements of each array, which
// are contiguous. The Python package calls the loops without the interpreter's lock.
// SPDX-License-Identifier: MIT
#include <kiln/brdf.h>

KILN_API void kiln_each_sh_evaluate(size_t count, const kiln_sh *sh, const double (*directions)[3],
                                    double (*values)[3]);
KILN_API void kiln_each_map_direction(size_t count, const kiln_map *map, int level,
                                      double (*directions)[3]);
KILN_API void kiln_each_table_texel(const kiln_table *table, double *nov, double *roughness,
                                    double *third);
KILN_API void kiln_each_table_lookup(size_t count, const kiln_table *table, const double *nov,
                                     const double *roughness, const double *third, double *values);
KILN_API void kiln_each_fit_evaluate(size_t count, const kiln_fit *fit, const float *nov,
                                     const float *roughness, float *values);

void kiln_each_sh_evaluate(size_t count, const kiln_sh *sh, const double (*directions)[3],
                           double (*values)[3])
{
    for (size_t i = 0; i < count; i++)
        kiln_sh_evaluate(sh, directions[i], values[i]);
}

void kiln_each_map_direction(size_t count, const kiln_map *map, int level, double (*directions)[3])
{
    for (size_t i = 0; i < count; i++)
        kiln_map_direction(map, level, i, directions[i]);
}

// One number in each of the three arrays for every texel of the table, slice after slice, row after
// row.
void kiln_each_table_texel(const kiln_table *table, double *nov, double *roughness, double *third)
{
    size_t at = 0;
    for (int slice = 0; slice < table->def.depth; slice++)
        for (int y = 0; y < table->def.height; y++)
            for (int x = 0; x < table->def.width; x++, at++)
                kiln_table_texel(table, x, y, slice, &nov[at], &roughness[at], &third[at]);
}

void kiln_each_table_lookup(size_t count, const kiln_table *table, const double *nov,
                            const double *roughness, const double *third, double *values)
{
    size_t width = (size_t)table->image.channels;
    if (table->def.kind == KILN_TABLE_LOBES)
        width *= (size_t)table->def.depth;
    for (size_t i = 0; i < count; i++)
        kiln_table_lookup(table, nov[i], roughness[i], third[i], &values[i * width]);
}

void kiln_each_fit_evaluate(size_t count, const kiln_fit *fit, const float *nov,
                            const float *roughness, float *values)
{
    size_t width = fit->def.kind == KILN_FIT_DFG ? 2 : 1;
    for (size_t i = 0; i < count; i++)
        kiln_fit_evaluate(fit, nov[i], roughness[i], &values[i * width]);
}
