// Resampling between panoramas and cubes or octahedra. In: the texels of one of the two maps. Out:
// the texels of the other map, exact up to rounding of weights and sums to float. Method: stencils
// (stencil.h), which list for each texel of the cube or octahedron the panorama's texels under it
// and the areas that the two share. Gather sums the panorama's texels by the stencils and writes
// the cube. Scatter adds each texel of the cube to the panorama by its stencil, band after band of
// rows.
#include "image/resample_method.h"

#include "base/vector.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

enum {
    // least number of texels along a side of a computed map; each texel of a smaller map is the
    // mean of a block of texels of a computed map
    FEWEST = 32,
    AHEAD = 192, // number of stencils by which the prefetch of their texels precedes their sum
    // number of blocks of 4 texels that are summed as floats before the sum is added to doubles
    FLUSH = 64
};

// Marks functions with an argument `mirror` that are inlined once with true and once with false, so
// that their loops have no branch. The function prefetch() needs the mark too, because GCC removes
// calls to a function that does nothing but prefetch.
#define ALWAYS_INLINE __attribute__((always_inline)) static inline

// ------------------------------------------------------------------------------------------- grids

// Returns the coordinate of the texel `k` steps from the middle of a side of 2 * half texels,
// towards larger coordinates if `sign` is positive, else towards smaller ones.
static int from_middle(int sign, int k, int half)
{
    return sign > 0 ? half + k : half - 1 - k;
}

// Returns the index in the map of texel (p, q) of a grid. A grid covers a quarter of a cube's top
// face or of an octahedron; `quarter` is the number of quarter turns, and p runs along the
// quarter's first direction.
static ptrdiff_t quarter_texel(ki_stencil_kind kind, int quarter, bool flip, int p, int q, int half)
{
    if (flip && kind != KI_STENCIL_TOP) {
        // The lower half of an octahedron is folded outwards, which swaps p and q and counts them
        // from the border.
        int swap = p;
        p = half - 1 - q;
        q = half - 1 - swap;
    }
    // Forward is -Z and right is +X: (forward, right) is (p, q) turned by the number of quarters.
    static const int forward_sign[4] = {1, -1, -1, 1}, right_sign[4] = {1, 1, -1, -1};
    int forward = quarter & 1 ? q : p, right = quarter & 1 ? p : q;
    // rows of the face +Y grow towards +Z, rows of the face -Y towards -Z
    bool bottom = flip && kind == KI_STENCIL_TOP;
    int x = from_middle(right_sign[quarter], right, half);
    int y = from_middle(bottom ? forward_sign[quarter] : -forward_sign[quarter], forward, half);
    ptrdiff_t n = 2 * (ptrdiff_t)half;
    ptrdiff_t face = kind == KI_STENCIL_TOP ? (flip ? 3 : 2) : 0;
    return (face * n + y) * n + x;
}

static void add_place(ki_stencil_grid *grid, int quarter, bool mirror, bool flip, int column,
                      int mirror_column)
{
    ki_stencil_place *place = &grid->place[grid->place_count++];
    *place = (ki_stencil_place){
        .column = column, .mirror_column = mirror_column, .mirror = mirror, .flip = flip};
    int half = grid->half;
    ptrdiff_t n = 2 * (ptrdiff_t)half;
    if (grid->kind == KI_STENCIL_SIDE) {
        // -Z, +X, +Z and -X, the order in which the panorama's columns meet the faces. A grid's i
        // grows against the coordinate s of a face unless the grid is mirrored.
        static const int faces[4] = {5, 0, 4, 1};
        int x = mirror ? half : half - 1, y = flip ? half : half - 1;
        place->base = (faces[quarter] * n + y) * n + x;
        place->across = mirror ? 1 : -1;
        place->down = flip ? n : -n;
        return;
    }
    int i = mirror ? 0 : 1, j = 1 - i;
    ki_stencil_kind kind = grid->kind;
    place->base = quarter_texel(kind, quarter, flip, 0, 0, half);
    place->across = quarter_texel(kind, quarter, flip, i, j, half) - place->base;
    place->down = quarter_texel(kind, quarter, flip, j, i, half) - place->base;
}

// Adds the grids of stencils of one kind to a plan. The map has four quarters, one for each of the
// axes -Z, +X, +Z and -X. Quarters whose axes lie at the same fraction of a panorama column share a
// grid.
static kiln_result add_grids(kiln_context *context, ki_resample_plan *plan, ki_stencil_kind kind,
                             int half, int height, double turn, kiln_error *error)
{
    double width = 2.0 * height;
    for (int quarter = 0; quarter < 4; quarter++) {
        double first = width / 2 + quarter * (width / 4) + turn;
        first = ki_is_whole(2 * first) ? floor(2 * first + 0.5) / 2 : first;
        int column = (int)floor(first);
        double offset = first - column;
        ki_stencil_grid *grid = NULL;
        for (int k = 0; k < plan->grid_count; k++)
            if (plan->grid[k].kind == kind && fabs(plan->grid[k].offset - offset) < 1e-9)
                grid = &plan->grid[k];
        // Mirroring a cube's side at its middle, or a quarter of the map at its diagonal, takes the
        // panorama position x, in columns, to `about` - x. Columns fall on columns if `about` is
        // whole.
        double about = kind == KI_STENCIL_SIDE ? 2 * offset : 2 * offset + width / 4;
        if (!grid) {
            grid = &plan->grid[plan->grid_count++];
            *grid = (ki_stencil_grid){.kind = kind,
                                      .half = half,
                                      .height = height,
                                      .offset = offset,
                                      .halved = ki_is_whole(about)};
        }
        int mirror_column = column + (int)floor(about + 0.5) - 1;
        for (int k = 0; k < 4; k++) {
            bool mirror = k & 1, flip = k & 2;
            if ((mirror && !grid->halved) || (flip && kind == KI_STENCIL_RIM))
                continue;
            add_place(grid, quarter, mirror, flip, column, mirror_column);
        }
    }
    for (int k = 0; k < plan->grid_count; k++) {
        ki_stencil_grid *grid = &plan->grid[k];
        if (grid->kind != kind)
            continue;
        kiln_result result = ki_stencil_grid_build(context, grid, error);
        if (result)
            return result;
    }
    return KILN_OK;
}

kiln_result ki_resample_plan_stencils(kiln_context *context, ki_resample_plan *plan,
                                      kiln_shape shape, int n, int height, double rotation,
                                      kiln_error *error)
{
    // The stencils need an even number of texels along a face, so that the middle of the face lies
    // between texels, and at least FEWEST, so that stencils stay small. Other sizes are multiplied
    // by the smallest factor that fits; the finer map is averaged afterwards.
    plan->factor = 1;
    while ((n * plan->factor) % 2 || n * plan->factor < FEWEST)
        plan->factor++;
    int half = n * plan->factor / 2;
    double turn = fmod(rotation, 360) * (2.0 * height) / 360;
    if (ki_is_whole(turn))
        turn = floor(turn + 0.5);
    kiln_result result;
    if (shape == KILN_SHAPE_CUBE) {
        result = add_grids(context, plan, KI_STENCIL_SIDE, half, height, turn, error);
        if (!result)
            result = add_grids(context, plan, KI_STENCIL_TOP, half, height, turn, error);
    } else {
        result = add_grids(context, plan, KI_STENCIL_OCTAHEDRON, half, height, turn, error);
        if (!result)
            result = add_grids(context, plan, KI_STENCIL_RIM, half, height, turn, error);
    }
    return result;
}

// Runs through the stencils of a chunk at one place of the map.
typedef struct cursor {
    const ki_stencil_grid *grid;
    const ki_stencil_place *place;
    const ki_stencil *stencil;
    const float *weights;
    ptrdiff_t texel; // index in the map of the texel to which the stencil belongs
    int i, end, j, stop;
} cursor;

static void start_row(cursor *c)
{
    ki_stencil_grid_range(c->grid, c->j, &c->i, &c->end);
    c->texel = c->place->base + c->i * c->place->across + c->j * c->place->down;
}

static cursor cursor_start(const ki_stencil_grid *grid, int chunk, const ki_stencil_place *place)
{
    cursor c = {.grid = grid,
                .place = place,
                .stencil = grid->chunks[chunk].stencils,
                .weights = grid->chunks[chunk].weights,
                .j = chunk * KI_STENCIL_ROWS};
    c.stop = ki_min(c.j + KI_STENCIL_ROWS, ki_stencil_grid_rows(grid));
    start_row(&c);
    return c;
}

// Moves to the next stencil: in the same row of the grid, or the first of the next row, since every
// row has at least one stencil. Returns false after the last stencil of the chunk.
static inline bool cursor_next(cursor *c)
{
    c->weights += (size_t)c->stencil->rows * c->stencil->blocks * 4;
    c->stencil++;
    c->texel += c->place->across;
    if (++c->i < c->end)
        return true;
    if (++c->j >= c->stop)
        return false;
    start_row(c);
    return true;
}

// Returns the leftmost panorama column that a stencil covers at a place of the map.
static inline int first_column(const ki_stencil *stencil, const ki_stencil_place *place, int width)
{
    int column = place->mirror ? place->mirror_column - (stencil->column + 4 * stencil->blocks - 1)
                               : place->column + stencil->column;
    return wrap(column, width);
}

// ------------------------------------------------------------------------------------------ gather

// Four floats. Four RGB texels are three such vectors, with the channels rgbr, gbrg and brgb.
typedef ki_float4 lanes;

typedef struct sums {
    lanes a, b, c;
} sums;

static inline lanes load(const float *from)
{
    lanes v;
    memcpy(&v, from, sizeof v);
    return v;
}

ALWAYS_INLINE void add_blocks(sums *sum, const float *texels, const float *weights, int blocks,
                              bool mirror)
{
    if (mirror)
        weights += (ptrdiff_t)4 * (blocks - 1);
    for (int k = 0; k < blocks; k++, texels += 12) {
        lanes w = load(weights), wa, wb, wc;
        if (mirror) {
            wa = KI_SHUFFLE4(w, w, 3, 3, 3, 2);
            wb = KI_SHUFFLE4(w, w, 2, 2, 1, 1);
            wc = KI_SHUFFLE4(w, w, 1, 0, 0, 0);
            weights -= 4;
        } else {
            wa = KI_SHUFFLE4(w, w, 0, 0, 0, 1);
            wb = KI_SHUFFLE4(w, w, 1, 1, 2, 2);
            wc = KI_SHUFFLE4(w, w, 2, 3, 3, 3);
            weights += 4;
        }
        sum->a += wa * load(texels);
        sum->b += wb * load(texels + 4);
        sum->c += wc * load(texels + 8);
    }
}

// Adds up the lanes by channel and returns red, green and blue in the first three lanes. The three
// vectors of `sum` hold the channels rgbr, gbrg and brgb of four texels.
static inline lanes total(const sums *sum)
{
    lanes a = sum->a, b = sum->b, c = sum->c;
    return (a + KI_SHUFFLE4(a, b, 3, 4, 5, 5)) +
           (KI_SHUFFLE4(b, c, 2, 3, 4, 4) + KI_SHUFFLE4(c, c, 1, 2, 3, 3));
}

static inline void flush(sums *sum, double rgb[3])
{
    lanes t = total(sum);
    for (int c = 0; c < 3; c++)
        rgb[c] += (double)t[c];
    *sum = (sums){0};
}

// Adds a stencil's weighted sum of texels to `rgb`, for stencils that are large or extend across
// the panorama's left or right edge. A stencil of up to FLUSH blocks gets the same bits as from the
// faster loop in gather_place.
static void gather_slowly(const float *source, int width, ptrdiff_t stride,
                          const ki_stencil *stencil, const float *weights, int column, bool mirror,
                          double rgb[3])
{
    sums sum = {0};
    int pending = 0, blocks = stencil->blocks;
    for (int r = 0; r < stencil->rows; r++, source += stride, weights += 4 * (size_t)blocks) {
        for (int k = 0; k < blocks; k += FLUSH) {
            int count = ki_min(FLUSH, blocks - k);
            if (pending + count > FLUSH) {
                flush(&sum, rgb);
                pending = 0;
            }
            const float *part = weights + 4 * (size_t)(mirror ? blocks - k - count : k);
            int at = column + 4 * k;
            if (at + 4 * count <= width) {
                add_blocks(&sum, source + 3 * (size_t)at, part, count, mirror);
            } else {
                float texels[12 * FLUSH];
                for (int i = 0; i < 4 * count; i++)
                    memcpy(texels + 3 * (size_t)i, source + 3 * (size_t)((at + i) % width),
                           3 * sizeof(float));
                add_blocks(&sum, texels, part, count, mirror);
            }
            pending += count;
        }
    }
    flush(&sum, rgb);
}

// Prefetches the panorama texels of a stencil that is summed soon, because stencils read many
// short, scattered pieces of memory.
ALWAYS_INLINE void prefetch(const ki_stencil_grid *grid, const ki_stencil_place *place,
                            const ki_stencil *s, const float *source)
{
    int height = grid->height, width = 2 * height, rows = s->rows;
    if (rows * s->blocks > 64)
        return;
    int row = place->flip ? height - s->row - rows : s->row;
    const float *texels = source + 3 * ((ptrdiff_t)row * width + first_column(s, place, width));
    for (int r = 0; r < rows; r++, texels += 3 * (ptrdiff_t)width)
        for (int k = 0; k < s->blocks; k += 2)
            __builtin_prefetch(texels + (ptrdiff_t)12 * k);
}

// Sums one stencil. `line` is the panorama row in which the stencil's first row of weights lies,
// and `stride` the distance from there to the next row.
ALWAYS_INLINE void gather_texel(const ki_stencil *s, const float *weights, const float *line,
                                ptrdiff_t stride, int width, int column, bool mirror, float *out)
{
    int blocks = s->blocks, rows = s->rows;
    if (rows * blocks <= FLUSH && column + 4 * blocks <= width) {
        const float *texels = line + 3 * (ptrdiff_t)column;
        ptrdiff_t step = (ptrdiff_t)4 * blocks;
        sums sum = {0};
        for (int r = 0; r < rows; r++, texels += stride, weights += step)
            add_blocks(&sum, texels, weights, blocks, mirror);
        lanes rgb = total(&sum);
        out[0] = rgb[0];
        out[1] = rgb[1];
        out[2] = rgb[2];
    } else {
        double rgb[3] = {0, 0, 0};
        gather_slowly(line, width, stride, s, weights, column, mirror, rgb);
        for (int k = 0; k < 3; k++)
            out[k] = (float)rgb[k];
    }
}

ALWAYS_INLINE void gather_place(const ki_stencil_grid *grid, int chunk,
                                const ki_stencil_place *place, bool mirror, const float *source,
                                float *target)
{
    int height = grid->height, width = 2 * height;
    ptrdiff_t stride = 3 * (ptrdiff_t)width * (place->flip ? -1 : 1);
    cursor c = cursor_start(grid, chunk, place);
    const ki_stencil *last = c.stencil + grid->chunks[chunk].stencil_count - 1;
    do {
        const ki_stencil *s = c.stencil;
        if (last - s >= AHEAD)
            prefetch(grid, place, s + AHEAD, source);
        int column = first_column(s, place, width);
        int row = place->flip ? height - 1 - s->row : s->row;
        gather_texel(s, c.weights, source + (ptrdiff_t)3 * width * row, stride, width, column,
                     mirror, target + 3 * c.texel);
    } while (cursor_next(&c));
}

// Returns the number of stencils of a chunk that have a depth below `depth`.
static size_t count_above(const ki_stencil_grid *grid, const ki_stencil_chunk *chunk, int depth)
{
    size_t low = 0, high = chunk->stencil_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const ki_stencil *s = &chunk->stencils[chunk->by_depth[middle].index];
        if (ki_stencil_depth(s->row, s->rows, grid->height) < depth)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Computes the texels of a chunk, at one place of the map, that the rows of the run's band
// complete. Their stencils are the entries from `first` to `end` - 1 of the chunk's list by depth.
ALWAYS_INLINE void gather_band(const ki_resample_run *run, const ki_stencil_grid *grid, int chunk,
                               const ki_stencil_place *place, bool mirror, size_t first, size_t end)
{
    const ki_stencil_chunk *stencils = &grid->chunks[chunk];
    int height = grid->height, width = 2 * height;
    ptrdiff_t line = 3 * (ptrdiff_t)width, across = place->across, down = place->down;
    bool flip = place->flip;
    for (size_t k = first; k < end; k++) {
        const ki_stencil_entry *e = &stencils->by_depth[k];
        const ki_stencil *s = &stencils->stencils[e->index];
        const float *source =
            ki_resample_rows(run, flip ? height - s->row - s->rows : s->row, s->rows);
        if (!source)
            continue;
        source += flip ? line * (s->rows - 1) : 0;
        gather_texel(s, stencils->weights + 4 * (size_t)e->blocks, source, flip ? -line : line,
                     width, first_column(s, place, width), mirror,
                     run->fine + 3 * (place->base + e->i * across + e->j * down));
    }
}

int ki_resample_gather_reach(const ki_resample_plan *plan)
{
    int most = 1;
    for (int k = 0; k < plan->grid_count; k++)
        for (int q = 0; q < plan->grid[k].chunk_count; q++) {
            const ki_stencil_chunk *chunk = &plan->grid[k].chunks[q];
            for (size_t i = 0; i < chunk->stencil_count; i++)
                most = ki_max(most, chunk->stencils[i].rows);
        }
    return most;
}

// Task of one thread: computes the texels of one chunk of a grid at all places of the map where the
// grid is used.
void ki_resample_gather(void *data, int index)
{
    const ki_resample_run *run = data;
    const ki_resample_plan *plan = run->plan;
    const ki_stencil_grid *grid = plan->grid;
    while (index >= grid->chunk_count)
        index -= (grid++)->chunk_count;
    // A stencil has the same depth at every place of the map, so the band has the same stencils at
    // all places.
    bool bands = !run->source;
    size_t first = bands ? count_above(grid, &grid->chunks[index], run->from) : 0;
    size_t end = bands ? count_above(grid, &grid->chunks[index], run->to) : 0;
    for (int k = 0; k < grid->place_count; k++) {
        const ki_stencil_place *place = &grid->place[k];
        if (bands && place->mirror)
            gather_band(run, grid, index, place, true, first, end);
        else if (bands)
            gather_band(run, grid, index, place, false, first, end);
        else if (place->mirror)
            gather_place(grid, index, place, true, run->source, run->fine);
        else
            gather_place(grid, index, place, false, run->source, run->fine);
    }
}

// Task of one thread: averages `factor` rows of the finer map to one row of the map.
void ki_resample_coarsen(void *data, int index)
{
    const ki_resample_run *run = data;
    const ki_resample_plan *plan = run->plan;
    int n = plan->size, factor = plan->factor;
    size_t fine = (size_t)n * (size_t)factor;
    const float *from = run->fine + (size_t)index * (size_t)factor * fine * 3;
    const float *areas = plan->fine_area + (size_t)(index % n) * (size_t)factor * fine;
    float *out = run->target + (size_t)index * (size_t)n * 3;
    for (int x = 0; x < n; x++) {
        double rgb[3] = {0, 0, 0}, total = 0;
        for (int j = 0; j < factor; j++) {
            for (int i = 0; i < factor; i++) {
                size_t at = (size_t)j * fine + (size_t)x * (size_t)factor + (size_t)i;
                double area = (double)areas[at];
                for (int c = 0; c < 3; c++)
                    rgb[c] += area * (double)from[3 * at + (size_t)c];
                total += area;
            }
        }
        for (int c = 0; c < 3; c++)
            out[3 * (size_t)x + (size_t)c] = (float)(rgb[c] / total);
    }
}

// ----------------------------------------------------------------------------------------- scatter

// Task of one thread: computes a band of rows of a panorama. Every stencil adds the light of its
// texel to the panorama texels that it covers.
void ki_resample_scatter(void *data, int index)
{
    const ki_resample_run *run = data;
    const ki_resample_plan *plan = run->plan;
    int height = plan->size, width = 2 * height;
    int first = (run->first_band + index) * plan->band_rows;
    int end = ki_min(first + plan->band_rows, height);
    if (first >= end)
        return;
    size_t line = 3 * (size_t)width;
    double *band = run->bands + (size_t)index * (size_t)plan->band_rows * line;
    memset(band, 0, (size_t)(end - first) * line * sizeof *band);

    ptrdiff_t n = plan->source_size, factor = plan->factor, fine = n * factor;
    for (int g = 0; g < plan->grid_count; g++) {
        const ki_stencil_grid *grid = &plan->grid[g];
        for (int k = 0; k < grid->place_count; k++) {
            const ki_stencil_place *place = &grid->place[k];
            for (int q = 0; q < grid->chunk_count; q++) {
                const ki_stencil_chunk *chunk = &grid->chunks[q];
                int low = place->flip ? height - chunk->end_row : chunk->first_row;
                int high = place->flip ? height - chunk->first_row : chunk->end_row;
                if (low >= end || high <= first)
                    continue;
                cursor c = cursor_start(grid, q, place);
                do {
                    const ki_stencil *s = c.stencil;
                    int row = place->flip ? height - s->row - s->rows : s->row;
                    int from = ki_max(row, first), to = ki_min(row + s->rows, end);
                    // A texel on the diagonal of a quarter of the map is its own mirror image, and
                    // its light is added only once.
                    bool again = place->mirror && grid->kind != KI_STENCIL_SIDE && c.i == c.j;
                    if (from >= to || again)
                        continue;
                    ptrdiff_t texel = c.texel;
                    if (factor > 1)
                        texel = texel / fine / factor * n + texel % fine / factor;
                    double rgb[3];
                    for (int i = 0; i < 3; i++)
                        rgb[i] = (double)s->area * (double)run->source[3 * texel + i];
                    int columns = 4 * s->blocks, column = first_column(s, place, width);
                    for (int r = from; r < to; r++) {
                        int own = place->flip ? row + s->rows - 1 - r : r - row;
                        const float *w = c.weights + (size_t)own * (size_t)columns;
                        double *out = band + (size_t)(r - first) * line;
                        for (int i = 0, x = column; i < columns; i++) {
                            double weight = (double)w[place->mirror ? columns - 1 - i : i];
                            for (size_t h = 0; h < 3; h++)
                                out[3 * (size_t)x + h] += weight * rgb[h];
                            x = x + 1 == width ? 0 : x + 1;
                        }
                    }
                } while (cursor_next(&c));
            }
        }
    }
    for (int r = first; r < end; r++) {
        // The difference of the cosines of a row's edges, by cos a - cos b = 2 sin((a + b) / 2)
        // sin((b - a) / 2), which avoids cancellation.
        double step = KI_PI / height;
        double tall = 2 * ki_sin((r + 0.5) * step) * ki_sin(0.5 * step);
        double scale = width / (2 * KI_PI * tall);
        const double *in = band + (size_t)(r - first) * line;
        float *out = run->target + (size_t)r * line;
        for (size_t i = 0; i < line; i++)
            out[i] = (float)(in[i] * scale);
    }
}

// ------------------------------------------------------------------------------------- finer maps

kiln_result ki_resample_plan_fine(kiln_context *context, ki_resample_plan *plan, kiln_error *error)
{
    size_t fine = (size_t)plan->size * (size_t)plan->factor;
    size_t area = 0;
    bool fits = ki_mul_size(fine, fine, &area);
    plan->fine_area = fits ? ki_alloc_raw(context, area, sizeof *plan->fine_area) : NULL;
    if (!plan->fine_area)
        return ki_fail_memory(context, error, "resampling", fits ? area * sizeof(float) : SIZE_MAX);
    // The faces of a cube have equal solid angles at equal texels, so the solid angles of face +Y
    // are stored for all faces.
    ptrdiff_t before = plan->shape == KILN_SHAPE_CUBE ? 2 * (ptrdiff_t)area : 0;
    for (int g = 0; g < plan->grid_count; g++) {
        const ki_stencil_grid *grid = &plan->grid[g];
        for (int k = 0; k < grid->place_count; k++) {
            if (grid->kind == KI_STENCIL_SIDE ||
                (grid->kind == KI_STENCIL_TOP && grid->place[k].flip))
                continue;
            for (int q = 0; q < grid->chunk_count; q++) {
                cursor c = cursor_start(grid, q, &grid->place[k]);
                do {
                    plan->fine_area[c.texel - before] = c.stencil->area;
                } while (cursor_next(&c));
            }
        }
    }
    return KILN_OK;
}
