// The report of kiln bake: one line, more lines with --verbose, or JSON.
#include "bake.h"
#include "json.h"
#include "os.h"

#include <math.h>
#include <stdio.h>

static double total_seconds(const bake *b)
{
    double sum = 0;
    for (int i = 0; i < BAKE_STAGES; i++)
        sum += b->seconds[i];
    return sum;
}

static void report_input(const bake *b, json *j)
{
    json_object(j, "input");
    json_array(j, "files");
    for (int i = 0; i < b->arguments.rest_count; i++)
        json_text(j, NULL, b->arguments.rest[i]);
    json_end(j);
    json_text(j, "shape", bake_shapes[b->source_shape]);
    json_number(j, "width", b->source_width);
    json_number(j, "height", b->source_height);
    json_end(j);
}

static void report_output(const bake *b, json *j)
{
    json_object(j, "output");
    json_text(j, "path", b->output);
    if (b->irradiance_path)
        json_text(j, "irradiance", b->irradiance_path);
    if (b->sh_path)
        json_text(j, "sh", b->sh_path);
    if (b->lights_path)
        json_text(j, "lights", b->lights_path);
    json_number(j, "file_count", b->saved.file_count);
    json_text(j, "shape", bake_shapes[b->made.levels.shape]);
    json_number(j, "size", b->made.levels.size);
    json_number(j, "level_count", b->made.levels.level_count);
    if (b->engine && b->engine->formats[0])
        json_text(j, "format",
                  kiln_format_names()[b->format ? b->format : (int)b->engine->formats[0]]);
    json_array(j, "levels");
    for (int k = 0; k < b->made.levels.level_count; k++) {
        json_object(j, NULL);
        json_number(j, "size", kiln_map_level_size(&b->made.levels, k));
        json_rounded(j, "roughness", (double)b->made.levels.roughness[k], 9);
        json_end(j);
    }
    json_end(j);
    json_end(j);
}

static void report_cut(const char *key, const kiln_cut *cut, const kiln_save_report *saved, json *j)
{
    json_object(j, key);
    json_number(j, "value_count", (double)cut->value_count);
    json_number(j, "negative_count", (double)cut->cut_count);
    json_number(j, "negative_share", cut->share);
    json_number(j, "limit", saved->limit);
    json_number(j, "above_count", (double)saved->cut_count);
    json_number(j, "above_share", saved->light_share);
    json_end(j);
}

// Prints notes on what was found in the input and what was cut off in the output.
static void report_losses(const bake *b, json *j)
{
    const kiln_load_report *loaded = &b->work.loaded;
    json_object(j, "report");
    json_number(j, "texel_count", (double)loaded->texel_count);
    json_number(j, "infinite_count", (double)loaded->infinite_count);
    json_number(j, "nan_count", (double)loaded->nan_count);
    json_number(j, "negative_count", (double)loaded->negative_count);
    json_number(j, "negative_share", loaded->negative_share);
    json_number(j, "missing_count", (double)loaded->missing_count);
    json_notes(j, loaded);
    report_cut("levels", &b->made.levels_cut, &b->saved.levels, j);
    if (b->irradiance_path)
        report_cut("irradiance", &b->made.irradiance_cut, &b->saved.irradiance, j);
    json_end(j);
}

static void report_sun(const bake *b, json *j)
{
    const kiln_clamp *clamped = &b->made.clamped;
    if (b->sun == KILN_SUN_EXTRACT)
        json_lights(j, &b->made.lights);
    if (b->sun != KILN_SUN_CLAMP)
        return;
    json_object(j, "clamp");
    json_number(j, "limit", clamped->limit);
    json_number(j, "texels", (double)clamped->texel_count);
    json_number(j, "light_share", clamped->light_share);
    json_end(j);
}

static void report_seconds(const bake *b, json *j)
{
    static const char *const stages[BAKE_STAGES] = {"load", "filter", "save"};
    json_object(j, "seconds");
    for (int i = 0; i < BAKE_STAGES; i++)
        json_number(j, stages[i], round(b->seconds[i] * 1e6) / 1e6);
    json_number(j, "total", round(total_seconds(b) * 1e6) / 1e6);
    json_end(j);
}

void bake_report_members(const bake *b, json *j)
{
    json_text(j, "kiln", kiln_version());
    report_input(b, j);
    report_output(b, j);
    report_losses(b, j);
    report_sun(b, j);
    json_text(j, "method", bake_methods[b->textbook]);
    json_text(j, "lobe", bake_lobes[b->lobe]);
    if (b->engine)
        json_text(j, "tune", bake_tunings[b->tuning]);
    if (b->made.degree)
        json_number(j, "degree", b->made.degree);
    json_text(j, "cpu", kiln_context_cpu(b->work.context));
    report_seconds(b, j);
    size_t now, peak;
    kiln_context_memory(b->work.context, &now, &peak);
    json_object(j, "peak_memory");
    json_number(j, "kiln", (double)peak);
    json_number(j, "process", os_peak_memory());
    json_end(j);
}

static void report_json(const bake *b)
{
    json j = {0};
    json_object(&j, NULL);
    bake_report_members(b, &j);
    json_end(&j);
}

static void print_summary(const bake *b)
{
    char files[32] = "";
    if (b->saved.levels.file_count > 1)
        snprintf(files, sizeof files, " in %d files", b->saved.levels.file_count);
    printf("%s: %s of %d, %d level%s%s, %s %s, from %s %s of %d x %d, %.2f s\n",
           cli_show(b->output).text, bake_shapes[b->made.levels.shape], b->made.levels.size,
           b->made.levels.level_count, b->made.levels.level_count > 1 ? "s" : "", files,
           b->tuning != BAKE_EXACT ? "tuned" : bake_methods[b->textbook], bake_lobes[b->lobe],
           b->source_shape == KILN_SHAPE_OCTAHEDRON ? "an" : "a", bake_shapes[b->source_shape],
           b->source_width, b->source_height, total_seconds(b));
    if (b->engine && b->engine->format_reason && !b->format)
        printf("  format %s\n", b->engine->format_reason);
}

static void print_details(const bake *b)
{
    const double *s = b->seconds;
    char text[32];
    for (int k = 0; k < b->made.levels.level_count; k++)
        printf("  level %-2d  size %-5d  roughness %.4g\n", k,
               kiln_map_level_size(&b->made.levels, k), (double)b->made.levels.roughness[k]);
    if (b->irradiance_path)
        printf("  irradiance %s, size %d\n", cli_show(b->irradiance_path).text,
               b->made.irradiance.size);
    if (b->sh_path)
        printf("  harmonics  %s, %d bands of %s\n", cli_show(b->sh_path).text, b->sh_bands,
               b->sh_irradiance ? "irradiance" : "radiance");
    cli_print_lights(&b->made.lights);
    if (b->made.degree)
        printf("  degree     %d\n", b->made.degree);
    printf("  seconds    load %.3f, filter %.3f, save %.3f (%s)\n", s[BAKE_LOAD], s[BAKE_FILTER],
           s[BAKE_SAVE], kiln_context_cpu(b->work.context));
    printf("  memory     %s at most\n", cli_bytes(os_peak_memory(), text));
}

void bake_report(bake *b)
{
    cli_hold_output(&b->work, true);
    if (b->json)
        report_json(b);
    else if (!b->quiet && !b->to_stdout)
        print_summary(b);
    if (b->verbose)
        print_details(b);
    cli_hold_output(&b->work, false);
}
