// Writes tables as C and GLSL with their lookups, and a program that holds the C to what
// kiln_table_lookup says: write FOLDER
#include "tables.h"

#include <stdio.h>

enum { POINTS = 200 };

static kiln_context *context;
static kiln_error error;

static bool save(const char *folder, int index, const kiln_table *table)
{
    static const char *const endings[] = {".h", ".glsl", "_lookup.h", "_lookup.glsl"};
    for (int i = 0; i < 4; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/t%d%s", folder, index, endings[i]);
        // Tables in GLSL in each of the four formats.
        kiln_table_save_def def = {.format = i == 1 ? (kiln_table_format)(1 + index % 4)
                                                    : KILN_TABLE_FORMAT_AUTO};
        if (i < 2 ? kiln_table_save(context, table, path, &def, &error)
                  : kiln_table_lookup_save(context, &table->def, path, NULL, &error))
            return false;
    }
    return true;
}

static void write_check(FILE *file, int index, const kiln_table *table)
{
    const char *nov = table->def.kind == KILN_TABLE_E_AVERAGE ? "" : "p[0], ";
    const char *third = table->def.depth > 1 ? ", p[2]" : "";
    int channels = table->image.channels;
    uint64_t seed = (uint64_t)index + 1000;
    fprintf(file, "static void check%d(void)\n{\n    static const double points[%d][7] = {\n",
            index, POINTS);
    for (int i = 0; i < POINTS; i++) {
        double point[3], values[4] = {0};
        lookup_point(&seed, point);
        kiln_table_lookup(table, point[0], point[1], point[2], values);
        fprintf(file, "        {%.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g},\n", point[0],
                point[1], point[2], values[0], values[1], values[2], values[3]);
    }
    fprintf(file,
            "    };\n    for (int i = 0; i < %d; i++) {\n        const double *p = points[i];\n"
            "        double values[4];\n        ",
            POINTS);
    if (channels == 1)
        fprintf(file, "values[0] = t%d_lookup(t%d_texels, %sp[1]%s);\n", index, index, nov, third);
    else
        fprintf(file, "t%d_lookup(t%d_texels, p[0], p[1]%s, values);\n", index, index, third);
    fprintf(file, "        compare(%d, values, p + 3, t%d_channels);\n    }\n}\n\n", index, index);
}

static const char head[] =
    "#include <math.h>\n#include <stdio.h>\n\n"
    "static int checked, wrong;\nstatic double worst;\n\n"
    "static void compare(int table, const double *values, const double *wanted, int count)\n{\n"
    "    for (int c = 0; c < count; c++, checked++) {\n"
    "        double off = fabs(values[c] - wanted[c]);\n"
    "        worst = off > worst ? off : worst;\n"
    "        if (!(off <= 1e-12) && wrong++ < 10)\n"
    "            printf(\"table %d: %.17g, wanted %.17g\\n\", table, values[c], wanted[c]);\n"
    "    }\n}\n\n";

int main(int argc, char **argv)
{
    char path[512];
    if (argc != 2 || kiln_context_create(NULL, &context, &error))
        return 2;
    snprintf(path, sizeof path, "%s/main.c", argv[1]);
    FILE *file = fopen(path, "w");
    if (!file)
        return 2;
    for (int i = 0; i < LOOKUP_TABLES; i++)
        fprintf(file, "#include \"t%d.h\"\n#include \"t%d_lookup.h\"\n", i, i);
    fputs(head, file);
    for (int i = 0; i < LOOKUP_TABLES; i++) {
        kiln_table table;
        if (lookup_table(context, i, &table, &error) || !save(argv[1], i, &table))
            break;
        write_check(file, i, &table);
        kiln_table_free(&table);
    }
    fputs("int main(void)\n{\n", file);
    for (int i = 0; i < LOOKUP_TABLES; i++)
        fprintf(file, "    check%d();\n", i);
    fputs("    printf(\"%d numbers, off by at most %g\\n\", checked, worst);\n"
          "    return wrong != 0 || checked == 0;\n}\n",
          file);
    fclose(file);
    kiln_context_destroy(context);
    if (error.result)
        fprintf(stderr, "%s\n", error.message);
    return error.result != KILN_OK;
}
