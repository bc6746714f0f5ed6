// JSON, read in one pass from bytes that are not trusted: the caller asks for what it expects next, and
// skips what it does not know. A wrong byte sets `failed`, after which every question fails.
#ifndef KI_JSON_H
#define KI_JSON_H

#include "base/base.h"

typedef struct ki_json {
    const char *at, *end;
    bool failed;
} ki_json;

ki_json ki_json_make(const void *bytes, size_t size);

/// Enters an object or an array; fails where the next value is none.
void ki_json_enter_object(ki_json *json);
void ki_json_enter_array(ki_json *json);
/// The key of the next member, cut off at `room`; false behind the last, which leaves the object.
bool ki_json_member(ki_json *json, char *key, size_t room);
/// Whether there is one more item; false behind the last, which leaves the array.
bool ki_json_item(ki_json *json);

/// A number; 0 where the next value is none, which is a failure.
double ki_json_number(ki_json *json);
/// A number that is whole and from 0 to `most`.
uint32_t ki_json_count(ki_json *json, uint32_t most);
/// A string, cut off at `room`. Escapes stay as they are written.
void ki_json_string(ki_json *json, char *text, size_t room);
/// `true` or `false`.
bool ki_json_flag(ki_json *json);
/// Passes over a value of any kind.
void ki_json_skip(ki_json *json);
/// An array of three numbers.
void ki_json_triple(ki_json *json, double triple[3]);

#endif
