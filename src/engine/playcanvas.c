// PlayCanvas: an atlas of 512 x 512 texels that holds equirectangular pictures, each inside a border:
// six sharp ones down the diagonal, 512 x 256 to 16 x 8; below the first, along the left edge, those
// of roughness k / 5, 256 x 128 to 16 x 8; and 64 x 32 of irradiance / pi at (128, 384). The border is a
// texel; larger atlases scale all of it. The shader reads level 5 r; PlayCanvas itself bakes other
// roughnesses than it reads.
//
// Its panoramas have +Z in the centre and -X to the right of it.
#include "engine/engine.h"

#include "codec/codec.h"
#include "codec/rgbx.h"
#include "image/image.h"
#include "image/pack.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

enum { ATLAS = 512, LEVELS = 6, STEPS = 12 };

static double roughness(int level, int level_count, int size)
{
    (void)size;
    return (double)level / (level_count - 1);
}

static double level(double roughness, int level_count, int size)
{
    (void)size;
    return (level_count - 1) * roughness;
}

// A picture in the atlas. The shader interpolates what is stored, so texels are sought whose interpolation
// is nearest to the level everywhere, and not the level's values at their centres.
typedef struct picture {
    const kiln_map *map;
    int level;
    bool roots;           // what is stored: square roots, or radiance
    int width, height;    // in texels without the border
    int times;            // wanted values along a texel's side
    float *texels;        // height x width x 3
    float *wanted, *rest; // height times x width times x 3
} picture;

// (x, y) of an equirectangular picture, also beyond its edges: x goes around, y over a pole.
static float *texel_at(float *pixels, int width, int height, int x, int y)
{
    if (y < 0 || y >= height) {
        y = y < 0 ? -1 - y : 2 * height - 1 - y;
        x += width / 2;
    }
    x = (x + width) % width;
    return pixels + 3 * ((ptrdiff_t)y * width + x);
}

static void read_row(void *data, int row)
{
    const picture *p = data;
    int width = p->width * p->times, height = p->height * p->times;
    for (int x = 0; x < width; x++) {
        double d[3], rgb[3];
        // +Z in the centre and -X to the right: a panorama of kiln's turned by half.
        ki_panorama_direction((x + 0.5) / width, (row + 0.5) / height, d);
        const double at[3] = {-d[0], d[1], -d[2]};
        ki_cube_read(p->map, p->level, at, rgb);
        float *to = p->wanted + 3 * ((ptrdiff_t)row * width + x);
        for (int c = 0; c < 3; c++)
            to[c] = (float)(p->roots ? sqrt(rgb[c] > 0 ? rgb[c] : 0) : rgb[c]);
    }
}

// Means of radiance.
static void average_row(void *data, int row)
{
    const picture *p = data;
    int width = p->width * p->times;
    for (int x = 0; x < p->width; x++) {
        double sum[3] = {0};
        for (int i = 0; i < p->times * p->times; i++) {
            ptrdiff_t y = (ptrdiff_t)row * p->times + i / p->times;
            ptrdiff_t place = y * width + (ptrdiff_t)x * p->times + i % p->times;
            const float *at = p->wanted + 3 * place;
            for (int c = 0; c < 3; c++)
                sum[c] += (double)(p->roots ? at[c] * at[c] : at[c]);
        }
        float *to = p->texels + 3 * ((ptrdiff_t)row * p->width + x);
        for (int c = 0; c < 3; c++) {
            sum[c] /= p->times * p->times;
            to[c] = (float)(p->roots ? sqrt(sum[c]) : sum[c]);
        }
    }
}

// What is wanted less what is shown, times the solid angle.
static void compare_row(void *data, int row)
{
    const picture *p = data;
    int width = p->width * p->times, height = p->height * p->times;
    double y = (row + 0.5) / p->times - 0.5, v = y - floor(y), sine, cosine;
    ki_sincos(KI_PI * (row + 0.5) / height, &sine, &cosine);
    for (int i = 0; i < width; i++) {
        double x = (i + 0.5) / p->times - 0.5, u = x - floor(x);
        double weight[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
        double shown[3] = {0};
        for (int j = 0; j < 4; j++) {
            const float *at = texel_at(p->texels, p->width, p->height, (int)floor(x) + j % 2,
                                       (int)floor(y) + j / 2);
            for (int c = 0; c < 3; c++)
                shown[c] += weight[j] * (double)at[c];
        }
        ptrdiff_t place = 3 * ((ptrdiff_t)row * width + i);
        for (int c = 0; c < 3; c++)
            p->rest[place + c] = (float)(sine * ((double)p->wanted[place + c] - shown[c]));
    }
}

// Moves texels by the mean of what is left, weighted as they are read: steps toward the least squares.
static void correct_row(void *data, int row)
{
    const picture *p = data;
    int times = p->times, width = p->width * times, height = p->height * times;
    for (int x = 0; x < p->width; x++) {
        double sum[3] = {0}, total = 0;
        for (int j = 0; j < 2 * times; j++) {
            int fy = row * times + j - times / 2;
            double sine, cosine;
            ki_sincos(KI_PI * (fy + 0.5) / height, &sine, &cosine);
            for (int i = 0; i < 2 * times; i++) {
                double weight =
                    (1 - fabs((i + 0.5) / times - 1)) * (1 - fabs((j + 0.5) / times - 1));
                const float *at = texel_at(p->rest, width, height, x * times + i - times / 2, fy);
                for (int c = 0; c < 3; c++)
                    sum[c] += weight * (double)at[c];
                total += weight * fabs(sine);
            }
        }
        float *to = p->texels + 3 * ((ptrdiff_t)row * p->width + x);
        for (int c = 0; c < 3; c++)
            to[c] = (float)ki_clamp((double)to[c] + sum[c] / total, 0, 65504);
    }
}

static bool find_texels(kiln_context *context, picture *p, int steps)
{
    int fine = p->height * p->times;
    bool good = ki_parallel_steps(context, NULL, fine, read_row, p) &&
                ki_parallel_steps(context, NULL, p->height, average_row, p);
    for (int i = 0; i < steps && good; i++)
        good = ki_parallel_steps(context, NULL, fine, compare_row, p) &&
               ki_parallel_steps(context, NULL, p->height, correct_row, p);
    return good;
}

// What the atlas holds, and the picture being drawn.
typedef struct atlas {
    ki_export *to;
    bool roots;
    float *pixels;   // size x size x 4
    float *room;     // for a picture's arrays
    kiln_map halves; // level 0 halved: level k is 2 << k times smaller
} atlas;

static void halve(const kiln_map *map, int level, float *to)
{
    int n = kiln_map_level_size(map, level) / 2;
    for (int i = 0; i < 6 * n * n; i++, to += 3) {
        const float *at = map->level[level] + (ptrdiff_t)3 * (i / n * 4 * n + i % n * 2);
        for (int c = 0; c < 3; c++)
            to[c] = (at[c] + at[3 + c] + at[6 * n + c] + at[6 * n + 3 + c]) / 4;
    }
}

// A rectangle at (x, y), `width` wide and half as high, its border included. Sharp pictures are means
// over their texels.
static bool draw(const atlas *a, const kiln_map *map, int level, int x, int y, int width,
                 bool sharp)
{
    int size = a->to->map->size, border = size / ATLAS;
    picture p = {.map = map,
                 .level = level,
                 .roots = a->roots,
                 .width = width - 2 * border,
                 .height = width / 2 - 2 * border,
                 .times = sharp || width < size / 4 ? 4 : 2};
    size_t texels = (size_t)p.width * (size_t)p.height, fine = (size_t)(p.times * p.times) * texels;
    p.texels = a->room;
    p.wanted = p.texels + 3 * texels;
    p.rest = p.wanted + 3 * fine;
    if (!find_texels(a->to->context, &p, sharp ? 0 : STEPS))
        return false;
    for (int row = 0; row < width / 2; row++)
        for (int column = 0; column < width; column++) {
            const float *from =
                texel_at(p.texels, p.width, p.height, column - border, row - border);
            float *to = a->pixels + 4 * ((ptrdiff_t)(y + row) * size + x + column);
            if (a->roots)
                ki_rgbp_from_float(
                    (const float[3]){from[0] * from[0], from[1] * from[1], from[2] * from[2]}, to);
            else
                memcpy(to, (const float[4]){from[0], from[1], from[2], 1}, 4 * sizeof *to);
        }
    return true;
}

static bool draw_all(const atlas *a)
{
    const kiln_map *map = a->to->map, *halves = &a->halves;
    int size = map->size, unit = size / ATLAS;
    bool good = draw(a, map, 0, 0, 0, size, true);
    for (int k = 1, at = size / 2; k < LEVELS && good; k++) {
        int width = size >> k;
        halve(k == 1 ? map : halves, k == 1 ? 0 : k - 2, halves->level[k - 1]);
        good = draw(a, halves, k - 1, at, at, width, true) &&
               draw(a, map, k, 0, size - width, width, false);
        at += width / 2;
    }
    // What GGX shows at roughness 1 is irradiance / pi.
    return good && draw(a, map, LEVELS - 1, 128 * unit, 384 * unit, 64 * unit, false);
}

// DDS as PlayCanvas reads it: the older header, whose code 113 says four halves.
static void write_dds(const float *pixels, int size, ki_writer *w)
{
    const uint32_t header[32] = {
        0x20534444, 124, 0x100f, (uint32_t)size, (uint32_t)size, 8 * (uint32_t)size,
        [19] = 32,  4,   113,    [27] = 0x1000};
    for (int i = 0; i < 32; i++)
        ki_write_u32(w, header[i]);
    for (ptrdiff_t i = 0; i < 4 * (ptrdiff_t)size * size; i++)
        ki_write_u16(w, ki_half_from_float(pixels[i]));
}

static kiln_result write_atlas(ki_export *to, bool roots, kiln_error *error)
{
    size_t size = (size_t)to->map->size, count = size * size;
    atlas a = {
        .to = to,
        .roots = roots,
        .halves = {.shape = KILN_SHAPE_CUBE, .size = to->map->size / 2, .level_count = LEVELS - 1}};
    ki_writer bytes = {.context = to->context};
    kiln_result result = ki_map_allocate(to->context, &a.halves, error);
    if (result != KILN_OK)
        return result;
    a.pixels = ki_alloc(to->context, count, 4 * sizeof *a.pixels);
    // A picture has at most half of the atlas, and 16 wanted values and rests a texel.
    a.room = ki_alloc_raw(to->context, count / 2 * (1 + 2 * 16), 3 * sizeof *a.room);
    if (!a.pixels || !a.room)
        result = ki_fail_memory(to->context, error, "an atlas", count * 51 * sizeof *a.room);
    else if (!draw_all(&a))
        result = ki_fail_cancelled(error, "writing");
    else if (roots)
        result = ki_png_encode(a.pixels, (int)size, (int)size, 4, KI_PNG_PLAIN8, &bytes, error);
    else
        write_dds(a.pixels, (int)size, &bytes);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    ki_free(a.room);
    ki_free(a.pixels);
    kiln_map_free(&a.halves);
    return result;
}

static kiln_result write_rgbp(ki_export *to, kiln_error *error)
{
    return write_atlas(to, true, error);
}

static kiln_result write_halfs(ki_export *to, kiln_error *error)
{
    return write_atlas(to, false, error);
}

const ki_recipe ki_playcanvas = {
    .about = {.name = "playcanvas",
              .title = "PlayCanvas 2, .png",
              .files = "NAME.png",
              .ending = "png",
              .mapping = "r = k / 5",
              .size = ATLAS,
              .level_count = LEVELS,
              .limit = KI_RGBP_MAX,
              .proof = "pixels of PlayCanvas 2.23.3"},
    .axes = {{0, 1, 2}, {-1, 1, -1}},
    .size_min = ATLAS,
    .size_max = 2 * ATLAS,
    .last_size = 16,
    .level_count_max = LEVELS,
    .roughness = roughness,
    .level = level,
    .write = write_rgbp,
};

const ki_recipe ki_playcanvas_dds = {
    .about = {.name = "playcanvas-dds",
              .title = "PlayCanvas 2, .dds",
              .files = "NAME.dds",
              .ending = "dds",
              .mapping = "r = k / 5",
              .size = ATLAS,
              .level_count = LEVELS,
              .limit = 65504,
              .proof = "pixels of PlayCanvas 2.23.3"},
    .axes = {{0, 1, 2}, {-1, 1, -1}},
    .size_min = ATLAS,
    .size_max = 2 * ATLAS,
    .last_size = 16,
    .level_count_max = LEVELS,
    .roughness = roughness,
    .level = level,
    .write = write_halfs,
};
