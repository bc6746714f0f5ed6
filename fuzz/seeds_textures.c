// Seeds for the readers of KTX2, DDS and KTX 1: cubes and pictures of 2 x 2 texels as other
// programs write them, in every format, and files for engines.
#include "seeds.h"

#include "codec/deflate.h"
#include "codec/env.h"
#include "codec/galacean_env.h"
#include "codec/gltf.h"
#include "codec/ktx1.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 2 };

typedef struct texture {
    uint32_t number; // vkFormat, DXGI format or glInternalFormat; 0 for the older header of DDS
    uint32_t type;   // glType of KTX 1
    int texel_bytes, faces;
} texture;

static void put_words(ki_writer *w, const uint32_t *words, int count)
{
    for (int i = 0; i < count; i++)
        ki_write_u32(w, words[i]);
}

static void put_texels(ki_writer *w, int bytes)
{
    for (int i = 0; i < bytes; i++)
        ki_write_u8(w, (uint8_t)(i * 37 & 0x7b));
}

static void write_ktx2(void)
{
    static const texture textures[] = {
        {23, 0, 3, 6}, {29, 0, 3, 6},   {36, 0, 3, 1},   {37, 0, 4, 6},  {43, 0, 4, 1},
        {44, 0, 4, 6}, {50, 0, 4, 6},   {84, 0, 6, 6},   {91, 0, 8, 6},  {90, 0, 6, 6},
        {97, 0, 8, 1}, {106, 0, 12, 6}, {109, 0, 16, 6}, {122, 0, 4, 6}, {123, 0, 4, 6},
        {83, 0, 4, 1}, {103, 0, 8, 1},  {76, 0, 2, 1}};
    for (int i = 0; i < (int)(sizeof textures / sizeof *textures); i++) {
        const texture *t = &textures[i];
        enum { HEADER = 80, ENTRY = 24, DESCRIPTOR = 28 };
        uint32_t size = (uint32_t)(t->texel_bytes * SIDE * SIDE * t->faces);
        uint32_t packed = 3 + 4 + size + 4, scheme = i % 3 == 2 ? 3 : 0;
        ki_writer w = seed_writer();
        ki_write(&w, "\xabKTX 20\xbb\r\n\x1a\n", 12);
        put_words(&w,
                  (const uint32_t[]){t->number, 1, SIDE, SIDE, 0, 0, (uint32_t)t->faces, 1, scheme},
                  9);
        put_words(&w, (const uint32_t[]){HEADER + ENTRY, DESCRIPTOR, 0, 0, 0, 0, 0, 0}, 8);
        put_words(
            &w,
            (const uint32_t[]){HEADER + ENTRY + DESCRIPTOR, 0, scheme ? packed : size, 0, size, 0},
            6);
        put_words(&w, (const uint32_t[]){28, 0, 2 | 24 << 16, 1 | 1 << 8 | 1 << 16, 0, 0, 0}, 7);
        if (scheme) { // zlib data of one stored block
            ki_write(&w, "\x78\x01\x01", 3);
            ki_write_u16(&w, (uint16_t)size);
            ki_write_u16(&w, (uint16_t)~size);
        }
        size_t from = w.size;
        put_texels(&w, (int)size);
        if (scheme)
            ki_write_u32(&w, __builtin_bswap32(ki_adler32(1, w.bytes + from, size)));
        seed_save("ktx2", i, &w);
    }
}

static void write_dds(void)
{
    static const texture textures[] = {{0, 0, 3, 6},  {0, 0, 4, 6},  {28, 0, 4, 6}, {29, 0, 4, 1},
                                       {91, 0, 4, 6}, {93, 0, 4, 1}, {11, 0, 8, 6}, {10, 0, 8, 6},
                                       {6, 0, 12, 6}, {2, 0, 16, 1}, {67, 0, 4, 6}, {26, 0, 4, 6}};
    for (int i = 0; i < (int)(sizeof textures / sizeof *textures); i++) {
        const texture *t = &textures[i];
        bool ten = t->number != 0, cube = t->faces == 6;
        const uint32_t header[31] = {[0] = 124,
                                     [1] = 0x1007,
                                     [2] = SIDE,
                                     [3] = SIDE,
                                     [6] = 1,
                                     [18] = 32,
                                     [19] = ten ? 4 : 0x40,
                                     [20] = ten ? 0x30315844 : 0,
                                     [21] = (uint32_t)(8 * t->texel_bytes),
                                     [22] = 0xff0000,
                                     [23] = 0xff00,
                                     [24] = 0xff,
                                     [26] = 0x1000,
                                     [27] = cube ? 0xfe00 : 0};
        ki_writer w = seed_writer();
        ki_write(&w, "DDS ", 4);
        put_words(&w, header, 31);
        if (ten)
            put_words(&w, (const uint32_t[]){t->number, 3, cube ? 4 : 0, 1, 0}, 5);
        put_texels(&w, t->texel_bytes * SIDE * SIDE * t->faces);
        seed_save("dds", i, &w);
    }
}

static void write_ktx1(void)
{
    static const texture textures[] = {{0x8c41, 0x1401, 3, 6},  {0x8051, 0x1401, 3, 1},
                                       {0x8c43, 0x1401, 4, 6},  {0x805b, 0x1403, 8, 6},
                                       {0x881b, 0x140b, 6, 6},  {0x881a, 0x140b, 8, 6},
                                       {0x8815, 0x1406, 12, 1}, {0x8814, 0x1406, 16, 6}};
    static const char pairs[] = "\x17\0\0\0KTXorientation\0S=r,T=u\0\0";
    for (int i = 0; i < (int)(sizeof textures / sizeof *textures); i++) {
        const texture *t = &textures[i];
        uint32_t format = t->number == 0x8c43 || t->texel_bytes % 3 ? 0x1908 : 0x1907;
        int row = (t->texel_bytes * SIDE + 3) / 4 * 4;
        ki_writer w = seed_writer();
        ki_write(&w, "\xabKTX 11\xbb\r\n\x1a\n", 12);
        put_words(&w,
                  (const uint32_t[]){0x04030201, t->type, 1, format, t->number, format, SIDE, SIDE,
                                     0, 0, (uint32_t)t->faces, 1, sizeof pairs - 1},
                  13);
        ki_write(&w, pairs, sizeof pairs - 1);
        ki_write_u32(&w, (uint32_t)(row * SIDE));
        put_texels(&w, row * SIDE * t->faces);
        seed_save("ktx1", i, &w);
    }
}

static void write_engines(void)
{
    const kiln_sh sh = {.bands = 3, .c = {{1, 2, 3}, {0.5, 0, -0.5}}};
    const kiln_lights lights = {.count = 1, .light = {{{0, 1, 0}, {1, 2, 3}, 0.25, 0.5, 4}}};
    kiln_map map = seed_cube(2, 0);
    for (int i = 0; i < 2; i++) {
        ki_writer w = seed_writer();
        if (ki_ktx1_encode(&map, &sh, "filament", i ? KILN_FORMAT_B10G11R11 : KILN_FORMAT_RGBA16F,
                           &w, NULL) == KILN_OK)
            seed_save("ktx1", 100 + i, &w);
        w = seed_writer();
        if (ki_gltf_encode(&map, &sh, i ? &lights : NULL, &w, NULL) == KILN_OK)
            seed_save("glb", i, &w);
    }
    ki_writer w = seed_writer();
    if (ki_env_encode(&map, 0.8, &sh, &w, NULL) == KILN_OK)
        seed_save("env", 0, &w);
    w = seed_writer();
    ki_write_u8(&w, 1); // faces of 2 texels along an edge
    if (ki_galacean_env_encode(&map, &sh, &w, NULL) == KILN_OK)
        seed_save("galacean", 0, &w);
    kiln_map_free(&map);
}

void seed_textures(void)
{
    write_ktx2();
    write_dds();
    write_ktx1();
    write_engines();
}
