// Files whose rows pass by. In: the path of an EXR or HDR file with a panorama. Out: a function
// that reads any rows of it, mended as ki_map_mend mends whole maps, and the same report as that of
// kiln_map_load. Method: what was found in each row is stored for the row, so that rows may be read
// in any order and more than once.
#include "codec/row_file.h"

#include "image/mend.h"

#include <stdatomic.h>
#include <string.h>

struct ki_row_file {
    ki_row_input input;
    ki_row_decoder decoder;
    kiln_load_def def;
    kiln_load_report report;
    ki_row_finds *finds;     // what was found in each row
    atomic_bool is_negative; // some row has values below zero
    atomic_bool needs_whole; // some row has values that are not a number
};

// -------------------------------------------------------------------------------------------- rows

enum { ROWS = 64 }; // number of rows after which the caller is asked whether to go on

// Decodes rows, converts their colours and mends them. With `weigh`, sums the light of the rows.
static kiln_result read_rows(ki_row_file *f, int first, int count, bool weigh, float *rgb,
                             kiln_error *error)
{
    const ki_row_decoder *d = &f->decoder;
    ki_asker asker = ki_asker_make(f->input.context);
    kiln_result result = d->decode(d->state, first, count, rgb, error);
    for (int i = 0; i < count && result == KILN_OK; i++, rgb += 6 * (size_t)d->size) {
        if (i % ROWS == ROWS - 1 && !ki_may_go_on(&asker))
            return ki_fail_cancelled(error, "reading");
        ki_row_finds *finds = &f->finds[first + i];
        bool weighs = weigh || finds->weighed || atomic_load(&f->is_negative);
        if (d->converts)
            ki_row_transform(f->input.context, &d->matrix, rgb, 2 * d->size);
        ki_row_mend(d->size, first + i, f->def.negative, weighs, rgb, finds);
        if (finds->negative_count)
            atomic_store(&f->is_negative, true);
        if (!finds->nan_count)
            continue;
        atomic_store(&f->needs_whole, true);
        result = ki_fail(error, KILN_ERROR_FORMAT, "%s: row %d holds values that are not a number",
                         f->input.name, first + i);
    }
    return result;
}

static kiln_result read_for_bake(void *user, int first, int count, float *rgb, kiln_error *error)
{
    return read_rows(user, first, count, false, rgb, error);
}

// Reads the rows whose light is not known again, a block at a time.
static kiln_result weigh_rows(ki_row_file *f, kiln_error *error)
{
    const ki_row_decoder *d = &f->decoder;
    int step = ki_max(1, ki_min(d->block, d->size));
    ki_buffer rows =
        ki_row_pool_take(&f->input.pool, (size_t)step * 6 * (size_t)d->size * sizeof(float));
    kiln_result result = rows.memory
                             ? KILN_OK
                             : ki_fail_memory(f->input.context, error, f->input.name,
                                              (size_t)step * 6 * (size_t)d->size * sizeof(float));
    for (int row = 0; row < d->size && result == KILN_OK;) {
        int into = ((row - d->phase) % step + step) % step,
            count = ki_min(step - into, d->size - row);
        bool known = true;
        for (int i = 0; i < count; i++)
            known = known && f->finds[row + i].weighed;
        if (!known && !ki_go_on(f->input.context))
            result = ki_fail_cancelled(error, "reading");
        else if (!known)
            result = read_rows(f, row, count, true, rows.memory, error);
        row += count;
    }
    ki_row_pool_give(&f->input.pool, rows);
    return result;
}

// ----------------------------------------------------------------------------------------- opening

static kiln_result open_decoder(ki_row_file *f, kiln_error *error)
{
    uint8_t first[4] = {0};
    size_t count = f->input.file.size < sizeof first ? (size_t)f->input.file.size : sizeof first;
    if (!ki_file_read_at(&f->input.file, 0, first, count))
        return KILN_OK;
    if (!memcmp(first, "\x76\x2f\x31\x01", 4))
        return ki_exr_rows_open(&f->input, &f->decoder, &f->report, error);
    if (!memcmp(first, "#?", 2) && !f->input.layer)
        return ki_hdr_rows_open(&f->input, &f->decoder, &f->report, error);
    return KILN_OK;
}

kiln_result ki_row_file_open(kiln_context *context, const char *path, const kiln_load_def *def,
                             ki_row_file **file, kiln_rows *rows, kiln_error *error)
{
    *file = NULL;
    bool whole = def->layout != KILN_LAYOUT_AUTO && def->layout != KILN_LAYOUT_PANORAMA;
    if (whole || (unsigned)def->negative > KILN_NEGATIVE_ZERO)
        return KILN_OK;
    ki_row_file *f = ki_alloc(context, 1, sizeof *f);
    if (!f)
        return ki_fail_memory(context, error, path, sizeof *f);
    f->def = *def;
    f->input = (ki_row_input){.context = context,
                              .name = path,
                              .layer = def->layer && def->layer[0] ? def->layer : NULL,
                              .any_layout = def->layout == KILN_LAYOUT_AUTO};
    ki_row_pool_begin(context, &f->input.pool);
    kiln_result result = KILN_OK;
    if (ki_file_open(path, &f->input.file))
        result = open_decoder(f, error);
    if (f->decoder.state && result == KILN_OK) {
        f->finds = ki_alloc(context, (size_t)f->decoder.size, sizeof *f->finds);
        if (!f->finds)
            result =
                ki_fail_memory(context, error, path, (size_t)f->decoder.size * sizeof *f->finds);
    }
    if (!f->decoder.state || result != KILN_OK) {
        ki_row_file_close(f);
        return result;
    }
    *file = f;
    *rows = (kiln_rows){f->decoder.size, read_for_bake, f, f->decoder.block, f->decoder.phase};
    return KILN_OK;
}

bool ki_row_file_needs_whole(const ki_row_file *file)
{
    return atomic_load(&((ki_row_file *)(uintptr_t)file)->needs_whole);
}

kiln_result ki_row_file_finish(ki_row_file *f, kiln_error *error)
{
    kiln_result result = KILN_OK;
    if (atomic_load(&f->is_negative))
        result = weigh_rows(f, error);
    if (result == KILN_OK)
        result = ki_rows_report(f->input.name, f->decoder.size, f->def.negative, f->finds,
                                &f->report, error);
    if (result == KILN_OK && f->def.report)
        *f->def.report = f->report;
    return result;
}

void ki_row_file_close(ki_row_file *f)
{
    if (!f)
        return;
    if (f->decoder.state)
        f->decoder.close(f->decoder.state);
    ki_row_pool_end(&f->input.pool);
    ki_file_close(&f->input.file);
    ki_free(f->finds);
    ki_free(f);
}
