// PlayCanvas: a cube and its levels go in, an atlas of 512 x 512 texels comes out, as a PNG with
// RGBP or as a DDS of halves. The atlas holds equirectangular pictures, each with a border of one
// texel:
//   six unfiltered pictures down the diagonal, from 512 x 256 to 16 x 8;
//   filtered pictures of roughness k / 5 along the left edge, from 256 x 128 to 16 x 8;
//   irradiance / pi, 64 x 32, at (128, 384).
// Larger atlases scale all sizes, the border too. The shader reads level 5 r at roughness r.
// PlayCanvas' own baker filters by roughnesses other than those its shader reads, kiln by the
// shader's. The filtered pictures are drawn so that their bilinear interpolation has the least
// error (picture.h).
//
// PlayCanvas' panoramas have +Z in the centre and -X to the right of the centre.
#include "engine/engine.h"

#include "codec/codec.h"
#include "codec/engine_text.h"
#include "codec/png_text.h"
#include "codec/rgbx.h"
#include "engine/picture.h"
#include "image/image.h"
#include "image/pack.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

enum { ATLAS = 512, LEVELS = 6, STEPS = 12 };

// The level of a cube that one of the atlas's equirectangular pictures shows.
typedef struct view {
    const kiln_map *map;
    int level;
} view;

static double read_picture(const void *data, double u, double v, double rgb[3])
{
    const view *w = data;
    double d[3];
    if (v < 0 || v > 1) { // (u, v) lies beyond the picture's upper or lower edge, across a pole
        v = v < 0 ? -v : 2 - v;
        u += 0.5;
    }
    // Panoramas of PlayCanvas have +Z in the centre and -X to its right: kiln's turned by 180
    // degrees.
    ki_panorama_direction(u - floor(u), v, d);
    const double at[3] = {-d[0], d[1], -d[2]};
    ki_cube_read(w->map, w->level, at, rgb);
    return sqrt(d[0] * d[0] + d[2] * d[2]);
}

// The atlas that is being drawn, and memory for one of its pictures.
typedef struct atlas {
    ki_export *to;
    bool roots;
    float *pixels; // the atlas: size x size x 4 floats
    float *texels; // texels of the atlas's picture that is being drawn
    float *room;   // scratch memory of ki_picture_draw for the picture
    // Level 0 of the cube at smaller sizes: level k of `halves` has 2 << k times fewer texels along
    // an edge.
    kiln_map halves;
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

// Draws one level of a cube as an equirectangular picture into the atlas's rectangle at (x, y),
// `width` wide and half as high, which includes the border. True `sharp`: texels are means over
// their areas; false: texels are refined for bilinear interpolation.
static bool draw(const atlas *a, const kiln_map *map, int level, int x, int y, int width,
                 bool sharp)
{
    int size = a->to->map->size, border = size / ATLAS;
    view shown = {map, level};
    ki_picture p = {.width = width,
                    .height = width / 2,
                    .border = border,
                    .times = sharp || width < size / 4 ? 4 : 2,
                    .roots = a->roots,
                    .read = read_picture,
                    .data = &shown,
                    .texels = a->texels,
                    .room = a->room};
    if (!ki_picture_draw(a->to->context, &p, sharp ? 0 : STEPS))
        return false;
    for (int row = 0; row < width / 2; row++)
        for (int column = 0; column < width; column++) {
            const float *from = p.texels + 3 * ((ptrdiff_t)row * width + column);
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
    // The GGX lobe of roughness 1 is the cosine lobe, so the last level is irradiance / pi, which
    // the shader reads here.
    return good && draw(a, map, LEVELS - 1, 128 * unit, 384 * unit, 64 * unit, false);
}

static kiln_result encode_png(const atlas *a, ki_writer *bytes, kiln_error *error)
{
    int size = a->to->map->size;
    ki_writer text = {.context = a->to->context}, program = text;
    kiln_result result = ki_png_encode(a->pixels, size, size, 4, KI_PNG_PLAIN8, bytes, error);
    ki_engine_text_write(&text, ki_playcanvas.about.name, " layout=atlas format=rgbp", a->to->map);
    ki_write_text(&program, "kiln %s", kiln_version());
    ki_write_u8(&program, 0);
    if (result == KILN_OK && (text.failed || program.failed))
        result = ki_fail_memory(a->to->context, error, "an atlas", text.size);
    if (result == KILN_OK) {
        ki_png_add_text(bytes, 0, "kiln:engine", (const char *)text.bytes);
        ki_png_add_text(bytes, 0, "Software", (const char *)program.bytes);
    }
    ki_writer_free(&text);
    ki_writer_free(&program);
    return result;
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
    // texels: the largest picture, the unfiltered one, covers half of the atlas. room: the largest
    // picture that is refined covers an eighth of the atlas, with 4 samples for each texel.
    a.texels = ki_alloc_raw(to->context, count / 2, 3 * sizeof *a.texels);
    a.room = ki_alloc_raw(to->context, count / 2, 7 * sizeof *a.room);
    if (!a.pixels || !a.texels || !a.room)
        result = ki_fail_memory(to->context, error, "an atlas", count * 9 * sizeof *a.room);
    else if (!draw_all(&a))
        result = ki_fail_cancelled(error, "writing");
    else if (roots)
        result = encode_png(&a, &bytes, error);
    else
        result = ki_dds_encode_atlas(&(kiln_image){(int)size, (int)size, 4, a.pixels, NULL},
                                     ki_playcanvas_dds.about.name, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    ki_free(a.room);
    ki_free(a.texels);
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

// ----------------------------------------------------------------------------------------- reading

// Reads a level of an atlas as the shader does.
static void look_at(const kiln_image *picture, int level, const double d[3], bool roots,
                    float rgb[3])
{
    int size = picture->width, border = size / ATLAS, width = size >> level;
    double u, v;
    const double at[3] = {-d[0], d[1], -d[2]}; // as in read_picture
    ki_direction_panorama(at, &u, &v);
    int height = width / 2;
    ki_atlas_read(picture, border + u * (width - 2 * border),
                  (level ? size - width : 0) + border + v * (height - 2 * border), roots, rgb);
}

static void look_rgbp(const kiln_image *picture, int level, const double d[3], float rgb[3])
{
    look_at(picture, level, d, true, rgb);
}

static void look_halfs(const kiln_image *picture, int level, const double d[3], float rgb[3])
{
    look_at(picture, level, d, false, rgb);
}

static kiln_result read_atlas(kiln_context *context, const kiln_image *picture, bool roots,
                              kiln_map *map, kiln_error *error)
{
    int size = picture->width;
    if (size != picture->height || size < ATLAS || size & (size - 1) || size > KILN_MAX_SIZE / 4)
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "the picture is %d x %d, an atlas of PlayCanvas is square with a side that is "
            "a power of two from %d on",
            picture->width, picture->height, ATLAS);
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = size, .level_count = LEVELS};
    return ki_atlas_fill(context, &ki_playcanvas, picture, roots ? look_rgbp : look_halfs, map,
                         error);
}

static kiln_result read_rgbp(kiln_context *context, const kiln_image *picture, kiln_map *map,
                             kiln_error *error)
{
    return read_atlas(context, picture, true, map, error);
}

static kiln_result read_halfs(kiln_context *context, const kiln_image *picture, kiln_map *map,
                              kiln_error *error)
{
    return read_atlas(context, picture, false, map, error);
}

const ki_recipe ki_playcanvas = {
    .about = {.name = "playcanvas",
              .title = "PlayCanvas 2, .png",
              .files = "NAME.png",
              .ending = "png",
              .mapping = "r = k / 5",
              .tune = true,
              .size = ATLAS,
              .level_count = LEVELS,
              .limit = KI_RGBP_MAX,
              .proof = "pixels of PlayCanvas 2.23.3"},
    .axes = {{0, 1, 2}, {-1, 1, -1}},
    .size_min = ATLAS,
    .size_max = 2 * ATLAS,
    .last_size = 16,
    .level_count_max = LEVELS,
    .roughness = ki_even_roughness,
    .level = ki_even_level,
    .flat = true,
    .write = write_rgbp,
    .read = read_rgbp,
    .unpack = ki_float_from_rgbp,
};

const ki_recipe ki_playcanvas_dds = {
    .about = {.name = "playcanvas-dds",
              .title = "PlayCanvas 2, .dds",
              .files = "NAME.dds",
              .ending = "dds",
              .mapping = "r = k / 5",
              .tune = true,
              .size = ATLAS,
              .level_count = LEVELS,
              .limit = KI_HALF_MAX,
              .proof = "pixels of PlayCanvas 2.23.3"},
    .axes = {{0, 1, 2}, {-1, 1, -1}},
    .size_min = ATLAS,
    .size_max = 2 * ATLAS,
    .last_size = 16,
    .level_count_max = LEVELS,
    .roughness = ki_even_roughness,
    .level = ki_even_level,
    .flat = true,
    .write = write_halfs,
    .read = read_halfs,
};
