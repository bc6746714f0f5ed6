// zlib's format (RFC 1950, RFC 1951), which EXR and PNG files hold.
#ifndef KI_DEFLATE_H
#define KI_DEFLATE_H

#include "base/base.h"

/// zlib data into exactly `size` bytes; false where it is damaged or unpacks to another size.
bool ki_inflate(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);

#endif
