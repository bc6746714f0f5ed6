// Decompression of EXR's DWAA and DWAB. In: the packed bytes of a chunk. Out: the lines of its box.
// Channels that the chunk's rules name are stored as 8 x 8 blocks of a discrete cosine transform of
// half floats in a perceptual scale; other channels are compressed as runs or by zlib. The format
// is described in "DreamWorks Animation Lossy Compression" (OpenEXR 2.2).
#include "base/bytes.h"
#include "codec/exr.h"
#include "image/pack.h"
#include "math/math.h"

#include <stdio.h>
#include <string.h>

enum { SCHEME_ZLIB = 0, SCHEME_DCT = 1, SCHEME_RUNS = 2 };
enum { MAX_RULES = 256, AC_HUFFMAN = 0, AC_DEFLATE = 1, END_OF_BLOCK = 0xff00 };

// -------------------------------------------------------------------------------------- the curve

enum { TABLE_TASKS = 64, TABLE_STRETCH = 0x7c00 / TABLE_TASKS };

// Fills a stretch of the table: x^2.2 up to 1, e^(2.2 (x - 1)) above. Infinities and not-a-number
// are never stored and give 0.
static void linear_stretch(void *data, int index)
{
    uint16_t *table = data;
    for (int i = index * TABLE_STRETCH; i < (index + 1) * TABLE_STRETCH; i++) {
        double x = (double)ki_float_from_half((uint16_t)i);
        double y = 0;
        if (x > 8)
            y = 65536; // a value larger than any half
        else if (x > 1)
            y = ki_exp(2.2 * (x - 1));
        // For smaller x the power is less than half of the smallest half float and rounds to 0.
        else if (x > 0x1p-12)
            y = ki_pow(x, 2.2);
        uint16_t half = ki_half_from_float((float)y);
        table[i] = half;
        table[0x8000 + i] = (uint16_t)(0x8000 | half);
    }
}

void ki_exr_dwa_table(kiln_context *context, uint16_t *table)
{
    memset(table, 0, 65536 * sizeof *table);
    ki_parallel_for(context, TABLE_TASKS, linear_stretch, table);
}

// ------------------------------------------------------------------------------------- the header

typedef struct counts {
    size_t version, zlib_size, zlib_packed, ac_packed, dc_packed, runs_packed, runs_size, runs_raw,
        ac_count, dc_count, ac_compression;
} counts;

typedef struct dwa_rule {
    char suffix[32];
    // place: position of the channel in a colour triple (0 red, 1 green, 2 blue), -1 for a channel
    // that belongs to no triple; type: ki_exr_type
    int scheme, place, type;
    bool any_case;
} dwa_rule;

// How the chunk stores the samples of one channel.
typedef struct dwa_plan {
    int scheme;
    int width, height; // size of the channel in samples
    // the channel's raw bytes, unless the channel is stored by the cosine transform
    const uint8_t *from;
    const size_t *lines; // the byte of the box at which each line of the channel begins
    bool done;
} dwa_plan;

typedef struct dwa {
    ki_exr_workspace *work;
    const ki_exr_box *box;
    counts counts;
    dwa_rule rules[MAX_RULES];
    int rule_count;
    uint8_t *raw;
    const uint16_t *ac, *ac_end, *dc, *dc_end;
    dwa_plan plans[]; // how each channel is stored
} dwa;

static void read_counts(ki_reader *r, counts *c)
{
    size_t *field[] = {&c->version,   &c->zlib_size,   &c->zlib_packed,   &c->ac_packed,
                       &c->dc_packed, &c->runs_packed, &c->runs_size,     &c->runs_raw,
                       &c->ac_count,  &c->dc_count,    &c->ac_compression};
    for (size_t i = 0; i < sizeof field / sizeof *field; i++) {
        uint64_t value = ki_read_u64(r);
        *field[i] = (size_t)value;
        r->failed = r->failed || *field[i] != value;
    }
}

static void add_rule(dwa *d, const char *suffix, int scheme, int place, int type, bool any_case)
{
    dwa_rule *added = &d->rules[d->rule_count++];
    snprintf(added->suffix, sizeof added->suffix, "%.8s", suffix);
    added->scheme = scheme;
    added->place = place;
    added->type = type;
    added->any_case = any_case;
}

// Adds the rules of files before version 2, which do not store rules: which channels, by the end of
// their names, are stored by which scheme (cosine transform, runs or zlib).
static void add_old_rules(dwa *d)
{
    static const struct {
        char suffix[8];
        int place;
    } transformed[] = {{"r", 0},   {"red", 0},  {"g", 1},  {"grn", 1}, {"green", 1}, {"b", 2},
                       {"blu", 2}, {"blue", 2}, {"y", -1}, {"by", -1}, {"ry", -1}};
    for (size_t i = 0; i < sizeof transformed / sizeof *transformed; i++)
        for (int type = KI_EXR_HALF; type <= KI_EXR_FLOAT; type++)
            add_rule(d, transformed[i].suffix, SCHEME_DCT, transformed[i].place, type, true);
    for (int type = KI_EXR_UINT; type <= KI_EXR_FLOAT; type++)
        add_rule(d, "a", SCHEME_RUNS, -1, type, true);
}

// Reads the rules of a chunk: which channels are stored by which scheme (cosine transform, runs or
// zlib). A rule is the last part of the channels' names with its NUL; a byte with the place in a
// colour triple + 1 (4 bits), the scheme (2 bits) and, in the last bit, whether case is ignored;
// and the pixel type.
static bool read_rules(dwa *d, ki_reader *r)
{
    const uint8_t *head = ki_read_bytes(r, 2);
    size_t size = head ? (size_t)(head[0] | head[1] << 8) : 0;
    const uint8_t *bytes = size >= 2 ? ki_read_bytes(r, size - 2) : NULL;
    if (!bytes)
        return false;
    ki_reader rules = ki_reader_make(bytes, size - 2);
    while (ki_reader_left(&rules)) {
        dwa_rule *read = &d->rules[d->rule_count];
        size_t length = 0;
        const uint8_t *at = rules.at;
        while (length < ki_reader_left(&rules) && at[length])
            length++;
        if (length >= sizeof read->suffix || !ki_read_bytes(&rules, length + 1))
            return false;
        memcpy(read->suffix, at, length + 1);
        int value = ki_read_u8(&rules);
        read->place = (value >> 4) - 1;
        read->scheme = value >> 2 & 3;
        read->any_case = value & 1;
        read->type = ki_read_u8(&rules);
        if (rules.failed || read->place > 2 || read->scheme > SCHEME_RUNS ||
            read->type > KI_EXR_FLOAT || ++d->rule_count == MAX_RULES)
            return false;
    }
    return true;
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static bool rule_fits(const dwa_rule *rule, const char *suffix, int type)
{
    if (rule->type != type)
        return false;
    const char *wanted = rule->suffix;
    for (; *wanted && *suffix; wanted++, suffix++)
        if (rule->any_case ? lower(*wanted) != lower(*suffix) : *wanted != *suffix)
            return false;
    return *wanted == *suffix;
}

// Compares the layers of two channels, which are the parts of the channels' names before the last
// dot.
static int compare_layers(const char *a, const char *b)
{
    size_t length_a = (size_t)(ki_exr_suffix(a) - a), length_b = (size_t)(ki_exr_suffix(b) - b);
    length_a -= length_a > 0;
    length_b -= length_b > 0;
    int order = memcmp(a, b, length_a < length_b ? length_a : length_b);
    return order ? order : (length_a > length_b) - (length_a < length_b);
}

// --------------------------------------------------------------------------------------- transform

// One of the two passes of the inverse cosine transform of an 8 x 8 block, for eight columns at
// once. The even coefficients give the part that is equal at the samples k and 7 - k, the odd
// coefficients the part that has opposite signs there.
static void inverse_pass(float v[8][8])
{
    // Halves of cos(pi / 4), cos(pi / 16), cos(pi / 8), cos(3 pi / 16), cos(5 pi / 16), cos(3 pi /
    // 8) and cos(7 pi / 16), the factors of the transform of eight samples.
    static const float a = 0.35355339F, b = 0.49039264F, c = 0.46193977F, d = 0.41573481F,
                       e = 0.27778512F, f = 0.19134172F, g = 0.09754516F;
    for (int i = 0; i < 8; i++) {
        float odd0 = b * v[1][i] + d * v[3][i] + e * v[5][i] + g * v[7][i];
        float odd1 = d * v[1][i] - g * v[3][i] - b * v[5][i] - e * v[7][i];
        float odd2 = e * v[1][i] - b * v[3][i] + g * v[5][i] + d * v[7][i];
        float odd3 = g * v[1][i] - e * v[3][i] + d * v[5][i] - b * v[7][i];
        float sum = a * (v[0][i] + v[4][i]), difference = a * (v[0][i] - v[4][i]);
        float wide = c * v[2][i] + f * v[6][i], narrow = f * v[2][i] - c * v[6][i];
        float even0 = sum + wide, even1 = difference + narrow;
        float even2 = difference - narrow, even3 = sum - wide;
        v[0][i] = even0 + odd0;
        v[1][i] = even1 + odd1;
        v[2][i] = even2 + odd2;
        v[3][i] = even3 + odd3;
        v[4][i] = even3 - odd3;
        v[5][i] = even2 - odd2;
        v[6][i] = even1 - odd1;
        v[7][i] = even0 - odd0;
    }
}

// Position of each coefficient, as column * 8 + row, in the zigzag order in which a block stores
// coefficients.
static const uint8_t zigzag[64] = {0,  8,  1,  2,  9,  16, 24, 17, 10, 3,  4,  11, 18, 25, 32, 40,
                                   33, 26, 19, 12, 5,  6,  13, 20, 27, 34, 41, 48, 56, 49, 42, 35,
                                   28, 21, 14, 7,  15, 22, 29, 36, 43, 50, 57, 58, 51, 44, 37, 30,
                                   23, 31, 38, 45, 52, 59, 60, 53, 46, 39, 47, 54, 61, 62, 55, 63};

// Transforms coefficients, half floats in zigzag order, to the samples of a block, row by row.
static void inverse_transform(const uint16_t coefficients[64], float samples[64])
{
    float values[64], columns[8][8], rows[8][8];
    ki_floats_from_halfs(coefficients, 64, values);
    for (int i = 0; i < 64; i++)
        columns[zigzag[i] / 8][zigzag[i] % 8] = values[i];
    inverse_pass(columns);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            rows[y][x] = columns[x][y];
    inverse_pass(rows);
    memcpy(samples, rows, sizeof rows);
}

// Reads all coefficients of a block but the first, which is stored elsewhere: values, runs of zeros
// (0xff01 to 0xff3f) and an end mark. Returns the position of the last coefficient that is not
// zero, or -1 if the data are damaged.
static int read_block(dwa *d, uint16_t block[64])
{
    int last = 0;
    for (int i = 1; i < 64;) {
        if (d->ac == d->ac_end)
            return -1;
        uint16_t value = *d->ac++;
        if (value == END_OF_BLOCK)
            break;
        if (value >> 8 == 0xff) {
            i += value & 0xff;
            continue;
        }
        last = i;
        block[i++] = value;
    }
    return last;
}

// Writes a row of a decoded block, at most 8 samples, to its place in the lines of the chunk's box.
static void put_row(const dwa *d, int bytes, bool linear, const uint16_t *halfs, int count,
                    uint8_t *to)
{
    uint16_t row[8] = {0};
    for (int x = 0; x < count; x++)
        row[x] = linear ? halfs[x] : d->work->dwa_table[halfs[x]];
    if (bytes == 2) {
        memcpy(to, row, 2 * (size_t)count);
    } else {
        float values[8];
        ki_floats_from_halfs(row, 8, values);
        memcpy(to, values, 4 * (size_t)count);
    }
}

// Decodes one channel, or three channels that were stored as luma and two colour differences.
static bool transform(dwa *d, const int *members, int count)
{
    int width = d->plans[members[0]].width, height = d->plans[members[0]].height;
    int across = (width + 7) / 8, down = (height + 7) / 8;
    size_t blocks = (size_t)across * (size_t)down;
    if ((size_t)(d->dc_end - d->dc) < blocks * (size_t)count)
        return false;
    for (int by = 0; by < down; by++) {
        if (!ki_exr_go_on(d->work, (size_t)count * 8 * 2 * (size_t)width))
            return false;
        for (int bx = 0; bx < across; bx++) {
            float samples[3][64];
            bool flat = true;
            for (int k = 0; k < count; k++) {
                uint16_t block[64] = {0};
                block[0] = d->dc[(size_t)k * blocks + (size_t)by * (size_t)across + (size_t)bx];
                int last = read_block(d, block);
                if (last < 0)
                    return false;
                if (last == 0) {
                    float value = ki_float_from_half(block[0]) * 0.125F;
                    for (int i = 0; i < 64; i++)
                        samples[k][i] = value;
                } else {
                    flat = false;
                    inverse_transform(block, samples[k]);
                }
            }
            for (int i = 0; count == 3 && i < (flat ? 8 : 64); i++) {
                float luma = samples[0][i], blue = samples[1][i], red = samples[2][i];
                samples[0][i] = luma + 1.5747F * red;
                samples[1][i] = luma - 0.1873F * blue - 0.4682F * red;
                samples[2][i] = luma + 1.8556F * blue;
            }
            int columns = ki_min(8, width - 8 * bx), lines = ki_min(8, height - 8 * by);
            for (int k = 0; k < count; k++) {
                const ki_exr_channel *channel = &d->box->channels[members[k]];
                uint16_t halfs[64];
                ki_halfs_from_floats(samples[k], flat ? 8 : 64, halfs);
                for (int y = 0; y < lines; y++)
                    put_row(d, channel->bytes, count == 1 && channel->linear,
                            halfs + (flat ? 0 : 8 * y), columns,
                            d->raw + d->plans[members[k]].lines[8 * by + y] +
                                (size_t)(8 * bx) * (size_t)channel->bytes);
            }
        }
    }
    d->dc += blocks * (size_t)count;
    for (int k = 0; k < count; k++)
        d->plans[members[k]].done = true;
    return true;
}

// ------------------------------------------------------------------------------------------- chunk

// The channels of one layer that are red, green and blue of a colour, as indices of channels; -1
// for a missing channel.
typedef struct triple {
    // name of one of the three channels, before whose last dot the layer's name stands
    const char *name;
    int member[3];
} triple;

// Sets for every channel the scheme by which it is stored (cosine transform, runs or zlib), and
// lists the colour triples, sorted by the names of their layers. Returns the number of triples.
static int make_plan(dwa *d, triple *triples)
{
    const ki_exr_box *box = d->box;
    int count = 0;
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        dwa_plan *plan = &d->plans[c];
        plan->width = ki_exr_columns(box, channel);
        plan->height = ki_exr_rows(box, channel);
        int place = -1;
        for (int i = 0; i < d->rule_count; i++) {
            const dwa_rule *rule = &d->rules[i];
            if (rule_fits(rule, ki_exr_suffix(channel->name), channel->type)) {
                plan->scheme = rule->scheme;
                place = rule->place >= 0 ? rule->place : place;
            }
        }
        if (place < 0)
            continue;
        int t = 0;
        while (t < count && compare_layers(triples[t].name, channel->name) < 0)
            t++;
        if (t == count || compare_layers(triples[t].name, channel->name) != 0) {
            memmove(triples + t + 1, triples + t, (size_t)(count - t) * sizeof *triples);
            triples[t] = (triple){channel->name, {-1, -1, -1}};
            count++;
        }
        triples[t].member[place] = c;
    }
    return count;
}

static bool whole_triple(const dwa *d, const int member[3])
{
    for (int k = 0; k < 3; k++) {
        if (member[k] < 0)
            return false;
        const ki_exr_channel *c = &d->box->channels[member[k]];
        const ki_exr_channel *first = &d->box->channels[member[0]];
        if (c->x_sampling != first->x_sampling || c->y_sampling != first->y_sampling)
            return false;
    }
    return true;
}

static size_t plane_size(const dwa *d, int scheme)
{
    size_t size = 0;
    for (int c = 0; c < d->box->channel_count; c++)
        if (d->plans[c].scheme == scheme)
            size += (size_t)d->plans[c].width * (size_t)d->plans[c].height *
                    (size_t)d->box->channels[c].bytes;
    return size;
}

// Returns the number of 8 x 8 blocks of all channels that are stored by the cosine transform.
static size_t block_count(const dwa *d)
{
    size_t count = 0;
    for (int c = 0; c < d->box->channel_count; c++)
        if (d->plans[c].scheme == SCHEME_DCT)
            count += (size_t)((d->plans[c].width + 7) / 8) * (size_t)((d->plans[c].height + 7) / 8);
    return count;
}

// Copies a channel that was stored without the cosine transform: line by line, or, if it was stored
// as runs, from planes that hold the most significant byte of every sample, then the next byte.
static bool copy_plain(dwa *d, int index)
{
    const dwa_plan *plan = &d->plans[index];
    size_t bytes = (size_t)d->box->channels[index].bytes;
    size_t width = (size_t)plan->width, plane = width * (size_t)plan->height;
    for (size_t y = 0; width && y < (size_t)plan->height; y++) {
        uint8_t *to = d->raw + plan->lines[y];
        if (!ki_exr_go_on(d->work, width * bytes))
            return false;
        if (plan->scheme == SCHEME_ZLIB) {
            memcpy(to, plan->from + y * width * bytes, width * bytes);
            continue;
        }
        for (size_t x = 0; x < width; x++)
            for (size_t b = 0; b < bytes; b++)
                to[x * bytes + b] = plan->from[b * plane + y * width + x];
    }
    return true;
}

// The packed sections of a chunk, and the memory for their unpacked content: channels compressed by
// zlib; coefficients of the cosine transform after the first of each block (ac); first coefficients
// (dc); and channels compressed as runs.
typedef struct sections {
    const uint8_t *zlib, *ac, *dc, *runs; // packed bytes of each section
    // unpacked channels that zlib compressed, followed by channels that are stored as runs
    uint8_t *plain;
    uint8_t *run_bytes; // the runs after unpacking by zlib, before they are expanded
    uint16_t *ac_values, *dc_values, *scratch;
    size_t *offset; // the byte of the box at which each line of each channel begins
    triple *triples;
    size_t zlib_size, runs_size, blocks;
} sections;

static bool read_sections(dwa *d, const uint8_t *packed, size_t packed_size, sections *s)
{
    ki_reader r = ki_reader_make(packed, packed_size);
    counts *n = &d->counts;
    read_counts(&r, n);
    if (r.failed || n->version > 2)
        return false;
    if (n->version < 2)
        add_old_rules(d);
    else if (!read_rules(d, &r))
        return false;
    s->zlib = ki_read_bytes(&r, n->zlib_packed);
    s->ac = ki_read_bytes(&r, n->ac_packed);
    s->dc = ki_read_bytes(&r, n->dc_packed);
    s->runs = ki_read_bytes(&r, n->runs_packed);
    return !r.failed;
}

// Checks that the counts in the chunk's header are what the channels of the box require. A block
// may have fewer than 64 coefficients.
static bool check_counts(const dwa *d, sections *s)
{
    const counts *n = &d->counts;
    s->zlib_size = plane_size(d, SCHEME_ZLIB);
    s->runs_size = plane_size(d, SCHEME_RUNS);
    s->blocks = block_count(d);
    return n->zlib_size == s->zlib_size && n->runs_raw == s->runs_size &&
           n->runs_size <= 2 * s->runs_size && n->dc_count == s->blocks &&
           n->ac_count <= 64 * (uint64_t)s->blocks;
}

static bool allocate(kiln_context *context, const dwa *d, sections *s)
{
    const counts *n = &d->counts;
    s->plain = ki_alloc_raw(context, s->zlib_size + s->runs_size + 1, 1);
    s->run_bytes = ki_alloc_raw(context, n->runs_size + 1, 1);
    s->ac_values = ki_alloc_raw(context, n->ac_count + 1, sizeof *s->ac_values);
    s->dc_values = ki_alloc_raw(context, s->blocks + 1, sizeof *s->dc_values);
    s->scratch = ki_alloc_raw(context, s->blocks + 1, sizeof *s->scratch);
    return s->plain && s->run_bytes && s->ac_values && s->dc_values && s->scratch;
}

static kiln_result unpack_ac(dwa *d, const sections *s)
{
    const counts *n = &d->counts;
    if (!n->ac_count)
        return KILN_OK;
    if (n->ac_compression == AC_HUFFMAN)
        return ki_exr_unpack_huffman(d->work, s->ac, n->ac_packed, s->ac_values, n->ac_count);
    bool good = n->ac_compression == AC_DEFLATE &&
                ki_exr_inflate(d->work, s->ac, n->ac_packed, (uint8_t *)s->ac_values,
                               n->ac_count * sizeof *s->ac_values);
    return good ? KILN_OK : KILN_ERROR_FORMAT;
}

static kiln_result unpack_sections(dwa *d, const sections *s)
{
    const counts *n = &d->counts;
    ki_exr_workspace *work = d->work;
    if (s->zlib_size && !ki_exr_inflate(work, s->zlib, n->zlib_packed, s->plain, s->zlib_size))
        return KILN_ERROR_FORMAT;
    if (s->runs_size &&
        (!ki_exr_inflate(work, s->runs, n->runs_packed, s->run_bytes, n->runs_size) ||
         ki_exr_unpack_runs(work, s->run_bytes, n->runs_size, s->plain + s->zlib_size,
                            s->runs_size) != s->runs_size))
        return KILN_ERROR_FORMAT;
    if (s->blocks && !ki_exr_unzip(work, s->dc, n->dc_packed, (uint8_t *)s->dc_values,
                                   s->blocks * sizeof *s->dc_values, (uint8_t *)s->scratch))
        return KILN_ERROR_FORMAT;
    d->ac = s->ac_values;
    d->ac_end = s->ac_values + n->ac_count;
    d->dc = s->dc_values;
    d->dc_end = s->dc_values + s->blocks;
    return unpack_ac(d, s);
}

// Decodes the colour triples (red, green and blue of a layer), which are stored before all other
// channels, sorted by the names of their layers.
static bool transform_triples(dwa *d, const triple *triples, int count)
{
    for (int t = 0; t < count; t++) {
        const int *member = triples[t].member;
        if (!whole_triple(d, member))
            continue;
        for (int k = 0; k < 3; k++)
            if (d->plans[member[k]].scheme != SCHEME_DCT)
                return false;
        if (!transform(d, member, 3))
            return false;
    }
    return true;
}

static bool put_other_channels(dwa *d, const sections *s)
{
    const ki_exr_box *box = d->box;
    const uint8_t *at[3] = {s->plain, NULL, s->plain + s->zlib_size};
    for (int c = 0; c < box->channel_count; c++) {
        dwa_plan *plan = &d->plans[c];
        if (plan->done)
            continue;
        if (plan->scheme == SCHEME_DCT) {
            if (!transform(d, &c, 1))
                return false;
            continue;
        }
        plan->from = at[plan->scheme];
        at[plan->scheme] +=
            (size_t)plan->width * (size_t)plan->height * (size_t)box->channels[c].bytes;
        if (!copy_plain(d, c))
            return false;
    }
    return true;
}

static kiln_result decompress(kiln_context *context, dwa *d, const uint8_t *packed,
                              size_t packed_size, sections *s)
{
    if (!read_sections(d, packed, packed_size, s))
        return KILN_ERROR_FORMAT;
    s->triples = ki_alloc_raw(context, (size_t)d->box->channel_count, sizeof *s->triples);
    if (!s->triples)
        return KILN_ERROR_MEMORY;
    int triple_count = make_plan(d, s->triples);
    if (!check_counts(d, s))
        return KILN_ERROR_FORMAT;
    s->offset = ki_alloc_raw(context, ki_exr_count_lines(d->box), sizeof *s->offset);
    if (!s->offset || !allocate(context, d, s))
        return KILN_ERROR_MEMORY;
    kiln_result result = unpack_sections(d, s);
    if (result != KILN_OK)
        return result;
    const size_t *lines[KI_EXR_MAX_CHANNELS];
    ki_exr_find_lines(d->box, s->offset, lines);
    for (int c = 0; c < d->box->channel_count; c++)
        d->plans[c].lines = lines[c];
    bool good = transform_triples(d, s->triples, triple_count) && put_other_channels(d, s);
    return good ? KILN_OK : KILN_ERROR_FORMAT;
}

kiln_result ki_exr_decompress_dwa(ki_exr_workspace *work, const ki_exr_box *box,
                                  const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                  size_t size)
{
    (void)size;
    dwa *d = ki_alloc(work->context, 1, sizeof *d + (size_t)box->channel_count * sizeof *d->plans);
    if (!d)
        return KILN_ERROR_MEMORY;
    d->box = box;
    d->work = work;
    d->raw = raw;
    sections s = {0};
    kiln_result result = decompress(work->context, d, packed, packed_size, &s);
    ki_free(s.triples);
    ki_free(s.offset);
    ki_free(s.plain);
    ki_free(s.run_bytes);
    ki_free(s.ac_values);
    ki_free(s.dc_values);
    ki_free(s.scratch);
    ki_free(d);
    return result;
}
