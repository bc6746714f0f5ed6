// ICC profiles of pictures, as PNG and JPEG files hold them.
#ifndef KI_ICC_H
#define KI_ICC_H

#include "codec/file_color.h"

/// Sets the colours that a profile describes. `color` takes over `profile`, which is memory of
/// ki_alloc with `size` bytes, or frees the memory. A profile of sRGB gives {0}. A profile that
/// kiln cannot use, because it is damaged or has only tables of more than one dimension, is noted
/// with a warning, and the picture counts as sRGB.
void ki_icc_read(uint8_t *profile, size_t size, ki_file_color *color, kiln_load_report *report);

#endif
