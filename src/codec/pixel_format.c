// Texels of the formats in kiln_format. In: RGB floats of a level. Out: the bytes that KTX2, DDS
// and graphics processors hold; or from such bytes, RGB floats. Also the names, limits and numbers
// of the formats, one row of a table for each. Rows are converted on all threads.
#include "codec/pixel_format.h"

#include "codec/bc6h.h"
#include "codec/uastc.h"
#include "image/image.h"
#include "image/pack.h"

#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are written as memory is");

const char *const ki_format_names[] = {"auto", "rgba16f", "rgba32f", "rgb9e5", "b10g11r11", "bc6h",
                                       "rgbm", "rgbd",    "rgbp",    "uastc",  NULL};

const char *const *kiln_format_names(void)
{
    return ki_format_names;
}

// One row for each kiln_format, in the order of the enum. The first row, for KILN_FORMAT_AUTO, has
// the values of RGBA16F. The formats rgbm, rgbd and rgbp exist only in PNG files and have no Vulkan
// or DXGI number.
enum { RGB = 1, BC6H = 133, UASTC_HDR = 167 }; // colour models
static const ki_pixel_format formats[] = {
    {KILN_FORMAT_RGBA16F, KI_HALF_MAX, 97, 10, 8, 2, 1, 4, RGB, NULL},
    {KILN_FORMAT_RGBA16F, KI_HALF_MAX, 97, 10, 8, 2, 1, 4, RGB, NULL},
    {KILN_FORMAT_RGBA32F, 0, 109, 2, 16, 4, 1, 4, RGB, NULL},
    {KILN_FORMAT_RGB9E5, KI_RGB9E5_MAX, 123, 67, 4, 4, 1, 3, RGB, NULL},
    {KILN_FORMAT_B10G11R11, KI_B10G11R11_MAX, 122, 26, 4, 4, 1, 3, RGB, NULL},
    {KILN_FORMAT_BC6H, KI_HALF_MAX, 143, 95, KI_BLOCK_BYTES, 1, 4, 3, BC6H, NULL},
    {KILN_FORMAT_RGBM, KI_RGBM_MAX, 0, 0, 4, 1, 1, 4, RGB, ki_rgbm_from_float},
    {KILN_FORMAT_RGBD, KI_RGBD_MAX, 0, 0, 4, 1, 1, 4, RGB, ki_rgbd_from_float},
    {KILN_FORMAT_RGBP, KI_RGBP_MAX, 0, 0, 4, 1, 1, 4, RGB, ki_rgbp_from_float},
    {KILN_FORMAT_UASTC, KI_HALF_MAX, 1000066000, 0, KI_BLOCK_BYTES, 1, 4, 3, UASTC_HDR, NULL},
};

enum { FORMATS = sizeof formats / sizeof *formats };
_Static_assert(FORMATS == KILN_FORMAT_UASTC + 1, "a row for each format");
_Static_assert(sizeof ki_format_names / sizeof *ki_format_names == FORMATS + 1, "and a name");

const ki_pixel_format *ki_pixel_format_of(kiln_format format)
{
    return (unsigned)format < FORMATS ? &formats[format] : NULL;
}

const ki_pixel_format *ki_pixel_format_of_vk(uint32_t vk)
{
    for (int i = KILN_FORMAT_RGBA16F; i < FORMATS; i++)
        if (vk && formats[i].vk == vk)
            return &formats[i];
    return NULL;
}

const ki_pixel_format *ki_pixel_format_of_dxgi(uint32_t dxgi)
{
    for (int i = KILN_FORMAT_RGBA16F; i < FORMATS; i++)
        if (dxgi && formats[i].dxgi == dxgi)
            return &formats[i];
    return NULL;
}

double kiln_format_limit(kiln_format format)
{
    const ki_pixel_format *found = ki_pixel_format_of(format);
    return found ? found->limit : 0;
}

enum { STRETCH = 64 };

static void pack_floats(const float *rgb, size_t count, uint8_t *bytes)
{
    for (size_t i = 0; i < count; i++) {
        const float texel[4] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 1};
        memcpy(bytes + 16 * i, texel, sizeof texel);
    }
}

static void pack(const ki_pixel_format *pixel, const float *rgb, size_t count, uint8_t *bytes)
{
    if (pixel->format == KILN_FORMAT_RGBA32F) {
        pack_floats(rgb, count, bytes);
        return;
    }
    for (size_t done = 0; done < count; done += STRETCH) {
        size_t n = count - done < STRETCH ? count - done : STRETCH;
        const float *from = rgb + 3 * done;
        if (pixel->format == KILN_FORMAT_RGBA16F) {
            uint16_t halfs[4 * STRETCH];
            ki_pack_rgba16f(from, n, halfs);
            memcpy(bytes + 8 * done, halfs, 8 * n);
            continue;
        }
        uint32_t words[STRETCH];
        if (pixel->format == KILN_FORMAT_RGB9E5)
            ki_pack_rgb9e5(from, n, words);
        else
            ki_pack_b10g11r11(from, n, words);
        memcpy(bytes + 4 * done, words, 4 * n);
    }
}

enum { PIECE = 1 << 16 };

typedef struct pack_job {
    const ki_pixel_format *pixel;
    const float *rgb;
    size_t count;
    uint8_t *bytes;
} pack_job;

static void pack_piece(void *data, int index)
{
    const pack_job *job = data;
    size_t first = (size_t)index * PIECE, left = job->count - first;
    pack(job->pixel, job->rgb + 3 * first, left < PIECE ? left : PIECE,
         job->bytes + (size_t)job->pixel->bytes * first);
}

uint64_t ki_pixels_size(const ki_pixel_format *pixel, int width, int height)
{
    int edge = pixel->block;
    uint64_t columns = (uint64_t)((width + edge - 1) / edge);
    return columns * (uint64_t)((height + edge - 1) / edge) * (uint64_t)pixel->bytes;
}

bool ki_pixels_pack(kiln_context *context, const ki_pixel_format *pixel, const float *rgb,
                    int width, int height, int count, uint8_t *bytes)
{
    if (pixel->format == KILN_FORMAT_BC6H)
        return ki_bc6h_encode(context, rgb, width, height, count, bytes);
    if (pixel->format == KILN_FORMAT_UASTC)
        return ki_uastc_encode(context, rgb, width, height, count, bytes);
    pack_job job = {pixel, rgb, (size_t)width * (size_t)height * (size_t)count, bytes};
    return ki_parallel_steps(context, NULL, (int)((job.count + PIECE - 1) / PIECE), pack_piece,
                             &job);
}

static void unpack(const ki_pixel_format *pixel, const uint8_t *bytes, size_t count, float *rgb)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t *from = bytes + (size_t)pixel->bytes * i;
        uint32_t word;
        switch (pixel->format) {
        case KILN_FORMAT_RGBA32F:
            memcpy(rgb + 3 * i, from, 3 * sizeof *rgb);
            break;
        case KILN_FORMAT_RGB9E5:
            memcpy(&word, from, sizeof word);
            ki_float_from_rgb9e5(word, rgb + 3 * i);
            break;
        case KILN_FORMAT_B10G11R11:
            memcpy(&word, from, sizeof word);
            ki_float_from_b10g11r11(word, rgb + 3 * i);
            break;
        case KILN_FORMAT_RGBA16F:
        default:
            ki_floats_from_half_bytes(from, 3, rgb + 3 * i);
            break;
        }
    }
}

void ki_pixels_unpack(const ki_pixel_format *pixel, const uint8_t *bytes, int width, int height,
                      float *rgb)
{
    if (pixel->format == KILN_FORMAT_BC6H)
        ki_bc6h_decode(bytes, width, height, rgb);
    else if (pixel->format == KILN_FORMAT_UASTC)
        ki_uastc_decode(bytes, width, height, rgb);
    else
        unpack(pixel, bytes, (size_t)width * (size_t)height, rgb);
}

// ----------------------------------------------------------------------------------- packed levels

// Finds how a level of a map is packed, its faces one below the other: the number of rows of texels
// or blocks, and the bytes of a row. Returns false for a format or level that cannot be packed.
static bool packed_rows(const kiln_map *map, int level, kiln_format format, size_t *rows,
                        size_t *row_bytes)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(format);
    int width, height, faces = map->shape == KILN_SHAPE_CUBE ? 6 : 1;
    *rows = *row_bytes = 0;
    if (!pixel || pixel->rgbx || level < 0 || level >= map->level_count)
        return false;
    ki_level_extent(map, level, &width, &height);
    *row_bytes = (size_t)ki_pixels_size(pixel, width, 1);
    *rows = (size_t)faces * (size_t)((height / faces + pixel->block - 1) / pixel->block);
    return true;
}

size_t kiln_map_packed_size(const kiln_map *map, int level, kiln_format format)
{
    size_t rows, row_bytes;
    packed_rows(map, level, format, &rows, &row_bytes);
    return rows * row_bytes;
}

static kiln_result check_pack(const kiln_map *map, int level, kiln_format format, size_t stride,
                              size_t size, size_t *rows, size_t *row_bytes, kiln_error *error)
{
    kiln_result result = ki_map_check(map, error);
    if (result != KILN_OK)
        return result;
    if (level < 0 || level >= map->level_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "level is %d, it must be less than the map's level count of %d", level,
                       map->level_count);
    if (!packed_rows(map, level, format, rows, row_bytes))
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "format is %d, it must be one of rgba16f, rgba32f, rgb9e5, b10g11r11, bc6h and uastc",
            (int)format);
    stride = stride ? stride : *row_bytes;
    if (stride < *row_bytes)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "row_stride is %zu bytes, it must be at least a row's %zu bytes", stride,
                       *row_bytes);
    size_t before;
    if (!ki_mul_size(*rows - 1, stride, &before) || size < before || size - before < *row_bytes)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the destination has %zu bytes, which are too few for %zu rows of %zu bytes "
                       "that are %zu bytes apart",
                       size, *rows, *row_bytes, stride);
    return KILN_OK;
}

static kiln_result pack_level(kiln_context *context, const kiln_map *map, int level,
                              kiln_format format, uint8_t *bytes, kiln_error *error)
{
    int width, height, faces = map->shape == KILN_SHAPE_CUBE ? 6 : 1;
    ki_level_extent(map, level, &width, &height);
    return ki_pixels_pack(context, ki_pixel_format_of(format), map->level[level], width,
                          height / faces, faces, bytes)
               ? KILN_OK
               : ki_fail_cancelled(error, "packing");
}

kiln_result kiln_map_pack(kiln_context *context, const kiln_map *map, int level, kiln_format format,
                          void *destination, size_t row_stride, size_t destination_size,
                          kiln_error *error)
{
    size_t rows, row_bytes;
    kiln_result result =
        check_pack(map, level, format, row_stride, destination_size, &rows, &row_bytes, error);
    if (result != KILN_OK)
        return result;
    if (!row_stride || row_stride == row_bytes)
        return pack_level(context, map, level, format, destination, error);
    uint8_t *packed = ki_alloc_raw(context, rows, row_bytes);
    if (!packed)
        return ki_fail_memory(context, error, "a packed level", rows * row_bytes);
    result = pack_level(context, map, level, format, packed, error);
    for (size_t i = 0; i < rows && result == KILN_OK; i++)
        memcpy((uint8_t *)destination + i * row_stride, packed + i * row_bytes, row_bytes);
    ki_free(packed);
    return result;
}
