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

static const char *axis_word(int index)
{
    return kiln_axis_names()[index];
}

#define AT(field) offsetof(tables, field)

static const cli_option options[TABLES_OPTIONS + 1] = {
    [TABLES_OUTPUT] =
        {"output", CLI_FILE, AT(output), .value = "FILE", .letter = 'o',
         .help = "the table: .ktx2, .exr, .hdr, .png, .raw (numbers alone), or source code, "
                 ".h, .inc (halves) or .glsl; with --assignment a folder, made where missing"},
    [TABLES_FOR] = {"for", CLI_CHOICE, AT(engine), 0, 0, -1, "ENGINE", .word = tables_engine_word,
                    .help =
                        "what an engine looks up in place of its own table: a .png for Babylon.js' "
                        "PBRMaterial.environmentBRDFTexture, the dfg.inc that Filament's build "
                        "compiles in"},
    [TABLES_TABLE] =
        {"table", CLI_CHOICE, AT(def.kind), .value = "KIND", .word = kind_word,
         .help = "what the table holds",
         .more = "e is the albedo of one bounce with F = 1; eavg its average over the cosine; "
                 "dfg A and B of the split sum; dfg-multiscatter Filament's: B, A + B and the "
                 "cloth's albedo; sheen the albedo of Charlie; e-dielectric e with exact "
                 "Fresnel, over the index of refraction from 1 to 3; glass what is reflected "
                 "and transmitted from outside and from inside, over the same. e-walk is what "
                 "the bounces after the first add to the albedo F0 A + B, by random walk, over "
                 "F0: the lobe times 1 + it / (F0 A + B) has the albedo of all bounces within "
                 "2e-3, if A and B are exact or from a table with --axis grazing --corners, "
                 "which e-walk always has."},
    [TABLES_G] = CLI_G_ROW(tables, def.model.g),
    [TABLES_D] = CLI_D_ROW(tables, def.model.d),
    [TABLES_SHEEN] = {"sheen", CLI_CHOICE, AT(def.sheen), .value = "MASKING",
                      .word = cli_sheen_word, .help = "masking of --table sheen"},
    [TABLES_SIZE] =
        {"size", CLI_TEXT, AT(size), .value = "SIZE",
         .help = "texels as N, WxH or WxHxD, 1 to 4096 each; with --method textbook N is 2 to "
                 "4096, with --assignment 2 to 1024",
         .unset = "128, with a third axis 32, of e-walk 40x32x20; 512 and 128 with those two"},
    [TABLES_AXIS] = {"axis", CLI_CHOICE, AT(def.axis), .value = "AXIS", .word = axis_word,
                     .help = "what u is of n.v; grazing errs least for e",
                     .more =
                         "grazing is sqrt(n.v (1 + alpha) / (n.v + alpha)); e-walk has no other."},
    [TABLES_CORNERS] = {"corners", CLI_FLAG, AT(def.corners),
                        .help = "the outermost texels stand on the edges, not half a texel inside"},
    [TABLES_COMPLEMENT] = {"complement", CLI_FLAG, AT(def.complement),
                           .help = "1 - value, of kinds with one number"},
    [TABLES_FLIP] = {"flip", CLI_FLAG, AT(def.flip), .help = "the first row is roughness 1"},
    [TABLES_FORMAT] = {"format", CLI_CHOICE, AT(save.format), .value = "FORMAT", .words = formats,
                       .help = "how numbers are stored; rgbd is for three of them in a PNG"},
    [TABLES_ZSTD] = {"zstd", CLI_INTEGER, AT(save.zstd), 1, 22, 0, "LEVEL",
                     .help = "compress KTX2 by Zstandard", .alone = "3"},
    [TABLES_AVERAGE] =
        {"average", CLI_FILE, AT(average), .value = "FILE",
         .help = "with --table e: E_avg of what looking the table up shows, into a file of "
                 "its own; with that the white furnace errs by no more than the lookup"},
    [TABLES_LOOKUP] = {"lookup", CLI_FLAG, AT(lookup),
                       .help = "write the code that reads the table too: NAME_lookup.h and "
                               "NAME_lookup.glsl"},
    [TABLES_NAME] = {"name", CLI_TEXT, AT(save.name), .value = "NAME",
                     .help = "what names in source code begin with", .unset = "the file's own"},
    [TABLES_PATHS] = {"paths", CLI_INTEGER, AT(def.path_count), 16, 1 << 24, 0, "N",
                      .help = "random walks a texel of e-walk", .unset = "8192"},
    [TABLES_ASSIGNMENT] =
        {"assignment", CLI_FLAG, AT(assignment),
         .help = "all of GAMES202's assignment 4, part 1, into the folder -o DIR, with "
                 "errors",
         .more = "--size, --samples, --json and --quiet go with this, and --g schlick-k2, "
                 "the default there, or schlick-text: k is roughness^2 / 2 as in the "
                 "assignment's figures, or (roughness + 1)^2 / 8 as in its text."},
    [TABLES_METHOD] = {"method", CLI_CHOICE, AT(method), 0, 0, -1, "METHOD", .words = methods,
                       .help = "A and B of the split sum by sampling, as courses do"},
    [TABLES_SAMPLES] = {"samples", CLI_INTEGER, AT(samples), 1, 1 << 20, 1024, "N",
                        .help = "samples a texel, of --assignment and --method textbook",
                        .more = "Monte Carlo takes the largest square up to that."},
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
        printf("%s: split-sum table of %d x %d, %d samples, %.2f s\n", t->output, size, size,
               t->samples, cli_elapsed(&work));
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
        return cli_wrong(&cli_tables, "--assignment has its own methods: leave --method out");
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
     "E and E_avg for Kulla and Conty's lobe, and the code that reads them"},
    {"kiln tables -o dfg.ktx2 --table dfg",
     "the split sum, as three.js, glTF viewers and most engines look it up"},
    {"kiln tables --for babylon -o brdf.png", "PBRMaterial.environmentBRDFTexture"},
    {"kiln tables -o walk.ktx2 --table e-walk --lookup",
     "what later bounces add to A and B, grazing axis and corners; 2 s"},
    {"kiln tables -o e.h --table e --size 32 --axis grazing --corners",
     "an array for those who want no texture"},
    {"kiln tables --assignment -o images",
     "what GAMES202's assignment 4 asks for, 128 x 128, and the exact ones"},
    {"kiln tables --assignment -o text --g schlick-text",
     "the same with the k of its text, with which a mirror glows"},
    {"kiln tables --method textbook -o brdf.exr",
     "the split sum as courses compute it, 512 x 512, 1024 samples a texel"},
    {NULL, NULL}};

const cli_command cli_tables = {
    .name = "tables",
    .arguments = "[--table KIND] -o FILE [OPTION...] | --assignment -o DIR [OPTION...] | "
                 "--method textbook -o FILE [OPTION...]",
    .summary = "Makes tables of a BRDF's integrals.",
    .about =
        "u is n.v, v is roughness, 0 in the first row; a third axis goes along F0 (e-walk) or the "
        "index of refraction from 1 to 3. What each kind holds: docs/tables.md.\n\n"
        "--assignment writes E(mu) by Monte Carlo, importance sampling and split sum, E_avg, the "
        "exact "
        "ones, maps of the errors, and report.md; --method textbook A and B as courses sample "
        "them. "
        "There roughness is 1 at the top.",
    .more =
        "With --assignment, pictures have the names and the orientation of GAMES202's fourth "
        "assignment "
        "(2021): Emu_MC.png, Emu_IS.png, Emu_split_sum.png, 1 - E(mu) unflipped, and Eavg.png. "
        "With "
        "them are the same integrals without sampling, maps of the errors, and report.md with all "
        "figures and with the assignment's own contradictions. Bytes are cut as its framework cuts "
        "them, not rounded.",
    .examples = examples,
    .options = options,
    .run = run,
};
