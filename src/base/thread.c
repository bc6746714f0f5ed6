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

static void run_on_pool(ki_pool *pool, int count, ki_task *task, void *data)
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
    ki_os_lock(&pool->mutex);
    while (pool->running)
        ki_os_wait(&pool->done, &pool->mutex);
    ki_os_unlock(&pool->mutex);
}

void ki_parallel_for(kiln_context *context, int count, ki_task *task, void *data)
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
    pool->in_use = true;
    if (own)
        run_on_pool(pool, count, task, data);
    else
        context->def.parallel_for(context->def.parallel_user, count, task, data);
    pool->in_use = false;
}

// Longest time in seconds between two progress reports, unless one task takes longer. A caller can
// therefore stop the work within this time.
static const double silence = 0.05;

typedef struct workers {
    kiln_context *context;
    void (*task)(void *data, int worker, int index);
    void *data;
    int count;
    uintptr_t caller;
    double asked; // time of the last progress report, in seconds
    atomic_int next;
    atomic_bool stopped;
} workers;

// Asks the caller of the library whether to go on, on the thread of the caller, from time to time.
static void ask(workers *w)
{
    if (ki_os_this_thread() != w->caller || ki_os_seconds() < w->asked + silence)
        return;
    if (!ki_go_on(w->context))
        atomic_store(&w->stopped, true);
    w->asked = ki_os_seconds();
}

static void work(void *data, int worker)
{
    workers *w = data;
    while (!atomic_load_explicit(&w->stopped, memory_order_relaxed)) {
        int index = atomic_fetch_add(&w->next, 1);
        if (index >= w->count)
            return;
        w->task(w->data, worker, index);
        if (w->context->def.progress)
            ask(w);
    }
}

bool ki_parallel_workers(kiln_context *context, int count,
                         void (*task)(void *data, int worker, int index), void *data)
{
    workers w = {.context = context,
                 .task = task,
                 .data = data,
                 .count = count,
                 .caller = ki_os_this_thread(),
                 .asked = ki_os_seconds()};
    ki_parallel_for(context, ki_min(context->def.thread_count, count), work, &w);
    return !atomic_load(&w.stopped);
}

typedef struct steps {
    kiln_context *context;
    ki_task *task;
    void *data;
    const ki_progress_range *range;
    uintptr_t caller;
    int count, told;
    double asked; // time of the last progress report, in seconds
    atomic_int done;
    atomic_bool stopped;
} steps;

enum { REPORTS = 64 };

static void step(void *data, int index)
{
    steps *s = data;
    if (atomic_load_explicit(&s->stopped, memory_order_relaxed))
        return;
    s->task(s->data, index);
    double part = (double)(atomic_fetch_add(&s->done, 1) + 1) / s->count;
    if (ki_os_this_thread() != s->caller ||
        (part * REPORTS < s->told + 1 && ki_os_seconds() < s->asked + silence))
        return;
    s->told = (int)(part * REPORTS);
    s->asked = ki_os_seconds();
    const ki_progress_range *at = s->range;
    bool go_on = at ? ki_progress(s->context, at->name, at->from + part * (at->to - at->from))
                    : ki_go_on(s->context);
    if (!go_on)
        atomic_store(&s->stopped, true);
}

bool ki_parallel_steps(kiln_context *context, const ki_progress_range *range, int count,
                       ki_task *task, void *data)
{
    if (!context->def.progress || count < 2) {
        ki_parallel_for(context, count, task, data);
        return true;
    }
    steps s = {.context = context,
               .task = task,
               .data = data,
               .range = range,
               .caller = ki_os_this_thread(),
               .count = count,
               .asked = ki_os_seconds()};
    ki_parallel_for(context, count, step, &s);
    return !atomic_load(&s.stopped);
}
