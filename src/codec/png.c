// PNG by libpng: 8 and 16 bits, every colour type, interlaced or not. Values are sRGB whatever the
// chunks gAMA, cHRM, iCCP and cICP say; alpha is left out.
#include "codec/codec.h"
#include "codec/components.h"
#include "image/pack.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

// Everything that must be released lives here, where longjmp cannot lose it.
typedef struct png_state {
    kiln_context *context;
    const char *name;
    ki_reader reader;
    ki_writer *writer;
    png_structp png;
    png_infop info;
    uint8_t *rows;
    float *table, *pixels;
    bool out_of_memory, cancelled;
    char message[128];
} png_state;

static void fail(png_structp png, png_const_charp message)
{
    png_state *s = png_get_error_ptr(png);
    snprintf(s->message, sizeof s->message, "%s", message);
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    png_state *s = png_get_mem_ptr(png);
    void *memory = ki_alloc_raw(s->context, size, 1);
    s->out_of_memory = s->out_of_memory || !memory;
    return memory;
}

static void release(png_structp png, png_voidp memory)
{
    (void)png;
    ki_free(memory);
}

static void read_bytes(png_structp png, png_bytep to, size_t size)
{
    png_state *s = png_get_io_ptr(png);
    const uint8_t *bytes = ki_read_bytes(&s->reader, size);
    if (!bytes)
        png_error(png, "the file ends too early");
    memcpy(to, bytes, size);
}

static void write_bytes(png_structp png, png_bytep from, size_t size)
{
    png_state *s = png_get_io_ptr(png);
    ki_write(s->writer, from, size);
    if (s->writer->failed) {
        s->out_of_memory = true;
        png_error(png, "out of memory");
    }
}

static void flush(png_structp png)
{
    (void)png;
}

// ----------------------------------------------------------------------------------------- reading

typedef struct png_shape {
    int width, height, depth, color, interlace;
} png_shape;

static kiln_result read_shape(png_state *s, png_shape *shape, kiln_error *error)
{
    png_set_read_fn(s->png, s, read_bytes);
    png_set_user_limits(s->png, 0x7fffffff, 0x7fffffff);
    png_set_chunk_cache_max(s->png, 64);
    png_set_chunk_malloc_max(s->png, 1 << 20);
    png_set_keep_unknown_chunks(s->png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
    png_set_crc_action(s->png, PNG_CRC_ERROR_QUIT, PNG_CRC_QUIET_USE);
    png_read_info(s->png, s->info);
    png_uint_32 width = png_get_image_width(s->png, s->info);
    png_uint_32 height = png_get_image_height(s->png, s->info);
    if (width > KILN_MAX_SIZE || height > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: the picture is %u x %u, the limit is %d",
                       s->name, width, height, KILN_MAX_SIZE);
    *shape =
        (png_shape){(int)width, (int)height, png_get_bit_depth(s->png, s->info),
                    png_get_color_type(s->png, s->info), png_get_interlace_type(s->png, s->info)};
    return KILN_OK;
}

static void describe(const png_shape *shape, kiln_file_info *info)
{
    bool color = shape->color & PNG_COLOR_MASK_COLOR;
    snprintf(info->format, sizeof info->format, "png");
    snprintf(info->encoding, sizeof info->encoding, "%d bits %s%s, srgb%s", shape->depth,
             shape->color & PNG_COLOR_MASK_PALETTE ? "palette"
             : color                               ? "rgb"
                                                   : "grey",
             shape->color & PNG_COLOR_MASK_ALPHA ? " with alpha" : "",
             shape->interlace ? ", interlaced" : "");
    info->width = shape->width;
    info->height = shape->height;
    info->channel_count = color ? 3 : 1;
    info->level_count = 1;
}

// Every value a sample can have, linear.
static bool make_table(png_state *s, bool wide)
{
    int count = wide ? 65536 : 256;
    s->table = ki_alloc_raw(s->context, (size_t)count, sizeof(float));
    for (int i = 0; s->table && i < count; i++)
        s->table[i] = ki_linear_from_srgb((float)i / (float)(count - 1));
    return s->table != NULL;
}

static void put_row(const png_state *s, const uint8_t *row, int width, bool wide, float *rgb)
{
    for (size_t i = 0; i < 3 * (size_t)width; i++)
        rgb[i] = s->table[wide ? row[2 * i] << 8 | row[2 * i + 1] : row[i]];
}

// The part that libpng may leave by a jump.
static kiln_result read_all(png_state *s, kiln_image *image, kiln_file_info *info,
                            kiln_error *error)
{
    png_shape shape = {0};
    kiln_result result = read_shape(s, &shape, error);
    if (result != KILN_OK)
        return result;
    if (info)
        describe(&shape, info);
    if (!image)
        return KILN_OK;

    // Deflate makes a byte into 1032 at most: a short file cannot ask for a huge picture.
    size_t texels = (size_t)shape.width * (size_t)shape.height;
    if (texels / 8 / 1032 > ki_reader_left(&s->reader) + 1024)
        png_error(s->png, "the file is too short for its size");
    png_set_expand(s->png);
    png_set_strip_alpha(s->png);
    png_set_gray_to_rgb(s->png);
    int passes = png_set_interlace_handling(s->png);
    png_read_update_info(s->png, s->info);
    bool wide = png_get_bit_depth(s->png, s->info) == 16;
    size_t row_size = (size_t)shape.width * (wide ? 6 : 3);
    if (png_get_rowbytes(s->png, s->info) != row_size)
        png_error(s->png, "unexpected row size");

    size_t rows = passes > 1 ? (size_t)shape.height : 1;
    s->rows = ki_alloc(s->context, rows, row_size);
    s->pixels = ki_alloc_raw(s->context, texels * 3, sizeof(float));
    if (!s->rows || !s->pixels || !make_table(s, wide)) {
        s->out_of_memory = true;
        png_error(s->png, "out of memory");
    }
    for (int p = 0; p < passes; p++) {
        for (size_t y = 0; y < (size_t)shape.height; y++) {
            uint8_t *row = s->rows + (passes > 1 ? y * row_size : 0);
            png_read_row(s->png, row, NULL);
            if (p == passes - 1)
                put_row(s, row, shape.width, wide, s->pixels + y * (size_t)shape.width * 3);
        }
    }
    *image = (kiln_image){shape.width, shape.height, 3, s->pixels, s->pixels};
    s->pixels = NULL;
    return KILN_OK;
}

static kiln_result say(const png_state *s, kiln_error *error)
{
    if (s->cancelled)
        return ki_fail_cancelled(error, "writing");
    if (s->out_of_memory)
        return ki_fail(error, KILN_ERROR_MEMORY, "out of memory: %s: %s", s->name,
                       s->message[0] ? s->message : "no room for a PNG");
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: the PNG is damaged: %s", s->name, s->message);
}

kiln_result ki_png_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error)
{
    if (image)
        *image = (kiln_image){0};
    kiln_result result;
    png_state *s = ki_alloc(context, 1, sizeof *s);
    if (!s)
        return ki_fail_memory(context, error, name, sizeof *s);
    s->context = context;
    s->name = name;
    s->reader = ki_reader_make(bytes, size);
    s->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, s, fail, ignore, s, allocate, release);
    s->info = s->png ? png_create_info_struct(s->png) : NULL;
    if (!s->info) {
        s->out_of_memory = true;
        result = say(s, error);
    } else if (setjmp(png_jmpbuf(s->png))) {
        result = say(s, error);
    } else {
        result = read_all(s, image, info, error);
    }
    png_destroy_read_struct(&s->png, &s->info, NULL);
    ki_free(s->rows);
    ki_free(s->table);
    ki_free(s->pixels);
    ki_free(s);
    return result;
}

// ----------------------------------------------------------------------------------------- writing

// The linear values from which on each 8-bit sRGB value is the nearest one.
static void make_thresholds(float thresholds[255])
{
    for (int i = 0; i < 255; i++)
        thresholds[i] = ki_linear_from_srgb(((float)i + 0.5f) / 255);
}

static uint8_t to_byte(float value, const float *thresholds)
{
    if (!(value > 0))
        return 0;
    if (value >= 1)
        return 255;
    if (!thresholds)
        return (uint8_t)(value * 255 + 0.5f);
    int low = 0, high = 255; // how many thresholds are reached
    while (low < high) {
        int middle = (low + high) / 2;
        if (value >= thresholds[middle])
            low = middle + 1;
        else
            high = middle;
    }
    return (uint8_t)low;
}

// One row of `count` values; 16 bits are stored with the high byte first.
static void to_row(const float *values, size_t count, ki_png_coding coding, const float *thresholds,
                   uint8_t *row)
{
    for (size_t i = 0; i < count; i++) {
        if (coding != KI_PNG_PLAIN16) {
            row[i] = to_byte(values[i], coding == KI_PNG_SRGB8 ? thresholds : NULL);
            continue;
        }
        uint8_t low_first[2];
        ki_components_pack(KILN_TABLE_FORMAT_U16, values + i, 1, 1, 1, low_first);
        row[2 * i] = low_first[1];
        row[2 * i + 1] = low_first[0];
    }
}

static void write_all(png_state *s, const float *pixels, int width, int height, int channels,
                      ki_png_coding coding)
{
    static const int colors[4] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                  PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    float thresholds[255];
    make_thresholds(thresholds);
    png_set_write_fn(s->png, s, write_bytes, flush);
    png_set_user_limits(s->png, 0x7fffffff, 0x7fffffff);
    int bits = coding == KI_PNG_PLAIN16 ? 16 : 8;
    png_set_IHDR(s->png, s->info, (png_uint_32)width, (png_uint_32)height, bits,
                 colors[channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (coding == KI_PNG_SRGB8)
        png_set_sRGB(s->png, s->info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(s->png, s->info);
    size_t row_size = (size_t)width * (size_t)channels;
    s->rows = ki_alloc_raw(s->context, row_size, 2);
    if (!s->rows) {
        s->out_of_memory = true;
        png_error(s->png, "out of memory");
    }
    for (int y = 0; y < height; y++) {
        if (y % 16 == 0 && !ki_go_on(s->context)) {
            s->cancelled = true;
            png_error(s->png, "cancelled");
        }
        to_row(pixels + (size_t)y * row_size, row_size, coding, thresholds, s->rows);
        png_write_row(s->png, s->rows);
    }
    png_write_end(s->png, s->info);
}

kiln_result ki_png_encode(const float *pixels, int width, int height, int channels,
                          ki_png_coding coding, ki_writer *writer, kiln_error *error)
{
    kiln_result result;
    png_state *s = ki_alloc(writer->context, 1, sizeof *s);
    if (!s)
        return ki_fail_memory(writer->context, error, "a PNG", sizeof *s);
    s->context = writer->context;
    s->name = "a PNG";
    s->writer = writer;
    s->png =
        png_create_write_struct_2(PNG_LIBPNG_VER_STRING, s, fail, ignore, s, allocate, release);
    s->info = s->png ? png_create_info_struct(s->png) : NULL;
    if (!s->info) {
        s->out_of_memory = true;
        result = say(s, error);
    } else if (setjmp(png_jmpbuf(s->png))) {
        result = say(s, error);
    } else {
        write_all(s, pixels, width, height, channels, coding);
        result = KILN_OK;
    }
    png_destroy_write_struct(&s->png, &s->info);
    ki_free(s->rows);
    ki_free(s);
    return result;
}
