// The tables of the fourth GAMES202 assignment, made with the assignment's methods, with exact
// integrals, error maps and a report. kiln tables --assignment writes them; kiln assignment also
// draws balls with them.
#ifndef KILN_CLI_ASSIGNMENT_H
#define KILN_CLI_ASSIGNMENT_H

#include "work.h"

#include <kiln/course.h>
#include <stdio.h>

struct assignment;

typedef struct assignment_def {
    const char *folder; ///< output folder, created if it does not exist
    int size, samples;
    kiln_g g; ///< shadowing of the tables: KILN_G_SCHLICK_K2 or KILN_G_SCHLICK_TEXT
    bool json, quiet;
    /// Draws further pictures and writes their part of the report. May be NULL.
    kiln_result (*draw)(struct assignment *a);
    void (*describe)(const struct assignment *a, FILE *report);
    void *user;
} assignment_def;

/// Checks that `folder` can be the output folder. Returns CLI_GO or an exit code.
int assignment_check_folder(const cli_command *command, const char *folder);
/// Computes all tables first and then writes the pictures and report.md. Returns CLI_DONE or
/// CLI_FAILED.
int assignment_write(cli_work *work, const assignment_def *def);

// The declarations below are shared by the sources assignment*.c.

enum {
    ASSIGNMENT_MC,
    ASSIGNMENT_MC_UNCLAMPED,
    ASSIGNMENT_IS,
    ASSIGNMENT_SPLIT_SUM,
    ASSIGNMENT_EXACT,
    ASSIGNMENT_AVERAGE_MC,
    ASSIGNMENT_AVERAGE,
    ASSIGNMENT_AVERAGE_BYTES,
    ASSIGNMENT_AVERAGE_EXACT,
    ASSIGNMENT_TABLES
};

typedef struct assignment {
    cli_work *work;
    const assignment_def *def;
    /// the tables, of one channel each, with roughness 1 in the top row
    kiln_image table[ASSIGNMENT_TABLES];
    /// map of each table's error, for tables whose error map is written
    kiln_image map[ASSIGNMENT_TABLES];
    /// statistics of each table's difference from the exact table
    kiln_difference difference[ASSIGNMENT_TABLES];
    int file_count;
} assignment;

/// For each table: its file's name without the ending, and its description.
extern const char *const assignment_names[ASSIGNMENT_TABLES];
extern const char *const assignment_words[ASSIGNMENT_TABLES];
/// Returns whether the table is an exact integral, which has no error map.
bool assignment_is_exact(int table);

/// Writes the picture BEFORE + NAME + .png, with `before` as the prefix, into the output folder.
kiln_result assignment_save(assignment *a, const kiln_image *image, const char *before,
                            const char *name);
/// Writes report.md completely or not at all. Returns CLI_DONE or CLI_FAILED.
int assignment_write_report(const assignment *a);
void assignment_print_json(const assignment *a);

#endif
