// What the files of kiln check share.
#ifndef KILN_CLI_CHECK_H
#define KILN_CLI_CHECK_H

#include <kiln/kiln.h>

/// Writes a picture of the differences of levels from exact levels.
kiln_result check_draw(kiln_context *context, const kiln_map *difference, const char *path,
                       kiln_error *error);

#endif
