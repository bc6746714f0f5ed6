// three.js r150 to r186 and model-viewer: a cube and its levels go in, an atlas called CubeUV comes
// out as an EXR picture, or in blocks of UASTC HDR as a KTX2 picture, which three.js reads from
// r170 on. cube_uv_reflection_fragment.glsl.js is the shader that reads the atlas. Each level
// ("mip" m of M) has six faces with a border of one texel each: +X +Y +Z in a row, and -X -Y -Z in
// the row above. Mips M to 4 have faces of 2^m texels and lie 4 (2^M - 2^m) texels above the
// bottom. Mips 3 to -2 have faces of 16 texels and lie to the right of mip 4. At the base size of
// 256 the atlas has 768 x 1024 texels.
//
// three.js' panoramas have +X in the centre and +Z to the right of the centre.
#include "engine/engine.h"

#include "codec/codec.h"
#include "codec/engine_text.h"
#include "codec/texels.h"
#include "engine/picture.h"
#include "image/image.h"
#include "image/pack.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// FINER: the cube has FINER times as many texels along an edge as the faces of the atlas's largest
// level. LAST: texels along the smallest faces. EXTRA: number of mips below 4. STEPS: number of
// refinement steps of a face for bilinear interpolation.
enum { FINER = 2, LAST = 16, EXTRA = 6, STEPS = 12 };

// Roughness of the atlas's mips 4 to -2, in this order. The mips m above 4 have roughness 2^(-m /
// 2) / 1.16. Both are from three.js' shader function roughnessToMip.
static const double coarse[] = {0.21, 0.305, 0.4, 0.4 + 0.4 / 3, 0.4 + 0.8 / 3, 0.8, 1};

// Returns the number of the atlas's largest mip, M, for a cube of `size`.
static int largest_mip(int size)
{
    int mip = 4;
    while ((FINER * LAST) << (mip - 4) < size)
        mip++;
    return mip;
}

static double roughness(int level, int level_count, int size)
{
    (void)level_count;
    int mip = largest_mip(size) - level;
    if (level == 0)
        return 0;
    return mip > 4 ? ki_exp(-mip * ki_log(2) / 2) / 1.16 : coarse[4 - mip];
}

// Returns the level, with its fraction, that three.js' shader reads. three.js clamps the roughness
// of materials to at least 0.0525.
static double level(double roughness, int level_count, int size)
{
    (void)level_count;
    int most = largest_mip(size);
    double r = fmax(roughness, 0.0525);
    if ((float)r < (float)coarse[0]) // the shader compares in single precision
        return most - ki_clamp(-2 * ki_log(1.16 * r) / ki_log(2), -2, most);
    int k = 0;
    while (k < EXTRA - 1 && r >= coarse[k + 1])
        k++;
    return most - 4 + k + (r - coarse[k]) / (coarse[k + 1] - coarse[k]);
}

typedef struct face {
    const kiln_map *map;
    int level, face;
} face;

// Inverts the function getUV of three.js' shader for one face: the faces are in the order +X +Y +Z
// -X -Y -Z, and v grows upwards.
static double read_picture(const void *data, double u, double v, double rgb[3])
{
    const face *f = data;
    double s = 2 * u - 1, t = 2 * v - 1;
    const double at[6][3] = {{1, t, s},   {-s, 1, -t}, {-s, t, 1},
                             {-1, t, -s}, {-s, -1, t}, {s, t, -1}};
    ki_cube_read(f->map, f->level, at[f->face], rgb);
    double square = 1 + s * s + t * t;
    return 1 / (square * sqrt(square));
}

typedef struct sheet {
    const kiln_map *map;
    int width, height;
    float *pixels; // the atlas: height x width x 3 floats, the upper row first
    float *texels, *room;
} sheet;

static bool draw(kiln_context *context, const sheet *s, int level, int index)
{
    int most = largest_mip(s->map->size), mip = most - level, size = 1 << ki_max(mip, 4);
    int left = index % 3 * size + ki_max(4 - mip, 0) * 3 * LAST;
    int bottom = index / 3 * size + 4 * ((1 << most) - size);
    face f = {s->map, level, index};
    ki_picture p = {.width = size,
                    .height = size,
                    .border = 1,
                    .times = size > LAST ? 2 : 4,
                    .read = read_picture,
                    .data = &f,
                    .texels = s->texels,
                    .room = s->room};
    if (!ki_picture_draw(context, &p, level > 0 ? STEPS : 0))
        return false;
    for (int y = 0; y < size; y++)
        memcpy(s->pixels + 3 * ((ptrdiff_t)(s->height - 1 - bottom - y) * s->width + left),
               s->texels + 3 * (ptrdiff_t)y * size, 3 * sizeof(float) * (size_t)size);
    return true;
}

// Adds the atlas to the files of the export, in the format of the export.
static kiln_result add_sheet(ki_export *to, const sheet *s, kiln_error *error)
{
    ki_writer bytes = {.context = to->context}, text = bytes;
    ki_engine_text_write(&text, ki_three_cubeuv.about.name, " layout=cubeuv", to->map);
    const char *engine = (const char *)text.bytes;
    kiln_result result = KILN_OK;
    if (text.failed)
        result = ki_fail_memory(to->context, error, "a picture", text.size);
    if (result == KILN_OK && to->format == KILN_FORMAT_UASTC) {
        const kiln_save_def def = {.format = to->format, .zstd = ki_export_zstd(to)};
        const kiln_image image = {
            .width = s->width, .height = s->height, .channels = 3, .pixels = s->pixels};
        // KTX2Loader passes the rows on as the file has them, and WebGL's textures begin below.
        result = ki_texels_flip(to->context, s->pixels, s->width, s->height, false, true)
                     ? ki_ktx2_encode_picture(&image, &def, engine, &bytes, error)
                     : ki_fail_cancelled(error, "writing");
    } else if (result == KILN_OK) {
        const ki_exr_options options = {.half = true, .roughness = -1, .engine = engine};
        result = ki_exr_encode(s->pixels, s->width, s->height, 3, &options, &bytes, error);
    }
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&text);
    ki_writer_free(&bytes);
    return result;
}

static kiln_result write_files(ki_export *to, kiln_error *error)
{
    int base = to->map->size / FINER;
    sheet s = {.map = to->map, .width = 3 * ki_max(base, 7 * LAST), .height = 4 * base};
    size_t count = (size_t)s.width * (size_t)s.height, face_count = (size_t)base * (size_t)base;
    kiln_result result = KILN_OK;
    s.pixels = ki_alloc(to->context, count, 3 * sizeof *s.pixels);
    s.texels = ki_alloc_raw(to->context, face_count, 3 * sizeof *s.texels);
    // Scratch memory of ki_picture_draw. The largest face that is refined has a quarter of
    // face_count texels and 4 samples for each texel. A face of 16 x 16 texels has 16 samples for
    // each texel.
    s.room = ki_alloc_raw(to->context, face_count + (size_t)16 * LAST * LAST, 7 * sizeof *s.room);
    bool good = s.pixels && s.texels && s.room;
    if (!good)
        result = ki_fail_memory(to->context, error, "a picture", count * 8 * sizeof *s.pixels);
    for (int i = 0; i < 6 * to->map->level_count && result == KILN_OK; i++)
        if (!draw(to->context, &s, i / 6, i % 6))
            result = ki_fail_cancelled(error, "writing");
    if (result == KILN_OK)
        result = add_sheet(to, &s, error);
    ki_free(s.room);
    ki_free(s.texels);
    ki_free(s.pixels);
    return result;
}

// ----------------------------------------------------------------------------------------- reading

// Reads level k as three.js' shader does: the function getUV of the shader, then one lookup.
static void look(const kiln_image *atlas, int k, const double d[3], float rgb[3])
{
    int most = largest_mip(FINER * atlas->height / 4), mip = most - k, size = 1 << ki_max(mip, 4);
    double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]), s, t;
    int index;
    if (x >= y && x >= z) {
        index = d[0] > 0 ? 0 : 3;
        s = (d[0] > 0 ? d[2] : -d[2]) / x;
        t = d[1] / x;
    } else if (y >= z) {
        index = d[1] > 0 ? 1 : 4;
        s = -d[0] / y;
        t = (d[1] > 0 ? -d[2] : d[2]) / y;
    } else {
        index = d[2] > 0 ? 2 : 5;
        s = (d[2] > 0 ? -d[0] : d[0]) / z;
        t = d[1] / z;
    }
    int column = index % 3, row = index / 3;
    double left = column * size + ki_max(4 - mip, 0) * 3 * LAST;
    double bottom = row * size + 4 * ((1 << most) - size);
    double u = (s + 1) / 2 * (size - 2) + 1, v = (t + 1) / 2 * (size - 2) + 1;
    ki_atlas_read(atlas, left + u, atlas->height - bottom - v, false, rgb);
}

static kiln_result read_atlas(kiln_context *context, const kiln_image *atlas, kiln_map *map,
                              kiln_error *error)
{
    int base = atlas->height / 4;
    if (base < LAST * FINER || base & (base - 1) || atlas->height != 4 * base ||
        atlas->width != 3 * ki_max(base, 7 * LAST) || base > KILN_MAX_SIZE / 4)
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "the picture is %d x %d, an atlas of three.js is 3 n x 4 n with n a power of "
            "two, and at least 336 wide",
            atlas->width, atlas->height);
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE,
                      .size = FINER * base,
                      .level_count = largest_mip(FINER * base) - 4 + 1 + EXTRA,
                      .smallest = FINER * LAST};
    return ki_atlas_fill(context, &ki_three_cubeuv, atlas, look, map, error);
}

const ki_recipe ki_three_cubeuv = {
    .about = {.name = "three-cubeuv",
              .title = "three.js r150 to r186",
              .files = "NAME.exr, or NAME.ktx2 in uastc",
              .ending = "exr",
              .mapping = "r = sqrt(2^(k + 1) / w) / 1.16 below 0.21, then .21 .305 .4 .53 .67 .8 1",
              .tune = true,
              .size = 512,
              .level_count = 11,
              .limit = KI_HALF_MAX,
              .formats = {KILN_FORMAT_RGBA16F, KILN_FORMAT_UASTC},
              .format_reason =
                  "rgba16f: in uastc the file is a quarter as large and the picture errs up to "
                  "1.9 times as much",
              .proof = "pixels of three.js 0.150.1 to 0.186.1"},
    .axes = {{2, 1, 0}, {1, 1, -1}},
    .size_min = 64,
    .size_max = 2048,
    .last_size = FINER * LAST,
    .smallest = FINER * LAST,
    .uastc_ending = "ktx2",
    .flat = true,
    .extra_levels = EXTRA,
    .roughness = roughness,
    .level = level,
    .write = write_files,
    .read = read_atlas,
};
