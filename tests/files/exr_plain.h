// Uncompressed EXR files for tests, byte by byte as "OpenEXR File Layout" describes them: several
// parts with names, any channels, and any attributes. All samples are 32-bit floats.
#ifndef KILN_EXR_PLAIN_H
#define KILN_EXR_PLAIN_H

#include "base/bytes.h"

enum { PLAIN_CHANNELS = 16, PLAIN_PARTS = 4 };

typedef struct plain_part {
    const char *name;                     // NULL for no name
    const char *channels[PLAIN_CHANNELS]; // in the order of their bytes; NULL after the last
    bool deep;                            // said to be deep, without samples
} plain_part;

typedef struct plain_file {
    int width, height;  // of the data window, which begins at (0, 0)
    int32_t display[4]; // left, top, right, bottom; all 0: the data window
    bool multipart;
    plain_part parts[PLAIN_PARTS];
    int part_count;
    const float *chromaticities; // 8 numbers; NULL for no attribute, and so below
    const float *neutral;        // 2 numbers
    const float *luminance;      // 1 number
    float aspect;                // pixelAspectRatio; 0 for 1
    int envmap;                  // value of the attribute plus 1; 0 for no attribute
    int sampling;                // of the channels RY and BY; 0 for 1
    /// The value of a sample; NULL for plain_number.
    float (*value)(int part, const char *channel, int x, int y);
} plain_file;

/// A number that differs by part and channel.
float plain_number(int part, const char *channel, int x, int y);

/// Appends the file to `w`.
void plain_write(const plain_file *file, ki_writer *w);

/// Appends an attribute of `size` bytes.
void plain_attribute(ki_writer *w, const char *name, const char *type, const void *bytes,
                     size_t size);

#endif
