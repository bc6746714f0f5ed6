// Writes tables.html of the demo. In: a context and an output folder. Out: a web page that shows
// the kinds of exact tables, maps of the lookup error over n.v and roughness for several storages
// (the furnace test), and the time to make tables.
#include "demo.h"

#include <errno.h>
#include <kiln/course.h>
#include <math.h>
#include <string.h>
#include <time.h>

enum { SIZE = 128, MAP = 192 };

typedef struct tables {
    demo_page page;
    kiln_error *error;
} tables;

static const char *const model_names[4] = {"smith", "smith-uncorrelated", "schlick-k2",
                                           "schlick-text"};

// ---------------------------------------------------------------------------------------- pictures

// Draws a table as a picture: one channel as grey, two channels as red and green.
static kiln_result show_table(tables *t, const kiln_table_def *def, const char *caption)
{
    kiln_table table;
    kiln_image picture = {0};
    kiln_result result = kiln_table_create(t->page.context, def, &table, t->error);
    int channels = result ? 1 : table.image.channels;
    if (!result)
        result = kiln_image_create(t->page.context, SIZE, SIZE, channels == 1 ? 1 : 3, &picture,
                                   t->error);
    for (int i = 0; i < SIZE * SIZE && !result; i++) {
        int column = i % SIZE % table.image.width, from = i / SIZE * table.image.width + column;
        for (int c = 0; c < channels && c < picture.channels; c++)
            picture.pixels[i * picture.channels + c] =
                fminf(1, table.image.pixels[from * channels + c]);
    }
    fputs("<figure>", t->page.file);
    if (!result)
        result = demo_page_picture(&t->page, &picture, "texels", caption, t->error);
    fprintf(t->page.file, "<figcaption>%s</figcaption></figure>\n", caption);
    kiln_table_free(&table);
    return result;
}

static kiln_result show_kinds(tables *t)
{
    static const struct {
        kiln_table_def def;
        const char *caption;
    } shown[] = {
        {{.flip = true}, "<b>E</b>: what one bounce gives back"},
        {{.complement = true, .flip = true}, "<b>1 &minus; E</b>: what is missing"},
        {{.axis = KILN_AXIS_GRAZING, .corners = true, .flip = true},
         "<b>E</b> on the grazing axis"},
        {{.kind = KILN_TABLE_E_AVERAGE, .flip = true}, "<b>E<sub>avg</sub></b>, over roughness"},
        {{.kind = KILN_TABLE_DFG, .flip = true}, "<b>A</b> red, <b>B</b> green: the split sum"},
        {{.kind = KILN_TABLE_DFG_MULTISCATTER, .flip = true},
         "<b>B, A + B</b> and cloth, as Filament has them"},
        {{.kind = KILN_TABLE_SHEEN, .flip = true}, "<b>Charlie</b> sheen"},
        {{.model.g = KILN_G_SCHLICK_TEXT, .flip = true}, "<b>E</b> with the text&rsquo;s k"},
    };
    kiln_result result = KILN_OK;
    fputs(
        "<h2 id=\"tables\">What the tables hold</h2>\n"
        "<p>n&middot;v runs from grazing at the left to straight on at the right, roughness from 0 "
        "at the bottom to 1 at the top. Every texel is an integral, to seven digits: there is no "
        "noise to look for.</p>\n<div class=\"pair\">\n",
        t->page.file);
    for (size_t i = 0; i < sizeof shown / sizeof *shown && !result; i++)
        result = show_table(t, &shown[i].def, shown[i].caption);
    fputs("</div>\n", t->page.file);
    return result;
}

// ----------------------------------------------------------------------------------------- furnace

// Rounds a number to the nearest half float: 11 significant bits, but never finer than multiples of
// 2^-24.
static float to_half(float x)
{
    int exponent;
    (void)frexpf(x, &exponent);
    float unit = ldexpf(1, exponent < -13 ? -24 : exponent - 11);
    return rintf(x / unit) * unit;
}

static float to_byte(float x)
{
    return rintf(x * 255) / 255;
}

typedef struct storage {
    kiln_axis axis;
    bool corners;
    float (*rounded)(float);
    const char *caption;
} storage;

// Returns the n.v of a column of an error map. The horizontal coordinate is cbrt(n.v) from 0 to 1,
// which gives grazing angles more room.
static double map_nov(int column)
{
    double x = (column + 0.5) / MAP;
    return x * x * x;
}

// Computes the light that a white surface reflects in a uniformly white environment, which would be
// 1 without errors: the single bounce E, plus Kulla and Conty's lobe. That lobe integrates to 1 - E
// as the table stores it, because E_avg is computed from the same table.
static kiln_result furnace(tables *t, kiln_g g, const storage *s, kiln_image *light)
{
    kiln_table table;
    kiln_table_def def = {.model.g = g, .axis = s->axis, .corners = s->corners};
    kiln_result result = kiln_table_create(t->page.context, &def, &table, t->error);
    if (!result)
        result = kiln_image_create(t->page.context, MAP, MAP, 1, light, t->error);
    for (int i = 0; i < SIZE * SIZE && !result && s->rounded; i++)
        table.image.pixels[i] = s->rounded(table.image.pixels[i]);
    for (int i = 0; i < MAP * MAP && !result; i++) {
        int row = i / MAP;
        double nov = map_nov(i % MAP), roughness = 1 - (row + 0.5) / MAP, e;
        kiln_table_lookup(&table, nov, roughness, 0, &e);
        light->pixels[i] = (float)(kiln_energy(&def.model, roughness, nov) + 1 - e);
    }
    kiln_table_free(&table);
    return result;
}

static kiln_result show_storage(tables *t, kiln_g g, const storage *s, const kiln_image *white)
{
    kiln_image light = {0}, map = {0};
    kiln_difference off = {0};
    kiln_result result = furnace(t, g, s, &light);
    if (!result)
        result = kiln_assignment_compare(t->page.context, &light, white, &off, &map, t->error);
    fputs("<figure>", t->page.file);
    if (!result)
        result = demo_page_picture(&t->page, &map, "texels", "Error of the furnace", t->error);
    fprintf(t->page.file,
            "<figcaption>%s: <b>%.2g</b> at most, <b>%.1g</b> rms</figcaption></figure>\n",
            s->caption, off.max, off.rms);
    kiln_image_free(&light);
    return result;
}

static kiln_result show_furnace(tables *t)
{
    static const storage storages[] = {
        {KILN_AXIS_LINEAR, false, NULL, "n&middot;v, texel centres"},
        {KILN_AXIS_SQRT, true, NULL, "&radic;(n&middot;v), corners"},
        {KILN_AXIS_CBRT, true, NULL, "&#8731;(n&middot;v), corners"},
        {KILN_AXIS_GRAZING, true, NULL, "grazing axis, corners"},
        {KILN_AXIS_LINEAR, false, to_byte, "n&middot;v, 8 bits"},
        {KILN_AXIS_LINEAR, false, to_half, "n&middot;v, half floats"},
        {KILN_AXIS_GRAZING, true, to_byte, "grazing axis, 8 bits"},
        {KILN_AXIS_GRAZING, true, to_half, "grazing axis, half floats"},
    };
    static const kiln_g shown[] = {KILN_G_SMITH, KILN_G_SCHLICK_K2};
    kiln_image white = {0};
    kiln_result result = kiln_image_create(t->page.context, MAP, MAP, 1, &white, t->error);
    for (int i = 0; i < MAP * MAP && !result; i++)
        white.pixels[i] = 1;
    fputs(
        "<h2 id=\"furnace\">Where the lookup errs</h2>\n"
        "<p>A white surface in white light, lit by its single bounce and Kulla and Conty&rsquo;s "
        "lobe, must be white. With the functions it is, to twelve digits. With a table of 128 "
        "&times; 128 it is the lookup between texels that errs, all of it at grazing angles: that "
        "layer is as wide as roughness&sup2;. So n&middot;v is stored on a curved axis. The best "
        "is &radic;(n&middot;v (1 + &alpha;) / (n&middot;v + &alpha;)), on which the layer is as "
        "wide at every roughness. In the maps n&middot;v is on a cubic scale: the left half is "
        "n&middot;v below 1/8.</p>\n",
        t->page.file);
    if (!result)
        result = demo_signed_legend(&t->page, t->error);
    for (int g = 0; g < 2 && !result; g++) {
        fprintf(t->page.file, "<div class=\"pair\"><h4>%s</h4>\n", model_names[shown[g]]);
        for (size_t i = 0; i < sizeof storages / sizeof *storages && !result; i++)
            result = show_storage(t, shown[g], &storages[i], &white);
        fputs("</div>\n", t->page.file);
    }
    kiln_image_free(&white);
    return result;
}

// -------------------------------------------------------------------------------------------- cost

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static kiln_result show_cost(tables *t)
{
    static const struct {
        kiln_table_def def;
        const char *name;
    } timed[] = {
        {{.width = 128}, "E, 128 &times; 128"},
        {{.width = 512, .height = 512}, "E, 512 &times; 512"},
        {{.kind = KILN_TABLE_DFG}, "A and B, 128 &times; 128"},
        {{.kind = KILN_TABLE_DFG, .width = 512, .height = 512}, "A and B, 512 &times; 512"},
        {{.kind = KILN_TABLE_SHEEN}, "Charlie sheen, 128 &times; 128"},
        {{.kind = KILN_TABLE_E_DIELECTRIC}, "dielectric E, 32 &times; 32 &times; 32"},
    };
    kiln_result result = KILN_OK;
    fputs("<h2 id=\"cost\">What they cost here</h2>\n<div class=\"scroll\"><table><thead><tr>"
          "<th>table</th><th>seconds</th></tr></thead><tbody>\n",
          t->page.file);
    for (size_t i = 0; i < sizeof timed / sizeof *timed && !result; i++) {
        kiln_table table;
        double began = seconds();
        result = kiln_table_create(t->page.context, &timed[i].def, &table, t->error);
        fprintf(t->page.file, "<tr><td>%s</td><td>%.2g</td></tr>\n", timed[i].name,
                seconds() - began);
        kiln_table_free(&table);
    }
    fputs("</tbody></table></div>\n", t->page.file);
    return result;
}

// -------------------------------------------------------------------------------------------- page

static kiln_result show(tables *t)
{
    demo_page_head(t->page.file);
    fputs("<header><div><h1>Exact tables</h1><p class=\"lead\">What rough surfaces give back, as "
          "integrals instead of samples, and how to store it so that white stays white.</p>\n"
          "<nav><a href=\"index.html\">kiln</a><a href=\"#tables\">The tables</a>"
          "<a href=\"#furnace\">The lookup</a><a href=\"#cost\">The cost</a>"
          "<a href=\"assignment.html\">The assignment</a></nav></div></header>\n<main>\n",
          t->page.file);
    kiln_result result = show_kinds(t);
    if (!result)
        result = show_furnace(t);
    if (!result)
        result = show_cost(t);
    demo_page_foot(t->page.file, "Errors are measured against the integrals, texel by texel.");
    return result;
}

kiln_result demo_tables_page(kiln_context *context, const char *folder, const char *scratch,
                             kiln_error *error)
{
    printf("the tables\n");
    FILE *f = demo_page_open(folder, "tables.html", error);
    if (!f)
        return error->result;
    tables t = {{f, scratch, context}, error};
    return demo_page_close(f, folder, "tables.html", show(&t), error);
}
