// kiln tables: integrals of the BRDF that need no panorama.
#include "assignment.h"

#include <stdio.h>
#include <string.h>

enum { OUTPUT = 1, METHOD, SIZE, SAMPLES, QUIET, ASSIGNMENT, G, JSON };

static const struct poptOption options[] = {
    {"output", 'o', POPT_ARG_STRING, NULL, OUTPUT, "the table, .exr, .hdr or .png", "FILE"},
    {"assignment", 0, POPT_ARG_NONE, NULL, ASSIGNMENT,
     "all of GAMES202's assignment 4, part 1, into the folder -o DIR, with errors", NULL},
    {"g", 0, POPT_ARG_STRING, NULL, G,
     "of the assignment: schlick-k2, as in its figures (the default), or schlick-text", "G"},
    {"method", 0, POPT_ARG_STRING, NULL, METHOD, "textbook: the split sum by sampling", "METHOD"},
    {"size", 0, POPT_ARG_STRING, NULL, SIZE,
     "texels along each side, 2 to 4096 (512); of the assignment to 1024 (128)", "N"},
    {"samples", 0, POPT_ARG_STRING, NULL, SAMPLES, "samples a texel (1024)", "N"},
    {"json", 0, POPT_ARG_NONE, NULL, JSON, "report the assignment's errors as JSON", NULL},
    {"quiet", 'q', POPT_ARG_NONE, NULL, QUIET, "print nothing but errors", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

static int read_arguments(const cli_arguments *a, int *size, int *samples)
{
    int code;
    if (a->rest_count)
        return cli_wrong(&cli_tables, "%s: tables takes no input; name the output by -o FILE",
                         a->rest[0]);
    if (a->value[G] || a->value[JSON])
        return cli_wrong(&cli_tables, "--g and --json are for --assignment");
    if (!a->value[METHOD])
        return cli_wrong(&cli_tables,
                         "no method: --assignment or --method textbook is there so far");
    if (strcmp(a->value[METHOD], "textbook") != 0)
        return cli_wrong(&cli_tables, "--method is '%s', only textbook is there so far",
                         a->value[METHOD]);
    if (!a->value[OUTPUT])
        return cli_wrong(&cli_tables, "no output: name it by -o FILE");
    const char *ending = cli_ending(a->value[OUTPUT]);
    if (strcmp(ending, "exr") != 0 && strcmp(ending, "hdr") != 0 && strcmp(ending, "png") != 0)
        return cli_wrong(&cli_tables, "--output %s: must end in .exr, .hdr or .png",
                         a->value[OUTPUT]);
    if ((code = cli_integer(a, SIZE, "--size", 2, 4096, size)) != CLI_GO ||
        (code = cli_integer(a, SAMPLES, "--samples", 1, 1 << 20, samples)) != CLI_GO)
        return code;
    return cli_check_folder(a->value[OUTPUT]);
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

static int run_assignment(const cli_arguments *a)
{
    static const char *const g_names[] = {"schlick-k2", "schlick-text", NULL};
    assignment_def def = {.folder = a->value[OUTPUT],
                          .size = 128,
                          .samples = 1024,
                          .json = a->value[JSON],
                          .quiet = a->value[QUIET]};
    int g = 0, code;
    if (a->rest_count)
        return cli_wrong(&cli_tables, "%s: tables takes no input; name the output by -o DIR",
                         a->rest[0]);
    if (a->value[METHOD])
        return cli_wrong(&cli_tables, "--assignment has its own methods: leave --method out");
    if (!def.folder)
        return cli_wrong(&cli_tables, "no output: name a folder by -o DIR");
    if ((code = cli_integer(a, SIZE, "--size", 2, 1024, &def.size)) != CLI_GO ||
        (code = cli_integer(a, SAMPLES, "--samples", 1, 1 << 20, &def.samples)) != CLI_GO ||
        (code = cli_choice(a, G, "--g", g_names, &g)) != CLI_GO ||
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
    cli_job job;
    int size = 512, samples = 1024;
    int code = cli_arguments_read(&a, &cli_tables, argc, argv);
    if (code == CLI_GO && a.value[ASSIGNMENT])
        code = run_assignment(&a);
    if (code == CLI_GO)
        code = read_arguments(&a, &size, &samples);
    if (code == CLI_GO) {
        const char *path = a.value[OUTPUT];
        kiln_image table = {0}, rgb = {0};
        code = cli_job_begin(&job, 0, a.value[QUIET]);
        if (code == CLI_GO)
            code = kiln_textbook_brdf(job.context, size, samples, &table, &job.error) ||
                           widen(&job, &table, &rgb) ||
                           kiln_image_save(job.context, &rgb, path, &job.error)
                       ? CLI_FAILED
                       : CLI_DONE;
        cli_clear_progress(&job);
        if (code == CLI_DONE && !a.value[QUIET])
            printf("%s: split-sum table of %d x %d, %d samples, %.2f s\n", path, size, size,
                   samples, cli_seconds() - job.began);
        kiln_image_free(&rgb);
        kiln_image_free(&table);
        code = cli_job_end(&job, code);
    }
    cli_arguments_free(&a);
    return code;
}

const cli_command cli_tables = {
    .name = "tables",
    .arguments = "--assignment -o DIR | --method textbook -o FILE [OPTION...]",
    .summary = "Makes tables of a BRDF's integrals.",
    .details =
        "The table's red is A and its green is B: specular albedo = F0 * A + B. Its x is n.v\n"
        "from 0 to 1, its y is roughness from 0 at the bottom to 1 at the top.\n"
        "\n"
        "--assignment writes E(mu) by Monte Carlo, importance sampling and split sum, E_avg, the\n"
        "exact ones, maps of the errors, and report.md. mu is n.v, roughness is 1 at the top.\n"
        "\n"
        "Examples:\n"
        "  kiln tables --assignment -o images\n"
        "      what GAMES202's assignment 4 asks for, 128 x 128, beside what is exact\n"
        "  kiln tables --assignment -o text --g schlick-text\n"
        "      the same with the k of its text, with which a mirror glows\n"
        "  kiln tables --method textbook -o brdf.exr\n"
        "      the split sum as courses compute it, 512 x 512, 1024 samples a texel\n"
        "  kiln tables --method textbook -o brdf.png --size 128 --samples 4096\n"
        "      smaller and smoother\n",
    .options = options,
    .run = run,
};
