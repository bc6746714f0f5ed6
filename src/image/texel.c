// Single texels of level 0 of a map. In: a map and the index of a texel, or a direction. Out: nodes
// within the texel, its solid angle, the texels that touch it. Method: all shapes map a rectangle
// of (u, v) to the sphere; the solid angle is the integral of the map's Jacobian determinant.
#include "image/texel.h"

#include "math/math.h"

#include <math.h>

// Sets the direction of the point (x, y) in texels, where y counts the rows of all faces and `face`
// is the face of a cube. Returns the solid angle per area of a texel at this point.
static double point(const kiln_map *map, int face, double x, double y, double direction[3])
{
    double n = map->size, length;
    double *d = direction;
    if (map->shape == KILN_SHAPE_PANORAMA) {
        double step = KI_PI / n;
        ki_panorama_direction(x / (2 * n), y / n, d);
        return step * step * ki_sin(y * step);
    }
    if (map->shape == KILN_SHAPE_CUBE) {
        ki_face_direction(face, 2 * x / n - 1, 2 * (y / n - face) - 1, d);
        length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int c = 0; c < 3; c++)
            d[c] /= length;
    } else {
        // The unit direction is the point of |x| + |y| + |z| = 1 divided by its length.
        ki_octahedron_direction(x / n, y / n, d);
        length = 1 / (fabs(d[0]) + fabs(d[1]) + fabs(d[2]));
    }
    // A surface element du dv of a cube's face or of the octahedron's unfolded plane, whose sides
    // are 2 long, has the solid angle du dv / length^3, where `length` is its distance from the
    // centre before it is scaled to the unit sphere. A texel has du = dv = 2 / n.
    return 4 / (n * n * length * length * length);
}

void ki_texel_nodes_find(const kiln_map *map, size_t index, int side, ki_texel_nodes *nodes)
{
    static const double two[2] = {0.21132486540518711775, 0.78867513459481288225};
    static const double four[4] = {0.06943184420297371239, 0.33000947820757186760,
                                   0.66999052179242813240, 0.93056815579702628761};
    static const double half[2] = {0.5, 0.5};
    static const double parts[4] = {0.17392742256872692869, 0.32607257743127307131,
                                    0.32607257743127307131, 0.17392742256872692869};
    const double *at = side == 2 ? two : four, *part = side == 2 ? half : parts;
    size_t width = (size_t)map->size * (map->shape == KILN_SHAPE_PANORAMA ? 2 : 1);
    size_t row = index / width;
    double x = (double)(index % width), y = (double)row;
    int face = map->shape == KILN_SHAPE_CUBE ? (int)row / map->size : 0;
    nodes->count = side * side;
    for (int i = 0; i < nodes->count; i++)
        nodes->weight[i] =
            part[i % side] * part[i / side] *
            point(map, face, x + at[i % side], y + at[i / side], nodes->direction[i]);
}

double ki_texel_solid_angle(const kiln_map *map, size_t index)
{
    if (map->shape == KILN_SHAPE_PANORAMA) {
        size_t row = index / (2 * (size_t)map->size);
        double step = KI_PI / map->size;
        return 2 * step * ki_sin(((double)row + 0.5) * step) * ki_sin(step / 2);
    }
    ki_texel_nodes nodes;
    ki_texel_nodes_find(map, index, 2, &nodes);
    return (nodes.weight[0] + nodes.weight[1]) + (nodes.weight[2] + nodes.weight[3]);
}

size_t ki_texel_of_direction(const kiln_map *map, const double direction[3])
{
    double u, v, n = map->size;
    int face = 0;
    double width = map->shape == KILN_SHAPE_PANORAMA ? 2 * n : n;
    if (map->shape == KILN_SHAPE_PANORAMA) {
        ki_direction_panorama(direction, &u, &v);
    } else if (map->shape == KILN_SHAPE_OCTAHEDRON) {
        ki_direction_octahedron(direction, &u, &v);
    } else {
        face = ki_direction_face(direction, &u, &v);
        u = (u + 1) / 2;
        v = (v + 1) / 2;
    }
    size_t x = (size_t)ki_clamp(floor(u * width), 0, width - 1);
    size_t y = (size_t)ki_clamp(floor(v * n), 0, n - 1);
    return ((size_t)face * (size_t)map->size + y) * (size_t)width + x;
}

// Returns the texel (x, y) of a panorama, one texel beyond its edges at most: behind the seam lies
// the other end of the row, behind a pole the other side of the same row.
static size_t panorama_texel(int n, int x, int y)
{
    if (y < 0 || y >= n) {
        y = y < 0 ? 0 : n - 1;
        x += n;
    }
    return (size_t)y * (size_t)(2 * n) + (size_t)((x + 2 * n) % (2 * n));
}

// Returns the texel (x, y) of an octahedron, one texel beyond its edges at most. Each edge is
// folded in its middle, so that its two halves touch.
static size_t octahedron_texel(int n, int x, int y)
{
    if (x < 0 || x >= n) {
        x = x < 0 ? 0 : n - 1;
        y = n - 1 - y;
    }
    if (y < 0 || y >= n) {
        y = y < 0 ? 0 : n - 1;
        x = n - 1 - x;
    }
    return (size_t)y * (size_t)n + (size_t)x;
}

void ki_texel_neighbors(const kiln_map *map, size_t index, size_t neighbors[4])
{
    static const int step[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    int n = map->size;
    size_t width = (size_t)n * (map->shape == KILN_SHAPE_PANORAMA ? 2 : 1);
    int row = (int)(index / width), x = (int)(index % width);
    for (int i = 0; i < 4; i++) {
        int at = x + step[i][0], y = row % n + step[i][1];
        if (map->shape == KILN_SHAPE_PANORAMA)
            neighbors[i] = panorama_texel(n, at, y);
        else if (map->shape == KILN_SHAPE_OCTAHEDRON)
            neighbors[i] = octahedron_texel(n, at, y);
        else
            neighbors[i] = ki_cube_texel(n, row / n, at, y);
    }
}
