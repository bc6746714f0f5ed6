#include "codec/components.h"

#include "image/pack.h"

#include <float.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are written as memory is");

int ki_component_bytes(kiln_table_format format)
{
    return format == KILN_TABLE_FORMAT_F32 ? 4 : format == KILN_TABLE_FORMAT_U8 ? 1 : 2;
}

// Converts a value in [0, 1] to an integer of 0 to `most`. The product with `most` is exact in
// double precision, and halves are rounded up.
static uint32_t whole(float value, double most)
{
    if (!(value > 0))
        return 0;
    return value < 1 ? (uint32_t)((double)value * most + 0.5) : (uint32_t)most;
}

static void pack(kiln_table_format format, const float *values, size_t count, uint8_t *bytes)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t number;
        switch (format) {
        case KILN_TABLE_FORMAT_U8:
            bytes[i] = (uint8_t)whole(values[i], 255);
            continue;
        case KILN_TABLE_FORMAT_U16:
            number = (uint16_t)whole(values[i], 65535);
            break;
        default:
            number = ki_half_from_float(values[i]);
            break;
        }
        memcpy(bytes + 2 * i, &number, sizeof number);
    }
}

void ki_components_pack(kiln_table_format format, const float *texels, size_t count, int channels,
                        int stored, uint8_t *bytes)
{
    enum { STRETCH = 64 };
    for (size_t done = 0; done < count; done += STRETCH) {
        size_t n = count - done < STRETCH ? count - done : STRETCH;
        float values[4 * STRETCH] = {0};
        for (size_t i = 0; i < n; i++)
            for (int c = 0; c < stored; c++)
                values[i * (size_t)stored + (size_t)c] =
                    c < channels ? texels[(done + i) * (size_t)channels + (size_t)c]
                    : c == 3     ? 1
                                 : 0;
        size_t value_count = n * (size_t)stored;
        if (format == KILN_TABLE_FORMAT_F32)
            memcpy(bytes, values, value_count * sizeof *values);
        else
            pack(format, values, value_count, bytes);
        bytes += value_count * (size_t)ki_component_bytes(format);
    }
}

void ki_components_unpack(kiln_table_format format, const uint8_t *bytes, size_t count,
                          float *values)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t number;
        float value;
        switch (format) {
        case KILN_TABLE_FORMAT_U8:
            value = (float)bytes[i] / 255;
            break;
        case KILN_TABLE_FORMAT_U16:
            memcpy(&number, bytes + 2 * i, sizeof number);
            value = (float)number / 65535;
            break;
        case KILN_TABLE_FORMAT_F32:
            memcpy(&value, bytes + 4 * i, sizeof value);
            break;
        default:
            memcpy(&number, bytes + 2 * i, sizeof number);
            value = ki_float_from_half(number);
            break;
        }
        float most = format == KILN_TABLE_FORMAT_F32 ? FLT_MAX : KI_HALF_MAX;
        values[i] = value > most ? most : value < -most ? -most : value == value ? value : 0;
    }
}
