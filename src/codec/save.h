// Maps into a set of files, which is written together or stays in memory.
#ifndef KI_SAVE_H
#define KI_SAVE_H

#include "base/file.h"

/// Adds the files of a map to a set, as kiln_map_save names and writes them. `def` and `report` may be
/// NULL.
kiln_result ki_map_write(ki_file_set *set, kiln_context *context, const kiln_map *map,
                         const char *path, const kiln_save_def *def, kiln_save_report *report,
                         kiln_error *error);
/// Fills in the report but for `file_count`: which of a map's values are above a limit, 0 for none.
void ki_count_cut(const kiln_map *map, double limit, kiln_save_report *report);

#endif
