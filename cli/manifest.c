// A reader of JSON (RFC 8259) for lists of work: objects one after the other, with blanks and line
// breaks between. In: bytes in memory. Out: the members of each object. Method: one pass. A text
// without its escape sequences is not longer than before, so that it is written over the bytes that
// it is read from, with a NUL in place of the closing quotation mark.
#include "manifest.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static bool fail(manifest_reader *r, const char *problem)
{
    if (!r->problem) {
        r->problem = problem;
        r->problem_line = r->line;
    }
    return false;
}

static void skip_blanks(manifest_reader *r)
{
    for (; r->at < r->end && strchr(" \t\r\n", *r->at) && *r->at; r->at++)
        r->line += *r->at == '\n';
}

// Steps over a character, with the blanks before it.
static bool skip(manifest_reader *r, char c)
{
    skip_blanks(r);
    if (r->at == r->end || *r->at != c)
        return false;
    r->at++;
    return true;
}

// Reads four hexadecimal digits; returns -1 if there are none.
static int read_hex(manifest_reader *r)
{
    int code = 0;
    if (r->end - r->at < 4)
        return -1;
    for (int i = 0; i < 4; i++, r->at++) {
        const char *digits = "0123456789abcdef";
        char c = *r->at >= 'A' && *r->at <= 'F' ? (char)(*r->at - 'A' + 'a') : *r->at;
        const char *digit = c ? strchr(digits, c) : NULL;
        if (!digit)
            return -1;
        code = 16 * code + (int)(digit - digits);
    }
    return code;
}

static char *write_utf8(char *to, unsigned code)
{
    if (code < 0x80) {
        *to++ = (char)code;
        return to;
    }
    int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const unsigned char first[] = {0, 0xc0, 0xe0, 0xf0};
    *to++ = (char)(first[more] | code >> (6 * more));
    while (more--)
        *to++ = (char)(0x80 | (code >> (6 * more) & 0x3f));
    return to;
}

// Reads the code of \uXXXX, of which two make a character above U+FFFF.
static bool read_code(manifest_reader *r, char **to)
{
    int code = read_hex(r);
    bool high = code >= 0xd800 && code < 0xdc00;
    if (code <= 0 || (code >= 0xdc00 && code < 0xe000))
        return fail(r, "a text has a code \\uXXXX that is no character");
    if (high) {
        bool second = r->end - r->at > 2 && r->at[0] == '\\' && r->at[1] == 'u';
        r->at += second ? 2 : 0;
        int low = second ? read_hex(r) : -1;
        if (low < 0xdc00 || low >= 0xe000)
            return fail(r, "a text has a code \\uXXXX that is no character");
        code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
    }
    *to = write_utf8(*to, (unsigned)code);
    return true;
}

static bool read_escape(manifest_reader *r, char **to)
{
    static const char from[] = "\"\\/bfnrt", into[] = "\"\\/\b\f\n\r\t";
    char c = r->at < r->end ? *r->at++ : 0;
    if (c == 'u')
        return read_code(r, to);
    const char *known = c ? strchr(from, c) : NULL;
    if (!known)
        return fail(r, "a text has an unknown escape sequence");
    *(*to)++ = into[known - from];
    return true;
}

// Reads a text whose quotation mark was read.
static char *read_text(manifest_reader *r)
{
    char *text = r->at, *to = r->at;
    while (r->at < r->end && *r->at != '"') {
        if ((unsigned char)*r->at < 0x20) {
            fail(r, "a text does not end, or holds a control character");
            return NULL;
        }
        if (*r->at != '\\')
            *to++ = *r->at++;
        else if (r->at++, !read_escape(r, &to))
            return NULL;
    }
    if (r->at == r->end) {
        fail(r, "a text does not end");
        return NULL;
    }
    r->at++;
    *to = 0;
    return text;
}

static bool read_word(manifest_reader *r, manifest_value *value)
{
    static const char *const words[] = {"true", "false", "null"};
    for (int i = 0; i < 3; i++) {
        size_t length = strlen(words[i]);
        if ((size_t)(r->end - r->at) >= length && !memcmp(r->at, words[i], length)) {
            r->at += length;
            value->kind = (manifest_kind)(MANIFEST_TRUE + i);
            return true;
        }
    }
    return fail(r, "a value is missing or of no known kind");
}

// Reads a number. Its text is moved one byte to the left, over the byte before, to make room for a
// NUL: a number follows a colon, a comma, a bracket or a blank, which was read.
static bool read_number(manifest_reader *r, manifest_value *value)
{
    char *from = r->at, *end;
    while (r->at < r->end && *r->at && strchr("+-.0123456789eE", *r->at))
        r->at++;
    size_t length = (size_t)(r->at - from);
    memmove(from - 1, from, length);
    from[length - 1] = 0;
    strtod(from - 1, &end);
    if (end != from + length - 1)
        return fail(r, "a number is not one");
    *value = (manifest_value){MANIFEST_NUMBER, from - 1};
    return true;
}

static bool read_value(manifest_reader *r, manifest_value *value)
{
    *value = (manifest_value){0};
    skip_blanks(r);
    char c = r->at < r->end ? *r->at : 0;
    if (c == '"') {
        r->at++;
        *value = (manifest_value){MANIFEST_TEXT, read_text(r)};
        return value->text != NULL;
    }
    if (c == '-' || (c >= '0' && c <= '9'))
        return read_number(r, value);
    return read_word(r, value);
}

static bool read_list(manifest_reader *r, manifest_member *member)
{
    member->value.kind = MANIFEST_LIST;
    if (skip(r, ']'))
        return true;
    do {
        if (member->item_count == MANIFEST_ITEMS)
            return fail(r, "a list has more than 64 items");
        if (!read_value(r, &member->item[member->item_count++]))
            return false;
    } while (skip(r, ','));
    return skip(r, ']') || fail(r, "a list does not end");
}

static bool read_member(manifest_reader *r, manifest_member *member)
{
    *member = (manifest_member){0};
    if (!skip(r, '"'))
        return fail(r, "a member must begin with its name in quotation marks");
    member->key = read_text(r);
    if (!member->key)
        return false;
    if (!skip(r, ':'))
        return fail(r, "a colon is missing after a name");
    return skip(r, '[') ? read_list(r, member) : read_value(r, &member->value);
}

int manifest_read(manifest_reader *r, manifest_member *members)
{
    int count = 0;
    skip_blanks(r);
    r->object_line = r->line;
    if (r->at == r->end)
        return -1;
    if (!skip(r, '{')) {
        fail(r, "a line must be an object: { ... }");
        return -1;
    }
    if (skip(r, '}'))
        return 0;
    do {
        if (count == MANIFEST_MEMBERS) {
            fail(r, "an object has more than 64 members");
            return -1;
        }
        if (!read_member(r, &members[count++]))
            return -1;
    } while (skip(r, ','));
    if (!skip(r, '}')) {
        fail(r, "an object does not end");
        return -1;
    }
    return count;
}
