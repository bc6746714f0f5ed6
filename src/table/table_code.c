// Writes source code in C or GLSL that reads a table as kiln_table_lookup does. In: the table's
// kiln_table_def, a name, the kind of code. Out: text. The code has the table's size and axis
// written in as constants and works in three steps. It maps arguments to places in [0, 1] (as
// table_axis.h), maps places to texels, and interpolates the texels linearly. Tests compare the
// code's results with kiln_table_lookup.
#include "table/table_code.h"

#include "table/table.h"
#include "table/table_axis.h"

#include <string.h>

typedef struct code_writer {
    const kiln_table_def *def;
    ki_writer *w;
    const char *name;
    bool c; // true: C is written; false: GLSL
    int channels;
    bool nov; // true: the lookup function has the argument n.v, which only tables of E_avg lack
    // Name of the lookup function's third argument, "ior" or "f0"; NULL if the function has no
    // third argument.
    const char *third;
} code_writer;

static const char *real(const code_writer *j)
{
    return j->c ? "double" : "float";
}

// ---------------------------------------------------------------------------------------- comments

static void write_arguments_comment(const code_writer *j)
{
    ki_write_text(j->w, "// %sroughness is perceptual%s%s. Arguments out of range are clamped.\n",
                  j->nov ? "nov is n.v, " : "", j->third ? ", " : "",
                  !j->third                                      ? ""
                  : ki_table_third(j->def->kind) == KI_THIRD_IOR ? "ior is from 1 to 3"
                                                                 : "f0 is F0");
}

static void write_result_comment(const code_writer *j)
{
    static const char *const results[] = {
        [KILN_TABLE_E] = "E, the albedo of the specular lobe with F = 1",
        [KILN_TABLE_E_AVERAGE] = "E_avg = 2 int E(mu) mu dmu",
        [KILN_TABLE_DFG] = "A and B: specular albedo = f0 A + B",
        [KILN_TABLE_DFG_MULTISCATTER] = "B, A + B and the albedo of Charlie sheen",
        [KILN_TABLE_SHEEN] = "the albedo of Charlie sheen",
        [KILN_TABLE_E_DIELECTRIC] = "the albedo of a rough dielectric's reflection",
        [KILN_TABLE_GLASS] = "reflected and transmitted from outside, then from inside",
        [KILN_TABLE_E_WALK] =
            ("the albedo of the bounces after the first; the specular lobe is multiplied by\n"
             "// 1 + result / (f0 A + B)"),
    };
    ki_write_text(j->w, "// The result is %s.\n", results[j->def->kind]);
}

// --------------------------------------------------------------------------------------- arguments

// Writes the code that sets u, v and w, the places in [0, 1] along a table's axes, from the
// arguments n.v, roughness and F0 or ior.
static void write_places(const code_writer *j)
{
    ki_writer *w = j->w;
    const kiln_table_def *def = j->def;
    const char *type = real(j), *unit = j->c ? j->name : "", *call = j->c ? "_unit(" : "clamp(";
    const char *end = j->c ? ")" : ", 0.0, 1.0)";
    ki_write_text(w, "    %s r = %s%sroughness%s;\n", type, unit, call, end);
    if (j->nov)
        ki_write_text(w, "    %s u = %s%snov%s;\n", type, unit, call, end);
    if (j->nov && def->axis == KILN_AXIS_SQRT)
        ki_write_text(w, "    u = sqrt(u);\n");
    if (j->nov && def->axis == KILN_AXIS_CBRT)
        ki_write_text(w, j->c ? "    u = cbrt(u);\n" : "    u = pow(u, 1.0 / 3.0);\n");
    if (j->nov && def->axis == KILN_AXIS_GRAZING) {
        // The written code sets c by the formulas of ki_grazing_scale.
        if (def->model.g == KILN_G_SCHLICK_TEXT)
            ki_write_text(w,
                          "    %s k = (r + 1.0) * (r + 1.0) / 8.0;\n"
                          "    %s c = k / (1.0 - k);\n",
                          type, type);
        else
            ki_write_text(w, "    %s c = r > 1e-6 ? r * r : 1e-12;\n", type);
        ki_write_text(w, "    u = u < 1.0 ? sqrt(u * (1.0 + c) / (u + c)) : 1.0;\n");
    }
    ki_write_text(w, "    %s v = %s;\n", type, def->flip ? "1.0 - r" : "r");
    if (j->third)
        ki_write_text(w, "    %s w = %s%s%s%s;\n", type, unit, call,
                      ki_table_third(def->kind) == KI_THIRD_IOR ? "2.0 * (ior - 1.0) / (ior + 1.0)"
                                                                : "f0",
                      end);
}

static void write_parameters(const code_writer *j, const char *first)
{
    const char *type = real(j);
    ki_write_text(j->w, "%s%s%s%s roughness%s%s%s%s", first, j->nov ? type : "",
                  j->nov ? " nov, " : "", type, j->third ? ", " : "", j->third ? type : "",
                  j->third ? " " : "", j->third ? j->third : "");
}

// ----------------------------------------------------------------------------------------------- C

// Writes the C functions that clamp to [0, 1], find the two texels nearest to a place, and
// interpolate.
static void write_c_parts(const code_writer *j)
{
    ki_write_text(
        j->w,
        "static inline double %s_unit(double x)\n"
        "{\n"
        "    return x > 0 ? x < 1 ? x : 1 : 0;\n"
        "}\n"
        "\n"
        "// Returns the texel before a place in [0, 1] among n texels. *step is 1, or 0 after the\n"
        "// last texel, and *share is the weight of the texel that is *step further.\n"
        "static inline int %s_between(double place, int n, int *step, double *share)\n"
        "{\n",
        j->name, j->name);
    if (j->def->corners)
        ki_write_text(j->w, "    double at = place * (n - 1);\n");
    else
        ki_write_text(j->w, "    double at = place * n - 0.5;\n"
                            "    at = at > 0 ? at < n - 1 ? at : n - 1 : 0;\n");
    ki_write_text(j->w,
                  "    int low = (int)at;\n"
                  "    *step = low < n - 1 ? 1 : 0;\n"
                  "    *share = at - low;\n"
                  "    return low;\n"
                  "}\n"
                  "\n"
                  "static inline double %s_mix(double a, double b, double share)\n"
                  "{\n"
                  "    return a + (b - a) * share;\n"
                  "}\n"
                  "\n",
                  j->name);
}

static void write_c_head(const code_writer *j)
{
    const char *result = j->channels > 1 ? "void" : "double";
    ki_write_text(j->w, "static inline %s %s_lookup(", result, j->name);
    write_parameters(j, "const float *texels, ");
    if (j->channels > 1)
        ki_write_text(j->w, ", double values[%d]", j->channels);
    ki_write_text(j->w, ")\n{\n");
}

// Writes the code that sets the variable `name` to an interpolated value of one slice of the table,
// between the four texels that lie around the arguments. In the written code, t points to the first
// of these texels.
static void write_c_slice(const code_writer *j, const char *name)
{
    ki_writer *w = j->w;
    const char *n = j->name;
    if (j->nov)
        ki_write_text(w,
                      "        double %s = %s_mix(%s_mix((double)t[0], (double)t[dx], fx),\n"
                      "            %s_mix((double)t[dy], (double)t[dy + dx], fx), fy);\n",
                      name, n, n, n);
    else
        ki_write_text(w, "        double %s = %s_mix((double)t[0], (double)t[dy], fy);\n", name, n);
}

static void write_c(const code_writer *j)
{
    ki_writer *w = j->w;
    const kiln_table_def *def = j->def;
    write_c_parts(j);
    write_arguments_comment(j);
    write_result_comment(j);
    ki_write_text(w,
                  "// `texels` are %d rows of %d texels%s, each of %d float%s.\n"
                  "// Interpolates linearly, as graphics hardware does.\n",
                  def->height, def->width, j->third ? ", slice after slice" : "", j->channels,
                  j->channels > 1 ? "s" : "");
    write_c_head(j);
    write_places(j);
    ki_write_text(w, "    int dy;\n    double fy;\n");
    ki_write_text(w, "    int at = %s_between(v, %d, &dy, &fy);\n", j->name, def->height);
    if (j->third)
        ki_write_text(w,
                      "    int dz;\n    double fz;\n    at += %d * %s_between(w, %d, &dz, &fz);\n",
                      def->height, j->name, def->depth);
    if (j->nov)
        ki_write_text(
            w,
            "    int dx;\n    double fx;\n    at = %d * at + %s_between(u, %d, &dx, &fx);\n"
            "    dx *= %d;\n",
            def->width, j->name, def->width, j->channels);
    ki_write_text(w, "    dy *= %d;\n", def->width * j->channels);
    if (j->third)
        ki_write_text(w, "    dz *= %d;\n", def->height * def->width * j->channels);
    ki_write_text(w, "    %sfor (int channel = 0; channel < %d; channel++) {\n",
                  j->channels > 1 ? "" : "double values[1];\n    ", j->channels);
    ki_write_text(w, "        const float *t = texels + at * %d + channel;\n", j->channels);
    write_c_slice(j, "value");
    if (j->third) {
        ki_write_text(w, "        t += dz;\n");
        write_c_slice(j, "next");
        ki_write_text(w, "        value = %s_mix(value, next, fz);\n", j->name);
    }
    ki_write_text(w, "        values[channel] = %s;\n    }\n%s}\n",
                  def->complement ? "1.0 - value" : "value",
                  j->channels > 1 ? "" : "    return values[0];\n");
}

// -------------------------------------------------------------------------------------------- GLSL

static const char *const vectors[4] = {"float", "vec2", "vec3", "vec4"};

static void write_glsl_texture(const code_writer *j)
{
    static const char *const swizzles[4] = {"r", "rg", "rgb", "rgba"};
    ki_writer *w = j->w;
    const kiln_table_def *def = j->def;
    write_arguments_comment(j);
    write_result_comment(j);
    ki_write_text(w, "// The texture is %d x %d", def->width, def->height);
    if (j->third)
        ki_write_text(w, " x %d", def->depth);
    ki_write_text(w,
                  "; its sampler filters linearly and clamps to the edge.\n"
                  "// Floats must be highp.\n"
                  "%s %s_lookup(",
                  vectors[j->channels - 1], j->name);
    write_parameters(j, j->third ? "highp sampler3D table, " : "highp sampler2D table, ");
    ki_write_text(w, ")\n{\n");
    write_places(j);
    if (!j->nov)
        ki_write_text(w, "    float u = 0.5;\n");
    const char *type = j->third ? "vec3" : "vec2";
    ki_write_text(w, "    %s at = %s(u, v%s);\n", type, type, j->third ? ", w" : "");
    if (def->corners) {
        ki_write_text(w, "    %s size = %s(%d, %d", type, type, def->width, def->height);
        if (j->third)
            ki_write_text(w, ", %d", def->depth);
        ki_write_text(w, ");\n    at = (at * (size - 1.0) + 0.5) / size;\n");
    }
    ki_write_text(w, "    return %stextureLod(table, at, 0.0).%s;\n}\n",
                  def->complement ? "1.0 - " : "", swizzles[j->channels - 1]);
}

static void write_glsl_place(const code_writer *j, char axis, int n)
{
    ki_writer *w = j->w;
    if (j->def->corners)
        ki_write_text(w, "    float f%c = %c * %d.0;\n", axis,
                      axis == 'x'   ? 'u'
                      : axis == 'y' ? 'v'
                                    : 'w',
                      n - 1);
    else
        ki_write_text(w, "    float f%c = clamp(%c * %d.0 - 0.5, 0.0, %d.0);\n", axis,
                      axis == 'x'   ? 'u'
                      : axis == 'y' ? 'v'
                                    : 'w',
                      n, n - 1);
    ki_write_text(w, "    int %c = int(f%c);\n    f%c -= float(%c);\n", axis, axis, axis, axis);
}

static void write_glsl_array(const code_writer *j)
{
    ki_writer *w = j->w;
    const kiln_table_def *def = j->def;
    const char *type = vectors[j->channels - 1], *n = j->name;
    // Writes two GLSL functions: NAME_texel reads the texel (x, y, z) of the table, and NAME_slice
    // interpolates in slice z between the texel (x, y) and its neighbours at x + 1 and y + 1.
    ki_write_text(w,
                  "%s %s_texel(int x, int y, int z)\n"
                  "{\n"
                  "    x = min(x, %d);\n"
                  "    y = min(y, %d);\n"
                  "    z = min(z, %d);\n"
                  "    int i = ((z * %d + y) * %d + x) * %d;\n"
                  "    return %s(",
                  type, n, def->width - 1, def->height - 1, def->depth - 1, def->height, def->width,
                  j->channels, type);
    for (int c = 0; c < j->channels; c++)
        ki_write_text(w, c ? ", %s_number(i + %d)" : "%s_number(i)", n, c);
    ki_write_text(w,
                  ");\n}\n\n"
                  "%s %s_slice(int x, int y, int z, float fx, float fy)\n"
                  "{\n"
                  "    return mix(mix(%s_texel(x, y, z), %s_texel(x + 1, y, z), fx),\n"
                  "               mix(%s_texel(x, y + 1, z), %s_texel(x + 1, y + 1, z), fx), fy);\n"
                  "}\n\n",
                  type, n, n, n, n, n);
    write_arguments_comment(j);
    write_result_comment(j);
    ki_write_text(w, "// Floats must be highp.\n%s %s_lookup(", type, n);
    write_parameters(j, "");
    ki_write_text(w, ")\n{\n");
    write_places(j);
    if (!j->nov)
        ki_write_text(w, "    float u = 0.0;\n");
    write_glsl_place(j, 'x', def->width);
    write_glsl_place(j, 'y', def->height);
    if (j->third)
        write_glsl_place(j, 'z', def->depth);
    ki_write_text(w, "    %s value = %s_slice(x, y, %s, fx, fy);\n", type, n, j->third ? "z" : "0");
    if (j->third)
        ki_write_text(w, "    value = mix(value, %s_slice(x, y, z + 1, fx, fy), fz);\n", n);
    ki_write_text(w, "    return %s;\n}\n", def->complement ? "1.0 - value" : "value");
}

void ki_table_write_code(const kiln_table_def *def, ki_table_code code, const char *name,
                         ki_writer *w)
{
    code_writer j = {.def = def,
                     .w = w,
                     .name = name,
                     .c = code == KI_TABLE_C,
                     .channels = ki_table_channels(def->kind),
                     .nov = def->kind != KILN_TABLE_E_AVERAGE,
                     .third = def->depth <= 1                             ? NULL
                              : ki_table_third(def->kind) == KI_THIRD_IOR ? "ior"
                                                                          : "f0"};
    if (code == KI_TABLE_C)
        write_c(&j);
    else if (code == KI_TABLE_GLSL_TEXTURE)
        write_glsl_texture(&j);
    else
        write_glsl_array(&j);
}
