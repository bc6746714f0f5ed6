// The kernel ki_surface_row: sums a Chebyshev series in u at `count` cosines n.v by Clenshaw's
// recurrence, two degrees per step, a block of cosines at a time. Files that are compiled for one
// instruction set each define KI_SURFACE_ROW, the kernel's name, and include this file.
#include "brdf/surface.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 32 };

void KI_SURFACE_ROW(const ki_surface *surface, const double *coefficient, double scale,
                    const double *nov, int count, double *out)
{
    for (int from = 0; from < count; from += BLOCK) {
        double x[BLOCK] = {0}, b1[BLOCK], b2[BLOCK] = {0}, sum[BLOCK];
        // top: the highest degree of the Chebyshev series of the albedo E in u. It is odd, because
        // `columns` is even.
        int n = ki_min(BLOCK, count - from), top = surface->columns - 1;
        memcpy(x, nov + from, (size_t)n * sizeof *x);
        for (int i = 0; i < BLOCK; i++)
            x[i] = sqrt(x[i] * (1 + scale) / (x[i] + scale));
        if (surface->quartic)
            for (int i = 0; i < BLOCK; i++)
                x[i] = sqrt(x[i]);
        for (int i = 0; i < BLOCK; i++) {
            x[i] = 4 * x[i] - 2; // 2 (2 u - 1): twice the argument of the Chebyshev polynomials
            b1[i] = coefficient[top];
        }
        for (int k = top - 1; k > 1; k -= 2) {
            double high = coefficient[k], low = coefficient[k - 1];
            for (int i = 0; i < BLOCK; i++) {
                double b = high + x[i] * b1[i] - b2[i];
                b1[i] = low + x[i] * b - b1[i];
                b2[i] = b;
            }
        }
        for (int i = 0; i < BLOCK; i++)
            sum[i] = coefficient[0] + x[i] * b1[i] / 2 - b2[i];
        memcpy(out + from, sum, (size_t)n * sizeof *out);
    }
}
