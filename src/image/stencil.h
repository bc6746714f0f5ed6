// How much of each texel of a panorama lies in each texel of a cube or an octahedron, exactly.
//
// The texels of both shapes are bounded by great circles, and both shapes are symmetric under
// quarter turns and mirrorings. Stencils are therefore computed only for one patch of the sphere (a
// grid) and used at several places of the map.
#ifndef KI_STENCIL_H
#define KI_STENCIL_H

#include "image/image.h"

/// A box of panorama texels with weights whose sum is 1. The weights are stored row by row, and
/// each row is padded with zeros to `blocks` * 4 columns.
typedef struct ki_stencil {
    int32_t column; ///< first column, counted from the grid's first direction; may be negative
    int32_t row;    ///< first row of the panorama
    uint16_t blocks, rows;
    float area; ///< solid angle of the map's texel
} ki_stencil;

/// The stencils of some rows of a grid, in the order of the rows.
typedef struct ki_stencil_chunk {
    ki_stencil *stencils;
    float *weights;
    size_t stencil_count, weight_count; ///< numbers of stencils and weights that are in use
    size_t weight_room;                 ///< number of weights that are allocated
    /// Range of panorama rows that all stencils of the chunk cover.
    int first_row, end_row;
    bool failed; ///< true: memory ran out
} ki_stencil_chunk;

/// Where a grid lies on the map: texel (i, j) of the grid is texel base + i * across + j * down of
/// the map.
typedef struct ki_stencil_place {
    ptrdiff_t base, across, down;
    int column;        ///< added to a stencil's columns, modulo the width of the panorama
    int mirror_column; ///< if `mirror` is set, column c of a stencil becomes mirror_column - c
    bool mirror;       ///< true: left and right are swapped
    bool flip;         ///< true: up and down are swapped, row r becomes height - 1 - r
} ki_stencil_place;

typedef enum ki_stencil_kind {
    KI_STENCIL_SIDE, ///< a side of the cube: i runs to the east, j upwards from the horizon
    /// The cube's +Y face: i runs along the first direction, j along the second direction.
    KI_STENCIL_TOP,
    /// The part of an octahedron above the horizon: i runs along the first direction, j along the
    /// second direction.
    KI_STENCIL_OCTAHEDRON,
    KI_STENCIL_RIM, ///< the texels of the octahedron that the horizon cuts in two
} ki_stencil_kind;

enum { KI_STENCIL_ROWS = 8, KI_STENCIL_PLACES = 16 };

typedef struct ki_stencil_grid {
    ki_stencil_kind kind;
    int half;      ///< number of texels from the middle of the map to its border
    int height;    ///< rows of the panorama, which has twice as many columns
    double offset; ///< position of the grid's first direction within column 0, 0 to 1
    bool halved;   ///< true: only half of the grid is computed, and mirroring gives the other half
    int place_count;
    ki_stencil_place place[KI_STENCIL_PLACES];
    int chunk_count; ///< number of chunks, of KI_STENCIL_ROWS rows each
    ki_stencil_chunk *chunks;
} ki_stencil_grid;

/// Return the number of rows of the grid, and the range first <= i < end of the texels in row j.
int ki_stencil_grid_rows(const ki_stencil_grid *grid);
void ki_stencil_grid_range(const ki_stencil_grid *grid, int j, int *first, int *end);

/// Computes all stencils of a grid whose other fields are set.
kiln_result ki_stencil_grid_build(kiln_context *context, ki_stencil_grid *grid, kiln_error *error);
void ki_stencil_grid_free(ki_stencil_grid *grid);

#endif
