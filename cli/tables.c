// kiln tables: tables of BRDF integrals, which depend on no environment. In: options. Out: an exact
// table (tables_exact.c), a split-sum table by importance sampling, or the GAMES202 assignment's
// tables (assignment.c). This file holds the options and the importance-sampled table.
#include "tables.h"
#include "assignment.h"

#include <stdio.h>
#include <string.h>

static const char *const formats[] = {"auto", "f32", "f16", "u16", "u8", "rgbd", NULL};
static const char *const methods[] = {"textbook", NULL};

static const char *kind_word(int index)
{
    return kiln_table_kind_names()[index];
}

static const char *engine_word(int index)
{
    const kiln_engine *engine = kiln_engine_at(index);
    return engine ? engine->name : NULL;
}

static const char *axis_word(int index)
{
    return kiln_axis_names()[index];
}

#define AT(field) offsetof(tables, field)

static const cli_option options[TABLES_OPTIONS + 1] = {
    [TABLES_OUTPUT] =
        {"output", CLI_FILE, AT(output), .value = "FILE", .letter = 'o',
         .help =
             "the table as .ktx2, .exr, .hdr, .png or .raw (numbers only), or as source code in "
             ".h, .inc (halves) or .glsl; with --assignment a folder, which is created if missing"},
    [TABLES_FOR] = {"for", CLI_CHOICE, AT(engine), 0, 0, -1, "ENGINE", .word = engine_word,
                    .help = "write the table that an engine can use instead of its own: for "
                            "babylon a .png for PBRMaterial.environmentBRDFTexture, for filament "
                            "the dfg.inc from which Filament is built; with --table lobes taps "
                            "read the levels of any engine"},
    [TABLES_TABLE] =
        {"table", CLI_CHOICE, AT(def.kind), .value = "KIND", .word = kind_word,
         .help = "kind of table; docs/tables.md describes each kind",
         .more =
             "e is the albedo of a specular lobe with F = 1, and eavg the cosine-weighted "
             "average of e. dfg holds A and B of the split sum. dfg-multiscatter holds B, A + "
             "B and the albedo of cloth in the order of Filament. sheen is the albedo of "
             "Charlie sheen. e-dielectric is e with the exact Fresnel term, for indices of "
             "refraction from 1 to 3. glass is the share of light that is reflected and "
             "transmitted, from outside and from inside, for the same indices. e-walk is the "
             "albedo that bounces after the first add to F0 A + B, computed by random walks "
             "for each F0. A lobe multiplied by 1 + e-walk / (F0 A + B) has the albedo of all "
             "bounces within 2e-3, if A and B are exact or from a table with --axis grazing "
             "--corners. Tables of e-walk always have that axis and corners. lobes replaces the "
             "single lookup of the split sum by 1 to 3 lookups and a correction from nine "
             "harmonics, which reflect the true lobe of GGX more closely."},
    [TABLES_G] = CLI_G_ROW(tables, def.model.g),
    [TABLES_D] = CLI_D_ROW(tables, def.model.d),
    [TABLES_SHEEN] = {"sheen", CLI_CHOICE, AT(def.sheen), .value = "MASKING",
                      .word = cli_sheen_word, .help = "with --table sheen: the masking function"},
    [TABLES_SIZE] =
        {"size", CLI_TEXT, AT(size), .value = "SIZE",
         .help = "number of texels as N, WxH or WxHxD, each 1 to 4096; with --method textbook N is "
                 "2 to 4096, with --assignment 2 to 1024",
         .unset = "128, with 32 along a third axis; 40x32x20 for e-walk; 32x32 for lobes; 512 with "
                  "--method textbook"},
    [TABLES_AXIS] = {"axis", CLI_CHOICE, AT(def.axis), .value = "AXIS", .word = axis_word,
                     .help = "the function of n.v that is the horizontal coordinate u; for the "
                             "kind e, interpolation has the least error with grazing",
                     .more = "grazing is sqrt(n.v (1 + alpha) / (n.v + alpha)). Tables of e-walk "
                             "have no other axis."},
    [TABLES_CORNERS] =
        {"corners", CLI_FLAG, AT(def.corners),
         .help =
             "place the outermost texels on the edges of the table instead of half a texel inside"},
    [TABLES_COMPLEMENT] = {"complement", CLI_FLAG, AT(def.complement),
                           .help = "store 1 - value, for kinds with one channel"},
    [TABLES_FLIP] = {"flip", CLI_FLAG, AT(def.flip),
                     .help = "begin with the row of roughness 1 instead of 0"},
    [TABLES_FORMAT] = {"format", CLI_CHOICE, AT(save.format), .value = "FORMAT", .words = formats,
                       .help = "how numbers are stored; rgbd is for three channels in a PNG"},
    [TABLES_ZSTD] = {"zstd", CLI_INTEGER, AT(save.zstd), 1, 22, 0, "LEVEL",
                     .help = "compress a KTX2 file by Zstandard", .alone = "3"},
    [TABLES_AVERAGE] =
        {"average", CLI_FILE, AT(average), .value = "FILE",
         .help =
             "with --table e: also write the cosine-weighted average of the interpolated table; "
             "with this average a white furnace has only the error of the interpolation"},
    [TABLES_LOOKUP] =
        {"lookup", CLI_FLAG, AT(lookup),
         .help = "also write code that reads the table, to NAME_lookup.h and NAME_lookup.glsl, and "
                 "for lobes to NAME_lookup.wgsl"},
    [TABLES_NAME] = {"name", CLI_TEXT, AT(save.name), .value = "NAME",
                     .help = "beginning of the names in source code",
                     .unset = "the name of the output file"},
    [TABLES_PATHS] = {"paths", CLI_INTEGER, AT(def.path_count), 16, 1 << 24, 0, "N",
                      .help = "number of random walks for each texel of e-walk", .unset = "8192"},
    [TABLES_TAPS] = {"taps", CLI_INTEGER, AT(def.tap_count), 1, KILN_MAX_TAPS, 0, "N",
                     .help = "with --table lobes: number of lookups", .unset = "1"},
    [TABLES_LEVELS] = {"levels", CLI_TEXT, AT(levels), .value = "LEVELS",
                       .help = "with --table lobes: the levels that the lookups read, as their "
                               "number, with equal steps of roughness from 0 to 1, or as the "
                               "roughness of each, R,R,...",
                       .unset = "7, or those of the engine of --for"},
    [TABLES_ERROR] = {"error", CLI_FILE, AT(error), .value = "FILE",
                      .help = "with --table lobes: also draw the expected errors as a PNG",
                      .more =
                          "From left to right: the split sum's lookup in the mirror direction, "
                          "the same in the bent direction, and the table. n.v goes from 0 to 1 "
                          "to the right, roughness from 0 to 1 downwards. The colours are black "
                          "below 1 %, then dark blue, blue, teal, green, orange and red for each "
                          "doubling, and white from 64 % on."},
    [TABLES_ASSIGNMENT] = {"assignment", CLI_FLAG, AT(assignment),
                           .help = "write all tables of part 1 of assignment 4 of GAMES202 into "
                                   "the folder -o DIR, with their errors",
                           .more =
                               "--size, --samples, --json and --quiet may be given too, and --g "
                               "schlick-k2 or --g schlick-text. With schlick-k2, the default, k is "
                               "roughness^2 / 2 as in the assignment's figures; with schlick-text "
                               "k is (roughness + 1)^2 / 8 as in the assignment's text."},
    [TABLES_METHOD] = {"method", CLI_CHOICE, AT(method), 0, 0, -1, "METHOD", .words = methods,
                       .help = "compute A and B of the split sum by sampling, as courses teach"},
    [TABLES_SAMPLES] =
        {"samples", CLI_INTEGER, AT(samples), 1, 1 << 20, 1024, "N",
         .help = "with --assignment or --method textbook: number of samples for each texel",
         .more = "Monte Carlo integration takes the largest square number that is not larger."},
    [TABLES_THREADS] = CLI_THREADS_ROW(tables),
    [TABLES_JSON] = {"json", CLI_FLAG, AT(json), .help = "report as JSON on standard output"},
    [TABLES_QUIET] = CLI_QUIET_ROW(tables),
};

// Checks that each given option is in `allowed`, a list that ends in -1.
static int check_options(const cli_arguments *a, const char *mode, const int *allowed)
{
    for (int option = 0; option < TABLES_OPTIONS; option++) {
        const int *at = allowed;
        while (*at >= 0 && *at != option)
            at++;
        if (a->text[option] && *at < 0)
            return cli_wrong(&cli_tables, "--%s is not for %s", options[option].name, mode);
    }
    return CLI_GO;
}

// ----------------------------------------------------------------------------- importance sampling

static int check_textbook(const tables *t, int *size)
{
    static const int allowed[] = {TABLES_OUTPUT,  TABLES_METHOD, TABLES_SIZE,
                                  TABLES_SAMPLES, TABLES_QUIET,  -1};
    const cli_arguments *a = &t->arguments;
    int code = check_options(a, "--method textbook", allowed);
    if (code != CLI_GO)
        return code;
    if (a->rest_count)
        return cli_wrong(&cli_tables, "%s: tables takes no input; name the output by -o FILE",
                         a->rest[0]);
    if (!t->output)
        return cli_wrong(&cli_tables, "no output: name it by -o FILE");
    if (!cli_ends_in(t->output, "exr") && !cli_ends_in(t->output, "hdr") &&
        !cli_ends_in(t->output, "png"))
        return cli_wrong(&cli_tables, "--output %s: must end in .exr, .hdr or .png", t->output);
    code = cli_integer(a, TABLES_SIZE, 2, 4096, size);
    return code == CLI_GO ? cli_check_folder(t->output) : code;
}

// Stores the channels (A, B) as red and green with blue 0, because every picture format can hold
// three channels.
static kiln_result widen(cli_work *work, const kiln_image *table, kiln_image *rgb)
{
    kiln_result result =
        kiln_image_create(work->context, table->width, table->height, 3, rgb, &work->error);
    size_t count = result ? 0 : (size_t)table->width * (size_t)table->height;
    for (size_t i = 0; i < count; i++) {
        rgb->pixels[3 * i] = table->pixels[2 * i];
        rgb->pixels[3 * i + 1] = table->pixels[2 * i + 1];
    }
    return result;
}

static int make_textbook(const tables *t)
{
    cli_work work;
    int size = 512, code = check_textbook(t, &size);
    if (code != CLI_GO)
        return code;
    kiln_image table = {0}, rgb = {0};
    code = cli_begin_work(&work, 0, t->quiet);
    if (code == CLI_GO)
        code = kiln_textbook_brdf(work.context, size, t->samples, &table, &work.error) ||
                       widen(&work, &table, &rgb) ||
                       kiln_image_save(work.context, &rgb, t->output, &work.error)
                   ? CLI_FAILED
                   : CLI_DONE;
    cli_clear_progress(&work);
    if (code == CLI_DONE && !t->quiet)
        printf("%s: split-sum table of %d x %d, %d samples, %.2f s\n", cli_show(t->output).text,
               size, size, t->samples, cli_elapsed(&work));
    kiln_image_free(&rgb);
    kiln_image_free(&table);
    return cli_end_work(&work, code);
}

// -------------------------------------------------------------------------------------- assignment

static int make_assignment(const tables *t)
{
    static const char *const g_names[] = {"schlick-k2", "schlick-text", NULL};
    static const int allowed[] = {TABLES_OUTPUT, TABLES_ASSIGNMENT, TABLES_G,
                                  TABLES_SIZE,   TABLES_SAMPLES,    TABLES_JSON,
                                  TABLES_QUIET,  TABLES_METHOD,     -1};
    const cli_arguments *a = &t->arguments;
    assignment_def def = {.folder = t->output,
                          .size = 128,
                          .samples = t->samples,
                          .json = t->json,
                          .quiet = t->quiet};
    int g = 0, code = check_options(a, "--assignment", allowed);
    if (code != CLI_GO)
        return code;
    if (a->rest_count)
        return cli_wrong(&cli_tables, "%s: tables takes no input; name the output by -o DIR",
                         a->rest[0]);
    if (t->method >= 0)
        return cli_wrong(&cli_tables, "--assignment has its own methods, leave --method out");
    if (!def.folder)
        return cli_wrong(&cli_tables, "no output: name a folder by -o DIR");
    if ((code = cli_integer(a, TABLES_SIZE, 2, 1024, &def.size)) != CLI_GO ||
        (code = cli_choice(a, TABLES_G, g_names, &g)) != CLI_GO ||
        (code = assignment_check_folder(&cli_tables, def.folder)) != CLI_GO)
        return code;
    def.g = g ? KILN_G_SCHLICK_TEXT : KILN_G_SCHLICK_K2;
    cli_work work;
    code = cli_begin_work(&work, 0, def.quiet);
    if (code == CLI_GO)
        code = assignment_write(&work, &def);
    return cli_end_work(&work, code);
}

static int run(const cli_call *call)
{
    tables t = {0};
    int code = cli_read_arguments(&t.arguments, &cli_tables, call, &t);
    if (code != CLI_GO)
        return code;
    return t.assignment    ? make_assignment(&t)
           : t.method >= 0 ? make_textbook(&t)
                           : tables_make_exact(&t);
}

static const cli_example examples[] = {
    {"kiln tables -o e.ktx2 --axis grazing --corners --average eavg.ktx2 --lookup",
     "the albedo and its average for Kulla and Conty's lobe, and the code that reads the tables"},
    {"kiln tables -o dfg.ktx2 --table dfg",
     "A and B of the split sum, in the layout of three.js, glTF viewers and most engines"},
    {"kiln tables --for babylon -o brdf.png",
     "a texture for PBRMaterial.environmentBRDFTexture of Babylon.js"},
    {"kiln tables -o walk.ktx2 --table e-walk --lookup",
     "the albedo that later bounces between microfacets add; takes about 2 s"},
    {"kiln tables -o lobes.ktx2 --table lobes --taps 2 --for three --lookup",
     "two lookups of the levels of three.js that reflect GGX's true lobe, and their code"},
    {"kiln tables -o e.h --table e --size 32 --axis grazing --corners",
     "an array in C for use without a texture"},
    {"kiln tables --assignment -o images",
     "the tables of assignment 4 of GAMES202, 128 x 128, and exact tables for comparison"},
    {"kiln tables --assignment -o text --g schlick-text",
     "the same tables with k as in the assignment's text, with which even a mirror loses light"},
    {"kiln tables --method textbook -o brdf.exr",
     "A and B by sampling, 512 x 512, with 1024 samples for each texel"},
    {NULL, NULL}};

const cli_command cli_tables = {
    .name = "tables",
    .arguments = "[--table KIND] -o FILE [OPTION...] | --assignment -o DIR [OPTION...] | "
                 "--method textbook -o FILE [OPTION...]",
    .summary = "Makes tables of the albedo and the split sum of reflection models.",
    .about =
        "Columns of a table go along the cosine n.v and rows along the roughness, beginning with "
        "0. A third axis goes along F0 (e-walk) or along the index of refraction from 1 to 3. "
        "docs/tables.md describes each kind of table.\n\n--assignment writes the albedo E by Monte "
        "Carlo integration, by importance sampling and by the split sum, the average E_avg, the "
        "exact tables, maps of the errors, and report.md. --method textbook writes A and B as "
        "courses sample them. In these tables the first row has roughness 1.",
    .more = "With --assignment, the pictures Emu_MC.png, Emu_IS.png and Eavg.png have the names "
            "and the orientation of the fourth assignment of GAMES202 (2021). kiln adds "
            "Emu_split_sum.png, a picture of 1 - E(mu) that is not flipped, the same integrals "
            "without sampling, maps of the errors, and report.md with all numbers and with the "
            "contradictions in the assignment's text. Bytes are truncated as the assignment's "
            "framework truncates them, and not rounded.",
    .examples = examples,
    .options = options,
    .run = run,
};
