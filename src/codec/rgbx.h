// Radiance in four bytes a texel (RGBM, RGBP, RGBD): the three colours are stored by a root, and
// alpha holds the number by which they are multiplied or divided.
#ifndef KI_RGBX_H
#define KI_RGBX_H

#include "base/base.h"

/// The largest radiance of each format; greater values are stored as this limit.
enum { KI_RGBM_MAX = 64, KI_RGBP_MAX = 64, KI_RGBD_MAX = 255 };

/// Convert one texel of RGB radiance, not negative, to four numbers in [0, 1] for storage in 8 bits
/// each. The fourth number a is a multiple of 1/255. With c a stored colour:
///   RGBM (PlayCanvas)  radiance = (8 a c)^2
///   RGBP (PlayCanvas)  radiance = ((8 - 7 a) c)^2
///   RGBD (Babylon.js)  radiance = c^2.2 / a
void ki_rgbm_from_float(const float rgb[3], float rgbm[4]);
void ki_rgbp_from_float(const float rgb[3], float rgbp[4]);
void ki_rgbd_from_float(const float rgb[3], float rgbd[4]);
/// Convert the four stored numbers of a texel to RGB radiance.
void ki_float_from_rgbm(const float rgbm[4], float rgb[3]);
void ki_float_from_rgbp(const float rgbp[4], float rgb[3]);
void ki_float_from_rgbd(const float rgbd[4], float rgb[3]);

typedef void ki_rgbx(const float rgb[3], float rgbx[4]);
typedef void ki_from_rgbx(const float rgbx[4], float rgb[3]);

#endif
