// What the reader and the writer of Radiance HDR files share.
#ifndef KI_HDR_H
#define KI_HDR_H

#include "base/bytes.h"
#include "image/color.h"

/// The smallest and largest width of pictures whose lines may have run-lengths of the new kind,
/// which store the four bytes of the texels separately.
enum { KI_HDR_RUNS_LEAST = 8, KI_HDR_RUNS_MOST = 32767 };

/// What the header of a Radiance HDR file says.
typedef struct ki_hdr_header {
    int width, height; ///< size of the picture when its first row is the top row
    /// number of lines in the file, and number of texels of a line; a line is a row or a column
    int line_count, line_length;
    bool columns; ///< true: a line of the file is a column of the picture
    /// flip_line: each line is stored from right to left, or from bottom to top if it is a column;
    /// flip_order: the lines are stored from the last to the first
    bool flip_line, flip_order;
    /// each channel's values are divided by this product of the header's lines EXPOSURE and
    /// COLORCORR
    double divisor[3];
    bool xyz;      ///< true: the texels are CIE XYZ instead of RGB
    bool converts; ///< true: the colours are multiplied by the matrix `to_rec709`
    ki_matrix3 to_rec709;
} ki_hdr_header;

/// Reads the header up to the line with the resolution, after which the texels begin. Adds notes to
/// *report about conversions that the header asks for (exposure, colour correction, XYZ,
/// primaries), and about numbers of 0 in the header that are taken as 1. `info`, which may be NULL,
/// gets the name of the program that wrote the file.
kiln_result ki_hdr_read_header(kiln_context *context, ki_reader *r, const char *name,
                               ki_hdr_header *header, kiln_file_info *info,
                               kiln_load_report *report, kiln_error *error);

#endif
