// What the readers and the writer of Radiance HDR files share.
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

/// How the bytes of a file's lines are encoded, by which the ends of the lines are found.
typedef enum ki_hdr_coding {
    /// each line by Radiance's rules: its first texel says whether it has run-lengths of the new
    /// kind
    KI_HDR_BY_START,
    KI_HDR_FLAT, ///< four bytes for each texel, whatever their values
    /// every line has run-lengths of the new kind, although Radiance's rules forbid them for its
    /// length
    KI_HDR_NEW_RUNS,
} ki_hdr_coding;

/// A Radiance HDR file that is being read: as a whole by hdr.c, or by rows by hdr_rows.c.
typedef struct ki_hdr_file {
    kiln_context *context;
    const char *name;
    // `held` bytes of the file from byte `first` on, and the size of the whole file
    const uint8_t *bytes;
    uint64_t first, size;
    size_t held;
    /// Holds the bytes of the file from `start` on, at least those of one line if the line is no
    /// longer than lines usually are. Returns false if the file cannot be read. NULL if all bytes
    /// are held.
    bool (*advance)(struct ki_hdr_file *f, uint64_t start);
    void *user; ///< what `advance` needs
    ki_hdr_header head;
    ki_hdr_coding coding;
    /// where each line begins in the file, and where the last line ends
    uint64_t *line_start;
    int task_count;
    uint8_t *texels; ///< memory for the texels of one line, for each task
    float *pixels;
    float scale[3][256];
} ki_hdr_file;

/// Finds how the lines are encoded, and where each line begins. `start` is where line 0 begins.
kiln_result ki_hdr_find_lines(ki_hdr_file *f, uint64_t start, kiln_load_report *report,
                              kiln_error *error);
/// Computes `scale` from the header: the value of a mantissa of 1 for each exponent.
void ki_hdr_fill_scales(ki_hdr_file *f);
/// Decodes line `index`, whose bytes are held, to texels `step` floats apart from `to` on. `texels`
/// has memory for the bytes of a line's texels.
void ki_hdr_decode_line(const ki_hdr_file *f, int index, uint8_t *texels, float *to,
                        ptrdiff_t step);

#endif
