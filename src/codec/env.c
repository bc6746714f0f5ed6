// Babylon.js' .env files. In: a cube and harmonics. Out: bytes of a file; or of a file that is
// read, its description, after a check of the file's size. A file is eight bytes, a JSON manifest
// that ends in NUL, and the images of the cube one after the other, level by level, face by face.
// Images are PNG files in RGBD with the bottom row first.
#include "codec/env.h"

#include "codec/decimal.h"
#include "codec/file_info.h"
#include "codec/json.h"
#include "codec/rgbx_png.h"
#include "math/math.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const uint8_t magic[8] = {0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36};

double ki_env_roughness(int level, double lod_scale, int size)
{
    double slope = ki_exp(level / lod_scale * ki_log(2)) / size;
    return level == 0 ? 0 : slope >= 1 ? 1 : sqrt(fmax(slope - 0.0005, 0));
}

// --------------------------------------------------------------------------------------- harmonics

// Factors between the coefficients of radiance in spherical harmonics and those of the polynomial
// in x, y and z that an .env file stores. Irradiance / pi has the harmonics of radiance times 1,
// 2/3 or 1/4 by band. Babylon.js multiplies the polynomial's coefficients by these numbers and by
// the constants of the basis functions once more, and its shader divides by them
// (SphericalPolynomial.updateFromHarmonics and SphericalHarmonics.FromPolynomial). The constant 1
// is written as x^2 + y^2 + z^2.
static void find_factors(double *k0, double *k1, double *k2, double *k3)
{
    *k0 = sqrt(1 / (4 * KI_PI));
    *k1 = sqrt(3 / (4 * KI_PI)) * 4 / 9;
    *k2 = sqrt(15 / (4 * KI_PI)) / 16;
    *k3 = sqrt(5 / (16 * KI_PI)) / 16;
}

static void make_polynomial(const kiln_sh *sh, double polynomial[9][3])
{
    double k0, k1, k2, k3;
    find_factors(&k0, &k1, &k2, &k3);
    for (int c = 0; c < 3; c++) {
        double one = k0 * sh->c[0][c], z2 = k3 * sh->c[6][c], x2_y2 = k2 / 2 * sh->c[8][c];
        polynomial[0][c] = k1 * sh->c[3][c];
        polynomial[1][c] = k1 * sh->c[1][c];
        polynomial[2][c] = k1 * sh->c[2][c];
        polynomial[3][c] = one - z2 + x2_y2;
        polynomial[4][c] = one - z2 - x2_y2;
        polynomial[5][c] = one + 2 * z2;
        polynomial[6][c] = k2 * sh->c[5][c];
        polynomial[7][c] = k2 * sh->c[7][c];
        polynomial[8][c] = k2 * sh->c[4][c];
    }
}

// Computes radiance in spherical harmonics from an .env file's polynomial. With c, z2 and x2_y2 the
// coefficients of the harmonics 1, 3z^2 - 1 and x^2 - y^2, the polynomial's coefficients of x^2,
// y^2 and z^2 are c - z2 + x2_y2, c - z2 - x2_y2 and c + 2 z2.
static void make_harmonics(double polynomial[9][3], kiln_file_info *info)
{
    double k0, k1, k2, k3;
    find_factors(&k0, &k1, &k2, &k3);
    for (int c = 0; c < 3; c++) {
        double xx = polynomial[3][c], yy = polynomial[4][c], zz = polynomial[5][c];
        const double sh[9] = {
            (xx + yy + zz) / (3 * k0),     polynomial[1][c] / k1, polynomial[2][c] / k1,
            polynomial[0][c] / k1,         polynomial[8][c] / k2, polynomial[6][c] / k2,
            (2 * zz - xx - yy) / (6 * k3), polynomial[7][c] / k2, (xx - yy) / k2};
        for (int i = 0; i < 9; i++)
            info->sh[i][c] = ki_info_number(sh[i]);
    }
    info->sh_bands = 3;
}

static const char *const polynomial_names[9] = {"x", "y", "z", "xx", "yy", "zz", "yz", "zx", "xy"};

// ----------------------------------------------------------------------------------------- writing

static void write_polynomial(ki_writer *w, double polynomial[9][3])
{
    for (int i = 0; i < 9; i++) {
        ki_write_text(w, "%s\"%s\":[", i ? "," : "", polynomial_names[i]);
        for (int c = 0; c < 3; c++) {
            ki_write_text(w, c ? "," : "");
            ki_write_number(w, polynomial[i][c]);
        }
        ki_write_text(w, "]");
    }
}

kiln_result ki_env_encode(const kiln_map *map, double lod_scale, const kiln_sh *sh, ki_writer *w,
                          kiln_error *error)
{
    double polynomial[9][3];
    make_polynomial(sh, polynomial);
    ki_writer images = {.context = w->context};
    kiln_result result = KILN_OK;
    ki_write(w, magic, sizeof magic);
    ki_write_text(w, "{\"version\":2,\"width\":%d,\"imageType\":\"image/png\",\"irradiance\":{",
                  map->size);
    write_polynomial(w, polynomial);
    ki_write_text(w, "},\"specular\":{\"lodGenerationScale\":");
    ki_write_number(w, lod_scale);
    ki_write_text(w, ",\"mipmaps\":[");
    for (int i = 0; i < 6 * map->level_count && result == KILN_OK; i++) {
        int n = kiln_map_level_size(map, i / 6);
        size_t begin = images.size;
        const kiln_image face = {
            n, n, 3, map->level[i / 6] + 3 * (size_t)(i % 6) * (size_t)n * (size_t)n, NULL};
        result = ki_rgbx_png_encode(&face, ki_rgbd_from_float, true, &images, error);
        ki_write_text(w, "%s{\"length\":%zu,\"position\":%zu}", i ? "," : "", images.size - begin,
                      begin);
    }
    ki_write_text(w, "]}}");
    ki_write_u8(w, 0);
    ki_write(w, images.bytes, images.size);
    if (result == KILN_OK && (w->failed || images.failed))
        result = ki_fail_memory(w->context, error, "an .env file", images.size);
    ki_writer_free(&images);
    return result;
}

// ----------------------------------------------------------------------------------------- reading

enum { MOST_IMAGES = 6 * KILN_MAX_LEVELS };

// The values of an .env file's JSON manifest. The images follow the manifest in the file and take
// at least `image_bytes` bytes.
typedef struct manifest {
    int version, width, image_count;
    // Number of bytes from the end of the manifest to the end of the last image.
    uint64_t image_bytes;
    // Place of each image after the manifest, for the first MOST_IMAGES images.
    uint32_t position[MOST_IMAGES], length[MOST_IMAGES];
    double lod_scale;
    char type[32];
    bool has_polynomial;
    double polynomial[9][3];
} manifest;

static void read_polynomial(ki_json *j, manifest *m)
{
    char key[8];
    int found = 0;
    ki_json_enter_object(j);
    while (ki_json_member(j, key, sizeof key)) {
        int i = 0;
        while (i < 9 && strcmp(key, polynomial_names[i]) != 0)
            i++;
        if (i < 9)
            ki_json_triple(j, m->polynomial[i]);
        else
            ki_json_skip(j);
        found |= 1 << i;
    }
    m->has_polynomial = !j->failed && (found & 0x1ff) == 0x1ff;
}

static void read_images(ki_json *j, manifest *m)
{
    char key[16];
    ki_json_enter_array(j);
    while (ki_json_item(j)) {
        uint64_t length = 0, position = 0;
        ki_json_enter_object(j);
        while (ki_json_member(j, key, sizeof key)) {
            if (!strcmp(key, "length"))
                length = ki_json_count(j, UINT32_MAX);
            else if (!strcmp(key, "position"))
                position = ki_json_count(j, UINT32_MAX);
            else
                ki_json_skip(j);
        }
        if (m->image_count < MOST_IMAGES) {
            m->position[m->image_count] = (uint32_t)position;
            m->length[m->image_count] = (uint32_t)length;
        }
        m->image_count += m->image_count < INT32_MAX;
        if (position + length > m->image_bytes)
            m->image_bytes = position + length;
    }
}

static void read_specular(ki_json *j, manifest *m)
{
    char key[24];
    ki_json_enter_object(j);
    while (ki_json_member(j, key, sizeof key)) {
        if (!strcmp(key, "lodGenerationScale"))
            m->lod_scale = ki_json_number(j);
        else if (!strcmp(key, "mipmaps"))
            read_images(j, m);
        else
            ki_json_skip(j);
    }
}

static void read_manifest(ki_json *j, manifest *m)
{
    char key[16];
    ki_json_enter_object(j);
    while (ki_json_member(j, key, sizeof key)) {
        if (!strcmp(key, "version"))
            m->version = (int)ki_json_count(j, INT32_MAX);
        else if (!strcmp(key, "width"))
            m->width = (int)ki_json_count(j, INT32_MAX);
        else if (!strcmp(key, "imageType"))
            ki_json_string(j, m->type, sizeof m->type);
        else if (!strcmp(key, "irradiance"))
            read_polynomial(j, m);
        else if (!strcmp(key, "specular"))
            read_specular(j, m);
        else
            ki_json_skip(j);
    }
}

static kiln_result check(const manifest *m, size_t left, const char *name, kiln_error *error)
{
    if (m->version < 1 || m->version > 2)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: is an .env file of version %d, kiln reads the versions 1 and 2", name,
                       m->version);
    if (m->width < 1 || m->width > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: faces are %d wide, they must be 1 to %d",
                       name, m->width, KILN_MAX_SIZE);
    int levels = m->image_count / 6;
    if (levels < 1 || m->image_count % 6 || levels > KILN_MAX_LEVELS ||
        m->width >> (levels - 1) == 0)
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "%s: has %d images for faces of size %d, it must have six images for each level", name,
            m->image_count, m->width);
    if (m->image_bytes > left)
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "%s: its images need %llu bytes after the manifest, but only %zu bytes follow it", name,
            (unsigned long long)m->image_bytes, left);
    return KILN_OK;
}

static void describe(manifest *m, kiln_file_info *info)
{
    const char *slash = strchr(m->type, '/');
    snprintf(info->format, sizeof info->format, "env");
    snprintf(info->encoding, sizeof info->encoding, "rgbd, %s", slash ? slash + 1 : "png");
    snprintf(info->engine, sizeof info->engine, "babylon");
    info->width = info->height = m->width;
    info->face_count = 6;
    info->level_count = m->image_count / 6;
    info->channel_count = 3;
    for (int k = 0; k < info->level_count && m->lod_scale >= 0.1 && m->lod_scale <= 10; k++)
        info->roughness[k] = (float)ki_env_roughness(k, m->lod_scale, m->width);
    if (m->has_polynomial)
        make_harmonics(m->polynomial, info);
}

// Reads the manifest, and sets *images to the bytes after it.
static kiln_result read_file(kiln_context *context, const uint8_t *bytes, size_t size,
                             const char *name, manifest *m, const uint8_t **images,
                             kiln_error *error)
{
    const uint8_t *from = bytes + sizeof magic;
    const uint8_t *end = size > sizeof magic ? memchr(from, 0, size - sizeof magic) : NULL;
    if (!end)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the manifest does not end within the file's %zu bytes", name, size);
    *m = (manifest){.lod_scale = 0.8}; // the level scale that Babylon.js uses if a file states none
    ki_json json = ki_json_make(context, from, (size_t)(end - from));
    read_manifest(&json, m);
    if (json.stopped)
        return ki_fail_cancelled(error, "reading");
    if (json.failed)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the manifest is damaged at byte %zu", name,
                       (size_t)(json.at - (const char *)bytes));
    *images = end + 1;
    return check(m, size - (size_t)(end + 1 - bytes), name, error);
}

kiln_result ki_env_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                            const char *name, kiln_file_info *info, kiln_error *error)
{
    manifest m;
    const uint8_t *images;
    kiln_result result = read_file(context, bytes, size, name, &m, &images, error);
    if (result == KILN_OK)
        describe(&m, info);
    return result;
}

bool ki_env_begins(const uint8_t *bytes, size_t size)
{
    return size >= sizeof magic && !memcmp(bytes, magic, sizeof magic);
}

kiln_result ki_env_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_map *map, kiln_error *error)
{
    manifest m = {0};
    const uint8_t *images = NULL;
    *map = (kiln_map){0};
    kiln_result result = read_file(context, bytes, size, name, &m, &images, error);
    if (result == KILN_OK && m.type[0] && strcmp(m.type, "image/png") != 0)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: its images are %s, kiln reads .env files of image/png", name, m.type);
    if (result == KILN_OK)
        result = ki_rgbd_png_check_size(m.width, m.image_bytes, name, error);
    if (result != KILN_OK)
        return result;
    *map = (kiln_map){.shape = KILN_SHAPE_CUBE,
                      .size = m.width,
                      .level_count = ki_min(m.image_count / 6, KILN_MAX_LEVELS)};
    result = ki_map_allocate(context, map, error);
    for (int i = 0; i < 6 * map->level_count && result == KILN_OK; i++)
        result = ki_rgbd_png_decode_face(context, images + m.position[i], m.length[i], name, i, map,
                                         error);
    for (int k = 0; k < map->level_count; k++)
        map->roughness[k] = (float)ki_env_roughness(k, m.lod_scale, m.width);
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}
