// Babylon.js' .env.
#ifndef KI_ENV_H
#define KI_ENV_H

#include "codec/codec.h"

/// A cube with all levels down to 1. `polynomial` is in the order x y z xx yy zz yz zx
/// xy.
kiln_result ki_env_encode(const kiln_map *map, double lod_scale, double polynomial[9][3],
                          ki_writer *writer, kiln_error *error);

#endif
