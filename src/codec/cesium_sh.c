#include "codec/cesium_sh.h"

#include "codec/decimal.h"
#include "codec/filament_sh.h"
#include "codec/json.h"

#include <stdio.h>

enum { COUNT = 9 };

void ki_cesium_sh_write(ki_writer *w, const kiln_sh *sh)
{
    double factors[COUNT][3];
    ki_filament_sh_factors(sh, factors);
    for (int i = 0; i < COUNT; i++) {
        ki_write_text(w, i ? ",\n    [" : "[\n    [");
        for (int c = 0; c < 3; c++) {
            ki_write_text(w, c ? ", " : "");
            ki_write_number(w, factors[i][c]);
        }
        ki_write_text(w, "]");
    }
    ki_write_text(w, "\n]\n");
}

bool ki_cesium_sh_begins(const uint8_t *bytes, size_t size)
{
    size_t at = 1;
    while (at < size && (bytes[at] == ' ' || bytes[at] == '\n' || bytes[at] == '\r'))
        at++;
    return at < size && bytes[0] == '[' && bytes[at] == '[';
}

kiln_result ki_cesium_sh_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                  const char *name, kiln_file_info *info, kiln_error *error)
{
    double factors[COUNT][3] = {{0}}, unused[3] = {0};
    int count = 0;
    ki_json json = ki_json_make(context, bytes, size);
    ki_json_enter_array(&json);
    for (; ki_json_item(&json); count += count <= COUNT)
        ki_json_triple(&json, count < COUNT ? factors[count] : unused);
    if (json.stopped)
        return ki_fail_cancelled(error, "reading");
    if (json.failed)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the JSON is damaged at byte %zu", name,
                       (size_t)(json.at - (const char *)bytes));
    if (count != COUNT)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: holds %s coefficients, CesiumJS takes nine",
                       name, count > COUNT ? "more than nine" : "fewer than nine");
    ki_filament_sh_store(factors, info);
    snprintf(info->format, sizeof info->format, "json");
    snprintf(info->encoding, sizeof info->encoding, "text");
    snprintf(info->layout, sizeof info->layout, "harmonics");
    snprintf(info->engine, sizeof info->engine, "cesium");
    info->width = COUNT;
    info->height = info->level_count = 1;
    info->channel_count = 3;
    return KILN_OK;
}
