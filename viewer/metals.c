// Fresnel reflectance of metals. In: a metal, the cosine v.h. Out: the reflectance in linear Rec.
// 709, 0 to 1. Each wavelength from 380 to 780 nm reflects by Fresnel's equations with the metal's
// measured complex index n + ik; the spectrum under daylight (D65) is then converted to a colour.
#include "internal.h"

#include <math.h>

enum { INDICES = 15, WAVES = 41, FIRST = 380, STEP = 10 };

typedef struct index {
    double wave, n, k; // wavelength in nm; complex index of refraction n + ik
} index;

// Gold, copper and silver: Johnson and Christy, Phys. Rev. B 6, 4370 (1972). Iron and titanium:
// Johnson and Christy, Phys. Rev. B 9, 5056 (1974). Aluminium: Rakic, Appl. Opt. 34, 4755 (1995).
// The rows are copied from refractiveindex.info (public domain, CC0).
static const index indices[VIEW_METAL_COUNT][INDICES] = {
    [VIEW_MATERIAL_GOLD] = {{381.5, 1.46, 1.933},
                            {397.4, 1.47, 1.952},
                            {413.3, 1.46, 1.958},
                            {430.5, 1.45, 1.948},
                            {450.9, 1.38, 1.914},
                            {471.4, 1.31, 1.849},
                            {495.9, 1.04, 1.833},
                            {520.9, 0.62, 2.081},
                            {548.6, 0.43, 2.455},
                            {582.1, 0.29, 2.863},
                            {616.8, 0.21, 3.272},
                            {659.5, 0.14, 3.697},
                            {704.5, 0.13, 4.103},
                            {756.0, 0.14, 4.542},
                            {821.1, 0.16, 5.083}},
    [VIEW_MATERIAL_COPPER] = {{381.5, 1.33, 2.045},
                              {397.4, 1.32, 2.116},
                              {413.3, 1.28, 2.207},
                              {430.5, 1.25, 2.305},
                              {450.9, 1.24, 2.397},
                              {471.4, 1.25, 2.483},
                              {495.9, 1.22, 2.564},
                              {520.9, 1.18, 2.608},
                              {548.6, 1.02, 2.577},
                              {582.1, 0.70, 2.704},
                              {616.8, 0.30, 3.205},
                              {659.5, 0.22, 3.747},
                              {704.5, 0.21, 4.205},
                              {756.0, 0.24, 4.665},
                              {821.1, 0.26, 5.180}},
    [VIEW_MATERIAL_ALUMINIUM] = {{364.66, 0.39877, 4.3957},
                                 {413.28, 0.52135, 5.0008},
                                 {442.80, 0.60790, 5.3676},
                                 {476.87, 0.72780, 5.7781},
                                 {516.60, 0.87340, 6.2418},
                                 {563.57, 1.0728, 6.7839},
                                 {619.93, 1.3660, 7.4052},
                                 {652.25, 1.5724, 7.7354},
                                 {688.81, 1.8301, 8.0601},
                                 {729.32, 2.1606, 8.3565},
                                 {774.91, 2.6154, 8.4914},
                                 {794.78, 2.7675, 8.3866},
                                 {815.69, 2.7668, 8.2573},
                                 {837.74, 2.6945, 8.1878},
                                 {885.61, 2.2802, 8.1134}},
    [VIEW_MATERIAL_SILVER] = {{381.5, 0.05, 1.864},
                              {397.4, 0.05, 2.070},
                              {413.3, 0.05, 2.275},
                              {430.5, 0.04, 2.462},
                              {450.9, 0.04, 2.657},
                              {471.4, 0.05, 2.869},
                              {495.9, 0.05, 3.093},
                              {520.9, 0.05, 3.324},
                              {548.6, 0.06, 3.586},
                              {582.1, 0.05, 3.858},
                              {616.8, 0.06, 4.152},
                              {659.5, 0.05, 4.483},
                              {704.5, 0.04, 4.838},
                              {756.0, 0.03, 5.242},
                              {821.1, 0.04, 5.727}},
    [VIEW_MATERIAL_IRON] = {{381, 2.12, 2.50},
                            {397, 2.24, 2.58},
                            {413, 2.35, 2.65},
                            {431, 2.48, 2.71},
                            {451, 2.59, 2.77},
                            {471, 2.67, 2.82},
                            {496, 2.74, 2.88},
                            {521, 2.86, 2.91},
                            {549, 2.95, 2.93},
                            {582, 2.94, 2.99},
                            {617, 2.88, 3.05},
                            {659, 2.92, 3.10},
                            {704, 2.86, 3.19},
                            {756, 2.87, 3.28},
                            {821, 2.94, 3.39}},
    [VIEW_MATERIAL_TITANIUM] = {{381, 1.99, 2.93},
                                {397, 2.08, 2.95},
                                {413, 2.14, 2.98},
                                {431, 2.21, 3.01},
                                {451, 2.27, 3.04},
                                {471, 2.32, 3.10},
                                {496, 2.36, 3.19},
                                {521, 2.44, 3.30},
                                {549, 2.54, 3.43},
                                {582, 2.60, 3.58},
                                {617, 2.67, 3.72},
                                {659, 2.76, 3.84},
                                {704, 2.86, 3.96},
                                {756, 3.00, 4.01},
                                {821, 3.21, 4.01}},
};

// Spectral power of the CIE standard illuminant D65 from 380 to 780 nm in steps of 10 nm (CIE
// 15:2004, table T.1).
static const double daylight[WAVES] = {
    49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812,
    114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
    100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
    80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856,
    75.0870, 63.5927, 46.4182, 66.8054, 63.3828};

// One Gaussian of the fit to the CIE 1931 colour matching functions: Wyman, Sloan and Shirley, JCGT
// 2(2), 2013, section 2.2.
static double lobe(double wave, double centre, double left, double right)
{
    double t = (wave - centre) * (wave < centre ? left : right);
    return exp(-t * t / 2);
}

static void observe(double w, double xyz[3])
{
    xyz[0] = 0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
             0.065 * lobe(w, 501.1, 0.0490, 0.0382);
    xyz[1] = 0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322);
    xyz[2] = 1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725);
}

// Interpolates n and k linearly between the measured wavelengths.
static void index_at(const index *of, double wave, double *n, double *k)
{
    int i = 0;
    while (i < INDICES - 2 && of[i + 1].wave <= wave)
        i++;
    double t = fmax((wave - of[i].wave) / (of[i + 1].wave - of[i].wave), 0);
    *n = of[i].n + t * (of[i + 1].n - of[i].n);
    *k = of[i].k + t * (of[i + 1].k - of[i].k);
}

void view_metal_fresnel(view_material metal, double voh, double f[3])
{
    // Matrix from CIE XYZ to linear Rec. 709 (IEC 61966-2-1).
    static const double primaries[3][3] = {
        {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
    double seen[3] = {0}, white[3] = {0};
    for (int i = 0; i < WAVES; i++) {
        double wave = FIRST + STEP * i, n, k, xyz[3];
        index_at(indices[metal], wave, &n, &k);
        observe(wave, xyz);
        double reflected = kiln_fresnel_conductor(n, k, voh);
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < 3; j++) {
                double light = primaries[c][j] * xyz[j] * daylight[i];
                seen[c] += light * reflected;
                white[c] += light;
            }
    }
    // Dividing by `white` makes a perfect reflector (1, 1, 1). The clamp is needed because gold's
    // colour lies outside Rec. 709.
    for (int c = 0; c < 3; c++)
        f[c] = fmax(0, fmin(1, seen[c] / white[c]));
}

void view_metal_average(view_material metal, double average[3])
{
    enum { NODES = 32 }; // the midpoint rule with 32 nodes has an error of at most 1e-4
    average[0] = average[1] = average[2] = 0;
    for (int i = 0; i < NODES; i++) {
        double mu = (i + 0.5) / NODES, f[3];
        view_metal_fresnel(metal, mu, f);
        for (int c = 0; c < 3; c++)
            average[c] += 2 * f[c] * mu / NODES;
    }
}
