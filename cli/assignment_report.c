// Writes report.md into the GAMES202 assignment's folder, and the same figures as JSON. In: the
// assignment's tables and their differences from the exact tables. The report lists the files, the
// errors by method and roughness, and their causes.
#include "assignment.h"
#include "json.h"
#include "os.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Index of the table row whose roughness is nearest.
static int row_of(const assignment *a, double roughness)
{
    int size = a->def->size, up = (int)floor(roughness * size);
    return size - 1 - (up < size ? up : size - 1);
}

static double roughness_of(const assignment *a, int row)
{
    return (a->def->size - 1 - row + 0.5) / a->def->size;
}

static double row_mean(const assignment *a, int table, int row)
{
    int size = a->def->size;
    double sum = 0;
    for (int x = 0; x < size; x++)
        sum += (double)a->table[table].pixels[row * size + x];
    return sum / size;
}

static double first_of_row(const assignment *a, int table, int row)
{
    return (double)a->table[table].pixels[(size_t)row * (size_t)a->def->size];
}

// The roughness below which pi alpha^4, the denominator of D at its peak, is less than 1e-4, where
// the framework clamps it.
static double clamp_reach(void)
{
    return pow(1e-4 / 3.14159265358979323846, 0.125);
}

static double mirror_average(kiln_g g)
{
    return kiln_energy_average(&(kiln_model){.g = g}, 0);
}

// ---------------------------------------------------------------------------------------- sections

static void write_files(const assignment *a, FILE *f)
{
    fputs("| picture | what it is | error map |\n|---|---|---|\n", f);
    for (int t = 0; t < ASSIGNMENT_TABLES; t++) {
        if (t == ASSIGNMENT_AVERAGE_BYTES)
            continue;
        fprintf(f, "| ![](%s.png)<br>`%s.png` | %s | ", assignment_names[t], assignment_names[t],
                assignment_words[t]);
        if (a->map[t].pixels)
            fprintf(f, "![](error_%s.png)<br>`error_%s.png` |\n", assignment_names[t],
                    assignment_names[t]);
        else
            fputs("|\n", f);
    }
    fputs("| ![](one_minus_Emu_IS.png)<br>`one_minus_Emu_IS.png` | 1 - E(mu) of Emu_IS with "
          "roughness 0 in the top row, as figure 3 of the assignment shows it | |\n\nIn each table "
          "the cosine mu = n.v grows from 0 at the left to 1 at the right, and the roughness from "
          "0 at the bottom to 1 at the top. Only one_minus_Emu_IS has roughness 0 at the top. "
          "Texel i of n has its centre at (i + 0.5) / n. A value x is stored as the byte "
          "(uint8)(255 x), which truncates instead of rounding. Values above 1, which noise "
          "causes, are stored as 255.\n\nIn the error maps blue means that the table is too dark, "
          "and red that it is too bright. The colours between the numbers of the scale below stand "
          "for errors between these numbers.\n\n![](error_legend.png)\n\n"
          "    -1   -0.1   -0.01  -0.001  +-0.0001  +0.001  +0.01   +0.1   +1\n\n",
          f);
}

static void write_errors(const assignment *a, FILE *f)
{
    fputs("## Errors\n\nThe errors are differences from the exact integral, over all texels, "
          "before values are truncated to bytes.\n\n"
          "| table | largest | rms | mean, signed |\n|---|---|---|---|\n",
          f);
    for (int t = 0; t < ASSIGNMENT_TABLES; t++)
        if (!assignment_is_exact(t))
            fprintf(f, "| %s: %s | %.2e | %.2e | %+.2e |\n", assignment_names[t],
                    assignment_words[t], a->difference[t].max, a->difference[t].rms,
                    a->difference[t].mean);
    fputs("\nTruncation to bytes subtracts up to 1/255 = 3.9e-3 more, and half of this on average. "
          "The assignment's framework computes E_avg from the picture of E(mu). Eavg_from_bytes is "
          "this E_avg.\n\n",
          f);
}

static void write_band(const assignment *a, FILE *f)
{
    static const double roughness[] = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5};
    fprintf(
        f,
        "## A clamp causes the dark band of figure 1\n\nFigure 1 is black at low roughness. The "
        "framework computes D with the denominator max(pi ((n.h)^2 (alpha^2 - 1) + 1)^2, 1e-4). At "
        "the peak of D, where n.h is 1, the first argument is pi alpha^4. It is below 1e-4 for "
        "every roughness below %.3f, so that the clamp at 1e-4 cuts off the peak of D and thereby "
        "reduces E.\n\nThe assignment names noise as the cause. But noise makes some texels too "
        "bright and others too dark. Without the clamp and with the same samples, the mean of a "
        "row stays near its exact value if some samples hit the lobe. With the clamp the mean is "
        "too dark. Below a roughness of about 0.1 few of the 1024 samples hit the lobe, and a few "
        "texels hold nearly all light. The table gives the mean of E over mu:\n\n"
        "| roughness | exact | unclamped | clamped |\n|---|---|---|---|\n",
        clamp_reach());
    for (size_t i = 0; i < sizeof roughness / sizeof *roughness; i++) {
        int row = row_of(a, roughness[i]);
        fprintf(f, "| %.4f | %.4f | %.4f | %.4f |\n", roughness_of(a, row),
                row_mean(a, ASSIGNMENT_EXACT, row), row_mean(a, ASSIGNMENT_MC_UNCLAMPED, row),
                row_mean(a, ASSIGNMENT_MC, row));
    }
    fputs(
        "\n`Eavg_MC.png` is black at these roughnesses too. A renderer that reads `Eavg_MC.png` "
        "assumes that smooth balls have lost nearly all their light, and adds the light again.\n\n",
        f);
}

static void write_contradictions(const assignment *a, FILE *f)
{
    bool text = a->def->g == KILN_G_SCHLICK_TEXT;
    fprintf(f,
            "## Contradictions in the assignment\n\n- **k.** The assignment's text has k = "
            "(roughness + 1)^2 / 8, but its framework and figures have k = roughness^2 / 2. The "
            "tables here have k = %s (`--g %s`). `kiln tables --assignment --g %s` makes tables "
            "with the other k. With the k of the text even a mirror shadows itself: E_avg at "
            "roughness 0 is %.3f, and Kulla and Conty's lobe would make a mirror glow with the "
            "missing %.3f. With the k of the figures, E_avg at roughness 0 is %.3f. Karis (2013) "
            "uses the k of the text for point lights only.\n",
            text ? "(roughness + 1)^2 / 8" : "roughness^2 / 2", kiln_g_names()[a->def->g],
            kiln_g_names()[text ? KILN_G_SCHLICK_K2 : KILN_G_SCHLICK_TEXT],
            mirror_average(KILN_G_SCHLICK_TEXT), 1 - mirror_average(KILN_G_SCHLICK_TEXT),
            mirror_average(KILN_G_SCHLICK_K2));
    fprintf(f,
            "- **D.** The denominator of D in the text, ((n.h)^2 ((alpha^2 - 1) + 1))^2, has a "
            "parenthesis in the wrong place: it equals (n.h)^4 alpha^4, which makes D no "
            "distribution. The tables here have the right denominator ((n.h)^2 (alpha^2 - 1) + "
            "1)^2.\n- **Figure 4.** The top row of figure 4, for roughness %.4f, has a value of "
            "about 0.2235. The exact E_avg is %.4f, and 2 mean(E mu), the formula of the text, "
            "gives %.4f with the samples used here.\n",
            roughness_of(a, 0), first_of_row(a, ASSIGNMENT_AVERAGE_EXACT, 0),
            first_of_row(a, ASSIGNMENT_AVERAGE, 0));
}

static void write_text(const assignment *a, FILE *f)
{
    fprintf(f,
            "# Tables for the Kulla-Conty lobe\n\nThis folder holds what section 2.2 of assignment "
            "4 of GAMES202 (2021), with its bonuses, asks for: the directional albedo E(mu) and "
            "its cosine-weighted average E_avg, for the GGX distribution and Schlick's masking G "
            "with k = %s. The tables have %d x %d texels and take %d samples for each texel. They "
            "are made by `kiln tables --assignment --g %s` of kiln %s.\n\n",
            a->def->g == KILN_G_SCHLICK_TEXT ? "(roughness + 1)^2 / 8" : "roughness^2 / 2",
            a->def->size, a->def->size, a->def->samples, kiln_g_names()[a->def->g], kiln_version());
    write_files(a, f);
    write_errors(a, f);
    write_band(a, f);
    write_contradictions(a, f);
    if (a->def->describe)
        a->def->describe(a, f);
}

int assignment_write_report(const assignment *a)
{
    char path[4400], part[4400];
    snprintf(path, sizeof path, "%s/report.md", a->def->folder);
    snprintf(part, sizeof part, "%s/.report.md.part", a->def->folder);
    errno = 0;
    FILE *f = os_create_file(part);
    bool failed = !f;
    if (f) {
        write_text(a, f);
        failed = ferror(f) != 0;
        failed = fclose(f) != 0 || failed;
        failed = failed || !os_replace(part, path);
    }
    if (!failed)
        return CLI_DONE;
    int reason = errno;
    if (f)
        os_remove_file(part);
    cli_clear_progress(a->work);
    return cli_fail("%s: cannot be written: %s", path, reason ? strerror(reason) : "no reason");
}

void assignment_print_json(const assignment *a)
{
    json j = {0};
    json_object(&j, NULL);
    json_text(&j, "kiln", kiln_version());
    json_text(&j, "output", a->def->folder);
    json_number(&j, "files", a->file_count);
    json_number(&j, "size", a->def->size);
    json_number(&j, "samples", a->def->samples);
    json_text(&j, "g", kiln_g_names()[a->def->g]);
    json_number(&j, "mirror_average", mirror_average(a->def->g));
    json_number(&j, "clamped_below_roughness", clamp_reach());
    json_array(&j, "tables");
    for (int t = 0; t < ASSIGNMENT_TABLES; t++) {
        json_object(&j, NULL);
        json_text(&j, "name", assignment_names[t]);
        json_text(&j, "what", assignment_words[t]);
        if (!assignment_is_exact(t)) {
            json_number(&j, "max", a->difference[t].max);
            json_number(&j, "rms", a->difference[t].rms);
            json_number(&j, "mean", a->difference[t].mean);
        }
        json_end(&j);
    }
    json_end(&j);
    json_number(&j, "seconds", cli_elapsed(a->work));
    json_end(&j);
}
