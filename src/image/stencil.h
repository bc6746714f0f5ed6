// How much of each texel of a panorama lies in each texel of a cube or an octahedron, exactly.
//
// The texels of both shapes are bounded by great circles, and both shapes are symmetric under
// quarter turns and mirrorings. Stencils are therefore computed only for one patch of the sphere (a
// grid) and used at several places of the map. A grid belongs to one of the axes -Z, +X, +Z and -X,
// turned with the map: its first direction. The next of these axes, 90 degrees to the east, is its
// second direction.
#ifndef KI_STENCIL_H
#define KI_STENCIL_H

#include "image/image.h"

/// A box of panorama texels with weights whose sum is 1. The weights are stored row by row, and
/// each row is padded with zeros to `blocks` * 4 columns.
typedef struct ki_stencil {
    /// first column of the box, counted from the panorama column in which the axis of the stencil's
    /// grid lies; may be negative
    int32_t column;
    int32_t row; ///< first row of the box, counted from the panorama's top
    uint16_t blocks, rows;
    float area; ///< solid angle of the texel of the cube or octahedron
} ki_stencil;

/// Where a stencil of a chunk is, in the order of the stencils' depths.
typedef struct ki_stencil_entry {
    uint32_t index;  ///< index of the stencil among the chunk's stencils
    uint32_t blocks; ///< number of blocks of 4 weights before its weights
    int32_t i, j;    ///< the texel of the grid to which it belongs
} ki_stencil_entry;

/// The stencils of at most KI_STENCIL_ROWS rows of a grid, row by row.
typedef struct ki_stencil_chunk {
    ki_stencil *stencils;
    float *weights;
    /// all stencils, the least depth first (ki_stencil_depth); NULL before ki_stencil_grid_order
    ki_stencil_entry *by_depth;
    size_t stencil_count, weight_count; ///< numbers of stencils and weights that are in use
    size_t weight_room;                 ///< number of weights that are allocated
    /// Range of panorama rows that the stencils of the chunk cover together.
    int first_row, end_row;
    bool failed; ///< true: memory ran out
} ki_stencil_chunk;

/// A place where a grid of stencils is used on a cube or octahedron: texel (i, j) of the grid is
/// texel base + i * across + j * down of the map.
typedef struct ki_stencil_place {
    ptrdiff_t base, across, down;
    int column; ///< panorama column of the place's axis, added to a stencil's columns
    /// if `mirror` is set, a stencil's column c is the panorama's column mirror_column - c
    int mirror_column;
    bool mirror; ///< true: the stencils' columns are swapped left to right
    bool flip;   ///< true: the stencils' rows are swapped, row r becomes height - 1 - r
} ki_stencil_place;

typedef enum ki_stencil_kind {
    /// the upper half of a side of the cube: i runs to the east, j upwards from the horizon
    KI_STENCIL_SIDE,
    /// A quarter of the cube's +Y face: i runs from the pole towards one of the axes -Z, +X, +Z and
    /// -X, j towards the next of these axes to the east.
    KI_STENCIL_TOP,
    /// A quarter of the octahedron above the horizon, with i and j as for KI_STENCIL_TOP.
    KI_STENCIL_OCTAHEDRON,
    KI_STENCIL_RIM, ///< the texels of the octahedron that the horizon cuts in two
} ki_stencil_kind;

enum { KI_STENCIL_ROWS = 8, KI_STENCIL_PLACES = 16 };

typedef struct ki_stencil_grid {
    ki_stencil_kind kind;
    int half;   ///< number of texels from the middle of a face or octahedron to its border
    int height; ///< rows of the panorama, which has twice as many columns
    /// where the grid's axis lies between the left (0) and right (1) border of its panorama column
    double offset;
    bool halved; ///< true: only half of the grid is computed, and mirroring gives the other half
    int place_count;
    ki_stencil_place place[KI_STENCIL_PLACES];
    int chunk_count; ///< number of chunks, of KI_STENCIL_ROWS rows each
    ki_stencil_chunk *chunks;
} ki_stencil_grid;

/// Return the number of rows of a grid of stencils, and the range first <= i < end of the texels
/// (i, j) that the grid has in its row j.
int ki_stencil_grid_rows(const ki_stencil_grid *grid);
void ki_stencil_grid_range(const ki_stencil_grid *grid, int j, int *first, int *end);

/// Returns the depth of a box of panorama rows: how many rows must be read, beginning at a pole and
/// without the last one, until the box is complete. The pole is the one that is nearer to the
/// middle of the box. A box that is flipped, so that row r becomes row height - 1 - r, has the same
/// depth.
static inline int ki_stencil_depth(int row, int rows, int height)
{
    return 2 * row + rows > height ? height - 1 - row : row + rows - 1;
}

/// Computes the chunks of a grid, which hold all its stencils, from the fields `kind` to `halved`.
kiln_result ki_stencil_grid_build(kiln_context *context, ki_stencil_grid *grid, kiln_error *error);
/// Lists the stencils of each chunk by their depths.
kiln_result ki_stencil_grid_order(kiln_context *context, ki_stencil_grid *grid, kiln_error *error);
void ki_stencil_grid_free(ki_stencil_grid *grid);

#endif
