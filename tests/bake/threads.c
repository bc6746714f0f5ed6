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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(missing_threads_change_nothing_but_time),
                                       cmocka_unit_test(long_loops_ask)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
