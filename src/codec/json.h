// A JSON reader for untrusted bytes, in one pass: the caller asks for the value that should come
// next, and skips values it does not know. An unexpected byte sets `failed`, and every later call
// fails.
#ifndef KI_JSON_H
#define KI_JSON_H

#include "base/base.h"

typedef struct ki_json {
    const char *at, *end;
    const char *ask; // position from which on the caller of the library is asked whether to go on
    kiln_context *context;
    bool failed,
        stopped; // stopped: the caller of the library asked to stop, so that reading failed
} ki_json;

ki_json ki_json_make(kiln_context *context, const void *bytes, size_t size);

/// Enter an object or an array. Fail if the next value is of another kind.
void ki_json_enter_object(ki_json *json);
void ki_json_enter_array(ki_json *json);
/// Reads the key of the next member, truncated to `room`. Returns false after the last member and
/// leaves the object.
bool ki_json_member(ki_json *json, char *key, size_t room);
/// Returns whether the array has another item. Returns false after the last item and leaves the
/// array.
bool ki_json_item(ki_json *json);

/// Reads a number. Fails and returns 0 if the next value is not a number.
double ki_json_number(ki_json *json);
/// Reads an integer of 0 to `most`.
uint32_t ki_json_count(ki_json *json, uint32_t most);
/// Reads a string, truncated to `room`. Escape sequences are not decoded.
void ki_json_string(ki_json *json, char *text, size_t room);
/// Reads `true` or `false`.
bool ki_json_flag(ki_json *json);
/// Skips a value of any kind.
void ki_json_skip(ki_json *json);
/// Reads an array of three numbers.
void ki_json_triple(ki_json *json, double triple[3]);

#endif
