// Draws the demo's pictures. In: maps, harmonics, tables and errors. Out: RGB pixels for a screen:
// panoramas, unfolded cubes, balls in front of the environment, and error maps.
#include "demo.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// ---------------------------------------------------------------------------------------- a screen

static double luminance(const double c[3])
{
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

// Returns a screen's value for linear radiance: the filmic curve that Narkowicz fitted to ACES
// (2015), then the sRGB curve.
static float screen(double radiance, double exposure)
{
    double x = radiance > 0 ? radiance * exposure : 0;
    x = x < 1e4 ? x : 1e4;
    double y = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    y = y < 1 ? y : 1;
    return (float)(y <= 0.0031308 ? 12.92 * y : 1.055 * pow(y, 1 / 2.4) - 0.055);
}

static void put(kiln_image *image, int x, int y, const double radiance[3], const demo_view *view)
{
    float *pixel =
        image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
    for (int c = 0; c < 3; c++)
        pixel[c] = screen(radiance[c], view->exposure);
    if (image->channels == 4)
        pixel[3] = 1;
}

kiln_result demo_view_choose(kiln_context *context, const kiln_map *panorama,
                             const kiln_spectrum *spectrum, demo_view *view, kiln_error *error)
{
    kiln_map small;
    kiln_result result = kiln_map_convert(context, panorama, KILN_SHAPE_CUBE, 32, 0, &small, error);
    if (result)
        return result;
    double mean[2] = {0};
    size_t count = kiln_map_texels(&small, 0);
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < count; i++) {
            const float *t = small.level[0] + 3 * i;
            double y = luminance((double[3]){(double)t[0], (double)t[1], (double)t[2]});
            mean[pass] += (pass ? log(y + 1e-3 * mean[0] + 1e-30) : y) / (double)count;
        }
    kiln_map_free(&small);
    view->exposure = 0.2 / sqrt((mean[0] + 1e-30) * exp(mean[1]));

    // Harmonics of bands 0 and 1 show from which azimuth most light comes.
    kiln_sh sh;
    result = kiln_spectrum_sh(spectrum, 2, false, 0, 0, &sh, error);
    view->yaw = 0;
    if (!result) {
        double best = 0;
        for (int i = 0; i < 72; i++) {
            double a = i * 2 * pi / 72, value[3];
            kiln_sh_evaluate(&sh, (double[3]){sin(a), 0, cos(a)}, value);
            if (i == 0 || luminance(value) > best) {
                best = luminance(value);
                view->yaw = a + 1.6;
            }
        }
    }
    return result;
}

// ------------------------------------------------------------------------------------------- cubes

// Sets d to the direction of the point (s, t) of a face, not normalised. s and t in [-1, 1] grow to
// the right and down, and the faces lie as OpenGL orients them.
static void face_direction(int face, double s, double t, double d[3])
{
    const double table[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                                {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
    memcpy(d, table[face], sizeof table[face]);
}

static int find_face(const double d[3], double *s, double *t)
{
    double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
    if (x >= y && x >= z) {
        *s = d[0] > 0 ? -d[2] / x : d[2] / x;
        *t = -d[1] / x;
        return d[0] > 0 ? 0 : 1;
    }
    if (y >= z) {
        *s = d[0] / y;
        *t = d[1] > 0 ? d[2] / y : -d[2] / y;
        return d[1] > 0 ? 2 : 3;
    }
    *s = d[2] > 0 ? d[0] / z : -d[0] / z;
    *t = -d[1] / z;
    return d[2] > 0 ? 4 : 5;
}

static int clamp(int value, int high)
{
    return value < 0 ? 0 : value > high ? high : value;
}

// Returns a texel of a face. If (x, y) lies one step outside of the face, returns the nearest texel
// of the neighbouring face.
static const float *texel(const kiln_map *cube, int level, int face, int x, int y)
{
    int n = kiln_map_level_size(cube, level);
    if (x < 0 || y < 0 || x >= n || y >= n) {
        double d[3], s, t;
        face_direction(face, (2 * x + 1.0) / n - 1, (2 * y + 1.0) / n - 1, d);
        face = find_face(d, &s, &t);
        x = clamp((int)floor((s + 1) / 2 * n), n - 1);
        y = clamp((int)floor((t + 1) / 2 * n), n - 1);
    }
    return cube->level[level] +
           3 * (((size_t)face * (size_t)n + (size_t)y) * (size_t)n + (size_t)x);
}

void demo_cube_sample(const kiln_map *cube, int level, const double direction[3], double value[3])
{
    int n = kiln_map_level_size(cube, level);
    double s, t;
    int face = find_face(direction, &s, &t);
    double u = (s + 1) / 2 * n - 0.5, v = (t + 1) / 2 * n - 0.5;
    int x = (int)floor(u), y = (int)floor(v);
    double fx = u - x, fy = v - y;
    const float *a = texel(cube, level, face, x, y), *b = texel(cube, level, face, x + 1, y);
    const float *c = texel(cube, level, face, x, y + 1);
    const float *d = texel(cube, level, face, x + 1, y + 1);
    for (int i = 0; i < 3; i++)
        value[i] = (1 - fy) * ((1 - fx) * (double)a[i] + fx * (double)b[i]) +
                   fy * ((1 - fx) * (double)c[i] + fx * (double)d[i]);
}

// --------------------------------------------------------------------------------------- unfolding

// Column and row of each face in the unfolded cross: -X +Z +X -Z form a row, +Y is above +Z and -Y
// is below +Z.
static const int cross_x[6] = {2, 0, 1, 1, 1, 3}, cross_y[6] = {1, 1, 0, 2, 1, 1};

kiln_result demo_picture_cross(kiln_context *context, const kiln_map *cube, int level, int largest,
                               const demo_view *view, kiln_image *image, kiln_error *error)
{
    int n = kiln_map_level_size(cube, level), step = 1;
    while (n / step > largest)
        step *= 2;
    int edge = n / step;
    kiln_result result = kiln_image_create(context, 4 * edge, 3 * edge, 4, image, error);
    if (result)
        return result;
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < edge; y++)
            for (int x = 0; x < edge; x++) {
                double sum[3] = {0};
                for (int i = 0; i < step * step; i++) {
                    const float *t =
                        texel(cube, level, face, x * step + i % step, y * step + i / step);
                    for (int c = 0; c < 3; c++)
                        sum[c] += (double)t[c] / (step * step);
                }
                put(image, cross_x[face] * edge + x, cross_y[face] * edge + y, sum, view);
            }
    return KILN_OK;
}

const unsigned char demo_error_colors[DEMO_ERROR_COLORS][3] = {
    {11, 16, 44},   {52, 40, 120},  {122, 46, 143}, {197, 63, 112},
    {240, 124, 72}, {250, 196, 84}, {255, 250, 214}};

static void error_color(double relative, float color[3])
{
    double at = relative > 1e-7 ? (log10(relative) + 7) / 7 : 0;
    at = (at < 1 ? at : 1) * (DEMO_ERROR_COLORS - 1);
    int i = at < DEMO_ERROR_COLORS - 2 ? (int)at : DEMO_ERROR_COLORS - 2;
    for (int c = 0; c < 3; c++)
        color[c] = (float)((demo_error_colors[i][c] * (i + 1 - at) +
                            demo_error_colors[i + 1][c] * (at - i)) /
                           255);
}

kiln_result demo_picture_errors(kiln_context *context, const double *errors, int size,
                                kiln_image *image, kiln_error *error)
{
    kiln_result result = kiln_image_create(context, 4 * size, 3 * size, 4, image, error);
    if (result)
        return result;
    for (int i = 0; i < 6 * size * size; i++) {
        int face = i / (size * size), x = i % size, y = i / size % size;
        size_t at = (size_t)(cross_y[face] * size + y) * (size_t)image->width +
                    (size_t)(cross_x[face] * size + x);
        error_color(errors[i], image->pixels + 4 * at);
        image->pixels[4 * at + 3] = 1;
    }
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------- balls

typedef void (*radiance_function)(const void *data, const double direction[3], double value[3]);

static void cube_radiance(const void *data, const double direction[3], double value[3])
{
    const demo_level *at = data;
    demo_cube_sample(at->cube, at->level, direction, value);
}

// Computes irradiance / pi, the radiance that a white matte surface reflects, from harmonics of
// irradiance.
static void sh_irradiance(const void *data, const double direction[3], double value[3])
{
    kiln_sh_evaluate(data, direction, value);
    for (int c = 0; c < 3; c++)
        value[c] /= pi;
}

static void turn(const demo_view *view, const double v[3], double d[3])
{
    double c = cos(view->yaw), s = sin(view->yaw);
    d[0] = c * v[0] + s * v[2];
    d[1] = v[1];
    d[2] = c * v[2] - s * v[0];
}

// Draws a ball over the picture in parallel projection, with soft edges. The eye looks along -z in
// its own frame, which view->yaw turns about +Y.
static void draw_ball(kiln_image *image, double center_x, double center_y, double radius,
                      bool matte, radiance_function radiance, const void *data,
                      const demo_view *view)
{
    enum { SUBPIXELS = 4, BRIGHTEST = 20 };
    int x0 = clamp((int)(center_x - radius - 1), image->width);
    int x1 = clamp((int)(center_x + radius + 2), image->width);
    int y0 = clamp((int)(center_y - radius - 1), image->height);
    int y1 = clamp((int)(center_y + radius + 2), image->height);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            double sum[3] = {0};
            int hits = 0;
            for (int i = 0; i < SUBPIXELS * SUBPIXELS; i++) {
                int column = i % SUBPIXELS, row = i / SUBPIXELS;
                double nx = (x + (column + 0.5) / SUBPIXELS - center_x) / radius;
                double ny = (center_y - y - (row + 0.5) / SUBPIXELS) / radius;
                double rest = 1 - nx * nx - ny * ny;
                if (rest <= 0)
                    continue;
                double nz = sqrt(rest), d[3], value[3];
                const double normal[3] = {nx, ny, nz};
                const double mirrored[3] = {2 * nz * nx, 2 * nz * ny, 2 * nz * nz - 1};
                turn(view, matte ? normal : mirrored, d);
                radiance(data, d, value);
                // The sun's reflection may fill a single subpixel: the limit BRIGHTEST keeps its
                // share of the pixel reasonable.
                for (int c = 0; c < 3; c++)
                    sum[c] += fmin(value[c] * view->exposure, BRIGHTEST);
                hits++;
            }
            float *pixel = image->pixels +
                           ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
            float cover = (float)hits / (SUBPIXELS * SUBPIXELS);
            for (int c = 0; c < 3 && hits; c++) {
                float ball = screen(sum[c] / hits, 1);
                pixel[c] = image->channels == 4 ? ball : (1 - cover) * pixel[c] + cover * ball;
            }
            if (image->channels == 4)
                pixel[3] = cover;
        }
}

static kiln_result picture_ball(kiln_context *context, bool matte, radiance_function radiance,
                                const void *data, int diameter, const demo_view *view,
                                kiln_image *image, kiln_error *error)
{
    kiln_result result = kiln_image_create(context, diameter, diameter, 4, image, error);
    if (!result)
        draw_ball(image, diameter / 2.0, diameter / 2.0, diameter / 2.0 - 0.5, matte, radiance,
                  data, view);
    return result;
}

kiln_result demo_picture_ball(kiln_context *context, demo_level level, bool matte, int diameter,
                              const demo_view *view, kiln_image *image, kiln_error *error)
{
    return picture_ball(context, matte, cube_radiance, &level, diameter, view, image, error);
}

kiln_result demo_picture_sh_ball(kiln_context *context, const kiln_sh *sh, int diameter,
                                 const demo_view *view, kiln_image *image, kiln_error *error)
{
    return picture_ball(context, true, sh_irradiance, sh, diameter, view, image, error);
}

kiln_result demo_picture_row(kiln_context *context, const demo_level *levels, int count, int width,
                             int height, const demo_view *view, kiln_image *image,
                             kiln_error *error)
{
    kiln_result result = kiln_image_create(context, width, height, 3, image, error);
    if (result)
        return result;
    // The background is the environment behind the balls, 70 degrees wide, with the horizon below
    // the middle. It is dimmed, because the rim of a mirror ball reflects exactly this part and
    // would be invisible against it.
    const double reach = tan(35 * pi / 180);
    const demo_view dimmed = {view->exposure / 6, view->yaw};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double ray[3] = {reach * (2 * x + 1.0 - width) / width,
                                   reach * (1.5 * height - 2 * y - 1.0) / width, -1};
            double d[3], value[3];
            turn(view, ray, d);
            demo_cube_sample(levels[2].cube, levels[2].level, d, value);
            put(image, x, y, value, &dimmed);
        }
    double pitch = width / (count + 0.4);
    double radius = 0.45 * pitch < 0.42 * height ? 0.45 * pitch : 0.42 * height;
    for (int k = 0; k < count; k++)
        draw_ball(image, width / 2.0 + (k - (count - 1) / 2.0) * pitch, height / 2.0, radius, false,
                  cube_radiance, &levels[k], view);
    return KILN_OK;
}

// --------------------------------------------------------------------------------------- panoramas

kiln_result demo_picture_panorama(kiln_context *context, const kiln_map *panorama, int height,
                                  const demo_view *view, kiln_image *image, kiln_error *error)
{
    kiln_map small = {0};
    kiln_result result =
        kiln_map_convert(context, panorama, KILN_SHAPE_PANORAMA, height, 0, &small, error);
    if (!result)
        result = kiln_image_create(context, 2 * height, height, 3, image, error);
    for (int y = 0; y < height && !result; y++)
        for (int x = 0; x < 2 * height; x++) {
            const float *t = small.level[0] + 3 * ((size_t)y * 2 * (size_t)height + (size_t)x);
            put(image, x, y, (double[3]){(double)t[0], (double)t[1], (double)t[2]}, view);
        }
    kiln_map_free(&small);
    return result;
}

kiln_result demo_picture_sh(kiln_context *context, const kiln_sh *sh, int height,
                            const demo_view *view, kiln_image *image, kiln_error *error)
{
    kiln_map directions = {0};
    kiln_result result =
        kiln_map_create(context, KILN_SHAPE_PANORAMA, height, 1, &directions, error);
    if (!result)
        result = kiln_image_create(context, 2 * height, height, 3, image, error);
    for (int y = 0; y < height && !result; y++)
        for (int x = 0; x < 2 * height; x++) {
            double d[3], value[3];
            kiln_map_direction(&directions, 0, (size_t)y * 2 * (size_t)height + (size_t)x, d);
            kiln_sh_evaluate(sh, d, value);
            put(image, x, y, value, view);
        }
    kiln_map_free(&directions);
    return result;
}

kiln_result demo_picture_table(kiln_context *context, const kiln_image *table, kiln_image *image,
                               kiln_error *error)
{
    kiln_result result = kiln_image_create(context, table->width, table->height, 3, image, error);
    size_t count = (size_t)table->width * (size_t)table->height;
    for (size_t i = 0; i < count && !result; i++)
        for (int c = 0; c < 2; c++)
            image->pixels[3 * i + (size_t)c] = table->pixels[2 * i + (size_t)c];
    return result;
}
