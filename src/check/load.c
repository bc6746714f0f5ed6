// kiln_levels_load and kiln_table_numbers_load. In: a path to a file with levels, a pattern for one
// file or set of faces for each level, or a folder. Out: a map with all levels in the axes of the
// file.
#include "check/check.h"

#include "base/file.h"
#include "base/os.h"
#include "codec/codec.h"
#include "codec/engine_text.h"
#include "codec/env.h"
#include "codec/galacean_env.h"
#include "codec/gltf.h"
#include "codec/rgbx_png.h"
#include "image/image.h"
#include "image/mend.h"
#include "image/pack.h"

#include <stdio.h>
#include <string.h>

// Writes the path of one level: the pattern with the number in place of {level} or %d.
static bool expand(const char *pattern, int level, char path[KI_OS_PATH])
{
    const char *braces = strstr(pattern, "{level}"), *at = braces ? braces : strstr(pattern, "%d");
    if (!at)
        return false;
    int length = ki_print(path, KI_OS_PATH, "%.*s%d%s", (int)(at - pattern), pattern, level,
                          at + (braces ? 7 : 2));
    return length > 0 && length < KI_OS_PATH;
}

// Writes the path of a file of a level: the path itself, or that of the face px.
static void find_file(const char *path, char file[KI_OS_PATH])
{
    const char *braces = strstr(path, "{face}"), *at = braces ? braces : strstr(path, "%s");
    if (at)
        ki_print(file, KI_OS_PATH, "%.*spx%s", (int)(at - path), path, at + (braces ? 6 : 2));
    else
        ki_print(file, KI_OS_PATH, "%s", path);
}

// Returns whether the file of a level, or the first of its six faces, exists.
static bool exists(const char *path)
{
    char file[KI_OS_PATH];
    find_file(path, file);
    return ki_os_kind_of(file) != KI_OS_NOTHING;
}

// Sets the roughness of the levels to what the file states, or to -1.
static kiln_result state_roughness(kiln_context *context, const char *path, float *roughness,
                                   int count, kiln_error *error)
{
    char file[KI_OS_PATH];
    kiln_file_info info = {.roughness = {-1}};
    kiln_result result = KILN_OK;
    find_file(path, file);
    if (ki_os_kind_of(file) == KI_OS_FILE)
        result = kiln_file_describe(context, file, &info, error);
    for (int k = 0; k < count; k++)
        roughness[k] = info.roughness[0] < 0 ? -1 : info.roughness[k];
    return result;
}

// Sets `pattern` to that of the files in a folder, if these have names that cmgen or kiln gives.
static bool find_pattern(const char *folder, char pattern[KI_OS_PATH])
{
    static const char *const names[] = {"m{level}_{face}", "{face}_{level}", "{level}_{face}"};
    static const char *const endings[] = {"exr", "hdr", "png", "rgb32f", "dds"};
    char path[KI_OS_PATH];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (size_t k = 0; k < sizeof endings / sizeof *endings; k++) {
            ki_print(pattern, KI_OS_PATH, "%s/%s.%s", folder, names[i], endings[k]);
            if (expand(pattern, 0, path) && exists(path))
                return true;
        }
    return false;
}

// Copies level 0 of a map that was loaded to level `k` of the map with all levels.
static kiln_result take_level(const char *path, kiln_map *one, int k, int count,
                              kiln_context *context, kiln_map *map, kiln_error *error)
{
    if (k == 0) {
        *map = (kiln_map){.shape = one->shape, .size = one->size, .level_count = count};
        kiln_result result = ki_map_allocate(context, map, error);
        if (result != KILN_OK)
            return result;
    }
    if (one->shape != map->shape || one->size != kiln_map_level_size(map, k))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has texels of %d along a side, level %d of a map of size %d has %d",
                       path, one->size, k, map->size, kiln_map_level_size(map, k));
    memcpy(map->level[k], one->level[0], 3 * sizeof(float) * kiln_map_texels(map, k));
    return state_roughness(context, path, &map->roughness[k], 1, error);
}

static void add_report(kiln_load_report *all, const kiln_load_report *one)
{
    all->texel_count += one->texel_count;
    all->infinite_count += one->infinite_count;
    all->nan_count += one->nan_count;
    all->negative_count += one->negative_count;
    all->missing_count += one->missing_count;
    all->negative_share =
        one->negative_share > all->negative_share ? one->negative_share : all->negative_share;
}

static kiln_result load_pattern(kiln_context *context, const char *pattern,
                                kiln_load_report *report, kiln_map *map, kiln_error *error)
{
    char path[KI_OS_PATH];
    int count = 0;
    while (count < KILN_MAX_LEVELS && expand(pattern, count, path) && exists(path))
        count++;
    if (!count)
        return ki_fail(error, KILN_ERROR_IO, "%s: there is no file of level 0", pattern);
    kiln_result result = KILN_OK;
    for (int k = 0; k < count && result == KILN_OK; k++) {
        kiln_map one = {0};
        kiln_load_report found = {0};
        expand(pattern, k, path);
        result = kiln_map_load(context, path, &(kiln_load_def){.report = &found}, &one, error);
        if (result == KILN_OK)
            result = take_level(path, &one, k, count, context, map, error);
        if (result == KILN_OK && k)
            add_report(report, &found);
        else if (result == KILN_OK)
            *report = found;
        kiln_map_free(&one);
    }
    return result;
}

// Decodes an atlas, a flat picture.
static kiln_result decode_atlas(kiln_context *context, const ki_recipe *recipe,
                                const uint8_t *bytes, size_t size, const char *path,
                                kiln_load_report *report, kiln_map *map, kiln_error *error)
{
    static const uint8_t png[4] = {0x89, 'P', 'N', 'G'};
    ki_decoded decoded = {0};
    kiln_result result;
    if (recipe->unpack && size > sizeof png && !memcmp(bytes, png, sizeof png))
        result = ki_png_decode_as(context, bytes, size, path, recipe->unpack, &decoded.image, NULL,
                                  NULL, error);
    else
        result = ki_decode(context, bytes, size, path, &decoded, NULL, error);
    if (result == KILN_OK && (decoded.is_map || decoded.image.channels != 3))
        result = ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: is no picture, but %s reads pictures",
                         path, recipe->about.title);
    if (result == KILN_OK)
        result = ki_image_mend(context, path, &decoded.image, report, error);
    if (result == KILN_OK)
        result = recipe->read(context, &decoded.image, map, error);
    ki_decoded_free(&decoded);
    return result;
}

// Returns whether a file holds a cube that kiln_map_load does not read.
static bool is_described_cube(const kiln_file_info *info)
{
    return !strcmp(info->format, "env") || !strcmp(info->format, "glb") ||
           !strcmp(info->format, "galacean env");
}

// Decodes the files that hold a cube which kiln_map_load does not read. Sets *done if the bytes are
// such a file.
static kiln_result decode_cube(kiln_context *context, const uint8_t *bytes, size_t size,
                               const char *path, bool *done, kiln_map *map, kiln_error *error)
{
    *done = true;
    if (ki_env_begins(bytes, size))
        return ki_env_decode(context, bytes, size, path, map, error);
    if (size >= 4 && !memcmp(bytes, "glTF", 4))
        return ki_gltf_decode(context, bytes, size, path, map, error);
    if (ki_galacean_env_begins(bytes, size))
        return ki_galacean_env_decode(context, bytes, size, map, error);
    *done = false;
    return KILN_OK;
}

// Loads the files that kiln_map_load does not read: those of Babylon.js, glTF and Galacean, and
// atlases. Sets *done if the file is one of these.
static kiln_result load_special(kiln_context *context, const char *path, const kiln_engine *engine,
                                bool *done, kiln_load_report *report, kiln_map *map,
                                kiln_error *error)
{
    uint8_t *bytes;
    size_t size;
    kiln_file_info info;
    *done = false;
    if (ki_os_kind_of(path) != KI_OS_FILE)
        return KILN_OK;
    kiln_result result = kiln_file_describe(context, path, &info, error);
    if (result != KILN_OK)
        return result;
    engine = engine ? engine : ki_is_atlas(&info) ? kiln_engine_find(info.engine) : NULL;
    const ki_recipe *recipe = engine ? ki_recipe_of(engine) : NULL;
    bool atlas = recipe && recipe->read && info.face_count != 6;
    if (!atlas && !is_described_cube(&info))
        return KILN_OK;
    result = ki_file_read(context, path, &bytes, &size, error);
    if (result != KILN_OK)
        return result;
    *done = atlas;
    result = atlas ? decode_atlas(context, recipe, bytes, size, path, report, map, error)
                   : decode_cube(context, bytes, size, path, done, map, error);
    ki_free(bytes);
    return result;
}

// Loads one file. Levels whose roughness the file does not state have the roughness -1.
static kiln_result load_file(kiln_context *context, const char *path, const kiln_engine *engine,
                             kiln_load_report *report, kiln_map *map, kiln_error *error)
{
    bool done;
    kiln_result special = load_special(context, path, engine, &done, report, map, error);
    if (special != KILN_OK || done)
        return special;
    kiln_result result =
        kiln_map_load(context, path, &(kiln_load_def){.report = report}, map, error);
    return result == KILN_OK
               ? state_roughness(context, path, map->roughness, map->level_count, error)
               : result;
}

kiln_result kiln_levels_load(kiln_context *context, const char *path, const kiln_engine *engine,
                             kiln_load_report *report, kiln_map *map, kiln_error *error)
{
    char pattern[KI_OS_PATH];
    kiln_load_report unused = {0};
    report = report ? report : &unused;
    *map = (kiln_map){0};
    *report = (kiln_load_report){0};
    bool folder = ki_os_kind_of(path) == KI_OS_FOLDER && find_pattern(path, pattern);
    kiln_result result;
    if (folder)
        result = load_pattern(context, pattern, report, map, error);
    else if (strstr(path, "{level}") || strstr(path, "%d"))
        result = load_pattern(context, path, report, map, error);
    else
        result = load_file(context, path, engine, report, map, error);
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}

kiln_result kiln_table_numbers_load(kiln_context *context, const char *path, kiln_image *image,
                                    bool *flip, kiln_error *error)
{
    kiln_file_info info;
    *image = (kiln_image){0};
    *flip = false;
    kiln_result result = kiln_file_describe(context, path, &info, error);
    if (result == KILN_OK)
        result = kiln_image_load(context, path, image, error);
    if (result != KILN_OK)
        return result;
    *flip = strstr(info.table, "flip=1") != NULL;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count && !strcmp(info.format, "png") && strstr(info.encoding, "srgb");
         i++)
        image->pixels[i] = ki_srgb_from_linear(image->pixels[i]);
    return KILN_OK;
}
