// Files under temporary names, and the temporary files that killed runs have left.
#ifndef KI_TEMPORARY_H
#define KI_TEMPORARY_H

#include "base/os.h"

/// Number of bytes, with the final NUL, of a temporary file's name after the path of its folder.
enum { KI_TEMPORARY_ROOM = 64 };

/// Returns the length of the part of a path that names the folder, with the separator at its end.
/// The length is 0 for a file of the current folder.
size_t ki_folder_length(const char *path);
/// Creates a file with a temporary name in the folder of `path` and returns its descriptor, or -1
/// with errno set. `name` has room for the folder and KI_TEMPORARY_ROOM bytes. The name is short,
/// so that `path` may be as long as the file system allows. Other runs do not remove the file while
/// the descriptor is open.
int ki_temporary_create(const char *path, char *name, size_t room);
/// Removes the temporary files in the folder of `path` that no running process holds.
void ki_temporary_sweep(const char *path);

#endif
