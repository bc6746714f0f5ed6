// How kiln writes environments for rendering engines. Each engine has one source file with its
// ki_recipe: the settings of the engine, and the function that writes the engine's files. engine.c
// lists the engines.
#ifndef KI_ENGINE_H
#define KI_ENGINE_H

#include "base/bytes.h"
#include "base/file.h"
#include "image/image.h"

/// The axes of an engine as a signed permutation of kiln's. Where the engine samples a cube in its
/// direction e, it shall show the light that arrives from kiln's direction d, with d[i] = sign[i]
/// e[axis[i]]. The engine then shows a panorama where its own loader would show it.
typedef struct ki_axes {
    int axis[3], sign[3];
} ki_axes;

/// The arguments of the function that writes an engine's files. The cube and the harmonics (three
/// bands of radiance) are already turned to the engine's axes.
typedef struct ki_export {
    kiln_context *context;
    const kiln_map *map;
    const kiln_sh *sh;
    /// Lights that were taken out of the environment, in kiln's directions; NULL for none.
    const kiln_lights *lights;
    // The texel format of the files, one of those that the engine reads; KILN_FORMAT_AUTO if there
    // is no choice.
    kiln_format format;
    const char *path;
    ki_file_set *set;
    int file_count;
} ki_export;

/// The settings of an engine, and the function that writes the engine's files.
typedef struct ki_recipe {
    kiln_engine about;
    ki_axes axes;
    int size_min, size_max;
    int last_size;       ///< by default the levels' sizes are halved down to this size
    int smallest;        ///< smallest size of a level in texels, 0 for no bound
    int extra_levels;    ///< number of further levels, all of the size last_size
    int level_count_max; ///< greatest default number of levels; 0 for no limit
    /// Smallest number of levels that a caller may choose; 0 if the number is fixed.
    int level_count_min;
    double (*roughness)(int level, int level_count, int size);
    /// The inverse function of `roughness`, as the engine's shader computes it: returns the level,
    /// with its fraction, that the shader reads for a roughness. NULL if the engine reads no
    /// levels.
    double (*level)(double roughness, int level_count, int size);
    bool keeps_last; ///< true: the engine uses the last level as its diffuse light
    /// Ending of the path for files of UASTC HDR; NULL for about.ending.
    const char *uastc_ending;
    /// True: the engine reads no cube, but flat pictures into which `write` draws the levels.
    bool flat;
    kiln_result (*write)(ki_export *to, kiln_error *error);
    /// The inverse of `write` for engines that read flat pictures: fills a cube in the engine's
    /// directions with what the engine's shader reads from the picture `atlas`, RGB radiance. Sets
    /// *map, whose levels the caller frees. NULL for engines without such a function.
    kiln_result (*read)(kiln_context *context, const kiln_image *atlas, kiln_map *map,
                        kiln_error *error);
    /// Computes radiance from the four samples of a pixel of the engine's PNG file; NULL for
    /// engines whose pictures hold radiance.
    void (*unpack)(const float rgbx[4], float rgb[3]);
} ki_recipe;

/// Reads an atlas bilinearly at (x, y) texels from its upper left corner, clamped to its edges.
/// `roots`: the shader interpolates square roots of radiance.
void ki_atlas_read(const kiln_image *atlas, double x, double y, bool roots, float rgb[3]);
/// A function that reads level `level` of an atlas in a direction of the engine.
typedef void ki_atlas_look(const kiln_image *atlas, int level, const double direction[3],
                           float rgb[3]);
/// Fills the levels of a cube with what `look` reads from an atlas. Shape, size, level_count and
/// smallest of *map are set; its levels are allocated and have the recipe's roughness.
kiln_result ki_atlas_fill(kiln_context *context, const ki_recipe *recipe, const kiln_image *atlas,
                          ki_atlas_look *look, kiln_map *map, kiln_error *error);

/// Levels at equal steps of roughness: level k of n has roughness k / (n - 1).
double ki_even_roughness(int level, int level_count, int size);
double ki_even_level(double roughness, int level_count, int size);
/// The levels of three.js and Filament: level k of n has the roughness r with r (2 - r) = k / (n -
/// 1). Both engines clamp the roughness of materials to at least 0.045.
double ki_quadratic_roughness(int level, int level_count, int size);
double ki_quadratic_level(double roughness, int level_count, int size);

extern const ki_recipe ki_three, ki_babylon, ki_babylon_dds, ki_filament, ki_playcanvas,
    ki_playcanvas_dds, ki_three_cubeuv, ki_cesium, ki_galacean, ki_gltf, ki_bevy, ki_unity,
    ki_godot, ki_model_viewer, ki_unreal;

/// Returns the settings of the engine at an index of the list, NULL after the last engine.
const ki_recipe *ki_recipe_at(int index);
const ki_recipe *ki_recipe_of(const kiln_engine *engine);
/// Returns the default number of levels of a cube whose level 0 has `size` texels along an edge.
/// The size is halved from level to level down to `last_size`, and `extra_levels` more levels
/// repeat that size.
int ki_recipe_levels(const ki_recipe *recipe, int size);

/// Copies the texels of a cube from kiln's directions to the engine's. `turned` has the shape and
/// sizes of `source`.
void ki_turn_cube(const kiln_map *source, const ki_axes *axes, kiln_map *turned);
/// Turns harmonics of at most three bands from kiln's directions to the engine's.
void ki_turn_sh(const kiln_sh *source, const ki_axes *axes, kiln_sh *turned);

/// Adds a file with the content `bytes` to the files that an export writes.
kiln_result ki_export_add(ki_export *to, const char *path, const ki_writer *bytes,
                          kiln_error *error);

/// Returns the zstd compression level for an export's file, whose loader reads zstd: 0 for none
/// where the texels are no blocks or where this build of kiln has no zstd.
int ki_export_zstd(const ki_export *to);

/// Writes the cube of an export as a single .dds file in the texel format of the export.
kiln_result ki_export_dds(ki_export *to, kiln_error *error);

/// Adds the files that kiln_engine_save writes to a set, and the lights, which may be NULL, to
/// files of formats that hold lights. `report` may be NULL.
kiln_result ki_engine_write(ki_file_set *set, kiln_context *context, const kiln_engine *engine,
                            const kiln_map *map, const kiln_sh *sh, const kiln_lights *lights,
                            kiln_format format, const char *path, kiln_save_report *report,
                            kiln_error *error);

#endif
