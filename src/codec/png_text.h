// Texts in PNG files (chunks tEXt) that say who wrote a picture, and for which engine.
#ifndef KI_PNG_TEXT_H
#define KI_PNG_TEXT_H

#include "base/bytes.h"

/// Puts a text behind the header of the PNG that begins at `start` and is whole.
void ki_png_add_text(ki_writer *writer, size_t start, const char *key, const char *text);
/// Takes from the texts "Software" and "kiln:engine" what they say.
void ki_png_read_texts(const uint8_t *bytes, size_t size, kiln_file_info *info);

#endif
