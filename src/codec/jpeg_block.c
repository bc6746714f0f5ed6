// The range of the inverse cosine transform of JPEG blocks (ITU-T T.81, A.3.3). The transform is
//
//     f(y, x) = 1/8 sum over v and u of B(v, y) B(u, x) F(v, u),
//     B(0, n) = 1,  B(k, n) = sqrt(2) cos((2 n + 1) k pi / 16),
//
// of the dequantized coefficients F, and f + 128 are the samples. The forward transform has the
// same factors. Decoders sum over v first, to a(y, u) = sum of B(v, y) F(v, u), which the method of
// Loeffler, Ligtenberg and Moschytz holds as 4 a.
#include "codec/jpeg_block.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 8, COUNT = SIDE * SIDE };

// Limits of the numbers below which all decoders agree.
enum {
    // Sum of |F| over the block. Since |f| <= 1/4 sum |F|, no other number can be beyond its limit
    // below this one, which spares most blocks the transform.
    SUM_CERTAIN = 2000,
    // Sum of |F| over a column: code for vector units adds two coefficients in 16 bits.
    COLUMN_MOST = 32000,
    // Sum of |a| over a row: code for vector units adds two numbers 4 a in 16 bits.
    ROW_MOST = 8000,
    // |f|: C code takes f modulo 1024, so that 512 would be the limit if integers were not rounded.
    SAMPLE_MOST = 504,
};

// Sets basis[k][n] to B(k, n).
static void fill_basis(double basis[SIDE][SIDE])
{
    // sqrt(2) cos(m pi / 16) for m = 0 to 8
    static const double cosines[SIDE + 1] = {1.4142135623730951,
                                             1.3870398453221475,
                                             1.3065629648763766,
                                             1.1758756024193588,
                                             1,
                                             0.7856949583871022,
                                             0.541196100146197,
                                             0.27589937928294306,
                                             0};
    for (int k = 0; k < SIDE; k++)
        for (int n = 0; n < SIDE; n++) {
            int m = (2 * n + 1) * k % 32;
            m = m > 16 ? 32 - m : m;
            basis[k][n] = k == 0 ? 1 : m > 8 ? -cosines[16 - m] : cosines[m];
        }
}

static void dequantize(const int16_t *coefficients, const uint16_t *steps, double *f)
{
    for (int i = 0; i < COUNT; i++)
        f[i] = (double)coefficients[i] * steps[i];
}

// Sets a to sum over v of B(v, y) F(v, u).
static void transform_columns(double basis[SIDE][SIDE], const double *coefficients, double *a)
{
    for (int y = 0; y < SIDE; y++)
        for (int u = 0; u < SIDE; u++) {
            double sum = 0;
            for (int v = 0; v < SIDE; v++)
                sum += basis[v][y] * coefficients[v * SIDE + u];
            a[y * SIDE + u] = sum;
        }
}

static void transform_rows(double basis[SIDE][SIDE], const double *a, double *samples)
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double sum = 0;
            for (int u = 0; u < SIDE; u++)
                sum += basis[u][x] * a[y * SIDE + u];
            samples[y * SIDE + x] = sum / 8;
        }
}

// Returns the greatest sum of eight absolute values, which lie `step` apart; the sums' first values
// lie `next` apart.
static double greatest_sum(const double *values, int step, int next)
{
    double most = 0;
    for (int i = 0; i < SIDE; i++) {
        double sum = 0;
        for (int k = 0; k < SIDE; k++)
            sum += fabs(values[i * next + k * step]);
        most = fmax(most, sum);
    }
    return most;
}

// Transforms a block to samples less 128. Returns whether no number leaves its range.
static bool transform(double basis[SIDE][SIDE], const double *coefficients, double *samples)
{
    double a[COUNT];
    transform_columns(basis, coefficients, a);
    transform_rows(basis, a, samples);
    bool fits =
        greatest_sum(coefficients, SIDE, 1) <= COLUMN_MOST && greatest_sum(a, 1, SIDE) <= ROW_MOST;
    for (int i = 0; i < COUNT; i++)
        fits = fits && fabs(samples[i]) <= SAMPLE_MOST;
    return fits;
}

// Returns sum |F|, or a number above SUM_CERTAIN if the sum could leave 32 bits.
static uint32_t absolute_sum(const int16_t *coefficients, const uint16_t *steps)
{
    uint32_t sum = 0, bits = 0;
    for (int i = 0; i < COUNT; i++) {
        uint32_t size = (uint32_t)abs(coefficients[i] * (int32_t)steps[i]);
        sum += size;
        bits |= size;
    }
    return bits >> 25 ? UINT32_MAX : sum;
}

bool ki_jpeg_block_fits(const int16_t *coefficients, const uint16_t *steps)
{
    if (absolute_sum(coefficients, steps) <= SUM_CERTAIN)
        return true;
    double basis[SIDE][SIDE], f[COUNT], samples[COUNT];
    fill_basis(basis);
    dequantize(coefficients, steps, f);
    return transform(basis, f, samples);
}

void ki_jpeg_block_limit(int16_t *coefficients, const uint16_t *steps)
{
    double basis[SIDE][SIDE], f[COUNT], samples[COUNT];
    fill_basis(basis);
    dequantize(coefficients, steps, f);
    if (!transform(basis, f, samples)) {
        for (int i = 0; i < COUNT; i++)
            samples[i] = fmin(fmax(samples[i], -128), 127);
        for (int v = 0; v < SIDE; v++)
            for (int u = 0; u < SIDE; u++) {
                double sum = 0;
                for (int i = 0; i < COUNT; i++)
                    sum += basis[v][i / SIDE] * basis[u][i % SIDE] * samples[i];
                f[v * SIDE + u] = floor(sum / 8 + 0.5);
            }
    }
    for (int i = 0; i < COUNT; i++)
        coefficients[i] = (int16_t)f[i];
}
