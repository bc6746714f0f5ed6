// The program bench. In: options and names of cases (bench [OPTION...] [CASE...]), run from the
// root of the sources. Out: the results of the cases, printed and as CSV files. Without names it
// runs every case that is not marked on_request. bench/run.sh makes the inputs that the cases need.
#include "bench.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

static const bench_case cases[] = {
    {"accuracy", "errors of every level of eight panoramas and a sky against brute force",
     bench_accuracy, false},
    {"probe", "a probe of 256 x 128 texels to faces of 64 x 64 by a plan, on one thread",
     bench_probe, false},
    {"threads", "time and bits of a bake on one and on two threads", bench_threads, false},
    {"instructions", "time and bits of a bake for every instruction set, on one thread",
     bench_instructions, false},
    {"files", "time of a bake compared with reading and writing its files", bench_files, false},
    {"scaling", "time of a bake for panoramas 1k to 8k wide and faces of 128 to 1024 texels",
     bench_scaling, false},
    {"peer", "time of the whole command, compared with Filament's cmgen", bench_peer, false},
    {"memory", "peak memory of baking a panorama of 8192 x 4096", bench_memory, false},
    {"stream", "time and peak memory of panoramas of 16384 x 8192 and 32768 x 16384", bench_stream,
     true},
    {"tables", "tables of E compared with 1024 importance samples for each texel, on one thread",
     bench_tables, false},
    {"tune", "errors of what engines show of exact and tuned levels against brute force",
     bench_tune, false},
    {"lights", "the same errors after suns and lamps were taken out of the panoramas", bench_lights,
     false},
    {"fixed", "a small bake with AVX2, whose instructions are counted", bench_fixed, true},
};
enum { CASE_COUNT = sizeof cases / sizeof *cases };

// ------------------------------------------------------------------------------------------ clocks

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double bench_cpu(void)
{
    return seconds(CLOCK_PROCESS_CPUTIME_ID);
}

double bench_wall(void)
{
    return seconds(CLOCK_MONOTONIC);
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bench_times bench_sum_up(double *times, int count)
{
    qsort(times, (size_t)count, sizeof *times, compare);
    return (bench_times){(times[(count - 1) / 2] + times[count / 2]) / 2, times[0]};
}

// ----------------------------------------------------------------------------------------- results

void bench_row(bench *b, const char *name, const char *unit, bench_times times)
{
    if (b->csv)
        fprintf(b->csv, "%s,%s,%.9g,%.9g\n", name, unit, times.median, times.minimum);
}

void bench_value(bench *b, const char *name, const char *unit, double value)
{
    bench_row(b, name, unit, (bench_times){value, value});
}

void bench_bar(bench *b, const char *what, double value, const char *unit, double bar,
               bool at_least)
{
    bool reached = at_least ? value >= bar : value <= bar;
    printf("  %-46s %10.4g %-4s %s %.4g: %s\n", what, value, unit,
           at_least ? "at least" : "at most", bar, reached ? "reached" : "MISSED");
    b->missed |= !reached;
}

void bench_aim(const char *what, double value, const char *unit, double aim)
{
    printf("  %-46s %10.4g %-4s aim %.4g: %.2f times the aim\n", what, value, unit, aim,
           value / aim);
}

bool bench_fail(bench *b, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(b->error.message, sizeof b->error.message, format, arguments);
    va_end(arguments);
    return false;
}

// Sets `name` to the processor's name in lower case with hyphens, which names the folder of
// results, for example "amd-epyc-7763".
static void name_machine(char *name, size_t size)
{
    char line[256];
    snprintf(name, size, "unknown");
    FILE *f = fopen("/proc/cpuinfo", "r");
    while (f && fgets(line, sizeof line, f)) {
        const char *at = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !at)
            continue;
        size_t n = 0;
        for (at++; *at && n + 2 < size; at++)
            if (isalnum((unsigned char)*at))
                name[n++] = (char)tolower((unsigned char)*at);
            else if (n && name[n - 1] != '-')
                name[n++] = '-';
        while (n && name[n - 1] == '-')
            n--;
        name[n] = 0;
        break;
    }
    if (f)
        fclose(f);
}

static FILE *open_csv(bench *b, const char *machine, const char *name)
{
    char path[1024];
    if (!b->results)
        return NULL;
    snprintf(path, sizeof path, "%s/%s", b->results, machine);
    if ((mkdir(b->results, 0777) && errno != EEXIST) || (mkdir(path, 0777) && errno != EEXIST))
        return NULL;
    snprintf(path, sizeof path, "%s/%s/%s.csv", b->results, machine, name);
    FILE *f = fopen(path, "w");
    if (f)
        fputs("name,unit,median,minimum\n", f);
    return f;
}

// ------------------------------------------------------------------------------------------ inputs

bool bench_city(bench *b, kiln_context *context, int size, kiln_map *map)
{
    char path[1024];
    kiln_map city = {0};
    snprintf(path, sizeof path, "%s/city.exr", b->data);
    if (kiln_map_load(context, path, NULL, &city, &b->error))
        return false;
    kiln_result result = KILN_OK;
    if (size < city.size) {
        result = kiln_map_convert(context, &city, KILN_SHAPE_PANORAMA, size, 0, map, &b->error);
    } else {
        result = kiln_map_create(context, KILN_SHAPE_PANORAMA, size, 1, map, &b->error);
        size_t times = (size_t)(size / city.size), width = 2 * (size_t)size;
        for (size_t y = 0; y < (size_t)size && !result; y++)
            for (size_t x = 0; x < width; x++)
                memcpy(map->level[0] + 3 * (y * width + x),
                       city.level[0] + 3 * (y / times * (width / times) + x / times),
                       3 * sizeof(float));
    }
    kiln_map_free(&city);
    return result == KILN_OK;
}

unsigned long long bench_hash(const kiln_map *map)
{
    unsigned long long hash = 14695981039346656037ULL; // the FNV-1a hash of 64 bits
    for (int k = 0; k < map->level_count; k++) {
        const unsigned char *bytes = (const unsigned char *)map->level[k];
        size_t size = kiln_map_texels(map, k) * 3 * sizeof(float);
        for (size_t i = 0; i < size; i++)
            hash = (hash ^ bytes[i]) * 1099511628211ULL;
    }
    return hash;
}

// -------------------------------------------------------------------------------------------- main

static int list(void)
{
    for (int i = 0; i < CASE_COUNT; i++)
        printf("%-14s%s%s\n", cases[i].name, cases[i].summary,
               cases[i].on_request ? " (runs only if named)" : "");
    return 0;
}

static int usage(FILE *file)
{
    fputs("usage: bench [OPTION...] [CASE...]\n  --list            print the names of the cases\n  "
          "--machine         print the name of the results' folder\n  --data FOLDER     the "
          "photographed panoramas (default build/data/blender)\n  --inputs FOLDER   larger "
          "panoramas made from them (default build/bench)\n  --results FOLDER  write CSV files to "
          "FOLDER/MACHINE/CASE.csv (default: no files)\n  --kiln FILE       the command kiln "
          "(default build/release/bin/kiln)\n  --runs N          number of runs of each "
          "measurement (default 5)\n",
          file);
    return file == stderr ? 2 : 0;
}

static bool run(bench *b, const bench_case *c, const char *machine)
{
    printf("\n%s: %s\n", c->name, c->summary);
    fflush(stdout);
    b->csv = open_csv(b, machine, c->name);
    bool done = c->run(b);
    if (!done)
        printf("  the case could not be run: %s\n", b->error.message);
    if (b->csv)
        fclose(b->csv);
    fflush(stdout);
    return done;
}

static bool known(const char *name)
{
    for (int i = 0; i < CASE_COUNT; i++)
        if (!strcmp(cases[i].name, name))
            return true;
    return false;
}

int main(int argc, char **argv)
{
    bench b = {.data = "build/data/blender",
               .inputs = "build/bench",
               .kiln = "build/release/bin/kiln",
               .runs = 5};
    char machine[64];
    name_machine(machine, sizeof machine);
    int i = 1;
    while (i < argc && argv[i][0] == '-') {
        const char *option = argv[i++];
        if (!strcmp(option, "--list"))
            return list();
        if (!strcmp(option, "--help"))
            return usage(stdout);
        if (!strcmp(option, "--machine"))
            return puts(machine) < 0;
        if (i == argc)
            return usage(stderr);
        const char *value = argv[i++];
        if (!strcmp(option, "--data"))
            b.data = value;
        else if (!strcmp(option, "--inputs"))
            b.inputs = value;
        else if (!strcmp(option, "--results"))
            b.results = value;
        else if (!strcmp(option, "--kiln"))
            b.kiln = value;
        else if (!strcmp(option, "--runs"))
            b.runs = (int)strtol(value, NULL, 10);
        else
            return usage(stderr);
    }
    if (b.runs < 1 || b.runs > BENCH_MAX_RUNS)
        return usage(stderr);
    for (int k = i; k < argc; k++)
        if (!known(argv[k])) {
            fprintf(stderr, "bench: there is no case '%s'; 'bench --list' names the cases\n",
                    argv[k]);
            return 2;
        }
    printf("kiln %s on %s, %d runs of each measurement\n", kiln_version(), machine, b.runs);
    bool failed = false;
    for (int c = 0; c < CASE_COUNT; c++) {
        bool wanted = i == argc && !cases[c].on_request;
        for (int k = i; k < argc; k++)
            wanted |= !strcmp(argv[k], cases[c].name);
        if (wanted)
            failed |= !run(&b, &cases[c], machine);
    }
    return failed || b.missed;
}
