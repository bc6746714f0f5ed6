// kiln render. In: a scene's options and an environment. Out: a picture of the scene, rendered by
// OpenGL ES 3.0 without a window or integrated by the reference (--reference), or their difference.
#include "scene_setup.h"

#include "headless.h"
#include "render_error.h"

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
    JSON,
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
    bool reference, errors, walk, alone, json, quiet;
    double noise;
    render_errors measured; // with --error
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
                .help = "print the error of the real-time picture against the reference for each "
                        "ball and each way of --reflections; -o, which may be absent, draws the "
                        "error relative to the mean brightness of the balls: red is too bright, "
                        "blue is too dark, and full colour is 25 %; an .exr file holds numbers "
                        "with sign"},
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
    [JSON] = {"json", CLI_FLAG, AT(json), .help = "print the errors of --error as JSON"},
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
    if (r->json && !r->errors)
        return cli_wrong(&cli_render, "--json needs --error, whose figures it prints");
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
    if (!r->output && !r->errors)
        return cli_wrong(&cli_render, "no output: name it by -o FILE");
    if (r->output && !cli_ends_in(r->output, "png") && !cli_ends_in(r->output, "exr") &&
        !cli_ends_in(r->output, "hdr"))
        return cli_wrong(&cli_render, "--output %s: must end in .png, .exr or .hdr", r->output);
    code = scene_read(&r->arguments, false, &r->setup);
    if (code == CLI_GO)
        code = check_reference(r);
    if (code != CLI_GO)
        return code;
    if (r->errors && r->output && cli_ends_in(r->output, "hdr"))
        return cli_wrong(&cli_render,
                         "--output %s: .hdr cannot hold negative errors, name an .exr or .png file",
                         r->output);
    return r->output ? cli_check_folder(r->output) : CLI_GO;
}

// Draws the view by its own way to look reflections up, or with `each` by every way: images[way].
static int draw(cli_work *work, const scene_setup *s, const kiln_map *source, bool linear,
                bool each, char name[128], kiln_image *images)
{
    view_headless *headless = NULL;
    view_renderer *renderer = NULL;
    int code = CLI_FAILED;
    if (view_headless_create(&headless, &work->error) ||
        view_create(work->context, view_headless_lookup, &renderer, &work->error))
        goto done;
    if (scene_has_environment(s) && scene_bake(work, s, source, renderer) != CLI_GO)
        goto done;
    for (int i = 0; i < (each ? VIEW_REFLECTIONS_COUNT : 1); i++) {
        view_options o = s->options;
        if (each)
            o.reflections = (view_reflections)i;
        if (view_picture(renderer, &o, s->width, s->height, linear, &images[i], &work->error))
            goto done;
    }
    snprintf(name, 128, "%s", view_gl_name(renderer));
    code = CLI_GO;
done:
    view_destroy(renderer);
    view_headless_destroy(headless);
    return code;
}

static int integrate(cli_work *work, const render *r, const kiln_map *source, bool linear,
                     kiln_image *image, kiln_image *deviation, view_reference_report *report)
{
    const view_options *o = &r->setup.options;
    view_reference_def def = {.noise = r->noise,
                              .walk = r->walk,
                              .alone = r->alone,
                              .lights = &r->setup.taken,
                              .bounces = r->bounces,
                              .deviation = deviation,
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

// Compares the real-time picture of every way to look reflections up with one reference. `image`
// receives the differences of the view's own way.
static int measure(cli_work *work, render *r, const kiln_map *source, bool colours,
                   kiln_image *image)
{
    kiln_image drawn[VIEW_REFLECTIONS_COUNT] = {{0}}, truth = {0}, deviation = {0};
    const view_options *o = &r->setup.options;
    char name[128];
    int code = draw(work, &r->setup, source, true, true, name, drawn);
    if (code == CLI_GO)
        code = integrate(work, r, source, true, &truth, &deviation, &r->measured.reference);
    if (code == CLI_GO) {
        for (int i = 0; i < VIEW_REFLECTIONS_COUNT; i++)
            r->measured.by[i] = view_compare(o, &drawn[i], &truth, colours);
        r->measured.noise = view_noise(o, &truth, &deviation);
        *image = drawn[o->reflections];
        drawn[o->reflections] = (kiln_image){0};
    }
    for (int i = 0; i < VIEW_REFLECTIONS_COUNT; i++)
        kiln_image_free(&drawn[i]);
    kiln_image_free(&deviation);
    kiln_image_free(&truth);
    return code;
}

// Renders or integrates the picture; `words` receives a description of the result.
static int make(cli_work *work, render *r, bool linear, kiln_image *image, char words[256])
{
    kiln_map source = {0};
    view_reference_report report = {0};
    char name[128] = "";
    int code = scene_has_environment(&r->setup) ? scene_load(work, &r->setup, &source) : CLI_GO;
    if (code == CLI_GO && r->reference) {
        code = integrate(work, r, &source, linear, image, NULL, &report);
        snprintf(words, 256, "integrated to a noise of %.2g, %.0f samples a ray", report.noise,
                 report.batches);
    } else if (code == CLI_GO && r->errors) {
        code = measure(work, r, &source, !linear, image);
        const view_error *e = &r->measured.by[r->setup.options.reflections];
        snprintf(words, 256, "error RMS %.3g, largest %.3g, on screen %.2f of 255, noise %.2g",
                 e->rms, e->largest, e->screen, r->measured.reference.noise);
    } else if (code == CLI_GO) {
        code = draw(work, &r->setup, &source, linear, false, name, image);
        snprintf(words, 256, "by %s", name);
    }
    kiln_map_free(&source);
    return code;
}

static void report(cli_work *work, const render *r, const char *words)
{
    const scene_setup *s = &r->setup;
    const char *name = r->output ? r->output : s->input;
    cli_clear_progress(work);
    if (r->json) {
        render_print_json(s->input, &s->options, s->width, s->height, &r->measured);
        return;
    }
    if (r->quiet)
        return;
    printf("%s: %s, %d x %d, %s, %.2f s\n", name ? cli_show(name).text : "sky",
           view_scene_name((int)s->options.scene), s->width, s->height, words, cli_elapsed(work));
    cli_print_lights(&s->taken);
    if (r->errors)
        render_print_errors(&s->options, &r->measured);
}

static int run(const cli_call *call)
{
    cli_work work;
    render r = {.noise = 0};
    char words[256] = "";
    kiln_image image = {0};
    int code = read_options(&r, call);
    if (code != CLI_GO)
        return code;
    code = cli_begin_work(&work, r.threads, r.quiet);
    if (code == CLI_GO)
        code = make(&work, &r, !r.output || !cli_ends_in(r.output, "png"), &image, words);
    if (code == CLI_GO && r.output && kiln_image_save(work.context, &image, r.output, &work.error))
        code = CLI_FAILED;
    if (code == CLI_GO) {
        report(&work, &r, words);
        code = CLI_DONE;
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
    {"kiln render city.exr --error --json --alone",
     "prints the error of each ball for each way to look reflections up"},
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
