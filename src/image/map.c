// Where the texels of each shape lie on the sphere, and the memory they lie in.
#include "image/image.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

const char *const ki_face_names[6] = {"px", "nx", "py", "ny", "pz", "nz"};

// ---------------------------------------------------------------------------------------- geometry

void ki_face_direction(int face, double s, double t, double direction[3])
{
    double *d = direction;
    switch (face) {
    case 0: // +X
        d[0] = 1, d[1] = -t, d[2] = -s;
        break;
    case 1: // -X
        d[0] = -1, d[1] = -t, d[2] = s;
        break;
    case 2: // +Y
        d[0] = s, d[1] = 1, d[2] = t;
        break;
    case 3: // -Y
        d[0] = s, d[1] = -1, d[2] = -t;
        break;
    case 4: // +Z
        d[0] = s, d[1] = -t, d[2] = 1;
        break;
    default: // -Z
        d[0] = -s, d[1] = -t, d[2] = -1;
        break;
    }
}

int ki_direction_face(const double direction[3], double *s, double *t)
{
    double x = direction[0], y = direction[1], z = direction[2];
    double ax = fabs(x), ay = fabs(y), az = fabs(z);
    if (ax >= ay && ax >= az && ax > 0) {
        *s = x > 0 ? -z / ax : z / ax;
        *t = -y / ax;
        return x > 0 ? 0 : 1;
    }
    if (ay >= az && ay > 0) {
        *s = x / ay;
        *t = y > 0 ? z / ay : -z / ay;
        return y > 0 ? 2 : 3;
    }
    if (az > 0) {
        *s = z > 0 ? x / az : -x / az;
        *t = -y / az;
        return z > 0 ? 4 : 5;
    }
    *s = *t = 0;
    return 0;
}

void ki_panorama_direction(double u, double v, double direction[3])
{
    double sin_theta, cos_theta, sin_phi, cos_phi;
    ki_sincos(KI_PI * v, &sin_theta, &cos_theta);
    ki_sincos(2 * KI_PI * (u - 0.5), &sin_phi, &cos_phi);
    direction[0] = sin_theta * sin_phi;
    direction[1] = cos_theta;
    direction[2] = -sin_theta * cos_phi;
}

void ki_direction_panorama(const double direction[3], double *u, double *v)
{
    double x = direction[0], y = direction[1], z = direction[2];
    *u = ki_clamp(0.5 + ki_atan2(x, -z) / (2 * KI_PI), 0, 1);
    *v = ki_clamp(ki_atan2(sqrt(x * x + z * z), y) / KI_PI, 0, 1);
}

// The octahedron |x| + |y| + |z| = 1 from above: its upper half fills the inner diamond, with +X to
// the right and +Z downwards as on the cube's +Y face; the four lower sides are folded out, so that
// -Y is in every corner.
void ki_octahedron_direction(double u, double v, double direction[3])
{
    double x = 2 * u - 1, z = 2 * v - 1;
    double y = 1 - fabs(x) - fabs(z);
    if (y < 0) {
        double folded = copysign(1 - fabs(z), x);
        z = copysign(1 - fabs(x), z);
        x = folded;
    }
    double length = sqrt(x * x + y * y + z * z);
    direction[0] = x / length;
    direction[1] = y / length;
    direction[2] = z / length;
}

void ki_direction_octahedron(const double direction[3], double *u, double *v)
{
    double sum = fabs(direction[0]) + fabs(direction[1]) + fabs(direction[2]);
    double x = 0, z = 0;
    if (sum > 0) {
        x = direction[0] / sum;
        z = direction[2] / sum;
    }
    if (direction[1] < 0) {
        double folded = copysign(1 - fabs(z), x);
        z = copysign(1 - fabs(x), z);
        x = folded;
    }
    *u = ki_clamp(0.5 * x + 0.5, 0, 1);
    *v = ki_clamp(0.5 * z + 0.5, 0, 1);
}

// The angle of a panorama's column grows by `degrees`: x = sin, z = -cos of that angle. Quarter
// turns are exact.
void ki_turn(const double direction[3], double degrees, double turned[3])
{
    double rest = fmod(degrees, 360), sine, cosine;
    double quarter = floor(rest / 90);
    ki_sincos((rest - 90 * quarter) * (KI_PI / 180), &sine, &cosine);
    for (int k = (int)quarter & 3; k > 0; k--) {
        double swap = sine;
        sine = cosine;
        cosine = -swap;
    }
    double x = direction[0], z = direction[2];
    turned[0] = x * cosine - z * sine;
    turned[1] = direction[1];
    turned[2] = z * cosine + x * sine;
}

// ------------------------------------------------------------------------------------------ memory

static const char *const shape_names[] = {
    [KILN_SHAPE_PANORAMA] = "panorama",
    [KILN_SHAPE_CUBE] = "cube",
    [KILN_SHAPE_OCTAHEDRON] = "octahedron",
};

static kiln_result check_numbers(const kiln_map *map, kiln_error *error)
{
    if ((int)map->shape < KILN_SHAPE_PANORAMA || map->shape > KILN_SHAPE_OCTAHEDRON)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "shape is %d, it must be %d to %d",
                       (int)map->shape, KILN_SHAPE_PANORAMA, KILN_SHAPE_OCTAHEDRON);
    if (map->size < 1 || map->size > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s size is %d, it must be 1 to %d",
                       shape_names[map->shape], map->size, KILN_MAX_SIZE);
    if (map->smallest < 0 || map->smallest > map->size)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "smallest is %d, it must be 0 to the size, %d",
                       map->smallest, map->size);
    if (map->level_count < 1 || map->level_count > KILN_MAX_LEVELS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "level_count is %d, it must be 1 to %d",
                       map->level_count, KILN_MAX_LEVELS);
    return KILN_OK;
}

kiln_result ki_map_check(const kiln_map *map, kiln_error *error)
{
    if (check_numbers(map, error))
        return KILN_ERROR_ARGUMENT;
    for (int k = 0; k < map->level_count; k++)
        if (!map->level[k])
            return ki_fail(error, KILN_ERROR_ARGUMENT, "level %d of %d of the %s is NULL", k,
                           map->level_count, shape_names[map->shape]);
    return KILN_OK;
}

void ki_level_extent(const kiln_map *map, int level, int *width, int *height)
{
    int n = ki_max(ki_max(1, map->smallest), map->size >> level);
    *width = map->shape == KILN_SHAPE_PANORAMA ? 2 * n : n;
    *height = map->shape == KILN_SHAPE_CUBE ? 6 * n : n;
}

// Floats of a level, rounded up so that the next one is aligned to 64 bytes.
static bool level_floats(const kiln_map *map, int level, size_t *count)
{
    int width, height;
    ki_level_extent(map, level, &width, &height);
    if (!ki_mul_size((size_t)width, (size_t)height, count) || !ki_mul_size(*count, 3, count) ||
        *count > SIZE_MAX / sizeof(float) - 16)
        return false;
    *count = (*count + 15) & ~(size_t)15;
    return true;
}

enum { PIECE = 1 << 20 }; // floats

typedef struct clear_job {
    float *memory;
    size_t count;
} clear_job;

static void clear_piece(void *data, int index)
{
    const clear_job *job = data;
    size_t first = (size_t)index * PIECE, left = job->count - first;
    memset(job->memory + first, 0, (left < PIECE ? left : PIECE) * sizeof(float));
}

kiln_result ki_map_allocate(kiln_context *context, kiln_map *map, kiln_error *error)
{
    memset(map->level, 0, sizeof map->level);
    map->owner = NULL;
    if (check_numbers(map, error)) {
        *map = (kiln_map){0};
        return KILN_ERROR_ARGUMENT;
    }
    size_t offset[KILN_MAX_LEVELS], total = 0;
    bool fits = true;
    for (int k = 0; k < map->level_count; k++) {
        size_t count = 0;
        offset[k] = total;
        fits = fits && level_floats(map, k, &count) && total <= SIZE_MAX / sizeof(float) - count;
        total += count;
    }
    float *memory = fits ? ki_alloc_raw(context, total, sizeof(float)) : NULL;
    if (!memory) {
        *map = (kiln_map){0};
        return ki_fail_memory(context, error, "a map", fits ? total * sizeof(float) : SIZE_MAX);
    }
    // Memory is slow to come by where there is much of it.
    clear_job job = {memory, total};
    if (!ki_parallel_steps(context, NULL, (int)((total + PIECE - 1) / PIECE), clear_piece, &job)) {
        ki_free(memory);
        *map = (kiln_map){0};
        return ki_fail_cancelled(error, "making a map");
    }
    for (int k = 0; k < map->level_count; k++)
        map->level[k] = memory + offset[k];
    map->owner = memory;
    return KILN_OK;
}

kiln_result ki_image_allocate(kiln_context *context, kiln_image *image, kiln_error *error)
{
    enum { LIMIT = 6 * KILN_MAX_SIZE }; // a strip of six faces
    kiln_image made = *image;
    *image = (kiln_image){0};
    if (made.width < 1 || made.width > LIMIT || made.height < 1 || made.height > LIMIT)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "image is %d x %d, each side must be 1 to %d",
                       made.width, made.height, LIMIT);
    if (made.channels < 1 || made.channels > 4)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "image has %d channels, it must be 1 to 4",
                       made.channels);
    size_t count = 0, bytes = 0;
    bool fits = ki_mul_size((size_t)made.width, (size_t)made.height, &count) &&
                ki_mul_size(count, (size_t)made.channels, &count) &&
                ki_mul_size(count, sizeof(float), &bytes);
    made.pixels = fits ? ki_alloc(context, count, sizeof(float)) : NULL;
    if (!made.pixels)
        return ki_fail_memory(context, error, "an image", fits ? bytes : SIZE_MAX);
    made.owner = made.pixels;
    *image = made;
    return KILN_OK;
}

// Texel (x, y) of a face, which may lie one beyond its edge: then it is the neighbour's that is
// nearest.
static size_t texel_at(int n, int face, int x, int y)
{
    if (x < 0 || y < 0 || x >= n || y >= n) {
        double direction[3], s, t;
        ki_face_direction(face, (2 * x + 1.0) / n - 1, (2 * y + 1.0) / n - 1, direction);
        face = ki_direction_face(direction, &s, &t);
        x = (int)ki_clamp(floor((s + 1) / 2 * n), 0, n - 1);
        y = (int)ki_clamp(floor((t + 1) / 2 * n), 0, n - 1);
    }
    return ((size_t)face * (size_t)n + (size_t)y) * (size_t)n + (size_t)x;
}

void ki_cube_taps(int size, const double direction[3], size_t texels[4], double weights[4])
{
    double s, t;
    int face = ki_direction_face(direction, &s, &t);
    double u = (s + 1) / 2 * size - 0.5, v = (t + 1) / 2 * size - 0.5;
    int x = (int)floor(u), y = (int)floor(v);
    u -= x;
    v -= y;
    for (int i = 0; i < 4; i++) {
        texels[i] = texel_at(size, face, x + i % 2, y + i / 2);
        weights[i] = (i % 2 ? u : 1 - u) * (i / 2 ? v : 1 - v);
    }
}

void ki_cube_read(const kiln_map *cube, int level, const double direction[3], double rgb[3])
{
    size_t texels[4];
    double w[4];
    ki_cube_taps(kiln_map_level_size(cube, level), direction, texels, w);
    for (int c = 0; c < 3; c++) {
        const float *from = cube->level[level] + c;
        rgb[c] = (w[0] * (double)from[3 * texels[0]] + w[1] * (double)from[3 * texels[1]]) +
                 (w[2] * (double)from[3 * texels[2]] + w[3] * (double)from[3 * texels[3]]);
    }
}
