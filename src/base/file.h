// Files, read whole and written whole or not at all.
#ifndef KI_FILE_H
#define KI_FILE_H

#include "base/base.h"

/// Whether a path has this ending, ".exr" or "/", and something before it. Letters of the path may be
/// capitals, those of `ending` are small.
bool ki_ends_with(const char *path, const char *ending);

/// Reads a whole file into memory of the context; "-" is standard input. The caller frees `bytes`.
kiln_result ki_file_read(kiln_context *context, const char *path, uint8_t **bytes, size_t *size,
                         kiln_error *error);
/// Writes a temporary file beside `path`, syncs it and renames it. On failure, `path` is as it was
/// and no temporary file is left.
kiln_result ki_file_write(kiln_context *context, const char *path, const void *bytes, size_t size,
                          kiln_error *error);

/// Several files that appear together: all are written and synced under temporary names before the
/// first is renamed. Or files that stay in memory.
typedef struct ki_file_set ki_file_set;
ki_file_set *ki_file_set_begin(kiln_context *context);
ki_file_set *ki_file_set_begin_in_memory(kiln_context *context);
/// Makes a folder that files of the set are in, unless it exists. A set that fails removes it again.
kiln_result ki_file_set_make_folder(ki_file_set *set, const char *path, kiln_error *error);
kiln_result ki_file_set_add(ki_file_set *set, const char *path, const void *bytes, size_t size,
                            kiln_error *error);
/// Renames all. The set is gone afterwards, whatever happens.
kiln_result ki_file_set_commit(ki_file_set *set, kiln_error *error);
/// The files of a set in memory, in the order in which they came. The set is gone afterwards.
kiln_result ki_file_set_take(ki_file_set *set, kiln_files *files, kiln_error *error);
/// Commits the set, or takes its files where `files` is not NULL; after a failure abandons it and
/// returns that failure. `set` may be NULL, which is a failure to allocate it.
kiln_result ki_file_set_end(kiln_context *context, ki_file_set *set, kiln_result result,
                            kiln_files *files, kiln_error *error);
/// Removes all temporary files and the set. May be NULL.
void ki_file_set_abandon(ki_file_set *set);

#endif
