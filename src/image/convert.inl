// Kernels for the texels of a picture that is read: products with a matrix of colours, and half
// floats converted to floats. Files that are compiled for one instruction set each define
// TRANSFORM and WIDEN, the kernels' names, and include this file. The loops are plain C that
// compilers vectorise.
#include "image/convert.h"

#include "base/vector.h"
#include "image/small_float.h"

#include <float.h>
#include <math.h>
#include <string.h>

// Splits KI_STRETCH texels into red, green and blue.
static void split(const float *rgb, ki_float4 colors[3][KI_STRETCH / 4])
{
    for (int i = 0; i < KI_STRETCH / 4; i++) {
        ki_float4 texels[3], four[3];
        memcpy(texels, rgb + 12 * (size_t)i, sizeof texels);
        ki_split_rgb4(texels, four);
        for (int c = 0; c < 3; c++)
            colors[c][i] = four[c];
    }
}

static void join(ki_float4 colors[3][KI_STRETCH / 4], float *rgb)
{
    for (int i = 0; i < KI_STRETCH / 4; i++) {
        ki_float4 texels[3], four[3] = {colors[0][i], colors[1][i], colors[2][i]};
        ki_join_rgb4(four, texels);
        memcpy(rgb + 12 * (size_t)i, texels, sizeof texels);
    }
}

// Only the products are tested. Each product is a sum over all three channels of a texel, so it is
// not finite if a channel is infinite or not a number, even where the matrix is 0, because 0 times
// infinity is not a number.
bool TRANSFORM(const ki_matrix3 *matrix, float *rgb)
{
    ki_float4 in[3][KI_STRETCH / 4], out[3][KI_STRETCH / 4];
    float(*from)[KI_STRETCH] = (float(*)[KI_STRETCH])in,
    (*to)[KI_STRETCH] = (float(*)[KI_STRETCH])out;
    const ki_matrix3 a = *matrix;
    int rare = 0;
    split(rgb, in);
    for (int i = 0; i < KI_STRETCH; i++) {
        double r = (double)from[0][i], g = (double)from[1][i], b = (double)from[2][i];
        for (int c = 0; c < 3; c++) {
            to[c][i] = (float)(a.m[c][0] * r + a.m[c][1] * g + a.m[c][2] * b);
            rare |= !(fabsf(to[c][i]) <= FLT_MAX);
        }
    }
    if (!rare)
        join(out, rgb);
    return !rare;
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
