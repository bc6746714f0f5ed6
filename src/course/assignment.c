// Estimates the tables E(mu) and E_avg of the fourth assignment of the course GAMES202 by its
// methods: Monte Carlo with cosine-distributed light, GGX importance sampling, and the split sum at
// F0 = 1. E is the albedo of a GGX lobe with F = 1, and E_avg its average under diffuse light. In:
// the method, the masking G, sizes and sample counts. Out: a square table of E, its row averages,
// and a comparison with exact tables. mu = n.v and roughness are at texel centres,
// (i + 0.5) / size. The view is (sqrt(1 - mu^2), 0, mu), the normal +z. docs/theory/assignment.md
// derives the methods and lists their errors.
#include "base/base.h"
#include "brdf/brdf.h"
#include "math/math.h"

#include <kiln/course.h>
#include <math.h>

// Lower bound that the supplied code of the fourth GAMES202 assignment puts on the denominator of
// GGX's D.
static const double least_denominator = 1e-4;

typedef struct assignment {
    kiln_assignment_method method;
    const kiln_assignment_def *def;
    kiln_model model;
    kiln_image *table;
    // number of strata along each side of the unit square of random numbers, for Monte Carlo
    int side;
    // cosine of the azimuth of each sample's half vector, for importance sampling
    double *cos_phi;
} assignment;

// ------------------------------------------------------------------------------------- Monte Carlo

// Random number `index` of a sequence, in [0, 1), by SplitMix64 (Steele, Lea and Flood 2014). Its
// state is a counter, so that a number is computed without the numbers before it.
static double random_number(uint64_t seed, uint64_t index)
{
    uint64_t z = seed + (index + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * (1.0 / 9007199254740992.0);
}

// pi D(h) of GGX, where h is the half vector of l and the view (v[0], 0, v[1]). Unless `unclamped`
// is set, the denominator of D is at least least_denominator.
static double lobe(double alpha, const double v[2], const double l[3], bool unclamped)
{
    double a2 = alpha * alpha, x = l[0] + v[0], z = l[2] + v[1];
    double flat = x * x + l[1] * l[1], length = flat + z * z;
    // q = (n.h)^2 (alpha^2 - 1) + 1 as a sum of squares, because the difference cancels near n.h =
    // 1.
    double q = (a2 * z * z + flat) / length, denominator = KI_PI * q * q;
    if (!unclamped && denominator < least_denominator)
        denominator = least_denominator;
    return KI_PI * a2 / denominator;
}

// Estimates the albedo E with light directions l of density (n.l) / pi, by the mean over the
// samples of (D G / (4 (n.v) (n.l))) (n.l) / ((n.l) / pi) = pi D G / (4 (n.v) (n.l)). The index of
// the texel selects its part of the random sequence.
static double monte_carlo(const assignment *r, double roughness, double mu, uint64_t texel)
{
    double v[2] = {sqrt((1 - mu) * (1 + mu)), mu}, sum = 0;
    uint64_t samples = (uint64_t)r->side * (uint64_t)r->side, at = 2 * samples * texel;
    for (int t = 0; t < r->side; t++)
        for (int p = 0; p < r->side; p++, at += 2) {
            // sin^2 theta and phi / (2 pi) are each random within a stratum of width 1 / side.
            double xi[2] = {(p + random_number(r->def->seed, at + 1)) / r->side,
                            (t + random_number(r->def->seed, at)) / r->side};
            double l[3];
            ki_sample_cosine(xi, l);
            sum += lobe(roughness * roughness, v, l, r->def->unclamped) *
                   ki_visibility(&r->model, roughness, mu, l[2]);
        }
    return sum / (4 * (double)samples);
}

// ----------------------------------------------------------------------------- importance sampling

// Estimates the albedo E with half vectors h of density D(h) (n.h) and light l = 2 (v.h) h - v, by
// the mean over the samples of
//
//     (v.h) G / ((n.v) (n.h)),        0 for l below the horizon.
//
// For the split sum, ab[0] is the mean of that weight times 1 - F5 and ab[1] the mean of the weight
// times F5, where F5 = (1 - v.h)^5. For E alone, ab[0] is E and ab[1] is 0. The N samples are
// Hammersley's points (i / N, radical inverse of i): the first coordinate xi gives the angle theta
// of h to n, tan^2 theta = alpha^2 xi / (1 - xi), and the second the azimuth. Section 2.2.2 of the
// assignment; Walter et al. 2007, eqs. 35, 36, 38 and 41.
static void importance(const assignment *r, double roughness, double mu, double ab[2])
{
    int count = r->def->sample_count;
    double alpha = roughness * roughness, vx = sqrt((1 - mu) * (1 + mu));
    ab[0] = ab[1] = 0;
    for (int i = 0; i < count; i++) {
        double xi = (double)i / count, d = (1 - xi) + alpha * alpha * xi;
        double noh = sqrt((1 - xi) / d), hx = alpha * sqrt(xi / d) * r->cos_phi[i];
        double voh = vx * hx + mu * noh, nol = 2 * voh * noh - mu;
        if (!(nol > 0))
            continue;
        voh = voh < 1 ? voh : 1;
        nol = nol < 1 ? nol : 1;
        double weight = voh * nol * ki_visibility(&r->model, roughness, mu, nol) / noh;
        double f5 = r->method == KILN_ASSIGNMENT_SPLIT_SUM ? ki_schlick_fresnel(voh) : 0;
        ab[0] += (1 - f5) * weight;
        ab[1] += f5 * weight;
    }
    ab[0] /= count;
    ab[1] /= count;
}

// ------------------------------------------------------------------------------------------ tables

static void fill_row(void *data, int index)
{
    const assignment *r = data;
    int size = r->def->size, row = r->def->unflipped ? index : size - 1 - index;
    double roughness = (index + 0.5) / size;
    float *texel = r->table->pixels + (size_t)row * (size_t)size;
    for (int x = 0; x < size; x++) {
        double mu = (x + 0.5) / size, ab[2] = {0};
        if (r->method == KILN_ASSIGNMENT_MONTE_CARLO)
            ab[0] = monte_carlo(r, roughness, mu, (uint64_t)index * (uint64_t)size + (uint64_t)x);
        else
            importance(r, roughness, mu, ab);
        texel[x] = (float)(ab[0] + ab[1]); // the albedo E = A + B of the split sum at F0 = 1
    }
}

// Fills an allocated image of size x size with estimates of the albedo E. The fields of `def` are
// already complete: 0 no longer stands for a default value.
static kiln_result fill_energy(kiln_context *context, kiln_assignment_method method,
                               const kiln_assignment_def *def, kiln_image *table, kiln_error *error)
{
    static const char *const names[] = {"Monte Carlo", "importance sampling", "split sum"};
    assignment r = {.method = method,
                    .def = def,
                    .model = {.g = kiln_assignment_masking(def->g)},
                    .table = table};
    size_t count = (size_t)def->sample_count;
    while ((r.side + 1) * (r.side + 1) <= def->sample_count)
        r.side++;
    r.cos_phi = ki_alloc_raw(context, count, sizeof *r.cos_phi);
    if (!r.cos_phi)
        return ki_fail_memory(context, error, "the assignment's samples",
                              count * sizeof *r.cos_phi);
    for (size_t i = 0; i < count; i++)
        r.cos_phi[i] = ki_cos(2 * KI_PI * ki_radical_inverse((uint32_t)i));
    ki_progress_range range = {names[method], 0, 1};
    bool whole = ki_parallel_steps(context, &range, def->size, fill_row, &r);
    ki_free(r.cos_phi);
    return whole ? KILN_OK : ki_fail_cancelled(error, names[method]);
}

// Fills each row of `average` with the average albedo at the row's roughness, 2 int E mu dmu: 2 /
// width times the sum of E mu over the row of `energy`.
static void fill_average(const kiln_image *energy, kiln_image *average)
{
    size_t width = (size_t)energy->width;
    for (size_t y = 0; y < (size_t)energy->height; y++) {
        const float *e = energy->pixels + y * width;
        double sum = 0;
        for (size_t x = 0; x < width; x++)
            sum += (double)e[x] * (((double)x + 0.5) / (double)width);
        for (size_t x = 0; x < width; x++)
            average->pixels[y * width + x] = (float)(2 * sum / (double)width);
    }
}

// --------------------------------------------------------------------------------------- comparing

// Colours of the map of a table's errors, sRGB 0 to 255, one for each power of ten of an error's
// size from 1e-4 to 1. The colours darken by visually equal steps. ramp[0], blue, is for values
// that are too low, and ramp[1], red, for values that are too high.
enum { STOPS = 5 };
static const double ramp[2][STOPS][3] = {
    {{247, 246, 243}, {150, 200, 230}, {70, 145, 200}, {30, 90, 160}, {12, 40, 90}},
    {{247, 246, 243}, {250, 180, 120}, {225, 110, 65}, {165, 50, 40}, {90, 5, 25}}};

static void error_color(double off, float color[3])
{
    double size = fabs(off), at = 0;
    if (size > 1e-4)
        at = ki_clamp(STOPS - 1 + ki_log(size) / ki_log(10), 0, STOPS - 1);
    int i = ki_min((int)at, STOPS - 2);
    const double *low = ramp[off > 0][i], *high = ramp[off > 0][i + 1];
    for (int c = 0; c < 3; c++)
        color[c] = (float)((low[c] + (high[c] - low[c]) * (at - i)) / 255);
}

// Computes the largest, root mean square and mean difference `table` - `exact`. `map`, which may be
// NULL, receives a colour for each difference.
static kiln_difference compare_tables(const kiln_image *table, const kiln_image *exact,
                                      kiln_image *map)
{
    kiln_difference figures = {0};
    size_t count = (size_t)table->width * (size_t)table->height;
    for (size_t i = 0; i < count; i++) {
        double off = (double)table->pixels[i] - (double)exact->pixels[i];
        figures.max = fabs(off) > figures.max ? fabs(off) : figures.max;
        figures.rms += off * off;
        figures.mean += off;
        if (map)
            error_color(off, map->pixels + 3 * i);
    }
    figures.rms = sqrt(figures.rms / (double)count);
    figures.mean /= (double)count;
    return figures;
}

enum { MAX_SAMPLES = 1 << 20, MAX_SIZE = 1024 };

static kiln_result complete(kiln_assignment_method method, const kiln_assignment_def *given,
                            kiln_assignment_def *def, kiln_error *error)
{
    *def = given ? *given : (kiln_assignment_def){0};
    def->size = def->size ? def->size : 128;
    def->sample_count = def->sample_count ? def->sample_count : 1024;
    if ((unsigned)method > KILN_ASSIGNMENT_SPLIT_SUM)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the method is %d, it must be 0 to %d",
                       (int)method, KILN_ASSIGNMENT_SPLIT_SUM);
    if (def->size < 2 || def->size > MAX_SIZE)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "size of the table is %d, it must be 2 to %d, or 0", def->size, MAX_SIZE);
    if (def->sample_count < 1 || def->sample_count > MAX_SAMPLES)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "sample_count is %d, it must be 1 to %d, or 0",
                       def->sample_count, MAX_SAMPLES);
    if ((unsigned)def->g > KILN_ASSIGNMENT_G_UNCORRELATED)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "g is %d, it must be 0 to %d", (int)def->g,
                       KILN_ASSIGNMENT_G_UNCORRELATED);
    return KILN_OK;
}

kiln_g kiln_assignment_masking(kiln_assignment_g g)
{
    static const kiln_g masking[] = {KILN_G_SCHLICK_K2, KILN_G_SCHLICK_TEXT, KILN_G_SMITH,
                                     KILN_G_SMITH_UNCORRELATED};
    return masking[(unsigned)g <= KILN_ASSIGNMENT_G_UNCORRELATED ? g : 0];
}

kiln_result kiln_assignment_energy(kiln_context *context, kiln_assignment_method method,
                                   const kiln_assignment_def *def, kiln_image *table,
                                   kiln_error *error)
{
    kiln_assignment_def d;
    *table = (kiln_image){0};
    kiln_result result = complete(method, def, &d, error);
    if (!result)
        result = kiln_image_create(context, d.size, d.size, 1, table, error);
    if (!result)
        result = fill_energy(context, method, &d, table, error);
    if (result)
        kiln_image_free(table);
    return result;
}

static kiln_result check_table(const char *name, const kiln_image *table, kiln_error *error)
{
    if (!table->pixels || table->channels != 1 || table->width < 1 || table->height < 1)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s is %d x %d with %d channels%s, it must have texels with one channel",
                       name, table->width, table->height, table->channels,
                       table->pixels ? "" : " and no pixels");
    return KILN_OK;
}

kiln_result kiln_assignment_average(kiln_context *context, const kiln_image *energy,
                                    kiln_image *average, kiln_error *error)
{
    *average = (kiln_image){0};
    kiln_result result = check_table("the table of E", energy, error);
    if (!result)
        result = kiln_image_create(context, energy->width, energy->height, 1, average, error);
    if (!result)
        fill_average(energy, average);
    return result;
}

kiln_result kiln_assignment_compare(kiln_context *context, const kiln_image *table,
                                    const kiln_image *exact, kiln_difference *difference,
                                    kiln_image *map, kiln_error *error)
{
    *difference = (kiln_difference){0};
    if (map)
        *map = (kiln_image){0};
    kiln_result result = check_table("the table", table, error);
    if (!result)
        result = check_table("the exact table", exact, error);
    if (!result && (table->width != exact->width || table->height != exact->height))
        result = ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "the table is %d x %d and the exact table is %d x %d, they must have the same size",
            table->width, table->height, exact->width, exact->height);
    if (!result && map)
        result = kiln_image_create(context, table->width, table->height, 3, map, error);
    if (!result)
        *difference = compare_tables(table, exact, map);
    return result;
}

void kiln_assignment_truncate(kiln_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) {
        double x = (double)image->pixels[i];
        x = x > 0 ? x < 1 ? x : 1 : 0;
        image->pixels[i] = (float)(floor(x * 255) / 255);
    }
}
