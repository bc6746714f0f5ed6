// Loading of maps and pictures. In: a path to a file, a folder, or a pattern for six face files;
// six paths; or bytes in memory. Out: a map on the sphere, or a flat picture, and a report. The
// content of a file decides its format, and the ratio of its sides its layout unless the caller
// names a layout.
#include "base/file.h"
#include "base/os.h"
#include "codec/engine_text.h"
#include "codec/exr.h"
#include "codec/faces.h"
#include "codec/formats.h"
#include "codec/layout.h"
#include "codec/report.h"
#include "image/mend.h"

#include <stdio.h>
#include <string.h>

// -------------------------------------------------------------------------------------- one file

static kiln_result check_def(const kiln_load_def *def, kiln_error *error)
{
    if ((int)def->layout < 0 || def->layout > KILN_LAYOUT_BALL)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "layout is %d, it must be 0 to %d",
                       (int)def->layout, (int)KILN_LAYOUT_BALL);
    if ((unsigned)def->negative > KILN_NEGATIVE_ZERO)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "negative is %d, it must be 0 or %d",
                       (int)def->negative, (int)KILN_NEGATIVE_ZERO);
    return KILN_OK;
}

// Returns the name of the layer that a load definition chooses, or NULL for none or an empty name.
static const char *layer_of(const kiln_load_def *def)
{
    return def->layer && def->layer[0] ? def->layer : NULL;
}

// Begins a public function that loads a map: replaces a load definition that is NULL by the
// defaults, checks the definition, and empties the outputs.
static kiln_result begin(const kiln_load_def **def, kiln_map *map, kiln_error *error)
{
    static const kiln_load_def defaults = {0};
    *map = (kiln_map){0};
    *def = *def ? *def : &defaults;
    if ((*def)->report)
        *(*def)->report = (kiln_load_report){0};
    return check_def(*def, error);
}

// Ends a public function that loads a map, whose result so far is `result`. If the map was read,
// replaces its values that are no radiance, and copies `report` to def->report unless that is NULL.
// On failure frees the map.
static kiln_result finish(kiln_context *context, const char *name, const kiln_load_def *def,
                          kiln_result result, kiln_load_report *report, kiln_map *map,
                          kiln_error *error)
{
    if (result == KILN_OK)
        result = ki_map_mend(context, name, def->negative, map, report, error);
    if (result != KILN_OK)
        kiln_map_free(map);
    else if (def->report)
        *def->report = *report;
    return result;
}

// Returns whether an EXR file declares an environment map, and notes what becomes of such a map if
// the caller names no layout.
static bool note_envmap(const kiln_file_info *info, kiln_load_report *report)
{
    bool cube = !strcmp(info->layout, "openexr-cube");
    if (!cube && strcmp(info->layout, "openexr-panorama") != 0)
        return false;
    ki_note(report, KILN_NOTE_CONVERSION, false,
            "the file is a %s with OpenEXR's attribute envmap, whose outer texels lie on the "
            "border; texels were interpolated at kiln's places; --layout %s reads them as they are",
            cube ? "cube" : "panorama", cube ? "strip" : "panorama");
    return true;
}

// Makes a map from what was decoded, whose memory the map may take over.
static kiln_result place(kiln_context *context, ki_decoded *decoded, const kiln_file_info *info,
                         const char *name, kiln_layout layout, kiln_map *map, kiln_error *error)
{
    if (decoded->is_map) {
        *map = decoded->map;
        decoded->map = (kiln_map){0};
        return KILN_OK;
    }
    if (decoded->is_table)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: holds a table, not an environment",
                       name);
    if (ki_is_atlas(info))
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is the atlas of %s, which kiln describes but does not read", name,
                       info->engine[0] ? info->engine : "an engine");
    if (layout == KILN_LAYOUT_AUTO && !strcmp(info->layout, "octahedron"))
        layout = KILN_LAYOUT_OCTAHEDRON;
    kiln_result result = KILN_OK;
    if (layout == KILN_LAYOUT_AUTO && note_envmap(info, &decoded->report))
        result = ki_exr_place_envmap(context, &decoded->image,
                                     !strcmp(info->layout, "openexr-cube"), name, error);
    if (result == KILN_OK)
        result = ki_lay_out(context, &decoded->image, name, layout, map, &decoded->report, error);
    if (result == KILN_OK && info->roughness[0] >= 0)
        map->roughness[0] = info->roughness[0];
    return result;
}

// Makes a map from a decoded file, replaces its values that are no radiance, and frees what was
// decoded.
static kiln_result take_map(kiln_context *context, ki_decoded *decoded, const kiln_file_info *info,
                            const char *name, const kiln_load_def *def, kiln_map *map,
                            kiln_error *error)
{
    kiln_result result = place(context, decoded, info, name, def->layout, map, error);
    result = finish(context, name, def, result, &decoded->report, map, error);
    ki_decoded_free(decoded);
    return result;
}

kiln_result kiln_map_decode(kiln_context *context, const void *bytes, size_t size, const char *name,
                            const kiln_load_def *def, kiln_map *map, kiln_error *error)
{
    kiln_file_info info;
    ki_decoded decoded;
    kiln_result result = begin(&def, map, error);
    name = name ? name : "memory";
    if (result == KILN_OK)
        result = ki_decode_layer(context, bytes, size, name, layer_of(def), &decoded, &info, error);
    if (result == KILN_OK)
        result = take_map(context, &decoded, &info, name, def, map, error);
    return result;
}

// Decodes a file to a flat picture, whose values stay as in the file. Fails if the file holds a
// cube. `layer` names a layer of an EXR file and may be NULL.
static kiln_result load_image(kiln_context *context, const char *path, const char *layer,
                              ki_decoded *decoded, kiln_file_info *info, kiln_error *error)
{
    kiln_result result = ki_decode_file(context, path, layer, decoded, info, error);
    if (result == KILN_OK && decoded->is_map) {
        ki_decoded_free(decoded);
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: holds a cube, not a flat picture", path);
    }
    return result;
}

kiln_result kiln_image_load(kiln_context *context, const char *path, kiln_image *image,
                            kiln_error *error)
{
    ki_decoded decoded;
    *image = (kiln_image){0};
    kiln_result result = load_image(context, path, NULL, &decoded, NULL, error);
    if (result != KILN_OK)
        return result;
    if (!decoded.is_table && decoded.image.channels == 3)
        result = ki_image_mend(context, path, &decoded.image, NULL, error);
    if (result == KILN_OK)
        *image = decoded.image;
    else
        ki_decoded_free(&decoded);
    return result;
}

// -------------------------------------------------------------------------------------- six files

// Fails where a picture cannot be a face: all faces are squares of `size` texels, which is 0 for
// the first face.
static kiln_result check_face_size(const char *path, int width, int height, int size,
                                   kiln_error *error)
{
    if (width != height)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: is %d x %d pixels, a face must be square",
                       path, width, height);
    if (size && width != size)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: is %d x %d pixels, but the first face is %d x %d", path, width, height,
                       size, size);
    return KILN_OK;
}

static kiln_result check_face(const char *path, const kiln_image *image, const kiln_map *map,
                              kiln_error *error)
{
    if (image->channels != 3)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: holds a table, not a face", path);
    return check_face_size(path, image->width, image->height, map->size, error);
}

static kiln_result load_face(kiln_context *context, const ki_face_files *files, int face,
                             const char *layer, kiln_map *map, kiln_load_report *report,
                             kiln_error *error)
{
    ki_decoded decoded;
    kiln_file_info info;
    const char *path = files->path[face];
    kiln_result result = load_image(context, path, layer, &decoded, &info, error);
    if (result != KILN_OK)
        return result;
    const kiln_image *image = &decoded.image;
    result = check_face(path, image, map, error);
    int size = image->width;
    if (result == KILN_OK && !map->size) {
        *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = size, .level_count = 1};
        result = ki_map_allocate(context, map, error);
        if (result == KILN_OK && info.roughness[0] >= 0)
            map->roughness[0] = info.roughness[0];
    }
    if (result == KILN_OK &&
        !ki_face_place(context, files->set, image, face,
                       map->level[0] + 3 * (size_t)size * (size_t)size * (size_t)face))
        result = ki_fail_cancelled(error, "reading");
    ki_report_add(report, &decoded.report);
    ki_decoded_free(&decoded);
    return result;
}

static kiln_result load_faces(kiln_context *context, const ki_face_files *files,
                              const kiln_load_def *def, kiln_map *map, kiln_error *error)
{
    kiln_load_report report = {0};
    kiln_result result = KILN_OK;
    ki_faces_note(files->set, &report);
    for (int face = 0; face < 6 && result == KILN_OK; face++)
        result = load_face(context, files, face, layer_of(def), map, &report, error);
    return finish(context, files->path[0], def, result, &report, map, error);
}

kiln_result kiln_map_load_faces(kiln_context *context, const char *const paths[6],
                                const kiln_load_def *def, kiln_map *map, kiln_error *error)
{
    int order[6] = {0, 1, 2, 3, 4, 5};
    ki_face_files files = {.set = ki_faces_order(paths, order)};
    kiln_result result = begin(&def, map, error);
    for (int face = 0; face < 6; face++)
        files.path[face] = paths[order[face]];
    return result == KILN_OK ? load_faces(context, &files, def, map, error) : result;
}

// Finds six files if the path is that of a folder or a pattern. Sets *found to false, and `files`
// to nothing, if the path is that of one file.
static kiln_result find_faces(kiln_context *context, const char *path, ki_face_files *files,
                              bool *found, kiln_error *error)
{
    const char *braces = strstr(path, "{face}"), *percent = strstr(path, "%s");
    bool folder = ki_os_kind_of(path) == KI_OS_FOLDER;
    *files = (ki_face_files){0};
    *found = braces || percent || folder;
    if (folder)
        return ki_faces_in_folder(context, path, files, error);
    return *found ? ki_faces_of_pattern(context, path, braces ? braces : percent, braces ? 6 : 2,
                                        files, error)
                  : KILN_OK;
}

kiln_result kiln_map_load(kiln_context *context, const char *path, const kiln_load_def *def,
                          kiln_map *map, kiln_error *error)
{
    kiln_result result = begin(&def, map, error);
    if (result != KILN_OK)
        return result;

    ki_face_files files;
    bool faces;
    result = find_faces(context, path, &files, &faces, error);
    if (result == KILN_OK && faces)
        result = load_faces(context, &files, def, map, error);
    ki_face_files_free(&files);
    if (result != KILN_OK || faces)
        return result;
    kiln_file_info info;
    ki_decoded decoded;
    result = ki_decode_file(context, path, layer_of(def), &decoded, &info, error);
    if (result == KILN_OK)
        result = take_map(context, &decoded, &info, path, def, map, error);
    return result;
}

// ------------------------------------------------------------------------------------ descriptions

static kiln_result describe_file(kiln_context *context, const char *path, kiln_file_info *info,
                                 kiln_error *error)
{
    memset(info, 0, sizeof *info);
    kiln_result result = ki_decode_file(context, path, NULL, NULL, info, error);
    if (result == KILN_OK)
        note_envmap(info, &info->report);
    return result;
}

// Describes six files of faces as a cube: the first face with the number of bytes of all faces,
// which must be squares of the same size.
static kiln_result describe_faces(kiln_context *context, const ki_face_files *files,
                                  kiln_file_info *info, kiln_error *error)
{
    kiln_file_info other;
    kiln_result result = describe_file(context, files->path[0], info, error);
    if (result == KILN_OK)
        ki_faces_note(files->set, &info->report);
    for (int face = 0; face < 6 && result == KILN_OK; face++) {
        result = describe_file(context, files->path[face], &other, error);
        if (result == KILN_OK)
            result =
                check_face_size(files->path[face], other.width, other.height, info->width, error);
        info->byte_count += result == KILN_OK && face ? other.byte_count : 0;
    }
    if (result != KILN_OK)
        return result;
    info->face_count = 6;
    snprintf(info->layout, sizeof info->layout, "cube");
    return KILN_OK;
}

kiln_result kiln_file_describe(kiln_context *context, const char *path, kiln_file_info *info,
                               kiln_error *error)
{
    ki_face_files files;
    bool faces;
    memset(info, 0, sizeof *info);
    kiln_result result = find_faces(context, path, &files, &faces, error);
    if (result == KILN_OK)
        result = faces ? describe_faces(context, &files, info, error)
                       : describe_file(context, path, info, error);
    ki_face_files_free(&files);
    char *const texts[] = {info->format, info->encoding,    info->layout, info->engine,
                           info->writer, info->orientation, info->table};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        kiln_text_clean(texts[i]);
    for (int i = 0; i < KILN_MAX_LAYERS; i++) {
        kiln_text_clean(info->layer[i].part);
        kiln_text_clean(info->layer[i].name);
        kiln_text_clean(info->layer[i].channels);
    }
    return result;
}
