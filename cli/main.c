// kiln: the command. Finds the sub-command and hands over.
#include "cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cli_command *const commands[] = {
    &cli_bake,   &cli_engines, &cli_info,    &cli_sky, &cli_tables, &cli_eval, &cli_fit,
#ifdef KILN_VIEWER
    &cli_render, &cli_view,    &cli_hand_in,
#endif
    NULL,
};

static void print_help(FILE *file)
{
    fputs("Exact image-based lighting: a panorama goes in, prefiltered radiance comes out.\n\n"
          "Usage: kiln COMMAND [OPTION...]\n\n",
          file);
    for (int i = 0; commands[i]; i++)
        fprintf(file, "  kiln %-10s  %s\n", commands[i]->name, commands[i]->summary);
    fputs("\n  kiln help COMMAND  all options of a command, with examples\n"
          "  kiln --version     the version\n\n"
          "Examples:\n"
          "  kiln bake city.exr -o city.ktx2\n"
          "  kiln sky -o sky.exr && kiln bake sky.exr -o sky.ktx2 --exposure -5\n"
          "  kiln info city.ktx2\n",
          file);
}

static const cli_command *find(const char *name)
{
    for (int i = 0; commands[i]; i++)
        if (!strcmp(name, commands[i]->name))
            return commands[i];
    return NULL;
}

// popt would take the word after a bare --zstd or --fit for its value; the default is put in.
static const char **prepare(int argc, char **argv, const char *name)
{
    const char **words = calloc((size_t)argc + 1, sizeof *words);
    if (!words)
        return NULL;
    bool options = true;
    for (int i = 0; i < argc; i++) {
        if (!strcmp(argv[i], "--"))
            options = false;
        words[i] = argv[i];
        if (options && !strcmp(argv[i], "--zstd"))
            words[i] = "--zstd=3";
        else if (options && !strcmp(argv[i], "--fit"))
            words[i] = "--fit=sharp";
    }
    words[0] = name; // as it stands in the usage line
    return words;
}

static int run_command(const cli_command *command, int argc, char **argv)
{
    char name[32];
    snprintf(name, sizeof name, "kiln %s", command->name);
    const char **words = prepare(argc, argv, name);
    int code = words ? command->run(argc, words) : cli_fail("out of memory");
    free(words);
    return code;
}

static int run(int argc, char **argv)
{
    const char *word = argc > 1 ? argv[1] : NULL;
    if (!word) {
        print_help(stderr);
        return CLI_WRONG;
    }
    if (!strcmp(word, "--version") || !strcmp(word, "-V")) {
        printf("kiln %s\n", kiln_version());
        return CLI_DONE;
    }
    bool help = !strcmp(word, "help");
    if (!strcmp(word, "--help") || !strcmp(word, "-h") || (help && argc == 2)) {
        print_help(stdout);
        return CLI_DONE;
    }
    const char *name = help ? argv[2] : word;
    const cli_command *command = find(name);
    if (!command)
        return cli_wrong(NULL, name[0] == '-' ? "%s: no such option" : "%s: no such command", name);
    if (help) {
        char *ask[] = {argv[0], "--help", NULL};
        return run_command(command, 2, ask);
    }
    return run_command(command, argc - 1, argv + 1);
}

int main(int argc, char **argv)
{
    return cli_close_output(run(argc, argv));
}
