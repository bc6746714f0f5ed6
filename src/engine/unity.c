// Unity: a cube as .dds whose level 6 has roughness 1, whatever the size of the cube. Unity's
// shaders read level 6 r (1.7 - 0.7 r) at roughness r (PerceptualRoughnessToMipmapLevel). Levels
// after the sixth are never read. The file has these levels too, because loaders expect a DDS cube
// to have all its levels.
//
// Unity's world is left-handed. Its panoramas (Skybox/Panoramic) have +X in the centre and -Z to
// the right of the centre.
#include "engine/engine.h"

#include "image/pack.h"

#include <math.h>

enum { STEPS = 6 };

static double roughness(int level, int level_count, int size)
{
    (void)level_count;
    (void)size;
    return level < STEPS ? (1.7 - sqrt(2.89 - 2.8 * level / STEPS)) / 1.4 : 1;
}

static double level(double roughness, int level_count, int size)
{
    (void)level_count;
    (void)size;
    return STEPS * roughness * (1.7 - 0.7 * roughness);
}

const ki_recipe ki_unity = {
    .about = {.name = "unity",
              .title = "Unity",
              .files = "NAME.dds",
              .ending = "dds",
              .mapping = "k = 6 r (1.7 - 0.7 r), and r = 1 from k = 6 on",
              .size = 512,
              .level_count = 10,
              .limit = KI_HALF_MAX,
              .formats = {KILN_FORMAT_RGBA16F, KILN_FORMAT_BC6H},
              .format_reason = "rgba16f: in bc6h the file is an eighth as large and the picture "
                               "errs up to 1.13 times "
                               "as much, and most phones cannot show bc6h",
              .proof = "source of Unity's shaders, Graphics 0c658a0"},
    .axes = {{2, 1, 0}, {-1, 1, -1}},
    .size_min = 64,
    .size_max = 4096,
    .last_size = 1,
    .roughness = roughness,
    .level = level,
    .write = ki_export_dds,
};
