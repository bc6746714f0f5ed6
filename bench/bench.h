// The benches' common ground: the clock, the inputs, and rows of results.
#ifndef BENCH_H
#define BENCH_H

#include <kiln/kiln.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct bench {
    const char *data;    ///< folder of the real panoramas
    const char *inputs;  ///< folder of what run.sh made from them; scratch files go there too
    const char *results; ///< folder of the CSV files, NULL for none
    const char *kiln;    ///< the command
    int runs;
    FILE *csv;   ///< of the case that runs
    bool missed; ///< a bar was missed
    kiln_error error;
} bench;

/// A case returns false when it could not be run; bench->error says why.
typedef struct bench_case {
    const char *name, *summary;
    bool (*run)(bench *b);
    bool on_request; ///< left out where no case is named
} bench_case;

bool bench_accuracy(bench *b);
bool bench_files(bench *b);
bool bench_scaling(bench *b);
bool bench_probe(bench *b);
bool bench_threads(bench *b);
bool bench_instructions(bench *b);
bool bench_fixed(bench *b);
bool bench_peer(bench *b);
bool bench_memory(bench *b);
bool bench_tables(bench *b);
bool bench_tune(bench *b);

/// Seconds of CPU time of all threads, and of a clock on the wall.
double bench_cpu(void);
double bench_wall(void);

enum { BENCH_MAX_RUNS = 64 };
typedef struct bench_times {
    double median, minimum;
} bench_times;
/// Sorts `seconds`.
bench_times bench_sum_up(double *seconds, int count);

/// One row of the case's CSV file: name, unit, median, minimum. The first creates the file.
void bench_row(bench *b, const char *name, const char *unit, bench_times times);
void bench_value(bench *b, const char *name, const char *unit, double value);
/// Prints what was reached beside the bar and remembers a miss.
void bench_bar(bench *b, const char *what, double value, const char *unit, double bar,
               bool at_least);
/// Prints how far a value is from an aim: at most `aim` is wanted, nothing fails.
void bench_aim(const char *what, double value, const char *unit, double aim);

/// Sets b->error to a formatted sentence and returns false.
bool bench_fail(bench *b, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Loads DATA/city.exr, each texel repeated to `size` rows (512 and its multiples), or averaged to
/// fewer.
bool bench_city(bench *b, kiln_context *context, int size, kiln_map *map);

/// Relative errors of a level: rms, and the largest of a value.
typedef struct bench_figures {
    double rms, largest;
} bench_figures;

/// Compares a GGX level with brute force.
bool bench_check_level(bench *b, kiln_context *context, const kiln_map *source, const kiln_map *map,
                       int level, bench_figures *f);

/// Of every bit of every level.
unsigned long long bench_hash(const kiln_map *map);

#endif
