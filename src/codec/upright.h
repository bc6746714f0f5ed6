// Pictures that a file states to be stored turned or mirrored.
#ifndef KI_UPRIGHT_H
#define KI_UPRIGHT_H

#include "base/base.h"

/// Notes that ki_turn_upright turns the picture. Does nothing for orientation 1.
void ki_note_upright(int orientation, kiln_load_report *report);
/// Turns a picture of three channels upright, by Exif's orientation from 1 to 8. Replaces the
/// picture's pixels, and from orientation 5 on exchanges its width and height. On failure the
/// picture stays as it is.
kiln_result ki_turn_upright(kiln_context *context, int orientation, kiln_image *image,
                            kiln_error *error);

#endif
