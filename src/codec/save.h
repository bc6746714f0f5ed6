// Adds the files of a map to a set of files, which is written together or kept in memory.
#ifndef KI_SAVE_H
#define KI_SAVE_H

#include "base/file.h"

/// Adds the files of a map to a set, with the names and contents of kiln_map_save. `def` and
/// `report` may be NULL.
kiln_result ki_map_write(ki_file_set *set, kiln_context *context, const kiln_map *map,
                         const char *path, const kiln_save_def *def, kiln_save_report *report,
                         kiln_error *error);
/// Makes a set of files as ki_file_set_make does. *report, which `add` fills in, is set to zero on
/// failure; `report` may be NULL.
kiln_result ki_save_files(kiln_context *context, ki_add_files *add, void *data, kiln_files *files,
                          kiln_save_report *report, kiln_error *error);
/// Sets all fields of *report except `file_count`: how many of the map's values are above `limit`,
/// where 0 stands for no limit.
void ki_count_cut(const kiln_map *map, double limit, kiln_save_report *report);

#endif
