// Reads and writes the samples of JPEG pictures, by libjpeg-turbo in builds with the option
// KILN_JPEG.
#ifndef KI_JPEG_PIXELS_H
#define KI_JPEG_PIXELS_H

#include "base/bytes.h"
#include "codec/jpeg_head.h"

/// Sets *samples to memory of ki_alloc with the picture's 8-bit samples, of one channel for a grey
/// picture and of red, green and blue for three components. `head` must be the picture's own.
kiln_result ki_jpeg_samples(kiln_context *context, ki_span picture, const ki_jpeg_head *head,
                            const char *name, uint8_t **samples, kiln_error *error);
/// Appends a JPEG picture of 8-bit samples: grey ones for 1 channel, red, green and blue ones for
/// 3, all at full resolution. `quality` is 1 to 100. The first segment, JFIF's, has 18 bytes.
kiln_result ki_jpeg_write(const uint8_t *samples, int width, int height, int channels, int quality,
                          const char *name, ki_writer *writer, kiln_error *error);

#endif
