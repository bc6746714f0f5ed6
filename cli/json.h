// A report as JSON, written to standard output piece by piece, with a tab for each depth of objects.
// Numbers have a point whatever the locale; text is valid UTF-8 whatever a file's name holds.
#ifndef KILN_CLI_JSON_H
#define KILN_CLI_JSON_H

#include <stdbool.h>

enum { JSON_DEPTH = 16 };

typedef struct json {
    int depth;
    bool array[JSON_DEPTH + 1], filled[JSON_DEPTH + 1]; ///< by depth
} json;

// `key` is the name of a member of an object; NULL in an array and for the whole.
void json_object(json *j, const char *key);
void json_array(json *j, const char *key);
/// Closes the object or array opened last; a line break ends the whole.
void json_end(json *j);
/// 15 digits where they tell the number from its neighbours, else 17; not finite becomes null.
void json_number(json *j, const char *key, double value);
/// A number whose decimal digits are no more than `digits`, such as 9 for a float.
void json_rounded(json *j, const char *key, double value, int digits);
/// The shortest number that is still this float.
void json_float(json *j, const char *key, float value);
void json_bool(json *j, const char *key, bool value);
/// What is no UTF-8 becomes U+FFFD.
void json_text(json *j, const char *key, const char *text);

#endif
