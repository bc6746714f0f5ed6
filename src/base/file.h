// Reads whole files, and writes files that appear completely or not at all.
#ifndef KI_FILE_H
#define KI_FILE_H

#include "base/base.h"

/// Returns whether a path ends with `ending`, for example ".exr" or "/", and has characters before
/// the ending. `ending` is lower-case; the path may have capital letters.
bool ki_ends_with(const char *path, const char *ending);

/// Reads a whole file into memory of the context. The path "-" is standard input. The caller frees
/// `bytes`.
kiln_result ki_file_read(kiln_context *context, const char *path, uint8_t **bytes, size_t *size,
                         kiln_error *error);

/// A file that is open for reading at any place.
typedef struct ki_open_file {
    int descriptor;
    uint64_t size; ///< size of the file in bytes when it was opened
} ki_open_file;

/// Opens a file for reading at any place. Returns false for standard input, for what is no regular
/// file, and where the system can only read files from the beginning to the end.
bool ki_file_open(const char *path, ki_open_file *file);
/// Reads exactly `size` bytes from byte `at` on, on any thread. Returns false if the file ends
/// before or cannot be read.
bool ki_file_read_at(const ki_open_file *file, uint64_t at, void *bytes, size_t size);
void ki_file_close(ki_open_file *file);

/// Writes a file that appears completely or not at all: writes a temporary file in the folder of
/// `path`, synchronises it to disk and renames it. A file that is replaced hands on its
/// permissions. A symbolic link stays, and the file to which the link leads is replaced. On failure
/// the file at `path` is unchanged and the temporary file is removed.
kiln_result ki_file_write(kiln_context *context, const char *path, const void *bytes, size_t size,
                          kiln_error *error);

/// A set of files that appear together: all files are written and synchronised under temporary
/// names before the first is renamed. A set in memory keeps its files in memory instead.
typedef struct ki_file_set ki_file_set;
/// A function that adds files to a set of files; `data` is what the caller passed to
/// ki_file_set_make.
typedef kiln_result ki_add_files(ki_file_set *set, void *data, kiln_error *error);
/// Makes one set of files: calls `add` once, then renames all files of the set, or moves them to
/// `files`, in the order in which they were added, if `files` is not NULL. On failure no file
/// appears, and `files` is empty.
kiln_result ki_file_set_make(kiln_context *context, ki_add_files *add, void *data,
                             kiln_files *files, kiln_error *error);
/// Creates a folder for files of the set, unless the folder exists. A set that fails removes the
/// folder again.
kiln_result ki_file_set_make_folder(ki_file_set *set, const char *path, kiln_error *error);
/// Calls `watch` with the caller's path and the bytes of each file that is added to the set from
/// now on. `watch` may be NULL.
void ki_file_set_watch(ki_file_set *set,
                       void (*watch)(void *user, const char *path, const void *bytes, size_t size),
                       void *user);
kiln_result ki_file_set_add(ki_file_set *set, const char *path, const void *bytes, size_t size,
                            kiln_error *error);

#endif
