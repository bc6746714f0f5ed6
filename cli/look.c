// Options of a view into numbers, and a name into an environment.
#include "look.h"

#include <stdio.h>
#include <string.h>

const struct poptOption look_options[] = {
    {"scene", 0, POPT_ARG_STRING, NULL, LOOK_SCENE,
     "assignment, ibl, furnace, grid or compare (assignment, or ibl with an ENV)", "SCENE"},
    {"method", 0, POPT_ARG_STRING, NULL, LOOK_METHOD,
     "single, kulla-conty, handout, fdez-aguera or turquin, of the upper row", "METHOD"},
    {"material", 0, POPT_ARG_STRING, NULL, LOOK_MATERIAL,
     "gold, copper, aluminium, silver, iron, titanium, white, handout, plastic or chalk (gold)",
     "MATERIAL"},
    {"size", 0, POPT_ARG_STRING, NULL, LOOK_SIZE, "pixels (1280x720)", "WxH"},
    {"samples", 0, POPT_ARG_STRING, NULL, LOOK_SAMPLES, "N x N rays a pixel, 1 to 8 (4)", "N"},
    {"exposure", 0, POPT_ARG_STRING, NULL, LOOK_EXPOSURE, "brighter by this many stops", "STOPS"},
    {"rotate", 0, POPT_ARG_STRING, NULL, LOOK_ROTATE, "turn the environment about +Y", "DEGREES"},
    {"background", 0, POPT_ARG_STRING, NULL, LOOK_BACKGROUND,
     "blur of the environment behind, 0 to 1", "ROUGHNESS"},
    {"azimuth", 0, POPT_ARG_STRING, NULL, LOOK_AZIMUTH, "camera around the balls", "DEGREES"},
    {"elevation", 0, POPT_ARG_STRING, NULL, LOOK_ELEVATION, "camera above them", "DEGREES"},
    {"distance", 0, POPT_ARG_STRING, NULL, LOOK_DISTANCE, "camera from them; a ball is 72 wide",
     "D"},
    {"fov", 0, POPT_ARG_STRING, NULL, LOOK_FOV, "vertical field of view", "DEGREES"},
    {"debug", 0, POPT_ARG_STRING, NULL, LOOK_DEBUG,
     "level, table-e, table-e-average, table-split, e or f", "VIEW"},
    {"level", 0, POPT_ARG_STRING, NULL, LOOK_LEVEL, "which one --debug level shows (0)", "K"},
    {"split", 0, POPT_ARG_STRING, NULL, LOOK_SPLIT, "where compare is split, 0 to 1 (0.5)", "X"},
    {"as-printed", 0, POPT_ARG_NONE, NULL, LOOK_AS_PRINTED,
     "assignment: with the mistake of the handout's figure 6", NULL},
    {"occlusion", 0, POPT_ARG_NONE, NULL, LOOK_OCCLUSION, "balls shade one another", NULL},
    {"straight", 0, POPT_ARG_NONE, NULL, LOOK_STRAIGHT,
     "reflections of rough balls are not bent towards the normal", NULL},
    {"diffuse", 0, POPT_ARG_STRING, NULL, LOOK_DIFFUSE,
     "light of diffuse surfaces: sh (harmonics) or cube (sh)", "SOURCE"},
    {"bake-size", 0, POPT_ARG_STRING, NULL, LOOK_BAKE_SIZE,
     "edge of the baked environment, 16 to 2048 (256)", "N"},
    POPT_TABLEEND,
};

// The words of an enumeration as cli_choice wants them.
static int choose(const cli_arguments *a, int option, const char *name,
                  const char *(*word)(int index), int *value)
{
    const char *words[16];
    int count = 0;
    while (count < 15 && (words[count] = word(count)))
        count++;
    words[count] = NULL;
    return cli_choice(a, option, name, words, value);
}

static int read_size(const cli_arguments *a, look *l)
{
    const char *text = a->value[LOOK_SIZE];
    char rest;
    l->width = 1280;
    l->height = 720;
    if (text && sscanf(text, "%dx%d%c", &l->width, &l->height, &rest) != 2)
        return cli_wrong(a->command, "--size is '%s', it must be WIDTHxHEIGHT", text);
    if (l->width < 1 || l->width > 16384 || l->height < 1 || l->height > 16384)
        return cli_wrong(a->command, "--size is %s, each side must be from 1 to 16384", text);
    return CLI_GO;
}

static int read_camera(const cli_arguments *a, view_camera *c)
{
    int code;
    if ((code = cli_number(a, LOOK_AZIMUTH, "--azimuth", -360, 360, &c->azimuth)) != CLI_GO ||
        (code = cli_number(a, LOOK_ELEVATION, "--elevation", -89, 89, &c->elevation)) != CLI_GO ||
        (code = cli_number(a, LOOK_DISTANCE, "--distance", 10, 10000, &c->distance)) != CLI_GO)
        return code;
    return cli_number(a, LOOK_FOV, "--fov", 1, 150, &c->fov);
}

// Which options mean something only together with others.
static int check(const cli_arguments *a, const look *l)
{
    const view_options *o = &l->options;
    const char *scene = view_scene_name((int)o->scene);
    bool window = a->command == &cli_view; // where the scene can change
    if (l->input && !window && !look_has_environment(l))
        return cli_wrong(a->command, "%s: the scene %s has no environment", l->input, scene);
    if (a->value[LOOK_AS_PRINTED] && o->scene != VIEW_SCENE_ASSIGNMENT)
        return cli_wrong(a->command, "--as-printed is for --scene assignment, not %s", scene);
    if (a->value[LOOK_SPLIT] && o->scene != VIEW_SCENE_COMPARE)
        return cli_wrong(a->command, "--split is for --scene compare, not %s", scene);
    if (a->value[LOOK_LEVEL] && o->debug != VIEW_DEBUG_LEVEL)
        return cli_wrong(a->command, "--level needs --debug level");
    if (o->debug == VIEW_DEBUG_LEVEL && !look_has_environment(l))
        return cli_wrong(a->command, "--debug level: the scene %s has no environment", scene);
    if (a->value[LOOK_MATERIAL] &&
        (o->scene == VIEW_SCENE_ASSIGNMENT || o->scene == VIEW_SCENE_FURNACE))
        return cli_wrong(a->command, "--material: the scene %s has its own", scene);
    return CLI_GO;
}

int look_read(const cli_arguments *a, look *l)
{
    static const char *const sources[] = {"sh", "cube", NULL};
    int code, debug = 0, method, material, diffuse = 0;
    *l = (look){.input = a->rest_count ? a->rest[0] : NULL};
    int scene = l->input ? VIEW_SCENE_IBL : VIEW_SCENE_ASSIGNMENT;
    if (a->rest_count > 1)
        return cli_wrong(a->command, "%d inputs: one environment", a->rest_count);
    if ((code = choose(a, LOOK_SCENE, "--scene", view_scene_name, &scene)) != CLI_GO)
        return code;
    view_options *o = &l->options;
    *o = view_defaults((view_scene)scene);
    method = (int)o->method;
    material = (int)o->material;
    if ((code = choose(a, LOOK_METHOD, "--method", view_method_name, &method)) != CLI_GO ||
        (code = choose(a, LOOK_MATERIAL, "--material", view_material_name, &material)) != CLI_GO ||
        (code = choose(a, LOOK_DEBUG, "--debug", view_debug_name, &debug)) != CLI_GO ||
        (code = cli_choice(a, LOOK_DIFFUSE, "--diffuse", sources, &diffuse)) != CLI_GO ||
        (code = read_size(a, l)) != CLI_GO || (code = read_camera(a, &o->camera)) != CLI_GO ||
        (code = cli_integer(a, LOOK_SAMPLES, "--samples", 1, 8, &o->samples)) != CLI_GO ||
        (code = cli_integer(a, LOOK_LEVEL, "--level", 0, 15, &o->debug_level)) != CLI_GO ||
        (code = cli_integer(a, LOOK_BAKE_SIZE, "--bake-size", 16, 2048, &l->bake_size)) != CLI_GO ||
        (code = cli_number(a, LOOK_EXPOSURE, "--exposure", -64, 64, &o->exposure)) != CLI_GO ||
        (code = cli_number(a, LOOK_ROTATE, "--rotate", -3600, 3600, &o->rotation)) != CLI_GO ||
        (code = cli_number(a, LOOK_BACKGROUND, "--background", 0, 1, &o->background)) != CLI_GO ||
        (code = cli_number(a, LOOK_SPLIT, "--split", 0, 1, &o->split)) != CLI_GO)
        return code;
    o->method = (view_method)method;
    o->material = (view_material)material;
    o->debug = (view_debug)debug;
    o->cube_diffuse = diffuse;
    o->as_printed = a->value[LOOK_AS_PRINTED];
    o->bent = !a->value[LOOK_STRAIGHT];
    o->occlusion = a->value[LOOK_OCCLUSION];
    return check(a, l);
}

bool look_has_environment(const look *l)
{
    return l->options.scene != VIEW_SCENE_ASSIGNMENT && l->options.scene != VIEW_SCENE_FURNACE;
}

int look_load(cli_job *job, const look *l, kiln_map *source)
{
    if (l->input) {
        const char *names[] = {l->input};
        return cli_load(job, names, 1, KILN_LAYOUT_AUTO, source);
    }
    // kcd/m2 to something near 1.
    kiln_sky_def def = {0};
    if (kiln_sky(job->context, &def, source, &job->error) != KILN_OK)
        return CLI_FAILED;
    kiln_map_expose(source, -4);
    return CLI_GO;
}

int look_bake_slot(cli_job *job, const look *l, const kiln_map *source, view_slot slot, int samples,
                   view_renderer *renderer)
{
    kiln_environment e;
    if (view_bake(job->context, source, l->bake_size, samples, &e, &job->error) != KILN_OK)
        return CLI_FAILED;
    kiln_result result =
        view_set_environment(renderer, slot, &e.levels, &e.sh, &e.irradiance, &job->error);
    kiln_environment_free(&e);
    return result == KILN_OK ? CLI_GO : CLI_FAILED;
}

int look_bake(cli_job *job, const look *l, const kiln_map *source, view_renderer *renderer)
{
    int code = look_bake_slot(job, l, source, VIEW_SLOT_EXACT, 0, renderer);
    if (code == CLI_GO && l->options.scene == VIEW_SCENE_COMPARE)
        code = look_bake_slot(job, l, source, VIEW_SLOT_TEXTBOOK, LOOK_TEXTBOOK_SAMPLES, renderer);
    return code;
}
