// Describing bytes in memory that ends where the bytes end, so that a read behind the end shows.
#ifndef KILN_KIT_DESCRIBE_H
#define KILN_KIT_DESCRIBE_H

#include <kiln/kiln.h>

#include <stddef.h>

/// Describes a file in memory, in the context of context.h, without reading its pixels. Checks that
/// a message of the error names the file.
kiln_result describe(const void *bytes, size_t size, const char *name, kiln_file_info *info);

#endif
