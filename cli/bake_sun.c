// What kiln bake does with the sun and other compact lights: --sun, --clamp, --lights,
// --lights-share and --lights-file. In: the words of these options. Out: the fields of a
// kiln_bake_def, and notes on what was taken out or lost.
#include "bake.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Reads the radiance of `option` from `text`: a number above 0, or auto, which is 0.
static int read_limit(bake *b, const char *option, const char *text)
{
    char *end;
    b->sun = KILN_SUN_CLAMP;
    if (!strcmp(text, "auto"))
        return CLI_GO;
    b->clamp = strtod(text, &end);
    if (end == text || *end || !(b->clamp > 0 && b->clamp <= 3.4e38))
        return cli_wrong(b->arguments.command, "%s is '%s', it must be auto or a radiance above 0",
                         option, text);
    return CLI_GO;
}

static int read_word(bake *b)
{
    const char *text = b->sun_text;
    if (!text || !strcmp(text, "keep"))
        return CLI_GO;
    if (!strncmp(text, "clamp=", 6))
        return read_limit(b, "--sun clamp=", text + 6);
    if (strcmp(text, "extract") != 0)
        return cli_wrong(b->arguments.command,
                         "--sun is '%s', it must be keep, extract, clamp=RADIANCE or clamp=auto",
                         text);
    b->sun = KILN_SUN_EXTRACT;
    return CLI_GO;
}

int bake_read_sun(bake *b, bool has_lights, bool has_share)
{
    int code = read_word(b);
    if (code == CLI_GO && b->clamp_text && b->sun_text)
        return cli_wrong(b->arguments.command, "--clamp and --sun contradict each other, leave one "
                                               "of them out");
    if (code == CLI_GO && b->clamp_text)
        code = read_limit(b, "--clamp", b->clamp_text);
    if (code != CLI_GO)
        return code;
    const char *option = has_lights       ? "--lights"
                         : has_share      ? "--lights-share"
                         : b->lights_path ? "--lights-file"
                                          : NULL;
    if (option && b->sun != KILN_SUN_EXTRACT)
        return cli_wrong(b->arguments.command, "%s needs --sun extract", option);
    if (b->lights_path && !cli_ends_in(b->lights_path, "json"))
        return cli_wrong(b->arguments.command, "--lights-file %s: must end in .json",
                         b->lights_path);
    if (has_share && b->lights.share == 0)
        b->lights.share = KILN_ZERO; // the library reads 0 as its default, and KILN_ZERO as zero
    return CLI_GO;
}

int bake_sun_of_source(bake *b)
{
    kiln_error *error = &b->work.error;
    kiln_result result = KILN_OK;
    if (b->sun == KILN_SUN_CLAMP)
        result = kiln_map_clamp(b->work.context, &b->source, b->clamp, &b->made.clamped, error);
    else if (b->sun == KILN_SUN_EXTRACT)
        result =
            kiln_lights_extract(b->work.context, &b->source, &b->lights, &b->made.lights, error);
    return result ? CLI_FAILED : CLI_GO;
}

void bake_say_sun(bake *b)
{
    const kiln_clamp *clamped = &b->made.clamped;
    const kiln_lights *lights = &b->made.lights;
    const char *name = b->arguments.rest[0];
    double share = 0;
    for (int i = 0; i < lights->count; i++)
        share += lights->light[i].share;
    if (b->quiet || b->sun == KILN_SUN_KEEP)
        return;
    if (b->sun == KILN_SUN_CLAMP)
        cli_note(&b->work, false,
                 "%s: %zu texels above %.4g were made as dark as this, which lost %.3g %% of the "
                 "light",
                 name, clamped->texel_count, clamped->limit, 100 * clamped->light_share);
    else if (!lights->count)
        cli_note(&b->work, false, "%s: no compact light was found, and nothing was taken out",
                 name);
    else
        cli_note(&b->work, false, "%s: %d light%s with %.3g %% of the light %s taken out%s%s", name,
                 lights->count, lights->count == 1 ? "" : "s", 100 * share,
                 lights->count == 1 ? "was" : "were",
                 b->lights_path ? " and written to " : "; --lights-file writes them to a file",
                 b->lights_path ? b->lights_path : "");
}
