// Writes an engine's file of known content. engine_write ENGINE WHAT SIZE PATH
//   coded  level k in direction d has the radiance (1 + k) (2 + d): red has d.x, green d.y, blue d.z
//   white  1 everywhere
#include <kiln/kiln.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void paint(kiln_map *map, bool coded)
{
    for (int k = 0; k < map->level_count; k++)
        for (size_t i = 0; i < kiln_map_texels(map, k); i++) {
            double d[3];
            kiln_map_direction(map, k, i, d);
            for (int c = 0; c < 3; c++)
                map->level[k][3 * i + (size_t)c] = coded ? (float)((1 + k) * (2 + d[c])) : 1;
        }
}

// Radiance 2 + d in orthonormal harmonics: 1 is sqrt(4 pi) Y0, d.x is sqrt(4 pi / 3) Y1,1.
static kiln_sh harmonics(bool coded)
{
    const double whole = 3.5449077018110318, part = 2.0466534158929770;
    static const int of_axis[3] = {3, 1, 2}; // the order is y z x
    kiln_sh sh = {.bands = 3};
    for (int c = 0; c < 3; c++) {
        sh.c[0][c] = (coded ? 2 : 1) * whole;
        if (coded)
            sh.c[of_axis[c]][c] = part;
    }
    return sh;
}

int main(int argc, char **argv)
{
    kiln_context *context = NULL;
    kiln_error error = {0};
    kiln_map map = {0};
    kiln_plan *plan = NULL; // knows how the levels are laid out
    kiln_prefilter_def def;
    float roughness[KILN_MAX_LEVELS];
    const kiln_engine *engine = argc >= 5 && argc <= 6 ? kiln_engine_find(argv[1]) : NULL;
    bool coded = engine && !strcmp(argv[2], "coded");
    if (!engine || (!coded && strcmp(argv[2], "white") != 0)) {
        fprintf(stderr, "engine_write ENGINE coded|white SIZE PATH [FORMAT]\n");
        return 2;
    }
    int size = (int)strtol(argv[3], NULL, 10), format = argc == 6 ? atoi(argv[5]) : 0;
    kiln_sh sh = harmonics(coded);
    if (!kiln_context_create(NULL, &context, &error) &&
        !kiln_engine_levels(engine, size, 0, roughness, &def, &error) &&
        !kiln_plan_create(context, 16, &def, &plan, &error) && !kiln_plan_map(plan, &map, &error)) {
        paint(&map, coded);
        if (!kiln_engine_save(context, engine, &map, &sh, (kiln_format)format, argv[4], NULL,
                              &error))
            error.result = KILN_OK;
    }
    kiln_map_free(&map);
    kiln_plan_destroy(plan);
    kiln_context_destroy(context);
    if (error.result)
        fprintf(stderr, "%s\n", error.message);
    return error.result != KILN_OK;
}
