// The integrals beside the main ones as the caller sees them.
#include "brdf/sheen.h"

double kiln_sheen_albedo(kiln_sheen sheen, double roughness, double nov)
{
    return ki_sheen_albedo(sheen, roughness, nov);
}
