// Converts a kiln_table_def to its line of text and back.
#include "table/table_text.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

static const char *const kind_names[] = {
    "e", "eavg", "dfg", "dfg-multiscatter", "sheen", "e-dielectric", "glass", "e-walk", NULL};
static const char *const d_names[] = {"ggx", "beckmann", NULL};
static const char *const g_names[] = {"smith", "smith-uncorrelated", "schlick-k2", "schlick-text",
                                      NULL};
static const char *const sheen_names[] = {"ashikhmin", "estevez", NULL};
static const char *const axis_names[] = {"linear", "sqrt", "cbrt", "grazing", NULL};

const char *const *kiln_d_names(void)
{
    return d_names;
}

const char *const *kiln_g_names(void)
{
    return g_names;
}

const char *const *kiln_sheen_names(void)
{
    return sheen_names;
}

const char *const *kiln_table_kind_names(void)
{
    return kind_names;
}

const char *const *kiln_axis_names(void)
{
    return axis_names;
}

void ki_table_describe(const kiln_table_def *def, char text[KI_TABLE_TEXT])
{
    snprintf(text, KI_TABLE_TEXT,
             "kind=%s d=%s g=%s sheen=%s axis=%s corners=%d complement=%d flip=%d size=%dx%dx%d "
             "paths=%d",
             kind_names[def->kind], d_names[def->model.d], g_names[def->model.g],
             sheen_names[def->sheen], axis_names[def->axis], def->corners, def->complement,
             def->flip, def->width, def->height, def->depth, def->path_count);
}

// Reads "KEY=WORD ", where KEY is `key`, and sets *value to the index of WORD in `words`. Returns
// the text that follows, or NULL if `text` does not begin in this way or is NULL.
static const char *parse_word(const char *text, const char *key, const char *const *words,
                              int *value)
{
    size_t length = strlen(key);
    if (!text || strncmp(text, key, length) != 0 || text[length] != '=')
        return NULL;
    text += length + 1;
    size_t end = strcspn(text, " ");
    for (int i = 0; words[i]; i++)
        if (strlen(words[i]) == end && !strncmp(text, words[i], end)) {
            *value = i;
            return text + end + (text[end] == ' ');
        }
    return NULL;
}

// Reads a whole number from 0 to `limit`. Returns the text that follows, or NULL if there is no
// such number.
static const char *parse_count(const char *text, int limit, int *value)
{
    int64_t number = 0;
    if (*text < '0' || *text > '9')
        return NULL;
    for (; *text >= '0' && *text <= '9'; text++) {
        number = number * 10 + (*text - '0');
        if (number > limit)
            return NULL;
    }
    *value = (int)number;
    return text;
}

static const char *parse_size(const char *text, kiln_table_def *def)
{
    int *const sides[3] = {&def->width, &def->height, &def->depth};
    if (!text || strncmp(text, "size=", 5) != 0)
        return NULL;
    text += 5;
    for (int i = 0; i < 3; i++) {
        text = parse_count(text, KILN_MAX_TABLE, sides[i]);
        if (!text || *sides[i] < 1 || *text++ != (i < 2 ? 'x' : ' '))
            return NULL;
    }
    return text;
}

bool ki_table_parse(const char *text, kiln_table_def *def)
{
    static const char *const answers[] = {"0", "1", NULL};
    int kind = 0, d = 0, g = 0, sheen = 0, axis = 0, corners = 0, complement = 0, flip = 0;
    *def = (kiln_table_def){0};
    text = parse_word(text, "kind", kind_names, &kind);
    text = parse_word(text, "d", d_names, &d);
    text = parse_word(text, "g", g_names, &g);
    text = parse_word(text, "sheen", sheen_names, &sheen);
    text = parse_word(text, "axis", axis_names, &axis);
    text = parse_word(text, "corners", answers, &corners);
    text = parse_word(text, "complement", answers, &complement);
    text = parse_word(text, "flip", answers, &flip);
    text = parse_size(text, def);
    text = text && !strncmp(text, "paths=", 6) ? parse_count(text + 6, INT_MAX, &def->path_count)
                                               : NULL;
    if (!text || *text) {
        *def = (kiln_table_def){0};
        return false;
    }
    def->kind = (kiln_table_kind)kind;
    def->model = (kiln_model){(kiln_d)d, (kiln_g)g};
    def->sheen = (kiln_sheen)sheen;
    def->axis = (kiln_axis)axis;
    def->corners = corners;
    def->complement = complement;
    def->flip = flip;
    return true;
}
