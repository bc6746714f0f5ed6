// EXR files as OpenEXRCore reads them: what kiln's reader is compared with.
#ifndef KILN_EXR_WITNESS_H
#define KILN_EXR_WITNESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// The channels R, G and B of level 0 of the last part, over the data window, three floats a pixel,
/// with the values of the file; missing channels are 0.
/// `pixels` is to be released by free(). False where OpenEXRCore refuses the file.
bool exr_witness_read(const uint8_t *bytes, size_t size, int *width, int *height, float **pixels);

#endif
