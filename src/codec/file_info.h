// Helpers that fill kiln_file_info.
#ifndef KI_FILE_INFO_H
#define KI_FILE_INFO_H

#include "base/base.h"

/// Greatest length in bytes of a key and its text in the metadata of KTX files that is looked at.
/// kiln's own have less than 10 kB.
enum { KI_KTX_TEXT = 1 << 20 };

/// Sets the description of a file of `byte_count` bytes to zero, except for one face, one slice and
/// -1 for each level's roughness.
void ki_file_info_clear(kiln_file_info *info, size_t byte_count);
/// Copies a text up to its first character that is not printable, truncated to `room`.
void ki_copy_printable(char *to, size_t room, const char *text);
/// Copies `length` bytes of a file's text so that the copy may be printed: control characters, also
/// those of Unicode that turn the direction of writing, and bytes that are not UTF-8 become \xNN, a
/// backslash becomes two. A copy that does not fit into `room` bytes is cut and ends in "...".
void ki_escape_text(char *to, size_t room, const char *text, size_t length);
/// Returns the finite float nearest to a value, or 0 for not-a-number.
float ki_info_number(double value);

#endif
