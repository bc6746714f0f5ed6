// Declarations shared by the files of the EXR codec: the parsed header, boxes of samples as stored
// in a file, the compression methods, and the picture that samples are written to.
#ifndef KI_EXR_H
#define KI_EXR_H

#include "base/base.h"

/// Greatest number of channels; files with more are rejected.
enum { KI_EXR_MAX_CHANNELS = 256 };

/// Compression methods, with the numbers that files use.
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

/// Types of samples, with the numbers that files use.
typedef enum ki_exr_type { KI_EXR_UINT, KI_EXR_HALF, KI_EXR_FLOAT, KI_EXR_TYPES } ki_exr_type;

// ------------------------------------------------------------------------------------------ header

typedef struct ki_exr_channel {
    const char *name;
    int type; // type of the samples, a ki_exr_type
    int bytes;
    int x_sampling, y_sampling;
    bool linear; // true: stored without DWA's transfer function
} ki_exr_channel;

/// A window of pixels from (left, top) to (right, bottom), both included.
typedef struct ki_exr_window {
    int32_t left, top, right, bottom;
} ki_exr_window;

/// One part of a file: a picture with a header of its own.
typedef struct ki_exr_part {
    const uint8_t *attributes, *attributes_end; // the bytes of the attributes within the file
    ki_exr_channel *channels;
    int channel_count;
    ki_exr_window data, display;
    int compression; // number of the compression method in the file; the method may be unknown
    bool tiled, deep;
    uint32_t tile_width, tile_height; // size of a tile; 0 if the header does not state it
    int32_t stated_chunks;            // stated number of chunks; -1 if the header does not state it
} ki_exr_part;

typedef struct ki_exr_header {
    const uint8_t *bytes; // bytes of the whole file, into which names and attributes point
    size_t size;
    bool multipart;
    // Position of the first table of chunk offsets; the tables of the parts follow one another.
    size_t tables;
    int part_count;
    ki_exr_part *parts;
} ki_exr_header;

/// Parses the headers of all parts of a file. `name` appears in error messages. The caller frees
/// `header` whatever the result is, and before `bytes`.
kiln_result ki_exr_read_header(kiln_context *context, const uint8_t *bytes, size_t size,
                               const char *name, ki_exr_header *header, kiln_error *error);
void ki_exr_header_free(ki_exr_header *header);

/// Returns the bytes of the first attribute with this name and type, or NULL. A string attribute
/// has no NUL at its end.
const uint8_t *ki_exr_attribute(const ki_exr_part *part, const char *name, const char *type,
                                size_t *size);

/// Returns the part of a channel's name after the last dot: "R" for "beauty.R".
const char *ki_exr_suffix(const char *name);

// ------------------------------------------------------------------------------------------- boxes

/// A box of pixels as stored in a file: line by line, and in each line channel by channel in the
/// file's order, the samples whose x and y are multiples of the channel's sampling.
typedef struct ki_exr_box {
    int x, y, width, height; // position (in the file's coordinates) and size in pixels
    const ki_exr_channel *channels;
    int channel_count;
} ki_exr_box;

/// Return the number of samples of a channel on each of its lines, and the number of lines of the
/// box that have samples of the channel.
int ki_exr_columns(const ki_exr_box *box, const ki_exr_channel *channel);
int ki_exr_rows(const ki_exr_box *box, const ki_exr_channel *channel);
/// Returns whether a channel has samples on line `y`, in the file's coordinates.
bool ki_exr_line_has(const ki_exr_channel *channel, int y);
/// Returns the number of bytes of a box, or 0 if the number exceeds size_t.
size_t ki_exr_box_size(const ki_exr_box *box);
/// Reorders planes to the lines of a box. In planes all samples of one channel precede all samples
/// of the next channel.
void ki_exr_lines_from_planes(const ki_exr_box *box, const uint8_t *planes, uint8_t *raw);

// ----------------------------------------------------------------------------------------- methods

/// What a decompression method uses besides the chunk. `scratch` has as many bytes as the
/// decompressed chunk.
typedef struct ki_exr_workspace {
    kiln_context *context;
    uint8_t *scratch;
    const uint16_t *dwa_table; // for DWAA and DWAB, filled by ki_exr_dwa_table
} ki_exr_workspace;

/// Decompresses the `packed` bytes of a chunk into exactly `size` bytes, which is the size of the
/// chunk's box. Returns KILN_OK, KILN_ERROR_FORMAT or KILN_ERROR_MEMORY and writes no error
/// message. The file exr_NAME.c has method NAME.
typedef kiln_result ki_exr_decompress(const ki_exr_workspace *work, const ki_exr_box *box,
                                      const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                      size_t size);
ki_exr_decompress ki_exr_decompress_rle, ki_exr_decompress_zip, ki_exr_decompress_piz,
    ki_exr_decompress_pxr24, ki_exr_decompress_b44, ki_exr_decompress_dwa;

/// Fills the table of 65536 entries from half floats as DWA stores them to linear half floats.
void ki_exr_dwa_table(kiln_context *context, uint16_t *table);

/// Decompresses EXR's byte runs to at most `size` bytes. Returns the number of bytes written, or
/// SIZE_MAX if the data are damaged.
size_t ki_exr_unpack_runs(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size);
/// Decompresses ZIP: zlib data whose bytes were sorted by parity and replaced by their differences.
/// `scratch` has `size` bytes. Returns false if the data are damaged.
bool ki_exr_unzip(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size,
                  uint8_t *scratch);
/// Decodes exactly `count` symbols of 16 bits from the Huffman codes that PIZ and DWA use.
kiln_result ki_exr_unpack_huffman(kiln_context *context, const uint8_t *packed, size_t packed_size,
                                  uint16_t *symbols, size_t count);

// ------------------------------------------------------------------------------------------ chunks

typedef struct ki_exr_chunk {
    ki_exr_box box;
    const uint8_t *packed;
    size_t packed_size, size; // size of the packed chunk, and of its box, in bytes
} ki_exr_chunk;

/// Returns the name of a known compression, for example "zip".
const char *ki_exr_compression_name(int compression);

/// Finds the chunks of a part and checks all their sizes, so that the texels of the data window
/// are bounded by the size of the file. The picture itself has the size of the display window,
/// which a cropped render may leave mostly empty. *chunks is allocated, or NULL on failure.
kiln_result ki_exr_find_chunks(kiln_context *context, const ki_exr_header *header, int part,
                               const char *name, ki_exr_chunk **chunks, int *count,
                               kiln_error *error);

/// Returns the samples of a chunk: in `raw`, which has the chunk's size, or the packed bytes
/// themselves if they are not compressed. On failure returns NULL and sets *result to
/// KILN_ERROR_FORMAT or KILN_ERROR_MEMORY.
const uint8_t *ki_exr_chunk_samples(const ki_exr_workspace *work, int compression,
                                    const ki_exr_chunk *chunk, uint8_t *raw, kiln_result *result);

// ----------------------------------------------------------------------------------------- picture

typedef struct ki_exr_picture {
    int left, top, width, height; // display window, in the file's coordinates
    int source[3]; // indices of the channels that become red, green and blue; -1 for no channel
    float *pixels; // width * height * 3 floats
} ki_exr_picture;

/// Writes the samples of a box to the pixels of the picture that the box overlaps.
void ki_exr_put_box(const ki_exr_picture *picture, const ki_exr_box *box, const uint8_t *raw);

#endif
