// kiln view: the scenes in a window.
#include "cli.h"
#include "look.h"

#include "controls.h"
#include "window.h"

#include <stdio.h>
#include <string.h>

enum { SCREENSHOT = 1, THREADS };

static const struct poptOption options[] = {
    {NULL, 0, POPT_ARG_INCLUDE_TABLE, (void *)look_options, 0, "The view:", NULL},
    {"screenshot", 0, POPT_ARG_STRING, NULL, SCREENSHOT,
     "draw once, write what the window holds as .png and leave", "FILE"},
    {"threads", 0, POPT_ARG_STRING, NULL, THREADS, "1 to 256, one a core by default", "N"},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

typedef struct show {
    cli_job *job;
    const look *look;
    const kiln_map *source;
} show;

// The job keeps the sentence where the work was its own.
static kiln_result prepare(void *user, view_renderer *renderer, kiln_error *error)
{
    const show *s = user;
    if (look_bake_slot(s->job, s->look, s->source, VIEW_SLOT_EXACT, renderer) == CLI_GO)
        return KILN_OK;
    *error = s->job->error;
    return error->result;
}

static kiln_result textbook(void *user, view_renderer *renderer, kiln_error *error)
{
    const show *s = user;
    if (look_bake_slot(s->job, s->look, s->source, VIEW_SLOT_TEXTBOOK, renderer) == CLI_GO)
        return KILN_OK;
    *error = s->job->error;
    return error->result;
}

static bool go_on(void *user)
{
    (void)user;
    return !cli_interrupted();
}

static int open_window(cli_job *job, const look *l, const char *screenshot)
{
    kiln_map source = {0};
    kiln_image image = {0};
    show s = {job, l, &source};
    view_window_def def = {.title = l->input ? l->input : "kiln",
                           .width = l->width,
                           .height = l->height,
                           .options = l->options,
                           .prepare = prepare,
                           .go_on = go_on,
                           .user = &s,
                           .has_environment = true,
                           .textbook = textbook,
                           .screenshot = screenshot ? &image : NULL};
    int code = look_load(job, l, &source);
    if (code == CLI_GO)
        code = view_window(job->context, &def, &job->error) ? CLI_FAILED : CLI_DONE;
    if (code == CLI_DONE && cli_interrupted())
        code = CLI_FAILED; // closed by a signal, as the exit code will say
    if (code == CLI_DONE && screenshot)
        code =
            kiln_image_save(job->context, &image, screenshot, &job->error) ? CLI_FAILED : CLI_DONE;
    kiln_image_free(&image);
    kiln_map_free(&source);
    return code;
}

static int run(int argc, const char **argv)
{
    cli_arguments a;
    cli_job job;
    look l;
    int threads = 0, code = cli_arguments_read(&a, &cli_view, argc, argv);
    if (code == CLI_GO)
        code = look_read(&a, &l);
    if (code == CLI_GO)
        code = cli_integer(&a, THREADS, "--threads", 1, 256, &threads);
    if (code == CLI_GO && a.value[SCREENSHOT] &&
        strcmp(cli_ending(a.value[SCREENSHOT]), "png") != 0)
        code = cli_wrong(&cli_view, "--screenshot %s: must end in .png", a.value[SCREENSHOT]);
    if (code == CLI_GO && a.value[SCREENSHOT])
        code = cli_check_folder(a.value[SCREENSHOT]);
    if (code == CLI_GO) {
        code = cli_job_begin(&job, threads, false);
        if (code == CLI_GO)
            code = open_window(&job, &l, a.value[SCREENSHOT]);
        code = cli_job_end(&job, code);
    }
    cli_arguments_free(&a);
    return code;
}

const cli_command cli_view = {
    .name = "view",
    .arguments = "[ENV] [OPTION...]",
    .summary = "Shows the balls in a window.",
    .details = "The key h prints what the keys do. Drag to orbit, with shift to turn the\n"
               "environment; the wheel zooms.\n"
               "\n"
               "Examples:\n"
               "  kiln view city.exr\n"
               "      gold in a city\n"
               "  kiln view city.exr --scene compare\n"
               "      the exact bake beside the textbook's, [ and ] move the handle\n"
               "  kiln view\n"
               "      the assignment's two rows\n",
    .options = options,
    .run = run,
};
