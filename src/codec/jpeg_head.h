// The segments of JPEG files before and between the picture's data.
#ifndef KI_JPEG_HEAD_H
#define KI_JPEG_HEAD_H

#include "base/base.h"

typedef struct ki_span {
    const uint8_t *bytes; ///< NULL if the file has no such bytes
    size_t size;
} ki_span;

enum { KI_JPEG_PROFILE_PARTS = 255 };

/// What the segments of one JPEG picture say. The spans lie in the file's bytes.
typedef struct ki_jpeg_head {
    int width, height, components, precision;
    bool progressive;
    int orientation;  ///< Exif's orientation, 1 to 8; 1 is upright
    double aspect;    ///< width of a pixel divided by its height, as the JFIF segment says, or 1
    ki_span xmp;      ///< text of the XMP packet
    ki_span iso;      ///< gain-map numbers of ISO 21496-1: the content of their segment
    ki_span pictures; ///< the index of the file's pictures (CIPA DC-007), a TIFF file
    /// parts of the ICC profile, each from a segment of its own
    ki_span profile[KI_JPEG_PROFILE_PARTS];
    int profile_parts; ///< number of parts that the ICC profile has
    size_t end;        ///< number of bytes from the picture's first byte to its end
} ki_jpeg_head;

/// Returns the orientation, 1 to 8, that Exif data state, which have the form of a TIFF file; 1 if
/// the data state none.
int ki_exif_orientation(ki_span exif);
/// Reads the segments of the JPEG picture that begins at `bytes`. Fails unless the picture has a
/// frame header, which states its size.
kiln_result ki_jpeg_read_head(kiln_context *context, const uint8_t *bytes, size_t size,
                              const char *name, ki_jpeg_head *head, kiln_error *error);
/// Finds the further pictures of a JPEG file, such as a gain map: by the file's index or, without
/// an index, after the first picture's end. Returns their number, at most `most`.
int ki_jpeg_other_pictures(const uint8_t *bytes, size_t size, const ki_jpeg_head *head,
                           ki_span *pictures, int most);
/// Joins the parts of the ICC profile. Returns NULL if there is no profile, a part is missing or
/// memory runs out.
uint8_t *ki_jpeg_profile(kiln_context *context, const ki_jpeg_head *head, size_t *size);

#endif
