// The integrals beside the main ones as the caller sees them.
#include "brdf/dielectric.h"
#include "brdf/sheen.h"

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
