// The checksums Adler-32 (RFC 1950) and CRC-32 (PNG, annex D).
#include "codec/deflate.h"

// In Adler-32, a is 1 plus the sum of all bytes, and b the sum of the values of a after each byte,
// both modulo 65521. Sixteen bytes are added at a time; the first of the sixteen counts sixteen
// times in b.
uint32_t ki_adler32(uint32_t sum, const uint8_t *bytes, size_t size)
{
    // number of bytes after which b, the second sum of Adler-32, is still below 2^32
    enum { AT_ONCE = 5552 };
    uint32_t a = sum & 0xffff, b = sum >> 16;
    while (size) {
        size_t count = size < AT_ONCE ? size : AT_ONCE, i = 0;
        for (; i + 16 <= count; i += 16) {
            uint32_t plain = 0, weighted = 0;
            for (uint32_t k = 0; k < 16; k++) {
                plain += bytes[i + k];
                weighted += (16 - k) * bytes[i + k];
            }
            b += 16 * a + weighted;
            a += plain;
        }
        for (; i < count; i++) {
            a += bytes[i];
            b += a;
        }
        a %= 65521;
        b %= 65521;
        bytes += count;
        size -= count;
    }
    return b << 16 | a;
}

void ki_crc32_fill(ki_crc32_table *table)
{
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t sum = i;
        for (int b = 0; b < 8; b++)
            sum = sum >> 1 ^ (sum & 1 ? 0xedb88320 : 0);
        table->sums[0][i] = sum;
    }
    for (int k = 1; k < 8; k++) // sums[k][b] is the checksum of the byte b followed by k zero bytes
        for (uint32_t i = 0; i < 256; i++)
            table->sums[k][i] =
                table->sums[k - 1][i] >> 8 ^ table->sums[0][table->sums[k - 1][i] & 255];
}

uint32_t ki_crc32(const ki_crc32_table *table, uint32_t sum, const uint8_t *bytes, size_t size)
{
    sum = ~sum;
    for (; size >= 8; size -= 8, bytes += 8) {
        sum ^= (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
               (uint32_t)bytes[3] << 24;
        sum = table->sums[7][sum & 255] ^ table->sums[6][sum >> 8 & 255] ^
              table->sums[5][sum >> 16 & 255] ^ table->sums[4][sum >> 24] ^
              table->sums[3][bytes[4]] ^ table->sums[2][bytes[5]] ^ table->sums[1][bytes[6]] ^
              table->sums[0][bytes[7]];
    }
    for (; size; size--)
        sum = sum >> 8 ^ table->sums[0][(sum ^ *bytes++) & 255];
    return ~sum;
}

uint32_t ki_crc32_long(const ki_asker *asker, const ki_crc32_table *table, const uint8_t *bytes,
                       size_t size)
{
    enum { PART = 1 << 24 };
    uint32_t sum = 0;
    for (size_t at = 0; at < size && (!at || ki_may_go_on(asker)); at += PART)
        sum = ki_crc32(table, sum, bytes + at, size - at < PART ? size - at : PART);
    return sum;
}
