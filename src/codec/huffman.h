// Huffman codes for deflate's blocks.
#ifndef KI_HUFFMAN_H
#define KI_HUFFMAN_H

#include "base/base.h"

/// As many symbols as deflate's largest code has.
enum { KI_HUFFMAN_SYMBOLS = 288 };

/// Lengths in bits, 0 for symbols that do not occur, and the codes in the order in which they are written,
/// lowest bit first.
typedef struct ki_huffman_code {
    uint8_t length[KI_HUFFMAN_SYMBOLS];
    uint16_t bits[KI_HUFFMAN_SYMBOLS];
} ki_huffman_code;

/// The code of `count` symbols that occur `counts` times, each below 2^16; `longest` is 15 at most.
void ki_huffman_make(ki_huffman_code *code, const uint32_t *counts, int count, int longest);
/// The bits from the lengths of `count` symbols; `with` has the number of codes of each length.
void ki_huffman_assign(ki_huffman_code *code, int count, const int *with, int longest);

#endif
