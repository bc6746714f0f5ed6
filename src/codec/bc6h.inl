// Encoding of a row of BC6H blocks, compiled once for each instruction set. In: RGB floats. Out: 16
// bytes for each block of 4 x 4 texels. The including file defines KI_BC6H_ROW, the name of the
// function. Method: a line of least squares is fitted to the colours of the block, and two lines
// for the most promising partitions; endpoints are quantised, indices chosen, and both refined by
// least squares. block_lines.inl finds the lines.
//
// Errors are weighted squared differences between the bits of half floats ("codes", 1024 of them for
// each factor of two), which are nearly relative errors except for the darkest colours.
// block_lines.inl has the weights. A code counts as the middle of its interval, since decoding rounds
// down.
#include "codec/block_lines.inl"

// The decoder multiplies a number that it has interpolated between endpoints by 31/64. The result
// is a code, the bits of a half float.
#define CODE (31.0f / 64)

// TRIED: number of partitions that are tried in full. MODES: number of modes that are tried for
// each partition. ROUNDS: number of least-squares refinements for each mode.
enum { TRIED = 2, MODES = 3, ROUNDS = 2 };

// A mode that stores endpoints as differences from endpoint 0 is also tried if the differences
// exceed its range by at most this factor; the endpoints are then moved into range.
#define EXCESS 1.2f

// The scaled distances of a block's texels from the two lines of a partition predict the error of the
// partition's best block. They leave out the differences of the weights within a channel, so that the
// true error may be less. A partition is tried if HOPEFUL times the prediction is less than the least
// error of the blocks that were tried before.
#define HOPEFUL 0.5f

// One block that is to be encoded.
typedef struct colors {
    texels t; // the bits of the half floats, where raised to the least value that counts
    float share[3][TEXELS]; // the weights of squared errors
    scaled_texels s;        // the texels for the search of lines
} colors;

typedef struct candidate {
    ki_bc6h_block block;
    float error;
} candidate;

// Sets mask[i] to 1 where texel i belongs to subset 1, else to 0.
static void read_mask(int partition, float mask[TEXELS])
{
    for (int i = 0; i < TEXELS; i++)
        mask[i] = (float)(ki_bc6h_partitions[partition] >> i & 1);
}

// ---------------------------------------------------------------------------- quantized endpoints

static float code_of(int value, int bits)
{
    return (float)ki_bc6h_unquantize(value, bits) * CODE;
}

// Returns the stored endpoint of `bits` bits whose code is nearest to `code`.
static int quantize(float code, int bits)
{
    float step = (float)(65536 >> bits) * CODE;
    int last = (1 << bits) - 1;
    float at = code / step;
    return at < 0.25f ? 0 : at > (float)last + 0.75f ? last : ki_min((int)at, last);
}

// Moves a stored endpoint into the range that the mode's bits allow: near `base`, which is endpoint
// 0, if the mode stores differences from it, and below 2^bits.
static int keep(int value, int base, const ki_bc6h_mode *mode, int channel)
{
    if (mode->relative) {
        int half = 1 << (mode->delta_bits[channel] - 1);
        value = ki_max(base - half, ki_min(value, base + half - 1));
    }
    return ki_max(0, ki_min(value, (1 << mode->bits) - 1));
}

static void quantize_lines(const lines *from, candidate *k)
{
    const ki_bc6h_mode *mode = &ki_bc6h_modes[k->block.mode];
    for (int e = 0; e < 2 * mode->subsets; e++)
        for (int c = 0; c < 3; c++) {
            int value = quantize(from->end[e / 2][e % 2][c], mode->bits);
            k->block.endpoint[e / 2][e % 2][c] =
                e ? keep(value, k->block.endpoint[0][0][c], mode, c) : value;
        }
}

// Returns whether the differences of all endpoints from endpoint 0 fit in the mode's bits.
static bool fits(const ki_bc6h_block *b)
{
    const ki_bc6h_mode *mode = &ki_bc6h_modes[b->mode];
    for (int e = 1; e < 2 * mode->subsets && mode->relative; e++)
        for (int c = 0; c < 3; c++) {
            int value = b->endpoint[e / 2][e % 2][c];
            if (keep(value, b->endpoint[0][0][c], mode, c) != value)
                return false;
        }
    return true;
}

static void swap_ends(int end[2][3])
{
    for (int c = 0; c < 3; c++) {
        int first = end[0][c];
        end[0][c] = end[1][c];
        end[1][c] = first;
    }
}

// Makes the index of each subset's anchor texel less than half of the index range, as the format
// requires. The ends of the subset's line are swapped to this end. If the swapped endpoints would
// not fit in the mode's bits, the anchor's index is changed instead.
static void obey_anchors(ki_bc6h_block *b, int index[TEXELS])
{
    int subsets = ki_bc6h_modes[b->mode].subsets, count = subsets == 2 ? 8 : 16;
    for (int s = 0; s < subsets; s++) {
        int anchor = s ? ki_bc6h_anchors[b->partition] : 0;
        if (index[anchor] < count / 2)
            continue;
        swap_ends(b->endpoint[s]);
        if (!fits(b)) {
            swap_ends(b->endpoint[s]);
            index[anchor] = count / 2 - 1;
            continue;
        }
        for (int i = 0; i < TEXELS; i++)
            if (subsets == 1 || (ki_bc6h_partitions[b->partition] >> i & 1) == s)
                index[i] = count - 1 - index[i];
    }
}

// Chooses the index of each texel, makes the indices of the anchors valid, and measures the error
// of the decoded block.
static void choose_indices(const colors *of, const float mask[TEXELS], candidate *k)
{
    ki_bc6h_block *b = &k->block;
    const ki_bc6h_mode *mode = &ki_bc6h_modes[b->mode];
    float last = mode->subsets == 2 ? 7 : 15;
    float along[TEXELS] = {0}, length[TEXELS] = {0}, error[TEXELS] = {0};
    for (int c = 0; c < 3; c++) {
        float end[4];
        for (int e = 0; e < 4; e++)
            end[e] = code_of(b->endpoint[e / 2][e % 2][c], mode->bits);
        for (int i = 0; i < TEXELS; i++) {
            float from = mask[i] != 0 ? end[2] : end[0];
            float way = mask[i] != 0 ? end[3] - end[2] : end[1] - end[0];
            float weighted = way * of->share[c][i];
            along[i] += (of->t.code[c][i] + 0.5f - from) * weighted;
            length[i] += way * weighted;
        }
    }
    int index[TEXELS];
    for (int i = 0; i < TEXELS; i++) {
        float at = length[i] > 0 ? along[i] / length[i] : 0;
        at = at > 0 ? at < 1 ? at : 1 : 0;
        index[i] = (int)(at * last + 0.5f);
    }
    obey_anchors(b, index);
    float weight[TEXELS];
    for (int i = 0; i < TEXELS; i++) {
        b->index[i] = index[i];
        weight[i] = (float)ki_bc6h_weight(index[i], mode->subsets);
    }
    // All values in the following loop are integers below 2^24, which floats represent exactly.
    for (int c = 0; c < 3; c++) {
        float end[4];
        for (int e = 0; e < 4; e++)
            end[e] = (float)ki_bc6h_unquantize(b->endpoint[e / 2][e % 2][c], mode->bits);
        for (int i = 0; i < TEXELS; i++) {
            float from = mask[i] != 0 ? end[2] : end[0], to = mask[i] != 0 ? end[3] : end[1];
            float mixed = (float)(int)(((64 - weight[i]) * from + weight[i] * to + 32) / 64);
            float off = (float)(int)(mixed * 31 / 64) - of->t.code[c][i];
            error[i] += off * off * of->share[c][i];
        }
    }
    k->error = fold(error);
}

// The squared error of a channel, summed over a subset, as a function of the codes a and b of the
// line's ends, up to a constant: xx a^2 + 2 xy a b + yy b^2 - 2 x a - 2 y b.
typedef struct parabola {
    float xx, xy, yy, x, y;
} parabola;

// Chooses the two stored ends of a subset's line in one channel. Tries three values of the end
// `low` near the minimum of the parabola, each with the best end `high` for it, and keeps the best
// pair.
static void descend(const parabola *p, const ki_bc6h_mode *mode, int channel, int base,
                    bool is_base, int *low, int *high)
{
    float determinant = p->xx * p->yy - p->xy * p->xy;
    if (!(determinant > 1e-4f * p->xx * p->yy))
        // All texels of the subset have the same index, so that the indices do not determine the
        // ends; the ends stay as they are.
        return;
    float a = (p->x * p->yy - p->y * p->xy) / determinant, best = INFINITY;
    int first = quantize(a, mode->bits);
    for (int i = -1; i <= 1; i++) {
        int q = ki_max(0, ki_min(first + i, (1 << mode->bits) - 1));
        q = is_base ? q : keep(q, base, mode, channel);
        float u = code_of(q, mode->bits);
        int other = keep(quantize((p->y - p->xy * u) / p->yy, mode->bits), is_base ? q : base, mode,
                         channel);
        float v = code_of(other, mode->bits);
        float error = p->xx * u * u + 2 * p->xy * u * v + p->yy * v * v - 2 * (p->x * u + p->y * v);
        if (error < best) {
            best = error;
            *low = q;
            *high = other;
        }
    }
}

// Sets the ends of each subset's line to those with the least squared error for the indices that
// the texels have.
static void refine(const colors *of, const float mask[TEXELS], candidate *k)
{
    ki_bc6h_block *b = &k->block;
    const ki_bc6h_mode *mode = &ki_bc6h_modes[b->mode];
    for (int s = 0; s < mode->subsets; s++) {
        float near[TEXELS], far[TEXELS], product[5][TEXELS];
        for (int i = 0; i < TEXELS; i++) {
            float in = s ? mask[i] : 1 - mask[i];
            float weight = (float)ki_bc6h_weight(b->index[i], mode->subsets) / 64;
            near[i] = in * (1 - weight);
            far[i] = in * weight;
        }
        for (int c = 0; c < 3; c++) {
            for (int i = 0; i < TEXELS; i++) {
                float x = near[i] * of->share[c][i], y = far[i] * of->share[c][i];
                float code = of->t.code[c][i] + 0.5f;
                product[0][i] = x * near[i];
                product[1][i] = x * far[i];
                product[2][i] = y * far[i];
                product[3][i] = x * code;
                product[4][i] = y * code;
            }
            const parabola p = {fold(product[0]), fold(product[1]), fold(product[2]),
                                fold(product[3]), fold(product[4])};
            descend(&p, mode, c, b->endpoint[0][0][c], s == 0, &b->endpoint[s][0][c],
                    &b->endpoint[s][1][c]);
        }
    }
}

// After endpoint 0 has changed, moves endpoints 1 to 3 into the range that the mode's bits for
// differences from endpoint 0 allow.
static void keep_all(ki_bc6h_block *b)
{
    const ki_bc6h_mode *mode = &ki_bc6h_modes[b->mode];
    for (int e = 1; e < 2 * mode->subsets; e++)
        for (int c = 0; c < 3; c++)
            b->endpoint[e / 2][e % 2][c] =
                keep(b->endpoint[e / 2][e % 2][c], b->endpoint[0][0][c], mode, c);
}

// --------------------------------------------------------------------------------------- choosing

static void try_mode(const colors *of, const float mask[TEXELS], const lines *ends, int mode,
                     int partition, candidate *best)
{
    candidate k = {.block = {.mode = mode, .partition = partition}};
    quantize_lines(ends, &k);
    float before = INFINITY;
    for (int round = 0;; round++) {
        choose_indices(of, mask, &k);
        if (k.error < best->error)
            *best = k;
        if (round == ROUNDS || !(k.error < before))
            break;
        before = k.error;
        refine(of, mask, &k);
        keep_all(&k.block);
    }
}

// Returns whether the endpoints' differences from endpoint 0 fit in a mode's bits, or exceed them
// by less than the factor EXCESS.
static bool reaches(const lines *ends, const ki_bc6h_mode *mode)
{
    float step = (float)(65536 >> mode->bits) * CODE;
    for (int c = 0; c < 3 && mode->relative; c++) {
        float most = (float)((1 << (mode->delta_bits[c] - 1)) - 1) * step * EXCESS;
        for (int e = 1; e < 2 * mode->subsets; e++)
            if (fabsf(ends->end[e / 2][e % 2][c] - ends->end[0][0][c]) > most)
                return false;
    }
    return true;
}

// Tries modes on the lines of a partition, from the most precise mode on, until MODES of them could
// store the lines' ends.
static void try_modes(const colors *of, const float mask[TEXELS], const lines *ends,
                      const uint8_t *modes, int count, int partition, candidate *best)
{
    for (int i = 0, tried = 0; i < count && tried < MODES && best->error > 0; i++)
        if (reaches(ends, &ki_bc6h_modes[modes[i]])) {
            try_mode(of, mask, ends, modes[i], partition, best);
            tried++;
        }
}

static void encode(const colors *of, uint8_t bytes[KI_BLOCK_BYTES])
{
    static const uint8_t ones_modes[4] = {13, 12, 11, 10};
    static const uint8_t twos_modes[10] = {2, 3, 4, 0, 5, 6, 7, 8, 1, 9};
    candidate best = {.error = INFINITY};
    float mask[TEXELS] = {0}, unmasked[TEXELS], left[PARTITIONS];
    lines ends = {0};
    for (int i = 0; i < TEXELS; i++)
        unmasked[i] = 1;
    find_scaled(&of->s, unmasked, ends.end[0]);
    try_modes(of, mask, &ends, ones_modes, 4, 0, &best);
    if (best.error > 0)
        rank(&of->s.t, left);
    for (int n = 0; n < TRIED && best.error > 0; n++) {
        int p = 0;
        for (int i = 1; i < PARTITIONS; i++)
            p = left[i] < left[p] ? i : p;
        if (HOPEFUL * left[p] >= best.error)
            break;
        left[p] = INFINITY;
        read_mask(p, mask);
        for (int i = 0; i < TEXELS; i++)
            unmasked[i] = 1 - mask[i];
        find_scaled(&of->s, unmasked, ends.end[0]);
        find_scaled(&of->s, mask, ends.end[1]);
        try_modes(of, mask, &ends, twos_modes, 10, p, &best);
    }
    ki_bc6h_pack(&best.block, bytes);
}

void KI_BC6H_ROW(const float *rgb, int width, int height, int y, uint8_t *bytes)
{
    for (int x = 0; x < width; x += 4, bytes += KI_BLOCK_BYTES) {
        uint16_t halfs[VALUES];
        colors of;
        read_block(rgb, width, height, x, y, halfs);
        int least = is_solid(halfs) ? 0 : least_of_block(halfs);
        for (int i = 0; i < VALUES; i++)
            of.t.code[i % 3][i / 3] = (float)ki_max(halfs[i], least);
        weigh_errors(halfs, of.share);
        scale_channels(&of.t, of.share, &of.s);
        encode(&of, bytes);
    }
}
