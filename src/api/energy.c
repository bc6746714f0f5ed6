// Energy integrals as the caller sees them.
#include "brdf/energy.h"

// Into [0, 1]; not a number becomes 0.
static double unit(double x)
{
    return x > 0 ? x < 1 ? x : 1 : 0;
}

double kiln_energy(const kiln_model *model, double roughness, double nov)
{
    return ki_energy(model, unit(roughness), unit(nov));
}

double kiln_energy_average(const kiln_model *model, double roughness)
{
    return ki_energy_average(model, unit(roughness));
}

void kiln_energy_split(const kiln_model *model, double roughness, double nov, double ab[2])
{
    ki_energy_split(model, unit(roughness), unit(nov), ab);
}
