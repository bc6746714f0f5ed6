// The samples of JPEG pictures, by libjpeg-turbo in builds with the option KILN_JPEG.
#ifndef KI_JPEG_PIXELS_H
#define KI_JPEG_PIXELS_H

#include "codec/jpeg_head.h"

/// Sets *samples to memory of ki_alloc with the picture's 8-bit samples, of one channel for a grey
/// picture and of red, green and blue for three components. `head` must be the picture's own.
kiln_result ki_jpeg_samples(kiln_context *context, ki_span picture, const ki_jpeg_head *head,
                            const char *name, uint8_t **samples, kiln_error *error);

#endif
