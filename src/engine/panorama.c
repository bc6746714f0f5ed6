// Engines that load only a panorama and filter it themselves: Godot's PanoramaSkyMaterial, Unreal's
// sky light, and <model-viewer> and drei's <Environment>, which load JPEG files with gain maps. A
// cube of w texels becomes a panorama of 4w x 2w in kiln's own directions, which is the orientation
// of the panorama that kiln read.
#include "engine/engine.h"

#include "codec/codec.h"
#include "codec/ultra_hdr.h"
#include "image/image.h"
#include "image/pack.h"

static double roughness(int level, int level_count, int size)
{
    (void)level;
    (void)level_count;
    (void)size;
    return 0;
}

static kiln_result write_exr(const kiln_map *p, const char *path, ki_writer *bytes,
                             kiln_error *error)
{
    (void)path;
    ki_exr_options options = {.half = true, .panorama = true, .roughness = -1};
    return ki_exr_encode(p->level[0], 2 * p->size, p->size, 3, &options, bytes, error);
}

static kiln_result write_hdr(const kiln_map *p, const char *path, ki_writer *bytes,
                             kiln_error *error)
{
    (void)path;
    return ki_hdr_encode(p->level[0], 2 * p->size, p->size, bytes, error);
}

static kiln_result write_jpeg(const kiln_map *p, const char *path, ki_writer *bytes,
                              kiln_error *error)
{
    const kiln_image image = {2 * p->size, p->size, 3, p->level[0], NULL};
    return ki_ultra_hdr_encode(&image, path, bytes, error);
}

static kiln_result write_panorama(ki_export *to,
                                  kiln_result (*encode)(const kiln_map *, const char *, ki_writer *,
                                                        kiln_error *),
                                  kiln_error *error)
{
    ki_writer bytes = {.context = to->context};
    kiln_map panorama = {.shape = KILN_SHAPE_PANORAMA, .size = 2 * to->map->size, .level_count = 1};
    kiln_result result = ki_map_allocate(to->context, &panorama, error);
    if (result == KILN_OK)
        result = ki_map_resample(to->context, to->map, 0, &panorama, 0, error);
    if (result == KILN_OK)
        result = encode(&panorama, to->path, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    kiln_map_free(&panorama);
    return result;
}

static kiln_result write_godot(ki_export *to, kiln_error *error)
{
    return write_panorama(to, write_exr, error);
}

static kiln_result write_unreal(ki_export *to, kiln_error *error)
{
    return write_panorama(to, write_hdr, error);
}

static kiln_result write_model_viewer(ki_export *to, kiln_error *error)
{
    return write_panorama(to, write_jpeg, error);
}

// What the recipes have in common: one unfiltered level in kiln's own axes.
#define UNFILTERED                                                                                 \
    .axes = {{0, 1, 2}, {1, 1, 1}}, .size_min = 32, .size_max = 4096, .last_size = 1,              \
    .level_count_max = 1, .roughness = roughness

const ki_recipe ki_godot = {
    .about = {.name = "godot",
              .title = "Godot 3 and 4, which filter by themselves",
              .files = "NAME.exr, a panorama",
              .ending = "exr",
              .mapping = "r = 0, unfiltered",
              .size = 512,
              .level_count = 1,
              .limit = KI_HALF_MAX,
              .proof = "pixels of Godot 3.2.3 and 4.6"},
    UNFILTERED,
    .write = write_godot,
};

const ki_recipe ki_unreal = {
    .about = {.name = "unreal",
              .title = "Unreal Engine, which filters by itself",
              .files = "NAME.hdr, a panorama",
              .ending = "hdr",
              .mapping = "r = 0, unfiltered",
              .size = 512,
              .level_count = 1,
              .limit = 1e38,
              .proof = "manual of Unreal Engine 4.27"},
    UNFILTERED,
    .write = write_unreal,
};

const ki_recipe ki_model_viewer = {
    .about = {.name = "model-viewer",
              .title = "<model-viewer> and drei, which filter by themselves",
              .files = "NAME.jpg, a panorama with a gain map",
              .ending = "jpg",
              .mapping = "r = 0, unfiltered",
              .size = 512,
              .level_count = 1,
              .limit = KI_HALF_MAX,
              .proof = "pixels of <model-viewer> 4.4.0 and drei 10.7.9"},
    UNFILTERED,
    .write = write_model_viewer,
};
