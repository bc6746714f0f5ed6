// What the reader and the writer of Radiance HDR files share.
#ifndef KI_HDR_H
#define KI_HDR_H

#include "base/bytes.h"
#include "image/color.h"

/// The widths of pictures whose rows may have new run-lengths.
enum { KI_HDR_RUNS_LEAST = 8, KI_HDR_RUNS_MOST = 32767 };

/// The header of a file.
typedef struct ki_hdr_header {
    int width, height;           ///< size of the upright picture
    int line_count, line_length; ///< number and length of lines as stored
    bool columns;                ///< true: a stored line is a column of the picture
    bool flip_line, flip_order;  ///< true: reversed along each line; reversed order of the lines
    double divisor[3];           ///< product of EXPOSURE and COLORCORR for each channel
    bool xyz;                    ///< true: the texels are CIE XYZ
    bool converts;               ///< true: the colours are multiplied by `to_rec709`
    ki_matrix3 to_rec709;
} ki_hdr_header;

/// Reads the header up to the line with the resolution, and leaves the reader at the texels. Notes
/// what is converted or assumed. `info`, which may be NULL, gets the name of the writer.
kiln_result ki_hdr_read_header(kiln_context *context, ki_reader *r, const char *name,
                               ki_hdr_header *header, kiln_file_info *info,
                               kiln_load_report *report, kiln_error *error);

#endif
