// Text. In: printf formats, and bytes that may come out of files. Out: text whose numbers have a
// decimal point in every locale, and text that a terminal shows without obeying it. Method: printf
// runs in the locale "C"; characters are decoded as UTF-8 (RFC 3629).
#include "base/base.h"
#include "base/os.h"

#include <stdio.h>
#include <string.h>

int ki_print(char *text, size_t room, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int length = ki_os_print(text, room, format, list);
    va_end(list);
    return length;
}

void ki_print_clean(char *text, size_t room, const char *format, va_list list)
{
    ki_os_print(text, room, format, list);
    kiln_text_clean(text);
}

// Length of the UTF-8 sequence at `at`; 0 if the `left` bytes there do not begin with such a
// sequence. Overlong sequences, surrogates and values above U+10FFFF are none.
static int sequence(const unsigned char *at, size_t left)
{
    static const struct {
        // range of first bytes, and the range of second bytes that UTF-8 allows after these first
        // bytes
        unsigned char first, last, low, high;
        int length;
    } forms[] = {
        {0x00, 0x7f, 0x00, 0x00, 1}, {0xc2, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
        {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3}, {0xee, 0xef, 0x80, 0xbf, 3},
        {0xf0, 0xf0, 0x90, 0xbf, 4}, {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4}};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if (*at < forms[i].first || *at > forms[i].last)
            continue;
        if (left < (size_t)forms[i].length)
            return 0;
        if (forms[i].length > 1 && (at[1] < forms[i].low || at[1] > forms[i].high))
            return 0;
        for (int k = 2; k < forms[i].length; k++)
            if ((at[k] & 0xc0) != 0x80)
                return 0;
        return forms[i].length;
    }
    return 0;
}

// The code point of a valid sequence.
static uint32_t decode(const unsigned char *at, int length)
{
    static const unsigned char first[] = {0x7f, 0x1f, 0x0f, 0x07};
    uint32_t code = at[0] & first[length - 1];
    for (int i = 1; i < length; i++)
        code = code << 6 | (at[i] & 0x3fu);
    return code;
}

// Returns whether a terminal would act on a character rather than show it: controls of ASCII and of
// ISO 6429 (U+0080 to U+009F), separators of lines and paragraphs, marks that turn the direction of
// the text around (U+061C, U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069).
static bool is_obeyed(uint32_t code)
{
    return code < 0x20 || (code >= 0x7f && code <= 0x9f) || code == 0x61c || code == 0x200e ||
           code == 0x200f || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2066 && code <= 0x2069) || code == 0xfeff;
}

int ki_text_step(const char *text, size_t left, unsigned *code, bool *shown)
{
    const unsigned char *at = (const unsigned char *)text;
    int length = sequence(at, left);
    *code = length ? decode(at, length) : 0xfffd;
    *shown = length && !is_obeyed(*code);
    return length ? length : 1;
}

int kiln_text_step(const char *text, unsigned *code, bool *shown)
{
    enum { LONGEST = 4 }; // a NUL ends a shorter sequence, since no sequence has a NUL inside
    return ki_text_step(text, LONGEST, code, shown);
}

void kiln_text_clean(char *text)
{
    char *to = text;
    while (*text) {
        unsigned code;
        bool shown;
        int length = kiln_text_step(text, &code, &shown);
        if (shown)
            memmove(to, text, (size_t)length);
        else
            *to = '?';
        to += shown ? length : 1;
        text += length;
    }
    *to = 0;
}
