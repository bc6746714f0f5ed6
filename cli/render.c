// kiln render: the scenes without a window.
#include "cli.h"
#include "look.h"

#include "headless.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { OUTPUT = 1, THREADS, QUIET };

static const struct poptOption options[] = {
    {"output", 'o', POPT_ARG_STRING, NULL, OUTPUT,
     "the picture: .png as a screen shows it; .exr or .hdr, linear light", "FILE"},
    {NULL, 0, POPT_ARG_INCLUDE_TABLE, (void *)(uintptr_t)look_options, 0, "The view:", NULL},
    {"threads", 0, POPT_ARG_STRING, NULL, THREADS, "1 to 256, one a core by default", "N"},
    {"quiet", 'q', POPT_ARG_NONE, NULL, QUIET, "print nothing but errors", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

static int read_arguments(const cli_arguments *a, look *l, int *threads)
{
    if (!a->value[OUTPUT])
        return cli_wrong(&cli_render, "no output: name it by -o FILE");
    const char *ending = cli_ending(a->value[OUTPUT]);
    if (strcmp(ending, "png") != 0 && strcmp(ending, "exr") != 0 && strcmp(ending, "hdr") != 0)
        return cli_wrong(&cli_render, "--output %s: must end in .png, .exr or .hdr",
                         a->value[OUTPUT]);
    int code = look_read(a, l);
    if (code == CLI_GO)
        code = cli_integer(a, THREADS, "--threads", 1, 256, threads);
    return code == CLI_GO ? cli_check_folder(a->value[OUTPUT]) : code;
}

static int draw(cli_job *job, const look *l, bool linear, char name[128], kiln_image *image)
{
    view_headless *headless = NULL;
    view_renderer *renderer = NULL;
    kiln_map source = {0};
    int code = CLI_FAILED;
    if (view_headless_create(&headless, &job->error) ||
        view_create(job->context, view_headless_lookup, &renderer, &job->error))
        goto done;
    if (look_has_environment(l) &&
        (look_load(job, l, &source) != CLI_GO || look_bake(job, l, &source, renderer) != CLI_GO))
        goto done;
    if (view_picture(renderer, &l->options, l->width, l->height, linear, image, &job->error))
        goto done;
    snprintf(name, 128, "%s", view_gl_name(renderer));
    code = CLI_GO;
done:
    kiln_map_free(&source);
    view_destroy(renderer);
    view_headless_destroy(headless);
    return code;
}

static int run(int argc, const char **argv)
{
    cli_arguments a;
    cli_job job;
    look l;
    int threads = 0, code = cli_arguments_read(&a, &cli_render, argc, argv);
    if (code == CLI_GO)
        code = read_arguments(&a, &l, &threads);
    if (code == CLI_GO) {
        const char *path = a.value[OUTPUT];
        char name[128] = "";
        kiln_image image = {0};
        code = cli_job_begin(&job, threads, a.value[QUIET]);
        if (code == CLI_GO)
            code = draw(&job, &l, strcmp(cli_ending(path), "png") != 0, name, &image);
        if (code == CLI_GO)
            code = kiln_image_save(job.context, &image, path, &job.error) ? CLI_FAILED : CLI_DONE;
        cli_clear_progress(&job);
        if (code == CLI_DONE && !a.value[QUIET])
            printf("%s: %s, %d x %d, by %s, %.2f s\n", path, view_scene_name((int)l.options.scene),
                   l.width, l.height, name, cli_seconds() - job.began);
        kiln_image_free(&image);
        code = cli_job_end(&job, code);
    }
    cli_arguments_free(&a);
    return code;
}

const cli_command cli_render = {
    .name = "render",
    .arguments = "[ENV] -o FILE [OPTION...]",
    .summary = "Renders rows of balls, lit by the assignment's light or an environment.",
    .details =
        "ENV is a panorama or anything else that `kiln bake` reads; a baked .ktx2 is used as it\n"
        "is. Without one, scenes that need an environment stand under a sky.\n"
        "\n"
        "Examples:\n"
        "  kiln render -o balls.png\n"
        "      the assignment's two rows: Kulla-Conty above, one bounce below\n"
        "  kiln render city.exr -o gold.png --material gold --exposure -1\n"
        "      gold in a city\n"
        "  kiln render city.exr -o compare.png --scene compare\n"
        "      the exact bake left, the textbook's right\n"
        "  kiln render -o furnace.exr --scene furnace\n"
        "      where nothing may be seen, in linear light\n",
    .options = options,
    .run = run,
};
