// What the parts of the EXR codec share.
#ifndef KI_EXR_H
#define KI_EXR_H

#include "base/base.h"

#include <openexr.h>

/// Which memory a header is read into: the library has its own.
#ifndef KI_EXR_MEMORY
#define KI_EXR_MEMORY(init, context) ((void)0)
#endif

/// Channels beyond this are refused; a picture has a handful.
enum { KI_EXR_MAX_CHANNELS = 256 };

typedef struct ki_exr_channel {
    const char *name;
    int type; // exr_pixel_type_t
    int bytes;
    int x_sampling, y_sampling;
    bool linear; // stored without DWA's transfer function
} ki_exr_channel;

/// A box of pixels as it lies in the file: of every line, channel after channel in the file's
/// order, the samples whose x and y are multiples of the channel's sampling.
typedef struct ki_exr_box {
    int x, y, width, height; // x and y in the file's coordinates
    const ki_exr_channel *channels;
    int channel_count;
} ki_exr_box;

/// Number of samples of a channel on `count` pixels from `start`, which may be negative.
int ki_exr_samples(int start, int count, int sampling);
/// Whether a channel has samples on line `y`.
bool ki_exr_line_has(const ki_exr_channel *channel, int y);
/// Bytes of a box; 0 where it does not fit into size_t.
size_t ki_exr_box_size(const ki_exr_box *box);

/// Decompress `packed` into exactly `size` bytes of samples. `scratch` has `size` bytes. They
/// return false on damaged data.
bool ki_exr_undo_zip(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size,
                     uint8_t *scratch);
bool ki_exr_undo_rle(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size,
                     uint8_t *scratch);
/// Undoes EXR's byte runs: at most `size` bytes are written; returns how many, or SIZE_MAX where
/// the data is damaged.
size_t ki_exr_unpack_runs(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size);
/// zlib data into exactly `size` bytes.
bool ki_exr_inflate(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size);

/// PIZ, PXR24, B44 and B44A, of a box that is chunk `info` of the file. False on damaged data or
/// where memory is short.
bool ki_exr_undo_other(kiln_context *context, exr_const_context_t core, int part,
                       const exr_chunk_info_t *info, const ki_exr_box *box, int compression,
                       const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size);

/// Half floats as DWA stores them to linear ones, 65536 entries.
void ki_dwa_linear_table(kiln_context *context, uint16_t *table);
/// DWAA and DWAB. `raw` has the box's size. KILN_ERROR_FORMAT or KILN_ERROR_MEMORY, no sentence.
kiln_result ki_exr_undo_dwa(kiln_context *context, const ki_exr_box *box, const uint16_t *table,
                            const uint8_t *packed, size_t packed_size, uint8_t *raw);

/// Huffman codes of 16-bit symbols as PIZ and DWA use them. Fills exactly `count` symbols.
kiln_result ki_exr_undo_huffman(kiln_context *context, const uint8_t *packed, size_t packed_size,
                                uint16_t *symbols, size_t count);

#endif
