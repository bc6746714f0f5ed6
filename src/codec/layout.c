// Makes maps from flat pictures: panoramas, crosses, strips and octahedra, by the ratio of the
// sides or by the caller's choice. A cross or strip is cut into the six faces of a cube. Light
// probes, mirror balls and panoramas that are not two to one, which only the caller can name,
// become panoramas.
#include "codec/layout.h"

#include "codec/report.h"
#include "image/flat.h"
#include "image/mend.h"

#include <string.h>

const char *ki_layout_name(int width, int height)
{
    int64_t w = width, h = height;
    if (w == 2 * h)
        return "panorama";
    if (3 * w == 4 * h || 4 * w == 3 * h)
        return "cross";
    if (w == 6 * h || 6 * w == h)
        return "strip";
    return NULL;
}

bool ki_cut_face(kiln_context *context, const kiln_image *image, int x, int y, int size,
                 bool turned, float *face)
{
    for (int row = 0; row < size; row++) {
        if (!ki_go_on(context))
            return false;
        const float *from =
            image->pixels + 3 * ((size_t)(y + row) * (size_t)image->width + (size_t)x);
        if (!turned) {
            memcpy(face + 3 * (size_t)row * (size_t)size, from, 3 * (size_t)size * sizeof *face);
            continue;
        }
        float *to = face + 3 * ((size_t)(size - 1 - row) * (size_t)size + (size_t)size - 1);
        for (int i = 0; i < size; i++, to -= 3)
            memcpy(to, from + 3 * (size_t)i, 3 * sizeof *to);
    }
    return true;
}

// Place of a cube face in a picture that shows a cross or strip: column and row, counted in faces.
typedef struct face_place {
    int x, y;
} face_place;

// Places of the faces +X -X +Y -Y +Z -Z in each layout. In the tall cross -Z lies below -Y, upside
// down.
static const face_place wide_cross[6] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
static const face_place tall_cross[6] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}};

static kiln_result make_cube(kiln_context *context, const kiln_image *image, int size,
                             const face_place places[6], bool turn_last, kiln_map *map,
                             kiln_error *error)
{
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = size, .level_count = 1};
    kiln_result result = ki_map_allocate(context, map, error);
    size_t face_floats = 3 * (size_t)size * (size_t)size;
    for (int face = 0; face < 6 && result == KILN_OK; face++)
        if (!ki_cut_face(context, image, places[face].x * size, places[face].y * size, size,
                         turn_last && face == 5, map->level[0] + face_floats * (size_t)face))
            result = ki_fail_cancelled(error, "reading");
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}

// Makes a map of one level whose texels are those of the picture; the picture's memory becomes the
// map's.
static kiln_result take_over(kiln_image *image, kiln_shape shape, int size, kiln_map *map)
{
    *map = (kiln_map){.shape = shape, .size = size, .level_count = 1, .owner = image->owner};
    map->level[0] = image->pixels;
    *image = (kiln_image){0};
    return KILN_OK;
}

// Makes a panorama from a light probe, a mirror ball, or a panorama with sides of any ratio.
static kiln_result resample(kiln_context *context, kiln_image *image, const char *name,
                            enum kiln_layout layout, kiln_map *map, kiln_load_report *report,
                            kiln_error *error)
{
    bool ball = layout == KILN_LAYOUT_BALL, stretched = layout == KILN_LAYOUT_PANORAMA;
    kiln_result result = ki_image_mend(context, name, image, report, error);
    if (result == KILN_OK && stretched)
        result = ki_panorama_stretch(context, image, map, error);
    else if (result == KILN_OK)
        result = ki_panorama_from_probe(context, image, ball ? KI_PROBE_BALL : KI_PROBE_ANGULAR,
                                        map, error);
    if (result == KILN_OK)
        ki_note(report, KILN_NOTE_CONVERSION, stretched,
                "the %s of %d x %d texels %s a panorama of %d x %d",
                stretched ? "picture"
                : ball    ? "mirror ball"
                          : "light probe",
                image->width, image->height,
                stretched ? "was stretched over the whole sphere to" : "became", 2 * map->size,
                map->size);
    return result;
}

kiln_result ki_lay_out(kiln_context *context, kiln_image *image, const char *name,
                       enum kiln_layout layout, kiln_map *map, kiln_load_report *report,
                       kiln_error *error)
{
    int64_t w = image->width, h = image->height;
    bool any = layout == KILN_LAYOUT_AUTO;
    if ((any || layout == KILN_LAYOUT_PANORAMA) && w == 2 * h)
        return take_over(image, KILN_SHAPE_PANORAMA, image->height, map);
    if (layout == KILN_LAYOUT_OCTAHEDRON && w == h)
        return take_over(image, KILN_SHAPE_OCTAHEDRON, image->height, map);
    if ((any || layout == KILN_LAYOUT_CROSS) && 3 * w == 4 * h && w % 4 == 0)
        return make_cube(context, image, image->width / 4, wide_cross, false, map, error);
    if ((any || layout == KILN_LAYOUT_CROSS) && 4 * w == 3 * h && w % 3 == 0)
        return make_cube(context, image, image->width / 3, tall_cross, true, map, error);
    if ((any || layout == KILN_LAYOUT_STRIP) && (w == 6 * h || 6 * w == h)) {
        face_place places[6];
        for (int face = 0; face < 6; face++)
            places[face] = w > h ? (face_place){face, 0} : (face_place){0, face};
        return make_cube(context, image, ki_min(image->width, image->height), places, false, map,
                         error);
    }
    if (layout == KILN_LAYOUT_PANORAMA ||
        ((layout == KILN_LAYOUT_PROBE || layout == KILN_LAYOUT_BALL) && w == h))
        return resample(context, image, name, layout, map, report, error);
    static const char *const wanted[] = {
        "2:1 (panorama), 4:3 or 3:4 (cross), 6:1 or 1:6 (strip)",
        "2:1 for a panorama",
        "4:3 or 3:4 for a cross",
        "6:1 or 1:6 for a strip",
        "1:1 for an octahedron",
        "1:1 for a light probe",
        "1:1 for a mirror ball",
    };
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: is %lld x %lld, its sides must be %s%s", name,
                   (long long)w, (long long)h, wanted[layout],
                   any && w == h
                       ? "; if the square is an octahedron, a light probe or a mirror ball, say "
                         "so by the layout"
                   : any ? "; a panorama of other sides is read if the layout says so"
                         : "");
}
