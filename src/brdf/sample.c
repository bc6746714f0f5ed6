// Maps two uniform numbers xi to directions with the densities of the reflection model.
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
// GGX's microsurface into a hemisphere. The stretched v mirrored by a visible normal of that
// hemisphere is a direction c, and c is uniform over the cap c.z > -v.z. So the code draws c and
// takes h along c + v.
//
// c.z = 1 - xi (1 + v.z) with xi = xi[1], therefore (c + v).z = (1 - xi) (1 + v.z): neither that
// nor 1 - c.z^2 is a difference that cancels. v may point below the surface, where it belongs to a
// ray that goes up inside the microsurface; then 1 + v.z is computed as (v.x^2 + v.y^2) / (1 -
// v.z).
void ki_sample_visible(double alpha, const double v[3], const double xi[2], double h[3])
{
    double x = alpha * v[0], y = alpha * v[1], z = v[2];
    double flat = x * x + y * y, length = sqrt(flat + z * z);
    double one = z >= 0 ? 1 + z / length : flat / (length * (length - z)); // 1 + v.z of the
                                                                           // stretched v
    double t = xi[1] * one, sine = sqrt(t * (2 - t)), sin_phi, cos_phi;
    ki_sincos(2 * KI_PI * xi[0], &sin_phi, &cos_phi);
    h[0] = alpha * (sine * cos_phi + x / length);
    h[1] = alpha * (sine * sin_phi + y / length);
    h[2] = (1 - xi[1]) * one;
    length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int c = 0; c < 3; c++)
        h[c] /= length;
}
