// The web page's checks of files (checker.h), compiled to WebAssembly. In: a file of levels or
// harmonics of any tool, and the source of the baker. Out: errors, findings in words, a picture of
// the differences, and the file's levels as textures for the view. The library's functions of
// <kiln/check.h> do the work.
#include "checker.h"

#include <kiln/check.h>

#include <stdlib.h>
#include <string.h>

struct checker {
    baker *baker;
    kiln_map levels; // of the file, in the file's axes
    kiln_image picture;
    kiln_check_levels_report report;
    kiln_check_sh_report sh_report;
};

checker *checker_create(baker *b)
{
    checker *c = calloc(1, sizeof *c);
    if (c)
        c->baker = b;
    return c;
}

static void clear(checker *c)
{
    baker *b = c->baker;
    kiln_map_free(&c->levels);
    kiln_image_free(&c->picture);
    *c = (checker){.baker = b};
}

static kiln_result check_levels(checker *c, const char *path, const kiln_engine *engine)
{
    baker *b = c->baker;
    kiln_context *context = baker_context(b);
    kiln_error *error = baker_error(b);
    kiln_map difference = {0};
    kiln_check_levels_def def = {.engine = engine};
    kiln_result result = kiln_levels_load(context, path, engine, NULL, &c->levels, error);
    if (result == KILN_OK) {
        def.stated = !engine && c->levels.roughness[0] >= 0;
        result = kiln_check_levels(context, baker_source(b), &c->levels, &def, &c->report,
                                   &difference, error);
    }
    if (result == KILN_OK)
        result = kiln_check_picture(context, &difference, &c->picture, error);
    kiln_map_free(&difference);
    return result;
}

static kiln_result check_harmonics(checker *c, const kiln_file_info *info,
                                   const kiln_engine *engine)
{
    baker *b = c->baker;
    kiln_sh sh = {.bands = info->sh_bands, .irradiance = info->sh_irradiance};
    for (int i = 0; i < sh.bands * sh.bands; i++)
        for (int k = 0; k < 3; k++)
            sh.c[i][k] = (double)info->sh[i][k];
    return kiln_check_sh(baker_context(b), baker_source(b), &sh, engine, &c->sh_report,
                         baker_error(b));
}

bool checker_run(checker *c, const char *path, int index)
{
    kiln_file_info info;
    baker *b = c->baker;
    clear(c);
    kiln_result result = kiln_file_describe(baker_context(b), path, &info, baker_error(b));
    // A file that states its engine is for that engine.
    const kiln_engine *engine = index >= 0 ? kiln_engine_at(index) : kiln_engine_find(info.engine);
    if (result == KILN_OK && strcmp(info.layout, "harmonics") != 0)
        result = check_levels(c, path, engine);
    if (result == KILN_OK && info.sh_bands)
        result = check_harmonics(c, &info, engine);
    if (result != KILN_OK)
        clear(c);
    return result == KILN_OK;
}

int checker_count(const checker *c, int what)
{
    return what == 0   ? c->report.level_count
           : what == 1 ? c->report.findings.count + c->sh_report.findings.count
                       : c->sh_report.bands;
}

double checker_level(const checker *c, int level, int what)
{
    const kiln_check_level *l = &c->report.level[level];
    const double numbers[] = {l->size,    l->roughness, l->found,  l->rms,
                              l->largest, l->bias,      l->energy, l->seam};
    return numbers[what];
}

static const kiln_finding *find(const checker *c, int index)
{
    int count = c->report.findings.count;
    return index < count ? &c->report.findings.finding[index]
                         : &c->sh_report.findings.finding[index - count];
}

bool checker_is_harmonic(const checker *c, int index)
{
    return index >= c->report.findings.count;
}

const char *checker_finding(const checker *c, int index)
{
    return find(c, index)->text;
}

bool checker_is_fault(const checker *c, int index)
{
    return find(c, index)->fault;
}

double checker_error(const checker *c, int what)
{
    return what == 0 ? c->report.worst : c->sh_report.rms;
}

double checker_band(const checker *c, int band)
{
    return c->sh_report.band[band];
}

const float *checker_picture(const checker *c)
{
    return c->picture.pixels;
}

// Copies level `k` of a map of any shape to the same level of a cube, where the cube's levels halve
// down to the last level.
static kiln_result copy_level(kiln_context *context, const kiln_map *from, int k, kiln_map *cube,
                              kiln_error *error)
{
    kiln_map made;
    const kiln_map level = {.shape = from->shape,
                            .size = kiln_map_level_size(from, k),
                            .level_count = 1,
                            .level = {from->level[k]}};
    kiln_result result = kiln_map_convert(context, &level, KILN_SHAPE_CUBE,
                                          kiln_map_level_size(cube, k), 0, &made, error);
    if (result != KILN_OK)
        return result;
    memcpy(cube->level[k], made.level[0], 3 * sizeof(float) * kiln_map_texels(&made, 0));
    kiln_map_free(&made);
    return KILN_OK;
}

bool checker_scenery(checker *c)
{
    kiln_context *context = baker_context(c->baker);
    kiln_error *error = baker_error(c->baker);
    const kiln_check_levels_report *report = &c->report;
    kiln_map shown, cube = {0};
    int count = 0;
    kiln_result result = kiln_levels_unturn(context, &c->levels, report->wanted_axis,
                                            report->wanted_sign, &shown, error);
    if (result != KILN_OK)
        return false;
    while (count < shown.level_count && shown.size >> count > 0)
        count++;
    result = kiln_map_create(context, KILN_SHAPE_CUBE, shown.size, count, &cube, error);
    for (int k = 0; k < count && result == KILN_OK; k++) {
        cube.roughness[k] = (float)report->level[k].roughness;
        result = copy_level(context, &shown, k, &cube, error);
    }
    kiln_map_free(&shown);
    if (result == KILN_OK)
        baker_take_levels(c->baker, &cube);
    else
        kiln_map_free(&cube);
    return result == KILN_OK;
}
