// Integrates a function over half vectors in two dimensions, without the library's closed forms.
#ifndef KILN_TEST_HALF_H
#define KILN_TEST_HALF_H

#include "rule.h"

#include <stdbool.h>

// A half vector h: n.h, the sine of its angle to n, v.h, and n.l of the light l that h mirrors the
// view to.
typedef struct half {
    double noh, sin_h, voh, nol;
} half;

// Adds to sums[x_count] the integrals of the x_count values of f over all half vectors that mirror
// the view to above the horizon. For angles theta of h to n below half the view's elevation, the
// azimuth phi runs over the full circle; above that, up to where n.l = 0, at cos phi = -cot theta_v
// cot 2 theta. theta is cut there, and at `width`, the angle over which f changes first, times
// powers of STRETCH.
static void half_integrate(double nov, double width,
                           void (*f)(const void *user, const half *h, double *x), const void *user,
                           int x_count, double *sums)
{
    enum { STRETCH = 30, MAX_CUTS = 16 };
    double theta_v = acos(nov), sin_v = sin(theta_v), turn = (HALF_PI - theta_v) / 2;
    double end = (HALF_PI + theta_v) / 2, cuts[MAX_CUTS] = {0};
    int cut_count = 1;
    bool turned = !(turn > 0);
    for (double next = width; next < end && cut_count < MAX_CUTS - 2; next *= STRETCH) {
        if (!turned && turn <= next) {
            cuts[cut_count++] = turn;
            turned = true;
        }
        if (next > cuts[cut_count - 1])
            cuts[cut_count++] = next;
    }
    if (!turned)
        cuts[cut_count++] = turn;
    cuts[cut_count] = end;
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
                double x[8], weight = 2 * sine * theta_weight[i] * phi_weight[j];
                if (!(h.nol > 0) || !(h.voh > 0))
                    continue;
                f(user, &h, x);
                for (int k = 0; k < x_count; k++)
                    sums[k] += weight * x[k];
            }
        }
    }
}

#endif
