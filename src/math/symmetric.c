// Eigenvalues and eigenvectors of a small symmetric matrix, by Jacobi's method (1846): rotations in
// the planes of two coordinates that make the off-diagonal elements vanish one after another.
#include "math/math.h"

#include <math.h>

// Rotates the vectors x and y, two rows or two columns of a matrix, by the angle of cosine c and
// sine s. Each has `count` elements, `step` apart.
static void turn(double *x, double *y, int count, int step, double c, double s)
{
    for (int k = 0; k < count; k++, x += step, y += step) {
        double from = *x;
        *x = c * from - s * *y;
        *y = s * from + c * *y;
    }
}

void ki_symmetric_axes(int count, double *a, double *axes, double *values)
{
    enum { SWEEPS = 16 };
    size_t n = (size_t)count;
    for (size_t i = 0; i < n * n; i++)
        axes[i] = i % (n + 1) == 0;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (size_t i = 1; i < n; i++)
            for (size_t j = 0; j < i; j++) {
                double *off = a + i * n + j, low = a[j * n + j], high = a[i * n + i];
                if (fabs(*off) <= 1e-30 * (fabs(low) + fabs(high)))
                    continue;
                double slope = (high - low) / (2 * *off);
                double t = (slope < 0 ? -1 : 1) / (fabs(slope) + sqrt(slope * slope + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                turn(a + j, a + i, count, count, c, s);
                turn(a + j * n, a + i * n, count, 1, c, s);
                turn(axes + j * n, axes + i * n, count, 1, c, s);
            }
    for (size_t i = 0; i < n; i++)
        values[i] = a[i * n + i];
}
