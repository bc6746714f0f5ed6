#include "lobe_sum.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void tabulate(double roughness, double *value)
{
    enum { NODES = 20000 };
    kiln_lobe lobe = kiln_lobe_ggx(roughness * roughness);
    double sum = 0;
    for (int i = 0; i < NODES; i++) {
        double t = (i + 0.5) / NODES, t3 = t * t * t; // 1 - cosine = 2 t^4
        sum += 8 * t3 / NODES * kiln_lobe_evaluate(&lobe, 1 - 2 * t3 * t);
    }
    for (int i = 0; i <= LOBE_ANGLES; i++) {
        double x = (double)i / LOBE_ANGLES;
        value[i] = kiln_lobe_evaluate(&lobe, 1 - 2 * x * x) / (2 * pi * sum);
    }
}

void lobe_levels_make(const float *roughness, int count, lobe_levels *levels)
{
    memset(levels, 0, sizeof *levels);
    levels->count = count;
    for (int i = 0; i < count; i++)
        if (roughness[i] >= 0.01f)
            tabulate((double)roughness[i], levels->value[i]);
}

// The mix of two levels by the fraction of the level's number, as graphics hardware computes it.
static double lobe_at(const lobe_levels *levels, double level, double cosine)
{
    int low = level < levels->count - 2 ? (int)level : levels->count - 2;
    double at = LOBE_ANGLES * sqrt(fmax(0.5 * (1 - cosine), 0)), value[2];
    int i = at < LOBE_ANGLES - 1 ? (int)at : LOBE_ANGLES - 1;
    for (int k = 0; k < 2; k++) {
        const double *f = levels->value[low + k] + i;
        value[k] = f[0] + (at - i) * (f[1] - f[0]);
    }
    return value[0] + (level - low) * (value[1] - value[0]);
}

lobe_sum lobe_sum_make(const double *values, int taps, double nov)
{
    double list[KILN_MAX_TAPS + 4];
    lobe_sum sum = {.count = taps, .c[5] = 1};
    for (int k = 0; k < taps; k++) {
        const double *tap = values + 4 * (size_t)k;
        double angle = acos(nov) - tap[0];
        sum.x[k] = sin(angle);
        sum.z[k] = cos(angle);
        sum.level[k] = tap[1];
        sum.weight[k] = tap[2];
        sum.c[5] -= tap[2];
        list[k] = tap[3];
    }
    memcpy(list + taps, values + 4 * (size_t)taps, 4 * sizeof *list);
    memcpy(sum.c, list, 5 * sizeof *list);
    return sum;
}

double lobe_sum_at(const lobe_levels *levels, const lobe_sum *sum, const double d[3])
{
    const double *c = sum->c;
    double x = d[0], y = d[1], z = d[2], value;
    double two = c[2] * (1.5 * z * z - 0.5) + 1.5 * c[3] * x * z + 1.5 * c[4] * (x * x - y * y);
    value = (c[5] + 3 * (c[0] * z + c[1] * x) + 5 * two) / (4 * pi);
    for (int k = 0; k < sum->count; k++) {
        double cosine = sum->x[k] * x + sum->z[k] * z;
        if (cosine > 0) // no level's lobe reaches beyond a quarter turn
            value += sum->weight[k] * lobe_at(levels, sum->level[k], cosine);
    }
    return value;
}
