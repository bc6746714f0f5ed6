// Saving of maps, pictures and harmonics by path. In: a map and a path, whose ending decides the
// format. Out: a set of files that appear together, or the same files in memory. Checks what each
// format can hold, makes the names of the faces and levels, and calls the encoders of the table of
// formats.
#include "codec/save.h"
#include "base/file.h"
#include "codec/formats.h"
#include "codec/pixel_format.h"
#include "codec/sh_text.h"
#include "image/light.h"

#include <stdio.h>
#include <string.h>

// ------------------------------------------------------------------------------------------ checks

static const char *const shape_names[] = {[KILN_SHAPE_PANORAMA] = "a panorama",
                                          [KILN_SHAPE_CUBE] = "a cube",
                                          [KILN_SHAPE_OCTAHEDRON] = "an octahedron"};

static kiln_result check_def(kiln_shape shape, const kiln_save_def *def, kiln_error *error)
{
    if ((int)shape < KILN_SHAPE_PANORAMA || shape > KILN_SHAPE_OCTAHEDRON)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "shape is %d, it must be %d to %d", (int)shape,
                       KILN_SHAPE_PANORAMA, KILN_SHAPE_OCTAHEDRON);
    if (!ki_pixel_format_of(def->format))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "format is %d, it must be 0 to %d",
                       (int)def->format, (int)KILN_FORMAT_UASTC);
    return ki_sh_check(def->sh, error);
}

// Returns the file format that a path's ending selects. A path that ends in a slash is a folder of
// EXR files.
static const ki_file_format *format_of(const char *path)
{
    return ki_file_format_of_path(ki_ends_with(path, "/") ? "a.exr" : path);
}

static bool has_face(const char *path)
{
    return strstr(path, "{face}") || strstr(path, "%s");
}

static kiln_result check_format(const char *path, const ki_file_format *file, kiln_format format,
                                kiln_error *error)
{
    char list[KI_ENDINGS_TEXT];
    if (format == KILN_FORMAT_AUTO || file->pixel_formats & 1U << format)
        return KILN_OK;
    if (!file->pixel_formats)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: %s files have one format only, leave the format %s out", path,
                       file->endings[0], ki_format_names[format]);
    return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: the format %s can be written to %s only", path,
                   ki_format_names[format], ki_list_endings_of_format(format, list));
}

kiln_result kiln_map_save_check(const char *path, kiln_shape shape, const kiln_save_def *def,
                                kiln_error *error)
{
    const ki_file_format *file = format_of(path);
    char list[KI_ENDINGS_TEXT];
    def = def ? def : &(kiln_save_def){0};
    kiln_result result = check_def(shape, def, error);
    if (result != KILN_OK)
        return result;
    if (!ki_file_holds(file, KI_HOLDS_PICTURE | KI_HOLDS_CUBE))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: must end in %s", path,
                       ki_list_endings(KI_HOLDS_PICTURE | KI_HOLDS_CUBE, "/", list));
    if (shape != KILN_SHAPE_CUBE && !ki_file_holds(file, KI_HOLDS_PICTURE))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: %s files hold cubes only, save %s to %s",
                       path, file->endings[0], shape_names[shape],
                       ki_list_endings(KI_HOLDS_PICTURE, NULL, list));
    if (shape != KILN_SHAPE_CUBE && has_face(path))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: the path names a face, but %s has no faces",
                       path, shape_names[shape]);
    result = check_format(path, file, def->format, error);
    return result == KILN_OK ? ki_check_zstd(path, file, def->zstd, error) : result;
}

double kiln_map_save_limit(const char *path, kiln_format format)
{
    const ki_file_format *file = format_of(path);
    return format != KILN_FORMAT_AUTO ? kiln_format_limit(format) : file ? file->limit : 0;
}

// ------------------------------------------------------------------------------------------- names

// Writes a template for the paths of all files of a map: the caller's path with {face} and {level}
// in place of `%s` and `%d`. If the map has faces or levels and the path has no place for them, a
// place is added before the ending.
static kiln_result make_template(const char *path, const kiln_map *map, ki_writer *w,
                                 kiln_error *error)
{
    bool cube = map->shape == KILN_SHAPE_CUBE;
    bool level = strstr(path, "{level}") || strstr(path, "%d");
    size_t length = strlen(path);
    if (ki_ends_with(path, "/")) {
        static const char *const names[] = {[KILN_SHAPE_PANORAMA] = "panorama",
                                            [KILN_SHAPE_CUBE] = "{face}",
                                            [KILN_SHAPE_OCTAHEDRON] = "octahedron"};
        ki_write(w, path, length);
        ki_write_text(w, "%s%s.exr", names[map->shape],
                      map->level_count > 1 && !level ? "_{level}" : "");
    } else {
        size_t stem = length - strlen(kiln_path_ending(path));
        ki_write(w, path, stem);
        ki_write_text(w, "%s%s", cube && !has_face(path) ? "_{face}" : "",
                      map->level_count > 1 && !level ? "_{level}" : "");
        ki_write(w, path + stem, length - stem);
    }
    ki_write_u8(w, 0);
    return w->failed ? ki_fail_memory(w->context, error, path, length + 32) : KILN_OK;
}

// Writes the path of the file of one face and level, made from the template, to `w`.
static bool expand(const char *template, int face, int level, ki_writer *w)
{
    w->size = 0;
    for (const char *at = template; *at;) {
        if (face >= 0 && (!strncmp(at, "{face}", 6) || !strncmp(at, "%s", 2))) {
            ki_write_text(w, "%s", ki_face_names[face]);
            at += *at == '{' ? 6 : 2;
        } else if (!strncmp(at, "{level}", 7) || !strncmp(at, "%d", 2)) {
            ki_write_text(w, "%d", level);
            at += *at == '{' ? 7 : 2;
        } else {
            ki_write_u8(w, (uint8_t)*at++);
        }
    }
    ki_write_u8(w, 0);
    return !w->failed;
}

// ------------------------------------------------------------------------------------------- files

// Adds the file of one face of one level to the set. `bytes`, memory for the content of the file,
// is overwritten.
static kiln_result add_picture(ki_file_set *set, const ki_file_format *file, const kiln_map *map,
                               int level, int face, kiln_format format, const char *path,
                               ki_writer *bytes, kiln_error *error)
{
    int faces = map->shape == KILN_SHAPE_CUBE ? 6 : 1;
    kiln_image image = {.channels = 3};
    ki_level_extent(map, level, &image.width, &image.height);
    image.height /= faces;
    image.pixels =
        map->level[level] + 3 * (size_t)image.width * (size_t)image.height * (size_t)face;
    const ki_picture_about about = {.radiance = true,
                                    .format = format,
                                    .panorama = map->shape == KILN_SHAPE_PANORAMA,
                                    .octahedron = map->shape == KILN_SHAPE_OCTAHEDRON,
                                    .roughness = map->roughness[level]};
    bytes->size = 0;
    kiln_result result = file->write_picture(&image, &about, bytes, error);
    return result == KILN_OK ? ki_file_set_add(set, path, bytes->bytes, bytes->size, error)
                             : result;
}

// Adds the files of all faces and levels to the set, with names from `template`.
static kiln_result add_pictures(ki_file_set *set, kiln_context *context, const kiln_map *map,
                                const char *template, const kiln_save_def *def, int *file_count,
                                kiln_error *error)
{
    ki_writer path = {.context = context};
    ki_writer bytes = {.context = context};
    kiln_result result = KILN_OK;
    bool cube = map->shape == KILN_SHAPE_CUBE;
    int faces = cube ? 6 : 1, count = 0;
    for (int i = 0; i < faces * map->level_count && result == KILN_OK; i++) {
        int level = i / faces, face = i % faces;
        if (!ki_progress(context, "writing", (double)i / (faces * map->level_count))) {
            result = ki_fail_cancelled(error, "writing");
            break;
        }
        if (!expand(template, cube ? face : -1, level, &path)) {
            result = ki_fail_memory(context, error, template, strlen(template) + 32);
            break;
        }
        result = add_picture(set, format_of(template), map, level, face, def->format,
                             (const char *)path.bytes, &bytes, error);
        count++;
    }
    *file_count = count;
    ki_writer_free(&path);
    ki_writer_free(&bytes);
    return result;
}

static kiln_result write_pictures(ki_file_set *set, kiln_context *context, const kiln_map *map,
                                  const char *path, const kiln_save_def *def, int *file_count,
                                  kiln_error *error)
{
    ki_writer template = {.context = context};
    kiln_result result = make_template(path, map, &template, error);
    if (result == KILN_OK && ki_ends_with(path, "/"))
        result = ki_file_set_make_folder(set, path, error);
    if (result == KILN_OK && template.bytes)
        result =
            add_pictures(set, context, map, (const char *)template.bytes, def, file_count, error);
    ki_writer_free(&template);
    return result;
}

static kiln_result write_cube(ki_file_set *set, kiln_context *context, const kiln_map *map,
                              const char *path, const kiln_save_def *def, int *file_count,
                              kiln_error *error)
{
    ki_writer bytes = {.context = context};
    if (!ki_progress(context, "writing", 0))
        return ki_fail_cancelled(error, "writing");
    kiln_result result = format_of(path)->write_cube(map, def, &bytes, error);
    if (result == KILN_OK)
        result = ki_file_set_add(set, path, bytes.bytes, bytes.size, error);
    *file_count = 1;
    ki_writer_free(&bytes);
    return result;
}

// Returns the largest of `count` values that is above 0, or 0.
static float find_largest(const float *value, size_t count)
{
    enum { LANES = 8 };
    float lanes[LANES] = {0}, most = 0;
    size_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (size_t k = 0; k < LANES; k++)
            lanes[k] = value[i + k] > lanes[k] ? value[i + k] : lanes[k];
    for (; i < count; i++)
        most = value[i] > most ? value[i] : most;
    for (int k = 0; k < LANES; k++)
        most = lanes[k] > most ? lanes[k] : most;
    return most;
}

void ki_count_cut(const kiln_map *map, double limit, kiln_save_report *report)
{
    float most = 0;
    size_t values = 0, cut = 0;
    for (int k = 0; k < map->level_count; k++) {
        size_t count = 3 * kiln_map_texels(map, k);
        const float *value = map->level[k];
        float largest = find_largest(value, count);
        for (size_t i = 0; i < count && limit > 0 && (double)largest > limit; i++)
            cut += (double)value[i] > limit;
        most = largest > most ? largest : most;
        values += count;
    }
    report->limit = limit;
    report->value_count = values;
    report->cut_count = cut;
    report->share = values ? (double)cut / (double)values : 0;
    report->light_share = 0;
    if (cut) {
        ki_light light = ki_map_light(map, limit);
        report->light_share = light.above_limit / light.above_zero;
    }
    report->largest = (double)most;
}

kiln_result ki_map_write(ki_file_set *set, kiln_context *context, const kiln_map *map,
                         const char *path, const kiln_save_def *def, kiln_save_report *report,
                         kiln_error *error)
{
    static const kiln_save_def defaults = {0};
    kiln_save_report unused = {0};
    def = def ? def : &defaults;
    kiln_result result = ki_map_check(map, error);
    if (result == KILN_OK)
        result = kiln_map_save_check(path, map->shape, def, error);
    if (result != KILN_OK)
        return result;
    if (report)
        ki_count_cut(map, kiln_map_save_limit(path, def->format), report);
    report = report ? report : &unused;
    return ki_file_holds(format_of(path), KI_HOLDS_CUBE)
               ? write_cube(set, context, map, path, def, &report->file_count, error)
               : write_pictures(set, context, map, path, def, &report->file_count, error);
}

kiln_result ki_save_files(kiln_context *context, ki_add_files *add, void *data, kiln_files *files,
                          kiln_save_report *report, kiln_error *error)
{
    if (report)
        *report = (kiln_save_report){0};
    kiln_result result = ki_file_set_make(context, add, data, files, error);
    if (report && result != KILN_OK)
        *report = (kiln_save_report){0};
    return result;
}

typedef struct map_files {
    kiln_context *context;
    const kiln_map *map;
    const char *path;
    const kiln_save_def *def;
    kiln_save_report *report;
} map_files;

static kiln_result add_map(ki_file_set *set, void *data, kiln_error *error)
{
    const map_files *m = data;
    return ki_map_write(set, m->context, m->map, m->path, m->def, m->report, error);
}

kiln_result kiln_map_save(kiln_context *context, const kiln_map *map, const char *path,
                          const kiln_save_def *def, kiln_save_report *report, kiln_error *error)
{
    map_files m = {context, map, path, def, report};
    return ki_save_files(context, add_map, &m, NULL, report, error);
}

kiln_result kiln_map_encode(kiln_context *context, const kiln_map *map, const char *name,
                            const kiln_save_def *def, kiln_files *files, kiln_save_report *report,
                            kiln_error *error)
{
    map_files m = {context, map, name, def, report};
    return ki_save_files(context, add_map, &m, files, report, error);
}

kiln_result kiln_image_save(kiln_context *context, const kiln_image *image, const char *path,
                            kiln_error *error)
{
    const ki_file_format *file = ki_file_format_of_path(path);
    char list[KI_ENDINGS_TEXT];
    if (!ki_file_holds(file, KI_HOLDS_PICTURE))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: must end in %s", path,
                       ki_list_endings(KI_HOLDS_PICTURE, NULL, list));
    if (!image->pixels || image->width < 1 || image->height < 1 || image->channels < 1 ||
        image->channels > 4)
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "the image is %d x %d with %d channels%s, it must have pixels and 1 to 4 channels",
            image->width, image->height, image->channels, image->pixels ? "" : " and no pixels");
    if (!strcmp(file->name, "hdr") && image->channels != 3)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: an HDR file has three channels, but the image has %d", path,
                       image->channels);
    ki_writer bytes = {.context = context};
    const ki_picture_about about = {.roughness = -1};
    kiln_result result = file->write_picture(image, &about, &bytes, error);
    if (result == KILN_OK)
        result = ki_file_write(context, path, bytes.bytes, bytes.size, error);
    ki_writer_free(&bytes);
    return result;
}
