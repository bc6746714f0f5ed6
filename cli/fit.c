// kiln fit. In: an integral of the reflection model, and a wanted error or numbers of coefficients.
// Out: a closed form fitted to the integral, as a function in C or GLSL.
#include "json.h"
#include "work.h"

#include <stdio.h>

enum { OUTPUT, ERROR, D, G, FORM, ROUGHNESS_MIN, MAX_COEFFICIENTS, NAME, JSON, QUIET, OPTIONS };

typedef struct fit {
    cli_arguments arguments;
    const char *output, *name;
    kiln_fit_def def;
    bool json, quiet;
} fit;

static const char *const kinds[] = {"e", "eavg", "dfg", "sheen", NULL};
static const char *const forms[] = {"auto", "polynomial", "rational", NULL};

#define AT(field) offsetof(fit, field)

static const cli_option options[OPTIONS + 1] = {
    [OUTPUT] = {"output", CLI_FILE, AT(output), .value = "FILE", .letter = 'o',
                .help = "the file of source code, as C (.h) or GLSL ES 3.00 (.glsl)",
                .more = "A comment in the file states the measured error."},
    [ERROR] = {"error", CLI_NUMBER, AT(def.error), 1e-6, 0.5, 1e-3, "E",
               .help = "largest error that the function may have"},
    [D] = CLI_D_ROW(fit, def.model.d),
    [G] = CLI_G_ROW(fit, def.model.g),
    [FORM] = {"form", CLI_CHOICE, AT(def.form), .value = "FORM", .words = forms,
              .help = "kind of function; auto takes the kind that needs fewer coefficients"},
    [ROUGHNESS_MIN] = {"roughness-min", CLI_NUMBER, AT(def.roughness_min), 0, 0.9, 0, "R",
                       .help = "smallest roughness for which the error holds; the function takes "
                               "smaller roughnesses as R",
                       .unset = "0, and 0.1 for sheen, whose albedo rises steeply below 0.1"},
    [MAX_COEFFICIENTS] =
        {"max-coefficients", CLI_INTEGER, AT(def.max_coefficients), 1, KILN_MAX_FIT, KILN_MAX_FIT,
         "N", .help = "largest number of coefficients of each part; dfg has two parts",
         .more = "If no function with so few coefficients is good enough, the exit code is 1."},
    [NAME] = {"name", CLI_TEXT, AT(name), .value = "NAME", .help = "name of the function",
              .unset = "kiln_e, kiln_e_average, kiln_dfg or kiln_sheen"},
    [JSON] = {"json", CLI_FLAG, AT(json), .help = "report as JSON on standard output"},
    [QUIET] = CLI_QUIET_ROW(fit),
};

static const char *kind_word(int index)
{
    return kinds[index];
}

static int read_kind(const cli_arguments *a, kiln_fit_kind *kind)
{
    char list[CLI_RANGE_TEXT];
    const cli_option words = {.words = kinds};
    if (!a->rest_count)
        return cli_wrong(&cli_fit, "no quantity is named, name %s", cli_list(&words, list));
    if (a->rest_count > 1)
        return cli_wrong(&cli_fit,
                         "%s: kiln fit takes one quantity at a time, and %s is named already",
                         a->rest[1], a->rest[0]);
    int index = 0, code = cli_find_word(&cli_fit, "quantity", a->rest[0], &words, &index);
    *kind = (kiln_fit_kind)index;
    return code;
}

static int read_options(fit *f, const cli_call *call)
{
    const cli_arguments *a = &f->arguments;
    int code = cli_read_arguments(&f->arguments, &cli_fit, call, f);
    if (code == CLI_GO)
        code = read_kind(a, &f->def.kind);
    if (code != CLI_GO)
        return code;
    if (!f->output)
        return cli_wrong(&cli_fit, "no output: name it by -o FILE");
    if (!cli_ends_in(f->output, "h") && !cli_ends_in(f->output, "glsl"))
        return cli_wrong(&cli_fit, "--output %s: must end in .h or .glsl", f->output);
    if ((a->text[D] || a->text[G]) && f->def.kind == KILN_FIT_SHEEN)
        return cli_wrong(&cli_fit,
                         "the quantity sheen has a model of its own, leave --d and --g out");
    code = cli_check_source_name(a, NAME);
    return code == CLI_GO ? cli_check_folder(f->output) : code;
}

static void report_json(const fit *f, const kiln_fit *form, double seconds)
{
    json j = {0};
    json_object(&j, NULL);
    json_text(&j, "output", f->output);
    json_text(&j, "quantity", kinds[form->def.kind]);
    json_text(&j, "d", kiln_d_names()[form->def.model.d]);
    json_text(&j, "g", kiln_g_names()[form->def.model.g]);
    json_number(&j, "coefficients", form->coefficient_count);
    json_number(&j, "max_error", form->max_error);
    json_number(&j, "rms_error", form->rms_error);
    json_number(&j, "seconds", seconds);
    json_array(&j, "parts");
    for (int k = 0; k < form->part_count; k++) {
        json_object(&j, NULL);
        json_bool(&j, "rational", form->part[k].rational);
        json_number(&j, "x_count", form->part[k].x_count);
        json_number(&j, "y_count", form->part[k].y_count);
        json_end(&j);
    }
    json_end(&j);
    json_end(&j);
}

static int make(cli_work *work, const fit *f, kiln_fit *form)
{
    if (kiln_fit_create(work->context, &f->def, form, &work->error) ||
        kiln_fit_save(work->context, form, f->name, f->output, &work->error))
        return CLI_FAILED;
    return CLI_DONE;
}

static int run(const cli_call *call)
{
    cli_work work;
    fit f = {0};
    kiln_fit form = {0};
    int code = read_options(&f, call);
    if (code != CLI_GO)
        return code;
    code = cli_begin_work(&work, 0, f.quiet);
    if (code == CLI_GO)
        code = make(&work, &f, &form);
    cli_clear_progress(&work);
    if (code == CLI_DONE && f.json)
        report_json(&f, &form, cli_elapsed(&work));
    else if (code == CLI_DONE && !f.quiet)
        printf("%s: %d coefficients, max error %.3g, RMS %.3g, %.2f s\n", cli_show(f.output).text,
               form.coefficient_count, form.max_error, form.rms_error, cli_elapsed(&work));
    return cli_end_work(&work, code);
}

static const char *list(int index, char left[64])
{
    static const char *const meanings[] = {
        "E(mu), the directional albedo for a Fresnel term of 1",
        "E_avg, its average over the cosine", "the split sum's A and B together",
        "the albedo of Charlie sheen, masked as by ashikhmin", NULL};
    if (meanings[index])
        snprintf(left, 64, "%s", kinds[index]);
    return meanings[index];
}

static const cli_example examples[] = {
    {"kiln fit e -o e.glsl", "E of GGX with height-correlated Smith masking to 1e-3"},
    {"kiln fit eavg --error 1e-5 -o eavg.h", "E_avg, a function of roughness alone"},
    {"kiln fit dfg --g schlick-k2 --error 0.01 --name env_brdf -o env_brdf.glsl",
     "A and B without a texture"},
    {NULL, NULL}};

const cli_command cli_fit = {
    .name = "fit",
    .arguments = "QUANTITY -o FILE [OPTION...]",
    .summary = "Fits polynomials or rational functions to albedo tables, as C or GLSL.",
    .about = "kiln searches for the function with the fewest coefficients whose error is at most "
             "--error for every cosine n.v (mu) and every roughness. A comment in the written code "
             "states the measured error.",
    .more = "kiln tries polynomials and rational functions, those with few coefficients first, "
            "until the error in 32-bit floats at some 40000 points is at most --error. "
            "Denominators are proven to have no zero.",
    .word = kind_word,
    .list_title = "Quantities",
    .list = list,
    .examples = examples,
    .options = options,
    .run = run,
};
