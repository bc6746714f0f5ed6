// The functions of os.h by POSIX.1-2008, for Linux, macOS, the BSDs, and WebAssembly by emscripten.
// In and out: UTF-8 paths, file descriptors, aligned memory, pthreads.
#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64
#if defined(__APPLE__)
#define _DARWIN_C_SOURCE // makes macOS declare _SC_NPROCESSORS_ONLN
#elif defined(__linux__)
#define _DEFAULT_SOURCE // makes Linux declare madvise
#endif
#include "base/os.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#if defined(__APPLE__)
#include <xlocale.h>
#endif

// ------------------------------------------------------------------------------------------- files

ki_os_kind ki_os_kind_of(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return KI_OS_NOTHING;
    return S_ISREG(status.st_mode)   ? KI_OS_FILE
           : S_ISDIR(status.st_mode) ? KI_OS_FOLDER
                                     : KI_OS_OTHER;
}

uint64_t ki_os_size(int file)
{
    struct stat status;
    bool known = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0;
    return known ? (uint64_t)status.st_size : 0;
}

bool ki_os_is_separator(char c)
{
    return c == '/';
}

int ki_os_open(const char *path)
{
    return open(path, O_RDONLY | O_CLOEXEC);
}

int ki_os_standard_input(void)
{
    return STDIN_FILENO;
}

// The new file gets the permissions that the process's umask allows. Another process may take the
// file for an abandoned one and remove it between its creation and its locking; the name then
// counts as in use.
int ki_os_create(const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0)
        return -1;
    struct stat status;
    bool taken = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!taken && fstat(file, &status) == 0 && status.st_nlink > 0)
        return file;
    close(file);
    errno = EEXIST;
    return -1;
}

void ki_os_remove_abandoned(const char *path)
{
    int file = open(path, O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return;
    struct stat opened, named;
    if (flock(file, LOCK_EX | LOCK_NB) == 0 && fstat(file, &opened) == 0 &&
        lstat(path, &named) == 0 && S_ISREG(named.st_mode) && opened.st_dev == named.st_dev &&
        opened.st_ino == named.st_ino)
        unlink(path);
    close(file);
}

// The set-user-ID and set-group-ID bits are not copied, because the new file may have another
// owner.
bool ki_os_copy_mode(int file, const char *path)
{
    struct stat status;
    return stat(path, &status) != 0 || fchmod(file, status.st_mode & 0777) == 0;
}

ptrdiff_t ki_os_read(int file, void *bytes, size_t size)
{
    return read(file, bytes, size);
}

ptrdiff_t ki_os_read_at(int file, void *bytes, size_t size, uint64_t at)
{
    return pread(file, bytes, size, (off_t)at);
}

ptrdiff_t ki_os_write(int file, const void *bytes, size_t size)
{
    return write(file, bytes, size);
}

bool ki_os_sync(int file)
{
    while (fsync(file) != 0)
        if (errno != EINTR)
            return false;
    return true;
}

bool ki_os_close(int file)
{
    return close(file) == 0;
}

// Replaces a path by the target `link` of the symbolic link at this path. The target is relative to
// the link's folder unless it begins with a slash.
static bool follow_once(char path[KI_OS_PATH], const char *link)
{
    char *slash = strrchr(path, '/');
    size_t kept = slash && link[0] != '/' ? (size_t)(slash + 1 - path) : 0, size = strlen(link) + 1;
    if (kept + size > KI_OS_PATH) {
        errno = ENAMETOOLONG;
        return false;
    }
    memcpy(path + kept, link, size);
    return true;
}

bool ki_os_follow(const char *path, char target[KI_OS_PATH])
{
    enum { MOST_LINKS = 40 };
    target[0] = 0;
    if (!follow_once(target, path))
        return false;
    for (int i = 0; i < MOST_LINKS; i++) {
        char link[KI_OS_PATH];
        ssize_t length = readlink(target, link, sizeof link - 1);
        if (length < 0)
            return true;
        link[length] = 0;
        if (!follow_once(target, link))
            return false;
    }
    errno = ELOOP;
    return false;
}

bool ki_os_replace(const char *from, const char *to)
{
    return rename(from, to) == 0;
}

// Some file systems cannot synchronise a folder, and a folder may be writable without being
// readable; only an error of the disk itself counts.
bool ki_os_sync_folder(const char *path)
{
    int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return true;
    bool good = ki_os_sync(folder) || (errno != EIO && errno != ENOSPC);
    int reason = errno;
    close(folder);
    errno = reason;
    return good;
}

int ki_os_enter_folder(const char *path)
{
    enum { TRIES = 1000 };
    int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (int i = 0; folder >= 0 && flock(folder, LOCK_EX | LOCK_NB) != 0; i++) {
        if (errno != EWOULDBLOCK || i == TRIES) {
            close(folder);
            return -1;
        }
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    return folder;
}

void ki_os_leave_folder(int folder)
{
    if (folder >= 0)
        close(folder);
}

bool ki_os_remove(const char *path)
{
    return unlink(path) == 0;
}

bool ki_os_make_folder(const char *path)
{
    return mkdir(path, 0777) == 0;
}

bool ki_os_remove_folder(const char *path)
{
    return rmdir(path) == 0;
}

bool ki_os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user)
{
    DIR *folder = opendir(path);
    if (!folder)
        return false;
    for (struct dirent *entry; (entry = readdir(folder));)
        name(user, entry->d_name);
    closedir(folder);
    return true;
}

long ki_os_process(void)
{
    return (long)getpid();
}

// -------------------------------------------------------------------------------------------- text

// The locale of the calling thread is exchanged, since printf has no argument for the locale. Every
// C library keeps the locale "C" ready, so that newlocale neither fails nor reads a file.
int ki_os_print(char *text, size_t room, const char *format, va_list list)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    locale_t before = uselocale(plain);
    int length = vsnprintf(text, room, format, list);
    uselocale(before);
    if (plain)
        freelocale(plain);
    return length;
}

float ki_os_read_float(const char *text)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    locale_t before = uselocale(plain);
    float value = strtof(text, NULL);
    uselocale(before);
    if (plain)
        freelocale(plain);
    return value;
}

// ------------------------------------------------------------------------------------------ memory

#if defined(__linux__) && defined(MADV_HUGEPAGE) && !defined(KI_OS_CHECKS_BLOCKS)
// Large blocks get pages of 2 MiB where Linux grants them. Linux else stops at the first use of
// every 4 KiB. They are mapped one by one, because malloc keeps some of what is freed, depending on
// what was freed before.
enum { LARGE_PAGE = 1 << 21 };

static bool is_large(size_t size)
{
    return size >= LARGE_PAGE && size <= SIZE_MAX / 2;
}

// Number of bytes of a large block in large pages. The last, incomplete page is large too if it is
// full to three quarters, so that a block takes at most 512 KiB, a seventh of its size, more than
// its size.
static size_t paged_size(size_t size)
{
    return (size + LARGE_PAGE / 4) / LARGE_PAGE * LARGE_PAGE;
}

// Number of bytes that are mapped for a large block. Mappings consist of whole pages. Pages have 4
// KiB on most machines and up to 64 KiB on some, so the number is a multiple of 64 KiB.
static size_t mapped_size(size_t size)
{
    size_t paged = paged_size(size), whole = (size + 0xffff) & ~(size_t)0xffff;
    return paged > whole ? paged : whole;
}

static void *map_large(size_t size)
{
    size_t wanted = mapped_size(size), all = wanted + LARGE_PAGE;
    char *start = mmap(NULL, all, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) {
        // Addresses may be short, for example under a limit of them. The block alone, without the
        // alignment that large pages need, may still fit.
        start = mmap(NULL, wanted, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        return start == MAP_FAILED ? NULL : start;
    }
    // what lies before the first address that is a multiple of a large page, and behind the block
    size_t before = (LARGE_PAGE - (uintptr_t)start % LARGE_PAGE) % LARGE_PAGE;
    if (before)
        munmap(start, before);
    if (all - before > wanted)
        munmap(start + before + wanted, all - before - wanted);
    madvise(start + before, paged_size(size), MADV_HUGEPAGE);
    return start + before;
}
#endif

void *ki_os_allocate(size_t size)
{
#if defined(__linux__) && defined(MADV_HUGEPAGE) && !defined(KI_OS_CHECKS_BLOCKS)
    if (is_large(size))
        return map_large(size);
#endif
    return aligned_alloc(64, (size + 63) & ~(size_t)63);
}

void ki_os_release(void *memory, size_t size)
{
#if defined(__linux__) && defined(MADV_HUGEPAGE) && !defined(KI_OS_CHECKS_BLOCKS)
    if (is_large(size)) {
        if (memory)
            munmap(memory, mapped_size(size));
        return;
    }
#endif
    (void)size;
    free(memory);
}

// ----------------------------------------------------------------------------------------- threads

static void *run(void *data)
{
    const ki_os_work *work = data;
    work->run(work->data);
    return NULL;
}

bool ki_os_thread_start(ki_os_thread *thread, ki_os_work *work)
{
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0)
        return false;
    bool good = pthread_attr_setstacksize(&attributes, KI_OS_STACK) == 0 &&
                pthread_create(thread, &attributes, run, work) == 0;
    pthread_attr_destroy(&attributes);
    return good;
}

void ki_os_thread_join(ki_os_thread *thread)
{
    pthread_join(*thread, NULL);
}

uintptr_t ki_os_this_thread(void)
{
    // The type pthread_t is an integer in some C libraries and a pointer in others.
    return (uintptr_t)pthread_self();
}

void ki_os_mutex_begin(ki_os_mutex *mutex)
{
    pthread_mutex_init(mutex, NULL);
}

void ki_os_mutex_end(ki_os_mutex *mutex)
{
    pthread_mutex_destroy(mutex);
}

void ki_os_lock(ki_os_mutex *mutex)
{
    pthread_mutex_lock(mutex);
}

void ki_os_unlock(ki_os_mutex *mutex)
{
    pthread_mutex_unlock(mutex);
}

void ki_os_condition_begin(ki_os_condition *condition)
{
    pthread_cond_init(condition, NULL);
}

void ki_os_condition_end(ki_os_condition *condition)
{
    pthread_cond_destroy(condition);
}

void ki_os_wait(ki_os_condition *condition, ki_os_mutex *mutex)
{
    pthread_cond_wait(condition, mutex);
}

void ki_os_wait_briefly(ki_os_condition *condition, ki_os_mutex *mutex)
{
    // Every system has a condition's default clock, and some have no other. If it is set forward
    // while a thread waits, the wait ends early; if it is set back, the wait may last until the
    // condition is signalled.
    struct timespec end;
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_nsec += 50 * 1000 * 1000;
    if (end.tv_nsec >= 1000 * 1000 * 1000) {
        end.tv_sec++;
        end.tv_nsec -= 1000 * 1000 * 1000;
    }
    pthread_cond_timedwait(condition, mutex, &end);
}

void ki_os_wake_one(ki_os_condition *condition)
{
    pthread_cond_signal(condition);
}

void ki_os_wake_all(ki_os_condition *condition)
{
    pthread_cond_broadcast(condition);
}

int ki_os_core_count(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > 1 << 20 ? 1 << 20 : (int)count;
}

double ki_os_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
