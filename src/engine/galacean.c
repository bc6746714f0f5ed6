// Galacean Engine: a cube with all levels down to a single texel, of which level k of n has
// roughness k / (n - 1), and harmonics for diffuse light, in one .env file. Radiance above 5 cannot
// be stored.
//
// Galacean's shaders sample cubes in the direction (-x, y, z), and evaluate harmonics in the same
// direction. Its panoramas (HDRLoader) have -X in the centre and -Z to the right of the centre.
#include "engine/engine.h"

#include "codec/galacean_env.h"

static kiln_result write_env(ki_export *to, kiln_error *error)
{
    ki_writer bytes = {.context = to->context};
    kiln_result result = ki_galacean_env_encode(to->map, to->sh, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    return result;
}

const ki_recipe ki_galacean = {
    .about = {.name = "galacean",
              .title = "Galacean Engine",
              .files = "NAME.env",
              .ending = "env",
              .mapping = "r = k / (n - 1)",
              .tune = true,
              .size = 256,
              .level_count = 9,
              .limit = KI_GALACEAN_MAX,
              .proof = "pixels of Galacean Engine 1.6.13"},
    .axes = {{2, 1, 0}, {-1, 1, -1}},
    .size_min = 16,
    .size_max = 4096,
    .last_size = 1,
    .roughness = ki_even_roughness,
    .level = ki_even_level,
    .write = write_env,
};
