// The errors of a level. In: a level and the exact level. Out: root mean square, largest and mean
// error, energy, jumps at the edges of faces, and counts of texels that are far too bright or
// negative. All means are over the sphere: a texel counts by its solid angle.
#include "check/check.h"

#include "image/texel.h"

#include <math.h>

ki_pair ki_pair_make(const kiln_map *is, const kiln_map *exact, int level)
{
    ki_pair pair = {.is = ki_single_level(is, level), .exact = ki_single_level(exact, level)};
    double sum = 0, squares = 0, weight = 0;
    for (size_t i = 0; i < kiln_map_texels(&pair.exact, 0); i++) {
        double w = ki_weight_of(&pair.exact, i);
        for (size_t c = 0; c < 3; c++) {
            double e = (double)pair.exact.level[0][3 * i + c];
            sum += w * e;
            squares += w * e * e;
            weight += w;
        }
    }
    pair.mean = sum / weight;
    pair.norm = sqrt(squares / weight);
    return pair;
}

// Returns the brightest value of any channel of an exact texel and of the texels that touch it.
static double brightest_near(const kiln_map *exact, size_t index)
{
    size_t near[5] = {0, 0, 0, 0, index};
    float most = 0;
    ki_texel_neighbors(exact, index, near);
    for (int k = 0; k < 5; k++)
        for (size_t c = 0; c < 3; c++) {
            float value = exact->level[0][3 * near[k] + c];
            most = value > most ? value : most;
        }
    return (double)most;
}

// Counts the texels that are below zero or far too bright.
static void count_texels(const ki_pair *pair, kiln_check_level *report)
{
    for (size_t i = 0; i < kiln_map_texels(&pair->is, 0); i++) {
        const float *rgb = pair->is.level[0] + 3 * i;
        float most = rgb[0] > rgb[1] ? rgb[0] : rgb[1], least = rgb[0] < rgb[1] ? rgb[0] : rgb[1];
        most = rgb[2] > most ? rgb[2] : most;
        least = rgb[2] < least ? rgb[2] : least;
        report->negative_count += least < 0;
        report->firefly_count += (double)most > 2 * brightest_near(&pair->exact, i) + pair->mean;
    }
}

static double error_of(const ki_pair *pair, size_t texel, size_t channel)
{
    return (double)pair->is.level[0][3 * texel + channel] -
           (double)pair->exact.level[0][3 * texel + channel];
}

// Jumps of the error between neighbouring texels: the sum of their squares and their number.
typedef struct jumps {
    double squares;
    int count;
} jumps;

static void add_jump(const ki_pair *pair, size_t a, size_t b, jumps *j)
{
    for (size_t c = 0; c < 3; c++) {
        double jump = error_of(pair, a, c) - error_of(pair, b, c);
        j->squares += jump * jump;
        j->count++;
    }
}

// Measures the jumps across the edges of faces, and those from the texels at an edge to the texels
// one step inward.
static void measure_seam(const ki_pair *pair, kiln_check_level *report)
{
    int n = pair->is.size;
    jumps across = {0, 0}, inward = {0, 0};
    if (pair->is.shape != KILN_SHAPE_CUBE || n < 2 || pair->norm <= 0)
        return;
    for (int i = 0; i < 24 * n; i++) {
        int face = i / (4 * n), side = i / n % 4, at = i % n;
        int x = side == 0 ? 0 : side == 1 ? n - 1 : at, y = side == 2 ? 0 : side == 3 ? n - 1 : at;
        int dx = side == 0 ? -1 : side == 1, dy = side == 2 ? -1 : side == 3;
        size_t edge = ki_cube_texel(n, face, x, y);
        add_jump(pair, edge, ki_cube_texel(n, face, x + dx, y + dy), &across);
        add_jump(pair, edge, ki_cube_texel(n, face, x - dx, y - dy), &inward);
    }
    report->seam = sqrt(across.squares / across.count) / pair->norm;
    report->within = sqrt(inward.squares / inward.count) / pair->norm;
}

void ki_measure_level(const ki_pair *pair, kiln_check_level *report)
{
    double squares = 0, sum = 0, own = 0, weight = 0, largest = 0;
    double norm = pair->norm > 0 ? pair->norm : 1, mean = pair->mean > 0 ? pair->mean : 1;
    for (size_t i = 0; i < kiln_map_texels(&pair->is, 0); i++) {
        double w = ki_weight_of(&pair->is, i);
        for (size_t c = 0; c < 3; c++) {
            double d = error_of(pair, i, c), l = (double)pair->is.level[0][3 * i + c];
            squares += w * d * d;
            sum += w * d;
            own += w * l * l;
            weight += w;
            largest = fmax(largest, fabs(d));
        }
    }
    report->rms = sqrt(squares / weight) / norm;
    report->largest = largest / norm;
    report->bias = sum / weight / mean;
    report->energy = sqrt(own / weight) / norm;
    measure_seam(pair, report);
    count_texels(pair, report);
}
