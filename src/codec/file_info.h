// Filling kiln_file_info.
#ifndef KI_FILE_INFO_H
#define KI_FILE_INFO_H

#include "base/base.h"

/// Zeros, but for one face, one slice, and a roughness that no file has stated.
void ki_file_info_clear(kiln_file_info *info, size_t byte_count);
/// Copies what is printable of a text, up to its first other character and as much as there is room.
void ki_copy_printable(char *to, size_t room, const char *text);
/// The nearest finite float; 0 where the value is not a number.
float ki_info_number(double value);

#endif
