// Encoding of a row of UASTC HDR blocks, compiled once for each instruction set. In: RGB floats.
// Out: 16 bytes for each block of 4 x 4 texels. The including file defines KI_UASTC_ROW, the name
// of the function. Method: a line of least squares is fitted to the colours of the block, and two
// lines for the most promising partitions; the ends are rounded to what a mode can store, a weight
// is chosen for each texel, and both are refined by least squares. Then both are adjusted such that
// the block also has little error after a conversion to BC6H. Blocks of one colour are stored
// exactly.
//
// The error of a block is the sum of two: that of the block as it is decoded, and that after the
// conversion. Errors are weighted squared differences between ASTC's logarithmic numbers of 16 bits ("codes",
// 2048 of them for each factor of two), between which the decoder interpolates. Such a difference
// is nearly a relative error. block_lines.inl has the weights.
#include "codec/block_lines.inl"
#include "codec/uastc.h"

#include <string.h>

// number of least-squares refinements for each mode
enum { ROUNDS = 1 };

// Indices in ki_uastc_modes of the modes that are tried: one line with 16 and with 12 weights, one
// line along which only brightness changes with 16 weights, two lines with 4 weights, and two lines
// along which only brightness changes with 8 weights.
enum { ONE_16 = 7, ONE_12 = 6, SCALE_16 = 15, TWO_4 = 22, SCALES_8 = 20 };

// Sum of both errors of a block below which no other mode than ONE_16 is tried: at most 1.2 % RMS.
#define SMOOTH 60000.0f
// Two lines are tried for the most promising partition, and for up to TRIED partitions while the sum
// of both errors of the best block exceeds HARSH, which is an error of about 4 % RMS. Few blocks need
// more than one partition; those around lights do.
#define HARSH 600000.0f
enum { TRIED = 3 };
// A candidate whose own error is not this many times less than the sum of both errors of the best
// candidate is given up after its lines are refined. The sum is usually 3 times the own error or more.
#define HOPELESS 2.0f

// One block that is to be encoded.
typedef struct colors {
    texels t;               // ASTC's codes
    float half[3][TEXELS];  // the bits of the half floats for which the codes stand
    float share[3][TEXELS]; // the weights of squared errors
    scaled_texels s;        // the texels for the search of lines
} colors;

typedef struct candidate {
    ki_uastc_block block;
    int end[2][2][3]; // what the block's values of endpoints give, in numbers of 12 bits
    float error;
} candidate;

// Sets end[2 subset + which] to one channel of the block's endpoints, as a number of 16 bits.
static void read_channel(const candidate *k, int channel, float end[4])
{
    for (int e = 0; e < 4; e++) {
        int number = 16 * k->end[e / 2][e % 2][channel];
        end[e] = (float)number;
    }
}

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
        read_channel(k, c, end);
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

// A candidate's block after conversion to BC6H: the endpoints as numbers of 16 bits, by channel and
// 2 subset + which, and the number of bits in which BC6H stores them.
typedef struct converted {
    float end[3][4];
    int bits;
} converted;

// Weights of BC6H to which the weights of a mode are converted, by the number of weights.
static const uint8_t converted_weights[4][16] = {
    {0, 18, 46, 64},
    {0, 9, 18, 27, 37, 46, 55, 64},
    {0, 4, 9, 17, 21, 26, 38, 43, 47, 55, 60, 64},
    {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64},
};

static const uint8_t *weights_after(const ki_uastc_mode *mode)
{
    int levels = ki_uastc_levels[mode->weights];
    return converted_weights[levels == 4 ? 0 : levels == 8 ? 1 : levels == 12 ? 2 : 3];
}

// Converts endpoints as Basis Universal's transcoder does: each is rounded down in the first mode
// whose bits reach all endpoints. Modes store differences from the endpoint that is near the first
// texel.
static void convert(const candidate *k, converted *o)
{
    static const uint8_t one[4] = {13, 12, 11, 10}, two[10] = {2, 3, 4, 0, 5, 6, 7, 8, 1, 9};
    const ki_uastc_mode *mode = &ki_uastc_modes[k->block.mode];
    bool turned = mode->subsets == 2 && ki_uastc_partitions[k->block.partition].inverted;
    int near = weights_after(mode)[k->block.index[0]] > 32, count = 6 * mode->subsets, whole[12];
    for (int i = 0; i < count; i++)
        whole[i] = (ki_uastc_half(16 * k->end[i / 6][i / 3 % 2][i % 3]) * 64 + 30) / 31;
    const int *base = whole + (turned ? 6 : 0) + (near ? 3 : 0);
    const uint8_t *m = mode->subsets == 2 ? two : one;
    for (bool fits = false; !fits; m++) {
        const ki_bc6h_mode *bc6h = &ki_bc6h_modes[*m];
        o->bits = bc6h->bits;
        fits = true;
        for (int i = 0; i < count && bc6h->relative; i++) {
            int reach = 1 << (bc6h->delta_bits[i % 3] - 1), shift = 16 - o->bits;
            int less = (whole[i] >> shift) - (base[i % 3] >> shift);
            fits = fits && less >= -reach && less < reach;
        }
    }
    for (int i = 0; i < count; i++)
        o->end[i % 3][i / 3] = (float)ki_bc6h_unquantize(whole[i] >> (16 - o->bits), o->bits);
}

// Adds the weighted errors of the texels of a converted block whose texels have these indices.
static void add_converted(const colors *b, const float mask[TEXELS], const candidate *k,
                          const converted *o, const uint8_t index[TEXELS], float error[TEXELS])
{
    const uint8_t *weights = weights_after(&ki_uastc_modes[k->block.mode]);
    float weight[TEXELS];
    for (int i = 0; i < TEXELS; i++)
        weight[i] = (float)weights[index[i]];
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TEXELS; i++) {
            float from = mask[i] != 0 ? o->end[c][2] : o->end[c][0];
            float to = mask[i] != 0 ? o->end[c][3] : o->end[c][1];
            // Integers below 2^24, which floats represent exactly.
            float mixed = (float)(int)(((64 - weight[i]) * from + weight[i] * to + 32) / 64);
            // Half floats have 1024 steps for each factor of two, and codes have 2048.
            float off = 2 * ((float)(int)(mixed * 31 / 64) - b->half[c][i]);
            error[i] += off * off * b->share[c][i];
        }
}

// Adds the weighted errors of the texels of the block itself.
static void add_own(const colors *b, const float mask[TEXELS], const candidate *k,
                    const uint8_t index[TEXELS], float error[TEXELS])
{
    const uint8_t *weights = ki_uastc_weights[ki_uastc_modes[k->block.mode].weights];
    float weight[TEXELS];
    for (int i = 0; i < TEXELS; i++)
        weight[i] = (float)weights[index[i]];
    for (int c = 0; c < 3; c++) {
        float end[4];
        read_channel(k, c, end);
        for (int i = 0; i < TEXELS; i++) {
            float from = mask[i] != 0 ? end[2] : end[0], to = mask[i] != 0 ? end[3] : end[1];
            // Integers below 2^24, which floats represent exactly.
            float mixed = (float)(int)(((64 - weight[i]) * from + weight[i] * to + 32) / 64);
            float off = mixed - (b->t.code[c][i] + 0.5f);
            error[i] += off * off * b->share[c][i];
        }
    }
}

// Chooses the weight of each texel.
static void choose_weights(const colors *b, const float mask[TEXELS], candidate *k)
{
    float last = (float)(ki_uastc_levels[ki_uastc_modes[k->block.mode].weights] - 1);
    float along[TEXELS];
    project(b, mask, k, along);
    for (int i = 0; i < TEXELS; i++)
        k->block.index[i] = (uint8_t)(int)(along[i] * last + 0.5f);
}

// Measures the error of the decoded block.
static void measure(const colors *b, const float mask[TEXELS], candidate *k)
{
    float error[TEXELS] = {0};
    add_own(b, mask, k, k->block.index, error);
    k->error = fold(error);
}

// Adds the error after the conversion `o`, and takes for each texel the neighbouring weight if that lowers
// the sum of the texel's two errors.
static void settle_weights(const colors *b, const float mask[TEXELS], const converted *o,
                           candidate *k)
{
    int last = ki_uastc_levels[ki_uastc_modes[k->block.mode].weights] - 1;
    float least[TEXELS] = {0};
    uint8_t first[TEXELS];
    memcpy(first, k->block.index, sizeof first);
    add_own(b, mask, k, first, least);
    add_converted(b, mask, k, o, first, least);
    for (int step = -1; step <= 1; step += 2) {
        float error[TEXELS] = {0};
        uint8_t index[TEXELS];
        for (int i = 0; i < TEXELS; i++)
            index[i] = (uint8_t)ki_max(0, ki_min(first[i] + step, last));
        add_own(b, mask, k, index, error);
        add_converted(b, mask, k, o, index, error);
        for (int i = 0; i < TEXELS; i++) {
            bool better = error[i] < least[i];
            k->block.index[i] = better ? index[i] : k->block.index[i];
            least[i] = better ? error[i] : least[i];
        }
    }
    k->error = fold(least);
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

// Returns the endpoint of a mode of BC6H of `bits` bits to which a code is converted, within the
// range of the bits.
static int to_bc6h(float code, int bits)
{
    int number = (int)(code > 0 ? code < 63487 ? code : 63487 : 0);
    return (ki_uastc_half(number) * 64 + 30) / 31 >> (16 - bits);
}

// Returns the code for which an endpoint of BC6H stands.
static float of_bc6h(int value, int bits)
{
    return code_of_half(ki_bc6h_unquantize(value, bits) * 31 / 64);
}

// Moves the ends of a line in one channel to where a mode of BC6H of `bits` bits has endpoints. The
// error of the channel is a parabola of the ends: tries three endpoints near *from, each with the
// best other end for that endpoint.
static void snap(const float share[TEXELS], const float in[TEXELS], const float x[TEXELS],
                 const float code[TEXELS], int bits, float *from, float *to)
{
    float products[5][TEXELS];
    for (int i = 0; i < TEXELS; i++) {
        float w = share[i] * in[i], near = 1 - x[i], y = code[i] + 0.5f - code[0];
        products[0][i] = w * near * near;
        products[1][i] = w * near * x[i];
        products[2][i] = w * x[i] * x[i];
        products[3][i] = w * near * y;
        products[4][i] = w * x[i] * y;
    }
    float xx = fold(products[0]), xy = fold(products[1]), yy = fold(products[2]);
    float a = fold(products[3]), b = fold(products[4]), best = INFINITY;
    int first = to_bc6h(*from, bits), last = (1 << bits) - 1;
    for (int q = ki_max(first - 1, 0); q <= ki_min(first + 1, last); q++) {
        float u = of_bc6h(q, bits) - code[0];
        float v = of_bc6h(to_bc6h((b - xy * u) / yy + code[0], bits), bits) - code[0];
        float error = xx * u * u + 2 * xy * u * v + yy * v * v - 2 * (a * u + b * v);
        if (error < best) {
            best = error;
            *from = u + code[0];
            *to = v + code[0];
        }
    }
}

// Moves the ends of all lines to where BC6H has endpoints of `bits` bits.
static void snap_lines(const colors *b, const float mask[TEXELS], const candidate *k, int bits,
                       lines *ends)
{
    const ki_uastc_mode *mode = &ki_uastc_modes[k->block.mode];
    float in[TEXELS], x[TEXELS];
    for (int i = 0; i < TEXELS; i++)
        x[i] = (float)ki_uastc_weights[mode->weights][k->block.index[i]] / 64;
    for (int s = 0; s < mode->subsets; s++) {
        for (int i = 0; i < TEXELS; i++)
            in[i] = s ? mask[i] : 1 - mask[i];
        for (int c = 0; c < 3; c++)
            snap(b->share[c], in, x, b->t.code[c], bits, &ends->end[s][0][c], &ends->end[s][1][c]);
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

// Returns whether a candidate cannot be better than the best, as far as its own error tells.
static bool is_hopeless(const candidate *k, const candidate *best)
{
    return HOPELESS * k->error >= best->error;
}

// Settles the weights of a candidate and its conversion, and keeps the result if it is the best.
static void keep_settled(const colors *b, const float mask[TEXELS], const converted *o,
                         const candidate *k, candidate *best)
{
    candidate settled = *k;
    settle_weights(b, mask, o, &settled);
    if (settled.error < best->error)
        *best = settled;
}

// Tries a mode on lines. The lines are refined by least squares for the block alone, then moved to
// where BC6H has endpoints, and the weights are settled for both formats. A mode is given up as soon
// as it is hopeless. (To give it up before the lines are refined would lose suns of one texel.)
static void try_mode(const colors *b, const float mask[TEXELS], const lines *ends, int mode,
                     int partition, candidate *best)
{
    candidate k = {.block = {.mode = mode, .partition = partition}};
    lines now = *ends;
    converted o;
    for (int round = 0;; round++) {
        write_lines(&now, &k);
        choose_weights(b, mask, &k);
        if (round == ROUNDS)
            break;
        refine(b, mask, &k, &now);
    }
    measure(b, mask, &k);
    if (is_hopeless(&k, best))
        return;
    convert(&k, &o);
    keep_settled(b, mask, &o, &k, best);
    snap_lines(b, mask, &k, o.bits, &now);
    write_lines(&now, &k);
    choose_weights(b, mask, &k);
    measure(b, mask, &k);
    if (is_hopeless(&k, best))
        return;
    convert(&k, &o);
    keep_settled(b, mask, &o, &k, best);
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
    find_scaled(&b->s, unmasked, ends.end[0]);
    find_scaled(&b->s, mask, ends.end[1]);
    try_mode(b, mask, &ends, TWO_4, partition, best);
    find_scale(&b->t, unmasked, ends.end[0]);
    find_scale(&b->t, mask, ends.end[1]);
    try_mode(b, mask, &ends, SCALES_8, partition, best);
}

static void encode(const colors *b, uint8_t bytes[KI_BLOCK_BYTES])
{
    candidate best = {.error = INFINITY};
    float none[TEXELS] = {0}, all[TEXELS], left[PARTITIONS];
    lines ends = {0};
    for (int i = 0; i < TEXELS; i++)
        all[i] = 1;
    find_scaled(&b->s, all, ends.end[0]);
    try_mode(b, none, &ends, ONE_16, 0, &best);
    if (best.error > SMOOTH) {
        try_mode(b, none, &ends, ONE_12, 0, &best);
        find_scale(&b->t, all, ends.end[0]);
        try_mode(b, none, &ends, SCALE_16, 0, &best);
        rank(&b->s.t, left);
        for (int n = 0; n < TRIED && (n == 0 || best.error > HARSH); n++) {
            int p = best_partition(left);
            left[ki_uastc_partitions[p].bc6h] = INFINITY;
            try_partition(b, p, &best);
        }
    }
    ki_uastc_pack(&best.block, bytes);
}

// Returns whether all texels have the same colour, and stores such a block.
static bool encode_solid(const uint16_t halfs[VALUES], uint8_t bytes[KI_BLOCK_BYTES])
{
    ki_uastc_block b = {.mode = KI_UASTC_SOLID};
    if (!is_solid(halfs))
        return false;
    memcpy(b.solid, halfs, sizeof b.solid);
    ki_uastc_pack(&b, bytes);
    return true;
}

static void read_colors(const uint16_t halfs[VALUES], colors *b)
{
    int least = least_of_block(halfs);
    weigh_errors(halfs, b->share);
    for (int i = 0; i < VALUES; i++) {
        int c = i % 3, t = i / 3, half = ki_max(halfs[i], least);
        float code = code_of_half(half) - 0.5f;
        b->half[c][t] = (float)half;
        b->t.code[c][t] = code;
    }
    scale_channels(&b->t, b->share, &b->s);
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
