// The container format of KTX2, by the Khronos specification 2.0.4, for cubes and tables. The index
// lists the levels with the largest first, the texels are stored with the smallest level first, and
// each level may be compressed by zstd.
#ifndef KI_KTX2_H
#define KI_KTX2_H

#include "codec/codec.h"
#include "codec/pixel_format.h"
#include "codec/texels.h"

// ----------------------------------------------------------------------------------------- writing

/// Channels by their numbers in the colour model RGBSDA of the Khronos Data Format, and flags that
/// are added to such a number.
enum {
    KI_KTX2_ALPHA = 15,
    KI_KTX2_EXPONENT = 0x20,
    KI_KTX2_SIGNED = 0x40,
    KI_KTX2_FLOAT = 0x80,
};

typedef struct ki_ktx2_sample {
    int offset, bits, channel;
    uint32_t lower, upper;
} ki_ktx2_sample;

/// The values of a KTX2 file's header and of its data format descriptor.
typedef struct ki_ktx2_file {
    uint32_t vk;
    // type_size: bytes of a number that is swapped for byte order; texel_size: bytes of a texel, or
    // of a block of texels.
    int type_size, texel_size;
    // Side of a block in texels; 0 or 1 for formats of single texels.
    int block;
    int model;                // colour model of the Khronos Data Format; 0 for RGBSDA
    int width, height, depth; // size in texels; depth 0 for a texture that is not 3-D
    int face_count, level_count;
    int zstd; // zstd compression level, 0 for no compression
    int sample_count;
    ki_ktx2_sample samples[6];
} ki_ktx2_file;

/// Returns a description of a file whose texels have a format. Sizes and counts are for the caller
/// to set, and so is `zstd`.
ki_ktx2_file ki_ktx2_file_of(const ki_pixel_format *pixel);

typedef struct ki_ktx2_writer {
    ki_writer *w;
    const ki_ktx2_file *file;
    size_t start, index, levels, metadata;
} ki_ktx2_writer;

/// Writes the file's header and its data format descriptor. The caller then writes the metadata
/// entries in the byte order of their keys, ends the metadata, and writes the levels, smallest
/// first.
void ki_ktx2_begin(ki_writer *writer, const ki_ktx2_file *file, ki_ktx2_writer *k);
/// ki_ktx2_begin_entry begins a metadata entry and returns its position for ki_ktx2_end_entry. The
/// entry's value is the text that the caller writes in between.
size_t ki_ktx2_begin_entry(ki_writer *w, const char *key);
void ki_ktx2_end_entry(ki_writer *w, size_t entry);
/// Writes the metadata entries KTXorientation, for example "rd", and KTXwriter, kiln's version.
void ki_ktx2_write_common(ki_writer *w, const char *orientation);
kiln_result ki_ktx2_end_metadata(ki_ktx2_writer *k, kiln_error *error);
/// A function that writes the texels of a level, in the file's format, to `bytes`. Returns false if
/// a progress report asks to stop.
typedef bool ki_ktx2_pack(kiln_context *context, const void *data, int level, uint8_t *bytes);
kiln_result ki_ktx2_write_level(ki_ktx2_writer *k, int level, size_t size, ki_ktx2_pack *pack,
                                const void *data, kiln_error *error);

// ----------------------------------------------------------------------------------------- reading

/// A KTX2 file that is being read. Once the header is read, `reader` is at the index of levels.
typedef struct ki_ktx2_source {
    const uint8_t *bytes;
    size_t size;
    const char *name;
    ki_reader reader;
    uint32_t vk, width, height, depth, layer_count, face_count, level_count;
    bool zstd, zlib; // how the levels are compressed
    uint32_t descriptor_offset, metadata_offset, metadata_size;
} ki_ktx2_source;

typedef struct ki_ktx2_level {
    const uint8_t *bytes;
    size_t size, plain_size;
} ki_ktx2_level;

/// Reads a file's header into `source`, and its metadata into `info`.
kiln_result ki_ktx2_open(kiln_context *context, ki_ktx2_source *source, const uint8_t *bytes,
                         size_t size, const char *name, kiln_file_info *info, kiln_error *error);
/// Reads the next entry of the file's index of levels, that of level k, whose texels take `wanted`
/// bytes. Its offset and size are checked before any memory is allocated.
kiln_result ki_ktx2_find_level(ki_ktx2_source *source, uint32_t k, uint64_t wanted,
                               ki_ktx2_level *level, kiln_error *error);
/// Sets *plain to the uncompressed bytes of a level. They lie within the file, or are decompressed
/// into *unpacked, which the caller frees.
kiln_result ki_ktx2_unpack(kiln_context *context, const ki_ktx2_source *source, int k,
                           const ki_ktx2_level *level, const uint8_t **plain, uint8_t **unpacked,
                           kiln_error *error);

/// Describes how the texels are stored. Fails for formats and colours that kiln does not read.
kiln_result ki_ktx2_texels(const ki_ktx2_source *source, ki_texels *texels, kiln_error *error);
/// Fails if a level of UASTC HDR blocks, which may come from a file of general ASTC, has a block
/// that kiln cannot decode.
kiln_result ki_ktx2_check_blocks(kiln_context *context, const ki_ktx2_source *source,
                                 const ki_texels *texels, const uint8_t *plain, size_t size,
                                 int level, kiln_error *error);
/// Returns the end of the description of the texels: ", zstd", ", zlib" or "".
const char *ki_ktx2_scheme(const ki_ktx2_source *source);
/// Turns a picture of RGB floats from the orientation that the metadata state to rows from the top
/// and columns from the left, and notes that. Fails if a progress report asks to stop.
kiln_result ki_ktx2_turn(kiln_context *context, const kiln_file_info *info, float *rgb, int width,
                         int height, kiln_load_report *report, kiln_error *error);

/// Decode a source with six faces as a cube, and a source with one face as a flat picture of three
/// channels or as a table.
kiln_result ki_ktx2_decode_cube(kiln_context *context, ki_ktx2_source *source, kiln_map *map,
                                kiln_file_info *info, kiln_load_report *report, kiln_error *error);
kiln_result ki_ktx2_decode_picture(kiln_context *context, ki_ktx2_source *source, kiln_image *image,
                                   kiln_file_info *info, kiln_load_report *report,
                                   kiln_error *error);
kiln_result ki_ktx2_decode_table(kiln_context *context, ki_ktx2_source *source, kiln_image *image,
                                 kiln_file_info *info, kiln_error *error);

#endif
