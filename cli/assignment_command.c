// kiln assignment: makes what GAMES202's fourth assignment asks for. In: an output folder. Out: the
// tables, the balls rendered with them, and the report. assignment.c makes the tables; the viewer's
// renderer, or its reference on machines without OpenGL, draws the balls.
#include "assignment.h"

#include "headless.h"
#include "reference.h"
#include "scene_setup.h"
#include "viewer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct values {
    const char *output, *size;
    bool quiet;
} values;

static const cli_option options[] = {
    {"output", CLI_FILE, offsetof(values, output), .value = "DIR", .letter = 'o',
     .help = "the folder for the files, which is created if missing"},
    {"size", CLI_TEXT, offsetof(values, size), SCENE_SIZE_WORDS},
    CLI_QUIET_ROW(values),
    {.name = NULL},
};

typedef struct pictures {
    int width, height;
    char by[128]; ///< name of what drew the balls: the OpenGL renderer or the CPU's integrator
    bool on_cpu;  ///< true: OpenGL is not available, and the CPU shaded the balls
    /// largest difference, in steps of 255, between balls drawn with the 8-bit tables and with
    /// exact tables
    double largest;
    double rms;
} pictures;

// Makes a table of the values that the assignment's framework reads from the PNG of this table,
// which are truncated to bytes.
static kiln_result load_bytes(const assignment *a, int table, kiln_table *to)
{
    const kiln_image *from = &a->table[table];
    to->def = (kiln_table_def){
        .model = {.g = a->def->g}, .width = from->width, .height = from->height, .flip = true};
    kiln_result result = kiln_image_create(a->work->context, from->width, from->height, 1,
                                           &to->image, &a->work->error);
    if (result == KILN_OK) {
        memcpy(to->image.pixels, from->pixels,
               (size_t)from->width * (size_t)from->height * sizeof *from->pixels);
        kiln_assignment_truncate(&to->image);
    }
    return result;
}

static kiln_result use_bytes(const assignment *a, view_renderer *renderer)
{
    kiln_table e = {0}, average = {0};
    kiln_result result = load_bytes(a, ASSIGNMENT_IS, &e);
    if (result == KILN_OK)
        result = load_bytes(a, ASSIGNMENT_AVERAGE_BYTES, &average);
    if (result == KILN_OK)
        result = view_set_tables(renderer, &e, &average, NULL, &a->work->error);
    kiln_image_free(&e.image);
    kiln_image_free(&average.image);
    return result;
}

// Draws the balls without OpenGL: the CPU shades the same rays as the renderer does, with exact E
// instead of a table.
static kiln_result shade(assignment *a, const view_options *o, kiln_image *image)
{
    const pictures *p = a->def->user;
    kiln_result result = view_reference(a->work->context, o, NULL, p->width, p->height, NULL, image,
                                        NULL, &a->work->error);
    for (size_t i = 0; result == KILN_OK && i < (size_t)p->width * (size_t)p->height; i++) {
        double c[3];
        for (size_t k = 0; k < 3; k++)
            c[k] = (double)image->pixels[3 * i + k];
        view_tone(o->scene, c, c);
        for (size_t k = 0; k < 3; k++)
            image->pixels[3 * i + k] = (float)c[k];
    }
    return result;
}

static kiln_result picture(assignment *a, view_renderer *renderer, const view_options *o,
                           kiln_image *image)
{
    const pictures *p = a->def->user;
    if (!renderer)
        return shade(a, o, image);
    return view_picture(renderer, o, p->width, p->height, false, image, &a->work->error);
}

static void compare(const kiln_image *a, const kiln_image *b, pictures *p)
{
    double squares = 0;
    size_t count = (size_t)p->width * (size_t)p->height * 3;
    for (size_t i = 0; i < count; i++) {
        double off = 255 * fabs((double)a->pixels[i] - (double)b->pixels[i]);
        squares += off * off;
        p->largest = fmax(p->largest, off);
    }
    p->rms = sqrt(squares / (double)count);
}

static kiln_result draw_all(assignment *a, view_renderer *renderer)
{
    static const char *const names[] = {"balls_exact", "balls", "balls_microfacet",
                                        "balls_as_printed"};
    kiln_image image[4] = {{0}};
    kiln_result result = KILN_OK;
    for (int i = 0; i < 4 && result == KILN_OK; i++) {
        view_options o = view_defaults(VIEW_SCENE_ASSIGNMENT);
        o.one_row = i == 2;
        o.as_printed = i == 3;
        if (i == 1 && renderer)
            result = use_bytes(a, renderer);
        if (result == KILN_OK)
            result = picture(a, renderer, &o, &image[i]);
        if (result == KILN_OK && i > 0)
            result = assignment_save(a, &image[i], "", names[i]);
    }
    if (result == KILN_OK)
        compare(&image[1], &image[0], a->def->user);
    for (int i = 0; i < 4; i++)
        kiln_image_free(&image[i]);
    return result;
}

static kiln_result draw(assignment *a)
{
    pictures *p = a->def->user;
    view_headless *headless = NULL;
    view_renderer *renderer = NULL;
    kiln_error why = {0};
    kiln_result result = view_headless_create(&headless, &why);
    if (result == KILN_OK) {
        result = view_create(a->work->context, view_headless_lookup, &renderer, &a->work->error);
        if (result == KILN_OK)
            snprintf(p->by, sizeof p->by, "%s", view_gl_name(renderer));
    } else {
        cli_note(a->work, true, "%s; the balls are shaded on the CPU instead", why.message);
        p->on_cpu = true;
        result = KILN_OK;
    }
    if (result == KILN_OK)
        result = draw_all(a, renderer);
    view_destroy(renderer);
    view_headless_destroy(headless);
    return result;
}

// ------------------------------------------------------------------------------------------ report

static void describe(const assignment *a, FILE *f)
{
    const pictures *p = a->def->user;
    fprintf(f, "\n## The two rows of balls\n\nSection 2.3 of the assignment asks for two rows of "
               "five copper balls. The upper row has the microfacet lobe and Kulla and Conty's "
               "lobe, the lower row the microfacet lobe alone. The roughness is 0.95 at the left "
               "and 0.15 at the right. One directional light of radiance 1 shines along (0, 0, "
               "-1). The camera is at (0, 80, 300) with a vertical field of view of 75 degrees. A "
               "colour c is shown as (c / (c + 1))^(1 / 2.2). The balls are spheres of radius 36, "
               "and each pixel is the mean of 4 x 4 rays.\n\n");
    if (p->on_cpu)
        fputs("The balls are shaded on the CPU in double precision with the exact E, because EGL "
              "was not available.\n\n",
              f);
    else
        fprintf(f,
                "The balls are drawn by %s with the tables `Emu_IS.png` and `Eavg_from_bytes`, "
                "which the assignment's framework reads too. With exact tables the picture differs "
                "by %.2f of 255 (RMS) and by at most %.1f of 255.\n\n",
                p->by, p->rms, p->largest);
    fputs("| picture | what it is |\n|---|---|\n"
          "| ![](balls.png)<br>`balls.png` | the two rows: figure 6 without its mistake |\n"
          "| ![](balls_microfacet.png)<br>`balls_microfacet.png` | the row with the microfacet "
          "lobe alone: figure 5 |\n"
          "| ![](balls_as_printed.png)<br>`balls_as_printed.png` | the two rows with the mistake "
          "of figure 6 |\n\n"
          "**Figure 6 has a mistake.** The framework's material names its table of E_avg "
          "`uEavgFLut`, but the shader reads `uEavgLut`. No texture is bound to the sampler "
          "`uEavgLut`, so that it reads texture unit 0, which holds the balls' colour. Therefore "
          "E_avg is (0.72, 0.45, 0.2) at every roughness, the factor f_add / (1 - E_avg) differs "
          "between the channels, and rough balls become orange. On the roughest ball linear red "
          "divided by linear green is 5.2, where the model gives 2.6.\n\n**The factor f_add counts "
          "the first bounce twice.** The assignment's factor F E / (1 - F (1 - E)) is the sum over "
          "all bounces from the first on, but the microfacet lobe contains the first bounce "
          "already. The sum from the second bounce on is F^2 E / (1 - F (1 - E)). The pictures "
          "here have the assignment's factor. `kiln render --method kulla-conty` has the factor "
          "from the second bounce on.\n",
          f);
}

static int run(const cli_call *call)
{
    cli_arguments a;
    cli_work work;
    values v;
    pictures p = {.rms = 0};
    int code = cli_read_arguments(&a, &cli_assignment, call, &v);
    if (code != CLI_GO)
        return code;
    assignment_def def = {.folder = v.output,
                          .size = 128,
                          .samples = 1024,
                          .g = KILN_G_SCHLICK_K2,
                          .quiet = v.quiet,
                          .draw = draw,
                          .describe = describe,
                          .user = &p};
    if (a.rest_count)
        return cli_wrong(&cli_assignment,
                         "%s: kiln assignment takes no input, name the output by -o DIR",
                         a.rest[0]);
    if (!def.folder)
        return cli_wrong(&cli_assignment, "no output: name a folder by -o DIR");
    code = scene_read_size(&cli_assignment, v.size, &p.width, &p.height);
    if (code != CLI_GO)
        return code;
    code = assignment_check_folder(&cli_assignment, def.folder);
    if (code != CLI_GO)
        return code;
    code = cli_begin_work(&work, 0, def.quiet);
    if (code == CLI_GO)
        code = assignment_write(&work, &def);
    return cli_end_work(&work, code);
}

static const cli_example examples[] = {
    {"kiln assignment -o images/", NULL},
    {"kiln assignment -o images/ --size 1920x1080", "with larger pictures of the balls"},
    {NULL, NULL}};

const cli_command cli_assignment = {
    .name = "assignment",
    .arguments = "-o DIR",
    .summary = "Makes the tables, pictures and report for assignment 4 of GAMES202.",
    .about = "The tables are those of 'kiln tables --assignment'. The balls are drawn with these "
             "tables. The file report.md describes the methods, their errors, and the mistakes of "
             "the assignment.",
    .more = "The pictures show two rows of balls, one row with the microfacet lobe alone, and two "
            "rows with the mistake of the assignment's figure 6.",
    .examples = examples,
    .options = options,
    .run = run,
};
