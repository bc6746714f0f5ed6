// The analysis of a panorama (docs/theory/spectral.md). In: the rows of a panorama as RGB floats, a
// whole one or row by row. Out: its spherical-harmonic coefficients up to a degree, and the list of
// suns left out of them. Method: rows are distributed onto latitude rings by the transpose of an
// interpolation with eight weights, the suns are subtracted, each ring is Fourier-transformed, and
// each order is summed over the rings with the Legendre functions.
#include "sphere/spectrum.h"

#include "math/math.h"
#include "sphere/grid.h"

#include <math.h>
#include <string.h>

// A texel can be kept out of the spectrum as a sun only if it holds at least this share of the
// panorama's light in some channel.
static const double sun_share = 1e-3;
// A texel can be kept out of the spectrum as a sun only if it is at least this many times brighter
// than the mean of the panorama.
static const double sun_contrast = 200;
// Greatest number of texels that may be suns at a time. In one channel no more than 1000 texels can
// hold the share sun_share of the light.
enum { CANDIDATES = 4096 };

// ---------------------------------------------------------------------------------------- the plan

enum { ROW_NODES = 6 };

// Computes the weights with which one row of the panorama contributes to the latitude rings from
// ring *first on. The weight of a ring is the integral over the row, from theta0 to theta1, of the
// ring's interpolating function times sin theta. Rings k < 0 or k >= ring_count lie beyond a pole.
// Returns the number of weights; with `weights` NULL the weights are only counted.
static int weigh_row(double theta0, double theta1, int ring_count, const double *taps,
                     const double rule[2][ROW_NODES], int *first, double *weights)
{
    // latitude ring k lies at theta = (k + 1/2) / scale
    double scale = ring_count / KI_PI;
    int low = (int)floor(theta0 * scale - 0.5), high = (int)floor(theta1 * scale - 0.5);
    *first = low - 3;
    int count = high - low + KI_TAPS;
    if (!weights)
        return count;
    memset(weights, 0, (size_t)count * sizeof *weights);
    for (int k = low; k <= high; k++) {
        double a = fmax(theta0, (k + 0.5) / scale), b = fmin(theta1, (k + 1.5) / scale);
        for (int n = 0; n < ROW_NODES && b > a; n++) {
            double theta = a + (b - a) * 0.5 * (1 + rule[0][n]), tap[KI_TAPS];
            double weight = rule[1][n] * (b - a) * 0.5 * ki_sin(theta);
            ki_taps_at(taps, ki_clamp(theta * scale - 0.5 - k, 0, 1), tap);
            for (int i = 0; i < KI_TAPS; i++)
                weights[k - low + i] += weight * tap[i];
        }
    }
    return count;
}

// Returns the index of the latitude ring with which a ring k < 0 or k >= count, beyond a pole,
// coincides. *half_turn says whether the ring lies beyond a pole: its points are then half a turn
// away in longitude.
static int real_ring(int ring, int count, bool *half_turn)
{
    *half_turn = ring < 0 || ring >= count;
    return ring < 0 ? -1 - ring : ring >= count ? 2 * count - 1 - ring : ring;
}

// Fills in the weights with which rows contribute to latitude rings, sorted by ring: the first pass
// counts the weights of each ring, the second pass stores them. Returns false when memory runs out.
static bool plan_row_weights(kiln_context *context, ki_analysis *a, const double *taps)
{
    int size = a->size, rings = 2 * a->rings.pair_count, first;
    double rule[2][ROW_NODES];
    ki_gauss_legendre(ROW_NODES, rule[0], rule[1]);
    const double(*nodes)[ROW_NODES] = (const double(*)[ROW_NODES])rule;
    // A row contributes to at most as many latitude rings as its height covers, rings / size, and
    // at each end to half as many as the interpolation has weights.
    int most = rings / size + KI_TAPS + 2;
    double *weights = ki_alloc_raw(context, (size_t)most, sizeof *weights);
    int *filled = ki_alloc(context, (size_t)rings, sizeof *filled);
    a->ring_start = ki_alloc(context, (size_t)rings + 1, sizeof *a->ring_start);
    bool good = weights && filled && a->ring_start;
    for (int pass = 0; good && pass < 2; pass++) {
        for (int j = 0; j < size; j++) {
            int count = weigh_row(j * KI_PI / size, (j + 1) * KI_PI / size, rings, taps, nodes,
                                  &first, pass ? weights : NULL);
            for (int i = 0; i < count; i++) {
                bool half_turn;
                int ring = real_ring(first + i, rings, &half_turn);
                if (pass)
                    a->row_weights[a->ring_start[ring] + filled[ring]++] =
                        (ki_row_weight){j, half_turn, weights[i]};
                else
                    a->ring_start[ring + 1]++;
            }
        }
        for (int k = 0; !pass && k < rings; k++)
            a->ring_start[k + 1] += a->ring_start[k];
        if (!pass)
            a->row_weights =
                ki_alloc_raw(context, (size_t)a->ring_start[rings], sizeof *a->row_weights);
        good = a->row_weights != NULL;
    }
    ki_free(weights);
    ki_free(filled);
    return good;
}

kiln_result ki_analysis_create(kiln_context *context, int size, int degree, const double *density,
                               ki_analysis **analysis, kiln_error *error)
{
    ki_analysis *a = *analysis = ki_alloc(context, 1, sizeof *a);
    double *taps = ki_alloc_raw(context, KI_TAP_TABLE, sizeof *taps);
    if (!a || !taps)
        goto failed;
    a->kernels = ki_sphere_kernels(context);
    a->size = size;
    a->degree = degree;
    a->column = ki_alloc_raw(context, (size_t)degree + 1, 2 * sizeof(double));
    if (!a->column || !ki_legendre_create(context, degree, &a->legendre) ||
        !ki_rings_create_grid(context, degree, &a->rings) ||
        !ki_fft_create(context, 2 * size, &a->fft))
        goto failed;

    // Integrates exp(-i m phi) over the columns of texels, each d radians wide. The integral over
    // column x is exp(-i m x d) times exp(-i m d / 2) d sinc(m d / 2). The Fourier transform
    // supplies the first factor, which depends on x. `column` holds the product of the others, with
    // sinc(y) = sin(y) / y.
    double d = KI_PI / size;
    for (int m = 0; m <= degree; m++) {
        double sine, cosine, width = m ? ki_sin(m * d / 2) * 2 / m : d;
        double *column = a->column + 2 * (size_t)m;
        ki_sincos(-m * d / 2, &sine, &cosine);
        column[0] = cosine * width;
        column[1] = sine * width;
    }
    ki_taps_design(KI_PI / (2 * a->rings.pair_count), density, degree, taps);
    if (!plan_row_weights(context, a, taps))
        goto failed;
    ki_free(taps);
    return KILN_OK;
failed:
    ki_free(taps);
    ki_analysis_destroy(a);
    *analysis = NULL;
    return ki_fail_memory(context, error, "the analysis' tables",
                          (size_t)degree * (size_t)degree * 16);
}

void ki_analysis_destroy(ki_analysis *analysis)
{
    if (!analysis)
        return;
    ki_legendre_destroy(&analysis->legendre);
    ki_rings_destroy(&analysis->rings);
    ki_fft_destroy(&analysis->fft);
    ki_free(analysis->column);
    ki_free(analysis->ring_start);
    ki_free(analysis->row_weights);
    ki_free(analysis);
}

kiln_result ki_spectrum_create(kiln_context *context, const ki_analysis *analysis,
                               kiln_spectrum **spectrum, kiln_error *error)
{
    kiln_spectrum *s = *spectrum = ki_alloc(context, 1, sizeof *s);
    if (s) {
        *s =
            (kiln_spectrum){.context = context, .degree = analysis->degree, .size = analysis->size};
        s->a = ki_alloc(context, ki_coefficient_count(s->degree), sizeof *s->a);
        s->suns = ki_alloc_raw(context, CANDIDATES, sizeof *s->suns);
    }
    if (s && s->a && s->suns)
        return KILN_OK;
    kiln_spectrum_destroy(s);
    *spectrum = NULL;
    return ki_fail_memory(context, error, "a spectrum",
                          ki_coefficient_count(analysis->degree) * sizeof(double));
}

void kiln_spectrum_destroy(kiln_spectrum *spectrum)
{
    if (!spectrum)
        return;
    ki_free(spectrum->a);
    ki_free(spectrum->suns);
    ki_free(spectrum);
}

int kiln_spectrum_degree(const kiln_spectrum *spectrum)
{
    return spectrum->degree;
}

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
    // the equator, then of the odd part.
    double *orders;
    // Scratch memory of each worker: two FFT buffers and 16 latitude rings, or the state of the
    // Legendre recurrence.
    double *scratch;
    size_t scratch_size;
};

// The data of one call of ki_analysis_add_rows, _finish or _execute, which all its tasks share.
typedef struct run {
    const ki_analysis *analysis;
    ki_analysis_workspace *work;
    // RGB of the panorama rows that are added, or of the whole panorama
    const float *rows;
    int row_count;           // number of rows in `rows`
    kiln_spectrum *spectrum; // the spectrum that is written
} run;

enum {
    PIECES = 16,             // number of pieces into which each half of a panorama row is cut
    RING_SET = 2 * KI_LANES, // number of latitude rings in a vector, two in each lane
};

kiln_result ki_analysis_workspace_create(kiln_context *context, const ki_analysis *analysis,
                                         bool whole, ki_analysis_workspace **workspace,
                                         kiln_error *error)
{
    size_t width = 2 * (size_t)analysis->size, rings = 2 * (size_t)analysis->rings.pair_count;
    size_t threads = (size_t)ki_context_threads(context), row, ring_bytes;
    size_t vectors = (size_t)analysis->rings.vector_count;
    ki_analysis_workspace *w = *workspace = ki_alloc(context, 1, sizeof *w);
    if (!w)
        return ki_fail_memory(context, error, "an analysis", sizeof *w);
    w->context = context;
    w->scratch_size = width * 16 * 2 + (whole ? width * 3 * RING_SET : 0);
    if (w->scratch_size < 16 * vectors)
        w->scratch_size = 16 * vectors;
    if (!ki_mul_size(width, 3 * sizeof(double), &row) || !ki_mul_size(row, rings, &ring_bytes))
        ring_bytes = SIZE_MAX;
    w->rings = whole ? NULL : ki_alloc(context, ring_bytes, 1);
    w->row_sums = ki_alloc_raw(context, (size_t)analysis->size, 3 * sizeof(double));
    w->row_peaks = ki_alloc_raw(context, (size_t)analysis->size, sizeof(float));
    w->candidates = ki_alloc_raw(context, CANDIDATES, sizeof *w->candidates);
    w->orders =
        ki_alloc_raw(context, ((size_t)analysis->degree + 1) * vectors, 96 * sizeof(double));
    w->scratch = ki_alloc_raw(context, threads * w->scratch_size, sizeof(double));
    if ((w->rings || whole) && w->row_sums && w->row_peaks && w->candidates && w->orders &&
        w->scratch)
        return KILN_OK;
    ki_analysis_workspace_destroy(w);
    *workspace = NULL;
    return ki_fail_memory(context, error, "the rings of an analysis", whole ? row : ring_bytes);
}

void ki_analysis_workspace_destroy(ki_analysis_workspace *workspace)
{
    if (!workspace)
        return;
    ki_free(workspace->rings);
    ki_free(workspace->row_sums);
    ki_free(workspace->row_peaks);
    ki_free(workspace->candidates);
    ki_free(workspace->orders);
    ki_free(workspace->scratch);
    ki_free(workspace);
}

// ---------------------------------------------------------------------------------------- the rows

// Adds the weighted panorama rows r->rows to one piece of a latitude ring. The two halves of a row
// (`half` 0 and 1) are cut at the same places, so that a ring beyond a pole, half a turn away,
// receives the same piece of the other half. The rows are added in their order, so that the sums do
// not depend on how many rows come at a time.
static void add_to_piece(const run *r, int ring, int half, int piece, double *accumulator)
{
    enum { MOST = 32 };
    const ki_analysis *a = r->analysis;
    int size = a->size, from = piece * size / PIECES, count = (piece + 1) * size / PIECES - from;
    ptrdiff_t here = 3 * ((ptrdiff_t)half * size + from);
    ptrdiff_t there = 3 * ((ptrdiff_t)(1 - half) * size + from), offsets[MOST];
    double weights[MOST];
    int n = 0;
    for (int i = a->ring_start[ring]; i < a->ring_start[ring + 1]; i++) {
        const ki_row_weight *from_row = &a->row_weights[i];
        int row = from_row->row - r->work->row_count;
        if (row < 0 || row >= r->row_count)
            continue;
        offsets[n] = (ptrdiff_t)row * size * 6 + (from_row->half_turn ? there : here);
        weights[n++] = from_row->weight;
        if (n == MOST) {
            a->kernels->add_weighted(accumulator + here, r->rows, offsets, weights, n, 3 * count);
            n = 0;
        }
    }
    if (n)
        a->kernels->add_weighted(accumulator + here, r->rows, offsets, weights, n, 3 * count);
}

// Task of one thread: adds one piece of the panorama rows r->rows to all latitude rings.
static void add_to_rings(void *data, int index)
{
    const run *r = data;
    for (int ring = 0; ring < 2 * r->analysis->rings.pair_count; ring++)
        add_to_piece(r, ring, index / PIECES, index % PIECES,
                     r->work->rings + (ptrdiff_t)ring * r->analysis->size * 6);
}

// Task of one thread: sums the magnitudes of one of the rows r->rows and finds the largest.
static void sum_one_row(void *data, int index)
{
    const run *r = data;
    ki_analysis_workspace *w = r->work;
    int size = r->analysis->size, row = w->row_count + index;
    w->row_peaks[row] = r->analysis->kernels->sum_row(r->rows + (size_t)index * (size_t)size * 6,
                                                      2 * size, w->row_sums + 3 * (size_t)row);
}

static double row_solid_angle(int row, int size)
{
    // The solid angle of one texel is its width in longitude times the difference of cos theta
    // between its upper and lower edge.
    double high = ki_sin((row + 0.5) * KI_PI / size) * ki_sin(KI_PI / size / 2);
    return KI_PI / size * 2 * high;
}

// Returns true if a texel with the radiance `rgb` and this solid angle holds more than the share
// sun_share of the total light in some channel.
static bool is_candidate(const float rgb[3], double solid, const double total[3])
{
    for (int c = 0; c < 3; c++)
        if (fabs((double)rgb[c]) * solid > sun_share * total[c] && total[c] > 0)
            return true;
    return false;
}

// Removes the candidate suns that hold too small a share of the light of all rows so far, since
// that light grows with every row.
static void drop_candidates(ki_analysis_workspace *w, int size)
{
    int count = 0;
    for (int i = 0; i < w->candidate_count; i++) {
        ki_sun sun = w->candidates[i];
        if (is_candidate(sun.radiance, row_solid_angle(sun.row, size), w->total))
            w->candidates[count++] = sun;
    }
    w->candidate_count = count;
}

// Adds the light of the rows r->rows to the total, and their brightest texels to the candidate
// suns.
static void gather_candidates(const run *r)
{
    ki_analysis_workspace *w = r->work;
    int size = r->analysis->size;
    for (int j = 0; j < r->row_count; j++) {
        int row = w->row_count + j;
        double solid = row_solid_angle(row, size);
        for (int c = 0; c < 3; c++)
            w->total[c] += solid * w->row_sums[3 * row + c];
        float peak = w->row_peaks[row], peaks[3] = {peak, peak, peak};
        if (!is_candidate(peaks, solid, w->total))
            continue;
        for (int x = 0; x < 2 * size; x++) {
            const float *rgb = r->rows + 3 * ((size_t)j * 2 * (size_t)size + (size_t)x);
            if (!is_candidate(rgb, solid, w->total))
                continue;
            if (w->candidate_count == CANDIDATES)
                drop_candidates(w, size);
            if (w->candidate_count < CANDIDATES)
                w->candidates[w->candidate_count++] = (ki_sun){row, x, {rgb[0], rgb[1], rgb[2]}};
        }
    }
}

kiln_result ki_analysis_add_rows(const ki_analysis *analysis, ki_analysis_workspace *w,
                                 const float *rows, int count, kiln_error *error)
{
    if (count < 0 || count > analysis->size - w->row_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%d rows after %d: the panorama has %d", count,
                       w->row_count, analysis->size);
    run r = {.analysis = analysis, .work = w, .rows = rows, .row_count = count};
    ki_parallel_for(w->context, count, sum_one_row, &r);
    gather_candidates(&r);
    ki_parallel_for(w->context, 2 * PIECES, add_to_rings, &r);
    w->row_count += count;
    return KILN_OK;
}

// Writes the list of suns of the spectrum: the candidates that hold the share sun_share of the
// whole panorama's light and are sun_contrast times brighter than its mean.
static void select_suns(ki_analysis_workspace *w, kiln_spectrum *spectrum)
{
    int count = 0;
    drop_candidates(w, spectrum->size);
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

// Computes the Fourier transforms of eight pairs of latitude rings for one channel. The real part
// of the data is the northern ring of a pair, the imaginary part the southern ring. The sum of the
// transforms of both rings is the pair's part that is even about the equator, their difference the
// odd part.
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
    for (int m = 0, i = 0; m <= a->degree; m++, i = i + 1 == width ? 0 : i + 1) {
        if (vector < a->rings.first[m])
            continue;
        const double *p = z + 16 * (size_t)i, *q = z + 16 * (size_t)(i ? width - i : 0);
        double *orders = r->work->orders + 96 * ((size_t)m * vectors + (size_t)vector);
        double *even = orders + 16 * (size_t)channel, *odd = even + 48;
        const double *column = a->column + 2 * (size_t)m;
        double fr = column[0] * 0.5, fi = column[1] * 0.5;
        for (int j = 0; j < KI_LANES; j++) {
            double nr = p[j] + q[j], ni = p[8 + j] - q[8 + j];
            double sr = p[8 + j] + q[8 + j], si = q[j] - p[j];
            double er = nr + sr, ei = ni + si, dr = nr - sr, di = ni - si;
            even[j] = er * fr - ei * fi;
            even[8 + j] = er * fi + ei * fr;
            odd[j] = dr * fr - di * fi;
            odd[8 + j] = dr * fi + di * fr;
        }
    }
}

// Task of one thread: transforms eight pairs of latitude rings. If r->rows is the whole panorama,
// the rings are first summed from these rows.
static void transform_rings(void *data, int worker, int vector)
{
    const run *r = data;
    const ki_analysis *a = r->analysis;
    ki_analysis_workspace *w = r->work;
    size_t width = 2 * (size_t)a->size, pitch = 3 * width, buffers = width * 16 * 2;
    double *buffer = w->scratch + (size_t)worker * w->scratch_size, *rings[RING_SET];
    int number[RING_SET];
    for (int j = 0; j < KI_LANES; j++) {
        number[j] = KI_LANES * vector + j;
        number[KI_LANES + j] = 2 * a->rings.pair_count - 1 - number[j];
    }
    for (int j = 0; j < RING_SET; j++)
        rings[j] =
            w->rings ? w->rings + (size_t)number[j] * pitch : buffer + buffers + (size_t)j * pitch;
    if (!w->rings) {
        memset(rings[0], 0, RING_SET * pitch * sizeof(double));
        for (int piece = 0; piece < 2 * PIECES; piece++)
            for (int j = 0; j < RING_SET; j++)
                add_to_piece(r, number[j], piece / PIECES, piece % PIECES, rings[j]);
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
    a->kernels->analyze(a->legendre.f + row, count, a->rings.twice_cos,
                        a->rings.start + 8 * vectors * (size_t)m,
                        w->orders + 96 * vectors * (size_t)m, a->rings.first[m],
                        a->rings.vector_count, w->scratch + (size_t)worker * w->scratch_size, out);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < KI_COMPONENTS; c++)
            out[KI_COMPONENTS * i + c] *= a->legendre.scale[row + (size_t)i];
}

static void analyze_rings(run *r)
{
    ki_analysis_workspace *w = r->work;
    select_suns(w, r->spectrum);
    ki_parallel_workers(w->context, r->analysis->rings.vector_count, transform_rings, r);
    ki_parallel_workers(w->context, r->analysis->degree + 1, analyze_order, r);
}

kiln_result ki_analysis_finish(const ki_analysis *analysis, ki_analysis_workspace *w,
                               kiln_spectrum *spectrum, kiln_error *error)
{
    if (w->row_count != analysis->size)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the panorama has %d rows, only %d came",
                       analysis->size, w->row_count);
    analyze_rings(&(run){.analysis = analysis, .work = w, .spectrum = spectrum});
    return KILN_OK;
}

void ki_analysis_execute(const ki_analysis *analysis, ki_analysis_workspace *w, const float *rows,
                         kiln_spectrum *spectrum)
{
    run r = {.analysis = analysis,
             .work = w,
             .rows = rows,
             .row_count = analysis->size,
             .spectrum = spectrum};
    w->row_count = w->candidate_count = 0;
    memset(w->total, 0, sizeof w->total);
    ki_parallel_for(w->context, r.row_count, sum_one_row, &r);
    gather_candidates(&r);
    analyze_rings(&r);
}
