// Vectors of KI_WIDTH doubles, KI_WIDTH being 1, 2, 4 or 8: the native vectors of the instruction
// set for which the including file is compiled.
#include <stdint.h>
#include <string.h>

#if KI_WIDTH == 1
typedef double vec;
#else
typedef double vec __attribute__((vector_size(8 * KI_WIDTH), may_alias));
typedef int64_t mask __attribute__((vector_size(8 * KI_WIDTH)));
#endif

static inline vec splat(double x)
{
#if KI_WIDTH == 1
    return x;
#elif KI_WIDTH == 2
    return (vec){x, x};
#elif KI_WIDTH == 4
    return (vec){x, x, x, x};
#else
    return (vec){x, x, x, x, x, x, x, x};
#endif
}

static inline vec load(const double *p)
{
    vec v;
    memcpy(&v, p, sizeof v);
    return v;
}

static inline void store(double *p, vec v)
{
    memcpy(p, &v, sizeof v);
}

// Returns x where x is positive, and 0 elsewhere.
static inline vec positive(vec x)
{
#if KI_WIDTH == 1
    return x > 0 ? x : 0;
#else
    return (vec)((mask)x & (mask)(x > 0));
#endif
}

// Returns the lesser of x and y in each lane.
static inline vec lesser(vec x, vec y)
{
#if KI_WIDTH == 1
    return x < y ? x : y;
#else
    mask less = x < y;
    return (vec)(((mask)x & less) | ((mask)y & ~less));
#endif
}
