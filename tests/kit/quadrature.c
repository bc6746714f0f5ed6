#include "quadrature.h"

#include "check.h"
#include "math/math.h"

enum { GAUSS = 24, MAX_CUTS = 16 };

double integrate(double (*f)(void *data, double x), void *data, double from, double to, int panels)
{
    double node[GAUSS], weight[GAUSS], sum = 0, reach = (to - from) / panels / 2;
    ki_gauss_legendre(GAUSS, node, weight);
    for (int p = 0; p < panels; p++)
        for (int i = 0; i < GAUSS; i++)
            sum += weight[i] * reach * f(data, from + reach * (2 * p + 1 + node[i]));
    return sum;
}

void half_rule(double a, double b, double nodes[HALF_NODES], double weights[HALF_NODES])
{
    for (int i = 0; i < HALF_NODES; i++) {
        double h = 6.4 / (HALF_NODES - 1), t = -3.2 + i * h, u = HALF_PI * sinh(t);
        double from_end = (b - a) / (1 + exp(2 * fabs(u)));
        nodes[i] = t < 0 ? a + from_end : b - from_end;
        weights[i] = h * (b - a) / 2 * HALF_PI * cosh(t) / (cosh(u) * cosh(u));
    }
}

// The range of the half vector's angle theta to n, cut where the integrand changes its form: at
// half the view's elevation, and at `width` times powers of STRETCH. Returns the number of panels.
static int half_cuts(double theta_v, double width, double cuts[MAX_CUTS])
{
    enum { STRETCH = 30 };
    double turn = (HALF_PI - theta_v) / 2, end = (HALF_PI + theta_v) / 2;
    int count = 1;
    bool turned = !(turn > 0);
    cuts[0] = 0;
    for (double next = width; next < end && count < MAX_CUTS - 2; next *= STRETCH) {
        if (!turned && turn <= next) {
            cuts[count++] = turn;
            turned = true;
        }
        if (next > cuts[count - 1])
            cuts[count++] = next;
    }
    if (!turned)
        cuts[count++] = turn;
    cuts[count] = end;
    return count;
}

// For angles theta of h to n below half the view's elevation, the azimuth phi runs over the full
// circle; above that, up to where n.l = 0, at cos phi = -cot theta_v cot 2 theta.
void half_integrate(double nov, double width, void (*f)(const void *user, const half *h, double *x),
                    const void *user, int x_count, double *sums)
{
    double theta_v = acos(nov), sin_v = sin(theta_v), turn = (HALF_PI - theta_v) / 2;
    double cuts[MAX_CUTS];
    int cut_count = half_cuts(theta_v, width, cuts);
    for (int panel = 0; panel < cut_count; panel++) {
        double theta[HALF_NODES], theta_weight[HALF_NODES];
        half_rule(cuts[panel], cuts[panel + 1], theta, theta_weight);
        for (int i = 0; i < HALF_NODES; i++) {
            double cosine = cos(theta[i]), sine = sin(theta[i]), reach = 2 * HALF_PI;
            if (theta[i] > turn) {
                double least =
                    -nov / sin_v * (cosine - sine) * (cosine + sine) / (2 * sine * cosine);
                reach = acos(fmin(1, fmax(-1, least)));
            }
            double phi[HALF_NODES], phi_weight[HALF_NODES];
            half_rule(0, reach, phi, phi_weight);
            for (int j = 0; j < HALF_NODES; j++) {
                half h = {.noh = cosine, .sin_h = sine};
                h.voh = nov * cosine + sin_v * sine * cos(phi[j]);
                h.nol = 2 * h.voh * cosine - nov;
                double x[HALF_VALUES], weight = 2 * sine * theta_weight[i] * phi_weight[j];
                if (!(h.nol > 0) || !(h.voh > 0))
                    continue;
                f(user, &h, x);
                for (int k = 0; k < x_count; k++)
                    sums[k] += weight * x[k];
            }
        }
    }
}
