// The functions of the reflection model as the caller sees them: arguments are clamped.
#include "brdf/brdf.h"
#include "brdf/walk.h"

#include "base/base.h"
#include "math/math.h"

#include <math.h>

static double unit(double x)
{
    return ki_clamp(x, 0, 1);
}

// Cosines so small that products of two would underflow are 0.
static double cosine(double x)
{
    return x >= 1e-150 ? unit(x) : 0;
}

// So is a roughness whose eighth power would.
static double rough(double x)
{
    return x >= 1e-35 ? unit(x) : 0;
}

static double index_of(double x)
{
    return ki_clamp(x, 0, 1e8);
}

// ------------------------------------------------------------------------------------------- D, G

double kiln_brdf_d(kiln_d d, double roughness, double noh)
{
    return ki_brdf_d(d, rough(roughness), unit(noh));
}

double kiln_brdf_g(const kiln_model *model, double roughness, double nov, double nol)
{
    return ki_masking(model, rough(roughness), cosine(nov), cosine(nol));
}

double kiln_brdf_specular(const kiln_model *model, double roughness, double nov, double nol,
                          double noh)
{
    double r = rough(roughness), d = ki_brdf_d(model->d, r, unit(noh));
    if (!(d > 0 && d < HUGE_VAL))
        return d;
    return d * ki_visibility(model, r, cosine(nov), cosine(nol)) / 4;
}

// ---------------------------------------------------------------------------------------------- F

double kiln_fresnel_schlick(double f0, double voh)
{
    double f = unit(f0);
    return f + (1 - f) * ki_schlick_fresnel(unit(voh));
}

double kiln_fresnel_dielectric(double ior, double voh)
{
    return ki_fresnel_dielectric(index_of(ior), unit(voh));
}

double kiln_fresnel_conductor(double n, double k, double voh)
{
    return ki_fresnel_conductor(index_of(n), index_of(k), unit(voh));
}

void kiln_gulbrandsen(double reflectivity, double edge_tint, double *n, double *k)
{
    ki_gulbrandsen(ki_clamp(reflectivity, 0, 0.9999), unit(edge_tint), n, k);
}

double kiln_fresnel_f82(double f0, double f82, double voh)
{
    return ki_fresnel_f82(unit(f0), unit(f82), unit(voh));
}

double kiln_fresnel_f82_average(double f0, double f82)
{
    double f = unit(f0);
    return (1 + 20 * f) / 21 - ki_f82_dip(f, unit(f82)) / 126;
}

double kiln_fresnel_schlick_average(double f0)
{
    return (1 + 20 * unit(f0)) / 21;
}

double kiln_fresnel_dielectric_average(double ior)
{
    return ki_fresnel_dielectric_average(index_of(ior));
}

double kiln_fresnel_conductor_average(double n, double k)
{
    return ki_fresnel_conductor_average(index_of(n), index_of(k));
}

double kiln_fresnel_dielectric_average_fit(double ior)
{
    return ki_fresnel_dielectric_average_fit(ki_clamp(ior, 0, 400));
}

double kiln_fresnel_conductor_average_fit(double reflectivity, double edge_tint)
{
    return ki_fresnel_conductor_average_fit(unit(reflectivity), unit(edge_tint));
}

// --------------------------------------------------------------------------------------- samplers

// xi into [0, 1): generators of floats may well round up to 1.
static const double *clamp_xi(const double xi[2], double clamped[2])
{
    for (int i = 0; i < 2; i++)
        clamped[i] = ki_clamp(xi[i], 0, 1 - 0x1p-53);
    return clamped;
}

void kiln_sample_cosine(const double xi[2], double l[3])
{
    double x[2];
    ki_sample_cosine(clamp_xi(xi, x), l);
}

double kiln_pdf_cosine(double nol)
{
    return unit(nol) / KI_PI;
}

void kiln_sample_half_vector(kiln_d d, double roughness, const double xi[2], double h[3])
{
    double r = rough(roughness), x[2];
    if (d == KILN_D_GGX)
        ki_ggx_half_vector(r * r, clamp_xi(xi, x), h);
    else
        ki_beckmann_half_vector(r * r, clamp_xi(xi, x), h);
}

double kiln_pdf_half_vector(kiln_d d, double roughness, double noh)
{
    double c = unit(noh);
    return c > 0 ? c * ki_brdf_d(d, rough(roughness), c) : 0;
}

void kiln_sample_visible(double roughness, const double v[3], const double xi[2], double h[3])
{
    double r = rough(roughness), x[2];
    h[0] = h[1] = 0;
    h[2] = 1; // of the mirror
    if (r > 0)
        ki_sample_visible(r * r, v, clamp_xi(xi, x), h);
}

double kiln_pdf_visible(double roughness, double nov, double noh, double voh)
{
    double r = rough(roughness), d = ki_brdf_d(KILN_D_GGX, r, unit(noh)), c = unit(voh);
    if (!(d > 0 && d < HUGE_VAL && c > 0))
        return c > 0 ? d : 0;
    return d * ki_smith_g1_over_cosine(r * r, cosine(nov)) * c;
}

double kiln_pdf_reflection(double pdf, double voh)
{
    return voh > 0 ? pdf / (4 * voh) : 0;
}

// ----------------------------------------------------------------------------------- compensation

double kiln_kulla_conty(double e_o, double e_i, double e_average)
{
    return ki_kulla_conty(unit(e_o), unit(e_i), unit(e_average));
}

double kiln_kulla_conty_fresnel(kiln_f_add form, double f_average, double e_average)
{
    return ki_kulla_conty_fresnel(form, unit(f_average), unit(e_average));
}

double kiln_turquin(double f0, double e)
{
    // Below every albedo that a lobe with light in it has; so that the factor stays finite.
    return ki_turquin(unit(f0), ki_clamp(e, 1e-6, 1));
}

void kiln_fdez_aguera(double f0, double a, double b, double *single, double *multiple)
{
    double a1 = unit(a), b1 = unit(b);
    ki_fdez_aguera(unit(f0), a1, b1 < 1 - a1 ? b1 : 1 - a1, single, multiple);
}

double kiln_compensate_walk(double e_single, double added)
{
    return 1 + unit(added) / ki_clamp(e_single, 1e-6, 1);
}

void kiln_walk_albedo(const kiln_walk_def *def, double roughness, double nov, kiln_walk *walk)
{
    kiln_walk_def d = *def;
    d.f0 = unit(d.f0);
    d.n = index_of(d.n);
    d.k = index_of(d.k);
    ki_walk_albedo(&d, rough(roughness), unit(nov), walk);
}
