// Writes lights to files.
#ifndef KI_LIGHTS_TEXT_H
#define KI_LIGHTS_TEXT_H

#include "base/file.h"

/// Adds a file of lights to a set, in the form that kiln_lights_save documents.
kiln_result ki_lights_write(ki_file_set *set, kiln_context *context, const kiln_lights *lights,
                            const char *path, kiln_error *error);

#endif
