// kiln tables: its options, and the three things it makes.
#ifndef KILN_CLI_TABLES_H
#define KILN_CLI_TABLES_H

#include "cli.h"

enum {
    TABLES_OUTPUT = 1,
    TABLES_ASSIGNMENT,
    TABLES_METHOD,
    TABLES_TABLE,
    TABLES_D,
    TABLES_G,
    TABLES_SHEEN,
    TABLES_SIZE,
    TABLES_AXIS,
    TABLES_CORNERS,
    TABLES_COMPLEMENT,
    TABLES_FLIP,
    TABLES_FORMAT,
    TABLES_ZSTD,
    TABLES_AVERAGE,
    TABLES_LOOKUP,
    TABLES_NAME,
    TABLES_PATHS,
    TABLES_SAMPLES,
    TABLES_THREADS,
    TABLES_JSON,
    TABLES_FOR,
    TABLES_QUIET
};

/// The exact tables: a file, with --lookup the code that reads it, with --average its mean. The exit
/// code.
int tables_exact(const cli_arguments *a);

#endif
