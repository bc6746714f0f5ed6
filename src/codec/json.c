// A JSON reader in one pass (json.h). In: bytes that are not trusted. Out: the keys, strings,
// numbers and flags that the caller asks for, one after the other. Skipping a value counts brackets
// instead of recursing, so that deep nesting costs no stack. The first error sets `failed`.
#include "codec/json.h"

#include "codec/decimal.h"

#include <math.h>
#include <string.h>

enum { BYTES_BETWEEN_QUESTIONS = 1 << 20 };

ki_json ki_json_make(kiln_context *context, const void *bytes, size_t size)
{
    return (ki_json){
        .at = bytes, .end = (const char *)bytes + size, .ask = bytes, .context = context};
}

// Asks the caller of the library, once for each megabyte, whether to go on.
static void ask(ki_json *j)
{
    size_t left = (size_t)(j->end - j->at);
    j->ask = j->at + (left < BYTES_BETWEEN_QUESTIONS ? left : BYTES_BETWEEN_QUESTIONS);
    if (!ki_go_on(j->context))
        j->failed = j->stopped = true;
}

// Returns the next byte that is not white space, without consuming it; 0 at the end.
static char peek(ki_json *j)
{
    for (;; j->at++) {
        if (j->at >= j->ask && j->at < j->end)
            ask(j);
        if (j->at == j->end || j->failed)
            return 0;
        if (*j->at != ' ' && *j->at != '\t' && *j->at != '\n' && *j->at != '\r')
            return *j->at;
    }
}

static bool take(ki_json *j, char wanted)
{
    if (peek(j) != wanted || !wanted)
        return false;
    j->at++;
    return true;
}

static void expect(ki_json *j, char wanted)
{
    if (!take(j, wanted))
        j->failed = true;
}

void ki_json_enter_object(ki_json *j)
{
    expect(j, '{');
}

void ki_json_enter_array(ki_json *j)
{
    expect(j, '[');
}

bool ki_json_item(ki_json *j)
{
    if (take(j, ']'))
        return false;
    take(j, ',');
    if (!peek(j))
        j->failed = true;
    return !j->failed;
}

bool ki_json_member(ki_json *j, char *key, size_t room)
{
    key[0] = 0;
    if (take(j, '}'))
        return false;
    take(j, ',');
    ki_json_string(j, key, room);
    expect(j, ':');
    return !j->failed;
}

void ki_json_string(ki_json *j, char *text, size_t room)
{
    size_t length = 0;
    text[0] = 0;
    expect(j, '"');
    while (!j->failed && j->at < j->end && *j->at != '"') {
        if (*j->at == '\\' && j->at + 1 < j->end && length + 1 < room)
            text[length++] = *j->at++;
        else if (*j->at == '\\' && j->at + 1 < j->end)
            j->at++;
        if (length + 1 < room)
            text[length++] = *j->at;
        j->at++;
        if (j->at >= j->ask && j->at < j->end)
            ask(j);
    }
    text[length] = 0;
    if (j->at == j->end)
        j->failed = true;
    else
        expect(j, '"');
}

// Reads a number. The parser of numbers expects a NUL after the number, which the bytes need not
// have, so the number is copied.
double ki_json_number(ki_json *j)
{
    char text[64];
    size_t length = 0;
    double value = 0;
    peek(j);
    while (j->at + length < j->end && length + 1 < sizeof text &&
           strchr("+-.0123456789eE", j->at[length]) && j->at[length])
        length++;
    memcpy(text, j->at, length);
    text[length] = 0;
    const char *end = j->failed ? NULL : ki_parse_number(text, &value);
    if (!end || *end || !isfinite(value)) {
        j->failed = true;
        return 0;
    }
    j->at += length;
    return value;
}

uint32_t ki_json_count(ki_json *j, uint32_t most)
{
    double value = ki_json_number(j);
    if (!(value >= 0) || value > most || value != floor(value)) {
        j->failed = true;
        return 0;
    }
    return (uint32_t)value;
}

bool ki_json_flag(ki_json *j)
{
    peek(j);
    size_t left = (size_t)(j->end - j->at);
    bool yes = left >= 4 && !memcmp(j->at, "true", 4);
    if (j->failed || (!yes && (left < 5 || memcmp(j->at, "false", 5) != 0))) {
        j->failed = true;
        return false;
    }
    j->at += yes ? 4 : 5;
    return yes;
}

void ki_json_triple(ki_json *j, double triple[3])
{
    ki_json_enter_array(j);
    for (int c = 0; c < 3; c++) {
        if (!j->failed && !ki_json_item(j))
            j->failed = true; // the array has too few numbers
        triple[c] = ki_json_number(j);
    }
    if (!j->failed && ki_json_item(j))
        j->failed = true; // the array has too many numbers
}

// Skips a number, or a word such as null.
static void skip_word(ki_json *j)
{
    const char *from = j->at;
    while (j->at < j->end && *j->at && !strchr("{}[]\",: \t\r\n", *j->at)) {
        j->at++;
        if (j->at >= j->ask && j->at < j->end)
            ask(j);
        if (j->failed)
            return;
    }
    if (j->at == from)
        j->failed = true;
}

void ki_json_skip(ki_json *j)
{
    char unused[1];
    size_t depth = 0;
    do {
        char c = peek(j);
        if (c == '"')
            ki_json_string(j, unused, sizeof unused);
        else if (c == '{' || c == '[' || ((c == '}' || c == ']') && depth > 0) ||
                 ((c == ',' || c == ':') && depth > 0))
            j->at++;
        else
            skip_word(j);
        depth += c == '{' || c == '[';
        depth -= (c == '}' || c == ']') && depth > 0;
    } while (depth > 0 && !j->failed);
}
