// kiln tables: integrals of the BRDF that need no panorama.
#include "tables.h"
#include "assignment.h"

#include <stdio.h>
#include <string.h>

static const struct poptOption options[] = {
    {"output", 'o', POPT_ARG_STRING, NULL, TABLES_OUTPUT,
     "the table: .ktx2, .exr, .hdr, .png, .raw, .h, .inc or .glsl", "FILE"},
    {"for", 0, POPT_ARG_STRING, NULL, TABLES_FOR,
     "what an engine looks up in place of its own: babylon (.png) or filament (.inc)", "ENGINE"},
    {"table", 0, POPT_ARG_STRING, NULL, TABLES_TABLE,
     "e (the default), eavg, dfg, dfg-multiscatter, sheen, e-dielectric, glass or e-walk", "KIND"},
    {"g", 0, POPT_ARG_STRING, NULL, TABLES_G,
     "masking: smith (the default), smith-uncorrelated, schlick-k2 or schlick-text", "G"},
    {"d", 0, POPT_ARG_STRING, NULL, TABLES_D, "normals: ggx (the default) or beckmann", "D"},
    {"sheen", 0, POPT_ARG_STRING, NULL, TABLES_SHEEN,
     "masking of --table sheen: ashikhmin (the default) or estevez", "MASKING"},
    {"size", 0, POPT_ARG_STRING, NULL, TABLES_SIZE,
     "texels, N, WxH or WxHxD to 4096 each (128; with a third axis 32, e-walk 40x32x20)", "SIZE"},
    {"axis", 0, POPT_ARG_STRING, NULL, TABLES_AXIS,
     "of n.v: linear (the default), sqrt, cbrt, or grazing, best for e and all that e-walk has",
     "AXIS"},
    {"corners", 0, POPT_ARG_NONE, NULL, TABLES_CORNERS,
     "the outermost texels stand on the edges, not half a texel inside", NULL},
    {"complement", 0, POPT_ARG_NONE, NULL, TABLES_COMPLEMENT, "1 - value", NULL},
    {"flip", 0, POPT_ARG_NONE, NULL, TABLES_FLIP, "the first row is roughness 1", NULL},
    {"format", 0, POPT_ARG_STRING, NULL, TABLES_FORMAT,
     "of the numbers: f32, f16, u16, u8 or, three in a PNG, rgbd", "FORMAT"},
    {"zstd", 0, POPT_ARG_STRING, NULL, TABLES_ZSTD, "compress KTX2 (3)", "[LEVEL]"},
    {"average", 0, POPT_ARG_STRING, NULL, TABLES_AVERAGE,
     "with --table e: E_avg of what looking it up shows, into a file of its own", "FILE"},
    {"lookup", 0, POPT_ARG_NONE, NULL, TABLES_LOOKUP,
     "write the code that reads the table beside it: NAME_lookup.h and .glsl", NULL},
    {"name", 0, POPT_ARG_STRING, NULL, TABLES_NAME,
     "what names in code begin with (the file's own)", "NAME"},
    {"paths", 0, POPT_ARG_STRING, NULL, TABLES_PATHS, "random walks a texel of e-walk (8192)", "N"},
    {"assignment", 0, POPT_ARG_NONE, NULL, TABLES_ASSIGNMENT,
     "all of GAMES202's assignment 4, part 1, into the folder -o DIR, with errors", NULL},
    {"method", 0, POPT_ARG_STRING, NULL, TABLES_METHOD, "textbook: the split sum by sampling",
     "METHOD"},
    {"samples", 0, POPT_ARG_STRING, NULL, TABLES_SAMPLES,
     "a texel, of --assignment and --method textbook (1024)", "N"},
    {"threads", 0, POPT_ARG_STRING, NULL, TABLES_THREADS, "1 to 256 (one a core)", "N"},
    {"json", 0, POPT_ARG_NONE, NULL, TABLES_JSON, "report as JSON", NULL},
    {"quiet", 'q', POPT_ARG_NONE, NULL, TABLES_QUIET, "print nothing but errors", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

// Everything that is given must be in `allowed`, which ends in 0.
static int check_options(const cli_arguments *a, const char *mode, const int *allowed)
{
    for (int option = 1; option <= TABLES_QUIET; option++) {
        const int *at = allowed;
        while (*at && *at != option)
            at++;
        if (a->value[option] && !*at)
            return cli_wrong(&cli_tables, "--%s is not for %s",
                             cli_option_name(&cli_tables, option), mode);
    }
    return CLI_GO;
}

// ---------------------------------------------------------------------------------------- textbook

static int read_arguments(const cli_arguments *a, int *size, int *samples)
{
    static const int allowed[] = {TABLES_OUTPUT,  TABLES_METHOD, TABLES_SIZE,
                                  TABLES_SAMPLES, TABLES_QUIET,  0};
    int code = check_options(a, "--method textbook", allowed);
    if (code != CLI_GO)
        return code;
    if (a->rest_count)
        return cli_wrong(&cli_tables, "%s: tables takes no input; name the output by -o FILE",
                         a->rest[0]);
    if (strcmp(a->value[TABLES_METHOD], "textbook") != 0)
        return cli_wrong(&cli_tables, "--method is '%s', only textbook is there",
                         a->value[TABLES_METHOD]);
    if (!a->value[TABLES_OUTPUT])
        return cli_wrong(&cli_tables, "no output: name it by -o FILE");
    const char *ending = cli_ending(a->value[TABLES_OUTPUT]);
    if (strcmp(ending, "exr") != 0 && strcmp(ending, "hdr") != 0 && strcmp(ending, "png") != 0)
        return cli_wrong(&cli_tables, "--output %s: must end in .exr, .hdr or .png",
                         a->value[TABLES_OUTPUT]);
    if ((code = cli_integer(a, TABLES_SIZE, "--size", 2, 4096, size)) != CLI_GO ||
        (code = cli_integer(a, TABLES_SAMPLES, "--samples", 1, 1 << 20, samples)) != CLI_GO)
        return code;
    return cli_check_folder(a->value[TABLES_OUTPUT]);
}

// Two channels (A, B) as red and green with a blue of 0, which every format can hold.
static kiln_result widen(cli_job *job, const kiln_image *table, kiln_image *rgb)
{
    kiln_result result =
        kiln_image_create(job->context, table->width, table->height, 3, rgb, &job->error);
    size_t count = result ? 0 : (size_t)table->width * (size_t)table->height;
    for (size_t i = 0; i < count; i++) {
        rgb->pixels[3 * i] = table->pixels[2 * i];
        rgb->pixels[3 * i + 1] = table->pixels[2 * i + 1];
    }
    return result;
}

static int run_textbook(const cli_arguments *a)
{
    cli_job job;
    int size = 512, samples = 1024, code = read_arguments(a, &size, &samples);
    if (code != CLI_GO)
        return code;
    const char *path = a->value[TABLES_OUTPUT];
    kiln_image table = {0}, rgb = {0};
    code = cli_job_begin(&job, 0, a->value[TABLES_QUIET]);
    if (code == CLI_GO)
        code = kiln_textbook_brdf(job.context, size, samples, &table, &job.error) ||
                       widen(&job, &table, &rgb) ||
                       kiln_image_save(job.context, &rgb, path, &job.error)
                   ? CLI_FAILED
                   : CLI_DONE;
    cli_clear_progress(&job);
    if (code == CLI_DONE && !a->value[TABLES_QUIET])
        printf("%s: split-sum table of %d x %d, %d samples, %.2f s\n", path, size, size, samples,
               cli_seconds() - job.began);
    kiln_image_free(&rgb);
    kiln_image_free(&table);
    return cli_job_end(&job, code);
}

// -------------------------------------------------------------------------------------- assignment

static int run_assignment(const cli_arguments *a)
{
    static const char *const g_names[] = {"schlick-k2", "schlick-text", NULL};
    assignment_def def = {.folder = a->value[TABLES_OUTPUT],
                          .size = 128,
                          .samples = 1024,
                          .json = a->value[TABLES_JSON],
                          .quiet = a->value[TABLES_QUIET]};
    static const int allowed[] = {TABLES_OUTPUT, TABLES_ASSIGNMENT, TABLES_G,
                                  TABLES_SIZE,   TABLES_SAMPLES,    TABLES_JSON,
                                  TABLES_QUIET,  TABLES_METHOD,     0};
    int g = 0, code = check_options(a, "--assignment", allowed);
    if (code != CLI_GO)
        return code;
    if (a->rest_count)
        return cli_wrong(&cli_tables, "%s: tables takes no input; name the output by -o DIR",
                         a->rest[0]);
    if (a->value[TABLES_METHOD])
        return cli_wrong(&cli_tables, "--assignment has its own methods: leave --method out");
    if (!def.folder)
        return cli_wrong(&cli_tables, "no output: name a folder by -o DIR");
    if ((code = cli_integer(a, TABLES_SIZE, "--size", 2, 1024, &def.size)) != CLI_GO ||
        (code = cli_integer(a, TABLES_SAMPLES, "--samples", 1, 1 << 20, &def.samples)) != CLI_GO ||
        (code = cli_choice(a, TABLES_G, "--g", g_names, &g)) != CLI_GO ||
        (code = assignment_check_folder(def.folder)) != CLI_GO)
        return code;
    def.g = g ? KILN_G_SCHLICK_TEXT : KILN_G_SCHLICK_K2;
    cli_job job;
    code = cli_job_begin(&job, 0, def.quiet);
    if (code == CLI_GO)
        code = assignment_write(&job, &def);
    return cli_job_end(&job, code);
}

static int run(int argc, const char **argv)
{
    cli_arguments a;
    int code = cli_arguments_read(&a, &cli_tables, argc, argv);
    if (code == CLI_GO)
        code = a.value[TABLES_ASSIGNMENT] ? run_assignment(&a)
               : a.value[TABLES_METHOD]   ? run_textbook(&a)
                                          : tables_exact(&a);
    cli_arguments_free(&a);
    return code;
}

const cli_command cli_tables = {
    .name = "tables",
    .arguments =
        "[--table KIND] -o FILE | --assignment -o DIR | --method textbook -o FILE [OPTION...]",
    .summary = "Makes tables of a BRDF's integrals.",
    .details =
        "u is n.v, v is roughness, 0 in the first row; a third axis goes along F0 (e-walk) or the\n"
        "index of refraction from 1 to 3. What each kind holds: docs/tables.md.\n"
        "\n"
        "--assignment writes E(mu) by Monte Carlo, importance sampling and split sum, E_avg, the\n"
        "exact ones, maps of the errors, and report.md; --method textbook A and B as courses "
        "sample\n"
        "them. There roughness is 1 at the top.\n"
        "\n"
        "Examples:\n"
        "  kiln tables -o e.ktx2 --axis grazing --corners --average eavg.ktx2 --lookup\n"
        "      E and E_avg for Kulla and Conty's lobe, and the code that reads them\n"
        "  kiln tables -o dfg.ktx2 --table dfg\n"
        "      the split sum, as three.js, glTF viewers and most engines look it up\n"
        "  kiln tables --for babylon -o brdf.png\n"
        "      PBRMaterial.environmentBRDFTexture\n"
        "  kiln tables -o walk.ktx2 --table e-walk --lookup\n"
        "      what later bounces add to A and B, grazing axis and corners; 2 s\n"
        "  kiln tables -o e.h --table e --size 32 --axis grazing --corners\n"
        "      an array for those who want no texture\n"
        "  kiln tables --assignment -o images\n"
        "      what GAMES202's assignment 4 asks for, 128 x 128, beside what is exact\n"
        "  kiln tables --assignment -o text --g schlick-text\n"
        "      the same with the k of its text, with which a mirror glows\n"
        "  kiln tables --method textbook -o brdf.exr\n"
        "      the split sum as courses compute it, 512 x 512, 1024 samples a texel\n",
    .options = options,
    .run = run,
};
