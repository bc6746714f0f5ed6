// The work of a command: a kiln context with a progress line on the terminal, which stops on
// signals.
#ifndef KILN_CLI_WORK_H
#define KILN_CLI_WORK_H

#include "cli.h"

typedef struct cli_work {
    kiln_context *context;
    kiln_error error;
    int threads;
    double began; ///< time at which the command's work began, by os_seconds
    /// time at which the progress line was last drawn, by os_seconds; 0 before the first time
    double drawn;
    bool quiet; ///< true: nothing but errors is printed
    /// true: progress is drawn, because standard error is a terminal and --quiet is absent
    bool on_terminal;
    const char *stage;      ///< name of the last reported stage, a string constant
    double stage_began;     ///< time at which that stage was first reported, by os_seconds
    double reading_seconds; ///< seconds of all stages called "reading" that have ended
    double furthest;        ///< largest fraction reported of the stage, 0 to 1
    /// Called with true before something is printed and with false afterwards, where several works
    /// share the terminal; may be NULL.
    void (*hold)(void *user, bool begins);
    void *hold_user;
    kiln_load_report loaded; ///< counts of what cli_load found and changed in the input file
} cli_work;

/// Creates the context. `threads`: 0 for one thread a core. `quiet`: no progress line. Returns
/// CLI_GO or CLI_FAILED.
int cli_begin_work(cli_work *work, int threads, bool quiet);
/// Clears the progress line, prints work->error if `code` is CLI_FAILED, and frees the context.
/// Returns the exit code: `code`, or 128 + N if signal N stopped the work.
int cli_end_work(cli_work *work, int code);
/// Seconds since the work began.
double cli_elapsed(const cli_work *work);
/// Returns whether a signal has asked the process to stop.
bool cli_interrupted(void);
void cli_clear_progress(cli_work *work);
/// Begins and ends the printing of what must not be mixed with the progress line or with the output
/// of works in other threads.
void cli_hold_output(cli_work *work, bool begins);
/// Returns the bytes that the process may use: the memory of the machine, or of its control group;
/// 0 if unknown.
size_t cli_memory_limit(void);
/// Progress callback: draws the progress line of `user`, a cli_work. Returns false if a signal has
/// asked the process to stop.
bool cli_progress(void *user, const char *stage, double fraction);
/// Prints "kiln: warning: MESSAGE" or "kiln: note: MESSAGE" on standard error.
void cli_note(cli_work *work, bool warning, const char *format, ...) CLI_PRINTF(3, 4);

// ------------------------------------------------------------------------------------------- input

/// Loads an environment. One name is a file, a folder, a pattern, or "-" for standard input. Six
/// names are those of the cube's faces, as kiln_map_load_faces takes them. What the loader found is
/// told on standard error and stays in work->loaded. Returns CLI_GO or CLI_FAILED.
int cli_load(cli_work *work, const char **names, int count, const kiln_load_def *def,
             kiln_map *map);
/// Says on standard error what the loader found and changed in the input `name`, as it stands in
/// work->loaded.
void cli_say_report(cli_work *work, const char *name);
/// Checks the number and form of the names. Returns CLI_GO, or CLI_WRONG if the names cannot be an
/// input.
int cli_check_input(const cli_command *command, const char **names, int count);

#endif
