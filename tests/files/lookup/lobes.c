// Writes tables of lobes as C arrays with their lookups in C, GLSL and WGSL, and a program that
// compares the C with kiln_table_lookup and the correction with the sum of harmonics that
// kiln/brdf.h defines: write FOLDER
#include "kit/random.h"

#include <kiln/brdf.h>

#include <math.h>
#include <stdio.h>

enum { POINTS = 50, COLUMNS = 5, ROWS = 4 };

static kiln_context *context;
static kiln_error error;

static void unit(uint64_t *seed, double v[3])
{
    double length = 0;
    for (int i = 0; i < 3; i++) {
        v[i] = 2 * random_number(seed) - 1;
        length += v[i] * v[i];
    }
    for (int i = 0; i < 3; i++)
        v[i] /= sqrt(length);
}

// Band l of random harmonics as a homogeneous polynomial of degree l in d.
static double band(const kiln_sh *sh, int l, const double d[3])
{
    kiln_sh one = {.bands = 3};
    double value[3], length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    double u[3] = {d[0] / length, d[1] / length, d[2] / length};
    for (int i = l * l; i < (l + 1) * (l + 1); i++)
        one.c[i][0] = sh->c[i][0];
    kiln_sh_evaluate(&one, u, value);
    return value[0] * (l == 2 ? length * length : l == 1 ? length : 1);
}

// What the coefficients of bands 0 to 2 add to reflected light.
static double correction(const kiln_table *table, const double *values, const kiln_sh *sh,
                         const double n[3], const double v[3])
{
    double nov = n[0] * v[0] + n[1] * v[1] + n[2] * v[2], sine = sqrt(1 - nov * nov), t[3], b[3];
    double list[8], rest = 1, both[3];
    int taps = table->def.tap_count;
    for (int i = 0; i < 3; i++) {
        t[i] = (nov * n[i] - v[i]) / sine;
        both[i] = n[i] + t[i];
    }
    for (int i = 0; i < 3; i++)
        b[i] = n[(i + 1) % 3] * t[(i + 2) % 3] - n[(i + 2) % 3] * t[(i + 1) % 3];
    for (int i = 0; i < taps; i++) {
        list[i] = values[4 * i + 3];
        rest -= values[4 * i + 2];
    }
    for (int i = 0; i < 4; i++)
        list[taps + i] = values[4 * taps + i];
    double nn = band(sh, 2, n), tt = band(sh, 2, t), nt = (band(sh, 2, both) - nn - tt) / 2;
    return rest * band(sh, 0, n) + list[0] * band(sh, 1, n) + list[1] * band(sh, 1, t) +
           list[2] * nn + list[3] * nt + list[4] * (tt - band(sh, 2, b));
}

static kiln_result make(int taps, kiln_table *table)
{
    uint64_t seed = (uint64_t)taps;
    *table = (kiln_table){.def = {.kind = KILN_TABLE_LOBES,
                                  .width = COLUMNS,
                                  .height = ROWS,
                                  .depth = taps + 1,
                                  .corners = true,
                                  .tap_count = taps,
                                  .level_count = 2,
                                  .level_roughness = {0, 1}}};
    kiln_result result =
        kiln_image_create(context, COLUMNS, ROWS * (taps + 1), 4, &table->image, &error);
    for (int i = 0; !result && i < COLUMNS * ROWS * (taps + 1) * 4; i++)
        table->image.pixels[i] = (float)random_number(&seed);
    return result;
}

static kiln_result save(const char *folder, const kiln_table *table)
{
    static const char *const endings[] = {".h", "_lookup.h", "_lookup.glsl", "_lookup.wgsl"};
    kiln_result result = KILN_OK;
    for (int i = 0; i < 4 && !result; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/l%d%s", folder, table->def.tap_count, endings[i]);
        result = i ? kiln_table_lookup_save(context, &table->def, path, NULL, &error)
                   : kiln_table_save(context, table, path, NULL, &error);
    }
    return result;
}

static void write_numbers(FILE *file, const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        fprintf(file, "%.17g,", numbers[i]);
}

// Writes the points of one table: n.v, roughness, n, v, nine harmonics, the table's numbers, the
// correction and the cosine of the angle from n to the first tap.
static void write_check(FILE *file, const kiln_table *table)
{
    int taps = table->def.tap_count, numbers = 4 * taps + 4;
    uint64_t seed = 77;
    fprintf(file, "static void check%d(void)\n{\n    static const double points[%d][%d] = {\n",
            taps, POINTS, 19 + numbers);
    for (int i = 0; i < POINTS; i++) {
        double at[8], values[16], sh9[9], last[2];
        kiln_sh sh = {.bands = 3};
        unit(&seed, at + 2);
        unit(&seed, at + 5);
        at[0] = at[2] * at[5] + at[3] * at[6] + at[4] * at[7];
        at[1] = 1.2 * random_number(&seed) - 0.1;
        kiln_table_lookup(table, at[0], at[1], 0, values);
        for (int k = 0; k < 9; k++)
            sh9[k] = sh.c[k][0] = 2 * random_number(&seed) - 1;
        last[0] = correction(table, values, &sh, at + 2, at + 5);
        last[1] = cos(acos(at[0]) - values[0]);
        fputs("        {", file);
        write_numbers(file, at, 8);
        write_numbers(file, sh9, 9);
        write_numbers(file, values, numbers);
        write_numbers(file, last, 2);
        fputs("},\n", file);
    }
    fprintf(file,
            "    };\n    for (int i = 0; i < %d; i++) {\n"
            "        const double *p = points[i], *n = p + 2;\n"
            "        double values[%d], d[%d][3], level[%d], weight[%d], w[9], sum = 0;\n"
            "        l%d_lookup(l%d_texels, p[0], p[1], values);\n"
            "        l%d_reflect(values, n, p + 5, d, level, weight, w);\n"
            "        for (int k = 0; k < 9; k++)\n            sum += w[k] * p[8 + k];\n"
            "        for (int k = 0; k < %d; k++)\n"
            "            compare(values[k], p[17 + k], 1e-12);\n"
            "        compare(sum, p[%d], 1e-6);\n"
            "        compare(d[0][0] * n[0] + d[0][1] * n[1] + d[0][2] * n[2], p[%d], 1e-9);\n"
            "        compare(level[0], values[1], 0);\n        compare(weight[0], values[2], 0);\n"
            "    }\n}\n\n",
            POINTS, numbers, taps, taps, taps, taps, taps, taps, numbers, 17 + numbers,
            18 + numbers);
}

static const char head[] = "#include <stdio.h>\n\n"
                           "static int checked, wrong;\n\n"
                           "static void compare(double value, double wanted, double bound)\n{\n"
                           "    checked++;\n"
                           "    if (!(fabs(value - wanted) <= bound) && wrong++ < 10)\n"
                           "        printf(\"%.17g, wanted %.17g\\n\", value, wanted);\n"
                           "}\n\n";

int main(int argc, char **argv)
{
    char path[512];
    if (argc != 2 || kiln_context_create(NULL, &context, &error))
        return 2;
    snprintf(path, sizeof path, "%s/main.c", argv[1]);
    FILE *file = fopen(path, "w");
    if (!file)
        return 2;
    for (int taps = 1; taps <= KILN_MAX_TAPS; taps++)
        fprintf(file, "#include \"l%d.h\"\n#include \"l%d_lookup.h\"\n", taps, taps);
    fputs(head, file);
    for (int taps = 1; taps <= KILN_MAX_TAPS && !error.result; taps++) {
        kiln_table table;
        if (make(taps, &table) || save(argv[1], &table))
            break;
        write_check(file, &table);
        kiln_table_free(&table);
    }
    fputs("int main(void)\n{\n    check1();\n    check2();\n    check3();\n"
          "    printf(\"%d numbers\\n\", checked);\n    return wrong != 0 || checked == 0;\n}\n",
          file);
    fclose(file);
    kiln_context_destroy(context);
    if (error.result)
        fprintf(stderr, "%s\n", error.message);
    return error.result != KILN_OK;
}
