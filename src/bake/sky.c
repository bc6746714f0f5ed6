// An analytic daylight sky (docs/theory/sky.md). In: elevation and azimuth of the sun, turbidity
// and the ground's albedo. Out: a panorama of sky, sun disc and ground in kcd/m^2. Method:
// Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999, whose
// tables and equations are cited by number below. The disc of the sun is integrated over each
// texel, so that its irradiance is exact at every size.
#include "bake/sky.h"

#include "math/math.h"

#include <math.h>

const double ki_sun_radius = 0.533 / 2 * (KI_PI / 180);

// ------------------------------------------------------------------------------------------ colour

// Converts XYZ to linear Rec. 709 with the white point D65 by IEC 61966-2-1.
static void rgb_from_xyz(const double xyz[3], double rgb[3])
{
    static const double m[3][3] = {
        {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
    for (int i = 0; i < 3; i++)
        rgb[i] = m[i][0] * xyz[0] + m[i][1] * xyz[1] + m[i][2] * xyz[2];
}

// Mixes a colour outside Rec. 709 with grey of the same luminance until no channel is negative.
static void into_gamut(double luminance, double rgb[3])
{
    double lowest = rgb[0] < rgb[1] ? rgb[0] : rgb[1];
    lowest = rgb[2] < lowest ? rgb[2] : lowest;
    if (lowest >= 0)
        return;
    double keep = luminance / (luminance - lowest);
    for (int i = 0; i < 3; i++) {
        double mixed = luminance + keep * (rgb[i] - luminance);
        rgb[i] = mixed > 0 ? mixed : 0;
    }
}

static double lobe(double x, double mean, double left, double right)
{
    double t = (x - mean) / (x < mean ? left : right);
    return ki_exp(-0.5 * t * t);
}

// Computes the colour matching functions of the CIE 1931 observer by the multi-lobe fits of Wyman,
// Sloan and Shirley 2013, table 1. The wavelength w is in nm.
static void colour_matching(double w, double xyz[3])
{
    xyz[0] = 1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) -
             0.065 * lobe(w, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8);
}

// --------------------------------------------------------------------------------------------- sun

// Spectra from 380 to 750 nm in steps of 10 nm, from table 2 of Preetham et al. 1999: radiance of
// the sun above the atmosphere in 100 W / (m^2 sr nm), and absorption of ozone (1/cm) and water
// vapour (1/cm).
enum { BANDS = 38 };
static const double sun_above[BANDS] = {
    165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6, 306.6, 288.3, 287.1,
    278.2, 271.0, 272.3, 263.6, 255.0, 250.6, 253.1, 253.5, 251.3, 246.3, 241.7, 236.8, 232.1,
    228.2, 223.4, 219.7, 215.3, 211.0, 207.3, 202.4, 198.7, 194.3, 190.7, 186.3, 182.6};
static const double ozone[BANDS] = {
    0,     0,     0,     0,     0,     0,     0,     0.003, 0.006, 0.009, 0.014, 0.021, 0.030,
    0.040, 0.048, 0.063, 0.075, 0.085, 0.103, 0.120, 0.120, 0.115, 0.125, 0.120, 0.105, 0.090,
    0.079, 0.067, 0.057, 0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009};
static const double water[BANDS] = {
    [31] = 0.016, [32] = 0.024, [33] = 0.0125, [34] = 1.0, [35] = 0.87, [36] = 0.061, [37] = 0.001};

// Computes the radiance of the sun, at `theta` from the zenith, through the atmosphere by Preetham
// et al. 1999, appendix "Sun Spectral Radiance". Mixed gases absorb only from 760 nm on and are
// therefore left out.
static void sun_radiance(double theta, double turbidity, double rgb[3])
{
    double degrees = theta * (180 / KI_PI);
    double mass = 1 / (ki_cos(theta) + 0.15 * ki_pow(93.885 - degrees, -1.253));
    double aerosols = 0.04608 * turbidity - 0.04586;
    double xyz[3] = {0};
    for (int i = 0; i < BANDS; i++) {
        double nm = 380 + 10 * i, um = nm / 1000, match[3];
        double depth = 0.008735 * ki_pow(um, -4.08) * mass; // optical depth of Rayleigh scattering
        depth += aerosols * ki_pow(um, -1.3) * mass;        // optical depth of aerosols (Angstrom)
        depth += ozone[i] * 0.35 * mass;                    // optical depth of 0.35 cm of ozone
        double w = water[i] * 2 * mass; // absorption times the amount of water, 2 cm
        depth += 0.2385 * w / ki_pow(1 + 20.07 * w, 0.45);
        double radiance = sun_above[i] * 100 * ki_exp(-depth);
        colour_matching(nm, match);
        for (int k = 0; k < 3; k++)
            xyz[k] += radiance * match[k];
    }
    // Turns the sum over wavelengths into luminance: 10 nm between the samples of the spectrum, 683
    // lm/W, and 1e-3 for kcd.
    for (int k = 0; k < 3; k++)
        xyz[k] *= 10 * 683 * 1e-3;
    rgb_from_xyz(xyz, rgb);
    into_gamut(xyz[1], rgb);
}

// Returns half the width in azimuth of the part of the sun's disc that lies on the circle of
// directions at the angle `theta` from the zenith.
static double disc_half_width(double sun_theta, double theta)
{
    double s = ki_sin(theta) * ki_sin(sun_theta), numerator;
    numerator = ki_cos(ki_sun_radius) - ki_cos(theta) * ki_cos(sun_theta);
    if (!(s > 1e-12))
        return numerator < 0 ? KI_PI : 0;
    return ki_acos(ki_clamp(numerator / s, -1, 1));
}

// Number of circles of constant theta over which the sun's disc is summed, between two angles theta
// from the zenith. The circles are evenly spaced in the arcsine of their distance from the disc's
// centre, so that the square root of the chord's length at the disc's edge does not slow the
// convergence of the sum.
enum { CIRCLES = 128 };

static bool disc_circles(double sun_theta, double low, double high, double theta[CIRCLES],
                         double step[CIRCLES])
{
    low = ki_clamp((low - sun_theta) / ki_sun_radius, -1, 1);
    high = ki_clamp((high - sun_theta) / ki_sun_radius, -1, 1);
    if (!(high > low))
        return false;
    double from = ki_asin(low), size = (ki_asin(high) - from) / CIRCLES;
    for (int i = 0; i < CIRCLES; i++) {
        double sine, cosine;
        ki_sincos(from + size * (i + 0.5), &sine, &cosine);
        theta[i] = sun_theta + ki_sun_radius * sine;
        step[i] = ki_sun_radius * cosine * size;
    }
    return true;
}

// Adds the part of the sun's disc within a row to the row's texels: radiance times the share of
// each texel that the disc covers. The share is found from the overlap of the disc's arcs of
// constant theta with the texel's columns.
static void paint_disc(const ki_sky *sky, double low, double high, double area, int width,
                       float *texel)
{
    double theta[CIRCLES], step[CIRCLES], column = 2 * KI_PI / width;
    high = high < KI_PI / 2 ? high : KI_PI / 2;
    if (!disc_circles(sky->sun_theta, low, high, theta, step))
        return;
    double centre = (sky->sun_azimuth + KI_PI) / column;
    for (int i = 0; i < CIRCLES; i++) {
        if (theta[i] <= 0)
            continue;
        double half = disc_half_width(sky->sun_theta, theta[i]) / column;
        double share = ki_sin(theta[i]) * step[i] * column / area;
        for (int x = (int)floor(centre - half); x < centre + half; x++) {
            double from = x > centre - half ? x : centre - half;
            double to = x + 1 < centre + half ? x + 1 : centre + half;
            int wrapped = ((x % width) + width) % width;
            for (int c = 0; c < 3; c++)
                texel[3 * wrapped + c] += (float)(sky->sun_radiance[c] * share * (to - from));
        }
    }
}

// Returns the irradiance of the ground from a sun's disc of radiance 1: the integral of cos theta
// over the part of the disc above the horizon.
static double disc_on_ground(double sun_theta)
{
    double theta[CIRCLES], step[CIRCLES], sum = 0;
    if (disc_circles(sun_theta, 0, KI_PI / 2, theta, step))
        for (int i = 0; i < CIRCLES; i++)
            if (theta[i] > 0)
                sum += ki_sin(theta[i]) * ki_cos(theta[i]) * step[i] * 2 *
                       disc_half_width(sun_theta, theta[i]);
    return sum;
}

// --------------------------------------------------------------------------------------------- sky

// Perez's function F, Preetham et al. 1999, eq. 2, is the product of a factor of the angle from the
// zenith and a factor of the angle gamma from the sun.
static double perez_height(const double p[5], double cos_theta)
{
    double f = 1 + p[0] * ki_exp(p[1] / (cos_theta > 1e-3 ? cos_theta : 1e-3));
    return f > 0 ? f : 0;
}

static double perez_sun(const double p[5], double gamma, double cos_gamma)
{
    double f = 1 + p[2] * ki_exp(p[3] * gamma) + p[4] * cos_gamma * cos_gamma;
    return f > 0 ? f : 0;
}

static double cubic(const double c[4], double x)
{
    return ((c[0] * x + c[1]) * x + c[2]) * x + c[3];
}

// Sets the coefficients of Perez's function for the luminance Y and the chromaticities x and y, and
// their values at the zenith, at turbidity t, from the appendix of Preetham et al. 1999.
static void set_perez(ki_sky *sky, double t, double sun_theta)
{
    static const double slope[3][5] = {{0.1787, -0.3554, -0.0227, 0.1206, -0.0670},
                                       {-0.0193, -0.0665, -0.0004, -0.0641, -0.0033},
                                       {-0.0167, -0.0950, -0.0079, -0.0441, -0.0109}};
    static const double start[3][5] = {{-1.4630, 0.4275, 5.3251, -2.5771, 0.3703},
                                       {-0.2592, 0.0008, 0.2125, -0.8989, 0.0452},
                                       {-0.2608, 0.0092, 0.2102, -1.6537, 0.0529}};
    static const double chroma[2][3][4] = {{{0.00166, -0.00375, 0.00209, 0},
                                            {-0.02903, 0.06377, -0.03202, 0.00394},
                                            {0.11693, -0.21196, 0.06052, 0.25886}},
                                           {{0.00275, -0.00610, 0.00317, 0},
                                            {-0.04214, 0.08970, -0.04153, 0.00516},
                                            {0.15346, -0.26756, 0.06670, 0.26688}}};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 5; i++)
            sky->perez[k][i] = slope[k][i] * t + start[k][i];

    double sine, cosine;
    ki_sincos((4.0 / 9 - t / 120) * (KI_PI - 2 * sun_theta), &sine, &cosine);
    sky->zenith[0] = (4.0453 * t - 4.9710) * (sine / cosine) - 0.2155 * t + 2.4192;
    for (int k = 0; k < 2; k++)
        sky->zenith[1 + k] =
            (cubic(chroma[k][0], sun_theta) * t + cubic(chroma[k][1], sun_theta)) * t +
            cubic(chroma[k][2], sun_theta);
    for (int k = 0; k < 3; k++) {
        const double *p = sky->perez[k];
        sky->zenith[k] /= perez_height(p, 1) * perez_sun(p, sun_theta, ki_cos(sun_theta));
    }
}

// Computes the radiance of the sky, without the sun's disc, in a direction. `height` holds the
// factors of Perez's function that depend only on the angle from the zenith, which are constant
// along a row.
static void radiance(const ki_sky *sky, const double height[3], const double direction[3],
                     double rgb[3])
{
    const double *d = direction, *s = sky->sun;
    double cos_gamma = ki_clamp(d[0] * s[0] + d[1] * s[1] + d[2] * s[2], -1, 1);
    double gamma = ki_acos(cos_gamma), value[3];
    for (int k = 0; k < 3; k++)
        value[k] = sky->zenith[k] * height[k] * perez_sun(sky->perez[k], gamma, cos_gamma);
    double luminance = value[0] * sky->fade, y = value[2] > 1e-3 ? value[2] : 1e-3;
    double z = 1 - value[1] - value[2];
    double xyz[3] = {value[1] / y * luminance, luminance, z > 0 ? z / y * luminance : 0};
    rgb_from_xyz(xyz, rgb);
    into_gamut(luminance, rgb);
}

void ki_sky_radiance(const ki_sky *sky, const double direction[3], double rgb[3])
{
    double height[3];
    for (int k = 0; k < 3; k++)
        height[k] = perez_height(sky->perez[k], direction[1]);
    radiance(sky, height, direction, rgb);
}

// Computes the irradiance of the ground from the sky without the sun's disc.
static void sky_on_ground(const ki_sky *sky, double irradiance[3])
{
    enum { HEIGHTS = 48, AZIMUTHS = 96 };
    double node[HEIGHTS], weight[HEIGHTS];
    ki_gauss_legendre(HEIGHTS, node, weight);
    irradiance[0] = irradiance[1] = irradiance[2] = 0;
    for (int j = 0; j < HEIGHTS; j++) {
        // The irradiance is the integral of radiance times cos theta over the hemisphere. The
        // quadrature is in cos^2 theta, whose differential is 2 cos theta sin theta dtheta.
        double square = 0.5 * (1 + node[j]), cos_theta = sqrt(square), sin_theta = sqrt(1 - square);
        for (int i = 0; i < AZIMUTHS; i++) {
            double sine, cosine, rgb[3];
            ki_sincos(sky->sun_azimuth + 2 * KI_PI * i / AZIMUTHS, &sine, &cosine);
            double d[3] = {sin_theta * sine, cos_theta, -sin_theta * cosine};
            ki_sky_radiance(sky, d, rgb);
            for (int c = 0; c < 3; c++)
                irradiance[c] += rgb[c] * (0.5 * weight[j] * KI_PI / AZIMUTHS);
        }
    }
}

void ki_sky_prepare(ki_sky *sky, double elevation, double azimuth, double turbidity, double albedo)
{
    double sine, cosine, irradiance[3];
    *sky = (ki_sky){.fade = 1};
    azimuth = fmod(azimuth, 360);
    sky->sun_theta = (90 - elevation) * (KI_PI / 180);
    sky->sun_azimuth = (azimuth > 180     ? azimuth - 360
                        : azimuth <= -180 ? azimuth + 360
                                          : azimuth) *
                       (KI_PI / 180);
    ki_sincos(sky->sun_azimuth, &sine, &cosine);
    sky->sun[0] = ki_sin(sky->sun_theta) * sine;
    sky->sun[1] = ki_cos(sky->sun_theta);
    sky->sun[2] = -ki_sin(sky->sun_theta) * cosine;

    // The sun's model holds until the sun is on the horizon, and that of the sky also only from
    // turbidity 2 on. Outside of these ranges the nearest value in range is used.
    double theta = sky->sun_theta < KI_PI / 2 ? sky->sun_theta : KI_PI / 2;
    set_perez(sky, turbidity > 2 ? turbidity : 2, theta);
    if (elevation < 0)
        sky->fade = ki_exp(-0.83 * elevation * elevation / (1 - elevation));
    sun_radiance(theta, turbidity, sky->sun_radiance);

    sky_on_ground(sky, irradiance);
    double sun = disc_on_ground(sky->sun_theta);
    for (int c = 0; c < 3; c++)
        sky->ground[c] = albedo / KI_PI * (irradiance[c] + sun * sky->sun_radiance[c]);
}

// ----------------------------------------------------------------------------------------- picture

typedef struct painter {
    const ki_sky *sky;
    kiln_map *map;
    int first_row;
} painter;

static void paint_row(void *data, int index)
{
    const painter *p = data;
    const ki_sky *sky = p->sky;
    int row = p->first_row + index, size = p->map->size, width = 2 * size;
    float *texel = p->map->level[0] + 3 * (size_t)row * (size_t)width;
    double low = KI_PI * row / size, high = KI_PI * (row + 1) / size;

    // above: the share of a texel's solid angle that is sky, in a row that the horizon crosses.
    double top = ki_cos(low), bottom = ki_cos(high), above = 1;
    if (2 * (row + 1) > size)
        above = 2 * row >= size ? 0 : top / (top - bottom);
    double theta = 0.5 * (low + (high < KI_PI / 2 ? high : KI_PI / 2));
    double sin_theta, cos_theta, height[3];
    ki_sincos(theta, &sin_theta, &cos_theta);
    for (int k = 0; k < 3; k++)
        height[k] = perez_height(sky->perez[k], cos_theta);

    for (int x = 0; x < width; x++) {
        double rgb[3] = {0}, sine, cosine;
        if (above > 0) {
            ki_sincos(2 * KI_PI * ((x + 0.5) / width - 0.5), &sine, &cosine);
            double d[3] = {sin_theta * sine, cos_theta, -sin_theta * cosine};
            radiance(sky, height, d, rgb);
        }
        for (int c = 0; c < 3; c++)
            texel[3 * x + c] = (float)(above * rgb[c] + (1 - above) * sky->ground[c]);
    }
    if (above > 0)
        paint_disc(sky, low, high, (top - bottom) * (2 * KI_PI / width), width, texel);
}

kiln_result ki_sky_paint(kiln_context *context, const ki_sky *sky, kiln_map *map, kiln_error *error)
{
    enum { ROWS = 64 };
    static const char stage[] = "sky";
    painter p = {sky, map, 0};
    for (; p.first_row < map->size; p.first_row += ROWS) {
        if (!ki_progress(context, stage, (double)p.first_row / map->size))
            return ki_fail_cancelled(error, stage);
        ki_parallel_for(context, ki_min(ROWS, map->size - p.first_row), paint_row, &p);
    }
    return ki_progress(context, stage, 1) ? KILN_OK : ki_fail_cancelled(error, stage);
}

static kiln_result check_range(const char *name, double value, double low, double high,
                               kiln_error *error)
{
    if (!(value >= low && value <= high))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s of the sky is %g, it must be %g to %g", name,
                       value, low, high);
    return KILN_OK;
}

// Returns the value of an option for which 0 stands for a default and KILN_ZERO for 0.
static double or_default(double value, double standard)
{
    if (value == KILN_ZERO)
        return 0;
    return value != 0 ? value : standard;
}

kiln_result kiln_sky(kiln_context *context, const kiln_sky_def *def, kiln_map *map,
                     kiln_error *error)
{
    kiln_sky_def d = def ? *def : (kiln_sky_def){0};
    *map = (kiln_map){0};
    d.size = d.size ? d.size : 512;
    d.elevation = or_default(d.elevation, 30);
    d.turbidity = d.turbidity != 0 ? d.turbidity : 3;
    d.albedo = or_default(d.albedo, 0.2);
    kiln_result result = check_range("size", d.size, 16, 8192, error);
    if (!result)
        result = check_range("elevation", d.elevation, -5, 90, error);
    if (!result)
        result = check_range("turbidity", d.turbidity, 1.7, 10, error);
    if (!result)
        result = check_range("albedo", d.albedo, 0, 1, error);
    if (!result && !isfinite(d.azimuth))
        result = ki_fail(error, KILN_ERROR_ARGUMENT, "azimuth of the sky is %g, it must be finite",
                         d.azimuth);
    if (!result)
        result = kiln_map_create(context, KILN_SHAPE_PANORAMA, d.size, 1, map, error);
    if (result)
        return result;

    ki_sky sky;
    ki_sky_prepare(&sky, d.elevation, d.azimuth, d.turbidity, d.albedo);
    result = ki_sky_paint(context, &sky, map, error);
    if (result)
        kiln_map_free(map);
    return result;
}
