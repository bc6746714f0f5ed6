// PNG files with radiance in four bytes a texel: RGBM, RGBD or RGBP.
#ifndef KI_RGBX_PNG_H
#define KI_RGBX_PNG_H

#include "base/bytes.h"
#include "codec/rgbx.h"

/// Appends a PNG file with an image of three channels. `upward` stores the bottom row first, as
/// Babylon.js and glTF require.
kiln_result ki_rgbx_png_encode(const kiln_image *image, ki_rgbx *pack, bool upward,
                               ki_writer *writer, kiln_error *error);

#endif
