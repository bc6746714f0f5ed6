// The albedo E of the specular lobe, and A and B of the split sum (albedo = F0 A + B), for given
// cosines of the view. This file chooses the kernel: for GGX the fastest that the processor runs,
// compiled from energy.inl, and for Beckmann ki_beckmann_energy. It also integrates E to its
// average E_avg under diffuse light. docs/theory/energy.md.
#include "brdf/energy.h"

#include "base/vector.h"
#include "brdf/arguments.h"
#include "brdf/beckmann.h"
#include "math/math.h"

#include <math.h>

// The kernel (the inner loop that computes a row of albedos E or of A and B of the split sum) for
// calls that have no context. It uses only instructions that every processor of the compiled
// architecture has.
#if defined(KILN_HAVE_SIMD128)
#define BASELINE ki_energy_row_simd128
#else
#define BASELINE ki_energy_row_scalar
#endif

static void beckmann_row(const kiln_model *model, double roughness, const double *nov, int count,
                         bool split, double *out)
{
    for (int i = 0; i < count; i++) {
        double ab[2];
        ki_beckmann_energy(model, roughness, nov[i], ab);
        if (split) {
            *out++ = ab[0];
            *out++ = ab[1];
        } else {
            *out++ = ab[0] + ab[1];
        }
    }
}

static ki_energy_row *row_of(const kiln_model *model, ki_energy_row *ggx)
{
    return model->d == KILN_D_BECKMANN ? beckmann_row : ggx;
}

void ki_energy_values(const kiln_context *context, const kiln_model *model, double roughness,
                      const double *nov, int count, bool split, double *out)
{
    row_of(model, KI_FASTEST(context, ki_energy_row))(model, roughness, nov, count, split, out);
}

double ki_energy(const kiln_model *model, double roughness, double nov)
{
    double e;
    row_of(model, BASELINE)(model, roughness, &nov, 1, false, &e);
    return e;
}

void ki_energy_split(const kiln_model *model, double roughness, double nov, double ab[2])
{
    row_of(model, BASELINE)(model, roughness, &nov, 1, true, ab);
}

// The average of the albedo E under diffuse light, 2 int_0^1 E(mu) mu dmu, by composite
// Gauss-Legendre quadrature over u, where mu = c (e^u - 1) and c = alpha / 50. E changes fast at
// grazing angles, mu < alpha, and with correlated masking behaves as mu log(mu) near 0. The range
// mu < alpha has the length log 51 in u at every roughness, so that enough nodes lie there.
double ki_energy_average(const kiln_model *model, double roughness)
{
    enum { NODES = 16 };
    double node[NODES], weight[NODES], nov[NODES], e[NODES], sum = 0;
    double alpha = roughness * roughness;
    double c = (alpha < 1e-12 ? 1e-12 : alpha) / 50, length = ki_log(1 + 1 / c);
    int count = (int)ceil(length / 2);
    double h = length / (2 * count);
    ki_gauss_legendre(NODES, node, weight);
    for (int i = 0; i < count; i++) {
        double rise[NODES];
        for (int j = 0; j < NODES; j++) {
            rise[j] = ki_exp(h * (2 * i + 1 + node[j]));
            nov[j] = ki_clamp(c * (rise[j] - 1), 0, 1);
        }
        row_of(model, BASELINE)(model, roughness, nov, NODES, false, e);
        for (int j = 0; j < NODES; j++)
            sum += 2 * weight[j] * h * c * rise[j] * nov[j] * e[j];
    }
    return sum;
}

double kiln_energy(const kiln_model *model, double roughness, double nov)
{
    return ki_energy(model, ki_clamp(roughness, 0, 1), ki_clamp(nov, 0, 1));
}

double kiln_energy_average(const kiln_model *model, double roughness)
{
    return ki_energy_average(model, ki_clamp(roughness, 0, 1));
}

void kiln_energy_split(const kiln_model *model, double roughness, double nov, double ab[2])
{
    ki_energy_split(model, ki_clamp(roughness, 0, 1), ki_clamp(nov, 0, 1), ab);
}
