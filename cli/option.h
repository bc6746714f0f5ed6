// The description of a command's option as one row of a table. The parser, the help, the manual and
// the shell completions read the same rows: a range or a default is written once.
#ifndef KILN_CLI_OPTION_H
#define KILN_CLI_OPTION_H

#include <stdbool.h>
#include <stddef.h>

typedef enum cli_kind {
    CLI_FLAG,    ///< bool: true if the option is given
    CLI_INTEGER, ///< value is an int
    CLI_NUMBER,  ///< value is a double
    CLI_CHOICE,  ///< value is the index of a word: an int or an enumeration
    CLI_TEXT,    ///< value is a const char *; NULL for an absent option
    CLI_FILE,    ///< value is a const char *, the name of a file or folder
    CLI_RENAMED, ///< the option was removed: `help` is an error message that says what replaces it
} cli_kind;

/// One option. A table of options ends with a row whose name is NULL.
typedef struct cli_option {
    const char *name; ///< long name without its dashes, such as "size"
    cli_kind kind;
    unsigned at;       ///< offset in bytes of the option's value in the command's structure
    double low, high;  ///< range of a CLI_INTEGER or CLI_NUMBER
    double initial;    ///< default value; for CLI_CHOICE the index of a word, or -1
    const char *value; ///< placeholder of the value in the help, such as "N"
    const char *help;  ///< a phrase for the help, without a capital and a full stop
    /// value of the option when it is given without a value; a value then needs the form
    /// --name=VALUE
    const char *alone;
    const char *const *words; ///< words of a CLI_CHOICE, ending in NULL
    /// function that returns the words in place of `words`; NULL after the last word
    const char *(*word)(int index);
    const char *unset; ///< describes in words what an absent option means
    const char *group; ///< heading in the help for this option and the options after it
    const char *more;  ///< further sentences that only the manual shows
    char letter;       ///< letter of the short form, such as 'o' for -o; 0 for no short form
    bool keep;   ///< an absent option leaves the value unchanged, instead of writing the default
    bool hidden; ///< the help does not show the option
} cli_option;

/// Word number `index` of a CLI_CHOICE; NULL after the last word.
const char *cli_option_word(const cli_option *option, int index);
/// How the option is written: "--size N", "-o, --output OUT", "--zstd[=LEVEL]".
const char *cli_option_form(const cli_option *option, char text[64]);

enum { CLI_RANGE_TEXT = 512 };

/// The values that the option takes, such as "1 to 32768, default 256"; "" if there is nothing to
/// say.
const char *cli_option_range(const cli_option *option, char text[CLI_RANGE_TEXT]);

enum { CLI_HELP_TEXT = 2048 };

/// The option's help followed by its range in parentheses.
const char *cli_option_help(const cli_option *option, char text[CLI_HELP_TEXT]);

/// The words of a choice as a phrase: "a, b or c".
const char *cli_list(const cli_option *option, char text[CLI_RANGE_TEXT]);

#endif
