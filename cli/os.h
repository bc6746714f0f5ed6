// What the command needs from the operating system: terminals, signals, memory, folders, a clock.
// os_posix.c, os_windows.c, and os_host.c for WebAssembly implement these functions. The command's
// other files do not depend on the system. Some functions are like those of the library's
// src/base/os.h, which the command cannot call: the command uses the library by its public headers
// alone, as any other program does.
#ifndef KILN_CLI_OS_H
#define KILN_CLI_OS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/// Prepares the process, and must be called first. On Windows it converts the arguments to UTF-8,
/// replaces backslashes by slashes, and makes standard output binary. Returns false if memory runs
/// out.
bool os_begin(int *argc, char ***argv);

typedef enum os_stream { OS_INPUT, OS_OUTPUT, OS_ERRORS } os_stream;

/// Returns whether a standard stream is a terminal.
bool os_is_terminal(os_stream stream);
/// Characters in a line of standard output's terminal; 0 if standard output is no terminal.
int os_columns(void);

/// Turns the system's other separators of paths into slashes, in place: on Windows backslashes,
/// unless the path begins with \\?\. os_begin has done so for the arguments.
void os_use_slashes(char *path);

/// A monotonic clock in seconds since an arbitrary moment.
double os_seconds(void);

/// After this call os_signal reports signals that ask the process to stop, and such a signal
/// interrupts waiting reads and writes. A closed pipe or a file above the size limit makes a write
/// fail.
void os_catch_signals(void);
/// Number of the signal that asked the process to stop; 0 for none.
int os_signal(void);
/// Calls `work`. Threads that `work` creates block the signals that ask the process to stop: the
/// signals then interrupt the calling thread.
void os_without_signals(void (*work)(void *user), void *user);
/// The exit code of a write to standard output that failed because the reader closed the pipe, if
/// the errno value `error` means that, or if `error` is 0 and the system says so; else 0.
int os_reader_gone(int error);

/// Tells the program around a WebAssembly module how far the work is: the fraction 0 to 1 of a
/// stage. Does nothing on other systems.
void os_tell_progress(const char *stage, double fraction);

/// Seconds of processor time that the process has used, in its own code and in the system's.
double os_cpu_seconds(void);

/// Physical memory of the machine in bytes; 0 if unknown.
size_t os_physical_memory(void);
/// Peak memory of this process in bytes; 0 if unknown.
double os_peak_memory(void);

typedef enum os_kind { OS_NOTHING, OS_FILE, OS_FOLDER, OS_UNREACHABLE } os_kind;

/// What exists at a path. For OS_UNREACHABLE errno says why that is unknown.
os_kind os_kind_of(const char *path);
/// Returns whether files can be created in a folder.
bool os_is_writable(const char *folder);
/// Calls name(user, NAME) for each entry of a folder, in no particular order. Returns false and
/// sets errno if the folder cannot be read.
bool os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user);

/// What tells a changed file from an unchanged one without reading the file.
typedef struct os_stamp {
    uint64_t size;     ///< size in bytes
    int64_t modified;  ///< time of the last change of the content, in nanoseconds
    int64_t changed;   ///< time of the last change of content or status, which no program can set
    uint64_t identity; ///< number of the file in its file system
    /// True if a file with an equal stamp has equal content: the system has all these numbers, and
    /// the last change is so long ago that a further change would have another time.
    bool is_settled;
} os_stamp;

/// Describes a regular file; returns false and sets errno if there is none.
bool os_stamp_of(const char *path, os_stamp *stamp);
/// Opens a file for reading; returns NULL and sets errno on failure.
FILE *os_open_file(const char *path);

/// Creates a folder; returns false and sets errno on failure.
bool os_make_folder(const char *path);
/// Removes a folder if it is empty.
void os_remove_folder(const char *path);
/// Creates a file or empties an existing file; returns NULL and sets errno on failure.
FILE *os_create_file(const char *path);
void os_remove_file(const char *path);
/// Renames a file and replaces an existing file of the new name; returns false and sets errno on
/// failure.
bool os_replace(const char *from, const char *to);

#endif
