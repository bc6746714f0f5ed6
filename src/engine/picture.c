#include "engine/picture.h"

#include "image/pack.h"
#include "math/math.h"

#include <math.h>

// WANTED: floats of a sample in the array of wanted values, RGB and a weight. REMAINDER: floats of
// a sample in the array of remainders, wanted minus interpolated RGB.
enum { WANTED = 4, REMAINDER = 3 };

static ptrdiff_t samples_across(const ki_picture *p)
{
    return (ptrdiff_t)(p->width - 2 * p->border) * p->times;
}

static ptrdiff_t samples_down(const ki_picture *p)
{
    return (ptrdiff_t)(p->height - 2 * p->border) * p->times;
}

size_t ki_picture_room(const ki_picture *picture)
{
    return (size_t)(samples_across(picture) * samples_down(picture)) * (WANTED + REMAINDER);
}

static float *remainders_of(const ki_picture *p)
{
    return p->room + WANTED * samples_across(p) * samples_down(p);
}

static double to_stored(const ki_picture *p, double radiance)
{
    radiance = radiance > 0 ? radiance : 0;
    return p->roots ? sqrt(radiance) : radiance;
}

// Sets the texels of a row of the picture to the mean radiance over each texel's area.
static void average_row(void *data, int row)
{
    const ki_picture *p = data;
    float *to = p->texels + 3 * (ptrdiff_t)row * p->width;
    for (int x = 0; x < p->width; x++, to += 3) {
        double sum[3] = {0}, rgb[3];
        for (int i = 0; i < p->times * p->times; i++) {
            int column = i % p->times, line = i / p->times;
            double u = x - p->border + (column + 0.5) / p->times;
            double v = row - p->border + (line + 0.5) / p->times;
            p->read(p->data, u / (p->width - 2 * p->border), v / (p->height - 2 * p->border), rgb);
            for (int c = 0; c < 3; c++)
                sum[c] += rgb[c];
        }
        for (int c = 0; c < 3; c++)
            to[c] = (float)to_stored(p, sum[c] / (p->times * p->times));
    }
}

static void read_row(void *data, int row)
{
    const ki_picture *p = data;
    ptrdiff_t across = samples_across(p), down = samples_down(p);
    float *to = p->room + (ptrdiff_t)WANTED * row * across;
    for (ptrdiff_t x = 0; x < across; x++, to += WANTED) {
        double rgb[3];
        double weight =
            p->read(p->data, ((double)x + 0.5) / (double)across, (row + 0.5) / (double)down, rgb);
        for (int c = 0; c < 3; c++)
            to[c] = (float)to_stored(p, rgb[c]);
        to[3] = (float)weight;
    }
}

// Sets the remainder of each sample of a row: the wanted value minus the value that the shader
// interpolates from the texels there, times the sample's weight, its solid angle.
static void compare_row(void *data, int row)
{
    const ki_picture *p = data;
    ptrdiff_t across = samples_across(p);
    const float *wanted = p->room + (ptrdiff_t)WANTED * row * across;
    float *remainder = remainders_of(p) + (ptrdiff_t)REMAINDER * row * across;
    double y = p->border + (row + 0.5) / p->times - 0.5, v = y - floor(y);
    for (ptrdiff_t i = 0; i < across; i++, wanted += WANTED, remainder += REMAINDER) {
        double x = p->border + ((double)i + 0.5) / p->times - 0.5, u = x - floor(x);
        const float *at = p->texels + 3 * ((ptrdiff_t)floor(y) * p->width + (ptrdiff_t)floor(x));
        const float *below = at + 3 * (ptrdiff_t)p->width;
        for (int c = 0; c < 3; c++) {
            double shown = (1 - v) * ((1 - u) * (double)at[c] + u * (double)at[3 + c]) +
                           v * ((1 - u) * (double)below[c] + u * (double)below[3 + c]);
            remainder[c] = (float)((double)wanted[3] * ((double)wanted[c] - shown));
        }
    }
}

// One step towards the least error: adds to each texel of a row the mean remainder of the samples
// around the texel, weighted by the share that the texel has in the shader's bilinear interpolation
// at the sample.
static void correct_row(void *data, int row)
{
    const ki_picture *p = data;
    int times = p->times;
    ptrdiff_t across = samples_across(p), down = samples_down(p);
    const float *remainders = remainders_of(p);
    float *to = p->texels + 3 * (ptrdiff_t)row * p->width;
    ptrdiff_t top = (ptrdiff_t)(row - p->border) * times - times / 2;
    for (int x = 0; x < p->width; x++, to += 3) {
        ptrdiff_t left = (ptrdiff_t)(x - p->border) * times - times / 2;
        double sum[3] = {0}, total = 0;
        for (int i = 0; i < 4 * times * times; i++) {
            int column = i % (2 * times), line = i / (2 * times);
            ptrdiff_t fx = left + column, fy = top + line;
            if (fx < 0 || fy < 0 || fx >= across || fy >= down)
                continue;
            double weight =
                (1 - fabs((column + 0.5) / times - 1)) * (1 - fabs((line + 0.5) / times - 1));
            const float *remainder = remainders + REMAINDER * (fy * across + fx);
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (double)remainder[c];
            total += weight * (double)p->room[WANTED * (fy * across + fx) + 3];
        }
        for (int c = 0; c < 3 && total > 0; c++)
            to[c] = (float)ki_clamp((double)to[c] + sum[c] / total, 0, KI_HALF_MAX);
    }
}

bool ki_picture_draw(kiln_context *context, const ki_picture *picture, int steps)
{
    ki_picture p = *picture;
    int down = (int)samples_down(&p);
    bool good = ki_parallel_steps(context, NULL, p.height, average_row, &p) &&
                (!steps || ki_parallel_steps(context, NULL, down, read_row, &p));
    for (int i = 0; i < steps && good; i++)
        good = ki_parallel_steps(context, NULL, down, compare_row, &p) &&
               ki_parallel_steps(context, NULL, p.height, correct_row, &p);
    return good;
}
