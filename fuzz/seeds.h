// What the two files of the program that writes seeds share.
#ifndef KILN_SEEDS_H
#define KILN_SEEDS_H

#include "base/bytes.h"

/// An empty writer.
ki_writer seed_writer(void);
/// Saves what was written as seed number `index` of a target, and frees the writer.
void seed_save(const char *target, int index, ki_writer *w);
/// A cube with texels that differ; `level_count` 0 for all levels.
kiln_map seed_cube(int size, int level_count);
/// Writes the seeds of the targets that read textures: ktx1, ktx2, dds, env and glb.
void seed_textures(void);

#endif
