// Declarations that the benchmarks share: the options, the clocks, the inputs, and the rows of
// results.
#ifndef BENCH_H
#define BENCH_H

#include <kiln/kiln.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct bench {
    const char *data; ///< folder of the photographed panoramas
    /// folder of the panoramas that run.sh made from `data`, and of scratch files
    const char *inputs;
    const char *results; ///< folder of the CSV files; NULL to write no CSV files
    const char *kiln;    ///< path of the command kiln
    int runs;
    FILE *csv;   ///< CSV file of the case that runs; NULL for no file
    bool missed; ///< true: a value missed the bar it must reach, so bench exits with failure
    kiln_error error;
} bench;

/// A benchmark case. `run` returns false if the case could not be run, and bench->error then says
/// why.
typedef struct bench_case {
    const char *name, *summary;
    bool (*run)(bench *b);
    bool on_request; ///< true: the case runs only if it is named
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
bool bench_stream(bench *b);
bool bench_tables(bench *b);
bool bench_tune(bench *b);
bool bench_lights(bench *b);

/// bench_cpu returns the seconds of CPU time that all threads of the process have used, bench_wall
/// the seconds of a clock.
double bench_cpu(void);
double bench_wall(void);

/// BENCH_FFT_LENGTH: number of complex doubles of the Fourier transform that serves as a yardstick.
enum { BENCH_FFT_LENGTH = 65536 };
/// Returns the seconds of CPU time of a Fourier transform of radix 2, without vectors, the least of
/// 20.
double bench_fft_seconds(void);
/// Returns the multiplications and additions of doubles that one core does in a second with the
/// vectors of the context's instruction set and with no fused operations, which kiln's kernels do
/// not use.
double bench_peak_flops(kiln_context *context);

enum { BENCH_MAX_RUNS = 64 };
typedef struct bench_times {
    double median, minimum;
} bench_times;
/// Sorts the `count` times in `seconds` and returns their median and minimum.
bench_times bench_sum_up(double *seconds, int count);

/// Writes a row of the running case's CSV file: name, unit, median and minimum of a measured time.
void bench_row(bench *b, const char *name, const char *unit, bench_times times);
void bench_value(bench *b, const char *name, const char *unit, double value);
/// Prints a measured value and the bar that it must reach: at least or at most `bar`. Sets
/// b->missed if it does not.
void bench_bar(bench *b, const char *what, double value, const char *unit, double bar,
               bool at_least);
/// Prints a measured value and its ratio to `aim`, which the value should not exceed. A value above
/// the aim is no failure.
void bench_aim(const char *what, double value, const char *unit, double aim);

/// Sets b->error to a formatted message and returns false.
bool bench_fail(bench *b, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Loads DATA/city.exr as a panorama of `size` rows: texels are repeated for 512 rows and its
/// multiples, and averaged for fewer rows.
bool bench_city(bench *b, kiln_context *context, int size, kiln_map *map);

/// Errors of a level: the RMS error relative to the RMS of the exact values, and the largest error
/// of a value relative to its exact value.
typedef struct bench_figures {
    double rms, largest;
} bench_figures;

/// Compares the texels of a level that is filtered by GGX with brute force (kiln_reference_filter)
/// and sets `f` to the level's errors.
bool bench_check_level(bench *b, kiln_context *context, const kiln_map *source, const kiln_map *map,
                       int level, bench_figures *f);

/// Returns a hash of the bits of all texels of a map's levels.
unsigned long long bench_hash(const kiln_map *map);

#endif
