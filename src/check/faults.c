// Faults that show in the texels of levels. In: levels and the exact levels. Out: sentences.
//
// Shifts: if a level has its texels beside their places, its error is a shift times the slope of
// the exact level. The shift of least square error is found for two kinds: one shift (x, y) in
// texels for all faces of a cube, and a small turn about each axis. A kind is named if it explains
// a good part of the error of most levels, and about the same shift in each.
//
// Clamped light: light is missing, and nearly all of what is missing is missing where the exact
// level is many times as bright as its mean.
#include "check/check.h"

#include "image/texel.h"
#include "math/math.h"

#include <math.h>
#include <stdio.h>

// ------------------------------------------------------------------------------------------ slopes

// SAMPLES: largest number of texels of a level at which slopes are measured. LEAST: smallest size
// of a level whose shift is measured.
enum { SAMPLES = 6000, LEAST = 8, MOST_UNKNOWNS = 3 };

// A shift of least square error: its components, and the part of the error that it explains.
typedef struct shift {
    double by[MOST_UNKNOWNS], part;
} shift;

// Sums of a weighted least-squares problem: slopes times slopes, slopes times the error, and the
// error squared.
typedef struct normal {
    int unknowns;
    double aa[MOST_UNKNOWNS][MOST_UNKNOWNS], ab[MOST_UNKNOWNS], bb;
} normal;

static void add_equation(normal *n, const double *slope, double error, double weight)
{
    for (int i = 0; i < n->unknowns; i++) {
        for (int j = 0; j < n->unknowns; j++)
            n->aa[i][j] += weight * slope[i] * slope[j];
        n->ab[i] += weight * slope[i] * error;
    }
    n->bb += weight * error * error;
}

static shift solve(const normal *n)
{
    shift s = {{0}, 0};
    double matrix[MOST_UNKNOWNS * MOST_UNKNOWNS], right[MOST_UNKNOWNS];
    for (int i = 0; i < n->unknowns; i++) {
        right[i] = n->ab[i];
        for (int j = 0; j < n->unknowns; j++)
            matrix[j * n->unknowns + i] = n->aa[i][j];
    }
    if (!ki_least_squares(matrix, right, n->unknowns, n->unknowns, s.by))
        return (shift){{0}, 0};
    for (int i = 0; i < n->unknowns && n->bb > 0; i++)
        s.part += s.by[i] * n->ab[i] / n->bb;
    return s;
}

// The texels of a cube around the texel whose slopes are wanted.
static void slope_on_face(const ki_pair *pair, size_t index, double slope[2][3])
{
    int n = pair->exact.size, face = (int)(index / ((size_t)n * (size_t)n)),
        y = (int)(index / (size_t)n) % n, x = (int)(index % (size_t)n);
    for (int i = 0; i < 2; i++) {
        double before[3], after[3], at[3], step = 2.0 / n;
        double s = (2 * x + 1.0) / n - 1, t = (2 * y + 1.0) / n - 1;
        ki_face_direction(face, s - (i == 0) * step, t - (i == 1) * step, at);
        ki_cube_read(&pair->exact, 0, at, before);
        ki_face_direction(face, s + (i == 0) * step, t + (i == 1) * step, at);
        ki_cube_read(&pair->exact, 0, at, after);
        for (int c = 0; c < 3; c++)
            slope[i][c] = (after[c] - before[c]) / 2;
    }
}

// Sets the slopes of the exact level under turns about x, y and z, in units of `angle`.
static void slope_of_turn(const ki_pair *pair, size_t index, double angle, double slope[3][3])
{
    double d[3];
    kiln_map_direction(&pair->exact, 0, index, d);
    const double along[3][3] = {{0, -d[2], d[1]}, {d[2], 0, -d[0]}, {-d[1], d[0], 0}};
    for (int i = 0; i < 3; i++) {
        double at[3], to[3], before[3], after[3];
        for (int k = 0; k < 3; k++) {
            at[k] = d[k] - angle * along[i][k];
            to[k] = d[k] + angle * along[i][k];
        }
        ki_cube_read(&pair->exact, 0, at, before);
        ki_cube_read(&pair->exact, 0, to, after);
        for (int c = 0; c < 3; c++)
            slope[i][c] = (after[c] - before[c]) / 2;
    }
}

// Finds the shift of least error: along the faces in texels, or as a turn in units of a texel.
static shift find_shift(const ki_pair *pair, bool turn)
{
    size_t texels = kiln_map_texels(&pair->exact, 0), stride = texels / SAMPLES + 1;
    normal n = {.unknowns = turn ? 3 : 2};
    for (size_t i = stride / 2; i < texels; i += stride) {
        double slope[MOST_UNKNOWNS][3];
        if (turn)
            slope_of_turn(pair, i, KI_PI / 2 / pair->exact.size, slope);
        else
            slope_on_face(pair, i, slope);
        for (size_t c = 0; c < 3; c++) {
            double e = (double)pair->exact.level[0][3 * i + c],
                   w = 1 / (fabs(e) + fabs(pair->mean) + 1e-30);
            const double column[MOST_UNKNOWNS] = {slope[0][c], slope[1][c], turn ? slope[2][c] : 0};
            add_equation(&n, column, (double)pair->is.level[0][3 * i + c] - e, w * w);
        }
    }
    return solve(&n);
}

// ------------------------------------------------------------------------------------------ shifts

// The median of the shifts of the levels, and how many levels agree with it.
typedef struct agreement {
    double by[MOST_UNKNOWNS];
    int agree, measured;
} agreement;

static double middle(const double *values, int count)
{
    for (int i = 0; i < count; i++) {
        int below = 0, same = 0;
        for (int j = 0; j < count; j++) {
            below += values[j] < values[i];
            same += values[j] == values[i];
        }
        if (below <= (count - 1) / 2 && below + same > (count - 1) / 2)
            return values[i];
    }
    return 0;
}

// Finds how the levels are shifted. Shifts are in texels of each level, but turns in radians.
static agreement find_agreement(const ki_pair *pairs, const kiln_check_levels_report *report,
                                bool turn)
{
    agreement all = {{0}, 0, 0};
    shift shifts[KILN_MAX_LEVELS] = {0};
    double list[KILN_MAX_LEVELS];
    for (int k = 0; k < report->level_count; k++) {
        if (pairs[k].exact.size < LEAST || report->level[k].rms < 0.003)
            continue;
        shift s = find_shift(&pairs[k], turn);
        for (int i = 0; i < 3 && turn; i++)
            s.by[i] *= KI_PI / 2 / pairs[k].exact.size;
        shifts[all.measured++] = s;
    }
    for (int i = 0; i < (turn ? 3 : 2) && all.measured; i++) {
        for (int k = 0; k < all.measured; k++)
            list[k] = shifts[k].by[i];
        all.by[i] = middle(list, all.measured);
    }
    double size = sqrt(all.by[0] * all.by[0] + all.by[1] * all.by[1] + all.by[2] * all.by[2]);
    for (int k = 0; k < all.measured; k++) {
        double off = 0;
        for (int i = 0; i < 3; i++)
            off += (shifts[k].by[i] - all.by[i]) * (shifts[k].by[i] - all.by[i]);
        all.agree += shifts[k].part > 0.25 && sqrt(off) < 0.4 * size;
    }
    return all;
}

// Returns a shift in words: "half a texel", "one texel" or the number of texels.
static const char *amount(double texels, char text[32])
{
    double size = fabs(texels);
    if (fabs(size - 0.5) < 0.12)
        return "half a texel";
    if (fabs(size - 1) < 0.15)
        return "one texel";
    ki_print(text, 32, "%.2g texels", size);
    return text;
}

static void say_shift(const agreement *a, kiln_findings *findings)
{
    char one[32], two[32];
    const double least = 0.12;
    bool right = fabs(a->by[0]) > least, down = fabs(a->by[1]) > least;
    if (right && down)
        ki_find(findings, KILN_FINDING_SHIFT, true,
                "the faces are shifted: their texels lie %s too far %s and %s too far %s",
                amount(a->by[0], one), a->by[0] > 0 ? "left" : "right", amount(a->by[1], two),
                a->by[1] > 0 ? "up" : "down");
    else if (right || down)
        ki_find(findings, KILN_FINDING_SHIFT, true,
                "the faces are shifted: their texels lie %s too far %s",
                amount(a->by[right ? 0 : 1], one),
                right          ? a->by[0] > 0 ? "left" : "right"
                : a->by[1] > 0 ? "up"
                               : "down");
}

static void say_turn(const agreement *a, kiln_findings *findings)
{
    const double degrees = 180 / KI_PI;
    double most = fmax(fabs(a->by[0]), fmax(fabs(a->by[1]), fabs(a->by[2])));
    if (most * degrees < 0.04)
        return;
    ki_find(findings, KILN_FINDING_SHIFT, true,
            "the environment is turned by %.2g, %.2g and %.2g degrees about +X, +Y and +Z; half a "
            "texel of a panorama of n rows is 90 / n degrees",
            a->by[0] * degrees, a->by[1] * degrees, a->by[2] * degrees);
}

void ki_judge_shift(const ki_pair *pairs, const kiln_check_levels_report *report,
                    kiln_findings *findings)
{
    if (pairs[0].exact.shape != KILN_SHAPE_CUBE)
        return;
    agreement faces = find_agreement(pairs, report, false);
    agreement turned = find_agreement(pairs, report, true);
    if (faces.measured && 2 * faces.agree > faces.measured && faces.agree >= turned.agree)
        say_shift(&faces, findings);
    else if (turned.measured && 2 * turned.agree > turned.measured)
        say_turn(&turned, findings);
}

// --------------------------------------------------------------------------------- clamped light

void ki_judge_clamp(const ki_pair *pair, kiln_findings *findings)
{
    // A texel is bright if it is more than BRIGHT times as bright as the mean.
    const double bright = 6;
    double missing = 0, wrong = 0, missing_bright = 0, light = 0, most = 0;
    for (size_t i = 0; i < kiln_map_texels(&pair->exact, 0); i++) {
        double w = ki_weight_of(&pair->exact, i);
        for (size_t c = 0; c < 3; c++) {
            double e = (double)pair->exact.level[0][3 * i + c],
                   l = (double)pair->is.level[0][3 * i + c];
            light += w * e;
            missing += w * (e - l);
            wrong += w * fabs(e - l);
            missing_bright += e > bright * pair->mean ? w * (e - l) : 0;
            most = fmax(most, l);
        }
    }
    if (light > 0 && missing > 0.005 * light && missing > 0.7 * wrong &&
        missing_bright > 0.8 * missing)
        ki_find(
            findings, KILN_FINDING_CLAMPED, true,
            "bright light was clamped: nothing is above %.4g, and %.3g %% of all light is missing",
            most, 100 * missing / light);
}
