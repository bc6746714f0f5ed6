// Files to texels and back, one file a format. Decoders take any bytes at all: they are the
// security boundary, and everything here is fuzzed.
#ifndef KI_CODEC_H
#define KI_CODEC_H

#include "base/base.h"
#include "base/bytes.h"
#include "image/image.h"

/// What a decoder finds: a flat picture, or (KTX2, DDS) a cube with its levels.
typedef struct ki_decoded {
    bool is_map;
    kiln_image image;
    kiln_map map;
} ki_decoded;

/// Reads any file kiln can read, told by its first bytes. `name` stands in messages. With `info`
/// not NULL it is filled, and with `decoded` NULL the texels are not read.
kiln_result ki_decode(kiln_context *context, const uint8_t *bytes, size_t size, const char *name,
                      ki_decoded *decoded, kiln_file_info *info, kiln_error *error);
void ki_decoded_free(ki_decoded *decoded);

/// Decimal numbers with a point, whatever the program's locale is. Parsing returns what follows the
/// number, or NULL where there is none; it is right to about 15 digits.
const char *ki_parse_number(const char *text, double *value);
/// Nine digits: enough for a float to come back as it was.
void ki_write_number(ki_writer *writer, double value);

kiln_result ki_exr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error);
kiln_result ki_hdr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error);
kiln_result ki_png_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error);
kiln_result ki_ktx2_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, kiln_map *map, kiln_file_info *info,
                           kiln_error *error);
kiln_result ki_dds_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_map *map, kiln_file_info *info, kiln_error *error);

/// The size of a picture's faces and how they lie, from its sides; NULL where they fit no layout.
const char *ki_layout_name(int width, int height);

/// Encoders append a whole file. KTX2 and DDS take cubes with all levels.
kiln_result ki_ktx2_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                           kiln_error *error);
kiln_result ki_dds_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                          kiln_error *error);
/// `width` * `height` texels of `channels` (1 to 4) floats, ZIP.
typedef struct ki_exr_options {
    bool half;       ///< false: 32-bit floats
    bool panorama;   ///< says so in the attribute "envmap"
    bool octahedron; ///< says so in the attribute "kilnShape"
    float roughness; ///< the attribute "kilnRoughness"; negative for none
} ki_exr_options;
kiln_result ki_exr_encode(const float *pixels, int width, int height, int channels,
                          const ki_exr_options *options, ki_writer *writer, kiln_error *error);
kiln_result ki_hdr_encode(const float *pixels, int width, int height, ki_writer *writer,
                          kiln_error *error);
/// 8 bits. `srgb`: encode linear values by the sRGB curve; else values are stored as they are.
kiln_result ki_png_encode(const float *pixels, int width, int height, int channels, bool srgb,
                          ki_writer *writer, kiln_error *error);

#endif
