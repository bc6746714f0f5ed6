// Files to texels and back, one file a format. Decoders take any bytes at all: they are the
// security boundary, and everything here is fuzzed.
#ifndef KI_CODEC_H
#define KI_CODEC_H

#include "base/base.h"
#include "base/bytes.h"
#include "image/image.h"

#include <kiln/brdf.h>

/// What a decoder finds: a flat picture of three channels, or (KTX2, DDS) a cube with its levels, or
/// (KTX2) a table in `image`, its slices one below the other, of 1, 2 or 4 channels that may be negative.
typedef struct ki_decoded {
    bool is_map, is_table;
    kiln_image image;
    kiln_map map;
} ki_decoded;

/// Reads any file kiln can read, told by its first bytes. `name` stands in messages. With `info`
/// not NULL it is filled, and with `decoded` NULL the texels are not read.
kiln_result ki_decode(kiln_context *context, const uint8_t *bytes, size_t size, const char *name,
                      ki_decoded *decoded, kiln_file_info *info, kiln_error *error);
void ki_decoded_free(ki_decoded *decoded);

kiln_result ki_exr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error);
kiln_result ki_hdr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error);
kiln_result ki_png_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error);
/// KTX2 is a cube or a table, DDS a cube; an atlas in DDS is described alone. `decoded` may be NULL, `info`
/// not.
kiln_result ki_ktx2_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, ki_decoded *decoded, kiln_file_info *info,
                           kiln_error *error);
kiln_result ki_dds_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, ki_decoded *decoded, kiln_file_info *info,
                          kiln_error *error);

/// Encoders append a whole file. KTX2 and DDS take cubes with all levels.
kiln_result ki_ktx2_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                           kiln_error *error);
kiln_result ki_dds_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                          kiln_error *error);
/// A square picture of four channels as halves, with the name of an engine.
kiln_result ki_dds_encode_atlas(const kiln_image *image, const char *engine, ki_writer *writer,
                                kiln_error *error);
/// A table of `depth` slices one below the other, 3-D where there are several. `text` says what it is.
kiln_result ki_ktx2_encode_table(const kiln_image *image, int depth, const char *text,
                                 kiln_table_format format, int zstd, ki_writer *writer,
                                 kiln_error *error);
/// `width` * `height` texels of `channels` (1 to 4) floats, ZIP.
typedef struct ki_exr_options {
    bool half;          ///< false: 32-bit floats
    bool panorama;      ///< says so in the attribute "envmap"
    bool octahedron;    ///< says so in the attribute "kilnShape"
    float roughness;    ///< the attribute "kilnRoughness"; negative for none
    const char *table;  ///< the attribute "kilnTable"; may be NULL
    const char *engine; ///< the attribute "kilnEngine", by ki_engine_text_write; may be NULL
} ki_exr_options;
kiln_result ki_exr_encode(const float *pixels, int width, int height, int channels,
                          const ki_exr_options *options, ki_writer *writer, kiln_error *error);
kiln_result ki_hdr_encode(const float *pixels, int width, int height, ki_writer *writer,
                          kiln_error *error);
/// How a PNG holds values of 0 to 1: by the sRGB curve, or as they are.
typedef enum ki_png_coding { KI_PNG_SRGB8, KI_PNG_PLAIN8, KI_PNG_PLAIN16 } ki_png_coding;
kiln_result ki_png_encode(const float *pixels, int width, int height, int channels,
                          ki_png_coding coding, ki_writer *writer, kiln_error *error);

#endif
