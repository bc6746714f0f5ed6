#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void fuzz_must(bool holds)
{
    if (!holds)
        abort();
}

kiln_context *fuzz_context(size_t memory_limit)
{
    const kiln_context_def def = {.memory_limit = memory_limit, .thread_count = 1};
    kiln_context *context;
    fuzz_must(kiln_context_create(&def, &context, NULL) == KILN_OK);
    return context;
}

void fuzz_end(kiln_context *context)
{
    size_t held;
    kiln_context_memory(context, &held, NULL);
    fuzz_must(held == 0);
    kiln_context_destroy(context);
}

char *fuzz_text(const uint8_t *bytes, size_t size)
{
    char *text = malloc(size + 1);
    fuzz_must(text != NULL);
    if (size)
        memcpy(text, bytes, size);
    text[size] = 0;
    return text;
}

void fuzz_must_be_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        fuzz_must(isfinite(values[i]));
}

void fuzz_must_end(const char *text, size_t room)
{
    fuzz_must(memchr(text, 0, room) != NULL);
}

static void check_texts(const kiln_file_info *info)
{
    fuzz_must_end(info->format, sizeof info->format);
    fuzz_must_end(info->encoding, sizeof info->encoding);
    fuzz_must_end(info->layout, sizeof info->layout);
    fuzz_must_end(info->engine, sizeof info->engine);
    fuzz_must_end(info->writer, sizeof info->writer);
    fuzz_must_end(info->orientation, sizeof info->orientation);
    fuzz_must_end(info->table, sizeof info->table);
    for (int i = 0; i < info->layer_count && i < KILN_MAX_LAYERS; i++) {
        fuzz_must_end(info->layer[i].part, sizeof info->layer[i].part);
        fuzz_must_end(info->layer[i].name, sizeof info->layer[i].name);
        fuzz_must_end(info->layer[i].channels, sizeof info->layer[i].channels);
    }
}

void fuzz_check_info(const kiln_file_info *info)
{
    check_texts(info);
    fuzz_must(info->format[0] && info->layout[0]);
    fuzz_must(info->width >= 1 && info->height >= 1 && info->depth >= 1);
    fuzz_must(info->level_count >= 0 && info->level_count <= KILN_MAX_LEVELS);
    fuzz_must(info->sh_bands >= 0 && info->sh_bands <= KILN_MAX_BANDS);
    for (int k = 0; k < KILN_MAX_LEVELS; k++)
        fuzz_must(info->roughness[k] == -1 || (info->roughness[k] >= 0 && info->roughness[k] <= 1));
    fuzz_must_be_finite(info->sh[0], sizeof info->sh / sizeof(float));
    kiln_note note;
    for (int i = 0; kiln_load_report_note(&info->report, i, &note); i++)
        fuzz_must_end(note.text, sizeof note.text);
}
