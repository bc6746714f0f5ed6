// The kiln command. In: the words of the command line. Out: an exit code, and the help or the
// version. The first word names a command of a table, which then reads the other words.
#include "cli.h"
#include "manual.h"
#include "os.h"
#include "suggest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cli_command *const commands[] = {
    &cli_bake,
#ifndef __EMSCRIPTEN__ // a batch needs threads
    &cli_batch,
#endif
    &cli_lights, &cli_engines,     &cli_info,
    &cli_check,  &cli_sky,         &cli_tables,
    &cli_eval,   &cli_fit,
#ifdef KILN_VIEWER
    &cli_render, &cli_view,        &cli_assignment,
#endif
    &cli_help,   &cli_completions, NULL,
};

static void print_overview(FILE *file)
{
    fputs("Exact image-based lighting: a panorama goes in, prefiltered radiance comes out.\n\n"
          "Usage: kiln COMMAND [OPTION...]\n\n",
          file);
    for (int i = 0; commands[i]; i++)
        fprintf(file, "  kiln %-11s  %s\n", commands[i]->name, commands[i]->summary);
    fputs("\n  kiln --version    prints the version\n\n"
          "Examples:\n"
          "  kiln bake city.exr -o city.ktx2\n"
          "  kiln sky -o sky.exr && kiln bake sky.exr -o sky.ktx2 --exposure -5\n"
          "  kiln info city.ktx2\n",
          file);
}

// Returns whether an unknown command name looks like a picture: the user most likely forgot the
// word `bake`.
static bool is_input(const char *name)
{
    static const char *const endings[] = {"exr", "hdr", "png", "ktx2", "dds", "/"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (cli_ends_in(name, endings[i]))
            return true;
    return false;
}

static int no_such_command(const char *name)
{
    char text[96];
    cli_suggestion suggestion = {.typed = name};
    if (name[0] == '-')
        return cli_wrong(NULL, "%s: no such option", name);
    if (is_input(name))
        return cli_wrong(NULL, "%s: no such command, use 'kiln bake %s -o OUT' to bake a picture",
                         name, name);
    for (int i = 0; commands[i]; i++)
        cli_suggest(&suggestion, commands[i]->name);
    return cli_wrong(NULL, "%s: no such command%s", name,
                     cli_suggestion_text(&suggestion, ", ", "", text));
}

static const cli_command *find(const char *name)
{
    for (int i = 0; commands[i]; i++)
        if (!strcmp(name, commands[i]->name))
            return commands[i];
    return NULL;
}

// ----------------------------------------------------------------------------------- kiln help

static const char *command_word(int index)
{
    return commands[index] ? commands[index]->name : NULL;
}

typedef struct help {
    bool man;
} help;

static const cli_option help_options[] = {
    {"man", CLI_FLAG, offsetof(help, man), .help = "write the manual page", .hidden = true},
    {.name = NULL},
};

static int run_help(const cli_call *call)
{
    cli_arguments a;
    help h;
    int code = cli_read_arguments(&a, &cli_help, call, &h);
    if (code != CLI_GO)
        return code;
    if (a.rest_count > 1)
        return cli_wrong(&cli_help,
                         "%s: kiln help takes one command at a time, and %s is named already",
                         a.rest[1], a.rest[0]);
    const cli_command *command = a.rest_count ? find(a.rest[0]) : NULL;
    if (a.rest_count && !command)
        return no_such_command(a.rest[0]);
    if (h.man)
        cli_print_manual(call->commands);
    else if (command)
        cli_print_help(command);
    else
        print_overview(stdout);
    return CLI_DONE;
}

static const cli_example help_examples[] = {{"kiln help bake", NULL}, {NULL, NULL}};

const cli_command cli_help = {
    .name = "help",
    .arguments = "[COMMAND]",
    .summary = "Prints all options of a command, with examples.",
    .about = "",
    .word = command_word,
    .examples = help_examples,
    .options = help_options,
    .run = run_help,
};

// ------------------------------------------------------------------------------------------ main

static int run_command(const cli_command *command, int argc, char **argv)
{
    const char **words = calloc((size_t)argc + 1, sizeof *words);
    if (!words)
        return cli_fail("out of memory");
    for (int i = 0; i < argc; i++)
        words[i] = argv[i];
    int code = command->run(&(cli_call){.commands = commands, .count = argc, .words = words});
    free(words);
    return code;
}

static int run(int argc, char **argv)
{
    const char *word = argc > 1 ? argv[1] : NULL;
    if (!word) {
        print_overview(stderr);
        return CLI_WRONG;
    }
    if (!strcmp(word, "--version") || !strcmp(word, "-V")) {
        printf("kiln %s\n", kiln_version());
        return CLI_DONE;
    }
    if (!strcmp(word, "--help") || !strcmp(word, "-h")) {
        print_overview(stdout);
        return CLI_DONE;
    }
    const cli_command *command = find(word);
    return command ? run_command(command, argc - 1, argv + 1) : no_such_command(word);
}

int main(int argc, char **argv)
{
    if (!os_begin(&argc, &argv))
        return cli_fail("out of memory");
    return cli_close_output(run(argc, argv));
}
