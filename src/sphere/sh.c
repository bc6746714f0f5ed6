// The first bands of spherical harmonics as rendering engines use them (docs/theory/spectral.md).
// In: a spectrum about the axis +Y with its list of suns. Out: up to 25 real coefficients for each
// channel about the axis z, of radiance or irradiance, with or without a window; and the power of
// each degree. Method: the first bands are evaluated on a Gauss grid and projected onto the basis.
// The grid integrates their products with the basis exactly.
#include "sphere/sh.h"

#include "image/image.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// Real orthonormal spherical harmonics as polynomials in x, y, z. The normalisations are the usual
// closed forms, for example in Sloan, "Stupid Spherical Harmonics Tricks" (2008), appendix A2,
// without the factor (-1)^m that Sloan's have.
void ki_sh_basis(const double d[3], double y[25])
{
    double x = d[0], v = d[1], z = d[2], x2 = x * x, v2 = v * v, z2 = z * z;
    double unit = sqrt(1 / KI_PI);
    y[0] = 0.5 * unit;
    double k = sqrt(3.0) / 2 * unit;
    y[1] = k * v;
    y[2] = k * z;
    y[3] = k * x;
    k = sqrt(15.0) / 2 * unit;
    y[4] = k * x * v;
    y[5] = k * v * z;
    y[6] = sqrt(5.0) / 4 * unit * (3 * z2 - 1);
    y[7] = k * x * z;
    y[8] = k / 2 * (x2 - v2);
    double k3 = sqrt(35.0 / 2) / 4 * unit, k1 = sqrt(21.0 / 2) / 4 * unit;
    k = sqrt(105.0) / 4 * unit;
    y[9] = k3 * v * (3 * x2 - v2);
    y[10] = 2 * k * x * v * z;
    y[11] = k1 * v * (5 * z2 - 1);
    y[12] = sqrt(7.0) / 4 * unit * z * (5 * z2 - 3);
    y[13] = k1 * x * (5 * z2 - 1);
    y[14] = k * z * (x2 - v2);
    y[15] = k3 * x * (x2 - 3 * v2);
    double k4 = 3.0 / 4 * sqrt(35.0) * unit, k43 = 3.0 / 4 * sqrt(35.0 / 2) * unit;
    double k2 = 3.0 / 4 * sqrt(5.0) * unit, k41 = 3.0 / 4 * sqrt(5.0 / 2) * unit;
    y[16] = k4 * x * v * (x2 - v2);
    y[17] = k43 * v * z * (3 * x2 - v2);
    y[18] = k2 * x * v * (7 * z2 - 1);
    y[19] = k41 * v * z * (7 * z2 - 3);
    y[20] = 3.0 / 16 * unit * (35 * z2 * z2 - 30 * z2 + 3);
    y[21] = k41 * x * z * (7 * z2 - 3);
    y[22] = k2 / 2 * (x2 - v2) * (7 * z2 - 1);
    y[23] = k43 * x * z * (x2 - 3 * v2);
    y[24] = k4 / 4 * (x2 * (x2 - 3 * v2) - v2 * (3 * x2 - v2));
}

// The spectrum has the polar axis +Y, the basis the polar axis z. Therefore the sum of the first
// bands is evaluated on a product grid of directions and projected onto the basis anew. The grid
// integrates products of two harmonics of these bands exactly.
kiln_result ki_sh_project(const kiln_spectrum *spectrum, int bands, const ki_tilt *tilt,
                          double rotation, kiln_sh *sh, kiln_error *error)
{
    enum { DEGREE = KILN_MAX_BANDS - 1, RINGS = 8, COLUMNS = 16 };
    kiln_context *context = spectrum->context;
    double f[DEGREE + 1][DEGREE + 1 + KI_LEGENDRE_PADDING];
    double scale[DEGREE + 1][DEGREE + 1 + KI_LEGENDRE_PADDING], start = 0;
    size_t count = ki_coefficient_count(DEGREE);
    *sh = (kiln_sh){.bands = bands};
    double *a = ki_alloc(context, count, sizeof *a);
    if (!a)
        return ki_fail_memory(context, error, "spherical harmonics", count * sizeof *a);
    for (int m = 0; m <= DEGREE; m++) {
        ki_legendre_order(DEGREE, m, &start, f[m], scale[m]);
        for (int l = m; l <= DEGREE && l <= spectrum->degree; l++)
            memcpy(a + ki_coefficient_row(DEGREE, m) + 6 * (size_t)(l - m),
                   spectrum->a + ki_coefficient_row(spectrum->degree, m) + 6 * (size_t)(l - m),
                   6 * sizeof *a);
    }
    kiln_result result = ki_spectrum_add_suns(spectrum, DEGREE, a, error);
    if (result != KILN_OK)
        goto done;

    double nodes[RINGS], weights[RINGS];
    ki_gauss_legendre(RINGS, nodes, weights);
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < COLUMNS; i++) {
            double sine = sqrt((1 - nodes[j]) * (1 + nodes[j])), value[3] = {0}, power = 1;
            double u = (double)i / COLUMNS;
            for (int m = 0; m <= DEGREE; m++, power *= sine) {
                const double *row = a + ki_coefficient_row(DEGREE, m);
                double q = power, before = 0, re, im;
                ki_sincos(2 * KI_PI * m * (u + rotation / 360), &im, &re);
                for (int l = 0; l <= DEGREE - m; l++, row += 6) {
                    double p = q * scale[m][l] * (m ? 2 : 1);
                    for (size_t c = 0; c < 3; c++)
                        value[c] += p * (row[2 * c] * re - row[2 * c + 1] * im);
                    double next = 2 * nodes[j] * q - f[m][l + 1] * before;
                    before = q;
                    q = next;
                }
            }
            // Direction of the point at longitude 2 pi u and polar angle theta of a panorama, as
            // ki_panorama_direction defines it. `nodes[j]` is cos theta.
            double y[25], s, c;
            ki_sincos(2 * KI_PI * u, &s, &c);
            double direction[3] = {-sine * s, nodes[j], sine * c};
            ki_tilt_undo(tilt, direction);
            ki_sh_basis(direction, y);
            for (int k = 0; k < bands * bands; k++)
                for (int n = 0; n < 3; n++)
                    sh->c[k][n] += y[k] * value[n] * weights[j] * 2 * KI_PI / COLUMNS;
        }
done:
    ki_free(a);
    return result;
}

kiln_result ki_sh_check_bands(int bands, double window, double rotation, kiln_error *error)
{
    if (bands < 1 || bands > KILN_MAX_BANDS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "bands is %d, it must be 1 to %d", bands,
                       KILN_MAX_BANDS);
    if (!(window >= 0 && window <= 1e6))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "window is %g, it must be 0 to 1e6", window);
    if (!(fabs(rotation) <= 1e6))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "rotation is %g degrees, it must be from -1e6 to 1e6", rotation);
    return KILN_OK;
}

kiln_result kiln_sh_filter(const kiln_sh *radiance, int bands, bool irradiance, double window,
                           kiln_sh *sh, kiln_error *error)
{
    // Factor A_l of the cosine lobe for each band l = 0 .. 4, from Ramamoorthi and Hanrahan 2001,
    // eq. 8.
    static const double cosine_lobe[] = {KI_PI, 2 * KI_PI / 3, KI_PI / 4, 0, -KI_PI / 24};
    kiln_sh from = *radiance;
    *sh = (kiln_sh){0};
    kiln_result result = ki_sh_check_bands(bands, window, 0, error);
    if (result != KILN_OK)
        return result;
    if (from.bands < bands || from.bands > KILN_MAX_BANDS || from.irradiance || from.window > 0)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "cannot make %d bands from %d bands of %s%s: the source must have as many "
                       "bands, of radiance, without a window",
                       bands, from.bands, from.irradiance ? "irradiance" : "radiance",
                       from.window > 0 ? " with a window" : "");
    *sh = (kiln_sh){.bands = bands, .irradiance = irradiance, .window = window};
    for (int l = 0; l < bands; l++) {
        double factor = irradiance ? cosine_lobe[l] : 1;
        if (window > 0)
            factor *= l < window ? (1 + ki_cos(KI_PI * l / window)) / 2 : 0;
        for (int k = l * l; k < (l + 1) * (l + 1); k++)
            for (int c = 0; c < 3; c++)
                sh->c[k][c] = from.c[k][c] * factor;
    }
    return KILN_OK;
}

kiln_result kiln_spectrum_sh(const kiln_spectrum *spectrum, int bands, bool irradiance,
                             double window, double rotation, kiln_sh *sh, kiln_error *error)
{
    *sh = (kiln_sh){0};
    kiln_sh radiance = {0};
    kiln_result result = ki_sh_check_bands(bands, window, rotation, error);
    if (result == KILN_OK)
        result = ki_sh_project(spectrum, bands, NULL, rotation, &radiance, error);
    if (result == KILN_OK)
        result = kiln_sh_filter(&radiance, bands, irradiance, window, sh, error);
    return result;
}

void kiln_sh_evaluate(const kiln_sh *sh, const double direction[3], double value[3])
{
    double y[25];
    ki_sh_basis(direction, y);
    for (int c = 0; c < 3; c++) {
        value[c] = 0;
        for (int k = 0; k < sh->bands * sh->bands; k++)
            value[c] += y[k] * sh->c[k][c];
    }
}

kiln_result kiln_spectrum_power(const kiln_spectrum *spectrum, double (*power)[3],
                                kiln_error *error)
{
    size_t count = (size_t)spectrum->degree + 1;
    double(*calm)[3] = ki_alloc_raw(spectrum->context, count, sizeof *calm);
    if (!calm)
        return ki_fail_memory(spectrum->context, error, "a spectrum's power", count * sizeof *calm);
    kiln_result result = ki_spectrum_power(spectrum, spectrum->degree, calm, power, error);
    ki_free(calm);
    return result;
}
