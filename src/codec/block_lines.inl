// Lines through the colours of a block of 4 x 4 texels, for encoders of blocks with one or two
// lines (BC6H and UASTC HDR). In: the texels' three channels, and weights of 0 and 1 that tell
// which texels belong to a line. Out: the line of least squares, or for each partition of BC6H the
// variance that its two lines leave. Included by files that are compiled once for each instruction
// set. The loops run over the sixteen texels or over the partitions, so that compilers vectorise
// them. Sixteen numbers are always added up in the same order, so that all instruction sets give
// the same bits.
#include "codec/bc6h.h"
#include "image/pack.h"

#include <math.h>

enum { TEXELS = 16, VALUES = 3 * TEXELS, PARTITIONS = KI_BC6H_PARTITIONS };

// Channels of the texels in codes: nearly logarithmic numbers, such as the bits of half floats. A
// code stands for the numbers from itself to the next code, so that its middle is code + 0.5.
typedef struct texels {
    float code[3][TEXELS];
} texels;

// The two ends of each subset's line in the space of the codes.
typedef struct lines {
    float end[2][2][3];
} lines;

// Reads the block whose first texel is (x, 4 y) of a picture as half floats, without negative and
// not-a-number values. Texels beyond the picture's edge repeat the last texel before the edge.
static void read_block(const float *rgb, int width, int height, int x, int y,
                       uint16_t halfs[VALUES])
{
    float block[VALUES];
    for (int i = 0; i < TEXELS; i++) {
        size_t column = (size_t)ki_min(x + i % 4, width - 1);
        size_t row = (size_t)ki_min(4 * y + i / 4, height - 1);
        const float *from = rgb + 3 * (row * (size_t)width + column);
        for (int c = 0; c < 3; c++)
            block[3 * i + c] = from[c] > 0 ? from[c] : 0;
    }
    ki_halfs_from_floats(block, VALUES, halfs);
}

// The encoders raise values that are less than the block's largest value divided by 2^DARKEST to this
// quotient, since no eye tells them apart beside the largest, and a line need not reach them.
enum { DARKEST = 20 };

// Returns the value, as the bits of a half float, to which lower values of the block are raised.
static int least_of_block(const uint16_t halfs[VALUES])
{
    int top = 0;
    for (int i = 0; i < VALUES; i++)
        top = ki_max(top, halfs[i]);
    return ki_max(top - DARKEST * 1024, 0);
}

// Returns whether all texels of a block have the same colour.
static bool is_solid(const uint16_t halfs[VALUES])
{
    for (int i = 3; i < VALUES; i++)
        if (halfs[i] != halfs[i - 3])
            return false;
    return true;
}

// What is added to all weights of errors, such that errors of black values count, too.
#define LEAST_SHARE 0.015f

// Sets share[channel][texel] to the weight with which the squared error of this channel of this texel
// counts: its value divided by the largest value of the block, plus LEAST_SHARE. Errors are relative.
// Without weights, a dark texel beside the sun would count as much as the sun, and an error in a
// channel that is nearly black as much as one in the channel that gives the colour.
static void weigh_errors(const uint16_t halfs[VALUES], float share[3][TEXELS])
{
    float value[VALUES], most = 0;
    ki_floats_from_halfs(halfs, VALUES, value);
    for (int i = 0; i < VALUES; i++)
        most = value[i] > most ? value[i] : most;
    for (int i = 0; i < VALUES; i++)
        share[i % 3][i / 3] = (most > 0 ? value[i] / most : 0) + LEAST_SHARE;
}

static float fold(const float v[TEXELS])
{
    float a[8], b[4];
    for (int i = 0; i < 8; i++)
        a[i] = v[i] + v[i + 8];
    for (int i = 0; i < 4; i++)
        b[i] = a[i] + a[i + 4];
    return b[0] + b[2] + (b[1] + b[3]);
}

// Finds the eigenvector of the largest eigenvalue of the symmetric matrix xx xy xz yy yz zz by
// power iteration.
static void find_axis(const float m[6], float axis[3])
{
    const float columns[3][3] = {{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}};
    const float *c = columns[m[0] >= m[3] && m[0] >= m[5] ? 0 : m[3] >= m[5] ? 1 : 2];
    float x = c[0], y = c[1], z = c[2];
    for (int i = 0; i < 6; i++) {
        float most = fmaxf(fabsf(x), fmaxf(fabsf(y), fabsf(z)));
        float scale = most > 0 ? 1 / most : 0;
        x *= scale;
        y *= scale;
        z *= scale;
        float a = m[0] * x + m[1] * y + m[2] * z;
        float b = m[1] * x + m[3] * y + m[4] * z;
        float d = m[2] * x + m[4] * y + m[5] * z;
        x = a;
        y = b;
        z = d;
    }
    float length = sqrtf(x * x + y * y + z * z);
    float scale = length > 0 ? 1 / length : 0;
    axis[0] = x * scale;
    axis[1] = y * scale;
    axis[2] = z * scale;
}

// Finds the least-squares line through the codes of the texels whose weight is 1, and the line's
// two ends, between which all of these texels lie.
static void find_line(const texels *t, const float weight[TEXELS], float end[2][3])
{
    float centered[3][TEXELS], product[TEXELS], mean[3], m[6], axis[3];
    float count = fold(weight);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < TEXELS; i++)
            product[i] = weight[i] * t->code[c][i];
        mean[c] = fold(product) / count;
        for (int i = 0; i < TEXELS; i++)
            centered[c][i] = weight[i] * (t->code[c][i] - mean[c]);
    }
    for (int a = 0, k = 0; a < 3; a++)
        for (int b = a; b < 3; b++, k++) {
            for (int i = 0; i < TEXELS; i++)
                product[i] = centered[a][i] * centered[b][i];
            m[k] = fold(product);
        }
    find_axis(m, axis);
    float low = 0, high = 0;
    for (int i = 0; i < TEXELS; i++) {
        float at = centered[0][i] * axis[0] + centered[1][i] * axis[1] + centered[2][i] * axis[2];
        low = at < low ? at : low;
        high = at > high ? at : high;
    }
    for (int c = 0; c < 3; c++) {
        end[0][c] = mean[c] + 0.5f + low * axis[c];
        end[1][c] = mean[c] + 0.5f + high * axis[c];
    }
}

// A block's codes, multiplied by a factor for each channel: the square root of the mean weight of the
// channel's errors. A line of least squares through the products is one that minimises weighted errors
// of the codes, but for the differences of the weights within a channel.
typedef struct scaled_texels {
    texels t;
    float factor[3];
} scaled_texels;

// `share` has the weights of errors, as weigh_errors sets them.
static void scale_channels(const texels *t, float share[3][TEXELS], scaled_texels *s)
{
    for (int c = 0; c < 3; c++) {
        s->factor[c] = sqrtf(fold(share[c]) / TEXELS);
        for (int i = 0; i < TEXELS; i++)
            s->t.code[c][i] = t->code[c][i] * s->factor[c];
    }
}

// Finds the line of least squares through the texels whose weight is 1, like find_line. Sets `end` to
// its ends, which are codes without the factors of the channels.
static void find_scaled(const scaled_texels *s, const float weight[TEXELS], float end[2][3])
{
    find_line(&s->t, weight, end);
    for (int c = 0; c < 3; c++)
        for (int e = 0; e < 2; e++)
            end[e][c] = (end[e][c] - 0.5f) / s->factor[c] + 0.5f;
}

// Sets left[p] to the variance that remains when the two subsets of partition p are approximated by
// their lines. The loops run over partitions, one in each vector lane.
static void rank(const texels *t, float left[PARTITIONS])
{
    float mean[3], x[3][TEXELS], total[10] = {0};
    for (int c = 0; c < 3; c++) {
        mean[c] = fold(t->code[c]) / TEXELS;
        for (int i = 0; i < TEXELS; i++)
            x[c][i] = t->code[c][i] - mean[c];
    }
    // For each partition p, sum[k][p] is the sum of value[k] over the texels of subset 1: their
    // number, their three channels, and the channels' six products. total[k] is the same sum over
    // all texels of the block.
    float sum[10][PARTITIONS] = {{0}};
    for (int i = 0; i < TEXELS; i++) {
        const float a = x[0][i], b = x[1][i], d = x[2][i];
        const float value[10] = {1, a, b, d, a * a, a * b, a * d, b * b, b * d, d * d};
        float mask[PARTITIONS];
        for (int p = 0; p < PARTITIONS; p++)
            mask[p] = (float)(ki_bc6h_partitions[p] >> i & 1);
        for (int k = 0; k < 10; k++) {
            total[k] += value[k];
            for (int p = 0; p < PARTITIONS; p++)
                sum[k][p] += value[k] * mask[p];
        }
    }
    for (int p = 0; p < PARTITIONS; p++)
        left[p] = 0;
    for (int subset = 0; subset < 2; subset++)
        for (int p = 0; p < PARTITIONS; p++) {
            float s[10];
            for (int k = 0; k < 10; k++)
                s[k] = subset ? sum[k][p] : total[k] - sum[k][p];
            float share = 1 / s[0];
            float xx = s[4] - s[1] * s[1] * share, xy = s[5] - s[1] * s[2] * share;
            float xz = s[6] - s[1] * s[3] * share, yy = s[7] - s[2] * s[2] * share;
            float yz = s[8] - s[2] * s[3] * share, zz = s[9] - s[3] * s[3] * share;
            // The largest eigenvalue of the covariance matrix xx .. zz: its largest column is
            // multiplied by the matrix three times, and the Rayleigh quotient of the result is the
            // eigenvalue.
            bool first = xx >= yy && xx >= zz, second = yy >= zz;
            float a = first ? xx : second ? xy : xz;
            float b = first ? xy : second ? yy : yz;
            float d = first ? xz : second ? yz : zz;
            float trace = xx + yy + zz, scale = 1 / (trace + 1e-6f);
            for (int i = 0; i < 3; i++) {
                float u = (xx * a + xy * b + xz * d) * scale;
                float v = (xy * a + yy * b + yz * d) * scale;
                float w = (xz * a + yz * b + zz * d) * scale;
                a = u;
                b = v;
                d = w;
            }
            float u = xx * a + xy * b + xz * d;
            float v = xy * a + yy * b + yz * d;
            float w = xz * a + yz * b + zz * d;
            float most = (u * a + v * b + w * d) / (a * a + b * b + d * d + 1e-30f);
            left[p] += fmaxf(trace - most, 0);
        }
}
