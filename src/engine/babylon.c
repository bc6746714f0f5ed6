// Babylon.js: a cube of W texels whose shader reads level log2(W (r^2 + 0.0005)) * scale at
// roughness r, down to the level of a single texel. An .env file states the scale. A .dds file
// cannot, and Babylon.js then takes 0.8. kiln uses 0.8 for both: with a scale of 1, the level for r
// = 0.7 would have 2 x 2 texels and three times the error. Near r = 1 the shader blends to
// irradiance / pi from harmonics, which an .env file stores as a polynomial and which Babylon.js
// computes itself for a .dds file.
//
// Babylon.js has a left-handed world. Its panoramas have +Z in the centre and +X to the right of
// the centre.
#include "engine/engine.h"

#include "codec/env.h"
#include "codec/rgbx.h"
#include "image/pack.h"
#include "math/math.h"

#include <math.h>

static const double lod_scale = 0.8;

static double roughness(int level, int level_count, int size)
{
    (void)level_count;
    return ki_env_roughness(level, lod_scale, size);
}

static double level(double roughness, int level_count, int size)
{
    double slope = roughness * roughness + 0.0005;
    return ki_clamp(ki_log(size * slope) / ki_log(2) * lod_scale, 0, level_count - 1);
}

static kiln_result write_env(ki_export *to, kiln_error *error)
{
    ki_writer bytes = {.context = to->context};
    kiln_result result = ki_env_encode(to->map, lod_scale, to->sh, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    return result;
}

const ki_recipe ki_babylon = {
    .about = {.name = "babylon",
              .title = "Babylon.js 5 to 9, .env",
              .files = "NAME.env",
              .ending = "env",
              .mapping = "r^2 = 2^(k / 0.8) / w - 0.0005, k > 0",
              .tune = true,
              .size = 256,
              .level_count = 9,
              .limit = KI_RGBD_MAX,
              .proof = "pixels of Babylon.js 5.0.0 and 9.34.0"},
    .axes = {{0, 1, 2}, {1, 1, -1}},
    .size_min = 16,
    .size_max = 2048,
    .last_size = 1,
    .roughness = roughness,
    .level = level,
    .write = write_env,
};

const ki_recipe ki_babylon_dds = {
    .about = {.name = "babylon-dds",
              .title = "Babylon.js 5 to 9, .dds",
              .files = "NAME.dds",
              .ending = "dds",
              .mapping = "r^2 = 2^(k / 0.8) / w - 0.0005, k > 0",
              .tune = true,
              .size = 256,
              .level_count = 9,
              .limit = KI_HALF_MAX,
              .proof = "pixels of Babylon.js 5.0.0 and 9.34.0"},
    .axes = {{0, 1, 2}, {1, 1, -1}},
    .size_min = 16,
    .size_max = 2048,
    .last_size = 1,
    .roughness = roughness,
    .level = level,
    .write = ki_export_dds,
};
