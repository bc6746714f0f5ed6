// The context, the progress line and the signals of a command's work.
#include "work.h"
#include "cgroup.h"
#include "os.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { PROGRESS_WIDTH = 40 };

bool cli_interrupted(void)
{
    return os_signal() != 0;
}

double cli_elapsed(const cli_work *work)
{
    return os_seconds() - work->began;
}

void cli_clear_progress(cli_work *work)
{
    if (work->drawn > 0)
        fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH, "");
    work->drawn = 0;
}

void cli_hold_output(cli_work *work, bool begins)
{
    if (begins)
        cli_clear_progress(work);
    if (work->hold)
        work->hold(work->hold_user, begins);
}

bool cli_progress(void *user, const char *stage, double fraction)
{
    cli_work *work = user;
    double now = os_seconds();
    bool other = !work->stage || strcmp(stage, work->stage) != 0;
    if (other && work->stage && !strcmp(work->stage, "reading"))
        work->reading_seconds += now - work->stage_began;
    if (other)
        work->stage_began = now;
    // The progress line never goes backwards within a stage.
    if (other || fraction > work->furthest)
        work->furthest = fraction;
    work->stage = stage;
    os_tell_progress(stage, work->furthest);
    bool due = now - work->began > 0.5 && now - work->drawn > 0.1;
    if (work->on_terminal && due && !cli_interrupted()) {
        char line[PROGRESS_WIDTH + 1];
        snprintf(line, sizeof line, "kiln: %s %.0f %%", stage, 100 * work->furthest);
        fprintf(stderr, "\r%-*s", PROGRESS_WIDTH, line);
        work->drawn = now;
    }
    return !cli_interrupted();
}

// A bake that needs more than the memory of the machine, or than the control group of the process
// may use, fails with an error message. Without a limit the system would kill the bake.
size_t cli_memory_limit(void)
{
    size_t physical = os_physical_memory(), group = cgroup_memory_limit("");
    return group && (!physical || group < physical) ? group : physical;
}

static void create_context(void *user)
{
    cli_work *work = user;
    kiln_context_def def = {
        .thread_count = work->threads,
        .progress = cli_progress,
        .progress_user = work,
        .memory_limit = cli_memory_limit(),
    };
    work->error.result = kiln_context_create(&def, &work->context, &work->error);
}

int cli_begin_work(cli_work *work, int threads, bool quiet)
{
    *work = (cli_work){.began = os_seconds(),
                       .threads = threads,
                       .quiet = quiet,
                       .on_terminal = !quiet && os_is_terminal(OS_ERRORS)};
    os_catch_signals();
    os_without_signals(create_context, work);
    if (!work->context)
        return CLI_FAILED;
    int running, wanted;
    kiln_context_threads(work->context, &running, &wanted);
    if (running < wanted && !quiet)
        cli_note(work, false, "%d of %d threads work, the system starts no more", running, wanted);
    return CLI_GO;
}

int cli_end_work(cli_work *work, int code)
{
    int signal = os_signal();
    cli_clear_progress(work);
    if (code == CLI_FAILED && !signal && work->error.message[0])
        cli_fail("%s", work->error.message);
    kiln_context_destroy(work->context);
    return code == CLI_FAILED && signal ? 128 + signal : code;
}

void cli_note(cli_work *work, bool warning, const char *format, ...)
{
    va_list list;
    cli_hold_output(work, true);
    va_start(list, format);
    cli_say(warning ? "kiln: warning: " : "kiln: note: ", format, list);
    va_end(list);
    cli_hold_output(work, false);
}
