// The command `kiln eval`, whose arguments are words and whose input is lines of numbers on
// standard input. The functions of cli/ that print sentences are replaced here by some that keep
// the last sentence, so that standard error stays free for what the sanitizers say.
#include "fuzz.h"

#include "cli.h"
#include "os.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char sentence[512];

int cli_wrong(const cli_command *command, const char *format, ...)
{
    va_list list;
    (void)command;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    return CLI_WRONG;
}

int cli_fail(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    return CLI_FAILED;
}

void cli_print_help(const cli_command *command)
{
    (void)command;
    puts("help");
}

bool os_is_terminal(os_stream stream)
{
    (void)stream;
    return false;
}

// Replaces a standard stream by a file without a name. Returns a descriptor of the stream's own
// file.
static int replace(FILE *stream, FILE *file)
{
    int descriptor = fileno(stream), kept = dup(descriptor);
    fflush(stream);
    fuzz_must(kept >= 0 && dup2(fileno(file), descriptor) == descriptor);
    return kept;
}

static void restore(FILE *stream, int kept)
{
    fflush(stream);
    fuzz_must(dup2(kept, fileno(stream)) == fileno(stream));
    close(kept);
}

// Checks that each line of a text is one number, and that the lines are one or as many as those of
// the input.
static void must_be_numbers(char *text, size_t count)
{
    size_t lines = 0;
    for (char *end; *text; text = end + 1, lines++) {
        strtod(text, &end);
        fuzz_must(end != text && *end == '\n');
    }
    fuzz_must(lines == count || lines == 1);
}

// Runs the command with words and with this standard input. Returns its exit code, and what it has
// printed.
static int evaluate(const char **words, int count, FILE *in, char *printed, size_t room)
{
    static const cli_command *const commands[] = {&cli_eval, NULL};
    FILE *out = tmpfile();
    fuzz_must(out != NULL);
    clearerr(stdin);
    rewind(in);
    int kept_in = replace(stdin, in), kept_out = replace(stdout, out);
    fseek(stdin, 0, SEEK_SET);
    sentence[0] = 0;
    int code = cli_eval.run(&(cli_call){commands, count, words});
    restore(stdout, kept_out);
    restore(stdin, kept_in);
    rewind(out);
    printed[fread(printed, 1, room - 1, out)] = 0;
    fclose(out);
    return code;
}

// The first line has the words of the command line, and up to 256 bytes after it are standard
// input, since some quantities are integrals that take long. A run prints one number for each line
// of its input, or for the words alone; or nothing, after a sentence.
void fuzz_eval(const uint8_t *bytes, size_t size)
{
    enum { WORDS = 12, ROOM = 1 << 16, INPUT = 256 };
    const char *words[WORDS + 1] = {"eval"};
    int count = 1;
    char *text = fuzz_text(bytes, size), *end = strchr(text, '\n'), *state = NULL;
    size_t at = end ? (size_t)(end + 1 - text) : size, lines = 0;
    size = size - at < INPUT ? size : at + INPUT;
    FILE *in = tmpfile();
    fuzz_must(in && fwrite(bytes + at, 1, size - at, in) == size - at && fflush(in) == 0);
    for (size_t i = at; i < size; i++)
        lines += bytes[i] == '\n' || i + 1 == size;
    if (end)
        *end = 0;
    for (char *word = strtok_r(text, " ", &state); word && count < WORDS;
         word = strtok_r(NULL, " ", &state))
        words[count++] = word;
    char *printed = malloc(ROOM);
    fuzz_must(printed != NULL);
    int code = evaluate(words, count, in, printed, ROOM);
    fuzz_must(code == CLI_DONE || code == CLI_FAILED || code == CLI_WRONG);
    fuzz_must((code == CLI_DONE) == (sentence[0] == 0));
    if (code != CLI_DONE)
        fuzz_must(!printed[0]);
    else if (!strchr("{[", printed[0]) && strcmp(printed, "help\n") != 0)
        must_be_numbers(printed, lines);
    free(printed);
    fclose(in);
    free(text);
}
