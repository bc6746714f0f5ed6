// The texels of KTX2 files, whichever program wrote the file, and flat pictures. In: an opened
// file. Out: how its texels are stored, by its vkFormat and its data format descriptor; or a flat
// picture, level 0 of a 2-D texture. Also the writing of an engine's flat picture.
#include "codec/engine_text.h"
#include "codec/ktx2.h"
#include "codec/report.h"
#include "codec/uastc.h"

#include <stdio.h>

kiln_result ki_ktx2_texels(const ki_ktx2_source *s, ki_texels *texels, kiln_error *error)
{
    enum { MODEL_UASTC = 166, VK_BC6H_SIGNED = 144 };
    enum { PRIMARIES_AT = 13, LINEAR = 1, SRGB = 2, BT709 = 1 };
    uint8_t model = 0, primaries = 0, transfer = 0;
    if (s->descriptor_offset && s->descriptor_offset <= s->size &&
        s->size - s->descriptor_offset >= PRIMARIES_AT + 2) {
        const uint8_t *at = s->bytes + s->descriptor_offset + PRIMARIES_AT;
        model = at[-1];
        primaries = at[0];
        transfer = at[1];
    }
    if (model == MODEL_UASTC)
        return ki_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s: holds UASTC texels; expand the file first, for example by 'ktx transcode "
            "--target rgba8'",
            s->name);
    if (s->vk == VK_BC6H_SIGNED)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: holds signed BC6H; kiln reads unsigned BC6H, and floats", s->name);
    if (!ki_texels_of_vk(s->vk, texels))
        return ki_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s: has vkFormat %u; kiln reads RGB and RGBA of 8 and 16 bits, of 16-bit and "
            "32-bit floats, and the formats 122, 123, 143 and 1000066000",
            s->name, s->vk);
    if (primaries > BT709 || transfer > SRGB)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: states colour primaries %u and transfer function %u; kiln reads the "
                       "primaries 1 (BT.709) and the functions 1 (linear) and 2 (sRGB)",
                       s->name, primaries, transfer);
    if (texels->kind == KI_TEXEL_U8 && transfer == SRGB)
        texels->kind = KI_TEXEL_SRGB8;
    return KILN_OK;
}

kiln_result ki_ktx2_check_blocks(kiln_context *context, const ki_ktx2_source *s,
                                 const ki_texels *texels, const uint8_t *plain, size_t size,
                                 int level, kiln_error *error)
{
    if (!texels->pixel || texels->pixel->format != KILN_FORMAT_UASTC)
        return KILN_OK;
    size_t count = size / KI_BLOCK_BYTES, part;
    for (size_t at = 0; at < count; at += part) {
        if (!ki_go_on(context))
            return ki_fail_cancelled(error, "reading");
        part = count - at < KI_ASK_EVERY ? count - at : KI_ASK_EVERY;
        size_t known = ki_uastc_first_unknown(plain + KI_BLOCK_BYTES * at, part);
        if (known < part)
            return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                           "%s: block %zu of %zu in level %d is not in one of the 24 modes of "
                           "UASTC HDR 4x4; kiln reads no other ASTC, expand the file first",
                           s->name, at + known, count, level);
    }
    return KILN_OK;
}

kiln_result ki_ktx2_turn(kiln_context *context, const kiln_file_info *info, float *rgb, int width,
                         int height, kiln_load_report *report, kiln_error *error)
{
    const char *way = info->orientation;
    bool left = way[0] == 'l', up = way[0] && way[1] == 'u';
    if (!left && !up)
        return KILN_OK;
    if (!ki_texels_flip(context, rgb, width, height, left, up))
        return ki_fail_cancelled(error, "reading");
    ki_note(report, KILN_NOTE_CONVERSION, false,
            "the orientation \"%s\" was turned to rows from the top and columns from the left",
            way);
    return KILN_OK;
}

// ----------------------------------------------------------------------------------- flat pictures

const char *ki_ktx2_scheme(const ki_ktx2_source *s)
{
    return s->zstd ? ", zstd" : s->zlib ? ", zlib" : "";
}

static void describe(const ki_ktx2_source *s, const ki_texels *texels, kiln_file_info *info)
{
    char name[KI_TEXELS_NAME];
    snprintf(info->format, sizeof info->format, "ktx2");
    snprintf(info->encoding, sizeof info->encoding, "%s%s", ki_texels_name(texels, name),
             ki_ktx2_scheme(s));
    info->width = (int)s->width;
    info->height = (int)s->height;
    if (!ki_is_atlas(info)) // whose metadata state the number of levels in the picture
        info->level_count = (int)s->level_count;
    info->channel_count = texels->channels;
}

kiln_result ki_ktx2_decode_picture(kiln_context *context, ki_ktx2_source *s, kiln_image *image,
                                   kiln_file_info *info, kiln_load_report *report,
                                   kiln_error *error)
{
    ki_texels texels;
    ki_ktx2_level level;
    const uint8_t *plain;
    uint8_t *unpacked = NULL;
    kiln_result result = ki_ktx2_texels(s, &texels, error);
    if (result == KILN_OK && (s->width < 1 || s->height < 1 || s->width > KILN_MAX_SIZE ||
                              s->height > KILN_MAX_SIZE || s->level_count > KILN_MAX_LEVELS))
        result =
            ki_fail(error, KILN_ERROR_UNSUPPORTED,
                    "%s: is %u x %u texels with %u levels; each side may be 1 to %d, with %d "
                    "levels at most",
                    s->name, s->width, s->height, s->level_count, KILN_MAX_SIZE, KILN_MAX_LEVELS);
    if (result != KILN_OK)
        return result;
    describe(s, &texels, info);
    int w = info->width, h = info->height;
    result = ki_ktx2_find_level(s, 0, ki_texels_size(&texels, w, h, 1), &level, error);
    if (result == KILN_OK)
        ki_texels_note(&texels, true, (int)s->level_count, report);
    if (result != KILN_OK || !image)
        return result;
    result = ki_ktx2_unpack(context, s, 0, &level, &plain, &unpacked, error);
    if (result == KILN_OK)
        result = ki_ktx2_check_blocks(context, s, &texels, plain,
                                      (size_t)ki_texels_size(&texels, w, h, 1), 0, error);
    *image = (kiln_image){.width = w, .height = h, .channels = 3};
    if (result == KILN_OK)
        result = ki_image_allocate(context, image, error);
    if (result == KILN_OK && !ki_texels_read(context, &texels, plain, w, h, 1, image->pixels))
        result = ki_fail_cancelled(error, "reading");
    if (result == KILN_OK)
        result = ki_ktx2_turn(context, info, image->pixels, w, h, report, error);
    ki_free(unpacked);
    if (result != KILN_OK)
        kiln_image_free(image);
    return result;
}

// ----------------------------------------------------------------------------------------- writing

typedef struct pack_job {
    const ki_pixel_format *pixel;
    const kiln_image *image;
} pack_job;

static bool pack_picture(kiln_context *context, const void *data, int level, uint8_t *bytes)
{
    (void)level;
    const pack_job *job = data;
    const kiln_image *image = job->image;
    return ki_pixels_pack(context, job->pixel, image->pixels, image->width, image->height, 1,
                          bytes);
}

kiln_result ki_ktx2_encode_picture(const kiln_image *image, const kiln_save_def *def,
                                   const char *engine, ki_writer *writer, kiln_error *error)
{
    pack_job job = {ki_pixel_format_of(def->format), image};
    ki_ktx2_file file = ki_ktx2_file_of(job.pixel);
    file.width = image->width;
    file.height = image->height;
    file.face_count = file.level_count = 1;
    file.zstd = def->zstd;
    ki_ktx2_writer k;
    ki_ktx2_begin(writer, &file, &k);
    ki_ktx2_write_common(writer, "ru");
    size_t entry = ki_ktx2_begin_entry(writer, "kiln:engine");
    ki_write_text(writer, "%s", engine);
    ki_ktx2_end_entry(writer, entry);
    kiln_result result = ki_ktx2_end_metadata(&k, error);
    size_t size = (size_t)ki_pixels_size(job.pixel, image->width, image->height);
    return result == KILN_OK ? ki_ktx2_write_level(&k, 0, size, pack_picture, &job, error) : result;
}
