// Converts unit directions to points of cube faces, panoramas and octahedra, and such points back
// to directions.
#include "image/image.h"
#include "math/math.h"

#include <math.h>

const char *const ki_face_names[6] = {"px", "nx", "py", "ny", "pz", "nz"};

void ki_face_direction(int face, double s, double t, double direction[3])
{
    double *d = direction;
    switch (face) {
    case 0: // +X
        d[0] = 1, d[1] = -t, d[2] = -s;
        break;
    case 1: // -X
        d[0] = -1, d[1] = -t, d[2] = s;
        break;
    case 2: // +Y
        d[0] = s, d[1] = 1, d[2] = t;
        break;
    case 3: // -Y
        d[0] = s, d[1] = -1, d[2] = -t;
        break;
    case 4: // +Z
        d[0] = s, d[1] = -t, d[2] = 1;
        break;
    default: // -Z
        d[0] = -s, d[1] = -t, d[2] = -1;
        break;
    }
}

int ki_direction_face(const double direction[3], double *s, double *t)
{
    double x = direction[0], y = direction[1], z = direction[2];
    double ax = fabs(x), ay = fabs(y), az = fabs(z);
    if (ax >= ay && ax >= az && ax > 0) {
        *s = x > 0 ? -z / ax : z / ax;
        *t = -y / ax;
        return x > 0 ? 0 : 1;
    }
    if (ay >= az && ay > 0) {
        *s = x / ay;
        *t = y > 0 ? z / ay : -z / ay;
        return y > 0 ? 2 : 3;
    }
    if (az > 0) {
        *s = z > 0 ? x / az : -x / az;
        *t = -y / az;
        return z > 0 ? 4 : 5;
    }
    *s = *t = 0;
    return 0;
}

void ki_panorama_direction(double u, double v, double direction[3])
{
    double sin_theta, cos_theta, sin_phi, cos_phi;
    ki_sincos(KI_PI * v, &sin_theta, &cos_theta);
    ki_sincos(2 * KI_PI * (u - 0.5), &sin_phi, &cos_phi);
    direction[0] = sin_theta * sin_phi;
    direction[1] = cos_theta;
    direction[2] = -sin_theta * cos_phi;
}

void ki_direction_panorama(const double direction[3], double *u, double *v)
{
    double x = direction[0], y = direction[1], z = direction[2];
    *u = ki_clamp(0.5 + ki_atan2(x, -z) / (2 * KI_PI), 0, 1);
    *v = ki_clamp(ki_atan2(sqrt(x * x + z * z), y) / KI_PI, 0, 1);
}

// Maps a point of the map to the octahedron |x| + |y| + |z| = 1, seen from above. The upper half
// fills the inner diamond, with +X to the right and +Z downwards as on the cube's +Y face. The four
// lower sides are folded outwards, so that -Y is in every corner.
void ki_octahedron_direction(double u, double v, double direction[3])
{
    double x = 2 * u - 1, z = 2 * v - 1;
    double y = 1 - fabs(x) - fabs(z);
    if (y < 0) {
        double folded = copysign(1 - fabs(z), x);
        z = copysign(1 - fabs(x), z);
        x = folded;
    }
    double length = sqrt(x * x + y * y + z * z);
    direction[0] = x / length;
    direction[1] = y / length;
    direction[2] = z / length;
}

void ki_direction_octahedron(const double direction[3], double *u, double *v)
{
    double sum = fabs(direction[0]) + fabs(direction[1]) + fabs(direction[2]);
    double x = 0, z = 0;
    if (sum > 0) {
        x = direction[0] / sum;
        z = direction[2] / sum;
    }
    if (direction[1] < 0) {
        double folded = copysign(1 - fabs(z), x);
        z = copysign(1 - fabs(x), z);
        x = folded;
    }
    *u = ki_clamp(0.5 * x + 0.5, 0, 1);
    *v = ki_clamp(0.5 * z + 0.5, 0, 1);
}

// The angle of a panorama's column, with x = sin and z = -cos of that angle, grows by `degrees`.
// Quarter turns are exact.
void ki_turn(const double direction[3], double degrees, double turned[3])
{
    double turn = fmod(degrees, 360), sine, cosine;
    double quarter = floor(turn / 90);
    ki_sincos((turn - 90 * quarter) * (KI_PI / 180), &sine, &cosine);
    for (int k = (int)quarter & 3; k > 0; k--) {
        double swap = sine;
        sine = cosine;
        cosine = -swap;
    }
    double x = direction[0], z = direction[2];
    turned[0] = x * cosine - z * sine;
    turned[1] = direction[1];
    turned[2] = z * cosine + x * sine;
}
