// The integrals over the reflection model as the caller sees them: arguments are clamped.
#include "brdf/energy.h"
#include "brdf/dielectric.h"
#include "brdf/sheen.h"

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

// The others clamp their own.

double kiln_sheen_albedo(kiln_sheen sheen, double roughness, double nov)
{
    return ki_sheen_albedo(sheen, roughness, nov);
}

void kiln_glass(const kiln_model *model, double roughness, double ior, double nov, double rt[2])
{
    ki_dielectric(model, roughness, ior, nov, rt);
}

void kiln_glass_average(const kiln_model *model, double roughness, double ior, double rt[2])
{
    ki_dielectric_average(model, roughness, ior, rt);
}
