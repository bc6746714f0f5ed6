// The balls' reflection model in double precision. In: a ball, a point on it, a direction of light.
// Out: the BRDF times n.l, and the factors of the lobes at the point (trace.h). The formulas are
// those of shaders/scene.frag and docs/theory/realtime.md, with exact tables in place of small
// textures.
#include "internal.h"
#include "trace.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

kiln_result view_energy_create(kiln_context *context, const view_options *options,
                               view_energy *energy, kiln_error *error)
{
    bool light = options->scene == VIEW_SCENE_ASSIGNMENT;
    *energy = (view_energy){.model = {.g = light ? KILN_G_SCHLICK_K2 : KILN_G_SMITH}};
    view_ball balls[VIEW_MAX_BALLS];
    int count = view_balls(options, balls);
    for (int i = 0; i < count; i++)
        energy->average[i] = kiln_energy_average(&energy->model, balls[i].roughness);
    kiln_table_def def = {.kind = KILN_TABLE_E,
                          .model = energy->model,
                          .width = 512,
                          .height = 512,
                          .axis = KILN_AXIS_GRAZING,
                          .corners = true,
                          .complement = true};
    kiln_result result = kiln_table_create(context, &def, &energy->e, error);
    def.kind = KILN_TABLE_DFG;
    def.axis = KILN_AXIS_SQRT; // the grazing axis does not resolve B where n.v is large
    def.complement = false;
    if (result == KILN_OK && !light)
        result = kiln_table_create(context, &def, &energy->split, error);
    if (result == KILN_OK && !light)
        result = view_edge_create(context, &energy->edge, error);
    for (int i = 0; i <= VIEW_CURVE && options->material < VIEW_METAL_COUNT; i++)
        view_metal_fresnel(options->material, (double)i / VIEW_CURVE, energy->curve[i]);
    if (result != KILN_OK)
        view_energy_free(energy);
    return result;
}

void view_energy_free(view_energy *energy)
{
    kiln_table_free(&energy->e);
    kiln_table_free(&energy->split);
    kiln_table_free(&energy->edge);
}

void view_fresnel(const view_ball *ball, const view_energy *energy, double voh, double f[3])
{
    double at = voh * VIEW_CURVE;
    int i = at < VIEW_CURVE - 1 ? (int)at : VIEW_CURVE - 1;
    for (int c = 0; c < 3; c++) {
        if (!ball->measured) {
            f[c] = kiln_fresnel_schlick(ball->f0[c], voh);
            continue;
        }
        double low = energy->curve[i][c], metal = low + (at - i) * (energy->curve[i + 1][c] - low);
        f[c] = ball->metallic * metal + (1 - ball->metallic) * kiln_fresnel_schlick(0.04, voh);
    }
}

static bool is_kulla_conty(view_method method)
{
    return method == VIEW_METHOD_KULLA_CONTY || method == VIEW_METHOD_KULLA_CONTY_HANDOUT;
}

static kiln_f_add form_of(view_method method)
{
    return method == VIEW_METHOD_KULLA_CONTY_HANDOUT ? KILN_F_ADD_ASSIGNMENT : KILN_F_ADD_SECOND;
}

// Returns the edge in F = Schlick's reflectance - edge voh (1 - voh)^6, as f82_edge of
// shaders/brdf.glsl does.
static double edge_of(double f0, double f82)
{
    static const double edge = 1.0 / 7;
    return (kiln_fresnel_schlick(f0, edge) - f82) / (edge * pow(1 - edge, 6));
}

void view_point_prepare(const view_ball *ball, const view_energy *energy, view_point *point)
{
    double ab[2], edge, average = energy->average[point->ball];
    // only view_reflect_light has no split sum, and it uses none of the factors set here
    if (!energy->split.image.pixels)
        return;
    kiln_table_lookup(&energy->split, point->v[2], ball->roughness, 0, ab);
    kiln_table_lookup(&energy->edge, point->v[2], ball->roughness, 0, &edge);
    double e = ab[0] + ab[1];
    for (int c = 0; c < 3; c++) {
        double f0 = ball->f0[c], single = f0 * ab[0] + ab[1], multiple = 0;
        single -= edge_of(f0, ball->f82[c]) * edge;
        point->specular[c] = 1;
        point->lobe[c] = 0;
        if (is_kulla_conty(ball->method)) {
            double factor =
                kiln_kulla_conty_fresnel(form_of(ball->method), ball->f_average[c], average);
            point->lobe[c] = average < 1 ? factor * (1 - e) / (1 - average) : 0;
            multiple = factor * (1 - e);
        } else if (ball->method == VIEW_METHOD_FDEZ_AGUERA) {
            // This is the formula of kiln_fdez_aguera with the F_avg of the ball instead of
            // Schlick's.
            multiple = single * (1 - e) / e *
                       kiln_kulla_conty_fresnel(KILN_F_ADD_ASSIGNMENT, ball->f_average[c], e);
        } else if (ball->method == VIEW_METHOD_TURQUIN) {
            point->specular[c] = kiln_turquin(f0, e);
        }
        single *= point->specular[c];
        // Fdez-Aguera 2019 treats the further bounces as diffuse light. Kulla and Conty 2017 give
        // the further bounces a lobe of their own (point->lobe).
        point->diffuse[c] = ball->albedo[c] * (1 - single - multiple) +
                            (ball->method == VIEW_METHOD_FDEZ_AGUERA ? multiple : 0);
    }
}

void view_reflect(const view_ball *ball, const view_energy *energy, const view_point *point,
                  const double l[3], double f[3])
{
    double nol = l[2], nov = point->v[2], h[3], size = 0;
    f[0] = f[1] = f[2] = 0;
    if (nol <= 0)
        return;
    for (int c = 0; c < 3; c++) {
        h[c] = l[c] + point->v[c];
        size += h[c] * h[c];
    }
    size = sqrt(size);
    double voh = fmin(size / 2, 1), fresnel[3]; // l and v are unit vectors: |l + v| = 2 v.h
    view_fresnel(ball, energy, voh, fresnel);
    double specular = 0, lobe = 0;
    if (ball->roughness > 0)
        specular =
            kiln_brdf_specular(&energy->model, ball->roughness, nov, nol, fmin(h[2] / size, 1));
    if (is_kulla_conty(ball->method)) {
        double e;
        kiln_table_lookup(&energy->e, nol, ball->roughness, 0, &e);
        lobe = (1 - e) / pi;
    }
    for (int c = 0; c < 3; c++) {
        f[c] = nol * (specular * fresnel[c] * point->specular[c] + lobe * point->lobe[c] +
                      point->diffuse[c] / pi);
    }
}

// The GAMES202 assignment's shader keeps the denominator 4 n.l n.v at 0.001 or more.
void view_reflect_light(const view_options *o, const view_ball *ball, const view_energy *energy,
                        const view_point *point, double radiance[3])
{
    double nov = point->v[2], nol = fmax(point->n[2], 0), r = ball->roughness;
    // The light comes from (0, 0, 1). h is the half vector in the world, before normalization.
    double h[3], size = 0, noh = 0;
    for (int c = 0; c < 3; c++) {
        h[c] = (c == 2) - point->ray[c];
        size += h[c] * h[c];
    }
    size = sqrt(size);
    for (int c = 0; c < 3; c++)
        noh += point->n[c] * h[c] / size;
    double d = kiln_brdf_d(KILN_D_GGX, r, fmax(fmin(noh, 1), 0));
    double lobe = d * kiln_brdf_g(&energy->model, r, nov, nol) / fmax(4 * nol * nov, 0.001);
    double e_o, e_i, average = energy->average[point->ball];
    kiln_table_lookup(&energy->e, nov, r, 0, &e_o);
    kiln_table_lookup(&energy->e, nol, r, 0, &e_i);
    for (int c = 0; c < 3; c++) {
        double f = lobe * kiln_fresnel_schlick(ball->f0[c], fmin(size / 2, 1));
        // The GAMES202 handout's figure 6 uses the albedo in place of E_avg.
        double e = o->as_printed ? view_handout_albedo[c] : average;
        if (is_kulla_conty(ball->method))
            f += kiln_kulla_conty(e_o, e_i, e) *
                 kiln_kulla_conty_fresnel(form_of(ball->method), ball->f_average[c], e);
        radiance[c] = f * nol;
    }
}
