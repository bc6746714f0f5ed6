// The three loops that textbooks and courses on image-based lighting teach: irradiance by a regular
// grid of angles, prefiltering by GGX importance sampling, and the split-sum table. In: a panorama,
// or nothing for the table, and sample counts. Out: levels of a map, or the table. The loops read
// unfiltered texels, with the addressing and the samples that are taught, so that their errors can
// be measured. docs/theory/textbook.md derives the loops and lists their errors.
//
// The textbook's coordinate axes are kiln's after a quarter turn about +Y: the textbook's (x, y, z)
// is kiln's (z, y, -x). In both, a column of a panorama is then the same fraction of the picture's
// width.
#include "brdf/brdf.h"
#include "image/image.h"
#include "math/math.h"

#include <kiln/course.h>
#include <math.h>
#include <string.h>

enum { ROWS = 16 }; // number of rows between two reports of progress

static void cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalize(double a[3])
{
    double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int c = 0; c < 3; c++)
        a[c] /= length;
}

// Returns the texel of a direction d in the textbook's axes. Its column is u (width - 1), cut to a
// whole number, with u in [0, 1]. Therefore the last column and the last row are read only where u
// or v is exactly 1, and the picture is stretched by width / (width - 1).
static const float *nearest(const kiln_map *panorama, const double d[3])
{
    int height = panorama->size, width = 2 * height;
    double phi = ki_atan2(d[2], d[0]);
    double u = (phi < 0 ? phi + 2 * KI_PI : phi) / (2 * KI_PI);
    double v = ki_acos(ki_clamp(d[1], -1, 1)) / KI_PI;
    int x = ki_min((int)(u * (width - 1)), width - 1);
    int y = ki_min((int)(v * (height - 1)), height - 1);
    return panorama->level[0] + 3 * ((size_t)y * (size_t)width + (size_t)x);
}

// Sets d to the direction, in the textbook's axes, that a texel of the filtered map stands for. On
// a panorama column i is at u = i / (width - 1) and row j at v = j / (height - 1). A level of one
// row, for which v is 0 / 0, uses the horizon. Other shapes use kiln's texel centres.
static void look_direction(const kiln_map *map, int level, int x, int row, int width, double d[3])
{
    if (map->shape == KILN_SHAPE_PANORAMA) {
        int height = width / 2;
        double phi = 2 * KI_PI * x / (width - 1);
        double theta = height > 1 ? KI_PI * row / (height - 1) : KI_PI / 2;
        double sin_theta, cos_theta, sin_phi, cos_phi;
        ki_sincos(theta, &sin_theta, &cos_theta);
        ki_sincos(phi, &sin_phi, &cos_phi);
        d[0] = sin_theta * cos_phi;
        d[1] = cos_theta;
        d[2] = sin_theta * sin_phi;
    } else {
        double k[3];
        kiln_map_direction(map, level, (size_t)row * (size_t)width + (size_t)x, k);
        d[0] = k[2];
        d[1] = k[1];
        d[2] = -k[0];
    }
}

// Runs row(data, i) for all rows of a level in parallel, in batches of ROWS, and reports progress
// between `from` and `to` after each batch. *first_row is the first row of the batch, to which
// tasks add their index.
static kiln_result run_rows(kiln_context *context, const char *stage, int row_count,
                            void (*row)(void *data, int index), void *data, int *first_row,
                            double from, double to, kiln_error *error)
{
    for (*first_row = 0; *first_row < row_count; *first_row += ROWS) {
        if (!ki_progress(context, stage, from + (to - from) * *first_row / row_count))
            return ki_fail_cancelled(error, stage);
        ki_parallel_for(context, ki_min(ROWS, row_count - *first_row), row, data);
    }
    return ki_progress(context, stage, to) ? KILN_OK : ki_fail_cancelled(error, stage);
}

// -------------------------------------------------------------------------------------- irradiance

typedef struct irradiance {
    const kiln_map *panorama;
    kiln_map *map;
    int width, first_row;
    int phi_count, theta_count;
    double (*phi)[2], (*theta)[2]; // sine and cosine of each angle of the grid
} irradiance;

// Sets texel[] to the irradiance E over pi of a surface with the normal `up`, by a sum over a grid
// of angles:
//
//     E / pi = 1/pi integral L cos theta dw
//            ~ pi / (n1 n2) sum over i, j of L(phi_i, theta_j) cos theta_j sin theta_j
//
// with phi_i = 2 pi i / n1 and theta_j = (pi / 2) j / n2, where n1 is phi_count, n2 is theta_count
// and L is the radiance of the panorama.
static void irradiance_texel(const irradiance *r, const double up[3], float texel[3])
{
    double front[3] = {0, 0, 1}, right[3];
    // The tangent frame needs another axis than z where `up` is along z. The textbook tests up.z
    // without the absolute value, and divides 0 by 0 at up = -z.
    if (!(fabs(up[2]) < 0.999)) {
        front[1] = -1;
        front[2] = 0;
    }
    cross(up, front, right);
    normalize(right);
    cross(right, up, front);
    normalize(front);

    double sum[3] = {0};
    for (int i = 0; i < r->phi_count; i++) {
        double side[3];
        for (int c = 0; c < 3; c++)
            side[c] = right[c] * r->phi[i][1] + front[c] * r->phi[i][0];
        for (int j = 0; j < r->theta_count; j++) {
            double sine = r->theta[j][0], cosine = r->theta[j][1], d[3];
            for (int c = 0; c < 3; c++)
                d[c] = side[c] * sine + up[c] * cosine;
            const float *l = nearest(r->panorama, d);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)l[c] * (cosine * sine);
        }
    }
    double scale = KI_PI / ((double)r->phi_count * r->theta_count);
    for (int c = 0; c < 3; c++)
        texel[c] = (float)(sum[c] * scale);
}

static void irradiance_row(void *data, int index)
{
    const irradiance *r = data;
    int row = r->first_row + index;
    float *texel = r->map->level[0] + 3 * (size_t)row * (size_t)r->width;
    for (int x = 0; x < r->width; x++, texel += 3) {
        double up[3];
        look_direction(r->map, 0, x, row, r->width, up);
        irradiance_texel(r, up, texel);
    }
}

// Fills level 0 of an allocated map with irradiance / pi. Each texel of the map is a sum over a
// grid of phi_count x theta_count directions, in which the panorama is read.
static kiln_result fill_irradiance(kiln_context *context, const kiln_map *panorama, int phi_count,
                                   int theta_count, kiln_map *map, kiln_error *error)
{
    irradiance r = {
        .panorama = panorama, .map = map, .phi_count = phi_count, .theta_count = theta_count};
    size_t steps = (size_t)phi_count + (size_t)theta_count;
    r.phi = ki_alloc_raw(context, steps, sizeof *r.phi);
    if (!r.phi)
        return ki_fail_memory(context, error, "the textbook's steps", steps * sizeof *r.phi);
    r.theta = r.phi + phi_count;
    for (int i = 0; i < phi_count; i++)
        ki_sincos(2 * KI_PI * i / phi_count, &r.phi[i][0], &r.phi[i][1]);
    for (int j = 0; j < theta_count; j++)
        ki_sincos(KI_PI / 2 * j / theta_count, &r.theta[j][0], &r.theta[j][1]);

    int row_count;
    ki_level_extent(map, 0, &r.width, &row_count);
    kiln_result result = run_rows(context, "textbook irradiance", row_count, irradiance_row, &r,
                                  &r.first_row, 0, 1, error);
    map->roughness[0] = 1;
    ki_free(r.phi);
    return result;
}

// --------------------------------------------------------------------------------------- prefilter

typedef struct prefilter {
    const kiln_map *panorama;
    kiln_map *map;
    int level, width, first_row;
    int sample_count;   // number of light directions, which are above the horizon
    double (*light)[3]; // light directions in a frame whose z axis is the normal
    double weight_sum;  // sum of n.l over the light directions
} prefilter;

// Computes the light directions and weights that prefilter a level. In a frame whose z axis is a
// texel's normal the directions are the same for every texel, because the method takes normal, view
// and reflection as equal.
static void set_lights(prefilter *r, double roughness, int sample_count)
{
    r->sample_count = 0;
    r->weight_sum = 0;
    for (int i = 0; i < sample_count; i++) {
        double xi[2], h[3];
        ki_hammersley((uint32_t)i, (uint32_t)sample_count, xi);
        ki_ggx_half_vector(roughness * roughness, xi, h);
        // The light is the view v = (0, 0, 1) mirrored by h: l = 2 (v.h) h - v.
        double nol = 2 * h[2] * h[2] - 1;
        if (!(nol > 0))
            continue;
        double *l = r->light[r->sample_count++];
        l[0] = 2 * h[2] * h[0];
        l[1] = 2 * h[2] * h[1];
        l[2] = nol;
        r->weight_sum += nol;
    }
}

static void prefilter_row(void *data, int index)
{
    const prefilter *r = data;
    int row = r->first_row + index;
    float *texel = r->map->level[r->level] + 3 * (size_t)row * (size_t)r->width;
    for (int x = 0; x < r->width; x++, texel += 3) {
        double n[3], t[3], b[3], up[3] = {0, 0, 1}, sum[3] = {0};
        look_direction(r->map, r->level, x, row, r->width, n);
        if (!(fabs(n[2]) < 0.999)) {
            up[0] = 1;
            up[2] = 0;
        }
        cross(up, n, t);
        normalize(t);
        cross(n, t, b);
        for (int i = 0; i < r->sample_count; i++) {
            const double *l = r->light[i];
            double d[3];
            for (int c = 0; c < 3; c++)
                d[c] = t[c] * l[0] + b[c] * l[1] + n[c] * l[2];
            const float *radiance = nearest(r->panorama, d);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)radiance[c] * l[2];
        }
        for (int c = 0; c < 3; c++)
            texel[c] = (float)(sum[c] / r->weight_sum);
    }
}

// Fills all levels of an allocated map with the panorama filtered by GGX. Level k of n gets the
// roughness k / (n - 1), and a single level the roughness 0.
static kiln_result fill_levels(kiln_context *context, const kiln_map *panorama, int sample_count,
                               kiln_map *map, kiln_error *error)
{
    kiln_result result = KILN_OK;
    prefilter r = {.panorama = panorama, .map = map};
    r.light = ki_alloc_raw(context, (size_t)sample_count, sizeof *r.light);
    if (!r.light)
        return ki_fail_memory(context, error, "the textbook's samples",
                              (size_t)sample_count * sizeof *r.light);
    // Progress is counted in texels, because the levels differ in size: each has a quarter of the
    // texels of the level before.
    double from = 0, total = 0, texels[KILN_MAX_LEVELS] = {0};
    for (int k = 0; k < map->level_count; k++)
        total += texels[k] = (double)kiln_map_texels(map, k);
    for (int k = 0; k < map->level_count && !result; k++) {
        double roughness = map->level_count > 1 ? (double)k / (map->level_count - 1) : 0;
        map->roughness[k] = (float)roughness;
        set_lights(&r, roughness, sample_count);
        r.level = k;
        int row_count;
        ki_level_extent(map, k, &r.width, &row_count);
        double to = from + texels[k] / total;
        result = run_rows(context, "textbook prefilter", row_count, prefilter_row, &r, &r.first_row,
                          from, ki_clamp(to, 0, 1), error);
        from = to;
    }
    ki_free(r.light);
    return result;
}

// ------------------------------------------------------------------------------------------- table

typedef struct brdf_table {
    kiln_image *image;
    int sample_count, first_row;
} brdf_table;

// Estimates A and B of the split sum (albedo = F0 A + B; Karis 2013). With half vectors h of
// density D(h) (n.h), A is the mean over the samples of 1 - F5, and B the mean of F5, each times
//
//     G(l, v) (v.h) / ((n.v) (n.h)),      F5 = (1 - v.h)^5.
//
// G is Schlick's masking with k = roughness^2 / 2. texel[0] is A, texel[1] is B.
static void brdf_texel(double roughness, double nov, int sample_count, float texel[2])
{
    double alpha = roughness * roughness, k = ki_schlick_k_ibl(alpha);
    double v[2] = {sqrt((1 - nov) * (1 + nov)), nov}, a = 0, b = 0; // x and z of the view direction
    for (int i = 0; i < sample_count; i++) {
        double xi[2], h[3];
        ki_hammersley((uint32_t)i, (uint32_t)sample_count, xi);
        ki_ggx_half_vector(alpha, xi, h);
        double voh = v[0] * h[0] + v[1] * h[2];
        double nol = 2 * voh * h[2] - v[1];
        if (!(nol > 0))
            continue;
        voh = ki_clamp(voh, 0, 1);
        nol = ki_clamp(nol, 0, 1);
        double visible = ki_smith_g_schlick(k, nov, nol) * voh / (h[2] * nov);
        double f5 = ki_schlick_fresnel(voh);
        a += (1 - f5) * visible;
        b += f5 * visible;
    }
    texel[0] = (float)(a / sample_count);
    texel[1] = (float)(b / sample_count);
}

static void brdf_row(void *data, int index)
{
    const brdf_table *r = data;
    int row = r->first_row + index, size = r->image->width;
    double roughness = (double)(size - 1 - row) / (size - 1);
    float *texel = r->image->pixels + 2 * (size_t)row * (size_t)size;
    for (int x = 0; x < size; x++, texel += 2) {
        // At n.v = 0 the textbook divides 0 by 0. The first column of the table takes the value at
        // n.v = 1e-4, which differs from the limit by about 1e-4.
        double nov = x > 0 ? (double)x / (size - 1) : 1e-4;
        brdf_texel(roughness, nov, r->sample_count, texel);
    }
}

// Fills an allocated table of size x size texels and two channels with A and B of the split sum.
static kiln_result fill_split_sum(kiln_context *context, int sample_count, kiln_image *table,
                                  kiln_error *error)
{
    brdf_table r = {.image = table, .sample_count = sample_count};
    return run_rows(context, "textbook table", table->height, brdf_row, &r, &r.first_row, 0, 1,
                    error);
}

// ---------------------------------------------------------------------------------------- textbook

enum { MAX_STEPS = 1 << 16, MAX_SAMPLES = 1 << 20, MAX_TABLE = 4096 };

static kiln_result check_count(const char *name, int count, int limit, kiln_error *error)
{
    if (count < 0 || count > limit)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s is %d, it must be 1 to %d, or 0", name,
                       count, limit);
    return KILN_OK;
}

// Prepares a filtering by a textbook's method: checks `panorama` and the definition `given` (NULL
// for all defaults), writes the definition with its zeros replaced by default sizes and counts to
// *def, and allocates the map for the filtered light.
static kiln_result start(kiln_context *context, const kiln_map *panorama,
                         const kiln_textbook_def *given, int level_count, kiln_textbook_def *def,
                         kiln_map *map, kiln_error *error)
{
    kiln_result result = ki_map_check_panorama(panorama, error);
    *map = (kiln_map){0};
    *def = given ? *given : (kiln_textbook_def){0};
    if (!result)
        result = check_count("phi_count", def->phi_count, MAX_STEPS, error);
    if (!result)
        result = check_count("theta_count", def->theta_count, MAX_STEPS, error);
    if (!result)
        result = check_count("sample_count", def->sample_count, MAX_SAMPLES, error);
    if (result)
        return result;
    if (def->shape == KILN_SHAPE_AUTO)
        def->shape = KILN_SHAPE_PANORAMA;
    def->size = def->size ? def->size : 64;
    def->phi_count = def->phi_count ? def->phi_count : 100;
    def->theta_count = def->theta_count ? def->theta_count : 100;
    def->sample_count = def->sample_count ? def->sample_count : 1024;
    return kiln_map_create(context, def->shape, def->size, level_count, map, error);
}

kiln_result kiln_textbook_irradiance(kiln_context *context, const kiln_map *panorama,
                                     const kiln_textbook_def *def, kiln_map *map, kiln_error *error)
{
    kiln_textbook_def d;
    kiln_result result = start(context, panorama, def, 1, &d, map, error);
    if (!result)
        result = fill_irradiance(context, panorama, d.phi_count, d.theta_count, map, error);
    if (result)
        kiln_map_free(map);
    return result;
}

kiln_result kiln_textbook_prefilter(kiln_context *context, const kiln_map *panorama,
                                    const kiln_textbook_def *def, kiln_map *map, kiln_error *error)
{
    kiln_textbook_def d;
    kiln_result result = start(context, panorama, def, def ? def->level_count : 0, &d, map, error);
    if (!result)
        result = fill_levels(context, panorama, d.sample_count, map, error);
    if (result)
        kiln_map_free(map);
    return result;
}

kiln_result kiln_textbook_brdf(kiln_context *context, int size, int sample_count, kiln_image *table,
                               kiln_error *error)
{
    *table = (kiln_image){0};
    if (size < 2 || size > MAX_TABLE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "size of the table is %d, it must be 2 to %d",
                       size, MAX_TABLE);
    kiln_result result = check_count("sample_count", sample_count, MAX_SAMPLES, error);
    if (!result)
        result = kiln_image_create(context, size, size, 2, table, error);
    if (!result)
        result = fill_split_sum(context, sample_count ? sample_count : 1024, table, error);
    if (result)
        kiln_image_free(table);
    return result;
}
