// Endpoints of ASTC HDR's colour endpoint modes 7 and 11. In: two wanted colours, or the values of
// 8 bits in which ASTC stores two colours. Out: the values, or the colours as logarithmic numbers
// of 12 bits, 128 for each factor of two. Both modes store the largest channel of the brighter
// colour and differences from this channel. Each has several layouts, which share the bits between
// precision and reach ("HDR endpoint decoding" of the Khronos Data Format Specification).
#include "codec/uastc.h"

#include <string.h>

// A layout: the numbers of bits of its fields, and what one step of a field counts in numbers of 12
// bits, as a shift. `high` says which bit of which field each of the extra bits is.
enum { EXTRAS = 7, NONE = 15 };
typedef struct extra {
    uint8_t field, bit;
} extra;
typedef struct layout {
    uint8_t bits[6], shift;
    extra high[EXTRAS];
} layout;

// Fields of mode 11: A is the largest channel of the brighter colour, B and C are what its other
// channels are less, D is what the other colour's channel is less, and E and F correct the other
// colour's channels.
enum { A, B, C, D, E, F };
static const layout colors[8] = {
    {{9, 7, 7, 6, 7, 7}, 3, {{B, 6}, {C, 6}, {E, 6}, {F, 6}, {E, 5}, {F, 5}}},
    {{9, 8, 8, 6, 6, 6}, 3, {{B, 6}, {C, 6}, {B, 7}, {C, 7}, {E, 5}, {F, 5}}},
    {{10, 6, 6, 7, 7, 7}, 2, {{A, 9}, {D, 6}, {E, 6}, {F, 6}, {E, 5}, {F, 5}}},
    {{10, 7, 7, 7, 6, 6}, 2, {{B, 6}, {C, 6}, {A, 9}, {D, 6}, {E, 5}, {F, 5}}},
    {{11, 8, 8, 6, 5, 5}, 1, {{B, 6}, {C, 6}, {B, 7}, {C, 7}, {A, 9}, {A, 10}}},
    {{11, 6, 6, 8, 6, 6}, 1, {{A, 9}, {A, 10}, {D, 7}, {D, 6}, {E, 5}, {F, 5}}},
    {{12, 7, 7, 7, 5, 5}, 0, {{B, 6}, {C, 6}, {A, 11}, {D, 6}, {A, 9}, {A, 10}}},
    {{12, 6, 6, 7, 6, 6}, 0, {{A, 9}, {A, 10}, {A, 11}, {D, 6}, {E, 5}, {F, 5}}},
};

// Fields of mode 7: R is the largest channel of the brighter colour, G and U are what its other
// channels are less (in layout 5 these channels themselves), and S is what all channels of the
// other colour are less.
enum { R, G, U, S };
static const layout scales[6] = {
    {{11, 5, 5, 7}, 1, {{R, 9}, {R, 8}, {R, 7}, {R, 10}, {R, 6}, {S, 6}, {S, 5}}},
    {{11, 6, 6, 5}, 1, {{R, 8}, {G, 5}, {R, 7}, {U, 5}, {R, 6}, {R, 10}, {R, 9}}},
    {{10, 5, 5, 8}, 2, {{R, 9}, {R, 8}, {R, 7}, {R, 6}, {S, 7}, {S, 6}, {S, 5}}},
    {{9, 6, 6, 7}, 3, {{R, 8}, {G, 5}, {R, 7}, {U, 5}, {R, 6}, {S, 6}, {S, 5}}},
    {{8, 7, 7, 6}, 4, {{G, 6}, {G, 5}, {U, 6}, {U, 5}, {R, 6}, {R, 7}, {S, 5}}},
    {{7, 7, 7, 7}, 5, {{G, 6}, {G, 5}, {U, 6}, {U, 5}, {R, 6}, {S, 6}, {S, 5}}},
};

// Where extra bits are stored: value and bit.
static const extra color_places[6] = {{2, 6}, {3, 6}, {4, 6}, {5, 6}, {4, 5}, {5, 5}};
static const extra scale_places[7] = {{1, 6}, {1, 5}, {2, 6}, {2, 5}, {3, 7}, {3, 6}, {3, 5}};

static int clamp12(int v)
{
    return v < 0 ? 0 : v > 4095 ? 4095 : v;
}

static void swap(int *a, int *b)
{
    int c = *a;
    *a = *b;
    *b = c;
}

// ----------------------------------------------------------------------------------------- reading

static void add_extras(const layout *l, const extra *places, int count, const uint8_t *value,
                       int *field)
{
    for (int i = 0; i < count; i++)
        field[l->high[i].field] |= (value[places[i].field] >> places[i].bit & 1) << l->high[i].bit;
}

static int signed_field(int value, int bits)
{
    int sign = 1 << (bits - 1);
    return ((value & (2 * sign - 1)) ^ sign) - sign;
}

static void ends_of_colors(const layout *l, const int f[6], int largest, int end[2][3])
{
    int s = l->shift, e = signed_field(f[E], l->bits[E]), g = signed_field(f[F], l->bits[F]);
    end[1][0] = clamp12(f[A] << s);
    end[1][1] = clamp12((f[A] - f[B]) * (1 << s));
    end[1][2] = clamp12((f[A] - f[C]) * (1 << s));
    end[0][0] = clamp12((f[A] - f[D]) * (1 << s));
    end[0][1] = clamp12((f[A] - f[B] - f[D] - e) * (1 << s));
    end[0][2] = clamp12((f[A] - f[C] - f[D] - g) * (1 << s));
    swap(&end[0][0], &end[0][largest]);
    swap(&end[1][0], &end[1][largest]);
}

static void read_direct(const uint8_t v[6], int end[2][3])
{
    for (int e = 0; e < 2; e++) {
        end[e][0] = v[e] << 4;
        end[e][1] = v[2 + e] << 4;
        end[e][2] = (v[4 + e] & 127) << 5;
    }
}

static void read_colors(const uint8_t v[6], int end[2][3])
{
    int largest = v[4] >> 7 | (v[5] >> 7) << 1;
    if (largest == 3) {
        read_direct(v, end);
        return;
    }
    const layout *l = &colors[v[1] >> 7 | (v[2] >> 7) << 1 | (v[3] >> 7) << 2];
    // Bits 5 and 6 of E and F are extra bits, of which some layouts make bits of other fields.
    int f[6] = {v[0] | (v[1] & 64) << 2, v[2] & 63, v[3] & 63, v[1] & 63, v[4] & 31, v[5] & 31};
    add_extras(l, color_places, 6, v, f);
    ends_of_colors(l, f, largest, end);
}

static void ends_of_scale(int number, const int f[4], int largest, int end[2][3])
{
    int s = scales[number].shift, less = f[S] << s;
    int g = number == 5 ? f[G] : f[R] - f[G], u = number == 5 ? f[U] : f[R] - f[U];
    int high[3] = {f[R] << s, g * (1 << s), u * (1 << s)};
    swap(&high[0], &high[largest]);
    for (int c = 0; c < 3; c++) {
        end[1][c] = clamp12(high[c]);
        end[0][c] = clamp12(high[c] - less);
    }
}

static void read_scale(const uint8_t v[4], int end[2][3])
{
    int head = v[0] >> 6 | (v[1] >> 7) << 2 | (v[2] >> 7) << 3;
    int largest = head < 12 ? head >> 2 : head < 15 ? head & 3 : 0;
    int number = head < 12 ? head & 3 : head < 15 ? 4 : 5;
    int f[4] = {v[0] & 63, v[1] & 31, v[2] & 31, v[3] & 31};
    add_extras(&scales[number], scale_places, EXTRAS, v, f);
    ends_of_scale(number, f, largest, end);
}

void ki_uastc_read_ends(const uint8_t value[6], int ends, int end[2][3])
{
    if (ends == 11)
        read_colors(value, end);
    else
        read_scale(value, end);
}

// ----------------------------------------------------------------------------------------- writing

// What is being written: a layout's fields are stored one after the other, and each is changed to
// the nearest number that the range of the values has.
typedef struct writing {
    const layout *l;
    const extra *places;
    int extras, range;
    uint8_t *value;
    int field[6];
} writing;

static int nearest_int(float v)
{
    return v < 0 ? -(int)(0.5f - v) : (int)(v + 0.5f);
}

// Stores field `own` in value `at`. `top` has the upper bits of the value that no field owns, and
// `low` is the number of lower bits that belong to the field without extra bits.
static void store(writing *w, int own, int at, unsigned top, int low)
{
    for (int i = 0; i < w->extras; i++)
        if (w->places[i].field == at) {
            extra x = w->l->high[i];
            if (x.field == own)
                low++;
            else
                top |= ((unsigned)w->field[x.field] >> x.bit & 1) << w->places[i].bit;
        }
    int mask = (1 << low) - 1, whole = w->field[own];
    int v = ki_uastc_quantize((int)top | (whole & mask), w->range, 8 - low);
    w->value[at] = (uint8_t)v;
    w->field[own] = whole - (whole & mask) + (v & mask);
}

// Sets a field to the number nearest to `wanted`. Returns false if the field's range, `first` and
// 2^bits numbers from there, ends more than a step before.
static bool set(writing *w, int own, float wanted, bool is_signed)
{
    int count = 1 << w->l->bits[own], first = is_signed ? -count / 2 : 0;
    int v = nearest_int(wanted);
    w->field[own] = ki_max(first, ki_min(v, first + count - 1));
    return v >= first - 1 && v <= first + count;
}

static bool finite(int end[2][3])
{
    int most = 0;
    for (int i = 0; i < 6; i++)
        most = ki_max(most, end[i / 3][i % 3]);
    return most <= KI_UASTC_LAST_END;
}

// Returns a number of 12 bits in steps of a layout, at most the largest finite number.
static float in_steps(float v, int shift)
{
    float steps = v / (float)(1 << shift), last = (float)(KI_UASTC_LAST_END >> shift);
    return steps < last ? steps : last;
}

// Writes two colours by a layout of mode 11. `wanted` has the largest channel first. Returns false
// if the layout does not reach the colours.
static bool write_colors(int number, float wanted[2][3], int largest, int range, uint8_t value[6],
                         int end[2][3])
{
    const layout *l = &colors[number];
    writing w = {l, color_places, 6, range, value, {0}};
    float high[3], low[3];
    unsigned n = (unsigned)number, c = (unsigned)largest;
    for (int i = 0; i < 3; i++) {
        high[i] = in_steps(wanted[1][i], l->shift);
        low[i] = in_steps(wanted[0][i], l->shift);
    }
    set(&w, A, high[0], false);
    store(&w, A, 0, 0, 8);
    // store() changes only the lower 8 bits of A; bit 8 is in value 1.
    bool reaches = set(&w, D, (float)w.field[A] - low[0], false);
    if (!reaches || !set(&w, B, (float)w.field[A] - high[1], false) ||
        !set(&w, C, (float)w.field[A] - high[2], false))
        return false;
    store(&w, D, 1, (n & 1) << 7 | ((unsigned)w.field[A] >> 8 & 1) << 6, 6);
    store(&w, B, 2, (n >> 1 & 1) << 7, 6);
    store(&w, C, 3, (n >> 2 & 1) << 7, 6);
    float less = (float)(w.field[A] - w.field[D]);
    if (!set(&w, E, less - (float)w.field[B] - low[1], true) ||
        !set(&w, F, less - (float)w.field[C] - low[2], true))
        return false;
    store(&w, E, 4, (c & 1) << 7, 5);
    store(&w, F, 5, (c >> 1) << 7, 5);
    read_colors(value, end);
    return finite(end);
}

// Writes a number as the `low` lower bits of a value, with the upper bits `top`.
static uint8_t write_number(float wanted, int last, unsigned top, int low, int range)
{
    int v = ki_max(0, ki_min(nearest_int(wanted), last)), q;
    do
        q = ki_uastc_quantize((int)top | v, range, 8 - low);
    while ((q & ((1 << low) - 1)) > last && v-- > 0);
    return (uint8_t)q;
}

static void write_direct(float wanted[2][3], int range, uint8_t value[6], int end[2][3])
{
    for (int e = 0; e < 2; e++) {
        value[e] = write_number(wanted[e][0] / 16, KI_UASTC_LAST_END >> 4, 0, 8, range);
        value[2 + e] = write_number(wanted[e][1] / 16, KI_UASTC_LAST_END >> 4, 0, 8, range);
        value[4 + e] = write_number(wanted[e][2] / 32, KI_UASTC_LAST_END >> 5, 128, 7, range);
    }
    read_direct(value, end);
}

static int largest_of(const float v[3])
{
    return v[0] >= v[1] && v[0] >= v[2] ? 0 : v[1] >= v[2] ? 1 : 2;
}

static void swap_floats(float *a, float *b)
{
    float c = *a;
    *a = *b;
    *b = c;
}

// Returns false if write_colors() would, since the layout is too narrow for two colours even if the
// rounding of the largest channel, by less than ROUNDED steps, brings them closer. `wanted` has the
// largest channel first.
static bool may_reach(int number, float wanted[2][3])
{
    enum { ROUNDED = 12 };
    const layout *l = &colors[number];
    const float below[3] = {wanted[1][0] - wanted[1][1], wanted[1][0] - wanted[1][2],
                            wanted[1][0] - wanted[0][0]};
    for (int f = B; f <= D; f++)
        if (below[f - B] > (float)(((1 << l->bits[f]) + ROUNDED) << l->shift))
            return false;
    return true;
}

static void write_two_colors(float wanted[2][3], int range, uint8_t value[6], int end[2][3])
{
    int first = largest_of(wanted[0]), second = largest_of(wanted[1]);
    if (wanted[0][first] > wanted[1][second])
        for (int c = 0; c < 3; c++)
            swap_floats(&wanted[0][c], &wanted[1][c]);
    int largest = largest_of(wanted[1]);
    float turned[2][3];
    memcpy(turned, wanted, sizeof turned);
    for (int e = 0; e < 2; e++)
        swap_floats(&turned[e][0], &turned[e][largest]);
    for (int number = 7; number >= 0; number--)
        if (may_reach(number, turned) && write_colors(number, turned, largest, range, value, end))
            return;
    write_direct(wanted, range, value, end);
}

// Writes the two ends of a line whose colours are multiples of one colour: the brighter end `high`,
// with its largest channel first, and `less`, the logarithmic steps by which every channel of the
// darker end is smaller. `number` is one of the layouts of ASTC's endpoint mode 7. Returns false if
// that layout cannot hold the ends.
static bool write_scale(int number, const float high[3], float less, int largest, int range,
                        uint8_t value[4], int end[2][3])
{
    const layout *l = &scales[number];
    writing w = {l, scale_places, EXTRAS, range, value, {0}};
    unsigned head =
        number < 4 ? (unsigned)(largest << 2 | number) : 12 | (unsigned)(number < 5 ? largest : 3);
    float steps[3];
    for (int c = 0; c < 3; c++)
        steps[c] = in_steps(high[c], l->shift);
    set(&w, R, steps[0], false);
    store(&w, R, 0, (head & 3) << 6, 6);
    float from = number == 5 ? 0 : (float)w.field[R];
    bool reaches = set(&w, G, number == 5 ? steps[1] : from - steps[1], false);
    reaches = set(&w, U, number == 5 ? steps[2] : from - steps[2], false) && reaches;
    reaches = set(&w, S, less / (float)(1 << l->shift), false) && reaches;
    if (!reaches)
        return false;
    store(&w, G, 1, (head >> 2 & 1) << 7, 5);
    store(&w, U, 2, (head >> 3) << 7, 5);
    store(&w, S, 3, 0, 5);
    read_scale(value, end);
    return finite(end);
}

static void write_color_and_scale(float wanted[2][3], int range, uint8_t value[4], int end[2][3])
{
    float less = 0;
    for (int c = 0; c < 3; c++)
        less += (wanted[1][c] - wanted[0][c]) / 3;
    if (less < 0) {
        less = -less;
        for (int c = 0; c < 3; c++)
            swap_floats(&wanted[0][c], &wanted[1][c]);
    }
    int largest = largest_of(wanted[1]);
    float high[3];
    memcpy(high, wanted[1], sizeof high);
    swap_floats(&high[0], &high[largest]);
    for (int number = 0; number < 5; number++)
        if (write_scale(number, high, less, largest, range, value, end))
            return;
    // Layout 5 reaches every colour, with the channels in their own order. The range of the values
    // may round a channel up to a number that is infinite; then the channels are lowered by a step.
    for (float most = KI_UASTC_LAST_END - 32;
         !write_scale(5, wanted[1], less, 0, range, value, end); most -= 32)
        for (int c = 0; c < 3; c++)
            wanted[1][c] = wanted[1][c] < most ? wanted[1][c] : most;
}

void ki_uastc_write_ends(int number, float wanted[2][3], uint8_t value[6], int end[2][3])
{
    const ki_uastc_mode *mode = &ki_uastc_modes[number];
    for (int i = 0; i < 6; i++) {
        float v = wanted[i / 3][i % 3];
        wanted[i / 3][i % 3] = v > 0 ? v < KI_UASTC_LAST_END ? v : KI_UASTC_LAST_END : 0;
    }
    if (mode->ends == 11)
        write_two_colors(wanted, mode->values, value, end);
    else
        write_color_and_scale(wanted, mode->values, value, end);
}
