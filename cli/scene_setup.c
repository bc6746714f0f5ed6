// Converts the options of a view into numbers, and loads or computes the environment.
#include "scene_setup.h"

#include <stdio.h>
#include <string.h>

const char *scene_diffuse_word(int index)
{
    static const char *const words[] = {"sh", "cube", NULL};
    return words[index];
}

const char *scene_sun_word(int index)
{
    static const char *const words[] = {
        [KILN_SUN_KEEP] = "keep", [KILN_SUN_EXTRACT] = "extract", NULL};
    return words[index];
}

// Reads a number of digits only; a number with more than six digits becomes 999999. Returns the
// text after the number, or NULL if there is no digit.
static const char *read_side(const char *text, int *side)
{
    const char *at = text;
    for (*side = 0; *at >= '0' && *at <= '9'; at++)
        *side = *side < 99999 ? 10 * *side + (*at - '0') : 999999;
    return at > text ? at : NULL;
}

// Reads "WIDTHxHEIGHT". Returns false for any other text.
static bool read_sides(const char *text, int *width, int *height)
{
    const char *at = read_side(text, width);
    at = at && *at == 'x' ? read_side(at + 1, height) : NULL;
    return at && !*at;
}

int scene_read_size(const cli_command *command, const char *size, int *width, int *height)
{
    *width = 1280;
    *height = 720;
    if (size && !read_sides(size, width, height))
        return cli_wrong(command, "--size is '%s', it must be WIDTHxHEIGHT", size);
    if (*width < 1 || *width > 16384 || *height < 1 || *height > 16384)
        return cli_wrong(command, "--size is %s, each side must be from 1 to 16384", size);
    return CLI_GO;
}

// Checks options that have an effect only together with others.
static int check(const cli_arguments *a, bool may_change, const scene_setup *s)
{
    const view_options *o = &s->options;
    const char *scene = view_scene_name((int)o->scene);
    if (s->input && !may_change && !scene_has_environment(s))
        return cli_wrong(a->command, "%s: the scene %s has no environment, leave the input out",
                         s->input, scene);
    if (o->as_printed && o->scene != VIEW_SCENE_ASSIGNMENT)
        return cli_wrong(a->command, "--as-printed is for --scene assignment, not %s", scene);
    if (a->text[SCENE_SPLIT] && o->scene != VIEW_SCENE_COMPARE)
        return cli_wrong(a->command, "--split is for --scene compare, not %s", scene);
    if (a->text[SCENE_LEVEL] && o->debug != VIEW_DEBUG_LEVEL)
        return cli_wrong(a->command, "--level needs --debug level");
    if (o->debug == VIEW_DEBUG_LEVEL && !scene_has_environment(s))
        return cli_wrong(
            a->command,
            "--debug level needs a scene with an environment, and the scene %s has no environment",
            scene);
    if (a->text[SCENE_MATERIAL] &&
        (o->scene == VIEW_SCENE_ASSIGNMENT || o->scene == VIEW_SCENE_FURNACE))
        return cli_wrong(a->command,
                         "--material is not for the scene %s, which has its own material", scene);
    return CLI_GO;
}

// Checks the options of the sun, lamps and the ground.
static int check_sun(const cli_arguments *a, bool may_change, const scene_setup *s)
{
    const char *scene = view_scene_name((int)s->options.scene);
    const char *option = a->text[SCENE_LIGHTS]         ? "--lights"
                         : a->text[SCENE_LIGHTS_SHARE] ? "--lights-share"
                                                       : NULL;
    if (option && s->sun != KILN_SUN_EXTRACT)
        return cli_wrong(a->command, "%s needs --sun extract", option);
    option = s->options.ground ? "--ground" : s->sun == KILN_SUN_EXTRACT ? "--sun extract" : NULL;
    if (option && !may_change && !scene_has_environment(s))
        return cli_wrong(a->command, "%s: the scene %s has no environment, choose --scene ibl",
                         option, scene);
    return CLI_GO;
}

int scene_read(const cli_arguments *a, bool may_change, scene_setup *s)
{
    if (a->rest_count > 1)
        return cli_wrong(a->command, "%d inputs are named, name one environment", a->rest_count);
    s->input = a->rest_count ? a->rest[0] : NULL;
    if (s->scene < 0)
        s->scene = s->input ? VIEW_SCENE_IBL : VIEW_SCENE_ASSIGNMENT;
    // The scene decides the defaults of the other options. The values that the command line gives
    // are therefore written again after them.
    s->options = view_defaults((view_scene)s->scene);
    int code = cli_store_values(a, s);
    if (code == CLI_GO)
        code = scene_read_size(a->command, s->size, &s->width, &s->height);
    s->options.cube_diffuse = s->cube_diffuse;
    if (a->text[SCENE_LIGHTS_SHARE] && s->lights.share == 0)
        s->lights.share = KILN_ZERO; // the library reads 0 as its default, and KILN_ZERO as zero
    if (code == CLI_GO)
        code = check(a, may_change, s);
    return code == CLI_GO ? check_sun(a, may_change, s) : code;
}

bool scene_has_environment(const scene_setup *s)
{
    return s->options.scene != VIEW_SCENE_ASSIGNMENT && s->options.scene != VIEW_SCENE_FURNACE;
}

static int load(cli_work *work, const scene_setup *s, kiln_map *source)
{
    if (s->input) {
        const char *names[] = {s->input};
        const kiln_load_def def = {.negative = (kiln_negative)s->negative, .layer = s->layer};
        return cli_load(work, names, 1, &def, source);
    }
    // Scales the sky's radiance from kcd/m2 to values near 1.
    kiln_sky_def def = {0};
    if (kiln_sky(work->context, &def, source, &work->error) != KILN_OK)
        return CLI_FAILED;
    kiln_map_expose(source, -4);
    return CLI_GO;
}

int scene_load(cli_work *work, scene_setup *s, kiln_map *source)
{
    const char *name = s->input ? s->input : "sky";
    int code = load(work, s, source);
    if (code != CLI_GO || s->sun != KILN_SUN_EXTRACT)
        return code;
    if (source->level_count > 1) {
        work->error.result = KILN_ERROR_ARGUMENT;
        snprintf(work->error.message, sizeof work->error.message,
                 "%s: is baked, and its %d levels hold the lights; name the panorama", name,
                 source->level_count);
        return CLI_FAILED;
    }
    if (kiln_lights_extract(work->context, source, &s->lights, &s->taken, &work->error))
        return CLI_FAILED;
    if (!s->taken.count)
        cli_note(work, false, "%s: no compact light was found, and nothing was taken out", name);
    return CLI_GO;
}

int scene_bake_slot(cli_work *work, const scene_setup *s, const kiln_map *source, view_slot slot,
                    int samples, view_renderer *renderer)
{
    kiln_environment e;
    if (view_bake(work->context, source, s->bake_size, samples, &e, &work->error) != KILN_OK)
        return CLI_FAILED;
    kiln_result result =
        view_set_environment(renderer, slot, &e.levels, &e.sh, &e.irradiance, &work->error);
    view_set_lights(renderer, &s->taken);
    kiln_environment_free(&e);
    return result == KILN_OK ? CLI_GO : CLI_FAILED;
}

int scene_bake(cli_work *work, const scene_setup *s, const kiln_map *source,
               view_renderer *renderer)
{
    int code = scene_bake_slot(work, s, source, VIEW_SLOT_EXACT, 0, renderer);
    if (code == CLI_GO && s->options.scene == VIEW_SCENE_COMPARE)
        code =
            scene_bake_slot(work, s, source, VIEW_SLOT_TEXTBOOK, SCENE_TEXTBOOK_SAMPLES, renderer);
    return code;
}
