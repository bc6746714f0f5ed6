// kiln bake. In: an environment (a panorama or six faces). Out: a file with all prefiltered levels
// and, if asked for, files of diffuse irradiance and spherical harmonics. kiln_bake filters;
// bake_options.c reads the options and bake_report.c prints the result.
#include "bake.h"
#include "os.h"

#include <kiln/course.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void next_stage(bake *b)
{
    double now = os_seconds();
    b->seconds[b->stage++] = now - b->since;
    b->since = now;
}

static kiln_load_def load_def(const bake *b)
{
    return (kiln_load_def){.layout = (kiln_layout)b->layout,
                           .negative = (kiln_negative)b->negative,
                           .layer = b->layer};
}

static void keep_extent(bake *b, kiln_extent source)
{
    b->source_shape = source.shape;
    b->source_height = source.size;
    b->source_width = source.shape == KILN_SHAPE_PANORAMA ? 2 * source.size : source.size;
}

static int load(bake *b)
{
    const kiln_load_def def = load_def(b);
    int code = cli_load(&b->work, b->arguments.rest, b->arguments.rest_count, &def, &b->source);
    if (code != CLI_GO)
        return code;
    keep_extent(b, (kiln_extent){b->source.shape, b->source.size});
    return CLI_GO;
}

static void change_source(bake *b)
{
    if (b->mirror)
        kiln_map_mirror(&b->source);
    if (b->exposure != 0)
        kiln_map_expose(&b->source, b->exposure);
}

// Returns the number of bands of harmonics to compute: enough for the output file's metadata
// (engines need three bands) and for --sh.
static int most_bands(const bake *b)
{
    return b->engine && b->sh_bands < 3 ? 3 : b->sh_bands;
}

void bake_plan_free(bake_plan *plan)
{
    kiln_plan_destroy(plan->plan);
    *plan = (bake_plan){0};
}

// Bakes by a plan, which is made anew if the plan at hand is for other sources or options. The bits
// are those of kiln_bake.
static int bake_by_plan(bake *b, const kiln_bake_def *def)
{
    bake_plan *p = b->plan;
    kiln_error *error = &b->work.error;
    if (!p->plan || p->key != b->plan_key || p->shape != b->source.shape ||
        p->size != b->source.size) {
        bake_plan_free(p);
        *p = (bake_plan){.key = b->plan_key, .shape = b->source.shape, .size = b->source.size};
        if (kiln_plan_create(b->work.context, p->shape, p->size, def, &p->plan, error))
            return CLI_FAILED;
    }
    if (kiln_plan_environment(p->plan, &b->made, error) ||
        kiln_plan_execute(p->plan, &b->source, &b->made, error))
        return CLI_FAILED;
    return CLI_GO;
}

// Bakes a file, whose rows pass by where this is possible.
static kiln_result bake_file(bake *b, const kiln_bake_def *unchanged)
{
    kiln_bake_def def = *unchanged;
    kiln_load_def load = load_def(b);
    kiln_extent source;
    load.report = &b->work.loaded;
    def.mirror = b->mirror;
    def.exposure = b->exposure;
    kiln_result result = kiln_bake_file(b->work.context, b->arguments.rest[0], &load, &def, &source,
                                        &b->made, &b->work.error);
    if (source.size)
        keep_extent(b, source);
    if (b->work.loaded.texel_count)
        cli_say_report(&b->work, b->arguments.rest[0]);
    b->seconds[BAKE_LOAD] = b->work.reading_seconds;
    b->since += b->work.reading_seconds;
    b->stage = BAKE_FILTER;
    return result;
}

static int bake_exactly(bake *b)
{
    kiln_bake_def def = {
        .levels = {.shape = (kiln_shape)b->shape,
                   .size = b->size,
                   .level_count = b->level_count,
                   .roughness = b->has_roughness ? b->roughness : NULL,
                   .lobe = (kiln_lobe_kind)b->lobe,
                   .rotation = b->rotation,
                   .pitch = b->pitch,
                   .roll = b->roll,
                   .up = (kiln_up)b->up},
        .engine = b->engine,
        .tune = b->engine ? (kiln_tune)(b->tuning + KILN_TUNE_NONE) : KILN_TUNE_AUTO,
        .irradiance_size = b->irradiance_path ? b->irradiance_size : KILN_NO_IRRADIANCE,
        .sh_bands = most_bands(b),
        .sun = b->sun,
        .lights = b->lights,
        .clamp = b->clamp,
    };
    if (b->arguments.rest_count == 1 && !b->plan)
        return bake_file(b, &def) ? CLI_FAILED : CLI_GO;
    int code = load(b);
    if (code != CLI_GO)
        return code;
    change_source(b);
    next_stage(b);
    if (b->plan)
        return bake_by_plan(b, &def);
    return kiln_bake(b->work.context, &b->source, &def, &b->made, &b->work.error) ? CLI_FAILED
                                                                                  : CLI_GO;
}

// The importance-sampling methods read only panoramas, so other shapes are converted.
static int make_panorama(bake *b)
{
    if (b->source.shape == KILN_SHAPE_PANORAMA && b->rotation == 0)
        return CLI_GO;
    int rows = b->source.shape == KILN_SHAPE_PANORAMA ? b->source.size : 2 * b->source.size;
    kiln_map turned = {0};
    if (kiln_map_convert(b->work.context, &b->source, KILN_SHAPE_PANORAMA, rows, b->rotation,
                         &turned, &b->work.error))
        return CLI_FAILED;
    kiln_map_free(&b->source);
    b->source = turned;
    b->rotation = 0;
    return CLI_GO;
}

static int bake_by_textbook(bake *b)
{
    kiln_context *context = b->work.context;
    kiln_error *error = &b->work.error;
    kiln_textbook_def def = {
        .shape = (kiln_shape)b->shape,
        .size = b->size,
        .level_count = b->level_count,
        .phi_count = b->phi_steps,
        .theta_count = b->theta_steps,
        .sample_count = b->samples,
    };
    int code = load(b);
    if (code != CLI_GO)
        return code;
    change_source(b);
    next_stage(b);
    if (make_panorama(b) != CLI_GO || bake_sun_of_source(b) != CLI_GO)
        return CLI_FAILED;
    b->made.lobe = (kiln_lobe_kind)b->lobe;
    if (b->lobe == KILN_LOBE_LAMBERT
            ? kiln_textbook_irradiance(context, &b->source, &def, &b->made.levels, error)
            : kiln_textbook_prefilter(context, &b->source, &def, &b->made.levels, error))
        return CLI_FAILED;
    kiln_map_cut_negative(context, &b->made.levels, &b->made.levels_cut);
    def.size = b->irradiance_size;
    if (b->irradiance_path &&
        kiln_textbook_irradiance(context, &b->source, &def, &b->made.irradiance, error))
        return CLI_FAILED;
    kiln_map_cut_negative(context, &b->made.irradiance, &b->made.irradiance_cut);
    return kiln_map_sh(context, &b->source, most_bands(b), b->rotation, &b->made.sh, error)
               ? CLI_FAILED
               : CLI_GO;
}

// Returns the name of an output for messages.
static const char *shown_path(const bake *b, const char *path)
{
    return b->to_stdout && path == b->output ? "standard output" : path;
}

static void warn_of_negatives(bake *b, const kiln_cut *cut, const char *path)
{
    kiln_note note;
    if (!b->quiet && kiln_cut_note(&b->work.loaded, cut, &note))
        cli_note(&b->work, note.warning, "%s: %s", shown_path(b, path), note.text);
}

static void warn_of_clamping(bake *b, const kiln_save_report *report, const char *path)
{
    if (b->quiet || !report->cut_count)
        return;
    double stops = b->exposure + floor(log2(report->limit / report->largest));
    bool png = cli_ends_in(path, "png"), bytes = b->format >= KILN_FORMAT_RGBM;
    char way_out[96];
    if (png && !bytes)
        snprintf(way_out, sizeof way_out, " because PNG holds no larger values");
    else if ((b->engine && path == b->output) || png)
        snprintf(way_out, sizeof way_out, "; --exposure %.0f keeps them", stops);
    else
        snprintf(way_out, sizeof way_out, "; --format rgba32f or --exposure %.0f keeps them",
                 stops);
    cli_note(&b->work, true,
             "%s: %zu values above %g (up to %.4g), %.2g %% of all, were cut off, with %.3g %% of "
             "the light%s",
             shown_path(b, path), report->cut_count, report->limit, report->largest,
             100 * report->share, 100 * report->light_share, way_out);
}

// Writes the one file of the environment to standard output.
static int write_to_stdout(bake *b, const kiln_environment_save_def *def)
{
    kiln_files files;
    if (kiln_environment_encode(b->work.context, &b->made, b->output, def, &files, &b->saved,
                                &b->work.error))
        return CLI_FAILED;
    int code = CLI_GO;
    if (files.count != 1)
        code = cli_fail("%s: the environment takes %d files, and standard output holds one",
                        b->output, files.count);
    // A failed write is reported where the command closes standard output.
    if (code == CLI_GO)
        fwrite(files.file[0].bytes, 1, files.file[0].size, stdout);
    kiln_files_free(&files);
    return code;
}

static int save(bake *b)
{
    kiln_context *context = b->work.context;
    kiln_error *error = &b->work.error;
    kiln_sh sh;
    kiln_environment_save_def def = {.engine = b->engine,
                                     .format = (kiln_format)b->format,
                                     .zstd = b->zstd,
                                     .irradiance_path = b->irradiance_path,
                                     .sh_path = b->sh_path,
                                     .lights_path = b->lights_path,
                                     .sh = &sh,
                                     .watch = b->watch,
                                     .watch_user = b->watch_user};
    kiln_map_free(&b->source);
    if (kiln_sh_filter(&b->made.sh, b->sh_bands, b->sh_irradiance, b->sh_window, &sh, error))
        return CLI_FAILED;
    if (b->to_stdout && write_to_stdout(b, &def) != CLI_GO)
        return CLI_FAILED;
    if (!b->to_stdout &&
        kiln_environment_save(context, &b->made, b->output, &def, &b->saved, error))
        return CLI_FAILED;
    bake_say_sun(b);
    warn_of_negatives(b, &b->made.levels_cut, b->output);
    warn_of_clamping(b, &b->saved.levels, b->output);
    if (b->irradiance_path) {
        warn_of_negatives(b, &b->made.irradiance_cut, b->irradiance_path);
        warn_of_clamping(b, &b->saved.irradiance, b->irradiance_path);
    }
    return CLI_GO;
}

static int bake_all(bake *b)
{
    int code = b->textbook ? bake_by_textbook(b) : bake_exactly(b);
    if (code != CLI_GO)
        return code;
    next_stage(b);
    code = save(b);
    if (code != CLI_GO)
        return code;
    next_stage(b);
    if (b->report)
        b->report(b);
    else
        bake_report(b);
    return CLI_DONE;
}

// Fails before any work if the levels alone need more memory than the process may use. Levels after
// the first one have a third of its texels together.
static int check_memory(const bake *b)
{
    const kiln_map first = {.shape = (kiln_shape)b->shape, .size = b->size, .level_count = 1};
    char needed[32], usable[32];
    double limit = (double)cli_memory_limit();
    double bytes = 3.0 * sizeof(float) * (b->size ? (double)kiln_map_texels(&first, 0) : 0);
    bytes *= b->level_count == 1 ? 1 : 4.0 / 3;
    if (limit == 0 || bytes <= limit)
        return CLI_GO;
    return cli_fail(
        "--size %d: the levels take %s of memory, and kiln may use %s; choose a smaller "
        "size",
        b->size, cli_bytes(bytes, needed), cli_bytes(limit, usable));
}

int bake_in_context(bake *b)
{
    b->since = os_seconds();
    int code = check_memory(b);
    if (code == CLI_GO)
        code = bake_all(b);
    char *message = b->work.error.message, *end = message + strlen(message);
    if (code == CLI_FAILED && message[0] && b->work.error.result == KILN_ERROR_MEMORY)
        snprintf(end, sizeof b->work.error.message - (size_t)(end - message), "; %s",
                 "a smaller --size needs less");
    kiln_map_free(&b->source);
    kiln_environment_free(&b->made);
    return code;
}

int bake_run(bake *b)
{
    int code = cli_begin_work(&b->work, b->threads, b->quiet);
    if (code == CLI_GO)
        code = bake_in_context(b);
    return cli_end_work(&b->work, code);
}
