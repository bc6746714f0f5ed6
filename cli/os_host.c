// The functions of os.h for the command as WebAssembly. In and out: questions that the JavaScript
// program around the module answers (npm/host.mjs). Answers below 0 are negative numbers of errors,
// which become errno.
#include "os.h"

#include <errno.h>
#include <stdio.h>

#define HOST(name) __attribute__((import_module("kiln"), import_name(#name)))

// Each path ends with a NUL.
HOST(terminal) int host_terminal(int stream);
HOST(columns) int host_columns(void);
HOST(seconds) double host_seconds(void);
HOST(signal) int host_signal(void);
HOST(progress) void host_progress(const char *stage, double fraction);
HOST(reader_gone) int host_reader_gone(void);
HOST(kind) int host_kind(const char *path);
HOST(writable) int host_writable(const char *folder);
HOST(make_folder) int host_make_folder(const char *path);
HOST(remove_folder) int host_remove_folder(const char *path);
HOST(create_or_empty) int host_create_or_empty(const char *path);
HOST(remove) int host_remove(const char *path);
HOST(replace) int host_replace(const char *from, const char *to);

static bool good(int answer)
{
    if (answer < 0)
        errno = -answer;
    return answer >= 0;
}

bool os_begin(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    return true;
}

bool os_is_terminal(os_stream stream)
{
    return host_terminal((int)stream) != 0;
}

int os_columns(void)
{
    return host_columns();
}

double os_seconds(void)
{
    return host_seconds();
}

void os_tell_progress(const char *stage, double fraction)
{
    host_progress(stage, fraction);
}

// ----------------------------------------------------------------------------------------- signals

int os_signal(void)
{
    return host_signal();
}

void os_catch_signals(void)
{
}

void os_without_signals(void (*work)(void *user), void *user)
{
    work(user);
}

// The C library forgets why an earlier write failed; the program around the module knows.
int os_reader_gone(int error)
{
    enum { BROKEN_PIPE = 13 }; // the number of SIGPIPE
    return error == EPIPE || host_reader_gone() ? 128 + BROKEN_PIPE : 0;
}

// ------------------------------------------------------------------------------------------ memory

// A module's memory ends at 4 GiB; the code, the stack and the C library's own blocks take a part
// of that.
size_t os_physical_memory(void)
{
    return (size_t)4000 << 20;
}

// The module's memory never shrinks.
double os_peak_memory(void)
{
    return 65536.0 * (double)__builtin_wasm_memory_size(0);
}

// ----------------------------------------------------------------------------------------- folders

os_kind os_kind_of(const char *path)
{
    enum { FOLDER = 2 }; // the answer for a folder; files are 1, pipes and devices 3
    int kind = host_kind(path);
    if (good(kind))
        return kind == FOLDER ? OS_FOLDER : OS_FILE;
    return errno == ENOENT ? OS_NOTHING : OS_UNREACHABLE;
}

bool os_is_writable(const char *folder)
{
    return good(host_writable(folder));
}

bool os_make_folder(const char *path)
{
    return good(host_make_folder(path));
}

void os_remove_folder(const char *path)
{
    host_remove_folder(path);
}

FILE *os_create_file(const char *path)
{
    int file = host_create_or_empty(path);
    return good(file) ? fdopen(file, "wb") : NULL;
}

void os_remove_file(const char *path)
{
    host_remove(path);
}

bool os_replace(const char *from, const char *to)
{
    return good(host_replace(from, to));
}
