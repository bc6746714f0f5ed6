// kiln lights. In: an environment. Out: its compact sources of light, such as the sun, as text or
// JSON, and as a file.
#include "json.h"
#include "work.h"

#include <math.h>
#include <stdio.h>

enum { LIGHTS, SHARE, OUTPUT, LAYER, NEGATIVE, JSON, QUIET, OPTIONS };

typedef struct lights_values {
    const char *output, *layer;
    kiln_lights_def def;
    int negative;
    bool json, quiet;
} lights_values;

#define AT(field) offsetof(lights_values, field)

static const cli_option options[OPTIONS + 1] = {
    [LIGHTS] = {"lights", CLI_INTEGER, AT(def.count), 1, KILN_MAX_LIGHTS, KILN_MAX_LIGHTS, "N",
                .help = "list N lights at most, those with the largest shares"},
    [SHARE] = {"lights-share", CLI_NUMBER, AT(def.share), 0, 1, 0.001, "S",
               .help = "list lights that hold at least this part of all light"},
    [OUTPUT] = {"output", CLI_FILE, AT(output), .value = "FILE", .letter = 'o',
                .help = "write the lights to a .json file too"},
    [LAYER] = CLI_LAYER_ROW(lights_values),
    [NEGATIVE] = CLI_NEGATIVE_ROW(lights_values),
    [JSON] = {"json", CLI_FLAG, AT(json), .help = "print JSON for a program"},
    [QUIET] = CLI_QUIET_ROW(lights_values),
};

void cli_print_lights(const kiln_lights *lights)
{
    for (int i = 0; i < lights->count; i++) {
        const kiln_light *l = &lights->light[i];
        const double *d = l->direction, *e = l->irradiance;
        printf("  light %-2d  direction %7.4f %7.4f %7.4f  irradiance %.4g %.4g %.4g  "
               "radius %.3g degrees  %.2f %% of the light, %zu texel%s\n",
               i + 1, d[0], d[1], d[2], e[0], e[1], e[2], l->angular_radius, 100 * l->share,
               l->texel_count, l->texel_count == 1 ? "" : "s");
    }
}

static void report(const lights_values *v, const char *name, const kiln_lights *lights)
{
    double share = 0;
    for (int i = 0; i < lights->count; i++)
        share += lights->light[i].share;
    if (v->json) {
        json j = {0};
        json_object(&j, NULL);
        json_lights(&j, lights);
        json_end(&j);
    } else if (!v->quiet) {
        printf("%s: %d compact light%s with %.2f %% of the light\n", cli_show(name).text,
               lights->count, lights->count == 1 ? "" : "s", 100 * share);
        cli_print_lights(lights);
    }
}

static int work(cli_work *w, const cli_arguments *a, const lights_values *v, kiln_map *map)
{
    kiln_lights lights;
    const kiln_load_def load = {.negative = (kiln_negative)v->negative, .layer = v->layer};
    int code = cli_load(w, a->rest, a->rest_count, &load, map);
    if (code != CLI_GO)
        return code;
    if (kiln_lights_find(w->context, map, &v->def, &lights, &w->error) ||
        (v->output && kiln_lights_save(w->context, &lights, v->output, &w->error)))
        return CLI_FAILED;
    cli_clear_progress(w);
    report(v, a->rest[0], &lights);
    return CLI_DONE;
}

static int run(const cli_call *call)
{
    lights_values v = {0};
    cli_arguments a;
    cli_work w;
    kiln_map map = {0};
    int code = cli_read_arguments(&a, &cli_lights, call, &v);
    if (code == CLI_GO)
        code = cli_check_input(&cli_lights, a.rest, a.rest_count);
    if (code == CLI_GO && v.output && !cli_ends_in(v.output, "json"))
        code = cli_wrong(&cli_lights, "--output %s: must end in .json", v.output);
    if (code == CLI_GO && v.output)
        code = cli_check_folder(v.output);
    if (code != CLI_GO)
        return code;
    if (v.def.share == 0)
        v.def.share = KILN_ZERO; // the library reads 0 as its default, and KILN_ZERO as zero
    code = cli_begin_work(&w, 0, v.quiet);
    if (code == CLI_GO)
        code = work(&w, &a, &v, &map);
    kiln_map_free(&map);
    return cli_end_work(&w, code);
}

static const cli_example examples[] = {
    {"kiln lights city.exr", "lists the sun, lamps and bright windows, the largest share first"},
    {"kiln lights city.exr --lights 1 -o sun.json", "writes the light with the largest share"},
    {NULL, NULL}};

const cli_command cli_lights = {
    .name = "lights",
    .arguments = "IN... [OPTION...]",
    .summary = "Lists the sun and other compact lights of a panorama.",
    .about =
        "For each light kiln prints the direction (x to the right of the centre of a panorama, "
        "y up, z away from the centre), the irradiance of a surface that faces the light, the "
        "angular radius of a disc of the same radiance, and the light's part of all light. "
        "'kiln bake --sun extract' takes lights out of what is baked.",
    .examples = examples,
    .options = options,
    .run = run,
};
