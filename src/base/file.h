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
/// first is renamed.
typedef struct ki_file_set ki_file_set;
ki_file_set *ki_file_set_begin(kiln_context *context);
kiln_result ki_file_set_add(ki_file_set *set, const char *path, const void *bytes, size_t size,
                            kiln_error *error);
/// Renames all. The set is gone afterwards, whatever happens.
kiln_result ki_file_set_commit(ki_file_set *set, kiln_error *error);
/// Removes all temporary files and the set. May be NULL.
void ki_file_set_abandon(ki_file_set *set);

#endif
