// Decoders and encoders of picture files, each format in a file of its own. Decoders accept
// arbitrary bytes: they are the security boundary of the library, and all of them are fuzzed.
#ifndef KI_CODEC_H
#define KI_CODEC_H

#include "base/base.h"
#include "base/bytes.h"
#include "image/image.h"

#include <kiln/brdf.h>

/// The content of a decoded file. If `is_map`, `map` is a cube with its levels (KTX2, DDS). If
/// `is_table`, `image` is a table (KTX2) whose slices lie one below the other and whose 1, 2 or 4
/// channels may be negative. Otherwise `image` is a flat picture of three channels. Texels have the
/// file's values, even infinite ones and values that are not a number, which ki_map_mend replaces
/// later.
typedef struct ki_decoded {
    bool is_map, is_table;
    kiln_image image;
    kiln_map map;
    kiln_load_report report; ///< notes of the reader, and the number of pixels that the file lacks
} ki_decoded;

/// Decodes any file that kiln can read; the first bytes decide the format. `name` appears in error
/// messages. `info`, if not NULL, is filled in. If `decoded` is NULL, the texels are not read.
kiln_result ki_decode(kiln_context *context, const uint8_t *bytes, size_t size, const char *name,
                      ki_decoded *decoded, kiln_file_info *info, kiln_error *error);
/// Decodes as ki_decode does, from an EXR file the layer that is named; `layer` may be NULL.
kiln_result ki_decode_layer(kiln_context *context, const uint8_t *bytes, size_t size,
                            const char *name, const char *layer, ki_decoded *decoded,
                            kiln_file_info *info, kiln_error *error);
/// Reads a whole file and decodes it as ki_decode_layer does.
kiln_result ki_decode_file(kiln_context *context, const char *path, const char *layer,
                           ki_decoded *decoded, kiln_file_info *info, kiln_error *error);
void ki_decoded_free(ki_decoded *decoded);

/// Decode a picture. `image`, `info` and `report` may be NULL; without `image` the texels are not
/// read. `layer`, which may be NULL, names a layer of an EXR file.
kiln_result ki_exr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, const char *layer, kiln_image *image,
                          kiln_file_info *info, kiln_load_report *report, kiln_error *error);
kiln_result ki_hdr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_load_report *report, kiln_error *error);
kiln_result ki_png_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_load_report *report, kiln_error *error);
kiln_result ki_jpeg_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, kiln_image *image, kiln_file_info *info,
                           kiln_load_report *report, kiln_error *error);
/// Decode a KTX2 file, which holds a cube or a table, or a DDS file, which holds a cube. A DDS file
/// may also hold an atlas, one flat picture with all levels for an engine: with `decoded` NULL the
/// file is described in `info`, otherwise the function fails. `info` must not be NULL.
kiln_result ki_ktx2_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, ki_decoded *decoded, kiln_file_info *info,
                           kiln_error *error);
kiln_result ki_dds_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, ki_decoded *decoded, kiln_file_info *info,
                          kiln_error *error);

/// Append a whole KTX2 or DDS file, which holds a cube with all its levels, to `writer`.
kiln_result ki_ktx2_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                           kiln_error *error);
kiln_result ki_dds_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                          kiln_error *error);
/// Appends a DDS file that holds an atlas, one square picture with all levels for an engine, as
/// four half floats a texel, and the engine's name.
kiln_result ki_dds_encode_atlas(const kiln_image *image, const char *engine, ki_writer *writer,
                                kiln_error *error);
/// Appends a KTX2 file with one flat picture of three channels, whose lowest row is the first of
/// `image`, as engines store atlases. `engine` is the text of ki_engine_text_write.
kiln_result ki_ktx2_encode_picture(const kiln_image *image, const kiln_save_def *def,
                                   const char *engine, ki_writer *writer, kiln_error *error);
/// Appends a KTX2 file with a table of the reflection model, whose `depth` slices lie one below the
/// other in `image`. Several slices become a 3-D texture. `text`, the table's description, is
/// stored in the metadata.
kiln_result ki_ktx2_encode_table(const kiln_image *image, int depth, const char *text,
                                 kiln_table_format format, int zstd, ki_writer *writer,
                                 kiln_error *error);
/// Options of an EXR file of `width` * `height` texels of `channels` (1 to 4) floats. The file is
/// always compressed by ZIP.
typedef struct ki_exr_options {
    bool half; ///< true: 16-bit floats; false: 32-bit floats
    /// True: writes the attribute "envmap", which says that the picture is a panorama.
    bool panorama;
    /// True: writes the attribute "kilnShape", which says that the picture is an octahedron.
    bool octahedron;
    float roughness;   ///< value of the attribute "kilnRoughness"; negative for no attribute
    const char *table; ///< value of the attribute "kilnTable"; NULL for no attribute
    /// Value of the attribute "kilnEngine", by ki_engine_text_write; NULL for no attribute.
    const char *engine;
} ki_exr_options;
kiln_result ki_exr_encode(const float *pixels, int width, int height, int channels,
                          const ki_exr_options *options, ki_writer *writer, kiln_error *error);
kiln_result ki_hdr_encode(const float *pixels, int width, int height, ki_writer *writer,
                          kiln_error *error);
/// How a PNG file stores values of 0 to 1: in 8 bits by the sRGB curve, in 8 bits linearly, or in
/// 16 bits linearly.
typedef enum ki_png_coding { KI_PNG_SRGB8, KI_PNG_PLAIN8, KI_PNG_PLAIN16 } ki_png_coding;
kiln_result ki_png_encode(const float *pixels, int width, int height, int channels,
                          ki_png_coding coding, ki_writer *writer, kiln_error *error);

#endif
