// What the sub-commands of kiln share: exit codes, options, the context with its progress line and
// signals, and the report.
#ifndef KILN_CLI_H
#define KILN_CLI_H

#include <kiln/brdf.h>

#include <cjson/cJSON.h>
#include <popt.h>
#include <stdbool.h>

enum {
    CLI_DONE = 0,   ///< the work is done
    CLI_FAILED = 1, ///< bad input, or the work could not be done
    CLI_WRONG = 2,  ///< the command line makes no sense
    CLI_GO = -1,    ///< not an exit code: go on
};

typedef struct cli_command {
    const char *name;      ///< "bake"
    const char *arguments; ///< "IN... -o OUT"
    const char *summary;   ///< one line for `kiln --help`
    const char *details;   ///< examples, printed under the options
    const struct poptOption *options;
    int (*run)(int argc, const char **argv);
} cli_command;

extern const cli_command cli_bake, cli_engines, cli_eval, cli_fit, cli_info, cli_sky, cli_tables;
extern const cli_command cli_hand_in, cli_render, cli_view; // with KILN_VIEWER

// ----------------------------------------------------------------------------------------- options

enum { CLI_MAX_OPTIONS = 48, CLI_HELP = CLI_MAX_OPTIONS - 1 };

/// The last line of every command's option table. Options have no `arg`; their `val`, 1 to
/// CLI_HELP - 1, is their place in cli_arguments.value.
#define CLI_HELP_OPTION                                                                            \
    {                                                                                              \
        "help", 'h', POPT_ARG_NONE, NULL, CLI_HELP, "print this and exit", NULL                    \
    }

typedef struct cli_arguments {
    const cli_command *command;
    poptContext popt;
    char *value[CLI_MAX_OPTIONS]; ///< NULL where not given, "" for options without a value
    const char **rest;            ///< what is not an option
    int rest_count;
} cli_arguments;

/// CLI_GO, or the exit code: help has been printed, or the sentence about a wrong option.
int cli_arguments_read(cli_arguments *arguments, const cli_command *command, int argc,
                       const char **argv);
void cli_arguments_free(cli_arguments *arguments);
/// The long name of an option, without dashes.
const char *cli_option_name(const cli_command *command, int option);

/// Prints "kiln: SENTENCE" and a hint to --help; returns CLI_WRONG. `command` may be NULL.
int cli_wrong(const cli_command *command, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/// Prints "kiln: SENTENCE"; returns CLI_FAILED.
int cli_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/// The number after an option, within its range; not given leaves `value` alone. CLI_GO or
/// CLI_WRONG, the range being in the sentence.
int cli_integer(const cli_arguments *arguments, int option, const char *name, int low, int high,
                int *value);
int cli_number(const cli_arguments *arguments, int option, const char *name, double low,
               double high, double *value);
/// The place of the option's word in `words`, which ends in NULL.
int cli_choice(const cli_arguments *arguments, int option, const char *name,
               const char *const *words, int *value);

/// The model that two options name; not given leaves its part alone.
int cli_model(const cli_arguments *arguments, int option_d, int option_g, kiln_model *model);

/// Whether the name that an option gives to source code can be one: CLI_GO or CLI_WRONG.
int cli_source_name(const cli_arguments *arguments, int option);

/// The ending of a file's name in small letters and without its dot, "" where it is none of kiln's, "/"
/// for a folder.
const char *cli_ending(const char *path);
/// Fails early, before the work, where the folder of an output file does not exist.
int cli_check_folder(const char *path);

// --------------------------------------------------------------------------------------------- job

/// One piece of work: a context whose progress is drawn on a terminal and which stops on signals.
typedef struct cli_job {
    kiln_context *context;
    kiln_error error;
    int threads;       ///< 0 for one a core
    double began;      ///< in seconds, by cli_seconds
    double drawn;      ///< when the progress line was drawn last, 0 for never
    bool on_terminal;  ///< standard error is one
    const char *stage; ///< the stage reported last, which is constant text
    double furthest;   ///< how far it was
} cli_job;

/// CLI_GO or CLI_FAILED. `threads` 0 for one a core; `quiet`: no progress.
int cli_job_begin(cli_job *job, int threads, bool quiet);
/// Clears the progress line, prints the sentence in job->error where `code` is CLI_FAILED and
/// releases everything. Returns the exit code: 128 + N where signal N stopped the work.
int cli_job_end(cli_job *job, int code);
/// A signal asks to stop.
bool cli_interrupted(void);
void cli_clear_progress(cli_job *job);
/// Draws the progress line of `user`, a job; false where a signal asks to stop.
bool cli_progress(void *user, const char *stage, double fraction);
/// "kiln: warning: SENTENCE" on standard error.
void cli_warn(cli_job *job, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// A clock that only goes forward.
double cli_seconds(void);
/// "4.2 MB".
const char *cli_bytes(double bytes, char text[32]);

/// Prints and deletes a report. CLI_DONE, or CLI_FAILED when memory ran out.
int cli_print_json(cJSON *json);
/// Empties standard output; the exit code, `code` unless nothing could be written.
int cli_close_output(int code);

// ------------------------------------------------------------------------------------------- input

/// One name: a file, a folder, a pattern, "-". Six names: faces, by the px nx py ny pz nz (or
/// right left top bottom front back) in their names or else in that order.
int cli_load(cli_job *job, const char **names, int count, enum kiln_layout layout, kiln_map *map);
/// CLI_GO, or CLI_WRONG where the names cannot be an input.
int cli_check_input(const cli_command *command, const char **names, int count);

#endif
