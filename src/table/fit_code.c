// Writes the source code of a closed form of the reflection model's integrals in C or GLSL. In: a
// fit and a name. Out: a function that evaluates the fit's polynomials by Horner's rule in 32-bit
// floats, with the same operations in the same order as ki_fit_evaluate_part.
#include "table/fit_code.h"

#include "base/file.h"
#include "codec/decimal.h"
#include "table/table_source.h"

#include <stddef.h>

// The words that differ between C and GLSL in written code: the type and the suffix of numbers, the
// name of the square root, and what precedes a function.
typedef struct language {
    const char *number, *suffix, *root, *prefix;
} language;

static const language c_language = {"float", "f", "sqrtf", "static inline "};
static const language glsl_language = {"highp float", "", "sqrt", ""};

static void write_number(ki_writer *w, const language *l, float value)
{
    ki_write_float(w, value);
    ki_write_text(w, "%s", l->suffix);
}

// ----------------------------------------------------------------------------------------- comment

// Names the integral that a closed form approximates, for the comment in the written code.
static const char *what(const kiln_fit_def *def)
{
    switch (def->kind) {
    case KILN_FIT_E_AVERAGE:
        return "E_avg = 2 int E(mu) mu dmu";
    case KILN_FIT_DFG:
        return "the split sum (A, B): specular albedo = F0 A + B";
    case KILN_FIT_SHEEN:
        return "the directional albedo of Charlie sheen";
    default:
        return "E(mu), the directional albedo with F = 1";
    }
}

static const char *model_of(const kiln_fit_def *def)
{
    static const char *const masking[] = {
        "height-correlated Smith masking", "uncorrelated Smith masking",
        "Schlick's masking, k = roughness^2 / 2", "Schlick's masking, k = (roughness + 1)^2 / 8"};
    if (def->kind == KILN_FIT_SHEEN)
        return "The masking is 1 / (4 (n.l + n.v - n.l n.v))";
    return masking[def->model.g];
}

static void write_comment(ki_writer *w, const kiln_fit *fit, const char *name)
{
    const kiln_fit_def *def = &fit->def;
    const char *d = def->kind == KILN_FIT_SHEEN  ? ""
                    : def->model.d == KILN_D_GGX ? "GGX, "
                                                 : "Beckmann, ";
    ki_write_text(w,
                  "// %s: %s.\n// %s%s. mu is n.v, roughness is perceptual, alpha = roughness^2.\n",
                  name, what(def), d, model_of(def));
    ki_write_text(
        w,
        "// A closed form with %d coefficients; max error %.3g, RMS %.3g, measured in 32-bit "
        "floats\n// for mu in [0, 1], roughness in [%.6g, 1]; arguments are clamped there.\n"
        "// Made by kiln %s. SPDX-License-Identifier: MIT\n",
        fit->coefficient_count, fit->max_error, fit->rms_error, def->roughness_min, kiln_version());
}

// -------------------------------------------------------------------------------------------- code

static bool has_axis(const kiln_fit *fit, kiln_fit_axis axis)
{
    return fit->part[0].axis == axis || (fit->part_count > 1 && fit->part[1].axis == axis);
}

static void write_clamp(ki_writer *w, const language *l, const char *to, const char *from,
                        float low)
{
    ki_write_text(w, "    %s %s = %s > ", l->number, to, from);
    write_number(w, l, low);
    ki_write_text(w, " ? (%s < 1.0%s ? %s : 1.0%s) : ", from, l->suffix, from, l->suffix);
    write_number(w, l, low);
    ki_write_text(w, ";\n");
}

// Writes the code that sets y, the roughness scaled to [-1, 1], and the variables m and t,
// functions of n.v and roughness, from which the parts of a fit compute their argument x.
static void write_arguments(ki_writer *w, const kiln_fit *fit, const language *l)
{
    const char *f = l->suffix, *number = l->number;
    float low = (float)fit->def.roughness_min;
    bool root = has_axis(fit, KILN_FIT_AXIS_SQRT_T);
    if (fit->def.kind != KILN_FIT_E_AVERAGE)
        write_clamp(w, l, "m", "mu", 0);
    write_clamp(w, l, "r", "roughness", low);
    if (low > 0) {
        ki_write_text(w, "    %s y = (r - ", number);
        write_number(w, l, low);
        ki_write_text(w, ") * ");
        write_number(w, l, 2 / (1 - low));
        ki_write_text(w, " - 1.0%s;\n", f);
    } else {
        ki_write_text(w, "    %s y = 2.0%s * r - 1.0%s;\n", number, f, f);
    }
    if (root || has_axis(fit, KILN_FIT_AXIS_T)) {
        if (fit->def.model.g == KILN_G_SCHLICK_TEXT)
            ki_write_text(w,
                          "    %s k = (r + 1.0%s) * (r + 1.0%s) * 0.125%s;\n"
                          "    %s c = k / (1.0%s - k);\n",
                          number, f, f, f, number, f);
        else
            ki_write_text(w, "    %s c = r * r;\n", number);
        ki_write_text(w,
                      "    %s s = m + c;\n"
                      "    %s t = s > 0.0%s ? m * (1.0%s + c) / s : 1.0%s;\n",
                      number, number, f, f, f);
    }
}

// Writes the code that sets x in [-1, 1], the first argument of the polynomials P and Q of one part
// of a closed form.
static void write_x(ki_writer *w, const kiln_fit_part *part, const language *l)
{
    static const char *const from[] = {"", "t", "t", "m", "m"};
    bool root = part->axis == KILN_FIT_AXIS_SQRT_T || part->axis == KILN_FIT_AXIS_SQRT_NOV;
    if (part->axis == KILN_FIT_AXIS_NONE)
        return;
    ki_write_text(w, "        %s x = 2.0%s * %s%s%s%s - 1.0%s;\n", l->number, l->suffix,
                  root ? l->root : "", root ? "(" : "", from[part->axis], root ? ")" : "",
                  l->suffix);
}

// Writes a polynomial of `variable` by Horner's rule, c0 + v * (c1 + v * (c2 ...)), four terms in a
// line. The coefficients are the numbers c[], or with `row` the variables row0, row1, ...
static void write_horner(ki_writer *w, const language *l, const float *c, int count,
                         const char *variable, const char *row)
{
    for (int i = 0; i < count; i++) {
        if (row)
            ki_write_text(w, "%s%d", row, i);
        else
            write_number(w, l, c[i]);
        if (i < count - 1)
            ki_write_text(w, " +%s%s * %s", i % 4 == 3 ? "\n            " : " ", variable,
                          i < count - 2 ? "(" : "");
    }
    for (int i = 0; i < count - 2; i++)
        ki_write_text(w, ")");
    ki_write_text(w, ";\n");
}

// Writes the code that sets the variable `name` to a polynomial in x and y, P or Q of one part of a
// closed form, with the coefficients c.
static void write_polynomial(ki_writer *w, const language *l, const kiln_fit_part *part,
                             const float *c, const char *name)
{
    if (part->x_count == 1) {
        ki_write_text(w, "        %s %s = ", l->number, name);
        write_horner(w, l, c, part->y_count, "y", NULL);
        return;
    }
    for (int j = 0; j < part->y_count; j++) {
        ki_write_text(w, "        %s %s%d = ", l->number, name, j);
        write_horner(w, l, c + (size_t)j * (size_t)part->x_count, part->x_count, "x", NULL);
    }
    ki_write_text(w, "        %s %s = ", l->number, name);
    write_horner(w, l, NULL, part->y_count, "y", name);
}

// Writes the code that sets the variable `to` to the value of one part of a fit, P or P / Q.
static void write_part(ki_writer *w, const kiln_fit_part *part, const language *l, const char *to)
{
    ki_write_text(w, "    %s %s;\n    {\n", l->number, to);
    write_x(w, part, l);
    write_polynomial(w, l, part, part->p, "p");
    if (part->rational)
        write_polynomial(w, l, part, part->q, "q");
    ki_write_text(w, "        %s = %s;\n    }\n", to, part->rational ? "p / q" : "p");
}

void ki_fit_write_code(const kiln_fit *fit, const char *name, bool glsl, ki_writer *w)
{
    const language *l = glsl ? &glsl_language : &c_language;
    bool two = fit->part_count > 1, average = fit->def.kind == KILN_FIT_E_AVERAGE;
    write_comment(w, fit, name);
    if (!glsl)
        ki_write_text(w, "#ifndef %s_h\n#define %s_h\n#include <math.h>\n", name, name);
    if (two && glsl)
        ki_write_text(w, "highp vec2 %s(", name);
    else
        ki_write_text(w, "%s%s %s(", l->prefix, two ? "void" : l->number, name);
    if (!average)
        ki_write_text(w, "%s mu, ", l->number);
    ki_write_text(w, "%s roughness%s)\n{\n", l->number, two && !glsl ? ", float ab[2]" : "");
    write_arguments(w, fit, l);
    write_part(w, &fit->part[0], l, "e");
    if (!two) {
        ki_write_text(w, "    return e;\n}\n");
    } else {
        const char *f = l->suffix;
        write_part(w, &fit->part[1], l, "d");
        ki_write_text(w,
                      "    %s g = 1.0%s - m, g2 = g * g;\n"
                      "    %s b = e * (g2 * g2 * g) + d;\n",
                      l->number, f, l->number);
        ki_write_text(w, glsl ? "    return vec2(e - b, b);\n}\n"
                              : "    ab[0] = e - b;\n    ab[1] = b;\n}\n");
    }
    if (!glsl)
        ki_write_text(w, "#endif\n");
}

static bool is_form(const kiln_fit *fit)
{
    if (fit->part_count < 1 || fit->part_count > 2)
        return false;
    for (int k = 0; k < fit->part_count; k++) {
        const kiln_fit_part *part = &fit->part[k];
        if (part->x_count < 1 || part->x_count > KILN_MAX_FIT_TERMS || part->y_count < 1 ||
            part->y_count > KILN_MAX_FIT_TERMS || (unsigned)part->axis > KILN_FIT_AXIS_SQRT_NOV)
            return false;
    }
    return true;
}

kiln_result kiln_fit_save(kiln_context *context, const kiln_fit *fit, const char *name,
                          const char *path, kiln_error *error)
{
    static const char *const names[] = {"kiln_e", "kiln_e_average", "kiln_dfg", "kiln_sheen"};
    if (!is_form(fit))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the fit has %d parts, make it by kiln_fit_create before it is saved",
                       fit->part_count);
    ki_source_name made;
    kiln_result result =
        ki_source_name_make(path, name ? name : names[fit->def.kind], &made, error);
    if (result != KILN_OK)
        return result;
    bool glsl = ki_ends_with(path, ".glsl");
    if (!glsl && !ki_ends_with(path, ".h"))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: must end in .h or .glsl", path);
    ki_writer text = {.context = context};
    ki_fit_write_code(fit, made.text, glsl, &text);
    result = text.failed ? ki_fail_memory(context, error, path, text.size)
                         : ki_file_write(context, path, text.bytes, text.size, error);
    ki_writer_free(&text);
    return result;
}
