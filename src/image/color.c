// Conversion of colours to Rec. 709. In: chromaticities of primaries and white, or CIE XYZ. Out: a
// 3 x 3 matrix for linear values, or a picture converted by such a matrix. Method: the primaries'
// XYZ are scaled so that their sum is the white with Y = 1 (SMPTE RP 177). White is adapted by the
// Bradford transform: XYZ become the responses of three cones, each of which is multiplied by the
// ratio of both whites' responses (ICC.1:2022, annex E).
#include "image/color.h"

#include "base/vector.h"
#include "image/convert.h"

#include <math.h>
#include <string.h>

const ki_primaries ki_rec709 = {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}};
const ki_primaries ki_rec2020 = {{0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}};
const ki_primaries ki_p3_d65 = {{0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}};
const double ki_white_e[2] = {1.0 / 3, 1.0 / 3};
// the white D50 of ICC.1, whose X, Y, Z are 0.9642, 1, 0.8249
const double ki_white_d50[2] = {0.9642 / 2.7891, 1 / 2.7891};

static const ki_matrix3 bradford = {
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

// -------------------------------------------------------------------------------------- matrices

bool ki_matrix_is_identity(const ki_matrix3 *matrix)
{
    for (int i = 0; i < 9; i++)
        if (matrix->m[i / 3][i % 3] != (i % 4 == 0))
            return false;
    return true;
}

ki_matrix3 ki_matrix_multiply(const ki_matrix3 *a, const ki_matrix3 *b)
{
    ki_matrix3 p;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            p.m[i][k] = a->m[i][0] * b->m[0][k] + a->m[i][1] * b->m[1][k] + a->m[i][2] * b->m[2][k];
    return p;
}

static void apply(const ki_matrix3 *a, const double v[3], double product[3])
{
    double sum[3];
    for (int i = 0; i < 3; i++)
        sum[i] = a->m[i][0] * v[0] + a->m[i][1] * v[1] + a->m[i][2] * v[2];
    memcpy(product, sum, sizeof sum);
}

// Inverts a matrix by its cofactors. Returns false if the magnitude of the determinant is below
// 1e-9 or not a number.
static bool invert(const ki_matrix3 *a, ki_matrix3 *inverse)
{
    double c[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
            c[k][i] = a->m[i1][k1] * a->m[i2][k2] - a->m[i1][k2] * a->m[i2][k1];
        }
    double determinant = a->m[0][0] * c[0][0] + a->m[0][1] * c[1][0] + a->m[0][2] * c[2][0];
    if (!(fabs(determinant) >= 1e-9))
        return false;
    for (int i = 0; i < 9; i++)
        inverse->m[i / 3][i % 3] = c[i / 3][i % 3] / determinant;
    return true;
}

// ---------------------------------------------------------------------------------------- colours

// Sets the XYZ of a chromaticity with Y = 1. Returns false if y is not positive.
static bool white_xyz(const double xy[2], double xyz[3])
{
    xyz[0] = xy[0] / xy[1];
    xyz[1] = 1;
    xyz[2] = (1 - xy[0] - xy[1]) / xy[1];
    return xy[1] > 1e-3 && fabs(xyz[0]) < 1e3 && fabs(xyz[2]) < 1e3;
}

// Sets the matrix from linear RGB to XYZ, in which (1, 1, 1) is the white with Y = 1.
static bool xyz_from_rgb(const ki_primaries *primaries, ki_matrix3 *matrix)
{
    const double *xy = primaries->xy;
    ki_matrix3 columns, inverse;
    double white[3], scale[3];
    for (int c = 0; c < 3; c++) {
        columns.m[0][c] = xy[2 * (size_t)c];
        columns.m[1][c] = xy[2 * (size_t)c + 1];
        columns.m[2][c] = 1 - columns.m[0][c] - columns.m[1][c];
    }
    if (!white_xyz(xy + 6, white) || !invert(&columns, &inverse))
        return false;
    apply(&inverse, white, scale);
    for (int c = 0; c < 3; c++) {
        if (!(scale[c] > 1e-6 && scale[c] < 1e6))
            return false;
        for (int i = 0; i < 3; i++)
            matrix->m[i][c] = columns.m[i][c] * scale[c];
    }
    return true;
}

// Sets the matrix, from XYZ to XYZ, that adapts colours seen under the white `from` to the white of
// Rec. 709.
static bool adapt(const double from[2], ki_matrix3 *matrix)
{
    double cones_from[3], cones_to[3];
    ki_matrix3 scaled, back;
    if (!white_xyz(from, cones_from) || !white_xyz(ki_rec709.xy + 6, cones_to) ||
        !invert(&bradford, &back))
        return false;
    apply(&bradford, cones_from, cones_from);
    apply(&bradford, cones_to, cones_to);
    for (int i = 0; i < 3; i++) {
        if (!(cones_from[i] > 1e-3))
            return false;
        for (int k = 0; k < 3; k++)
            scaled.m[i][k] = bradford.m[i][k] * (cones_to[i] / cones_from[i]);
    }
    *matrix = ki_matrix_multiply(&back, &scaled);
    return true;
}

static bool rec709_from_xyz(const double white[2], ki_matrix3 *matrix)
{
    ki_matrix3 to_xyz, from_xyz, adapted;
    if (!adapt(white, &adapted) || !xyz_from_rgb(&ki_rec709, &to_xyz) ||
        !invert(&to_xyz, &from_xyz))
        return false;
    *matrix = ki_matrix_multiply(&from_xyz, &adapted);
    return true;
}

bool ki_rec709_from_xyz(const double white[2], ki_matrix3 *matrix)
{
    *matrix = (ki_matrix3){0};
    return rec709_from_xyz(white, matrix);
}

bool ki_luminance_weights(const ki_primaries *primaries, double weights[3])
{
    ki_matrix3 to_xyz = {0};
    bool good = xyz_from_rgb(primaries, &to_xyz);
    for (int c = 0; c < 3; c++)
        weights[c] = good ? to_xyz.m[1][c] : 0;
    return good;
}

static bool is_rec709(const double *xy, const double *neutral)
{
    for (int i = 0; i < 8; i++) {
        double value = neutral && i >= 6 ? neutral[i - 6] : xy[i];
        if (!(fabs(value - ki_rec709.xy[i]) <= 2e-4) || !(fabs(xy[i] - ki_rec709.xy[i]) <= 2e-4))
            return false;
    }
    return true;
}

bool ki_rec709_from_rgb(const ki_primaries *primaries, const double *neutral, ki_matrix3 *matrix)
{
    static const ki_matrix3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const double *xy = primaries->xy;
    ki_matrix3 to_xyz, from_xyz;
    bool same = is_rec709(xy, neutral);
    bool good = same || (xyz_from_rgb(primaries, &to_xyz) &&
                         rec709_from_xyz(neutral ? neutral : xy + 6, &from_xyz));
    *matrix = same ? identity : good ? ki_matrix_multiply(&from_xyz, &to_xyz) : (ki_matrix3){0};
    return good;
}

// --------------------------------------------------------------------------------------- pictures

typedef struct transform_job {
    kiln_context *context;
    const ki_matrix3 *matrix;
    kiln_image *image;
} transform_job;

// Multiplies a texel by the matrix. Products beyond the largest float become this float. A texel
// with a channel that is not finite stays as it is.
static void transform_texel(const ki_matrix3 *matrix, float rgb[3])
{
    double color[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]};
    if (!isfinite(rgb[0]) || !isfinite(rgb[1]) || !isfinite(rgb[2]))
        return;
    apply(matrix, color, color);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)ki_clamp(color[c], -(double)FLT_MAX, (double)FLT_MAX);
}

void ki_row_transform(kiln_context *context, const ki_matrix3 *matrix, float *rgb, int width)
{
    ki_transform_texels *transform_texels = KI_FASTEST(context, ki_transform_texels);
    for (int x = 0; x < width;) {
        x += (int)transform_texels(matrix, rgb + 3 * (size_t)x, (size_t)(width - x));
        for (int end = ki_min(x + KI_TRANSFORMED, width); x < end; x++)
            transform_texel(matrix, rgb + 3 * (size_t)x);
    }
}

// Task of one thread: multiplies the colours of one row by the matrix.
static void transform_row(void *data, int row)
{
    const transform_job *job = data;
    int width = job->image->width;
    ki_row_transform(job->context, job->matrix,
                     job->image->pixels + 3 * (size_t)width * (size_t)row, width);
}

bool ki_image_transform(kiln_context *context, const ki_matrix3 *matrix, kiln_image *image)
{
    transform_job job = {context, matrix, image};
    return ki_parallel_steps(context, NULL, image->height, transform_row, &job);
}
