// What the library asks of the operating system, answered by os_posix.c or os_windows.c: no other file
// of src/ includes a header of the system. Paths and names are UTF-8 everywhere. Functions that can fail
// return false or -1 and leave the reason in errno.
#ifndef KI_OS_H
#define KI_OS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if !defined(_WIN32)
#include <pthread.h>
#endif

// ------------------------------------------------------------------------------------------- files

typedef enum ki_os_kind { KI_OS_NOTHING, KI_OS_FILE, KI_OS_FOLDER, KI_OS_OTHER } ki_os_kind;

/// What a path leads to: KI_OS_NOTHING where nothing is found, KI_OS_OTHER for a pipe or a device.
ki_os_kind ki_os_kind_of(const char *path);
/// Whether a character parts the names in a path: '/', and '\' in Windows.
bool ki_os_is_separator(char c);

/// Opens a file for reading and returns its descriptor. Bytes are never translated.
int ki_os_open(const char *path);
/// The descriptor of standard input, which need not be closed.
int ki_os_standard_input(void);
/// Creates a file for writing; errno is EEXIST where there is one.
int ki_os_create(const char *path);
/// The bytes of an open file, 0 where that is not known: of a pipe or a device.
uint64_t ki_os_size(int file);
/// The bytes read or written, which may be fewer than `size`; 0 at the end of a file. A signal may
/// interrupt both: errno is then EINTR.
ptrdiff_t ki_os_read(int file, void *bytes, size_t size);
ptrdiff_t ki_os_write(int file, const void *bytes, size_t size);
/// Waits until what was written has reached the disk.
bool ki_os_sync(int file);
bool ki_os_close(int file);

/// Gives `from` the name `to` in one step, in place of a file that may be there.
bool ki_os_replace(const char *from, const char *to);
bool ki_os_remove(const char *path);
bool ki_os_make_folder(const char *path);
bool ki_os_remove_folder(const char *path);
/// Calls name(user, NAME) for everything in a folder, in no particular order; false where the folder
/// cannot be opened.
bool ki_os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user);

/// A number that no other running process has.
long ki_os_process(void);

// ------------------------------------------------------------------------------------------ memory

/// `size` bytes aligned to 64, or NULL.
void *ki_os_allocate(size_t size);
void ki_os_release(void *memory);

// ----------------------------------------------------------------------------------------- threads

#if defined(_WIN32)
typedef void *ki_os_thread;       // HANDLE
typedef void *ki_os_mutex[1];     // SRWLOCK
typedef void *ki_os_condition[1]; // CONDITION_VARIABLE
#else
typedef pthread_t ki_os_thread;
typedef pthread_mutex_t ki_os_mutex;
typedef pthread_cond_t ki_os_condition;
#endif

/// What a thread runs. It lives until ki_os_thread_join has returned.
typedef struct ki_os_work {
    void (*run)(void *data);
    void *data;
} ki_os_work;

/// Stack of a thread: the same on every system, since some give 128 kB and some 8 MB.
enum { KI_OS_STACK = 2 << 20 };

bool ki_os_thread_start(ki_os_thread *thread, ki_os_work *work);
void ki_os_thread_join(ki_os_thread *thread);
/// A number of the calling thread that no other running thread has.
uintptr_t ki_os_this_thread(void);

void ki_os_mutex_begin(ki_os_mutex *mutex);
void ki_os_mutex_end(ki_os_mutex *mutex);
void ki_os_lock(ki_os_mutex *mutex);
void ki_os_unlock(ki_os_mutex *mutex);

void ki_os_condition_begin(ki_os_condition *condition);
void ki_os_condition_end(ki_os_condition *condition);
/// Unlocks the mutex, waits to be woken, perhaps without a reason, and locks it again.
void ki_os_wait(ki_os_condition *condition, ki_os_mutex *mutex);
void ki_os_wake_one(ki_os_condition *condition);
void ki_os_wake_all(ki_os_condition *condition);

/// How many processors can run threads, at least 1.
int ki_os_core_count(void);
/// A clock that only goes forward.
double ki_os_seconds(void);

#endif
