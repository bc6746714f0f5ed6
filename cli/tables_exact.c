// kiln tables --table KIND -o FILE. In: the options of kiln tables. Out: a table of an integral in
// the format that the file's ending names, with code that reads it and a table of E_avg if asked
// for. The options are checked together, then kiln_table_create integrates on all threads.
#include "json.h"
#include "tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Reads a size of the form "N", "WxH" or "WxHxD".
static int read_size(tables *t)
{
    kiln_table_def *def = &t->def;
    const char *text = t->size;
    if (!text)
        return CLI_GO;
    long side[3] = {0};
    int count = 0;
    const char *at = text;
    bool more = true;
    for (; more && count < 3; count++) {
        char *end;
        side[count] = strtol(at, &end, 10);
        if (*at < '0' || *at > '9' || side[count] < 1 || side[count] > KILN_MAX_TABLE)
            break;
        more = *end == 'x';
        at = end + more;
    }
    if (more || *at)
        return cli_wrong(t->arguments.command,
                         "--size is '%s', it must be N, WxH or WxHxD, each 1 to %d", text,
                         KILN_MAX_TABLE);
    def->width = (int)side[0];
    def->height = (int)(count > 1 ? side[1] : side[0]);
    def->depth = (int)side[2];
    return CLI_GO;
}

// Checks that a file with this name's ending can hold the table and can be written.
static int check_output(const tables *t, const char *path)
{
    kiln_error error = {0};
    if (kiln_table_save_check(path, &t->save, &error))
        return cli_wrong(t->arguments.command, "%s", error.message);
    return cli_check_folder(path);
}

// Forms the paths NAME_lookup.h and NAME_lookup.glsl.
static int name_lookup(tables *t)
{
    size_t length = strlen(t->output) - strlen(cli_ending(t->output)) - 1;
    if (length + sizeof "_lookup.glsl" > sizeof t->lookup_path[0])
        return cli_fail("%.60s...: the path is too long, choose a shorter one", t->output);
    snprintf(t->lookup_path[0], sizeof t->lookup_path[0], "%.*s_lookup.h", (int)length, t->output);
    snprintf(t->lookup_path[1], sizeof t->lookup_path[1], "%.*s_lookup.glsl", (int)length,
             t->output);
    snprintf(t->lookup_path[2], sizeof t->lookup_path[2], "%.*s_lookup.wgsl", (int)length,
             t->output);
    return CLI_GO;
}

// ----------------------------------------------------------------------------------------- engines

// The table that each engine of --for looks up. Each table holds three numbers at n.v and roughness
// of the texel centres.
static const struct {
    const char *name, *ending;
    int size;
    kiln_table_format format;
} engines[] = {{"babylon", "png", 256, KILN_TABLE_FORMAT_RGBD},
               {"filament", "inc", 128, KILN_TABLE_FORMAT_F16}};

static int apply_engine(tables *t)
{
    static const int decided[] = {TABLES_TABLE,   TABLES_D,          TABLES_G,     TABLES_SIZE,
                                  TABLES_AXIS,    TABLES_CORNERS,    TABLES_FLIP,  TABLES_FORMAT,
                                  TABLES_AVERAGE, TABLES_COMPLEMENT, TABLES_LOOKUP};
    const cli_arguments *a = &t->arguments;
    if (t->engine < 0)
        return CLI_GO;
    const char *name = kiln_engine_at(t->engine)->name;
    size_t at = 0, count = sizeof engines / sizeof *engines;
    while (at < count && strcmp(engines[at].name, name) != 0)
        at++;
    if (at == count)
        return cli_wrong(a->command,
                         "--for %s: kiln has tables for babylon and filament; for the levels of "
                         "other engines there is --table lobes",
                         name);
    for (size_t k = 0; k < sizeof decided / sizeof *decided; k++)
        if (a->text[decided[k]])
            return cli_wrong(t->arguments.command,
                             "--for %s decides what --%s is, leave one of them out", name,
                             t->arguments.command->options[decided[k]].name);
    if (!cli_ends_in(t->output, engines[at].ending))
        return cli_wrong(t->arguments.command, "--output %s: --for %s writes .%s", t->output, name,
                         engines[at].ending);
    t->def.kind = KILN_TABLE_DFG_MULTISCATTER;
    t->def.width = t->def.height = engines[at].size;
    t->save.format = engines[at].format;
    return CLI_GO;
}

// ---------------------------------------------------------------------------------- contradictions

// Checks options that apply only to some kinds of table.
static int check_kind(const tables *t)
{
    static const struct {
        int option;
        unsigned kinds; // one bit for each kind of table that has the option
    } only[] = {
        {TABLES_AVERAGE, 1U << KILN_TABLE_E},
        {TABLES_SHEEN, 1U << KILN_TABLE_SHEEN},
        {TABLES_PATHS, 1U << KILN_TABLE_E_WALK},
        {TABLES_TAPS, 1U << KILN_TABLE_LOBES},
        {TABLES_LEVELS, 1U << KILN_TABLE_LOBES},
        {TABLES_ERROR, 1U << KILN_TABLE_LOBES},
        {TABLES_AXIS, ~(1U << KILN_TABLE_LOBES)},
        {TABLES_FLIP, ~(1U << KILN_TABLE_LOBES)},
        {TABLES_G, ~(1U << KILN_TABLE_SHEEN | 1U << KILN_TABLE_E_WALK)},
        {TABLES_D, ~(1U << KILN_TABLE_SHEEN | 1U << KILN_TABLE_E_WALK | 1U << KILN_TABLE_LOBES)},
        {TABLES_COMPLEMENT, ~(1U << KILN_TABLE_DFG | 1U << KILN_TABLE_DFG_MULTISCATTER |
                              1U << KILN_TABLE_GLASS | 1U << KILN_TABLE_LOBES)},
    };
    const cli_arguments *a = &t->arguments;
    for (size_t i = 0; i < sizeof only / sizeof *only; i++)
        if (a->text[only[i].option] && !(only[i].kinds >> t->def.kind & 1))
            return cli_wrong(t->arguments.command, "--%s is not for --table %s",
                             t->arguments.command->options[only[i].option].name,
                             kiln_table_kind_names()[t->def.kind]);
    if (t->def.kind == KILN_TABLE_LOBES &&
        (t->save.format == KILN_TABLE_FORMAT_U16 || t->save.format == KILN_TABLE_FORMAT_U8 ||
         t->save.format == KILN_TABLE_FORMAT_RGBD))
        return cli_wrong(t->arguments.command,
                         "--table lobes has numbers below 0 and above 1, --format must be f16 or "
                         "f32");
    if (t->def.kind == KILN_TABLE_E_WALK && a->text[TABLES_AXIS] &&
        t->def.axis != KILN_AXIS_GRAZING)
        return cli_wrong(t->arguments.command,
                         "--axis %s is not for --table e-walk: its axis is grazing",
                         kiln_axis_names()[t->def.axis]);
    return CLI_GO;
}

// Checks that the file of --average is none of the other output files.
static int check_average(const tables *t)
{
    const char *average = t->average;
    if (average && (!strcmp(average, t->output) || !strcmp(average, t->lookup_path[0]) ||
                    !strcmp(average, t->lookup_path[1])))
        return cli_wrong(
            t->arguments.command,
            "--average %s: the table or its code is written to this file, name another file",
            average);
    return CLI_GO;
}

static int check_options(tables *t)
{
    const cli_arguments *a = &t->arguments;
    int code;
    if (a->rest_count)
        return cli_wrong(t->arguments.command,
                         "%s: tables takes no input; name the output by -o FILE", a->rest[0]);
    if (!t->output)
        return cli_wrong(t->arguments.command, "no output: name it by -o FILE");
    if (a->text[TABLES_SAMPLES])
        return cli_wrong(t->arguments.command,
                         "--samples is for --assignment and --method textbook: what "
                         "--table makes is not sampled");
    if ((code = cli_check_source_name(a, TABLES_NAME)) != CLI_GO ||
        (code = read_size(t)) != CLI_GO ||
        (code = t->def.kind == KILN_TABLE_LOBES ? tables_read_lobes(t) : apply_engine(t)) !=
            CLI_GO ||
        (code = check_kind(t)) != CLI_GO || (code = check_output(t, t->output)) != CLI_GO)
        return code;
    if (t->average && (code = check_output(t, t->average)) != CLI_GO)
        return code;
    if (t->lookup && (code = name_lookup(t)) != CLI_GO)
        return code;
    return check_average(t);
}

// ------------------------------------------------------------------------------------------ report

// Returns the number of files of code that --lookup writes.
static int lookup_count(const tables *t)
{
    return !t->lookup ? 0 : t->def.kind == KILN_TABLE_LOBES ? 3 : 2;
}

static void report(const cli_work *work, const tables *t, const kiln_table *table)
{
    const kiln_table_def *def = &table->def;
    char size[64], model[64] = "";
    snprintf(size, sizeof size, def->depth > 1 ? "%d x %d x %d" : "%d x %d", def->width,
             def->height, def->depth);
    if (def->kind == KILN_TABLE_SHEEN)
        snprintf(model, sizeof model, "%s, ", kiln_sheen_names()[def->sheen]);
    else
        snprintf(model, sizeof model, "%s, %s, ", kiln_d_names()[def->model.d],
                 kiln_g_names()[def->model.g]);
    printf("%s: %s, %s%s, %s axis, texels at %s, %.2f s\n", cli_show(t->output).text,
           kiln_table_kind_names()[def->kind], model, size, kiln_axis_names()[def->axis],
           def->corners ? "corners" : "centres", cli_elapsed(work));
    if (t->average)
        printf("%s: the average of this table, 1024 texels\n", cli_show(t->average).text);
    for (int i = 0; i < lookup_count(t); i++)
        printf("%s%s", cli_show(t->lookup_path[i]).text,
               i + 1 < lookup_count(t) ? ", " : ": code that looks the table up\n");
    if (t->error)
        printf("%s: expected errors of the split sum straight, bent, and of the table\n",
               cli_show(t->error).text);
}

static void report_json(const cli_work *work, const tables *t, const kiln_table *table)
{
    const kiln_table_def *def = &table->def;
    json j = {0};
    json_object(&j, NULL);
    json_text(&j, "output", t->output);
    json_text(&j, "table", kiln_table_kind_names()[def->kind]);
    json_text(&j, "d", kiln_d_names()[def->model.d]);
    json_text(&j, "g", kiln_g_names()[def->model.g]);
    json_number(&j, "width", def->width);
    json_number(&j, "height", def->height);
    json_number(&j, "depth", def->depth);
    json_number(&j, "channels", table->image.channels);
    json_text(&j, "axis", kiln_axis_names()[def->axis]);
    json_bool(&j, "corners", def->corners);
    json_bool(&j, "complement", def->complement);
    json_bool(&j, "flip", def->flip);
    if (def->kind == KILN_TABLE_LOBES) {
        json_number(&j, "taps", def->tap_count);
        json_array(&j, "roughness");
        for (int i = 0; i < def->level_count; i++)
            json_number(&j, NULL, (double)def->level_roughness[i]);
        json_end(&j);
    }
    if (t->error)
        json_text(&j, "error", t->error);
    if (t->average)
        json_text(&j, "average", t->average);
    if (t->lookup) {
        json_array(&j, "lookup");
        for (int i = 0; i < lookup_count(t); i++)
            json_text(&j, NULL, t->lookup_path[i]);
        json_end(&j);
    }
    json_number(&j, "seconds", cli_elapsed(work));
    json_end(&j);
}

// ------------------------------------------------------------------------------------------- work

// Computes all tables before the first file is written.
static kiln_result make(cli_work *work, const tables *t, kiln_table *table, kiln_table *average)
{
    kiln_context *context = work->context;
    kiln_result result = kiln_table_create(context, &t->def, table, &work->error);
    if (!result && t->average)
        result = kiln_table_average(context, table, 0, average, &work->error);
    if (!result)
        result = kiln_table_save(context, table, t->output, &t->save, &work->error);
    if (!result && t->average)
        result = kiln_table_save(context, average, t->average, &t->save, &work->error);
    if (!result && t->error)
        result = tables_draw_error(work, t, table);
    for (int i = 0; i < lookup_count(t) && !result; i++)
        result = kiln_table_lookup_save(context, &table->def, t->lookup_path[i], t->save.name,
                                        &work->error);
    return result;
}

int tables_make_exact(tables *t)
{
    int code = check_options(t);
    if (code != CLI_GO)
        return code;
    cli_work work;
    kiln_table table = {0}, average = {0};
    code = cli_begin_work(&work, t->threads, t->quiet);
    if (code == CLI_GO)
        code = make(&work, t, &table, &average) ? CLI_FAILED : CLI_DONE;
    cli_clear_progress(&work);
    if (code == CLI_DONE && t->json)
        report_json(&work, t, &table);
    else if (code == CLI_DONE && !t->quiet)
        report(&work, t, &table);
    kiln_table_free(&average);
    kiln_table_free(&table);
    return cli_end_work(&work, code);
}
