// Generates the manual page man/kiln.1 in the language mdoc(7), for `kiln help --man`. In: the
// commands' descriptions and option rows. Out: the page on standard output, with one section for
// each command. A test compares man/kiln.1 with this output.
#include "manual.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 80 };

// Prints one word with escapes: a backslash begins a roff escape, a hyphen would become a
// typographic hyphen, and a line that begins with a point or an apostrophe would be a macro.
static int print_word(const char *word, int length, bool first)
{
    if (first && (word[0] == '.' || word[0] == '\''))
        fputs("\\&", stdout);
    for (int i = 0; i < length; i++) {
        if (word[i] == '\\')
            fputs("\\e", stdout);
        else if (word[i] == '-' && i + 1 < length && word[i + 1] == '-')
            fputs("\\-\\-", stdout), i++;
        else
            putchar(word[i]);
    }
    return length;
}

// Prints text. Each sentence begins a line, as mdoc recommends, and an empty line becomes a
// paragraph.
static void print_text(const char *text)
{
    int column = 0;
    while (*text) {
        int length = (int)strcspn(text, " \n");
        if (column && column + 1 + length > LINE) {
            putchar('\n');
            column = 0;
        }
        if (column)
            putchar(' ');
        column += print_word(text, length, !column) + 1;
        char last = length ? text[length - 1] : ' ';
        text += length;
        if (*text == '\n') {
            fputs("\n.Pp\n", stdout);
            column = 0;
            text += strspn(text, "\n");
            continue;
        }
        if (*text == ' ' && (last == '.' || last == ':') && isupper((unsigned char)text[1])) {
            putchar('\n');
            column = 0;
        }
        text += *text == ' ';
    }
    if (column)
        putchar('\n');
}

// Prints a phrase as a sentence: adds a full stop, and a capital unless the phrase begins with a
// symbol such as "n.v".
static void print_sentence(const char *phrase)
{
    char text[CLI_HELP_TEXT];
    size_t letters = strspn(phrase, "abcdefghijklmnopqrstuvwxyz");
    snprintf(text, sizeof text, "%s.", phrase);
    if (strchr(" ,;:-", phrase[letters]))
        text[0] = (char)toupper((unsigned char)text[0]);
    print_text(text);
}

// Prints one word of a command's arguments with its mdoc macro; words are "[--table", "KIND]",
// "-o", "FILE", "IN...".
static void print_argument(const char *word, int length)
{
    char text[64];
    bool opens = word[0] == '[', closes = word[length - 1] == ']';
    word += opens;
    length -= opens;
    if (opens)
        fputs(closes ? ".Op " : ".Oo\n.", stdout);
    else
        putchar('.');
    snprintf(text, sizeof text, "%.*s", length - closes, word);
    if (text[0] == '-') {
        printf("Fl %s", text + 1);
    } else {
        char *dots = strstr(text, "...");
        if (dots)
            *dots = 0;
        bool named = isupper((unsigned char)text[0]);
        for (char *at = text; *at; at++)
            *at = (char)tolower((unsigned char)*at);
        printf("%s %s%s", named ? "Ar" : "Cm", text, dots ? " ..." : "");
    }
    fputs(closes && !opens ? "\n.Oc\n" : "\n", stdout);
}

static void print_synopsis(const cli_command *command)
{
    const char *at = command->arguments;
    do {
        printf(".Nm\n.Cm %s\n", command->name);
        while (*at && *at != '|') {
            int length = (int)strcspn(at, " |");
            if (length)
                print_argument(at, length);
            at += length;
            at += *at == ' ';
        }
    } while (*at++);
}

static void print_option(const cli_option *option)
{
    char text[CLI_HELP_TEXT];
    fputs(".It ", stdout);
    if (option->letter)
        printf("Fl %c , ", option->letter);
    printf("Fl -%s", option->name);
    if (option->alone)
        printf(" Ns Op = Ns Ar %s", option->value);
    else if (option->value)
        printf(" Ar %s", option->value);
    putchar('\n');
    print_sentence(cli_option_help(option, text));
    if (option->more)
        print_text(option->more);
}

static void print_options(const cli_option *options)
{
    bool open = false;
    for (int i = 0; options[i].name; i++) {
        if (options[i].hidden || options[i].kind == CLI_RENAMED)
            continue;
        if (options[i].group && open)
            puts(".El");
        if (options[i].group)
            printf(".Pp\n%s:\n", options[i].group);
        if (options[i].group || !open)
            puts(".Bl -tag -width Ds");
        open = true;
        print_option(&options[i]);
    }
    if (open)
        puts(".El");
}

static void print_command(const cli_command *command)
{
    char left[64];
    const char *right;
    printf(".Ss kiln %s\n", command->name);
    print_text(command->summary);
    if (command->about[0]) {
        puts(".Pp");
        print_text(command->about);
    }
    if (command->more) {
        puts(".Pp");
        print_text(command->more);
    }
    if (command->list) {
        printf(".Pp\n%s:\n.Bl -tag -width Ds\n", command->list_title);
        for (int i = 0; (right = command->list(i, left)) != NULL; i++) {
            int length = (int)strcspn(left, " ");
            printf(".It Cm %.*s%s%s\n", length, left, left[length] ? " Ns \\&:" : "",
                   left + length);
            print_sentence(right);
        }
        puts(".El");
    }
    if (command->list && command->options)
        puts(".Pp\nOptions:");
    if (command->options)
        print_options(command->options);
    if (command->also)
        printf(".Pp\nFurther options are those of\n.Nm kiln Cm %s .\n", command->also->name);
}

static void print_examples(const cli_command *command, bool *first)
{
    for (const cli_example *example = command->examples; example->line; example++) {
        if (!*first)
            puts(".Pp");
        *first = false;
        if (example->meaning)
            print_sentence(example->meaning);
        fputs(".Dl $ ", stdout);
        print_word(example->line, (int)strlen(example->line), false);
        putchar('\n');
    }
}

static const char head[] =
    ".\\\" SPDX-License-Identifier: MIT\n"
    ".\\\" Written by kiln help --man.\n"
    ".Dd November 28, 2026\n"
    ".Dt KILN 1\n"
    ".Os\n"
    ".Sh NAME\n"
    ".Nm kiln\n"
    ".Nd exact image-based lighting: prefiltered environments from panoramas\n"
    ".Sh SYNOPSIS\n";

static const char description[] =
    ".Nm\n.Fl -version\n.Sh DESCRIPTION\n.Nm\n"
    "turns a panorama into the lighting that renderers look up: the environment seen\n"
    "through the lobe of a surface, a mip level for each roughness, with diffuse\n"
    "irradiance and spherical harmonics.\n"
    "The levels are computed in spherical harmonics and not by sampling.\n"
    "The result has no noise, and the same input gives the same bits on every machine\n"
    "and for every number of threads.\n"
    ".Pp\n"
    "The value of a long option is the next word, or follows after\n.Sq = .\n"
    "The value of a short option is the next word, or follows without a space.\n"
    "Words after\n.Sq --\n"
    "are not options.\n"
    "Every command has\n.Fl h , -help .\n";

static const char foot[] =
    ".Sh EXIT STATUS\n.Bl -tag -width Ds\n"
    ".It 0\nThe work is done.\n"
    ".It 1\nThe input is not usable or the work failed.\nA message on standard error says why.\n"
    ".It 2\nThe command line is wrong.\nA message on standard error says why.\n"
    ".It 129 , 130 , 143\nStopped by a hangup, an interrupt or a request to terminate; no "
    "unfinished file\n"
    "is left.\n.El\n";

static const char see_also[] =
    ".Sh SEE ALSO\n"
    "The file\n.Pa docs/conventions.md\n"
    "of the sources has the conventions for directions, faces, texels and harmonics.\n"
    "The library's header is\n"
    ".In kiln/kiln.h .\n";

void cli_print_manual(const cli_command *const *commands)
{
    fputs(head, stdout);
    for (int i = 0; commands[i]; i++)
        print_synopsis(commands[i]);
    fputs(description, stdout);
    for (int i = 0; commands[i]; i++)
        print_command(commands[i]);
    fputs(foot, stdout);
    bool first = true;
    puts(".Sh EXAMPLES");
    for (int i = 0; commands[i]; i++)
        print_examples(commands[i], &first);
    fputs(see_also, stdout);
}
