// The functions of os.h for the command as WebAssembly, by functions that the JavaScript program
// around the module offers (npm/host.mjs). In: paths and descriptors. Out: what the program
// answers: a number of 0 or more, or the negative number of an error, which becomes errno. There
// are no threads, and there is one locale.
#include "base/os.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HOST(name) __attribute__((import_module("kiln"), import_name(#name)))

// Each path ends with a NUL. The functions that return int may return a negative error number.
HOST(kind) int host_kind(const char *path);
HOST(open) int host_open(const char *path);
HOST(create) int host_create(const char *path);
HOST(copy_mode) int host_copy_mode(int file, const char *path);
HOST(size) double host_size(int file);
HOST(read) int host_read(int file, void *bytes, size_t size);
HOST(write) int host_write(int file, const void *bytes, size_t size);
HOST(sync) int host_sync(int file);
HOST(close) int host_close(int file);
HOST(link) int host_link(const char *path, char *target, size_t room);
HOST(replace) int host_replace(const char *from, const char *to);
HOST(remove) int host_remove(const char *path);
HOST(make_folder) int host_make_folder(const char *path);
HOST(remove_folder) int host_remove_folder(const char *path);
HOST(list) int host_list(const char *path, char *names, size_t room);
HOST(process) int host_process(void);
HOST(seconds) double host_seconds(void);

static bool good(int answer)
{
    if (answer < 0)
        errno = -answer;
    return answer >= 0;
}

static int value(int answer)
{
    return good(answer) ? answer : -1;
}

// ------------------------------------------------------------------------------------------- files

ki_os_kind ki_os_kind_of(const char *path)
{
    int kind = host_kind(path);
    return kind < 0 ? KI_OS_NOTHING : (ki_os_kind)kind;
}

uint64_t ki_os_size(int file)
{
    return (uint64_t)host_size(file);
}

bool ki_os_is_separator(char c)
{
    return c == '/';
}

int ki_os_open(const char *path)
{
    return value(host_open(path));
}

int ki_os_standard_input(void)
{
    return 0;
}

// JavaScript has no locks of files. Temporary files therefore have names that no program takes for
// abandoned ones: ki_os_process returns a negative number, and names of temporary files that may be
// removed have digits alone.
int ki_os_create(const char *path)
{
    return value(host_create(path));
}

void ki_os_remove_abandoned(const char *path)
{
    (void)path;
}

bool ki_os_copy_mode(int file, const char *path)
{
    return good(host_copy_mode(file, path));
}

ptrdiff_t ki_os_read(int file, void *bytes, size_t size)
{
    return value(host_read(file, bytes, size));
}

ptrdiff_t ki_os_read_at(int file, void *bytes, size_t size, uint64_t at)
{
    (void)file, (void)bytes, (void)size, (void)at;
    errno = ENOTSUP;
    return -1;
}

ptrdiff_t ki_os_write(int file, const void *bytes, size_t size)
{
    return value(host_write(file, bytes, size));
}

bool ki_os_sync(int file)
{
    return good(host_sync(file));
}

bool ki_os_close(int file)
{
    return good(host_close(file));
}

bool ki_os_follow(const char *path, char target[KI_OS_PATH])
{
    return good(host_link(path, target, KI_OS_PATH));
}

bool ki_os_replace(const char *from, const char *to)
{
    return good(host_replace(from, to));
}

bool ki_os_sync_folder(const char *path)
{
    (void)path;
    return true;
}

int ki_os_enter_folder(const char *path)
{
    (void)path;
    return -1;
}

void ki_os_leave_folder(int folder)
{
    (void)folder;
}

bool ki_os_remove(const char *path)
{
    return good(host_remove(path));
}

bool ki_os_make_folder(const char *path)
{
    return good(host_make_folder(path));
}

bool ki_os_remove_folder(const char *path)
{
    return good(host_remove_folder(path));
}

bool ki_os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user)
{
    // The names, each with its NUL, need room that the first call tells. The second call gives the
    // same names.
    int size = host_list(path, NULL, 0);
    if (!good(size))
        return false;
    char *names = calloc((size_t)size + 1, 1);
    if (!names)
        return false;
    host_list(path, names, (size_t)size);
    for (const char *at = names; at < names + size; at += strlen(at) + 1)
        name(user, at);
    free(names);
    return true;
}

long ki_os_process(void)
{
    return -(long)host_process();
}

// -------------------------------------------------------------------------------------------- text

int ki_os_print(char *text, size_t room, const char *format, va_list list)
{
    return vsnprintf(text, room, format, list);
}

float ki_os_read_float(const char *text)
{
    return strtof(text, NULL);
}

// ------------------------------------------------------------------------------------------ memory

void *ki_os_allocate(size_t size)
{
    return aligned_alloc(64, (size + 63) & ~(size_t)63);
}

void ki_os_release(void *memory, size_t size)
{
    (void)size;
    free(memory);
}

// ----------------------------------------------------------------------------------------- threads

bool ki_os_thread_start(ki_os_thread *thread, ki_os_work *work)
{
    (void)thread;
    (void)work;
    return false;
}

void ki_os_thread_join(ki_os_thread *thread)
{
    (void)thread;
}

uintptr_t ki_os_this_thread(void)
{
    return 1;
}

void ki_os_mutex_begin(ki_os_mutex *mutex)
{
    (void)mutex;
}

void ki_os_mutex_end(ki_os_mutex *mutex)
{
    (void)mutex;
}

void ki_os_lock(ki_os_mutex *mutex)
{
    (void)mutex;
}

void ki_os_unlock(ki_os_mutex *mutex)
{
    (void)mutex;
}

void ki_os_condition_begin(ki_os_condition *condition)
{
    (void)condition;
}

void ki_os_condition_end(ki_os_condition *condition)
{
    (void)condition;
}

void ki_os_wait(ki_os_condition *condition, ki_os_mutex *mutex)
{
    (void)condition;
    (void)mutex;
}

void ki_os_wait_briefly(ki_os_condition *condition, ki_os_mutex *mutex)
{
    (void)condition;
    (void)mutex;
}

void ki_os_wake_one(ki_os_condition *condition)
{
    (void)condition;
}

void ki_os_wake_all(ki_os_condition *condition)
{
    (void)condition;
}

int ki_os_core_count(void)
{
    return 1;
}

double ki_os_seconds(void)
{
    return host_seconds();
}
