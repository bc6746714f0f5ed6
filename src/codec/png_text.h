// Texts in PNG files (chunks tEXt) that name the program that wrote a picture and the engine that
// reads it.
#ifndef KI_PNG_TEXT_H
#define KI_PNG_TEXT_H

#include "base/bytes.h"

/// Inserts a text after the header of the complete PNG file that begins at `start`.
void ki_png_add_text(ki_writer *writer, size_t start, const char *key, const char *text);
/// Fills in `info` from the texts "Software" and "kiln:engine".
void ki_png_read_texts(const uint8_t *bytes, size_t size, kiln_file_info *info);

#endif
