// Dense linear least squares: QR decomposition by Householder reflections, then back substitution.
#include "math/math.h"

#include <math.h>

// Multiplies a column of `rows` numbers by the reflection I - 2 v v^T / (v.v), where norm2 is v.v.
static void reflect(const double *v, double norm2, double *column, int rows)
{
    double dot = 0;
    for (int i = 0; i < rows; i++)
        dot += v[i] * column[i];
    dot *= 2 / norm2;
    for (int i = 0; i < rows; i++)
        column[i] -= dot * v[i];
}

bool ki_least_squares(double *a, double *b, int rows, int columns, double *x)
{
    double largest = 0;
    for (int k = 0; k < columns; k++) {
        double *column = a + (size_t)k * (size_t)rows, *v = column + k;
        int left = rows - k;
        double sum = 0;
        for (int i = 0; i < left; i++)
            sum += v[i] * v[i];
        double length = sqrt(sum), diagonal = v[0] > 0 ? -length : length;
        largest = length > largest ? length : largest;
        if (!(length > 1e-14 * largest))
            return false;
        v[0] -= diagonal;
        double norm2 = 2 * length * fabs(v[0]);
        for (int j = k + 1; j < columns; j++)
            reflect(v, norm2, a + (size_t)j * (size_t)rows + k, left);
        reflect(v, norm2, b + k, left);
        x[k] = diagonal;
    }
    for (int k = columns - 1; k >= 0; k--) {
        double sum = b[k];
        for (int j = k + 1; j < columns; j++)
            sum -= a[(size_t)j * (size_t)rows + (size_t)k] * x[j];
        x[k] = sum / x[k];
    }
    return true;
}
