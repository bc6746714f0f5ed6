// The part of OpenEXRCore's interface that exr.c reads headers by, for builds without that library
// (KILN_ALONE). exr_header.c is behind it.
#ifndef KI_ALONE_OPENEXR_H
#define KI_ALONE_OPENEXR_H

#include <stdbool.h>
#include <stdint.h>

typedef int32_t exr_result_t;
enum { EXR_ERR_SUCCESS, EXR_ERR_OUT_OF_MEMORY, EXR_ERR_BAD_HEADER, EXR_ERR_BAD_CHUNK };
enum {
    EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE = 1,
    EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION = 2
};

typedef enum {
    EXR_COMPRESSION_NONE,
    EXR_COMPRESSION_RLE,
    EXR_COMPRESSION_ZIPS,
    EXR_COMPRESSION_ZIP,
    EXR_COMPRESSION_PIZ,
    EXR_COMPRESSION_PXR24,
    EXR_COMPRESSION_B44,
    EXR_COMPRESSION_B44A,
    EXR_COMPRESSION_DWAA,
    EXR_COMPRESSION_DWAB,
    EXR_COMPRESSION_LAST_TYPE
} exr_compression_t;

typedef enum {
    EXR_PIXEL_UINT,
    EXR_PIXEL_HALF,
    EXR_PIXEL_FLOAT,
    EXR_PIXEL_LAST_TYPE
} exr_pixel_type_t;

typedef enum {
    EXR_STORAGE_SCANLINE,
    EXR_STORAGE_TILED,
    EXR_STORAGE_DEEP_SCANLINE,
    EXR_STORAGE_DEEP_TILED
} exr_storage_t;

typedef struct {
    struct {
        int32_t x, y;
    } min, max;
} exr_attr_box2i_t;

typedef struct {
    int32_t length;
    const char *str;
} exr_attr_string_t;

typedef struct {
    exr_attr_string_t name;
    exr_pixel_type_t pixel_type;
    uint8_t p_linear;
    int32_t x_sampling, y_sampling;
} exr_attr_chlist_entry_t;

typedef struct {
    int num_channels;
    exr_attr_chlist_entry_t *entries;
} exr_attr_chlist_t;

typedef enum { EXR_ATTR_OTHER, EXR_ATTR_FLOAT, EXR_ATTR_STRING } exr_attribute_type_t;

typedef struct {
    exr_attribute_type_t type;
    exr_attr_string_t *string;
} exr_attribute_t;

typedef struct {
    int32_t width, height;
    uint64_t data_offset, packed_size;
} exr_chunk_info_t;

typedef struct exr_header *exr_context_t;
typedef const struct exr_header *exr_const_context_t;
typedef exr_result_t (*exr_stream_error_func_ptr_t)(exr_const_context_t context, exr_result_t code,
                                                    const char *format, ...);

struct kiln_context;

typedef struct {
    struct kiln_context *memory; // what the header is allocated by
    void (*error_handler_fn)(exr_const_context_t context, exr_result_t code, const char *message);
    void *user_data;
    int64_t (*read_fn)(exr_const_context_t context, void *user_data, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t error);
    int64_t (*size_fn)(exr_const_context_t context, void *user_data);
    int flags;
} exr_context_initializer_t;
#define EXR_DEFAULT_CONTEXT_INITIALIZER                                                            \
    {                                                                                              \
        0                                                                                          \
    }

#define KI_EXR_MEMORY(init, context) ((init)->memory = (context))

#define exr_start_read ki_exr_start_read
#define exr_finish ki_exr_finish
#define exr_get_default_error_message ki_exr_error_message
#define exr_get_count ki_exr_get_count
#define exr_get_storage ki_exr_get_storage
#define exr_get_channels ki_exr_get_channels
#define exr_get_data_window ki_exr_get_data_window
#define exr_get_display_window ki_exr_get_display_window
#define exr_get_compression ki_exr_get_compression
#define exr_get_chunk_count ki_exr_get_chunk_count
#define exr_get_scanlines_per_chunk ki_exr_get_scanlines_per_chunk
#define exr_get_tile_sizes ki_exr_get_tile_sizes
#define exr_read_scanline_chunk_info ki_exr_read_scanline_chunk_info
#define exr_read_tile_chunk_info ki_exr_read_tile_chunk_info
#define exr_get_attribute_by_name ki_exr_get_attribute_by_name
#define exr_attr_get_float ki_exr_attr_get_float

exr_result_t exr_start_read(exr_context_t *context, const char *name,
                            const exr_context_initializer_t *init);
void exr_finish(exr_context_t *context);
const char *exr_get_default_error_message(exr_result_t code);
exr_result_t exr_get_count(exr_const_context_t h, int *count);
exr_result_t exr_get_storage(exr_const_context_t h, int part, exr_storage_t *storage);
exr_result_t exr_get_channels(exr_const_context_t h, int part, const exr_attr_chlist_t **list);
exr_result_t exr_get_data_window(exr_const_context_t h, int part, exr_attr_box2i_t *box);
exr_result_t exr_get_display_window(exr_const_context_t h, int part, exr_attr_box2i_t *box);
exr_result_t exr_get_compression(exr_const_context_t h, int part, exr_compression_t *compression);
exr_result_t exr_get_chunk_count(exr_const_context_t h, int part, int32_t *count);
exr_result_t exr_get_scanlines_per_chunk(exr_const_context_t h, int part, int32_t *lines);
exr_result_t exr_get_tile_sizes(exr_const_context_t h, int part, int level_x, int level_y,
                                int32_t *width, int32_t *height);
exr_result_t exr_read_scanline_chunk_info(exr_const_context_t h, int part, int y,
                                          exr_chunk_info_t *info);
exr_result_t exr_read_tile_chunk_info(exr_const_context_t h, int part, int x, int y, int level_x,
                                      int level_y, exr_chunk_info_t *info);
exr_result_t exr_get_attribute_by_name(exr_const_context_t h, int part, const char *name,
                                       const exr_attribute_t **attribute);
exr_result_t exr_attr_get_float(exr_const_context_t h, int part, const char *name, float *value);

#endif
