// What the command asks of the operating system: terminals, signals, memory, folders, a clock. Each
// system has its own source file, os_posix.c among them; no other file of the command knows which system
// it runs on.
#ifndef KILN_CLI_OS_H
#define KILN_CLI_OS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// Called first. Makes the arguments UTF-8 and slashes the only separator of paths, and standard output a
/// stream of bytes, where they are not; false where memory runs out.
bool os_begin(int *argc, char ***argv);

typedef enum os_stream { OS_INPUT, OS_OUTPUT, OS_ERRORS } os_stream;

/// Whether a standard stream is a terminal.
bool os_is_terminal(os_stream stream);
/// Characters in a line of the terminal that standard output is; 0 where it is none.
int os_columns(void);

/// A clock that only goes forward, in seconds from some fixed moment.
double os_seconds(void);

/// From now on the signals that ask to stop are noted by os_signal, and end waiting reads and writes. A
/// reader that has gone away or a file grown too large shows as a failed write.
void os_catch_signals(void);
/// The number of the signal that asked to stop, 0 for none.
int os_signal(void);
/// Calls `work` with those signals kept from threads that it begins, so that they reach the thread that
/// calls and end its waits.
void os_without_signals(void (*work)(void *user), void *user);
/// The exit code of a write whose reader has gone away, if `error` (of errno) is that; else 0.
int os_reader_gone(int error);

/// Bytes of memory that the machine has, 0 where that is not known.
size_t os_physical_memory(void);
/// The most bytes that this process has held, 0 where that is not known.
double os_peak_memory(void);

typedef enum os_kind { OS_NOTHING, OS_FILE, OS_FOLDER, OS_UNREACHABLE } os_kind;

/// What is at a path. OS_UNREACHABLE: errno says why that cannot be told.
os_kind os_kind_of(const char *path);
/// Whether files can be made in a folder.
bool os_is_writable(const char *folder);
/// Makes a folder; false with errno where that fails.
bool os_make_folder(const char *path);
/// Removes a folder if nothing is in it.
void os_remove_folder(const char *path);
/// Creates a file or empties the one that is there; NULL with errno.
FILE *os_create_file(const char *path);
void os_remove_file(const char *path);
/// Gives a file another name, in place of a file that has that name; false with errno.
bool os_replace(const char *from, const char *to);

#endif
