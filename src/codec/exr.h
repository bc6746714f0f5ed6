// Declarations shared by the files of the EXR codec: the parsed header, boxes of samples as stored
// in a file, the compression methods, and the picture that samples are written to.
#ifndef KI_EXR_H
#define KI_EXR_H

#include "base/base.h"
#include "base/file.h"
#include "image/color.h"

#include <kiln/kiln.h>

/// Greatest number of channels of a part that is read, and of parts of a file; and the greatest
/// length of the name of an attribute or a channel, which is OpenEXR's limit.
enum { KI_EXR_MAX_CHANNELS = 1024, KI_EXR_MAX_PARTS = 1024, KI_EXR_MAX_NAME = 255 };
/// Greatest number of attributes in the header of a part, some of which are looked for several
/// times.
enum { KI_EXR_MAX_ATTRIBUTES = 1 << 20 };
/// Greatest distance of the samples of a channel, in pixels. Lines without samples of a channel
/// take time too, which this limit keeps proportional to the number of samples.
enum { KI_EXR_MAX_SAMPLING = 16 };

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
    // true: the file marks the channel as "perceptually linear"; DWA then stores it without a
    // transfer function, B44 stores exp(x / 8) for x
    bool linear;
} ki_exr_channel;

/// A rectangle of pixels from (left, top) to (right, bottom), both included.
typedef struct ki_exr_window {
    int32_t left, top, right, bottom;
} ki_exr_window;

/// One part of an EXR file: a picture with a header of its own.
typedef struct ki_exr_part {
    const uint8_t *attributes, *attributes_end; // the bytes of the attributes within the file
    const char *name; // name within the file, without a NUL at its end; NULL for no name
    size_t name_length;
    ki_exr_channel *channels;
    int channel_count;
    ki_exr_window data, display;
    // number of the compression method as in the file, which may be one that kiln does not know
    int compression;
    bool tiled, deep;
    uint32_t tile_width, tile_height; // size of a tile; 0 if the header does not state it
    int32_t stated_chunks; // number of chunks that the header states; -1 if it states none
} ki_exr_part;

typedef struct ki_exr_header {
    // The bytes of the file from its beginning, into which names and attributes point, and their
    // number `held`: all `size` bytes of the file, or at least the headers and the tables of chunk
    // offsets, if `file` is set.
    const uint8_t *bytes;
    size_t held;
    uint64_t size;
    const ki_open_file *file; // the file from which chunks are read; NULL if all bytes are held
    bool multipart;
    // Position in the file of the first part's table of chunk offsets. The tables of the other
    // parts follow.
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

/// Returns the part of a channel's name after the last dot: "R" for the channel "beauty.R".
const char *ki_exr_suffix(const char *name);

// ------------------------------------------------------------------------------------------ layers

/// What a channel means by the last component of its name.
typedef enum ki_exr_role {
    KI_EXR_RED,
    KI_EXR_GREEN,
    KI_EXR_BLUE,
    KI_EXR_LUMINANCE,
    KI_EXR_RED_CHROMA,  // RY = (R - Y) / Y
    KI_EXR_BLUE_CHROMA, // BY = (B - Y) / Y
    KI_EXR_ROLES,
    /// a channel X or Z, which together with a channel Y stores a position or a normal, no colour
    KI_EXR_COORDINATE = KI_EXR_ROLES,
    KI_EXR_OTHER
} ki_exr_role;

/// Which picture the channels of a layer make.
typedef enum ki_exr_kind {
    KI_EXR_NO_PICTURE,
    KI_EXR_COLOR,   // red, green and blue
    KI_EXR_PARTIAL, // one or two of red, green and blue
    KI_EXR_CHROMA,  // luminance and chroma
    KI_EXR_GREY     // luminance, or one channel that the caller named
} ki_exr_kind;

/// A layer: the channels of a part whose names agree up to the last dot.
typedef struct ki_exr_layer {
    int part;
    const char *name; // the part of the channels' names before the last dot, of `length` bytes
    size_t length;    // number of bytes of `name`; 0 for channels without a layer
    ki_exr_kind kind;
    int channel[KI_EXR_ROLES]; // indices of the channels that have a role; -1 for no channel
    bool coordinates;          // true: the layer has a channel X or Z
    bool single;               // true: not a layer but one channel, whose whole name is `name`
} ki_exr_layer;

typedef struct ki_exr_layers {
    ki_exr_layer *layer;
    int count;
} ki_exr_layers;

/// Lists the layers of all parts that are not deep and have at most KI_EXR_MAX_CHANNELS channels.
/// The caller frees layers->layer by ki_free, whatever the result is.
kiln_result ki_exr_list_layers(kiln_context *context, const ki_exr_header *header, const char *name,
                               ki_exr_layers *layers, kiln_error *error);
/// Chooses the layer that is the picture, by the rules in exr_layers.c, or the one that `wanted`
/// names; `wanted` may be NULL.
kiln_result ki_exr_choose_layer(const ki_exr_header *header, const ki_exr_layers *layers,
                                const char *wanted, const char *name, ki_exr_layer *chosen,
                                kiln_error *error);
/// Adds a note about the layer that was chosen, unless the file has one layer without a name and
/// all its colours.
void ki_exr_note_layer(const ki_exr_header *header, const ki_exr_layers *layers,
                       const ki_exr_layer *chosen, kiln_load_report *report);
/// Lists the layers in `info`. `chosen` is NULL if no layer is the picture.
void ki_exr_describe_layers(const ki_exr_header *header, const ki_exr_layers *layers,
                            const ki_exr_layer *chosen, kiln_file_info *info);

// ------------------------------------------------------------------------------------------- boxes

/// A box of pixels as a decompressed chunk holds it: line by line, and in each line channel by
/// channel in the file's order. Of each channel the box has the samples whose x and y are multiples
/// of the channel's sampling.
typedef struct ki_exr_box {
    // position of the box in the file's coordinates, and its size in pixels
    int x, y, width, height;
    const ki_exr_channel *channels;
    int channel_count;
} ki_exr_box;

/// ki_exr_columns: number of samples of a channel on each of its lines in the box. ki_exr_rows:
/// number of lines of the box that have samples of the channel.
int ki_exr_columns(const ki_exr_box *box, const ki_exr_channel *channel);
int ki_exr_rows(const ki_exr_box *box, const ki_exr_channel *channel);
/// Returns whether a channel has samples on line `y`, in the file's coordinates.
bool ki_exr_line_has(const ki_exr_channel *channel, int y);
/// A channel with samples in a box, and the number of bytes of a line of these.
typedef struct ki_exr_run {
    int channel; // index of the channel
    size_t bytes;
} ki_exr_run;
/// Lists the channels that have columns in a box, in the file's order. Returns their number.
int ki_exr_list_runs(const ki_exr_box *box, ki_exr_run runs[KI_EXR_MAX_CHANNELS]);
/// Returns how many lines of samples a box has, summed over its channels. A line that lies between
/// the samples of a subsampled channel does not count for that channel.
size_t ki_exr_count_lines(const ki_exr_box *box);
/// Finds the bytes of a box at which the lines of every channel begin. `offset` has room for as
/// many numbers as ki_exr_count_lines returns; lines[c] becomes the part of `offset` for channel c,
/// or NULL if no column of channel c is in the box.
void ki_exr_find_lines(const ki_exr_box *box, size_t *offset,
                       const size_t *lines[KI_EXR_MAX_CHANNELS]);
/// Returns the number of bytes of a box's samples, or 0 if the number exceeds size_t.
size_t ki_exr_box_size(const ki_exr_box *box);

// ----------------------------------------------------------------------------------------- methods

/// What a decompression method uses besides the packed bytes. `scratch` has as many bytes as the
/// decompressed chunk.
typedef struct ki_exr_workspace {
    kiln_context *context;
    ki_asker asker; // whom to ask whether to go on: a tile may be as large as the picture
    uint8_t *scratch;
    const uint16_t *dwa_table; // table by ki_exr_dwa_table, used by the methods DWAA and DWAB only
    size_t worked;             // bytes since the last question, which ki_exr_go_on counts
} ki_exr_workspace;

/// Adds `bytes`, the size of what was just decompressed or is decompressed next, to work->worked.
/// Where the sum reaches 2^22, asks the caller of the library whether to go on and begins a new
/// sum. Returns false if the caller wants to stop.
bool ki_exr_go_on(ki_exr_workspace *work, size_t bytes);

/// Decompresses the `packed` bytes of a chunk into exactly `size` bytes, which is the size of the
/// chunk's box. Returns KILN_OK, KILN_ERROR_MEMORY or, where the bytes are damaged or the work was
/// stopped, KILN_ERROR_FORMAT, and writes no error message. Each function is defined in the file
/// exr_METHOD.c of its method.
typedef kiln_result ki_exr_decompress(ki_exr_workspace *work, const ki_exr_box *box,
                                      const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                      size_t size);
ki_exr_decompress ki_exr_decompress_rle, ki_exr_decompress_zip, ki_exr_decompress_piz,
    ki_exr_decompress_pxr24, ki_exr_decompress_b44, ki_exr_decompress_dwa;

/// Fills DWA's table of 65536 entries, which turns a half float as DWA stores it, by a curve close
/// to perception, into a linear half float.
void ki_exr_dwa_table(kiln_context *context, uint16_t *table);

// The steps that several methods use. Each fails if its data are damaged, or if the caller of the
// library wants to stop.

/// Decompresses zlib data into exactly `size` bytes.
bool ki_exr_inflate(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size,
                    uint8_t *plain, size_t size);
/// Decompresses the byte runs of EXR's method RLE to at most `size` bytes. Returns the number of
/// bytes written, or SIZE_MAX on failure.
size_t ki_exr_unpack_runs(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size,
                          uint8_t *raw, size_t size);
/// Decompresses EXR's method ZIP: zlib data of bytes that were sorted into even and odd ones and
/// then replaced by their differences. `scratch` has `size` bytes.
bool ki_exr_unzip(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size, uint8_t *raw,
                  size_t size, uint8_t *scratch);
/// Decodes exactly `count` symbols of 16 bits from the Huffman codes of EXR's methods PIZ and DWA.
kiln_result ki_exr_unpack_huffman(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size,
                                  uint16_t *symbols, size_t count);
/// Reorders samples from planes, in which all samples of one channel precede all samples of the
/// next channel, to the lines of a box, in which the channels alternate line by line.
bool ki_exr_lines_from_planes(ki_exr_workspace *work, const ki_exr_box *box, const uint8_t *planes,
                              uint8_t *raw);

// ------------------------------------------------------------------------------------------ chunks

typedef struct ki_exr_chunk {
    ki_exr_box box;
    uint64_t at;              // position in the file of the packed chunk
    const uint8_t *packed;    // the packed chunk; NULL if the file's bytes are not held
    size_t packed_size, size; // size in bytes of the packed chunk, and of the samples in its box
} ki_exr_chunk;

/// Returns how many lines of pixels the chunks of a part share: the height of its tiles, or the
/// number of lines that its compression method packs together.
int ki_exr_chunk_height(const ki_exr_part *part);
/// Returns the name of a compression method that kiln knows, for example "zip".
const char *ki_exr_compression_name(int compression);

/// Finds the chunks of a part and checks all their sizes, so that the texels of the data window
/// are bounded by the size of the file. The picture itself has the size of the display window,
/// which a cropped render may leave mostly empty. *chunks is allocated, or NULL on failure.
kiln_result ki_exr_find_chunks(kiln_context *context, const ki_exr_header *header, int part,
                               const char *name, ki_exr_chunk **chunks, int *count,
                               kiln_error *error);

/// Returns the samples of a chunk: in `raw`, which has the chunk's size, or the packed bytes
/// themselves if they are not compressed. On failure returns NULL and sets *result to
/// KILN_ERROR_FORMAT, KILN_ERROR_MEMORY or KILN_ERROR_CANCELLED.
const uint8_t *ki_exr_chunk_samples(ki_exr_workspace *work, int compression,
                                    const ki_exr_chunk *chunk, uint8_t *raw, kiln_result *result);

// ----------------------------------------------------------------------------------------- picture

typedef struct ki_exr_picture {
    int left, top, width, height; // window of pixels, in the file's coordinates
    int source[3]; // indices of the channels that become red, green and blue; -1 for no channel
    float *pixels; // the picture's pixels: width * height * 3 floats
} ki_exr_picture;

/// Writes the samples of a box to the pixels of the picture that the box overlaps. A subsampled
/// channel is written to those pixels only that have a sample. Returns KILN_OK or
/// KILN_ERROR_CANCELLED.
kiln_result ki_exr_put_box(ki_exr_workspace *work, const ki_exr_picture *picture,
                           const ki_exr_box *box, const uint8_t *raw);

// ------------------------------------------------------------------------------------------- color

typedef struct ki_exr_color {
    ki_primaries primaries;
    double neutral[2]; // chromaticity that is to look white; the primaries' white unless stated
    double luminance;  // luminance of white in cd/m2; 0 if the file does not state it
    double weights[3]; // weights of red, green and blue in the luminance Y, of sum 1
    bool converts;     // true: colours are multiplied by `matrix` to become those of Rec. 709
    ki_matrix3 matrix;
} ki_exr_color;

/// Reads the attributes chromaticities, adoptedNeutral and whiteLuminance of a part. Fails if the
/// chromaticities are no set of primaries.
kiln_result ki_exr_read_color(const ki_exr_part *part, const char *name, ki_exr_color *color,
                              kiln_error *error);
/// Notes that the attribute pixelAspectRatio is ignored, if it is not 1.
void ki_exr_note_aspect(const ki_exr_part *part, kiln_load_report *report);
/// Notes which colours are converted, for a layer of this kind.
void ki_exr_note_color(const ki_exr_color *color, ki_exr_kind kind, kiln_load_report *report);

/// Computes red, green and blue from luminance and chroma. In: a picture over the data window, with
/// RY, Y and BY in place of red, green and blue, where `sampling` (1 or 2) says that the samples of
/// RY and BY lie at multiples of 1 or 2. Out: `rgb`, of the same size.
kiln_result ki_exr_reconstruct(kiln_context *context, const ki_exr_picture *picture, int sampling,
                               const double weights[3], const char *name, float *rgb,
                               kiln_error *error);

/// Moves the texels of a panorama of 2:1 or, if `cube`, of a strip of 1:6 from where OpenEXR's
/// attribute "envmap" has them to where kiln has them. Replaces the picture's pixels.
kiln_result ki_exr_place_envmap(kiln_context *context, kiln_image *image, bool cube,
                                const char *name, kiln_error *error);

#endif
