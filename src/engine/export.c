// What the functions that write engines' files share: turning a cube and its harmonics to the axes
// of an engine, and adding files to a set.
#include "engine/engine.h"

#include "codec/codec.h"
#include "codec/zstd.h"
#include "math/math.h"
#include "sphere/sh.h"

#include <math.h>
#include <string.h>

static void turn(const ki_axes *axes, const double direction[3], double turned[3])
{
    for (int i = 0; i < 3; i++)
        turned[i] = axes->sign[i] * direction[axes->axis[i]];
}

// Returns the index, in a source level of size n, of the texel that comes to (x, y) of a face of
// the turned level.
static ptrdiff_t turned_texel(const ki_axes *axes, int n, int face, int x, int y)
{
    double at[3], from[3], s, t;
    ki_face_direction(face, (2 * x + 1.0) / n - 1, (2 * y + 1.0) / n - 1, at);
    turn(axes, at, from);
    int other = ki_direction_face(from, &s, &t);
    int column = (int)floor((s + 1) / 2 * n), row = (int)floor((t + 1) / 2 * n);
    return ((ptrdiff_t)other * n + row) * n + column;
}

// Turns one face of a level. The turn takes the rows and columns of a face to rows or columns of a
// face, so that the texels are found by steps of one length.
static void turn_face(const ki_axes *axes, int n, int face, const float *source, float *turned)
{
    ptrdiff_t first = turned_texel(axes, n, face, 0, 0), across = 0, down = 0;
    if (n > 1) {
        across = turned_texel(axes, n, face, 1, 0) - first;
        down = turned_texel(axes, n, face, 0, 1) - first;
    }
    float *to = turned + 3 * (size_t)face * (size_t)n * (size_t)n;
    for (int y = 0; y < n; y++) {
        const float *from = source + 3 * (first + y * down);
        for (int x = 0; x < n; x++, from += 3 * across, to += 3)
            memcpy(to, from, 3 * sizeof *to);
    }
}

void ki_turn_cube(const kiln_map *source, const ki_axes *axes, kiln_map *turned)
{
    for (int k = 0; k < source->level_count; k++) {
        turned->roughness[k] = source->roughness[k];
        for (int face = 0; face < 6; face++)
            turn_face(axes, kiln_map_level_size(source, k), face, source->level[k],
                      turned->level[k]);
    }
}

// Turns harmonics by evaluating the series in the turned directions and projecting the values onto
// the spherical harmonics again. The quadrature of 4 Gauss nodes in z times 8 longitudes integrates
// products of two harmonics of degree 2 exactly.
void ki_turn_sh(const kiln_sh *source, const ki_axes *axes, kiln_sh *turned)
{
    double nodes[4], weights[4];
    int count = source->bands * source->bands;
    ki_gauss_legendre(4, nodes, weights);
    *turned = *source;
    memset(turned->c, 0, sizeof turned->c);
    for (int i = 0; i < 32; i++) {
        double sine, cosine, from[3], value[3], basis[KILN_MAX_BANDS * KILN_MAX_BANDS];
        double z = nodes[i / 8], r = sqrt(1 - z * z);
        ki_sincos(i % 8 * (KI_PI / 4), &sine, &cosine);
        const double at[3] = {r * cosine, r * sine, z};
        turn(axes, at, from);
        kiln_sh_evaluate(source, from, value);
        ki_sh_basis(at, basis);
        for (int j = 0; j < count; j++)
            for (int c = 0; c < 3; c++)
                turned->c[j][c] += weights[i / 8] * (KI_PI / 4) * basis[j] * value[c];
    }
}

kiln_result ki_export_add(ki_export *to, const char *path, const ki_writer *bytes,
                          kiln_error *error)
{
    if (bytes->failed)
        return ki_fail_memory(to->context, error, path, bytes->size);
    to->file_count++;
    return ki_file_set_add(to->set, path, bytes->bytes, bytes->size, error);
}

int ki_export_zstd(const ki_export *to)
{
    enum { LEVEL = 19 };
    return to->format == KILN_FORMAT_UASTC && ki_zstd_known(to->path, NULL) == KILN_OK ? LEVEL : 0;
}

kiln_result ki_export_dds(ki_export *to, kiln_error *error)
{
    ki_writer bytes = {.context = to->context};
    kiln_save_def def = {.format = to->format};
    kiln_result result = ki_dds_encode(to->map, &def, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    return result;
}
