// Writes an engine's file of known content. engine_write ENGINE WHAT SIZE PATH [FORMAT]
//   coded  level k in direction d has the radiance (1 + k) (2 + d): red has d.x, green d.y, blue d.z
//   white  1 everywhere
// Where an engine's files hold less than the coded cube's largest radiance, both are written DIM
// times darker, and the page lets the engine multiply its light by DIM. engine_write ENGINE default
// PANORAMA PATH: the levels that kiln bake --for ENGINE makes, as a cube of floats.
#include <kiln/kiln.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double DIM = 16;

static double scale_for(const kiln_engine *engine, const kiln_map *map)
{
    return engine->limit < 3 * map->level_count ? 1 / DIM : 1;
}

static void paint(kiln_map *map, bool coded, double scale)
{
    for (int k = 0; k < map->level_count; k++)
        for (size_t i = 0; i < kiln_map_texels(map, k); i++) {
            double d[3];
            kiln_map_direction(map, k, i, d);
            for (int c = 0; c < 3; c++)
                map->level[k][3 * i + (size_t)c] =
                    (float)(scale * (coded ? (1 + k) * (2 + d[c]) : 1));
        }
}

// Radiance 2 + d in orthonormal harmonics: 1 is sqrt(4 pi) Y0, d.x is sqrt(4 pi / 3) Y1,1.
static kiln_sh harmonics(bool coded, double scale)
{
    const double whole = 3.5449077018110318, part = 2.0466534158929770;
    static const int of_axis[3] = {3, 1, 2}; // the order is y z x
    kiln_sh sh = {.bands = 3};
    for (int c = 0; c < 3; c++) {
        sh.c[0][c] = scale * (coded ? 2 : 1) * whole;
        if (coded)
            sh.c[of_axis[c]][c] = scale * part;
    }
    return sh;
}

static kiln_result save_default(kiln_context *context, const kiln_engine *engine,
                                const char *panorama, const char *path, kiln_error *error)
{
    const kiln_save_def save = {.format = KILN_FORMAT_RGBA32F};
    kiln_prefilter_def def;
    kiln_map source = {0}, map = {0};
    float roughness[KILN_MAX_LEVELS];
    kiln_result result = kiln_engine_levels(engine, 0, 0, roughness, &def, error);
    if (!result)
        result = kiln_map_load(context, panorama, NULL, &source, error);
    if (!result) {
        def.tune_for = engine->tune ? engine : NULL;
        result = kiln_prefilter(context, &source, &def, &map, error);
    }
    if (!result)
        result = kiln_map_save(context, &map, path, &save, NULL, error);
    kiln_map_free(&map);
    kiln_map_free(&source);
    return result;
}

static kiln_result save_known(kiln_context *context, const kiln_engine *engine, bool coded,
                              int size, const char *path, kiln_format format, kiln_error *error)
{
    kiln_environment made = {0};
    kiln_map *map = &made.levels;
    kiln_plan *plan = NULL; // knows how the levels are laid out, and is quick where all are rough
    kiln_prefilter_def def;
    float roughness[KILN_MAX_LEVELS], rough[KILN_MAX_LEVELS];
    kiln_result result = kiln_engine_levels(engine, size, 0, roughness, &def, error);
    for (int k = 0; k < KILN_MAX_LEVELS; k++)
        rough[k] = 1;
    def.roughness = rough;
    if (!result)
        result = kiln_plan_create(context, KILN_SHAPE_PANORAMA, 16, &(kiln_bake_def){.levels = def},
                                  &plan, error);
    if (!result)
        result = kiln_plan_environment(plan, &made, error);
    if (!result) {
        memcpy(map->roughness, roughness, (size_t)map->level_count * sizeof *roughness);
        const double scale = scale_for(engine, map);
        const kiln_sh sh = harmonics(coded, scale);
        paint(map, coded, scale);
        result = kiln_engine_save(context, engine, map, &sh, format, path, NULL, error);
    }
    kiln_environment_free(&made);
    kiln_plan_destroy(plan);
    return result;
}

int main(int argc, char **argv)
{
    kiln_context *context = NULL;
    kiln_error error = {0};
    const kiln_engine *engine = argc >= 5 && argc <= 6 ? kiln_engine_find(argv[1]) : NULL;
    bool by_default = engine && !strcmp(argv[2], "default");
    bool coded = engine && !strcmp(argv[2], "coded");
    if (!engine || (!by_default && !coded && strcmp(argv[2], "white") != 0)) {
        fprintf(stderr, "engine_write ENGINE coded|white SIZE PATH [FORMAT]\n"
                        "engine_write ENGINE default PANORAMA PATH\n");
        return 2;
    }
    kiln_result result = kiln_context_create(NULL, &context, &error);
    if (!result && by_default)
        result = save_default(context, engine, argv[3], argv[4], &error);
    else if (!result)
        result = save_known(context, engine, coded, atoi(argv[3]), argv[4],
                            argc == 6 ? (kiln_format)atoi(argv[5]) : KILN_FORMAT_AUTO, &error);
    kiln_context_destroy(context);
    if (result)
        fprintf(stderr, "%s\n", error.message);
    return result != KILN_OK;
}
