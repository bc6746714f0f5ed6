// An environment for checks of files: smooth and sharp lights of random colours at random places,
// so that no turn and no mirror image is like the environment itself, and a sun of one texel.
#ifndef KILN_CHECK_BLOBS_H
#define KILN_CHECK_BLOBS_H

#include "kit/context.h"

enum { SCENE_LIGHTS = 24, SCENE_ROWS = 64 };

static inline kiln_map blobs(bool sun)
{
    kiln_map map = make_panorama(context, SCENE_ROWS);
    uint32_t seed = 7;
    double at[SCENE_LIGHTS][3], colour[SCENE_LIGHTS][3], narrow[SCENE_LIGHTS];
    for (int j = 0; j < SCENE_LIGHTS; j++) {
        double z = 2 * scene_random(&seed) - 1, turn = 2 * pi * scene_random(&seed),
               r = sqrt(1 - z * z);
        at[j][0] = r * cos(turn);
        at[j][1] = z;
        at[j][2] = r * sin(turn);
        narrow[j] = 4 * pow(100, scene_random(&seed));
        for (int c = 0; c < 3; c++)
            colour[j][c] = 0.5 + 2 * scene_random(&seed);
    }
    for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
        double d[3], rgb[3] = {0.2, 0.25, 0.3};
        kiln_map_direction(&map, 0, i, d);
        for (int j = 0; j < SCENE_LIGHTS; j++) {
            double near =
                exp(narrow[j] * (d[0] * at[j][0] + d[1] * at[j][1] + d[2] * at[j][2] - 1));
            for (int c = 0; c < 3; c++)
                rgb[c] += near * colour[j][c];
        }
        for (size_t c = 0; c < 3; c++)
            map.level[0][3 * i + c] = (float)rgb[c];
    }
    for (size_t c = 0; c < 3 && sun; c++)
        texel_at(&map, 20, 18)[c] = 3000;
    return map;
}

#endif
