// kiln fit: closed forms of the integrals, as functions in C and GLSL.
#include "cli.h"

#include <stdio.h>
#include <string.h>

enum { OUTPUT = 1, ERROR, D, G, FORM, ROUGHNESS_MIN, MAX_COEFFICIENTS, NAME, JSON, QUIET };

#define VALUE(name, option, help, word)                                                            \
    {                                                                                              \
        name, 0, POPT_ARG_STRING, NULL, option, help, word                                         \
    }

static const struct poptOption options[] = {
    {"output", 'o', POPT_ARG_STRING, NULL, OUTPUT, "C (.h) or GLSL ES 3.00 (.glsl)", "FILE"},
    VALUE("error", ERROR, "largest error wanted, 1e-6 to 0.5 (0.001)", "E"),
    VALUE("d", D, "ggx or beckmann (ggx)", "D"),
    VALUE("g", G, "smith, smith-uncorrelated, schlick-k2 or schlick-text (smith)", "G"),
    VALUE("form", FORM, "polynomial, rational, or auto: the shorter (auto)", "FORM"),
    VALUE("roughness-min", ROUGHNESS_MIN, "smallest roughness asked for, 0 to 0.9 (0; sheen 0.1)",
          "R"),
    VALUE("max-coefficients", MAX_COEFFICIENTS, "of each part, 1 to 160 (160)", "N"),
    VALUE("name", NAME, "of the function (kiln_e, kiln_e_average, kiln_dfg or kiln_sheen)", "NAME"),
    {"json", 0, POPT_ARG_NONE, NULL, JSON, "report on standard output as JSON", NULL},
    {"quiet", 'q', POPT_ARG_NONE, NULL, QUIET, "print nothing but errors", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

static const char *const kinds[] = {"e", "eavg", "dfg", "sheen", NULL};

static int read_kind(const cli_arguments *a, kiln_fit_kind *kind)
{
    if (!a->rest_count)
        return cli_wrong(&cli_fit, "no quantity: name e, eavg, dfg or sheen");
    if (a->rest_count > 1)
        return cli_wrong(&cli_fit, "%s: one quantity at a time, after %s", a->rest[1], a->rest[0]);
    for (int i = 0; kinds[i]; i++)
        if (!strcmp(a->rest[0], kinds[i])) {
            *kind = (kiln_fit_kind)i;
            return CLI_GO;
        }
    return cli_wrong(&cli_fit, "%s: no such quantity, it must be e, eavg, dfg or sheen",
                     a->rest[0]);
}

static int read_arguments(const cli_arguments *a, kiln_fit_def *def)
{
    static const char *const forms[] = {"auto", "polynomial", "rational", NULL};
    int code = read_kind(a, &def->kind), form = 0;
    if (code != CLI_GO)
        return code;
    if (!a->value[OUTPUT])
        return cli_wrong(&cli_fit, "no output: name it by -o FILE");
    const char *path = a->value[OUTPUT], *ending = cli_ending(path);
    if (strcmp(ending, "h") != 0 && strcmp(ending, "glsl") != 0)
        return cli_wrong(&cli_fit, "--output %s: must end in .h or .glsl", path);
    if ((code = cli_number(a, ERROR, "--error", 1e-6, 0.5, &def->error)) != CLI_GO ||
        (code = cli_model(a, D, G, &def->model)) != CLI_GO ||
        (code = cli_choice(a, FORM, "--form", forms, &form)) != CLI_GO ||
        (code = cli_number(a, ROUGHNESS_MIN, "--roughness-min", 0, 0.9, &def->roughness_min)) !=
            CLI_GO ||
        (code = cli_integer(a, MAX_COEFFICIENTS, "--max-coefficients", 1, KILN_MAX_FIT,
                            &def->max_coefficients)) != CLI_GO ||
        (code = cli_source_name(a, NAME)) != CLI_GO)
        return code;
    def->form = (kiln_fit_form)form;
    if ((a->value[D] || a->value[G]) && def->kind == KILN_FIT_SHEEN)
        return cli_wrong(&cli_fit, "sheen has a model of its own, leave --d and --g out");
    return cli_check_folder(path);
}

static int report(const cli_arguments *a, const kiln_fit *fit, double seconds)
{
    const char *path = a->value[OUTPUT];
    if (!a->value[JSON]) {
        if (!a->value[QUIET])
            printf("%s: %d coefficients, max error %.3g, RMS %.3g, %.2f s\n", path,
                   fit->coefficient_count, fit->max_error, fit->rms_error, seconds);
        return CLI_DONE;
    }
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "output", path);
    cJSON_AddStringToObject(json, "quantity", kinds[fit->def.kind]);
    cJSON_AddStringToObject(json, "d", kiln_d_names()[fit->def.model.d]);
    cJSON_AddStringToObject(json, "g", kiln_g_names()[fit->def.model.g]);
    cJSON_AddNumberToObject(json, "coefficients", fit->coefficient_count);
    cJSON_AddNumberToObject(json, "max_error", fit->max_error);
    cJSON_AddNumberToObject(json, "rms_error", fit->rms_error);
    cJSON_AddNumberToObject(json, "seconds", seconds);
    cJSON *parts = cJSON_AddArrayToObject(json, "parts");
    for (int k = 0; k < fit->part_count; k++) {
        const kiln_fit_part *part = &fit->part[k];
        cJSON *one = cJSON_CreateObject();
        cJSON_AddBoolToObject(one, "rational", part->rational);
        cJSON_AddNumberToObject(one, "x_count", part->x_count);
        cJSON_AddNumberToObject(one, "y_count", part->y_count);
        cJSON_AddItemToArray(parts, one);
    }
    return cli_print_json(json);
}

static int run(int argc, const char **argv)
{
    cli_arguments a;
    cli_job job;
    kiln_fit_def def = {0};
    int code = cli_arguments_read(&a, &cli_fit, argc, argv);
    if (code == CLI_GO)
        code = read_arguments(&a, &def);
    if (code == CLI_GO) {
        kiln_fit fit = {0};
        code = cli_job_begin(&job, 0, a.value[QUIET]);
        if (code == CLI_GO)
            code =
                kiln_fit_create(job.context, &def, &fit, &job.error) ||
                        kiln_fit_save(job.context, &fit, a.value[NAME], a.value[OUTPUT], &job.error)
                    ? CLI_FAILED
                    : CLI_DONE;
        cli_clear_progress(&job);
        if (code == CLI_DONE)
            code = report(&a, &fit, cli_seconds() - job.began);
        code = cli_job_end(&job, code);
    }
    cli_arguments_free(&a);
    return code;
}

const cli_command cli_fit = {
    .name = "fit",
    .arguments = "QUANTITY -o FILE [OPTION...]",
    .summary = "Finds closed forms of the integrals, as C or GLSL.",
    .details =
        "Quantities: e is E(mu), eavg E_avg, dfg the split sum's A and B, sheen Charlie's albedo.\n"
        "The form with the fewest coefficients that errs by --error at most, for every mu and\n"
        "roughness, is written as a function; its measured error stands in the comment.\n"
        "\n"
        "Examples:\n"
        "  kiln fit e -o e.glsl\n"
        "      E of GGX with height-correlated Smith masking to 1e-3\n"
        "  kiln fit eavg --error 1e-5 -o eavg.h\n"
        "      E_avg, a function of roughness alone\n"
        "  kiln fit dfg --g schlick-k2 --error 0.01 --name env_brdf -o env_brdf.glsl\n"
        "      A and B without a texture\n",
    .options = options,
    .run = run,
};
