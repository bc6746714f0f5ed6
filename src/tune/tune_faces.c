// The planes of tune_faces.h. The rims are found once, by asking for the texel of the cube that is
// nearest to each texel of a rim.
#include "tune/tune_faces.h"

#include "image/image.h"

#include <math.h>
#include <string.h>

static size_t texel_index(const ki_faces *f, int x, int y)
{
    return (size_t)(y + 1) * (size_t)f->width + (size_t)(x + 1);
}

// Calls `use` for every texel of the rims of all faces, with the face that owns what the texel
// repeats.
static void visit_rims(const ki_faces *f, void (*use)(void *data, int owner, ki_rim_texel texel),
                       void *data)
{
    int n = f->size;
    size_t face_texels = (size_t)n * (size_t)n;
    for (int face = 0; face < 6; face++)
        for (int y = -1; y <= n; y++)
            for (int x = -1; x <= n; x += y < 0 || y == n ? 1 : n + 1) {
                size_t of = ki_cube_texel(n, face, x, y), inside = of % face_texels;
                int owner_x = (int)(inside % (size_t)n), owner_y = (int)(inside / (size_t)n);
                use(data, (int)(of / face_texels),
                    (ki_rim_texel){(uint32_t)texel_index(f, x, y), (uint32_t)face,
                                   (uint32_t)texel_index(f, owner_x, owner_y)});
            }
}

static void count_texel(void *data, int owner, ki_rim_texel texel)
{
    ki_faces *f = data;
    (void)texel;
    f->start[owner + 1]++;
}

typedef struct filling {
    ki_faces *faces;
    size_t next[6];
} filling;

static void fill_texel(void *data, int owner, ki_rim_texel texel)
{
    filling *a = data;
    a->faces->rim[a->next[owner]++] = texel;
}

kiln_result ki_faces_create(kiln_context *context, int size, ki_faces *f, kiln_error *error)
{
    size_t width = (size_t)size + 2, count = 6 * (4 * (size_t)size + 4);
    *f = (ki_faces){.context = context,
                    .size = size,
                    .width = size + 2,
                    .plane = width * width,
                    .guard = (width + 1 + 15) / 16 * 16};
    f->stride = f->guard + (f->plane + 15) / 16 * 16;
    f->rim = ki_alloc_raw(context, count, sizeof *f->rim);
    if (!f->rim) {
        *f = (ki_faces){0};
        return ki_fail_memory(context, error, "a cube's edges", count * sizeof *f->rim);
    }
    visit_rims(f, count_texel, f);
    filling a = {.faces = f};
    for (int face = 0; face < 6; face++) {
        f->start[face + 1] += f->start[face];
        a.next[face] = f->start[face];
    }
    visit_rims(f, fill_texel, &a);
    return KILN_OK;
}

void ki_faces_destroy(ki_faces *f)
{
    ki_free(f->rim);
    *f = (ki_faces){0};
}

size_t ki_faces_count(const ki_faces *f)
{
    return KI_PLANES * f->stride + f->guard;
}

double *ki_faces_plane(const ki_faces *f, double *planes, int plane)
{
    return planes + f->guard + (size_t)plane * f->stride;
}

void ki_faces_fill_rims(const ki_faces *f, double *planes, int plane)
{
    const double *from = ki_faces_plane(f, planes, plane);
    for (size_t i = f->start[plane / 3]; i < f->start[plane / 3 + 1]; i++) {
        const ki_rim_texel *rim = &f->rim[i];
        ki_faces_plane(f, planes, 3 * (int)rim->face + plane % 3)[rim->at] = from[rim->owner];
    }
}

void ki_faces_add_rims(const ki_faces *f, double *planes, int plane)
{
    double *to = ki_faces_plane(f, planes, plane);
    for (size_t i = f->start[plane / 3]; i < f->start[plane / 3 + 1]; i++) {
        const ki_rim_texel *rim = &f->rim[i];
        to[rim->owner] += ki_faces_plane(f, planes, 3 * (int)rim->face + plane % 3)[rim->at];
    }
}

void ki_faces_load(const ki_faces *f, const float *texels, double *planes)
{
    for (int plane = 0; plane < KI_PLANES; plane++) {
        double *to = ki_faces_plane(f, planes, plane);
        size_t n = (size_t)f->size;
        for (int y = 0; y < f->size; y++) {
            const float *from = texels + 3 * n * (n * (size_t)(plane / 3) + (size_t)y) + plane % 3;
            double *row = to + texel_index(f, 0, y);
            for (size_t x = 0; x < n; x++)
                row[x] = (double)from[3 * x];
        }
    }
    for (int plane = 0; plane < KI_PLANES; plane++)
        ki_faces_fill_rims(f, planes, plane);
}

void ki_face_taps_set(const ki_faces *f, int edge, ki_face_tap *taps)
{
    for (int i = 0; i < edge; i++) {
        double at = (i + 0.5) * f->size / edge - 0.5, before = floor(at);
        double share = at - before;
        taps[i] = (ki_face_tap){(int)before + 1, {1 - share, share}};
    }
}

void ki_faces_read_row(const ki_faces *f, const double *plane, int edge, const ki_face_tap *taps,
                       int y, double factor, double *line, float *to)
{
    const double *above = plane + (size_t)taps[y].first * (size_t)f->width;
    const double *below = above + f->width;
    double a = factor * taps[y].share[0], b = factor * taps[y].share[1];
    for (int x = 0; x < f->width; x++)
        line[x] = a * above[x] + b * below[x];
    for (ptrdiff_t x = 0; x < edge; x++) {
        const double *at = line + taps[x].first;
        to[3 * x] += (float)(taps[x].share[0] * at[0] + taps[x].share[1] * at[1]);
    }
}
