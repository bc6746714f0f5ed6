// Maps two uniform numbers xi to directions with the densities of the reflection model.
#include "brdf/brdf.h"

#include "brdf/arguments.h"
#include "math/math.h"

#include <math.h>

void ki_sample_cosine(const double xi[2], double l[3])
{
    double sine = sqrt(xi[1]), sin_phi, cos_phi;
    ki_sincos(2 * KI_PI * xi[0], &sin_phi, &cos_phi);
    l[0] = sine * cos_phi;
    l[1] = sine * sin_phi;
    l[2] = sqrt(1 - xi[1]);
}

// The half vector's angle theta to the normal has tan^2 theta = -alpha^2 log(1 - xi[1]).
void ki_beckmann_half_vector(double alpha, const double xi[2], double h[3])
{
    double tangent = alpha * sqrt(-ki_log(1 - xi[1])), sin_phi, cos_phi;
    ki_sincos(2 * KI_PI * xi[0], &sin_phi, &cos_phi);
    h[2] = 1 / sqrt(1 + tangent * tangent);
    h[0] = h[2] * tangent * cos_phi;
    h[1] = h[2] * tangent * sin_phi;
}

// By spherical caps (Dupuy and Benyoub 2023). Multiplying the x and y of directions by alpha turns
// GGX's microsurface into a hemisphere. v, stretched like this and mirrored at a visible normal of
// that hemisphere, becomes a direction c that is uniform over the cap c.z > -v.z. The code
// therefore draws c and takes h along c + v.
//
// c.z = 1 - x (1 + v.z) with x = xi[1], therefore (c + v).z = (1 - x) (1 + v.z): neither that nor 1
// - c.z^2 is a difference that cancels. v may point below the surface, where it belongs to a ray
// that goes up inside the microsurface; then 1 + v.z is computed as (v.x^2 + v.y^2) / (1 - v.z).
void ki_sample_visible(double alpha, const double v[3], const double xi[2], double h[3])
{
    double x = alpha * v[0], y = alpha * v[1], z = v[2];
    double flat = x * x + y * y, length = sqrt(flat + z * z);
    // 1 + z, where z is the component of the stretched unit vector v along the normal
    double one = z >= 0 ? 1 + z / length : flat / (length * (length - z));
    double t = xi[1] * one, sine = sqrt(t * (2 - t)), sin_phi, cos_phi;
    ki_sincos(2 * KI_PI * xi[0], &sin_phi, &cos_phi);
    h[0] = alpha * (sine * cos_phi + x / length);
    h[1] = alpha * (sine * sin_phi + y / length);
    h[2] = (1 - xi[1]) * one;
    length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int c = 0; c < 3; c++)
        h[c] /= length;
}

// Clamps xi to [0, 1), because random number generators for floats may round up to 1.
static const double *clamp_xi(const double xi[2], double clamped[2])
{
    for (int i = 0; i < 2; i++)
        clamped[i] = ki_clamp(xi[i], 0, 1 - 0x1p-53);
    return clamped;
}

void kiln_sample_cosine(const double xi[2], double l[3])
{
    double x[2];
    ki_sample_cosine(clamp_xi(xi, x), l);
}

double kiln_pdf_cosine(double nol)
{
    return ki_unit(nol) / KI_PI;
}

void kiln_sample_half_vector(kiln_d d, double roughness, const double xi[2], double h[3])
{
    double r = ki_roughness(roughness), x[2];
    if (d == KILN_D_GGX)
        ki_ggx_half_vector(r * r, clamp_xi(xi, x), h);
    else
        ki_beckmann_half_vector(r * r, clamp_xi(xi, x), h);
}

double kiln_pdf_half_vector(kiln_d d, double roughness, double noh)
{
    double c = ki_unit(noh);
    return c > 0 ? c * ki_brdf_d(d, ki_roughness(roughness), c) : 0;
}

void kiln_sample_visible(double roughness, const double v[3], const double xi[2], double h[3])
{
    double r = ki_roughness(roughness), x[2];
    h[0] = h[1] = 0;
    h[2] = 1; // the half vector of a mirror is the normal
    if (r > 0)
        ki_sample_visible(r * r, v, clamp_xi(xi, x), h);
}

double kiln_pdf_visible(double roughness, double nov, double noh, double voh)
{
    double r = ki_roughness(roughness), d = ki_brdf_d(KILN_D_GGX, r, ki_unit(noh)),
           c = ki_unit(voh);
    if (!(d > 0 && d < HUGE_VAL && c > 0))
        return c > 0 ? d : 0;
    return d * ki_smith_g1_over_cosine(r * r, ki_cosine(nov)) * c;
}

double kiln_pdf_reflection(double pdf, double voh)
{
    return voh > 0 && pdf > 0 ? pdf / (4 * ki_clamp(voh, 0, 1)) : 0;
}
