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

// Reads one UTF-8 sequence (RFC 3629). Returns its number of bytes, and 0 if the sequence is invalid
// or stands for a control character.
static size_t printable_sequence(const unsigned char *at, size_t left)
{
    static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
    size_t count = *at < 0x80             ? 1
                   : (*at & 0xe0) == 0xc0 ? 2
                   : (*at & 0xf0) == 0xe0 ? 3
                   : (*at & 0xf8) == 0xf0 ? 4
                                          : 0;
    if (!count || count > left)
        return 0;
    uint32_t point = count == 1 ? *at : *at & (0x7fU >> count);
    for (size_t i = 1; i < count; i++) {
        if ((at[i] & 0xc0) != 0x80)
            return 0;
        point = point << 6 | (at[i] & 0x3fU);
    }
    bool valid = point >= least[count] && point < 0x110000 && (point & ~0x7ffU) != 0xd800;
    bool control = point < 0x20 || (point >= 0x7f && point < 0xa0) ||
                   (point >= 0x200e && point <= 0x200f) || (point >= 0x2028 && point <= 0x202e) ||
                   (point >= 0x2066 && point <= 0x2069) || point == 0x61c || point == 0xfeff;
    return valid && !control ? count : 0;
}

void ki_escape_text(char *to, size_t room, const char *text, size_t length)
{
    const unsigned char *at = (const unsigned char *)text, *end = at + length;
    size_t used = 0, fits = 0; // `fits` bytes leave room for the three dots
    while (at < end) {
        char piece[8];
        size_t count = printable_sequence(at, (size_t)(end - at)), size = count;
        if (!count || *at == '\\') {
            snprintf(piece, sizeof piece, count ? "\\\\" : "\\x%02x", (unsigned)*at);
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
