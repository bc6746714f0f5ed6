// What a table is, in one line of text, as files and source code keep it:
//   kind=e d=ggx g=smith sheen=ashikhmin axis=grazing corners=1 complement=0 flip=0 size=128x128x1 paths=0
#ifndef KI_TABLE_TEXT_H
#define KI_TABLE_TEXT_H

#include <kiln/brdf.h>

enum { KI_TABLE_TEXT = 160 };

/// In the order of the enums, NULL behind the last.
extern const char *const ki_d_names[], *const ki_g_names[], *const ki_sheen_names[];
extern const char *const ki_kind_names[], *const ki_axis_names[];

/// For a def whose choices are in range. Paths are those of KILN_TABLE_E_WALK.
void ki_table_describe(const kiln_table_def *def, char text[KI_TABLE_TEXT]);
/// The inverse; false, and `def` zeroed, where it is none. Choices are in range then, sizes from 1 to
/// KILN_MAX_TABLE.
bool ki_table_parse(const char *text, kiln_table_def *def);

#endif
