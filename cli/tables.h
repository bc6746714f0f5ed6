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
    TABLES_TAPS,
    TABLES_LEVELS,
    TABLES_ERROR,
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
    const char *levels; ///< levels of the environment that taps read: a number or a list
    const char *error;  ///< picture of expected errors; NULL for none
    kiln_table_def def;
    kiln_table_save_def save;
    int engine; ///< index of the engine of --for, as in kiln_engine_at; -1 without --for
    int method, samples, threads;
    bool assignment, lookup, json, quiet;
    /// Paths of the files in C, GLSL and, for tables of lobes, WGSL with the code that reads the
    /// table
    char lookup_path[3][4096];
} tables;

/// Reads the options that only --table lobes has into t->def and checks them. Returns CLI_GO or the
/// exit code.
int tables_read_lobes(tables *t);
/// Draws the expected errors of the split sum's lookup straight and bent and of the table, side by
/// side, to the file t->error.
kiln_result tables_draw_error(cli_work *work, const tables *t, const kiln_table *table);
/// Writes an exact table, with --lookup the code that reads the table, with --average the table of
/// E_avg. Returns the exit code.
int tables_make_exact(tables *t);

#endif
