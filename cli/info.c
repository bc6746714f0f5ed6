// kiln info: what a file is.
#include "cli.h"

#include <stdio.h>
#include <stdlib.h>

enum { JSON = 1 };

static const struct poptOption options[] = {
    {"json", 0, POPT_ARG_NONE, NULL, JSON, "an array of objects, one a file", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

static void print_engine(const char *name)
{
    const kiln_engine *engine = kiln_engine_find(name);
    if (engine)
        printf("  engine       %s: %s\n  mapping      %s\n", name, engine->title, engine->mapping);
    else if (name[0])
        printf("  engine       %s\n", name);
}

static void print_text(const char *path, const kiln_file_info *info)
{
    char bytes[32];
    printf("%s\n", path);
    printf("  format       %s, %s, %s\n", info->format, info->encoding,
           cli_bytes((double)info->byte_count, bytes));
    printf("  layout       %s, %d x %d", info->layout, info->width, info->height);
    if (info->depth > 1)
        printf(" x %d", info->depth);
    if (info->face_count > 1)
        printf(", %d faces", info->face_count);
    if (info->level_count > 1)
        printf(", %d levels", info->level_count);
    printf(", %d channel%s\n", info->channel_count, info->channel_count == 1 ? "" : "s");
    if (info->roughness[0] >= 0) {
        printf("  roughness   ");
        for (int k = 0; k < info->level_count && k < KILN_MAX_LEVELS; k++)
            printf(" %.4g", (double)info->roughness[k]);
        putchar('\n');
    }
    print_engine(info->engine);
    if (info->table[0])
        printf("  table        %s\n", info->table);
    if (info->orientation[0])
        printf("  orientation  %s\n", info->orientation);
    if (info->sh_bands) {
        printf("  harmonics    %d band%s, %s\n", info->sh_bands, info->sh_bands == 1 ? "" : "s",
               info->sh_irradiance ? "irradiance" : "radiance");
        for (int i = 0; i < info->sh_bands * info->sh_bands; i++)
            printf("    %12.6g %12.6g %12.6g\n", (double)info->sh[i][0], (double)info->sh[i][1],
                   (double)info->sh[i][2]);
    }
    if (info->writer[0])
        printf("  writer       %s\n", info->writer);
}

// The shortest number that is still this float.
static cJSON *number(float value)
{
    char text[32];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value)
            break;
    }
    return cJSON_CreateNumber(strtod(text, NULL));
}

static cJSON *to_json(const char *path, const kiln_file_info *info)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "path", path);
    cJSON_AddStringToObject(json, "format", info->format);
    cJSON_AddStringToObject(json, "encoding", info->encoding);
    cJSON_AddStringToObject(json, "layout", info->layout);
    cJSON_AddNumberToObject(json, "width", info->width);
    cJSON_AddNumberToObject(json, "height", info->height);
    cJSON_AddNumberToObject(json, "depth", info->depth);
    cJSON_AddNumberToObject(json, "face_count", info->face_count);
    cJSON_AddNumberToObject(json, "level_count", info->level_count);
    cJSON_AddNumberToObject(json, "channel_count", info->channel_count);
    cJSON_AddNumberToObject(json, "byte_count", (double)info->byte_count);
    if (info->roughness[0] >= 0) {
        cJSON *roughness = cJSON_AddArrayToObject(json, "roughness");
        for (int k = 0; k < info->level_count && k < KILN_MAX_LEVELS; k++)
            cJSON_AddItemToArray(roughness, number(info->roughness[k]));
    }
    const kiln_engine *engine = kiln_engine_find(info->engine);
    if (info->engine[0])
        cJSON_AddStringToObject(json, "engine", info->engine);
    if (engine)
        cJSON_AddStringToObject(json, "mapping", engine->mapping);
    if (info->table[0])
        cJSON_AddStringToObject(json, "table", info->table);
    if (info->orientation[0])
        cJSON_AddStringToObject(json, "orientation", info->orientation);
    if (info->writer[0])
        cJSON_AddStringToObject(json, "writer", info->writer);
    if (info->sh_bands) {
        cJSON *sh =
            cJSON_AddArrayToObject(json, info->sh_irradiance ? "sh_irradiance" : "sh_radiance");
        for (int i = 0; i < info->sh_bands * info->sh_bands; i++) {
            cJSON *row = cJSON_CreateArray();
            for (int c = 0; c < 3; c++)
                cJSON_AddItemToArray(row, number(info->sh[i][c]));
            cJSON_AddItemToArray(sh, row);
        }
    }
    return json;
}

static int describe(const cli_arguments *a, cli_job *job)
{
    int code = CLI_DONE;
    cJSON *list = a->value[JSON] ? cJSON_CreateArray() : NULL;
    for (int i = 0; i < a->rest_count && !cli_interrupted(); i++) {
        kiln_file_info info;
        if (kiln_file_describe(job->context, a->rest[i], &info, &job->error)) {
            if (!cli_interrupted())
                cli_fail("%s", job->error.message);
            job->error.message[0] = 0; // said
            code = CLI_FAILED;
        } else if (list) {
            cJSON_AddItemToArray(list, to_json(a->rest[i], &info));
        } else {
            print_text(a->rest[i], &info);
        }
    }
    if (list && cli_print_json(list) != CLI_DONE)
        code = CLI_FAILED;
    return cli_interrupted() ? CLI_FAILED : code;
}

static int run(int argc, const char **argv)
{
    cli_arguments a;
    cli_job job;
    int code = cli_arguments_read(&a, &cli_info, argc, argv);
    if (code == CLI_GO && a.rest_count == 0)
        code = cli_wrong(&cli_info, "no input: name a file");
    if (code == CLI_GO) {
        code = cli_job_begin(&job, 1, false);
        if (code == CLI_GO)
            code = describe(&a, &job);
        code = cli_job_end(&job, code);
    }
    cli_arguments_free(&a);
    return code;
}

const cli_command cli_info = {
    .name = "info",
    .arguments = "FILE... [OPTION...]",
    .summary = "Describes files that kiln reads or writes.",
    .details = "Examples:\n"
               "  kiln info city.exr city.ktx2\n"
               "      format, layout, size, roughness of the levels, spherical harmonics\n"
               "  kiln info --json city.ktx2\n"
               "      the same for a program\n",
    .options = options,
    .run = run,
};
