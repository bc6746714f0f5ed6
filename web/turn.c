// turn_map. In: a map and angles. Out: a panorama. Method: for 4 x 4 points of each texel of the
// turned panorama, the turns are undone one after the other, and the source's texel is read in the
// direction that results.
#include "turn.h"

#include <math.h>

enum { POINTS = 4 };

static const double pi = 3.14159265358979323846;

typedef struct turn {
    double sin_pitch, cos_pitch, sin_roll, cos_roll;
    kiln_up up;
} turn;

// Replaces a direction of the turned map by the source's direction that is shown there.
static void undo(const turn *t, double d[3])
{
    // Pitch turns about +X: what is ahead, at -Z, moves up.
    double y = d[1] * t->cos_pitch + d[2] * t->sin_pitch;
    double z = d[2] * t->cos_pitch - d[1] * t->sin_pitch;
    // Roll turns about -Z: what is above moves to the right.
    double x = d[0] * t->cos_roll - y * t->sin_roll;
    y = d[0] * t->sin_roll + y * t->cos_roll;
    d[0] = x;
    d[1] = t->up == KILN_UP_Y ? y : t->up == KILN_UP_Z ? -z : z;
    d[2] = t->up == KILN_UP_Y ? z : t->up == KILN_UP_Z ? y : -y;
}

static const float *texel_of(const kiln_map *panorama, const double d[3])
{
    int rows = panorama->size, columns = 2 * rows;
    int x = (int)((0.5 + atan2(d[0], -d[2]) / (2 * pi)) * columns);
    int y = (int)(atan2(sqrt(d[0] * d[0] + d[2] * d[2]), d[1]) / pi * rows);
    x = x < 0 ? 0 : x >= columns ? columns - 1 : x;
    y = y < 0 ? 0 : y >= rows ? rows - 1 : y;
    return panorama->level[0] + 3 * ((size_t)y * (size_t)columns + (size_t)x);
}

static void turn_row(const turn *t, const kiln_map *panorama, int y, kiln_map *turned)
{
    int rows = turned->size, columns = 2 * rows;
    float *out = turned->level[0] + 6 * (size_t)y * (size_t)rows;
    for (int x = 0; x < columns; x++, out += 3) {
        double sum[3] = {0, 0, 0};
        for (int i = 0; i < POINTS * POINTS; i++) {
            double theta = pi * (y + (i / POINTS + 0.5) / POINTS) / rows;
            double phi = 2 * pi * ((x + (i % POINTS + 0.5) / POINTS) / columns - 0.5);
            double d[3] = {sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)};
            undo(t, d);
            const float *rgb = texel_of(panorama, d);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)rgb[c];
        }
        for (int c = 0; c < 3; c++)
            out[c] = (float)(sum[c] / (POINTS * POINTS));
    }
}

kiln_result turn_map(kiln_context *context, const kiln_map *source, double pitch, double roll,
                     kiln_up up, kiln_map *turned, kiln_error *error)
{
    kiln_map panorama = {0};
    bool convert = source->shape != KILN_SHAPE_PANORAMA;
    int rows = convert ? 2 * source->size : source->size;
    const turn t = {sin(pitch * pi / 180), cos(pitch * pi / 180), sin(roll * pi / 180),
                    cos(roll * pi / 180), up};
    kiln_result result = kiln_map_create(context, KILN_SHAPE_PANORAMA, rows, 1, turned, error);
    if (result == KILN_OK && convert)
        result = kiln_map_convert(context, source, KILN_SHAPE_PANORAMA, rows, 0, &panorama, error);
    for (int y = 0; y < rows && result == KILN_OK; y++)
        turn_row(&t, convert ? &panorama : source, y, turned);
    if (result != KILN_OK)
        kiln_map_free(turned);
    kiln_map_free(&panorama);
    return result;
}
