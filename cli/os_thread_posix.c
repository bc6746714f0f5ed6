// The functions of os_thread.h by POSIX threads.
#if defined(__linux__)
#define _GNU_SOURCE // makes <sched.h> declare sched_getaffinity
#endif
#include "os_thread.h"

#include <sched.h>
#include <stddef.h>
#include <time.h>
#include <unistd.h>

enum { STACK = 4 << 20 }; // default stack sizes differ between systems, from 128 kB to 8 MB

static void *run(void *data)
{
    os_thread *thread = data;
    thread->run(thread->data);
    return NULL;
}

bool os_thread_start(os_thread *thread, void (*function)(void *data), void *data)
{
    pthread_attr_t attributes;
    *thread = (os_thread){.run = function, .data = data};
    if (pthread_attr_init(&attributes) != 0)
        return false;
    bool good = pthread_attr_setstacksize(&attributes, STACK) == 0 &&
                pthread_create(&thread->handle, &attributes, run, thread) == 0;
    pthread_attr_destroy(&attributes);
    return good;
}

void os_thread_join(os_thread *thread)
{
    pthread_join(thread->handle, NULL);
}

// Job schedulers bind a process to a part of the machine's processors.
int os_core_count(void)
{
#if defined(__linux__)
    cpu_set_t mine;
    if (sched_getaffinity(0, sizeof mine, &mine) == 0 && CPU_COUNT(&mine) > 0)
        return CPU_COUNT(&mine);
#endif
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : (int)count;
}

void os_mutex_begin(os_mutex *mutex)
{
    pthread_mutex_init(mutex, NULL);
}

void os_mutex_end(os_mutex *mutex)
{
    pthread_mutex_destroy(mutex);
}

void os_lock(os_mutex *mutex)
{
    pthread_mutex_lock(mutex);
}

void os_unlock(os_mutex *mutex)
{
    pthread_mutex_unlock(mutex);
}

void os_condition_begin(os_condition *condition)
{
    pthread_cond_init(condition, NULL);
}

void os_condition_end(os_condition *condition)
{
    pthread_cond_destroy(condition);
}

void os_wait(os_condition *condition, os_mutex *mutex)
{
    pthread_cond_wait(condition, mutex);
}

void os_wait_for(os_condition *condition, os_mutex *mutex, int milliseconds)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += milliseconds / 1000;
    until.tv_nsec += milliseconds % 1000 * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    pthread_cond_timedwait(condition, mutex, &until);
}

void os_wake_all(os_condition *condition)
{
    pthread_cond_broadcast(condition);
}
