// kiln info. In: a file. Out: its format, shape, levels, metadata and harmonics, as text or JSON.
#include "json.h"
#include "work.h"

#include <stdio.h>
#include <string.h>

typedef struct info_values {
    bool json, lights;
} info_values;

static const cli_option options[] = {
    {"json", CLI_FLAG, offsetof(info_values, json),
     .help = "print an array with one JSON object for each file"},
    {"lights", CLI_FLAG, offsetof(info_values, lights),
     .help = "read the texels of environments too, and list the sun and other compact lights as "
             "'kiln lights' does"},
    {.name = NULL},
};

static void print_engine(const char *name)
{
    const kiln_engine *engine = kiln_engine_find(name);
    if (engine)
        printf("  engine       %s: %s\n  mapping      %s\n", name, engine->title, engine->mapping);
    else if (name[0])
        printf("  engine       %s\n", name);
}

// Prints the layers of an EXR file, unless the file has nothing but one layer without a name.
static void print_layers(const kiln_file_info *info)
{
    if (info->part_count < 2 && info->layer_count < 2 && !info->layer[0].name[0])
        return;
    printf("  layers       %d in %d part%s\n", info->layer_count, info->part_count,
           info->part_count == 1 ? "" : "s");
    int shown = info->layer_count < KILN_MAX_LAYERS ? info->layer_count : KILN_MAX_LAYERS;
    for (int i = 0; i < shown; i++) {
        const kiln_layer_info *layer = &info->layer[i];
        const char *name = layer->name[0] ? layer->name : "(no name)";
        printf("    %s", name);
        if (layer->part[0])
            printf(" in part %s", layer->part);
        printf(": %s%s\n", layer->channels, layer->picture ? ", the picture" : "");
    }
    if (shown < info->layer_count)
        printf("    and %d more\n", info->layer_count - shown);
}

// Prints a KTX file's orientation, such as "rd" or "S=r,T=d", and what it says of the order of
// texels.
static void print_orientation(const char *text)
{
    static const char *const words[][2] = {
        {"r", "texels to the right"}, {"l", "texels to the left"},
        {"d", "rows down"},           {"u", "rows up"},
        {"i", "slices inwards"},      {"o", "slices outwards"}};
    printf("  orientation  %s", text);
    const char *separator = ": ";
    bool known = strspn(text, "rludioSTR=,") == strlen(text);
    for (const char *at = text; known && *at; at++)
        for (size_t i = 0; i < sizeof words / sizeof *words; i++)
            if (*at == *words[i][0]) {
                printf("%s%s", separator, words[i][1]);
                separator = ", ";
            }
    putchar('\n');
}

static void print_text(const char *path, const kiln_file_info *info, const kiln_lights *lights)
{
    char bytes[32];
    printf("%s\n", cli_show(path).text);
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
    print_layers(info);
    print_engine(info->engine);
    if (info->table[0])
        printf("  table        %s\n", info->table);
    if (info->orientation[0])
        print_orientation(info->orientation);
    if (info->sh_bands) {
        printf("  harmonics    %d band%s, %s\n", info->sh_bands, info->sh_bands == 1 ? "" : "s",
               info->sh_irradiance ? "irradiance" : "radiance");
        for (int i = 0; i < info->sh_bands * info->sh_bands; i++)
            printf("    %12.6g %12.6g %12.6g\n", (double)info->sh[i][0], (double)info->sh[i][1],
                   (double)info->sh[i][2]);
    }
    if (info->writer[0])
        printf("  writer       %s\n", info->writer);
    kiln_note note;
    for (int i = 0; kiln_load_report_note(&info->report, i, &note); i++)
        printf("  %-12s %s\n", note.warning ? "warning" : "note", note.text);
    if (lights && !lights->count)
        printf("  lights       none that are compact\n");
    else if (lights)
        cli_print_lights(lights);
}

static void print_roughness_json(json *j, const kiln_file_info *info)
{
    json_array(j, "roughness");
    for (int k = 0; k < info->level_count && k < KILN_MAX_LEVELS; k++)
        json_float(j, NULL, info->roughness[k]);
    json_end(j);
}

// Writes the spherical harmonics of a file as JSON: three channels for each coefficient.
static void print_sh_json(json *j, const kiln_file_info *info)
{
    json_array(j, info->sh_irradiance ? "sh_irradiance" : "sh_radiance");
    for (int i = 0; i < info->sh_bands * info->sh_bands; i++) {
        json_array(j, NULL);
        for (int c = 0; c < 3; c++)
            json_float(j, NULL, info->sh[i][c]);
        json_end(j);
    }
    json_end(j);
}

static void print_layers_json(json *j, const kiln_file_info *info)
{
    json_number(j, "part_count", info->part_count);
    json_number(j, "layer_count", info->layer_count);
    json_array(j, "layers");
    for (int i = 0; i < info->layer_count && i < KILN_MAX_LAYERS; i++) {
        const kiln_layer_info *layer = &info->layer[i];
        json_object(j, NULL);
        json_text(j, "part", layer->part);
        json_text(j, "name", layer->name);
        json_text(j, "channels", layer->channels);
        json_bool(j, "picture", layer->picture);
        json_end(j);
    }
    json_end(j);
}

static void print_json(json *j, const char *path, const kiln_file_info *info,
                       const kiln_lights *lights)
{
    json_object(j, NULL);
    json_text(j, "path", path);
    json_text(j, "format", info->format);
    json_text(j, "encoding", info->encoding);
    json_text(j, "layout", info->layout);
    json_number(j, "width", info->width);
    json_number(j, "height", info->height);
    json_number(j, "depth", info->depth);
    json_number(j, "face_count", info->face_count);
    json_number(j, "level_count", info->level_count);
    json_number(j, "channel_count", info->channel_count);
    json_number(j, "byte_count", (double)info->byte_count);
    if (info->roughness[0] >= 0)
        print_roughness_json(j, info);
    const kiln_engine *engine = kiln_engine_find(info->engine);
    if (info->engine[0])
        json_text(j, "engine", info->engine);
    if (engine)
        json_text(j, "mapping", engine->mapping);
    if (info->table[0])
        json_text(j, "table", info->table);
    if (info->orientation[0])
        json_text(j, "orientation", info->orientation);
    if (info->writer[0])
        json_text(j, "writer", info->writer);
    if (info->sh_bands)
        print_sh_json(j, info);
    if (info->layer_count)
        print_layers_json(j, info);
    json_notes(j, &info->report);
    if (lights)
        json_lights(j, lights);
    json_end(j);
}

// Finds the lights of a file. A file that holds no environment has none.
static kiln_result find_lights(cli_work *work, const char *path, const kiln_file_info *info,
                               kiln_lights *lights)
{
    static const char *const layouts[] = {"panorama", "cross", "strip", "cube", "octahedron"};
    const kiln_lights_def def = {.share = 0.001};
    kiln_map map = {0};
    bool has_map = false;
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        has_map |= !strcmp(info->layout, layouts[i]);
    lights->count = 0;
    if (!has_map)
        return KILN_OK;
    kiln_result result = kiln_map_load(work->context, path, NULL, &map, &work->error);
    if (result == KILN_OK)
        result = kiln_lights_find(work->context, &map, &def, lights, &work->error);
    kiln_map_free(&map);
    return result;
}

static int describe(const cli_arguments *a, const info_values *values, cli_work *work)
{
    int code = CLI_DONE;
    json j = {0};
    if (values->json)
        json_array(&j, NULL);
    for (int i = 0; i < a->rest_count && !cli_interrupted(); i++) {
        kiln_file_info info;
        kiln_lights found = {0}, *lights = values->lights ? &found : NULL;
        if (kiln_file_describe(work->context, a->rest[i], &info, &work->error) ||
            (lights && find_lights(work, a->rest[i], &info, lights))) {
            if (!cli_interrupted())
                cli_fail("%s", work->error.message);
            work->error.message[0] = 0; // keeps cli_end_work from printing the message again
            code = CLI_FAILED;
        } else if (values->json) {
            print_json(&j, a->rest[i], &info, lights);
        } else {
            print_text(a->rest[i], &info, lights);
        }
    }
    if (values->json)
        json_end(&j);
    return cli_interrupted() ? CLI_FAILED : code;
}

static int run(const cli_call *call)
{
    cli_arguments a;
    cli_work work;
    info_values values;
    int code = cli_read_arguments(&a, &cli_info, call, &values);
    if (code != CLI_GO)
        return code;
    if (a.rest_count == 0)
        return cli_wrong(&cli_info, "no input is named, name a file");
    code = cli_begin_work(&work, 1, false);
    if (code == CLI_GO)
        code = describe(&a, &values, &work);
    return cli_end_work(&work, code);
}

static const cli_example examples[] = {
    {"kiln info city.exr city.ktx2",
     "prints format, layout, size, roughness of the levels and spherical harmonics"},
    {"kiln info --json city.ktx2", "prints the same as JSON for a program"},
    {NULL, NULL}};

const cli_command cli_info = {
    .name = "info",
    .arguments = "FILE... [OPTION...]",
    .summary = "Describes files that kiln reads or writes.",
    .about =
        "For each file kiln prints the format, encoding, layout, size, the roughness of the "
        "levels, the spherical harmonics, the layers of an EXR file, the engine that the file "
        "is for, and what kiln chooses, converts and assumes when the file is read. Files that "
        "kiln writes only, such as .env and .glb, are described too. A folder with six faces, or a "
        "pattern such as city_{face}.exr, is described as a cube.",
    .examples = examples,
    .options = options,
    .run = run,
};
