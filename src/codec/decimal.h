// Numbers as decimal text, with a point whatever the program's locale is.
#ifndef KI_DECIMAL_H
#define KI_DECIMAL_H

#include "base/bytes.h"

/// Reads a number after spaces and tabs, right to about 15 digits. Returns what follows the number, or
/// NULL where there is none.
const char *ki_parse_number(const char *text, double *value);
/// Writes nine digits: enough for a float to come back as it was.
void ki_write_number(ki_writer *writer, double value);
/// Writes the shortest of six to nine digits that is this float again, with a point or an exponent,
/// which C and GLSL want.
void ki_write_float(ki_writer *writer, float value);

#endif
