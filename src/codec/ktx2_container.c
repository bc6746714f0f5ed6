// The container format of KTX2 (Khronos specification 2.0.4). In: the values of the header,
// metadata entries and packed levels. Out: bytes of a file; or of a file that is read, the values
// of its header, its metadata, and the checked place and bytes of each level, decompressed by zstd
// or zlib if needed.
#include "codec/decimal.h"
#include "codec/deflate.h"
#include "codec/engine_text.h"
#include "codec/file_info.h"
#include "codec/ktx2.h"
#include "codec/zstd.h"

#include <stdio.h>
#include <string.h>

static const uint8_t identifier[12] = {0xab, 'K',  'T',  'X',  ' ',  '2',
                                       '0',  0xbb, '\r', '\n', 0x1a, '\n'};

enum { INDEX_ENTRY = 24, SCHEME_NONE = 0, SCHEME_BASIS = 1, SCHEME_ZSTD = 2, SCHEME_ZLIB = 3 };

// ----------------------------------------------------------------------------------------- writing

// Sets the samples of the file's data format descriptor, which say where the bits of each channel
// lie, and returns their number. A shared exponent is a further sample for each of its channels.
static int find_samples(const ki_pixel_format *pixel, ki_ktx2_sample samples[6])
{
    const uint32_t minus_one = 0xbf800000, one = 0x3f800000;
    switch (pixel->format) {
    case KILN_FORMAT_RGB9E5:
        // The lower and upper limits, the last two numbers of a sample, are those of the KTX
        // specification for VK_FORMAT_E5B9G9R9_UFLOAT_PACK32.
        for (int c = 0; c < 3; c++) {
            samples[2 * (size_t)c] = (ki_ktx2_sample){9 * c, 9, c, 0, 8448};
            samples[2 * (size_t)c + 1] = (ki_ktx2_sample){27, 5, c | KI_KTX2_EXPONENT, 15, 31};
        }
        return 6;
    case KILN_FORMAT_B10G11R11:
        samples[0] = (ki_ktx2_sample){0, 11, 0 | KI_KTX2_FLOAT, 0, one};
        samples[1] = (ki_ktx2_sample){11, 11, 1 | KI_KTX2_FLOAT, 0, one};
        samples[2] = (ki_ktx2_sample){22, 10, 2 | KI_KTX2_FLOAT, 0, one};
        return 3;
    case KILN_FORMAT_BC6H:
    case KILN_FORMAT_UASTC:
        samples[0] = (ki_ktx2_sample){0, 128, 0 | KI_KTX2_FLOAT, 0, one};
        return 1;
    default:
        break;
    }
    int bits = 2 * pixel->bytes;
    for (int c = 0; c < 4; c++)
        samples[c] = (ki_ktx2_sample){bits * c, bits,
                                      (c == 3 ? KI_KTX2_ALPHA : c) | KI_KTX2_FLOAT | KI_KTX2_SIGNED,
                                      minus_one, one};
    return 4;
}

ki_ktx2_file ki_ktx2_file_of(const ki_pixel_format *pixel)
{
    ki_ktx2_file file = {.vk = pixel->vk,
                         .type_size = pixel->type_size,
                         .texel_size = pixel->bytes,
                         .block = pixel->block,
                         .model = pixel->model};
    file.sample_count = find_samples(pixel, file.samples);
    return file;
}

// Writes the data format descriptor: a basic descriptor block of the Khronos Data Format 1.3.
static void write_format(ki_writer *w, const ki_ktx2_file *file)
{
    enum { MODEL_RGBSDA = 1, PRIMARIES_BT709 = 1, TRANSFER_LINEAR = 1 };
    uint32_t block = 24 + 16 * (uint32_t)file->sample_count;
    ki_write_u32(w, 4 + block);
    ki_write_u32(w, 0); // descriptor block: vendor Khronos, type "basic format"
    // version of the descriptor block, 2 for Khronos Data Format 1.3, and the block's size in bytes
    ki_write_u32(w, 2 | block << 16);
    ki_write_u8(w, (uint8_t)(file->model ? file->model : MODEL_RGBSDA));
    ki_write_u8(w, PRIMARIES_BT709);
    ki_write_u8(w, TRANSFER_LINEAR);
    ki_write_u8(w, 0); // flags: alpha is not multiplied into the colours
    uint32_t less = (uint32_t)ki_max(file->block, 1) - 1;
    // Dimensions of a texel block, each less 1: `less` x `less` x 0 x 0.
    ki_write_u32(w, less | less << 8);
    ki_write_u32(w, (uint32_t)file->texel_size);
    ki_write_u32(w, 0);
    for (int i = 0; i < file->sample_count; i++) {
        const ki_ktx2_sample *s = &file->samples[i];
        ki_write_u32(w, (uint32_t)s->offset | (uint32_t)(s->bits - 1) << 16 |
                            (uint32_t)s->channel << 24);
        ki_write_u32(w, 0); // position of the sample within a texel
        ki_write_u32(w, s->lower);
        ki_write_u32(w, s->upper);
    }
}

void ki_ktx2_begin(ki_writer *w, const ki_ktx2_file *file, ki_ktx2_writer *k)
{
    *k = (ki_ktx2_writer){.w = w, .file = file, .start = w->size};
    ki_write(w, identifier, sizeof identifier);
    ki_write_u32(w, file->vk);
    ki_write_u32(w, (uint32_t)file->type_size);
    ki_write_u32(w, (uint32_t)file->width);
    ki_write_u32(w, (uint32_t)file->height);
    ki_write_u32(w, (uint32_t)file->depth);
    ki_write_u32(w, 0); // number of array layers, 0 because the texture is no array
    ki_write_u32(w, (uint32_t)file->face_count);
    ki_write_u32(w, (uint32_t)file->level_count);
    ki_write_u32(w, file->zstd ? SCHEME_ZSTD : SCHEME_NONE);
    k->index = w->size;
    // offsets and lengths of the data format descriptor and of the metadata, filled in later
    for (int i = 0; i < 4; i++)
        ki_write_u32(w, 0);
    // offset and length of global data, which only other compression schemes have
    ki_write_u64(w, 0);
    ki_write_u64(w, 0);
    k->levels = w->size;
    for (int i = 0; i < 3 * file->level_count; i++)
        ki_write_u64(w, 0);
    size_t begin = w->size;
    write_format(w, file);
    k->metadata = w->size;
    ki_patch_u32(w, k->index, (uint32_t)(begin - k->start));
    ki_patch_u32(w, k->index + 4, (uint32_t)(k->metadata - begin));
}

// Begins a metadata entry. The returned position is where ki_ktx2_end_entry stores the entry's
// length.
size_t ki_ktx2_begin_entry(ki_writer *w, const char *key)
{
    size_t entry = w->size;
    ki_write_u32(w, 0);
    ki_write(w, key, strlen(key) + 1);
    return entry;
}

void ki_ktx2_end_entry(ki_writer *w, size_t entry)
{
    ki_write_u8(w, 0);
    ki_patch_u32(w, entry, (uint32_t)(w->size - entry - 4));
    ki_write_align(w, 4);
}

void ki_ktx2_write_common(ki_writer *w, const char *orientation)
{
    size_t entry = ki_ktx2_begin_entry(w, "KTXorientation");
    ki_write_text(w, "%s", orientation);
    ki_ktx2_end_entry(w, entry);
    entry = ki_ktx2_begin_entry(w, "KTXwriter");
    ki_write_text(w, "kiln %s", kiln_version());
    ki_ktx2_end_entry(w, entry);
}

kiln_result ki_ktx2_end_metadata(ki_ktx2_writer *k, kiln_error *error)
{
    ki_writer *w = k->w;
    ki_patch_u32(w, k->index + 8, (uint32_t)(k->metadata - k->start));
    ki_patch_u32(w, k->index + 12, (uint32_t)(w->size - k->metadata));
    return w->failed ? ki_fail_memory(w->context, error, "a KTX2 file", w->size) : KILN_OK;
}

kiln_result ki_ktx2_write_level(ki_ktx2_writer *k, int level, size_t size, ki_ktx2_pack *pack,
                                const void *data, kiln_error *error)
{
    ki_writer *w = k->w;
    int zstd = k->file->zstd;
    // An uncompressed level begins at a multiple of the least common multiple of 4 and the bytes of
    // a texel.
    if (!zstd)
        ki_write_align(w, (size_t)ki_max(4, k->file->texel_size));
    uint64_t start = w->size;
    size_t bound = zstd ? ki_zstd_bound(size) : size, packed = size;
    uint8_t *room = ki_write_room(w, bound);
    uint8_t *plain = zstd && room ? ki_alloc_raw(w->context, size, 1) : room;
    kiln_result result = plain ? KILN_OK : KILN_ERROR_MEMORY;
    if (plain && !pack(w->context, data, level, plain))
        result = KILN_ERROR_CANCELLED;
    if (zstd && result == KILN_OK)
        result = ki_zstd_pack(w->context, plain, size, zstd, room, bound, &packed);
    if (zstd)
        ki_free(plain);
    if (result == KILN_ERROR_CANCELLED)
        return ki_fail_cancelled(error, "writing");
    if (result != KILN_OK)
        return ki_fail_memory(w->context, error, "a level of a KTX2 file", size + bound);
    w->size -= bound - packed;
    size_t entry = k->levels + INDEX_ENTRY * (size_t)level;
    ki_patch_u64(w, entry, start - k->start);
    ki_patch_u64(w, entry + 8, w->size - start);
    ki_patch_u64(w, entry + 16, size);
    return KILN_OK;
}

// ----------------------------------------------------------------------------------------- reading

static kiln_result read_header(ki_ktx2_source *s, kiln_error *error)
{
    ki_reader *r = &s->reader;
    ki_read_bytes(r, sizeof identifier);
    s->vk = ki_read_u32(r);
    ki_read_u32(r); // skips the field typeSize
    s->width = ki_read_u32(r);
    s->height = ki_read_u32(r);
    s->depth = ki_read_u32(r);
    s->layer_count = ki_read_u32(r);
    s->face_count = ki_read_u32(r);
    s->level_count = ki_read_u32(r);
    uint32_t scheme = ki_read_u32(r);
    s->descriptor_offset = ki_read_u32(r);
    ki_read_u32(r);
    s->metadata_offset = ki_read_u32(r);
    s->metadata_size = ki_read_u32(r);
    ki_read_u64(r);
    ki_read_u64(r);
    if (r->failed)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the KTX2 header is cut off", s->name);
    bool cube = s->face_count == 6 && s->depth == 0;
    if ((!cube && s->face_count != 1) || s->layer_count > 1)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has %u faces, %u layers and depth %u; kiln reads single cubes, "
                       "pictures and tables "
                       "only",
                       s->name, s->face_count, s->layer_count, s->depth);
    if (scheme == SCHEME_BASIS)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is compressed by BasisLZ; expand the file first, for example by 'ktx "
                       "transcode --target rgba8'",
                       s->name);
    if (scheme > SCHEME_ZLIB)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has supercompression scheme %u; kiln reads the schemes 0 (none), 2 "
                       "(zstd) and 3 (zlib)",
                       s->name, scheme);
    s->zstd = scheme == SCHEME_ZSTD;
    s->zlib = scheme == SCHEME_ZLIB;
    s->level_count = s->level_count ? s->level_count : 1;
    return s->zstd ? ki_zstd_known(s->name, error) : KILN_OK;
}

kiln_result ki_ktx2_find_level(ki_ktx2_source *s, uint32_t k, uint64_t wanted, ki_ktx2_level *level,
                               kiln_error *error)
{
    ki_reader *r = &s->reader;
    uint64_t offset = ki_read_u64(r), length = ki_read_u64(r), plain = ki_read_u64(r);
    if (r->failed || offset > s->size || length > s->size - offset)
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "%s: level %u has %llu bytes from byte %llu on, but the file has only %zu bytes",
            s->name, k, (unsigned long long)length, (unsigned long long)offset, s->size);
    *level = (ki_ktx2_level){s->bytes + offset, (size_t)length, (size_t)wanted};
    uint64_t stated = length;
    if (s->zstd && !ki_zstd_stated_size(level->bytes, level->size, &stated))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: level %u is not a zstd frame that states its size", s->name, k);
    if (s->zlib)
        stated = plain;
    if (plain != wanted || stated != wanted)
        return ki_fail(
            error, KILN_ERROR_FORMAT, "%s: level %u holds %llu bytes, but its %s %llu bytes",
            s->name, k, (unsigned long long)(plain != wanted ? plain : stated),
            s->face_count == 6 ? "six faces need" : "texels need", (unsigned long long)wanted);
    // zstd expands a byte to at most 43691 bytes: a block of 128 KiB takes at least three bytes.
    // zlib expands a byte to at most 1032 bytes.
    if (wanted / (s->zlib ? 1032 : 43691) > length)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: level %u is damaged: its bytes are too few for its size", s->name, k);
    return KILN_OK;
}

kiln_result ki_ktx2_unpack(kiln_context *context, const ki_ktx2_source *s, int k,
                           const ki_ktx2_level *level, const uint8_t **plain, uint8_t **unpacked,
                           kiln_error *error)
{
    *plain = level->bytes;
    *unpacked = NULL;
    if (!s->zstd && !s->zlib)
        return KILN_OK;
    uint8_t *room = ki_alloc_raw(context, level->plain_size, 1);
    if (!room)
        return ki_fail_memory(context, error, s->name, level->plain_size);
    const char *fault = "its zlib data";
    kiln_result result;
    ki_asker asker = ki_asker_make(context);
    if (s->zlib)
        result = ki_inflate_long(&asker, level->bytes, level->size, room, level->plain_size, false);
    else
        result =
            ki_zstd_unpack(context, level->bytes, level->size, room, level->plain_size, &fault);
    if (result == KILN_OK) {
        *plain = *unpacked = room;
        return KILN_OK;
    }
    ki_free(room);
    if (result == KILN_ERROR_CANCELLED)
        return ki_fail_cancelled(error, "reading");
    if (result == KILN_ERROR_MEMORY)
        return ki_fail(error, KILN_ERROR_MEMORY,
                       "out of memory: %s: the zstd library could not allocate its own", s->name);
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: level %d is damaged: %s", s->name, k, fault);
}

// ---------------------------------------------------------------------------------------- metadata

static void read_sh(const char *text, kiln_file_info *info)
{
    double bands = 0;
    if (strncmp(text, "bands ", 6) != 0 || !ki_parse_number(text + 6, &bands) || bands < 1 ||
        bands > KILN_MAX_BANDS)
        return;
    info->sh_irradiance = strstr(text, "\nirradiance 1\n") != NULL;
    // skips the lines "bands", "irradiance" and "window", after which the coefficients begin
    for (int line = 0; line < 3 && text; line++) {
        text = strchr(text, '\n');
        text = text ? text + 1 : NULL;
    }
    int count = (int)bands * (int)bands;
    for (int i = 0; i < 3 * count; i++) {
        double value = 0;
        text = text ? ki_parse_number(text + (*text == '\n'), &value) : NULL;
        info->sh[i / 3][i % 3] = ki_info_number(value);
    }
    if (text) // text is not NULL if all coefficients were present
        info->sh_bands = (int)bands;
    else
        memset(info->sh, 0, sizeof info->sh);
}

static void read_entry(const char *key, const char *value, kiln_file_info *info)
{
    if (!strcmp(key, "KTXorientation"))
        ki_copy_printable(info->orientation, sizeof info->orientation, value);
    if (!strcmp(key, "KTXwriter"))
        ki_copy_printable(info->writer, sizeof info->writer, value);
    if (!strcmp(key, "kiln:sh"))
        read_sh(value, info);
    if (!strcmp(key, "kiln:table"))
        ki_copy_printable(info->table, sizeof info->table, value);
    if (!strcmp(key, "kiln:engine"))
        ki_engine_text_read(value, info);
    if (strcmp(key, "kiln:roughness") != 0)
        return;
    for (int k = 0; k < KILN_MAX_LEVELS; k++) {
        double roughness;
        value = ki_parse_number(value, &roughness);
        if (!value || !(roughness >= 0) || !(roughness <= 1))
            return;
        info->roughness[k] = (float)roughness;
    }
}

// Reads the metadata. Entries whose value is not text that ends within the entry, and entries
// longer than KI_KTX_TEXT, are skipped. Returns false if the caller asks to stop.
static bool read_metadata(kiln_context *context, const uint8_t *bytes, size_t size,
                          kiln_file_info *info)
{
    ki_reader r = ki_reader_make(bytes, size);
    for (unsigned count = 0; ki_reader_left(&r) >= 4; count++) {
        if (count % 65536 == 0 && !ki_go_on(context))
            return false;
        uint32_t length = ki_read_u32(&r);
        const uint8_t *entry = ki_read_bytes(&r, length);
        if (!entry)
            return true;
        const uint8_t *end = memchr(entry, 0, length);
        if (end && end + 1 < entry + length && entry[length - 1] == 0 && length <= KI_KTX_TEXT)
            read_entry((const char *)entry, (const char *)end + 1, info);
        ki_read_bytes(&r, (4 - length % 4) % 4);
    }
    return true;
}

kiln_result ki_ktx2_open(kiln_context *context, ki_ktx2_source *s, const uint8_t *bytes,
                         size_t size, const char *name, kiln_file_info *info, kiln_error *error)
{
    *s = (ki_ktx2_source){
        .bytes = bytes, .size = size, .name = name, .reader = ki_reader_make(bytes, size)};
    kiln_result result = read_header(s, error);
    if (result == KILN_OK && s->metadata_offset <= size &&
        s->metadata_size <= size - s->metadata_offset &&
        !read_metadata(context, bytes + s->metadata_offset, s->metadata_size, info))
        result = ki_fail_cancelled(error, "reading");
    return result;
}
