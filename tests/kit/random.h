// Random numbers for tests: the same on every machine, well mixed for every seed, 0 included. Needs
// no test framework, so that the programs which write files for other programs use these numbers
// too.
#ifndef KILN_KIT_RANDOM_H
#define KILN_KIT_RANDOM_H

#include <math.h>
#include <stdint.h>

static const double pi = 3.14159265358979323846;

/// 64 bits that look random, as a function of 64 bits: the output function of SplitMix64 (Steele,
/// Lea and Flood 2014, "Fast splittable pseudorandom number generators").
static inline uint64_t random_hash(uint64_t value)
{
    value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9u;
    value = (value ^ value >> 27) * 0x94d049bb133111ebu;
    return value ^ value >> 31;
}

/// The next 64 random bits of a sequence. Any start value of *state gives a good sequence.
static inline uint64_t random_bits(uint64_t *state)
{
    *state += 0x9e3779b97f4a7c15u;
    return random_hash(*state);
}

/// Uniform in (0, 1), both ends excluded, in steps of 2^-52.
static inline double random_number(uint64_t *state)
{
    return ((double)(random_bits(state) >> 12) + 0.5) / 4503599627370496.0;
}

/// Uniform between low and high; rounding may give an end of this range.
static inline double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * random_number(state);
}

/// A unit vector, uniform over the sphere.
static inline void random_direction(uint64_t *state, double d[3])
{
    double z = 2 * random_number(state) - 1, phi = 2 * pi * random_number(state);
    double s = sqrt(1 - z * z);
    d[0] = s * cos(phi);
    d[1] = z;
    d[2] = s * sin(phi);
}

#endif
