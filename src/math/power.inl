// The exponential, the logarithm and the power as inline functions, so that compilers can turn a
// loop over an array of arguments into vector instructions. In and out: doubles. Method: the
// argument is reduced to a short interval, where a power series is summed. There is no branch and
// no call, and only + - * / are used, so that vectors and single numbers give the same bits. math.h
// states ranges and errors.
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static inline double double_of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline uint64_t bits_of_double(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

// Returns floor x for |x| < 2^51. The sum of x and 1.5 * 2^52 has no bits for a fraction, so that x
// is rounded to an integer.
static inline double floor_of_small(double x)
{
    double rounded = (x + 6755399441055744.0) - 6755399441055744.0;
    return rounded > x ? rounded - 1 : rounded;
}

static inline double scale_by_power_of_two(double x, int exponent)
{
    // The power is split into two factors, because one factor may be outside the range of doubles.
    // A result below the normal range is rounded once, by the last product.
    int half = exponent / 2;
    return x * double_of_bits((uint64_t)(half + 1023) << 52) *
           double_of_bits((uint64_t)(exponent - half + 1023) << 52);
}

static inline double exponential(double x)
{
    static const double log2_high = 6.93147180369123816490e-01,
                        log2_low = 1.90821492927058770002e-10;
    double inside = x > -745 ? x : -745;
    inside = inside > 709 ? 709 : inside;
    double n = floor_of_small(inside * 1.44269504088896340736 + 0.5);
    double r = (inside - n * log2_high) - n * log2_low;
    // exp r by its Taylor polynomial of degree 13. |r| <= 0.347, so that the next term is below
    // 5e-18.
    double p = 1.0 / 6227020800;
    p = p * r + 1.0 / 479001600;
    p = p * r + 1.0 / 39916800;
    p = p * r + 1.0 / 3628800;
    p = p * r + 1.0 / 362880;
    p = p * r + 1.0 / 40320;
    p = p * r + 1.0 / 5040;
    p = p * r + 1.0 / 720;
    p = p * r + 1.0 / 120;
    p = p * r + 1.0 / 24;
    p = p * r + 1.0 / 6;
    p = p * r + 1.0 / 2;
    double value = scale_by_power_of_two(1 + (r + r * r * p), (int)n);
    value = x > 709 ? 1.7976931348623157e308 : value;
    return x > -745 ? value : 0;
}

static inline double logarithm(double x)
{
    static const double log2_high = 6.93147180369123816490e-01,
                        log2_low = 1.90821492927058770002e-10;
    bool tiny = x < 2.2250738585072014e-308;
    uint64_t bits = bits_of_double(tiny ? x * 18014398509481984.0 : x); // 2^54, for subnormal x
    double e = (int)(bits >> 52) - (tiny ? 1023 + 54 : 1023);
    double m = double_of_bits((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
    bool large = m > 1.41421356237309514547;
    m = large ? m * 0.5 : m;
    e = large ? e + 1 : e;
    // log m = 2 artanh(s) with s = (m - 1) / (m + 1), by the power series of artanh to s^21; |s| <=
    // 0.1716.
    double f = m - 1, s = f / (m + 1), y = s * s, p = 1.0 / 21;
    p = p * y + 1.0 / 19;
    p = p * y + 1.0 / 17;
    p = p * y + 1.0 / 15;
    p = p * y + 1.0 / 13;
    p = p * y + 1.0 / 11;
    p = p * y + 1.0 / 9;
    p = p * y + 1.0 / 7;
    p = p * y + 1.0 / 5;
    p = p * y + 1.0 / 3;
    // With f = m - 1, the series is log m = 2 s + 2 s y p = (f - s f) + 2 s y p, where y p is the
    // sum after the first term. The sum starts from f, which is exact, to round as little as
    // possible.
    return e * log2_high + (f - (s * f - (2 * s * (y * p) + e * log2_low)));
}

// Returns what ki_pow returns for y > 0.
static inline double positive_power(double x, double y)
{
    double value = exponential(y * logarithm(x > 0 ? x : 1));
    return x > 0 ? value : 0;
}
