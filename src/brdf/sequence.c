#include "brdf/brdf.h"

double ki_radical_inverse(uint32_t index)
{
    uint32_t b = index;
    b = (b << 16) | (b >> 16);
    b = ((b & 0x55555555u) << 1) | ((b & 0xaaaaaaaau) >> 1);
    b = ((b & 0x33333333u) << 2) | ((b & 0xccccccccu) >> 2);
    b = ((b & 0x0f0f0f0fu) << 4) | ((b & 0xf0f0f0f0u) >> 4);
    b = ((b & 0x00ff00ffu) << 8) | ((b & 0xff00ff00u) >> 8);
    return (double)b * (1.0 / 4294967296.0);
}

void ki_hammersley(uint32_t index, uint32_t count, double xi[2])
{
    xi[0] = (double)index / (double)count;
    xi[1] = ki_radical_inverse(index);
}
