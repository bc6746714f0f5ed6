// The cases that measure whole processes from outside: kiln bake beside cmgen, and the peak memory
// of a large bake. In: panoramas as files. Out: seconds of CPU and bytes of memory, printed and as
// rows of CSV files.
#include "bench.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct usage {
    /// CPU time in user and system mode, and time of a clock, in seconds
    double user, system, wall;
    double peak; ///< greatest memory in bytes
} usage;

static double timeval_seconds(struct timeval t)
{
    return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

// Runs a command, discards its output and measures it. The peak memory is that of the command's
// process alone, as the kernel measures it.
static bool run_command(bench *b, const char *const *command, usage *u)
{
    *u = (usage){0};
    double start = bench_wall();
    pid_t child = fork();
    if (child < 0)
        return bench_fail(b, "cannot start %s: %s", command[0], strerror(errno));
    if (child == 0) {
        int nothing = open("/dev/null", O_WRONLY);
        if (nothing >= 0) {
            dup2(nothing, STDOUT_FILENO);
            dup2(nothing, STDERR_FILENO);
        }
        execvp(command[0], (char *const *)command);
        _exit(127);
    }
    int status = 0;
    struct rusage r;
    if (wait4(child, &status, 0, &r) != child || !WIFEXITED(status) || WEXITSTATUS(status) == 127)
        return bench_fail(b, "%s could not be run, install it first", command[0]);
    if (WEXITSTATUS(status))
        return bench_fail(b, "%s ended with exit code %d", command[0], WEXITSTATUS(status));
    *u = (usage){timeval_seconds(r.ru_utime), timeval_seconds(r.ru_stime), bench_wall() - start,
                 1024.0 * (double)r.ru_maxrss};
    return true;
}

// -------------------------------------------------------------------------------------------- peer

enum { COMMANDS = 4 };

bool bench_peer(bench *b)
{
    char input[1024], cube[1024], irradiance[1024], sh[1024], folder[1024];
    snprintf(input, sizeof input, "%s/city2k.exr", b->inputs);
    snprintf(cube, sizeof cube, "%s/peer.ktx2", b->inputs);
    snprintf(irradiance, sizeof irradiance, "%s/peer_irradiance.ktx2", b->inputs);
    snprintf(sh, sizeof sh, "%s/peer_sh.json", b->inputs);
    snprintf(folder, sizeof folder, "%s/cmgen", b->inputs);
    char levels[1100], diffuse[1100];
    snprintf(levels, sizeof levels, "--ibl-ld=%s", folder);
    snprintf(diffuse, sizeof diffuse, "--ibl-irradiance=%s", folder);
    const char *const commands[COMMANDS][12] = {
        {b->kiln, "bake", input, "-o", cube, "--irradiance", irradiance, "--sh", sh, "--quiet"},
        {"cmgen", "-q", "-f", "exr", "--size=256", levels, input},
        {"cmgen", "-q", "--sh=3", input},
        {"cmgen", "-q", "-f", "exr", "--size=64", diffuse, input},
    };
    static const char *const names[COMMANDS] = {"kiln bake: levels, irradiance, harmonics",
                                                "cmgen --ibl-ld --size=256: five levels",
                                                "cmgen --sh=3", "cmgen --ibl-irradiance --size=64"};
    double user[COMMANDS][BENCH_MAX_RUNS], all[COMMANDS][BENCH_MAX_RUNS];
    double peak[COMMANDS] = {0};
    // The commands are run in turn, so that other load on the machine affects all of them alike.
    for (int i = 0; i < b->runs; i++)
        for (int k = 0; k < COMMANDS; k++) {
            usage u;
            if (!run_command(b, commands[k], &u))
                return false;
            user[k][i] = u.user;
            all[k][i] = u.user + u.system;
            peak[k] = u.peak > peak[k] ? u.peak : peak[k];
        }
    bench_times t[COMMANDS];
    for (int k = 0; k < COMMANDS; k++) {
        t[k] = bench_sum_up(user[k], b->runs);
        bench_times with_system = bench_sum_up(all[k], b->runs);
        printf("  %-42s %8.3f s of CPU time (%.3f s with the system's), %.0f MiB peak memory\n",
               names[k], t[k].median, with_system.median, peak[k] / 1048576);
        bench_row(b, names[k], "s user", t[k]);
        bench_row(b, names[k], "s user + system", with_system);
        bench_value(b, names[k], "bytes", peak[k]);
    }
    double sum = t[1].median + t[2].median + t[3].median;
    bench_value(b, "cmgen levels over kiln", "ratio", t[1].median / t[0].median);
    bench_value(b, "cmgen all over kiln", "ratio", sum / t[0].median);
    bench_bar(b, "time of cmgen's levels / time of kiln bake", t[1].median / t[0].median, "", 50,
              true);
    bench_bar(b, "time of all of cmgen / kiln bake (aim: 100)", sum / t[0].median, "", 50, true);
    return true;
}

// ------------------------------------------------------------------------------------------ memory

bool bench_memory(bench *b)
{
    char input[1024], output[1024];
    snprintf(input, sizeof input, "%s/city8k.exr", b->inputs);
    snprintf(output, sizeof output, "%s/memory.ktx2", b->inputs);
    const char *const command[] = {b->kiln, "bake", input, "-o", output, "--quiet", NULL};
    usage u;
    if (!run_command(b, command, &u))
        return false;
    remove(output);
    printf("  %-46s %10.2f s, %.2f s of CPU time\n", "kiln bake of 8192 x 4096, half EXR", u.wall,
           u.user);
    printf("  %-46s %10.0f MiB\n", "memory of the panorama's texels as floats",
           8192.0 * 4096 * 12 / 1048576);
    bench_value(b, "peak", "bytes", u.peak);
    bench_value(b, "user", "s", u.user);
    bench_bar(b, "peak memory of the process", u.peak / 1048576, "MiB", 160, false);
    return true;
}

// ------------------------------------------------------------------------------------------ stream

// What a child process does alone: loads a whole panorama and forgets it.
static int load_alone(const char *path)
{
    kiln_context *context = NULL;
    kiln_map map = {0};
    if (kiln_context_create(NULL, &context, NULL))
        return 1;
    int code = kiln_map_load(context, path, NULL, &map, NULL) != KILN_OK;
    kiln_map_free(&map);
    kiln_context_destroy(context);
    return code;
}

// Measures a process that only loads a file.
static bool measure_load(bench *b, const char *path, usage *u)
{
    double start = bench_wall();
    int status = 0;
    struct rusage r;
    pid_t child = fork();
    if (child == 0)
        _exit(load_alone(path));
    if (child < 0 || wait4(child, &status, 0, &r) != child || status)
        return bench_fail(b, "%s could not be loaded", path);
    *u = (usage){timeval_seconds(r.ru_utime), timeval_seconds(r.ru_stime), bench_wall() - start,
                 1024.0 * (double)r.ru_maxrss};
    return true;
}

// Measures the bake of one large file, and the loading of it if `loads`.
static bool stream_file(bench *b, const char *name, bool loads, double bound)
{
    char input[1024], output[1024], text[128];
    snprintf(input, sizeof input, "%s/%s", b->inputs, name);
    snprintf(output, sizeof output, "%s/stream.ktx2", b->inputs);
    const char *const command[] = {b->kiln,  "bake", input,     "-o", output,
                                   "--size", "512",  "--quiet", NULL};
    usage bake, load = {0};
    if (access(input, R_OK) != 0) {
        printf("  %-46s %10s\n", name, "is not there");
        return true;
    }
    if ((loads && !measure_load(b, input, &load)) || !run_command(b, command, &bake))
        return false;
    remove(output);
    printf("  %-30s bake  %7.2f s, %6.2f s of CPU time with the system's, %6.0f MiB\n", name,
           bake.wall, bake.user + bake.system, bake.peak / 1048576);
    if (loads)
        printf("  %-30s load  %7.2f s, %6.2f s of CPU time with the system's, %6.0f MiB\n", "",
               load.wall, load.user + load.system, load.peak / 1048576);
    snprintf(text, sizeof text, "%s: peak", name);
    bench_value(b, text, "bytes", bake.peak);
    bench_bar(b, text, bake.peak / 1048576, "MiB", bound, false);
    if (!loads)
        return true;
    double ratio = (bake.user + bake.system) / (load.user + load.system);
    snprintf(text, sizeof text, "%s: CPU time of the bake / of loading", name);
    bench_value(b, text, "ratio", ratio);
    snprintf(text, sizeof text, "%s: time of the bake / of loading", name);
    bench_value(b, text, "ratio", bake.wall / load.wall);
    bench_bar(b, text, bake.wall / load.wall, "", 1.3, false);
    return true;
}

bool bench_stream(bench *b)
{
    return stream_file(b, "city16k.exr", true, 400) &&
           stream_file(b, "city16k_piz.exr", true, 400) &&
           stream_file(b, "city16k.hdr", true, 400) && stream_file(b, "city32k.exr", false, 800);
}
