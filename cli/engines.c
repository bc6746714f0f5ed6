// kiln engines: lists the engines that kiln bake --for knows, or describes one engine.
#include "cli.h"
#include "json.h"

#include <stdio.h>
#include <string.h>

typedef struct engines {
    bool json;
} engines;

static const cli_option options[] = {
    {"json", CLI_FLAG, offsetof(engines, json),
     .help = "print an array with one JSON object for each engine"},
    {.name = NULL},
};

static const char *engine_word(int index)
{
    const kiln_engine *engine = kiln_engine_at(index);
    return engine ? engine->name : NULL;
}

static void print_json(json *j, const kiln_engine *engine)
{
    json_object(j, NULL);
    json_text(j, "name", engine->name);
    json_text(j, "title", engine->title);
    json_text(j, "files", engine->files);
    json_text(j, "ending", engine->ending);
    json_text(j, "mapping", engine->mapping);
    json_number(j, "size", engine->size);
    json_number(j, "level_count", engine->level_count);
    json_number(j, "limit", engine->limit);
    json_array(j, "formats");
    for (int k = 0; k < 4 && engine->formats[k]; k++)
        json_text(j, NULL, kiln_format_names()[engine->formats[k]]);
    json_end(j);
    if (engine->format_reason)
        json_text(j, "format_reason", engine->format_reason);
    json_array(j, "endings");
    for (int k = 0; k < 4 && engine->formats[k]; k++)
        json_text(j, NULL, kiln_engine_ending(engine, engine->formats[k]));
    json_end(j);
    json_text(j, "tune", engine->tune ? "sharp" : "none");
    json_text(j, "proof", engine->proof);
    json_end(j);
}

static void print_formats(const kiln_engine *engine)
{
    if (!engine->formats[0])
        return;
    printf("  format       ");
    for (int k = 0; k < 4 && engine->formats[k]; k++)
        printf("%s%s", k ? " or " : "", kiln_format_names()[engine->formats[k]]);
    puts("");
    if (engine->format_reason)
        printf("  by default   %s\n", engine->format_reason);
}

static void print_short(const kiln_engine *engine)
{
    printf("%-14s %s\n  writes       %s, by default %d level%s of %d%s\n", engine->name,
           engine->title, engine->files, engine->level_count, engine->level_count > 1 ? "s" : "",
           engine->size, engine->tune ? ", tuned" : "");
    print_formats(engine);
    printf("  roughness    %s\n  proof        %s\n", engine->mapping, engine->proof);
}

// Prints the size and the roughness of each level of a default bake.
static void print_levels(const kiln_engine *engine)
{
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    kiln_error error;
    if (kiln_engine_levels(engine, 0, 0, roughness, &def, &error))
        return;
    for (int k = 0; k < def.level_count; k++) {
        int size = def.size >> k;
        printf("    level %-2d   size %-5d roughness %.4g\n", k,
               size > def.smallest ? size : def.smallest, (double)roughness[k]);
    }
}

// Prints the engine's documentation page. The file is named by the first word of the engine's name:
// docs/engines/three.md describes three-cubeuv too.
static void print_page(const kiln_engine *engine)
{
    printf("  how to load  docs/engines/%.*s.md\n", (int)strcspn(engine->name, "-"), engine->name);
}

static void print_full(const kiln_engine *engine)
{
    print_short(engine);
    printf("  largest      %g\n  levels       %s\n", engine->limit,
           engine->tune ? "tuned to the engine by default (--tune none writes exact levels), about:"
                        : "exact:");
    print_levels(engine);
    print_page(engine);
}

static int run(const cli_call *call)
{
    cli_arguments a;
    engines values;
    json j = {0};
    const cli_option words = {.word = engine_word};
    int only = -1, code = cli_read_arguments(&a, &cli_engines, call, &values);
    if (code != CLI_GO)
        return code;
    if (a.rest_count > 1)
        return cli_wrong(&cli_engines,
                         "%s: kiln engines takes one engine at a time, and %s is named already",
                         a.rest[1], a.rest[0]);
    if (a.rest_count) {
        code = cli_find_word(&cli_engines, "engine", a.rest[0], &words, &only);
        if (code != CLI_GO)
            return code;
    }
    if (values.json)
        json_array(&j, NULL);
    const kiln_engine *engine;
    for (int i = 0; (engine = kiln_engine_at(i)) != NULL; i++)
        if (only < 0 || i == only) {
            if (values.json)
                print_json(&j, engine);
            else if (only == i)
                print_full(engine);
            else
                print_short(engine);
        }
    if (values.json)
        json_end(&j);
    return CLI_DONE;
}

static const cli_example examples[] = {
    {"kiln engines", "every engine in a few lines"},
    {"kiln engines three",
     "one engine with all levels, and the page that shows how to load the file"},
    {"kiln bake city.exr --for three -o city.ktx2", NULL},
    {NULL, NULL}};

const cli_command cli_engines = {
    .name = "engines",
    .arguments = "[ENGINE] [OPTION...]",
    .summary = "Lists the engines that 'kiln bake --for' knows.",
    .about =
        "The line 'roughness' relates level k of n, or the width w of level 0, to the "
        "roughness r for which the level is filtered. Tuned levels differ from exactly "
        "filtered levels where this reduces the error of the engine's picture (kiln bake "
        "--tune). The line 'by default' names the default format, and compares with it the size "
        "of the file and the error of the picture in the other formats. The line 'proof' says "
        "whether kiln's tests check pixels drawn by the engine, or against which source the "
        "file was checked.",
    .word = engine_word,
    .examples = examples,
    .options = options,
    .run = run,
};
