// Bakes without files. In: pixels in memory. Out: texels packed for a graphics processor, and the
// bytes of a KTX2 file. All memory comes from an allocator that counts.
#include <kiln/kiln.h>

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 256, HEIGHT = 128 };

static void *allocate(void *user, size_t size)
{
    *(size_t *)user += size;
    return aligned_alloc(64, (size + 63) / 64 * 64); // kiln requires an alignment of 64 bytes
}

static void release(void *user, void *memory, size_t size)
{
    *(size_t *)user -= size;
    free(memory);
}

// Draws a sky as a renderer stores it: RGBA floats, bottom row first.
static void draw_sky(float *rgba)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            float up = (float)y / HEIGHT, *pixel = rgba + 4 * ((size_t)y * WIDTH + (size_t)x);
            pixel[0] = up * up;
            pixel[1] = up;
            pixel[2] = 0.5f + up;
            pixel[3] = 1;
        }
}

// Packs each level as rgb9e5 with rows at multiples of 256 bytes, as Direct3D 12 requires. `all`
// receives the total number of bytes.
static kiln_result pack_levels(kiln_context *context, const kiln_map *levels, size_t *all,
                               kiln_error *error)
{
    kiln_result result = KILN_OK;
    for (int k = 0; k < levels->level_count && result == KILN_OK; k++) {
        size_t rows = 6 * (size_t)kiln_map_level_size(levels, k);
        size_t row = kiln_map_packed_size(levels, k, KILN_FORMAT_RGB9E5) / rows;
        size_t stride = (row + 255) / 256 * 256;
        void *upload = malloc(rows * stride);
        if (upload)
            result = kiln_map_pack(context, levels, k, KILN_FORMAT_RGB9E5, upload, stride,
                                   rows * stride, error);
        free(upload); // a real program would upload the texels here
        *all += rows * stride;
    }
    return result;
}

static kiln_result work(kiln_context *context, kiln_error *error)
{
    static float rgba[4 * WIDTH * HEIGHT];
    draw_sky(rgba);
    const ptrdiff_t row = (ptrdiff_t)sizeof(float) * 4 * WIDTH;
    // row 0 of kiln_pixels is the top row, which is the last row of rgba
    kiln_pixels pixels = {.data = rgba + (size_t)4 * WIDTH * (HEIGHT - 1),
                          .width = WIDTH,
                          .height = HEIGHT,
                          .channels = 4,
                          .row_stride = -row};
    kiln_map source = {0};
    kiln_environment made = {0};
    kiln_files files = {0};
    size_t packed = 0;
    kiln_result result = kiln_map_from_pixels(context, &pixels, &source, error);
    if (result == KILN_OK)
        result = kiln_bake(context, &source, NULL, &made, error);
    if (result == KILN_OK)
        result = pack_levels(context, &made.levels, &packed, error);
    if (result == KILN_OK)
        result = kiln_environment_encode(context, &made, "sky.ktx2", NULL, &files, NULL, error);
    if (result == KILN_OK)
        printf("%zu bytes of texels, and %s in %zu bytes; the sky is %.3f bright\n", packed,
               files.file[0].name, files.file[0].size, made.sh.c[0][1] * 0.2820947918);
    kiln_files_free(&files);
    kiln_environment_free(&made);
    kiln_map_free(&source);
    return result;
}

int main(void)
{
    size_t held = 0;
    kiln_error error = {0};
    kiln_context *context = NULL;
    kiln_context_def def = {.allocate = allocate,
                            .release = release,
                            .allocator_user = &held,
                            .memory_limit = 256 << 20,
                            .thread_count = 1};
    if (kiln_context_create(&def, &context, &error) || work(context, &error))
        fprintf(stderr, "memory: %s\n", error.message);
    kiln_context_destroy(context);
    return error.result || held ? 1 : 0;
}
