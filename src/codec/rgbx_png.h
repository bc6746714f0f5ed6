// PNG files with radiance in four bytes a texel: RGBM, RGBD or RGBP.
#ifndef KI_RGBX_PNG_H
#define KI_RGBX_PNG_H

#include "base/bytes.h"
#include "codec/rgbx.h"

/// Appends a PNG file with an image of three channels. `upward` stores the bottom row first, as
/// Babylon.js and glTF require.
kiln_result ki_rgbx_png_encode(const kiln_image *image, ki_rgbx *pack, bool upward,
                               ki_writer *writer, kiln_error *error);

/// Decodes a PNG file as ki_png_decode does, but takes its four samples of 8 bits as radiance that
/// `unpack` computes, whatever the file says. `unpack`, `info` and `report` may be NULL.
kiln_result ki_png_decode_as(kiln_context *context, const uint8_t *bytes, size_t size,
                             const char *name, ki_from_rgbx *unpack, kiln_image *image,
                             kiln_file_info *info, kiln_load_report *report, kiln_error *error);

/// Decodes a PNG file in RGBD whose bottom row comes first, as Babylon.js and glTF store it, to
/// face `index` % 6 of level `index` / 6 of a cube. Fails if the picture has another size than the
/// face.
kiln_result ki_rgbd_png_decode_face(kiln_context *context, const uint8_t *bytes, size_t size,
                                    const char *name, int index, kiln_map *map, kiln_error *error);
/// Fails if `byte_count` bytes are too few for the PNG files of six faces of `size` texels along an
/// edge, so that a short file cannot ask for memory for a huge cube.
kiln_result ki_rgbd_png_check_size(int size, uint64_t byte_count, const char *name,
                                   kiln_error *error);

#endif
