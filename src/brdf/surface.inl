// The body of ki_surface_row: Clenshaw's recurrence for a block of n.v at a time. Before inclusion:
// KI_SURFACE_ROW, its name.
#include "brdf/surface.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 32 };

void KI_SURFACE_ROW(const ki_surface *surface, const double *coefficient, double scale,
                    const double *nov, int count, double *out)
{
    for (int from = 0; from < count; from += BLOCK) {
        double x[BLOCK] = {0}, b1[BLOCK], b2[BLOCK] = {0}, sum[BLOCK];
        int n = ki_min(BLOCK, count - from), top = surface->columns - 1; // odd
        memcpy(x, nov + from, (size_t)n * sizeof *x);
        for (int i = 0; i < BLOCK; i++)
            x[i] = sqrt(x[i] * (1 + scale) / (x[i] + scale));
        if (surface->quartic)
            for (int i = 0; i < BLOCK; i++)
                x[i] = sqrt(x[i]);
        for (int i = 0; i < BLOCK; i++) {
            x[i] = 4 * x[i] - 2; // twice the argument
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
