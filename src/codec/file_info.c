#include "codec/file_info.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

void ki_file_info_clear(kiln_file_info *info, size_t byte_count)
{
    memset(info, 0, sizeof *info);
    info->byte_count = byte_count;
    info->face_count = info->depth = 1;
    for (int k = 0; k < KILN_MAX_LEVELS; k++)
        info->roughness[k] = -1;
}

void ki_copy_printable(char *to, size_t room, const char *text)
{
    size_t i = 0;
    for (; i + 1 < room && text[i] >= ' ' && text[i] <= '~'; i++)
        to[i] = text[i];
    to[i] = 0;
}

// Returns the number of bytes of the character at `at`, or 0 if the bytes are no UTF-8 or a
// terminal would obey the character.
static size_t printable_sequence(const char *at, size_t left)
{
    unsigned code;
    bool shown;
    int length = ki_text_step(at, left, &code, &shown);
    return shown ? (size_t)length : 0;
}

void ki_escape_text(char *to, size_t room, const char *text, size_t length)
{
    const char *at = text, *end = at + length;
    size_t used = 0, fits = 0; // `fits` bytes leave room for the three dots
    while (at < end) {
        char piece[8];
        size_t count = printable_sequence(at, (size_t)(end - at)), size = count;
        if (!count || *at == '\\') {
            snprintf(piece, sizeof piece, count ? "\\\\" : "\\x%02x", (unsigned)(unsigned char)*at);
            count = 1;
            size = strlen(piece);
        } else {
            memcpy(piece, at, count);
        }
        if (used + size + 1 > room) {
            memcpy(to + fits, "...", 4);
            return;
        }
        memcpy(to + used, piece, size);
        used += size;
        fits = used + 4 <= room ? used : fits;
        at += count;
    }
    to[used] = 0;
}

float ki_info_number(double value)
{
    const double most = (double)FLT_MAX;
    return (float)(value > most ? most : value < -most ? -most : value == value ? value : 0);
}
