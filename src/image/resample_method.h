// A plan for resampling by area, and the methods that execute the plan. Shared by resample.c, which
// chooses the method, resample_stencil.c (the methods gather and scatter) and resample_texel.c (the
// methods that compute the target texel by texel).
#ifndef KI_RESAMPLE_METHOD_H
#define KI_RESAMPLE_METHOD_H

#include "image/resample.h"
#include "image/stencil.h"

#include <math.h>

enum {
    KI_RESAMPLE_GRIDS = 8,
    KI_RESAMPLE_BANDS = 8 ///< row bands to which threads distribute light at the same time
};

typedef enum ki_resample_method {
    /// from a panorama to a cube or octahedron: sums the texels under each stencil
    KI_RESAMPLE_GATHER,
    /// from a cube or octahedron to a panorama: adds each texel to the texels under its stencil
    KI_RESAMPLE_SCATTER,
    KI_RESAMPLE_SEPARABLE, ///< from a panorama to a panorama: separable weights of columns and rows
    /// from a cube to a cube of another size, turned by quarter turns: rectangles on faces
    KI_RESAMPLE_FACES,
    KI_RESAMPLE_SUBSAMPLE ///< all other conversions, by samples within each texel
} ki_resample_method;

/// The range of source columns or rows that a target column or row overlaps.
typedef struct ki_resample_span {
    int first, count;
    size_t weight; // index in `weights` of the weight of the first column or row
} ki_resample_span;

struct ki_resample_plan {
    kiln_shape source_shape, shape;
    int source_size, size;
    double rotation;

    // `method` decides which member of the union is in use.
    ki_resample_method method;
    union {
        struct
        // gather and scatter: the cube or octahedron is computed `factor` times finer than its size
        {
            ki_stencil_grid grid[KI_RESAMPLE_GRIDS];
            int grid_count;
            int factor;
            // gather only: solid angles of the texels of the finer map's first face
            float *fine_area;
            int band_rows; // scatter only: number of rows of a band
        };
        struct { // separable
            ki_resample_span *columns, *rows;
            float *weights;
        };
        int sub; // subsample: number of points along a texel's side
    };
};

/// The data of one execution, which all its tasks share.
typedef struct ki_resample_run {
    const ki_resample_plan *plan;
    const float *source;
    float *target;
    float *fine;    ///< gather: texels of the finer map, or `target` if factor is 1
    double *bands;  ///< scatter: sums of KI_RESAMPLE_BANDS bands of rows of a panorama
    int first_band; ///< scatter: index of the first of these bands
} ki_resample_run;

// Wraps a column into the range 0 .. width - 1, without a division. The column must not be far
// outside the range.
static inline int wrap(int column, int width)
{
    while (column < 0)
        column += width;
    while (column >= width)
        column -= width;
    return column;
}

/// Returns whether a number is whole, up to rounding.
static inline bool ki_is_whole(double x)
{
    return fabs(x - floor(x + 0.5)) < 1e-9;
}

/// Sets grids and factor for resampling between a cube or octahedron of size n and a panorama of
/// `height` rows.
kiln_result ki_resample_plan_stencils(kiln_context *context, ki_resample_plan *plan,
                                      kiln_shape shape, int n, int height, double rotation,
                                      kiln_error *error);
/// Computes the solid angles of the texels of a gather's finer map.
kiln_result ki_resample_plan_fine(kiln_context *context, ki_resample_plan *plan, kiln_error *error);
/// Sets the columns, rows and weights of a separable resampling.
kiln_result ki_resample_plan_separable(kiln_context *context, ki_resample_plan *plan,
                                       kiln_error *error);

// The tasks of threads; `data` is a ki_resample_run.

/// Gathers the texels of one chunk of stencils; `index` counts the chunks of all grids.
void ki_resample_gather(void *data, int index);
/// Averages `factor` rows of the finer map to row `index` of the target.
void ki_resample_coarsen(void *data, int index);
/// Computes band first_band + index of a panorama.
void ki_resample_scatter(void *data, int index);
/// Compute row `index` of the target; the rows of all faces are counted one face after the other.
void ki_resample_separable(void *data, int index);
void ki_resample_faces(void *data, int index);
void ki_resample_subsample(void *data, int index);

#endif
