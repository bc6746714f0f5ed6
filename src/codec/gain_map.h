// Gain maps: a second picture by which a picture of low dynamic range becomes one of high dynamic
// range (ISO 21496-1, and Ultra HDR by XMP).
#ifndef KI_GAIN_MAP_H
#define KI_GAIN_MAP_H

#include "codec/jpeg_head.h"

/// The numbers of a gain map, for three channels. With g a stored sample in [0, 1] and x a linear
/// value of the base picture, the value of high dynamic range is
///   (x + base_offset) 2^(low + (high - low) g^(1 / gamma)) - other_offset.
typedef struct ki_gain_map {
    double low[3], high[3], gamma[3], base_offset[3], other_offset[3];
    /// log2 of the ratio of the largest value to white, for the base picture and for the other
    /// picture, that of high dynamic range
    double base_headroom, other_headroom;
} ki_gain_map;

/// Returns whether the segments of a picture hold the numbers of a gain map, or announce that the
/// file has a gain map.
bool ki_gain_map_announced(const ki_jpeg_head *head);
/// Reads a gain map's numbers from the segments of the picture that holds the gain map, by ISO
/// 21496-1 or else from XMP. Returns false if there are no such numbers, or only numbers that
/// cannot be used.
bool ki_gain_map_read(const ki_jpeg_head *head, ki_gain_map *map);
/// Applies a gain map of 8-bit samples to the linear values of `image` in place. The map has 1 or 3
/// channels. A map of another size than the image is interpolated bilinearly.
kiln_result ki_gain_map_apply(kiln_context *context, const ki_gain_map *map, const uint8_t *samples,
                              int width, int height, int channels, kiln_image *image,
                              kiln_error *error);

#endif
