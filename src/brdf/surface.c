// Builds and evaluates the Chebyshev series of the albedo E in surface.h. ki_surface_build samples
// E on a Chebyshev grid of n.v and roughness, and transforms rows and columns to coefficients.
// ki_surface_values sums the series over roughness once for a row; kernels compiled from
// surface.inl sum it over n.v.
#include "brdf/surface.h"

#include "base/vector.h"
#include "brdf/brdf.h"
#include "brdf/energy.h"
#include "math/math.h"

#include <string.h>

double ki_grazing_scale(const kiln_model *model, double roughness)
{
    if (model->g == KILN_G_SCHLICK_TEXT) {
        double k = ki_schlick_k_direct(roughness);
        return k / (1 - k);
    }
    double alpha = roughness * roughness;
    return alpha > 1e-12 ? alpha : 1e-12;
}

// Returns Chebyshev point `index` of the `count` points of the first kind on [0, 1].
static double point(int index, int count)
{
    return (1 + ki_cos(KI_PI * (index + 0.5) / count)) / 2;
}

// Fills matrix[i][k] with the weight that the function's value at Chebyshev point i has in the
// series' coefficient of degree k.
static void transform_matrix(int count, double matrix[KI_SURFACE_NOV][KI_SURFACE_NOV])
{
    double cosine[4 * KI_SURFACE_NOV];
    for (int i = 0; i < 4 * count; i++)
        cosine[i] = ki_cos(KI_PI * i / (2 * count));
    for (int k = 0; k < count; k++)
        for (int i = 0; i < count; i++)
            matrix[i][k] = cosine[k * (2 * i + 1) % (4 * count)] * (k ? 2.0 : 1.0) / count;
}

typedef struct build_job {
    const kiln_context *context;
    ki_surface *surface;
    double by_nov[KI_SURFACE_NOV][KI_SURFACE_NOV], by_roughness[KI_SURFACE_NOV][KI_SURFACE_NOV];
} build_job;

// Task of one thread: computes the albedo E along one row of constant roughness and transforms the
// row to Chebyshev coefficients in u, the variable that replaces n.v (surface.h).
static void build_row(void *data, int row)
{
    const build_job *job = data;
    ki_surface *surface = job->surface;
    int columns = surface->columns;
    double nov[KI_SURFACE_NOV], e[KI_SURFACE_NOV], roughness = point(row, surface->rows);
    double c = ki_grazing_scale(&surface->model, roughness);
    for (int i = 0; i < columns; i++) {
        double u = point(i, columns), t = surface->quartic ? u * u * (u * u) : u * u;
        nov[i] = t * c / (c + (1 - t));
    }
    ki_energy_values(job->context, &surface->model, roughness, nov, columns, false, e);
    double *coefficient = surface->coefficient[row];
    for (int k = 0; k < KI_SURFACE_NOV; k++)
        coefficient[k] = 0;
    for (int i = 0; i < columns; i++)
        for (int k = 0; k < columns; k++)
            coefficient[k] += job->by_nov[i][k] * e[i];
}

// Chooses the numbers of Chebyshev coefficients that bring the error of the albedo E below 7e-8 for
// each masking. For KILN_G_SMITH, E has a logarithmic singularity at n.v = 0, which the fourth root
// in u smooths. For KILN_G_SCHLICK_TEXT, E changes over n.v < k / (1 - k), with Schlick's k, and by
// a small amount over n.v < alpha. These two widths depend differently on roughness, which takes
// more coefficients in roughness.
static void choose_degrees(ki_surface *surface)
{
    surface->quartic = surface->model.g == KILN_G_SMITH;
    // the number of coefficients in u is even, because surface.inl sums two degrees per step
    surface->columns = surface->quartic ? 46 : 34;
    surface->rows = 18;
    if (surface->model.g == KILN_G_SCHLICK_TEXT) {
        surface->columns = 20;
        surface->rows = 36;
    }
}

void ki_surface_build(kiln_context *context, const kiln_model *model, ki_surface *surface)
{
    surface->model = *model;
    choose_degrees(surface);
    build_job job = {.context = context, .surface = surface};
    transform_matrix(surface->columns, job.by_nov);
    transform_matrix(surface->rows, job.by_roughness);
    ki_parallel_for(context, surface->rows, build_row, &job);
    double row[KI_SURFACE_ROUGHNESS][KI_SURFACE_NOV];
    memcpy(row, surface->coefficient, sizeof row);
    for (int k = 0; k < surface->rows; k++) {
        double *coefficient = surface->coefficient[k];
        memset(coefficient, 0, sizeof row[0]);
        for (int i = 0; i < surface->rows; i++)
            for (int j = 0; j < surface->columns; j++)
                coefficient[j] += job.by_roughness[i][k] * row[i][j];
    }
}

// Sums the series of the albedo E over roughness by the recurrence of Chebyshev polynomials,
// T_{i+1}(x) = 2 x T_i(x) - T_{i-1}(x) with x = 2 roughness - 1. A kernel then sums the remaining
// series over u.
void ki_surface_values(const kiln_context *context, const ki_surface *surface, double roughness,
                       const double *nov, int count, double *out)
{
    double coefficient[KI_SURFACE_NOV] = {0}, x = 2 * roughness - 1, before = 1, now = x;
    for (int i = 0; i < surface->rows; i++) {
        double value = i ? now : 1;
        for (int k = 0; k < KI_SURFACE_NOV; k++)
            coefficient[k] += value * surface->coefficient[i][k];
        if (i) {
            double next = 2 * x * now - before;
            before = now;
            now = next;
        }
    }
    KI_FASTEST(context, ki_surface_row)
    (surface, coefficient, ki_grazing_scale(&surface->model, roughness), nov, count, out);
}
