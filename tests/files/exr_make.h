// EXR files for tests, written by OpenEXRCore, which is not what reads them.
#ifndef KILN_EXR_MAKE_H
#define KILN_EXR_MAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <openexr.h>

typedef struct exr_make_channel {
    const char *name;
    exr_pixel_type_t type;
    int sampling; // along x and y; 0 for 1
    bool linear;  // said to be perceptually linear, which B44 stores by another curve
} exr_make_channel;

typedef struct exr_make {
    int width, height;        // of the data window
    int x, y;                 // where it begins
    exr_attr_box2i_t display; // all 0: the data window
    exr_compression_t compression;
    exr_lineorder_t order;       // in which the chunks follow each other
    int tile_width, tile_height; // 0 for scan lines
    bool mip_levels;             // of tiles; every level below the first holds the value of (0, 0)
    const exr_make_channel *channels;
    int channel_count;
    int level;      // for exr_make_file's own use
    int part_count; // 0 for 1; the parts before the last have a channel "Z" only
    /// The value of a sample.
    float (*value)(int x, int y, const char *channel);
} exr_make;

/// Bytes to be released by free().
uint8_t *exr_make_file(const exr_make *make, size_t *size);

/// A line >= 0 that may stand for line `y` of a chunk in OpenEXRCore's pipelines: every sampling
/// that the tests use divides the difference. OpenEXRCore 3.1.6 to 3.1.13 and 3.2 count one line
/// too many of a subsampled channel whose chunk begins at an odd distance above line 0 or ends
/// there (compute_sampled_lines in internal_util.h rounds towards 0, where it means down); their
/// PIZ encoder then writes behind its buffer, and their decoder frees the buffer of its caller.
int exr_make_safe_line(int y);

#endif
