// What the commands of kiln share: exit codes, a command's description, its arguments, and sentences.
#ifndef KILN_CLI_H
#define KILN_CLI_H

#include "option.h"

#include <kiln/brdf.h>

#include <stdbool.h>

/// Lets the compiler check a function's arguments against its format, printf's as C17 has it.
#if defined(__MINGW32__) && !defined(__clang__)
#define CLI_PRINTF(format_at, first) __attribute__((format(gnu_printf, format_at, first)))
#else
#define CLI_PRINTF(format_at, first) __attribute__((format(printf, format_at, first)))
#endif

enum {
    CLI_DONE = 0,   ///< the work is done
    CLI_FAILED = 1, ///< bad input, or the work could not be done
    CLI_WRONG = 2,  ///< the command line makes no sense
    CLI_GO = -1,    ///< not an exit code: go on
};

/// A command line and what it does, which may be NULL.
typedef struct cli_example {
    const char *line, *meaning;
} cli_example;

typedef struct cli_command cli_command;

/// What a command is called with. `words` is the command's own to change.
typedef struct cli_call {
    const cli_command *const *commands; ///< all there are, NULL behind the last
    int count;
    const char **words; ///< the command's name first
} cli_call;

struct cli_command {
    const char *name;      ///< "bake"
    const char *arguments; ///< "IN... -o OUT"; '|' between ways to call the command
    const char *summary;   ///< one sentence
    const char *about;     ///< paragraphs, each without line breaks inside; "" for none
    const char *(*word)(
        int index);         ///< what the first argument may be, NULL behind the last; or NULL
    const char *list_title; ///< "Quantities"
    /// What an argument may be: the word of an index with what it takes, and in words what that is; NULL
    /// behind the last. The function may be NULL.
    const char *(*list)(int index, char left[64]);
    const char *more;            ///< further paragraphs, for the manual; may be NULL
    const cli_example *examples; ///< ends in {NULL, NULL}
    const cli_option *options;   ///< or NULL; --help is not among them
    int (*run)(const cli_call *call);
};

extern const cli_command cli_bake, cli_engines, cli_eval, cli_fit, cli_info, cli_sky, cli_tables;
extern const cli_command cli_completions, cli_help;
extern const cli_command cli_assignment, cli_render, cli_view; // with KILN_VIEWER

// --------------------------------------------------------------------------------------- arguments

enum { CLI_MAX_OPTIONS = 48 };

typedef struct cli_arguments {
    const cli_command *command;
    const char *text[CLI_MAX_OPTIONS]; ///< by the row's index: NULL where not given, "" for a flag
    const char **rest;                 ///< what is no option
    int rest_count;
} cli_arguments;

/// Reads a command's words into `arguments`, and values and defaults into `values`, the structure that the
/// rows' offsets are of. CLI_GO, or the exit code: help has been printed, or a sentence about what is
/// wrong. The words must outlive both.
int cli_read_arguments(cli_arguments *arguments, const cli_command *command, const cli_call *call,
                       void *values);
/// Writes the values of the options that are given into `values` again.
int cli_store_values(const cli_arguments *arguments, void *values);
/// The number of an option of CLI_TEXT that is given, within a range that depends on other options; not
/// given leaves `value` alone. CLI_GO or CLI_WRONG.
int cli_integer(const cli_arguments *arguments, int option, int low, int high, int *value);
/// The index of a word, likewise. `words` ends in NULL.
int cli_choice(const cli_arguments *arguments, int option, const char *const *words, int *value);

/// The index of an argument among words, which are those of a row: CLI_GO, or CLI_WRONG with a sentence that
/// names `what` is wanted, all words, and the nearest.
int cli_find_word(const cli_command *command, const char *what, const char *text,
                  const cli_option *words, int *index);

// --------------------------------------------------------------------------------------- sentences

/// Prints "kiln: SENTENCE" and a hint to --help; returns CLI_WRONG. `command` may be NULL.
int cli_wrong(const cli_command *command, const char *format, ...) CLI_PRINTF(2, 3);
/// Prints "kiln: SENTENCE"; returns CLI_FAILED.
int cli_fail(const char *format, ...) CLI_PRINTF(1, 2);
/// "4.2 MB".
const char *cli_bytes(double bytes, char text[32]);
/// Empties standard output; the exit code, `code` unless nothing could be written.
int cli_close_output(int code);

// ------------------------------------------------------------------------------------- file names

/// Whether a name ends in a dot and `ending`, in small letters or capitals; "/" asks for a folder, which
/// a slash at the end or one that is there makes of the name.
bool cli_ends_in(const char *path, const char *ending);
/// The ending in small letters without its dot, "" where kiln has no such ending, "/" for a folder.
const char *cli_ending(const char *path);
/// Fails early, before the work, where the folder of an output file does not exist.
int cli_check_folder(const char *path);

// -------------------------------------------------------------------------------------------- help

/// Prints a command's help, as wide as the terminal or 80 characters.
void cli_print_help(const cli_command *command);
/// Prints `text`, its lines broken before `width`; each but the first begins with `indent` blanks. The
/// first begins at `column`. A line break in the text ends the line.
void cli_print_wrapped(const char *text, int column, int indent, int width);

// ------------------------------------------------------------------- options of several commands

/// The words of `d` and `g` of a model, and of Charlie's masking, for rows.
const char *cli_d_word(int index);
const char *cli_g_word(int index);
const char *cli_sheen_word(int index);
/// Whether the name that an option gives to source code can be one: CLI_GO or CLI_WRONG.
int cli_check_source_name(const cli_arguments *arguments, int option);

/// The rows that several commands have; `type` is the command's structure.
#define CLI_QUIET_ROW(type)                                                                        \
    {                                                                                              \
        "quiet", CLI_FLAG, offsetof(type, quiet), .letter = 'q',                                   \
                                                  .help = "print nothing but errors"               \
    }
#define CLI_THREADS_ROW(type)                                                                      \
    {                                                                                              \
        "threads", CLI_INTEGER, offsetof(type, threads), 1, 256, 0, "N",                           \
            "threads to work on; their number never changes the result", .letter = 'j',            \
                                                                         .unset = "one a core"     \
    }
#define CLI_D_ROW(type, field)                                                                     \
    {                                                                                              \
        "d", CLI_CHOICE, offsetof(type, field), .value = "D", .word = cli_d_word,                  \
                                                .help = "distribution of the normals"              \
    }
#define CLI_G_ROW(type, field)                                                                     \
    {                                                                                              \
        "g", CLI_CHOICE, offsetof(type, field),                                                    \
            .value = "G", .word = cli_g_word, .help = "masking and shadowing",                     \
            .more = "smith is height-correlated; k of Schlick's is roughness^2 / 2 or (roughness " \
                    "+ 1)^2 / 8."                                                                  \
    }

#endif
