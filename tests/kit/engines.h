// What depends on the build: the engines whose files can be written.
#ifndef KILN_KIT_ENGINES_H
#define KILN_KIT_ENGINES_H

#include <kiln/kiln.h>

#include <string.h>

/// Returns whether this build writes the files of an engine: those of model-viewer are JPEG files.
static inline bool engine_is_written(const kiln_engine *engine)
{
    return KILN_TEST_JPEG || strcmp(engine->name, "model-viewer") != 0;
}

#endif
