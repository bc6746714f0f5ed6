// Kernels for the texels of a picture that is read: products with a matrix of colours, half floats
// converted to floats, and channels joined to texels. Files that are compiled for one instruction
// set each define TRANSFORM, WIDEN and JOIN, the kernels' names, and include this file. WIDEN is
// plain C that compilers vectorise.
#include "image/convert.h"

#include "base/vector.h"
#include "image/small_float.h"

#include <string.h>

typedef double double4 __attribute__((vector_size(32)));

// Loads and stores four texels as three vectors, one by one, which then stay in registers.
static inline void load4(const float *rgb, ki_float4 texels[3])
{
    memcpy(&texels[0], rgb, sizeof texels[0]);
    memcpy(&texels[1], rgb + 4, sizeof texels[1]);
    memcpy(&texels[2], rgb + 8, sizeof texels[2]);
}

static inline void store4(float *rgb, const ki_float4 texels[3])
{
    memcpy(rgb, &texels[0], sizeof texels[0]);
    memcpy(rgb + 4, &texels[1], sizeof texels[1]);
    memcpy(rgb + 8, &texels[2], sizeof texels[2]);
}

// Multiplies four texels by the matrix, and adds to `zero` numbers that are 0, or not a number
// where a product is not finite. Each product is a sum over all three channels of a texel, so it is
// not finite if a channel is infinite or not a number, even where the matrix is 0, because 0 times
// infinity is not a number. Lists of lanes convert vectors with the fewest instructions.
static inline void transform4(const ki_matrix3 *a, ki_float4 texels[3], ki_float4 *zero)
{
    ki_float4 from[3], to[3];
    double4 in[3];
    ki_split_rgb4(texels, from);
    for (int c = 0; c < 3; c++)
        in[c] = (double4){(double)from[c][0], (double)from[c][1], (double)from[c][2],
                          (double)from[c][3]};
    for (int c = 0; c < 3; c++) {
        double4 sum = a->m[c][0] * in[0] + a->m[c][1] * in[1] + a->m[c][2] * in[2];
        to[c] = (ki_float4){(float)sum[0], (float)sum[1], (float)sum[2], (float)sum[3]};
        *zero += to[c] - to[c];
    }
    ki_join_rgb4(to, texels);
}

size_t TRANSFORM(const ki_matrix3 *matrix, float *rgb, size_t count)
{
    const ki_matrix3 a = *matrix;
    size_t done = 0;
    for (; done + KI_TRANSFORMED <= count; done += KI_TRANSFORMED) {
        ki_float4 first[3], second[3], zero = {0};
        float *texels = rgb + 3 * done;
        load4(texels, first);
        load4(texels + 12, second);
        transform4(&a, first, &zero);
        transform4(&a, second, &zero);
        if (!((zero[0] + zero[2]) + (zero[1] + zero[3]) == 0))
            break;
        store4(texels, first);
        store4(texels + 12, second);
    }
    return done;
}

void JOIN(const float *const colors[3], size_t count, float *restrict rgb)
{
    const float *r = colors[0], *g = colors[1], *b = colors[2];
    size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        ki_float4 planes[3], texels[3];
        memcpy(&planes[0], r + i, sizeof planes[0]);
        memcpy(&planes[1], g + i, sizeof planes[1]);
        memcpy(&planes[2], b + i, sizeof planes[2]);
        ki_join_rgb4(planes, texels);
        store4(rgb + 3 * i, texels);
    }
    for (; i < count; i++) {
        rgb[3 * i] = r[i];
        rgb[3 * i + 1] = g[i];
        rgb[3 * i + 2] = b[i];
    }
}

void WIDEN(const void *restrict bytes, size_t count, float *restrict values)
{
    enum { PART = 256 };
    const uint8_t *from = bytes;
    for (size_t done = 0; done < count; done += PART) {
        size_t n = count - done < PART ? count - done : PART;
        uint16_t halfs[PART];
        memcpy(halfs, from + 2 * done, 2 * n);
        for (size_t i = 0; i < n; i++)
            values[done + i] = ki_float_of_half(halfs[i]);
    }
}
