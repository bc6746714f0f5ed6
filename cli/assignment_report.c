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

// ----------------------------------------------------------------------------------------- sections

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
    fputs("| ![](one_minus_Emu_IS.png)<br>`one_minus_Emu_IS.png` | 1 - E(mu) of Emu_IS, the top "
          "row is roughness 0: figure 3 | |\n\n"
          "mu = n.v runs from 0 at the left to 1 at the right, roughness from 0 at the bottom to 1 "
          "at the top (but for figure 3), texel centres at (i + 0.5) / size. Bytes are (uint8)(255 "
          "x), cut and not rounded; where noise exceeds 1 they stay at 255.\n\n"
          "Colours of the error maps, a decade from one quarter of each half to the next: blue "
          "where the table is too dark, red where it is too bright.\n\n"
          "![](error_legend.png)\n\n"
          "    -1   -0.1   -0.01  -0.001  +-0.0001  +0.001  +0.01   +0.1   +1\n\n",
          f);
}

static void write_errors(const assignment *a, FILE *f)
{
    fputs("## Errors\n\nAgainst the exact integral, over all texels, before the cut to bytes.\n\n"
          "| table | largest | rms | mean, signed |\n|---|---|---|---|\n",
          f);
    for (int t = 0; t < ASSIGNMENT_TABLES; t++)
        if (!assignment_is_exact(t))
            fprintf(f, "| %s: %s | %.2e | %.2e | %+.2e |\n", assignment_names[t],
                    assignment_words[t], a->difference[t].max, a->difference[t].rms,
                    a->difference[t].mean);
    fputs("\nThe cut to bytes takes off up to 1/255 = 3.9e-3 more, half of that on average. The "
          "framework reads the picture to compute E_avg, which is Eavg_from_bytes.\n\n",
          f);
}

static void write_band(const assignment *a, FILE *f)
{
    static const double roughness[] = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5};
    fprintf(
        f,
        "## The dark band of figure 1 is the clamp's\n\n"
        "The framework divides by max(pi ((n.h)^2 (alpha^2 - 1) + 1)^2, 1e-4). At the peak of D "
        "that is pi alpha^4, which is below 1e-4 for every roughness below %.3f: there the peak, "
        "and with it E, is cut off. The assignment blames the noise. But noise errs both ways: "
        "with the same samples and D as it is, the means of the rows stay near the exact ones "
        "as long as some samples hit the lobe, while the clamp takes their light away. "
        "(Below roughness 0.1 or so 1024 samples seldom hit it at all: a few texels hold it "
        "all.) Means over mu:\n\n"
        "| roughness | exact | unclamped | clamped |\n|---|---|---|---|\n",
        clamp_reach());
    for (size_t i = 0; i < sizeof roughness / sizeof *roughness; i++) {
        int row = row_of(a, roughness[i]);
        fprintf(f, "| %.4f | %.4f | %.4f | %.4f |\n", roughness_of(a, row),
                row_mean(a, ASSIGNMENT_EXACT, row), row_mean(a, ASSIGNMENT_MC_UNCLAMPED, row),
                row_mean(a, ASSIGNMENT_MC, row));
    }
    fputs("\n`Eavg_MC.png` is black there too: a renderer that reads it takes smooth balls to have "
          "lost nearly all of their light, and adds it.\n\n",
          f);
}

static void write_contradictions(const assignment *a, FILE *f)
{
    bool text = a->def->g == KILN_G_SCHLICK_TEXT;
    fprintf(f,
            "## Where the assignment contradicts itself\n\n"
            "- **k.** Its text has k = (roughness + 1)^2 / 8; its framework and figures have k = "
            "roughness^2 / 2. These tables have k = %s (`--g %s`); `--g %s` makes the other. "
            "With the text's k even a mirror shadows itself: E_avg at roughness 0 is %.3f, so that "
            "Kulla and Conty's lobe would make it glow with the missing %.3f. With the figures' "
            "it is %.3f. The text's k is meant for point lights.\n",
            text ? "(roughness + 1)^2 / 8" : "roughness^2 / 2", kiln_g_names()[a->def->g],
            kiln_g_names()[text ? KILN_G_SCHLICK_K2 : KILN_G_SCHLICK_TEXT],
            mirror_average(KILN_G_SCHLICK_TEXT), 1 - mirror_average(KILN_G_SCHLICK_TEXT),
            mirror_average(KILN_G_SCHLICK_K2));
    fprintf(
        f,
        "- **D.** The text's denominator, ((n.h)^2 ((alpha^2 - 1) + 1))^2, has a parenthesis in "
        "the wrong place: that is (n.h)^4 alpha^4, no distribution at all. Meant, and used "
        "here, is ((n.h)^2 (alpha^2 - 1) + 1)^2.\n"
        "- **Figure 4.** Its top row, roughness %.4f, reads about 0.2235. The exact value is "
        "%.4f, and the recipe of the text, 2 mean(E mu), gives %.4f from our samples.\n",
        roughness_of(a, 0), first_of_row(a, ASSIGNMENT_AVERAGE_EXACT, 0),
        first_of_row(a, ASSIGNMENT_AVERAGE, 0));
}

static void write_text(const assignment *a, FILE *f)
{
    fprintf(f,
            "# Kulla-Conty, precomputed\n\n"
            "GAMES202 (2021), assignment 4, section 2.2 with its bonuses: E(mu) and E_avg of GGX "
            "with Schlick's G, k = %s. %d x %d texels, %d samples each. Made by `kiln tables "
            "--assignment --g %s`, kiln %s.\n\n",
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
