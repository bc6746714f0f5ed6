// Writes JSON to standard output piece by piece, indented by tabs or on one line. Numbers have a
// decimal point in every locale. Bytes of text that are not UTF-8 are replaced, so the output is
// always valid.
#ifndef KILN_CLI_JSON_H
#define KILN_CLI_JSON_H

#include <kiln/kiln.h>

#include <stdbool.h>

enum { JSON_DEPTH = 16 };

typedef struct json {
    bool line; ///< true: everything on one line, without tabs and line breaks between values
    int depth;
    /// array: whether an array is open at each depth; filled: whether that array or object has a
    /// member
    bool array[JSON_DEPTH + 1], filled[JSON_DEPTH + 1];
} json;

// `key` is the name of a member; NULL inside an array and for the outermost value.
void json_object(json *j, const char *key);
void json_array(json *j, const char *key);
/// Closes the object or array that was opened last. A line break follows the outermost value.
void json_end(json *j);
/// Writes 15 digits if they identify the number, else 17 digits; a number that is not finite
/// becomes null.
void json_number(json *j, const char *key, double value);
/// Writes a number rounded to `digits` significant digits, such as 9 for a float.
void json_rounded(json *j, const char *key, double value, int digits);
/// Writes the shortest decimal number that rounds to this float.
void json_float(json *j, const char *key, float value);
void json_bool(json *j, const char *key, bool value);
/// Writes text; bytes that are not UTF-8 become U+FFFD.
void json_text(json *j, const char *key, const char *text);
/// Writes the array "notes" with the sentences of a report.
void json_notes(json *j, const kiln_load_report *report);
/// Writes the array "lights" with the members that kiln_lights_save writes.
void json_lights(json *j, const kiln_lights *lights);

#endif
