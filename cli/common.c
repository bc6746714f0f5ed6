// Options with ranges, sentences, the job with its progress line and signals.
#include "cli.h"
#include "os.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --------------------------------------------------------------------------------------- sentences

static void say(const char *format, va_list list)
{
    fputs("kiln: ", stderr);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
}

int cli_wrong(const cli_command *command, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say(format, list);
    va_end(list);
    fprintf(stderr, "Try 'kiln %s%s--help'.\n", command ? command->name : "", command ? " " : "");
    return CLI_WRONG;
}

int cli_fail(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say(format, list);
    va_end(list);
    return CLI_FAILED;
}

const char *cli_bytes(double bytes, char text[32])
{
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB"};
    int unit = 0;
    while (bytes >= 1000 && unit < 4) {
        bytes /= 1000;
        unit++;
    }
    snprintf(text, 32, unit ? "%.3g %s" : "%.0f %s", bytes >= 999.5 ? 999 : bytes, units[unit]);
    return text;
}

// ----------------------------------------------------------------------------------------- options

// The long name of an option, looked for in included tables too.
static const char *option_name(const struct poptOption *table, int option)
{
    const char *name = NULL;
    for (; !name && (table->longName || table->arg); table++) {
        if (table->argInfo == POPT_ARG_INCLUDE_TABLE)
            name = option_name(table->arg, option);
        else if (table->val == option)
            name = table->longName;
    }
    return name;
}

const char *cli_option_name(const cli_command *command, int option)
{
    return option_name(command->options, option);
}

int cli_arguments_read(cli_arguments *a, const cli_command *command, int argc, const char **argv)
{
    *a = (cli_arguments){.command = command};
    a->popt = poptGetContext(NULL, argc, argv, command->options, 0);
    if (!a->popt)
        return cli_fail("out of memory");
    poptSetOtherOptionHelp(a->popt, command->arguments);

    int option;
    while ((option = poptGetNextOpt(a->popt)) > 0) {
        char *text = poptGetOptArg(a->popt);
        if (a->value[option]) {
            free(text);
            return cli_wrong(command, "--%s is given twice", cli_option_name(command, option));
        }
        a->value[option] = text ? text : strdup("");
        if (!a->value[option])
            return cli_fail("out of memory");
    }
    if (a->value[CLI_HELP]) {
        printf("%s\n\n", command->summary);
        poptPrintHelp(a->popt, stdout, 0);
        printf("\n%s", command->details);
        return CLI_DONE;
    }
    const char *bad = poptBadOption(a->popt, 0);
    if (option == POPT_ERROR_BADOPT)
        return cli_wrong(command, "%s: no such option", bad);
    if (option == POPT_ERROR_NOARG)
        return cli_wrong(command, "%s needs a value", bad);
    if (option < -1)
        return cli_wrong(command, "%s: %s", bad, poptStrerror(option));
    a->rest = poptGetArgs(a->popt);
    while (a->rest && a->rest[a->rest_count])
        a->rest_count++;
    return CLI_GO;
}

void cli_arguments_free(cli_arguments *a)
{
    for (int i = 0; i < CLI_MAX_OPTIONS; i++)
        free(a->value[i]);
    poptFreeContext(a->popt);
}

int cli_integer(const cli_arguments *a, int option, const char *name, int low, int high, int *value)
{
    const char *text = a->value[option];
    if (!text)
        return CLI_GO;
    char *end;
    errno = 0;
    long n = strtol(text, &end, 10);
    if (end == text || *end)
        return cli_wrong(a->command, "%s is '%s', it must be a whole number from %d to %d", name,
                         text, low, high);
    if (errno || n < low || n > high)
        return cli_wrong(a->command, "%s is %s, it must be from %d to %d", name, text, low, high);
    *value = (int)n;
    return CLI_GO;
}

int cli_number(const cli_arguments *a, int option, const char *name, double low, double high,
               double *value)
{
    const char *text = a->value[option];
    if (!text)
        return CLI_GO;
    char *end;
    double x = strtod(text, &end);
    if (end == text || *end)
        return cli_wrong(a->command, "%s is '%s', it must be a number from %g to %g", name, text,
                         low, high);
    if (!(x >= low && x <= high))
        return cli_wrong(a->command, "%s is %s, it must be from %g to %g", name, text, low, high);
    *value = x;
    return CLI_GO;
}

int cli_choice(const cli_arguments *a, int option, const char *name, const char *const *words,
               int *value)
{
    const char *text = a->value[option];
    if (!text)
        return CLI_GO;
    char list[256] = "";
    for (int i = 0; words[i]; i++) {
        if (!strcmp(text, words[i])) {
            *value = i;
            return CLI_GO;
        }
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s",
                 !i             ? ""
                 : words[i + 1] ? ", "
                                : " or ",
                 words[i]);
    }
    return cli_wrong(a->command, "%s is '%s', it must be %s", name, text, list);
}

const char *cli_ending(const char *path)
{
    const char *ending = kiln_path_ending(path);
    if (ending[0] == '/' || os_kind_of(path) == OS_FOLDER)
        return "/";
    return ending[0] ? ending + 1 : "";
}

int cli_check_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash || !slash[1])
        return CLI_GO; // here, or a folder that will be made
    char folder[4096];
    size_t length = slash == path ? 1 : (size_t)(slash - path);
    if (length >= sizeof folder)
        return cli_fail("%.60s...: the name is too long", path);
    memcpy(folder, path, length);
    folder[length] = 0;
    if (strchr(folder, '%') || strchr(folder, '{'))
        return CLI_GO;
    switch (os_kind_of(folder)) {
    case OS_NOTHING:
        return cli_fail("%s: there is no folder %s", path, folder);
    case OS_UNREACHABLE:
        return cli_fail("%s: cannot enter the folder %s", path, folder);
    case OS_FILE:
        return cli_fail("%s: %s is not a folder", path, folder);
    default:
        return CLI_GO;
    }
}

// --------------------------------------------------------------------------------------------- job

double cli_seconds(void)
{
    return os_seconds();
}

bool cli_interrupted(void)
{
    return os_signal() != 0;
}

enum { PROGRESS_WIDTH = 40 };

void cli_clear_progress(cli_job *job)
{
    if (job->drawn > 0)
        fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH, "");
    job->drawn = 0;
}

bool cli_progress(void *user, const char *stage, double fraction)
{
    cli_job *job = user;
    double now = cli_seconds();
    // Within a stage the line only goes forward.
    if (!job->stage || strcmp(stage, job->stage) != 0 || fraction > job->furthest)
        job->furthest = fraction;
    job->stage = stage;
    if (job->on_terminal && now - job->began > 0.5 && now - job->drawn > 0.1 &&
        !cli_interrupted()) {
        char line[PROGRESS_WIDTH + 1];
        snprintf(line, sizeof line, "kiln: %s %.0f %%", stage, 100 * job->furthest);
        fprintf(stderr, "\r%-*s", PROGRESS_WIDTH, line);
        job->drawn = now;
    }
    return !cli_interrupted();
}

static void create_context(void *user)
{
    cli_job *job = user;
    kiln_context_def def = {
        .thread_count = job->threads,
        .progress = cli_progress,
        .progress_user = job,
        // Beyond what the machine has, a bake would be killed without a sentence.
        .memory_limit = os_physical_memory(),
    };
    job->error.result = kiln_context_create(&def, &job->context, &job->error);
}

int cli_job_begin(cli_job *job, int threads, bool quiet)
{
    *job = (cli_job){.began = cli_seconds(),
                     .threads = threads,
                     .on_terminal = !quiet && os_is_terminal(OS_ERRORS)};
    os_catch_signals();
    os_without_signals(create_context, job);
    return job->context ? CLI_GO : CLI_FAILED;
}

int cli_job_end(cli_job *job, int code)
{
    int signal = os_signal();
    cli_clear_progress(job);
    if (code == CLI_FAILED && !signal && job->error.message[0])
        cli_fail("%s", job->error.message);
    kiln_context_destroy(job->context);
    return code == CLI_FAILED && signal ? 128 + signal : code;
}

void cli_warn(cli_job *job, const char *format, ...)
{
    cli_clear_progress(job);
    fputs("kiln: warning: ", stderr);
    va_list list;
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputc('\n', stderr);
}

// ------------------------------------------------------------------------------------------ output

int cli_print_json(cJSON *json)
{
    char *text = json ? cJSON_Print(json) : NULL;
    cJSON_Delete(json);
    if (!text)
        return cli_fail("out of memory");
    puts(text);
    free(text);
    return CLI_DONE;
}

int cli_close_output(int code)
{
    bool failed = ferror(stdout) != 0;
    errno = 0;
    failed = fflush(stdout) != 0 || failed;
    if (!failed)
        return code;
    int gone = os_reader_gone(errno);
    if (gone)
        return gone; // the reader knows it
    if (code == CLI_DONE)
        cli_fail("standard output: %s", errno ? strerror(errno) : "cannot be written");
    return code == CLI_DONE ? CLI_FAILED : code;
}
