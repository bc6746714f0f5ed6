// Declarations shared by the PNG reader and writer.
#ifndef KI_PNG_H
#define KI_PNG_H

#include <stdint.h>

/// Bits of a colour type.
enum { KI_PNG_PALETTE = 1, KI_PNG_COLOR = 2, KI_PNG_ALPHA = 4 };

/// Key of the text chunk by which a picture of kiln says that its samples are radiance in four
/// bytes. The text is "rgbm", "rgbd" or "rgbp".
#define KI_PNG_TEXELS_KEY "kiln:texels"

/// Filters of a row, whose bytes are stored as differences from a prediction.
typedef enum ki_png_filter {
    KI_PNG_NONE,
    KI_PNG_SUB,     ///< predicts the byte one pixel to the left
    KI_PNG_UP,      ///< predicts the byte above
    KI_PNG_AVERAGE, ///< predicts the mean of left and above, rounded down
    KI_PNG_PAETH,   ///< predicts the left, upper or upper left byte, by ki_png_paeth
    KI_PNG_FILTERS
} ki_png_filter;

/// Returns that of the three bytes which is nearest to left + above - corner. Ties are decided in
/// the order left, above, corner.
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
