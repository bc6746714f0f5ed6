// The tables of GAMES202's fourth assignment by its own methods, with the exact integrals, maps of the errors
// and a report: for kiln tables --assignment, and for kiln assignment, which adds rendered balls.
#ifndef KILN_CLI_ASSIGNMENT_H
#define KILN_CLI_ASSIGNMENT_H

#include "work.h"

#include <kiln/course.h>
#include <stdio.h>

struct assignment;

typedef struct assignment_def {
    const char *folder; ///< made where missing
    int size, samples;
    kiln_g g; ///< one of Schlick's two
    bool json, quiet;
    /// Draws pictures that are no tables, and writes their part of the report. May be NULL.
    kiln_result (*draw)(struct assignment *a);
    void (*describe)(const struct assignment *a, FILE *report);
    void *user;
} assignment_def;

/// CLI_GO, or the exit code: the folder's name cannot be one.
int assignment_check_folder(const cli_command *command, const char *folder);
/// Computes all, then writes all: pictures and report.md. CLI_DONE or CLI_FAILED.
int assignment_write(cli_work *work, const assignment_def *def);

// What follows is between the work and its report.

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
    kiln_image table[ASSIGNMENT_TABLES];           ///< one channel, the top row is roughness 1
    kiln_image map[ASSIGNMENT_TABLES];             ///< of the error, where there is a file for it
    kiln_difference difference[ASSIGNMENT_TABLES]; ///< to the exact table
    int file_count;
} assignment;

/// The file's name without its ending, and what is in it.
extern const char *const assignment_names[ASSIGNMENT_TABLES];
extern const char *const assignment_words[ASSIGNMENT_TABLES];
/// The exact table has no error.
bool assignment_is_exact(int table);

/// Writes NAME.png into the folder; `before` stands before the name.
kiln_result assignment_save(assignment *a, const kiln_image *image, const char *before,
                            const char *name);
/// report.md, written whole or not at all. CLI_DONE or CLI_FAILED.
int assignment_write_report(const assignment *a);
void assignment_print_json(const assignment *a);

#endif
