// Writes seeds for the fuzz targets: small whole files of every kind that kiln reads, made by
// kiln's own writers, by OpenEXRCore and, byte by byte, here. In: a folder. Out:
// FOLDER/TARGET/NAME.
#include "seeds.h"

#include "codec/codec.h"
#include "codec/deflate.h"
#include "codec/engine_text.h"
#include "codec/uastc.h"
#include "files/exr_make.h"
#include "files/exr_plain.h"

#include <kiln/brdf.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char *folder;
static kiln_context *context;
static kiln_error error;

static void must(kiln_result result)
{
    if (result != KILN_OK)
        fail_msg("%s", error.message);
}

static void save(const char *target, const char *name, const void *bytes, size_t size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, target);
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/%s/%s", folder, target, name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        fail_msg("%s: cannot be written", path);
}

static void save_text(const char *target, const char *name, const char *text)
{
    save(target, name, text, strlen(text));
}

static void save_writer(const char *target, const char *name, ki_writer *w)
{
    save(target, name, w->bytes, w->size);
    ki_writer_free(w);
    *w = (ki_writer){.context = context};
}

ki_writer seed_writer(void)
{
    return (ki_writer){.context = context};
}

void seed_save(const char *target, int index, ki_writer *w)
{
    char name[32];
    snprintf(name, sizeof name, "made-%d", index);
    save_writer(target, name, w);
}

kiln_map seed_cube(int size, int level_count)
{
    kiln_map map;
    must(kiln_map_create(context, KILN_SHAPE_CUBE, size, level_count, &map, &error));
    for (int k = 0; k < map.level_count; k++)
        for (size_t i = 0; i < 3 * kiln_map_texels(&map, k); i++)
            map.level[k][i] = (float)(i * i % 101) / 16;
    for (int k = 0; k < map.level_count; k++)
        map.roughness[k] = (float)k / (float)map.level_count;
    return map;
}

// ---------------------------------------------------------------------------- files of kiln's own

// Which target reads a file with this ending.
static const char *target_of(const char *name)
{
    static const char *const known[][2] = {
        {".exr", "exr"},        {".hdr", "hdr"},       {".png", "png"},    {".ktx2", "ktx2"},
        {".ktx", "ktx1"},       {".dds", "dds"},       {".env", "env"},    {".glb", "glb"},
        {".json", "harmonics"}, {".txt", "harmonics"}, {".h", "harmonics"}};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof known / sizeof *known; i++)
        if (!strcmp(dot, known[i][0]))
            return known[i][1];
    return "input";
}

static void save_files(const char *prefix, kiln_files *files)
{
    enum { MOST = 40000 };
    for (int i = 0; i < files->count && i < 8; i++) {
        char name[256];
        const kiln_file *file = &files->file[i];
        const char *slash = strrchr(file->name, '/');
        snprintf(name, sizeof name, "%s-%s", prefix, slash ? slash + 1 : file->name);
        if (file->size > MOST)
            continue;
        save(target_of(file->name), name, file->bytes, file->size);
        if (i == 0)
            save("input", name, file->bytes, file->size);
    }
    kiln_files_free(files);
}

// A block of each mode of UASTC HDR, with values and weights of all sizes.
static void write_uastc(void)
{
    for (int mode = 0; mode <= KI_UASTC_SOLID; mode++) {
        ki_uastc_block b = {.mode = mode, .partition = mode, .solid = {1, 0x3c00, 0x7bff}};
        uint8_t bytes[KI_BLOCK_BYTES];
        char name[32];
        for (int i = 0; i < 12 && mode < KI_UASTC_SOLID; i++)
            b.value[i / 6][i % 6] = (uint8_t)ki_uastc_quantize((67 * i + 40 * mode) % 256,
                                                               ki_uastc_modes[mode].values, 0);
        for (int i = 0; i < 16 && mode < KI_UASTC_SOLID; i++)
            b.index[i] = (uint8_t)(i % ki_uastc_levels[ki_uastc_modes[mode].weights]);
        ki_uastc_pack(&b, bytes);
        snprintf(name, sizeof name, "mode-%d", mode);
        save("uastc", name, bytes, sizeof bytes);
    }
}

static void write_maps(void)
{
    static const char *const names[] = {"a.ktx2", "a.dds", "a_%s.exr", "a_%s.hdr", "a_%s.png"};
    kiln_map map = seed_cube(4, 0);
    kiln_sh sh = {.bands = 3, .c = {{1, 2, 3}, {0.5, 0, -0.5}}};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        for (int format = 0; format <= KILN_FORMAT_UASTC; format++)
            for (int zstd = 0; zstd < 2; zstd++) {
                const kiln_save_def def = {
                    .format = (kiln_format)format, .zstd = zstd, .sh = &sh, .lobe = "ggx"};
                char prefix[32];
                kiln_files files;
                snprintf(prefix, sizeof prefix, "map-%d-%d", format, zstd);
                if (kiln_map_encode(context, &map, names[n], &def, &files, NULL, &error) == KILN_OK)
                    save_files(prefix, &files);
            }
    kiln_map_free(&map);
}

static void write_engines(void)
{
    kiln_sh sh = {.bands = 3, .c = {{1, 2, 3}, {0.5, 0, -0.5}}};
    for (int i = 0; kiln_engine_at(i); i++)
        for (int size = 4; size <= 64; size *= 2) {
            const kiln_engine *engine = kiln_engine_at(i);
            kiln_map map = seed_cube(size, 0);
            kiln_files files;
            char name[64];
            snprintf(name, sizeof name, "a.%s", engine->ending[0] ? engine->ending : "exr");
            if (kiln_engine_encode(context, engine, &map, &sh, KILN_FORMAT_AUTO,
                                   engine->ending[0] ? name : "a", &files, NULL, &error) == KILN_OK)
                save_files(engine->name, &files);
            kiln_map_free(&map);
        }
}

static void write_harmonics(void)
{
    static const char *const names[] = {"sh.json", "sh.txt", "sh.h"};
    kiln_environment environment = {.levels = seed_cube(1, 1), .lobe = KILN_LOBE_GGX};
    for (int bands = 1; bands <= KILN_MAX_BANDS; bands += 2)
        for (size_t i = 0; i < 3; i++) {
            const kiln_sh sh = {.bands = bands, .irradiance = bands == 3, .c = {{1, -2, 0.25}}};
            const kiln_environment_save_def def = {.sh_path = names[i], .sh = &sh};
            kiln_files files;
            must(kiln_environment_encode(context, &environment, "a.ktx2", &def, &files, NULL,
                                         &error));
            const kiln_file *file = &files.file[files.count - 1];
            char name[32];
            snprintf(name, sizeof name, "%d-%s", bands, names[i]);
            save("input", name, file->bytes, file->size);
            // The first byte chooses none of the beginnings that the target puts there.
            uint8_t *copy = malloc(file->size + 1);
            memcpy(copy + 1, file->bytes, file->size);
            copy[0] = '\x04'; // 4 % 5: as it is
            save("harmonics", name, file->bytes, file->size);
            const char *body = strchr((const char *)file->bytes, '\n');
            size_t skipped = body ? (size_t)(body - (const char *)file->bytes) : 0;
            copy[skipped] = (uint8_t)(i == 0 ? 0 : i == 1 ? 2 : 1);
            save("harmonics", strcat(name, "-behind"), copy + skipped, file->size + 1 - skipped);
            free(copy);
            kiln_files_free(&files);
        }
    kiln_map_free(&environment.levels);
}

static void write_tables(void)
{
    enum { SIDE = 4, SLICES = 2 };
    float pixels[SIDE * SIDE * SLICES * 4];
    for (int i = 0; i < SIDE * SIDE * SLICES * 4; i++)
        pixels[i] = (float)(i % 17) / 16;
    for (int kind = 0; kiln_table_kind_names()[kind]; kind++)
        for (int format = 0; format <= KILN_TABLE_FORMAT_U8; format++) {
            char text[256], name[64];
            int channels = 1 + kind % 4;
            ki_writer w = {.context = context};
            const kiln_image image = {SIDE, SIDE * SLICES, channels, pixels, NULL};
            snprintf(text, sizeof text,
                     "kind=%s d=ggx g=smith sheen=ashikhmin axis=linear corners=1 complement=0 "
                     "flip=0 size=%dx%dx%d paths=0",
                     kiln_table_kind_names()[kind], SIDE, SIDE, SLICES);
            snprintf(name, sizeof name, "table-%d-%d.ktx2", kind, format);
            if (ki_ktx2_encode_table(&image, SLICES, text, (kiln_table_format)format, kind % 2, &w,
                                     &error) == KILN_OK) {
                save("table", name, w.bytes, w.size);
                save("ktx2", name, w.bytes, w.size);
            }
            ki_writer_free(&w);
            save_text("table_text", name, text);
        }
}

// --------------------------------------------------------------------------------------------- EXR

static float exr_value(int x, int y, const char *name)
{
    return (float)((x * 7 + y * 3 + name[0]) % 32) / 4;
}

// Saves the packed bytes of the file's first chunk, which begins behind an offset that leads there.
static void save_chunk(const char *name, const uint8_t *bytes, size_t size, const uint8_t head[4],
                       size_t words)
{
    for (size_t at = 0; at + 8 + 4 * words <= size; at++) {
        uint64_t offset;
        uint32_t packed;
        memcpy(&offset, bytes + at, 8);
        if (offset != at + 8)
            continue;
        memcpy(&packed, bytes + at + 4 + 4 * words, 4);
        size_t from = at + 8 + 4 * words;
        uint8_t *seed = malloc(4 + packed);
        memcpy(seed, head, 4);
        memcpy(seed + 4, bytes + from, packed);
        save("exr_chunk", name, seed, 4 + packed);
        free(seed);
        return;
    }
    fail_msg("%s: has no chunk", name);
}

static void write_exr_compressions(void)
{
    static const exr_make_channel sets[3][3] = {{{"B", EXR_PIXEL_HALF, 0, false},
                                                 {"G", EXR_PIXEL_HALF, 0, false},
                                                 {"R", EXR_PIXEL_HALF, 0, false}},
                                                {{"B", EXR_PIXEL_FLOAT, 0, false},
                                                 {"G", EXR_PIXEL_FLOAT, 0, false},
                                                 {"R", EXR_PIXEL_FLOAT, 0, false}},
                                                {{"BY", EXR_PIXEL_HALF, 2, false},
                                                 {"RY", EXR_PIXEL_HALF, 2, false},
                                                 {"Y", EXR_PIXEL_HALF, 0, false}}};
    static const uint8_t kinds[3] = {0, 1, 5};
    for (int compression = 0; compression < 8; compression++) // DWA's files lie in tests/files/good
        for (int set = 0; set < 3; set++)
            for (int tiled = 0; tiled < 2; tiled++) {
                enum { SIDE = 16 };
                int height = compression < 3 ? 1 : SIDE;
                if (set == 2 && (tiled || height == 1))
                    continue;
                exr_make make = {.width = SIDE,
                                 .height = tiled ? SIDE : height,
                                 .compression = (exr_compression_t)compression,
                                 .tile_width = tiled ? SIDE : 0,
                                 .tile_height = tiled ? SIDE : 0,
                                 .mip_levels = tiled,
                                 .channels = sets[set],
                                 .channel_count = 3,
                                 .value = exr_value};
                size_t size;
                char name[64];
                snprintf(name, sizeof name, "made-%d-%d-%d.exr", compression, set, tiled);
                uint8_t *bytes = exr_make_file(&make, &size);
                save("exr", name, bytes, size);
                const uint8_t head[4] = {(uint8_t)compression, kinds[set], SIDE - 1,
                                         (uint8_t)(make.height - 1)};
                if (!tiled)
                    save_chunk(name, bytes, size, head, 2);
                free(bytes);
            }
}

// Panoramas, which can be read by rows: scan lines and tiles, in several orders, with a window that
// is not the picture, and in the second of two parts.
static void write_panoramas(void)
{
    static const exr_make_channel channels[3] = {{"B", EXR_PIXEL_HALF, 0, false},
                                                 {"G", EXR_PIXEL_FLOAT, 0, false},
                                                 {"R", EXR_PIXEL_HALF, 0, false}};
    enum { ROWS = 20 };
    for (int i = 0; i < 8 * 4; i++) {
        int kind = i / 8;
        exr_make make = {.width = kind == 2 ? 30 : 2 * ROWS,
                         .height = kind == 2 ? 11 : ROWS,
                         .x = kind == 2 ? -3 : 0,
                         .y = kind == 2 ? 5 : 0,
                         .display = {{{{0, 0}}}, {{{2 * ROWS - 1, ROWS - 1}}}},
                         .compression = (exr_compression_t)(i % 8),
                         .order =
                             kind == 3 ? EXR_LINEORDER_DECREASING_Y : EXR_LINEORDER_INCREASING_Y,
                         .tile_width = kind == 1 ? 9 : 0,
                         .tile_height = kind == 1 ? 7 : 0,
                         .part_count = 1 + kind / 3,
                         .channels = channels,
                         .channel_count = 3,
                         .value = exr_value};
        size_t size;
        char name[64];
        snprintf(name, sizeof name, "panorama-%d.exr", i);
        uint8_t *bytes = exr_make_file(&make, &size);
        save("rows", name, bytes, size);
        free(bytes);
    }
    kiln_map map;
    must(kiln_sky(context, &(kiln_sky_def){.size = 16}, &map, &error));
    char path[512];
    snprintf(path, sizeof path, "%s/rows/sky.hdr", folder);
    must(kiln_map_save(context, &map, path, NULL, NULL, &error));
    kiln_map_free(&map);
}

static void write_exr_plain(void)
{
    static const float primaries[8] = {0.68f, 0.32f, 0.265f, 0.69f, 0.15f, 0.06f, 0.3127f, 0.329f};
    static const float neutral[2] = {0.3457f, 0.3585f};
    const plain_file files[] = {
        {.width = 4, .height = 2, .parts = {{.channels = {"B", "G", "R"}}}, .part_count = 1},
        {.width = 4,
         .height = 2,
         .parts = {{.channels = {"BY", "RY", "Y"}}},
         .part_count = 1,
         .sampling = 2,
         .chromaticities = primaries,
         .neutral = neutral},
        {.width = 4,
         .height = 2,
         .multipart = true,
         .part_count = 2,
         .parts = {{.name = "depth", .channels = {"Z"}},
                   {.name = "beauty", .channels = {"rgba.B", "rgba.G", "rgba.R"}}}},
        {.width = 4,
         .height = 2,
         .envmap = 1,
         .part_count = 1,
         .parts = {{.channels = {"blue", "diffuse.B", "diffuse.G", "diffuse.R", "green", "red"}}}},
        {.width = 2,
         .height = 12,
         .envmap = 2,
         .part_count = 1,
         .parts = {{.channels = {"X", "Y", "Z"}}}},
        {.width = 4,
         .height = 4,
         .display = {1, 1, 6, 2},
         .part_count = 1,
         .parts = {{.channels = {"A", "B", "G", "R"}}}},
        {.width = 4, .height = 2, .part_count = 1, .parts = {{.channels = {"Z"}, .deep = true}}},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char name[32];
        ki_writer w = {.context = context};
        plain_write(&files[i], &w);
        snprintf(name, sizeof name, "plain-%zu.exr", i);
        save_writer("exr", name, &w);
    }
}

// ---------------------------------------------------------------------------------- HDR and texts

static void write_texts(void)
{
    static const char flat[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2.0\nCOLORCORR=1 0.5 2\n"
        "PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n\n-Y 1 +X 2\n"
        "\1\2\3\200\4\5\6\201";
    static const char xyz[] = "#?RGBE\nFORMAT=32-bit_rle_xyze\nSOFTWARE=x\nVIEW= -vtv -vh 90\n\n"
                              "+X 1 -Y 3\n\1\2\3\200\1\1\1\2\4\5\6\201";
    save("hdr", "flat.hdr", flat, sizeof flat - 1);
    save("hdr", "xyz.hdr", xyz, sizeof xyz - 1);
    save_text("engine_text", "atlas",
              "engine=playcanvas layout=atlas format=rgbp roughness=0,0.2,0.4,0.6,0.8,1");
    save_text("engine_text", "cubeuv", "engine=three layout=cubeuv roughness=0,1");
    save_text("number", "point", "-12.5e-3 7");
    save_text("number", "large", "123456789012345678901234567890e300,");
    save_text("json", "all",
              "{\"a\": [1, -2.5e3, true], \"b\": {\"c\": \"d\\\"\\u0041\"}, \"e\": null}");
    save_text("json", "triple", "[1, 2, 3]");
    save_text("shown_text", "utf-8", "a\\b\x1b[2J \xc3\xa4 \xe2\x80\xae \xf0\x9f\x8c\x9e \xff.");
    save_text("faces", "px", "a/px%s.exr\na/nx.exr\na/py.exr\na/ny.exr\na/pz.exr\na/nz.exr");
    save_text("faces", "quake", "skyrt.png\nskylf.png\nskyup.png\nskydn.png\nskyft.png\nskybk.png");
    save_text("faces", "sides",
              "right1.jpg\nleft2.jpg\ntop3.jpg\nbottom4.jpg\nfront5.jpg\nback6.jpg");
    static const char folder[] = "px.hdr\nnx.hdr\npy.hdr\nny.hdr\npz.hdr\nnz.hdr\nground.hdr\n\n#?"
                                 "RGBE\n\n-Y 1 +X 1\n\1\2\3\200";
    save("folder", "px", folder, sizeof folder - 1);
    save_text("folder", "sides",
              "a_Right.png\na_Left.png\na_Up.png\na_Down.png\na_Front.png\na_Back.png\n\n");
    save_text("folder", "two",
              "px.hdr\nnx.hdr\npy.hdr\nny.hdr\npz.hdr\nnz.hdr\nrt.hdr\nlf.hdr\nup.hdr\ndn.hdr\nft."
              "hdr\nbk.hdr\n\n");
    save_text("manifest", "two",
              "{\"input\": \"a.exr\", \"output\": \"a.ktx2\", \"for\": \"three\"}\n"
              "{\"input\": [\"b\", \"c\"], \"size\": 64, \"zstd\": true}\n");
    save_text("manifest", "escapes", "{\"a\\u0041\\ud83c\\udf0c\": null,\n\"b\": -1.5e3}");
    save_text("eval", "columns", "e --roughness 0.5\n0.25\n 1e-1 \r\n.75");
    save_text("eval", "alone", "specular --roughness 0.5 --mu 0.5 --nol 0.5 --noh 0.5 --voh 0.5");
    save_text("eval", "json", "schlick --json\n0.04 0.5\n1 1\n");
    save_text("eval", "metal", "conductor --n 0.2\n0.5 3\n0.1 2");
    save_text("gain_map", "xmp",
              "\1.<rdf:Description hdrgm:Version=\"1.0\" hdrgm:GainMapMin=\"-0.5\" "
              "hdrgm:GainMapMax=\"3\" hdrgm:Gamma=\"1.5\" hdrgm:OffsetSDR=\"0.015625\" "
              "hdrgm:OffsetHDR=\"0.03125\" hdrgm:HDRCapacityMin=\"0\" hdrgm:HDRCapacityMax=\"3\" "
              "hdrgm:BaseRenditionIsHDR=\"True\"/>");
    save_text("gain_map", "xmp-list",
              "\1.hdrgm:Version='1.0' <hdrgm:GainMapMax><rdf:Seq><rdf:li>1.5</rdf:li>"
              "<rdf:li>2.5</rdf:li><rdf:li>4</rdf:li></rdf:Seq></hdrgm:GainMapMax>");
    static const uint8_t iso[1 + 61] = {61, 0, 0, 0, 0, 64, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0,
                                        0,  4, 0, 0, 0, 1,  0, 0, 0, 0, 0, 0, 0, 1, 0, 0,
                                        0,  3, 0, 0, 0, 1,  0, 0, 0, 1, 0, 0, 0, 1, 0, 0,
                                        0,  1, 0, 0, 0, 64, 0, 0, 0, 1, 0, 0, 0, 64};
    save("gain_map", "iso", iso, sizeof iso);
    static const char entry[] = "\x12\0\0\0KTXorientation\0rd\0\0\0"
                                "\x17\0\0\0engine\0roughness=0,0.5,1\0";
    save("metadata", "entries", entry, sizeof entry - 1);
}

// --------------------------------------------------------------------------------------------- PNG

static void put_high_first(ki_writer *w, uint32_t value)
{
    ki_write_u32(w, value << 24 | (value & 0xff00) << 8 | (value >> 8 & 0xff00) | value >> 24);
}

static void add_chunk(ki_writer *w, const char *type, const void *bytes, size_t size)
{
    ki_crc32_table table;
    ki_crc32_fill(&table);
    put_high_first(w, (uint32_t)size);
    size_t start = w->size;
    ki_write(w, type, 4);
    ki_write(w, bytes, size);
    put_high_first(w, ki_crc32(&table, 0, w->bytes + start, size + 4));
}

// zlib data of one block that is stored as it is, so that changes of a byte change that byte alone.
static void add_stored(ki_writer *w, const char *type, const void *before, size_t before_size,
                       const void *bytes, size_t size)
{
    ki_writer d = {.context = context};
    ki_write(&d, before, before_size);
    ki_write(&d, "\x78\x01\x01", 3);
    ki_write_u16(&d, (uint16_t)size);
    ki_write_u16(&d, (uint16_t)~size);
    ki_write(&d, bytes, size);
    put_high_first(&d, ki_adler32(1, bytes, size));
    add_chunk(w, type, d.bytes, d.size);
    ki_writer_free(&d);
}

static void put_tag(uint8_t *profile, int index, const char *name, size_t offset, size_t size)
{
    uint8_t *tag = profile + 132 + 12 * index;
    memcpy(tag, name, 4);
    for (int i = 0; i < 4; i++) {
        tag[4 + i] = (uint8_t)(offset >> (24 - 8 * i));
        tag[8 + i] = (uint8_t)(size >> (24 - 8 * i));
    }
}

// A profile with three columns, a parametric curve, a curve as a table, and a name.
static size_t make_profile(uint8_t profile[512])
{
    static const char *const names[] = {"rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC", "desc"};
    static const uint8_t columns[3][12] = {{0, 0, 0x6f, 0xa2, 0, 0, 0x38, 0xf5, 0, 0, 3, 0x90},
                                           {0, 0, 0x62, 0x99, 0, 0, 0xb7, 0x85, 0, 0, 0x18, 0xda},
                                           {0, 0, 0x24, 0xa0, 0, 0, 0x0f, 0x84, 0, 0, 0xb6, 0xcf}};
    static const uint8_t para[] =
        "para\0\0\0\0\0\3\0\0\0\2\x66\x66\0\0\xf2\xa7\0\0\x0d\x59\0\0\x13\xd0"
        "\0\0\x0a\x5b";
    static const uint8_t curve[] = "curv\0\0\0\0\0\0\0\3\0\0\x40\0\xff\xff\0";
    size_t at = 132 + 12 * 7;
    memset(profile, 0, 512);
    memcpy(profile + 16, "RGB XYZ ", 8);
    memcpy(profile + 36, "acsp", 4);
    profile[131] = 7;
    for (int i = 0; i < 3; i++, at += 20) {
        put_tag(profile, i, names[i], at, 20);
        memcpy(profile + at, "XYZ ", 4);
        memcpy(profile + at + 8, columns[i], 12);
    }
    for (int i = 3; i < 6; i++) {
        const uint8_t *data = i == 3 ? para : curve;
        size_t size = i == 3 ? sizeof para - 1 : sizeof curve - 1;
        put_tag(profile, i, names[i], at, size);
        memcpy(profile + at, data, size);
        at += size;
    }
    put_tag(profile, 6, names[6], at, 28);
    memcpy(profile + at, "desc\0\0\0\0\0\0\0\x0fsquare", 18);
    return at + 28;
}

static void write_png(void)
{
    static const uint8_t kinds[15][2] = {{0, 1}, {0, 2},  {0, 4},  {0, 8}, {0, 16},
                                         {2, 8}, {2, 16}, {3, 1},  {3, 2}, {3, 4},
                                         {3, 8}, {4, 8},  {4, 16}, {6, 8}, {6, 16}};
    static const uint8_t zeros[256], gamma[4] = {0, 0, 0xb1, 0x8f}, cicp[4] = {9, 16, 0, 1};
    static const uint8_t channels[7] = {1, 0, 3, 1, 2, 0, 4};
    uint8_t profile[512];
    size_t profile_size = make_profile(profile);
    save("icc", "rgb.icc", profile, profile_size);
    for (int i = 0; i < 15; i++) {
        ki_writer w = {.context = context};
        char name[32];
        const uint8_t head[13] = {0, 0, 0, 4, 0, 0, 0, 2, kinds[i][1], kinds[i][0]};
        size_t row = 1 + (size_t)(4 * kinds[i][1] * channels[kinds[i][0]] + 7) / 8;
        ki_write(&w, "\x89PNG\r\n\x1a\n", 8);
        add_chunk(&w, "IHDR", head, sizeof head);
        if (i % 5 == 1)
            add_chunk(&w, "gAMA", gamma, 4);
        if (i % 5 == 2)
            add_chunk(&w, "cICP", cicp, 4);
        if (i % 5 == 3)
            add_stored(&w, "iCCP", "profile\0", 9, profile, profile_size);
        if (i % 5 == 4)
            add_chunk(&w, "sRGB", zeros, 1);
        if (kinds[i][0] == 3)
            add_chunk(&w, "PLTE", profile, 48);
        add_chunk(&w, "tEXt", "kiln\0engine=three layout=cubeuv roughness=0,1", 45);
        add_stored(&w, "IDAT", "", 0, zeros, 2 * row);
        add_chunk(&w, "IEND", zeros, 0);
        snprintf(name, sizeof name, "stored-%d.png", i);
        save_writer("png", name, &w);
        const uint8_t rows[16] = {(uint8_t)i, 3, 3, (uint8_t)(i & 1), 15, 1, 1, 2, 3, 4, 5,
                                  6,          7, 8};
        save("png_rows", name, rows, sizeof rows);
        save("deflate", name, rows, sizeof rows);
    }
}

// -------------------------------------------------------------------------------------------- JPEG

#ifdef KILN_FUZZ_JPEG
#include <jpeglib.h>

static void make_jpeg(int components, bool progressive, ki_writer *w)
{
    enum { SIDE = 8 };
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    uint8_t row[SIDE * 2 * 4];
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = 2 * SIDE;
    jpeg.image_height = SIDE;
    jpeg.input_components = components;
    jpeg.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    if (progressive)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < SIDE; y++) {
        JSAMPROW rows = row;
        for (int x = 0; x < 2 * SIDE * components; x++)
            row[x] = (uint8_t)(x * 5 + y * 9);
        jpeg_write_scanlines(&jpeg, &rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    ki_write(w, bytes, size);
    free(bytes);
}

// Appends a JPEG picture with a segment behind its first marker.
static void add_jpeg(ki_writer *w, int marker, const void *data, size_t size)
{
    ki_writer jpeg = {.context = context};
    make_jpeg(3, false, &jpeg);
    ki_write(w, jpeg.bytes, 2);
    ki_write_u8(w, 0xff);
    ki_write_u8(w, (uint8_t)marker);
    ki_write_u8(w, (uint8_t)((size + 2) >> 8));
    ki_write_u8(w, (uint8_t)(size + 2));
    ki_write(w, data, size);
    ki_write(w, jpeg.bytes + 2, jpeg.size - 2);
    ki_writer_free(&jpeg);
}

static void write_jpeg(void)
{
    static const char xmp[] = "http://ns.adobe.com/xap/1.0/\0<x hdrgm:Version=\"1.0\" "
                              "hdrgm:GainMapMax=\"3\" hdrgm:HDRCapacityMax=\"3\"/>";
    static const char exif[] = "Exif\0\0MM\0*\0\0\0\x08\0\1\1\x12\0\3\0\0\0\1\0\6\0\0\0\0\0\0";
    static const char index[] =
        "MPF\0MM\0*\0\0\0\x08\0\3\xb0\0\0\7\0\0\0\4"
        "0100\xb0\1\0\4\0\0\0\1\0\0\0\2\xb0\2\0\7\0\0\0\x20\0\0\0\x32\0\0\0";
    uint8_t profile[14 + 512] = "ICC_PROFILE\0\1\1";
    size_t size = make_profile(profile + 14);
    ki_writer w = {.context = context};
    for (int i = 0; i < 6; i++) {
        static const int components[3] = {1, 3, 4};
        char name[32];
        snprintf(name, sizeof name, "plain-%d.jpg", i);
        make_jpeg(components[i % 3], i >= 3, &w);
        save_writer("jpeg", name, &w);
    }
    add_jpeg(&w, 0xe1, exif, sizeof exif - 1);
    save_writer("jpeg", "turned.jpg", &w);
    add_jpeg(&w, 0xe2, profile, 14 + size);
    save_writer("jpeg", "profile.jpg", &w);
    add_jpeg(&w, 0xe2, index, sizeof index - 1);
    add_jpeg(&w, 0xe1, xmp, sizeof xmp - 1);
    save_writer("jpeg", "index.jpg", &w);
    add_jpeg(&w, 0xe1, xmp, sizeof xmp - 1);
    add_jpeg(&w, 0xe1, xmp, sizeof xmp - 1);
    save_writer("jpeg", "gain-map.jpg", &w);
}
#else
static void write_jpeg(void)
{
}
#endif

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    folder = argv[1];
    mkdir(folder, 0777);
    must(kiln_context_create(NULL, &context, &error));
    write_maps();
    write_uastc();
    write_engines();
    write_harmonics();
    write_tables();
    write_exr_compressions();
    write_exr_plain();
    write_panoramas();
    write_texts();
    write_png();
    write_jpeg();
    seed_textures();
    kiln_context_destroy(context);
    return 0;
}
