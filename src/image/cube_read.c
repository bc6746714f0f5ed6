// Reads a cube bilinearly, across the edges of its faces too, as graphics processors do.
#include "image/image.h"
#include "math/math.h"

#include <math.h>

size_t ki_cube_texel(int n, int face, int x, int y)
{
    if (x < 0 || y < 0 || x >= n || y >= n) {
        double direction[3], s, t;
        ki_face_direction(face, (2 * x + 1.0) / n - 1, (2 * y + 1.0) / n - 1, direction);
        face = ki_direction_face(direction, &s, &t);
        x = (int)ki_clamp(floor((s + 1) / 2 * n), 0, n - 1);
        y = (int)ki_clamp(floor((t + 1) / 2 * n), 0, n - 1);
    }
    return ((size_t)face * (size_t)n + (size_t)y) * (size_t)n + (size_t)x;
}

void ki_cube_taps(int size, const double direction[3], size_t texels[4], double weights[4])
{
    double s, t;
    int face = ki_direction_face(direction, &s, &t);
    double u = (s + 1) / 2 * size - 0.5, v = (t + 1) / 2 * size - 0.5;
    int x = (int)floor(u), y = (int)floor(v);
    u -= x;
    v -= y;
    for (int i = 0; i < 4; i++) {
        texels[i] = ki_cube_texel(size, face, x + i % 2, y + i / 2);
        weights[i] = (i % 2 ? u : 1 - u) * (i / 2 ? v : 1 - v);
    }
}

void ki_cube_read(const kiln_map *cube, int level, const double direction[3], double rgb[3])
{
    size_t texels[4];
    double w[4];
    ki_cube_taps(kiln_map_level_size(cube, level), direction, texels, w);
    for (int c = 0; c < 3; c++) {
        const float *from = cube->level[level] + c;
        rgb[c] = (w[0] * (double)from[3 * texels[0]] + w[1] * (double)from[3 * texels[1]]) +
                 (w[2] * (double)from[3 * texels[2]] + w[3] * (double)from[3 * texels[3]]);
    }
}
