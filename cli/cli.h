// Declarations that the kiln commands share: exit codes, a command's description, its parsed
// arguments, error messages, file names and help.
#ifndef KILN_CLI_H
#define KILN_CLI_H

#include "option.h"

#include <kiln/brdf.h>

#include <stdarg.h>
#include <stdbool.h>

/// Lets the compiler check a function's arguments against its printf format.
#if defined(__MINGW32__) && !defined(__clang__)
#define CLI_PRINTF(format_at, first) __attribute__((format(gnu_printf, format_at, first)))
#else
#define CLI_PRINTF(format_at, first) __attribute__((format(printf, format_at, first)))
#endif

enum {
    CLI_DONE = 0,   ///< the work is done: exit code 0
    CLI_FAILED = 1, ///< bad input or failed work: exit code 1
    CLI_WRONG = 2,  ///< wrong command line: exit code 2
    CLI_GO = -1,    ///< no exit code: the caller continues
};

/// An example for the help: a command line, and an explanation, which may be NULL.
typedef struct cli_example {
    const char *line, *meaning;
} cli_example;

typedef struct cli_command cli_command;

/// What a command is called with. The command may change the array `words`.
typedef struct cli_call {
    const cli_command *const *commands; ///< all commands; a NULL ends the array
    int count;
    const char **words; ///< words of the command line, the command's name first
} cli_call;

struct cli_command {
    const char *name; ///< name of the command, such as "bake"
    /// form of the arguments, such as "IN... -o OUT"; '|' separates ways to call the command
    const char *arguments;
    const char *summary; ///< one sentence for the list of commands
    /// description: paragraphs without line breaks inside; "" for no description
    const char *about;
    /// returns the words that the first argument may be, NULL after the last; NULL if there is no
    /// such list
    const char *(*word)(int index);
    /// heading, in the help, of the list that `list` gives, such as "Quantities"
    const char *list_title;
    /// Lists what the first argument may be: writes the word of an index, with the arguments that
    /// follow the word, to `left`, and returns its description, or NULL after the last word. The
    /// function may be NULL.
    const char *(*list)(int index, char left[64]);
    const char *more;            ///< further paragraphs that only the manual shows; may be NULL
    const cli_example *examples; ///< array that ends in {NULL, NULL}
    const cli_option *options;   ///< rows of the options except --help; may be NULL
    /// command whose options may be given too, and which of its rows; NULL for none
    const cli_command *also;
    bool (*takes)(int option);
    /// Where the options stand if not on the command line, such as "list.jsonl, line 3", for error
    /// messages; NULL for the command line.
    const char *place;
    int (*run)(const cli_call *call);
};

extern const cli_command cli_bake, cli_batch, cli_check, cli_engines, cli_eval, cli_fit, cli_info,
    cli_lights, cli_sky, cli_tables;
extern const cli_command cli_completions, cli_help;
// commands that only builds with the CMake option KILN_VIEWER have
extern const cli_command cli_assignment, cli_render, cli_view;

// --------------------------------------------------------------------------------------- arguments

enum { CLI_MAX_OPTIONS = 48 };

typedef struct cli_arguments {
    const cli_command *command;
    /// text of each option by its row's index: NULL for an absent option, "" for a flag
    const char *text[CLI_MAX_OPTIONS];
    const char *also[CLI_MAX_OPTIONS]; ///< the same for the options of command->also
    const char **rest;                 ///< words of the command line that are not options
    int rest_count;
} cli_arguments;

/// Parses a command's words. `arguments` receives the texts, `values` (the structure that the rows'
/// offsets refer to) receives values and defaults. Returns CLI_GO, or the exit code after it has
/// printed the help or an error message. The words must outlive `arguments` and `values`.
int cli_read_arguments(cli_arguments *arguments, const cli_command *command, const cli_call *call,
                       void *values);
/// Returns a row of the options that the command takes of the command `also`, or NULL if it does
/// not take the option. The rows end where the options of `also` end.
const cli_option *cli_also_option(const cli_command *command, int index);
/// Writes defaults and values of all options into `values` by the texts in `arguments`, which need
/// not come from a command line. Returns CLI_GO or CLI_WRONG.
int cli_fill_values(const cli_arguments *arguments, void *values);
/// Writes the values of the options that the command line gives into `values` once more, for
/// commands that have changed the values of absent options after cli_read_arguments.
int cli_store_values(const cli_arguments *arguments, void *values);
/// Reads an option of type CLI_TEXT as an integer from `low` to `high`. `value` stays unchanged for
/// an absent option. Returns CLI_GO or CLI_WRONG.
int cli_integer(const cli_arguments *arguments, int option, int low, int high, int *value);
/// Reads an option of type CLI_TEXT as one of `words`, which ends in NULL; `value` receives the
/// index and stays unchanged for an absent option. Returns CLI_GO or CLI_WRONG.
int cli_choice(const cli_arguments *arguments, int option, const char *const *words, int *value);

/// Finds `text` among the words of an option row and stores the index of the word. Returns CLI_GO,
/// or CLI_WRONG after an error message with `what` is expected, all the words, and the most similar
/// word.
int cli_find_word(const cli_command *command, const char *what, const char *text,
                  const cli_option *words, int *index);

// ---------------------------------------------------------------------------------------- messages

/// Prints "kiln: MESSAGE" and a hint to --help; returns CLI_WRONG. `command` may be NULL. If the
/// command has a place, prints "kiln: PLACE: MESSAGE" without a hint.
int cli_wrong(const cli_command *command, const char *format, ...) CLI_PRINTF(2, 3);
/// Prints "kiln: MESSAGE"; returns CLI_FAILED.
int cli_fail(const char *format, ...) CLI_PRINTF(1, 2);
/// Prints a sentence on standard error: what a terminal would obey rather than show, for example in
/// the name of a file, becomes '?'.
void cli_say(const char *opening, const char *format, va_list list) CLI_PRINTF(2, 0);

/// A text of any origin, for example the name of a file, as one line that a terminal shows.
typedef struct cli_shown {
    char text[4096];
} cli_shown;
/// Returns `text` with '?' for every character that a terminal would obey rather than show. Usage:
/// printf("%s", cli_show(path).text).
cli_shown cli_show(const char *text);
/// Writes a number of bytes for people, such as "4.2 MB", to `text`, and returns `text`.
const char *cli_bytes(double bytes, char text[32]);
/// Flushes standard output. Returns `code`, or the exit code of a failed write.
int cli_close_output(int code);

/// Prints a line for each light.
void cli_print_lights(const kiln_lights *lights);

// ------------------------------------------------------------------------------------- file names

/// Returns whether a file name ends in a dot and `ending`, in lower or upper case. The ending "/"
/// means a folder: the name ends in a slash, or a folder with this name exists.
bool cli_ends_in(const char *path, const char *ending);
/// The file name's ending in lower case without its dot; "" for an ending that kiln does not know,
/// "/" for a folder.
const char *cli_ending(const char *path);
/// Checks before the work that the folder of an output file exists. Returns CLI_GO or CLI_FAILED.
int cli_check_folder(const char *path);
/// Creates the folders of an output file that are missing, and adds their number to *made; without
/// `make` only checks those that are there. Folders whose names hold patterns such as {face} are
/// left to the library. Returns false, with a message, if a folder is a file or cannot be created.
bool cli_make_folders(const char *path, bool make, int *made, kiln_error *error);

// -------------------------------------------------------------------------------------------- help

/// Prints a command's help, wrapped at the terminal's width or at 80 characters.
void cli_print_help(const cli_command *command);
/// Prints `text` wrapped before column `width`. The first line starts in column `column`; the other
/// lines are indented by `indent` blanks. A line break in `text` ends the line.
void cli_print_wrapped(const char *text, int column, int indent, int width);

// ------------------------------------------------------------------- options of several commands

/// Return the words of options that choose a model's D, its G, or the masking of the Charlie lobe.
const char *cli_d_word(int index);
const char *cli_g_word(int index);
const char *cli_sheen_word(int index);
/// Returns the word of --negative with this index, in the order of kiln_negative.
const char *cli_negative_word(int index);
/// Returns whether the option's text is a valid identifier in C and GLSL: CLI_GO or CLI_WRONG.
int cli_check_source_name(const cli_arguments *arguments, int option);

/// Rows of options that several commands have. `type` is the command's structure.
#define CLI_QUIET_ROW(type)                                                                        \
    {                                                                                              \
        "quiet", CLI_FLAG, offsetof(type, quiet), .letter = 'q',                                   \
                                                  .help = "print nothing but errors"               \
    }
#define CLI_THREADS_ROW(type)                                                                      \
    {                                                                                              \
        "threads", CLI_INTEGER, offsetof(type, threads), 1, 256, 0, "N",                           \
            "number of threads; the result is the same for every number", .letter = 'j',           \
                                                                          .unset = "one per core"  \
    }
#define CLI_NEGATIVE_ROW(type)                                                                     \
    {                                                                                              \
        "negative", CLI_CHOICE, offsetof(type, negative),                                          \
            .value = "WHICH", .word = cli_negative_word,                                           \
            .help = "what becomes of negative texels of the input; keep filters the numbers of "   \
                    "the file as they stand, zero sets negative texels to 0 first",                \
            .more = "Lossy compression leaves negative texels beside bright ones, and colours "    \
                    "outside the gamut of Rec. 709 have negative channels. Filtered values below " \
                    "zero are written as 0 in either case."                                        \
    }
#define CLI_LIGHTS_ROW(type)                                                                       \
    {                                                                                              \
        "lights", CLI_INTEGER, offsetof(type, lights.count), 1, KILN_MAX_LIGHTS, 0, "N",           \
            .help = "with --sun extract: take N lights out at most, those with the largest "       \
                    "shares",                                                                      \
            .unset = "1, or all with --lights-share"                                               \
    }
#define CLI_LIGHTS_SHARE_ROW(type)                                                                 \
    {                                                                                              \
        "lights-share", CLI_NUMBER, offsetof(type, lights.share), 0, 1, 0, "S",                    \
            .help = "with --sun extract: take lights out that hold at least this part of all "     \
                    "light",                                                                       \
            .unset = "0.01"                                                                        \
    }
#define CLI_LAYER_ROW(type)                                                                        \
    {                                                                                              \
        "layer", CLI_TEXT, offsetof(type, layer),                                                  \
            .value = "NAME",                                                                       \
            .help = "which layer of an EXR file is the picture: a layer, a part, or a channel "    \
                    "that is read as grey; 'kiln info' lists the layers",                          \
            .unset = "the channels R, G and B without a layer, else the layer that renderers "     \
                     "name like a picture, else the only one with colours",                        \
            .more = "NAME may be the end of a layer's name after a dot, such as Combined for "     \
                    "ViewLayer.Combined, or PART.LAYER. A file with several layers that may be "   \
                    "the picture is refused without this option."                                  \
    }
#define CLI_D_ROW(type, field)                                                                     \
    {                                                                                              \
        "d", CLI_CHOICE, offsetof(type, field), .value = "D", .word = cli_d_word,                  \
                                                .help = "distribution of microfacet normals"       \
    }
#define CLI_G_ROW(type, field)                                                                     \
    {                                                                                              \
        "g", CLI_CHOICE, offsetof(type, field),                                                    \
            .value = "G", .word = cli_g_word, .help = "masking and shadowing function",            \
            .more =                                                                                \
                "smith is height-correlated Smith masking. The k of Schlick's approximation is "   \
                "roughness^2 / 2 for schlick-k2 and (roughness + 1)^2 / 8 for schlick-text."       \
    }

#endif
