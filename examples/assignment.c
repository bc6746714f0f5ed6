// Writes assignment.html of the demo. In: a context and an output folder. Out: a web page with the
// tables of the GAMES202 assignment, made by its methods (kiln/course.h), their errors against
// exact integrals, and charts over roughness.
#include "demo.h"

#include <kiln/course.h>
#include <math.h>

enum { SIZE = 128, MC = 0, FREE, IS, SPLIT, EXACT, TABLES };

typedef struct assignment {
    demo_page page;
    kiln_error *error;
    // the masking function G: `g` for exact tables, `taught` the same function for the GAMES202
    // assignment's methods
    kiln_g g;
    kiln_assignment_g taught;
    kiln_image table[TABLES];
    kiln_difference difference[TABLES];
} assignment;

static const char *const captions[TABLES] = {
    "<b>Monte Carlo</b>, as taught: figure 1", "the same samples, <b>D not clamped</b>",
    "<b>importance sampling</b>: bonus 1, figure 2", "<b>split sum</b>: bonus 2",
    "<b>exact</b>: the integral"};

// Returns the number of significant digits with which a percentage is shown: two, or three from 100
// on.
static int digits(double number)
{
    return number < 100 ? 2 : 3;
}

// --------------------------------------------------------------------------------------- computing

static void release(assignment *a)
{
    for (int t = 0; t < TABLES; t++)
        kiln_image_free(&a->table[t]);
}

static kiln_result compute(assignment *a)
{
    static const kiln_assignment_method methods[EXACT] = {
        KILN_ASSIGNMENT_MONTE_CARLO, KILN_ASSIGNMENT_MONTE_CARLO, KILN_ASSIGNMENT_IMPORTANCE,
        KILN_ASSIGNMENT_SPLIT_SUM};
    kiln_table exact;
    kiln_table_def exact_def = {.model = {.g = a->g}, .width = SIZE, .height = SIZE, .flip = true};
    kiln_result result = kiln_table_create(a->page.context, &exact_def, &exact, a->error);
    a->table[EXACT] = exact.image;
    for (int t = 0; t < EXACT && !result; t++) {
        kiln_assignment_def def = {.size = SIZE, .g = a->taught, .unclamped = t == FREE};
        result = kiln_assignment_energy(a->page.context, methods[t], &def, &a->table[t], a->error);
        if (!result)
            result = kiln_assignment_compare(a->page.context, &a->table[t], &a->table[EXACT],
                                             &a->difference[t], NULL, a->error);
    }
    return result;
}

static double row_mean(const kiln_image *table, int row)
{
    double sum = 0;
    for (int x = 0; x < SIZE; x++)
        sum += (double)table->pixels[row * SIZE + x] / SIZE;
    return sum;
}

// ---------------------------------------------------------------------------------------- pictures

// Shows a table with the bytes that the GAMES202 assignment's supplied code writes. With `figure3`
// the picture shows 1 - E with roughness 0 in the top row.
static kiln_result show_table(assignment *a, const kiln_image *table, bool figure3,
                              const char *caption)
{
    kiln_image picture;
    kiln_result result = kiln_image_create(a->page.context, SIZE, SIZE, 1, &picture, a->error);
    for (int i = 0; i < SIZE * SIZE && !result; i++) {
        int row = i / SIZE, column = i % SIZE;
        float e = table->pixels[(figure3 ? SIZE - 1 - row : row) * SIZE + column];
        picture.pixels[i] = figure3 ? 1 - e : e;
    }
    fputs("<figure>", a->page.file);
    if (!result) {
        kiln_assignment_truncate(&picture);
        result = demo_page_picture(&a->page, &picture, "texels", "A table of E", a->error);
    }
    fprintf(a->page.file, "<figcaption>%s</figcaption></figure>\n", caption);
    return result;
}

static kiln_result show_error(assignment *a, int t)
{
    kiln_image map;
    kiln_difference d;
    kiln_result result = kiln_assignment_compare(a->page.context, &a->table[t], &a->table[EXACT],
                                                 &d, &map, a->error);
    fputs("<figure>", a->page.file);
    if (!result)
        result = demo_page_picture(&a->page, &map, "texels", "Error map", a->error);
    fprintf(a->page.file,
            "<figcaption>its error: <b>%.*g</b> at most, <b>%.2g</b> rms, %+.1g on the mean"
            "</figcaption></figure>\n",
            digits(d.max), d.max, d.rms, d.mean);
    return result;
}

// ------------------------------------------------------------------------------------------ charts

// Draws a curve over roughness, in SVG. `values` has one number from 0 to 1.2 for each table row,
// from the top row down.
static void show_curve(FILE *f, const double values[SIZE], const char *style)
{
    fprintf(f, "<polyline fill=\"none\" %s points=\"", style);
    for (int row = SIZE - 1; row >= 0; row--)
        fprintf(f, "%.1f,%.1f ", 600 * (SIZE - row - 0.5) / SIZE,
                300 - 250 * fmin(values[row], 1.2));
    fputs("\"/>\n", f);
}

static void begin_chart(FILE *f)
{
    fputs("<svg viewBox=\"-46 -6 664 350\" role=\"img\" style=\"width:100%;max-width:720px;"
          "font:15px system-ui,sans-serif;color:var(--ink)\">\n",
          f);
    for (int i = 0; i <= 4; i++)
        fprintf(f,
                "<path d=\"M0 %gH600\" stroke=\"var(--line)\"/><text x=\"-8\" y=\"%g\" "
                "text-anchor=\"end\" fill=\"currentColor\">%g</text>\n"
                "<text x=\"%d\" y=\"322\" text-anchor=\"middle\" fill=\"currentColor\">%g</text>\n",
                300 - 62.5 * i, 305 - 62.5 * i, i / 4.0, 150 * i, i / 4.0);
    fputs(
        "<text x=\"300\" y=\"341\" text-anchor=\"middle\" fill=\"var(--soft)\">roughness</text>\n",
        f);
}

static const char *const exact_style = "stroke=\"var(--accent)\" stroke-width=\"3\"";
static const char *const other_style =
    "stroke=\"var(--accent)\" stroke-width=\"3\" stroke-dasharray=\"7 5\"";
static const char *const noisy_style = "stroke=\"#6d9fc9\" stroke-width=\"1.6\"";
static const char *const clamped_style = "stroke=\"currentColor\" stroke-width=\"2.4\"";

static void show_band(const assignment *a)
{
    static const struct {
        int table;
        const char *const *style;
    } curves[] = {{FREE, &noisy_style}, {MC, &clamped_style}, {EXACT, &exact_style}};
    FILE *f = a->page.file;
    fprintf(f,
            "<h2 id=\"band\">Why figure 1 is dark below</h2>\n"
            "<p>The assignment explains the dark band of its figure 1 by noise: few samples hit "
            "a narrow lobe. But noise errs both ways. The framework keeps the denominator of D "
            "above 0.0001, and at the lobe&rsquo;s peak it is &pi;&alpha;<sup>4</sup>, less than "
            "that for every roughness below <b>%.3f</b>. There the peak is cut off.</p>\n",
            pow(1e-4 / 3.14159265358979323846, 0.125));
    begin_chart(f);
    for (int c = 0; c < 3; c++) {
        double values[SIZE];
        for (int row = 0; row < SIZE; row++)
            values[row] = row_mean(&a->table[curves[c].table], row);
        show_curve(f, values, *curves[c].style);
    }
    fputs(
        "</svg>\n<p class=\"note\">The mean of E over &mu; by roughness. Orange: exact. Blue: "
        "Monte "
        "Carlo, 1024 samples a texel, D as it is; noisy, but about the right value as long as any "
        "sample hits. Black (white in the dark): the same samples with the clamp.</p>\n",
        f);
}

static void show_averages(const assignment *a)
{
    FILE *f = a->page.file;
    double values[4][SIZE];
    kiln_model figures = {.g = KILN_G_SCHLICK_K2}, text = {.g = KILN_G_SCHLICK_TEXT};
    for (int row = 0; row < SIZE; row++) {
        double roughness = (SIZE - row - 0.5) / SIZE;
        values[0][row] = kiln_energy_average(&figures, roughness);
        values[1][row] = kiln_energy_average(&text, roughness);
        values[2][row] = values[3][row] = 0;
        for (int x = 0; x < SIZE; x++) {
            double mu = (x + 0.5) / SIZE;
            values[2][row] += 2 * mu * (double)a->table[MC].pixels[row * SIZE + x] / SIZE;
            values[3][row] += 2 * mu * (double)a->table[IS].pixels[row * SIZE + x] / SIZE;
        }
    }
    double worst = 0;
    for (int row = 0; row < SIZE; row++)
        worst = fmax(worst, fabs(values[3][row] - values[0][row]));
    fprintf(
        f,
        "<h2 id=\"average\">E<sub>avg</sub>, and a mirror that glows</h2>\n"
        "<p>The text of the assignment has k = (roughness + 1)&sup2; / 8, its framework and "
        "its figures have k = roughness&sup2; / 2. With the text&rsquo;s k even a mirror "
        "shadows itself: E<sub>avg</sub> is <b>%.3f</b> where it should be 1, and the lobe that "
        "makes up for lost light would add the rest to a mirror that has lost none. That k is "
        "meant for point lights.</p>\n",
        kiln_energy_average(&text, 0));
    begin_chart(f);
    show_curve(f, values[2], clamped_style);
    show_curve(f, values[1], other_style);
    show_curve(f, values[0], exact_style);
    fprintf(
        f,
        "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"6\" fill=\"none\" stroke=\"#d33\" "
        "stroke-width=\"2.5\"/></svg>\n<p class=\"note\">Orange: exact, k of the figures; the "
        "average of the table by importance sampling is within %.1g of it. Dashed: exact, k of "
        "the text. Black (white in the dark): the average of the Monte Carlo table. Red circle: "
        "what the assignment&rsquo;s figure 4 shows near roughness 1, 0.2235. Exact is %.3f, "
        "and its own recipe gives %.3f.</p>\n",
        600 * (1 - 0.5 / SIZE), 300 - 250 * 0.2235, worst, values[0][0], values[3][0]);
}

// -------------------------------------------------------------------------------------------- page

static kiln_result show_tables(assignment *a, const char *title)
{
    static const int shown[] = {MC, FREE, IS, EXACT};
    kiln_result result = KILN_OK;
    fprintf(a->page.file, "<div class=\"pair\"><h4>%s</h4>\n", title);
    for (int i = 0; i < 4 && !result; i++)
        result = show_table(a, &a->table[shown[i]], false, captions[shown[i]]);
    for (int i = 0; i < 3 && !result; i++)
        result = show_error(a, shown[i]);
    if (!result)
        result = show_table(a, &a->table[IS], true, "1 &minus; E, not flipped: figure 3");
    fputs("</div>\n", a->page.file);
    return result;
}

static void show_numbers(const assignment *all)
{
    FILE *f = all->page.file;
    fputs(
        "<div class=\"scroll\"><table><thead><tr><th>error of E</th><th>k = r&sup2;/2: largest</th>"
        "<th>rms</th><th>k = (r+1)&sup2;/8: largest</th><th>rms</th></tr></thead><tbody>\n",
        f);
    for (int t = 0; t < EXACT; t++)
        fprintf(f, "<tr><td>%s</td><td>%.*g</td><td>%.2g</td><td>%.*g</td><td>%.2g</td></tr>\n",
                captions[t], digits(all[0].difference[t].max), all[0].difference[t].max,
                all[0].difference[t].rms, digits(all[1].difference[t].max),
                all[1].difference[t].max, all[1].difference[t].rms);
    fputs(
        "</tbody></table></div>\n<p class=\"note\">Over all 128 &times; 128 texels, before the cut "
        "to bytes, which takes off up to 0.0039 more. The exact table is an integral in one "
        "dimension, to eleven digits, and takes less time than any of the others.</p>\n",
        f);
}

static kiln_result show(assignment all[2])
{
    FILE *f = all->page.file;
    demo_page_head(f);
    fprintf(f,
            "<header><div><h1>The assignment</h1><p class=\"lead\">What the fourth assignment of "
            "GAMES202 asks to precompute for Kulla and Conty&rsquo;s lobe, by the methods that it "
            "teaches, beside the integrals themselves.</p>\n<nav><a href=\"index.html\">kiln</a>"
            "<a href=\"#tables\">E(&mu;)</a><a href=\"#band\">The dark band</a>"
            "<a href=\"#average\">E<sub>avg</sub></a></nav></div></header>\n<main>\n"
            "<h2 id=\"tables\">E(&mu;): how much light one bounce gives back</h2>\n"
            "<p>A rough surface under white light from everywhere should give all of it back. A "
            "model with a single bounce loses some; E(&mu;) is what is left, by the angle of view "
            "(&mu; = n&middot;v, from grazing at the left to straight on at the right) and by "
            "roughness (0 at the bottom, 1 at the top). Each picture is the very bytes that "
            "<code>kiln tables --assignment</code> writes: 128 &times; 128, 1024 samples a "
            "texel.</p>\n");
    kiln_result result = demo_signed_legend(&all->page, all->error);
    if (!result)
        result =
            show_tables(&all[0], "k = roughness&sup2; / 2, as in the assignment&rsquo;s figures");
    if (!result)
        result = show_tables(&all[1],
                             "k = (roughness + 1)&sup2; / 8, as in the assignment&rsquo;s text");
    show_numbers(all);
    show_band(all);
    show_averages(all);
    demo_page_foot(f, "Every number is computed from the tables before they are cut to bytes.");
    return result;
}

kiln_result demo_assignment_page(kiln_context *context, const char *folder, const char *scratch,
                                 kiln_error *error)
{
    assignment all[2] = {{.g = KILN_G_SCHLICK_K2, .taught = KILN_ASSIGNMENT_G_FIGURES},
                         {.g = KILN_G_SCHLICK_TEXT, .taught = KILN_ASSIGNMENT_G_TEXT}};
    printf("the assignment\n");
    FILE *f = demo_page_open(folder, "assignment.html", error);
    if (!f)
        return error->result;
    kiln_result result = KILN_OK;
    for (int i = 0; i < 2 && !result; i++) {
        all[i].page = (demo_page){f, scratch, context};
        all[i].error = error;
        result = compute(&all[i]);
    }
    if (!result)
        result = show(all);
    result = demo_page_close(f, folder, "assignment.html", result, error);
    release(&all[0]);
    release(&all[1]);
    return result;
}
