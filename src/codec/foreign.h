// Pictures of formats that kiln recognises but does not read.
#ifndef KI_FOREIGN_H
#define KI_FOREIGN_H

#include "base/base.h"

/// Fails with the name of the format and a program that converts the file, or returns KILN_OK if
/// the bytes are of no such format.
kiln_result ki_refuse_foreign(const uint8_t *bytes, size_t size, const char *name,
                              kiln_error *error);

#endif
