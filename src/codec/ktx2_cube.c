// KTX2 cubes. In: a cube with all its levels and its metadata. Out: bytes of a file; or of a file
// that is read, the cube.
#include "codec/decimal.h"
#include "codec/ktx2.h"

#include <stdio.h>
#include <string.h>

// ----------------------------------------------------------------------------------------- writing

// Writes the metadata entries of a cube, in the byte order of their keys.
static void write_metadata(ki_writer *w, const kiln_map *map, const kiln_save_def *def)
{
    ki_ktx2_write_common(w, "rd");
    if (def->lobe) {
        size_t entry = ki_ktx2_begin_entry(w, "kiln:lobe");
        ki_write(w, def->lobe, strlen(def->lobe));
        ki_ktx2_end_entry(w, entry);
    }
    size_t entry = ki_ktx2_begin_entry(w, "kiln:roughness");
    for (int k = 0; k < map->level_count; k++) {
        ki_write_text(w, k ? " " : "");
        ki_write_number(w, (double)map->roughness[k]);
    }
    ki_ktx2_end_entry(w, entry);
    if (def->sh) {
        const kiln_sh *sh = def->sh;
        entry = ki_ktx2_begin_entry(w, "kiln:sh");
        ki_write_text(w, "bands %d\nirradiance %d\nwindow ", sh->bands, sh->irradiance);
        ki_write_number(w, sh->window);
        for (int i = 0; i < sh->bands * sh->bands; i++)
            for (int c = 0; c < 3; c++) {
                ki_write_text(w, c ? " " : "\n");
                ki_write_number(w, sh->c[i][c]);
            }
        ki_ktx2_end_entry(w, entry);
    }
}

typedef struct pack_job {
    const kiln_map *map;
    const ki_pixel_format *pixel;
} pack_job;

static bool pack_level(kiln_context *context, const void *data, int level, uint8_t *bytes)
{
    const pack_job *job = data;
    int n = kiln_map_level_size(job->map, level);
    return ki_pixels_pack(context, job->pixel, job->map->level[level], n, n, 6, bytes);
}

kiln_result ki_ktx2_encode(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                           kiln_error *error)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(def->format);
    if (map->shape != KILN_SHAPE_CUBE)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "a KTX2 file holds a cube only, convert the map by kiln_map_convert");
    if (!pixel || !pixel->vk)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "format is %d, it must be 0 to %d or %d",
                       (int)def->format, (int)KILN_FORMAT_BC6H, (int)KILN_FORMAT_UASTC);
    if (map->smallest > 1 && map->size >> (map->level_count - 1) < map->smallest)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "each level of a KTX2 file has half the size of the previous level, which "
                       "the map's smallest of %d prevents",
                       map->smallest);
    ki_ktx2_file file = ki_ktx2_file_of(pixel);
    file.width = file.height = map->size;
    file.face_count = 6;
    file.level_count = map->level_count;
    file.zstd = def->zstd;
    ki_ktx2_writer k;
    ki_ktx2_begin(writer, &file, &k);
    write_metadata(writer, map, def);
    kiln_result result = ki_ktx2_end_metadata(&k, error);
    pack_job job = {map, pixel};
    for (int level = map->level_count - 1; level >= 0 && result == KILN_OK; level--) {
        int n = kiln_map_level_size(map, level);
        result = ki_ktx2_write_level(&k, level, 6 * (size_t)ki_pixels_size(pixel, n, n), pack_level,
                                     &job, error);
    }
    return result;
}

// ----------------------------------------------------------------------------------------- reading

static kiln_result check(const ki_ktx2_source *s, kiln_error *error)
{
    if (s->width < 1 || s->width != s->height || s->width > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: faces are %u x %u, they must be square with sides of 1 to %d", s->name,
                       s->width, s->height, KILN_MAX_SIZE);
    if (s->level_count > KILN_MAX_LEVELS || s->width >> (s->level_count - 1) == 0)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has %u levels, which is too many for faces of size %u", s->name,
                       s->level_count, s->width);
    return KILN_OK;
}

static kiln_result read_level(kiln_context *context, const ki_ktx2_source *s,
                              const ki_texels *format, const ki_ktx2_level *level, int k,
                              kiln_map *map, kiln_error *error)
{
    const uint8_t *plain;
    uint8_t *unpacked;
    kiln_result result = ki_ktx2_unpack(context, s, k, level, &plain, &unpacked, error);
    int n = kiln_map_level_size(map, k);
    size_t face = (size_t)ki_texels_size(format, n, n, 1), texels = kiln_map_texels(map, k) / 6;
    if (result == KILN_OK)
        result = ki_ktx2_check_blocks(context, s, format, plain, 6 * face, k, error);
    for (size_t i = 0; i < 6 && result == KILN_OK; i++)
        if (!ki_texels_read(context, format, plain + face * i, n, n, 1,
                            map->level[k] + 3 * texels * i))
            result = ki_fail_cancelled(error, "reading");
    ki_free(unpacked);
    return result;
}

static void describe(const ki_ktx2_source *s, const ki_texels *texels, kiln_file_info *info)
{
    char name[KI_TEXELS_NAME];
    snprintf(info->format, sizeof info->format, "ktx2");
    snprintf(info->encoding, sizeof info->encoding, "%s%s", ki_texels_name(texels, name),
             ki_ktx2_scheme(s));
    info->width = info->height = (int)s->width;
    info->face_count = 6;
    info->level_count = (int)s->level_count;
    info->channel_count = texels->channels;
}

// Turns the faces as the metadata say.
static kiln_result turn_faces(kiln_context *context, const kiln_map *map,
                              const kiln_file_info *info, kiln_load_report *report,
                              kiln_error *error)
{
    kiln_result result = KILN_OK;
    for (int k = 0; k < map->level_count; k++)
        for (size_t face = 0; face < 6 && result == KILN_OK; face++) {
            int n = kiln_map_level_size(map, k);
            result = ki_ktx2_turn(context, info, map->level[k] + 3 * face * (size_t)n * (size_t)n,
                                  n, n, report, error);
        }
    return result;
}

kiln_result ki_ktx2_decode_cube(kiln_context *context, ki_ktx2_source *s, kiln_map *map,
                                kiln_file_info *info, kiln_load_report *report, kiln_error *error)
{
    ki_texels texels;
    ki_ktx2_level levels[KILN_MAX_LEVELS];
    kiln_result result = ki_ktx2_texels(s, &texels, error);
    if (result == KILN_OK)
        result = check(s, error);
    if (result != KILN_OK)
        return result;
    describe(s, &texels, info);
    for (uint32_t k = 0; k < s->level_count && result == KILN_OK; k++) {
        int edge = (int)(s->width >> k);
        uint64_t wanted = 6 * ki_texels_size(&texels, edge, edge, 1);
        result = ki_ktx2_find_level(s, k, wanted, &levels[k], error);
    }
    // A cube that kiln wrote states the roughness of its levels.
    if (result == KILN_OK)
        ki_texels_note(&texels, true, info->roughness[0] >= 0 ? 1 : (int)s->level_count, report);
    if (result != KILN_OK || !map)
        return result;

    int count = (int)s->level_count;
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = (int)s->width, .level_count = count};
    result = ki_map_allocate(context, map, error);
    for (int k = 0; k < count && result == KILN_OK; k++) {
        float linear = count > 1 ? (float)k / (float)(count - 1) : 0;
        map->roughness[k] = info->roughness[k] >= 0 ? info->roughness[k] : linear;
        result = read_level(context, s, &texels, &levels[k], k, map, error);
    }
    if (result == KILN_OK)
        result = turn_faces(context, map, info, report, error);
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}
