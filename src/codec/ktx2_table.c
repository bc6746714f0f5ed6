// KTX2 tables. In: an image whose slices lie one below the other. Out: bytes of a file with one 2-D
// or 3-D texture of one level; or of a file that is read, the image. Three channels are stored as
// four, because every device can sample four.
#include "codec/components.h"
#include "codec/ktx2.h"

#include <stdio.h>

typedef struct table_texel {
    uint32_t vk;
    kiln_table_format format;
    int channels;
    const char *name;
} table_texel;

static const table_texel texels[] = {
    {100, KILN_TABLE_FORMAT_F32, 1, "r32f"},    {103, KILN_TABLE_FORMAT_F32, 2, "rg32f"},
    {109, KILN_TABLE_FORMAT_F32, 4, "rgba32f"}, {76, KILN_TABLE_FORMAT_F16, 1, "r16f"},
    {83, KILN_TABLE_FORMAT_F16, 2, "rg16f"},    {97, KILN_TABLE_FORMAT_F16, 4, "rgba16f"},
    {70, KILN_TABLE_FORMAT_U16, 1, "r16"},      {77, KILN_TABLE_FORMAT_U16, 2, "rg16"},
    {91, KILN_TABLE_FORMAT_U16, 4, "rgba16"},   {9, KILN_TABLE_FORMAT_U8, 1, "r8"},
    {16, KILN_TABLE_FORMAT_U8, 2, "rg8"},       {37, KILN_TABLE_FORMAT_U8, 4, "rgba8"},
};

enum { TEXELS = sizeof texels / sizeof *texels };

static size_t texel_size(const table_texel *texel)
{
    return (size_t)texel->channels * (size_t)ki_component_bytes(texel->format);
}

// ----------------------------------------------------------------------------------------- writing

static const table_texel *find_texel(kiln_table_format format, int channels)
{
    for (int i = 0; i < TEXELS; i++)
        if (texels[i].format == format && texels[i].channels >= channels)
            return &texels[i];
    return NULL;
}

typedef struct pack_job {
    const kiln_image *image;
    const table_texel *texel;
} pack_job;

static bool pack_rows(kiln_context *context, const void *data, int level, uint8_t *bytes)
{
    (void)level;
    const pack_job *job = data;
    const kiln_image *image = job->image;
    size_t width = (size_t)image->width, channels = (size_t)image->channels;
    for (int y = 0; y < image->height; y++) {
        if (y % 64 == 0 && !ki_go_on(context))
            return false;
        ki_components_pack(job->texel->format, image->pixels + (size_t)y * width * channels, width,
                           image->channels, job->texel->channels, bytes);
        bytes += width * texel_size(job->texel);
    }
    return true;
}

// Sets the samples of the file's data format descriptor, which say where the bits of each channel
// lie. Their limits are -1 and 1 for floats, as the KTX specification requires, and 0 and the
// largest integer for integers.
static void find_samples(const table_texel *texel, ki_ktx2_file *file)
{
    int bits = 8 * ki_component_bytes(texel->format);
    bool whole = texel->format == KILN_TABLE_FORMAT_U8 || texel->format == KILN_TABLE_FORMAT_U16;
    file->sample_count = texel->channels;
    for (int c = 0; c < texel->channels; c++) {
        int channel = (c == 3 ? KI_KTX2_ALPHA : c) | (whole ? 0 : KI_KTX2_FLOAT | KI_KTX2_SIGNED);
        file->samples[c] = (ki_ktx2_sample){bits * c, bits, channel, whole ? 0 : 0xbf800000,
                                            whole ? (1U << bits) - 1 : 0x3f800000};
    }
}

kiln_result ki_ktx2_encode_table(const kiln_image *image, int depth, const char *text,
                                 kiln_table_format format, int zstd, ki_writer *writer,
                                 kiln_error *error)
{
    const table_texel *texel = find_texel(format, image->channels);
    if (!texel)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "a KTX2 file cannot hold a table of format %d with %d channels", (int)format,
                       image->channels);
    ki_ktx2_file file = {.vk = texel->vk,
                         .type_size = ki_component_bytes(format),
                         .texel_size = (int)texel_size(texel),
                         .width = image->width,
                         .height = image->height / depth,
                         .depth = depth > 1 ? depth : 0,
                         .face_count = 1,
                         .level_count = 1,
                         .zstd = zstd};
    find_samples(texel, &file);
    ki_ktx2_writer k;
    ki_ktx2_begin(writer, &file, &k);
    ki_ktx2_write_common(writer, depth > 1 ? "rdi" : "rd");
    size_t entry = ki_ktx2_begin_entry(writer, "kiln:table");
    ki_write_text(writer, "%s", text);
    ki_ktx2_end_entry(writer, entry);
    kiln_result result = ki_ktx2_end_metadata(&k, error);
    if (result != KILN_OK)
        return result;
    pack_job job = {image, texel};
    size_t size = (size_t)image->width * (size_t)image->height * texel_size(texel);
    return ki_ktx2_write_level(&k, 0, size, pack_rows, &job, error);
}

// ----------------------------------------------------------------------------------------- reading

static const table_texel *texel_of_vk(uint32_t vk)
{
    for (int i = 0; i < TEXELS; i++)
        if (texels[i].vk == vk)
            return &texels[i];
    return NULL;
}

static kiln_result check(const ki_ktx2_source *s, const table_texel *texel, kiln_error *error)
{
    enum { LIMIT = 6 * KILN_MAX_SIZE };
    if (!texel)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has vkFormat %u; kiln reads tables of 8 and 16 bits, 16-bit floats and "
                       "32-bit floats with 1, 2 and 4 channels",
                       s->name, s->vk);
    if (s->width < 1 || s->height < 1)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: is %u x %u texels, each side must be at least 1", s->name, s->width,
                       s->height);
    uint64_t rows = (uint64_t)s->height * (s->depth ? s->depth : 1);
    if (s->width > LIMIT || s->depth > LIMIT || rows > LIMIT)
        return ki_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s: is %u x %u x %u texels; width, depth, and height times depth may be %d at most",
            s->name, s->width, s->height, s->depth, LIMIT);
    return KILN_OK;
}

static void describe(const ki_ktx2_source *s, const table_texel *texel, kiln_file_info *info)
{
    snprintf(info->format, sizeof info->format, "ktx2");
    snprintf(info->encoding, sizeof info->encoding, "%s%s", texel->name, s->zstd ? ", zstd" : "");
    snprintf(info->layout, sizeof info->layout, "table");
    info->width = (int)s->width;
    info->height = (int)s->height;
    info->depth = s->depth ? (int)s->depth : 1;
    info->level_count = s->level_count < KILN_MAX_LEVELS ? (int)s->level_count : KILN_MAX_LEVELS;
    info->channel_count = texel->channels;
}

kiln_result ki_ktx2_decode_table(kiln_context *context, ki_ktx2_source *s, kiln_image *image,
                                 kiln_file_info *info, kiln_error *error)
{
    const table_texel *texel = texel_of_vk(s->vk);
    kiln_result result = check(s, texel, error);
    if (result != KILN_OK || !texel)
        return result;
    describe(s, texel, info);
    ki_ktx2_level level;
    int rows = info->height * info->depth;
    uint64_t count = (uint64_t)s->width * (uint64_t)rows;
    result = ki_ktx2_find_level(s, 0, count * texel_size(texel), &level, error);
    if (result != KILN_OK || !image)
        return result;
    const uint8_t *plain;
    uint8_t *unpacked;
    result = ki_ktx2_unpack(context, s, 0, &level, &plain, &unpacked, error);
    if (result != KILN_OK)
        return result;
    *image = (kiln_image){.width = info->width, .height = rows, .channels = texel->channels};
    result = ki_image_allocate(context, image, error);
    size_t line = (size_t)s->width * (size_t)texel->channels;
    for (int y = 0; y < rows && result == KILN_OK; y++) {
        if (ki_go_on(context))
            ki_components_unpack(texel->format, plain + (size_t)y * s->width * texel_size(texel),
                                 line, image->pixels + (size_t)y * line);
        else
            result = ki_fail_cancelled(error, "reading");
    }
    ki_free(unpacked);
    if (result != KILN_OK)
        kiln_image_free(image);
    return result;
}
