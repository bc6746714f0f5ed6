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
/// Writes a temporary file in the folder of `path`, synchronises it to disk and renames it. On
/// failure the file at `path` is unchanged and the temporary file is removed.
kiln_result ki_file_write(kiln_context *context, const char *path, const void *bytes, size_t size,
                          kiln_error *error);

/// A set of files that appear together: all files are written and synchronised under temporary
/// names before the first is renamed. A set in memory keeps its files in memory instead.
typedef struct ki_file_set ki_file_set;
ki_file_set *ki_file_set_begin(kiln_context *context);
ki_file_set *ki_file_set_begin_in_memory(kiln_context *context);
/// Creates a folder for files of the set, unless the folder exists. A set that fails removes the
/// folder again.
kiln_result ki_file_set_make_folder(ki_file_set *set, const char *path, kiln_error *error);
kiln_result ki_file_set_add(ki_file_set *set, const char *path, const void *bytes, size_t size,
                            kiln_error *error);
/// Renames all files of a set and frees the set, on failure too.
kiln_result ki_file_set_commit(ki_file_set *set, kiln_error *error);
/// Moves the files of a set in memory to `files`, in the order in which they were added, and frees
/// the set.
kiln_result ki_file_set_take(ki_file_set *set, kiln_files *files, kiln_error *error);
/// Ends a set. With `result` KILN_OK, commits the set, or takes its files if `files` is not NULL.
/// With any other `result`, abandons the set and returns `result`. `set` NULL counts as a failed
/// allocation of the set.
kiln_result ki_file_set_end(kiln_context *context, ki_file_set *set, kiln_result result,
                            kiln_files *files, kiln_error *error);
/// Removes all temporary files and frees the set. `set` may be NULL.
void ki_file_set_abandon(ki_file_set *set);

#endif
