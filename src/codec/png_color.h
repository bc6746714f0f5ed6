// Reads the chunks of PNG files that say which colours the samples stand for.
#ifndef KI_PNG_COLOR_H
#define KI_PNG_COLOR_H

#include "codec/file_color.h"
#include "codec/rgbx.h"

/// How the samples of a PNG file become radiance.
typedef struct ki_png_meaning {
    /// Function that computes radiance from the four samples of a pixel; NULL if the samples are
    /// colours as `color` says.
    ki_from_rgbx *unpack;
    ki_file_color color;
    const char *name; ///< short name of the coding of the samples, for example "srgb"
    int orientation;  ///< Exif's orientation, 1 to 8; 1 is upright
    bool transparent; ///< true: the chunk tRNS names transparent colours
} ki_png_meaning;

/// Reads the chunks about colours and orientation, and notes which statements of other chunks kiln
/// ignores. Fails if a chunk names colours that kiln cannot convert.
kiln_result ki_png_read_meaning(kiln_context *context, const uint8_t *bytes, size_t size,
                                const char *name, ki_png_meaning *meaning, kiln_load_report *report,
                                kiln_error *error);

#endif
