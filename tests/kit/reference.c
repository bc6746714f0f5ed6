#include "reference.h"

#include "kit.h"

kiln_map scene_panorama(kiln_context *context, int size, uint32_t seed)
{
    kiln_map map = make_panorama(context, size);
    scene_fill(&map, seed);
    return map;
}

// The lobe's integral over the texel in column x between the cosines `top` and `bottom`, in n x n
// equal areas.
static double ggx_weight(double alpha, const double d[3], int n, double top, double bottom,
                         double x, double columns)
{
    double sum = 0, a2 = alpha * alpha;
    for (int j = 0; j < n; j++) {
        double z = top + (bottom - top) * (j + 0.5) / n, s = sqrt(1 - z * z);
        for (int i = 0; i < n; i++) {
            double phi = 2 * pi * (x + (i + 0.5) / n) / columns - pi;
            double c = d[0] * s * sin(phi) + d[1] * z - d[2] * s * cos(phi);
            double q = a2 + (1 - a2) * 0.5 * (1 - c);
            sum += c > 0 ? c * (a2 / q) * (a2 / q) : 0;
        }
    }
    return sum * (top - bottom);
}

double ggx_mean(const kiln_map *map, int columns, int rows, double alpha, const double d[3], int n)
{
    double sum = 0, all = 0;
    for (int y = 0; y < rows; y++) {
        double top = cos(pi * y / rows), bottom = cos(pi * (y + 1) / rows);
        for (int x = 0; x < columns; x++) {
            double weight = ggx_weight(alpha, d, n, top, bottom, x, columns);
            sum += weight * (double)texel_at(map, x, y)[0];
            all += weight;
        }
    }
    return sum / all;
}

scene_errors scene_compare(kiln_context *context, const kiln_map *panorama, const kiln_map *result,
                           int level, const kiln_lobe *lobe, double rotation, int count)
{
    size_t texels = kiln_map_texels(result, level);
    count = texels < (size_t)count ? (int)texels : count;
    double(*directions)[3] = malloc((size_t)count * sizeof *directions);
    double(*values)[3] = malloc((size_t)count * sizeof *values);
    size_t *index = malloc((size_t)count * sizeof *index);
    uint32_t seed = 7u + (uint32_t)level;
    for (int i = 0; i < count; i++) {
        index[i] =
            texels == (size_t)count ? (size_t)i : (size_t)(scene_random(&seed) * (double)texels);
        kiln_map_direction(result, level, index[i], directions[i]);
    }
    kiln_error error = {0};
    CHECK_OK(kiln_reference_filter(context, panorama, lobe, rotation,
                                   (const double(*)[3])directions, count, values, &error));
    double square = 0, whole = 0, most = 0;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            double off = (double)result->level[level][3 * index[i] + (size_t)c] - values[i][c];
            square += off * off;
            whole += values[i][c] * values[i][c];
            most = fmax(most, fabs(off) / values[i][c]);
        }
    free(directions);
    free(values);
    free(index);
    return (scene_errors){sqrt(square / whole), most};
}

double filtered_furnace_error(kiln_context *context, int size, int face, enum kiln_lobe_kind lobe)
{
    kiln_error error;
    kiln_map in = make_panorama(context, size), out;
    fill_constant(&in, 0.75f);
    kiln_prefilter_def def = {.size = face, .lobe = lobe};
    // At roughness 0 the lobes of Phong and Charlie are so narrow that they cost much and run no
    // other code.
    static const float roughness[] = {0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 1};
    if (lobe > KILN_LOBE_LAMBERT)
        def.roughness = roughness;
    CHECK_OK(kiln_prefilter(context, &in, &def, &out, &error));
    double most = 0;
    for (int l = 0; l < out.level_count; l++)
        for (size_t i = 0; i < 3 * kiln_map_texels(&out, l); i++)
            most = fmax(most, fabs((double)out.level[l][i] / 0.75 - 1));
    kiln_map_free(&in);
    kiln_map_free(&out);
    return most;
}
