// Synthetic environments that are identical on every machine. Does not need a test framework.
#ifndef KILN_SCENE_H
#define KILN_SCENE_H

#include <kiln/kiln.h>

static inline double scene_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / 16777216.0;
}

/// Fills a panorama with a sky and a darker ground, multiplied by random factors from 0.5 to 2, and
/// one texel of sun with radiance 5000. All other values are at most 2.4.
static inline void scene_fill(kiln_map *map, uint32_t seed)
{
    int size = map->size;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < 2 * size; x++) {
            float *rgb = map->level[0] + 3 * ((size_t)y * 2 * (size_t)size + (size_t)x);
            double noise = 0.5 + 1.5 * scene_random(&seed);
            double sky = y < size / 2 ? 1 : 0.2;
            rgb[0] = (float)(0.6 * sky * noise);
            rgb[1] = (float)(0.8 * sky * noise);
            rgb[2] = (float)(1.2 * sky * noise);
        }
    size_t sun = (size_t)(size / 3) * 2 * (size_t)size + (size_t)(size / 5);
    for (int c = 0; c < 3; c++)
        map->level[0][3 * sun + (size_t)c] = 5000;
}

/// Fills a panorama of more than 9 rows with whole numbers from 0 to 16, and one texel of sun with
/// radiance 5000, 4300 and 3600.
static inline void scene_checks(kiln_map *map)
{
    int width = 2 * map->size;
    float *rgb = map->level[0];
    for (int y = 0; y < map->size; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                *rgb++ = (float)((7 * (x / 3) + 13 * (y / 2) + 5 * c) % 17);
    for (int c = 0; c < 3; c++)
        map->level[0][(9 * width + 20) * 3 + c] = (float)(5000 - 700 * c);
}

#endif
