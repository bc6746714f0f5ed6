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

void ki_turn_cube(const kiln_map *source, const ki_axes *axes, kiln_map *turned)
{
    for (int k = 0; k < source->level_count; k++) {
        int n = kiln_map_level_size(source, k);
        float *to = turned->level[k];
        turned->roughness[k] = source->roughness[k];
        for (int i = 0; i < 6 * n * n; i++, to += 3) {
            int face = i / (n * n), y = i / n % n, x = i % n;
            double at[3], from[3], s, t;
            ki_face_direction(face, (2 * x + 1.0) / n - 1, (2 * y + 1.0) / n - 1, at);
            turn(axes, at, from);
            int other = ki_direction_face(from, &s, &t);
            int column = (int)floor((s + 1) / 2 * n), row = (int)floor((t + 1) / 2 * n);
            size_t texel = ((size_t)other * (size_t)n + (size_t)row) * (size_t)n + (size_t)column;
            memcpy(to, source->level[k] + 3 * texel, 3 * sizeof *to);
        }
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
