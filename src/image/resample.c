// Resampling of maps by area. In: the texels of a panorama, cube or octahedron. Out: the texels of
// another such map, each the mean of the source over the texel's solid angle. The method depends on
// the two shapes:
//
//   panorama -> cube, octahedron   exact: each texel sums its stencil (stencil.h)
//   cube, octahedron -> panorama   exact: each texel distributes its light by its stencil
//   panorama -> panorama           exact: separable in rows and columns
//   cube -> cube                   exact for quarter turns: rectangles on faces
//   other cubes and octahedra      16 x 16 or more samples in each texel, weighted by solid angle;
//                                  exact for the same size and quarter turns
//
// Exact means up to rounding of weights and sums to float. A plan holds everything that depends on
// shapes, sizes and rotation.
#include "image/resample_method.h"

#include "image/image.h"

#include <math.h>

static kiln_result check_numbers(kiln_shape shape, int size, const char *which, kiln_error *error)
{
    if ((int)shape < KILN_SHAPE_PANORAMA || shape > KILN_SHAPE_OCTAHEDRON)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s shape is %d, it must be %d to %d", which,
                       (int)shape, KILN_SHAPE_PANORAMA, KILN_SHAPE_OCTAHEDRON);
    if (size < 1 || size > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s size is %d, it must be 1 to %d", which, size,
                       KILN_MAX_SIZE);
    return KILN_OK;
}

kiln_result ki_resample_plan_create(kiln_context *context, kiln_shape source_shape, int source_size,
                                    kiln_shape shape, int size, const ki_tilt *tilt,
                                    double rotation, ki_resample_plan **plan, kiln_error *error)
{
    *plan = NULL;
    if (check_numbers(source_shape, source_size, "source", error) ||
        check_numbers(shape, size, "target", error))
        return KILN_ERROR_ARGUMENT;
    if (!isfinite(rotation))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "rotation is %g degrees, it must be finite",
                       rotation);
    ki_resample_plan *p = ki_alloc(context, 1, sizeof *p);
    if (!p)
        return ki_fail_memory(context, error, "resampling", sizeof *p);
    p->source_shape = source_shape;
    p->shape = shape;
    p->source_size = source_size;
    p->size = size;
    p->rotation = rotation;
    if (tilt)
        p->tilt = *tilt;

    kiln_result result = KILN_OK;
    bool quarter = fmod(rotation, 90) == 0 && (!p->tilt.any || p->tilt.quarter);
    bool cubes = source_shape == KILN_SHAPE_CUBE && shape == KILN_SHAPE_CUBE;
    if (p->tilt.any && !(cubes && quarter)) {
        p->method = KI_RESAMPLE_SUBSAMPLE;
        result = ki_resample_plan_subsample(context, p, error);
    } else if (source_shape == KILN_SHAPE_PANORAMA && shape == KILN_SHAPE_PANORAMA) {
        p->method = KI_RESAMPLE_SEPARABLE;
        result = ki_resample_plan_separable(context, p, error);
    } else if (source_shape == KILN_SHAPE_PANORAMA) {
        p->method = KI_RESAMPLE_GATHER;
        result = ki_resample_plan_stencils(context, p, shape, size, source_size, rotation, error);
        if (!result && p->factor > 1)
            result = ki_resample_plan_fine(context, p, error);
    } else if (shape == KILN_SHAPE_PANORAMA) {
        p->method = KI_RESAMPLE_SCATTER;
        result = ki_resample_plan_stencils(context, p, source_shape, source_size, size, -rotation,
                                           error);
        p->band_rows = ki_max(1, (size + 4 * KI_RESAMPLE_BANDS - 1) / (4 * KI_RESAMPLE_BANDS));
    } else if (shape == KILN_SHAPE_CUBE && source_shape == shape && source_size != size &&
               quarter) {
        p->method = KI_RESAMPLE_FACES;
    } else {
        p->method = KI_RESAMPLE_SUBSAMPLE;
        result = ki_resample_plan_subsample(context, p, error);
        if (source_shape == shape && source_size == size && quarter)
            p->sub = 1;
    }
    if (result)
        ki_resample_plan_destroy(p);
    else
        *plan = p;
    return result;
}

// Sets *bytes to the size of the buffer that an execution of the plan needs. The method gather
// stores a finer map there before it is averaged, the method scatter bands of the panorama's rows.
// Returns false if the size overflows.
static bool buffer_bytes(const ki_resample_plan *plan, size_t *bytes)
{
    size_t size = (size_t)plan->size, faces = plan->shape == KILN_SHAPE_CUBE ? 6 : 1, texels;
    *bytes = 0;
    if (plan->method == KI_RESAMPLE_SCATTER)
        *bytes = KI_RESAMPLE_BANDS * (size_t)plan->band_rows * 6 * size * sizeof(double);
    if (plan->method != KI_RESAMPLE_GATHER || plan->factor == 1)
        return true;
    size_t fine = size * (size_t)plan->factor;
    return ki_mul_size(fine, fine, &texels) &&
           ki_mul_size(texels, 3 * faces * sizeof(float), bytes);
}

kiln_result ki_resample_reserve(kiln_context *context, const ki_resample_plan *plan,
                                ki_buffer *buffer, kiln_error *error)
{
    size_t bytes;
    bool fits = buffer_bytes(plan, &bytes);
    if (fits && ki_buffer_reserve(context, buffer, bytes, 1))
        return KILN_OK;
    return ki_fail_memory(context, error, "resampling", fits ? bytes : SIZE_MAX);
}

// Returns the number of tasks of the method gather: chunks of stencils.
static int count_chunks(const ki_resample_plan *plan)
{
    int count = 0;
    for (int k = 0; k < plan->grid_count; k++)
        count += plan->grid[k].chunk_count;
    return count;
}

// Returns the number of rows of the target, those of all faces.
static int count_rows(const ki_resample_plan *plan)
{
    return plan->size * (plan->shape == KILN_SHAPE_CUBE ? 6 : 1);
}

// Computes each texel of a cube or octahedron from the panorama texels under it: directly, or on a
// map with `factor` times as many texels along a side, whose texels are then averaged.
static bool gather(kiln_context *context, ki_resample_run *r, int rows,
                   const ki_progress_range *range)
{
    if (!ki_parallel_steps(context, range, count_chunks(r->plan), ki_resample_gather, r))
        return false;
    if (r->fine != r->target)
        ki_parallel_for(context, rows, ki_resample_coarsen, r);
    return true;
}

static bool scatter(kiln_context *context, ki_resample_run *r)
{
    for (; r->first_band * r->plan->band_rows < r->plan->size; r->first_band += KI_RESAMPLE_BANDS)
        if (!ki_parallel_steps(context, NULL, KI_RESAMPLE_BANDS, ki_resample_scatter, r))
            return false;
    return true;
}

bool ki_resample_execute(kiln_context *context, const ki_resample_plan *plan, ki_buffer *buffer,
                         const float *source, float *target, const ki_progress_range *range)
{
    ki_resample_run r = {.plan = plan, .source = source, .target = target};
    int rows = count_rows(plan);
    switch (plan->method) {
    case KI_RESAMPLE_GATHER:
        r.fine = plan->factor > 1 ? buffer->memory : target;
        return gather(context, &r, rows, range);
    case KI_RESAMPLE_SCATTER:
        r.bands = buffer->memory;
        return scatter(context, &r);
    case KI_RESAMPLE_SEPARABLE:
        return ki_parallel_steps(context, range, rows, ki_resample_separable, &r);
    case KI_RESAMPLE_FACES:
        return ki_parallel_steps(context, range, rows, ki_resample_faces, &r);
    default:
        return ki_parallel_steps(context, range, rows, ki_resample_subsample, &r);
    }
}

bool ki_resample_has_bands(const ki_resample_plan *plan)
{
    return plan->method == KI_RESAMPLE_GATHER || plan->method == KI_RESAMPLE_SEPARABLE;
}

kiln_result ki_resample_plan_bands(kiln_context *context, ki_resample_plan *plan, kiln_error *error)
{
    kiln_result result = KILN_OK;
    bool gathers = plan->method == KI_RESAMPLE_GATHER;
    for (int k = 0; gathers && k < plan->grid_count && result == KILN_OK; k++)
        result = ki_stencil_grid_order(context, &plan->grid[k], error);
    return result;
}

int ki_resample_reach(const ki_resample_plan *plan)
{
    int most = 1;
    if (plan->method == KI_RESAMPLE_GATHER)
        return ki_resample_gather_reach(plan);
    for (int y = 0; y < plan->size; y++)
        most = ki_max(most, plan->rows[y].count);
    return most;
}

bool ki_resample_band(kiln_context *context, const ki_resample_plan *plan, ki_buffer *buffer,
                      const ki_rows rows[2], int from, int to, float *target)
{
    bool gathers = plan->method == KI_RESAMPLE_GATHER;
    ki_resample_run r = {.plan = plan,
                         .target = target,
                         .fine = gathers && plan->factor > 1 ? buffer->memory : target,
                         .rows = {rows[0], rows[1]},
                         .from = from,
                         .to = to};
    return gathers ? ki_parallel_steps(context, NULL, count_chunks(plan), ki_resample_gather, &r)
                   : ki_parallel_steps(context, NULL, plan->size, ki_resample_separable, &r);
}

void ki_resample_end_bands(kiln_context *context, const ki_resample_plan *plan, ki_buffer *buffer,
                           float *target)
{
    ki_resample_run r = {.plan = plan, .target = target, .fine = buffer->memory};
    if (plan->method == KI_RESAMPLE_GATHER && plan->factor > 1)
        ki_parallel_for(context, count_rows(plan), ki_resample_coarsen, &r);
}

void ki_resample_plan_destroy(ki_resample_plan *plan)
{
    if (!plan)
        return;
    if (plan->method == KI_RESAMPLE_GATHER || plan->method == KI_RESAMPLE_SCATTER) {
        for (int k = 0; k < plan->grid_count; k++)
            ki_stencil_grid_free(&plan->grid[k]);
        ki_free(plan->fine_area);
    } else if (plan->method == KI_RESAMPLE_SEPARABLE) {
        ki_free(plan->columns);
        ki_free(plan->weights);
    } else if (plan->method == KI_RESAMPLE_SUBSAMPLE) {
        ki_free(plan->sine);
    }
    ki_free(plan);
}

kiln_result ki_map_resample(kiln_context *context, const kiln_map *source, double rotation,
                            kiln_map *target, int level, kiln_error *error)
{
    if (ki_map_check(source, error) || ki_map_check(target, error))
        return KILN_ERROR_ARGUMENT;
    if (level < 0 || level >= target->level_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "level is %d, it must be 0 to %d", level,
                       target->level_count - 1);
    ki_resample_plan *plan;
    ki_buffer buffer = {0};
    kiln_result result =
        ki_resample_plan_create(context, source->shape, source->size, target->shape,
                                kiln_map_level_size(target, level), NULL, rotation, &plan, error);
    if (result || !plan)
        return result;
    static const ki_progress_range range = {"converting", 0, 1};
    result = ki_resample_reserve(context, plan, &buffer, error);
    if (!result && !ki_resample_execute(context, plan, &buffer, source->level[0],
                                        target->level[level], &range))
        result = ki_fail_cancelled(error, range.name);
    ki_buffer_free(&buffer);
    ki_resample_plan_destroy(plan);
    return result;
}

kiln_result kiln_map_convert(kiln_context *context, const kiln_map *source, kiln_shape shape,
                             int size, double rotation, kiln_map *map, kiln_error *error)
{
    kiln_map made = {.shape = shape, .size = size, .level_count = 1};
    kiln_result result = ki_map_check(source, error);
    if (result)
        goto done;
    result = ki_map_allocate(context, &made, error);
    if (result)
        goto done;
    result = ki_map_resample(context, source, rotation, &made, 0, error);
done:
    if (result)
        kiln_map_free(&made);
    *map = made;
    return result;
}
