// The manual page kiln(1), made from the commands' descriptions and rows.
#ifndef KILN_CLI_MANUAL_H
#define KILN_CLI_MANUAL_H

#include "cli.h"

/// Prints the page as mdoc(7). `commands` ends in NULL.
void cli_print_manual(const cli_command *const *commands);

#endif
