// The functions of os.h, what the command needs from the operating system, by POSIX.1-2008.
#define _DEFAULT_SOURCE // makes <sys/ioctl.h> declare TIOCGWINSZ
#include "os.h"

#include <dirent.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

bool os_begin(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    return true;
}

void os_use_slashes(char *path)
{
    (void)path;
}

bool os_is_terminal(os_stream stream)
{
    static const int number[] = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
    return isatty(number[stream]);
}

int os_columns(void)
{
    struct winsize size = {0};
    return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

double os_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double os_cpu_seconds(void)
{
    struct rusage usage = {0};
    getrusage(RUSAGE_SELF, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

void os_tell_progress(const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
}

// ----------------------------------------------------------------------------------------- signals

static volatile sig_atomic_t caught;

static void on_signal(int signal)
{
    caught = signal;
}

int os_signal(void)
{
    return (int)caught;
}

static const int stopping[] = {SIGINT, SIGTERM, SIGHUP};
enum { STOPPING = sizeof stopping / sizeof *stopping };

// Without SA_RESTART the signals interrupt waiting reads and writes. Signals that the parent
// process ignores, as nohup does for SIGHUP, stay ignored.
void os_catch_signals(void)
{
    struct sigaction action = {.sa_handler = on_signal}, old;
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < STOPPING; i++)
        if (sigaction(stopping[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN)
            sigaction(stopping[i], &action, NULL);
    // With SIGPIPE and SIGXFSZ ignored, the write fails instead of ending the process, and the
    // error path removes temporary files.
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

void os_without_signals(void (*work)(void *user), void *user)
{
    sigset_t mask, before;
    sigemptyset(&mask);
    for (int i = 0; i < STOPPING; i++)
        sigaddset(&mask, stopping[i]);
    sigprocmask(SIG_BLOCK, &mask, &before);
    work(user);
    sigprocmask(SIG_SETMASK, &before, NULL);
}

// A C library such as musl drops what an earlier write could not write, and then the last write
// succeeds. The pipe itself still says that its reader is gone.
int os_reader_gone(int error)
{
    struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
    bool gone = error == EPIPE || (!error && poll(&out, 1, 0) > 0 && (out.revents & POLLERR) != 0);
    return gone ? 128 + SIGPIPE : 0;
}

// ------------------------------------------------------------------------------------------ memory

size_t os_physical_memory(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? (size_t)pages * (size_t)page : 0;
}

double os_peak_memory(void)
{
    struct rusage usage = {0};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return (double)usage.ru_maxrss; // ru_maxrss is in bytes on macOS and in kB on other systems
#else
    return 1024.0 * (double)usage.ru_maxrss;
#endif
}

// ----------------------------------------------------------------------------------------- folders

os_kind os_kind_of(const char *path)
{
    struct stat status;
    if (stat(path, &status) == 0)
        return S_ISDIR(status.st_mode) ? OS_FOLDER : OS_FILE;
    return errno == ENOENT ? OS_NOTHING : OS_UNREACHABLE;
}

bool os_is_writable(const char *folder)
{
    return access(folder, W_OK | X_OK) == 0;
}

bool os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user)
{
    DIR *folder = opendir(path);
    if (!folder)
        return false;
    for (struct dirent *entry; (entry = readdir(folder));)
        name(user, entry->d_name);
    closedir(folder);
    return true;
}

static int64_t nanoseconds(struct timespec time)
{
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

// Two changes within one tick of the file system's clock have one time. Ticks are two seconds long
// at most.
bool os_stamp_of(const char *path, os_stamp *stamp)
{
    static const int64_t longest_tick = 2000000000;
    struct stat status;
    struct timespec now;
    *stamp = (os_stamp){0};
    if (stat(path, &status) != 0)
        return false;
    if (!S_ISREG(status.st_mode)) {
        errno = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
        return false;
    }
    clock_gettime(CLOCK_REALTIME, &now);
#ifdef __APPLE__
    struct timespec modified = status.st_mtimespec, changed = status.st_ctimespec;
#else
    struct timespec modified = status.st_mtim, changed = status.st_ctim;
#endif
    *stamp = (os_stamp){.size = (uint64_t)status.st_size,
                        .modified = nanoseconds(modified),
                        .changed = nanoseconds(changed),
                        .identity = (uint64_t)status.st_ino,
                        .is_settled = nanoseconds(now) - nanoseconds(changed) > longest_tick};
    return true;
}

FILE *os_open_file(const char *path)
{
    return fopen(path, "rb");
}

bool os_make_folder(const char *path)
{
    return mkdir(path, 0777) == 0;
}

void os_remove_folder(const char *path)
{
    rmdir(path);
}

FILE *os_create_file(const char *path)
{
    return fopen(path, "wb");
}

void os_remove_file(const char *path)
{
    unlink(path);
}

bool os_replace(const char *from, const char *to)
{
    return rename(from, to) == 0;
}
