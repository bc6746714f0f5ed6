// The weights of the lobes that are powers, as inline functions for loops over arrays (power.inl).
#include "math/power.inl"

// Returns the weight of the Charlie lobe for exponent = 1 / (2 alpha). The weight is
// D(h) cos theta, where D is proportional to (sin theta_h)^(1 / alpha). The half vector h of N and
// the light has sin^2 theta_h = (1 - c) / 2 with c = cos theta. D is divided by its value at the
// horizon, where c = 0.
static inline double charlie_weight(double exponent, double one_minus_cos)
{
    double c = 1 - one_minus_cos, value = c * positive_power(one_minus_cos, exponent);
    return c > 0 ? value : 0;
}

// Returns the weight of the Phong lobe, cos theta to the power `exponent`.
static inline double phong_weight(double exponent, double one_minus_cos)
{
    double c = 1 - one_minus_cos, value = positive_power(c, exponent);
    return c > 0 ? value : 0;
}
