// Encoding of a row of UASTC HDR blocks, compiled once for each instruction set. In: RGB floats.
// Out: 16 bytes for each block of 4 x 4 texels. The including file defines KI_UASTC_ROW, the name
// of the function. Method: a line of least squares is fitted to the colours of the block, and two
// lines for the most promising partition; the ends are rounded to what a mode can store, a weight
// is chosen for each texel, and both are refined by least squares. Blocks of one colour are stored
// exactly.
//
// Errors are weighted squared differences between ASTC's logarithmic numbers of 16 bits ("codes",
// 2048 of them for each factor of two), between which the decoder interpolates. Such a difference
// is nearly a relative error. A channel of a texel has a weight of its value divided by the largest
// value of the block, so that the sun's texels count more than dark texels next to the sun, and a
// colour's nearly black channels count little.
#include "codec/block_lines.inl"
#include "codec/uastc.h"

#include <string.h>

// number of least-squares refinements for each mode
enum { ROUNDS = 2 };

// Indices in ki_uastc_modes of the modes that are tried: one line with 16 and with 12 weights, two
// lines with 4 weights, and two lines along which only brightness changes with 8 weights.
enum { ONE_16 = 7, ONE_12 = 6, TWO_4 = 22, SCALES_8 = 20 };

// Least weight of an error, which black channels have.
#define LEAST_SHARE 0.005f
// Before lines are fitted, values are raised to this many codes below the block's largest value,
// such that nearly black channels do not determine the direction of a line.
#define REACH (8 * 2048.0f)

// The texels of a block, and the weights of their errors.
typedef struct colors {
    texels t, raised;
    float share[3][TEXELS];
} colors;

typedef struct candidate {
    ki_uastc_block block;
    int end[2][2][3]; // what the block's values of endpoints give, in numbers of 12 bits
    float error;
} candidate;

// Returns the middle of the logarithmic numbers of 16 bits that decode to a half float: the inverse
// of ki_uastc_half.
static float code_of_half(int half)
{
    int mantissa = half & 1023;
    float middle = 8 * (float)mantissa + 3.5f;
    float within = mantissa < 192   ? middle / 3
                   : mantissa < 704 ? (middle + 512) / 4
                                    : (middle + 2048) / 5;
    return (float)(half >> 10) * 2048 + within;
}

// Sets along[i] to where texel i lies between the ends of its line, 0 to 1.
static void project(const colors *b, const float mask[TEXELS], const candidate *k,
                    float along[TEXELS])
{
    float length[TEXELS] = {0};
    for (int i = 0; i < TEXELS; i++)
        along[i] = 0;
    for (int c = 0; c < 3; c++) {
        float end[4];
        for (int e = 0; e < 4; e++) {
            int number = 16 * k->end[e / 2][e % 2][c];
            end[e] = (float)number;
        }
        for (int i = 0; i < TEXELS; i++) {
            float from = mask[i] != 0 ? end[2] : end[0];
            float way = mask[i] != 0 ? end[3] - end[2] : end[1] - end[0];
            float weighted = way * b->share[c][i];
            along[i] += (b->t.code[c][i] + 0.5f - from) * weighted;
            length[i] += way * weighted;
        }
    }
    for (int i = 0; i < TEXELS; i++) {
        float at = length[i] > 0 ? along[i] / length[i] : 0;
        along[i] = at > 0 ? at < 1 ? at : 1 : 0;
    }
}

// Chooses the weight of each texel, and measures the error of the decoded block.
static void choose_weights(const colors *b, const float mask[TEXELS], candidate *k)
{
    const ki_uastc_mode *mode = &ki_uastc_modes[k->block.mode];
    float last = (float)(ki_uastc_levels[mode->weights] - 1);
    float along[TEXELS], error[TEXELS] = {0}, weight[TEXELS];
    project(b, mask, k, along);
    for (int i = 0; i < TEXELS; i++)
        k->block.index[i] = (uint8_t)(int)(along[i] * last + 0.5f);
    for (int i = 0; i < TEXELS; i++)
        weight[i] = (float)ki_uastc_weights[mode->weights][k->block.index[i]];
    for (int c = 0; c < 3; c++) {
        float end[4];
        for (int e = 0; e < 4; e++) {
            int number = 16 * k->end[e / 2][e % 2][c];
            end[e] = (float)number;
        }
        for (int i = 0; i < TEXELS; i++) {
            float from = mask[i] != 0 ? end[2] : end[0], to = mask[i] != 0 ? end[3] : end[1];
            // Integers below 2^24, which floats represent exactly.
            float mixed = (float)(int)(((64 - weight[i]) * from + weight[i] * to + 32) / 64);
            float off = mixed - (b->t.code[c][i] + 0.5f);
            error[i] += off * off * b->share[c][i];
        }
    }
    k->error = fold(error);
}

// The line of least squares in one channel: y = at0 + slope x, where x is 0 to 1, through the mean
// of all points. `spread` is the weighted variance of x. `known` is false if all x are equal.
typedef struct fit {
    float x, y, slope, spread;
    bool known;
} fit;

static fit fit_channel(const float share[TEXELS], const float in[TEXELS], const float x[TEXELS],
                       const float code[TEXELS])
{
    float w0[TEXELS], w1[TEXELS], w2[TEXELS], y0[TEXELS], y1[TEXELS];
    for (int i = 0; i < TEXELS; i++) {
        float y = code[i] - code[0];
        w0[i] = share[i] * in[i];
        w1[i] = w0[i] * x[i];
        w2[i] = w1[i] * x[i];
        y0[i] = w0[i] * y;
        y1[i] = w1[i] * y;
    }
    float all = fold(w0), first = fold(w1), second = fold(w2), sum = fold(y0);
    float determinant = all * second - first * first;
    fit f = {first / all, sum / all + code[0] + 0.5f, 0, determinant / all,
             determinant > 1e-4f * all * second};
    if (f.known)
        f.slope = (all * fold(y1) - first * sum) / determinant;
    return f;
}

// Sets the ends of the line of a subset to those with the least squared error for the weights that
// the texels have. Channels whose texels all have the same weight stay as they are.
static void refine_line(const colors *b, const float in[TEXELS], const candidate *k, int subset,
                        float end[2][3])
{
    const ki_uastc_mode *mode = &ki_uastc_modes[k->block.mode];
    float x[TEXELS], slope = 0, spread = 0;
    fit f[3];
    for (int i = 0; i < TEXELS; i++)
        x[i] = (float)ki_uastc_weights[mode->weights][k->block.index[i]] / 64;
    for (int c = 0; c < 3; c++) {
        f[c] = fit_channel(b->share[c], in, x, b->t.code[c]);
        slope += f[c].slope * f[c].spread;
        spread += f[c].spread;
    }
    bool known = f[0].known && f[1].known && f[2].known;
    for (int c = 0; c < 3; c++) {
        // In mode 7 the channels have one slope, the mean of the slopes weighted by the spreads.
        float own = mode->ends == 7 ? slope / spread : f[c].slope;
        float from = f[c].y - own * f[c].x;
        end[0][c] = known ? from : (float)(16 * k->end[subset][0][c]);
        end[1][c] = known ? from + own : (float)(16 * k->end[subset][1][c]);
    }
}

static void refine(const colors *b, const float mask[TEXELS], const candidate *k, lines *ends)
{
    float in[TEXELS];
    for (int s = 0; s < ki_uastc_modes[k->block.mode].subsets; s++) {
        for (int i = 0; i < TEXELS; i++)
            in[i] = s ? mask[i] : 1 - mask[i];
        refine_line(b, in, k, s, ends->end[s]);
    }
}

static void write_lines(const lines *ends, candidate *k)
{
    for (int s = 0; s < ki_uastc_modes[k->block.mode].subsets; s++) {
        float wanted[2][3];
        for (int c = 0; c < 3; c++) {
            wanted[0][c] = ends->end[s][0][c] / 16;
            wanted[1][c] = ends->end[s][1][c] / 16;
        }
        ki_uastc_write_ends(k->block.mode, wanted, k->block.value[s], k->end[s]);
    }
}

static void try_mode(const colors *b, const float mask[TEXELS], const lines *ends, int mode,
                     int partition, candidate *best)
{
    candidate k = {.block = {.mode = mode, .partition = partition}};
    lines now = *ends;
    float before = INFINITY;
    for (int round = 0;; round++) {
        write_lines(&now, &k);
        choose_weights(b, mask, &k);
        if (k.error < best->error)
            *best = k;
        if (round == ROUNDS || !(k.error < before))
            break;
        before = k.error;
        refine(b, mask, &k, &now);
    }
}

// Finds the line through the mean of the texels whose weight is 1 along which the three channels
// rise equally, as in modes with a colour and a brightness, and its two ends.
static void find_scale(const texels *t, const float weight[TEXELS], float end[2][3])
{
    float product[TEXELS], mean[3], count = fold(weight), low = 0, high = 0;
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < TEXELS; i++)
            product[i] = weight[i] * t->code[c][i];
        mean[c] = fold(product) / count;
    }
    for (int i = 0; i < TEXELS; i++) {
        float at = 0;
        for (int c = 0; c < 3; c++)
            at += weight[i] * (t->code[c][i] - mean[c]) / 3;
        low = at < low ? at : low;
        high = at > high ? at : high;
    }
    for (int c = 0; c < 3; c++) {
        end[0][c] = mean[c] + 0.5f + low;
        end[1][c] = mean[c] + 0.5f + high;
    }
}

// Returns the partition whose two lines leave the least variance. `left` is indexed by BC6H's
// numbers of partitions.
static int best_partition(const float left[PARTITIONS])
{
    int p = 0;
    for (int i = 1; i < KI_UASTC_PARTITIONS; i++)
        p = left[ki_uastc_partitions[i].bc6h] < left[ki_uastc_partitions[p].bc6h] ? i : p;
    return p;
}

static void try_partition(const colors *b, int partition, candidate *best)
{
    float mask[TEXELS], unmasked[TEXELS];
    lines ends = {0};
    unsigned bits = ki_uastc_mask(partition);
    for (int i = 0; i < TEXELS; i++) {
        mask[i] = (float)(bits >> i & 1);
        unmasked[i] = 1 - mask[i];
    }
    find_line(&b->raised, unmasked, ends.end[0]);
    find_line(&b->raised, mask, ends.end[1]);
    try_mode(b, mask, &ends, TWO_4, partition, best);
    find_scale(&b->raised, unmasked, ends.end[0]);
    find_scale(&b->raised, mask, ends.end[1]);
    try_mode(b, mask, &ends, SCALES_8, partition, best);
}

static void encode(const colors *b, uint8_t bytes[KI_BLOCK_BYTES])
{
    candidate best = {.error = INFINITY};
    float none[TEXELS] = {0}, all[TEXELS], left[PARTITIONS];
    lines ends = {0};
    for (int i = 0; i < TEXELS; i++)
        all[i] = 1;
    find_line(&b->raised, all, ends.end[0]);
    try_mode(b, none, &ends, ONE_16, 0, &best);
    try_mode(b, none, &ends, ONE_12, 0, &best);
    rank(&b->raised, left);
    try_partition(b, best_partition(left), &best);
    ki_uastc_pack(&best.block, bytes);
}

// Returns whether all texels have the same colour, and stores such a block.
static bool encode_solid(const uint16_t halfs[VALUES], uint8_t bytes[KI_BLOCK_BYTES])
{
    ki_uastc_block b = {.mode = KI_UASTC_SOLID};
    for (int i = 3; i < VALUES; i++)
        if (halfs[i] != halfs[i - 3])
            return false;
    memcpy(b.solid, halfs, sizeof b.solid);
    ki_uastc_pack(&b, bytes);
    return true;
}

static void read_colors(const uint16_t halfs[VALUES], colors *b)
{
    float value[VALUES], most = 0, top = 0;
    ki_floats_from_halfs(halfs, VALUES, value);
    for (int i = 0; i < VALUES; i++)
        most = value[i] > most ? value[i] : most;
    for (int i = 0; i < VALUES; i++) {
        b->t.code[i % 3][i / 3] = code_of_half(halfs[i]) - 0.5f;
        b->share[i % 3][i / 3] = value[i] / most + LEAST_SHARE;
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TEXELS; i++)
            top = b->t.code[c][i] > top ? b->t.code[c][i] : top;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TEXELS; i++) {
            float code = b->t.code[c][i];
            b->raised.code[c][i] = code > top - REACH ? code : top - REACH;
        }
}

void KI_UASTC_ROW(const float *rgb, int width, int height, int y, uint8_t *bytes)
{
    for (int x = 0; x < width; x += 4, bytes += KI_BLOCK_BYTES) {
        uint16_t halfs[VALUES];
        colors b;
        read_block(rgb, width, height, x, y, halfs);
        if (encode_solid(halfs, bytes))
            continue;
        read_colors(halfs, &b);
        encode(&b, bytes);
    }
}
