// KTX version 1, as Filament reads it.
#ifndef KI_KTX1_H
#define KI_KTX1_H

#include "codec/codec.h"

/// Levels `first` to `first + count - 1` of a cube as RGBA16F or B10G11R11, with one pair of metadata
/// where `key` is not NULL.
kiln_result ki_ktx1_encode(const kiln_map *map, int first, int count, kiln_format format,
                           const char *key, const char *value, ki_writer *writer,
                           kiln_error *error);

#endif
