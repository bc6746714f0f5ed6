// Builds Huffman codes for deflate's blocks.
#ifndef KI_HUFFMAN_H
#define KI_HUFFMAN_H

#include "base/base.h"

/// Number of symbols of deflate's largest code.
enum { KI_HUFFMAN_SYMBOLS = 288 };

/// A Huffman code: the length in bits of each symbol's code, 0 for symbols that do not occur, and
/// the bits of each code in the order in which they are written, lowest bit first.
typedef struct ki_huffman_code {
    uint8_t length[KI_HUFFMAN_SYMBOLS];
    uint16_t bits[KI_HUFFMAN_SYMBOLS];
} ki_huffman_code;

/// Builds the code of `count` symbols from how often each occurs. Each count is below 2^16, and no
/// code is longer than `longest`, at most 15.
void ki_huffman_make(ki_huffman_code *code, const uint32_t *counts, int count, int longest);
/// Assigns bits to the codes of `count` symbols, whose lengths are set. `with` holds the number of
/// codes of each length.
void ki_huffman_assign(ki_huffman_code *code, int count, const int *with, int longest);

/// Returns the lowest `length` bits of a code, 16 at most, in reverse order. Deflate stores a code
/// from its highest bit on, but fills each byte of the file from the lowest bit on.
static inline uint32_t ki_reverse_bits(uint32_t bits, int length)
{
    bits = (bits & 0x5555) << 1 | (bits >> 1 & 0x5555);
    bits = (bits & 0x3333) << 2 | (bits >> 2 & 0x3333);
    bits = (bits & 0x0f0f) << 4 | (bits >> 4 & 0x0f0f);
    bits = (bits & 0x00ff) << 8 | (bits >> 8 & 0x00ff);
    return bits >> (16 - length);
}

#endif
