// The options of kiln bake and their contradictions. In: a command line. Out: a `bake` whose
// numbers are in range, with the settings that the engine of --for decides, and with outputs whose
// file format can hold the wanted data.
#include "bake.h"
#include "os.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    OUTPUT,
    ENGINE,
    TUNE,
    FIT,
    SIZE,
    LEVELS,
    SHAPE,
    FORMAT,
    ZSTD,
    LOBE,
    ROUGHNESS,
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
    LAYER,
    NEGATIVE,
    UP,
    ROTATE,
    EXPOSURE,
    MIRROR,
    SUN,
    CLAMP,
    LIGHTS,
    LIGHTS_SHARE,
    LIGHTS_FILE,
    THREADS,
    JSON,
    QUIET,
    VERBOSE,
    OPTIONS
};

const char *const bake_lobes[] = {"ggx", "lambert", "charlie", "phong", NULL};
const char *const bake_shapes[] = {"auto", "panorama", "cube", "octahedron", NULL};
const char *const bake_methods[] = {"exact", "textbook", NULL};
const char *const bake_tunings[] = {"none", "sharp", "soft", NULL};
static const char *const layouts[] = {"auto",       "panorama", "cross", "strip",
                                      "octahedron", "probe",    "ball",  NULL};

static const char *const ups[] = {"y", "z", "-z", NULL};

static const char *format_word(int index)
{
    return kiln_format_names()[index];
}

static const char *engine_word(int index)
{
    const kiln_engine *engine = kiln_engine_at(index);
    return engine ? engine->name : NULL;
}

#define AT(field) offsetof(bake, field)

const cli_option bake_options[OPTIONS + 1] = {
    [OUTPUT] = {"output", CLI_FILE, AT(output), .value = "OUT", .letter = 'o', .group = "Output",
                .help = "what to write, chosen by the ending: .ktx2 and .dds files hold a cube "
                        "with all its levels; .exr, .hdr and .png files hold one face of one level "
                        "each; a folder, whose name ends in /, receives EXR files",
                .more = "Every file is written whole or not at all. The name - is standard output, "
                        "which takes one file: KTX2, or the format whose ending follows, as in "
                        "-.dds. Several inputs are baked one after the other if the name holds "
                        "{name}."},
    [ENGINE] = {"for", CLI_CHOICE, AT(engine_index), 0, 0, -1, "ENGINE", .word = engine_word,
                .help = "write the files that an engine loads, with the engine's levels, "
                        "roughnesses, axes and encoding; 'kiln engines' describes each engine",
                .more = "With this option the size must be a power of two."},
    [TUNE] = {"tune", CLI_CHOICE, AT(tuning), 0, 0, -1, "WHICH", .words = bake_tunings,
              .help = "with --for: choose the texels of the levels such that the engine's picture "
                      "has the least error in this environment after the engine has mixed two "
                      "levels and interpolated between texels; sharp leaves level 0 unfiltered, "
                      "soft tunes level 0 too, none writes exactly filtered levels",
              .unset = "sharp for engines that 'kiln engines' calls tuned, else none"},
    [FIT] = {"fit", CLI_RENAMED,
             .help = "this option is --tune sharp, --tune soft or "
                     "--tune none since version 0.2"},
    [SIZE] = {"size", CLI_INTEGER, AT(size), 1, KILN_MAX_SIZE, 256, "N",
              .help = "texels along the edge of a face, or rows of a panorama",
              .unset = "256, or the engine's with --for"},
    [LEVELS] = {"levels", CLI_INTEGER, AT(level_count), 1, KILN_MAX_LEVELS, 0, "N",
                .help = "mip levels to write",
                .unset = "all, down to 1 texel, or the engine's with --for"},
    [SHAPE] = {"shape", CLI_CHOICE, AT(shape), 0, 0, KILN_SHAPE_CUBE - KILN_SHAPE_PANORAMA, "SHAPE",
               .words = bake_shapes + KILN_SHAPE_PANORAMA, .help = "the kind of map to write"},
    [FORMAT] =
        {"format", CLI_CHOICE, AT(format), .value = "FORMAT", .word = format_word,
         .help = "how texels are stored in KTX2 and DDS; rgba16f and rgba32f are half and "
                 "float in EXR too; rgbm, rgbd and rgbp are for PNG",
         .unset = "rgba16f, or the engine's with --for, which auto stands for too",
         .more = "bc6h and uastc take one byte for each texel and have errors of about a per cent; "
                 "uastc (UASTC HDR 4x4) is for KTX2 and for web engines. rgbm, rgbd and rgbp hold "
                 "radiance up to 64, 255 and 64 in four bytes. Each engine of --for has a default "
                 "of its own, for which 'kiln engines ENGINE' gives the reason."},
    [ZSTD] = {"zstd", CLI_INTEGER, AT(zstd), 1, 22, 0, "LEVEL",
              .help = "compress KTX2 files by Zstandard", .alone = "3"},
    [LOBE] = {"lobe", CLI_CHOICE, AT(lobe), .value = "LOBE", .words = bake_lobes, .group = "Filter",
              .help = "the weight as a function of the angle by which each level is averaged; the "
                      "width of a lobe is alpha, the square of the roughness"},
    [ROUGHNESS] = {"roughness", CLI_TEXT, AT(roughness_text), .value = "LIST",
                   .help = "the roughness of each level, as numbers from 0 to 1 with commas "
                           "between them, or the word linear for equal steps from 0 to 1",
                   .unset = "linear"},
    [METHOD] = {"method", CLI_CHOICE, AT(textbook), .value = "METHOD", .words = bake_methods,
                .help = "how levels are computed: exact by spherical harmonics; textbook as "
                        "courses teach, by importance sampling on Hammersley points, or for --lobe "
                        "lambert by a uniform sum over two angles",
                .more = "The textbook method is for learning and for comparison."},
    [SAMPLES] = {"samples", CLI_INTEGER, AT(samples), 1, 1 << 20, 1024, "N",
                 .help = "with --method textbook: number of samples for each texel"},
    [PHI_STEPS] = {"phi-steps", CLI_INTEGER, AT(phi_steps), 1, 10000, 100, "N",
                   .help =
                       "with --method textbook --lobe lambert: number of steps around the normal"},
    [THETA_STEPS] = {"theta-steps", CLI_INTEGER, AT(theta_steps), 1, 10000, 100, "N",
                     .help = "with --method textbook --lobe lambert: number of steps from the "
                             "normal to the horizon"},
    [IRRADIANCE] =
        {"irradiance", CLI_FILE, AT(irradiance_path), .value = "FILE", .group = "Diffuse light",
         .help = "write a map of the irradiance divided by pi, in which a white environment is 1"},
    [IRRADIANCE_SIZE] =
        {"irradiance-size", CLI_INTEGER, AT(irradiance_size), 1, KILN_MAX_SIZE, 64, "N",
         .help = "texels along the edge of a face of the irradiance map, or rows of a panorama"},
    [SH] = {"sh", CLI_FILE, AT(sh_path), .value = "FILE",
            .help = "write spherical harmonics to a .json, .txt or .h file",
            .more = "The metadata of a KTX2 file hold the spherical harmonics of the radiance, "
                    "with or without this option."},
    [SH_BANDS] = {"sh-bands", CLI_INTEGER, AT(sh_bands), 1, KILN_MAX_BANDS, 3, "N",
                  .help =
                      "number of bands of spherical harmonics; N bands have N x N coefficients"},
    [SH_RADIANCE] = {"sh-radiance", CLI_FLAG, AT(sh_radiance),
                     .help = "write the coefficients of the radiance, which is the default"},
    [SH_IRRADIANCE] = {"sh-irradiance", CLI_FLAG, AT(sh_irradiance),
                       .help = "write the coefficients of the irradiance"},
    [SH_WINDOW] = {"sh-window", CLI_NUMBER, AT(sh_window), 1, 1000, 0, "W",
                   .help = "multiply band l by (1 + cos(pi l / W)) / 2, which reduces ringing",
                   .unset = "none"},
    [LAYOUT] =
        {"layout", CLI_CHOICE, AT(layout), .value = "LAYOUT", .words = layouts, .group = "Input",
         .help = "how a picture that is read lies on the sphere; auto decides by the proportions",
         .more = "A panorama named so need not be twice as wide as high: the picture is stretched "
                 "over the whole sphere. A probe is a square angular map with -Z in its centre, a "
                 "ball the square photograph of a mirror ball; both become a panorama."},
    [LAYER] = CLI_LAYER_ROW(bake),
    [NEGATIVE] = CLI_NEGATIVE_ROW(bake),
    [UP] = {"up", CLI_CHOICE, AT(up), .value = "AXIS", .words = ups,
            .help =
                "the axis of the input that points up, after --mirror; with z, kiln's direction "
                "(x, y, z) shows the input's (x, -z, y)"},
    [ROTATE] = {"rotate", CLI_TEXT, AT(rotation_text), .value = "YAW[,PITCH[,ROLL]]",
                .help =
                    "turn the environment by angles in degrees, after --mirror and --up: by ROLL "
                    "about the view axis, by PITCH about +X, which moves what is ahead up, and "
                    "by YAW about the vertical axis, which moves the content of a panorama to "
                    "the left",
                .unset = "0,0,0"},
    [EXPOSURE] = {"exposure", CLI_NUMBER, AT(exposure), -64, 64, 0, "STOPS",
                  .help = "multiply the radiance by 2^STOPS"},
    [MIRROR] = {"mirror", CLI_FLAG, AT(mirror), .help = "swap left and right, before --rotate"},
    [SUN] = {"sun", CLI_TEXT, AT(sun_text), .value = "WHICH", .group = "Sun and lamps",
             .help = "what becomes of the sun and other compact lights: keep leaves them in the "
                     "maps, extract takes the light with the largest share out, clamp=RADIANCE "
                     "makes texels above a radiance darker, clamp=auto chooses the radiance",
             .unset = "keep",
             .more =
                 "A light that is taken out is for an analytic light of the engine, which shows "
                 "its highlight sharply and casts shadows. 'kiln lights' lists the lights of a "
                 "panorama."},
    [CLAMP] = {"clamp", CLI_TEXT, AT(clamp_text), .value = "RADIANCE",
               .help = "the same as --sun clamp=RADIANCE; the word auto chooses the radiance"},
    [LIGHTS] = CLI_LIGHTS_ROW(bake),
    [LIGHTS_SHARE] = CLI_LIGHTS_SHARE_ROW(bake),
    [LIGHTS_FILE] = {"lights-file", CLI_FILE, AT(lights_path), .value = "FILE",
                     .help = "with --sun extract: write the lights to a .json file"},
    [THREADS] = {"threads", CLI_INTEGER, AT(threads), 1, 256, 0, "N",
                 .help = "number of threads; the result is the same for every number",
                 .letter = 'j', .unset = "one per core", .group = "Work and report"},
    [JSON] = {"json", CLI_FLAG, AT(json),
              .help =
                  "report as JSON on standard output: files read and written, levels, seconds "
                  "for each stage, the most memory held, and what was found in the input and cut "
                  "off in the output"},
    [QUIET] = CLI_QUIET_ROW(bake),
    [VERBOSE] = {"verbose", CLI_FLAG, AT(verbose), .letter = 'v',
                 .help = "print levels, times and memory"},
};

// --------------------------------------------------------------------------------------- roughness

static int read_roughness(bake *b)
{
    const char *text = b->roughness_text;
    if (!text || !strcmp(text, "linear"))
        return CLI_GO;
    int count = 0;
    for (const char *at = text;; at++) {
        char *end;
        double r = strtod(at, &end);
        if (end == at || (*end && *end != ','))
            return cli_wrong(b->arguments.command,
                             "--roughness is '%s', it must be 'linear' or numbers from "
                             "0 to 1 with commas between them",
                             text);
        if (!(r >= 0 && r <= 1))
            return cli_wrong(b->arguments.command,
                             "--roughness: number %d is %g, it must be from 0 to 1", count + 1, r);
        if (count == KILN_MAX_LEVELS)
            return cli_wrong(b->arguments.command, "--roughness has more than %d numbers",
                             KILN_MAX_LEVELS);
        b->roughness[count++] = (float)r;
        at = end;
        if (!*at)
            break;
    }
    if (b->level_count && b->level_count != count)
        return cli_wrong(b->arguments.command, "--roughness has %d numbers, but --levels is %d",
                         count, b->level_count);
    b->level_count = count;
    b->has_roughness = true;
    return CLI_GO;
}

// ---------------------------------------------------------------------------------------- rotation

static int read_rotation(bake *b)
{
    enum { LIMIT = 3600 };
    double *angles[] = {&b->rotation, &b->pitch, &b->roll};
    const char *at = b->rotation_text;
    for (int i = 0; at && i < 3; i++) {
        char *end;
        double angle = strtod(at, &end);
        if (end == at || (*end && *end != ',') || (*end && i == 2))
            return cli_wrong(
                b->arguments.command,
                "--rotate is '%s', it must be a number of degrees, or up to three with "
                "commas between them",
                b->rotation_text);
        if (!(angle >= -LIMIT && angle <= LIMIT))
            return cli_wrong(b->arguments.command,
                             "--rotate: number %d is %g, it must be from -%d to %d", i + 1, angle,
                             LIMIT, LIMIT);
        *angles[i] = angle;
        at = *end ? end + 1 : NULL;
    }
    return CLI_GO;
}

// ----------------------------------------------------------------------------------------- outputs

// Returns the first engine of kiln's list that loads files with the ending of this path, or NULL if
// no engine does.
static const kiln_engine *engine_of(const char *path)
{
    const kiln_engine *engine;
    for (int i = 0; (engine = kiln_engine_at(i)) != NULL; i++)
        if (engine->ending[0] && cli_ends_in(path, engine->ending))
            return engine;
    return NULL;
}

// Checks that the file at `path` can hold the wanted data. `option` names the path in error
// messages.
static int check_output(const bake *b, const char *option, const char *path)
{
    const kiln_save_def def = {.format = (kiln_format)b->format};
    kiln_error error;
    if (!strcmp(path, "-"))
        return cli_wrong(b->arguments.command,
                         "%s: only --output can be standard output, name a file", option);
    if (!kiln_map_save_check(path, (kiln_shape)b->shape, &def, &error))
        return CLI_GO;
    bool is_main = path == b->output;
    const kiln_engine *engine = is_main ? engine_of(path) : NULL;
    kiln_error ignored;
    if (engine && kiln_map_save_check(path, KILN_SHAPE_CUBE, NULL, &ignored))
        return cli_wrong(b->arguments.command, "%s %s: .%s is a file for %s, add --for %s", option,
                         path, engine->ending, engine->title, engine->name);
    return cli_wrong(b->arguments.command, "%s %s", option, error.message);
}

// Takes "-" as standard output, and the letters after "-." as the ending of the format: KTX2, or
// the engine's format, if none is named.
static void take_stdout(bake *b)
{
    bool bare = !strcmp(b->output, "-");
    b->to_stdout = bare || !strncmp(b->output, "-.", 2);
    const char *ending =
        kiln_engine_ending(kiln_engine_at(b->engine_index), (kiln_format)b->format);
    if (bare)
        snprintf(b->folder[0], sizeof b->folder[0], "-.%s", ending && ending[0] ? ending : "ktx2");
    b->output = bare ? b->folder[0] : b->output;
}

// Checks that standard output can take the file: one file, no report beside it, and no terminal.
static int check_stdout(const bake *b)
{
    const cli_command *command = b->arguments.command;
    bool one_file =
        b->engine ? b->engine->ending[0] != 0
                  : cli_ends_in(b->output, "ktx2") || cli_ends_in(b->output, "dds") ||
                        ((b->shape == KILN_SHAPE_PANORAMA || b->shape == KILN_SHAPE_OCTAHEDRON) &&
                         b->level_count == 1);
    if (!b->to_stdout)
        return CLI_GO;
    if (!one_file)
        return cli_wrong(command,
                         "--output %s: standard output holds one file, and this environment takes "
                         "several; choose -.ktx2, or --shape panorama --levels 1",
                         b->output);
    if (b->json || b->verbose)
        return cli_wrong(command, "--output -: standard output holds the file, leave out --%s",
                         b->json ? "json" : "verbose");
    if (b->irradiance_path || b->sh_path || b->lights_path)
        return cli_wrong(command, "--output -: standard output holds one file, leave out --%s",
                         b->irradiance_path ? "irradiance"
                         : b->sh_path       ? "sh"
                                            : "lights-file");
    if (os_is_terminal(OS_OUTPUT))
        return cli_wrong(command,
                         "--output -: standard output is a terminal, which cannot show the "
                         "file; redirect it to a file or a program");
    return CLI_GO;
}

static int check_folder(const bake *b, const char *path)
{
    kiln_error error;
    if (!b->makes_folders)
        return cli_check_folder(path);
    return cli_make_folders(path, false, NULL, &error) ? CLI_GO : cli_fail("%s", error.message);
}

static int check_paths(const bake *b)
{
    enum { PATHS = 4 };
    const char *paths[PATHS] = {b->output, b->irradiance_path, b->sh_path, b->lights_path};
    static const char *const names[] = {"--output", "--irradiance", "--sh", "--lights-file"};
    int code = CLI_GO;
    for (int i = 0; i < PATHS; i++)
        for (int k = 0; k < i; k++)
            if (paths[i] && paths[k] && !strcmp(paths[i], paths[k]))
                return cli_wrong(b->arguments.command, "%s and %s are the same file, %s", names[k],
                                 names[i], paths[i]);
    if (b->sh_path && !cli_ends_in(b->sh_path, "json") && !cli_ends_in(b->sh_path, "txt") &&
        !cli_ends_in(b->sh_path, "h"))
        return cli_wrong(b->arguments.command, "--sh %s: must end in .json, .txt or .h",
                         b->sh_path);
    if (!b->engine)
        code = check_output(b, "--output", b->output);
    if (code == CLI_GO && b->irradiance_path)
        code = check_output(b, "--irradiance", b->irradiance_path);
    for (int i = 0; i < PATHS && code == CLI_GO; i++)
        if (paths[i])
            code = check_folder(b, paths[i]);
    return code;
}

// Adds the final slash, which the library requires, to the name of an existing folder.
static const char *add_slash(const char *path, char folder[4096])
{
    size_t length = path ? strlen(path) : 0;
    if (!length || length + 2 > 4096 || path[length - 1] == '/' || !cli_ends_in(path, "/"))
        return path;
    snprintf(folder, 4096, "%s/", path);
    return folder;
}

// ---------------------------------------------------------------------------- options of an engine

// Returns the engine's first format whose files have the ending of `path`, or KILN_FORMAT_AUTO.
static kiln_format format_of_ending(const kiln_engine *engine, const char *path)
{
    for (int k = 0; k < 4 && engine->formats[k]; k++)
        if (cli_ends_in(path, kiln_engine_ending(engine, engine->formats[k])))
            return engine->formats[k];
    return KILN_FORMAT_AUTO;
}

// Checks that no option is given whose value the engine decides.
static int check_engine(const bake *b)
{
    static const int decided[] = {SHAPE, ZSTD, ROUGHNESS, LOBE, METHOD};
    const char *name = b->engine->name;
    const char *ending = kiln_engine_ending(b->engine, (kiln_format)b->format);
    for (size_t i = 0; i < sizeof decided / sizeof *decided; i++)
        if (b->arguments.text[decided[i]])
            return cli_wrong(b->arguments.command,
                             "--for %s decides what --%s is, leave one of them out", name,
                             bake_options[decided[i]].name);
    if (!ending[0] || cli_ends_in(b->output, ending))
        return CLI_GO;
    kiln_format other = format_of_ending(b->engine, b->output);
    return other ? cli_wrong(b->arguments.command,
                             "--output %s: --for %s writes .%s; for this ending add --format %s",
                             b->output, name, ending, kiln_format_names()[other])
                 : cli_wrong(b->arguments.command, "--output %s: --for %s writes .%s", b->output,
                             name, ending);
}

// Takes the lobe and the roughness of each level from the engine of --for, and checks the format.
static int apply_engine(bake *b)
{
    b->engine = kiln_engine_at(b->engine_index);
    if (!b->engine && b->arguments.text[TUNE])
        return cli_wrong(b->arguments.command, "--tune needs --for ENGINE");
    if (!b->engine)
        return CLI_GO;
    kiln_error error = {0};
    kiln_format format = (kiln_format)b->format;
    kiln_prefilter_def def;
    int code = check_engine(b);
    if (code != CLI_GO)
        return code;
    if (kiln_engine_format(b->engine, &format, &error) ||
        kiln_engine_levels(b->engine, b->arguments.text[SIZE] ? b->size : 0, b->level_count,
                           b->roughness, &def, &error))
        return cli_wrong(b->arguments.command, "--for %s", error.message);
    b->size = def.size;
    b->level_count = def.level_count;
    b->stores_sh = true;
    if (b->tuning < 0 && b->engine->tune)
        b->tuning = BAKE_SHARP;
    return CLI_GO;
}

// ---------------------------------------------------------------------------------- contradictions

static int check_textbook(const bake *b)
{
    const char *const *given = b->arguments.text;
    bool lambert = b->lobe == KILN_LOBE_LAMBERT;
    if (b->lobe != KILN_LOBE_GGX && !lambert)
        return cli_wrong(b->arguments.command,
                         "--method textbook knows the lobes ggx and lambert, not %s",
                         bake_lobes[b->lobe]);
    if (b->pitch != 0 || b->roll != 0 || b->up != KILN_UP_Y)
        return cli_wrong(
            b->arguments.command,
            "--method textbook turns about the vertical axis only, leave out --up, and "
            "pitch and roll of --rotate");
    if (b->has_roughness)
        return cli_wrong(b->arguments.command,
                         "--method textbook spaces its roughness linearly, leave "
                         "--roughness out");
    if (given[SAMPLES] && lambert)
        return cli_wrong(b->arguments.command,
                         "--samples is for --lobe ggx; the textbook irradiance has "
                         "--phi-steps and --theta-steps");
    if ((given[PHI_STEPS] || given[THETA_STEPS]) && !lambert && !b->irradiance_path)
        return cli_wrong(b->arguments.command, "--phi-steps and --theta-steps are for irradiance: "
                                               "--lobe lambert or --irradiance FILE");
    return CLI_GO;
}

static int check_exact(const bake *b)
{
    static const int sampled[] = {SAMPLES, PHI_STEPS, THETA_STEPS};
    for (size_t i = 0; i < sizeof sampled / sizeof *sampled; i++)
        if (b->arguments.text[sampled[i]])
            return cli_wrong(b->arguments.command,
                             "--%s is for --method textbook; the exact method has no samples",
                             bake_options[sampled[i]].name);
    return CLI_GO;
}

static int check_harmonics(const bake *b)
{
    static const int of_file[] = {SH_WINDOW, SH_RADIANCE, SH_IRRADIANCE};
    if (b->sh_radiance && b->sh_irradiance)
        return cli_wrong(b->arguments.command,
                         "--sh-radiance and --sh-irradiance contradict each other");
    for (size_t i = 0; i < sizeof of_file / sizeof *of_file && !b->sh_path; i++)
        if (b->arguments.text[of_file[i]])
            return cli_wrong(b->arguments.command, "--%s needs --sh FILE",
                             bake_options[of_file[i]].name);
    if (b->arguments.text[SH_BANDS] && !b->sh_path && !b->stores_sh)
        return cli_wrong(b->arguments.command, "--sh-bands needs --sh FILE or a .ktx2 output");
    return CLI_GO;
}

static int largest_level_count(int size)
{
    int count = 1;
    for (; size > 1; size /= 2)
        count++;
    return count < KILN_MAX_LEVELS ? count : KILN_MAX_LEVELS;
}

static int check_levels(const bake *b)
{
    if (b->lobe == KILN_LOBE_LAMBERT && b->level_count > 1)
        return cli_wrong(b->arguments.command,
                         "--levels is %d, it must be 1 for --lobe lambert, which has no roughness",
                         b->level_count);
    if (!b->engine && b->level_count > largest_level_count(b->size))
        return cli_wrong(b->arguments.command,
                         "--levels is %d, a map of size %d has %d levels at most", b->level_count,
                         b->size, largest_level_count(b->size));
    return CLI_GO;
}

bool bake_is_for_several(const bake *b)
{
    const char *paths[] = {b->output, b->irradiance_path, b->sh_path, b->lights_path};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (paths[i] && strstr(paths[i], "{name}"))
            return true;
    return false;
}

// Checks options that are valid only with a certain method, lobe or file.
static int check_combinations(const bake *b)
{
    const char *const *given = b->arguments.text;
    if (b->quiet && b->verbose)
        return cli_wrong(b->arguments.command, "--quiet and --verbose contradict each other");
    if (b->json && b->verbose)
        return cli_wrong(b->arguments.command,
                         "--json and --verbose contradict each other: the report has "
                         "everything");
    int code = b->textbook ? check_textbook(b) : check_exact(b);
    if (code == CLI_GO)
        code = check_levels(b);
    if (code != CLI_GO)
        return code;
    if (given[ZSTD] && !cli_ends_in(b->output, "ktx2"))
        return cli_wrong(b->arguments.command, "--zstd is for .ktx2 files, not for %s", b->output);
    if (given[IRRADIANCE_SIZE] && !b->irradiance_path)
        return cli_wrong(b->arguments.command, "--irradiance-size needs --irradiance FILE");
    if (given[LAYOUT] && b->arguments.rest_count > 1 && !bake_is_for_several(b))
        return cli_wrong(b->arguments.command,
                         "--layout is for one picture, leave it out for six faces");
    return check_harmonics(b);
}

int bake_check_options(bake *b)
{
    cli_arguments *a = &b->arguments;
    int code = bake_read_sun(b, a->text[LIGHTS] != NULL, a->text[LIGHTS_SHARE] != NULL);
    b->shape += KILN_SHAPE_PANORAMA; // word 0 of --shape is `panorama`, enumerator 1
    bool several = code == CLI_GO && bake_is_for_several(b) && a->rest_count > 0;
    if (code == CLI_GO && !several)
        code = cli_check_input(a->command, a->rest, a->rest_count);
    if (code != CLI_GO)
        return code;
    if (!b->output)
        return cli_wrong(b->arguments.command, "no output: name it by -o OUT");
    take_stdout(b);
    b->output = add_slash(b->output, b->folder[0]);
    b->irradiance_path = add_slash(b->irradiance_path, b->folder[1]);
    b->stores_sh = cli_ends_in(b->output, "ktx2");
    if ((code = read_roughness(b)) != CLI_GO || (code = read_rotation(b)) != CLI_GO ||
        (code = apply_engine(b)) != CLI_GO || (code = check_combinations(b)) != CLI_GO)
        return code;
    if (b->tuning < 0)
        b->tuning = BAKE_EXACT;
    if (b->lobe == KILN_LOBE_LAMBERT)
        b->level_count = 1;
    code = check_stdout(b);
    return code == CLI_GO ? check_paths(b) : code;
}

int bake_read_options(bake *b, const cli_command *command, const cli_call *call)
{
    int code = cli_read_arguments(&b->arguments, command, call, b);
    return code == CLI_GO ? bake_check_options(b) : code;
}

bool bake_changes_files(int option)
{
    return option < THREADS;
}
