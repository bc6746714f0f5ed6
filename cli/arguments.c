// The parser of command lines. In: words and a table of option rows. Out: the options' values and
// defaults, and the words that are not options.
//
//   --size 64, --size=64     a long option. The next word is its value even if it begins with -,
//                            as in --rotate -30
//   -o out, -oout, -o=out    a short option; -qo out means -q -o out
//   --zstd, --zstd=19        an option that may stand without a value takes a value only after =
//   --                       the words after it are not options; a single - is not an option either
//
// Options may follow other words. Giving an option twice is an error. Names cannot be shortened,
// but the error message for an unknown name suggests a similar name.
#include "cli.h"
#include "suggest.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HELP = -2, UNKNOWN = -1 };

// Where the text of an option is kept: the command whose table has the option, and the texts by the
// rows of this table.
typedef struct place {
    const cli_command *command;
    const char **text;
} place;

static int find_name(const cli_command *command, const char *name, size_t length)
{
    if (length == 4 && !strncmp(name, "help", 4))
        return HELP;
    for (int i = 0; command->options && command->options[i].name; i++)
        if (strlen(command->options[i].name) == length &&
            !strncmp(command->options[i].name, name, length))
            return i;
    return UNKNOWN;
}

const cli_option *cli_also_option(const cli_command *command, int index)
{
    return command->takes(index) ? &command->also->options[index] : NULL;
}

// Returns the index of a row of the command `also`, or UNKNOWN if the command does not take it.
static int taken(const cli_command *command, int index)
{
    return index >= 0 && !command->takes(index) ? UNKNOWN : index;
}

// Finds an option by its name among the command's own rows and those of the command `also`.
static int find_long(cli_arguments *a, const char *name, size_t length, place *at)
{
    *at = (place){a->command, a->text};
    int index = find_name(a->command, name, length);
    if (index != UNKNOWN || !a->command->also)
        return index;
    *at = (place){a->command->also, a->also};
    return taken(a->command, find_name(a->command->also, name, length));
}

static int find_letter(const cli_command *command, char letter)
{
    if (letter == 'h')
        return HELP;
    for (int i = 0; command->options && command->options[i].name; i++)
        if (command->options[i].letter == letter)
            return i;
    return UNKNOWN;
}

// Finds an option by its letter among the command's own rows and those of the command `also`.
static int find_short(cli_arguments *a, char letter, place *at)
{
    *at = (place){a->command, a->text};
    int index = find_letter(a->command, letter);
    if (index != UNKNOWN || !a->command->also)
        return index;
    *at = (place){a->command->also, a->also};
    return taken(a->command, find_letter(a->command->also, letter));
}

static void suggest_option(cli_suggestion *suggestion, const cli_option *option)
{
    if (option && !option->hidden && option->kind != CLI_RENAMED)
        cli_suggest(suggestion, option->name);
}

static void suggest_options(cli_suggestion *suggestion, const cli_command *command)
{
    for (int i = 0; command->options && command->options[i].name; i++)
        suggest_option(suggestion, &command->options[i]);
    for (int i = 0; command->also && command->also->options[i].name; i++)
        suggest_option(suggestion, cli_also_option(command, i));
}

static int no_such_option(const cli_command *command, const char *word)
{
    char text[96], name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    cli_suggestion suggestion = {.typed = name};
    if (word[1] == '-')
        suggest_options(&suggestion, command);
    return cli_wrong(command, "%s: no such option%s", word,
                     cli_suggestion_text(&suggestion, ", ", "--", text));
}

// Takes one option. `value` is the text in the option's own word (after = or the letter), or NULL.
// If the value is the next word, `*at` is advanced to that word.
static int take(cli_arguments *a, const cli_call *call, const place *in, int index,
                const char *form, const char *value, int *at)
{
    const cli_option *option = &in->command->options[index];
    if (option->kind == CLI_RENAMED)
        return cli_wrong(a->command, "%s: %s", form, option->help);
    if (option->kind == CLI_FLAG && value)
        return cli_wrong(a->command, "%s takes no value", form);
    if (option->kind == CLI_FLAG)
        value = "";
    else if (!value && option->alone)
        value = option->alone;
    else if (!value && *at + 1 < call->count)
        value = call->words[++*at];
    if (!value)
        return cli_wrong(a->command, "%s needs a value", form);
    if (in->text[index])
        return cli_wrong(a->command, "--%s is given twice", option->name);
    in->text[index] = value;
    return CLI_GO;
}

static int show_help(const cli_command *command)
{
    cli_print_help(command);
    return CLI_DONE;
}

static int read_long(cli_arguments *a, const cli_call *call, int *at)
{
    const char *word = call->words[*at], *equals = strchr(word, '=');
    size_t length = equals ? (size_t)(equals - word) : strlen(word);
    char form[64];
    place in;
    int index = find_long(a, word + 2, length - 2, &in);
    if (index == HELP && !equals)
        return show_help(a->command);
    if (index < 0)
        return no_such_option(a->command, word);
    snprintf(form, sizeof form, "%.*s", (int)length, word);
    return take(a, call, &in, index, form, equals ? equals + 1 : NULL, at);
}

static int read_letters(cli_arguments *a, const cli_call *call, int *at)
{
    const char *word = call->words[*at];
    int code = CLI_GO;
    for (int i = 1; word[i] && code == CLI_GO; i++) {
        place in;
        int index = find_short(a, word[i], &in);
        char form[] = {'-', word[i], 0};
        if (index == HELP)
            return show_help(a->command);
        if (index < 0)
            return no_such_option(a->command, word[2] ? form : word);
        bool flag = in.command->options[index].kind == CLI_FLAG;
        const char *rest = word + i + 1;
        code = take(a, call, &in, index, form, flag || !*rest ? NULL : rest + (*rest == '='), at);
        if (!flag)
            break;
    }
    return code;
}

// ------------------------------------------------------------------------------------------ values

static int read_integer(const cli_command *command, const char *name, const char *text, double low,
                        double high, int *value)
{
    char *end;
    errno = 0;
    long n = strtol(text, &end, 10);
    if (end == text || *end)
        return cli_wrong(command, "--%s is '%s', it must be a whole number from %.0f to %.0f", name,
                         text, low, high);
    if (errno || (double)n < low || (double)n > high)
        return cli_wrong(command, "--%s is %s, it must be from %.0f to %.0f", name, text, low,
                         high);
    *value = (int)n;
    return CLI_GO;
}

static int read_number(const cli_command *command, const cli_option *option, const char *text,
                       double *value)
{
    char *end;
    double x = strtod(text, &end);
    if (end == text || *end)
        return cli_wrong(command, "--%s is '%s', it must be a number from %g to %g", option->name,
                         text, option->low, option->high);
    if (!(x >= option->low && x <= option->high))
        return cli_wrong(command, "--%s is %s, it must be from %g to %g", option->name, text,
                         option->low, option->high);
    *value = x;
    return CLI_GO;
}

static int read_word(const cli_command *command, const cli_option *option, const char *text,
                     int *value)
{
    char list[CLI_RANGE_TEXT], nearest[96];
    cli_suggestion suggestion = {.typed = text};
    const char *word;
    int count = 0;
    for (; (word = cli_option_word(option, count)) != NULL; count++) {
        if (!strcmp(text, word)) {
            *value = count;
            return CLI_GO;
        }
        cli_suggest(&suggestion, word);
    }
    cli_suggestion_text(&suggestion, "; ", "", nearest);
    if (count == 1)
        return cli_wrong(command, "--%s is '%s', it must be %s%s", option->name, text,
                         cli_option_word(option, 0), nearest);
    return cli_wrong(command, "--%s is '%s', it must be %s%s", option->name, text,
                     cli_list(option, list), nearest);
}

int cli_find_word(const cli_command *command, const char *what, const char *text,
                  const cli_option *words, int *index)
{
    char list[CLI_RANGE_TEXT], nearest[96];
    cli_suggestion suggestion = {.typed = text};
    const char *word;
    for (int i = 0; (word = cli_option_word(words, i)) != NULL; i++) {
        if (!strcmp(text, word)) {
            *index = i;
            return CLI_GO;
        }
        cli_suggest(&suggestion, word);
    }
    return cli_wrong(command, "%s: no such %s, it must be %s%s", text, what, cli_list(words, list),
                     cli_suggestion_text(&suggestion, "; ", "", nearest));
}

// Writes an option's value to its place in the command's structure. An enumeration has the size of
// an int.
static int store(const cli_command *command, const cli_option *option, const char *text, char *to)
{
    int n = 0, code = CLI_GO;
    double x = 0;
    bool flag = true;
    switch (option->kind) {
    case CLI_FLAG:
        memcpy(to, &flag, sizeof flag);
        break;
    case CLI_INTEGER:
        code = read_integer(command, option->name, text, option->low, option->high, &n);
        memcpy(to, &n, sizeof n);
        break;
    case CLI_CHOICE:
        code = read_word(command, option, text, &n);
        memcpy(to, &n, sizeof n);
        break;
    case CLI_NUMBER:
        code = read_number(command, option, text, &x);
        memcpy(to, &x, sizeof x);
        break;
    case CLI_FILE:
        if (!*text)
            return cli_wrong(command, "--%s is empty, it must name a file or folder", option->name);
        memcpy(to, &text, sizeof text);
        break;
    default:
        memcpy(to, &text, sizeof text);
    }
    return code;
}

static void store_default(const cli_option *option, char *to)
{
    int n = (int)option->initial;
    bool flag = false;
    const char *text = NULL;
    if (option->kind == CLI_RENAMED || option->keep)
        return;
    if (option->kind == CLI_FLAG)
        memcpy(to, &flag, sizeof flag);
    else if (option->kind == CLI_INTEGER || option->kind == CLI_CHOICE)
        memcpy(to, &n, sizeof n);
    else if (option->kind == CLI_NUMBER)
        memcpy(to, &option->initial, sizeof option->initial);
    else
        memcpy(to, &text, sizeof text);
}

int cli_store_values(const cli_arguments *a, void *values)
{
    const cli_option *options = a->command->options;
    int code = CLI_GO;
    for (int i = 0; options && options[i].name && code == CLI_GO; i++)
        if (a->text[i])
            code = store(a->command, &options[i], a->text[i], (char *)values + options[i].at);
    return code;
}

int cli_fill_values(const cli_arguments *a, void *values)
{
    const cli_option *options = a->command->options;
    for (int i = 0; options && options[i].name; i++)
        store_default(&options[i], (char *)values + options[i].at);
    return cli_store_values(a, values);
}

int cli_integer(const cli_arguments *a, int option, int low, int high, int *value)
{
    const char *text = a->text[option];
    return text ? read_integer(a->command, a->command->options[option].name, text, low, high, value)
                : CLI_GO;
}

int cli_choice(const cli_arguments *a, int option, const char *const *words, int *value)
{
    const cli_option row = {.name = a->command->options[option].name, .words = words};
    return a->text[option] ? read_word(a->command, &row, a->text[option], value) : CLI_GO;
}

int cli_read_arguments(cli_arguments *a, const cli_command *command, const cli_call *call,
                       void *values)
{
    bool options = true;
    *a = (cli_arguments){.command = command, .rest = call->words};
    for (int i = 1; i < call->count; i++) {
        const char *word = call->words[i];
        int code = CLI_GO;
        if (!*word)
            code = cli_wrong(command, "word %d after '%s' is empty", i, command->name);
        else if (options && !strcmp(word, "--"))
            options = false;
        else if (!options || word[0] != '-' || !word[1])
            // rest[] shares memory with words[]: the writes never overtake the reads
            a->rest[a->rest_count++] = word;
        else
            code = word[1] == '-' ? read_long(a, call, &i) : read_letters(a, call, &i);
        if (code != CLI_GO)
            return code;
    }
    return cli_fill_values(a, values);
}
