// kiln eval: single values of the reflection model's functions and integrals, to twelve digits.
#include "cli.h"
#include "os.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ----------------------------------------------------------------------------------- what there is

typedef enum argument {
    NONE,
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
    ARGUMENTS, // and the options that are none
    D = ARGUMENTS,
    G,
    SHEEN,
    F_ADD,
    JSON,
} argument;

static const struct {
    const char *name;
    double low, high;
} argument_of[ARGUMENTS] = {
    [ROUGHNESS] = {"roughness", 0, 1},
    [MU] = {"mu", 0, 1},
    [NOL] = {"nol", 0, 1},
    [NOH] = {"noh", 0, 1},
    [VOH] = {"voh", 0, 1},
    [F0] = {"f0", 0, 1},
    [F] = {"f", 0, 1},
    [IOR] = {"ior", 0, 1e8},
    [N] = {"n", 0, 1e8},
    [K] = {"k", 0, 1e8},
    [REFLECTIVITY] = {"reflectivity", 0, 0.9999},
    [EDGE_TINT] = {"edge-tint", 0, 1},
};

typedef struct choices {
    kiln_model model;
    int sheen, f_add;
} choices;

enum { MAX_ARGUMENTS = 4 };

typedef struct quantity {
    const char *name;
    argument takes[MAX_ARGUMENTS]; // in the order of a line on standard input
    double (*value)(const choices *c, const double x[MAX_ARGUMENTS]);
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
    {"e", {ROUGHNESS, MU}, e},
    {"eavg", {ROUGHNESS}, e_average},
    {"a", {ROUGHNESS, MU}, a},
    {"b", {ROUGHNESS, MU}, b},
    {"sheen", {ROUGHNESS, MU}, sheen},
    {"d", {ROUGHNESS, NOH}, d},
    {"g", {ROUGHNESS, MU, NOL}, g},
    {"specular", {ROUGHNESS, MU, NOL, NOH}, specular},
    {"schlick", {F0, VOH}, schlick},
    {"dielectric", {IOR, VOH}, dielectric},
    {"conductor", {N, K, VOH}, conductor},
    {"schlick-avg", {F0}, schlick_average},
    {"dielectric-avg", {IOR}, dielectric_average},
    {"conductor-avg", {N, K}, conductor_average},
    {"dielectric-avg-fit", {IOR}, dielectric_average_fit},
    {"conductor-avg-fit", {REFLECTIVITY, EDGE_TINT}, conductor_average_fit},
    {"kulla-conty", {ROUGHNESS, MU, NOL}, kulla_conty},
    {"f-add", {ROUGHNESS, F}, f_add},
    {"turquin", {ROUGHNESS, MU, F0}, turquin},
};
enum { QUANTITIES = sizeof quantities / sizeof *quantities };

// --------------------------------------------------------------------------------------- arguments

#define VALUE(name, option, help, word)                                                            \
    {                                                                                              \
        name, 0, POPT_ARG_STRING, NULL, option, help, word                                         \
    }

static const struct poptOption options[] = {
    VALUE("roughness", ROUGHNESS, "perceptual, alpha = roughness^2, 0 to 1", "R"),
    VALUE("mu", MU, "n.v, the cosine with the view, 0 to 1", "MU"),
    VALUE("nol", NOL, "n.l, with the light", "C"),
    VALUE("noh", NOH, "n.h, with the half vector", "C"),
    VALUE("voh", VOH, "v.h, between view and half vector", "C"),
    VALUE("f0", F0, "reflectance at normal incidence, 0 to 1", "F0"),
    VALUE("f", F, "average Fresnel reflectance, 0 to 1", "F"),
    VALUE("ior", IOR, "of a dielectric, relative to outside, 0 to 1e8", "IOR"),
    VALUE("n", N, "of a conductor's index n + i k, 0 to 1e8", "N"),
    VALUE("k", K, "of a conductor's index n + i k, 0 to 1e8", "K"),
    VALUE("reflectivity", REFLECTIVITY, "of a metal, Gulbrandsen's, 0 to 0.9999", "R"),
    VALUE("edge-tint", EDGE_TINT, "of a metal, Gulbrandsen's, 0 to 1", "G"),
    VALUE("d", D, "ggx or beckmann (ggx)", "D"),
    VALUE("g", G, "smith, smith-uncorrelated, schlick-k2 or schlick-text (smith)", "G"),
    VALUE("sheen", SHEEN, "masking of sheen, ashikhmin or estevez (ashikhmin)", "KIND"),
    VALUE("f-add", F_ADD, "bounces in f-add, second (from the second on) or assignment (second)",
          "FORM"),
    {"json", 0, POPT_ARG_NONE, NULL, JSON, "arguments and value as JSON; an array for many", NULL},
    CLI_HELP_OPTION,
    POPT_TABLEEND,
};

typedef struct eval {
    cli_arguments arguments;
    const quantity *quantity;
    choices choices;
    double fixed[MAX_ARGUMENTS]; // by option
    int count, column_count;     // of all arguments, and of those that stand on a line
    int column[MAX_ARGUMENTS];
    double *lines; // column_count numbers each
    size_t line_count;
} eval;

static int unknown_quantity(const char *name)
{
    char list[512] = "";
    for (int i = 0; i < QUANTITIES; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s",
                 !i                   ? ""
                 : i < QUANTITIES - 1 ? ", "
                                      : " or ",
                 quantities[i].name);
    }
    if (!name)
        return cli_wrong(&cli_eval, "no quantity: name %s", list);
    return cli_wrong(&cli_eval, "%s: no such quantity, it must be %s", name, list);
}

static int read_quantity(eval *v)
{
    const cli_arguments *arguments = &v->arguments;
    if (!arguments->rest_count)
        return unknown_quantity(NULL);
    if (arguments->rest_count > 1)
        return cli_wrong(&cli_eval, "%s: one quantity at a time, after %s", arguments->rest[1],
                         arguments->rest[0]);
    for (int i = 0; i < QUANTITIES; i++)
        if (!strcmp(arguments->rest[0], quantities[i].name))
            v->quantity = &quantities[i];
    return v->quantity ? CLI_GO : unknown_quantity(arguments->rest[0]);
}

// "roughness mu" of a line.
static const char *columns(const eval *v, char text[128])
{
    *text = 0;
    for (int i = 0; i < v->column_count; i++) {
        size_t used = strlen(text);
        snprintf(text + used, 128 - used, "%s%s", i ? " " : "",
                 argument_of[v->quantity->takes[v->column[i]]].name);
    }
    return text;
}

static int read_arguments(eval *v)
{
    static const char *const forms[] = {"second", "assignment", NULL};
    const cli_arguments *arguments = &v->arguments;
    bool taken[ARGUMENTS] = {false};
    int code = read_quantity(v);
    if (code != CLI_GO || (code = cli_model(arguments, D, G, &v->choices.model)) != CLI_GO ||
        (code = cli_choice(arguments, SHEEN, "--sheen", kiln_sheen_names(), &v->choices.sheen)) !=
            CLI_GO ||
        (code = cli_choice(arguments, F_ADD, "--f-add", forms, &v->choices.f_add)) != CLI_GO)
        return code;
    for (int i = 0; i < MAX_ARGUMENTS && v->quantity->takes[i]; i++) {
        argument which = v->quantity->takes[i];
        char name[32];
        snprintf(name, sizeof name, "--%s", argument_of[which].name);
        code = cli_number(arguments, (int)which, name, argument_of[which].low,
                          argument_of[which].high, &v->fixed[i]);
        if (code != CLI_GO)
            return code;
        taken[which] = true;
        v->count++;
        if (!arguments->value[which])
            v->column[v->column_count++] = i;
    }
    for (int i = 1; i < ARGUMENTS; i++)
        if (arguments->value[i] && !taken[i])
            return cli_wrong(&cli_eval, "%s does not depend on --%s", v->quantity->name,
                             argument_of[i].name);
    char text[128];
    if (v->column_count && os_is_terminal(OS_INPUT))
        return cli_wrong(&cli_eval, "no --%s, and standard input has no lines of '%s'",
                         argument_of[v->quantity->takes[v->column[0]]].name, columns(v, text));
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
            return cli_fail("standard input: line %zu must be numbers, '%s'", index + 1,
                            columns(v, text));
        if (!(numbers[i] >= argument_of[which].low && numbers[i] <= argument_of[which].high))
            return cli_fail("standard input: line %zu: %s is %g, it must be from %g to %g",
                            index + 1, argument_of[which].name, numbers[i], argument_of[which].low,
                            argument_of[which].high);
        at = end;
    }
    char text[128];
    if (at[strspn(at, " \t\r\n")])
        return cli_fail("standard input: line %zu has more than '%s'", index + 1, columns(v, text));
    return CLI_GO;
}

// The next line of standard input, without its end, in a buffer that grows. False at the end of the file
// and where memory runs out, which errno then tells.
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
        (*line)[length++] = (char)(c ? c : '?'); // which no number has
    }
    if (c == EOF && length == 0)
        return false;
    if (!*line)
        return (*line = calloc(1, *capacity = 256)) != NULL;
    (*line)[length] = 0;
    return true;
}

// Room for one more line's numbers.
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

// All lines are read before anything is printed: a bad one leaves no half of an answer.
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

// The shortest number that is still x.
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
    for (int i = 0; i < v->count; i++) {
        printf(", \"%s\": ", argument_of[v->quantity->takes[i]].name);
        print_argument(x[i]);
    }
    if (isfinite(value))
        printf(", \"value\": %.12g}", value);
    else
        fputs(", \"value\": null}", stdout); // JSON has no infinity
}

static void print_values(const eval *v)
{
    bool json = v->arguments.value[JSON], many = v->column_count > 0;
    size_t count = many ? v->line_count : 1;
    double x[MAX_ARGUMENTS];
    memcpy(x, v->fixed, sizeof x);
    if (json && many)
        fputs("[", stdout);
    for (size_t k = 0; k < count; k++) {
        for (int i = 0; i < v->column_count; i++)
            x[v->column[i]] = v->lines[k * (size_t)v->column_count + (size_t)i];
        double value = v->quantity->value(&v->choices, x);
        if (json) {
            fputs(k ? ",\n" : many ? "\n" : "", stdout);
            print_json(v, x, value);
        } else {
            printf("%.12g\n", value);
        }
    }
    if (json)
        puts(many ? "\n]" : "");
}

static int run(int argc, const char **argv)
{
    eval v = {0};
    int code = cli_arguments_read(&v.arguments, &cli_eval, argc, argv);
    if (code == CLI_GO)
        code = read_arguments(&v);
    if (code == CLI_GO && v.column_count)
        code = read_lines(&v);
    if (code == CLI_GO) {
        print_values(&v);
        code = CLI_DONE;
    }
    free(v.lines);
    cli_arguments_free(&v.arguments);
    return code;
}

const cli_command cli_eval = {
    .name = "eval",
    .arguments = "QUANTITY [OPTION...]",
    .summary = "Evaluates functions of the reflection model.",
    .details =
        "Quantities, and what each depends on. What is not given by an option is read from\n"
        "standard input: lines of these numbers in this order, a value printed for each.\n"
        "  e a b                   roughness mu       E = A + B; specular albedo = F0 A + B\n"
        "  eavg                    roughness          2 int E(mu) mu dmu\n"
        "  sheen                   roughness mu       albedo of Charlie sheen\n"
        "  d                       roughness noh      distribution of normals\n"
        "  g                       roughness mu nol   masking and shadowing\n"
        "  specular                roughness mu nol noh   D G / (4 mu nol)\n"
        "  schlick                 f0 voh             Fresnel terms\n"
        "  dielectric              ior voh\n"
        "  conductor               n k voh\n"
        "  schlick-avg             f0                 2 int F(mu) mu dmu\n"
        "  dielectric-avg          ior                exact, and -fit: Kulla and Conty's\n"
        "  conductor-avg           n k                exact\n"
        "  conductor-avg-fit       reflectivity edge-tint   Kulla and Conty's fit\n"
        "  kulla-conty             roughness mu nol   the lobe that adds what is missing\n"
        "  f-add                   roughness f        its factor for F_avg = f\n"
        "  turquin                 roughness mu f0    Turquin's factor to the specular lobe\n"
        "\n"
        "Examples:\n"
        "  kiln eval e --roughness 0.5 --mu 0.5\n"
        "      0.857263435582\n"
        "  kiln eval eavg --g schlick-k2 --roughness 0.5 --json\n"
        "      the same quantity of another model, for a program\n"
        "  seq 0 0.01 1 | kiln eval e --roughness 0.25\n"
        "      101 values, mu from standard input\n",
    .options = options,
    .run = run,
};
