// kiln engines: what --for knows.
#include "cli.h"

#include <stdio.h>

enum { JSON = 1 };

static const struct poptOption options[] = {
    {"json", 0, POPT_ARG_NONE, NULL, JSON, "the same as JSON", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

static int list_json(void)
{
    cJSON *json = cJSON_CreateArray();
    const kiln_engine *engine;
    for (int i = 0; (engine = kiln_engine_at(i)) != NULL; i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "name", engine->name);
        cJSON_AddStringToObject(row, "title", engine->title);
        cJSON_AddStringToObject(row, "files", engine->files);
        cJSON_AddStringToObject(row, "ending", engine->ending);
        cJSON_AddStringToObject(row, "mapping", engine->mapping);
        cJSON_AddNumberToObject(row, "size", engine->size);
        cJSON_AddNumberToObject(row, "level_count", engine->level_count);
        cJSON_AddNumberToObject(row, "limit", engine->limit);
        cJSON *formats = cJSON_AddArrayToObject(row, "formats");
        for (int k = 0; formats && k < 4 && engine->formats[k]; k++)
            cJSON_AddItemToArray(formats,
                                 cJSON_CreateString(kiln_format_names()[engine->formats[k]]));
        cJSON_AddStringToObject(row, "fit", engine->tune ? "sharp" : "none");
        cJSON_AddStringToObject(row, "proof", engine->proof);
        cJSON_AddItemToArray(json, row);
    }
    return cli_print_json(json);
}

static void print(const kiln_engine *engine)
{
    printf("%-14s %s\n  writes       %s, by default %d level%s of %d%s\n", engine->name,
           engine->title, engine->files, engine->level_count, engine->level_count > 1 ? "s" : "",
           engine->size, engine->tune ? ", fitted" : "");
    if (engine->formats[0]) {
        printf("  format       ");
        for (int k = 0; k < 4 && engine->formats[k]; k++)
            printf("%s%s", k ? " or " : "", kiln_format_names()[engine->formats[k]]);
        puts("");
    }
    printf("  roughness    %s\n  proof        %s\n", engine->mapping, engine->proof);
}

static int run(int argc, const char **argv)
{
    cli_arguments arguments;
    int code = cli_arguments_read(&arguments, &cli_engines, argc, argv);
    if (code == CLI_GO && arguments.rest_count)
        code = cli_wrong(&cli_engines, "%s: nothing but options is expected", arguments.rest[0]);
    if (code == CLI_GO && arguments.value[JSON])
        code = list_json();
    if (code == CLI_GO) {
        const kiln_engine *engine;
        for (int i = 0; (engine = kiln_engine_at(i)) != NULL; i++)
            print(engine);
        code = CLI_DONE;
    }
    cli_arguments_free(&arguments);
    return code;
}

const cli_command cli_engines = {
    .name = "engines",
    .arguments = "[OPTION...]",
    .summary = "Lists the engines that 'kiln bake --for' knows.",
    .details =
        "Level k of n, of a size of w texels, is filtered for roughness r; fitted levels differ\n"
        "from that where the engine then shows less error (kiln bake --fit). The proof of a file "
        "is\n"
        "what the engine's own pixels show in kiln's tests, or else what was read of it.\n"
        "\n"
        "Examples:\n"
        "  kiln engines\n"
        "  kiln bake city.exr --for three -o city.ktx2\n",
    .options = options,
    .run = run,
};
