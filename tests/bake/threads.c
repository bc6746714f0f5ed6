// A system that starts fewer threads than a context asks for: the context works with those it has,
// says how many these are, and gives the same bits. Long work asks its caller whether to go on.
#include "base/base.h"

#include "kit/kit.h"

#include <pthread.h>
#include <time.h>

// The linker sends the library's calls here. `allowed` more threads may start.
static int allowed;

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                          void *data);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                          void *data);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                          void *data)
{
    return allowed-- > 0 ? __real_pthread_create(thread, attributes, run, data) : 11; // EAGAIN
}

static kiln_error error;

// Bakes a noisy panorama with `asked` threads, of which the system starts `started` beside the
// caller's.
static kiln_environment bake(int asked, int started)
{
    kiln_context *context = NULL;
    kiln_map source;
    kiln_environment made;
    int running = 0, wanted = 0;
    allowed = started;
    CHECK_OK(kiln_context_create(&(kiln_context_def){.thread_count = asked}, &context, &error));
    kiln_context_threads(context, &running, &wanted);
    assert_int_equal(wanted, asked);
    assert_int_equal(running, 1 + (started < asked - 1 ? started : asked - 1));
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 16, 1, &source, &error));
    fill_noise(&source, 1, 0, 10);
    kiln_bake_def def = {.levels.size = 16, .irradiance_size = 8};
    CHECK_OK(kiln_bake(context, &source, &def, &made, &error));
    kiln_map_free(&source);
    kiln_context_destroy(context);
    return made;
}

static void missing_threads_change_nothing_but_time(void **state)
{
    (void)state;
    kiln_environment all = bake(8, 100);
    for (int started = 0; started < 8; started++) {
        kiln_environment few = bake(8, started);
        check_same_levels(&all.levels, &few.levels);
        check_same_levels(&all.irradiance, &few.irradiance);
        kiln_environment_free(&few);
    }
    kiln_environment_free(&all);
}

static int ask_count,
    stop_at; // number of times that the caller was asked, and the answer that stops the work

static bool ask(void *user, const char *stage, double fraction)
{
    (void)user, (void)stage, (void)fraction;
    return ++ask_count != stop_at;
}

// Takes longer than the library may be silent, which is 50 ms.
static void sleep_long(void *data, int worker, int index)
{
    (void)worker, (void)index;
    nanosleep(&(struct timespec){.tv_nsec = 60000000}, NULL);
    ++*(int *)data;
}

// Loops of long tasks with scratch memory of their own ask after each task, and end when they are
// told to.
static void long_loops_ask(void **state)
{
    (void)state;
    kiln_context *context = NULL;
    CHECK_OK(kiln_context_create(&(kiln_context_def){.thread_count = 1, .progress = ask}, &context,
                                 &error));
    int done = 0;
    assert_true(ki_parallel_workers(context, 3, sleep_long, &done));
    assert_int_equal(done, 3);
    assert_int_equal(ask_count, 3);
    done = ask_count = 0;
    stop_at = 2;
    assert_false(ki_parallel_workers(context, 5, sleep_long, &done));
    assert_int_equal(done, 2);
    kiln_context_destroy(context);
}

// Two tasks that begin together. The one on the thread that called the library ends at once, the
// other when it learns that work is to stop, or after a minute.
typedef struct pair {
    kiln_context *context;
    ki_asker asker;
    pthread_t caller;
    atomic_int begun;
    double waited; // seconds that the other task took
} pair;

static void wait_for_stop(void *data, int worker, int index)
{
    pair *p = data;
    (void)worker, (void)index;
    atomic_fetch_add(&p->begun, 1);
    while (atomic_load(&p->begun) < 2)
        nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    struct timespec from, now;
    clock_gettime(CLOCK_MONOTONIC, &from);
    while (!pthread_equal(p->caller, pthread_self()) && p->waited < 60 && ki_may_go_on(&p->asker)) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
        clock_gettime(CLOCK_MONOTONIC, &now);
        p->waited =
            (double)(now.tv_sec - from.tv_sec) + 1e-9 * (double)(now.tv_nsec - from.tv_nsec);
    }
}

static void step_until_stop(void *data, int index)
{
    wait_for_stop(data, 0, index);
}

// While the thread that called the library waits for another thread's long task, it asks whether to
// go on, and the other thread learns the answer. Nobody asks again afterwards.
static void the_caller_asks_while_it_waits(void **state)
{
    (void)state;
    kiln_context *context = NULL;
    kiln_context_def def = {.thread_count = 2, .progress = ask};
    allowed = 1;
    CHECK_OK(kiln_context_create(&def, &context, &error));
    for (int workers = 0; workers < 2; workers++) {
        pair p = {context, ki_asker_make(context), pthread_self(), 0, 0};
        ask_count = 0;
        stop_at = 3; // the first question may be that after the caller's own task
        assert_false(workers ? ki_parallel_workers(context, 2, wait_for_stop, &p)
                             : ki_parallel_steps(context, NULL, 2, step_until_stop, &p));
        assert_true(p.waited < 60);
        assert_int_equal(ask_count, 3);
    }
    kiln_context_destroy(context);
}

// A callback that does work of its own, in the memory of a plan execution, and stops it. Meanwhile
// another thread allocates memory.
typedef struct nest {
    kiln_context *context;
    ki_scratch scratch;
    pthread_t caller;
    void *memory[2];
    atomic_int inside;
    int calls, nested_calls;
    bool was_stopped[2]; // of the work without and with the stop inside
} nest;

static bool stop_own_work(void *user, const char *stage, double fraction)
{
    nest *n = user;
    (void)stage, (void)fraction;
    n->calls++;
    if (atomic_load(&n->inside))
        return ++n->nested_calls % 2 == 1; // the second question inside stops the work inside
    atomic_store(&n->inside, 1);
    ki_scratch_begin(n->context, &n->scratch);
    ki_asker asker = ki_asker_make(n->context);
    n->was_stopped[0] = !ki_may_go_on(&asker);
    n->was_stopped[1] = !ki_may_go_on(&asker) && ki_was_stopped(&asker);
    while (atomic_load(&n->inside) < 2)
        nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    ki_scratch_end(n->context);
    atomic_store(&n->inside, 0);
    return true;
}

static void allocate_meanwhile(void *data, int index)
{
    nest *n = data;
    if (pthread_equal(n->caller, pthread_self())) {
        (void)ki_go_on(n->context);
        return;
    }
    while (atomic_load(&n->inside) != 1)
        nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    n->memory[index] = ki_alloc_raw(n->context, 100, 1);
    atomic_store(&n->inside, 2);
}

static void calls_within_a_callback_are_apart(void **state)
{
    (void)state;
    static nest n;
    kiln_context_def def = {.thread_count = 2, .progress = stop_own_work, .progress_user = &n};
    allowed = 1;
    n = (nest){.caller = pthread_self()};
    CHECK_OK(kiln_context_create(&def, &n.context, &error));
    ki_asker outer = ki_asker_make(n.context);
    ki_parallel_for(n.context, 2, allocate_meanwhile, &n);
    assert_false(n.was_stopped[0]);
    assert_true(n.was_stopped[1]);
    assert_false(ki_was_stopped(&outer));
    // The other thread's memory did not come from the scratch.
    assert_true(n.memory[0] || n.memory[1]);
    assert_int_equal(n.scratch.peak, 0);
    ki_free(n.memory[0]);
    ki_free(n.memory[1]);
    kiln_context_destroy(n.context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(missing_threads_change_nothing_but_time),
                                       cmocka_unit_test(long_loops_ask),
                                       cmocka_unit_test(the_caller_asks_while_it_waits),
                                       cmocka_unit_test(calls_within_a_callback_are_apart)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
