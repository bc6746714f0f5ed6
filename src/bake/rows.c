// The pass of a panorama's rows through a bake. In: a function that reads rows. Out: spectra and
// mirror levels, with the same bits as from the whole panorama in memory. Method: rows are read
// from both poles to the equator, because the analysis transforms each latitude ring together with
// the ring at the same distance from the other pole. Two windows hold the rows that rings and
// texels still need, one window for each hemisphere:
//
//   north pole | forgotten | window | not read yet | window | forgotten | south pole
//
// The two windows lie one after the other in memory, so that they are one window in the end, when
// all rows in between are read. Suns are known only after the last row. The rings to which a sun
// contributes are added again without the sun, from rows that are read a second time.
#include "bake/rows.h"

#include "image/image.h"

#include <string.h>

static const char reading[] = "reading"; // name of this work in progress reports

// A range of rows, first <= row < end.
typedef struct range {
    int first, end;
} range;

// Greatest number of pieces of rows that are read at the same time.
enum { MOST_PIECES = 64 };

typedef struct pass {
    kiln_context *context;
    const kiln_rows *source;
    const ki_row_work *work;
    int size, block;
    int middle;      // the row at which the two windows meet
    int reach;       // number of rows that a ring or a texel needs on one side
    int step;        // number of rows that are read on each side at a time
    size_t capacity; // number of rows that one window can hold
    // Memory of both windows. The northern window ends, and the southern window begins, `capacity`
    // rows after the beginning.
    float *memory;
    range north, south; // the rows in the windows
    int depth;          // number of rows from each pole that have done their work
    // The pieces that are read at the same time, and the result and error message of each.
    range piece[MOST_PIECES];
    float *to[MOST_PIECES];
    kiln_result results[MOST_PIECES];
    kiln_error errors[MOST_PIECES];
    int piece_count;
} pass;

static size_t line_floats(const pass *p)
{
    return 6 * (size_t)p->size;
}

static float *southern_memory(const pass *p)
{
    return p->memory + p->capacity * line_floats(p);
}

static float *northern_memory(const pass *p)
{
    return southern_memory(p) - (size_t)(p->north.end - p->north.first) * line_floats(p);
}

// ----------------------------------------------------------------------------------------- reading

// Task of one thread: reads the rows of one piece, mirrors them if the bake mirrors its source, and
// multiplies them by the exposure of the bake.
static void read_piece(void *data, int index)
{
    pass *p = data;
    const range *piece = &p->piece[index];
    int count = piece->end - piece->first;
    p->results[index] =
        p->source->read(p->source->user, piece->first, count, p->to[index], &p->errors[index]);
    if (p->results[index] != KILN_OK)
        return;
    for (int i = 0; i < count && p->work->mirror; i++)
        ki_mirror_row(p->to[index] + (size_t)i * line_floats(p), 2 * p->size);
    ki_expose_values(p->to[index], (size_t)count * line_floats(p), p->work->exposure);
}

// Reads the pieces that are listed.
static kiln_result read_pieces(pass *p, kiln_error *error)
{
    double done = ki_min(p->depth, p->size / 2) / (0.5 * p->size + 1);
    if (!ki_progress(p->context, reading, done) ||
        !ki_parallel_steps(p->context, NULL, p->piece_count, read_piece, p))
        return ki_fail_cancelled(error, reading);
    int count = p->piece_count;
    p->piece_count = 0;
    for (int i = 0; i < count; i++)
        if (p->results[i] != KILN_OK) {
            if (error)
                *error = p->errors[i];
            return p->results[i];
        }
    return KILN_OK;
}

// Returns the first end of a block at or after `row`, no further than `limit`.
static int end_of_block(const pass *p, int row, int limit)
{
    int into = (int)(((int64_t)row - p->source->phase) % p->block);
    into += into < 0 ? p->block : 0;
    int64_t end = (int64_t)row + (into ? p->block - into : 0);
    return end < limit ? (int)end : limit;
}

// Reads the rows of a range into `to`, cut into pieces where blocks end.
static kiln_result read_range(pass *p, range rows, float *to, bool last, kiln_error *error)
{
    kiln_result result = KILN_OK;
    for (int row = rows.first; row < rows.end && result == KILN_OK;) {
        int least = ki_max(1, (rows.end - rows.first) / (MOST_PIECES / 4));
        int end = end_of_block(p, row + ki_min(least, rows.end - row), rows.end);
        p->piece[p->piece_count] = (range){row, end};
        p->to[p->piece_count++] = to + (size_t)(row - rows.first) * line_floats(p);
        row = end;
        if (p->piece_count == MOST_PIECES)
            result = read_pieces(p, error);
    }
    return result == KILN_OK && last && p->piece_count ? read_pieces(p, error) : result;
}

// -------------------------------------------------------------------------------------------- work

static void see_rows(const pass *p, const ki_rows *rows)
{
    for (int i = 0; i < p->work->analysis_count; i++)
        ki_analysis_see_rows(p->work->analysis[i].analysis, p->work->analysis[i].workspace, rows);
}

// Adds the rings and computes the texels whose last row has a depth from p->depth to `to` - 1.
// Returns false if the caller of the library stops the work.
static bool add_band(const pass *p, const ki_rows rows[2], int to)
{
    const ki_row_work *work = p->work;
    bool go_on = true;
    for (int i = 0; i < work->analysis_count && go_on; i++) {
        const ki_row_analysis *a = &work->analysis[i];
        go_on = ki_analysis_add_band(a->analysis, a->workspace, rows, p->depth, to, a->spectrum);
    }
    for (int i = 0; i < work->mirror_count && go_on; i++) {
        ki_buffer buffer = work->mirrors[i].buffer;
        go_on = ki_resample_band(p->context, work->mirrors[i].plan, &buffer, rows, p->depth, to,
                                 work->mirrors[i].target);
    }
    return go_on;
}

// Reads the next rows on both sides and forgets the rows that are no longer needed.
static kiln_result advance(pass *p, kiln_error *error)
{
    size_t line = line_floats(p);
    int north = ki_min(p->middle, end_of_block(p, p->north.end + p->step, p->size));
    int south = p->south.first - p->step > p->middle
                    ? end_of_block(p, p->south.first - p->step - p->block + 1, p->size)
                    : p->middle;
    south = ki_max(p->middle, south);
    int keep = ki_max(0, p->depth - p->reach + 1);
    range kept = {ki_min(ki_max(p->north.first, keep), p->north.end), p->north.end};
    float *middle = southern_memory(p);
    memmove(middle - (size_t)(north - kept.first) * line,
            middle - (size_t)(p->north.end - kept.first) * line,
            (size_t)(kept.end - kept.first) * line * sizeof(float));
    int end = ki_max(ki_min(p->south.end, p->size - keep), p->south.first);
    memmove(middle + (size_t)(p->south.first - south) * line, middle,
            (size_t)(end - p->south.first) * line * sizeof(float));
    range fresh[2] = {{p->north.end, north}, {south, p->south.first}};
    p->north = (range){kept.first, north};
    p->south = (range){south, end};
    float *to = middle - (size_t)(north - fresh[0].first) * line;
    kiln_result result = read_range(p, fresh[0], to, false, error);
    if (result == KILN_OK)
        result = read_range(p, fresh[1], middle, true, error);
    if (result != KILN_OK)
        return result;
    see_rows(p, &(ki_rows){to, fresh[0].first, fresh[0].end - fresh[0].first});
    see_rows(p, &(ki_rows){middle, fresh[1].first, fresh[1].end - fresh[1].first});
    return KILN_OK;
}

// Lets all rows pass by once.
static kiln_result pass_all(pass *p, kiln_error *error)
{
    while (p->north.end < p->middle || p->south.first > p->middle) {
        kiln_result result = advance(p, error);
        if (result != KILN_OK)
            return result;
        ki_rows rows[2] = {
            {northern_memory(p), p->north.first, p->north.end - p->north.first},
            {southern_memory(p), p->south.first, p->south.end - p->south.first},
        };
        int to = ki_min(p->north.end, p->size - p->south.first);
        if (p->north.end == p->south.first) {
            // The windows have met and are one.
            rows[0].count = p->south.end - p->north.first;
            rows[1] = rows[0];
            to = p->size;
        }
        if (!add_band(p, rows, to))
            return ki_fail_cancelled(error, reading);
        p->depth = to;
    }
    return KILN_OK;
}

// Adds the rings to which suns contribute again, without the suns.
static kiln_result add_suns(pass *p, const ki_row_analysis *a, kiln_error *error)
{
    ki_rows rows[2];
    kiln_result result = KILN_OK;
    ki_analysis_choose_suns(a->analysis, a->workspace, a->spectrum);
    for (int vector = 0;
         result == KILN_OK && ki_analysis_next_sun(a->analysis, a->spectrum, &vector, rows);
         vector++) {
        float *to = p->memory;
        for (int side = 0; side < 2 && result == KILN_OK; side++) {
            range wanted = {rows[side].first, rows[side].first + rows[side].count};
            result = read_range(p, wanted, to, side == 1, error);
            rows[side].rgb = to;
            to += (size_t)rows[side].count * line_floats(p);
        }
        if (result == KILN_OK &&
            !ki_analysis_add_vector(a->analysis, a->workspace, rows, vector, a->spectrum))
            result = ki_fail_cancelled(error, reading);
    }
    if (result == KILN_OK && !ki_analysis_sum_orders(a->analysis, a->workspace, a->spectrum))
        result = ki_fail_cancelled(error, reading);
    return result;
}

static kiln_result pass_and_finish(pass *p, kiln_error *error)
{
    const ki_row_work *work = p->work;
    for (int i = 0; i < work->analysis_count; i++)
        ki_analysis_begin(work->analysis[i].workspace, work->analysis[i].spectrum);
    kiln_result result = pass_all(p, error);
    for (int i = 0; i < work->analysis_count && result == KILN_OK; i++)
        result = add_suns(p, &work->analysis[i], error);
    for (int i = 0; i < work->mirror_count && result == KILN_OK; i++) {
        ki_buffer buffer = work->mirrors[i].buffer;
        ki_resample_end_bands(p->context, work->mirrors[i].plan, &buffer, work->mirrors[i].target);
    }
    return result;
}

// ------------------------------------------------------------------------------------------ memory

// Returns the number of rows that are read at a time on each side. As many rows as the reach keep
// the copies of old rows small, and some rows for each thread keep the threads busy. Rows of large
// panoramas are read in steps of limited memory.
static int find_step(const pass *p)
{
    const size_t most_bytes = 32 << 20;
    size_t most = most_bytes / (line_floats(p) * sizeof(float)) + 1;
    int wanted = ki_max(p->reach, 16 * ki_context_threads(p->context));
    return (size_t)wanted < most ? wanted : (int)most;
}

// Decides how rows are read, and allocates the windows.
static kiln_result prepare(pass *p, kiln_error *error)
{
    const ki_row_work *work = p->work;
    p->reach = 1;
    for (int i = 0; i < work->analysis_count; i++)
        p->reach = ki_max(p->reach, ki_analysis_reach(work->analysis[i].analysis));
    for (int i = 0; i < work->mirror_count; i++)
        p->reach = ki_max(p->reach, ki_resample_reach(work->mirrors[i].plan));
    p->step = find_step(p);
    p->block = ki_min(ki_max(1, p->source->block), p->size);
    p->middle = end_of_block(p, p->size / 2, p->size);
    p->south = (range){p->size, p->size};
    // A window holds the rows within reach, the rows of a step, and parts of blocks at both ends,
    // but no more rows than its side of the panorama has. The rows of a ring with suns, which may
    // be those of both sides, fit too.
    int64_t wanted = (int64_t)p->reach + p->step + 3 * (int64_t)p->block;
    int side = ki_max(p->middle, p->size - p->middle);
    p->capacity = (size_t)ki_max(p->reach, wanted < side ? (int)wanted : side);
    p->memory = ki_alloc_raw(p->context, 2 * p->capacity, line_floats(p) * sizeof(float));
    return p->memory ? KILN_OK
                     : ki_fail_memory(p->context, error, "the rows of a panorama",
                                      2 * p->capacity * line_floats(p) * sizeof(float));
}

kiln_result ki_rows_pass(kiln_context *context, const kiln_rows *rows, const ki_row_work *work,
                         kiln_error *error)
{
    pass *p = ki_alloc(context, 1, sizeof *p);
    if (!p)
        return ki_fail_memory(context, error, "the rows of a panorama", sizeof *p);
    p->context = context;
    p->source = rows;
    p->work = work;
    p->size = rows->size;
    kiln_result result = prepare(p, error);
    if (result == KILN_OK)
        result = pass_and_finish(p, error);
    ki_free(p->memory);
    ki_free(p);
    return result;
}
