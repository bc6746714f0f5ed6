// The environment maps that EXR files declare by the attribute "envmap". In: a picture with texels
// where OpenEXR has them. Out: a panorama, or a strip of six cube faces, with texels where kiln has
// them.
//
// OpenEXR (ImfEnvmap.h) puts the outer texels of a picture onto its border: with n texels across,
// texel i lies at i / (n - 1), where kiln has (i + 0.5) / n. The first and last columns of a
// panorama show the same direction, and the texels along the edge of a cube face belong to the
// neighbouring face as well. The texels are therefore interpolated bilinearly at kiln's texel
// centres. OpenEXR's centre of a panorama looks along +Z with -X to its right; kiln's looks along
// -Z with +X to its right. A direction (x, y, z) of kiln is (-x, y, -z) in OpenEXR, which shows
// both panoramas alike.
#include "codec/exr.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

typedef struct job {
    const kiln_image *from;
    int size; // number of texels along a side of a cube face, or 0 for a panorama
    float *to;
} job;

// Reads a picture bilinearly within a window of `width` * `height` texels from line `top` on, at
// (x, y) in texels, where the first texel of the window lies at (0, 0).
static void read_at(const kiln_image *image, int top, int width, int height, double x, double y,
                    float rgb[3])
{
    int x0 = ki_min((int)x, ki_max(width - 2, 0)), y0 = ki_min((int)y, ki_max(height - 2, 0));
    const double u = x - x0, v = y - y0;
    const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    double sum[3] = {0};
    for (int i = 0; i < 4; i++) {
        if (weights[i] == 0) // a texel of weight 0 may lie outside of the window or be infinite
            continue;
        const float *texel =
            image->pixels +
            3 * ((size_t)(top + y0 + i / 2) * (size_t)image->width + (size_t)(x0 + i % 2));
        for (int c = 0; c < 3; c++)
            sum[c] += weights[i] * (double)texel[c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)sum[c];
}

// Returns OpenEXR's face (+X -X +Y -Y +Z -Z) of a direction in OpenEXR's axes, and sets the column
// and row within the face, in 0 to 1 from its upper left corner.
static int place_on_cube(const double d[3], double *column, double *row)
{
    double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
    if (x >= y && x >= z) {
        *column = d[0] > 0 ? d[2] / x : -d[2] / x;
        *row = -d[1] / x;
    } else if (y >= z) {
        *column = d[0] / y;
        *row = d[1] > 0 ? -d[2] / y : d[2] / y;
    } else {
        *column = d[2] > 0 ? -d[0] / z : d[0] / z;
        *row = -d[1] / z;
    }
    *column = (*column + 1) / 2;
    *row = (*row + 1) / 2;
    return x >= y && x >= z ? (d[0] < 0) : y >= z ? 2 + (d[1] < 0) : 4 + (d[2] < 0);
}

// Task of one thread: computes one row of kiln's strip of faces.
static void make_cube_row(void *data, int row)
{
    const job *j = data;
    int n = j->size;
    double t = (2 * (row % n) + 1.0) / n - 1;
    for (int x = 0; x < n; x++) {
        double d[3], column, line;
        ki_face_direction(row / n, (2 * x + 1.0) / n - 1, t, d);
        const double turned[3] = {-d[0], d[1], -d[2]};
        int face = place_on_cube(turned, &column, &line);
        read_at(j->from, face * n, n, n, column * (n - 1), line * (n - 1),
                j->to + 3 * ((size_t)row * (size_t)n + (size_t)x));
    }
}

// Task of one thread: computes one row of kiln's panorama.
static void make_panorama_row(void *data, int row)
{
    const job *j = data;
    int width = j->from->width, height = j->from->height;
    double y = (row + 0.5) / height * (height - 1);
    for (int x = 0; x < width; x++)
        read_at(j->from, 0, width, height, (x + 0.5) / width * (width - 1), y,
                j->to + 3 * ((size_t)row * (size_t)width + (size_t)x));
}

kiln_result ki_exr_place_envmap(kiln_context *context, kiln_image *image, bool cube,
                                const char *name, kiln_error *error)
{
    job j = {image, cube ? image->width : 0, NULL};
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    if (cube && (int64_t)image->height != 6 * (int64_t)image->width)
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "%s: is %d x %d pixels, the cube that its attribute envmap states must be N x "
            "6 N; --layout reads the picture without the attribute",
            name, image->width, image->height);
    j.to = ki_alloc_raw(context, count, sizeof *j.to);
    if (!j.to)
        return ki_fail_memory(context, error, name, count * sizeof *j.to);
    if (!ki_parallel_steps(context, NULL, image->height, cube ? make_cube_row : make_panorama_row,
                           &j)) {
        ki_free(j.to);
        return ki_fail_cancelled(error, "reading");
    }
    kiln_image placed = {image->width, image->height, image->channels, j.to, j.to};
    kiln_image_free(image);
    *image = placed;
    return KILN_OK;
}
