// The command kiln batch: reads the options, makes jobs of the manifest's lines or of the words,
// and runs them.
#include "batch_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AT(field) offsetof(batch, field)

static const cli_option options[] = {
    {"dry-run", CLI_FLAG, AT(dry_run), .letter = 'n', .group = "Which environments",
     .help = "print what would be baked and why, and bake nothing"},
    {"force", CLI_FLAG, AT(force), .help = "bake every environment, changed or not"},
    {"shard", CLI_TEXT, AT(shard_text), .value = "I/N",
     .help = "bake only the environments number I, I + N, I + 2 N, ... of the list, I being 1 to "
             "N; N machines with the same list and different I bake the whole list",
     .unset = "1/1"},
    {"keep-going", CLI_FLAG, AT(keep_going), .letter = 'k',
     .help = "begin further environments after one has failed; the exit code is 1 all the same"},
    {"threads", CLI_INTEGER, AT(threads), 1, 256, 0, "N", .letter = 'j', .group = "Work and report",
     .help = "number of cores to use; the files are the same for every number",
     .unset = "all that the process may use"},
    {"memory", CLI_INTEGER, AT(memory), 64, 1 << 24, 0, "MIB",
     .help = "MiB that all bakes together may hold; a bake waits until its share is free, and the "
             "cores that no other bake uses work for those that run",
     .unset = "three quarters of what the process may use"},
    {"depfile", CLI_FILE, AT(depfile), .value = "FILE",
     .help = "write a rule for make and ninja: the written files depend on the files that were "
             "read"},
    {"stamp", CLI_FILE, AT(stamp), .value = "FILE",
     .help = "write an empty file when everything is baked, which is the target of --depfile "
             "then"},
    {"json", CLI_FLAG, AT(json),
     .help = "report as JSON on standard output: a line for each environment, and a line with the "
             "summary"},
    {"quiet", CLI_FLAG, AT(quiet), .letter = 'q', .help = "print nothing but errors"},
    {.name = NULL},
};

static bool is_manifest(const char *word)
{
    static const char *const endings[] = {".jsonl", ".ndjson", ".json"};
    size_t size = strlen(word);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        size_t length = strlen(endings[i]);
        if (size > length && !strcmp(word + size - length, endings[i]))
            return true;
    }
    return !strcmp(word, "-");
}

// Reads I/N as a shard number from 0 and a number of shards.
static int read_shard(batch *all)
{
    int used = 0;
    all->shard_count = 1;
    if (!all->shard_text)
        return CLI_GO;
    if (sscanf(all->shard_text, "%9d/%9d%n", &all->shard, &all->shard_count, &used) != 2 ||
        all->shard_text[used] || all->shard < 1 || all->shard > all->shard_count)
        return cli_wrong(all->arguments.command,
                         "--shard is '%s', it must be I/N with I from 1 to N, such as 1/4",
                         all->shard_text);
    all->shard--;
    return CLI_GO;
}

static int add_lines(batch *all)
{
    const cli_arguments *a = &all->arguments;
    int code = CLI_GO, manifests = 0;
    for (int i = 0; i < a->rest_count; i++)
        manifests += is_manifest(a->rest[i]);
    if (!a->rest_count)
        return cli_wrong(a->command, "no input is named, name a manifest, folders or pictures");
    if (manifests && manifests < a->rest_count)
        return cli_wrong(a->command, "manifests and pictures cannot be mixed, name either");
    if (!manifests)
        return batch_add_words(&all->store, a->rest, a->rest_count, a->also, &all->lines);
    for (int i = 0; i < a->rest_count && code == CLI_GO; i++)
        code = batch_add_manifest(&all->store, a->rest[i], a->also, &all->lines);
    return code;
}

// Keeps the jobs of the shard, and checks their options.
static int take_shard(batch *all)
{
    size_t count = 0;
    int code = CLI_GO;
    bake *b = malloc(sizeof *b);
    if (!b)
        return cli_fail("out of memory");
    for (size_t i = 0; i < all->jobs.count && code == CLI_GO; i++) {
        if (i % (size_t)all->shard_count != (size_t)all->shard)
            continue;
        batch_job *job = &all->jobs.job[i];
        os_stamp stamp;
        code = batch_job_bake(job, b);
        // A small panorama costs about what 2 MB more of a larger one's file do.
        job->weight = 2e6 + (os_stamp_of(job->input[0], &stamp) ? (double)stamp.size : 0);
        all->weight += job->weight;
        all->jobs.job[count++] = *job;
    }
    all->jobs.count = count;
    free(b);
    return code;
}

static int make_jobs(batch *all)
{
    int code = read_shard(all);
    if (code == CLI_GO)
        code = add_lines(all);
    if (code == CLI_GO)
        code = batch_make_jobs(&all->store, &all->lines, &all->jobs);
    if (code == CLI_GO)
        code = batch_check_files(&all->jobs);
    return code == CLI_GO ? take_shard(all) : code;
}

static int run_jobs(batch *all)
{
    size_t most = cli_memory_limit();
    all->limit = most ? most / 4 * 3 : SIZE_MAX / 2;
    if (all->memory)
        all->limit =
            (size_t)all->memory < SIZE_MAX >> 20 ? (size_t)all->memory << 20 : SIZE_MAX / 2;
    all->threads = all->threads ? all->threads : os_core_count();
    all->threads = all->threads > 256 ? 256 : all->threads;
    all->on_terminal = !all->quiet && os_is_terminal(OS_ERRORS);
    all->began = os_seconds();
    all->cpu_began = os_cpu_seconds();
    os_catch_signals();
    int code = all->jobs.count ? batch_pool_run(all, batch_run_job, batch_draw) : CLI_GO;
    if (code == CLI_GO)
        code = batch_report_end(all);
    if (code == CLI_DONE && !all->dry_run && batch_write_depfile(all) != CLI_GO)
        code = CLI_FAILED;
    return code;
}

static int run(const cli_call *call)
{
    batch *all = calloc(1, sizeof *all);
    if (!all)
        return cli_fail("out of memory");
    os_mutex_begin(&all->mutex);
    os_mutex_begin(&all->output);
    os_condition_begin(&all->changed);
    os_condition_begin(&all->ended);
    int code = cli_read_arguments(&all->arguments, &cli_batch, call, all);
    if (code == CLI_GO)
        code = make_jobs(all);
    if (code == CLI_GO)
        code = run_jobs(all);
    os_condition_end(&all->ended);
    os_condition_end(&all->changed);
    os_mutex_end(&all->output);
    os_mutex_end(&all->mutex);
    free(all->jobs.job);
    free(all->lines.line);
    batch_store_free(&all->store);
    free(all);
    return code;
}

static const cli_example examples[] = {
    {"kiln batch library.jsonl", "bakes what has changed since the last run"},
    {"kiln batch hdris/ -o 'out/{name}.ktx2' --for three",
     "the pictures of a folder, each to a file of its own"},
    {"kiln batch library.jsonl --dry-run", "says what would be baked, and why"},
    {"kiln batch library.jsonl --shard 3/16 --keep-going",
     "the third of sixteen parts, for one of sixteen machines"},
    {NULL, NULL}};

const cli_command cli_batch = {
    .name = "batch",
    .arguments = "MANIFEST... [OPTION...] | IN... -o OUT [OPTION...]",
    .summary = "Bakes many environments, and later those that have changed.",
    .about =
        "MANIFEST is a file of JSON lines (.jsonl, .ndjson or .json, or - for standard input). A "
        "line is an object with \"input\", \"output\" and any other option of kiln bake by its "
        "name, such as {\"input\": \"city.exr\", \"output\": \"city.ktx2\", \"for\": \"three\", "
        "\"sh-bands\": 3}. Options of kiln bake on the command line hold for all lines that do not "
        "have them. IN is a picture, a pattern such as 'in/*.hdr', or a folder, which stands for "
        "the pictures in it; OUT then holds {name}, as for kiln bake. Folders of outputs that are "
        "missing are created.\n\nFiles are those of kiln "
        "bake, byte for byte. What was baked is recorded in a folder .kiln next to each output: "
        "environments whose inputs, options and outputs have not changed since are kept, by the "
        "content of the files and not by their times.",
    .more = "A path is relative to the current folder. \"input\" may be a list: of the six faces "
            "of a cube, or of several pictures if \"output\" holds {name}. The values true, false "
            "and null give an option or take away one that the command line gives; a list of "
            "numbers stands for numbers with commas between.\n\nAll environments are checked "
            "before the first is baked. A batch that is killed leaves whole files only; the same "
            "command then bakes what is missing. If a batch takes longer than half a second and "
            "standard error is a terminal, a line shows how many environments are done and the "
            "time that is left.",
    .examples = examples,
    .options = options,
    .also = &cli_bake,
    .takes = bake_changes_files,
    .run = run,
};
