// Makes the GAMES202 assignment's tables and pictures. In: an output folder, size, sample count and
// the shadowing G. Out: PNG files and report.md. Tables are computed by the assignment's methods
// (kiln/course.h) and by exact integration, then compared, and all files are written at the end.
#include "assignment.h"
#include "os.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// The table of E that each table of E_avg is the average of.
static const int source_of[ASSIGNMENT_TABLES] = {
    [ASSIGNMENT_AVERAGE_MC] = ASSIGNMENT_MC,
    [ASSIGNMENT_AVERAGE] = ASSIGNMENT_IS,
    [ASSIGNMENT_AVERAGE_BYTES] = ASSIGNMENT_IS,
};

int assignment_check_folder(const cli_command *command, const char *folder)
{
    if (!folder[0])
        return cli_wrong(command, "--output is empty, it must name a folder");
    os_kind kind = os_kind_of(folder);
    if (kind == OS_UNREACHABLE)
        return cli_fail("%s: %s", folder, strerror(errno));
    if (kind == OS_FILE)
        return cli_fail("%s: is a file, name a folder for the assignment's pictures", folder);
    if (kind == OS_FOLDER)
        return os_is_writable(folder)
                   ? CLI_GO
                   : cli_fail("%s: kiln is not allowed to write into this folder", folder);
    // The path without a final slash, for which os_kind_of says whether the folder itself exists.
    char path[4096];
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    if (length >= sizeof path)
        return cli_fail("%.60s...: the path is too long, choose a shorter one", folder);
    memcpy(path, folder, length);
    path[length] = 0;
    return cli_check_folder(path);
}

// --------------------------------------------------------------------------------------- computing

static kiln_result compute_energies(assignment *a)
{
    static const struct {
        int table;
        kiln_assignment_method method;
        bool unclamped;
    } methods[] = {{ASSIGNMENT_MC, KILN_ASSIGNMENT_MONTE_CARLO, false},
                   {ASSIGNMENT_MC_UNCLAMPED, KILN_ASSIGNMENT_MONTE_CARLO, true},
                   {ASSIGNMENT_IS, KILN_ASSIGNMENT_IMPORTANCE, false},
                   {ASSIGNMENT_SPLIT_SUM, KILN_ASSIGNMENT_SPLIT_SUM, false}};
    kiln_result result = KILN_OK;
    for (size_t i = 0; i < sizeof methods / sizeof *methods && !result; i++) {
        kiln_assignment_def def = {.size = a->def->size,
                                   .sample_count = a->def->samples,
                                   .g = a->def->g == KILN_G_SCHLICK_TEXT
                                            ? KILN_ASSIGNMENT_G_TEXT
                                            : KILN_ASSIGNMENT_G_FIGURES,
                                   .unclamped = methods[i].unclamped};
        result = kiln_assignment_energy(a->work->context, methods[i].method, &def,
                                        &a->table[methods[i].table], &a->work->error);
    }
    return result;
}

// Computes E_avg from a table of E; with `bytes`, from the 8-bit values that the PNG of E holds.
static kiln_result compute_average(assignment *a, int table, bool bytes)
{
    const kiln_image *source = &a->table[source_of[table]];
    kiln_image energy = {0};
    kiln_result result = kiln_image_create(a->work->context, source->width, source->height, 1,
                                           &energy, &a->work->error);
    if (!result) {
        memcpy(energy.pixels, source->pixels,
               (size_t)source->width * (size_t)source->height * sizeof *energy.pixels);
        if (bytes)
            kiln_assignment_truncate(&energy);
        result =
            kiln_assignment_average(a->work->context, &energy, &a->table[table], &a->work->error);
    }
    kiln_image_free(&energy);
    return result;
}

// Integrates E and E_avg exactly, for the model and at the texel centres of the assignment's
// tables.
static kiln_result compute_exact(assignment *a)
{
    int size = a->def->size;
    kiln_table_def def = {.model = {.g = a->def->g}, .width = size, .height = size, .flip = true};
    kiln_table energy = {0}, average = {0};
    kiln_result result = kiln_table_create(a->work->context, &def, &energy, &a->work->error);
    a->table[ASSIGNMENT_EXACT] = energy.image;
    def.kind = KILN_TABLE_E_AVERAGE;
    if (!result)
        result = kiln_table_create(a->work->context, &def, &average, &a->work->error);
    kiln_image *wide = &a->table[ASSIGNMENT_AVERAGE_EXACT];
    if (!result)
        result = kiln_image_create(a->work->context, size, size, 1, wide, &a->work->error);
    for (int i = 0; i < size * size && !result; i++)
        wide->pixels[i] = average.image.pixels[i / size];
    kiln_table_free(&average);
    return result;
}

static kiln_result compute(assignment *a)
{
    kiln_result result = compute_exact(a);
    if (!result)
        result = compute_energies(a);
    for (int t = ASSIGNMENT_AVERAGE_MC; t <= ASSIGNMENT_AVERAGE_BYTES && !result; t++)
        result = compute_average(a, t, t == ASSIGNMENT_AVERAGE_BYTES);
    for (int t = 0; t < ASSIGNMENT_TABLES && !result; t++) {
        int exact = t <= ASSIGNMENT_EXACT ? ASSIGNMENT_EXACT : ASSIGNMENT_AVERAGE_EXACT;
        bool mapped = t != exact && t != ASSIGNMENT_AVERAGE_BYTES;
        result =
            kiln_assignment_compare(a->work->context, &a->table[t], &a->table[exact],
                                    &a->difference[t], mapped ? &a->map[t] : NULL, &a->work->error);
    }
    return result;
}

// ----------------------------------------------------------------------------------------- writing

kiln_result assignment_save(assignment *a, const kiln_image *image, const char *before,
                            const char *name)
{
    char path[4400];
    snprintf(path, sizeof path, "%s/%s%s.png", a->def->folder, before, name);
    a->file_count++;
    return kiln_image_save(a->work->context, image, path, &a->work->error);
}

// Writes a table as the GAMES202 assignment's framework does: three equal channels of (uint8)(255
// x). With `figure3` the picture shows 1 - E with roughness 0 in the top row, as in the handout's
// figure 3.
static kiln_result save_table(assignment *a, const kiln_image *table, const char *name,
                              bool figure3)
{
    kiln_image rgb = {0};
    kiln_result result =
        kiln_image_create(a->work->context, table->width, table->height, 3, &rgb, &a->work->error);
    if (!result) {
        size_t width = (size_t)table->width, height = (size_t)table->height;
        for (size_t y = 0; y < height; y++)
            for (size_t i = 0; i < 3 * width; i++) {
                float e = table->pixels[(figure3 ? height - 1 - y : y) * width + i / 3];
                rgb.pixels[3 * y * width + i] = figure3 ? 1 - e : e;
            }
        kiln_assignment_truncate(&rgb);
        result = assignment_save(a, &rgb, "", name);
    }
    kiln_image_free(&rgb);
    return result;
}

// Writes the colour scale of the error maps: errors from -1 at the left to 1 at the right, with a
// logarithmic magnitude from 1e-4 at the centre.
static kiln_result save_legend(assignment *a)
{
    enum { HALF = 160, HEIGHT = 20 };
    kiln_image off = {0}, none = {0}, map = {0};
    kiln_difference difference;
    kiln_error *error = &a->work->error;
    kiln_context *context = a->work->context;
    kiln_result result = kiln_image_create(context, 2 * HALF, HEIGHT, 1, &off, error);
    if (!result)
        result = kiln_image_create(context, 2 * HALF, HEIGHT, 1, &none, error);
    for (int i = 0; i < 2 * HALF * HEIGHT && !result; i++) {
        double x = (i % (2 * HALF) + 0.5) / HALF - 1;
        off.pixels[i] = (float)(copysign(1e-4, x) * pow(10, 4 * fabs(x)));
    }
    if (!result)
        result = kiln_assignment_compare(context, &off, &none, &difference, &map, error);
    if (!result)
        result = assignment_save(a, &map, "", "error_legend");
    kiln_image_free(&map);
    kiln_image_free(&none);
    kiln_image_free(&off);
    return result;
}

static kiln_result write_pictures(assignment *a)
{
    kiln_result result = KILN_OK;
    for (int t = 0; t < ASSIGNMENT_TABLES && !result; t++) {
        // this table differs from Eavg by one byte at most, so it appears in the report only
        if (t != ASSIGNMENT_AVERAGE_BYTES)
            result = save_table(a, &a->table[t], assignment_names[t], false);
        if (!result && a->map[t].pixels)
            result = assignment_save(a, &a->map[t], "error_", assignment_names[t]);
    }
    if (!result)
        result = save_table(a, &a->table[ASSIGNMENT_IS], "one_minus_Emu_IS", true);
    return result ? result : save_legend(a);
}

static void print_figures(const assignment *a)
{
    printf("%s: %d files, %d x %d, %d samples, %s, %.2f s\n", cli_show(a->def->folder).text,
           a->file_count, a->def->size, a->def->size, a->def->samples, kiln_g_names()[a->def->g],
           cli_elapsed(a->work));
    printf("  %-17s %9s %9s %10s\n", "error of", "largest", "rms", "mean");
    for (int t = 0; t < ASSIGNMENT_TABLES; t++)
        if (!assignment_is_exact(t))
            printf("  %-17s %9.2e %9.2e %+10.2e\n", assignment_names[t], a->difference[t].max,
                   a->difference[t].rms, a->difference[t].mean);
}

int assignment_write(cli_work *work, const assignment_def *def)
{
    assignment a = {.work = work, .def = def};
    int code = CLI_FAILED;
    bool made = false;
    if (compute(&a))
        goto done;
    made = os_make_folder(def->folder);
    if (!made && errno != EEXIST) {
        cli_clear_progress(work);
        code = cli_fail("%s: the folder cannot be created: %s", def->folder, strerror(errno));
        goto done;
    }
    if (!write_pictures(&a) && (!def->draw || !def->draw(&a))) {
        a.file_count++;
        code = assignment_write_report(&a);
    }
    cli_clear_progress(work);
    if (code == CLI_DONE && def->json)
        assignment_print_json(&a);
    else if (code == CLI_DONE && !def->quiet)
        print_figures(&a);
    if (code != CLI_DONE && made)
        // removes the folder if it is empty, and leaves it if it already holds a picture
        os_remove_folder(def->folder);
done:
    for (int t = 0; t < ASSIGNMENT_TABLES; t++) {
        kiln_image_free(&a.table[t]);
        kiln_image_free(&a.map[t]);
    }
    return code;
}
