// The work of a command: a context whose progress is drawn on a terminal and which stops on signals.
#ifndef KILN_CLI_WORK_H
#define KILN_CLI_WORK_H

#include "cli.h"

typedef struct cli_work {
    kiln_context *context;
    kiln_error error;
    int threads;
    double began;      ///< in seconds, by os_seconds
    double drawn;      ///< when the progress line was drawn last, 0 for never
    bool on_terminal;  ///< standard error is a terminal, and progress is wanted
    const char *stage; ///< the stage reported last, which is constant text
    double furthest;   ///< how far that stage was, 0 to 1
} cli_work;

/// CLI_GO or CLI_FAILED. `threads` 0 for one a core; `quiet`: no progress.
int cli_begin_work(cli_work *work, int threads, bool quiet);
/// Clears the progress line, prints the sentence in work->error where `code` is CLI_FAILED and releases
/// everything. Returns the exit code: 128 + N where signal N stopped the work.
int cli_end_work(cli_work *work, int code);
/// Seconds since the work began.
double cli_elapsed(const cli_work *work);
/// Whether a signal asks to stop.
bool cli_interrupted(void);
void cli_clear_progress(cli_work *work);
/// Draws the progress line of `user`, a cli_work; false where a signal asks to stop.
bool cli_progress(void *user, const char *stage, double fraction);
/// "kiln: warning: SENTENCE" on standard error.
void cli_warn(cli_work *work, const char *format, ...) CLI_PRINTF(2, 3);

// ------------------------------------------------------------------------------------------- input

/// One name: a file, a folder, a pattern, "-". Six names: faces, by the px nx py ny pz nz (or
/// right left top bottom front back) in their names or else in that order. CLI_GO or CLI_FAILED.
int cli_load(cli_work *work, const char **names, int count, kiln_layout layout, kiln_map *map);
/// CLI_GO, or CLI_WRONG where the names cannot be an input.
int cli_check_input(const cli_command *command, const char **names, int count);

#endif
