// The container that KTX2 files are, by the Khronos specification 2.0.4, for cubes and tables alike:
// level index largest first, levels stored smallest first, zstd for each level where asked for.
#ifndef KI_KTX2_H
#define KI_KTX2_H

#include "codec/codec.h"

// ----------------------------------------------------------------------------------------- writing

/// Channels of the Khronos Data Format's model RGBSDA, and what may be added to them.
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

/// What the header and the data format descriptor say.
typedef struct ki_ktx2_file {
    uint32_t vk;
    int type_size, texel_size; // bytes of what is swapped for byte order, and of a texel or block
    int block;                 // edge of a block of BC6H, 0 or 1 for texels
    int width, height, depth;  // depth 0: not a 3-D texture
    int face_count, level_count;
    int zstd; // level, 0 for none
    int sample_count;
    ki_ktx2_sample samples[6];
} ki_ktx2_file;

typedef struct ki_ktx2_writer {
    ki_writer *w;
    const ki_ktx2_file *file;
    size_t start, index, levels, metadata;
} ki_ktx2_writer;

/// Header and descriptor. Then entries in the order of their keys' bytes, the end of the metadata,
/// and the levels, smallest first.
kiln_result ki_ktx2_begin(ki_writer *writer, const ki_ktx2_file *file, ki_ktx2_writer *k,
                          kiln_error *error);
/// An entry whose value is the text written in between.
size_t ki_ktx2_begin_entry(ki_writer *w, const char *key);
void ki_ktx2_end_entry(ki_writer *w, size_t entry);
/// KTXorientation and KTXwriter.
void ki_ktx2_write_common(ki_writer *w, const char *orientation);
kiln_result ki_ktx2_end_metadata(ki_ktx2_writer *k, kiln_error *error);
/// Puts a level's texels into `bytes`; false where a report of progress asks to stop.
typedef bool ki_ktx2_pack(kiln_context *context, const void *data, int level, uint8_t *bytes);
kiln_result ki_ktx2_write_level(ki_ktx2_writer *k, int level, size_t size, ki_ktx2_pack *pack,
                                const void *data, kiln_error *error);

// ----------------------------------------------------------------------------------------- reading

/// A file being read. `reader` stands at the level index once the header is read.
typedef struct ki_ktx2_source {
    const uint8_t *bytes;
    size_t size;
    const char *name;
    ki_reader reader;
    uint32_t vk, width, height, depth, layer_count, face_count, level_count;
    bool zstd;
    uint32_t metadata_offset, metadata_size;
} ki_ktx2_source;

typedef struct ki_ktx2_level {
    const uint8_t *bytes;
    size_t size, plain_size;
} ki_ktx2_level;

/// Reads the header, and the metadata into `info`.
kiln_result ki_ktx2_open(ki_ktx2_source *source, const uint8_t *bytes, size_t size,
                         const char *name, kiln_file_info *info, kiln_error *error);
/// The next level of the index, whose texels take `wanted` bytes: its place and size are checked
/// before memory is asked for.
kiln_result ki_ktx2_find_level(ki_ktx2_source *source, uint32_t k, uint64_t wanted,
                               ki_ktx2_level *level, kiln_error *error);
/// Its plain bytes, within the file or, unpacked, in `unpacked`, which the caller frees.
kiln_result ki_ktx2_unpack(kiln_context *context, const ki_ktx2_source *source, int k,
                           const ki_ktx2_level *level, const uint8_t **plain, uint8_t **unpacked,
                           kiln_error *error);

/// A source with six faces, and one with a single one.
kiln_result ki_ktx2_decode_cube(kiln_context *context, ki_ktx2_source *source, kiln_map *map,
                                kiln_file_info *info, kiln_error *error);
kiln_result ki_ktx2_decode_table(kiln_context *context, ki_ktx2_source *source, kiln_image *image,
                                 kiln_file_info *info, kiln_error *error);

#endif
