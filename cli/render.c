// kiln render. In: a scene's options and an environment. Out: a picture of the scene, rendered by
// OpenGL ES 3.0 without a window or integrated by the reference (--reference), or their difference.
#include "scene_setup.h"

#include "headless.h"
#include "reference.h"

#include <math.h>
#include <stdio.h>

enum {
    OUTPUT = SCENE_OPTIONS,
    REFERENCE,
    ERRORS,
    WALK,
    ALONE,
    BOUNCES,
    NOISE,
    THREADS,
    QUIET,
    OPTIONS
};

typedef struct render {
    // the shared options; must be the first member, because the shared option rows write to this
    // address
    scene_setup setup;
    cli_arguments arguments;
    const char *output;
    int threads, bounces;
    bool reference, errors, walk, alone, quiet;
    double noise;
} render;

#define AT(field) offsetof(render, field)

static const cli_option options[OPTIONS + 1] = {
    SCENE_ROWS,
    [OUTPUT] = {"output", CLI_FILE, AT(output), .value = "FILE", .letter = 'o', .group = "Output",
                .help = "the picture: a .png file with tone mapping as for a screen, or an .exr or "
                        ".hdr file with linear light"},
    [REFERENCE] = {"reference", CLI_FLAG, AT(reference),
                   .help = "compute the reflected light by Monte Carlo integration on the CPU, "
                           "from the texels of the environment, with the light that balls reflect "
                           "on one another, and without prefiltered levels or the split sum"},
    [ERRORS] = {"error", CLI_FLAG, AT(errors),
                .help = "draw the error of the real-time picture against the reference, relative "
                        "to the mean brightness of the balls: red is too bright, blue is too dark, "
                        "and full colour is 25 %; an .exr file holds numbers with sign"},
    [WALK] = {"walk", CLI_FLAG, AT(walk),
              .help = "compute the reference's reflections between microfacets, from the second "
                      "on, by random walks (Heitz et al. 2016) instead of by --method",
              .more = "With --error the picture then shows the error of the method too."},
    [ALONE] = {"alone", CLI_FLAG, AT(alone),
               .help = "leave out of the reference the light that balls reflect on one another, as "
                       "the real-time picture does",
               .more = "With --occlusion a ball then sees the other balls as black."},
    [BOUNCES] =
        {"bounces", CLI_INTEGER, AT(bounces), 1, 1000, 0, "N",
         .help = "drop from the reference the light that would be reflected by more than N balls",
         .unset = "no limit"},
    [NOISE] = {"noise", CLI_NUMBER, AT(noise), 1e-4, 1, 0.01, "E",
               .help = "stop the reference when the relative standard error of a pixel is E"},
    [THREADS] = CLI_THREADS_ROW(render),
    [QUIET] = CLI_QUIET_ROW(render),
};

// Checks that options of the reference are not given without --reference.
static int check_reference(const render *r)
{
    static const int of_reference[] = {NOISE, WALK, ALONE, BOUNCES};
    const char *const *given = r->arguments.text;
    bool reference = r->reference || r->errors;
    if (r->reference && r->errors)
        return cli_wrong(&cli_render, "--reference and --error contradict each other");
    for (size_t i = 0; i < sizeof of_reference / sizeof *of_reference && !reference; i++)
        if (given[of_reference[i]])
            return cli_wrong(&cli_render, "--%s needs --reference or --error",
                             options[of_reference[i]].name);
    if (r->alone && given[BOUNCES])
        return cli_wrong(&cli_render, "--alone and --bounces contradict each other");
    if (r->walk && r->setup.options.scene == VIEW_SCENE_ASSIGNMENT)
        return cli_wrong(
            &cli_render,
            "--walk is not for the scene assignment, whose light comes from one direction");
    if (reference && r->setup.options.debug)
        return cli_wrong(&cli_render,
                         "--debug shows the real-time picture, leave --reference and --error out");
    return CLI_GO;
}

static int read_options(render *r, const cli_call *call)
{
    int code = cli_read_arguments(&r->arguments, &cli_render, call, r);
    if (code != CLI_GO)
        return code;
    if (!r->output)
        return cli_wrong(&cli_render, "no output: name it by -o FILE");
    if (!cli_ends_in(r->output, "png") && !cli_ends_in(r->output, "exr") &&
        !cli_ends_in(r->output, "hdr"))
        return cli_wrong(&cli_render, "--output %s: must end in .png, .exr or .hdr", r->output);
    code = scene_read(&r->arguments, false, &r->setup);
    if (code == CLI_GO)
        code = check_reference(r);
    if (code != CLI_GO)
        return code;
    if (r->errors && cli_ends_in(r->output, "hdr"))
        return cli_wrong(&cli_render,
                         "--output %s: .hdr cannot hold negative errors, name an .exr or .png file",
                         r->output);
    return cli_check_folder(r->output);
}

static int draw(cli_work *work, const scene_setup *s, const kiln_map *source, bool linear,
                char name[128], kiln_image *image)
{
    view_headless *headless = NULL;
    view_renderer *renderer = NULL;
    int code = CLI_FAILED;
    if (view_headless_create(&headless, &work->error) ||
        view_create(work->context, view_headless_lookup, &renderer, &work->error))
        goto done;
    if (scene_has_environment(s) && scene_bake(work, s, source, renderer) != CLI_GO)
        goto done;
    if (view_picture(renderer, &s->options, s->width, s->height, linear, image, &work->error))
        goto done;
    snprintf(name, 128, "%s", view_gl_name(renderer));
    code = CLI_GO;
done:
    view_destroy(renderer);
    view_headless_destroy(headless);
    return code;
}

static int integrate(cli_work *work, const render *r, const kiln_map *source, bool linear,
                     kiln_image *image, view_reference_report *report)
{
    const view_options *o = &r->setup.options;
    view_reference_def def = {.noise = r->noise,
                              .walk = r->walk,
                              .alone = r->alone,
                              .lights = &r->setup.taken,
                              .bounces = r->bounces,
                              .thread_count = r->threads,
                              .progress = cli_progress,
                              .progress_user = work};
    if (view_reference(work->context, o, source->size ? source : NULL, r->setup.width,
                       r->setup.height, &def, image, report, &work->error))
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

// Renders or integrates the picture; `words` receives a description of the result.
static int make(cli_work *work, render *r, bool linear, kiln_image *image, char words[256],
                view_error *errors)
{
    kiln_map source = {0};
    kiln_image truth = {0};
    view_reference_report report = {0};
    char name[128] = "";
    int code = scene_has_environment(&r->setup) ? scene_load(work, &r->setup, &source) : CLI_GO;
    if (code == CLI_GO && r->reference) {
        code = integrate(work, r, &source, linear, image, &report);
        snprintf(words, 256, "integrated to a noise of %.2g, %.0f samples a ray", report.noise,
                 report.batches);
    } else if (code == CLI_GO && r->errors) {
        view_error e = {0};
        code = draw(work, &r->setup, &source, true, name, image);
        if (code == CLI_GO)
            code = integrate(work, r, &source, true, &truth, &report);
        if (code == CLI_GO)
            e = view_compare(&r->setup.options, image, &truth, !linear);
        snprintf(words, 256, "error RMS %.3g, largest %.3g, on screen %.2f of 255, noise %.2g",
                 e.rms, e.largest, e.screen, report.noise);
        if (code == CLI_GO)
            *errors = e;
    } else if (code == CLI_GO) {
        code = draw(work, &r->setup, &source, linear, name, image);
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

static int run(const cli_call *call)
{
    cli_work work;
    render r = {.noise = 0};
    char words[256] = "";
    kiln_image image = {0};
    view_error errors = {.rms = 0};
    int code = read_options(&r, call);
    if (code != CLI_GO)
        return code;
    code = cli_begin_work(&work, r.threads, r.quiet);
    if (code == CLI_GO)
        code = make(&work, &r, !cli_ends_in(r.output, "png"), &image, words, &errors);
    if (code == CLI_GO)
        code = kiln_image_save(work.context, &image, r.output, &work.error) ? CLI_FAILED : CLI_DONE;
    cli_clear_progress(&work);
    if (code == CLI_DONE && !r.quiet) {
        printf("%s: %s, %d x %d, %s, %.2f s\n", cli_show(r.output).text,
               view_scene_name((int)r.setup.options.scene), r.setup.width, r.setup.height, words,
               cli_elapsed(&work));
        cli_print_lights(&r.setup.taken);
        print_errors(&r.setup.options, &errors);
    }
    kiln_image_free(&image);
    return cli_end_work(&work, code);
}

static const cli_example examples[] = {
    {"kiln render -o balls.png", "two rows of copper balls: with Kulla and Conty's lobe above, "
                                 "with light reflected once below"},
    {"kiln render city.exr -o gold.png --material gold --exposure -1", "gold balls in a city"},
    {"kiln render city.exr -o compare.png --scene compare",
     "the exact bake at the left, the textbook's bake at the right"},
    {"kiln render city.exr -o error.png --error --size 640x360",
     "the error of prefiltered levels and tables at each pixel"},
    {"kiln render city.exr -o sun.png --sun extract --ground",
     "the sun as a disc of its true size, and the shadows of the balls"},
    {"kiln render -o furnace.exr --scene furnace",
     "white balls in white light, which a correct method makes invisible"},
    {NULL, NULL}};

const cli_command cli_render = {
    .name = "render",
    .arguments = "[ENV] -o FILE [OPTION...]",
    .summary = "Renders balls in an environment into a file.",
    .about = "ENV is a panorama or any other file that kiln bake reads; a baked .ktx2 file is used "
             "without another bake. Without ENV, a sky by 'kiln sky' lights scenes that need an "
             "environment. Pictures are drawn by OpenGL ES 3.0; no screen is needed.",
    .examples = examples,
    .options = options,
    .run = run,
};
