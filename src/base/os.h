// The functions of the operating system that the library uses, implemented in os_posix.c,
// os_windows.c, and os_host.c for the command as WebAssembly. No other file of src/ includes a
// system header. Paths and names are UTF-8 on every system. Functions that can fail return false or
// -1 and set errno.
#ifndef KI_OS_H
#define KI_OS_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if !defined(_WIN32)
#include <pthread.h>
#endif

// ------------------------------------------------------------------------------------------- files

typedef enum ki_os_kind { KI_OS_NOTHING, KI_OS_FILE, KI_OS_FOLDER, KI_OS_OTHER } ki_os_kind;

/// Returns the kind of object at a path: KI_OS_NOTHING if nothing is found, KI_OS_OTHER for a pipe
/// or a device.
ki_os_kind ki_os_kind_of(const char *path);
/// Returns whether a character separates the names in a path: '/', and on Windows '\' too.
bool ki_os_is_separator(char c);

/// Opens a file for reading and returns its descriptor, or -1. Line ends are not translated.
int ki_os_open(const char *path);
/// Returns the descriptor of standard input, which must not be closed.
int ki_os_standard_input(void);
/// Creates a file for writing and returns its descriptor, or -1. If the file exists, errno is
/// EEXIST. The file is locked until the descriptor is closed, which also happens when the process
/// is killed, and may be renamed meanwhile.
int ki_os_create(const char *path);
/// Removes a temporary file that ki_os_create made and whose process ended without removing it.
/// Does nothing if a descriptor still locks the file or the file system has no locks.
void ki_os_remove_abandoned(const char *path);
/// Gives an open file the permissions of the file at `path`, if there is a file.
bool ki_os_copy_mode(int file, const char *path);
/// Returns the size of an open file in bytes, or 0 if the size is unknown, as for a pipe or a
/// device.
uint64_t ki_os_size(int file);
/// Read or write up to `size` bytes and return the number of bytes; reading returns 0 at the end of
/// a file. A signal may interrupt either function, which then returns -1 with errno EINTR.
ptrdiff_t ki_os_read(int file, void *bytes, size_t size);
/// Reads as ki_os_read does, from byte `at` of the file on, on any thread. Returns -1 where the
/// file or the system can only be read from the beginning to the end.
ptrdiff_t ki_os_read_at(int file, void *bytes, size_t size, uint64_t at);
ptrdiff_t ki_os_write(int file, const void *bytes, size_t size);
/// Waits until the written bytes of a file have reached the disk.
bool ki_os_sync(int file);
bool ki_os_close(int file);

/// Greatest length of a path in bytes, with its terminating zero.
enum { KI_OS_PATH = 4096 };

/// Follows symbolic links: sets `target` to the path of the file to which `path` leads, which need
/// not exist. A path that is no link is copied.
bool ki_os_follow(const char *path, char target[KI_OS_PATH]);
/// Renames `from` to `to` in one step. An existing file `to` is replaced.
bool ki_os_replace(const char *from, const char *to);
/// Waits until the names in a folder have reached the disk. Returns true too on systems that do not
/// offer this.
bool ki_os_sync_folder(const char *path);
/// Locks a folder against other callers of this function, and returns a descriptor for
/// ki_os_leave_folder. Returns -1 if the folder cannot be locked within a second; the caller then
/// goes on without the lock.
int ki_os_enter_folder(const char *path);
void ki_os_leave_folder(int folder);
bool ki_os_remove(const char *path);
bool ki_os_make_folder(const char *path);
bool ki_os_remove_folder(const char *path);
/// Calls name(user, NAME) for each entry of a folder, in no particular order. Returns false if the
/// folder cannot be opened.
bool ki_os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user);

/// Returns a number that no other running process has.
long ki_os_process(void);

// -------------------------------------------------------------------------------------------- text

/// Prints as vsnprintf does in the locale "C", whatever locale the program has chosen.
int ki_os_print(char *text, size_t room, const char *format, va_list list);
/// Reads a number as strtof does in the locale "C".
float ki_os_read_float(const char *text);

// ------------------------------------------------------------------------------------------ memory

/// Defined in programs that are compiled with a sanitizer of memory. It sees errors only in blocks
/// that come from malloc, so that every block comes from malloc there.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_HWADDRESS__)
#define KI_OS_CHECKS_BLOCKS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer)
#define KI_OS_CHECKS_BLOCKS
#endif
#endif

/// Allocates `size` bytes aligned to 64. Returns NULL on failure.
void *ki_os_allocate(size_t size);
/// Frees a block of `size` bytes; `memory` may be NULL.
void ki_os_release(void *memory, size_t size);

// ----------------------------------------------------------------------------------------- threads

#if defined(_WIN32)
typedef void *ki_os_thread;       // holds a HANDLE of Windows
typedef void *ki_os_mutex[1];     // holds an SRWLOCK of Windows
typedef void *ki_os_condition[1]; // holds a CONDITION_VARIABLE of Windows
#else
typedef pthread_t ki_os_thread;
typedef pthread_mutex_t ki_os_mutex;
typedef pthread_cond_t ki_os_condition;
#endif

/// The function and data of a thread. The object must exist until ki_os_thread_join has returned
/// for the thread.
typedef struct ki_os_work {
    void (*run)(void *data);
    void *data;
} ki_os_work;

/// Stack size of a thread in bytes. Defaults differ between systems, from 128 kB to 8 MB.
enum { KI_OS_STACK = 2 << 20 };

bool ki_os_thread_start(ki_os_thread *thread, ki_os_work *work);
void ki_os_thread_join(ki_os_thread *thread);
/// Returns a number for the calling thread that no other running thread has.
uintptr_t ki_os_this_thread(void);

void ki_os_mutex_begin(ki_os_mutex *mutex);
void ki_os_mutex_end(ki_os_mutex *mutex);
void ki_os_lock(ki_os_mutex *mutex);
void ki_os_unlock(ki_os_mutex *mutex);

void ki_os_condition_begin(ki_os_condition *condition);
void ki_os_condition_end(ki_os_condition *condition);
/// Unlocks the mutex, waits until the condition is signalled or the wait ends spuriously, and locks
/// the mutex again.
void ki_os_wait(ki_os_condition *condition, ki_os_mutex *mutex);
/// Waits as ki_os_wait does, but also ends after about a twentieth of a second, or later if the
/// system's clock is set back meanwhile.
void ki_os_wait_briefly(ki_os_condition *condition, ki_os_mutex *mutex);
void ki_os_wake_one(ki_os_condition *condition);
void ki_os_wake_all(ki_os_condition *condition);

/// Returns the number of processors that can run threads, at least 1.
int ki_os_core_count(void);
/// Returns the seconds of a clock that never goes backwards.
double ki_os_seconds(void);

#endif
