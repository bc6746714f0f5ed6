// kiln sky: a daylight panorama, for when there is no other.
#include "cli.h"

#include <stdio.h>
#include <string.h>

enum { OUTPUT = 1, SIZE, ELEVATION, AZIMUTH, TURBIDITY, ALBEDO, QUIET };

static const struct poptOption options[] = {
    {"output", 'o', POPT_ARG_STRING, NULL, OUTPUT, "the panorama, .exr (32-bit) or .hdr", "FILE"},
    {"elevation", 0, POPT_ARG_STRING, NULL, ELEVATION,
     "of the sun above the horizon, -5 to 90 (30)", "DEGREES"},
    {"azimuth", 0, POPT_ARG_STRING, NULL, AZIMUTH, "of the sun, from the centre to the right (0)",
     "DEGREES"},
    {"turbidity", 0, POPT_ARG_STRING, NULL, TURBIDITY, "1.7 (clear) to 10 (hazy) (3)", "T"},
    {"albedo", 0, POPT_ARG_STRING, NULL, ALBEDO, "of the ground below, 0 to 1 (0.2)", "A"},
    {"size", 0, POPT_ARG_STRING, NULL, SIZE, "rows, 16 to 8192 (512)", "N"},
    {"quiet", 'q', POPT_ARG_NONE, NULL, QUIET, "print nothing but errors", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

static int read_def(const cli_arguments *a, kiln_sky_def *def)
{
    int code;
    if (a->rest_count)
        return cli_wrong(&cli_sky, "%s: sky takes no input; name the output by -o FILE",
                         a->rest[0]);
    if (!a->value[OUTPUT])
        return cli_wrong(&cli_sky, "no output: name it by -o FILE");
    const char *ending = cli_ending(a->value[OUTPUT]);
    if (strcmp(ending, "exr") != 0 && strcmp(ending, "hdr") != 0)
        return cli_wrong(&cli_sky, "--output %s: must end in .exr or .hdr", a->value[OUTPUT]);
    if ((code = cli_number(a, ELEVATION, "--elevation", -5, 90, &def->elevation)) != CLI_GO ||
        (code = cli_number(a, AZIMUTH, "--azimuth", -360, 360, &def->azimuth)) != CLI_GO ||
        (code = cli_number(a, TURBIDITY, "--turbidity", 1.7, 10, &def->turbidity)) != CLI_GO ||
        (code = cli_number(a, ALBEDO, "--albedo", 0, 1, &def->albedo)) != CLI_GO ||
        (code = cli_integer(a, SIZE, "--size", 16, 8192, &def->size)) != CLI_GO)
        return code;
    if (a->value[ELEVATION] && def->elevation == 0)
        def->elevation = KILN_ZERO;
    if (a->value[ALBEDO] && def->albedo == 0)
        def->albedo = KILN_ZERO;
    return cli_check_folder(a->value[OUTPUT]);
}

static int run(int argc, const char **argv)
{
    cli_arguments a;
    cli_job job;
    kiln_sky_def def = {.size = 512};
    int code = cli_arguments_read(&a, &cli_sky, argc, argv);
    if (code == CLI_GO)
        code = read_def(&a, &def);
    if (code == CLI_GO) {
        const char *path = a.value[OUTPUT];
        // A noon sun is beyond what half floats hold.
        bool exr = !strcmp(cli_ending(path), "exr");
        kiln_save_def save = {.format = exr ? KILN_FORMAT_RGBA32F : KILN_FORMAT_AUTO};
        kiln_map map = {0};
        code = cli_job_begin(&job, 0, a.value[QUIET]);
        if (code == CLI_GO)
            code = kiln_sky(job.context, &def, &map, &job.error) ||
                           kiln_map_save(job.context, &map, path, &save, NULL, &job.error)
                       ? CLI_FAILED
                       : CLI_DONE;
        cli_clear_progress(&job);
        if (code == CLI_DONE && !a.value[QUIET])
            printf("%s: panorama of %d x %d, in kcd/m2, %.2f s\n", path, 2 * map.size, map.size,
                   cli_seconds() - job.began);
        kiln_map_free(&map);
        code = cli_job_end(&job, code);
    }
    cli_arguments_free(&a);
    return code;
}

const cli_command cli_sky = {
    .name = "sky",
    .arguments = "-o FILE [OPTION...]",
    .summary = "Makes a daylight panorama with a sun.",
    .details = "Examples:\n"
               "  kiln sky -o sky.exr\n"
               "      a clear sky, the sun 30 degrees high, 1024 x 512\n"
               "  kiln sky -o evening.hdr --elevation 4 --azimuth 60 --turbidity 6\n"
               "      a low sun to the right, in haze\n",
    .options = options,
    .run = run,
};
