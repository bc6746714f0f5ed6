// Prints the help of a command from its rows: description, options by group with ranges and
// defaults, examples. Text is wrapped at 80 characters or at the terminal's width.
#include "cli.h"
#include "os.h"

#include <stdio.h>
#include <string.h>

enum { COLUMN = 26, WIDTH = 80, NARROWEST = 50, WIDEST = 110 };

static int help_width(void)
{
    int columns = os_columns();
    return columns <= 0          ? WIDTH
           : columns < NARROWEST ? NARROWEST
           : columns > WIDEST    ? WIDEST
                                 : columns;
}

static void print_blanks(int count)
{
    printf("%*s", count > 0 ? count : 0, "");
}

// Prints words until the next word would reach `width`, then starts a new line.
void cli_print_wrapped(const char *text, int column, int indent, int width)
{
    bool first = true; // true while the output line has no word after its indentation
    while (*text) {
        int length = (int)strcspn(text, " \n");
        if (!first && column + 1 + length >= width) {
            putchar('\n');
            print_blanks(indent);
            column = indent;
            first = true;
        }
        if (!first)
            putchar(' ');
        printf("%.*s", length, text);
        column += length + !first;
        first = false;
        text += length;
        if (*text == '\n') {
            putchar('\n');
            if (text[1] && text[1] != '\n')
                print_blanks(indent);
            column = indent;
            first = true;
        }
        text += *text != 0;
    }
    putchar('\n');
}

// Prints `left` in its column and `right` from column COLUMN on; a long `left` gets a line of its
// own.
static void print_line(const char *left, const char *right, int width)
{
    printf("  %s", left);
    int used = 2 + (int)strlen(left);
    if (used + 2 > COLUMN) {
        putchar('\n');
        used = 0;
    }
    print_blanks(COLUMN - used);
    cli_print_wrapped(right, COLUMN, COLUMN, width);
}

static void print_option(const cli_option *option, int width)
{
    char form[64], left[80], right[CLI_HELP_TEXT];
    snprintf(left, sizeof left, "%s%s", option->letter ? "" : "    ",
             cli_option_form(option, form));
    print_line(left, cli_option_help(option, right), width);
}

static void print_options(const cli_option *options, int width)
{
    for (int i = 0; options && options[i].name; i++) {
        if (options[i].group)
            printf("\n%s:\n", options[i].group);
        else if (!i)
            puts("\nOptions:");
        if (!options[i].hidden && options[i].kind != CLI_RENAMED)
            print_option(&options[i], width);
    }
    if (!options)
        puts("\nOptions:");
    print_line("-h, --help", "print this help and exit", width);
}

static void print_usage(const cli_command *command, int width)
{
    const char *at = command->arguments, *before = "Usage:";
    do {
        char way[256];
        at += strspn(at, " ");
        int length = (int)strcspn(at, "|");
        snprintf(way, sizeof way, "%s kiln %s %.*s", before, command->name, length, at);
        cli_print_wrapped(way, 0, 12, width);
        at += length;
        before = "      ";
    } while (*at++);
}

void cli_print_help(const cli_command *command)
{
    int width = help_width();
    printf("%s\n\n", command->summary);
    print_usage(command, width);
    print_options(command->options, width);
    if (command->also)
        printf("\nFurther options are those of kiln %s: see 'kiln help %s'.\n", command->also->name,
               command->also->name);
    if (command->about[0]) {
        putchar('\n');
        cli_print_wrapped(command->about, 0, 0, width);
    }
    if (command->list) {
        printf("\n%s:\n", command->list_title);
        char left[64];
        const char *right;
        for (int i = 0; (right = command->list(i, left)) != NULL; i++)
            print_line(left, right, width);
    }
    puts("\nExamples:");
    for (const cli_example *example = command->examples; example->line; example++) {
        printf("  %s\n", example->line);
        if (example->meaning) {
            print_blanks(6);
            cli_print_wrapped(example->meaning, 6, 6, width);
        }
    }
}
