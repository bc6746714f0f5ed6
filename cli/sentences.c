// The command's messages on standard error, and the flush of standard output.
#include "cli.h"
#include "os.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void cli_say(const char *opening, const char *format, va_list list)
{
    char text[8192];
    vsnprintf(text, sizeof text, format, list);
    kiln_text_clean(text);
    fprintf(stderr, "%s%s\n", opening, text);
}

cli_shown cli_show(const char *text)
{
    cli_shown shown;
    snprintf(shown.text, sizeof shown.text, "%s", text);
    kiln_text_clean(shown.text);
    return shown;
}

int cli_wrong(const cli_command *command, const char *format, ...)
{
    va_list list;
    char opening[4096 + 16] = "kiln: ";
    if (command && command->place)
        snprintf(opening, sizeof opening, "kiln: %s: ", cli_show(command->place).text);
    va_start(list, format);
    cli_say(opening, format, list);
    va_end(list);
    if (command && command->place)
        return CLI_WRONG;
    fprintf(stderr, "Try 'kiln %s%s--help'.\n", command ? command->name : "", command ? " " : "");
    return CLI_WRONG;
}

int cli_fail(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    cli_say("kiln: ", format, list);
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

int cli_close_output(int code)
{
    bool failed = ferror(stdout) != 0;
    errno = 0;
    failed = fflush(stdout) != 0 || failed;
    if (!failed)
        return code;
    int gone = os_reader_gone(errno);
    if (gone)
        return gone; // no message: the reader of standard output closed the pipe
    if (code == CLI_DONE)
        cli_fail("standard output: %s", errno ? strerror(errno) : "cannot be written");
    return code == CLI_DONE ? CLI_FAILED : code;
}
