// Binary glTF 2.0 with the extension EXT_lights_image_based. In: a cube, harmonics and lights. Out:
// bytes of a file; or of a file that is read, the description or the cube of its first light. A
// file is 12 bytes of header, a chunk of JSON padded with spaces, and a chunk of bytes padded with
// zeros. The images of a light are PNG files in RGBD, level by level, face by face. The extension's
// figure has v upward while glTF has v downward, so images are stored with the bottom row first.
#include "codec/gltf.h"

#include "codec/decimal.h"
#include "codec/file_info.h"
#include "codec/json.h"
#include "codec/rgbx_png.h"
#include "image/image.h"
#include "math/math.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    MAGIC = 0x46546c67,
    VERSION = 2,
    HEADER = 12,
    CHUNK_JSON = 0x4e4f534a,
    CHUNK_BIN = 0x4e4942
};

// Factors from harmonics of radiance to those that a light stores. The extension asks for
// "spherical harmonics coefficients for irradiance": those of radiance times pi, 2 pi / 3 and pi /
// 4 by band. The extension leaves the signs of the basis functions open. kiln uses Sloan's signs
// ("Stupid Spherical Harmonics Tricks", 2008, appendix A2), which Babylon.js reads.
static const double irradiance_factor[9] = {
    KI_PI,         KI_PI *(-2.0 / 3), KI_PI *(2.0 / 3), KI_PI *(-2.0 / 3), KI_PI * 0.25,
    KI_PI * -0.25, KI_PI * 0.25,      KI_PI * -0.25,    KI_PI * 0.25};

// ----------------------------------------------------------------------------------------- writing

static kiln_result write_images(const kiln_map *map, ki_writer *json, ki_writer *images,
                                kiln_error *error)
{
    kiln_result result = KILN_OK;
    ki_write_text(json, "\"bufferViews\":[");
    for (int i = 0; i < 6 * map->level_count && result == KILN_OK; i++) {
        int n = kiln_map_level_size(map, i / 6);
        size_t begin = images->size;
        const kiln_image face = {
            n, n, 3, map->level[i / 6] + 3 * (size_t)(i % 6) * (size_t)n * (size_t)n, NULL};
        result = ki_rgbx_png_encode(&face, ki_rgbd_from_float, true, images, error);
        ki_write_text(json, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", i ? "," : "",
                      begin, images->size - begin);
        ki_write_align(images, 4);
    }
    ki_write_text(json, "],\"buffers\":[{\"byteLength\":%zu}],\"images\":[", images->size);
    for (int i = 0; i < 6 * map->level_count; i++)
        ki_write_text(json, "%s{\"bufferView\":%d,\"mimeType\":\"image/png\"}", i ? "," : "", i);
    ki_write_text(json, "]");
    return result;
}

static void write_light(const kiln_map *map, const kiln_sh *sh, ki_writer *json)
{
    ki_write_text(json, "{\"intensity\":1,\"rotation\":[0,0,0,1],\"irradianceCoefficients\":[");
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++) {
            ki_write_text(json, "%s", c ? "," : i ? ",[" : "[");
            ki_write_number(json, irradiance_factor[i] * sh->c[i][c]);
            ki_write_text(json, c == 2 ? "]" : "");
        }
    ki_write_text(json, "],\"specularImageSize\":%d,\"specularImages\":[", map->size);
    for (int i = 0; i < 6 * map->level_count; i++)
        ki_write_text(json, "%s%d%s", i % 6 ? "," : i ? ",[" : "[", i, i % 6 == 5 ? "]" : "");
    ki_write_text(json, "]}");
}

// Writes the array of a directional light's definition. The extension wants the colour and the
// illuminance of a surface that faces the light apart; their product is the irradiance.
static void write_sun(const kiln_light *light, bool first, ki_writer *json)
{
    const double *e = light->irradiance;
    double most = e[0] > e[1] ? e[0] : e[1];
    most = most > e[2] ? most : e[2];
    ki_write_text(json, "%s{\"type\":\"directional\",\"intensity\":", first ? "" : ",");
    ki_write_number(json, most);
    ki_write_text(json, ",\"color\":[");
    for (int c = 0; c < 3; c++) {
        ki_write_text(json, "%s", c ? "," : "");
        ki_write_number(json, most > 0 ? e[c] / most : 1);
    }
    ki_write_text(json, "]}");
}

// Writes the node of a directional light, which shines along the node's -Z. The quaternion turns +Z
// to the direction d by the shortest way: its axis is Z x d, and its parts before normalisation are
// (-d.y, d.x, 0, 1 + d.z).
static void write_sun_node(const kiln_light *light, int index, ki_writer *json)
{
    const double *d = light->direction;
    double q[4] = {-d[1], d[0], 0, 1 + d[2]};
    double square = q[0] * q[0] + q[1] * q[1] + q[3] * q[3];
    if (!(square > 1e-12)) { // -Z: half a turn about Y
        q[0] = q[3] = 0;
        q[1] = square = 1;
    }
    ki_write_text(json, "%s{\"rotation\":[", index ? "," : "");
    for (int k = 0; k < 4; k++) {
        ki_write_text(json, "%s", k ? "," : "");
        ki_write_number(json, q[k] / sqrt(square));
    }
    ki_write_text(json, "],\"extensions\":{\"KHR_lights_punctual\":{\"light\":%d}}}", index);
}

// Writes the extensions and the scene: the light of the cube, and directional lights as nodes.
static void write_scene(const kiln_map *map, const kiln_sh *sh, const kiln_lights *lights,
                        ki_writer *json)
{
    int count = lights ? lights->count : 0;
    ki_write_text(json, ",\"extensionsUsed\":[\"EXT_lights_image_based\"%s],\"extensions\":{",
                  count ? ",\"KHR_lights_punctual\"" : "");
    for (int i = 0; i < count; i++) {
        ki_write_text(json, "%s", i ? "" : "\"KHR_lights_punctual\":{\"lights\":[");
        write_sun(&lights->light[i], i == 0, json);
    }
    ki_write_text(json, "%s\"EXT_lights_image_based\":{\"lights\":[", count ? "]}," : "");
    write_light(map, sh, json);
    ki_write_text(json, "]}},");
    for (int i = 0; i < count; i++) {
        ki_write_text(json, "%s", i ? "" : "\"nodes\":[");
        write_sun_node(&lights->light[i], i, json);
    }
    ki_write_text(json, "%s\"scene\":0,\"scenes\":[{", count ? "]," : "");
    for (int i = 0; i < count; i++)
        ki_write_text(json, "%s%d%s", i ? "," : "\"nodes\":[", i, i == count - 1 ? "]," : "");
    ki_write_text(json, "\"extensions\":{\"EXT_lights_image_based\":{\"light\":0}}}]}");
}

kiln_result ki_gltf_encode(const kiln_map *map, const kiln_sh *sh, const kiln_lights *lights,
                           ki_writer *w, kiln_error *error)
{
    ki_writer json = {.context = w->context}, images = json;
    ki_write_text(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"kiln %s\"},",
                  kiln_version());
    kiln_result result = write_images(map, &json, &images, error);
    write_scene(map, sh, lights, &json);
    while (json.size % 4 && !json.failed)
        ki_write_u8(&json, ' ');
    const size_t size = HEADER + 8 + json.size + 8 + images.size;
    ki_write_u32(w, MAGIC);
    ki_write_u32(w, VERSION);
    ki_write_u32(w, (uint32_t)size);
    ki_write_u32(w, (uint32_t)json.size);
    ki_write_u32(w, CHUNK_JSON);
    ki_write(w, json.bytes, json.size);
    ki_write_u32(w, (uint32_t)images.size);
    ki_write_u32(w, CHUNK_BIN);
    ki_write(w, images.bytes, images.size);
    if (result == KILN_OK && (w->failed || json.failed || images.failed))
        result = ki_fail_memory(w->context, error, "a glTF file", size);
    ki_writer_free(&json);
    ki_writer_free(&images);
    return result;
}

// ----------------------------------------------------------------------------------------- reading

enum { MOST_IMAGES = 6 * KILN_MAX_LEVELS };

// A file's image of the light: its index among the images of the file, the index of the view of the
// buffer that holds the image, and the place of the view in the buffer.
typedef struct face_image {
    uint32_t image, view, offset, length;
    bool found, placed; // whether the file has such an image, and such a view
} face_image;

// What the JSON of a glTF file says about its first light.
typedef struct light {
    char generator[64];
    int width, level_count;
    // found: the file has a light; uneven: a level of the light has more or fewer than six images
    bool found, uneven;
    int sh_count;
    double sh[9][3];
    // number of bytes from the buffer's beginning to the end of the last image
    uint64_t image_bytes;
    double intensity;
    bool rotated, foreign; // foreign: an image of the light is no PNG file
    // The first images of the light, level by level, face by face.
    int image_count;
    face_image image[MOST_IMAGES];
} light;

static void read_asset(ki_json *j, light *l)
{
    char key[16];
    ki_json_enter_object(j);
    while (ki_json_member(j, key, sizeof key)) {
        if (!strcmp(key, "generator"))
            ki_json_string(j, l->generator, sizeof l->generator);
        else
            ki_json_skip(j);
    }
}

static void read_views(ki_json *j, light *l)
{
    char key[16];
    ki_json_enter_array(j);
    for (uint32_t index = 0; ki_json_item(j); index++) {
        uint64_t offset = 0, length = 0;
        ki_json_enter_object(j);
        while (ki_json_member(j, key, sizeof key)) {
            if (!strcmp(key, "byteOffset"))
                offset = ki_json_count(j, UINT32_MAX);
            else if (!strcmp(key, "byteLength"))
                length = ki_json_count(j, UINT32_MAX);
            else
                ki_json_skip(j);
        }
        if (offset + length > l->image_bytes)
            l->image_bytes = offset + length;
        for (int i = 0; i < l->image_count; i++)
            if (l->image[i].found && l->image[i].view == index) {
                l->image[i].offset = (uint32_t)offset;
                l->image[i].length = (uint32_t)length;
                l->image[i].placed = true;
            }
    }
}

// Reads which views hold the images of the light.
static void read_images(ki_json *j, light *l)
{
    char key[16];
    ki_json_enter_array(j);
    for (uint32_t index = 0; ki_json_item(j); index++) {
        uint32_t view = 0;
        bool has_view = false, foreign = false;
        char type[16];
        ki_json_enter_object(j);
        while (ki_json_member(j, key, sizeof key)) {
            if (!strcmp(key, "bufferView")) {
                view = ki_json_count(j, UINT32_MAX);
                has_view = true;
            } else if (!strcmp(key, "mimeType")) {
                ki_json_string(j, type, sizeof type);
                foreign = strcmp(type, "image/png") != 0;
            } else {
                ki_json_skip(j);
            }
        }
        for (int i = 0; i < l->image_count; i++)
            if (l->image[i].image == index) {
                l->image[i].view = view;
                l->image[i].found = has_view;
                l->foreign |= foreign;
            }
    }
}

static void read_specular(ki_json *j, light *l)
{
    ki_json_enter_array(j);
    while (ki_json_item(j)) {
        int faces = 0;
        ki_json_enter_array(j);
        for (; ki_json_item(j); faces += faces < 7) {
            uint32_t image = ki_json_count(j, UINT32_MAX);
            if (l->image_count < MOST_IMAGES)
                l->image[l->image_count++].image = image;
        }
        l->uneven |= faces != 6;
        l->level_count += l->level_count < INT32_MAX;
    }
}

// Reads a quaternion, of which (0, 0, 0, 1) and (0, 0, 0, -1) rotate nothing.
static void read_rotation(ki_json *j, light *l)
{
    ki_json_enter_array(j);
    for (int i = 0; ki_json_item(j); i += i < 3) {
        double part = ki_json_number(j);
        l->rotated |= i < 3 && fabs(part) > 1e-6;
    }
}

static void read_light(ki_json *j, light *l)
{
    char key[32];
    double unused[3] = {0};
    l->found = true;
    ki_json_enter_object(j);
    while (ki_json_member(j, key, sizeof key)) {
        if (!strcmp(key, "specularImageSize")) {
            l->width = (int)ki_json_count(j, INT32_MAX);
        } else if (!strcmp(key, "specularImages")) {
            read_specular(j, l);
        } else if (!strcmp(key, "irradianceCoefficients")) {
            ki_json_enter_array(j);
            for (; ki_json_item(j); l->sh_count += l->sh_count < 10)
                ki_json_triple(j, l->sh_count < 9 ? l->sh[l->sh_count] : unused);
        } else if (!strcmp(key, "rotation")) {
            read_rotation(j, l);
        } else if (!strcmp(key, "intensity")) {
            l->intensity = ki_json_number(j);
        } else {
            ki_json_skip(j);
        }
    }
}

// Reads the object { "EXT_lights_image_based": { "lights": [ ... ] } }.
static void read_extensions(ki_json *j, light *l, bool inside)
{
    char key[32];
    ki_json_enter_object(j);
    while (ki_json_member(j, key, sizeof key)) {
        if (!inside && !strcmp(key, "EXT_lights_image_based")) {
            read_extensions(j, l, true);
        } else if (inside && !strcmp(key, "lights")) {
            ki_json_enter_array(j);
            while (ki_json_item(j))
                if (l->found)
                    ki_json_skip(j);
                else
                    read_light(j, l);
        } else {
            ki_json_skip(j);
        }
    }
}

typedef void read_part(ki_json *j, light *l);

static void read_own_extensions(ki_json *j, light *l)
{
    read_extensions(j, l, false);
}

// Reads those members of the file's object that `keys` names, each by its function.
static void read_members(ki_json *j, light *l, const char *const *keys, read_part *const *parts,
                         int count)
{
    char key[16];
    ki_json_enter_object(j);
    while (ki_json_member(j, key, sizeof key)) {
        int i = 0;
        while (i < count && strcmp(key, keys[i]) != 0)
            i++;
        if (i < count)
            parts[i](j, l);
        else
            ki_json_skip(j);
    }
}

static kiln_result check(const light *l, size_t binary, const char *name, kiln_error *error)
{
    if (!l->found)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is a glTF file without a light of EXT_lights_image_based, which kiln "
                       "does not describe",
                       name);
    if (l->width < 1 || l->width > KILN_MAX_SIZE || l->level_count < 1 || l->uneven ||
        l->level_count > KILN_MAX_LEVELS || l->width >> (l->level_count - 1) == 0)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: its light has %d levels for faces of size %d; each level must have six "
                       "images, and the smallest level at least one texel",
                       name, l->level_count, l->width);
    if (l->image_bytes > binary)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: its images need %llu bytes of the buffer, which has %zu bytes", name,
                       (unsigned long long)l->image_bytes, binary);
    return KILN_OK;
}

static float roughness_of(int level, int level_count)
{
    return level ? (float)level / (float)(level_count - 1) : 0;
}

static void describe(const light *l, kiln_file_info *info)
{
    snprintf(info->format, sizeof info->format, "glb");
    snprintf(info->encoding, sizeof info->encoding, "rgbd, png");
    snprintf(info->engine, sizeof info->engine, "gltf");
    ki_copy_printable(info->writer, sizeof info->writer,
                      strncmp(l->generator, "kiln ", 5) ? "" : l->generator);
    info->width = info->height = l->width;
    info->face_count = 6;
    info->level_count = l->level_count;
    info->channel_count = 3;
    for (int k = 0; k < l->level_count; k++)
        info->roughness[k] = roughness_of(k, l->level_count);
    info->sh_bands = l->sh_count == 9 ? 3 : 0;
    for (int i = 0; i < 9 && info->sh_bands; i++)
        for (int c = 0; c < 3; c++)
            info->sh[i][c] = ki_info_number(l->sh[i][c] / irradiance_factor[i]);
}

// Returns the bytes of the file's next chunk, or NULL if the type of the chunk is not `type` or the
// file ends.
static const uint8_t *read_chunk(ki_reader *r, uint32_t type, uint32_t *size)
{
    *size = ki_read_u32(r);
    bool good = ki_read_u32(r) == type;
    const uint8_t *bytes = ki_read_bytes(r, *size);
    return good ? bytes : NULL;
}

// The JSON and the bytes of the buffer of a file.
typedef struct chunks {
    const uint8_t *text, *binary;
    uint32_t text_size, binary_size;
} chunks;

static kiln_result read_light_of(kiln_context *context, const uint8_t *bytes, size_t size,
                                 const char *name, chunks *c, light *l, kiln_error *error)
{
    static const char *const keys[] = {"asset", "bufferViews", "extensions"};
    static read_part *const parts[] = {read_asset, read_views, read_own_extensions};
    ki_reader r = ki_reader_make(bytes, size);
    ki_read_u32(&r);
    uint32_t version = ki_read_u32(&r), stated = ki_read_u32(&r);
    c->text = read_chunk(&r, CHUNK_JSON, &c->text_size);
    if (!c->text || version != VERSION || stated > size)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the glTF file is cut off or damaged: its header states version %u and "
                       "%u bytes, the file has %zu bytes",
                       name, version, stated, size);
    *l = (light){.intensity = 1};
    ki_json json = ki_json_make(context, c->text, c->text_size);
    read_members(&json, l, keys, parts, 3);
    if (json.stopped)
        return ki_fail_cancelled(error, "reading");
    if (json.failed)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: its JSON is damaged at byte %zu", name,
                       (size_t)(json.at - (const char *)c->text));
    c->binary = read_chunk(&r, CHUNK_BIN, &c->binary_size);
    if (!c->binary)
        c->binary_size = 0;
    return check(l, c->binary_size, name, error);
}

kiln_result ki_gltf_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                             const char *name, kiln_file_info *info, kiln_error *error)
{
    light l;
    chunks c;
    kiln_result result = read_light_of(context, bytes, size, name, &c, &l, error);
    if (result == KILN_OK)
        describe(&l, info);
    return result;
}

// Finds the places of the images. The JSON may name them after the light, before the light, or in
// any order, and is therefore read once for the images and once for the views that hold these.
static kiln_result find_images(kiln_context *context, const chunks *c, const char *name, light *l,
                               kiln_error *error)
{
    static const char *const keys[] = {"images", "bufferViews"};
    static read_part *const parts[] = {read_images, read_views};
    for (int i = 0; i < 2; i++) {
        ki_json json = ki_json_make(context, c->text, c->text_size);
        read_members(&json, l, &keys[i], &parts[i], 1);
        if (json.stopped)
            return ki_fail_cancelled(error, "reading");
        if (json.failed)
            return ki_fail(error, KILN_ERROR_FORMAT, "%s: its JSON is damaged at byte %zu", name,
                           (size_t)(json.at - (const char *)c->text));
    }
    if (l->foreign)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: its light has images of another format, kiln reads lights of image/png",
                       name);
    for (int i = 0; i < l->image_count; i++)
        if (!l->image[i].placed)
            return ki_fail(error, KILN_ERROR_FORMAT,
                           "%s: image %u of its light does not lie in the buffer of the file", name,
                           l->image[i].image);
    return KILN_OK;
}

static kiln_result check_scale(const light *l, const char *name, kiln_error *error)
{
    if (l->rotated)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: its light is rotated, kiln reads lights without a rotation", name);
    if (!(l->intensity >= 0 && l->intensity <= 1e9))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the intensity of its light is %g, it must be 0 to 1e9", name,
                       l->intensity);
    return KILN_OK;
}

// Multiplies the values of a level by the intensity of the light.
static kiln_result scale_level(kiln_context *context, const kiln_map *map, int level,
                               double intensity, kiln_error *error)
{
    float *value = map->level[level];
    size_t count = intensity != 1 ? 3 * kiln_map_texels(map, level) : 0;
    for (size_t i = 0; i < count; i++) {
        if (i % KI_ASK_EVERY == 0 && !ki_go_on(context))
            return ki_fail_cancelled(error, "reading");
        value[i] = (float)((double)value[i] * intensity);
    }
    return KILN_OK;
}

kiln_result ki_gltf_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, kiln_map *map, kiln_error *error)
{
    light l;
    chunks c;
    *map = (kiln_map){0};
    kiln_result result = read_light_of(context, bytes, size, name, &c, &l, error);
    if (result == KILN_OK)
        result = check_scale(&l, name, error);
    if (result == KILN_OK)
        result = find_images(context, &c, name, &l, error);
    if (result == KILN_OK)
        result = ki_rgbd_png_check_size(l.width, c.binary_size, name, error);
    if (result != KILN_OK)
        return result;
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE, .size = l.width, .level_count = l.level_count};
    result = ki_map_allocate(context, map, error);
    for (int i = 0; i < l.image_count && result == KILN_OK; i++)
        result = ki_rgbd_png_decode_face(context, c.binary + l.image[i].offset, l.image[i].length,
                                         name, i, map, error);
    for (int k = 0; k < map->level_count && result == KILN_OK; k++) {
        map->roughness[k] = roughness_of(k, map->level_count);
        result = scale_level(context, map, k, l.intensity, error);
    }
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}
