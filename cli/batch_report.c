// What kiln batch prints: a line for each environment, the progress, the summary; and the files
// that tell make and ninja what the outputs were made from.
#include "batch.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 60 };

static const char *const reasons[] = {
    [BATCH_UNCHANGED] = "nothing has changed",
    [BATCH_NO_RECORD] = "there is no record of an earlier bake",
    [BATCH_OTHER_VERSION] = "another version of kiln baked it",
    [BATCH_OTHER_OPTIONS] = "the options have changed",
    [BATCH_OTHER_INPUT] = "the input has changed",
    [BATCH_OTHER_OUTPUT] = "a written file is missing or has changed",
    [BATCH_ALWAYS] = "--force is given",
};

static void clear_line(batch *all)
{
    if (all->drawn > 0)
        fprintf(stderr, "\r%*s\r", WIDTH, "");
    all->drawn = 0;
}

void batch_hold(void *user, bool begins)
{
    batch *all = user;
    if (!begins) {
        fflush(stdout); // a batch that is killed has reported what it has baked
        os_unlock(&all->output);
        return;
    }
    os_lock(&all->output);
    clear_line(all);
}

// The time that is left, if the environments to come are like those that were baked so far. Kept
// environments take no time.
static double seconds_left(const batch *all, double now)
{
    double left = all->weight - all->done_weight;
    return all->worked_weight > 0 ? (now - all->began) * left / all->worked_weight : -1;
}

void batch_draw(batch *all)
{
    double now = os_seconds();
    os_lock(&all->output);
    bool due = all->on_terminal && now - all->began > 0.5 && now - all->drawn > 0.1;
    if (due && !cli_interrupted()) {
        char line[128], left[40] = "";
        double seconds = seconds_left(all, now);
        if (seconds >= 0)
            snprintf(left, sizeof left, seconds < 90 ? ", %.0f s left" : ", %.0f min left",
                     seconds < 90 ? seconds : seconds / 60);
        snprintf(line, sizeof line, "kiln: %zu of %zu environments%s", all->done, all->jobs.count,
                 left);
        fprintf(stderr, "\r%-*.*s", WIDTH, WIDTH, line);
        all->drawn = now;
    }
    os_unlock(&all->output);
}

static void print_files(json *j, const char *key, const char *files)
{
    json_array(j, key);
    for (const char *at = files; at && *at; at += strlen(at) + 1)
        json_text(j, NULL, at);
    json_end(j);
}

static const char *outcome_word(batch_outcome outcome)
{
    static const char *const words[] = {[BATCH_WAITS] = "stopped",
                                        [BATCH_KEPT] = "kept",
                                        [BATCH_DUE] = "due",
                                        [BATCH_BAKED] = "baked",
                                        [BATCH_FAILED] = "failed"};
    return words[outcome];
}

void batch_report_bake(bake *b)
{
    json j = {.line = true};
    cli_hold_output(&b->work, true);
    json_object(&j, NULL);
    json_text(&j, "outcome", outcome_word(BATCH_BAKED));
    bake_report_members(b, &j);
    json_end(&j);
    cli_hold_output(&b->work, false);
}

void batch_report_job(batch *all, const batch_job *job, batch_reason reason, const char *problem)
{
    batch_hold(all, true);
    all->done += job->outcome != BATCH_WAITS;
    if (job->outcome == BATCH_BAKED)
        all->worked_weight += job->weight;
    if (job->outcome != BATCH_WAITS)
        all->done_weight += job->weight;
    if (all->json && job->outcome == BATCH_FAILED)
        cli_fail("%s", problem);
    if (all->json && job->outcome != BATCH_BAKED && job->outcome != BATCH_WAITS) {
        json j = {.line = true};
        json_object(&j, NULL);
        json_text(&j, "outcome", outcome_word(job->outcome));
        json_text(&j, "output", job->path[0]);
        if (job->outcome == BATCH_DUE)
            json_text(&j, "reason", reasons[reason]);
        if (job->outcome == BATCH_FAILED)
            json_text(&j, "error", problem);
        if (job->outcome == BATCH_KEPT) {
            print_files(&j, "read", job->read);
            print_files(&j, "written", job->written);
        }
        json_end(&j);
    } else if (job->outcome == BATCH_DUE && !all->quiet && !all->json) {
        printf("%s: to be baked, %s\n", cli_show(job->path[0]).text, reasons[reason]);
    } else if (job->outcome == BATCH_FAILED) {
        cli_fail("%s", problem);
    }
    batch_hold(all, false);
}

// ----------------------------------------------------------------------------------------- summary

typedef struct counts {
    size_t of[BATCH_FAILED + 1];
} counts;

static counts count_outcomes(const batch *all)
{
    counts c = {{0}};
    for (size_t i = 0; i < all->jobs.count; i++)
        c.of[all->jobs.job[i].outcome]++;
    return c;
}

static void print_json(const batch *all, const counts *c, double seconds, double cpu)
{
    json j = {.line = true};
    json_object(&j, NULL);
    json_object(&j, "summary");
    json_text(&j, "kiln", kiln_version());
    json_number(&j, "shard", all->shard + 1);
    json_number(&j, "shards", all->shard_count);
    json_number(&j, "environments", (double)all->jobs.count);
    for (int i = BATCH_WAITS; i <= BATCH_FAILED; i++)
        json_number(&j, outcome_word((batch_outcome)i), (double)c->of[i]);
    json_number(&j, "folders", atomic_load(&all->folders));
    json_rounded(&j, "seconds", seconds, 6);
    json_rounded(&j, "cpu_seconds", cpu, 6);
    json_number(&j, "threads", all->threads);
    json_number(&j, "memory_limit", (double)all->limit);
    json_number(&j, "peak_memory", os_peak_memory());
    json_end(&j);
    json_end(&j);
}

static void print_words(const batch *all, const counts *c, double seconds, double cpu)
{
    char memory[32], shard[48] = "";
    size_t count = all->jobs.count;
    if (all->shard_count > 1)
        snprintf(shard, sizeof shard, "shard %d of %d: ", all->shard + 1, all->shard_count);
    printf("%s%zu environment%s: ", shard, count, count == 1 ? "" : "s");
    if (all->dry_run)
        printf("%zu to be baked", c->of[BATCH_DUE]);
    else
        printf("%zu baked", c->of[BATCH_BAKED]);
    printf(", %zu kept", c->of[BATCH_KEPT]);
    if (c->of[BATCH_FAILED])
        printf(", %zu failed", c->of[BATCH_FAILED]);
    if (c->of[BATCH_WAITS])
        printf(", %zu not begun", c->of[BATCH_WAITS]);
    int folders = atomic_load(&all->folders);
    if (folders)
        printf(", %d folder%s created", folders, folders == 1 ? "" : "s");
    printf("; %.2f s, %.2f s of CPU time (%.0f %% of %d core%s), %s at most\n", seconds, cpu,
           seconds > 0 ? 100 * cpu / (seconds * all->threads) : 0, all->threads,
           all->threads == 1 ? "" : "s", cli_bytes(os_peak_memory(), memory));
}

int batch_report_end(batch *all)
{
    counts c = count_outcomes(all);
    double seconds = os_seconds() - all->began, cpu = os_cpu_seconds() - all->cpu_began;
    os_lock(&all->output);
    clear_line(all);
    os_unlock(&all->output);
    if (all->json)
        print_json(all, &c, seconds, cpu);
    else if (!all->quiet)
        print_words(all, &c, seconds, cpu);
    if (cli_interrupted())
        return 128 + os_signal();
    return c.of[BATCH_FAILED] || c.of[BATCH_WAITS] ? CLI_FAILED : CLI_DONE;
}

// ----------------------------------------------------------------------------------------- depfile

// Writes a path as make and ninja read it: a blank, # and \ with a backslash before, $ doubled.
static void write_path(FILE *file, const char *path)
{
    for (; *path; path++) {
        if (strchr(" #\\", *path))
            putc('\\', file);
        if (*path == '$')
            putc('$', file);
        putc(*path, file);
    }
}

static void write_next(FILE *file, const char *path)
{
    fputs(" \\\n  ", file);
    write_path(file, path);
}

static void write_files(FILE *file, const char *files)
{
    for (const char *at = files; at && *at; at += strlen(at) + 1)
        write_next(file, at);
}

static int cannot_write(const char *path)
{
    return cli_fail("%s: cannot be written: %s", path, strerror(errno));
}

// The target is the file of --stamp, else every file that was written. With a stamp, which is newer
// than what the batch wrote, the target also depends on folders whose pictures are inputs.
static int write_rule(const batch *all)
{
    FILE *file = os_create_file(all->depfile);
    if (!file)
        return cannot_write(all->depfile);
    if (all->stamp)
        write_path(file, all->stamp);
    for (size_t i = 0; i < all->jobs.count && !all->stamp; i++)
        write_files(file, all->jobs.job[i].written);
    fputs(":", file);
    for (int i = 0; i < all->arguments.rest_count; i++)
        if (os_kind_of(all->arguments.rest[i]) == OS_FILE)
            write_next(file, all->arguments.rest[i]);
    for (const batch_folder *f = all->stamp ? all->jobs.folder : NULL; f; f = f->below)
        write_next(file, f->path);
    for (size_t i = 0; i < all->jobs.count; i++)
        write_files(file, all->jobs.job[i].read);
    putc('\n', file);
    bool good = !ferror(file);
    return fclose(file) == 0 && good ? CLI_GO : cannot_write(all->depfile);
}

int batch_write_depfile(const batch *all)
{
    int code = all->depfile ? write_rule(all) : CLI_GO;
    if (code != CLI_GO || !all->stamp)
        return code;
    FILE *file = os_create_file(all->stamp);
    return file && fclose(file) == 0 ? CLI_GO : cannot_write(all->stamp);
}
