// Saving: a map as one file or a set of them, pictures and spherical harmonics.
#include "base/file.h"
#include "base/os.h"
#include "codec/codec.h"
#include "codec/rgbx.h"
#include "codec/texel.h"
#include "image/pack.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

const char *const *kiln_format_names(void)
{
    return ki_format_names;
}

double kiln_format_limit(kiln_format format)
{
    switch (format) {
    case KILN_FORMAT_RGBA32F:
        return 0;
    case KILN_FORMAT_RGB9E5:
        return KI_RGB9E5_MAX;
    case KILN_FORMAT_B10G11R11:
        return KI_B10G11R11_MAX;
    case KILN_FORMAT_RGBM:
        return KI_RGBM_MAX;
    case KILN_FORMAT_RGBD:
        return KI_RGBD_MAX;
    case KILN_FORMAT_RGBP:
        return KI_RGBP_MAX;
    default:
        return KI_HALF_MAX;
    }
}

// ------------------------------------------------------------------------------------------- names

// Text that grows; a failed allocation shows as `failed`.
typedef ki_writer text_writer;

static void add_text(text_writer *w, const char *text, size_t length)
{
    ki_write(w, text, length);
}

// A template of all files' names, with {face} and {level} where they go: what the caller wrote, or
// the places for what is missing.
static kiln_result make_template(const char *path, const kiln_map *map, text_writer *w,
                                 kiln_error *error)
{
    bool cube = map->shape == KILN_SHAPE_CUBE;
    bool face = strstr(path, "{face}") || strstr(path, "%s");
    bool level = strstr(path, "{level}") || strstr(path, "%d");
    if (face && !cube)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: names a face, the map is a %s and has none",
                       path, map->shape == KILN_SHAPE_PANORAMA ? "panorama" : "octahedron");
    size_t length = strlen(path);
    if (ki_ends_with(path, "/")) {
        static const char *const names[] = {"panorama", "{face}", "octahedron"};
        add_text(w, path, length);
        ki_write_text(w, "%s%s.exr", names[map->shape],
                      map->level_count > 1 && !level ? "_{level}" : "");
    } else {
        size_t stem = length - 4; // all endings have four letters
        add_text(w, path, stem);
        ki_write_text(w, "%s%s", cube && !face ? "_{face}" : "",
                      map->level_count > 1 && !level ? "_{level}" : "");
        add_text(w, path + stem, 4);
    }
    ki_write_u8(w, 0);
    return w->failed ? ki_fail_memory(w->context, error, path, length + 32) : KILN_OK;
}

// The path of one file.
static bool expand(const char *template, int face, int level, text_writer *w)
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

// A picture of three channels in four bytes.
static kiln_result encode_rgbx(ki_rgbx *pack, const float *pixels, int width, int height,
                               ki_writer *w, kiln_error *error)
{
    size_t texels = (size_t)width * (size_t)height;
    float *packed = ki_alloc_raw(w->context, texels, 4 * sizeof *packed);
    if (!packed)
        return ki_fail_memory(w->context, error, "a PNG", 16 * texels);
    for (size_t i = 0; i < texels; i++)
        pack(pixels + 3 * i, packed + 4 * i);
    kiln_result result = ki_png_encode(packed, width, height, 4, KI_PNG_PLAIN8, w, error);
    ki_free(packed);
    return result;
}

// One picture by the ending of its path.
static kiln_result encode(const char *path, const float *pixels, int width, int height,
                          int channels, const ki_exr_options *options, ki_png_coding coding,
                          ki_writer *w, kiln_error *error)
{
    if (ki_ends_with(path, ".exr"))
        return ki_exr_encode(pixels, width, height, channels, options, w, error);
    if (ki_ends_with(path, ".hdr"))
        return ki_hdr_encode(pixels, width, height, w, error);
    return ki_png_encode(pixels, width, height, channels, coding, w, error);
}

static kiln_result write_set(kiln_context *context, const kiln_map *map, const char *template,
                             const kiln_save_def *def, int *file_count, kiln_error *error)
{
    text_writer path = {.context = context};
    ki_writer bytes = {.context = context};
    kiln_result result = KILN_OK;
    ki_file_set *set = ki_file_set_begin(context);
    if (!set)
        return ki_fail_memory(context, error, template, 64);
    bool cube = map->shape == KILN_SHAPE_CUBE;
    int faces = cube ? 6 : 1, count = 0;
    for (int i = 0; i < faces * map->level_count && result == KILN_OK; i++) {
        int level = i / faces, face = i % faces, width, height;
        if (!ki_progress(context, "writing", (double)i / (faces * map->level_count))) {
            result = ki_fail_cancelled(error, "writing");
            break;
        }
        ki_level_extent(map, level, &width, &height);
        height /= faces;
        size_t floats = 3 * (size_t)width * (size_t)height;
        ki_exr_options options = {.half = def->format != KILN_FORMAT_RGBA32F,
                                  .panorama = map->shape == KILN_SHAPE_PANORAMA,
                                  .octahedron = map->shape == KILN_SHAPE_OCTAHEDRON,
                                  .roughness = map->roughness[level]};
        bytes.size = 0;
        if (!expand(template, cube ? face : -1, level, &path)) {
            result = ki_fail_memory(context, error, template, strlen(template) + 32);
            break;
        }
        const char *name = (const char *)path.bytes;
        const float *pixels = map->level[level] + floats * (size_t)face;
        ki_rgbx *rgbx = ki_rgbx_of_format(def->format);
        result =
            rgbx ? encode_rgbx(rgbx, pixels, width, height, &bytes, error)
                 : encode(name, pixels, width, height, 3, &options, KI_PNG_SRGB8, &bytes, error);
        if (result == KILN_OK)
            result = ki_file_set_add(set, name, bytes.bytes, bytes.size, error);
        count++;
    }
    if (result == KILN_OK)
        result = ki_file_set_commit(set, error);
    else
        ki_file_set_abandon(set);
    if (result == KILN_OK && file_count)
        *file_count = count;
    ki_writer_free(&path);
    ki_writer_free(&bytes);
    return result;
}

static kiln_result save_pictures(kiln_context *context, const kiln_map *map, const char *path,
                                 const kiln_save_def *def, int *file_count, kiln_error *error)
{
    text_writer template = {.context = context};
    kiln_result result = make_template(path, map, &template, error);
    bool made = false;
    if (result == KILN_OK && ki_ends_with(path, "/")) {
        made = ki_os_make_folder(path);
        if (!made && errno != EEXIST)
            result = ki_fail(error, KILN_ERROR_IO, "%s: the folder cannot be made: %s", path,
                             strerror(errno));
    }
    if (result == KILN_OK && template.bytes)
        result = write_set(context, map, (const char *)template.bytes, def, file_count, error);
    if (result != KILN_OK && made)
        ki_os_remove_folder(path);
    ki_writer_free(&template);
    return result;
}

static kiln_result save_cube(kiln_context *context, const kiln_map *map, const char *path,
                             const kiln_save_def *def, kiln_error *error)
{
    ki_writer bytes = {.context = context};
    if (!ki_progress(context, "writing", 0))
        return ki_fail_cancelled(error, "writing");
    kiln_result result = ki_ends_with(path, ".ktx2") ? ki_ktx2_encode(map, def, &bytes, error)
                                                     : ki_dds_encode(map, def, &bytes, error);
    if (result == KILN_OK)
        result = ki_file_write(context, path, bytes.bytes, bytes.size, error);
    ki_writer_free(&bytes);
    return result;
}

static kiln_result check_sh(const kiln_sh *sh, kiln_error *error)
{
    if (sh && (sh->bands < 1 || sh->bands > KILN_MAX_BANDS))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "bands is %d, it must be 1 to %d", sh->bands,
                       KILN_MAX_BANDS);
    return KILN_OK;
}

kiln_result kiln_map_save(kiln_context *context, const kiln_map *map, const char *path,
                          const kiln_save_def *def, int *file_count, kiln_error *error)
{
    static const kiln_save_def defaults = {0};
    if (file_count)
        *file_count = 0;
    def = def ? def : &defaults;
    kiln_result result = ki_map_check(map, error);
    if (result == KILN_OK)
        result = check_sh(def->sh, error);
    if (result != KILN_OK)
        return result;
    if ((int)def->format < 0 || def->format > KILN_FORMAT_RGBP)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "format is %d, it must be 0 to %d",
                       (int)def->format, (int)KILN_FORMAT_RGBP);
    if (def->zstd < 0 || def->zstd > 22)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "zstd is %d, it must be 0 to 22", def->zstd);
    bool cube = ki_ends_with(path, ".ktx2") || ki_ends_with(path, ".dds");
    if (cube) {
        result = save_cube(context, map, path, def, error);
        if (result == KILN_OK && file_count)
            *file_count = 1;
        return result;
    }
    bool exr = ki_ends_with(path, ".exr") || ki_ends_with(path, "/");
    if (!exr && !ki_ends_with(path, ".hdr") && !ki_ends_with(path, ".png"))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: ends in none of .ktx2 .dds .exr .hdr .png and /", path);
    bool plain = def->format == KILN_FORMAT_AUTO || (exr && def->format <= KILN_FORMAT_RGBA32F) ||
                 (ki_ends_with(path, ".png") && ki_rgbx_of_format(def->format));
    if (!plain || def->zstd)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: has no %s; EXR takes rgba16f and rgba32f, PNG rgbm, rgbd and "
                       "rgbp, HDR has one format",
                       path, plain ? "zstd" : "such format");
    return save_pictures(context, map, path, def, file_count, error);
}

kiln_result kiln_image_save(kiln_context *context, const kiln_image *image, const char *path,
                            kiln_error *error)
{
    bool exr = ki_ends_with(path, ".exr"), hdr = ki_ends_with(path, ".hdr");
    if (!exr && !hdr && !ki_ends_with(path, ".png"))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: ends in none of .exr .hdr .png", path);
    if (!image->pixels || image->width < 1 || image->height < 1 || image->channels < 1 ||
        image->channels > 4)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the image is %d x %d with %d channels%s",
                       image->width, image->height, image->channels,
                       image->pixels ? "" : " and no pixels");
    if (hdr && image->channels != 3)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: HDR has three channels, the image %d", path,
                       image->channels);
    ki_writer bytes = {.context = context};
    ki_exr_options options = {.half = false, .roughness = -1};
    kiln_result result = encode(path, image->pixels, image->width, image->height, image->channels,
                                &options, KI_PNG_PLAIN8, &bytes, error);
    if (result == KILN_OK)
        result = ki_file_write(context, path, bytes.bytes, bytes.size, error);
    ki_writer_free(&bytes);
    return result;
}

// ------------------------------------------------------------------------------ spherical harmonics

static const char *const basis[KILN_MAX_BANDS * KILN_MAX_BANDS] = {
    "Y0,0",  "Y1,-1", "Y1,0",  "Y1,1", "Y2,-2", "Y2,-1", "Y2,0", "Y2,1",  "Y2,2",
    "Y3,-3", "Y3,-2", "Y3,-1", "Y3,0", "Y3,1",  "Y3,2",  "Y3,3", "Y4,-4", "Y4,-3",
    "Y4,-2", "Y4,-1", "Y4,0",  "Y4,1", "Y4,2",  "Y4,3",  "Y4,4"};

static void write_row(ki_writer *w, const double c[3], const char *between)
{
    for (int k = 0; k < 3; k++) {
        ki_write_text(w, "%s", k ? between : "");
        ki_write_number(w, c[k]);
    }
}

static void write_json(ki_writer *w, const kiln_sh *sh)
{
    ki_write_text(w, "{\n  \"bands\": %d,\n  \"irradiance\": %s,\n  \"window\": ", sh->bands,
                  sh->irradiance ? "true" : "false");
    ki_write_number(w, sh->window);
    ki_write_text(w, ",\n  \"basis\": \"real orthonormal, no Condon-Shortley sign, l(l+1)+m\",\n"
                     "  \"coefficients\": [\n");
    int count = sh->bands * sh->bands;
    for (int i = 0; i < count; i++) {
        ki_write_text(w, "    [");
        write_row(w, sh->c[i], ", ");
        ki_write_text(w, "]%s\n", i < count - 1 ? "," : "");
    }
    ki_write_text(w, "  ]\n}\n");
}

static void write_lines(ki_writer *w, const kiln_sh *sh)
{
    for (int i = 0; i < sh->bands * sh->bands; i++) {
        write_row(w, sh->c[i], " ");
        ki_write_text(w, " ; %s\n", basis[i]);
    }
}

static void write_array(ki_writer *w, const kiln_sh *sh)
{
    int count = sh->bands * sh->bands;
    ki_write_text(w,
                  "// Spherical harmonics of %s, %d bands, red green blue: real, orthonormal, no\n"
                  "// Condon-Shortley sign, in the order l(l+1)+m.",
                  sh->irradiance ? "irradiance" : "radiance", sh->bands);
    if (sh->window > 0) {
        ki_write_text(w, " Hanning window of width ");
        ki_write_number(w, sh->window);
        ki_write_text(w, ".");
    }
    ki_write_text(w, "\nstatic const double kiln_sh_coefficients[%d][3] = {\n", count);
    for (int i = 0; i < count; i++) {
        ki_write_text(w, "    {");
        write_row(w, sh->c[i], ", ");
        ki_write_text(w, "}, // %s\n", basis[i]);
    }
    ki_write_text(w, "};\n");
}

kiln_result kiln_sh_save(kiln_context *context, const kiln_sh *sh, const char *path,
                         kiln_error *error)
{
    kiln_result result = check_sh(sh, error);
    if (result != KILN_OK)
        return result;
    ki_writer bytes = {.context = context};
    if (ki_ends_with(path, ".json"))
        write_json(&bytes, sh);
    else if (ki_ends_with(path, ".txt"))
        write_lines(&bytes, sh);
    else if (ki_ends_with(path, ".h"))
        write_array(&bytes, sh);
    else
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: ends in none of .json .txt .h", path);
    if (bytes.failed)
        result = ki_fail_memory(context, error, path, bytes.size);
    else
        result = ki_file_write(context, path, bytes.bytes, bytes.size, error);
    ki_writer_free(&bytes);
    return result;
}
