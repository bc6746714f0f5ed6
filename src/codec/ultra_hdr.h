// Ultra HDR: JPEG pictures of high dynamic range with a gain map.
#ifndef KI_ULTRA_HDR_H
#define KI_ULTRA_HDR_H

#include "codec/codec.h"

/// Appends a JPEG file with a gain map, which holds the linear values of a picture of three
/// channels. Values below 0 become 0. `name` appears in error messages. Fails in a build without
/// JPEG.
kiln_result ki_ultra_hdr_encode(const kiln_image *image, const char *name, ki_writer *writer,
                                kiln_error *error);

#endif
