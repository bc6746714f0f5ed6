// Threads of the command, implemented in os_thread_posix.c and os_thread_windows.c. WebAssembly has
// none. The threads of the library (src/base/os.h) are no part of its public headers, to which the
// command keeps.
#ifndef KILN_CLI_OS_THREAD_H
#define KILN_CLI_OS_THREAD_H

#include <stdbool.h>

#if defined(_WIN32)
typedef void *os_mutex[1];     // holds an SRWLOCK of Windows
typedef void *os_condition[1]; // holds a CONDITION_VARIABLE of Windows
#else
#include <pthread.h>
typedef pthread_mutex_t os_mutex;
typedef pthread_cond_t os_condition;
#endif

/// A thread with its function and the function's argument. The object must stay where it is until
/// os_thread_join has returned.
typedef struct os_thread {
    void (*run)(void *data);
    void *data;
#if defined(_WIN32)
    void *handle;
#else
    pthread_t handle;
#endif
} os_thread;

/// Starts a thread that calls run(data). Returns false if the system starts no more threads.
bool os_thread_start(os_thread *thread, void (*run)(void *data), void *data);
/// Waits until the thread's function has returned.
void os_thread_join(os_thread *thread);
/// Number of processors that the process may use, at least 1.
int os_core_count(void);

void os_mutex_begin(os_mutex *mutex);
void os_mutex_end(os_mutex *mutex);
void os_lock(os_mutex *mutex);
void os_unlock(os_mutex *mutex);

void os_condition_begin(os_condition *condition);
void os_condition_end(os_condition *condition);
/// Unlocks the mutex, waits until the condition is signalled or the wait ends without a reason, and
/// locks the mutex again.
void os_wait(os_condition *condition, os_mutex *mutex);
/// The same, but waits for `milliseconds` at most.
void os_wait_for(os_condition *condition, os_mutex *mutex, int milliseconds);
void os_wake_all(os_condition *condition);

#endif
