// The functions of os_thread.h by Windows 7 and later.
#define WIN32_LEAN_AND_MEAN
#define _WIN32_WINNT 0x0601
#include "os_thread.h"

#include <windows.h>

#include <assert.h>
#include <process.h>

enum { STACK = 4 << 20 };

static_assert(sizeof(os_mutex) == sizeof(SRWLOCK), "a mutex holds an SRWLOCK");
static_assert(sizeof(os_condition) == sizeof(CONDITION_VARIABLE),
              "a condition holds a CONDITION_VARIABLE");

static unsigned __stdcall run(void *data)
{
    os_thread *thread = data;
    thread->run(thread->data);
    return 0;
}

bool os_thread_start(os_thread *thread, void (*function)(void *data), void *data)
{
    *thread = (os_thread){.run = function, .data = data};
    thread->handle =
        (HANDLE)_beginthreadex(NULL, STACK, run, thread, STACK_SIZE_PARAM_IS_A_RESERVATION, NULL);
    return thread->handle != NULL;
}

void os_thread_join(os_thread *thread)
{
    WaitForSingleObject(thread->handle, INFINITE);
    CloseHandle(thread->handle);
}

int os_core_count(void)
{
    DWORD count = GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
    return count < 1 ? 1 : (int)count;
}

void os_mutex_begin(os_mutex *mutex)
{
    InitializeSRWLock((SRWLOCK *)mutex);
}

void os_mutex_end(os_mutex *mutex)
{
    (void)mutex;
}

void os_lock(os_mutex *mutex)
{
    AcquireSRWLockExclusive((SRWLOCK *)mutex);
}

void os_unlock(os_mutex *mutex)
{
    ReleaseSRWLockExclusive((SRWLOCK *)mutex);
}

void os_condition_begin(os_condition *condition)
{
    InitializeConditionVariable((CONDITION_VARIABLE *)condition);
}

void os_condition_end(os_condition *condition)
{
    (void)condition;
}

void os_wait(os_condition *condition, os_mutex *mutex)
{
    SleepConditionVariableSRW((CONDITION_VARIABLE *)condition, (SRWLOCK *)mutex, INFINITE, 0);
}

void os_wait_for(os_condition *condition, os_mutex *mutex, int milliseconds)
{
    SleepConditionVariableSRW((CONDITION_VARIABLE *)condition, (SRWLOCK *)mutex,
                              (DWORD)milliseconds, 0);
}

void os_wake_all(os_condition *condition)
{
    WakeAllConditionVariable((CONDITION_VARIABLE *)condition);
}
