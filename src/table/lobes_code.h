// Writes source code that reads a table of KILN_TABLE_LOBES.
#ifndef KI_LOBES_CODE_H
#define KI_LOBES_CODE_H

#include "table/table_source.h"

/// Appends the code that reads a table to `w`: in C from an array of floats, in GLSL ES 3.00 from a
/// sampler3D and a samplerCube, in WGSL from a texture_3d and a texture_cube. The names of its
/// functions begin with `name`. `def` has been completed by ki_lobes_complete.
void ki_lobes_write_code(const kiln_table_def *def, ki_language language, const char *name,
                         ki_writer *w);

#endif
