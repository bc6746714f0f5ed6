// Numbers as decimal text, with a decimal point in every locale.
#ifndef KI_DECIMAL_H
#define KI_DECIMAL_H

#include "base/bytes.h"

/// Reads a number of at most 300 digits after spaces and tabs, precise to about 15 digits. A number
/// too large for a double is infinite. Returns a pointer to the text after the number, or NULL if
/// there is no number.
const char *ki_parse_number(const char *text, double *value);
/// Writes a number with nine digits, from which reading gives the same float.
void ki_write_number(ki_writer *writer, double value);
/// Writes a float with the fewest of six to nine digits from which reading gives the same float.
/// The text has a point or an exponent, as C and GLSL require of a floating-point constant.
void ki_write_float(ki_writer *writer, float value);

#endif
