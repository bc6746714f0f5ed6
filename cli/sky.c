// kiln sky: writes a panorama of daylight, for users without a panorama of their own.
#include "work.h"

#include <stdio.h>

enum { OUTPUT, ELEVATION, AZIMUTH, TURBIDITY, ALBEDO, SIZE, QUIET, OPTIONS };

typedef struct sky {
    const char *output;
    kiln_sky_def def;
    bool quiet;
} sky;

#define AT(field) offsetof(sky, field)

static const cli_option options[OPTIONS + 1] = {
    [OUTPUT] = {"output", CLI_FILE, AT(output), .value = "FILE", .letter = 'o',
                .help = "the panorama, as .exr (32-bit floats) or .hdr"},
    [ELEVATION] = {"elevation", CLI_NUMBER, AT(def.elevation), -5, 90, 30, "DEGREES",
                   .help = "angle of the sun above the horizon"},
    [AZIMUTH] = {"azimuth", CLI_NUMBER, AT(def.azimuth), -360, 360, 0, "DEGREES",
                 .help = "angle of the sun to the right of the centre of the panorama"},
    [TURBIDITY] = {"turbidity", CLI_NUMBER, AT(def.turbidity), 1.7, 10, 3, "T",
                   .help = "haziness of the air; 1.7 is clear air"},
    [ALBEDO] = {"albedo", CLI_NUMBER, AT(def.albedo), 0, 1, 0.2, "A",
                .help = "share of the light that the ground reflects"},
    [SIZE] = {"size", CLI_INTEGER, AT(def.size), 16, 8192, 512, "N",
              .help = "rows of the panorama, which has twice as many columns"},
    [QUIET] = CLI_QUIET_ROW(sky),
};

static int read_options(sky *s, const cli_call *call)
{
    cli_arguments a;
    int code = cli_read_arguments(&a, &cli_sky, call, s);
    if (code != CLI_GO)
        return code;
    if (a.rest_count)
        return cli_wrong(&cli_sky, "%s: sky takes no input; name the output by -o FILE", a.rest[0]);
    if (!s->output)
        return cli_wrong(&cli_sky, "no output: name it by -o FILE");
    if (!cli_ends_in(s->output, "exr") && !cli_ends_in(s->output, "hdr"))
        return cli_wrong(&cli_sky, "--output %s: must end in .exr or .hdr", s->output);
    if (s->def.elevation == 0)
        s->def.elevation = KILN_ZERO; // the library reads 0 as its default, and KILN_ZERO as zero
    if (s->def.albedo == 0)
        s->def.albedo = KILN_ZERO;
    return cli_check_folder(s->output);
}

static int make(cli_work *work, const sky *s, kiln_map *map)
{
    // The radiance of a high sun exceeds the largest half float.
    bool exr = cli_ends_in(s->output, "exr");
    kiln_save_def save = {.format = exr ? KILN_FORMAT_RGBA32F : KILN_FORMAT_AUTO};
    if (kiln_sky(work->context, &s->def, map, &work->error) ||
        kiln_map_save(work->context, map, s->output, &save, NULL, &work->error))
        return CLI_FAILED;
    return CLI_DONE;
}

static int run(const cli_call *call)
{
    sky s = {0};
    cli_work work;
    kiln_map map = {0};
    int code = read_options(&s, call);
    if (code != CLI_GO)
        return code;
    code = cli_begin_work(&work, 0, s.quiet);
    if (code == CLI_GO)
        code = make(&work, &s, &map);
    cli_clear_progress(&work);
    if (code == CLI_DONE && !s.quiet)
        printf("%s: panorama of %d x %d, in kcd/m2, %.2f s\n", cli_show(s.output).text,
               2 * map.size, map.size, cli_elapsed(&work));
    kiln_map_free(&map);
    return cli_end_work(&work, code);
}

static const cli_example examples[] = {
    {"kiln sky -o sky.exr",
     "a clear sky with the sun 30 degrees high, as a panorama of 1024 x 512"},
    {"kiln sky -o evening.hdr --elevation 4 --azimuth 60 --turbidity 6",
     "a low sun in haze, to the right of the centre"},
    {NULL, NULL}};

const cli_command cli_sky = {
    .name = "sky",
    .arguments = "-o FILE [OPTION...]",
    .summary = "Makes a daylight panorama with a sun.",
    .about = "Radiance is written in kcd/m2: a white texel of 1 has the luminance 1 kcd/m2.",
    .examples = examples,
    .options = options,
    .run = run,
};
