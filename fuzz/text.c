// Lines of text, numbers, JSON, and text that is shown. Numbers are compared with strtod, and
// tables' descriptions with what was written of them again.
#include "fuzz.h"

#include "codec/decimal.h"
#include "codec/engine_text.h"
#include "codec/file_info.h"
#include "codec/json.h"
#include "table/table_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The line by which a file for an engine describes itself.
void fuzz_engine_text(const uint8_t *bytes, size_t size)
{
    kiln_file_info info;
    ki_file_info_clear(&info, size);
    snprintf(info.format, sizeof info.format, "fuzz");
    snprintf(info.layout, sizeof info.layout, "fuzz");
    info.width = info.height = 1;
    char *text = fuzz_text(bytes, size);
    ki_engine_text_read(text, &info);
    fuzz_check_info(&info);
    ki_is_atlas(&info);
    free(text);
}

// The description of a table: written again, it says the same.
void fuzz_table_text(const uint8_t *bytes, size_t size)
{
    kiln_table_def def, again;
    char *text = fuzz_text(bytes, size), written[KI_TABLE_TEXT];
    if (ki_table_parse(text, &def)) {
        ki_table_describe(&def, written);
        fuzz_must(ki_table_parse(written, &again) && !memcmp(&def, &again, sizeof def));
    }
    free(text);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// A number has the value that C's library reads, to 13 digits, and ends where that library says.
void fuzz_number(const uint8_t *bytes, size_t size)
{
    enum { LONGEST = 250 }; // more digits are refused
    char *text = fuzz_text(bytes, size < LONGEST ? size : LONGEST), *end;
    double value = 0, wanted = strtod(text, &end);
    const char *to = ki_parse_number(text, &value), *from = text + strspn(text, " \t");
    from += *from == '-' || *from == '+';
    bool number = is_digit(from[0]) || (from[0] == '.' && is_digit(from[1]));
    bool hexadecimal = from[0] == '0' && (from[1] == 'x' || from[1] == 'X');
    fuzz_must((to != NULL) == number);
    if (number && !hexadecimal) {
        fuzz_must(to == end);
        fuzz_must(value == wanted || fabs(value - wanted) <= 1e-13 * fabs(wanted) + 1e-320);
    }
    free(text);
}

static void walk(ki_json *json, int depth)
{
    enum { DEEPEST = 64 };
    char key[16];
    while (json->at < json->end && strchr(" \t\r\n", *json->at) && *json->at)
        json->at++;
    char next = json->at < json->end ? *json->at : 0;
    if (depth > DEEPEST || json->failed) {
        ki_json_skip(json);
    } else if (next == '{') {
        ki_json_enter_object(json);
        while (ki_json_member(json, key, sizeof key))
            walk(json, depth + 1);
    } else if (next == '[') {
        ki_json_enter_array(json);
        while (ki_json_item(json))
            walk(json, depth + 1);
    } else if (next == '"') {
        ki_json_string(json, key, sizeof key);
        fuzz_must_end(key, sizeof key);
    } else if (next == 't' || next == 'f') {
        ki_json_flag(json);
    } else if (next == '-' || is_digit(next)) {
        fuzz_must(isfinite(ki_json_number(json)));
    } else {
        ki_json_skip(json);
    }
}

// JSON whose values are read by their kind. An object or array that is read so can be skipped as a
// whole.
void fuzz_json(const uint8_t *bytes, size_t size)
{
    kiln_context *context = fuzz_context(0);
    uint8_t *copy = malloc(size ? size : 1);
    fuzz_must(copy != NULL);
    if (size)
        memcpy(copy, bytes, size);
    ki_json read = ki_json_make(context, copy, size), skipped = read;
    walk(&read, 0);
    ki_json_skip(&skipped);
    bool nested = size && (bytes[0] == '{' || bytes[0] == '[');
    fuzz_must(!nested || read.failed || (!skipped.failed && skipped.at == read.at));
    fuzz_must(read.at <= read.end && skipped.at <= skipped.end);
    double triple[3];
    ki_json three = ki_json_make(context, copy, size);
    ki_json_triple(&three, triple);
    ki_json whole = ki_json_make(context, copy, size);
    fuzz_must(ki_json_count(&whole, 1000) <= 1000);
    free(copy);
    fuzz_end(context);
}

static void must_be_shown(const char *text)
{
    while (*text) {
        unsigned code;
        bool shown = true;
        text += kiln_text_step(text, &code, &shown);
        fuzz_must(shown);
    }
}

// Text that was cleaned or escaped can be shown, and fits into its room.
void fuzz_shown_text(const uint8_t *bytes, size_t size)
{
    char *text = fuzz_text(bytes, size), escaped[64];
    for (size_t room = 8; room <= sizeof escaped; room += 7) {
        char *exact = malloc(room);
        fuzz_must(exact != NULL);
        ki_escape_text(exact, room, text, size);
        fuzz_must_end(exact, room);
        must_be_shown(exact);
        free(exact);
    }
    ki_copy_printable(escaped, sizeof escaped, text);
    fuzz_must_end(escaped, sizeof escaped);
    kiln_text_clean(text);
    must_be_shown(text);
    free(text);
}
