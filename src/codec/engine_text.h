// What a file that was written for an engine says of itself, in one line of text:
//   engine=playcanvas layout=atlas format=rgbp roughness=0,0.2,0.4,0.6,0.8,1
// Such files hold cubes in an engine's own axes, or atlases, so that neither their sides nor their texels
// say what they are. The line stands in an attribute of EXR, a text of PNG, a pair of KTX 1.
#ifndef KI_ENGINE_TEXT_H
#define KI_ENGINE_TEXT_H

#include "base/bytes.h"

/// Appends the line for the levels of a map, and its NUL. `words` is what stands in between, each word
/// with a space before it.
void ki_engine_text_write(ki_writer *writer, const char *engine, const char *words,
                          const kiln_map *map);
/// Takes from a line what it says; `text` ends in NUL. The format is that of bytes in a PNG.
void ki_engine_text_read(const char *text, kiln_file_info *info);
/// Whether a file was said to be an atlas, which is a picture of no layout that kiln reads.
bool ki_is_atlas(const kiln_file_info *info);

#endif
