// kiln completions. In: the commands' option rows. Out: a completion script for bash, zsh or fish.
// The script completes the names of commands and options, the words of choices and of first
// arguments, and file names.
#include "cli.h"

#include <stdio.h>
#include <string.h>

static const char *shell_word(int index)
{
    static const char *const shells[] = {"bash", "zsh", "fish", NULL};
    return shells[index];
}

static bool is_shown(const cli_option *option)
{
    return !option->hidden && option->kind != CLI_RENAMED;
}

static void print_words(const char *(*word)(int index), const char *const *words)
{
    const cli_option option = {.word = word, .words = words};
    const char *text;
    for (int i = 0; (text = cli_option_word(&option, i)) != NULL; i++)
        printf("%s%s", i ? " " : "", text);
}

static void print_commands(const cli_call *call)
{
    for (int i = 0; call->commands[i]; i++)
        printf("%s%s", i ? " " : "", call->commands[i]->name);
}

enum { SUMMARY = 160 };

// Copies the help up to its first semicolon or colon, escaped for single quotes of a shell.
static const char *summary(const char *help, char text[SUMMARY])
{
    size_t used = 0;
    for (const char *at = help; *at && !strchr(";:", *at) && used < 120; at++)
        if (*at == '\'')
            used += (size_t)snprintf(text + used, SUMMARY - used, "'\\''");
        else if (!strchr("[]\\$`\"", *at))
            text[used++] = *at;
    text[used] = 0;
    return text;
}

// -------------------------------------------------------------------------------------------- bash

// Prints the option's names as a pattern of bash's `case`, such as -o|--output.
static void print_bash_names(const cli_option *option)
{
    printf("        --%s", option->name);
    if (option->letter)
        printf(" | -%c", option->letter);
    fputs(") ", stdout);
}

// Calls print(command, ROW) for each option that the command shows, with those that it takes of
// another command.
static void for_each_option(const cli_command *command,
                            void (*print)(const cli_command *command, const cli_option *option))
{
    for (int i = 0; command->options && command->options[i].name; i++)
        if (is_shown(&command->options[i]))
            print(command, &command->options[i]);
    for (int i = 0; command->also && command->also->options[i].name; i++) {
        const cli_option *option = cli_also_option(command, i);
        if (option && is_shown(option))
            print(command, option);
    }
}

static void print_bash_values(const cli_command *command, const cli_option *option)
{
    (void)command;
    if (option->kind == CLI_FLAG || option->alone)
        // an option without a value, or with a value only after =, takes no value from the next
        // word
        return;
    print_bash_names(option);
    if (option->kind == CLI_CHOICE) {
        fputs("words='", stdout);
        print_words(option->word, option->words);
        puts("' ;;");
    } else {
        puts(option->kind == CLI_FILE ? "return ;;" : "compopt +o default 2>/dev/null; return ;;");
    }
}

static void print_bash_option(const cli_command *command, const cli_option *option)
{
    (void)command;
    printf(" --%s", option->name);
}

static void print_bash_command(const cli_command *command)
{
    printf("    %s)\n        case $before in\n", command->name);
    for_each_option(command, print_bash_values);
    fputs("        *)\n            case $current in\n            -*) words='--help", stdout);
    for_each_option(command, print_bash_option);
    puts("' ;;");
    if (command->word) {
        fputs("            *) words='", stdout);
        print_words(command->word, NULL);
        puts("' ;;");
    }
    puts("            esac\n            ;;\n        esac\n        ;;");
}

// Bash splits --name=value into three words at the =.
static void print_bash(const cli_call *call)
{
    fputs(
        "# Completions of kiln for bash, written by kiln completions bash.\n"
        "_kiln() {\n"
        "    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
        "    [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}\n"
        "    [[ $current == = ]] && current=\n"
        "    COMPREPLY=()\n"
        "    if ((COMP_CWORD == 1)); then\n"
        "        COMPREPLY=($(compgen -W '--help --version ",
        stdout);
    print_commands(call);
    fputs("' -- \"$current\"))\n"
          "        return\n"
          "    fi\n"
          "    case ${COMP_WORDS[1]} in\n",
          stdout);
    for (int i = 0; call->commands[i]; i++)
        print_bash_command(call->commands[i]);
    fputs("    esac\n"
          "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
          "}\n"
          "complete -o default -F _kiln kiln\n",
          stdout);
}

// --------------------------------------------------------------------------------------------- zsh

// Prints an option in zsh's form: '(-o --output)'{-o+,--output=}'[what to write]:OUT:_files'
static void print_zsh_option(const cli_command *command, const cli_option *option)
{
    (void)command;
    char text[SUMMARY];
    bool flag = option->kind == CLI_FLAG;
    const char *equals = flag ? "" : option->alone ? "=-" : "=";
    fputs("            ", stdout);
    if (option->letter)
        printf("'(-%c --%s)'{-%c%s,--%s%s}'", option->letter, option->name, option->letter,
               flag ? "" : "+", option->name, equals);
    else
        printf("'--%s%s", option->name, equals);
    printf("[%s]", summary(option->help, text));
    if (!flag)
        printf("%s:%s:", option->alone ? ":" : "", option->value);
    if (option->kind == CLI_FILE)
        fputs("_files", stdout);
    if (option->kind == CLI_CHOICE) {
        putchar('(');
        print_words(option->word, option->words);
        putchar(')');
    }
    puts("' \\");
}

static void print_zsh_command(const cli_command *command)
{
    printf("    %s)\n        _arguments -s -S \\\n", command->name);
    for_each_option(command, print_zsh_option);
    fputs("            '(-h --help)'{-h,--help}'[print the help]' '", stdout);
    if (command->word) {
        fputs("1:argument:(", stdout);
        print_words(command->word, NULL);
        puts(")'");
    } else {
        puts("*:file:_files'");
    }
    puts("        ;;");
}

static void print_zsh(const cli_call *call)
{
    fputs("#compdef kiln\n"
          "# Completions of kiln for zsh, written by kiln completions zsh.\n"
          "_kiln() {\n"
          "    local -a commands\n"
          "    commands=(\n",
          stdout);
    for (int i = 0; call->commands[i]; i++) {
        char text[SUMMARY];
        printf("        '%s:%s'\n", call->commands[i]->name,
               summary(call->commands[i]->summary, text));
    }
    fputs("    )\n"
          "    if ((CURRENT == 2)); then\n"
          "        _describe command commands\n"
          "        return\n"
          "    fi\n"
          "    local command=$words[2]\n"
          "    shift words\n"
          "    ((CURRENT--))\n"
          "    case $command in\n",
          stdout);
    for (int i = 0; call->commands[i]; i++)
        print_zsh_command(call->commands[i]);
    fputs("    esac\n}\n_kiln \"$@\"\n", stdout);
}

// -------------------------------------------------------------------------------------------- fish

static void print_fish_option(const cli_command *command, const cli_option *option)
{
    char text[SUMMARY];
    printf("complete -c kiln -n '__fish_seen_subcommand_from %s' -l %s", command->name,
           option->name);
    if (option->letter)
        printf(" -s %c", option->letter);
    if (option->kind == CLI_FILE)
        fputs(" -r -F", stdout);
    else if (option->kind != CLI_FLAG && !option->alone)
        fputs(" -x", stdout);
    if (option->kind == CLI_CHOICE) {
        fputs(" -a '", stdout);
        print_words(option->word, option->words);
        putchar('\'');
    }
    printf(" -d '%s'\n", summary(option->help, text));
}

static void print_fish(const cli_call *call)
{
    puts("# Completions of kiln for fish, written by kiln completions fish.");
    for (int i = 0; call->commands[i]; i++) {
        const cli_command *command = call->commands[i];
        char text[SUMMARY];
        printf("complete -c kiln -f -n __fish_use_subcommand -a %s -d '%s'\n", command->name,
               summary(command->summary, text));
        for_each_option(command, print_fish_option);
        if (command->word) {
            printf("complete -c kiln -f -n '__fish_seen_subcommand_from %s' -a '", command->name);
            print_words(command->word, NULL);
            puts("'");
        }
    }
}

// ----------------------------------------------------------------------------------------- command

static int run(const cli_call *call)
{
    static void (*const print[])(const cli_call *call) = {print_bash, print_zsh, print_fish};
    const cli_option words = {.word = shell_word};
    cli_arguments a;
    char none;
    int shell = 0, code = cli_read_arguments(&a, &cli_completions, call, &none);
    if (code != CLI_GO)
        return code;
    if (a.rest_count != 1)
        return cli_wrong(&cli_completions, "name one shell: bash, zsh or fish");
    code = cli_find_word(&cli_completions, "shell", a.rest[0], &words, &shell);
    if (code != CLI_GO)
        return code;
    print[shell](call);
    return CLI_DONE;
}

static const cli_example examples[] = {
    {"kiln completions bash >~/.local/share/bash-completion/completions/kiln",
     "for one user, where they are not installed for all"},
    {NULL, NULL}};

const cli_command cli_completions = {
    .name = "completions",
    .arguments = "bash | zsh | fish",
    .summary = "Prints the completions of a shell.",
    .about = "",
    .word = shell_word,
    .examples = examples,
    .run = run,
};
