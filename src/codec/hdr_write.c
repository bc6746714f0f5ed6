// Writing of Radiance HDR files (RGBE). In: RGB floats, rows from top to bottom. Out: a file whose
// rows have new run-lengths where the format allows them, and are flat elsewhere.
#include "codec/codec.h"
#include "codec/hdr.h"

#include <math.h>
#include <string.h>

// Converts an RGB texel to three mantissas and an exponent. The exponent is that of the largest
// channel; mantissas are rounded to the nearest byte.
static void to_rgbe(const float rgb[3], uint8_t rgbe[4])
{
    float c[3], most = 0;
    for (int i = 0; i < 3; i++) {
        c[i] = rgb[i] > 0 ? rgb[i] : 0;
        // 255 / 256 * 2^127, the largest value of RGBE.
        c[i] = c[i] < 0x1.fep126F ? c[i] : 0x1.fep126F;
        most = c[i] > most ? c[i] : most;
    }
    int e = 0;
    (void)frexpf(most, &e);
    double scale = ldexp(1, 8 - e);
    if ((double)most * scale >= 255.5) {
        e++;
        scale /= 2;
    }
    if (most <= 0 || e < -127) {
        memset(rgbe, 0, 4);
        return;
    }
    for (int i = 0; i < 3; i++)
        rgbe[i] = (uint8_t)((double)c[i] * scale + 0.5);
    rgbe[3] = (uint8_t)(e + 128);
}

// Writes one channel of a line: four or more equal bytes as a run, other bytes literally.
static void write_runs(ki_writer *w, const uint8_t *bytes, int count)
{
    for (int x = 0; x < count;) {
        int run = 1;
        while (run < 127 && x + run < count && bytes[x + run] == bytes[x])
            run++;
        if (run >= 4) {
            ki_write_u8(w, (uint8_t)(128 + run));
            ki_write_u8(w, bytes[x]);
            x += run;
            continue;
        }
        int end = x + 1;
        while (end < count && end - x < 128 &&
               !(end + 3 < count && bytes[end] == bytes[end + 1] && bytes[end] == bytes[end + 2] &&
                 bytes[end] == bytes[end + 3]))
            end++;
        ki_write_u8(w, (uint8_t)(end - x));
        ki_write(w, bytes + x, (size_t)(end - x));
        x = end;
    }
}

kiln_result ki_hdr_encode(const float *pixels, int width, int height, ki_writer *writer,
                          kiln_error *error)
{
    ki_write_text(writer, "#?RADIANCE\nSOFTWARE=kiln %s\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n",
                  kiln_version(), height, width);
    bool runs = width >= KI_HDR_RUNS_LEAST && width <= KI_HDR_RUNS_MOST;
    uint8_t *planes = ki_alloc_raw(writer->context, (size_t)width, 4);
    kiln_result result = KILN_OK;
    for (int y = 0; planes && y < height; y++) {
        if (y % 16 == 0 && !ki_go_on(writer->context)) {
            result = ki_fail_cancelled(error, "writing");
            break;
        }
        const float *line = pixels + 3 * (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++) {
            uint8_t texel[4];
            to_rgbe(line + 3 * (size_t)x, texel);
            for (int c = 0; c < 4; c++)
                planes[runs ? c * width + x : 4 * x + c] = texel[c];
        }
        if (!runs) {
            ki_write(writer, planes, 4 * (size_t)width);
            continue;
        }
        const uint8_t start[4] = {2, 2, (uint8_t)(width >> 8), (uint8_t)width};
        ki_write(writer, start, 4);
        for (int c = 0; c < 4; c++)
            write_runs(writer, planes + (size_t)c * (size_t)width, width);
    }
    bool good = planes && !writer->failed;
    ki_free(planes);
    return good ? result
                : ki_fail_memory(writer->context, error, "an HDR file",
                                 writer->size + 4 * (size_t)width);
}
