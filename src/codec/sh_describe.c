#include "codec/sh_describe.h"

#include "codec/decimal.h"
#include "codec/filament_sh.h"
#include "codec/file_info.h"
#include "codec/json.h"

#include <stdio.h>
#include <string.h>

enum { MOST = KILN_MAX_BANDS * KILN_MAX_BANDS };

// A file's text, cut after the room of the struct and ended by NUL. The room exceeds the longest
// text that kiln writes.
typedef struct text {
    char bytes[8192];
} text;

static void copy_text(const uint8_t *bytes, size_t size, size_t room, text *t)
{
    size = size < room ? size : room - 1;
    if (size) // `bytes` may be NULL where there are none
        memcpy(t->bytes, bytes, size);
    t->bytes[size] = 0;
}

static bool has(const uint8_t *bytes, size_t size, const char *words)
{
    text t;
    copy_text(bytes, size, 128, &t);
    return strstr(t.bytes, words) != NULL;
}

bool ki_sh_json_begins(const uint8_t *bytes, size_t size)
{
    return size && bytes[0] == '{' && has(bytes, size, "\"bands\"");
}

bool ki_sh_lines_begin(const uint8_t *bytes, size_t size)
{
    return has(bytes, size, " ; Y0,0\n") || has(bytes, size, "// L00, irradiance, pre-scaled base");
}

bool ki_sh_array_begins(const uint8_t *bytes, size_t size)
{
    return size > 1 && bytes[0] == '/' && has(bytes, size, "// Spherical harmonics of ");
}

static kiln_result finish(const char *format, int count, const char *name, kiln_file_info *info,
                          kiln_error *error)
{
    int bands = 1;
    while (bands < KILN_MAX_BANDS && bands * bands < count)
        bands++;
    if (bands * bands != count)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: holds %d complete coefficients, the number must be 1, 4, 9, 16 or 25",
                       name, count);
    snprintf(info->format, sizeof info->format, "%s", format);
    snprintf(info->encoding, sizeof info->encoding, "text");
    snprintf(info->layout, sizeof info->layout, "harmonics");
    info->width = count;
    info->height = info->level_count = 1;
    info->channel_count = 3;
    info->sh_bands = bands;
    return KILN_OK;
}

kiln_result ki_sh_json_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                const char *name, kiln_file_info *info, kiln_error *error)
{
    char key[16];
    double triple[3];
    int count = 0;
    ki_json json = ki_json_make(context, bytes, size);
    ki_json_enter_object(&json);
    while (ki_json_member(&json, key, sizeof key)) {
        if (!strcmp(key, "irradiance")) {
            info->sh_irradiance = ki_json_flag(&json);
        } else if (!strcmp(key, "coefficients")) {
            ki_json_enter_array(&json);
            for (; ki_json_item(&json); count += count <= MOST) {
                ki_json_triple(&json, triple);
                for (int c = 0; c < 3 && count < MOST; c++)
                    info->sh[count][c] = ki_info_number(triple[c]);
            }
        } else {
            ki_json_skip(&json);
        }
    }
    if (json.stopped)
        return ki_fail_cancelled(error, "reading");
    if (json.failed)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the JSON is damaged at byte %zu", name,
                       (size_t)(json.at - (const char *)bytes));
    return finish("json", count, name, info, error);
}

// Reads three numbers from each line of *at into info->sh, and ignores the text around the numbers.
// Stops at the first line without three numbers, at which *at then points. Returns the number of
// lines read.
static int read_lines(const char **at, kiln_file_info *info)
{
    int count = 0;
    for (; count < MOST && **at; count++) {
        double value[3];
        const char *to = *at;
        for (int c = 0; c < 3 && to; c++)
            to = ki_parse_number(to + strspn(to, " \t{,"), &value[c]);
        if (!to)
            break;
        for (int c = 0; c < 3; c++)
            info->sh[count][c] = ki_info_number(value[c]);
        to += strcspn(to, "\n");
        *at = to + (*to == '\n');
    }
    return count;
}

kiln_result ki_sh_lines_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                 const char *name, kiln_file_info *info, kiln_error *error)
{
    (void)context; // the text is short
    text t;
    copy_text(bytes, size, sizeof t.bytes, &t);
    if (size && bytes[0] == '(') {
        snprintf(info->engine, sizeof info->engine, "filament");
        return finish("text", ki_filament_sh_read(t.bytes, info) ? 9 : 0, name, info, error);
    }
    const char *at = t.bytes;
    int count = read_lines(&at, info);
    // Text that remains after the last coefficient is an error, which finish() reports for a count
    // of 0.
    return finish("text", *at ? 0 : count, name, info, error);
}

kiln_result ki_sh_array_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                 const char *name, kiln_file_info *info, kiln_error *error)
{
    (void)context; // the text is short
    text t;
    copy_text(bytes, size, sizeof t.bytes, &t);
    const char *array = strstr(t.bytes, "= {\n");
    info->sh_irradiance = strstr(t.bytes, "harmonics of irradiance") != NULL;
    array = array ? array + 4 : "";
    int count = read_lines(&array, info);
    return finish("c", *array == '}' ? count : 0, name, info, error);
}
