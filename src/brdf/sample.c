// Directions with the densities that the reflection model asks for.
#include "brdf/brdf.h"

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

// tan^2 theta = -alpha^2 log(1 - xi).
void ki_beckmann_half_vector(double alpha, const double xi[2], double h[3])
{
    double tangent = alpha * sqrt(-ki_log(1 - xi[1])), sin_phi, cos_phi;
    ki_sincos(2 * KI_PI * xi[0], &sin_phi, &cos_phi);
    h[2] = 1 / sqrt(1 + tangent * tangent);
    h[0] = h[2] * tangent * cos_phi;
    h[1] = h[2] * tangent * sin_phi;
}

// Stretched by alpha along x and y, GGX's microsurface is a hemisphere; the normals of it that v sees
// are spread evenly over the cap z > -v.z of directions c, as c + v. Dupuy and Benyoub 2023.
//
// With c.z = 1 - xi (1 + v.z) neither 1 - c.z^2 nor (c + v).z = (1 - xi) (1 + v.z) cancels. v may
// look from below (a ray that goes up inside the microsurface): then 1 + v.z = sin^2 / (1 - v.z).
void ki_sample_visible(double alpha, const double v[3], const double xi[2], double h[3])
{
    double x = alpha * v[0], y = alpha * v[1], z = v[2];
    double flat = x * x + y * y, length = sqrt(flat + z * z);
    double one = z >= 0 ? 1 + z / length : flat / (length * (length - z)); // 1 + v.z, stretched
    double t = xi[1] * one, sine = sqrt(t * (2 - t)), sin_phi, cos_phi;
    ki_sincos(2 * KI_PI * xi[0], &sin_phi, &cos_phi);
    h[0] = alpha * (sine * cos_phi + x / length);
    h[1] = alpha * (sine * sin_phi + y / length);
    h[2] = (1 - xi[1]) * one;
    length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int c = 0; c < 3; c++)
        h[c] /= length;
}
