#include "codec/engine_text.h"

#include "codec/decimal.h"
#include "codec/file_info.h"
#include "codec/pixel_format.h"

#include <stdio.h>
#include <string.h>

static const char *const atlases[] = {"cubeuv", "atlas"};

void ki_engine_text_write(ki_writer *w, const char *engine, const char *words, const kiln_map *map)
{
    ki_write_text(w, "engine=%s%s roughness=", engine, words);
    for (int k = 0; k < map->level_count; k++) {
        ki_write_text(w, k ? "," : "");
        ki_write_number(w, (double)map->roughness[k]);
    }
    ki_write_u8(w, 0);
}

// Copies the value of the word "KEY=VALUE" in a line to `value`, or "" if the line has no such
// word.
static void find_word(const char *text, const char *key, char *value, size_t room)
{
    size_t length = strlen(key);
    value[0] = 0;
    for (; text; text = strchr(text, ' ')) {
        text += *text == ' ';
        if (strncmp(text, key, length) != 0 || text[length] != '=')
            continue;
        snprintf(value, room, "%.*s", (int)strcspn(text + length + 1, " "), text + length + 1);
        return;
    }
}

static void read_levels(const char *list, kiln_file_info *info)
{
    float roughness[KILN_MAX_LEVELS] = {0};
    int count = 0;
    for (double value; *list; list += *list == ',') {
        list = ki_parse_number(list, &value);
        if (!list || count == KILN_MAX_LEVELS || !(value >= 0) || !(value <= 1) ||
            (*list && *list != ','))
            return;
        roughness[count++] = (float)value;
    }
    memcpy(info->roughness, roughness, (size_t)count * sizeof *roughness);
    info->level_count = count ? count : info->level_count;
}

void ki_engine_text_read(const char *text, kiln_file_info *info)
{
    char word[KILN_MAX_LEVELS * 16];
    find_word(text, "engine", word, sizeof word);
    ki_copy_printable(info->engine, sizeof info->engine, word);
    find_word(text, "layout", word, sizeof word);
    for (size_t i = 0; i < sizeof atlases / sizeof *atlases; i++)
        if (!strcmp(word, atlases[i]))
            snprintf(info->layout, sizeof info->layout, "%s", atlases[i]);
    find_word(text, "format", word, sizeof word);
    for (int i = KILN_FORMAT_RGBM; i <= KILN_FORMAT_RGBP; i++)
        if (!strcmp(word, ki_format_names[i]))
            snprintf(info->encoding, sizeof info->encoding, "8 bits %s", ki_format_names[i]);
    find_word(text, "roughness", word, sizeof word);
    read_levels(word, info);
}

bool ki_is_atlas(const kiln_file_info *info)
{
    for (size_t i = 0; i < sizeof atlases / sizeof *atlases; i++)
        if (!strcmp(info->layout, atlases[i]))
            return true;
    return false;
}
