// kiln view: the scenes in a window.
#include "cli.h"
#include "look.h"
#include "os.h"

#include "controls.h"
#include "window.h"

#include <pthread.h>
#include <stdatomic.h>
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

// The textbook's bake takes a minute or more: it goes on behind the window.
typedef struct textbook {
    pthread_t thread;
    bool begun, set;
    atomic_bool stop, finished;
    atomic_int thousandths;
    kiln_context *context;
    kiln_environment environment;
    kiln_result result;
    kiln_error error;
} textbook;

typedef struct show {
    cli_job *job;
    const look *look;
    const kiln_map *source;
    int threads;
    textbook textbook;
} show;

static bool note_progress(void *user, const char *stage, double fraction)
{
    textbook *t = user;
    (void)stage;
    atomic_store(&t->thousandths, (int)(1000 * fraction));
    return !atomic_load(&t->stop);
}

static void *bake(void *user)
{
    show *s = user;
    textbook *t = &s->textbook;
    t->result = view_bake(t->context, s->source, s->look->bake_size, LOOK_TEXTBOOK_SAMPLES,
                          &t->environment, &t->error);
    atomic_store(&t->finished, true);
    return NULL;
}

static void create_thread(void *user)
{
    show *s = user;
    textbook *t = &s->textbook;
    const kiln_context_def def = {
        .thread_count = s->threads, .progress = note_progress, .progress_user = t};
    t->result = kiln_context_create(&def, &t->context, &t->error);
    t->begun = t->result == KILN_OK && !pthread_create(&t->thread, NULL, bake, s);
}

static kiln_result begin_textbook(show *s, view_renderer *renderer, kiln_error *error)
{
    textbook *t = &s->textbook;
    // Until then both halves are exact.
    if (look_bake_slot(s->job, s->look, s->source, VIEW_SLOT_TEXTBOOK, 0, renderer) != CLI_GO) {
        *error = s->job->error;
        return error->result;
    }
    os_without_signals(create_thread, s); // signals are for the window's thread
    if (t->begun)
        return KILN_OK;
    *error = t->error;
    if (!t->context)
        return error->result;
    snprintf(error->message, sizeof error->message, "no thread for the textbook's bake");
    return error->result = KILN_ERROR_MEMORY;
}

static kiln_result ask_textbook(void *user, view_renderer *renderer, bool wait, double *done,
                                kiln_error *error)
{
    show *s = user;
    textbook *t = &s->textbook;
    kiln_result result = t->begun ? KILN_OK : begin_textbook(s, renderer, error);
    *done = atomic_load(&t->thousandths) / 1001.0; // 1 is for when it is set
    if (result != KILN_OK || (!wait && !atomic_load(&t->finished)))
        return result;
    pthread_join(t->thread, NULL);
    t->set = true;
    *done = 1;
    const kiln_environment *e = &t->environment;
    if (t->result == KILN_OK)
        return view_set_environment(renderer, VIEW_SLOT_TEXTBOOK, &e->levels, &e->sh,
                                    &e->irradiance, error);
    *error = t->error;
    return t->result;
}

static void end_textbook(textbook *t)
{
    atomic_store(&t->stop, true);
    if (t->begun && !t->set)
        pthread_join(t->thread, NULL);
    kiln_environment_free(&t->environment);
    kiln_context_destroy(t->context);
}

// The job keeps the sentence where the work was its own.
static kiln_result prepare(void *user, view_renderer *renderer, kiln_error *error)
{
    const show *s = user;
    if (look_bake_slot(s->job, s->look, s->source, VIEW_SLOT_EXACT, 0, renderer) == CLI_GO)
        return KILN_OK;
    *error = s->job->error;
    return error->result;
}

static bool go_on(void *user)
{
    (void)user;
    return !cli_interrupted();
}

static int open_window(cli_job *job, const look *l, int threads, const char *screenshot)
{
    kiln_map source = {0};
    kiln_image image = {0};
    show s = {.job = job, .look = l, .source = &source, .threads = threads};
    view_window_def def = {.title = l->input ? l->input : "kiln",
                           .width = l->width,
                           .height = l->height,
                           .options = l->options,
                           .prepare = prepare,
                           .go_on = go_on,
                           .user = &s,
                           .has_environment = true,
                           .textbook = ask_textbook,
                           .screenshot = screenshot ? &image : NULL};
    int code = look_load(job, l, &source);
    if (code == CLI_GO)
        code = view_window(job->context, &def, &job->error) ? CLI_FAILED : CLI_DONE;
    end_textbook(&s.textbook);
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
            code = open_window(&job, &l, threads, a.value[SCREENSHOT]);
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
               "      the exact bake beside the textbook's, which bakes meanwhile; [ and ] move "
               "the handle\n"
               "  kiln view\n"
               "      the assignment's two rows\n",
    .options = options,
    .run = run,
};
