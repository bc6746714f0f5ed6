// The analysis of a panorama (docs/theory/spectral.md). In: the rows of a panorama as RGB floats:
// all at once, from north to south, or from both poles to the equator. Out: its spherical-harmonic
// coefficients up to a degree, and the list of suns left out of them. Method: rows are distributed
// onto latitude rings by the transpose of an interpolation with eight weights, the suns are
// subtracted, each ring is Fourier-transformed, and each order is summed over the rings with the
// Legendre functions. Every way of passing the rows gives the same bits.
#include "sphere/spectrum.h"

#include "math/math.h"

#include <math.h>
#include <string.h>

// A texel can be kept out of the spectrum as a sun only if it holds at least this share of the
// panorama's light in some channel.
static const double sun_share = 1e-3;
// A texel can be kept out of the spectrum as a sun only if it is at least this many times brighter
// than the mean of the panorama.
static const double sun_contrast = 200;

// ----------------------------------------------------------------------------------- the workspace

struct ki_analysis_workspace {
    kiln_context *context;
    int row_count; // number of panorama rows added by earlier calls of ki_analysis_add_rows
    // Weighted sums of panorama rows for each latitude ring, [ring][column][rgb]; NULL if panoramas
    // come whole.
    double *rings;
    // The magnitudes |radiance| of texels decide which texels are suns, because texels may be
    // negative.
    double *row_sums; // magnitudes of the radiance summed over each row, [size][3]
    float *row_peaks; // largest magnitude of each row, [size]
    // magnitudes times solid angle, summed over the texels of the rows so far
    double total[3];
    ki_sun *candidates; // texels bright enough to be suns relative to the light of the rows so far
    int candidate_count;

    // Fourier coefficients of the latitude rings for each order m, [m][vector of rings][12][lane].
    // The twelve are the real and imaginary parts of r, g, b: first of the part that is even about
    // the equator, then of the odd part times 2 cos theta, as the kernel `analyze` reads them.
    double *orders;
    bool borrows; // `orders` and `scratch` are those of ki_analysis_borrow
    // Scratch memory of each worker: two FFT buffers and 16 latitude rings, or the state of the
    // Legendre recurrence.
    double *scratch;
    size_t scratch_size;
};

// The data of one call of ki_analysis_add_rows, _finish or _execute, which all its tasks share.
typedef struct run {
    const ki_analysis *analysis;
    ki_analysis_workspace *work;
    // The panorama rows from which the northern and the southern latitude rings are summed. The two
    // are the same rows unless rows come from both poles.
    ki_rows rows[2];
    kiln_spectrum *spectrum; // the spectrum that is written
    int first_vector;        // index of the vector of rings that the first task transforms
} run;

enum {
    // MOST_PIECES: greatest number of pieces into which each half of a panorama row is cut. The
    // texels of a piece and of the rows that a ring needs fit in a processor's first cache.
    // PIECE_COLUMNS: number of columns that a piece has at least, where the panorama has as many.
    MOST_PIECES = 16,
    PIECE_COLUMNS = 64,
    RING_SET = 2 * KI_LANES, // number of latitude rings in a vector, two in each lane
};

kiln_result ki_analysis_workspace_create(kiln_context *context, const ki_analysis *analysis,
                                         ki_analysis_use use, ki_analysis_workspace **workspace,
                                         kiln_error *error)
{
    bool whole = use != KI_ANALYSIS_ROWS, owns = use != KI_ANALYSIS_BORROWS;
    size_t width = 2 * (size_t)analysis->size, rings = 2 * (size_t)analysis->rings.pair_count;
    size_t threads = (size_t)ki_context_threads(context), row, ring_bytes;
    size_t vectors = (size_t)analysis->rings.vector_count;
    ki_analysis_workspace *w = *workspace = ki_alloc(context, 1, sizeof *w);
    if (!w)
        return ki_fail_memory(context, error, "an analysis", sizeof *w);
    w->context = context;
    w->borrows = !owns;
    w->scratch_size = width * 16 * 2 + (whole ? width * 3 * RING_SET : 0);
    if (w->scratch_size < 24 * vectors)
        w->scratch_size = 24 * vectors;
    if (!ki_mul_size(width, 3 * sizeof(double), &row) || !ki_mul_size(row, rings, &ring_bytes))
        ring_bytes = SIZE_MAX;
    w->rings = whole ? NULL : ki_alloc(context, ring_bytes, 1);
    w->row_sums = ki_alloc_raw(context, (size_t)analysis->size, 3 * sizeof(double));
    w->row_peaks = ki_alloc_raw(context, (size_t)analysis->size, sizeof(float));
    w->candidates = ki_alloc_raw(context, KI_MAX_SUNS, sizeof *w->candidates);
    if (owns) {
        w->orders =
            ki_alloc_raw(context, ((size_t)analysis->degree + 1) * vectors, 96 * sizeof(double));
        w->scratch = ki_alloc_raw(context, threads * w->scratch_size, sizeof(double));
    }
    if ((w->rings || whole) && w->row_sums && w->row_peaks && w->candidates &&
        (!owns || (w->orders && w->scratch)))
        return KILN_OK;
    ki_analysis_workspace_destroy(w);
    *workspace = NULL;
    return ki_fail_memory(context, error, "the rings of an analysis", whole ? row : ring_bytes);
}

kiln_result ki_analysis_borrow(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                               ki_buffer *orders, ki_buffer *scratch, kiln_error *error)
{
    ki_analysis_workspace *w = workspace;
    size_t count = ((size_t)analysis->degree + 1) * (size_t)analysis->rings.vector_count;
    size_t threads = (size_t)ki_context_threads(w->context);
    if (!ki_buffer_reserve(w->context, orders, count, 96 * sizeof(double)) ||
        !ki_buffer_reserve(w->context, scratch, threads * w->scratch_size, sizeof(double)))
        return ki_fail_memory(w->context, error, "an analysis", count * 96 * sizeof(double));
    w->orders = orders->memory;
    w->scratch = scratch->memory;
    return KILN_OK;
}

void ki_analysis_workspace_destroy(ki_analysis_workspace *workspace)
{
    if (!workspace)
        return;
    ki_free(workspace->rings);
    ki_free(workspace->row_sums);
    ki_free(workspace->row_peaks);
    ki_free(workspace->candidates);
    if (!workspace->borrows) {
        ki_free(workspace->orders);
        ki_free(workspace->scratch);
    }
    ki_free(workspace);
}

// ---------------------------------------------------------------------------------------- the rows

// Returns the number of pieces into which each half of a panorama row is cut.
static int piece_count(const ki_analysis *a)
{
    return ki_max(1, ki_min(MOST_PIECES, a->size / PIECE_COLUMNS));
}

// Adds the weighted panorama rows of the run to one piece of a latitude ring. The two halves of a
// row (`half` 0 and 1) are cut at the same places, so that a ring beyond a pole, half a turn away,
// receives the same piece of the other half. The rows are added in their order, so that the sums do
// not depend on how many rows come at a time. With `is_first`, what `accumulator` held is overwritten.
static void add_to_piece(const run *r, int ring, int half, int piece, bool is_first,
                         double *accumulator)
{
    enum { MOST = 32 };
    const ki_analysis *a = r->analysis;
    const ki_rows *rows = &r->rows[ring >= a->rings.pair_count];
    int size = a->size, pieces = piece_count(a);
    int from = piece * size / pieces, count = (piece + 1) * size / pieces - from;
    ptrdiff_t here = 3 * ((ptrdiff_t)half * size + from);
    ptrdiff_t there = 3 * ((ptrdiff_t)(1 - half) * size + from), offsets[MOST];
    double weights[MOST];
    int n = 0;
    for (int i = a->ring_start[ring]; i < a->ring_start[ring + 1]; i++) {
        const ki_row_weight *from_row = &a->row_weights[i];
        int row = from_row->row - rows->first;
        if (row < 0 || row >= rows->count)
            continue;
        offsets[n] = (ptrdiff_t)row * size * 6 + (from_row->half_turn ? there : here);
        weights[n++] = from_row->weight;
        if (n == MOST) {
            a->kernels->add_weighted(accumulator + here, is_first, rows->rgb, offsets, weights, n,
                                     3 * count);
            is_first = false;
            n = 0;
        }
    }
    if (n || is_first)
        a->kernels->add_weighted(accumulator + here, is_first, rows->rgb, offsets, weights, n,
                                 3 * count);
}

// Task of one thread: adds one piece of the run's panorama rows to all latitude rings.
static void add_to_rings(void *data, int index)
{
    const run *r = data;
    int pieces = piece_count(r->analysis);
    for (int ring = 0; ring < 2 * r->analysis->rings.pair_count; ring++)
        add_to_piece(r, ring, index / pieces, index % pieces, false,
                     r->work->rings + (ptrdiff_t)ring * r->analysis->size * 6);
}

// Task of one thread: sums the magnitudes of one of the rows r->rows[0] and finds the largest.
static void sum_one_row(void *data, int index)
{
    const run *r = data;
    ki_analysis_workspace *w = r->work;
    int size = r->analysis->size, row = r->rows[0].first + index;
    w->row_peaks[row] = r->analysis->kernels->sum_row(
        r->rows[0].rgb + (size_t)index * (size_t)size * 6, 2 * size, w->row_sums + 3 * (size_t)row);
}

// Returns true if a texel with the radiance `rgb` and this solid angle holds more than `share` of
// the total light in some channel.
static bool holds_share(const float rgb[3], double solid, double share, const double total[3])
{
    for (int c = 0; c < 3; c++)
        if (fabs((double)rgb[c]) * solid > share * total[c] && total[c] > 0)
            return true;
    return false;
}

// Removes the candidate suns that hold too small a share of the light of all rows so far, since
// that light grows with every row.
static void drop_candidates(const ki_analysis *a, ki_analysis_workspace *w, double share)
{
    int count = 0;
    for (int i = 0; i < w->candidate_count; i++) {
        ki_sun sun = w->candidates[i];
        if (holds_share(sun.radiance, a->solid[sun.row], share, w->total))
            w->candidates[count++] = sun;
    }
    w->candidate_count = count;
}

// Adds the magnitudes of a row's light to the total of the rows so far.
static void add_total(ki_analysis_workspace *w, int row, double solid)
{
    for (int c = 0; c < 3; c++)
        w->total[c] += solid * w->row_sums[3 * row + c];
}

// Adds the light of the rows r->rows[0] to the total, and their brightest texels to the candidate
// suns. The last bits of the total depend on the order in which rows are added. Texels that hold a
// billionth less than the share sun_share are candidates too, and select_suns, which adds the rows
// from north to south, decides.
static void gather_candidates(const run *r)
{
    const double share = sun_share * (1 - 1e-9);
    ki_analysis_workspace *w = r->work;
    const ki_rows *rows = &r->rows[0];
    int size = r->analysis->size;
    for (int j = 0; j < rows->count; j++) {
        int row = rows->first + j;
        double solid = r->analysis->solid[row];
        add_total(w, row, solid);
        float peak = w->row_peaks[row], peaks[3] = {peak, peak, peak};
        if (!holds_share(peaks, solid, share, w->total))
            continue;
        for (int x = 0; x < 2 * size; x++) {
            const float *rgb = rows->rgb + 3 * ((size_t)j * 2 * (size_t)size + (size_t)x);
            if (!holds_share(rgb, solid, share, w->total))
                continue;
            if (w->candidate_count == KI_MAX_SUNS)
                drop_candidates(r->analysis, w, share);
            if (w->candidate_count < KI_MAX_SUNS)
                w->candidates[w->candidate_count++] = (ki_sun){row, x, {rgb[0], rgb[1], rgb[2]}};
        }
    }
}

// Sums the magnitudes of the rows r->rows[0] and finds the candidate suns among their texels.
static void see_rows(run *r)
{
    ki_parallel_for(r->work->context, r->rows[0].count, sum_one_row, r);
    gather_candidates(r);
}

kiln_result ki_analysis_add_rows(const ki_analysis *analysis, ki_analysis_workspace *w,
                                 const float *rows, int count, kiln_error *error)
{
    if (count < 0 || count > analysis->size - w->row_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%d rows after %d: the panorama has %d", count,
                       w->row_count, analysis->size);
    ki_rows added = {rows, w->row_count, count};
    run r = {.analysis = analysis, .work = w, .rows = {added, added}};
    see_rows(&r);
    ki_parallel_for(w->context, 2 * piece_count(analysis), add_to_rings, &r);
    w->row_count += count;
    return KILN_OK;
}

// Sorts the candidate suns by row and then by column, by insertion, because rows that come from
// both poles leave them in runs.
static void sort_candidates(ki_analysis_workspace *w)
{
    for (int i = 1; i < w->candidate_count; i++) {
        ki_sun sun = w->candidates[i];
        int to = i;
        for (; to > 0; to--) {
            const ki_sun *before = &w->candidates[to - 1];
            if (before->row < sun.row || (before->row == sun.row && before->column < sun.column))
                break;
            w->candidates[to] = *before;
        }
        w->candidates[to] = sun;
    }
}

// Writes the list of suns of the spectrum: the candidates that hold the share sun_share of the
// whole panorama's light and are sun_contrast times brighter than its mean.
static void select_suns(const ki_analysis *a, ki_analysis_workspace *w, kiln_spectrum *spectrum)
{
    int count = 0, size = spectrum->size;
    memset(w->total, 0, sizeof w->total);
    for (int row = 0; row < size; row++)
        add_total(w, row, a->solid[row]);
    drop_candidates(a, w, sun_share);
    sort_candidates(w);
    for (int i = 0; i < w->candidate_count; i++) {
        const ki_sun *sun = &w->candidates[i];
        bool bright = false;
        for (int c = 0; c < 3; c++)
            bright |= fabs((double)sun->radiance[c]) * 4 * KI_PI > sun_contrast * w->total[c] &&
                      w->total[c] > 0;
        if (bright)
            spectrum->suns[count++] = *sun;
    }
    spectrum->sun_count = count;
}

// ---------------------------------------------------------------------------------------- analysis

// Subtracts the suns, which the spectrum leaves out, from the sums of a latitude ring.
static void subtract_suns(const run *r, int ring, double *accumulator)
{
    const ki_analysis *a = r->analysis;
    for (int k = a->ring_start[ring]; k < a->ring_start[ring + 1]; k++)
        for (int i = 0; i < r->spectrum->sun_count; i++) {
            const ki_row_weight *from_row = &a->row_weights[k];
            const ki_sun *sun = &r->spectrum->suns[i];
            if (sun->row != from_row->row)
                continue;
            int column = (sun->column + (from_row->half_turn ? a->size : 0)) % (2 * a->size);
            for (int c = 0; c < 3; c++)
                accumulator[3 * column + c] -= from_row->weight * (double)sun->radiance[c];
        }
}

// Computes the Fourier transforms of eight pairs of latitude rings for one channel, and splits them
// into orders.
static void transform_channel(const run *r, int vector, int channel, double *const *rings,
                              double *buffer)
{
    const ki_analysis *a = r->analysis;
    int width = 2 * a->size;
    size_t vectors = (size_t)a->rings.vector_count;
    for (int x = 0; x < width; x++)
        for (int j = 0; j < RING_SET; j++)
            buffer[RING_SET * x + j] = rings[j][3 * x + channel];
    const double *z = a->kernels->fft(&a->fft, buffer, buffer + 16 * (size_t)width);
    a->kernels->split_orders(z, width, a->degree, a->column,
                             a->rings.twice_cos + KI_LANES * (size_t)vector, a->rings.first, vector,
                             r->work->orders + 96 * (size_t)vector + 16 * (size_t)channel,
                             96 * vectors);
}

// Sets the numbers of the latitude rings of a vector: eight northern rings, then for each of them
// the ring at the same distance from the south pole.
static void list_rings(const ki_analysis *a, int vector, int number[RING_SET])
{
    for (int j = 0; j < KI_LANES; j++) {
        number[j] = KI_LANES * vector + j;
        number[KI_LANES + j] = 2 * a->rings.pair_count - 1 - number[j];
    }
}

// Task of one thread: transforms eight pairs of latitude rings. Unless rows were added to all rings
// before, the rings are first summed from the run's rows.
static void transform_rings(void *data, int worker, int index)
{
    const run *r = data;
    const ki_analysis *a = r->analysis;
    ki_analysis_workspace *w = r->work;
    int vector = r->first_vector + index;
    size_t width = 2 * (size_t)a->size, pitch = 3 * width, buffers = width * 16 * 2;
    double *buffer = w->scratch + (size_t)worker * w->scratch_size, *rings[RING_SET];
    int number[RING_SET];
    list_rings(a, vector, number);
    for (int j = 0; j < RING_SET; j++)
        rings[j] =
            w->rings ? w->rings + (size_t)number[j] * pitch : buffer + buffers + (size_t)j * pitch;
    if (!w->rings) {
        int pieces = piece_count(a);
        for (int piece = 0; piece < 2 * pieces; piece++)
            for (int j = 0; j < RING_SET; j++)
                add_to_piece(r, number[j], piece / pieces, piece % pieces, true, rings[j]);
    }
    for (int j = 0; j < RING_SET; j++)
        subtract_suns(r, number[j], rings[j]);
    for (int channel = 0; channel < 3; channel++)
        transform_channel(r, vector, channel, rings, buffer);
}

// Task of one thread: computes the coefficients a_lm of one order m from the Fourier coefficients
// of the rings.
static void analyze_order(void *data, int worker, int m)
{
    const run *r = data;
    const ki_analysis *a = r->analysis;
    ki_analysis_workspace *w = r->work;
    size_t vectors = (size_t)a->rings.vector_count, row = ki_legendre_row(&a->legendre, m);
    int count = a->degree - m + 1;
    double *out = r->spectrum->a + ki_coefficient_row(a->degree, m);
    a->kernels->analyze(a->legendre.steps + row, count, a->rings.twice_cos,
                        a->rings.start + 8 * vectors * (size_t)m,
                        w->orders + 96 * vectors * (size_t)m, a->rings.skip + vectors * (size_t)m,
                        a->rings.first[m], a->rings.vector_count,
                        w->scratch + (size_t)worker * w->scratch_size, out);
    ki_legendre_part_odd(a->degree, m, out);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < KI_COMPONENTS; c++)
            out[KI_COMPONENTS * i + c] *= a->legendre.scale[row + (size_t)i];
}

// Returns false if the caller of the library stops the work.
static bool transform_vectors(run *r, int first, int count)
{
    r->first_vector = first;
    return ki_parallel_workers(r->work->context, count, transform_rings, r);
}

static bool sum_orders(run *r)
{
    return ki_parallel_workers(r->work->context, r->analysis->degree + 1, analyze_order, r);
}

kiln_result ki_analysis_finish(const ki_analysis *analysis, ki_analysis_workspace *w,
                               kiln_spectrum *spectrum, kiln_error *error)
{
    if (w->row_count != analysis->size)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the panorama has %d rows, only %d came",
                       analysis->size, w->row_count);
    run r = {.analysis = analysis, .work = w, .spectrum = spectrum};
    select_suns(analysis, w, spectrum);
    bool go_on = transform_vectors(&r, 0, analysis->rings.vector_count) && sum_orders(&r);
    return go_on ? KILN_OK : ki_fail_cancelled(error, "analysing");
}

bool ki_analysis_execute(const ki_analysis *analysis, ki_analysis_workspace *w, const float *rows,
                         kiln_spectrum *spectrum)
{
    ki_rows all = {rows, 0, analysis->size};
    run r = {.analysis = analysis, .work = w, .rows = {all, all}, .spectrum = spectrum};
    ki_analysis_begin(w, spectrum);
    see_rows(&r);
    select_suns(analysis, w, spectrum);
    return transform_vectors(&r, 0, analysis->rings.vector_count) && sum_orders(&r);
}

// --------------------------------------------------------------------------- rows from both poles

// Finds the rows that a vector of rings is summed from: rows[0] for its northern rings, rows[1] for
// its southern rings. Each gets a first row and a number of rows, and no texels.
static void find_rows(const ki_analysis *a, int vector, ki_rows rows[2])
{
    int number[RING_SET];
    list_rings(a, vector, number);
    for (int side = 0; side < 2; side++) {
        int first = a->size, end = 0;
        for (int j = 0; j < KI_LANES; j++) {
            int ring = number[side * KI_LANES + j];
            first = ki_min(first, a->row_weights[a->ring_start[ring]].row);
            end = ki_max(end, a->row_weights[a->ring_start[ring + 1] - 1].row + 1);
        }
        rows[side] = (ki_rows){.first = first, .count = end - first};
    }
}

// Returns the depth of the last row that a vector needs when rows come from both poles, and sets
// *reach to the number of depths from the first row that it needs to the last.
static int find_depth(const ki_analysis *a, int vector, int *reach)
{
    ki_rows rows[2];
    find_rows(a, vector, rows);
    int last = ki_max(rows[0].first + rows[0].count - 1, a->size - 1 - rows[1].first);
    int first = ki_min(rows[0].first, a->size - rows[1].first - rows[1].count);
    *reach = last - first + 1;
    return last;
}

int ki_analysis_reach(const ki_analysis *analysis)
{
    int most = 1, reach;
    for (int vector = 0; vector < analysis->rings.vector_count; vector++) {
        find_depth(analysis, vector, &reach);
        most = ki_max(most, reach);
    }
    return most;
}

void ki_analysis_begin(ki_analysis_workspace *w, kiln_spectrum *spectrum)
{
    w->row_count = w->candidate_count = 0;
    memset(w->total, 0, sizeof w->total);
    spectrum->sun_count = 0;
}

void ki_analysis_see_rows(const ki_analysis *analysis, ki_analysis_workspace *w,
                          const ki_rows *rows)
{
    see_rows(&(run){.analysis = analysis, .work = w, .rows = {*rows, *rows}});
}

bool ki_analysis_add_band(const ki_analysis *analysis, ki_analysis_workspace *w,
                          const ki_rows rows[2], int from, int to, kiln_spectrum *spectrum)
{
    run r = {.analysis = analysis, .work = w, .rows = {rows[0], rows[1]}, .spectrum = spectrum};
    int first = 0, count = analysis->rings.vector_count, reach;
    while (first < count && find_depth(analysis, first, &reach) < from)
        first++;
    int end = first;
    while (end < count && find_depth(analysis, end, &reach) < to)
        end++;
    return transform_vectors(&r, first, end - first);
}

void ki_analysis_choose_suns(const ki_analysis *analysis, ki_analysis_workspace *w,
                             kiln_spectrum *spectrum)
{
    select_suns(analysis, w, spectrum);
}

bool ki_analysis_next_sun(const ki_analysis *analysis, const kiln_spectrum *spectrum, int *vector,
                          ki_rows rows[2])
{
    for (; *vector < analysis->rings.vector_count; ++*vector) {
        find_rows(analysis, *vector, rows);
        for (int i = 0; i < 2 * spectrum->sun_count; i++) {
            int row = spectrum->suns[i / 2].row - rows[i % 2].first;
            if (row >= 0 && row < rows[i % 2].count)
                return true;
        }
    }
    return false;
}

bool ki_analysis_add_vector(const ki_analysis *analysis, ki_analysis_workspace *w,
                            const ki_rows rows[2], int vector, kiln_spectrum *spectrum)
{
    run r = {.analysis = analysis, .work = w, .rows = {rows[0], rows[1]}, .spectrum = spectrum};
    return transform_vectors(&r, vector, 1);
}

bool ki_analysis_sum_orders(const ki_analysis *analysis, ki_analysis_workspace *w,
                            kiln_spectrum *spectrum)
{
    return sum_orders(&(run){.analysis = analysis, .work = w, .spectrum = spectrum});
}
