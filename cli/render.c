// kiln render: the scenes without a window.
#include "cli.h"
#include "look.h"

#include "headless.h"
#include "reference.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { OUTPUT = 1, REFERENCE, ERRORS, WALK, ALONE, BOUNCES, NOISE, THREADS, QUIET };

static const struct poptOption options[] = {
    {"output", 'o', POPT_ARG_STRING, NULL, OUTPUT,
     "the picture: .png as a screen shows it; .exr or .hdr, linear light", "FILE"},
    {NULL, 0, POPT_ARG_INCLUDE_TABLE, (void *)look_options, 0, "The view:", NULL},
    {"reference", 0, POPT_ARG_NONE, NULL, REFERENCE,
     "integrate the light on the CPU, without approximation", NULL},
    {"error", 0, POPT_ARG_NONE, NULL, ERRORS,
     "show the real-time picture's error against the reference", NULL},
    {"walk", 0, POPT_ARG_NONE, NULL, WALK,
     "reference: further bounces by random walk, not by --method", NULL},
    {"alone", 0, POPT_ARG_NONE, NULL, ALONE,
     "reference: balls do not see one another, as in the real-time picture", NULL},
    {"bounces", 0, POPT_ARG_STRING, NULL, BOUNCES,
     "reference: light that would meet more balls is lost, 1 to 1000 (all of it is kept)", "N"},
    {"noise", 0, POPT_ARG_STRING, NULL, NOISE,
     "relative standard error at which the reference stops, 1e-4 to 1 (0.01)", "E"},
    {"threads", 0, POPT_ARG_STRING, NULL, THREADS, "1 to 256, one a core by default", "N"},
    {"quiet", 'q', POPT_ARG_NONE, NULL, QUIET, "print nothing but errors", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

typedef struct render {
    look look;
    int threads, bounces;
    bool reference, errors, walk, alone;
    double noise;
} render;

// Options of the reference without one.
static int check_reference(const cli_arguments *a, const render *r)
{
    static const struct {
        int option;
        const char *name;
    } of_it[] = {{NOISE, "--noise"}, {WALK, "--walk"}, {ALONE, "--alone"}, {BOUNCES, "--bounces"}};
    if (r->reference && r->errors)
        return cli_wrong(&cli_render, "--reference and --error contradict each other");
    for (size_t i = 0; i < sizeof of_it / sizeof *of_it && !r->reference && !r->errors; i++)
        if (a->value[of_it[i].option])
            return cli_wrong(&cli_render, "%s needs --reference or --error", of_it[i].name);
    if (r->alone && a->value[BOUNCES])
        return cli_wrong(&cli_render, "--alone and --bounces contradict each other");
    if (r->walk && r->look.options.scene == VIEW_SCENE_ASSIGNMENT)
        return cli_wrong(&cli_render, "--walk: the scene assignment has a light of no size");
    if ((r->reference || r->errors) && r->look.options.debug)
        return cli_wrong(&cli_render, "--debug has no reference");
    return CLI_GO;
}

static int read_arguments(const cli_arguments *a, render *r)
{
    if (!a->value[OUTPUT])
        return cli_wrong(&cli_render, "no output: name it by -o FILE");
    const char *ending = cli_ending(a->value[OUTPUT]);
    if (strcmp(ending, "png") != 0 && strcmp(ending, "exr") != 0 && strcmp(ending, "hdr") != 0)
        return cli_wrong(&cli_render, "--output %s: must end in .png, .exr or .hdr",
                         a->value[OUTPUT]);
    r->reference = a->value[REFERENCE];
    r->errors = a->value[ERRORS];
    r->walk = a->value[WALK];
    r->alone = a->value[ALONE];
    int code = look_read(a, &r->look);
    if (code != CLI_GO)
        return code;
    if ((code = check_reference(a, r)) != CLI_GO)
        return code;
    if (r->errors && !strcmp(ending, "hdr"))
        return cli_wrong(&cli_render, "--output %s: .hdr cannot hold an error's sign",
                         a->value[OUTPUT]);
    if ((code = cli_integer(a, THREADS, "--threads", 1, 256, &r->threads)) != CLI_GO ||
        (code = cli_integer(a, BOUNCES, "--bounces", 1, 1000, &r->bounces)) != CLI_GO ||
        (code = cli_number(a, NOISE, "--noise", 1e-4, 1, &r->noise)) != CLI_GO)
        return code;
    return cli_check_folder(a->value[OUTPUT]);
}

static int draw(cli_job *job, const look *l, const kiln_map *source, bool linear, char name[128],
                kiln_image *image)
{
    view_headless *headless = NULL;
    view_renderer *renderer = NULL;
    int code = CLI_FAILED;
    if (view_headless_create(&headless, &job->error) ||
        view_create(job->context, view_headless_lookup, &renderer, &job->error))
        goto done;
    if (look_has_environment(l) && look_bake(job, l, source, renderer) != CLI_GO)
        goto done;
    if (view_picture(renderer, &l->options, l->width, l->height, linear, image, &job->error))
        goto done;
    snprintf(name, 128, "%s", view_gl_name(renderer));
    code = CLI_GO;
done:
    view_destroy(renderer);
    view_headless_destroy(headless);
    return code;
}

static int integrate(cli_job *job, const render *r, const kiln_map *source, bool linear,
                     kiln_image *image, view_reference_report *report)
{
    const view_options *o = &r->look.options;
    view_reference_def def = {.noise = r->noise,
                              .walk = r->walk,
                              .alone = r->alone,
                              .bounces = r->bounces,
                              .thread_count = r->threads,
                              .progress = cli_progress,
                              .progress_user = job};
    if (view_reference(job->context, o, source->size ? source : NULL, r->look.width, r->look.height,
                       &def, image, report, &job->error))
        return CLI_FAILED;
    size_t count = linear ? 0 : (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        double c[3];
        for (int k = 0; k < 3; k++)
            c[k] = (double)image->pixels[3 * i + (size_t)k] * exp2(o->exposure);
        view_tone(o->scene, c, c);
        for (int k = 0; k < 3; k++)
            image->pixels[3 * i + (size_t)k] = (float)c[k];
    }
    return CLI_GO;
}

// The picture that was asked for, and the words about it.
static int make(cli_job *job, const render *r, bool linear, kiln_image *image, char words[256],
                view_error *errors)
{
    kiln_map source = {0};
    kiln_image truth = {0};
    view_reference_report report = {0};
    char name[128] = "";
    int code = look_has_environment(&r->look) ? look_load(job, &r->look, &source) : CLI_GO;
    if (code == CLI_GO && r->reference) {
        code = integrate(job, r, &source, linear, image, &report);
        snprintf(words, 256, "integrated to a noise of %.2g, %.0f samples a ray", report.noise,
                 report.batches);
    } else if (code == CLI_GO && r->errors) {
        view_error e = {0};
        code = draw(job, &r->look, &source, true, name, image);
        if (code == CLI_GO)
            code = integrate(job, r, &source, true, &truth, &report);
        if (code == CLI_GO)
            e = view_compare(&r->look.options, image, &truth, !linear);
        snprintf(words, 256, "error RMS %.3g, largest %.3g, on screen %.2f of 255, noise %.2g",
                 e.rms, e.largest, e.screen, report.noise);
        if (code == CLI_GO)
            *errors = e;
    } else if (code == CLI_GO) {
        code = draw(job, &r->look, &source, linear, name, image);
        snprintf(words, 256, "by %s", name);
    }
    kiln_image_free(&truth);
    kiln_map_free(&source);
    return code;
}

static void print_errors(const view_options *o, const view_error *e)
{
    view_ball balls[VIEW_MAX_BALLS];
    view_balls(o, balls);
    if (e->ball_count)
        printf("  %9s %8s  %-12s %8s %9s\n", "roughness", "metallic", "method", "RMS", "of 255");
    for (int i = 0; i < e->ball_count; i++)
        printf("  %9.3g %8.3g  %-12s %8.3g %9.2f\n", balls[i].roughness, balls[i].metallic,
               view_method_name((int)balls[i].method), e->ball[i], e->ball_screen[i]);
}

static int run(int argc, const char **argv)
{
    cli_arguments a;
    cli_job job;
    render r = {.noise = 0.01};
    int code = cli_arguments_read(&a, &cli_render, argc, argv);
    if (code == CLI_GO)
        code = read_arguments(&a, &r);
    if (code == CLI_GO) {
        const char *path = a.value[OUTPUT];
        char words[256] = "";
        kiln_image image = {0};
        view_error errors = {.rms = 0};
        code = cli_job_begin(&job, r.threads, a.value[QUIET]);
        if (code == CLI_GO)
            code = make(&job, &r, strcmp(cli_ending(path), "png") != 0, &image, words, &errors);
        if (code == CLI_GO)
            code = kiln_image_save(job.context, &image, path, &job.error) ? CLI_FAILED : CLI_DONE;
        cli_clear_progress(&job);
        if (code == CLI_DONE && !a.value[QUIET])
            printf("%s: %s, %d x %d, %s, %.2f s\n", path,
                   view_scene_name((int)r.look.options.scene), r.look.width, r.look.height, words,
                   cli_seconds() - job.began);
        if (code == CLI_DONE && !a.value[QUIET])
            print_errors(&r.look.options, &errors);
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
        "  kiln render city.exr -o error.png --error --size 640x360\n"
        "      what prefiltered levels and tables get wrong, and where\n"
        "  kiln render -o furnace.exr --scene furnace\n"
        "      where nothing may be seen, in linear light\n",
    .options = options,
    .run = run,
};
