// What each engine wants: one recipe a file, one table of them.
#ifndef KI_ENGINE_H
#define KI_ENGINE_H

#include "base/bytes.h"
#include "base/file.h"
#include "image/image.h"

/// A signed permutation of axes. An engine that samples in direction e shall show what arrives from d:
/// d[i] = sign[i] e[axis[i]]. It makes the engine show a panorama where its own loader shows it.
typedef struct ki_axes {
    int axis[3], sign[3];
} ki_axes;

/// What a recipe writes. Map and harmonics (three bands, radiance) are in the engine's directions.
typedef struct ki_export {
    kiln_context *context;
    const kiln_map *map;
    const kiln_sh *sh;
    kiln_format format; // one of the recipe's, AUTO where it has none
    const char *path;
    ki_file_set *set;
    int file_count;
} ki_export;

typedef struct ki_recipe {
    kiln_engine about;
    ki_axes axes;
    int size_min, size_max;
    int last_size;       ///< of the last level, which gives the default number of levels
    int smallest;        ///< size below which no level goes, 0 for none
    int extra_levels;    ///< of the last size, behind the first that has it
    int level_count_max; ///< of the default number; 0 for no limit
    int level_count_min; ///< where the number may be chosen; 0 where it may not
    double (*roughness)(int level, int level_count, int size);
    /// The inverse as its shader has it: the level, a fraction, that it reads for a roughness.
    double (*level)(double roughness, int level_count, int size);
    bool keeps_last; ///< the last level is its diffuse light
    bool flat;       ///< it reads other pictures than cubes, made from this one
    kiln_result (*write)(ki_export *to, kiln_error *error);
} ki_recipe;

/// Levels at even steps of roughness, r = k / (n - 1).
double ki_even_roughness(int level, int level_count, int size);
double ki_even_level(double roughness, int level_count, int size);
/// Levels at k / (n - 1) = r (2 - r), for materials no smoother than 0.045: three.js and Filament.
double ki_quadratic_roughness(int level, int level_count, int size);
double ki_quadratic_level(double roughness, int level_count, int size);

extern const ki_recipe ki_three, ki_babylon, ki_babylon_dds, ki_filament, ki_playcanvas,
    ki_playcanvas_dds, ki_three_cubeuv, ki_gltf, ki_bevy, ki_unity, ki_godot, ki_unreal;

/// The table of all; NULL behind the last.
const ki_recipe *ki_recipe_at(int index);
const ki_recipe *ki_recipe_of(const kiln_engine *engine);
/// Levels of a chain from `size` to the recipe's last size.
int ki_recipe_levels(const ki_recipe *recipe, int size);

/// Moves a cube's texels to the engine's directions. `turned` has the source's shape and sizes.
void ki_turn_cube(const kiln_map *source, const ki_axes *axes, kiln_map *turned);
/// The same for harmonics of at most three bands.
void ki_turn_sh(const kiln_sh *source, const ki_axes *axes, kiln_sh *turned);

/// Adds a file to the set that `to` writes.
kiln_result ki_export_add(ki_export *to, const char *path, const ki_writer *bytes,
                          kiln_error *error);

/// The whole export of an engine that takes one .dds in `to`'s format.
kiln_result ki_export_dds(ki_export *to, kiln_error *error);

/// Adds to a set the files that kiln_engine_save writes. `report` may be NULL.
kiln_result ki_engine_write(ki_file_set *set, kiln_context *context, const kiln_engine *engine,
                            const kiln_map *map, const kiln_sh *sh, kiln_format format,
                            const char *path, kiln_save_report *report, kiln_error *error);

#endif
