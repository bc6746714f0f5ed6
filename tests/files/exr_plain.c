#include "exr_plain.h"

#include <string.h>

float plain_number(int part, const char *channel, int x, int y)
{
    (void)x;
    (void)y;
    uint32_t hash = (uint32_t)part + 1;
    for (; *channel; channel++)
        hash = hash * 31 + (unsigned char)*channel;
    return (float)(hash % 100003);
}

void plain_attribute(ki_writer *w, const char *name, const char *type, const void *bytes,
                     size_t size)
{
    ki_write(w, name, strlen(name) + 1);
    ki_write(w, type, strlen(type) + 1);
    ki_write_u32(w, (uint32_t)size);
    ki_write(w, bytes, size);
}

static int sampling_of(const plain_file *f, const char *channel)
{
    bool chroma = !strcmp(channel, "RY") || !strcmp(channel, "BY");
    return chroma && f->sampling ? f->sampling : 1;
}

static void write_channels(const plain_file *f, const plain_part *p, ki_writer *w)
{
    ki_writer list = {.context = w->context};
    for (int c = 0; c < PLAIN_CHANNELS && p->channels[c]; c++) {
        uint32_t sampling = (uint32_t)sampling_of(f, p->channels[c]);
        ki_write(&list, p->channels[c], strlen(p->channels[c]) + 1);
        ki_write_u32(&list, 2); // 32-bit floats
        ki_write_u32(&list, 0);
        ki_write_u32(&list, sampling);
        ki_write_u32(&list, sampling);
    }
    ki_write_u8(&list, 0);
    plain_attribute(w, "channels", "chlist", list.bytes, list.size);
    ki_writer_free(&list);
}

static void write_header(const plain_file *f, const plain_part *p, ki_writer *w)
{
    const float one = 1, zeros[2] = {0}, aspect = f->aspect != 0 ? f->aspect : 1;
    const int32_t data[4] = {0, 0, f->width - 1, f->height - 1};
    bool same = !f->display[2] && !f->display[3];
    const char *type = p->deep ? "deepscanline" : "scanlineimage";
    write_channels(f, p, w);
    plain_attribute(w, "compression", "compression", "", 1);
    plain_attribute(w, "dataWindow", "box2i", data, sizeof data);
    plain_attribute(w, "displayWindow", "box2i", same ? data : f->display, sizeof data);
    plain_attribute(w, "lineOrder", "lineOrder", "", 1);
    plain_attribute(w, "pixelAspectRatio", "float", &aspect, sizeof aspect);
    plain_attribute(w, "screenWindowCenter", "v2f", zeros, sizeof zeros);
    plain_attribute(w, "screenWindowWidth", "float", &one, sizeof one);
    if (p->name)
        plain_attribute(w, "name", "string", p->name, strlen(p->name));
    if (f->multipart || p->deep)
        plain_attribute(w, "type", "string", type, strlen(type));
    if (f->multipart) {
        const int32_t chunks = f->height;
        plain_attribute(w, "chunkCount", "int", &chunks, sizeof chunks);
    }
    if (f->chromaticities)
        plain_attribute(w, "chromaticities", "chromaticities", f->chromaticities, 32);
    if (f->neutral)
        plain_attribute(w, "adoptedNeutral", "v2f", f->neutral, 8);
    if (f->luminance)
        plain_attribute(w, "whiteLuminance", "float", f->luminance, 4);
    if (f->envmap) {
        const char value = (char)(f->envmap - 1);
        plain_attribute(w, "envmap", "envmap", &value, 1);
    }
    ki_write_u8(w, 0);
}

static void write_line(const plain_file *f, int part, int y, ki_writer *w)
{
    float (*value)(int, const char *, int, int) = f->value ? f->value : plain_number;
    const plain_part *p = &f->parts[part];
    if (f->multipart)
        ki_write_u32(w, (uint32_t)part);
    ki_write_u32(w, (uint32_t)y);
    size_t at = w->size;
    ki_write_u32(w, 0); // the number of bytes, which follows below
    for (int c = 0; c < PLAIN_CHANNELS && p->channels[c]; c++) {
        int sampling = sampling_of(f, p->channels[c]);
        for (int x = 0; x < f->width && y % sampling == 0; x += sampling) {
            float sample = value(part, p->channels[c], x, y);
            ki_write(w, &sample, sizeof sample);
        }
    }
    ki_patch_u32(w, at, (uint32_t)(w->size - at - 4));
}

void plain_write(const plain_file *f, ki_writer *w)
{
    bool deep = f->parts[0].deep && !f->multipart;
    ki_write_u32(w, 20000630);
    ki_write_u32(w, 2 | (f->multipart ? 0x1000 : 0) | (deep ? 0x800 : 0));
    for (int p = 0; p < f->part_count; p++)
        write_header(f, &f->parts[p], w);
    if (f->multipart)
        ki_write_u8(w, 0);
    size_t table = w->size;
    for (int i = 0; i < f->part_count * f->height; i++)
        ki_write_u64(w, 0);
    for (int i = 0; i < f->part_count * f->height; i++) {
        ki_patch_u64(w, table + 8 * (size_t)i, w->size);
        write_line(f, i / f->height, i % f->height, w);
    }
}
