// Threads that wait for work. In: a task and a number of indices. Out: the task has been run once
// for every index. Method: each thread takes the next index from an atomic counter. Which thread
// runs an index is left to chance, but what the task does for an index does not depend on its
// thread.
#include "base/base.h"
#include "base/context.h"

static void take_all(ki_pool *pool)
{
    for (;;) {
        int index = atomic_fetch_add(&pool->next, 1);
        if (index >= pool->count)
            return;
        pool->task(pool->data, index);
    }
}

static void thread_main(void *data)
{
    ki_pool *pool = data;
    unsigned seen = 0;
    ki_os_lock(&pool->mutex);
    for (;;) {
        while (pool->round == seen && !pool->stop)
            ki_os_wait(&pool->work, &pool->mutex);
        if (pool->stop)
            break;
        seen = pool->round;
        ki_os_unlock(&pool->mutex);
        take_all(pool);
        ki_os_lock(&pool->mutex);
        if (--pool->running == 0)
            ki_os_wake_one(&pool->done);
    }
    ki_os_unlock(&pool->mutex);
}

int ki_threads_start(kiln_context *context)
{
    ki_pool *pool = &context->pool;
    ki_os_mutex_begin(&pool->mutex);
    ki_os_condition_begin(&pool->work);
    ki_os_condition_begin(&pool->done);
    pool->helper = (ki_os_work){thread_main, pool};
    while (pool->thread_count + 1 < context->def.thread_count &&
           ki_os_thread_start(&pool->thread[pool->thread_count], &pool->helper))
        pool->thread_count++;
    return pool->thread_count + 1;
}

void ki_threads_stop(kiln_context *context)
{
    ki_pool *pool = &context->pool;
    ki_os_lock(&pool->mutex);
    pool->stop = true;
    ki_os_wake_all(&pool->work);
    ki_os_unlock(&pool->mutex);
    for (int i = 0; i < pool->thread_count; i++)
        ki_os_thread_join(&pool->thread[i]);
    ki_os_condition_end(&pool->done);
    ki_os_condition_end(&pool->work);
    ki_os_mutex_end(&pool->mutex);
}

// Waits until the helper threads have finished. Meanwhile asks the caller of the library now and
// then whether to go on if `asker` is not NULL.
static void wait_for_helpers(ki_pool *pool, const ki_asker *asker)
{
    ki_os_lock(&pool->mutex);
    while (pool->running) {
        if (!asker || ki_was_stopped(asker)) {
            ki_os_wait(&pool->done, &pool->mutex);
            continue;
        }
        ki_os_wait_briefly(&pool->done, &pool->mutex);
        bool waits = pool->running > 0;
        ki_os_unlock(&pool->mutex);
        if (waits)
            (void)ki_may_go_on(asker);
        ki_os_lock(&pool->mutex);
    }
    ki_os_unlock(&pool->mutex);
}

static void run_on_pool(ki_pool *pool, const ki_asker *asker, int count, ki_task *task, void *data)
{
    ki_os_lock(&pool->mutex);
    pool->task = task;
    pool->data = data;
    pool->count = count;
    atomic_store(&pool->next, 0);
    pool->running = pool->thread_count;
    pool->round++;
    ki_os_wake_all(&pool->work);
    ki_os_unlock(&pool->mutex);
    take_all(pool);
    wait_for_helpers(pool, asker);
}

static void run(kiln_context *context, const ki_asker *asker, int count, ki_task *task, void *data)
{
    ki_pool *pool = &context->pool;
    bool own = !context->def.parallel_for;
    // The helper threads are busy if a progress callback, which the library calls during a task,
    // calls the library again. The calling thread then does the work alone.
    if (pool->in_use || (own && (pool->thread_count == 0 || count < 2))) {
        for (int i = 0; i < count; i++)
            task(data, i);
        return;
    }
    pool->caller = ki_os_this_thread();
    pool->depth = context->depth;
    pool->in_use = true;
    if (own)
        run_on_pool(pool, asker, count, task, data);
    else if (!asker || ki_may_go_on(asker))
        context->def.parallel_for(context->def.parallel_user, count, task, data);
    pool->in_use = false;
}

void ki_parallel_for(kiln_context *context, int count, ki_task *task, void *data)
{
    run(context, NULL, count, task, data);
}

// Longest time in seconds between two progress reports, unless one task takes longer. A caller can
// therefore stop the work within this time.
static const double silence = 0.05;

typedef struct workers {
    ki_asker asker;
    void (*task)(void *data, int worker, int index);
    void *data;
    int count;
    double asked; // time of the last progress report, in seconds
    atomic_int next;
} workers;

// Asks the caller of the library whether to go on, on the thread of the caller, from time to time.
static void ask(workers *w)
{
    if (!ki_is_caller(w->asker.context) || ki_os_seconds() < w->asked + silence)
        return;
    (void)ki_may_go_on(&w->asker);
    w->asked = ki_os_seconds();
}

static void work(void *data, int worker)
{
    workers *w = data;
    while (!ki_was_stopped(&w->asker)) {
        int index = atomic_fetch_add(&w->next, 1);
        if (index >= w->count)
            return;
        w->task(w->data, worker, index);
        if (w->asker.context->def.progress)
            ask(w);
    }
}

bool ki_parallel_workers(kiln_context *context, int count,
                         void (*task)(void *data, int worker, int index), void *data)
{
    workers w = {.asker = ki_asker_make(context),
                 .task = task,
                 .data = data,
                 .count = count,
                 .asked = ki_os_seconds()};
    run(context, context->def.progress ? &w.asker : NULL, ki_min(context->def.thread_count, count),
        work, &w);
    return !ki_was_stopped(&w.asker);
}

typedef struct steps {
    ki_asker asker;
    ki_task *task;
    void *data;
    const ki_progress_range *range;
    int count, told;
    double asked; // time of the last progress report, in seconds
    atomic_int done;
} steps;

enum { REPORTS = 64 };

static void step(void *data, int index)
{
    steps *s = data;
    if (ki_was_stopped(&s->asker))
        return;
    s->task(s->data, index);
    double part = (double)(atomic_fetch_add(&s->done, 1) + 1) / s->count;
    kiln_context *context = s->asker.context;
    if (!ki_is_caller(context) || ki_was_stopped(&s->asker) ||
        (part * REPORTS < s->told + 1 && ki_os_seconds() < s->asked + silence))
        return;
    s->told = (int)(part * REPORTS);
    s->asked = ki_os_seconds();
    const ki_progress_range *at = s->range;
    if (at)
        (void)ki_progress(context, at->name, at->from + part * (at->to - at->from));
    else
        (void)ki_go_on(context);
}

bool ki_parallel_steps(kiln_context *context, const ki_progress_range *range, int count,
                       ki_task *task, void *data)
{
    if (!context->def.progress || count < 2) {
        ki_parallel_for(context, count, task, data);
        return true;
    }
    steps s = {.asker = ki_asker_make(context),
               .task = task,
               .data = data,
               .range = range,
               .count = count,
               .asked = ki_os_seconds()};
    run(context, &s.asker, count, step, &s);
    return !ki_was_stopped(&s.asker);
}
