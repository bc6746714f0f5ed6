// Tables of every kind, axis and flag, of numbers that have nothing to do with their neighbours: a
// lookup that is off by a little then shows.
#ifndef KILN_LOOKUP_TABLES_H
#define KILN_LOOKUP_TABLES_H

#include "kit/random.h"

#include <kiln/brdf.h>

enum { LOOKUP_TABLES = 72, LOOKUP_KINDS = KILN_TABLE_E_WALK + 1 };

/// Number `index` of LOOKUP_TABLES.
static inline kiln_result lookup_table(kiln_context *context, int index, kiln_table *table,
                                       kiln_error *error)
{
    static const int channels[LOOKUP_KINDS] = {1, 1, 2, 3, 1, 1, 4, 1};
    int kind = index % LOOKUP_KINDS, turn = index / LOOKUP_KINDS;
    bool slices = kind >= KILN_TABLE_E_DIELECTRIC;
    *table = (kiln_table){.def = {.kind = (kiln_table_kind)kind,
                                  .model = {.g = (kiln_g)((turn + kind) % 4)},
                                  .sheen = (kiln_sheen)(turn % 2),
                                  .width = kind == KILN_TABLE_E_AVERAGE ? 1 : 7,
                                  .height = 5,
                                  .depth = slices ? 3 : 1,
                                  .axis = (kiln_axis)(turn % 4),
                                  .corners = turn / 4 % 2 == 1,
                                  .complement = channels[kind] == 1 && (turn + kind) % 2,
                                  .flip = (turn + kind) % 3 == 0,
                                  .path_count = kind == KILN_TABLE_E_WALK ? 1000 : 0}};
    if (turn == 8) // the smallest
        table->def.width = table->def.height = table->def.depth = 1;
    kiln_result result =
        kiln_image_create(context, table->def.width, table->def.height * table->def.depth,
                          channels[kind], &table->image, error);
    size_t count =
        (size_t)table->image.width * (size_t)table->image.height * (size_t)table->image.channels;
    uint64_t seed = (uint64_t)index;
    for (size_t i = 0; result == KILN_OK && i < count; i++)
        table->image.pixels[i] = (float)random_number(&seed);
    return result;
}

/// A point somewhat beyond the table's range at times, at its very ends at others.
static inline void lookup_point(uint64_t *seed, double point[3])
{
    for (int c = 0; c < 3; c++) {
        double x = 1.2 * random_number(seed) - 0.1;
        double scale = random_number(seed) < 0.3 ? 1e-3 : 1;
        point[c] = c == 2 ? 1.2 * x + 1 : x * scale;
        if (random_number(seed) < 0.1)
            point[c] = c == 2 || x > 0.5 ? 1 : 0;
    }
}

#endif
