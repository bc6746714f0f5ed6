// Builds Huffman codes of limited length for deflate's blocks from the counts of the symbols.
#include "codec/huffman.h"

#include <string.h>

// Sorts the symbols that occur, the rarest first and equal counts by number. Returns how many
// symbols occur.
static int sort_symbols(const uint32_t *counts, int count, uint16_t *sorted)
{
    uint16_t by_low[KI_HUFFMAN_SYMBOLS];
    int used = 0;
    // Radix sort of the symbols by their counts: by the low byte of the count, then by the high
    // byte.
    for (int pass = 0; pass < 2; pass++) {
        int place[257] = {0};
        int n = pass ? used : count;
        for (int i = 0; i < n; i++) {
            // The first pass has set `by_low`, which cppcheck does not see.
            // cppcheck-suppress legacyUninitvar
            int symbol = pass ? by_low[i] : i;
            if (counts[symbol])
                place[(counts[symbol] >> 8 * pass & 255) + 1]++;
        }
        for (int i = 0; i < 256; i++)
            place[i + 1] += place[i];
        used = place[256];
        for (int i = 0; i < n; i++) {
            int symbol = pass ? by_low[i] : i;
            if (counts[symbol])
                (pass ? sorted : by_low)[place[counts[symbol] >> 8 * pass & 255]++] =
                    (uint16_t)symbol;
        }
    }
    return used;
}

// Counts how many codes of each length a Huffman code without a limit of length has. `counts` says
// how often each symbol occurs; `sorted` lists the `used` symbols that occur, the rarest first.
static void count_lengths(const uint32_t *counts, const uint16_t *sorted, int used, int *with)
{
    uint32_t weight[2 * KI_HUFFMAN_SYMBOLS];
    uint16_t parent[2 * KI_HUFFMAN_SYMBOLS];
    uint8_t depth[2 * KI_HUFFMAN_SYMBOLS];
    for (int i = 0; i < used; i++)
        weight[i] = counts[sorted[i]];
    // Leaves are sorted by weight, and new inner nodes are made in the order of their weight. The
    // two lightest nodes are therefore at the heads of these two queues.
    int leaf = 0, node = used, made = used;
    for (; made < 2 * used - 1; made++) {
        weight[made] = 0;
        for (int k = 0; k < 2; k++) {
            bool from_leaves = leaf < used && (node == made || weight[leaf] <= weight[node]);
            int child = from_leaves ? leaf++ : node++;
            weight[made] += weight[child];
            parent[child] = (uint16_t)made;
        }
    }
    depth[made - 1] = 0;
    for (int i = made - 2; i >= 0; i--) {
        // Each node below the root was made a child above, so its parent is set.
        // cppcheck-suppress uninitvar
        depth[i] = (uint8_t)(depth[parent[i]] + 1);
        if (i < used)
            with[depth[i]]++;
    }
}

// Limits the code lengths to `longest`. with[length] is the number of codes of a length. Longer
// codes are shortened; shorter codes are then lengthened until the code is possible again.
static void limit_lengths(int *with, int deepest, int longest)
{
    // sum over all codes of 2^(longest - length); a code is possible if it is at most 2^longest
    uint32_t used = 0;
    for (int length = deepest; length > longest; length--) {
        with[longest] += with[length];
        with[length] = 0;
    }
    for (int length = 1; length <= longest; length++)
        used += (uint32_t)with[length] << (longest - length);
    for (; used > 1U << longest; used--) {
        int length = longest - 1;
        while (!with[length])
            length--;
        // A code of this length becomes two codes with one more bit. The second of them is given to
        // a symbol that had a code of the greatest length.
        with[length]--;
        with[length + 1] += 2;
        with[longest]--;
    }
}

void ki_huffman_assign(ki_huffman_code *c, int count, const int *with, int longest)
{
    uint32_t next[17] = {0}, first = 0;
    for (int length = 1; length <= longest; length++) {
        next[length] = first;
        first = (first + (uint32_t)with[length]) << 1;
    }
    memset(c->bits, 0, sizeof c->bits);
    for (int i = 0; i < count; i++)
        if (c->length[i])
            c->bits[i] = (uint16_t)ki_reverse_bits(next[c->length[i]]++, c->length[i]);
}

void ki_huffman_make(ki_huffman_code *c, const uint32_t *counts, int count, int longest)
{
    // a Huffman tree of symbols that occur less than 2^16 times each is not deeper
    enum { DEEPEST = 32 };
    uint16_t sorted[KI_HUFFMAN_SYMBOLS];
    int with[DEEPEST + 1] = {0};
    int used = sort_symbols(counts, count, sorted);
    memset(c, 0, sizeof *c);
    if (used == 1)
        with[1] = 1;
    else if (used > 1)
        count_lengths(counts, sorted, used, with);
    limit_lengths(with, DEEPEST, longest);
    int i = 0;
    for (int length = longest; length > 0; length--)
        for (int k = 0; k < with[length]; k++)
            c->length[sorted[i++]] = (uint8_t)length;
    ki_huffman_assign(c, count, with, longest);
}
