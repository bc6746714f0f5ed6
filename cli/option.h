// An option of a command is a row of a table. The parser, the help, the manual and the shells' completions
// all read the same rows, so that a range or a default is written once.
#ifndef KILN_CLI_OPTION_H
#define KILN_CLI_OPTION_H

#include <stdbool.h>
#include <stddef.h>

typedef enum cli_kind {
    CLI_FLAG,    ///< bool: true where given
    CLI_INTEGER, ///< int
    CLI_NUMBER,  ///< double
    CLI_CHOICE,  ///< int, or an enumeration: the index of a word
    CLI_TEXT,    ///< const char *, NULL where not given
    CLI_FILE,    ///< the same, the name of a file or folder
    CLI_RENAMED, ///< not there any more: `help` is a sentence that says what to write instead
} cli_kind;

/// Tables end with a row whose name is NULL.
typedef struct cli_option {
    const char *name; ///< "size", for --size
    cli_kind kind;
    unsigned at;       ///< offset of the value in the command's structure
    double low, high;  ///< the range of CLI_INTEGER and CLI_NUMBER
    double initial;    ///< the value where the option is not given; for CLI_CHOICE an index or -1
    const char *value; ///< what stands for the value in the help: "N"
    const char *help;  ///< a phrase without a capital and a full stop
    const char *alone; ///< the value of the option without one; then another is given by = only
    const char *const *words;       ///< of CLI_CHOICE, NULL behind the last
    const char *(*word)(int index); ///< or as a function, NULL behind the last
    const char *unset;              ///< in words, what holds where the option is not given
    const char *group;              ///< the heading of this option and those that follow
    const char *more;               ///< further sentences, for the manual
    char letter;                    ///< 'o', for -o; 0 for none
    bool keep;                      ///< not given, the option leaves the value as it is
    bool hidden;                    ///< in no help
} cli_option;

/// The word of a choice at an index; NULL behind the last.
const char *cli_option_word(const cli_option *option, int index);
/// "--size N", "-o, --output OUT", "--zstd[=LEVEL]": how the option is written.
const char *cli_option_form(const cli_option *option, char text[64]);

enum { CLI_RANGE_TEXT = 512 };

/// "1 to 32768, default 256": the values that an option takes; "" where there is nothing to say.
const char *cli_option_range(const cli_option *option, char text[CLI_RANGE_TEXT]);

enum { CLI_HELP_TEXT = 2048 };

/// The help with the range behind in parentheses.
const char *cli_option_help(const cli_option *option, char text[CLI_HELP_TEXT]);

/// "a, b or c": words of a choice, or of any function like cli_option.word.
const char *cli_list(const cli_option *option, char text[CLI_RANGE_TEXT]);

#endif
