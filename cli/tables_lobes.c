// kiln tables --table lobes: what this kind has beyond other kinds. In: the number of taps, the
// levels of the prefiltered environment, and with --error the name of a picture. Out: the fields of
// a kiln_table_def, and a picture of expected errors by roughness and n.v.
#include "tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Reads the roughness of each level, "0,0.2,0.5,1".
static int read_list(tables *t)
{
    kiln_table_def *def = &t->def;
    const char *at = t->levels;
    int count = 0;
    for (bool more = true; more; at += more, count++) {
        char *end;
        double value = strtod(at, &end);
        if (count == KILN_MAX_LEVELS || end == at || !(value >= 0 && value <= 1) ||
            (count && !((float)value > def->level_roughness[count - 1])) || (*end && *end != ','))
            return cli_wrong(t->arguments.command,
                             "--levels is '%s', it must be a number of levels from 2 to %d, or the "
                             "increasing roughness of each level as R,R,..., each 0 to 1",
                             t->levels, KILN_MAX_LEVELS);
        def->level_roughness[count] = (float)value;
        more = *end == ',';
        at = end;
    }
    def->level_count = count;
    return CLI_GO;
}

static int read_levels(tables *t)
{
    if (!t->levels)
        return CLI_GO;
    if (strchr(t->levels, ','))
        return read_list(t);
    return cli_integer(&t->arguments, TABLES_LEVELS, 2, KILN_MAX_LEVELS, &t->def.level_count);
}

// Takes the levels that an engine reads.
static int apply_engine(tables *t)
{
    if (t->engine < 0)
        return CLI_GO;
    const kiln_engine *engine = kiln_engine_at(t->engine);
    kiln_prefilter_def levels;
    kiln_error error = {0};
    if (t->levels && strchr(t->levels, ','))
        return cli_wrong(t->arguments.command,
                         "--for %s decides the roughness of each level, give --levels a number or "
                         "leave it out",
                         engine->name);
    if (kiln_engine_levels(engine, 0, t->def.level_count, t->def.level_roughness, &levels, &error))
        return cli_wrong(t->arguments.command, "%s", error.message);
    if (levels.level_count < 2)
        return cli_wrong(
            t->arguments.command,
            "--for %s: this engine filters the environment itself, leave --for out and "
            "give --levels",
            engine->name);
    // Some engines repeat their last roughness, and taps need none of the repeated levels.
    t->def.level_count = 1;
    while (t->def.level_count < levels.level_count &&
           levels.roughness[t->def.level_count] > levels.roughness[t->def.level_count - 1])
        t->def.level_count++;
    return CLI_GO;
}

int tables_read_lobes(tables *t)
{
    int code = read_levels(t);
    if (code == CLI_GO)
        code = apply_engine(t);
    if (code == CLI_GO && t->error && !cli_ends_in(t->error, "png"))
        code = cli_wrong(t->arguments.command, "--error %s: must end in .png", t->error);
    return code == CLI_GO && t->error ? cli_check_folder(t->error) : code;
}

// ----------------------------------------------------------------------------------------- picture

// The picture has three squares of SIDE x SIDE pixels side by side, with gaps.
enum { SIDE = 256, GAP = 8, WIDTH = 3 * SIDE + 2 * GAP };

// Returns the number of errors along a side of a square, which divides SIDE: 32, or about twice the
// columns of a smaller table.
static int point_count(const kiln_table *table)
{
    int points = 32;
    while (points > 8 && points > 2 * table->def.width)
        points /= 2;
    return points;
}

// Sets the colour of an error: bands of a factor of two, from black below 1 % to white from 64 %
// on.
static void color_of(double error, float rgb[3])
{
    static const float colors[8][3] = {
        {0, 0, 0},           {0.02f, 0.02f, 0.2f}, {0.05f, 0.1f, 0.6f},  {0.05f, 0.4f, 0.4f},
        {0.3f, 0.6f, 0.05f}, {0.9f, 0.5f, 0.02f},  {0.8f, 0.05f, 0.02f}, {1, 1, 1}};
    int band = 0;
    for (double limit = 0.01; band < 7 && error >= limit; limit *= 2)
        band++;
    memcpy(rgb, colors[band], sizeof colors[band]);
}

static void draw(const kiln_lobes_error *errors, int points, kiln_image *picture)
{
    int dot = SIDE / points;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < WIDTH; x++) {
            int square = x / (SIDE + GAP), column = x % (SIDE + GAP) / dot;
            float *pixel = picture->pixels + 3 * ((size_t)y * WIDTH + (size_t)x);
            if (column >= points) {
                pixel[0] = pixel[1] = pixel[2] = 0.5f;
                continue;
            }
            const kiln_lobes_error *e = errors + (size_t)(y / dot) * (size_t)points + column;
            color_of(square == 0 ? e->straight : square == 1 ? e->bent : e->table, pixel);
        }
}

kiln_result tables_draw_error(cli_work *work, const tables *t, const kiln_table *table)
{
    int points = point_count(table), count = points * points;
    double *nov = malloc((size_t)count * sizeof *nov);
    double *roughness = malloc((size_t)count * sizeof *roughness);
    kiln_lobes_error *errors = malloc((size_t)count * sizeof *errors);
    kiln_image picture = {0};
    kiln_result result = nov && roughness && errors ? KILN_OK : KILN_ERROR_MEMORY;
    if (result)
        snprintf(work->error.message, sizeof work->error.message, "out of memory");
    for (int i = 0; i < count && !result; i++) {
        int row = i / points;
        nov[i] = (i % points + 0.5) / points;
        roughness[i] = (row + 0.5) / points;
    }
    if (!result)
        result =
            kiln_lobes_errors(work->context, table, nov, roughness, count, errors, &work->error);
    if (!result)
        result = kiln_image_create(work->context, WIDTH, SIDE, 3, &picture, &work->error);
    if (!result) {
        draw(errors, points, &picture);
        result = kiln_image_save(work->context, &picture, t->error, &work->error);
    }
    kiln_image_free(&picture);
    free(errors);
    free(roughness);
    free(nov);
    return result;
}
