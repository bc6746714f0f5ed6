// PNG files whose four bytes a texel hold radiance: RGBM, RGBD, RGBP.
#ifndef KI_RGBX_PNG_H
#define KI_RGBX_PNG_H

#include "base/bytes.h"
#include "codec/rgbx.h"

/// Writes an image of three channels; `upward`: the last row first, as Babylon.js and glTF have it.
kiln_result ki_rgbx_png_encode(const kiln_image *image, ki_rgbx *pack, bool upward,
                               ki_writer *writer, kiln_error *error);

#endif
