#include "codec/file_info.h"

#include <float.h>
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

float ki_info_number(double value)
{
    const double most = (double)FLT_MAX;
    return (float)(value > most ? most : value < -most ? -most : value == value ? value : 0);
}
