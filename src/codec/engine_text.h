// The line of text by which a file for a rendering engine describes itself:
//   engine=playcanvas layout=atlas format=rgbp roughness=0,0.2,0.4,0.6,0.8,1
// Such files hold cubes in an engine's own axes, or atlases, so that neither their sizes nor their
// texels show what they are. The line is stored in an attribute of EXR, a text chunk of PNG or a
// key-value pair of KTX 1.
#ifndef KI_ENGINE_TEXT_H
#define KI_ENGINE_TEXT_H

#include "base/bytes.h"

/// Appends the line "engine=ENGINE WORDS roughness=R0,R1,..." with a NUL at its end, where Rk is
/// the roughness of level k of the map. `words` are words such as "layout=atlas", each with a space
/// before it, or "".
void ki_engine_text_write(ki_writer *writer, const char *engine, const char *words,
                          const kiln_map *map);
/// Fills in `info` from such a line, which ends in NUL. The line's word "format=..." becomes the
/// encoding of the texels, which a PNG file does not state.
void ki_engine_text_read(const char *text, kiln_file_info *info);
/// Returns whether a file's description says that the file is an atlas: one picture that holds all
/// levels in an engine's own arrangement. kiln cannot lay an atlas out on the sphere.
bool ki_is_atlas(const kiln_file_info *info);

#endif
