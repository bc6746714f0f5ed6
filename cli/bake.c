// kiln bake: a panorama in, every level of an environment out, with irradiance and spherical
// harmonics beside it.
#include "cli.h"
#include "os.h"

#include <kiln/course.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    OUTPUT = 1,
    ENGINE,
    FIT,
    SIZE,
    LEVELS,
    SHAPE,
    FORMAT,
    ZSTD,
    ROUGHNESS,
    LOBE,
    METHOD,
    SAMPLES,
    PHI_STEPS,
    THETA_STEPS,
    IRRADIANCE,
    IRRADIANCE_SIZE,
    SH,
    SH_BANDS,
    SH_RADIANCE,
    SH_IRRADIANCE,
    SH_WINDOW,
    LAYOUT,
    ROTATE,
    EXPOSURE,
    MIRROR,
    THREADS,
    JSON,
    QUIET,
    VERBOSE,
};

#define GROUP(table, title)                                                                        \
    {                                                                                              \
        NULL, 0, POPT_ARG_INCLUDE_TABLE, table, 0, title, NULL                                     \
    }
#define VALUE(name, option, help, word)                                                            \
    {                                                                                              \
        name, 0, POPT_ARG_STRING, NULL, option, help, word                                         \
    }
#define FLAG(name, option, help)                                                                   \
    {                                                                                              \
        name, 0, POPT_ARG_NONE, NULL, option, help, NULL                                           \
    }

static struct poptOption output_options[] = {
    {"output", 'o', POPT_ARG_STRING, NULL, OUTPUT,
     "what to write, by its ending: .ktx2 .dds; faces or panoramas as .exr .hdr .png, or in "
     "FOLDER/",
     "OUT"},
    VALUE("for", ENGINE,
          "what an engine loads: its levels, its axes, its files; see 'kiln engines'", "ENGINE"),
    VALUE(
        "fit", FIT,
        "with --for: levels for what the engine shows; sharp keeps level 0 a mirror, none is exact "
        "levels (by engine)",
        "sharp|soft|none"),
    VALUE("size", SIZE, "texels along a face, rows of a panorama (256)", "N"),
    VALUE("levels", LEVELS, "levels of the chain (all, down to 1 texel)", "N"),
    VALUE("shape", SHAPE, "cube, panorama or octahedron (cube)", "SHAPE"),
    VALUE("format", FORMAT,
          "rgba16f, rgba32f, rgb9e5, b10g11r11 or bc6h (rgba16f); for PNG rgbm, rgbd or rgbp",
          "FORMAT"),
    VALUE("zstd", ZSTD, "compress KTX2; a level from 1 to 22 as --zstd=LEVEL (3)", "LEVEL"),
    POPT_TABLEEND,
};
static struct poptOption filter_options[] = {
    VALUE("lobe", LOBE, "ggx, lambert, charlie or phong (ggx)", "LOBE"),
    VALUE("roughness", ROUGHNESS, "'linear', or one number from 0 to 1 a level: 0,0.2,0.5,1",
          "LIST"),
    VALUE("method", METHOD, "exact, or textbook: the sampling that courses teach (exact)",
          "METHOD"),
    VALUE("samples", SAMPLES, "textbook ggx: Hammersley points a texel (1024)", "N"),
    VALUE("phi-steps", PHI_STEPS, "textbook irradiance: steps of phi (100)", "N"),
    VALUE("theta-steps", THETA_STEPS, "textbook irradiance: steps of theta (100)", "N"),
    POPT_TABLEEND,
};
static struct poptOption more_options[] = {
    VALUE("irradiance", IRRADIANCE, "write a map filtered by the cosine too", "FILE"),
    VALUE("irradiance-size", IRRADIANCE_SIZE, "its size (64)", "N"),
    VALUE("sh", SH, "write spherical harmonics as .json, .txt or .h", "FILE"),
    VALUE("sh-bands", SH_BANDS, "bands, 1 to 5 (3)", "N"),
    FLAG("sh-radiance", SH_RADIANCE, "coefficients of the radiance (so by default)"),
    FLAG("sh-irradiance", SH_IRRADIANCE, "coefficients of the irradiance"),
    VALUE("sh-window", SH_WINDOW, "width in bands of a Hanning window against ringing (none)", "W"),
    POPT_TABLEEND,
};
static struct poptOption input_options[] = {
    VALUE("layout", LAYOUT, "auto, panorama, cross, strip or octahedron (auto)", "LAYOUT"),
    VALUE("rotate", ROTATE, "turn about the vertical axis", "DEGREES"),
    VALUE("exposure", EXPOSURE, "multiply by 2^STOPS", "STOPS"),
    FLAG("mirror", MIRROR, "swap left and right, before turning"),
    POPT_TABLEEND,
};
static const struct poptOption options[] = {
    GROUP(output_options, "Output:"),
    GROUP(filter_options, "Filter:"),
    GROUP(more_options, "Beside it:"),
    GROUP(input_options, "Input:"),
    VALUE("threads", THREADS, "1 to 256 (one a core); never changes the result", "N"),
    FLAG("json", JSON, "report what was done as JSON on standard output"),
    {"quiet", 'q', POPT_ARG_NONE, NULL, QUIET, "print nothing but errors", NULL},
    {"verbose", 'v', POPT_ARG_NONE, NULL, VERBOSE, "print levels, times and memory", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

static const char *const lobes[] = {"ggx", "lambert", "charlie", "phong", NULL};
static const char *const shapes[] = {"auto", "panorama", "cube", "octahedron", NULL};
static const char *const methods[] = {"exact", "textbook", NULL};
static const char *const fits[] = {"none", "sharp", "soft", NULL};
static const char *const layouts[] = {"auto", "panorama", "cross", "strip", "octahedron", NULL};

typedef struct bake {
    cli_arguments arguments;
    const char *output, *irradiance_path, *sh_path;
    const kiln_engine *engine; // NULL without --for
    int size, level_count, smallest, shape, format, zstd, lobe, textbook, fit;
    int samples, phi_steps, theta_steps;
    int irradiance_size, sh_bands, layout, threads;
    double sh_window, rotation, exposure;
    bool mirror, json, quiet, verbose, sh_irradiance;
    bool has_roughness;
    float roughness[KILN_MAX_LEVELS];

    cli_job job;
    kiln_map source;
    kiln_environment made;
    bool stores_sh; // in the file's metadata
    int source_width, source_height, file_count, main_count;
    kiln_shape source_shape;
    enum { LOAD, FILTER, BESIDE, SAVE, STAGES } stage;
    double seconds[STAGES], since;
} bake;

// --------------------------------------------------------------------------------------- arguments

static int read_roughness(bake *b)
{
    const char *text = b->arguments.value[ROUGHNESS];
    if (!text || !strcmp(text, "linear"))
        return CLI_GO;
    int count = 0;
    for (const char *at = text;; at++) {
        char *end;
        double r = strtod(at, &end);
        if (end == at || (*end && *end != ','))
            return cli_wrong(&cli_bake,
                             "--roughness is '%s', it must be 'linear' or numbers from "
                             "0 to 1 with commas between them",
                             text);
        if (!(r >= 0 && r <= 1))
            return cli_wrong(&cli_bake, "--roughness: number %d is %g, it must be from 0 to 1",
                             count + 1, r);
        if (count == KILN_MAX_LEVELS)
            return cli_wrong(&cli_bake, "--roughness has more than %d numbers", KILN_MAX_LEVELS);
        b->roughness[count++] = (float)r;
        at = end;
        if (!*at)
            break;
    }
    if (b->level_count && b->level_count != count)
        return cli_wrong(&cli_bake, "--roughness has %d numbers, but --levels is %d", count,
                         b->level_count);
    b->level_count = count;
    b->has_roughness = true;
    return CLI_GO;
}

// What can be written where. `option` names it in sentences.
static int check_output(const bake *b, const char *option, const char *path)
{
    const kiln_save_def def = {.format = (kiln_format)b->format};
    kiln_error error;
    if (!strcmp(path, "-"))
        return cli_wrong(&cli_bake, "%s: writing to standard output is not possible, name a file",
                         option);
    if (kiln_map_save_check(path, (kiln_shape)b->shape, &def, &error))
        return cli_wrong(&cli_bake, "%s %s", option, error.message);
    return CLI_GO;
}

static int largest_level_count(int size)
{
    int count = 1;
    while (size > 1) {
        size /= 2;
        count++;
    }
    return count < KILN_MAX_LEVELS ? count : KILN_MAX_LEVELS;
}

static int read_shape(const cli_arguments *a, int *shape)
{
    int choice = *shape - KILN_SHAPE_PANORAMA;
    int code = cli_choice(a, SHAPE, "--shape", shapes + KILN_SHAPE_PANORAMA, &choice);
    *shape = choice + KILN_SHAPE_PANORAMA;
    return code;
}

static int read_numbers(bake *b)
{
    const cli_arguments *a = &b->arguments;
    int code;
    if ((code = cli_integer(a, SIZE, "--size", 1, KILN_MAX_SIZE, &b->size)) != CLI_GO ||
        (code = cli_integer(a, LEVELS, "--levels", 1, KILN_MAX_LEVELS, &b->level_count)) !=
            CLI_GO ||
        (code = cli_integer(a, ZSTD, "--zstd", 1, 22, &b->zstd)) != CLI_GO ||
        (code = cli_integer(a, SAMPLES, "--samples", 1, 1 << 20, &b->samples)) != CLI_GO ||
        (code = cli_integer(a, PHI_STEPS, "--phi-steps", 1, 10000, &b->phi_steps)) != CLI_GO ||
        (code = cli_integer(a, THETA_STEPS, "--theta-steps", 1, 10000, &b->theta_steps)) !=
            CLI_GO ||
        (code = cli_integer(a, IRRADIANCE_SIZE, "--irradiance-size", 1, KILN_MAX_SIZE,
                            &b->irradiance_size)) != CLI_GO ||
        (code = cli_integer(a, SH_BANDS, "--sh-bands", 1, KILN_MAX_BANDS, &b->sh_bands)) !=
            CLI_GO ||
        (code = cli_integer(a, THREADS, "--threads", 1, 256, &b->threads)) != CLI_GO ||
        (code = cli_number(a, SH_WINDOW, "--sh-window", 1, 1000, &b->sh_window)) != CLI_GO ||
        (code = cli_number(a, ROTATE, "--rotate", -3600, 3600, &b->rotation)) != CLI_GO ||
        (code = cli_number(a, EXPOSURE, "--exposure", -64, 64, &b->exposure)) != CLI_GO ||
        (code = cli_choice(a, LOBE, "--lobe", lobes, &b->lobe)) != CLI_GO ||
        (code = read_shape(a, &b->shape)) != CLI_GO ||
        (code = cli_choice(a, METHOD, "--method", methods, &b->textbook)) != CLI_GO ||
        (code = cli_choice(a, FIT, "--fit", fits, &b->fit)) != CLI_GO ||
        (code = cli_choice(a, LAYOUT, "--layout", layouts, &b->layout)) != CLI_GO ||
        (code = cli_choice(a, FORMAT, "--format", kiln_format_names(), &b->format)) != CLI_GO)
        return code;
    return read_roughness(b);
}

// The options of one method, lobe or file given without it.
static int check_combinations(const bake *b)
{
    char *const *v = b->arguments.value;
    bool lambert = b->lobe == KILN_LOBE_LAMBERT;
    if (b->quiet && b->verbose)
        return cli_wrong(&cli_bake, "--quiet and --verbose contradict each other");
    if (b->json && b->verbose)
        return cli_wrong(&cli_bake, "--json and --verbose contradict each other: the report has "
                                    "everything");
    if (!b->textbook) {
        const char *name = v[SAMPLES]       ? "--samples"
                           : v[PHI_STEPS]   ? "--phi-steps"
                           : v[THETA_STEPS] ? "--theta-steps"
                                            : NULL;
        if (name)
            return cli_wrong(&cli_bake,
                             "%s is for --method textbook; the exact method has no "
                             "samples",
                             name);
    } else {
        if (b->lobe != KILN_LOBE_GGX && !lambert)
            return cli_wrong(&cli_bake, "--method textbook knows the lobes ggx and lambert, not %s",
                             lobes[b->lobe]);
        if (b->has_roughness)
            return cli_wrong(&cli_bake, "--method textbook spaces its roughness linearly, leave "
                                        "--roughness out");
        if (v[SAMPLES] && lambert)
            return cli_wrong(&cli_bake, "--samples is for --lobe ggx; the textbook irradiance has "
                                        "--phi-steps and --theta-steps");
        if ((v[PHI_STEPS] || v[THETA_STEPS]) && !lambert && !b->irradiance_path)
            return cli_wrong(&cli_bake, "--phi-steps and --theta-steps are for irradiance: "
                                        "--lobe lambert or --irradiance FILE");
    }
    if (lambert && b->level_count > 1)
        return cli_wrong(&cli_bake, "--lobe lambert has no roughness: one level, not %d",
                         b->level_count);
    if (!b->engine && b->level_count > largest_level_count(b->size))
        return cli_wrong(&cli_bake, "%d levels: a size of %d has %d at most", b->level_count,
                         b->size, largest_level_count(b->size));
    if (v[ZSTD] && strcmp(cli_ending(b->output), "ktx2") != 0)
        return cli_wrong(&cli_bake, "--zstd is for .ktx2, not for %s", b->output);
    if (v[IRRADIANCE_SIZE] && !b->irradiance_path)
        return cli_wrong(&cli_bake, "--irradiance-size needs --irradiance FILE");
    if (v[SH_RADIANCE] && v[SH_IRRADIANCE])
        return cli_wrong(&cli_bake, "--sh-radiance and --sh-irradiance contradict each other");
    if ((v[SH_RADIANCE] || v[SH_IRRADIANCE] || v[SH_WINDOW]) && !b->sh_path)
        return cli_wrong(&cli_bake, "%s needs --sh FILE",
                         v[SH_WINDOW]     ? "--sh-window"
                         : v[SH_RADIANCE] ? "--sh-radiance"
                                          : "--sh-irradiance");
    if (v[SH_BANDS] && !b->sh_path && !b->stores_sh)
        return cli_wrong(&cli_bake, "--sh-bands needs --sh FILE or a .ktx2 output");
    if (v[LAYOUT] && b->arguments.rest_count > 1)
        return cli_wrong(&cli_bake, "--layout is for one picture, not for six faces");
    return CLI_GO;
}

// --for decides the lobe and each level's roughness, and which formats there are.
static int take_engine(bake *b)
{
    static const int decided[] = {SHAPE, ZSTD, ROUGHNESS, LOBE, METHOD};
    const cli_arguments *a = &b->arguments;
    const char *name = a->value[ENGINE];
    if (!name && a->value[FIT])
        return cli_wrong(&cli_bake, "--fit needs --for ENGINE");
    if (!name)
        return CLI_GO;
    b->engine = kiln_engine_find(name);
    if (!b->engine)
        return cli_wrong(&cli_bake, "--for is '%s', which is no engine; 'kiln engines' lists them",
                         name);
    for (size_t i = 0; i < sizeof decided / sizeof *decided; i++)
        if (a->value[decided[i]])
            return cli_wrong(&cli_bake, "--for %s decides what --%s is, leave one of them out",
                             name, cli_option_name(&cli_bake, decided[i]));
    kiln_format format = (kiln_format)b->format;
    if (kiln_engine_format(b->engine, &format, &b->job.error))
        return cli_wrong(&cli_bake, "--for %s", b->job.error.message);
    if (b->engine->ending[0] && strcmp(cli_ending(b->output), b->engine->ending) != 0)
        return cli_wrong(&cli_bake, "--output %s: --for %s writes .%s", b->output, name,
                         b->engine->ending);
    kiln_prefilter_def def;
    if (kiln_engine_levels(b->engine, a->value[SIZE] ? b->size : 0, b->level_count, b->roughness,
                           &def, &b->job.error))
        return cli_wrong(&cli_bake, "--for %s", b->job.error.message);
    b->size = def.size;
    b->level_count = def.level_count;
    b->smallest = def.smallest;
    b->has_roughness = true;
    b->stores_sh = true;
    if (!a->value[FIT])
        b->fit = b->engine->tune;
    return CLI_GO;
}

static int check_paths(const bake *b)
{
    const char *paths[] = {b->output, b->irradiance_path, b->sh_path};
    static const char *const names[] = {"--output", "--irradiance", "--sh"};
    int code;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++)
            if (paths[i] && paths[j] && !strcmp(paths[i], paths[j]))
                return cli_wrong(&cli_bake, "%s and %s are the same file, %s", names[j], names[i],
                                 paths[i]);
    if (b->sh_path) {
        const char *ending = cli_ending(b->sh_path);
        if (strcmp(ending, "json") != 0 && strcmp(ending, "txt") != 0 && strcmp(ending, "h") != 0)
            return cli_wrong(&cli_bake, "--sh %s: must end in .json, .txt or .h", b->sh_path);
    }
    if ((!b->engine && (code = check_output(b, "--output", b->output)) != CLI_GO) ||
        (b->irradiance_path &&
         (code = check_output(b, "--irradiance", b->irradiance_path)) != CLI_GO))
        return code;
    for (int i = 0; i < 3; i++)
        if (paths[i] && (code = cli_check_folder(paths[i])) != CLI_GO)
            return code;
    return CLI_GO;
}

// A folder that exists may be named without the slash at its end.
static char *add_slash(char *path)
{
    size_t length = path ? strlen(path) : 0;
    if (!length || strcmp(cli_ending(path), "/") != 0 || path[length - 1] == '/')
        return path;
    char *longer = realloc(path, length + 2);
    if (!longer)
        return path;
    memcpy(longer + length, "/", 2);
    return longer;
}

static int read_arguments(bake *b, int argc, const char **argv)
{
    cli_arguments *a = &b->arguments;
    int code = cli_arguments_read(a, &cli_bake, argc, argv);
    if (code != CLI_GO)
        return code;
    a->value[OUTPUT] = add_slash(a->value[OUTPUT]);
    a->value[IRRADIANCE] = add_slash(a->value[IRRADIANCE]);
    b->output = a->value[OUTPUT];
    b->irradiance_path = a->value[IRRADIANCE];
    b->sh_path = a->value[SH];
    b->mirror = a->value[MIRROR];
    b->json = a->value[JSON];
    b->quiet = a->value[QUIET];
    b->verbose = a->value[VERBOSE];
    b->sh_irradiance = a->value[SH_IRRADIANCE];
    b->size = 256;
    b->irradiance_size = 64;
    b->sh_bands = 3;
    b->shape = KILN_SHAPE_CUBE;
    if ((code = cli_check_input(&cli_bake, a->rest, a->rest_count)) != CLI_GO)
        return code;
    if (!b->output)
        return cli_wrong(&cli_bake, "no output: name it by -o OUT");
    b->stores_sh = !strcmp(cli_ending(b->output), "ktx2");
    if ((code = read_numbers(b)) != CLI_GO || (code = take_engine(b)) != CLI_GO ||
        (code = check_combinations(b)) != CLI_GO)
        return code;
    if (b->lobe == KILN_LOBE_LAMBERT)
        b->level_count = 1;
    return check_paths(b);
}

// -------------------------------------------------------------------------------------------- work

static void next_stage(bake *b)
{
    double now = cli_seconds();
    b->seconds[b->stage++] = now - b->since;
    b->since = now;
}

static int load(bake *b)
{
    int code = cli_load(&b->job, b->arguments.rest, b->arguments.rest_count,
                        (enum kiln_layout)b->layout, &b->source);
    if (code != CLI_GO)
        return code;
    b->source_shape = b->source.shape;
    b->source_height = b->source.size;
    b->source_width = b->source.shape == KILN_SHAPE_PANORAMA ? 2 * b->source.size : b->source.size;
    if (b->mirror)
        kiln_map_mirror(&b->source);
    if (b->exposure != 0)
        kiln_map_expose(&b->source, b->exposure);
    return CLI_GO;
}

// Bands of harmonics to make: those of the file's metadata, which engines want three of, and of --sh.
static int most_bands(const bake *b)
{
    return b->engine && b->sh_bands < 3 ? 3 : b->sh_bands;
}

static int filter_exactly(bake *b)
{
    cli_job *job = &b->job;
    kiln_bake_def def = {
        .levels = {.shape = (kiln_shape)b->shape,
                   .size = b->size,
                   .level_count = b->level_count,
                   .smallest = b->smallest,
                   .roughness = b->has_roughness ? b->roughness : NULL,
                   .lobe = (enum kiln_lobe_kind)b->lobe,
                   .rotation = b->rotation,
                   .tune_for = b->fit ? b->engine : NULL,
                   .tune_soft = b->fit == 2},
        .irradiance_size = b->irradiance_path ? b->irradiance_size : KILN_NO_IRRADIANCE,
        .sh_bands = most_bands(b),
    };
    if (kiln_bake(job->context, &b->source, &def, &b->made, &job->error))
        return CLI_FAILED;
    next_stage(b);
    return CLI_GO;
}

// The textbook's methods read a panorama as it is.
static int make_panorama(bake *b)
{
    if (b->source.shape == KILN_SHAPE_PANORAMA && b->rotation == 0)
        return CLI_GO;
    int rows = b->source.shape == KILN_SHAPE_PANORAMA ? b->source.size : 2 * b->source.size;
    kiln_map turned = {0};
    if (kiln_map_convert(b->job.context, &b->source, KILN_SHAPE_PANORAMA, rows, b->rotation,
                         &turned, &b->job.error))
        return CLI_FAILED;
    kiln_map_free(&b->source);
    b->source = turned;
    b->rotation = 0;
    return CLI_GO;
}

static int filter_by_textbook(bake *b)
{
    cli_job *job = &b->job;
    kiln_textbook_def def = {
        .shape = (kiln_shape)b->shape,
        .size = b->size,
        .level_count = b->level_count,
        .phi_count = b->phi_steps,
        .theta_count = b->theta_steps,
        .sample_count = b->samples,
    };
    if (make_panorama(b) != CLI_GO)
        return CLI_FAILED;
    b->made.lobe = (kiln_lobe_kind)b->lobe;
    if (b->lobe == KILN_LOBE_LAMBERT
            ? kiln_textbook_irradiance(job->context, &b->source, &def, &b->made.levels, &job->error)
            : kiln_textbook_prefilter(job->context, &b->source, &def, &b->made.levels, &job->error))
        return CLI_FAILED;
    next_stage(b);
    def.size = b->irradiance_size;
    if (b->irradiance_path &&
        kiln_textbook_irradiance(job->context, &b->source, &def, &b->made.irradiance, &job->error))
        return CLI_FAILED;
    return kiln_map_sh(job->context, &b->source, most_bands(b), b->rotation, &b->made.sh,
                       &job->error)
               ? CLI_FAILED
               : CLI_GO;
}

static void warn_of_clamping(bake *b, const kiln_save_report *report, const char *path)
{
    if (b->quiet || !report->cut_count)
        return;
    double stops = b->exposure + floor(log2(report->limit / report->largest));
    bool png = !strcmp(cli_ending(path), "png"), bytes = b->format >= KILN_FORMAT_RGBM;
    char way_out[96];
    if (png && !bytes)
        snprintf(way_out, sizeof way_out, ", PNG holds no more");
    else if ((b->engine && path == b->output) || png)
        snprintf(way_out, sizeof way_out, "; --exposure %.0f keeps them", stops);
    else
        snprintf(way_out, sizeof way_out, "; --format rgba32f or --exposure %.0f keeps them",
                 stops);
    cli_warn(&b->job, "%s: %zu values above %g (up to %.4g), %.2g %% of all, were cut off%s", path,
             report->cut_count, report->limit, report->largest, 100 * report->share, way_out);
}

static int save(bake *b)
{
    cli_job *job = &b->job;
    kiln_sh sh;
    kiln_environment_save_def def = {.engine = b->engine,
                                     .format = (kiln_format)b->format,
                                     .zstd = b->zstd,
                                     .irradiance_path = b->irradiance_path,
                                     .sh_path = b->sh_path,
                                     .sh = &sh};
    kiln_environment_report report;
    kiln_map_free(&b->source);
    if (kiln_sh_filter(&b->made.sh, b->sh_bands, b->sh_irradiance, b->sh_window, &sh,
                       &job->error) ||
        kiln_environment_save(job->context, &b->made, b->output, &def, &report, &job->error))
        return CLI_FAILED;
    b->main_count = report.levels.file_count;
    b->file_count = report.file_count;
    warn_of_clamping(b, &report.levels, b->output);
    if (b->irradiance_path)
        warn_of_clamping(b, &report.irradiance, b->irradiance_path);
    return CLI_GO;
}

// ------------------------------------------------------------------------------------------ report

static double total_seconds(const bake *b)
{
    return b->seconds[LOAD] + b->seconds[FILTER] + b->seconds[BESIDE] + b->seconds[SAVE];
}

static int report_json(const bake *b)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "kiln", kiln_version());
    cJSON *input = cJSON_AddObjectToObject(json, "input");
    cJSON *files = cJSON_AddArrayToObject(input, "files");
    for (int i = 0; i < b->arguments.rest_count; i++)
        cJSON_AddItemToArray(files, cJSON_CreateString(b->arguments.rest[i]));
    cJSON_AddStringToObject(input, "shape", shapes[b->source_shape]);
    cJSON_AddNumberToObject(input, "width", b->source_width);
    cJSON_AddNumberToObject(input, "height", b->source_height);

    cJSON *output = cJSON_AddObjectToObject(json, "output");
    cJSON_AddStringToObject(output, "path", b->output);
    if (b->irradiance_path)
        cJSON_AddStringToObject(output, "irradiance", b->irradiance_path);
    if (b->sh_path)
        cJSON_AddStringToObject(output, "sh", b->sh_path);
    cJSON_AddNumberToObject(output, "file_count", b->file_count);
    cJSON_AddStringToObject(output, "shape", shapes[b->made.levels.shape]);
    cJSON_AddNumberToObject(output, "size", b->made.levels.size);
    cJSON_AddNumberToObject(output, "level_count", b->made.levels.level_count);
    cJSON *levels = cJSON_AddArrayToObject(output, "levels");
    for (int k = 0; k < b->made.levels.level_count; k++) {
        cJSON *level = cJSON_CreateObject();
        cJSON_AddNumberToObject(level, "size", kiln_map_level_size(&b->made.levels, k));
        // Nine digits tell every float; the nearest such double prints shortest.
        char text[32];
        snprintf(text, sizeof text, "%.9g", (double)b->made.levels.roughness[k]);
        cJSON_AddNumberToObject(level, "roughness", strtod(text, NULL));
        cJSON_AddItemToArray(levels, level);
    }
    cJSON_AddStringToObject(json, "method", methods[b->textbook]);
    cJSON_AddStringToObject(json, "lobe", lobes[b->lobe]);
    if (b->engine)
        cJSON_AddStringToObject(json, "fit", fits[b->fit]);
    if (b->made.degree)
        cJSON_AddNumberToObject(json, "degree", b->made.degree);
    cJSON_AddStringToObject(json, "cpu", kiln_context_cpu(b->job.context));

    static const char *const stages[STAGES] = {"load", "filter", "beside", "save"};
    cJSON *seconds = cJSON_AddObjectToObject(json, "seconds");
    for (int i = 0; i < STAGES; i++)
        cJSON_AddNumberToObject(seconds, stages[i], round(b->seconds[i] * 1e6) / 1e6);
    cJSON_AddNumberToObject(seconds, "total", round(total_seconds(b) * 1e6) / 1e6);
    size_t now, peak;
    kiln_context_memory(b->job.context, &now, &peak);
    cJSON *memory = cJSON_AddObjectToObject(json, "peak_memory");
    cJSON_AddNumberToObject(memory, "kiln", (double)peak);
    cJSON_AddNumberToObject(memory, "process", os_peak_memory());
    return cli_print_json(json);
}

static int report(bake *b)
{
    cli_clear_progress(&b->job);
    if (b->json)
        return report_json(b);
    if (b->quiet)
        return CLI_DONE;
    char files[32] = "";
    if (b->main_count > 1)
        snprintf(files, sizeof files, " in %d files", b->main_count);
    printf("%s: %s of %d, %d level%s%s, %s %s, from %s %s of %d x %d, %.2f s\n", b->output,
           shapes[b->made.levels.shape], b->made.levels.size, b->made.levels.level_count,
           b->made.levels.level_count > 1 ? "s" : "", files,
           b->fit ? "fitted" : methods[b->textbook], lobes[b->lobe],
           b->source_shape == KILN_SHAPE_OCTAHEDRON ? "an" : "a", shapes[b->source_shape],
           b->source_width, b->source_height, total_seconds(b));
    if (!b->verbose)
        return CLI_DONE;
    for (int k = 0; k < b->made.levels.level_count; k++)
        printf("  level %-2d  size %-5d  roughness %.4g\n", k,
               kiln_map_level_size(&b->made.levels, k), (double)b->made.levels.roughness[k]);
    if (b->irradiance_path)
        printf("  irradiance %s, size %d\n", b->irradiance_path, b->made.irradiance.size);
    if (b->sh_path)
        printf("  harmonics  %s, %d bands of %s\n", b->sh_path, b->sh_bands,
               b->sh_irradiance ? "irradiance" : "radiance");
    if (b->made.degree)
        printf("  degree     %d\n", b->made.degree);
    printf("  seconds    load %.3f, filter %.3f, beside %.3f, save %.3f (%s)\n", b->seconds[LOAD],
           b->seconds[FILTER], b->seconds[BESIDE], b->seconds[SAVE],
           kiln_context_cpu(b->job.context));
    char text[32];
    printf("  memory     %s at most\n", cli_bytes(os_peak_memory(), text));
    return CLI_DONE;
}

static int run(int argc, const char **argv)
{
    bake b = {0};
    int code = read_arguments(&b, argc, argv);
    if (code == CLI_GO) {
        code = cli_job_begin(&b.job, b.threads, b.quiet);
        b.since = cli_seconds();
        if (code == CLI_GO && (code = load(&b)) == CLI_GO) {
            next_stage(&b);
            code = b.textbook ? filter_by_textbook(&b) : filter_exactly(&b);
        }
        if (code == CLI_GO) {
            next_stage(&b);
            code = save(&b);
        }
        if (code == CLI_GO) {
            next_stage(&b);
            code = report(&b);
        }
        kiln_map_free(&b.source);
        kiln_environment_free(&b.made);
        code = cli_job_end(&b.job, code);
    }
    cli_arguments_free(&b.arguments);
    return code;
}

const cli_command cli_bake = {
    .name = "bake",
    .arguments = "IN... -o OUT [OPTION...]",
    .summary = "Bakes a panorama into a prefiltered environment.",
    .details =
        "IN is a panorama, cross, strip, octahedron or cube (EXR, HDR, PNG, KTX2, DDS), a folder\n"
        "or pattern of six faces, six files, or - for standard input. In a pattern, and in OUT,\n"
        "%s or {face} stands for px nx py ny pz nz; in OUT, %d or {level} stands for the level.\n"
        "\n"
        "Examples:\n"
        "  kiln bake city.exr -o city.ktx2\n"
        "      a cube of 256, nine levels of GGX, all in one file\n"
        "  kiln bake city.exr -o city.ktx2 --zstd --irradiance diffuse.ktx2 --sh sh.json\n"
        "      compressed, with an irradiance cube and spherical harmonics\n"
        "  kiln bake 'face_%s.png' -o out.dds --format b10g11r11 --roughness 0,0.25,0.5,1\n"
        "      six faces in, four levels of chosen roughness out\n"
        "  kiln bake city.exr --for three -o city.ktx2\n"
        "      what three.js loads\n"
        "  kiln bake city.exr -o 'level_%d.hdr' --shape panorama --method textbook\n"
        "      what courses teach, on panoramas, to compare with\n",
    .options = options,
    .run = run,
};
