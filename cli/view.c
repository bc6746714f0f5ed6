// kiln view. In: a scene's options and an environment. Out: a window that shows the scene
// (viewer/window.h), or a screenshot of it. For scene compare a second thread bakes the
// importance-sampled environment while the window is open.
#include "os.h"
#include "scene_setup.h"

#include "controls.h"
#include "window.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

enum { SCREENSHOT = SCENE_OPTIONS, THREADS, OPTIONS };

typedef struct view {
    // the shared options; must be the first member, because the shared option rows write to this
    // address
    scene_setup setup;
    const char *screenshot;
    int threads;
} view;

static const cli_option options[OPTIONS + 1] = {
    SCENE_ROWS,
    [SCREENSHOT] =
        {"screenshot", CLI_FILE, offsetof(view, screenshot), .value = "FILE", .group = "Window",
         .help = "draw one picture, write that picture to a .png file, and close the window"},
    [THREADS] = CLI_THREADS_ROW(view),
};

// The importance-sampled bake, which takes a minute or more and runs in a thread of its own.
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
    cli_work *work;
    const scene_setup *setup;
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
    t->result = view_bake(t->context, s->source, s->setup->bake_size, SCENE_TEXTBOOK_SAMPLES,
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
    // Until the bake by importance sampling has finished, both halves of scene compare show the
    // exact environment.
    if (scene_bake_slot(s->work, s->setup, s->source, VIEW_SLOT_TEXTBOOK, 0, renderer) != CLI_GO) {
        *error = s->work->error;
        return error->result;
    }
    // the thread blocks signals, which must reach the window's thread
    os_without_signals(create_thread, s);
    if (t->begun)
        return KILN_OK;
    *error = t->error;
    if (!t->context)
        return error->result;
    snprintf(error->message, sizeof error->message,
             "cannot start a thread for the textbook's bake");
    return error->result = KILN_ERROR_MEMORY;
}

static kiln_result ask_textbook(void *user, view_renderer *renderer, bool wait, double *done,
                                kiln_error *error)
{
    show *s = user;
    textbook *t = &s->textbook;
    kiln_result result = t->begun ? KILN_OK : begin_textbook(s, renderer, error);
    // at most 1000/1001, because 1 says that the sampled environment is set too
    *done = atomic_load(&t->thousandths) / 1001.0;
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

// Bakes and sets the environment before the window opens. On failure the error message is in
// work->error.
static kiln_result prepare(void *user, view_renderer *renderer, kiln_error *error)
{
    const show *s = user;
    if (scene_bake_slot(s->work, s->setup, s->source, VIEW_SLOT_EXACT, 0, renderer) == CLI_GO)
        return KILN_OK;
    *error = s->work->error;
    return error->result;
}

static bool go_on(void *user)
{
    (void)user;
    return !cli_interrupted();
}

static int open_window(cli_work *work, view *v)
{
    scene_setup *setup = &v->setup;
    kiln_map source = {0};
    kiln_image image = {0};
    show s = {.work = work, .setup = setup, .source = &source, .threads = v->threads};
    cli_shown title = cli_show(setup->input ? setup->input : "kiln");
    view_window_def def = {.title = title.text,
                           .width = setup->width,
                           .height = setup->height,
                           .options = setup->options,
                           .prepare = prepare,
                           .go_on = go_on,
                           .user = &s,
                           .has_environment = true,
                           .textbook = ask_textbook,
                           .screenshot = v->screenshot ? &image : NULL};
    int code = scene_load(work, setup, &source);
    if (code == CLI_GO)
        code = view_window(work->context, &def, &work->error) ? CLI_FAILED : CLI_DONE;
    end_textbook(&s.textbook);
    if (code == CLI_DONE && cli_interrupted())
        code = CLI_FAILED; // a signal closed the window; the exit code will name it
    if (code == CLI_DONE && v->screenshot &&
        kiln_image_save(work->context, &image, v->screenshot, &work->error))
        code = CLI_FAILED;
    kiln_image_free(&image);
    kiln_map_free(&source);
    return code;
}

static int read_options(view *v, const cli_call *call)
{
    cli_arguments a;
    int code = cli_read_arguments(&a, &cli_view, call, v);
    if (code == CLI_GO)
        code = scene_read(&a, true, &v->setup);
    if (code != CLI_GO || !v->screenshot)
        return code;
    if (!cli_ends_in(v->screenshot, "png"))
        return cli_wrong(&cli_view, "--screenshot %s: must end in .png", v->screenshot);
    return cli_check_folder(v->screenshot);
}

static int run(const cli_call *call)
{
    cli_work work;
    view v = {.threads = 0};
    int code = read_options(&v, call);
    if (code != CLI_GO)
        return code;
    code = cli_begin_work(&work, v.threads, false);
    if (code == CLI_GO)
        code = open_window(&work, &v);
    return cli_end_work(&work, code);
}

static const cli_example examples[] = {
    {"kiln view city.exr", "gold balls in a city"},
    {"kiln view city.exr --scene compare",
     "the exact bake and the textbook's bake, which is computed while the window is open; [ and ] "
     "move the line between the two"},
    {"kiln view", "two rows of copper balls under one light"},
    {NULL, NULL}};

const cli_command cli_view = {
    .name = "view",
    .arguments = "[ENV] [OPTION...]",
    .summary = "Shows balls in an environment in a window.",
    .about = "The key h prints the meaning of all keys. Drag with the mouse to move the camera, "
             "and drag with shift or with the right button to turn the environment. The wheel "
             "zooms. The keys 1 to 5 choose the scene; the scene compare can be chosen only if the "
             "window was opened with --scene compare.",
    .examples = examples,
    .options = options,
    .run = run,
};
