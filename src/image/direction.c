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

void ki_tilt_apply(const ki_tilt *tilt, double d[3])
{
    if (!tilt || !tilt->any)
        return;
    const double from[3] = {d[0], d[1], d[2]};
    for (int i = 0; i < 3; i++)
        d[i] = tilt->m[i][0] * from[0] + tilt->m[i][1] * from[1] + tilt->m[i][2] * from[2];
}

void ki_tilt_undo(const ki_tilt *tilt, double d[3])
{
    if (!tilt || !tilt->any)
        return;
    const double from[3] = {d[0], d[1], d[2]};
    for (int i = 0; i < 3; i++)
        d[i] = tilt->m[0][i] * from[0] + tilt->m[1][i] * from[1] + tilt->m[2][i] * from[2];
}

// Turns a direction back by yaw, pitch and roll, and then from y up to the axes of the source.
static void turn_back(double rotation, double pitch, double roll, kiln_up up, double d[3])
{
    double s, c, turned[3], x, y, z;
    ki_turn(d, fmod(rotation, 360), turned);
    ki_sincos(fmod(pitch, 360) * KI_PI / 180, &s, &c);
    y = turned[1] * c + turned[2] * s;
    z = turned[2] * c - turned[1] * s;
    ki_sincos(fmod(roll, 360) * KI_PI / 180, &s, &c);
    x = turned[0] * c - y * s;
    y = turned[0] * s + y * c;
    d[0] = x;
    d[1] = up == KILN_UP_Z ? -z : up == KILN_UP_MINUS_Z ? z : y;
    d[2] = up == KILN_UP_Z ? y : up == KILN_UP_MINUS_Z ? -y : z;
}

void ki_tilt_make(double rotation, double pitch, double roll, kiln_up up, ki_tilt *tilt)
{
    tilt->quarter = true;
    tilt->any = pitch != 0 || roll != 0 || up != KILN_UP_Y;
    for (int axis = 0; axis < 3; axis++) {
        double d[3] = {axis == 0, axis == 1, axis == 2};
        turn_back(rotation, pitch, roll, up, d);
        for (int i = 0; i < 3; i++) {
            // Sines and cosines of quarter turns differ from whole numbers by rounding.
            double whole = floor(d[i] + 0.5);
            bool is_whole = fabs(d[i] - whole) < 1e-14;
            tilt->m[i][axis] = is_whole ? whole : d[i];
            tilt->quarter = tilt->quarter && is_whole;
        }
    }
}
