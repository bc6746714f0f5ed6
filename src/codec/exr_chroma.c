// Luminance and chroma (Y, RY, BY) to red, green and blue. In: the samples as stored, with chroma
// in every second column and line. Out: three floats a pixel. The method is that of OpenEXR's own
// reader (RgbaInputFile), described in "Technical Introduction to OpenEXR": 1. Missing chroma is
// interpolated by a symmetric filter of 14 samples, along lines first. 2. R = (RY + 1) Y, B = (BY +
// 1) Y, and G from Y = wr R + wg G + wb B, where the weights w follow from the chromaticities of
// the file. 3. A pixel far more saturated than its four diagonal neighbours is an error of step 1
// at a sharp edge. Such a pixel is made less saturated, with its luminance unchanged. Beyond the
// data window, filters read the nearest line or column that has chroma.
#include "codec/exr.h"

#include <math.h>
#include <string.h>

enum { TAPS = 7, STRIPS = 64 };

/// Weights of the chroma samples at a distance of 1, 3, 5, ..., 13 columns or lines on either side
/// of the pixel.
static const float taps[TAPS] = {0.627123F, -0.186077F, 0.087929F, -0.043159F,
                                 0.019597F, -0.007540F, 0.002128F};

enum { RY, Y, BY };

typedef struct job {
    kiln_context *context;
    const ki_exr_picture *picture;
    int sampling;
    float weights[3];
    float *rgb;
    bool starved[STRIPS];
} job;

// ----------------------------------------------------------------------------------- interpolation

// Returns the nearest line (or column) of the picture that a filter may read. After the last line
// the one before it stands, since chroma lies in even lines and the number of lines is even.
static int nearest(int at, int count)
{
    int last_even = (count - 1) & ~1;
    return at < 0 ? 0 : at >= count ? last_even : at;
}

// Task of one thread: fills in the chroma of the odd columns of line 2 * index.
static void fill_line(void *data, int index)
{
    const job *j = data;
    int width = j->picture->width;
    float *line = j->picture->pixels + 3 * (size_t)width * 2 * (size_t)index;
    for (int x = 1; x < width; x += 2)
        for (int c = RY; c <= BY; c += BY - RY) {
            float sum = 0;
            for (int k = 0; k < TAPS; k++)
                sum += taps[k] * (line[3 * nearest(x - 1 - 2 * k, width) + c] +
                                  line[3 * nearest(x + 1 + 2 * k, width) + c]);
            line[3 * x + c] = sum;
        }
}

static const float *line_at(const job *j, int y)
{
    return j->picture->pixels +
           3 * (size_t)j->picture->width * (size_t)nearest(y, j->picture->height);
}

// Adds to `line`, times a weight, the chroma of two lines that lie at the same distance above and
// below it.
static void add_lines(const float *a, const float *b, float weight, int width, float *line)
{
    for (int x = 0; x < width; x++) {
        line[3 * x + RY] += weight * (a[3 * x + RY] + b[3 * x + RY]);
        line[3 * x + BY] += weight * (a[3 * x + BY] + b[3 * x + BY]);
    }
}

static void to_rgb(const float weights[3], float texel[3])
{
    // without chroma the pixel is grey, and stays exactly grey
    if (texel[RY] == 0 && texel[BY] == 0) {
        texel[0] = texel[2] = texel[1];
        return;
    }
    float y = texel[Y], r = (texel[RY] + 1) * y, b = (texel[BY] + 1) * y;
    texel[0] = r;
    texel[1] = (y - r * weights[0] - b * weights[2]) / weights[1];
    texel[2] = b;
}

// Computes a line in red, green and blue. `y` may be one line outside the picture.
static void make_line(const job *j, int y, float *line)
{
    int width = j->picture->width;
    memcpy(line, line_at(j, y), 3 * (size_t)width * sizeof *line);
    if (j->sampling == 2 && y % 2) {
        for (int x = 0; x < width; x++)
            line[3 * x + RY] = line[3 * x + BY] = 0;
        for (int k = 0; k < TAPS; k++)
            add_lines(line_at(j, y - 1 - 2 * k), line_at(j, y + 1 + 2 * k), taps[k], width, line);
    }
    for (int x = 0; x < width; x++)
        to_rgb(j->weights, line + 3 * (size_t)x);
}

// -------------------------------------------------------------------------------------- saturation

static float saturation(const float rgb[3])
{
    float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])), least = fminf(rgb[0], fminf(rgb[1], rgb[2]));
    return most > 0 ? 1 - least / most : 0;
}

static float luminance(const float weights[3], const float rgb[3])
{
    return weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2];
}

// Moves the channels of a pixel towards the largest of them by a factor, and keeps the luminance,
// whose weights are `weights`.
static void desaturate(const float weights[3], const float in[3], float factor, float out[3])
{
    float most = fmaxf(in[0], fmaxf(in[1], in[2]));
    for (int c = 0; c < 3; c++)
        out[c] = fmaxf(most - (most - in[c]) * factor, 0);
    float before = luminance(weights, in), after = luminance(weights, out);
    for (int c = 0; c < 3 && after > 0; c++)
        out[c] *= before / after;
}

// Writes a line whose pixels are not much more saturated than their diagonal neighbours in the
// lines above and below: a pixel keeps at least a quarter of the neighbours' mean distance from
// pure colour.
static void write_line(const job *j, float *const lines[3], float *out)
{
    int width = j->picture->width;
    for (int x = 0; x < width; x++) {
        size_t left = 3 * (size_t)(x > 0 ? x - 1 : 0), at = 3 * (size_t)x;
        size_t right = 3 * (size_t)(x < width - 1 ? x + 1 : x);
        const float *in = lines[1] + at;
        float mean = (saturation(lines[0] + left) + saturation(lines[0] + right) +
                      saturation(lines[2] + left) + saturation(lines[2] + right)) /
                     4;
        mean = fminf(mean, 1);
        float own = saturation(in), most = fminf(1 - (1 - mean) / 4, 1);
        if (own > mean && own > most)
            desaturate(j->weights, in, most / own, out + at);
        else
            memcpy(out + at, in, 3 * sizeof *out);
    }
}

// Task of one thread: writes a strip of lines, of which the line above and below are computed too.
static void write_strip(void *data, int index)
{
    job *j = data;
    int height = j->picture->height, width = j->picture->width;
    int first = (int)((int64_t)height * index / STRIPS);
    int end = (int)((int64_t)height * (index + 1) / STRIPS);
    size_t floats = 3 * (size_t)width;
    if (first == end)
        return;
    float *memory = ki_alloc_raw(j->context, 3 * floats, sizeof *memory);
    j->starved[index] = !memory;
    if (!memory)
        return;
    float *lines[3] = {memory, memory + floats, memory + 2 * floats};
    make_line(j, first - 1, lines[1]);
    make_line(j, first, lines[2]);
    for (int y = first; y < end; y++) {
        float *oldest = lines[0];
        lines[0] = lines[1];
        lines[1] = lines[2];
        lines[2] = oldest;
        make_line(j, y + 1, lines[2]);
        float *out = j->rgb + floats * (size_t)y;
        if (j->sampling == 2)
            write_line(j, lines, out);
        else
            memcpy(out, lines[1], floats * sizeof *out);
    }
    ki_free(memory);
}

kiln_result ki_exr_reconstruct(kiln_context *context, const ki_exr_picture *picture, int sampling,
                               const double weights[3], const char *name, float *rgb,
                               kiln_error *error)
{
    job j = {.context = context, .picture = picture, .sampling = sampling, .rgb = rgb};
    for (int c = 0; c < 3; c++)
        j.weights[c] = (float)weights[c];
    if (sampling == 2 &&
        !ki_parallel_steps(context, NULL, (picture->height + 1) / 2, fill_line, &j))
        return ki_fail_cancelled(error, "reading");
    if (!ki_parallel_steps(context, NULL, STRIPS, write_strip, &j))
        return ki_fail_cancelled(error, "reading");
    for (int i = 0; i < STRIPS; i++)
        if (j.starved[i])
            return ki_fail_memory(context, error, name, 9 * (size_t)picture->width * sizeof(float));
    return KILN_OK;
}
