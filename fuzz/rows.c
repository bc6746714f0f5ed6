// Any bytes as a file whose rows are decoded one after the other. The rows must be those of the
// whole picture, and the report that of loading the whole picture; a file that cannot be loaded
// must not be read by rows either.
#include "fuzz.h"

#include "codec/row_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MEMORY = 64 << 20 };

// Reads all rows in pieces of `step`, from the last to the first.
static kiln_result read_all(const kiln_rows *rows, int step, float *rgb, kiln_error *error)
{
    kiln_result result = KILN_OK;
    for (int end = rows->size; end > 0 && result == KILN_OK; end -= step) {
        int first = ki_max(0, end - step);
        result = rows->read(rows->user, first, end - first,
                            rgb + 6 * (size_t)rows->size * (size_t)first, error);
    }
    return result;
}

static void compare(const kiln_map *map, const kiln_load_report *wanted, const float *rgb,
                    const kiln_load_report *got)
{
    fuzz_must(!memcmp(map->level[0], rgb, 3 * sizeof *rgb * kiln_map_texels(map, 0)));
    fuzz_must(got->texel_count == wanted->texel_count &&
              got->infinite_count == wanted->infinite_count &&
              got->negative_count == wanted->negative_count &&
              got->missing_count == wanted->missing_count && got->note_count == wanted->note_count);
    fuzz_must(!memcmp(&got->negative_share, &wanted->negative_share, sizeof got->negative_share));
}

// Reads a file by rows and as a whole.
static void check(kiln_context *context, const char *path, const uint8_t *bytes, size_t size,
                  int step)
{
    kiln_error error = {0};
    kiln_load_report reports[2];
    kiln_load_def def = {.report = &reports[0]};
    kiln_map map;
    ki_row_file *file;
    kiln_rows rows;
    if (ki_row_file_open(context, path, &def, &file, &rows, &error) != KILN_OK || !file)
        return;
    float *rgb = malloc(6 * sizeof *rgb * (size_t)rows.size * (size_t)rows.size);
    fuzz_must(rgb != NULL);
    kiln_result result = read_all(&rows, step, rgb, &error);
    if (result == KILN_OK)
        result = ki_row_file_finish(file, &error);
    bool whole = ki_row_file_needs_whole(file);
    ki_row_file_close(file);
    def.report = &reports[1];
    kiln_result loaded = kiln_map_decode(context, bytes, size, path, &def, &map, &error);
    if (!whole && result != KILN_ERROR_MEMORY && loaded != KILN_ERROR_MEMORY) {
        fuzz_must(result == loaded);
        if (loaded == KILN_OK) {
            fuzz_must(map.shape == KILN_SHAPE_PANORAMA && map.size == rows.size);
            compare(&map, &reports[1], rgb, &reports[0]);
        }
    }
    kiln_map_free(&map);
    free(rgb);
}

// Makes the bytes an HDR file if they begin like one, else an EXR file.
static void begin_like_a_picture(uint8_t *bytes)
{
    if (bytes[0] == '#')
        memcpy(bytes, "#?", 2);
    else
        memcpy(bytes, "\x76\x2f\x31\x01", 4);
}

void fuzz_rows(const uint8_t *bytes, size_t size)
{
    if (size < 8)
        return;
    char path[] = "/tmp/kiln-fuzz-XXXXXX";
    int file = mkstemp(path);
    uint8_t *copy = malloc(size);
    fuzz_must(copy != NULL);
    memcpy(copy, bytes, size);
    begin_like_a_picture(copy);
    fuzz_must(file >= 0 && write(file, copy, size) == (ssize_t)size && close(file) == 0);
    kiln_context *context = fuzz_context(MEMORY);
    check(context, path, copy, size, 1 + bytes[size - 1] % 40);
    fuzz_end(context);
    fuzz_must(remove(path) == 0);
    free(copy);
}
