// kiln_check_table. In: a picture with a table of reflection models. Out: what its channels hold,
// in which order, at which places and by which model, and the errors.
//
// Method: at 12 x 12 texels all hypotheses are compared with exact integrals: rows and columns
// swapped or reversed, a gamma curve, the axis of n.v, and the model. For each channel the function
// of least error is taken: A, B, A + B, their complement, the albedo of sheen, or a constant. The
// places of the texels are then found from the slopes of the exact functions: texels that lie
// beside the centres (i + 1/2) / n give differences of slope times shift. At last the whole table
// is compared with an exact table of the same size.
#include "check/check.h"

#include "image/image.h"
#include "image/pack.h"
#include "math/math.h"
#include "table/table_axis.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// GRID: texels along each side that are compared for each hypothesis. ORDERS: ways to swap rows and
// columns and to reverse both.
enum { GRID = 12, POINTS = GRID * GRID, ORDERS = 8, CHANNELS = 4, CONTENTS = KILN_HOLDS_ONE + 1 };
enum { SWAPPED = 1, COLUMNS_REVERSED = 2, ROWS_REVERSED = 4 };

// ----------------------------------------------------------------------------------------- samples

typedef double values[CONTENTS];

// Exact values and slopes at the points of the grid. Slopes are per texel along u (n.v) and v.
typedef struct exact_grid {
    values at[POINTS], along_u[POINTS], along_v[POINTS];
} exact_grid;

typedef struct table_check {
    const kiln_image *image;
    kiln_table_def def;                              // the model and axis that are tried
    int index_u[GRID], index_v[GRID], width, height; // width: texels along u
} table_check;

// Evaluates all functions at a place. `sheen` false leaves the albedo of sheen, which takes most of
// the time and does not depend on the model, as it is.
static void evaluate(const kiln_table_def *def, bool sheen, double u, double v, values result)
{
    double ab[2], r = ki_clamp(v, 0, 1), nov = ki_axis_to_nov(def, r, ki_clamp(u, 0, 1));
    kiln_energy_split(&def->model, r, nov, ab);
    result[KILN_HOLDS_UNKNOWN] = (double)NAN;
    result[KILN_HOLDS_A] = ab[0];
    result[KILN_HOLDS_B] = ab[1];
    result[KILN_HOLDS_E] = ab[0] + ab[1];
    result[KILN_HOLDS_COMPLEMENT] = 1 - ab[0] - ab[1];
    if (sheen)
        result[KILN_HOLDS_SHEEN] = kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, fmax(r, 0.01), nov);
    result[KILN_HOLDS_ZERO] = 0;
    result[KILN_HOLDS_ONE] = 1;
}

static void set_slopes(const values low, const values high, bool sheen, values slopes)
{
    for (int q = 1; q < CONTENTS; q++)
        if (sheen || q != KILN_HOLDS_SHEEN)
            slopes[q] = (high[q] - low[q]) / 0.8;
}

// Task of one thread: the values and slopes of one row of the grid.
typedef struct grid_job {
    const table_check *check;
    bool sheen; // false: the grid has the albedo of sheen already
    exact_grid *grid;
} grid_job;

static void evaluate_row(void *data, int row)
{
    const grid_job *job = data;
    const table_check *c = job->check;
    for (int column = 0; column < GRID; column++) {
        int i = row * GRID + column;
        double u = (c->index_u[column] + 0.5) / c->width, v = (c->index_v[row] + 0.5) / c->height;
        double du = 0.4 / c->width, dv = 0.4 / c->height;
        values low = {0}, high = {0};
        evaluate(&c->def, job->sheen, u, v, job->grid->at[i]);
        evaluate(&c->def, job->sheen, u - du, v, low);
        evaluate(&c->def, job->sheen, u + du, v, high);
        set_slopes(low, high, job->sheen, job->grid->along_u[i]);
        evaluate(&c->def, job->sheen, u, v - dv, low);
        evaluate(&c->def, job->sheen, u, v + dv, high);
        set_slopes(low, high, job->sheen, job->grid->along_v[i]);
    }
}

// Places the grid: the indices are the same when they are counted from the other end.
static void place_grid(table_check *c, bool swapped)
{
    c->width = swapped ? c->image->height : c->image->width;
    c->height = swapped ? c->image->width : c->image->height;
    for (int k = 0; k < GRID / 2; k++) {
        c->index_u[k] = (int)((k + 0.3) * c->width / GRID);
        c->index_v[k] = (int)((k + 0.3) * c->height / GRID);
        c->index_u[GRID - 1 - k] = c->width - 1 - c->index_u[k];
        c->index_v[GRID - 1 - k] = c->height - 1 - c->index_v[k];
    }
}

// Returns the texel that holds the value of index (u, v) in a table of this order.
static const float *texel_of(const kiln_image *image, int order, int u, int v)
{
    int x = order & SWAPPED ? v : u, y = order & SWAPPED ? u : v;
    // The reversed columns are those of n.v, whichever way they run.
    bool reverse_x = order & (order & SWAPPED ? ROWS_REVERSED : COLUMNS_REVERSED),
         reverse_y = order & (order & SWAPPED ? COLUMNS_REVERSED : ROWS_REVERSED);
    x = reverse_x ? image->width - 1 - x : x;
    y = reverse_y ? image->height - 1 - y : y;
    return image->pixels + (size_t)image->channels * ((size_t)y * (size_t)image->width + (size_t)x);
}

static double decode(double value, bool gamma)
{
    return gamma ? (double)ki_linear_from_srgb((float)ki_clamp(value, 0, 1)) : value;
}

// -------------------------------------------------------------------------------------- hypotheses

// A hypothesis about a table, and how well the table fits it.
typedef struct guess {
    int order;
    bool gamma;
    kiln_table_def def;
    kiln_table_content content[CHANNELS];
    double by[4];   // shift of the columns and their stretch, shift of the rows and their stretch
    double error;   // root mean square difference without a shift
    double remains; // root mean square difference after a shift by `by`
} guess;

// Finds the function of least error of each channel.
static void find_contents(const table_check *c, const exact_grid *grid, guess *g)
{
    double total = 0;
    for (int channel = 0; channel < c->image->channels; channel++) {
        double least = HUGE_VAL;
        for (int q = 1; q < CONTENTS; q++) {
            double sum = 0;
            for (int i = 0; i < POINTS; i++) {
                const float *texel =
                    texel_of(c->image, g->order, c->index_u[i % GRID], c->index_v[i / GRID]);
                double d = decode((double)texel[channel], g->gamma) - grid->at[i][q];
                sum += d * d;
            }
            if (sum < least) {
                least = sum;
                g->content[channel] = (kiln_table_content)q;
            }
        }
        total += least;
    }
    g->error = sqrt(total / (POINTS * c->image->channels));
}

// Finds the shift and the stretch of columns and rows, in texels, with which the error is least.
static void find_places(const table_check *c, const exact_grid *grid, guess *g)
{
    double matrix[4 * CHANNELS * POINTS], right[CHANNELS * POINTS], left[CHANNELS * POINTS];
    int rows = POINTS * c->image->channels, at = 0;
    double slopes[CHANNELS * POINTS][4], sum = 0;
    for (int i = 0; i < POINTS; i++)
        for (int channel = 0; channel < c->image->channels; channel++, at++) {
            const float *texel =
                texel_of(c->image, g->order, c->index_u[i % GRID], c->index_v[i / GRID]);
            int q = (int)g->content[channel];
            int column = c->index_u[i % GRID], row = c->index_v[i / GRID];
            double u = (column + 0.5) / c->width - 0.5, v = (row + 0.5) / c->height - 0.5;
            const double s[4] = {grid->along_u[i][q], u * grid->along_u[i][q], grid->along_v[i][q],
                                 v * grid->along_v[i][q]};
            left[at] = right[at] = decode((double)texel[channel], g->gamma) - grid->at[i][q];
            for (int k = 0; k < 4; k++)
                slopes[at][k] = matrix[k * rows + at] = s[k];
        }
    if (!ki_least_squares(matrix, right, rows, 4, g->by))
        memset(g->by, 0, sizeof g->by);
    for (int i = 0; i < rows; i++) {
        for (int k = 0; k < 4; k++)
            left[i] -= slopes[i][k] * g->by[k];
        sum += left[i] * left[i];
    }
    g->remains = sqrt(sum / rows);
    // A shift of more than one and a half texels is another table, not a shift.
    for (int k = 0; k < 4; k++)
        if (!(fabs(g->by[k]) < 1.6))
            g->remains = g->error;
}

// Compares the table with the exact values of one model and one axis: in the four orders in which
// n.v grows or falls along rows, or, if `swapped` is true, in the four in which n.v runs along
// columns.
static kiln_result try_model(kiln_context *context, table_check *c, bool swapped, bool sheen,
                             exact_grid *grid, guess *best, kiln_error *error)
{
    grid_job job = {c, sheen, grid};
    place_grid(c, swapped);
    if (!ki_parallel_steps(context, NULL, GRID, evaluate_row, &job))
        return ki_fail_cancelled(error, "checking");
    for (int order = swapped; order < ORDERS; order += 2)
        for (int gamma = 0; gamma < 2; gamma++) {
            guess g = {.order = order, .gamma = gamma, .def = c->def};
            find_contents(c, grid, &g);
            find_places(c, grid, &g);
            // Of hypotheses that are equally good the simpler one, which comes first, is taken.
            if (g.remains < 0.8 * best->remains)
                *best = g;
        }
    return KILN_OK;
}

static kiln_result find_guess(kiln_context *context, const kiln_image *image, guess *best,
                              kiln_error *error)
{
    static const kiln_model models[] = {{KILN_D_GGX, KILN_G_SMITH},
                                        {KILN_D_GGX, KILN_G_SMITH_UNCORRELATED},
                                        {KILN_D_GGX, KILN_G_SCHLICK_K2},
                                        {KILN_D_GGX, KILN_G_SCHLICK_TEXT},
                                        {KILN_D_BECKMANN, KILN_G_SMITH}};
    // remaining errors at which no further models and no further axes are tried
    const double exact = 2e-4, good = 0.002;
    table_check c = {.image = image};
    bool square = image->width == image->height;
    exact_grid *grid = ki_alloc_raw(context, 2, sizeof *grid); // as stored, and swapped
    kiln_result result =
        grid ? KILN_OK : ki_fail_memory(context, error, "the check of a table", 2 * sizeof *grid);
    *best = (guess){.error = HUGE_VAL, .remains = HUGE_VAL};
    for (int axis = KILN_AXIS_LINEAR; axis <= KILN_AXIS_GRAZING && best->remains > good; axis++)
        for (size_t m = 0; m < sizeof models / sizeof *models && best->remains > exact; m++)
            for (int swapped = 0; swapped < 2 && result == KILN_OK; swapped++) {
                c.def = (kiln_table_def){.model = models[m], .axis = (kiln_axis)axis};
                result = try_model(context, &c, swapped, m == 0 && !(square && swapped),
                                   grid + (square ? 0 : swapped), best, error);
            }
    ki_free(grid);
    return result;
}

// ------------------------------------------------------------------------------------------- words

static const char *content_name(kiln_table_content content)
{
    static const char *const names[] = {"an unknown function", "A", "B", "A + B", "1 - (A + B)",
                                        "the albedo of sheen", "0", "1"};
    return names[content];
}

static void say_contents(const guess *g, int channels, kiln_findings *findings)
{
    static const char *const axes[] = {"", ", on the axis sqrt(n.v)", ", on the axis cbrt(n.v)",
                                       ", on the grazing axis"};
    char list[96] = "";
    for (int i = 0; i < channels; i++) {
        size_t length = strlen(list);
        snprintf(list + length, sizeof list - length, "%s%s", i ? ", " : "",
                 content_name(g->content[i]));
    }
    ki_find(findings, KILN_FINDING_CONTENT, false,
            "the channels hold %s, of %s with the masking %s%s", list,
            kiln_d_names()[g->def.model.d], kiln_g_names()[g->def.model.g], axes[g->def.axis]);
}

static void say_order(const guess *g, bool flip, kiln_findings *findings)
{
    if (g->order & SWAPPED)
        ki_find(findings, KILN_FINDING_ORDER, true,
                "rows and columns are transposed: n.v changes from row to row, and roughness from "
                "column "
                "to column, as in three.js");
    if (g->order & COLUMNS_REVERSED)
        ki_find(findings, KILN_FINDING_ORDER, true,
                "n.v is flipped: the first texels hold n.v = 1");
    if (!(g->order & ROWS_REVERSED) == flip)
        ki_find(findings, KILN_FINDING_ORDER, true,
                "roughness is flipped: the first texels hold roughness %d", flip ? 0 : 1);
    if (g->gamma)
        ki_find(findings, KILN_FINDING_ENCODING, true,
                "the numbers are gamma-encoded: they are stored by the sRGB curve");
}

// Says where the texels lie along one axis. Returns whether they lie at the corners i / (n - 1).
static bool say_place(const char *what, double shift, double stretch, kiln_findings *findings)
{
    double size = fabs(shift);
    bool corners = size < 0.2 && fabs(stretch - 1) < 0.3;
    if (size < 0.2)
        return corners;
    if (size < 0.75)
        ki_find(findings, KILN_FINDING_SHIFT, true,
                "%s is half a texel off: the texels hold values of %.2g texels %s", what, size,
                shift > 0 ? "further on" : "before");
    else
        ki_find(findings, KILN_FINDING_SHIFT, true,
                "%s is one texel off: the texels hold values of %.2g texels %s", what, size,
                shift > 0 ? "further on" : "before");
    return false;
}

// ------------------------------------------------------------------------------------------- check

static double exact_value(const kiln_table *split, const kiln_table *sheen, size_t texel,
                          kiln_table_content content)
{
    double a = (double)split->image.pixels[2 * texel],
           b = (double)split->image.pixels[2 * texel + 1];
    return content == KILN_HOLDS_A            ? a
           : content == KILN_HOLDS_B          ? b
           : content == KILN_HOLDS_E          ? a + b
           : content == KILN_HOLDS_COMPLEMENT ? 1 - a - b
           : content == KILN_HOLDS_SHEEN      ? (double)sheen->image.pixels[texel]
                                              : content == KILN_HOLDS_ONE;
}

// Compares all texels with an exact table.
static kiln_result measure(kiln_context *context, const kiln_image *image, const guess *g,
                           kiln_check_table_report *report, kiln_error *error)
{
    bool swapped = g->order & SWAPPED;
    int width = swapped ? image->height : image->width,
        height = swapped ? image->width : image->height;
    kiln_table_def def = g->def;
    kiln_table split = {0}, sheen = {0};
    double sum = 0, numbers = 0;
    def.width = width;
    def.height = height;
    def.corners = report->corners;
    def.kind = KILN_TABLE_DFG;
    kiln_result result = kiln_table_create(context, &def, &split, error);
    def.kind = KILN_TABLE_SHEEN;
    def.model = (kiln_model){KILN_D_GGX, KILN_G_SMITH};
    bool has_sheen = false;
    for (int c = 0; c < image->channels; c++)
        has_sheen |= g->content[c] == KILN_HOLDS_SHEEN;
    if (result == KILN_OK && has_sheen)
        result = kiln_table_create(context, &def, &sheen, error);
    for (int v = 0; v < height && result == KILN_OK; v++)
        for (int u = 0; u < width; u++)
            for (int c = 0; c < image->channels; c++) {
                double is = decode((double)texel_of(image, g->order, u, v)[c], g->gamma);
                size_t texel = (size_t)v * (size_t)width + (size_t)u;
                double d = is - exact_value(&split, &sheen, texel, g->content[c]);
                sum += d * d;
                numbers += g->content[c] < KILN_HOLDS_ZERO;
                report->largest = fmax(report->largest, fabs(d));
            }
    report->rms = sqrt(sum / fmax(1, numbers));
    kiln_table_free(&split);
    kiln_table_free(&sheen);
    return result;
}

static kiln_result check_image(const kiln_image *image, kiln_error *error)
{
    if (image->width < GRID || image->height < GRID || image->width > KILN_MAX_TABLE ||
        image->height > KILN_MAX_TABLE || image->channels < 1 || image->channels > CHANNELS ||
        !image->pixels)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the table has %d x %d texels of %d channels, it must have %d to %d texels "
                       "along each side and 1 to %d channels",
                       image->width, image->height, image->channels, GRID, KILN_MAX_TABLE,
                       CHANNELS);
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height * (size_t)image->channels;
         i++)
        if (!isfinite(image->pixels[i]))
            return ki_fail(error, KILN_ERROR_ARGUMENT, "number %zu of the table is not finite", i);
    return KILN_OK;
}

kiln_result kiln_check_table(kiln_context *context, const kiln_image *image, bool flip,
                             kiln_check_table_report *report, kiln_error *error)
{
    guess g;
    memset(report, 0, sizeof *report);
    kiln_result result = check_image(image, error);
    if (result == KILN_OK)
        result = find_guess(context, image, &g, error);
    if (result != KILN_OK)
        return result;
    kiln_findings *findings = &report->findings;
    report->channels = image->channels;
    if (g.remains > 0.03) {
        ki_find(findings, KILN_FINDING_CONTENT, true,
                "the numbers are not those of a table that kiln knows: the best guess errs by %.2g",
                g.remains);
        report->rms = report->largest = g.remains;
        return KILN_OK;
    }
    memcpy(report->content, g.content, sizeof report->content);
    report->model = g.def.model;
    report->axis = g.def.axis;
    say_contents(&g, image->channels, findings);
    say_order(&g, flip, findings);
    bool columns = say_place("n.v", g.by[0], g.by[1], findings),
         rows = say_place("roughness", g.by[2], g.by[3], findings);
    report->corners = columns && rows;
    if (report->corners)
        ki_find(findings, KILN_FINDING_CONTENT, false, "texel i of n lies at i / (n - 1)");
    result = measure(context, image, &g, report, error);
    if (result != KILN_OK)
        memset(report, 0, sizeof *report);
    return result;
}
