// A plan for resampling by area, and the methods that execute the plan. Shared by resample.c, which
// chooses the method, resample_stencil.c (the methods gather and scatter) and resample_texel.c (the
// methods that compute the target texel by texel).
#ifndef KI_RESAMPLE_METHOD_H
#define KI_RESAMPLE_METHOD_H

#include "image/resample.h"
#include "image/stencil.h"

#include <math.h>

enum {
    /// greatest number of grids of stencils: two kinds for each quarter of the map
    KI_RESAMPLE_GRIDS = 8,
    KI_RESAMPLE_BANDS = 8 ///< bands of panorama rows to which threads add light at the same time
};

typedef enum ki_resample_method {
    /// from a panorama to a cube or octahedron: sums the texels under each stencil
    KI_RESAMPLE_GATHER,
    /// from a cube or octahedron to a panorama: adds each texel to the texels under its stencil
    KI_RESAMPLE_SCATTER,
    /// from a panorama to a panorama: weights of columns times weights of rows
    KI_RESAMPLE_SEPARABLE,
    /// from a cube to a cube of another size, turned by quarter turns: rectangles on faces
    KI_RESAMPLE_FACES,
    KI_RESAMPLE_SUBSAMPLE ///< all other conversions, by samples within each texel
} ki_resample_method;

/// The range of source columns or rows that a target column or row overlaps.
typedef struct ki_resample_span {
    int first, count;
    size_t weight; // index of the first column's or row's weight in the plan's array `weights`
} ki_resample_span;

struct ki_resample_plan {
    kiln_shape source_shape, shape;
    int source_size, size;
    ki_tilt tilt;
    double rotation;

    // `method` decides which member of the union is in use.
    ki_resample_method method;
    union {
        struct
        // gather and scatter: the grids are stencils of a cube or octahedron that has `factor`
        // times as many texels along a face as the map that is read or written
        {
            ki_stencil_grid grid[KI_RESAMPLE_GRIDS];
            int grid_count;
            int factor;
            // gather only: solid angle of each texel of one face of that finer cube, or of that
            // finer octahedron
            float *fine_area;
            int band_rows; // scatter only: number of panorama rows that one task computes
        };
        struct { // separable: the columns and rows of the source that those of the target overlap
            ki_resample_span *columns, *rows;
            float *weights;
        };
        struct {
            int sub; // subsample: number of samples along a side of each target texel
            // If the source is a panorama: sine and cosine of the longitudes at which its columns
            // begin, and cosine of the angle from the north pole at which its rows begin. The last
            // of each is where the last column or row ends. `sine` owns the memory of the three.
            double *sine, *cosine, *edge;
        };
    };
};

/// The data of one execution, which all its tasks share.
typedef struct ki_resample_run {
    const ki_resample_plan *plan;
    const float *source; ///< all texels of the source; NULL in an execution by bands
    float *target;
    /// Execution by bands: the rows in memory from the north and from the south pole. The texels
    /// whose last row has a depth from `from` to `to` - 1 are computed, see ki_resample_band.
    ki_rows rows[2];
    int from, to;
    float *fine;    ///< gather: texels of the map before averaging; `target` if none is averaged
    double *bands;  ///< scatter: light of each texel of KI_RESAMPLE_BANDS bands of panorama rows
    int first_band; ///< scatter: index of the first of these bands, from the panorama's top
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

/// Sets the fields of gather and scatter: the grids of stencils, and the factor by which they are
/// finer than the map, for a cube or octahedron of size n and a panorama of `height` rows.
kiln_result ki_resample_plan_stencils(kiln_context *context, ki_resample_plan *plan,
                                      kiln_shape shape, int n, int height, double rotation,
                                      kiln_error *error);
/// Returns the greatest number of panorama rows that a stencil of the method gather covers.
int ki_resample_gather_reach(const ki_resample_plan *plan);
/// Returns where the rows first .. first + count - 1 of the source begin, or NULL if they belong to
/// another band of an execution by bands.
static inline const float *ki_resample_rows(const ki_resample_run *run, int first, int count)
{
    int size = run->plan->source_size;
    size_t line = 6 * (size_t)size;
    if (run->source)
        return run->source + line * (size_t)first;
    int depth = ki_stencil_depth(first, count, size);
    if (depth < run->from || depth >= run->to)
        return NULL;
    const ki_rows *rows = &run->rows[2 * first + count > size];
    return rows->rgb + line * (size_t)(first - rows->first);
}
/// Sets `fine_area`, the solid angles by which the method gather averages a finer map.
kiln_result ki_resample_plan_fine(kiln_context *context, ki_resample_plan *plan, kiln_error *error);
/// Sets the number of samples of the method subsample and, if the source is a panorama, the
/// directions of the edges of its texels.
kiln_result ki_resample_plan_subsample(kiln_context *context, ki_resample_plan *plan,
                                       kiln_error *error);
/// Sets the columns, rows and weights of a separable resampling.
kiln_result ki_resample_plan_separable(kiln_context *context, ki_resample_plan *plan,
                                       kiln_error *error);

// The tasks of ki_parallel_for; `data` is a ki_resample_run.

/// Gathers the texels of one chunk of stencils; `index` counts the chunks of all grids.
void ki_resample_gather(void *data, int index);
/// Averages `factor` rows of the finer map that gather has filled to row `index` of the target.
void ki_resample_coarsen(void *data, int index);
/// Computes one band of a panorama's rows, the band first_band + index, by the method scatter.
void ki_resample_scatter(void *data, int index);
/// Compute row `index` of the target by the method of the function's name. The rows of a cube's
/// faces are counted one face after the other.
void ki_resample_separable(void *data, int index);
void ki_resample_faces(void *data, int index);
void ki_resample_subsample(void *data, int index);

#endif
