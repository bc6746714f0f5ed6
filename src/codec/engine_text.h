// The line of text by which a file for a rendering engine describes itself:
//   engine=playcanvas layout=atlas format=rgbp roughness=0,0.2,0.4,0.6,0.8,1
// Such files hold cubes in an engine's own axes, or atlases, so that neither their sizes nor their
// texels show what they are. The line is stored in an attribute of EXR, a text chunk of PNG or a
// key-value pair of KTX 1.
#ifndef KI_ENGINE_TEXT_H
#define KI_ENGINE_TEXT_H

#include "base/bytes.h"

/// Appends the line of text that describes the levels of a map, with a NUL at its end. `words` are
/// further words between the engine and the roughness, each with a space before it.
void ki_engine_text_write(ki_writer *writer, const char *engine, const char *words,
                          const kiln_map *map);
/// Fills in `info` from a line that ends in NUL. The word `format` of the line becomes the encoding
/// of the texels, which a PNG file does not state.
void ki_engine_text_read(const char *text, kiln_file_info *info);
/// Returns whether a file's description says that the file is an atlas. kiln cannot lay an atlas
/// out on the sphere.
bool ki_is_atlas(const kiln_file_info *info);

#endif
