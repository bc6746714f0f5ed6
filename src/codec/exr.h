// What the files of the EXR codec share: the header as parsed, boxes of samples as they lie in a file,
// the compression methods, and the picture that samples are written to.
#ifndef KI_EXR_H
#define KI_EXR_H

#include "base/base.h"

/// Channels beyond this number are refused; a picture has a handful.
enum { KI_EXR_MAX_CHANNELS = 256 };

/// Compression methods by the numbers that files hold.
typedef enum ki_exr_compression {
    KI_EXR_NONE,
    KI_EXR_RLE,
    KI_EXR_ZIPS,
    KI_EXR_ZIP,
    KI_EXR_PIZ,
    KI_EXR_PXR24,
    KI_EXR_B44,
    KI_EXR_B44A,
    KI_EXR_DWAA,
    KI_EXR_DWAB,
    KI_EXR_COMPRESSIONS
} ki_exr_compression;

/// Types of samples by the numbers that files hold.
typedef enum ki_exr_type { KI_EXR_UINT, KI_EXR_HALF, KI_EXR_FLOAT, KI_EXR_TYPES } ki_exr_type;

// ------------------------------------------------------------------------------------------ header

typedef struct ki_exr_channel {
    const char *name;
    int type; // ki_exr_type
    int bytes;
    int x_sampling, y_sampling;
    bool linear; // stored without DWA's transfer function
} ki_exr_channel;

/// Pixels from (left, top) to (right, bottom), both included.
typedef struct ki_exr_window {
    int32_t left, top, right, bottom;
} ki_exr_window;

/// One part of a file: a picture with a header of its own.
typedef struct ki_exr_part {
    const uint8_t *attributes, *attributes_end; // in the file
    ki_exr_channel *channels;
    int channel_count;
    ki_exr_window data, display;
    int compression; // as the file has it: perhaps none that is known
    bool tiled, deep;
    uint32_t tile_width, tile_height; // 0 where the header does not say
    int32_t stated_chunks;            // -1 where the header does not say
} ki_exr_part;

typedef struct ki_exr_header {
    const uint8_t *bytes; // of the whole file, which names and attributes point into
    size_t size;
    bool multipart;
    size_t tables; // where the offsets of the chunks begin, part after part
    int part_count;
    ki_exr_part *parts;
} ki_exr_header;

/// Parses the headers of all parts of a file. `name` stands in messages; `header` is to be freed
/// whatever the result is, and before `bytes`.
kiln_result ki_exr_read_header(kiln_context *context, const uint8_t *bytes, size_t size,
                               const char *name, ki_exr_header *header, kiln_error *error);
void ki_exr_header_free(ki_exr_header *header);

/// The bytes of the first attribute with this name and type, or NULL. A string has no NUL at its end.
const uint8_t *ki_exr_attribute(const ki_exr_part *part, const char *name, const char *type,
                                size_t *size);

/// What follows the last dot of a channel's name: "R" of "beauty.R".
const char *ki_exr_suffix(const char *name);

// ------------------------------------------------------------------------------------------- boxes

/// A box of pixels as it lies in the file: of every line, channel after channel in the file's
/// order, the samples whose x and y are multiples of the channel's sampling.
typedef struct ki_exr_box {
    int x, y, width, height; // x and y in the file's coordinates
    const ki_exr_channel *channels;
    int channel_count;
} ki_exr_box;

/// Samples of a channel on each of its lines, and lines of the box on which it has samples.
int ki_exr_columns(const ki_exr_box *box, const ki_exr_channel *channel);
int ki_exr_rows(const ki_exr_box *box, const ki_exr_channel *channel);
/// Whether a channel has samples on line `y`, in the file's coordinates.
bool ki_exr_line_has(const ki_exr_channel *channel, int y);
/// Bytes of a box; 0 where they are more than size_t holds.
size_t ki_exr_box_size(const ki_exr_box *box);
/// Brings planes, all samples of a channel after those of the one before, to the lines of a box.
void ki_exr_lines_from_planes(const ki_exr_box *box, const uint8_t *planes, uint8_t *raw);

// ----------------------------------------------------------------------------------------- methods

/// What decompressing needs besides the chunk. `scratch` has as many bytes as the chunk unpacks to.
typedef struct ki_exr_workspace {
    kiln_context *context;
    uint8_t *scratch;
    const uint16_t *dwa_table; // for DWAA and DWAB, by ki_exr_dwa_table
} ki_exr_workspace;

/// Decompresses the `packed` bytes of a chunk into exactly `size` bytes, those of its box.
/// KILN_ERROR_FORMAT or KILN_ERROR_MEMORY, no sentence. The file exr_NAME.c holds method NAME.
typedef kiln_result ki_exr_decompress(const ki_exr_workspace *work, const ki_exr_box *box,
                                      const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                      size_t size);
ki_exr_decompress ki_exr_decompress_rle, ki_exr_decompress_zip, ki_exr_decompress_piz,
    ki_exr_decompress_pxr24, ki_exr_decompress_b44, ki_exr_decompress_dwa;

/// Half floats as DWA stores them to linear ones, 65536 entries.
void ki_exr_dwa_table(kiln_context *context, uint16_t *table);

/// Undoes EXR's byte runs: at most `size` bytes are written; returns how many, or SIZE_MAX where
/// the data is damaged.
size_t ki_exr_unpack_runs(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size);
/// Undoes ZIP: zlib data whose bytes were sorted by parity and replaced by their differences.
/// `scratch` has `size` bytes. False on damaged data.
bool ki_exr_unzip(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size,
                  uint8_t *scratch);
/// Huffman codes of 16-bit symbols as PIZ and DWA use them. Fills exactly `count` symbols.
kiln_result ki_exr_unpack_huffman(kiln_context *context, const uint8_t *packed, size_t packed_size,
                                  uint16_t *symbols, size_t count);

// ------------------------------------------------------------------------------------------ chunks

typedef struct ki_exr_chunk {
    ki_exr_box box;
    const uint8_t *packed;
    size_t packed_size, size; // size: of the box
} ki_exr_chunk;

/// "zip"; the compression must be a known one.
const char *ki_exr_compression_name(int compression);

/// Finds the chunks of a part and checks every size in them, so that what is allocated for the
/// picture later is bounded by the file's size. `chunks` is allocated; it is NULL on failure.
kiln_result ki_exr_find_chunks(kiln_context *context, const ki_exr_header *header, int part,
                               const char *name, ki_exr_chunk **chunks, int *count,
                               kiln_error *error);

/// The samples of a chunk: `raw`, which has the chunk's size, or the packed bytes themselves where
/// they are not compressed. NULL on failure, with KILN_ERROR_FORMAT or KILN_ERROR_MEMORY.
const uint8_t *ki_exr_chunk_samples(const ki_exr_workspace *work, int compression,
                                    const ki_exr_chunk *chunk, uint8_t *raw, kiln_result *result);

// ----------------------------------------------------------------------------------------- picture

typedef struct ki_exr_picture {
    int left, top, width, height; // of the display window, in the file's coordinates
    int source[3];                // the channels that become red, green and blue; -1 for none
    float *pixels;                // width * height * 3
} ki_exr_picture;

/// Writes the samples of a box to where it overlaps the picture.
void ki_exr_put_box(const ki_exr_picture *picture, const ki_exr_box *box, const uint8_t *raw);

#endif
