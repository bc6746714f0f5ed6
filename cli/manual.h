// The manual page kiln(1), generated from the commands' descriptions and options.
#ifndef KILN_CLI_MANUAL_H
#define KILN_CLI_MANUAL_H

#include "cli.h"

/// Prints the page as mdoc(7). `commands` ends in NULL.
void cli_print_manual(const cli_command *const *commands);

#endif
