// Loading of maps and pictures. In: a path to a file, a folder, or a pattern for six face files; six
// paths; or bytes in memory. Out: a map on the sphere, or a flat picture, and a report. The content
// of a file decides its format, and the ratio of its sides its layout unless the caller names a
// layout.
#include "base/file.h"
#include "base/os.h"
#include "codec/engine_text.h"
#include "codec/formats.h"
#include "codec/layout.h"
#include "codec/report.h"
#include "image/mend.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// -------------------------------------------------------------------------------------- one file

static kiln_result check_def(const kiln_load_def *def, kiln_error *error)
{
    if ((int)def->layout < 0 || def->layout > KILN_LAYOUT_OCTAHEDRON)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "layout is %d, it must be 0 to %d",
                       (int)def->layout, (int)KILN_LAYOUT_OCTAHEDRON);
    if ((unsigned)def->negative > KILN_NEGATIVE_ZERO)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "negative is %d, it must be 0 or %d",
                       (int)def->negative, (int)KILN_NEGATIVE_ZERO);
    return KILN_OK;
}

// Replaces a definition that is NULL by the defaults, checks it, and empties the outputs.
static kiln_result begin(const kiln_load_def **def, kiln_map *map, kiln_error *error)
{
    static const kiln_load_def defaults = {0};
    *map = (kiln_map){0};
    *def = *def ? *def : &defaults;
    if ((*def)->report)
        *(*def)->report = (kiln_load_report){0};
    return check_def(*def, error);
}

// Mends a map that was read, if `result` says that it was, and hands out its report. On failure
// frees the map.
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
    kiln_result result = ki_lay_out(context, &decoded->image, name, layout, map, error);
    if (result == KILN_OK && info->roughness[0] >= 0)
        map->roughness[0] = info->roughness[0];
    return result;
}

// Makes a map from a decoded file, mends the map, and frees what was decoded.
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
        result = ki_decode(context, bytes, size, name, &decoded, &info, error);
    if (result == KILN_OK)
        result = take_map(context, &decoded, &info, name, def, map, error);
    return result;
}

// Reads a flat picture with the values of its file.
static kiln_result load_image(kiln_context *context, const char *path, ki_decoded *decoded,
                              kiln_file_info *info, kiln_error *error)
{
    kiln_result result = ki_decode_file(context, path, decoded, info, error);
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
    kiln_result result = load_image(context, path, &decoded, NULL, error);
    if (result != KILN_OK)
        return result;
    if (!decoded.is_table && decoded.image.channels == 3)
        result = ki_image_mend(context, path, &decoded.image, error);
    if (result == KILN_OK)
        *image = decoded.image;
    else
        ki_decoded_free(&decoded);
    return result;
}

kiln_result kiln_file_describe(kiln_context *context, const char *path, kiln_file_info *info,
                               kiln_error *error)
{
    memset(info, 0, sizeof *info);
    return ki_decode_file(context, path, NULL, info, error);
}

// -------------------------------------------------------------------------------------- six files

// The path of a face: the parts before and after the two letters of the face.
typedef struct face_paths {
    char *before, *after;
} face_paths;

static void free_paths(face_paths *paths)
{
    ki_free(paths->before);
    ki_free(paths->after);
}

static char *copy_text(kiln_context *context, const char *text, size_t length)
{
    char *copy = ki_alloc(context, length + 1, 1);
    if (copy)
        memcpy(copy, text, length);
    return copy;
}

static kiln_result split_path(kiln_context *context, const char *path, const char *at,
                              size_t length, face_paths *paths, kiln_error *error)
{
    paths->before = copy_text(context, path, (size_t)(at - path));
    paths->after = copy_text(context, at + length, strlen(at + length));
    return paths->before && paths->after ? KILN_OK
                                         : ki_fail_memory(context, error, path, strlen(path) + 2);
}

// Finds "px" as the name of a face in a file name: px.exr, NAME_px.exr, px_0.exr or NAME_px_0.exr.
// Only level 0 is accepted. Returns NULL if the name has no such part.
static const char *face_in(const char *name)
{
    if (!ki_file_holds(ki_file_format_of_path(name), KI_HOLDS_PICTURE))
        return NULL;
    const char *end = strrchr(name, '.');
    if (end - name > 2 && end[-1] == '0' && end[-2] == '_')
        end -= 2;
    if (end - name < 2)
        return NULL;
    const char *at = end - 2;
    return !strncmp(at, "px", 2) && (at == name || at[-1] == '_') ? at : NULL;
}

// Orders face files: a name that is only the face comes first, then the byte order of the names
// decides.
static bool goes_before(const char *a, const char *b)
{
    size_t before_a = (size_t)(face_in(a) - a), before_b = (size_t)(face_in(b) - b);
    if (!before_a != !before_b)
        return !before_a;
    return strcmp(a, b) < 0;
}

// The two names of a folder that come first in the order of goes_before.
typedef struct face_search {
    char best[256], other[256];
} face_search;

static void consider(void *user, const char *name)
{
    face_search *found = user;
    if (strlen(name) >= sizeof found->best || !face_in(name))
        return;
    if (!found->best[0] || goes_before(name, found->best)) {
        memcpy(found->other, found->best, sizeof found->other);
        snprintf(found->best, sizeof found->best, "%s", name);
    } else if (!found->other[0] || goes_before(name, found->other)) {
        snprintf(found->other, sizeof found->other, "%s", name);
    }
}

static kiln_result search_folder(kiln_context *context, const char *path, face_paths *paths,
                                 kiln_error *error)
{
    face_search found = {"", ""};
    if (!ki_os_list_folder(path, consider, &found))
        return ki_fail(error, KILN_ERROR_IO, "%s: the folder cannot be opened", path);
    const char *best = found.best, *other = found.other;
    if (!best[0])
        return ki_fail(error, KILN_ERROR_IO,
                       "%s: holds no face named px.exr, NAME_px.exr or the like (exr, hdr, png)",
                       path);
    if (other[0] && face_in(best) > best)
        return ki_fail(
            error, KILN_ERROR_IO,
            "%s: holds two sets of faces, as %.64s and %.64s; name one set by a pattern with %%s",
            path, best, other);
    size_t length = strlen(path);
    bool slash = length && ki_os_is_separator(path[length - 1]);
    size_t room = length + strlen(best) + 2;
    char *full = ki_alloc(context, room, 1);
    if (!full)
        return ki_fail_memory(context, error, path, room);
    snprintf(full, room, "%s%s%s", path, slash ? "" : "/", best);
    const char *at = full + room - 1 - strlen(best) - (slash ? 1 : 0) + (face_in(best) - best);
    kiln_result result = split_path(context, full, at, 2, paths, error);
    ki_free(full);
    return result;
}

// Fails where a picture cannot be a face of the map; the first face gives the map its size.
static kiln_result check_face(const char *path, const kiln_image *image, const kiln_map *map,
                              kiln_error *error)
{
    if (image->channels != 3)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: holds a table, not a face", path);
    if (image->width != image->height)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: is %d x %d pixels, a face must be square",
                       path, image->width, image->height);
    if (map->size && image->width != map->size)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: is %d x %d pixels, but the first face is %d x %d", path, image->width,
                       image->height, map->size, map->size);
    return KILN_OK;
}

static kiln_result load_face(kiln_context *context, const char *path, int face, kiln_map *map,
                             kiln_load_report *report, kiln_error *error)
{
    ki_decoded decoded;
    kiln_file_info info;
    kiln_result result = load_image(context, path, &decoded, &info, error);
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
    if (result == KILN_OK)
        ki_cut_face(image, 0, 0, size, false,
                    map->level[0] + 3 * (size_t)size * (size_t)size * (size_t)face);
    ki_report_add(report, &decoded.report);
    ki_decoded_free(&decoded);
    return result;
}

kiln_result kiln_map_load_faces(kiln_context *context, const char *const paths[6],
                                const kiln_load_def *def, kiln_map *map, kiln_error *error)
{
    kiln_load_report report = {0};
    kiln_result result = begin(&def, map, error);
    if (result != KILN_OK)
        return result;
    for (int face = 0; face < 6 && result == KILN_OK; face++)
        result = load_face(context, paths[face], face, map, &report, error);
    return finish(context, paths[0], def, result, &report, map, error);
}

// Loads six files whose paths differ only in the name of the face.
static kiln_result load_pattern(kiln_context *context, const face_paths *parts,
                                const kiln_load_def *def, kiln_map *map, kiln_error *error)
{
    const char *paths[6];
    size_t room = strlen(parts->before) + strlen(parts->after) + 3;
    char *text = ki_alloc(context, 6, room);
    if (!text)
        return ki_fail_memory(context, error, "six paths", 6 * room);
    for (size_t face = 0; face < 6; face++) {
        paths[face] = text + room * face;
        snprintf(text + room * face, room, "%s%s%s", parts->before, ki_face_names[face],
                 parts->after);
    }
    kiln_result result = kiln_map_load_faces(context, paths, def, map, error);
    ki_free(text);
    return result;
}

kiln_result kiln_map_load(kiln_context *context, const char *path, const kiln_load_def *def,
                          kiln_map *map, kiln_error *error)
{
    kiln_result result = begin(&def, map, error);
    if (result != KILN_OK)
        return result;

    face_paths paths = {0};
    const char *braces = strstr(path, "{face}"), *percent = strstr(path, "%s");
    bool folder = ki_os_kind_of(path) == KI_OS_FOLDER;
    if (braces || percent || folder) {
        result = folder ? search_folder(context, path, &paths, error)
                        : split_path(context, path, braces ? braces : percent, braces ? 6 : 2,
                                     &paths, error);
        if (result == KILN_OK && paths.before && paths.after)
            result = load_pattern(context, &paths, def, map, error);
        free_paths(&paths);
        return result;
    }
    kiln_file_info info;
    ki_decoded decoded;
    result = ki_decode_file(context, path, &decoded, &info, error);
    if (result == KILN_OK)
        result = take_map(context, &decoded, &info, path, def, map, error);
    return result;
}
