// The lobe of GGX and what tables of lobes make of it, for docs/theory/lobes.md: draws the picture
// docs/images/lobes.png and prints the expected errors.
//
//   bench_lobes PICTURE.png
//
// In: nothing. Out: a picture with a row for each roughness and n.v of `cases` and four columns:
// the lobe f (n.l) / E, then one, two and three taps of levels at seven equal steps of roughness,
// with their correction of bands 0 to 2. In a panel the angle in the plane of incidence runs from
// -90 to 180 degrees to the right, 0 at the normal, positive towards the mirror direction; the
// angle out of the plane runs from -90 to 90 degrees upwards.
#include "lobe_sum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 3, COLUMNS = 4, PANEL_WIDTH = 270, PANEL_HEIGHT = 120, GAP = 6 };
enum { WIDTH = COLUMNS * PANEL_WIDTH + (COLUMNS - 1) * GAP };
enum { HEIGHT = ROWS * PANEL_HEIGHT + (ROWS - 1) * GAP };

static const double pi = 3.14159265358979323846;
static const struct {
    double roughness, nov;
} cases[ROWS] = {{0.35, 0.1}, {0.55, 0.35}, {0.9, 0.35}};

static kiln_error error;

static void check(kiln_result result)
{
    if (result) {
        fprintf(stderr, "bench_lobes: %s\n", error.message);
        exit(1);
    }
}

// The true lobe per steradian at the direction d; x is along the tangent, z along the normal.
static double truth(double roughness, double nov, const double d[3])
{
    static const kiln_model model = {0};
    double x = d[0] - sqrt(1 - nov * nov), z = d[2] + nov;
    double noh = z / sqrt(x * x + d[1] * d[1] + z * z);
    if (d[2] <= 0)
        return 0;
    return d[2] * kiln_brdf_specular(&model, roughness, nov, d[2], noh) /
           kiln_energy(&model, roughness, nov);
}

// Colours a value relative to the lobe's maximum: black is 0, yellow is 1, blue is negative.
static void color(double value, float rgb[3])
{
    double bright = sqrt(value > 0 ? value : -4 * value);
    rgb[0] = (float)(value > 0 ? bright : 0);
    rgb[1] = (float)(value > 0 ? 0.8 * bright * bright : 0.2 * bright);
    rgb[2] = (float)(value > 0 ? 0.15 * bright : bright);
    for (int c = 0; c < 3; c++)
        rgb[c] = rgb[c] < 1 ? rgb[c] : 1;
}

static void direction_at(int x, int y, double d[3])
{
    double along = (-90 + 270 * (x + 0.5) / PANEL_WIDTH) * pi / 180;
    double across = (90 - 180 * (y + 0.5) / PANEL_HEIGHT) * pi / 180;
    d[0] = cos(across) * sin(along);
    d[1] = sin(across);
    d[2] = cos(across) * cos(along);
}

static void draw_panel(kiln_image *picture, int row, int taps, const lobe_levels *levels,
                       const lobe_sum *sum)
{
    double roughness = cases[row].roughness, nov = cases[row].nov, d[3], most = 0;
    static double panel[PANEL_HEIGHT][PANEL_WIDTH];
    for (int y = 0; y < PANEL_HEIGHT; y++)
        for (int x = 0; x < PANEL_WIDTH; x++) {
            direction_at(x, y, d);
            double f = truth(roughness, nov, d);
            most = f > most ? f : most;
            panel[y][x] = taps ? lobe_sum_at(levels, sum, d) : f;
        }
    for (int y = 0; y < PANEL_HEIGHT; y++)
        for (int x = 0; x < PANEL_WIDTH; x++) {
            size_t at = (size_t)(row * (PANEL_HEIGHT + GAP) + y) * WIDTH;
            color(panel[y][x] / most,
                  picture->pixels + 3 * (at + (size_t)(taps * (PANEL_WIDTH + GAP) + x)));
        }
}

static void print_errors(kiln_context *context, const kiln_table *tables)
{
    static const double roughness[] = {0.15, 0.35, 0.55, 0.75, 0.95}, cosine[] = {0.1, 0.35, 0.7};
    puts("| roughness, n.v | straight | bent | one tap | two taps | three taps |\n"
         "|---|---|---|---|---|---|");
    for (int i = 0; i < 15; i++) {
        double r = roughness[i / 3], nov = cosine[i % 3];
        kiln_lobes_error e[4];
        for (int taps = 1; taps <= 3; taps++)
            check(kiln_lobes_errors(context, &tables[taps], &nov, &r, 1, &e[taps], &error));
        printf("| %.2f, %.2f | %.1f | %.1f | %.1f | %.1f | %.1f |\n", r, nov, 100 * e[1].straight,
               100 * e[1].bent, 100 * e[1].table, 100 * e[2].table, 100 * e[3].table);
    }
}

int main(int argc, char **argv)
{
    static lobe_levels levels;
    float roughness[7];
    kiln_context *context;
    kiln_table tables[4];
    kiln_image picture;
    if (argc != 2) {
        fputs("bench_lobes PICTURE.png\n", stderr);
        return 2;
    }
    check(kiln_context_create(NULL, &context, &error));
    check(kiln_image_create(context, WIDTH, HEIGHT, 3, &picture, &error));
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        picture.pixels[i] = 0.5f;
    for (int level = 0; level < 7; level++)
        roughness[level] = (float)level / 6;
    lobe_levels_make(roughness, 7, &levels);
    for (int taps = 0; taps <= 3; taps++) {
        const kiln_table_def def = {.kind = KILN_TABLE_LOBES, .tap_count = taps};
        if (taps)
            check(kiln_table_create(context, &def, &tables[taps], &error));
        for (int row = 0; row < ROWS; row++) {
            double values[16] = {0};
            if (taps)
                kiln_table_lookup(&tables[taps], cases[row].nov, cases[row].roughness, 0, values);
            lobe_sum sum = lobe_sum_make(values, taps, cases[row].nov);
            draw_panel(&picture, row, taps, &levels, &sum);
        }
    }
    check(kiln_image_save(context, &picture, argv[1], &error));
    print_errors(context, tables);
    for (int taps = 1; taps <= 3; taps++)
        kiln_table_free(&tables[taps]);
    kiln_image_free(&picture);
    kiln_context_destroy(context);
    return 0;
}
