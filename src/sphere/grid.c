#include "sphere/grid.h"

#include "math/math.h"

#include <math.h>

// Number of unknowns of the linear system that determines interpolation weights: the eight weights,
// and the Lagrange multiplier of the constraint that the weights sum to 1.
enum { UNKNOWNS = KI_TAPS + 1 };

// Solves the linear system a x = b by Gaussian elimination with partial pivoting. The solution x
// replaces b, and a is overwritten.
static void solve(double a[UNKNOWNS][UNKNOWNS], double b[UNKNOWNS])
{
    for (int i = 0; i < UNKNOWNS; i++) {
        int pivot = i;
        for (int r = i + 1; r < UNKNOWNS; r++)
            if (fabs(a[r][i]) > fabs(a[pivot][i]))
                pivot = r;
        for (int c = 0; c < UNKNOWNS; c++) {
            double t = a[i][c];
            a[i][c] = a[pivot][c];
            a[pivot][c] = t;
        }
        double t = b[i];
        b[i] = b[pivot];
        b[pivot] = t;
        for (int r = i + 1; r < UNKNOWNS; r++) {
            double factor = a[r][i] / a[i][i];
            for (int c = i; c < UNKNOWNS; c++)
                a[r][c] -= factor * a[i][c];
            b[r] -= factor * b[i];
        }
    }
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        for (int c = i + 1; c < UNKNOWNS; c++)
            b[i] -= a[i][c] * b[c];
        b[i] /= a[i][i];
    }
}

// A random function whose power at angular frequency l is density_l has the autocorrelation
// r(x) = sum_l density_l cos(l x). Its value at x is interpolated from its values at grid points
// x_i. The mean square error is least with the weights w_j that solve
// sum_j r(x_i - x_j) w_j = r(x_i - x) for each i (Wiener's filter). Here the constraint that the
// weights sum to 1 is added.
void ki_taps_design(double step, const double *density, int degree, double *taps)
{
    // To save time, the sums over the angular frequency l take only every stride-th l: `density` is
    // smooth in l, and each l that is taken represents its neighbours.
    int stride = 1 + degree / 64;
    double total = 0, apart[KI_TAPS] = {0};
    for (int l = 0; l <= degree; l += stride) {
        total += density[l];
        for (int d = 0; d < KI_TAPS; d++)
            apart[d] += density[l] * ki_cos(l * d * step);
    }
    for (int n = 0; n <= KI_TAP_STEPS / 2; n++) {
        double fraction = (double)n / KI_TAP_STEPS, a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS] = {0};
        for (int i = 0; i < KI_TAPS; i++) {
            for (int j = 0; j < KI_TAPS; j++)
                a[i][j] = apart[i > j ? i - j : j - i] / total + (i == j ? 1e-14 : 0);
            a[i][KI_TAPS] = a[KI_TAPS][i] = 1;
        }
        a[KI_TAPS][KI_TAPS] = 0;
        // Computes cos(l x) for the distance x from each grid point to the interpolated position,
        // by its recurrence in l. The recurrence errs by about 1e-13, far less than the
        // interpolation itself.
        double twice[KI_TAPS], now[KI_TAPS], before[KI_TAPS];
        for (int i = 0; i < KI_TAPS; i++) {
            double c = ki_cos((fraction - (i - 3)) * step * stride);
            twice[i] = 2 * c;
            now[i] = 1;
            before[i] = c;
        }
        for (int l = 0; l <= degree; l += stride)
            for (int i = 0; i < KI_TAPS; i++) {
                b[i] += density[l] * now[i];
                double next = twice[i] * now[i] - before[i];
                before[i] = now[i];
                now[i] = next;
            }
        for (int i = 0; i < KI_TAPS; i++)
            b[i] /= total;
        b[KI_TAPS] = 1;
        solve(a, b);
        double sum = 0;
        for (int i = 0; i < KI_TAPS; i++)
            sum += b[i];
        // The interpolation weights for the fraction 1 - t of the way between two grid points are
        // the weights for the fraction t in reverse order.
        for (int i = 0; i < KI_TAPS; i++)
            taps[(KI_TAP_STEPS - n) * KI_TAPS + KI_TAPS - 1 - i] = b[i] / sum;
        for (int i = 0; i < KI_TAPS; i++)
            taps[n * KI_TAPS + i] = b[i] / sum;
    }
}

// density[l] is the product of two models, of an environment's power at degree l and of a GGX
// lobe's squared Legendre coefficient.
// The power of each coefficient a_lm of a photographed environment is about proportional to 1 /
// l^2. The sum over the 2 l + 1 orders m of a degree is then about proportional to 1 / l. 1 / (l +
// 1) takes its place, which is finite at l = 0. Constant factors do not matter to ki_taps_design.
// The lobe's coefficient is about exp(-2 alpha l). For the narrowest lobe that `degree` can
// represent, alpha is such that the coefficient of the last degree is exp(-10.4).
void ki_model_density(int degree, double *density)
{
    for (int l = 0; l <= degree; l++)
        density[l] = ki_exp(-2 * 10.4 * l / degree) / (l + 1);
}

void ki_taps_at(const double *taps, double fraction, double weights[KI_TAPS])
{
    double at = fraction * KI_TAP_STEPS;
    int step = at < KI_TAP_STEPS ? (int)at : KI_TAP_STEPS - 1;
    double t = at - step;
    const double *a = taps + (size_t)step * KI_TAPS, *b = a + KI_TAPS;
    for (int i = 0; i < KI_TAPS; i++)
        weights[i] = a[i] + t * (b[i] - a[i]);
}
