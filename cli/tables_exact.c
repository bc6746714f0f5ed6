// kiln tables --table KIND -o FILE
#include "tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const formats[] = {"auto", "f32", "f16", "u16", "u8", "rgbd", NULL};

typedef struct exact_job {
    const cli_arguments *a;
    kiln_table_def def;
    kiln_table_save_def save;
    int threads;
    char lookup[2][4096]; // the names of the code's files
} exact_job;

// "N", "WxH" or "WxHxD".
static int read_size(const cli_arguments *a, kiln_table_def *def)
{
    const char *text = a->value[TABLES_SIZE];
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
        return cli_wrong(a->command, "--size is '%s', it must be N, WxH or WxHxD, each 1 to %d",
                         text, KILN_MAX_TABLE);
    def->width = (int)side[0];
    def->height = (int)(count > 1 ? side[1] : side[0]);
    def->depth = (int)side[2];
    return CLI_GO;
}

// Whether a file of that name can be written, and hold what is asked for.
static int check_output(const exact_job *job, const char *path)
{
    kiln_error error = {0};
    if (kiln_table_save_check(path, &job->save, &error))
        return cli_wrong(job->a->command, "%s", error.message);
    return cli_check_folder(path);
}

// NAME_lookup.h and NAME_lookup.glsl.
static int name_lookup(exact_job *job)
{
    const char *path = job->a->value[TABLES_OUTPUT];
    size_t length = strlen(path) - strlen(cli_ending(path)) - 1;
    if (length + sizeof "_lookup.glsl" > sizeof job->lookup[0])
        return cli_fail("%.60s...: the name is too long", path);
    snprintf(job->lookup[0], sizeof job->lookup[0], "%.*s_lookup.h", (int)length, path);
    snprintf(job->lookup[1], sizeof job->lookup[1], "%.*s_lookup.glsl", (int)length, path);
    return CLI_GO;
}

static int read_choices(exact_job *job)
{
    const cli_arguments *a = job->a;
    int kind = 0, axis = 0, format = 0, sheen = 0, code;
    if ((code = cli_choice(a, TABLES_TABLE, "--table", kiln_table_kind_names(), &kind)) != CLI_GO ||
        (code = cli_choice(a, TABLES_AXIS, "--axis", kiln_axis_names(), &axis)) != CLI_GO ||
        (code = cli_choice(a, TABLES_FORMAT, "--format", formats, &format)) != CLI_GO ||
        (code = cli_choice(a, TABLES_SHEEN, "--sheen", kiln_sheen_names(), &sheen)) != CLI_GO ||
        (code = cli_model(a, TABLES_D, TABLES_G, &job->def.model)) != CLI_GO ||
        (code = cli_source_name(a, TABLES_NAME)) != CLI_GO ||
        (code = read_size(a, &job->def)) != CLI_GO)
        return code;
    job->def.kind = (kiln_table_kind)kind;
    job->def.sheen = (kiln_sheen)sheen;
    job->def.axis = (kiln_axis)axis;
    job->def.corners = a->value[TABLES_CORNERS];
    job->def.complement = a->value[TABLES_COMPLEMENT];
    job->def.flip = a->value[TABLES_FLIP];
    job->save.format = (kiln_table_format)format;
    job->save.name = a->value[TABLES_NAME];
    return CLI_GO;
}

// --for: both engines look up the same three numbers, at n.v and roughness of texel centres.
static int take_engine(exact_job *job)
{
    static const struct {
        const char *name, *ending;
        int size;
        kiln_table_format format;
    } engines[] = {{"babylon", "png", 256, KILN_TABLE_FORMAT_RGBD},
                   {"filament", "inc", 128, KILN_TABLE_FORMAT_F16}};
    static const int decided[] = {TABLES_TABLE,   TABLES_D,          TABLES_G,     TABLES_SIZE,
                                  TABLES_AXIS,    TABLES_CORNERS,    TABLES_FLIP,  TABLES_FORMAT,
                                  TABLES_AVERAGE, TABLES_COMPLEMENT, TABLES_LOOKUP};
    const cli_arguments *a = job->a;
    const char *name = a->value[TABLES_FOR];
    if (!name)
        return CLI_GO;
    int i = !strcmp(name, engines[1].name);
    if (strcmp(name, engines[i].name) != 0)
        return cli_wrong(a->command, "--for is '%s', it must be babylon or filament", name);
    for (size_t k = 0; k < sizeof decided / sizeof *decided; k++)
        if (a->value[decided[k]])
            return cli_wrong(a->command, "--for %s decides what --%s is, leave one of them out",
                             name, cli_option_name(a->command, decided[k]));
    if (strcmp(cli_ending(a->value[TABLES_OUTPUT]), engines[i].ending) != 0)
        return cli_wrong(a->command, "--output %s: --for %s writes .%s", a->value[TABLES_OUTPUT],
                         name, engines[i].ending);
    job->def.kind = KILN_TABLE_DFG_MULTISCATTER;
    job->def.width = job->def.height = engines[i].size;
    job->save.format = engines[i].format;
    return CLI_GO;
}

// Options that not every kind has.
static int check_kind(const exact_job *job)
{
    static const struct {
        int option;
        unsigned kinds; // a bit each
    } only[] = {
        {TABLES_AVERAGE, 1U << KILN_TABLE_E},
        {TABLES_SHEEN, 1U << KILN_TABLE_SHEEN},
        {TABLES_PATHS, 1U << KILN_TABLE_E_WALK},
        {TABLES_G, ~(1U << KILN_TABLE_SHEEN | 1U << KILN_TABLE_E_WALK)},
        {TABLES_D, ~(1U << KILN_TABLE_SHEEN | 1U << KILN_TABLE_E_WALK)},
        {TABLES_COMPLEMENT,
         ~(1U << KILN_TABLE_DFG | 1U << KILN_TABLE_DFG_MULTISCATTER | 1U << KILN_TABLE_GLASS)},
    };
    for (size_t i = 0; i < sizeof only / sizeof *only; i++)
        if (job->a->value[only[i].option] && !(only[i].kinds >> job->def.kind & 1))
            return cli_wrong(job->a->command, "--%s is not for --table %s",
                             cli_option_name(job->a->command, only[i].option),
                             kiln_table_kind_names()[job->def.kind]);
    if (job->def.kind == KILN_TABLE_E_WALK && job->a->value[TABLES_AXIS] &&
        job->def.axis != KILN_AXIS_GRAZING)
        return cli_wrong(job->a->command,
                         "--axis %s is not for --table e-walk: its axis is grazing",
                         kiln_axis_names()[job->def.axis]);
    return CLI_GO;
}

// The average must not take the place of another output.
static int check_average(const exact_job *job)
{
    const cli_arguments *a = job->a;
    const char *average = a->value[TABLES_AVERAGE];
    if (average && (!strcmp(average, a->value[TABLES_OUTPUT]) || !strcmp(average, job->lookup[0]) ||
                    !strcmp(average, job->lookup[1])))
        return cli_wrong(a->command, "--average %s: that file is written already", average);
    return CLI_GO;
}

static int read_arguments(exact_job *job)
{
    const cli_arguments *a = job->a;
    int code;
    if (a->rest_count)
        return cli_wrong(a->command, "%s: tables takes no input; name the output by -o FILE",
                         a->rest[0]);
    if (!a->value[TABLES_OUTPUT])
        return cli_wrong(a->command, "no output: name it by -o FILE");
    if (a->value[TABLES_SAMPLES])
        return cli_wrong(a->command, "--samples is for --assignment and --method textbook: what "
                                     "--table makes is not sampled");
    if ((code = read_choices(job)) != CLI_GO ||
        (code = cli_integer(a, TABLES_ZSTD, "--zstd", 1, 22, &job->save.zstd)) != CLI_GO ||
        (code = cli_integer(a, TABLES_PATHS, "--paths", 16, 1 << 24, &job->def.path_count)) !=
            CLI_GO ||
        (code = cli_integer(a, TABLES_THREADS, "--threads", 1, 256, &job->threads)) != CLI_GO)
        return code;
    if ((code = take_engine(job)) != CLI_GO || (code = check_kind(job)) != CLI_GO)
        return code;
    if ((code = check_output(job, a->value[TABLES_OUTPUT])) != CLI_GO)
        return code;
    if (a->value[TABLES_AVERAGE] && (code = check_output(job, a->value[TABLES_AVERAGE])) != CLI_GO)
        return code;
    if (a->value[TABLES_LOOKUP] && (code = name_lookup(job)) != CLI_GO)
        return code;
    return check_average(job);
}

static void report(const cli_job *run, const exact_job *job, const kiln_table *table)
{
    const kiln_table_def *def = &table->def;
    const cli_arguments *a = job->a;
    char size[64], model[64] = "";
    snprintf(size, sizeof size, def->depth > 1 ? "%d x %d x %d" : "%d x %d", def->width,
             def->height, def->depth);
    if (def->kind == KILN_TABLE_SHEEN)
        snprintf(model, sizeof model, "%s, ", kiln_sheen_names()[def->sheen]);
    else
        snprintf(model, sizeof model, "%s, %s, ", kiln_d_names()[def->model.d],
                 kiln_g_names()[def->model.g]);
    printf("%s: %s, %s%s, %s axis, texels at %s, %.2f s\n", a->value[TABLES_OUTPUT],
           kiln_table_kind_names()[def->kind], model, size, kiln_axis_names()[def->axis],
           def->corners ? "corners" : "centres", cli_seconds() - run->began);
    if (a->value[TABLES_AVERAGE])
        printf("%s: the mean of that table, 1024 texels\n", a->value[TABLES_AVERAGE]);
    if (a->value[TABLES_LOOKUP])
        printf("%s, %s: how to look it up\n", job->lookup[0], job->lookup[1]);
}

static int report_json(const cli_job *run, const exact_job *job, const kiln_table *table)
{
    const kiln_table_def *def = &table->def;
    const cli_arguments *a = job->a;
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "output", a->value[TABLES_OUTPUT]);
    cJSON_AddStringToObject(json, "table", kiln_table_kind_names()[def->kind]);
    cJSON_AddStringToObject(json, "d", kiln_d_names()[def->model.d]);
    cJSON_AddStringToObject(json, "g", kiln_g_names()[def->model.g]);
    cJSON_AddNumberToObject(json, "width", def->width);
    cJSON_AddNumberToObject(json, "height", def->height);
    cJSON_AddNumberToObject(json, "depth", def->depth);
    cJSON_AddNumberToObject(json, "channels", table->image.channels);
    cJSON_AddStringToObject(json, "axis", kiln_axis_names()[def->axis]);
    cJSON_AddBoolToObject(json, "corners", def->corners);
    cJSON_AddBoolToObject(json, "complement", def->complement);
    cJSON_AddBoolToObject(json, "flip", def->flip);
    if (a->value[TABLES_AVERAGE])
        cJSON_AddStringToObject(json, "average", a->value[TABLES_AVERAGE]);
    if (a->value[TABLES_LOOKUP]) {
        cJSON *lookup = cJSON_AddArrayToObject(json, "lookup");
        for (int i = 0; i < 2; i++)
            cJSON_AddItemToArray(lookup, cJSON_CreateString(job->lookup[i]));
    }
    cJSON_AddNumberToObject(json, "seconds", cli_seconds() - run->began);
    return cli_print_json(json);
}

// Everything is computed before the first file is written.
static kiln_result make(cli_job *run, const exact_job *job, kiln_table *table, kiln_table *average)
{
    const cli_arguments *a = job->a;
    const char *path = a->value[TABLES_OUTPUT], *mean = a->value[TABLES_AVERAGE];
    kiln_result result = kiln_table_create(run->context, &job->def, table, &run->error);
    if (!result && mean)
        result = kiln_table_average(run->context, table, 0, average, &run->error);
    if (!result)
        result = kiln_table_save(run->context, table, path, &job->save, &run->error);
    if (!result && mean)
        result = kiln_table_save(run->context, average, mean, &job->save, &run->error);
    for (int i = 0; i < 2 && !result && a->value[TABLES_LOOKUP]; i++)
        result = kiln_table_lookup_save(run->context, &table->def, job->lookup[i], job->save.name,
                                        &run->error);
    return result;
}

int tables_exact(const cli_arguments *a)
{
    exact_job job = {.a = a};
    int code = read_arguments(&job);
    if (code != CLI_GO)
        return code;
    cli_job run;
    kiln_table table = {0}, average = {0};
    code = cli_job_begin(&run, job.threads, a->value[TABLES_QUIET]);
    if (code == CLI_GO)
        code = make(&run, &job, &table, &average) ? CLI_FAILED : CLI_DONE;
    cli_clear_progress(&run);
    if (code == CLI_DONE && a->value[TABLES_JSON])
        code = report_json(&run, &job, &table);
    else if (code == CLI_DONE && !a->value[TABLES_QUIET])
        report(&run, &job, &table);
    kiln_table_free(&average);
    kiln_table_free(&table);
    return cli_job_end(&run, code);
}
