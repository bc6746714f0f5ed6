// What lies inside of files: packed texels, profiles, gain maps and metadata. Each is put into a
// file that is otherwise whole, or handed to its reader alone, so that every input reaches that
// reader.
#include "fuzz.h"

#include "codec/codec.h"
#include "codec/gain_map.h"
#include "codec/icc.h"
#include "codec/ktx1.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MEMORY = 64 << 20 };

// --------------------------------------------------------------------------------------- EXR chunk

typedef struct channel {
    const char *name;
    uint32_t type, sampling; // type: 0 whole numbers, 1 half floats, 2 floats
} channel;

static const channel layouts[8][4] = {{{"B", 1, 1}, {"G", 1, 1}, {"R", 1, 1}},
                                      {{"B", 2, 1}, {"G", 2, 1}, {"R", 2, 1}},
                                      {{"A", 1, 1}, {"B", 2, 1}, {"G", 1, 1}, {"R", 0, 1}},
                                      {{"Y", 1, 1}},
                                      {{"Y", 2, 1}},
                                      {{"BY", 1, 2}, {"RY", 1, 2}, {"Y", 1, 1}},
                                      {{"X", 1, 1}, {"Y", 1, 1}, {"Z", 1, 1}},
                                      {{"B", 0, 1}, {"G", 0, 1}, {"R", 0, 1}}};

static void add_attribute(ki_writer *w, const char *name, const char *type, const void *bytes,
                          size_t size)
{
    ki_write(w, name, strlen(name) + 1);
    ki_write(w, type, strlen(type) + 1);
    ki_write_u32(w, (uint32_t)size);
    ki_write(w, bytes, size);
}

static void add_channels(ki_writer *w, const channel *channels)
{
    ki_writer list = {.context = w->context};
    for (int c = 0; c < 4 && channels[c].name; c++) {
        ki_write(&list, channels[c].name, strlen(channels[c].name) + 1);
        ki_write_u32(&list, channels[c].type);
        ki_write_u32(&list, 0);
        ki_write_u32(&list, channels[c].sampling);
        ki_write_u32(&list, channels[c].sampling);
    }
    ki_write_u8(&list, 0);
    add_attribute(w, "channels", "chlist", list.bytes, list.size);
    ki_writer_free(&list);
}

// An EXR file of one chunk. The input's byte 0 chooses the compression, byte 1 the channels and
// whether the file has tiles, and bytes 2 and 3 the width and the height. The input's other bytes
// are the chunk's packed texels.
void fuzz_exr_chunk(const uint8_t *bytes, size_t size)
{
    static const int lines[10] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    enum { HEAD = 4, TILED = 128, LONGEST = 64 };
    if (size < HEAD)
        return;
    uint8_t compression = bytes[0] % 10;
    bool tiled = bytes[1] & TILED;
    int width = 1 + bytes[2] % LONGEST, height = 1 + bytes[3] % LONGEST;
    if (!tiled && height > lines[compression])
        height = lines[compression];
    const int32_t box[4] = {0, 0, width - 1, height - 1};
    const uint32_t tile[2] = {LONGEST, LONGEST};
    const float one = 1, zeros[2] = {0};
    kiln_context *context = fuzz_context(MEMORY);
    ki_writer w = {.context = context};
    ki_write_u32(&w, 20000630);
    ki_write_u32(&w, 2 | (tiled ? 0x200 : 0));
    add_channels(&w, layouts[bytes[1] % 8]);
    add_attribute(&w, "compression", "compression", &compression, 1);
    add_attribute(&w, "dataWindow", "box2i", box, sizeof box);
    add_attribute(&w, "displayWindow", "box2i", box, sizeof box);
    add_attribute(&w, "lineOrder", "lineOrder", "", 1);
    add_attribute(&w, "pixelAspectRatio", "float", &one, sizeof one);
    add_attribute(&w, "screenWindowCenter", "v2f", zeros, sizeof zeros);
    add_attribute(&w, "screenWindowWidth", "float", &one, sizeof one);
    if (tiled) {
        uint8_t description[9] = {0};
        memcpy(description, tile, sizeof tile);
        add_attribute(&w, "tiles", "tiledesc", description, sizeof description);
    }
    ki_write_u8(&w, 0);
    ki_write_u64(&w, w.size + 8);
    for (int i = 0; i < (tiled ? 4 : 1); i++) // the line, or column, row and level of the tile
        ki_write_u32(&w, 0);
    ki_write_u32(&w, (uint32_t)(size - HEAD));
    ki_write(&w, bytes + HEAD, size - HEAD);
    fuzz_decode(w.bytes, w.size);
    ki_writer_free(&w);
    fuzz_end(context);
}

// ---------------------------------------------------------------------------------------- profiles

// The profile of a picture, by which every sample is then converted.
void fuzz_icc(const uint8_t *bytes, size_t size)
{
    enum { SAMPLES = 256 };
    kiln_context *context = fuzz_context(MEMORY);
    kiln_load_report report = {0};
    kiln_note note;
    ki_file_color color;
    uint8_t *profile = ki_alloc_raw(context, size ? size : 1, 1);
    fuzz_must(profile != NULL);
    if (size)
        memcpy(profile, bytes, size);
    ki_icc_read(profile, size, &color, &report);
    float table[SAMPLES];
    for (int c = 0; c < 3; c++)
        ki_file_color_fill(&color, c, table, SAMPLES);
    kiln_image image;
    fuzz_must(kiln_image_create(context, SAMPLES / 8, 8, 3, &image, NULL) == KILN_OK);
    for (int i = 0; i < SAMPLES; i++)
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] = table[(i * (c + 1)) % SAMPLES];
    fuzz_must(ki_file_color_finish(context, &color, &image, NULL) == KILN_OK);
    for (int i = 0; kiln_load_report_note(&report, i, &note); i++)
        fuzz_must_end(note.text, sizeof note.text);
    kiln_image_free(&image);
    ki_file_color_free(&color);
    fuzz_end(context);
}

// --------------------------------------------------------------------------------------- gain maps

// Byte 0 divides the rest into numbers of ISO 21496-1 and text of XMP. Numbers that are accepted
// give finite values.
void fuzz_gain_map(const uint8_t *bytes, size_t size)
{
    enum { SIDE = 4 };
    static const uint8_t samples[2 * 2 * 3] = {0, 128, 255, 1, 2, 3, 254, 17, 90, 33, 200, 100};
    if (!size)
        return;
    size_t iso = bytes[0] < size ? bytes[0] : size - 1, xmp = size - 1 - iso;
    // in memory of their own, so that a read past the end is seen
    uint8_t *numbers = (uint8_t *)malloc(iso ? iso : 1), *text = malloc(xmp ? xmp : 1);
    fuzz_must(numbers && text);
    memcpy(numbers, bytes + 1, iso);
    memcpy(text, bytes + 1 + iso, xmp);
    ki_jpeg_head head = {.iso = {iso ? numbers : NULL, iso}, .xmp = {xmp ? text : NULL, xmp}};
    ki_gain_map map;
    ki_gain_map_announced(&head);
    if (ki_gain_map_read(&head, &map)) {
        kiln_context *context = fuzz_context(MEMORY);
        kiln_image image;
        fuzz_must(kiln_image_create(context, SIDE, SIDE, 3, &image, NULL) == KILN_OK);
        for (int i = 0; i < 3 * SIDE * SIDE; i++)
            image.pixels[i] = (float)i / (3 * SIDE * SIDE);
        for (int channels = 1; channels <= 3; channels += 2)
            fuzz_must(ki_gain_map_apply(context, &map, samples, 2, 2, channels, &image, NULL) ==
                      KILN_OK);
        kiln_image_free(&image);
        fuzz_end(context);
    }
    free(numbers);
    free(text);
}

// ---------------------------------------------------------------------------------------- metadata

// Metadata at the end of a KTX2 file and in the midst of a KTX 1 file, both otherwise whole.
void fuzz_metadata(const uint8_t *bytes, size_t size)
{
    enum { KTX1_LENGTH = 60, KTX1_HEADER = 64, KTX2_OFFSET = 56, KTX2_LENGTH = 60 };
    kiln_context *context = fuzz_context(MEMORY);
    const kiln_save_def def = {.format = KILN_FORMAT_RGBA16F};
    kiln_map map;
    ki_writer w = {.context = context}, old = {.context = context};
    fuzz_must(kiln_map_create(context, KILN_SHAPE_CUBE, 2, 0, &map, NULL) == KILN_OK);
    fuzz_must(ki_ktx2_encode(&map, &def, &w, NULL) == KILN_OK);
    ki_patch_u32(&w, KTX2_OFFSET, (uint32_t)w.size);
    ki_patch_u32(&w, KTX2_LENGTH, (uint32_t)size);
    ki_write(&w, bytes, size);
    fuzz_decode(w.bytes, w.size);

    fuzz_must(ki_ktx1_encode(&map, NULL, "filament", KILN_FORMAT_RGBA16F, &old, NULL) == KILN_OK);
    uint32_t length;
    memcpy(&length, old.bytes + KTX1_LENGTH, sizeof length);
    size_t texels = KTX1_HEADER + length;
    w.size = 0;
    ki_write(&w, old.bytes, KTX1_HEADER);
    ki_patch_u32(&w, KTX1_LENGTH, (uint32_t)size);
    ki_write(&w, bytes, size);
    ki_write(&w, old.bytes + texels, old.size - texels);
    fuzz_decode(w.bytes, w.size);
    ki_writer_free(&w);
    ki_writer_free(&old);
    kiln_map_free(&map);
    fuzz_end(context);
}
