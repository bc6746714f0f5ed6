// Describes an option in words for the help: its form, its range and its default.
#include "option.h"

#include <stdio.h>
#include <string.h>

const char *cli_option_word(const cli_option *option, int index)
{
    if (option->word)
        return option->word(index);
    return option->words ? option->words[index] : NULL;
}

const char *cli_option_form(const cli_option *option, char text[64])
{
    char letter[8] = "";
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    const char *before = option->alone ? "[=" : option->value ? " " : "";
    snprintf(text, 64, "%s--%s%s%s%s", letter, option->name, before,
             option->value ? option->value : "", option->alone ? "]" : "");
    return text;
}

static void add(char text[CLI_RANGE_TEXT], const char *before, const char *what)
{
    size_t used = strlen(text);
    snprintf(text + used, CLI_RANGE_TEXT - used, "%s%s", used ? before : "", what);
}

const char *cli_list(const cli_option *option, char text[CLI_RANGE_TEXT])
{
    const char *word;
    text[0] = 0;
    for (int i = 0; (word = cli_option_word(option, i)) != NULL; i++)
        add(text, cli_option_word(option, i + 1) ? ", " : " or ", word);
    return text;
}

// Adds the default to the text if the default is a value of the option's own range.
static void add_default(const cli_option *option, char text[CLI_RANGE_TEXT])
{
    char what[CLI_RANGE_TEXT];
    bool in_range =
        !option->keep && option->initial >= option->low && option->initial <= option->high;
    bool number = option->kind == CLI_INTEGER || option->kind == CLI_NUMBER;
    if (option->unset)
        snprintf(what, sizeof what, "default %s", option->unset);
    else if (option->kind == CLI_CHOICE && !option->keep && option->initial >= 0)
        snprintf(what, sizeof what, "default %s", cli_option_word(option, (int)option->initial));
    else if (number && in_range)
        snprintf(what, sizeof what, "default %g", option->initial);
    else
        return;
    add(text, option->kind == CLI_CHOICE ? "; " : ", ", what);
}

const char *cli_option_range(const cli_option *option, char text[CLI_RANGE_TEXT])
{
    char alone[64];
    text[0] = 0;
    if (option->kind == CLI_INTEGER || option->kind == CLI_NUMBER)
        snprintf(text, CLI_RANGE_TEXT, "%.10g to %.10g", option->low, option->high);
    else if (option->kind == CLI_CHOICE)
        cli_list(option, text);
    if (option->alone) {
        snprintf(alone, sizeof alone, "%s without %s", option->alone, option->value);
        add(text, ", ", alone);
    }
    add_default(option, text);
    return text;
}

const char *cli_option_help(const cli_option *option, char text[CLI_HELP_TEXT])
{
    char range[CLI_RANGE_TEXT];
    cli_option_range(option, range);
    const char *open = range[0] ? " (" : "", *close = range[0] ? ")" : "";
    snprintf(text, CLI_HELP_TEXT, "%s%s%s%s", option->help, open, range, close);
    return text;
}
