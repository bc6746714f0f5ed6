// Declarations shared by the PNG reader and writer.
#ifndef KI_PNG_H
#define KI_PNG_H

#include <stdint.h>

/// The bits of a PNG file's colour type.
enum { KI_PNG_PALETTE = 1, KI_PNG_COLOR = 2, KI_PNG_ALPHA = 4 };

/// Key of the text chunk by which a picture of kiln says that its samples are radiance in four
/// bytes. The text is "rgbm", "rgbd" or "rgbp".
#define KI_PNG_TEXELS_KEY "kiln:texels"

/// PNG's filters: a row's bytes are stored as differences from what the filter predicts.
typedef enum ki_png_filter {
    KI_PNG_NONE,
    KI_PNG_SUB, ///< predicts each byte to be that one pixel to the left
    KI_PNG_UP,  ///< predicts each byte to be that in the row above
    /// predicts each byte to be the mean of the bytes to the left and above, rounded down
    KI_PNG_AVERAGE,
    /// predicts each byte to be that to the left, above, or above left, whichever ki_png_paeth
    /// returns
    KI_PNG_PAETH,
    KI_PNG_FILTERS
} ki_png_filter;

/// Returns the one of the bytes left, above and corner (above left) that is nearest to left + above
/// - corner. Ties are decided in this order.
static inline uint8_t ki_png_paeth(int left, int above, int corner)
{
    int to_left = above - corner, to_above = left - corner, to_corner = to_left + to_above;
    to_left = to_left < 0 ? -to_left : to_left;
    to_above = to_above < 0 ? -to_above : to_above;
    to_corner = to_corner < 0 ? -to_corner : to_corner;
    int nearest = to_above < to_left ? above : left;
    int distance = to_above < to_left ? to_above : to_left;
    return (uint8_t)(to_corner < distance ? corner : nearest);
}

#endif
