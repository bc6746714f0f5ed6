// The threads of a batch. In: jobs. Out: each job was run once, in the order given, on one thread a
// core and some more, which work while others wait for the disk. Method: each thread reads, bakes
// and writes one environment after the other with a context of its own. A thread without a job
// helps with the loops of the others' contexts (kiln_context_def.parallel_for), so that the last
// environments, and those that are so large that few fit into the memory, use all cores too.
#include "batch.h"
#include "os.h"

#include <stdlib.h>

// ------------------------------------------------------------------------------------------- loops

static void take_indices(batch_loop *loop)
{
    for (;;) {
        int index = atomic_fetch_add(&loop->next, 1);
        if (index >= loop->count)
            return;
        loop->task(loop->data, index);
    }
}

// Finds a loop that has indices left. The caller holds the mutex.
static batch_loop *find_loop(batch *all)
{
    batch_loop *loop = all->loop;
    while (loop && atomic_load(&loop->next) >= loop->count)
        loop = loop->below;
    return loop;
}

// Waits for a change, or helps with a loop of another thread meanwhile. The caller holds the mutex.
static void help_or_wait(batch *all)
{
    batch_loop *loop = find_loop(all);
    if (!loop) {
        atomic_fetch_add(&all->idle, 1);
        os_wait(&all->changed, &all->mutex);
        atomic_fetch_sub(&all->idle, 1);
        return;
    }
    loop->helpers++;
    os_unlock(&all->mutex);
    take_indices(loop);
    os_lock(&all->mutex);
    if (--loop->helpers == 0)
        os_wake_all(&all->changed);
}

// The function parallel_for of the contexts.
static void run_loop(void *user, int count, void (*task)(void *data, int index), void *data)
{
    batch *all = user;
    batch_loop loop = {.task = task, .data = data, .count = count};
    bool shared = count > 1 && atomic_load(&all->idle) > 0;
    if (shared) {
        os_lock(&all->mutex);
        loop.below = all->loop;
        all->loop = &loop;
        os_wake_all(&all->changed);
        os_unlock(&all->mutex);
    }
    take_indices(&loop);
    if (!shared)
        return;
    os_lock(&all->mutex);
    batch_loop **at = &all->loop;
    while (*at != &loop)
        at = &(*at)->below;
    *at = loop.below;
    while (loop.helpers)
        os_wait(&all->changed, &all->mutex);
    os_unlock(&all->mutex);
}

// ------------------------------------------------------------------------------------------ memory

// Frees what a thread keeps for its next bake, which may be what another thread waits for. The
// caller holds the mutex, which is unlocked meanwhile.
static void trim(batch_worker *worker)
{
    batch *all = worker->batch;
    if (!worker->keeps)
        return;
    os_unlock(&all->mutex);
    bake_plan_free(&worker->plan);
    batch_heap_trim(&worker->heap);
    os_lock(&all->mutex);
    worker->keeps = false;
    all->keepers--;
    os_wake_all(&all->changed);
}

static bool fits(const batch *all, size_t bytes, bool alone)
{
    if (all->alone || (alone && (all->baking || all->keepers)))
        return false;
    return !all->baking || (bytes <= all->limit && all->promised <= all->limit - bytes);
}

void batch_pool_enter(batch_worker *worker, size_t bytes, bool alone)
{
    batch *all = worker->batch;
    os_lock(&all->mutex);
    unsigned ticket = all->ticket++;
    if (alone)
        trim(worker);
    while (ticket != all->served || !fits(all, bytes, alone)) {
        if (worker->keeps)
            trim(worker);
        else
            help_or_wait(all);
    }
    all->served++;
    all->keepers += !worker->keeps;
    worker->keeps = true;
    all->baking++;
    all->promised += bytes;
    all->alone = alone;
    os_wake_all(&all->changed);
    os_unlock(&all->mutex);
}

void batch_pool_leave(batch_worker *worker, size_t bytes, bool alone)
{
    batch *all = worker->batch;
    os_lock(&all->mutex);
    all->baking--;
    all->promised -= bytes;
    all->alone = all->alone && !alone;
    os_wake_all(&all->changed);
    os_unlock(&all->mutex);
}

static batch_need *find_need(batch *all, uint64_t key, int width, int height)
{
    for (int i = 0; i < all->need_count; i++)
        if (all->need[i].key == key && all->need[i].width == width && all->need[i].height == height)
            return &all->need[i];
    return NULL;
}

size_t batch_pool_need(batch *all, uint64_t key, int width, int height, size_t guess)
{
    os_lock(&all->mutex);
    const batch_need *need = find_need(all, key, width, height);
    size_t bytes = need ? need->bytes + need->bytes / 8 : guess;
    os_unlock(&all->mutex);
    return bytes;
}

void batch_pool_needed(batch *all, uint64_t key, int width, int height, size_t bytes)
{
    os_lock(&all->mutex);
    batch_need *need = find_need(all, key, width, height);
    if (!need && all->need_count < BATCH_NEEDS) {
        need = &all->need[all->need_count++];
        *need = (batch_need){.key = key, .width = width, .height = height};
    }
    if (need && need->bytes < bytes)
        need->bytes = bytes;
    os_unlock(&all->mutex);
}

// --------------------------------------------------------------------------------------- workers

// Returns the next job, or NULL when all jobs have ended. Helps other threads before that.
static batch_job *take_job(batch_worker *worker)
{
    batch *all = worker->batch;
    batch_job *job = NULL;
    os_lock(&all->mutex);
    for (;;) {
        bool more = all->next < all->jobs.count && !all->stopped && !cli_interrupted();
        if (more) {
            job = &all->jobs.job[all->next++];
            all->busy++;
        }
        if (more || !all->busy)
            break;
        if (worker->keeps)
            trim(worker);
        else
            help_or_wait(all);
    }
    os_unlock(&all->mutex);
    return job;
}

typedef struct run {
    batch *all;
    void (*job)(batch_worker *worker, batch_job *job);
} run;

typedef struct start {
    batch_worker *worker;
    const run *run;
} start;

static void work(void *data)
{
    start *s = data;
    batch_worker *worker = s->worker;
    batch *all = worker->batch;
    for (batch_job *job; (job = take_job(worker)) != NULL;) {
        s->run->job(worker, job);
        os_lock(&all->mutex);
        all->busy--;
        all->stopped = all->stopped || (job->outcome == BATCH_FAILED && !all->keep_going);
        os_wake_all(&all->changed);
        os_unlock(&all->mutex);
    }
    os_lock(&all->mutex);
    all->alive--;
    os_wake_all(&all->ended);
    os_unlock(&all->mutex);
}

static bool go_on(void *user, const char *stage, double fraction)
{
    const batch_worker *worker = user;
    return worker->work ? cli_progress(worker->work, stage, fraction) : !cli_interrupted();
}

static bool begin_worker(batch_worker *worker, batch *all, kiln_error *error)
{
    worker->batch = all;
    batch_heap_begin(&worker->heap, all);
    const kiln_context_def def = {
        .allocate = batch_allocate,
        .release = batch_release,
        .allocator_user = &worker->heap,
        .memory_limit = all->limit,
        .thread_count = all->threads,
        .parallel_for = run_loop,
        .parallel_user = all,
        .progress = go_on,
        .progress_user = worker,
    };
    return kiln_context_create(&def, &worker->context, error) == KILN_OK;
}

static void end_worker(batch_worker *worker)
{
    bake_plan_free(&worker->plan);
    kiln_context_destroy(worker->context);
    batch_heap_end(&worker->heap);
}

typedef struct starting {
    const run *run;
    start *start;
    int count; // threads that run
} starting;

// Starts the threads, as many as the system allows.
static void start_threads(void *user)
{
    starting *s = user;
    batch *all = s->run->all;
    for (int i = 0; i < all->worker_count; i++) {
        s->start[i] = (start){&all->worker[i], s->run};
        if (!os_thread_start(&all->worker[i].thread, work, &s->start[i]))
            break;
        s->count++;
    }
}

static void run_workers(batch *all, const run *r, start *starts, void (*tick)(batch *all))
{
    starting s = {.run = r, .start = starts};
    os_lock(&all->mutex);
    os_without_signals(start_threads, &s);
    all->alive = s.count;
    while (all->alive) {
        os_wait_for(&all->ended, &all->mutex, 100);
        if (cli_interrupted())
            os_wake_all(&all->changed);
        os_unlock(&all->mutex);
        tick(all);
        os_lock(&all->mutex);
    }
    os_unlock(&all->mutex);
    for (int i = 0; i < s.count; i++)
        os_thread_join(&all->worker[i].thread);
    all->worker_count = s.count;
}

int batch_pool_run(batch *all, void (*job)(batch_worker *worker, batch_job *job),
                   void (*tick)(batch *all))
{
    const run r = {all, job};
    kiln_error error = {0};
    int made = 0, wanted = all->threads + (all->threads + 3) / 4;
    if ((size_t)wanted > all->jobs.count)
        wanted = (size_t)all->threads > all->jobs.count ? all->threads : (int)all->jobs.count;
    all->worker = calloc((size_t)wanted, sizeof *all->worker);
    start *starts = calloc((size_t)wanted, sizeof *starts);
    bool good = all->worker && starts;
    while (good && made < wanted)
        good = begin_worker(&all->worker[made++], all, &error);
    all->worker_count = made;
    if (good)
        run_workers(all, &r, starts, tick);
    for (int i = 0; i < made; i++)
        end_worker(&all->worker[i]);
    free(starts);
    free(all->worker);
    if (!good)
        return cli_fail("%s", error.message[0] ? error.message : "out of memory");
    return all->worker_count ? CLI_GO : cli_fail("the system starts no thread");
}
