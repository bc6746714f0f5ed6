// kiln_check_sh. In: spherical harmonics of any tool, and the panorama. Out: a report. Method: the
// exact coefficients are turned under each of the 48 axes, and multiplied by powers of the
// constants of the basis functions. Each band of the file is compared with a multiple of the exact
// band, so that neither brightness nor weights nor windows matter, and the axes and constants of
// least error are taken. The factors of the bands then tell the weights (radiance, irradiance, or
// the cosine applied twice) and the window.
#include "check/check.h"

#include "math/math.h"
#include "sphere/sh.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST = KILN_MAX_BANDS * KILN_MAX_BANDS, RINGS = 6, STEPS = 12, WAYS = 48, POWERS = 3 };

// ------------------------------------------------------------------------------------------- turns

// Sets `turned` to the coefficients that a file with these axes has. RINGS Gauss nodes in z times
// STEPS longitudes integrate products of two harmonics of degree 4 exactly.
static void turn(const kiln_sh *source, const ki_axes *axes, double turned[MOST][3])
{
    double nodes[RINGS], weights[RINGS];
    int count = source->bands * source->bands;
    ki_gauss_legendre(RINGS, nodes, weights);
    memset(turned, 0, MOST * sizeof *turned);
    for (int i = 0; i < RINGS * STEPS; i++) {
        double sine, cosine, from[3], value[3], basis[MOST], z = nodes[i / STEPS];
        ki_sincos(i % STEPS * (2 * KI_PI / STEPS), &sine, &cosine);
        const double at[3] = {sqrt(1 - z * z) * cosine, sqrt(1 - z * z) * sine, z};
        ki_axes_apply(axes, at, from);
        kiln_sh_evaluate(source, from, value);
        ki_sh_basis(at, basis);
        for (int j = 0; j < count; j++)
            for (int c = 0; c < 3; c++)
                turned[j][c] += weights[i / STEPS] * (2 * KI_PI / STEPS) * basis[j] * value[c];
    }
}

// Returns the constant of a basis function of the first three bands: of x^2 - y^2, not of its half.
static double constant(int index)
{
    static const double constants[9] = {
        0.28209479177387814, 0.48860251190291992, 0.48860251190291992,
        0.48860251190291992, 1.0925484305920792,  1.0925484305920792,
        0.31539156525252005, 1.0925484305920792,  0.54627421529603959};
    return index < 9 ? constants[index] : 1;
}

static void multiply_constants(int bands, int power, double c[MOST][3])
{
    for (int i = 0; i < bands * bands; i++)
        for (int k = 0; k < 3; k++)
            for (int p = 0; p < power; p++)
                c[i][k] *= constant(i);
}

// ------------------------------------------------------------------------------------------- match

// How a file's harmonics are made from the exact ones.
typedef struct match {
    ki_axes axes;
    int power;                     // times that coefficients are multiplied by their constants
    double factor[KILN_MAX_BANDS]; // factors of the bands
    double error;                  // what remains, relative to the file's coefficients
} match;

static int band_of(int index)
{
    int band = 0;
    while ((band + 1) * (band + 1) <= index)
        band++;
    return band;
}

// Finds the factors of the bands between `exact` and the file.
static void find_factors(const kiln_sh *file, double exact[MOST][3], match *m)
{
    double fe[KILN_MAX_BANDS] = {0}, ee[KILN_MAX_BANDS] = {0}, ff[KILN_MAX_BANDS] = {0};
    for (int i = 0; i < file->bands * file->bands; i++)
        for (int c = 0; c < 3; c++) {
            int l = band_of(i);
            fe[l] += file->c[i][c] * exact[i][c];
            ee[l] += exact[i][c] * exact[i][c];
            ff[l] += file->c[i][c] * file->c[i][c];
        }
    m->error = 0;
    for (int l = 0; l < file->bands; l++) {
        m->factor[l] = ee[l] > 0 ? fe[l] / ee[l] : 0;
        // Each band counts alike. A band that is turned the other way round is no match; a band of
        // irradiance may be negative from degree 4 on.
        double part = ff[l] > 0 && ee[l] > 0 ? 1 - fe[l] * fe[l] / (ff[l] * ee[l]) : 0;
        m->error += l < 3 && m->factor[l] < 0 ? 2 : part;
    }
}

static match find_match(const kiln_sh *file, const kiln_sh *exact, const ki_axes *expected)
{
    match best = {.axes = *expected, .error = HUGE_VAL};
    for (int i = -1; i < WAYS; i++)
        for (int power = 0; power < POWERS; power++) {
            match tried = {.axes = i < 0 ? *expected : ki_axes_numbered(i), .power = power};
            double turned[MOST][3];
            turn(exact, &tried.axes, turned);
            multiply_constants(file->bands, power, turned);
            find_factors(file, turned, &tried);
            // The expected axes come first, and others must be clearly better.
            if (tried.error < best.error - 1e-4)
                best = tried;
        }
    return best;
}

// ----------------------------------------------------------------------------------------- weights

typedef enum weight { RADIANCE, IRRADIANCE, TWICE, WEIGHTS } weight;

// The factor of a band, relative to that of band 0.
static double weight_of(weight w, int band)
{
    static const double cosine[KILN_MAX_BANDS] = {1, 2.0 / 3, 0.25, 0, -1.0 / 24};
    return w == RADIANCE ? 1 : w == IRRADIANCE ? cosine[band] : cosine[band] * cosine[band];
}

typedef enum window { NO_WINDOW, HANNING, LANCZOS, LANCZOS_4, WINDOWS } window;

static double window_of(window kind, double width, int band)
{
    double x = KI_PI * band / width;
    if (kind == NO_WINDOW || band == 0)
        return 1;
    if (band >= width)
        return 0;
    if (kind == HANNING)
        return (1 + ki_cos(x)) / 2;
    double sinc = ki_sin(x) / x;
    return kind == LANCZOS ? sinc : sinc * sinc * sinc * sinc;
}

// Weights and a window that explain the factors of the bands.
typedef struct shape {
    weight weight;
    window window;
    double width, error;
} shape;

static double shape_error(const match *m, int bands, const shape *s)
{
    double most = 0;
    for (int l = 1; l < bands; l++) {
        double wanted = weight_of(s->weight, l) * window_of(s->window, s->width, l);
        most = fmax(most, fabs(m->factor[l] / m->factor[0] - wanted));
    }
    return most;
}

// Finds the simplest shape: the claimed weights before others, and no window before a window.
static shape find_shape(const match *m, int bands, weight claimed)
{
    // Largest error of a factor, relative to that of band 0, and how much better a shape must be
    // than a simpler one.
    const double good = 0.02, better = 2;
    shape best = {claimed, NO_WINDOW, 1, 0};
    best.error = shape_error(m, bands, &best);
    for (int w = 0; w < WEIGHTS; w++) {
        shape tried = {(weight)w, NO_WINDOW, 1, 0};
        tried.error = shape_error(m, bands, &tried);
        if (tried.error * better < best.error && best.error > good)
            best = tried;
    }
    for (int w = 0; w < WEIGHTS && best.error > good; w++)
        for (int kind = HANNING; kind < WINDOWS && bands > 1; kind++)
            for (int i = 0; i < 400; i++) {
                shape tried = {(weight)w, (window)kind, 1.5 * ki_exp(0.01 * i), 0};
                tried.error = shape_error(m, bands, &tried);
                if (tried.error < best.error - 1e-6)
                    best = tried;
            }
    for (double step = 0.01; step > 1e-6 && best.window != NO_WINDOW; step /= 2)
        for (int side = -1; side <= 1; side += 2) {
            shape tried = best;
            tried.width *= 1 + side * step;
            tried.error = shape_error(m, bands, &tried);
            best = tried.error < best.error ? tried : best;
        }
    return best;
}

// ------------------------------------------------------------------------------------------- words

static void say_factor(double factor, kiln_findings *findings)
{
    static const struct {
        double factor;
        const char *text;
    } known[] = {{KI_PI, "pi times too large"},
                 {1 / KI_PI, "pi times too small"},
                 {4 * KI_PI, "4 pi times too large"},
                 {1 / (4 * KI_PI), "4 pi times too small"}};
    if (fabs(factor - 1) <= 0.02)
        return;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (fabs(factor / known[i].factor - 1) < 0.02) {
            ki_find(findings, KILN_FINDING_BRIGHTNESS, true, "all coefficients are %s",
                    known[i].text);
            return;
        }
    ki_find(findings, KILN_FINDING_BRIGHTNESS, true, "all coefficients are multiplied by %.4g",
            factor);
}

static void say_shape(const match *m, int bands, const shape *s, weight claimed,
                      kiln_findings *findings)
{
    static const char *const weights[] = {
        [RADIANCE] = "the coefficients are those of radiance, not of irradiance: the bands are not "
                     "weighted by the cosine lobe",
        [IRRADIANCE] = "the coefficients are those of irradiance, not of radiance: the bands are "
                       "weighted by the cosine lobe once too often",
        [TWICE] = "the bands are doubly weighted by the cosine lobe"};
    static const char *const windows[] = {
        [HANNING] = "Hanning", [LANCZOS] = "Lanczos (sinc)", [LANCZOS_4] = "sinc^4"};
    double two = bands > 2 ? window_of(s->window, s->width, 2) : 1;
    if (s->error > 0.05) {
        ki_find(
            findings, KILN_FINDING_WEIGHT, true,
            "the bands have unknown weights: band 1 is %.4g and band 2 is %.4g of what band 0 is",
            m->factor[1] / m->factor[0], bands > 2 ? m->factor[2] / m->factor[0] : 0);
        return;
    }
    if (s->weight != claimed)
        ki_find(findings, KILN_FINDING_WEIGHT, true, "%s", weights[s->weight]);
    if (s->window != NO_WINDOW)
        ki_find(
            findings, KILN_FINDING_WINDOW, false,
            "the bands are windowed: band 1 is reduced by %.3g %% and band 2 by %.3g %%, as by a "
            "%s window of width %.3g",
            100 * (1 - window_of(s->window, s->width, 1)), 100 * (1 - two), windows[s->window],
            s->width);
}

// Says what the factors of the bands tell. Irradiance may be divided by pi where the file does not
// claim to hold irradiance.
static void say_weights(const match *m, const kiln_sh *file, kiln_findings *findings)
{
    weight claimed = file->irradiance ? IRRADIANCE : RADIANCE;
    shape s = find_shape(m, file->bands, claimed);
    double factor = m->factor[0] / (file->irradiance ? KI_PI : 1);
    if (file->window <= 0)
        say_shape(m, file->bands, &s, claimed, findings);
    for (double scale = 1; scale < 10 && s.weight != claimed; scale *= KI_PI)
        if (fabs(m->factor[0] / scale - 1) < 0.02)
            return;
    say_factor(factor, findings);
}

static void say_basis(const match *m, kiln_findings *findings)
{
    if (m->power)
        ki_find(findings, KILN_FINDING_BASIS, true,
                "the coefficients are multiplied by the constants of the basis functions%s",
                m->power > 1 ? " twice" : "");
}

// Says how the harmonics are turned. The sign (-1)^m of Condon and Shortley is the same as a turn
// by 180 degrees about z.
static void say_axes(const ki_axes *found, const ki_axes *expected, kiln_findings *findings)
{
    const ki_axes signs = {{0, 1, 2}, {-1, -1, 1}};
    ki_axes shown = expected ? ki_axes_shown(found, expected) : *found;
    if (ki_axes_equal(&shown, &signs))
        ki_find(findings, KILN_FINDING_BASIS, true,
                "coefficients of odd order m have the wrong sign, as in a basis with the "
                "Condon-Shortley sign");
    else
        ki_say_axes(&shown, expected ? &ki_axes_none : NULL, findings);
}

// ------------------------------------------------------------------------------------------- check

static kiln_result check_arguments(const kiln_sh *sh, const kiln_engine *engine, kiln_error *error)
{
    if (sh->bands < 1 || sh->bands > KILN_MAX_BANDS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "bands is %d, it must be 1 to %d", sh->bands,
                       KILN_MAX_BANDS);
    for (int i = 0; i < sh->bands * sh->bands; i++)
        for (int c = 0; c < 3; c++)
            if (!isfinite(sh->c[i][c]))
                return ki_fail(error, KILN_ERROR_ARGUMENT,
                               "coefficient %d is %g, it must be finite", i, sh->c[i][c]);
    if (engine && !ki_recipe_of(engine))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the engine is unknown, take an engine from kiln_engine_find");
    return KILN_OK;
}

// Computes the error of the file, and the factors of its bands, against what it claims to hold.
static void measure(const kiln_sh *file, const kiln_sh *claimed, const match *m,
                    kiln_check_sh_report *report)
{
    double exact[MOST][3], difference = 0, norm = 0;
    match found = *m;
    turn(claimed, &m->axes, exact);
    find_factors(file, exact, &found);
    for (int i = 0; i < file->bands * file->bands; i++)
        for (int c = 0; c < 3; c++) {
            double d = file->c[i][c] - exact[i][c];
            difference += d * d;
            norm += exact[i][c] * exact[i][c];
        }
    report->rms = norm > 0 ? sqrt(difference / norm) : 0;
    memcpy(report->band, found.factor, sizeof report->band);
    memcpy(report->axis, m->axes.axis, sizeof report->axis);
    memcpy(report->sign, m->axes.sign, sizeof report->sign);
    report->bands = file->bands;
}

kiln_result kiln_check_sh(kiln_context *context, const kiln_map *source, const kiln_sh *sh,
                          const kiln_engine *engine, kiln_check_sh_report *report,
                          kiln_error *error)
{
    kiln_sh radiance, claimed;
    memset(report, 0, sizeof *report);
    kiln_result result = check_arguments(sh, engine, error);
    if (result == KILN_OK)
        result = kiln_map_sh(context, source, sh->bands, 0, &radiance, error);
    if (result == KILN_OK)
        result = kiln_sh_filter(&radiance, sh->bands, sh->irradiance, sh->window, &claimed, error);
    if (result != KILN_OK)
        return result;
    const ki_axes *expected = engine ? &ki_recipe_of(engine)->axes : NULL;
    match m = find_match(sh, &radiance, expected ? expected : &ki_axes_none);
    measure(sh, &claimed, &m, report);
    say_axes(&m.axes, expected, &report->findings);
    say_basis(&m, &report->findings);
    if (m.factor[0] > 0)
        say_weights(&m, sh, &report->findings);
    return KILN_OK;
}
