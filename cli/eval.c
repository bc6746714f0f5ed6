// kiln eval. In: a quantity of the reflection model (a function or an integral), its arguments as
// options or as lines of standard input. Out: the values with twelve digits, as lines or JSON.
// kiln/brdf.h computes them.
#include "cli.h"
#include "os.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ----------------------------------------------------------------------------------- what there is

typedef enum argument {
    ROUGHNESS,
    MU,
    NOL,
    NOH,
    VOH,
    F0,
    F,
    IOR,
    N,
    K,
    REFLECTIVITY,
    EDGE_TINT,
    // number of options that are arguments of quantities; the options from here on are none
    ARGUMENTS,
    D = ARGUMENTS,
    G,
    SHEEN,
    F_ADD,
    JSON,
    OPTIONS
} argument;

typedef struct choices {
    kiln_model model;
    int sheen, f_add;
} choices;

enum { MAX_ARGUMENTS = 4 };

typedef struct quantity {
    const char *name;
    int count;
    // the arguments of the quantity, in the order of a line of standard input
    argument takes[MAX_ARGUMENTS];
    double (*value)(const choices *c, const double x[MAX_ARGUMENTS]);
    const char *meaning;
} quantity;

static double e(const choices *c, const double *x)
{
    return kiln_energy(&c->model, x[0], x[1]);
}

static double e_average(const choices *c, const double *x)
{
    return kiln_energy_average(&c->model, x[0]);
}

static double a(const choices *c, const double *x)
{
    double ab[2];
    kiln_energy_split(&c->model, x[0], x[1], ab);
    return ab[0];
}

static double b(const choices *c, const double *x)
{
    double ab[2];
    kiln_energy_split(&c->model, x[0], x[1], ab);
    return ab[1];
}

static double sheen(const choices *c, const double *x)
{
    return kiln_sheen_albedo((kiln_sheen)c->sheen, x[0], x[1]);
}

static double d(const choices *c, const double *x)
{
    return kiln_brdf_d(c->model.d, x[0], x[1]);
}

static double g(const choices *c, const double *x)
{
    return kiln_brdf_g(&c->model, x[0], x[1], x[2]);
}

static double specular(const choices *c, const double *x)
{
    return kiln_brdf_specular(&c->model, x[0], x[1], x[2], x[3]);
}

static double schlick(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_schlick(x[0], x[1]);
}

static double dielectric(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_dielectric(x[0], x[1]);
}

static double conductor(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_conductor(x[0], x[1], x[2]);
}

static double schlick_average(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_schlick_average(x[0]);
}

static double dielectric_average(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_dielectric_average(x[0]);
}

static double conductor_average(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_conductor_average(x[0], x[1]);
}

static double dielectric_average_fit(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_dielectric_average_fit(x[0]);
}

static double conductor_average_fit(const choices *c, const double *x)
{
    (void)c;
    return kiln_fresnel_conductor_average_fit(x[0], x[1]);
}

static double kulla_conty(const choices *c, const double *x)
{
    return kiln_kulla_conty(kiln_energy(&c->model, x[0], x[1]), kiln_energy(&c->model, x[0], x[2]),
                            kiln_energy_average(&c->model, x[0]));
}

static double f_add(const choices *c, const double *x)
{
    return kiln_kulla_conty_fresnel((kiln_f_add)c->f_add, x[1],
                                    kiln_energy_average(&c->model, x[0]));
}

static double turquin(const choices *c, const double *x)
{
    return kiln_turquin(x[2], kiln_energy(&c->model, x[0], x[1]));
}

static const quantity quantities[] = {
    {"e",
     2,
     {ROUGHNESS, MU},
     e,
     "directional albedo of the specular lobe with Fresnel term 1, E(mu) = A + B"},
    {"eavg", 1, {ROUGHNESS}, e_average, "cosine-weighted average of E, 2 int E(mu) mu dmu"},
    {"a",
     2,
     {ROUGHNESS, MU},
     a,
     "scale A of the split sum, in which the specular albedo is F0 A + B"},
    {"b", 2, {ROUGHNESS, MU}, b, "bias B of the split sum"},
    {"sheen", 2, {ROUGHNESS, MU}, sheen, "directional albedo of Charlie sheen"},
    {"d", 2, {ROUGHNESS, NOH}, d, "value D of the distribution of microfacet normals"},
    {"g", 3, {ROUGHNESS, MU, NOL}, g, "value G of masking and shadowing"},
    {"specular",
     4,
     {ROUGHNESS, MU, NOL, NOH},
     specular,
     "specular lobe with Fresnel term 1, D G / (4 mu n.l)"},
    {"schlick", 2, {F0, VOH}, schlick, "Schlick's approximation of Fresnel reflectance"},
    {"dielectric", 2, {IOR, VOH}, dielectric, "exact Fresnel reflectance of a dielectric"},
    {"conductor", 3, {N, K, VOH}, conductor, "exact Fresnel reflectance of a metal"},
    {"schlick-avg",
     1,
     {F0},
     schlick_average,
     "cosine-weighted average of Schlick's approximation, 2 int F(mu) mu dmu"},
    {"dielectric-avg",
     1,
     {IOR},
     dielectric_average,
     "cosine-weighted average of the exact reflectance of a dielectric"},
    {"conductor-avg",
     2,
     {N, K},
     conductor_average,
     "cosine-weighted average of the exact reflectance of a metal"},
    {"dielectric-avg-fit",
     1,
     {IOR},
     dielectric_average_fit,
     "Kulla and Conty's approximation of dielectric-avg"},
    {"conductor-avg-fit",
     2,
     {REFLECTIVITY, EDGE_TINT},
     conductor_average_fit,
     "Kulla and Conty's approximation of the average reflectance of a metal"},
    {"kulla-conty",
     3,
     {ROUGHNESS, MU, NOL},
     kulla_conty,
     "Kulla and Conty's lobe, which returns the light that a single bounce loses"},
    {"f-add",
     2,
     {ROUGHNESS, F},
     f_add,
     "factor of Kulla and Conty's lobe for an average Fresnel reflectance F"},
    {"turquin",
     3,
     {ROUGHNESS, MU, F0},
     turquin,
     "Turquin's factor by which the specular lobe is multiplied"},
};
enum { QUANTITIES = sizeof quantities / sizeof *quantities };

static const char *quantity_word(int index)
{
    return index < QUANTITIES ? quantities[index].name : NULL;
}

// --------------------------------------------------------------------------------------- arguments

typedef struct eval {
    cli_arguments arguments;
    const quantity *quantity;
    choices choices;
    bool json;
    double given[ARGUMENTS]; // values of the arguments, indexed by option
    // values of those arguments of the quantity that are given as options, in the quantity's order
    double fixed[MAX_ARGUMENTS];
    int column_count; // number of arguments that each line of standard input holds
    int column[MAX_ARGUMENTS];
    double *lines; // arguments of all lines of standard input, column_count for each line
    size_t line_count;
} eval;

static const char *const f_adds[] = {"second", "assignment", NULL};

#define AT(field) offsetof(eval, field)
// An option of an argument. If it is absent, the argument is read from standard input.
#define ARGUMENT(index, name, high, value, help)                                                   \
    [index] = {name, CLI_NUMBER,  AT(given) + (index) * sizeof(double), 0, high, 0, value,         \
               help, .keep = true}

static const cli_option options[OPTIONS + 1] = {
    ARGUMENT(ROUGHNESS, "roughness", 1, "R", "perceptual roughness; alpha is its square"),
    ARGUMENT(MU, "mu", 1, "MU", "cosine n.v of the angle between normal and view"),
    ARGUMENT(NOL, "nol", 1, "C", "cosine n.l of the angle between normal and light"),
    ARGUMENT(NOH, "noh", 1, "C", "cosine n.h of the angle between normal and half vector"),
    ARGUMENT(VOH, "voh", 1, "C", "cosine v.h of the angle between view and half vector"),
    ARGUMENT(F0, "f0", 1, "F0", "reflectance at normal incidence"),
    ARGUMENT(F, "f", 1, "F", "average Fresnel reflectance"),
    ARGUMENT(IOR, "ior", 1e8, "IOR",
             "index of refraction of a dielectric, relative to the medium outside"),
    ARGUMENT(N, "n", 1e8, "N", "real part n of the index of refraction n + i k of a metal"),
    ARGUMENT(K, "k", 1e8, "K", "imaginary part k of the index of refraction n + i k of a metal"),
    ARGUMENT(REFLECTIVITY, "reflectivity", 0.9999, "R",
             "reflectance of a metal at normal incidence, in Gulbrandsen's parameters"),
    ARGUMENT(EDGE_TINT, "edge-tint", 1, "G", "edge tint of a metal, in Gulbrandsen's parameters"),
    [D] = CLI_D_ROW(eval, choices.model.d),
    [G] = CLI_G_ROW(eval, choices.model.g),
    [SHEEN] = {"sheen", CLI_CHOICE, AT(choices.sheen), .value = "KIND", .word = cli_sheen_word,
               .help = "masking function of sheen"},
    [F_ADD] = {"f-add", CLI_CHOICE, AT(choices.f_add), .value = "FORM", .words = f_adds,
               .help = "bounces that the quantity f-add contains: from the second on, or from the "
                       "first on as in the GAMES202 assignment"},
    [JSON] = {"json", CLI_FLAG, AT(json),
              .help = "print arguments and value as JSON, and an array for several lines of input"},
};

static int read_quantity(eval *v)
{
    char list[CLI_RANGE_TEXT];
    const cli_option words = {.word = quantity_word};
    const cli_arguments *a = &v->arguments;
    if (!a->rest_count)
        return cli_wrong(&cli_eval, "no quantity is named, name %s", cli_list(&words, list));
    if (a->rest_count > 1)
        return cli_wrong(&cli_eval,
                         "%s: kiln eval takes one quantity at a time, and %s is named already",
                         a->rest[1], a->rest[0]);
    int index = 0, code = cli_find_word(&cli_eval, "quantity", a->rest[0], &words, &index);
    v->quantity = &quantities[index];
    return code;
}

static bool takes(const quantity *q, int option)
{
    for (int i = 0; i < q->count; i++)
        if ((int)q->takes[i] == option)
            return true;
    return false;
}

// Writes the names of the arguments that a line of standard input holds, such as "roughness mu", to
// `text`.
static const char *columns(const eval *v, char text[128])
{
    *text = 0;
    for (int i = 0; i < v->column_count; i++) {
        size_t used = strlen(text);
        snprintf(text + used, 128 - used, "%s%s", i ? " " : "",
                 options[v->quantity->takes[v->column[i]]].name);
    }
    return text;
}

static int read_options(eval *v, const cli_call *call)
{
    int code = cli_read_arguments(&v->arguments, &cli_eval, call, v);
    if (code == CLI_GO)
        code = read_quantity(v);
    if (code != CLI_GO)
        return code;
    const quantity *q = v->quantity;
    for (int i = 0; i < ARGUMENTS; i++)
        if (v->arguments.text[i] && !takes(q, i))
            return cli_wrong(&cli_eval, "%s does not depend on --%s", q->name, options[i].name);
    for (int i = 0; i < q->count; i++) {
        v->fixed[i] = v->given[q->takes[i]];
        if (!v->arguments.text[q->takes[i]])
            v->column[v->column_count++] = i;
    }
    char text[128];
    if (v->column_count && os_is_terminal(OS_INPUT))
        return cli_wrong(
            &cli_eval,
            "--%s is missing, and standard input is a terminal instead of lines with '%s'",
            options[q->takes[v->column[0]]].name, columns(v, text));
    return CLI_GO;
}

// ------------------------------------------------------------------------------------------- lines

static int read_line(const eval *v, const char *line, size_t index, double *numbers)
{
    const char *at = line;
    for (int i = 0; i < v->column_count; i++) {
        argument which = v->quantity->takes[v->column[i]];
        char *end, text[128];
        numbers[i] = strtod(at, &end);
        if (end == at || (*end && !strchr(" \t\r\n", *end)))
            return cli_fail("standard input: line %zu must be numbers for '%s'", index + 1,
                            columns(v, text));
        if (!(numbers[i] >= options[which].low && numbers[i] <= options[which].high))
            return cli_fail("standard input: line %zu: %s is %g, it must be from %g to %g",
                            index + 1, options[which].name, numbers[i], options[which].low,
                            options[which].high);
        at = end;
    }
    char text[128];
    if (at[strspn(at, " \t\r\n")])
        return cli_fail("standard input: line %zu has more numbers than '%s'", index + 1,
                        columns(v, text));
    return CLI_GO;
}

// Reads the next line of standard input, without its line break, into a buffer that grows. Returns
// false at the end of the file, and if memory runs out, with errno set.
static bool next_line(char **line, size_t *capacity)
{
    size_t length = 0;
    int c;
    while ((c = getchar()) != EOF && c != '\n') {
        if (length + 2 > *capacity) {
            size_t more = *capacity ? 2 * *capacity : 256;
            char *longer = realloc(*line, more);
            if (!longer) {
                errno = ENOMEM;
                return false;
            }
            *line = longer;
            *capacity = more;
        }
        // a zero byte becomes ?, which is invalid in a number
        (*line)[length++] = (char)(c ? c : '?');
    }
    if (c == EOF && length == 0)
        return false;
    if (!*line)
        return (*line = calloc(1, *capacity = 256)) != NULL;
    (*line)[length] = 0;
    return true;
}

// Makes room for the numbers of one more line of standard input.
static bool grow(eval *v, size_t *room)
{
    size_t width = (size_t)v->column_count, more = *room ? 2 * *room : 1024;
    if (v->line_count < *room)
        return true;
    double *lines = more < SIZE_MAX / (width * sizeof *lines * 2)
                        ? realloc(v->lines, more * width * sizeof *lines)
                        : NULL;
    if (!lines)
        return false;
    v->lines = lines;
    *room = more;
    return true;
}

// Reads all lines of standard input before anything is printed, so that an invalid line leaves no
// partial output.
static int read_lines(eval *v)
{
    size_t capacity = 0, room = 0, width = (size_t)v->column_count;
    char *line = NULL;
    int code = CLI_GO;
    errno = 0;
    while (code == CLI_GO && next_line(&line, &capacity)) {
        if (grow(v, &room))
            code = read_line(v, line, v->line_count, v->lines + v->line_count * width);
        else
            code = cli_fail("out of memory: %zu lines", v->line_count);
        v->line_count++;
    }
    if (code == CLI_GO && (ferror(stdin) || errno == ENOMEM))
        code = cli_fail("standard input: %s", strerror(errno));
    free(line);
    return code;
}

// ------------------------------------------------------------------------------------------ output

// Prints the shortest decimal number that reads back as x.
static void print_argument(double x)
{
    char text[32];
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, x);
        if (strtod(text, NULL) == x)
            break;
    }
    fputs(text, stdout);
}

static void print_json(const eval *v, const double *x, double value)
{
    printf("{\"quantity\": \"%s\", \"d\": \"%s\", \"g\": \"%s\"", v->quantity->name,
           kiln_d_names()[v->choices.model.d], kiln_g_names()[v->choices.model.g]);
    for (int i = 0; i < v->quantity->count; i++) {
        printf(", \"%s\": ", options[v->quantity->takes[i]].name);
        print_argument(x[i]);
    }
    if (isfinite(value))
        printf(", \"value\": %.12g}", value);
    else
        fputs(", \"value\": null}", stdout); // JSON has no infinity: null stands for it
}

static void print_values(const eval *v)
{
    bool many = v->column_count > 0;
    size_t count = many ? v->line_count : 1;
    double x[MAX_ARGUMENTS];
    memcpy(x, v->fixed, sizeof x);
    if (v->json && many)
        fputs("[", stdout);
    for (size_t k = 0; k < count; k++) {
        for (int i = 0; i < v->column_count; i++)
            x[v->column[i]] = v->lines[k * (size_t)v->column_count + (size_t)i];
        double value = v->quantity->value(&v->choices, x);
        if (v->json) {
            fputs(k ? ",\n" : many ? "\n" : "", stdout);
            print_json(v, x, value);
        } else {
            printf("%.12g\n", value);
        }
    }
    if (v->json)
        puts(many ? "\n]" : "");
}

static int run(const cli_call *call)
{
    eval v = {0};
    int code = read_options(&v, call);
    if (code == CLI_GO && v.column_count)
        code = read_lines(&v);
    if (code == CLI_GO) {
        print_values(&v);
        code = CLI_DONE;
    }
    free(v.lines);
    return code;
}

// Writes a quantity with its arguments, such as "specular roughness mu nol noh", to `left`, and
// returns its description; NULL after the last quantity.
static const char *list(int index, char left[64])
{
    if (index >= QUANTITIES)
        return NULL;
    const quantity *q = &quantities[index];
    snprintf(left, 64, "%s", q->name);
    for (int i = 0; i < q->count; i++) {
        size_t used = strlen(left);
        snprintf(left + used, 64 - used, " %s", options[q->takes[i]].name);
    }
    return q->meaning;
}

static const cli_example examples[] = {
    {"kiln eval e --roughness 0.5 --mu 0.5", "0.857263435582"},
    {"kiln eval eavg --g schlick-k2 --roughness 0.5 --json",
     "the average albedo with another masking function, as JSON"},
    {"seq 0 0.01 1 | kiln eval e --roughness 0.25",
     "101 values, whose mu is read from standard input"},
    {NULL, NULL}};

const cli_command cli_eval = {
    .name = "eval",
    .arguments = "QUANTITY [OPTION...]",
    .summary = "Evaluates functions of the reflection model.",
    .about = "Values are printed with twelve digits. The list of quantities names the arguments of "
             "each quantity. Arguments without an option are read from standard input: each line "
             "has these numbers in the order of the list, and one value is printed for each line.",
    .more = "The values are printed after all lines were read, in the order of the lines.",
    .word = quantity_word,
    .list_title = "Quantities",
    .list = list,
    .examples = examples,
    .options = options,
    .run = run,
};
