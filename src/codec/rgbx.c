#include "codec/rgbx.h"

#include "math/math.h"

#include <math.h>

static float largest_of(const float rgb[3])
{
    return fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
}

// Sets the stored colours: the square roots of radiance divided by `scale`, clamped to [0, 1].
static void put_roots(const float rgb[3], double scale, float color[3])
{
    for (int c = 0; c < 3; c++)
        color[c] = rgb[c] > 0 ? (float)ki_clamp(sqrt((double)rgb[c]) / scale, 0, 1) : 0;
}

// RGBM multiplies stored colours by 8 alpha. Alpha, in steps of 1/255, is rounded up, so that no
// colour exceeds 1, and is at least one step and at most 255.
void ki_rgbm_from_float(const float rgb[3], float rgbm[4])
{
    double root = sqrt(fmax((double)largest_of(rgb), 0));
    double steps = ki_clamp(ceil(root / 8 * 255), 1, 255);
    put_roots(rgb, 8 * steps / 255, rgbm);
    rgbm[3] = (float)(steps / 255);
}

// RGBP multiplies stored colours by 8 - 7 alpha, which must not be too small for the largest
// colour. Alpha is therefore rounded down to a step of 1/255.
void ki_rgbp_from_float(const float rgb[3], float rgbp[4])
{
    double root = sqrt(fmax((double)largest_of(rgb), 0));
    double steps = ki_clamp(floor((8 - root) / 7 * 255), 0, 255);
    put_roots(rgb, 8 - 7 * steps / 255, rgbp);
    rgbp[3] = (float)(steps / 255);
}

// RGBD divides decoded colours by alpha. Alpha is the greatest of the numbers 1/255, 2/255, ..., 1
// for which the largest channel of radiance times alpha is at most 1.
void ki_rgbd_from_float(const float rgb[3], float rgbd[4])
{
    float largest = largest_of(rgb);
    float quotient = largest > 1 ? floorf(255 / largest) : 255;
    rgbd[3] = fmaxf(quotient, 1) / 255;
    for (int c = 0; c < 3; c++) {
        double share = ki_clamp((double)rgb[c] * (double)rgbd[3], 0, 1);
        rgbd[c] = share > 0 ? (float)ki_pow(share, 1 / 2.2) : 0;
    }
}

void ki_float_from_rgbm(const float rgbm[4], float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        float root = 8 * rgbm[3] * rgbm[c];
        rgb[c] = root * root;
    }
}

void ki_float_from_rgbp(const float rgbp[4], float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        float root = (8 - 7 * rgbp[3]) * rgbp[c];
        rgb[c] = root * root;
    }
}

void ki_float_from_rgbd(const float rgbd[4], float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        double power = rgbd[c] > 0 ? ki_pow((double)rgbd[c], 2.2) : 0;
        rgb[c] = (float)(power / fmax((double)rgbd[3], 1.0 / 255));
    }
}
