// The options of kiln tables. The command makes exact tables, split-sum tables by importance
// sampling, or the GAMES202 assignment's tables.
#ifndef KILN_CLI_TABLES_H
#define KILN_CLI_TABLES_H

#include "work.h"

enum {
    TABLES_OUTPUT,
    TABLES_FOR,
    TABLES_TABLE,
    TABLES_G,
    TABLES_D,
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
    TABLES_ASSIGNMENT,
    TABLES_METHOD,
    TABLES_SAMPLES,
    TABLES_THREADS,
    TABLES_JSON,
    TABLES_QUIET,
    TABLES_OPTIONS
};

typedef struct tables {
    cli_arguments arguments;
    const char *output, *average, *size;
    kiln_table_def def;
    kiln_table_save_def save;
    int engine; ///< index of the engine of --for, as in tables_engine_word; -1 without --for
    int method, samples, threads;
    bool assignment, lookup, json, quiet;
    char lookup_path[2][4096]; ///< paths of the C and GLSL files with the code that reads the table
} tables;

/// Word number `index` of --for, the name of an engine; NULL after the last word.
const char *tables_engine_word(int index);
/// Writes an exact table, with --lookup the code that reads the table, with --average the table of
/// E_avg. Returns the exit code.
int tables_make_exact(tables *t);

#endif
