// Converts a kiln_table_def to its line of text and back.
#include "table/table_text.h"

#include "codec/decimal.h"
#include "table/lobes.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

static const char *const kind_names[] = {
    "e",      "eavg",  "dfg", "dfg-multiscatter", "sheen", "e-dielectric", "glass",
    "e-walk", "lobes", NULL};
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

// Returns the roughness of a level when all levels are at equal steps from 0 to 1.
static float even_roughness(int level, int count)
{
    return (float)level / (float)(count - 1);
}

static void describe_lobes(const kiln_table_def *def, char *text, size_t room)
{
    bool even = true;
    for (int i = 0; i < def->level_count; i++)
        even = even && def->level_roughness[i] == even_roughness(i, def->level_count);
    int used = ki_print(text, room, " taps=%d levels=", def->tap_count);
    if (even)
        ki_print(text + used, room - (size_t)used, "%d", def->level_count);
    for (int i = 0; i < def->level_count && !even; i++)
        used += ki_print(text + used, room - (size_t)used, i ? ",%.9g" : "%.9g",
                         (double)def->level_roughness[i]);
}

void ki_table_describe(const kiln_table_def *def, char text[KI_TABLE_TEXT])
{
    int used = snprintf(
        text, KI_TABLE_TEXT,
        "kind=%s d=%s g=%s sheen=%s axis=%s corners=%d complement=%d flip=%d size=%dx%dx%d "
        "paths=%d",
        kind_names[def->kind], d_names[def->model.d], g_names[def->model.g],
        sheen_names[def->sheen], axis_names[def->axis], def->corners, def->complement, def->flip,
        def->width, def->height, def->depth, def->path_count);
    if (def->kind == KILN_TABLE_LOBES)
        describe_lobes(def, text + used, KI_TABLE_TEXT - (size_t)used);
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

// Reads " taps=2 levels=0,0.25,0.6,1". Returns the text that follows, or NULL.
static const char *parse_lobes(const char *text, kiln_table_def *def)
{
    if (!text || strncmp(text, " taps=", 6) != 0)
        return NULL;
    text = parse_count(text + 6, KILN_MAX_TAPS, &def->tap_count);
    if (!text || strncmp(text, " levels=", 8) != 0)
        return NULL;
    text += 8;
    if (!strchr(text, ','))
        text = parse_count(text, KILN_MAX_LEVELS, &def->level_count);
    else
        for (bool more = true; more;) {
            double value = 0;
            if (*text < '0' || *text > '9' || def->level_count == KILN_MAX_LEVELS)
                return NULL;
            text = ki_parse_number(text, &value);
            if (!text)
                return NULL;
            def->level_roughness[def->level_count++] = (float)value;
            more = *text == ',';
            text += more;
        }
    return text && def->tap_count && def->level_count && !ki_lobes_complete(def, NULL) ? text
                                                                                       : NULL;
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
    def->kind = (kiln_table_kind)kind;
    def->model = (kiln_model){(kiln_d)d, (kiln_g)g};
    def->axis = (kiln_axis)axis;
    if (def->kind == KILN_TABLE_LOBES)
        text = corners && !def->path_count ? parse_lobes(text, def) : NULL;
    if (!text || *text) {
        *def = (kiln_table_def){0};
        return false;
    }
    def->sheen = (kiln_sheen)sheen;
    def->corners = corners;
    def->complement = complement;
    def->flip = flip;
    return true;
}
