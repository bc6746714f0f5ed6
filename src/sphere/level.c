// Synthesis of one level (docs/theory/spectral.md). In: a spectrum, a lobe, and the shape and size
// of the level. Out: the texels of the level, RGB floats. Method: the coefficients of the spectrum
// are multiplied by the lobe's and summed on latitude rings. A small level is evaluated directly at
// its texels. For other levels the rings are Fourier-synthesised to a regular grid in (theta, phi),
// from which texels are interpolated with eight weights along each axis. The suns, bright texels
// kept out of the spectrum, are added as points.
#include "sphere/level.h"

#include "base/vector.h"
#include "image/image.h"
#include "math/math.h"
#include "sphere/grid.h"
#include "sphere/points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// PAD: number of rows and columns added at each side of the grid, which repeat values from the
// opposite side so that the interpolation needs no wrapping. TAP_OFFSET: index, among the eight
// weights along an axis, of the weight of the last grid point before the texel.
enum { PAD = 4, TAP_OFFSET = KI_TAPS / 2 - 1 };

// A texel of a small level. Such a level is evaluated at its texels, whose centres lie on few
// circles of latitude.
typedef struct place {
    // theta: angle of the texel's latitude ring, or of its mirror image if it lies in the south,
    // from the north pole. cosine, sine: of the longitude phi. sign: 1 in the northern hemisphere,
    // -1 in the southern.
    double theta, cosine, sine, sign;
    int texel, ring;
} place;

struct ki_level {
    const ki_kernels *kernels;
    const ki_legendre *legendre;
    ki_zonal zonal;
    ki_zonal_spectrum lobe;
    kiln_shape shape;
    int size, degree;
    ki_tilt tilt; // the turn that texel directions take before they meet the spectrum
    ki_rings rings;
    size_t scratch_size; // number of doubles of scratch memory that each thread needs

    // The fields up to ring_start are for small levels, whose texels are evaluated directly.
    place *places; // texels, sorted by the latitude ring on which they lie
    int place_count;
    // Index in `places` of the first texel on each latitude ring, a lane of `rings`; [lanes + 1],
    // the last one being the number of texels.
    int *ring_start;

    // The fields up to `positions` are for larger levels, whose texels are interpolated on a grid.
    ki_fft fft;
    float *ring_taps, *column_taps;
    // Number of floats in a row of the grid and in a colour channel of it. The grid is
    // [channel][PAD + rings + PAD][pitch].
    size_t pitch, plane;
    // Positions of texels on the grid as {index of the latitude ring, column}, both with fractions:
    // of the texels of the faces +X and +Y of a cube without tilt, or of all texels of other maps.
    double *positions;
};

// The data of one call of ki_level_execute, which all its tasks share.
typedef struct run {
    const ki_level *level;
    const kiln_spectrum *spectrum;
    const kiln_map *panorama;
    double rotation;
    ki_points points;
    kiln_map *map; // map whose level `index` is written
    int index;
    // Products of the coefficients of the spectrum and of the lobe, in rows as ki_coefficient_row
    // says.
    double *coefficients;
    float *grid;
    double *scratch; // scratch memory of all threads
} run;

static bool design_taps(kiln_context *context, ki_level *level)
{
    double *density = ki_alloc_raw(context, (size_t)level->degree + 1, sizeof *density);
    double *taps = ki_alloc_raw(context, KI_TAP_TABLE, sizeof *taps);
    // KI_TAPS zeros follow a table of interpolation weights: a fraction that rounds up to 1 reads
    // the entry after the table's last, and gives it the weight 0.
    size_t count = KI_TAP_TABLE + KI_TAPS;
    level->ring_taps = ki_alloc(context, count, sizeof(float));
    level->column_taps = ki_alloc(context, count, sizeof(float));
    bool good = density && taps && level->ring_taps && level->column_taps;
    for (int axis = 0; good && axis < 2; axis++) {
        double step = axis ? 2 * KI_PI / level->fft.length : KI_PI / (2 * level->rings.pair_count);
        float *out = axis ? level->column_taps : level->ring_taps;
        for (int l = 0; l <= level->degree; l++)
            density[l] = level->lobe.k[l] * level->lobe.k[l] / (l + 1);
        ki_taps_design(step, density, level->degree, taps);
        for (int i = 0; i < KI_TAP_TABLE; i++)
            out[i] = (float)taps[i];
    }
    ki_free(density);
    ki_free(taps);
    return good;
}

// Task of one thread: finds the positions of a row of texels on the grid. For a cube the first
// `size` rows are those of the face +X, the next `size` rows those of +Y; find_positions derives
// the positions on other faces from these by a quarter turn or a reflection.
static void place_row(void *data, int row)
{
    ki_level *level = data;
    int width, height;
    kiln_map map = {.shape = level->shape, .size = level->size, .level_count = 1};
    ki_level_extent(&map, 0, &width, &height);
    size_t face = (size_t)width * (size_t)width, first = (size_t)row * (size_t)width;
    bool top = level->shape == KILN_SHAPE_CUBE && row >= width && !level->tilt.any;
    for (size_t i = first; i < first + (size_t)width; i++) {
        double direction[3], u, v;
        kiln_map_direction(&map, 0, top ? i + face : i, direction);
        ki_tilt_apply(&level->tilt, direction);
        ki_direction_panorama(direction, &u, &v);
        level->positions[2 * i] = v * 2 * level->rings.pair_count - 0.5 + (PAD - TAP_OFFSET);
        level->positions[2 * i + 1] = u * level->fft.length;
    }
}

// Greatest number of texels of a level that is evaluated directly at its texels.
enum { SMALL = 6 * 16 * 16 };

static int by_theta(const void *a, const void *b)
{
    const place *x = a, *y = b;
    if (x->theta != y->theta)
        return x->theta < y->theta ? -1 : 1;
    return x->texel - y->texel;
}

// Prepares a small level: sorts the texels by latitude. Texels whose theta differ by at most 1e-12
// lie on one latitude ring by symmetry, and differ only by rounding.
static bool plan_places(kiln_context *context, ki_level *v, const kiln_map *map)
{
    int count = v->place_count = (int)kiln_map_texels(map, 0), ring = -1;
    v->places = ki_alloc(context, (size_t)count, sizeof *v->places);
    double *theta = ki_alloc(context, (size_t)count, sizeof *theta);
    bool good = v->places && theta;
    for (int i = 0; good && i < count; i++) {
        double d[3], sine;
        place *p = &v->places[i];
        kiln_map_direction(map, 0, (size_t)i, d);
        ki_tilt_apply(&v->tilt, d);
        sine = sqrt(d[0] * d[0] + d[2] * d[2]);
        p->theta = ki_atan2(sine, fabs(d[1]));
        p->sign = d[1] < 0 ? -1 : 1;
        // Sets the cosine and sine of the azimuth phi, which ki_panorama_direction defines.
        p->cosine = sine > 0 ? d[2] / sine : 1;
        p->sine = sine > 0 ? -d[0] / sine : 0;
        p->texel = i;
    }
    if (good)
        qsort(v->places, (size_t)count, sizeof *v->places, by_theta);
    for (int i = 0; good && i < count; i++) {
        if (ring < 0 || v->places[i].theta > theta[ring] + 1e-12)
            theta[++ring] = v->places[i].theta;
        v->places[i].ring = ring;
    }
    good = good && ki_rings_create(context, theta, ring + 1, v->degree, &v->rings);
    if (good) {
        int lanes = KI_LANES * v->rings.vector_count;
        v->ring_start = ki_alloc(context, (size_t)lanes + 1, sizeof *v->ring_start);
        good = v->ring_start != NULL;
        for (int i = 0, k = 0; good && k <= lanes; k++) {
            while (i < count && v->places[i].ring < k)
                i++;
            v->ring_start[k] = i;
        }
    }
    ki_free(theta);
    return good;
}

// Prepares a level that is interpolated on a grid. `map` has the shape and size of the level.
static bool plan_grid(kiln_context *context, ki_level *v, const kiln_map *map)
{
    bool alike = v->shape == KILN_SHAPE_CUBE && !v->tilt.any; // faces have each other's positions
    size_t texels = kiln_map_texels(map, 0) / (alike ? 3 : 1);
    if (!ki_rings_create_grid(context, v->degree, KI_FEW_RINGS, &v->rings) ||
        !ki_fft_create(context, ki_fft_good_length(4 * v->rings.pair_count), &v->fft))
        return false;
    int width = v->fft.length + 2 * PAD, rows = 2 * v->rings.pair_count + 2 * PAD;
    v->pitch = ((size_t)width + 15) / 16 * 16;
    v->plane = v->pitch * (size_t)rows;
    v->scratch_size += (size_t)v->fft.length * 16 * 2;
    v->positions = ki_alloc_raw(context, texels, 2 * sizeof(double));
    if (!v->positions || !design_taps(context, v))
        return false;
    int row, height;
    ki_level_extent(map, 0, &row, &height);
    ki_parallel_for(context, (int)(texels / (size_t)row), place_row, v);
    return true;
}

kiln_result ki_level_create(kiln_context *context, const ki_legendre *legendre,
                            const ki_zonal *zonal, ki_zonal_spectrum *spectrum, kiln_shape shape,
                            int size, const ki_tilt *tilt, ki_level **level, kiln_error *error)
{
    ki_level *v = *level = ki_alloc(context, 1, sizeof *v);
    if (!v) {
        ki_zonal_free(spectrum);
        return ki_fail_memory(context, error, "a level's plan", sizeof *v);
    }
    *v = (ki_level){.kernels = ki_sphere_kernels(context),
                    .legendre = legendre,
                    .zonal = *zonal,
                    .lobe = *spectrum,
                    .shape = shape,
                    .size = size,
                    .degree = ki_min(ki_max(spectrum->degree, 8), legendre->degree)};
    *spectrum = (ki_zonal_spectrum){0};
    if (tilt)
        v->tilt = *tilt;
    kiln_map map = {.shape = shape, .size = size, .level_count = 1};
    bool small = kiln_map_texels(&map, 0) <= SMALL;
    v->scratch_size = (size_t)(v->degree + 1) * 2 * 96;
    if (small ? plan_places(context, v, &map) : plan_grid(context, v, &map))
        return KILN_OK;
    ki_level_destroy(v);
    *level = NULL;
    return ki_fail_memory(context, error, "a level's plan",
                          kiln_map_texels(&map, 0) * 2 * sizeof(double));
}

void ki_level_destroy(ki_level *level)
{
    if (!level)
        return;
    ki_zonal_free(&level->lobe);
    ki_rings_destroy(&level->rings);
    ki_fft_destroy(&level->fft);
    ki_free(level->ring_taps);
    ki_free(level->column_taps);
    ki_free(level->positions);
    ki_free(level->places);
    ki_free(level->ring_start);
    ki_free(level);
}

kiln_result ki_level_reserve(kiln_context *context, const ki_level *level,
                             ki_level_workspace *workspace, kiln_error *error)
{
    size_t count = ki_coefficient_count(level->degree), grid = level->places ? 0 : 3 * level->plane;
    size_t scratch = (size_t)ki_context_threads(context) * level->scratch_size;
    workspace->context = context;
    if (ki_buffer_reserve(context, &workspace->coefficients, count, sizeof(double)) &&
        ki_buffer_reserve(context, &workspace->grid, grid, sizeof(float)) &&
        ki_buffer_reserve(context, &workspace->scratch, scratch, sizeof(double)))
        return KILN_OK;
    return ki_fail_memory(context, error, "a level's buffers",
                          (count + scratch) * sizeof(double) + grid * sizeof(float));
}

void ki_level_workspace_free(ki_level_workspace *workspace)
{
    ki_buffer_free(&workspace->coefficients);
    ki_buffer_free(&workspace->grid);
    ki_buffer_free(&workspace->scratch);
    *workspace = (ki_level_workspace){0};
}

// Task of one thread: multiplies the coefficients a_lm of one order m of the spectrum by the lobe's
// coefficients k_l, applies the rotation, and multiplies by the factors `scale` of the Legendre
// recurrence (legendre.h).
static void weigh_order(void *data, int m)
{
    const run *r = data;
    const ki_level *v = r->level;
    const double *from = r->spectrum->a + ki_coefficient_row(r->spectrum->degree, m);
    const double *scale = v->legendre->scale + ki_legendre_row(v->legendre, m);
    double *to = r->coefficients + ki_coefficient_row(v->degree, m), sine, cosine;
    bool turns = r->rotation != 0;
    ki_sincos(turns ? m * r->rotation * KI_PI / 180 : 0, &sine, &cosine);
    for (int i = 0; i <= v->degree - m; i++, from += KI_COMPONENTS, to += KI_COMPONENTS) {
        double weight = v->lobe.k[m + i] * scale[i];
        for (int c = 0; c < KI_COMPONENTS && !turns; c++)
            to[c] = from[c] * weight;
        for (int c = 0; c < KI_COMPONENTS && turns; c += 2) {
            double re = from[c] * weight, im = from[c + 1] * weight;
            to[c] = re * cosine - im * sine;
            to[c + 1] = re * sine + im * cosine;
        }
    }
    // The kernel `synthesize` reads an even number of degrees, so the entry of padding that follows
    // an odd number must be 0.
    int count = v->degree - m + 1;
    if (count % 2)
        memset(to, 0, KI_COMPONENTS * sizeof *to);
    ki_legendre_join_odd(v->degree, m, r->coefficients + ki_coefficient_row(v->degree, m));
}

// Sums the spherical harmonics over the degrees l, for all orders m, on the two vectors of latitude
// rings 2 * index and 2 * index + 1. Returns the Fourier coefficients of the rings,
// [m][vector][12][lane]: six components of the part even about the equator, then six of the odd
// part.
static const double *synthesize_orders(const run *r, int worker, int index)
{
    const ki_level *v = r->level;
    double *orders = r->scratch + (size_t)worker * v->scratch_size;
    int vectors = v->rings.vector_count;
    for (int m = 0; m <= v->degree; m++) {
        size_t row = ki_legendre_row(v->legendre, m);
        double *out = orders + 192 * (size_t)m;
        if (2 * index + 1 < v->rings.first[m]) {
            memset(out, 0, 192 * sizeof *out);
            continue;
        }
        v->kernels->synthesize(
            v->legendre->steps + row, v->degree - m + 1, v->rings.twice_cos + 16 * (size_t)index,
            v->rings.start + 8 * ((size_t)m * (size_t)vectors + 2 * (size_t)index),
            r->coefficients + ki_coefficient_row(v->degree, m),
            v->rings.skip[(size_t)m * (size_t)vectors + 2 * (size_t)index + 1], out, out + 96);
    }
    return orders;
}

enum { COLUMNS = 32 }; // number of columns that are stored in the grid at once

// Stores columns of the rings of a vector in the rows of one channel of the grid. The Fourier
// transform `z` has the values of eight southern and eight northern rings side by side. Few columns
// at a time keep the rows in the first cache. Blocks of four columns and four rings are transposed
// in registers. `from` and `to` are multiples of four.
static void store_columns(const ki_level *v, int vector, const double *z, int from, int to,
                          float *plane)
{
    for (int j = 0; j < 2 * KI_LANES; j += 4) {
        float *row[4];
        for (int i = 0; i < 4; i++) {
            int k = KI_LANES * vector + (j + i) % KI_LANES;
            int south = PAD + 2 * v->rings.pair_count - 1 - k;
            row[i] = plane + (size_t)(j < KI_LANES ? south : PAD + k) * v->pitch;
        }
        for (int x = from; x < to; x += 4) {
            ki_float4 block[4];
            for (int i = 0; i < 4; i++) {
                const double *p = z + 2 * KI_LANES * (x + i) + j;
                block[i] = (ki_float4){(float)p[0], (float)p[1], (float)p[2], (float)p[3]};
            }
            ki_transpose4(block);
            for (int i = 0; i < 4; i++)
                memcpy(row[i] + x, &block[i], sizeof block[i]);
        }
    }
}

// Task of one thread: Fourier-synthesises the latitude rings of two vectors and stores them in the
// grid.
static void fill_grid(void *data, int worker, int index)
{
    const run *r = data;
    const ki_level *v = r->level;
    const double *orders = synthesize_orders(r, worker, index);
    double *buffer = r->scratch + (size_t)worker * v->scratch_size + 192 * (size_t)(v->degree + 1);
    int length = v->fft.length;
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++) {
            int vector = 2 * index + half;
            v->kernels->join_orders(orders + 96 * (size_t)half + 16 * (size_t)c, 192, v->degree,
                                    v->rings.first, vector, length, buffer);
            const double *z = v->kernels->fft(&v->fft, buffer, buffer + 16 * (size_t)length);
            float *plane = r->grid + (size_t)c * v->plane + TAP_OFFSET;
            for (int from = 0; from < length; from += COLUMNS)
                store_columns(v, vector, z, from, ki_min(from + COLUMNS, length), plane);
        }
}

// Task of one thread: evaluates the texels that lie on the latitude rings of two vectors.
static void fill_places(void *data, int worker, int index)
{
    const run *r = data;
    const ki_level *v = r->level;
    const double *orders = synthesize_orders(r, worker, index);
    for (int half = 0; half < 2; half++) {
        size_t vector = 2 * (size_t)index + (size_t)half;
        const int *start = v->ring_start + KI_LANES * vector;
        const double *here = orders + 96 * (size_t)half;
        int most = 0;
        for (int j = 0; j < KI_LANES; j++)
            most = ki_max(most, start[j + 1] - start[j]);
        for (int n = 0; n < most; n++) {
            double cosine[KI_LANES], sine[KI_LANES], sign[KI_LANES], rgb[3 * KI_LANES];
            for (int j = 0; j < KI_LANES; j++) {
                // Eight latitude rings are evaluated at once, at one texel each. A ring with fewer
                // texels than the others evaluates some texel again, whose value is not used.
                const place *p = &v->places[start[j] + n < start[j + 1] ? start[j] + n : 0];
                cosine[j] = p->cosine;
                sine[j] = p->sine;
                sign[j] = p->sign;
            }
            v->kernels->sum_orders(here, 192, v->degree + 1, cosine, sine, sign, rgb);
            for (int j = 0; j < KI_LANES; j++)
                for (int c = 0; start[j] + n < start[j + 1] && c < 3; c++)
                    r->map->level[r->index][3 * v->places[start[j] + n].texel + c] =
                        (float)rgb[KI_LANES * c + j];
        }
    }
}

// Fills the padding of the grid: rows beyond the poles, where the grid continues half a turn away,
// and columns around the ends of each row, where the longitude wraps.
static void pad_grid(const run *r)
{
    const ki_level *v = r->level;
    int length = v->fft.length, rings = 2 * v->rings.pair_count;
    for (int c = 0; c < 3; c++) {
        float *plane = r->grid + (size_t)c * v->plane + TAP_OFFSET;
        for (int k = 0; k < PAD; k++) {
            size_t half = (size_t)length / 2 * sizeof *plane;
            float *ends[2] = {plane + (size_t)(PAD - 1 - k) * v->pitch,
                              plane + (size_t)(PAD + rings + k) * v->pitch};
            const float *mirrored[2] = {plane + (size_t)(PAD + k) * v->pitch,
                                        plane + (size_t)(PAD + rings - 1 - k) * v->pitch};
            for (int e = 0; e < 2; e++) {
                memcpy(ends[e], mirrored[e] + length / 2, half);
                memcpy(ends[e] + length / 2, mirrored[e], half);
            }
        }
        for (int k = 0; k < rings + 2 * PAD; k++) {
            float *row = plane + (size_t)k * v->pitch;
            for (int x = 1; x <= TAP_OFFSET; x++)
                row[-x] = row[length - x];
            for (int x = 0; x <= KI_TAPS - TAP_OFFSET; x++)
                row[length + x] = row[x];
        }
    }
}

enum { CHUNK = 32 }; // number of texels that are interpolated at once, a multiple of KI_LANES

// Finds the grid positions of the texels first .. first + count - 1, which lie in one row of one
// face.
static void find_positions(const ki_level *v, size_t first, int count, double *positions)
{
    size_t n = (size_t)v->size, face = first / (n * n), at = first % (n * n);
    int length = v->fft.length;
    if (v->shape != KILN_SHAPE_CUBE || v->tilt.any) {
        memcpy(positions, v->positions + 2 * first, 2 * (size_t)count * sizeof *positions);
        return;
    }
    // Number of quarter turns about the vertical axis for each of the faces +X -X +Y -Y +Z -Z:
    // every side face is +X turned, and -Y is +Y turned upside down.
    static const int quarters[6] = {0, 2, 0, 0, 1, 3};
    bool side = face < 2 || face > 3, bottom = face == 3;
    size_t y = at / n, x = at % n, from = (bottom ? n - 1 - y : y) * n + x + (side ? 0 : n * n);
    double turn = quarters[face] * 0.25 * length;
    for (size_t i = 0; i < (size_t)count; i++) {
        double ring = v->positions[2 * (from + i)];
        double column = v->positions[2 * (from + i) + 1] + turn;
        positions[2 * i] =
            bottom ? 2 * v->rings.pair_count - 1 + 2 * (PAD - TAP_OFFSET) - ring : ring;
        positions[2 * i + 1] = column >= length ? column - length : column;
    }
}

// Finds the direction of a texel as kiln_map_direction does, but faster for cubes.
static void texel_direction(const run *r, size_t texel, double d[3])
{
    const ki_level *v = r->level;
    if (v->shape != KILN_SHAPE_CUBE) {
        kiln_map_direction(r->map, r->index, texel, d);
        return;
    }
    size_t n = (size_t)v->size, row = texel / n;
    ki_face_direction((int)(row / n), (2.0 * (double)(texel % n) + 1) / v->size - 1,
                      (2.0 * (double)(row % n) + 1) / v->size - 1, d);
    double scale = 1 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        d[k] *= scale;
}

// Finds the direction in which the untilted environment has what a texel shows.
static void find_direction(const run *r, size_t texel, double d[3])
{
    texel_direction(r, texel, d);
    ki_tilt_apply(&r->level->tilt, d);
}

// Adds the light of the suns through the lobe to the texels first .. first + count - 1.
static void add_suns(const run *r, size_t first, int count, float *rgb)
{
    for (int i = 0; i < count; i += KI_LANES) {
        double directions[3 * KI_LANES], sum[3 * KI_LANES] = {0};
        for (int j = 0; j < KI_LANES; j++) {
            double d[3];
            find_direction(r, first + (size_t)(i + j < count ? i + j : count - 1), d);
            for (int k = 0; k < 3; k++)
                directions[KI_LANES * k + j] = d[k];
        }
        ki_points_add(&r->points, directions, sum);
        for (int j = 0; j < KI_LANES && i + j < count; j++)
            for (int c = 0; c < 3; c++)
                rgb[3 * (i + j) + c] += (float)sum[KI_LANES * c + j];
    }
}

// Adds to the texels first .. first + count - 1 the light near the lobe's axis, which the spectrum
// of a very narrow lobe leaves out.
static void add_surroundings(const run *r, size_t first, int count, float *rgb)
{
    const ki_level *v = r->level;
    for (int i = 0; i < count; i++) {
        double direction[3], turned[3], sum[3] = {0};
        kiln_map_direction(r->map, r->index, first + (size_t)i, direction);
        ki_tilt_apply(&v->tilt, direction);
        ki_turn(direction, r->rotation, turned);
        ki_surroundings_add(r->panorama, &v->zonal, v->lobe.integral, turned, sum);
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] += (float)sum[c];
    }
}

// Task of one thread: computes a row of texels from the grid, unless the level is small and the row
// is already there. Then adds the suns, and for a very narrow lobe the light near the lobe's axis.
static void fill_row(void *data, int index)
{
    const run *r = data;
    const ki_level *v = r->level;
    int width, height;
    ki_level_extent(r->map, r->index, &width, &height);
    for (int x = 0; x < width; x += CHUNK) {
        int count = width - x < CHUNK ? width - x : CHUNK;
        size_t first = (size_t)index * (size_t)width + (size_t)x;
        float rgb[3 * CHUNK] = {0}, *out = r->map->level[r->index] + 3 * first;
        if (v->places) {
            memcpy(rgb, out, 3 * (size_t)count * sizeof *rgb);
        } else {
            double positions[2 * CHUNK];
            find_positions(v, first, count, positions);
            v->kernels->interpolate(r->grid, v->plane, v->pitch, v->ring_taps, v->column_taps,
                                    positions, count, rgb);
        }
        if (r->points.suns.count)
            add_suns(r, first, count, rgb);
        if (v->zonal.outer > 0)
            add_surroundings(r, first, count, rgb);
        memcpy(out, rgb, 3 * (size_t)count * sizeof *rgb);
    }
}

kiln_result ki_level_execute(const ki_level *level, const ki_level_workspace *workspace,
                             const kiln_spectrum *spectrum, const kiln_map *panorama,
                             double rotation, kiln_map *map, int index,
                             const ki_progress_range *range, kiln_error *error)
{
    kiln_context *context = workspace->context;
    run r = {.level = level,
             .spectrum = spectrum,
             .panorama = panorama,
             .rotation = rotation,
             .map = map,
             .index = index,
             .coefficients = workspace->coefficients.memory,
             .grid = workspace->grid.memory,
             .scratch = workspace->scratch.memory};
    kiln_result result =
        ki_points_create(spectrum, &level->zonal, level->lobe.integral, rotation, &r.points, error);
    if (result != KILN_OK)
        return result;
    int width, height;
    ki_level_extent(map, index, &width, &height);
    ki_parallel_for(context, level->degree + 1, weigh_order, &r);
    bool go_on = ki_parallel_workers(context, level->rings.vector_count / 2,
                                     level->places ? fill_places : fill_grid, &r);
    if (go_on && !level->places)
        pad_grid(&r);
    if (!go_on || !ki_parallel_steps(context, range, height, fill_row, &r))
        result = ki_fail_cancelled(error, range ? range->name : "filtering");
    ki_points_destroy(&r.points);
    return result;
}

bool ki_level_needs_panorama(const ki_level *level)
{
    return level->zonal.outer > 0;
}

size_t ki_level_suns_size(const ki_level *level, int source_size, size_t count)
{
    return ki_points_size(&level->zonal, source_size, count);
}
