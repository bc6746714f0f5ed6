// One environment of a batch. In: a job and a thread with its context. Out: the files of the job,
// by the function that kiln bake runs, and their record; or nothing, if the files are what this
// bake would write.
#include "batch.h"

#include "batch_run.h"

#include <stdlib.h>
#include <string.h>

// Joins the paths of files for batch_job.read and .written; NULL if memory runs out.
static const char *keep_paths(batch *all, const batch_files *files)
{
    size_t size = 1;
    for (int i = 0; i < files->count; i++)
        size += strlen(files->file[i].path) + 1;
    os_lock(&all->output);
    char *paths = batch_keep(&all->store, size), *at = paths;
    os_unlock(&all->output);
    for (int i = 0; paths && i < files->count; i++) {
        size_t length = strlen(files->file[i].path) + 1;
        memcpy(at, files->file[i].path, length);
        at += length;
    }
    if (paths)
        *at = 0;
    return paths;
}

// The size of an input in texels, as its file says without being read; 0 if the file does not say.
typedef struct extent {
    int width, height;
    double file_bytes; // of all files of the input
} extent;

static extent find_extent(batch_worker *worker, const batch_record *record)
{
    extent found = {0};
    kiln_file_info *info = calloc(1, sizeof *info);
    kiln_error error;
    for (int i = 0; i < record->in.count; i++)
        found.file_bytes += (double)record->in.file[i].stamp.size;
    if (info && record->in.count &&
        kiln_file_describe(worker->context, record->in.file[0].path, info, &error) == KILN_OK) {
        found.width = info->width;
        found.height = info->height * record->in.count;
    }
    free(info);
    return found;
}

// A plan saves a tenth of the time of small bakes, and needs the whole picture in memory. From 4096
// x 2048 texels on, a bake whose rows pass by is as quick and holds a part of the picture.
static bool is_small(const extent *e)
{
    return (double)e->width * e->height < 4096.0 * 2048.0;
}

// A guess from above at the memory that a bake needs, until the first bake of its kind has told:
// the texels as floats and once more for what is made of them, or a part of the rows, the file, and
// the levels with the spectrum behind them.
static size_t guess_need(const extent *e, const bake *b)
{
    bool rows = !is_small(e) && b->tuning == BAKE_EXACT && b->sun == KILN_SUN_KEEP && !b->textbook;
    double bytes = 96e6 + 600.0 * b->size * b->size + e->file_bytes;
    bytes += e->width ? (rows ? 6.0 : 40.0) * e->width * e->height : 8 * e->file_bytes;
    return bytes < (double)(SIZE_MAX / 2) ? (size_t)bytes : SIZE_MAX / 2;
}

// Bakes with the share of the memory that the bake may need, or, if it needs more and `alone`, with
// all of it.
static int bake_once(batch_worker *worker, const batch_job *job, batch_record *record, bake *b,
                     bool alone)
{
    batch *all = worker->batch;
    int code = batch_job_bake(job, b);
    if (code != CLI_GO)
        return code;
    extent source = find_extent(worker, record);
    b->plan_key = batch_plan_key(job);
    size_t bytes = alone ? all->limit
                         : batch_pool_need(all, b->plan_key, source.width, source.height,
                                           guess_need(&source, b));
    batch_pool_enter(worker, bytes, alone);
    b->work = (cli_work){
        .context = worker->context, .quiet = all->quiet, .hold = batch_hold, .hold_user = all};
    b->quiet = all->quiet;
    b->plan = is_small(&source) ? &worker->plan : NULL;
    b->watch = batch_record_watch;
    b->watch_user = record;
    b->report = all->json ? batch_report_bake : NULL;
    // What the thread keeps from bakes of another kind is of no use to this one.
    if (!b->plan || worker->plan.key != b->plan_key) {
        bake_plan_free(&worker->plan);
        batch_heap_trim(&worker->heap);
    }
    batch_heap_mark(&worker->heap);
    batch_record_restart(record);
    worker->work = &b->work;
    code = cli_interrupted() ? CLI_FAILED : bake_in_context(b);
    worker->work = NULL;
    if (code == CLI_DONE)
        batch_pool_needed(all, b->plan_key, source.width, source.height, worker->heap.peak);
    batch_pool_leave(worker, bytes, alone);
    return code;
}

static bool make_folders(batch *all, const batch_job *job, kiln_error *error)
{
    bool good = true;
    int made = 0;
    for (int i = 0; i < BATCH_PATHS && good; i++)
        good = !job->path[i] || cli_make_folders(job->path[i], true, &made, error);
    atomic_fetch_add(&all->folders, made);
    return good;
}

static void bake_job(batch_worker *worker, batch_job *job, batch_record *record, bake *b)
{
    batch_record_inputs(record);
    int code = CLI_FAILED;
    if (make_folders(worker->batch, job, &b->work.error))
        code = bake_once(worker, job, record, b, false);
    if (code == CLI_FAILED && b->work.error.result == KILN_ERROR_MEMORY && !cli_interrupted())
        code = bake_once(worker, job, record, b, true);
    if (code == CLI_DONE)
        batch_record_write(record);
    if (code == CLI_DONE || !cli_interrupted())
        job->outcome = code == CLI_DONE ? BATCH_BAKED : BATCH_FAILED;
}

void batch_run_job(batch_worker *worker, batch_job *job)
{
    batch *all = worker->batch;
    batch_record record;
    bake *b = calloc(1, sizeof *b);
    batch_record_begin(&record, job);
    batch_reason reason = all->force ? BATCH_ALWAYS : batch_record_compare(&record, all->dry_run);
    if (!b)
        job->outcome = BATCH_FAILED;
    else if (reason == BATCH_UNCHANGED)
        job->outcome = BATCH_KEPT;
    else if (all->dry_run)
        job->outcome = BATCH_DUE;
    else
        bake_job(worker, job, &record, b);
    job->read = keep_paths(all, &record.in);
    job->written = keep_paths(all, &record.out);
    batch_report_job(all, job, reason,
                     b && b->work.error.message[0] ? b->work.error.message : "out of memory");
    batch_record_free(&record);
    free(b);
}
