// A kiln_table_def as one line of text, which files and written source code carry:
//   kind=e d=ggx g=smith sheen=ashikhmin axis=grazing corners=1 complement=0 flip=0 size=128x128x1 paths=0
// Tables of KILN_TABLE_LOBES append their number of taps and the roughness of each level, or the
// number of levels if their roughness rises in equal steps from 0 to 1:
//   taps=2 levels=0,0.25,0.6,1
#ifndef KI_TABLE_TEXT_H
#define KI_TABLE_TEXT_H

#include <kiln/brdf.h>

enum { KI_TABLE_TEXT = 384 };

/// Writes the line of text for a kiln_table_def whose fields are in range. paths= is path_count,
/// used by KILN_TABLE_E_WALK only.
void ki_table_describe(const kiln_table_def *def, char text[KI_TABLE_TEXT]);
/// Reads a line that ki_table_describe has written. If `text` is such a line, returns true with
/// every field of `def` in range, sizes from 1 to KILN_MAX_TABLE. Otherwise returns false and
/// zeroes `def`.
bool ki_table_parse(const char *text, kiln_table_def *def);

#endif
