// demo OUTDIR [PANORAMA...] writes the demo's web pages. In: a computed sky and any panoramas. Out:
// index.html with the levels, errors and times of each bake; also the pages of assignment.c,
// tables.c and gallery.c. The errors are relative to a numerical integration of the unfiltered map.
//
// demo --picture FILE.png draws only a row of balls.
#include "demo.h"

#include <errno.h>
#include <kiln/course.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum {
    SOFT = 64,     // smallest edge, in texels, of the cubes that balls mirror
    BALL = 240,    // diameter of a ball in pixels
    CROSS = 128,   // largest edge of a cubemap face in pixels, in pictures of unfolded cubes
    COMPARED = 16, // edge in texels of the cubes whose errors are measured
    COMPARED_TEXELS = 6 * COMPARED * COMPARED,
    SAMPLES = 1024, // samples for each texel of the textbook's importance-sampled prefilter
    STEPS = 100,    // steps in phi and in theta of the textbook's irradiance
    // edge in texels of the cubes that kiln and the textbook's loops bake for the comparison of
    // times
    TIMED = 64,
    TIMED_LEVELS = 7,
};

static const float compared_roughness[] = {0.125F, 0.25F, 0.5F, 1.0F};
enum { COMPARED_LEVELS = sizeof compared_roughness / sizeof *compared_roughness };

typedef struct demo_time {
    double wall, cpu; ///< seconds of a clock and of CPU time
} demo_time;

typedef struct demo_figures {
    double rms, max; ///< RMS and largest relative error
} demo_figures;

typedef struct demo {
    kiln_context *context;
    kiln_error error;
    demo_page page; ///< collects the sections' HTML in memory
    char scratch[1024];

    // Data of the environment whose section is being written.
    int index;
    kiln_map source;
    kiln_environment environment;
    /// the levels with fewer than SOFT texels a side, filtered again with SOFT texels a side
    kiln_map soft[KILN_MAX_LEVELS];
    demo_level balls[KILN_MAX_LEVELS];
    kiln_plan *plan;
    const kiln_spectrum *spectrum;
    demo_view view;
    demo_time load, bake, again, exact, textbook, irradiance_exact, irradiance_textbook;

    // Data of the whole demo, for all environments.
    bool has_gallery;
    kiln_image row; ///< picture of the first environment's row of balls
    demo_figures worst_exact, worst_textbook;
    double first_bake, first_textbook_ratio;
} demo;

static demo_time now(void)
{
    struct timespec wall, cpu;
    clock_gettime(CLOCK_MONOTONIC, &wall);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    return (demo_time){(double)wall.tv_sec + 1e-9 * (double)wall.tv_nsec,
                       (double)cpu.tv_sec + 1e-9 * (double)cpu.tv_nsec};
}

static demo_time since(demo_time start)
{
    demo_time end = now();
    return (demo_time){end.wall - start.wall, end.cpu - start.cpu};
}

// Writes an error as text: percent for larger errors ("0.08 %"), powers of ten for small ones
// ("1.3e-6").
static const char *error_text(double error, char text[64])
{
    if (error >= 1e-3)
        snprintf(text, 64,
                 error >= 0.1    ? "%.0f%%"
                 : error >= 0.01 ? "%.1f%%"
                                 : "%.2f%%",
                 100 * error);
    else {
        int exponent = error > 0 ? (int)floor(log10(error)) : 0;
        snprintf(text, 64, "%.1f&middot;10<sup>&minus;%d</sup>", error / pow(10, exponent),
                 -exponent);
    }
    return text;
}

static const char *time_text(double seconds, char text[64])
{
    if (seconds < 1)
        snprintf(text, 64, seconds < 0.01 ? "%.1f ms" : "%.0f ms", 1000 * seconds);
    else
        snprintf(text, 64, seconds < 10 ? "%.2f s" : "%.0f s", seconds);
    return text;
}

// Writes a picture with a caption. The caption is HTML.
static kiln_result figure(demo *d, kiln_image *image, const char *style_class, const char *alt,
                          const char *caption)
{
    fputs("<figure>", d->page.file);
    kiln_result result = demo_page_picture(&d->page, image, style_class, alt, &d->error);
    fprintf(d->page.file, "<figcaption>%s</figcaption></figure>\n", caption);
    return result;
}

// ------------------------------------------------------------------------------------------- input

static kiln_result show_input(demo *d, const char *title, const char *story)
{
    const kiln_map *source = &d->source;
    double peak = 0, mean = 0, weights = 0;
    for (int y = 0; y < source->size; y++) {
        double weight = sin((y + 0.5) * 3.14159265358979323846 / source->size);
        for (int x = 0; x < 2 * source->size; x++) {
            const float *t =
                source->level[0] + 3 * ((size_t)y * 2 * (size_t)source->size + (size_t)x);
            double l = 0.2126 * (double)t[0] + 0.7152 * (double)t[1] + 0.0722 * (double)t[2];
            mean += weight * l;
            weights += weight;
            peak = l > peak ? l : peak;
        }
    }
    mean /= weights;
    FILE *f = d->page.file;
    fprintf(f, "<h2 id=\"e%d\">", d->index);
    demo_page_text(f, title);
    fprintf(f, "</h2>\n<p>%s</p>\n", story);
    char caption[256], times[32];
    if (peak < 100 * mean)
        snprintf(times, sizeof times, "%.0f", peak / mean);
    else
        snprintf(times, sizeof times, peak < 1e4 * mean ? "%.0f00" : "%.0f,000",
                 peak / mean / (peak < 1e4 * mean ? 100 : 1000));
    snprintf(caption, sizeof caption,
             "The input: <b>%d&times;%d</b> texels, each the radiance that arrives from one "
             "direction. The brightest is <b>%s times</b> the mean.",
             2 * source->size, source->size, times);
    kiln_image image;
    kiln_result result =
        demo_picture_panorama(d->context, source, 384, &d->view, &image, &d->error);
    if (!result)
        result = figure(d, &image, "wide", "The panorama", caption);
    return result;
}

// ------------------------------------------------------------------------------------------ levels

static kiln_result show_levels(demo *d)
{
    FILE *f = d->page.file;
    kiln_result result = KILN_OK;
    fprintf(f,
            "<h3>What a surface mirrors, from smooth to rough</h3>\n"
            "<p>Each ball mirrors the world as filtered for one roughness. A smooth surface shows "
            "the world as it is; the "
            "rougher it gets, the wider the part of the world that it averages.</p>\n"
            "<div class=\"turn\" data-balls=\"balls%d\" hidden><div class=\"stack\"></div><label>"
            "Roughness <output></output><input type=\"range\" min=\"0\" max=\"1\" step=\"0.01\" "
            "value=\"0.25\"><span class=\"soft\">Between two levels a renderer fades from one to "
            "the next, as this slider does.</span></label></div>\n"
            "<div class=\"balls\" id=\"balls%d\">\n",
            d->index, d->index);
    char caption[128];
    for (int k = 0; k < d->environment.levels.level_count && !result; k++) {
        kiln_image image;
        result =
            demo_picture_ball(d->context, d->balls[k], false, BALL, &d->view, &image, &d->error);
        snprintf(caption, sizeof caption, "<b>%.3g</b>",
                 (double)d->environment.levels.roughness[k]);
        if (!result)
            result = figure(d, &image, "ball", "A ball mirroring one level", caption);
    }
    fputs("</div>\n<h3>The same levels, as the file holds them</h3>\n"
          "<p>A cube map has six faces, unfolded here as textures store them: seen from outside, "
          "so left and right are swapped. Blurred levels need few texels; each is half as large "
          "as the one before.</p>\n<div class=\"crosses\">\n",
          f);
    for (int k = 0; k < d->environment.levels.level_count && !result; k++) {
        kiln_image image;
        int size = kiln_map_level_size(&d->environment.levels, k);
        result = demo_picture_cross(d->context, &d->environment.levels, k, CROSS, &d->view, &image,
                                    &d->error);
        snprintf(caption, sizeof caption, "Roughness <b>%.3g</b>, six faces of %d&times;%d",
                 (double)d->environment.levels.roughness[k], size, size);
        if (!result)
            result = figure(d, &image, "texels", "An unfolded cube", caption);
    }
    fputs("</div>\n", f);
    return result;
}

// --------------------------------------------------------------------------------------- comparing

static demo_figures compare(const kiln_map *map, int level, double (*truth)[3], double *errors)
{
    double sum = 0, whole = 0;
    demo_figures figures = {0};
    for (int i = 0; i < COMPARED_TEXELS; i++) {
        errors[i] = 0;
        for (int c = 0; c < 3; c++) {
            double off = (double)map->level[level][3 * i + c] - truth[i][c];
            double relative = truth[i][c] > 0 ? fabs(off) / truth[i][c] : 0;
            sum += off * off;
            whole += truth[i][c] * truth[i][c];
            errors[i] = relative > errors[i] ? relative : errors[i];
        }
        figures.max = errors[i] > figures.max ? errors[i] : figures.max;
    }
    figures.rms = whole > 0 ? sqrt(sum / whole) : 0;
    return figures;
}

typedef struct comparison {
    kiln_map exact, textbook;
    int textbook_level;
    demo_figures figures[2];
} comparison;

static kiln_result show_comparison(demo *d, comparison *c, const char *title, double (*truth)[3],
                                   const char *textbook_name)
{
    static double errors[2][COMPARED_TEXELS];
    c->figures[0] = compare(&c->exact, 0, truth, errors[0]);
    c->figures[1] = compare(&c->textbook, c->textbook_level, truth, errors[1]);
    demo_figures *worst[2] = {&d->worst_exact, &d->worst_textbook};
    for (int i = 0; i < 2; i++) {
        worst[i]->rms = fmax(worst[i]->rms, c->figures[i].rms);
        worst[i]->max = fmax(worst[i]->max, c->figures[i].max);
    }
    char caption[4][160], text[64];
    snprintf(caption[0], sizeof *caption, "<b>kiln</b>");
    snprintf(caption[1], sizeof *caption, "its error: <b>%s</b> rms",
             error_text(c->figures[0].rms, text));
    snprintf(caption[2], sizeof *caption, "<b>textbook</b>, %s", textbook_name);
    snprintf(caption[3], sizeof *caption, "its error: <b>%s</b> rms",
             error_text(c->figures[1].rms, text));
    fprintf(d->page.file, "<div class=\"pair\"><h4>%s</h4>\n", title);
    kiln_result result = KILN_OK;
    for (int i = 0; i < 4 && !result; i++) {
        kiln_image image;
        if (i % 2)
            result = demo_picture_errors(d->context, errors[i / 2], COMPARED, &image, &d->error);
        else
            result = demo_picture_cross(d->context, i ? &c->textbook : &c->exact,
                                        i ? c->textbook_level : 0, COMPARED, &d->view, &image,
                                        &d->error);
        if (!result)
            result =
                figure(d, &image, "texels", i % 2 ? "Error map" : "An unfolded cube", caption[i]);
    }
    fputs("</div>\n", d->page.file);
    return result;
}

static void show_figures(demo *d, const comparison *comparisons, int count)
{
    FILE *f = d->page.file;
    fputs("<div class=\"scroll\"><table><thead><tr><th></th><th>kiln rms</th><th>largest</th>"
          "<th>textbook rms</th><th>largest</th></tr></thead><tbody>\n",
          f);
    for (int i = 0; i < count; i++) {
        const demo_figures *e = comparisons[i].figures;
        char text[4][64];
        if (i < COMPARED_LEVELS)
            fprintf(f, "<tr><td>roughness %g</td>", (double)compared_roughness[i]);
        else
            fputs("<tr><td>irradiance</td>", f);
        fprintf(f, "<td class=\"good\">%s</td><td>%s</td><td>%s</td><td>%s</td></tr>\n",
                error_text(e[0].rms, text[0]), error_text(e[0].max, text[1]),
                error_text(e[1].rms, text[2]), error_text(e[1].max, text[3]));
    }
    fprintf(f,
            "</tbody></table></div>\n<p class=\"note\">Relative errors of the linear values over "
            "the three channels of all %d texels; rms is the root of the sum of squared errors "
            "over that of the squared truth. The truth is the sum over every texel of the input "
            "in double precision.</p>\n",
            COMPARED_TEXELS);
}

static kiln_result show_textbook(demo *d)
{
    static double directions[COMPARED_TEXELS][3], truth[COMPARED_TEXELS][3];
    comparison all[COMPARED_LEVELS + 1] = {0};
    kiln_map lattice = {0};
    kiln_result result =
        kiln_map_create(d->context, KILN_SHAPE_CUBE, COMPARED, 1, &lattice, &d->error);
    for (int i = 0; i < COMPARED_TEXELS && !result; i++)
        kiln_map_direction(&lattice, 0, (size_t)i, directions[i]);
    kiln_map_free(&lattice);
    fprintf(
        d->page.file,
        "<h3>Exact, beside the textbook</h3>\n<p>Courses teach to look in %d directions a texel "
        "and to average what is there. That is off by percents, and where it hits or misses "
        "the sun, by much more: the white dots are known as fireflies. kiln multiplies two "
        "spectra instead. It has no samples, so it has no noise. The error maps compare each "
        "texel with the sum over every texel of the input.</p>\n",
        SAMPLES);
    demo_page_legend(d->page.file);
    for (int i = 0; i < COMPARED_LEVELS && !result; i++) {
        comparison *c = &all[i];
        double r = (double)compared_roughness[i];
        kiln_lobe lobe = kiln_lobe_ggx(r * r);
        printf("  roughness %g\n", r);
        kiln_prefilter_def def = {
            .size = COMPARED, .level_count = 1, .roughness = &compared_roughness[i]};
        // The textbook's prefilter spaces roughness evenly over the levels: with this number of
        // levels, level 1 has roughness r.
        kiln_textbook_def taught = {.shape = KILN_SHAPE_CUBE,
                                    .size = 2 * COMPARED,
                                    .level_count = 1 + (int)lround(1 / r),
                                    .sample_count = SAMPLES};
        c->textbook_level = 1;
        result = kiln_prefilter(d->context, &d->source, &def, &c->exact, &d->error);
        if (!result)
            result =
                kiln_textbook_prefilter(d->context, &d->source, &taught, &c->textbook, &d->error);
        if (!result)
            result = kiln_reference_filter(d->context, &d->source, &lobe, 0,
                                           (const double(*)[3])directions, COMPARED_TEXELS, truth,
                                           &d->error);
        char title[64];
        snprintf(title, sizeof title, "Roughness %g", r);
        if (!result)
            result = show_comparison(d, c, title, truth, "1024 samples");
    }
    // Irradiance is compared with true values of its own, because its cosine lobe differs from the
    // lobe of roughness 1.
    comparison *c = &all[COMPARED_LEVELS];
    kiln_prefilter_def def = {.size = COMPARED, .level_count = 1, .lobe = KILN_LOBE_LAMBERT};
    kiln_textbook_def taught = {.shape = KILN_SHAPE_CUBE,
                                .size = COMPARED,
                                .level_count = 1,
                                .phi_count = STEPS,
                                .theta_count = STEPS};
    demo_time start = now();
    if (!result)
        result = kiln_prefilter(d->context, &d->source, &def, &c->exact, &d->error);
    d->irradiance_exact = since(start);
    start = now();
    if (!result)
        result = kiln_textbook_irradiance(d->context, &d->source, &taught, &c->textbook, &d->error);
    d->irradiance_textbook = since(start);
    if (!result)
        result = show_comparison(d, c, "Irradiance, what a white matte surface reflects", truth,
                                 "100 &times; 100 steps");
    if (!result)
        show_figures(d, all, COMPARED_LEVELS + 1);
    for (int i = 0; i <= COMPARED_LEVELS; i++) {
        kiln_map_free(&all[i].exact);
        kiln_map_free(&all[i].textbook);
    }
    return result;
}

// ----------------------------------------------------------------------------- spherical harmonics

static double sh_error(const kiln_sh *sh, const kiln_map *exact)
{
    double sum = 0, whole = 0;
    for (size_t i = 0; i < kiln_map_texels(exact, 0); i++) {
        double direction[3], value[3];
        kiln_map_direction(exact, 0, i, direction);
        kiln_sh_evaluate(sh, direction, value);
        for (size_t c = 0; c < 3; c++) {
            double truth = (double)exact->level[0][3 * i + c];
            double off = value[c] / 3.14159265358979323846 - truth;
            sum += off * off;
            whole += truth * truth;
        }
    }
    return sqrt(sum / whole);
}

static kiln_result show_harmonics(demo *d)
{
    FILE *f = d->page.file;
    kiln_map exact = {0};
    kiln_image image;
    kiln_lobe lambert = kiln_lobe_lambert();
    char caption[160], text[64];
    kiln_result result = kiln_map_create(d->context, KILN_SHAPE_CUBE, 32, 1, &exact, &d->error);
    if (!result)
        result = kiln_spectrum_filter(d->context, d->spectrum, &lambert, 0, &exact, 0, &d->error);
    fputs(
        "<h3>In nine numbers: spherical harmonics</h3>\n<p>Matte light changes so slowly that a "
        "few waves around the sphere hold it. Three bands are nine numbers a channel, five are "
        "twenty-five. They are poor pictures of the world, negative where it shows black, and good "
        "pictures of its light.</p>\n"
        "<div class=\"three\">\n",
        f);
    if (!result)
        result = demo_picture_panorama(d->context, &d->source, 160, &d->view, &image, &d->error);
    if (!result)
        result = figure(d, &image, "wide", "The panorama", "the world");
    for (int bands = 3; bands <= 5 && !result; bands += 2) {
        kiln_sh sh;
        result = kiln_spectrum_sh(d->spectrum, bands, false, 0, 0, &sh, &d->error);
        if (!result)
            result = demo_picture_sh(d->context, &sh, 160, &d->view, &image, &d->error);
        snprintf(caption, sizeof caption, "<b>%d bands</b> of its radiance", bands);
        if (!result)
            result = figure(d, &image, "wide", "Radiance from harmonics", caption);
    }
    fputs("</div>\n<div class=\"three\">\n", f);
    if (!result)
        result = demo_picture_ball(d->context, (demo_level){&exact, 0}, true, BALL, &d->view,
                                   &image, &d->error);
    if (!result)
        result = figure(d, &image, "ball", "A matte ball", "a white matte ball, exact");
    for (int bands = 3; bands <= 5 && !result; bands += 2) {
        kiln_sh sh;
        result = kiln_spectrum_sh(d->spectrum, bands, true, 0, 0, &sh, &d->error);
        if (!result)
            result = demo_picture_sh_ball(d->context, &sh, BALL, &d->view, &image, &d->error);
        if (result)
            break;
        snprintf(caption, sizeof caption, "from <b>%d bands</b>, off by <b>%s</b> rms", bands,
                 error_text(sh_error(&sh, &exact), text));
        result = figure(d, &image, "ball", "A matte ball from harmonics", caption);
    }
    fputs("</div>\n", f);
    kiln_map_free(&exact);
    return result;
}

// ------------------------------------------------------------------------------------------- times

static kiln_result measure(demo *d)
{
    kiln_prefilter_def def = {.size = TIMED, .level_count = TIMED_LEVELS};
    kiln_textbook_def taught = {.shape = KILN_SHAPE_CUBE,
                                .size = TIMED,
                                .level_count = TIMED_LEVELS,
                                .sample_count = SAMPLES};
    kiln_map exact = {0}, textbook = {0};
    demo_time start = now();
    kiln_result result = kiln_prefilter(d->context, &d->source, &def, &exact, &d->error);
    d->exact = since(start);
    start = now();
    if (!result)
        result = kiln_textbook_prefilter(d->context, &d->source, &taught, &textbook, &d->error);
    d->textbook = since(start);
    start = now();
    if (!result)
        result = kiln_plan_execute(d->plan, &d->source, &d->environment, &d->error);
    d->again = since(start);
    kiln_map_free(&exact);
    kiln_map_free(&textbook);
    return result;
}

static void show_bar(demo *d, const char *name, demo_time time, double longest, bool own)
{
    char wall[64], cpu[64];
    fprintf(d->page.file,
            "<span>%s</span><div><i%s style=\"width:%.1f%%\"></i><b>%s</b><span class=\"soft\">%s "
            "CPU</span></div>\n",
            name, own ? " class=\"own\"" : "", 55 * time.wall / longest, time_text(time.wall, wall),
            time_text(time.cpu, cpu));
}

static void show_times(demo *d, const char *load_name)
{
    FILE *f = d->page.file;
    fputs("<h3>Measured while making this page</h3>\n<div class=\"bars\">\n", f);
    double longest = fmax(fmax(d->load.wall, d->bake.wall), d->again.wall);
    show_bar(d, load_name, d->load, longest, false);
    char name[128];
    snprintf(name, sizeof name, "bake it: 6 &times; %d&times;%d, %d levels",
             d->environment.levels.size, d->environment.levels.size,
             d->environment.levels.level_count);
    show_bar(d, name, d->bake, longest, true);
    show_bar(d, "bake again with the same plan", d->again, longest, true);
    fputs("</div>\n<div class=\"bars\">\n", f);
    longest = fmax(d->textbook.wall, d->irradiance_textbook.wall);
    snprintf(name, sizeof name, "kiln, 6 &times; %d&times;%d, %d levels", TIMED, TIMED,
             TIMED_LEVELS);
    show_bar(d, name, d->exact, longest, true);
    show_bar(d, "textbook, the same", d->textbook, longest, false);
    snprintf(name, sizeof name, "kiln, irradiance 6 &times; %d&times;%d", COMPARED, COMPARED);
    show_bar(d, name, d->irradiance_exact, longest, true);
    show_bar(d, "textbook, the same", d->irradiance_textbook, longest, false);
    fprintf(f,
            "</div>\n<p class=\"note\">One run each on this machine, all its cores (%s "
            "instructions), wall-clock time and the CPU time of all threads; no file is written. "
            "&ldquo;Again&rdquo; keeps what depends on sizes only. Both methods use the same "
            "threads.</p>\n",
            kiln_context_cpu(d->context));
}

// ------------------------------------------------------------------------------------ environments

static kiln_result bake(demo *d)
{
    kiln_bake_def def = {.irradiance_size = KILN_NO_IRRADIANCE};
    demo_time start = now();
    kiln_result result =
        kiln_plan_create(d->context, d->source.shape, d->source.size, &def, &d->plan, &d->error);
    if (!result)
        result = kiln_plan_environment(d->plan, &d->environment, &d->error);
    if (!result)
        result = kiln_plan_execute(d->plan, &d->source, &d->environment, &d->error);
    d->bake = since(start);
    if (result)
        return result;
    d->spectrum = kiln_plan_spectrum(d->plan);
    // A ball that mirrors a small level would show the level's texels as squares: levels with fewer
    // than SOFT texels a side are filtered again onto larger faces.
    for (int k = 0; k < d->environment.levels.level_count && !result; k++) {
        double r = (double)d->environment.levels.roughness[k];
        kiln_lobe lobe = kiln_lobe_ggx(r * r);
        d->balls[k] = (demo_level){&d->environment.levels, k};
        if (kiln_map_level_size(&d->environment.levels, k) >= SOFT)
            continue;
        d->balls[k] = (demo_level){&d->soft[k], 0};
        result = kiln_map_create(d->context, KILN_SHAPE_CUBE, SOFT, 1, &d->soft[k], &d->error);
        if (!result)
            result =
                kiln_spectrum_filter(d->context, d->spectrum, &lobe, 0, &d->soft[k], 0, &d->error);
    }
    return result ? result
                  : demo_view_choose(d->context, &d->source, d->spectrum, &d->view, &d->error);
}

static void release(demo *d)
{
    kiln_plan_destroy(d->plan);
    d->plan = NULL;
    kiln_environment_free(&d->environment);
    kiln_map_free(&d->source);
    for (int k = 0; k < KILN_MAX_LEVELS; k++)
        kiln_map_free(&d->soft[k]);
}

static kiln_result make_sky(demo *d)
{
    kiln_sky_def def = {.elevation = 12, .azimuth = 60, .albedo = 0.3};
    demo_time start = now();
    kiln_result result = kiln_sky(d->context, &def, &d->source, &d->error);
    d->load = since(start);
    return result;
}

static kiln_result load(demo *d, const char *path)
{
    demo_time start = now();
    kiln_result result = kiln_map_load(d->context, path, NULL, &d->source, &d->error);
    d->load = since(start);
    if (!result && d->source.shape != KILN_SHAPE_PANORAMA) {
        kiln_map panorama;
        result = kiln_map_convert(d->context, &d->source, KILN_SHAPE_PANORAMA, 2 * d->source.size,
                                  0, &panorama, &d->error);
        kiln_map_free(&d->source);
        if (!result)
            d->source = panorama;
    }
    return result;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// Writes the page's section about the panorama in the file `path`, or about the computed sky if
// `path` is NULL.
static kiln_result show_environment(demo *d, const char *path)
{
    const char *title = path ? base_name(path) : "A computed sky";
    printf("%s\n", title);
    kiln_result result = path ? load(d, path) : make_sky(d);
    if (!result)
        result = bake(d);
    if (!result && d->index == 0)
        result = demo_picture_row(d->context, d->balls, 8, 1600, 330, &d->view, &d->row, &d->error);
    if (!result)
        result = show_input(d, title,
                            path ? "A photographed environment."
                                 : "No photograph needed: an analytic daylight sky with the sun "
                                   "12&deg; above the horizon. The sun is the hard part. It "
                                   "fills a few texels and holds much of the light.");
    if (!result)
        result = show_levels(d);
    if (!result)
        result = show_textbook(d);
    if (!result)
        result = show_harmonics(d);
    if (!result)
        result = measure(d);
    if (!result)
        show_times(d, path ? "read the file" : "compute the sky");
    if (d->index == 0) {
        d->first_bake = d->bake.wall;
        d->first_textbook_ratio = d->textbook.cpu / d->exact.cpu;
    }
    release(d);
    d->index++;
    return result;
}

static kiln_result show_split_sum(demo *d)
{
    kiln_image table = {0}, image;
    printf("split-sum table\n");
    kiln_result result = kiln_textbook_brdf(d->context, 128, SAMPLES, &table, &d->error);
    FILE *f = d->page.file;
    fputs("<h2 id=\"table\">The other half: the split-sum table</h2>\n<div class=\"table\">\n"
          "<figure>",
          f);
    if (!result)
        result = demo_picture_table(d->context, &table, &image, &d->error);
    if (!result)
        result = demo_page_picture(&d->page, &image, "", "The split-sum table", &d->error);
    fputs("<span class=\"x\"><span>0</span><span>n&middot;v</span><span>1</span></span>"
          "<span class=\"y\"><span>0</span><span>roughness</span><span>1</span></span></figure>\n"
          "<div class=\"words\"><p>A baked level says what light a rough surface gathers. How much "
          "of it comes back depends on the angle of view (n&middot;v) and on the roughness, not "
          "on the environment: one small table serves all.</p><p>Red is A, green is B, and the "
          "colour of the reflection is</p><p><b>level &times; (F<sub>0</sub> &middot; A + B)"
          "</b></p><p class=\"soft\">This is the textbook&rsquo;s table, by 1024 samples an "
          "entry.</p></div></div>\n",
          f);
    kiln_image_free(&table);
    return result;
}

// ------------------------------------------------------------------------------------------- whole

static kiln_result write_page(demo *d, const char *path, const char *sections, char **names,
                              int count)
{
    FILE *f = fopen(path, "wb");
    if (!f) {
        snprintf(d->error.message, sizeof d->error.message, "%.400s: cannot be written: %s", path,
                 strerror(errno));
        return KILN_ERROR_IO;
    }
    d->page.file = f;
    char text[4][64];
    demo_page_head(f);
    fputs("<header>", f);
    kiln_result result = demo_page_picture(&d->page, &d->row, "",
                                           "Balls of rising roughness under a sky", &d->error);
    fprintf(f,
            "<div><h1>kiln</h1><p class=\"lead\">Exact image-based lighting: a panorama goes in, "
            "what surfaces of every roughness mirror of it comes out.</p>\n<div class=\"cards\">"
            "<div class=\"card\"><strong>%s</strong><span>to bake nine levels of 6 &times; "
            "256&times;256 for the sky below</span></div>"
            "<div class=\"card\"><strong>%s</strong><span>the largest rms error on this "
            "page</span></div>"
            "<div class=\"card\"><strong>%s</strong><span>that of the textbook&rsquo;s 1024 "
            "samples</span></div>"
            "<div class=\"card\"><strong>%.0f&times;</strong><span>the CPU time that the "
            "textbook takes for the same small map</span></div></div>\n<nav>",
            time_text(d->first_bake, text[0]), error_text(d->worst_exact.rms, text[1]),
            error_text(d->worst_textbook.rms, text[2]), d->first_textbook_ratio);
    for (int i = 0; i <= count; i++) {
        fprintf(f, "<a href=\"#e%d\">", i);
        demo_page_text(f, i ? base_name(names[i - 1]) : "A computed sky");
        fputs("</a>", f);
    }
    fprintf(f,
            "<a href=\"#table\">The split-sum table</a>"
            "<a href=\"tables.html\">Exact tables</a>"
            "<a href=\"assignment.html\">The assignment</a>%s</nav>\n</div></header>\n<main>\n%s",
            d->has_gallery ? "<a href=\"gallery.html\">In the engines</a>" : "", sections);
    demo_page_foot(f, "Pictures are brought to the screen by one exposure a section and a filmic "
                      "curve; every number is computed from the linear values.");
    bool failed = ferror(f);
    failed |= fclose(f) != 0;
    if (failed && !result) {
        snprintf(d->error.message, sizeof d->error.message, "%.400s: cannot be written", path);
        result = KILN_ERROR_IO;
    }
    return result;
}

static kiln_result make_page(demo *d, const char *folder, char **names, int count)
{
    char path[1024], *sections = NULL;
    size_t size;
    if (mkdir(folder, 0777) && errno != EEXIST) {
        snprintf(d->error.message, sizeof d->error.message, "%.400s: cannot be made: %s", folder,
                 strerror(errno));
        return KILN_ERROR_IO;
    }
    snprintf(path, sizeof path, "%s/index.html", folder);
    snprintf(d->scratch, sizeof d->scratch, "%s/picture.png", folder);
    d->page = (demo_page){open_memstream(&sections, &size), d->scratch, d->context};
    if (!d->page.file)
        return d->error.result = KILN_ERROR_MEMORY;
    kiln_result result = show_environment(d, NULL);
    for (int i = 0; i < count && !result; i++)
        result = show_environment(d, names[i]);
    if (!result)
        result = show_split_sum(d);
    fclose(d->page.file);
    if (!result)
        result = demo_assignment_page(d->context, folder, d->scratch, &d->error);
    if (!result)
        result = demo_tables_page(d->context, folder, d->scratch, &d->error);
    if (!result)
        result = demo_gallery_page(folder, &d->has_gallery, &d->error);
    if (!result)
        result = write_page(d, path, sections, names, count);
    free(sections);
    if (!result)
        printf("wrote %s\n", path);
    return result;
}

int main(int argc, char **argv)
{
    if (argc < 2 || argv[1][0] == '-') {
        fputs("usage: demo OUTDIR [PANORAMA...]\n", stderr);
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    demo d = {0};
    kiln_result result = kiln_context_create(NULL, &d.context, &d.error);
    if (!result)
        result = make_page(&d, argv[1], argv + 2, argc - 2);
    if (result)
        fprintf(stderr, "demo: %s\n", d.error.message);
    kiln_image_free(&d.row);
    kiln_context_destroy(d.context);
    return result ? 1 : 0;
}
