// Makes a map from pixels in the caller's memory. Values are converted to floats, placed on the
// sphere and mended in the same way as the texels of files.
#include "codec/layout.h"
#include "image/mend.h"
#include "image/pack.h"

#include <stdlib.h>
#include <string.h>

static kiln_result check_pixels(const kiln_pixels *p, size_t *row_bytes, kiln_error *error)
{
    if (!p->data)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the pixels' data is NULL");
    if (p->channels != 3 && p->channels != 4)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "pixels have %d channels, they must have 3 or 4",
                       p->channels);
    if ((unsigned)p->type > KILN_PIXEL_HALF)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the pixels' type is %d, it must be 0 or %d",
                       (int)p->type, (int)KILN_PIXEL_HALF);
    if ((unsigned)p->layout > KILN_LAYOUT_BALL)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "layout is %d, it must be 0 to %d",
                       (int)p->layout, (int)KILN_LAYOUT_BALL);
    if ((unsigned)p->negative > KILN_NEGATIVE_ZERO)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "negative is %d, it must be 0 or %d",
                       (int)p->negative, (int)KILN_NEGATIVE_ZERO);
    size_t sample = p->type == KILN_PIXEL_HALF ? 2 : 4;
    if (p->width < 0 || !ki_mul_size((size_t)p->width, sample * (size_t)p->channels, row_bytes))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the width is %d pixels, it must be positive and small enough for memory",
                       p->width);
    // Negated as an unsigned number, because -PTRDIFF_MIN does not exist.
    size_t stride = p->row_stride < 0 ? 0 - (size_t)p->row_stride : (size_t)p->row_stride;
    if (stride && stride < *row_bytes)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "row_stride is %td bytes, it must be 0 or at least a row's %zu bytes",
                       p->row_stride, *row_bytes);
    return KILN_OK;
}

typedef struct convert_job {
    const kiln_pixels *pixels;
    ptrdiff_t stride;
    float *rgb;
} convert_job;

// Task of one thread: converts one row of the caller's pixels to floats.
static void convert_row(void *data, int row)
{
    enum { STRETCH = 64 };
    const convert_job *job = data;
    const kiln_pixels *p = job->pixels;
    int channels = p->channels;
    size_t sample = p->type == KILN_PIXEL_HALF ? 2 : 4;
    const uint8_t *from = (const uint8_t *)p->data + (ptrdiff_t)row * job->stride;
    float *to = job->rgb + 3 * (size_t)row * (size_t)p->width;
    for (int x = 0; x < p->width; x += STRETCH) {
        float values[4 * STRETCH];
        int n = ki_min(STRETCH, p->width - x);
        const uint8_t *here = from + (size_t)x * (size_t)channels * sample;
        size_t count = (size_t)n * (size_t)channels;
        if (p->type == KILN_PIXEL_HALF)
            ki_floats_from_half_bytes(here, count, values);
        else
            memcpy(values, here, count * sizeof *values);
        for (int i = 0; i < n; i++)
            memcpy(to + 3 * (size_t)(x + i), values + (size_t)(channels * i), 3 * sizeof *to);
    }
}

kiln_result kiln_map_from_pixels(kiln_context *context, const kiln_pixels *pixels, kiln_map *map,
                                 kiln_error *error)
{
    size_t row_bytes;
    kiln_image image = {.width = pixels->width, .height = pixels->height, .channels = 3};
    kiln_load_report unused = {0}, *report = pixels->report ? pixels->report : &unused;
    *map = (kiln_map){0};
    *report = (kiln_load_report){0};
    kiln_result result = check_pixels(pixels, &row_bytes, error);
    if (result == KILN_OK)
        result = ki_image_allocate(context, &image, error);
    if (result != KILN_OK)
        return result;
    convert_job job = {pixels, pixels->row_stride ? pixels->row_stride : (ptrdiff_t)row_bytes,
                       image.pixels};
    if (!ki_parallel_steps(context, NULL, pixels->height, convert_row, &job))
        result = ki_fail_cancelled(error, "reading");
    if (result == KILN_OK)
        result = ki_lay_out(context, &image, "pixels", pixels->layout, map, report, error);
    if (result == KILN_OK)
        result = ki_map_mend(context, "pixels", pixels->negative, map, report, error);
    if (result != KILN_OK) {
        kiln_map_free(map);
        *report = (kiln_load_report){0};
    }
    if (result == KILN_ERROR_FORMAT && error)
        error->result = result = KILN_ERROR_ARGUMENT;
    kiln_image_free(&image);
    return result == KILN_ERROR_FORMAT ? KILN_ERROR_ARGUMENT : result;
}
