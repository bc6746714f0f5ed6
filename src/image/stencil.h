// How much of each panorama texel lies in each texel of a cube or an octahedron, exactly.
//
// Both shapes have texels bounded by great circles, and both look the same after quarter turns and
// mirrorings. So stencils are computed for one patch of the sphere (a grid) and laid onto the map
// several times (places).
#ifndef KI_STENCIL_H
#define KI_STENCIL_H

#include "image/image.h"

/// A box of panorama texels and their weights, which add up to 1. The weights stand row after row,
/// each row filled up with zeros to `blocks` * 4 columns.
typedef struct ki_stencil {
    int32_t column; ///< first column, counted from the grid's own first direction; may be negative
    int32_t row;    ///< first row
    uint16_t blocks, rows;
    float area; ///< solid angle of the texel
} ki_stencil;

/// The stencils of some rows of a grid, in the order of the rows.
typedef struct ki_stencil_chunk {
    ki_stencil *stencils;
    float *weights;
    size_t stencil_count, weight_count; ///< in use
    size_t weight_room;                 ///< allocated
    int first_row, end_row;             ///< of the panorama, of all stencils
    bool failed;                        ///< no memory
} ki_stencil_chunk;

/// Where a grid lies on the map: texel (i, j) is the map's texel base + i across + j down.
typedef struct ki_stencil_place {
    ptrdiff_t base, across, down;
    int column;        ///< to be added to a stencil's columns, modulo the width
    int mirror_column; ///< with mirror: column c of a stencil becomes mirror_column - c
    bool mirror;       ///< left and right
    bool flip;         ///< up and down: row r becomes height - 1 - r
} ki_stencil_place;

typedef enum ki_stencil_kind {
    KI_STENCIL_SIDE,       ///< i to the east, j upwards from the horizon on a side of the cube
    KI_STENCIL_TOP,        ///< i along the first direction, j along the second, on the cube's +Y
    KI_STENCIL_OCTAHEDRON, ///< the same on an octahedron, above the horizon
    KI_STENCIL_RIM,        ///< the octahedron's texels that the horizon cuts in two
} ki_stencil_kind;

enum { KI_STENCIL_ROWS = 8, KI_STENCIL_PLACES = 16 };

typedef struct ki_stencil_grid {
    ki_stencil_kind kind;
    int half;      ///< texels from the middle of the map to its border
    int height;    ///< rows of the panorama; it has twice as many columns
    double offset; ///< where the grid's first direction lies in column 0, 0 to 1
    bool halved;   ///< only the half that mirroring does not give
    int place_count;
    ki_stencil_place place[KI_STENCIL_PLACES];
    int chunk_count; ///< KI_STENCIL_ROWS rows each
    ki_stencil_chunk *chunks;
} ki_stencil_grid;

/// Rows of the grid, and the texels first <= i < end of row j.
int ki_stencil_grid_rows(const ki_stencil_grid *grid);
void ki_stencil_grid_range(const ki_stencil_grid *grid, int j, int *first, int *end);

/// Computes all stencils of a grid whose other fields are set.
kiln_result ki_stencil_grid_build(kiln_context *context, ki_stencil_grid *grid, kiln_error *error);
void ki_stencil_grid_free(ki_stencil_grid *grid);

#endif
