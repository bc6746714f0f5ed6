// kiln check. In: a panorama, and files that any tool made from it. Out: what is right and what is
// wrong with the files, as text or JSON. The exit code is 1 if a file is wrong.
#include "json.h"
#include "work.h"

#include <kiln/check.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FOR, TABLE, TOLERANCE, PICTURE, LAYER, NEGATIVE, JSON, QUIET, THREADS, OPTIONS };

typedef struct check_values {
    int engine, negative, threads;
    double tolerance;
    const char *picture, *layer;
    bool table, json, quiet;
} check_values;

#define AT(field) offsetof(check_values, field)

static const char *engine_word(int index)
{
    const kiln_engine *engine = kiln_engine_at(index);
    return engine ? engine->name : NULL;
}

static const cli_option options[OPTIONS + 1] = {
    [FOR] = {"for", CLI_CHOICE, AT(engine), .initial = -1, .value = "ENGINE", .word = engine_word,
             .help = "the engine that the files are for, whose axes and roughnesses they must have",
             .unset = "axes and roughnesses are found out"},
    [TABLE] = {"table", CLI_FLAG, AT(table),
               .help = "the files are tables of reflection models as textures or pictures (.ktx2, "
                       ".exr, .hdr or .png); no panorama is named"},
    [TOLERANCE] = {"tolerance", CLI_NUMBER, AT(tolerance), 0, 1, 0.01, "E",
                   .help = "largest relative root mean square error of a level for which the exit "
                           "code is 0; tuned levels are judged by what the engine shows"},
    [PICTURE] = {"picture", CLI_FILE, AT(picture), .value = "FILE.png",
                 .help =
                     "write a picture of the errors of the levels of one file: panoramas from the "
                     "first level down, blue where a level is too dark, red where it is too "
                     "bright, and full colours for three times its rms"},
    [LAYER] = CLI_LAYER_ROW(check_values),
    [NEGATIVE] = CLI_NEGATIVE_ROW(check_values),
    [JSON] = {"json", CLI_FLAG, AT(json),
              .help = "print an array with one JSON object for each file"},
    [QUIET] = CLI_QUIET_ROW(check_values),
    [THREADS] = CLI_THREADS_ROW(check_values),
};

// The work of the command: the panorama, and how files are judged.
typedef struct checker {
    cli_work *work;
    const check_values *values;
    const kiln_engine *engine;
    kiln_map panorama;
    json *json;
    int wrong;   ///< number of files that are wrong
    bool failed; ///< true: a file could not be read
    bool good;   ///< false: what was judged of the present file is wrong
} checker;

// ------------------------------------------------------------------------------------------ levels

static void print_findings(const kiln_findings *findings)
{
    for (int i = 0; i < findings->count; i++)
        printf("  %-5s  %s\n", findings->finding[i].fault ? "WRONG" : "note",
               findings->finding[i].text);
}

static void print_levels(const kiln_check_levels_report *report)
{
    printf("  level  size  roughness  like     rms   largest      bias   energy    seam\n");
    for (int k = 0; k < report->level_count; k++) {
        const kiln_check_level *l = &report->level[k];
        char found[16] = "-";
        if (l->found >= 0)
            snprintf(found, sizeof found, "%.3f", l->found);
        printf("  %5d %5d %10.4f %5s %6.3g %% %6.3g %% %+6.2g %% %8.4f %5.2g %%\n", k, l->size,
               l->roughness, found, 100 * l->rms, 100 * l->largest, 100 * l->bias, l->energy,
               100 * l->seam);
    }
}

static void print_findings_json(json *j, const kiln_findings *findings)
{
    json_array(j, "findings");
    for (int i = 0; i < findings->count; i++) {
        json_object(j, NULL);
        json_bool(j, "fault", findings->finding[i].fault);
        json_text(j, "text", findings->finding[i].text);
        json_end(j);
    }
    json_end(j);
}

static void print_levels_json(json *j, const kiln_check_levels_report *report)
{
    json_rounded(j, "worst", report->worst, 6);
    json_rounded(j, "brightness", report->brightness, 6);
    json_array(j, "levels");
    for (int k = 0; k < report->level_count; k++) {
        const kiln_check_level *l = &report->level[k];
        json_object(j, NULL);
        json_number(j, "size", l->size);
        json_rounded(j, "roughness", l->roughness, 9);
        json_rounded(j, "found_roughness", l->found, 4);
        json_rounded(j, "rms", l->rms, 6);
        json_rounded(j, "largest", l->largest, 6);
        json_rounded(j, "bias", l->bias, 6);
        json_rounded(j, "energy", l->energy, 9);
        json_rounded(j, "seam", l->seam, 6);
        json_number(j, "fireflies", (double)l->firefly_count);
        json_number(j, "negative", (double)l->negative_count);
        json_rounded(j, "proof", l->proof, 3);
        json_number(j, "proof_texels", l->proof_count);
        json_end(j);
    }
    json_end(j);
}

static void print_shown_json(json *j, const kiln_engine *engine,
                             const kiln_check_shown_report *shown)
{
    if (!shown->direction_count)
        return;
    json_object(j, "shown");
    json_text(j, "engine", engine->name);
    json_rounded(j, "all", shown->all, 6);
    json_rounded(j, "worst", shown->worst, 6);
    json_rounded(j, "displayed", shown->displayed, 6);
    json_rounded(j, "exact_all", shown->exact_all, 6);
    json_rounded(j, "exact_displayed", shown->exact_displayed, 6);
    json_array(j, "rms");
    for (int i = 0; i < KILN_SHOWN; i++)
        json_rounded(j, NULL, shown->rms[i], 6);
    json_end(j);
    json_end(j);
}

// Adds to the findings what the loader had to replace.
static void add_replaced(const kiln_load_report *loaded, kiln_findings *findings)
{
    size_t count = loaded->infinite_count + loaded->nan_count;
    if (!count || findings->count >= KILN_MAX_FINDINGS)
        return;
    kiln_finding *finding = &findings->finding[findings->count++];
    *finding = (kiln_finding){.kind = KILN_FINDING_NEGATIVE, .fault = true};
    findings->fault_count++;
    snprintf(finding->text, sizeof finding->text, "%zu texels are infinite or not a number", count);
}

// Returns whether no fault was found and an error is within the tolerance.
static bool within(const checker *c, const kiln_findings *findings, double error)
{
    return !findings->fault_count && error <= c->values->tolerance;
}

// Counts a report as good or not, and opens its object in JSON. Returns whether the report is good.
static bool judge(checker *c, const char *kind, bool good)
{
    c->good &= good;
    cli_clear_progress(c->work);
    if (c->json) {
        json_object(c->json, kind);
        json_bool(c->json, "right", good);
    }
    return good;
}

static void print_levels_report(checker *c, const char *path,
                                const kiln_check_levels_report *report,
                                const kiln_check_shown_report *shown)
{
    bool good = judge(c, "levels", kiln_check_right(report, shown, c->values->tolerance));
    if (c->json) {
        print_levels_json(c->json, report);
        print_shown_json(c->json, report->engine, shown);
        print_findings_json(c->json, &report->findings);
        json_end(c->json);
        return;
    }
    if (c->values->quiet)
        return;
    bool tuned = good && report->worst > c->values->tolerance;
    if (tuned)
        printf("%s: right, tuned for %s\n", cli_show(path).text, report->engine->name);
    else
        printf("%s: %s, the largest error of a level is %.3g %%\n", cli_show(path).text,
               good ? "right" : "WRONG", 100 * report->worst);
    print_levels(report);
    if (shown->direction_count) {
        printf("  %s shows it with an error of %.3g %% over 19 roughnesses from 0.1 to 1, at most "
               "%.3g %% at roughness %.2f, and exact levels with %.3g %%\n",
               report->engine->name, 100 * shown->all, 100 * shown->worst, shown->worst_roughness,
               100 * shown->exact_all);
        printf("  as values x / (x + mean) of a display, it errs by %.3g %% of white, and exact "
               "levels by "
               "%.3g %%\n",
               100 * shown->displayed, 100 * shown->exact_displayed);
    }
    print_findings(&report->findings);
    if (tuned)
        printf("  note   the levels are not exact, and right because %s shows less error with "
               "them than with exact ones\n",
               report->engine->name);
    else if (!good && !report->findings.fault_count && shown->direction_count)
        printf(
            "  note   no fault was found; if the levels are tuned for %s, they differ from exact "
            "ones on purpose, and the %d directions of this check do not show their use\n",
            report->engine->name, shown->direction_count);
}

static kiln_result save_picture(kiln_context *context, const kiln_map *difference, const char *path,
                                kiln_error *error)
{
    kiln_image picture;
    kiln_result result = kiln_check_picture(context, difference, &picture, error);
    if (result == KILN_OK)
        result = kiln_image_save(context, &picture, path, error);
    kiln_image_free(&picture);
    return result;
}

// Checks levels for an engine, which is NULL for levels of any kind.
static int check_levels(checker *c, const char *path, const kiln_engine *engine)
{
    kiln_map levels = {0}, difference = {0};
    kiln_check_shown_report shown = {.direction_count = 0};
    kiln_load_report loaded;
    kiln_check_levels_report report;
    kiln_context *context = c->work->context;
    kiln_check_levels_def def = {.engine = engine};
    kiln_result result = kiln_levels_load(context, path, engine, &loaded, &levels, &c->work->error);
    if (result == KILN_OK) {
        def.stated = !def.engine && levels.roughness[0] >= 0;
        result = kiln_check_levels(context, &c->panorama, &levels, &def, &report, &difference,
                                   &c->work->error);
    }
    // Without --for, what an engine shows matters only where it decides whether the file is right.
    bool shows = result == KILN_OK && levels.shape == KILN_SHAPE_CUBE && report.engine &&
                 kiln_engine_level(report.engine, 0.5, levels.size, levels.level_count) >= 0;
    bool undecided =
        result == KILN_OK && !report.findings.fault_count && report.worst > c->values->tolerance;
    if (shows && (engine || undecided))
        result = kiln_check_shown(context, &c->panorama, &levels, report.engine, &shown,
                                  &c->work->error);
    if (result == KILN_OK && c->values->picture)
        result = save_picture(context, &difference, c->values->picture, &c->work->error);
    if (result == KILN_OK) {
        add_replaced(&loaded, &report.findings);
        print_levels_report(c, path, &report, &shown);
    }
    kiln_map_free(&difference);
    kiln_map_free(&levels);
    return result == KILN_OK ? CLI_DONE : CLI_FAILED;
}

// --------------------------------------------------------------------------------------- harmonics

static void print_bands(const checker *c, const kiln_check_sh_report *report)
{
    if (!c->json)
        printf("  factor of each band:");
    else
        json_array(c->json, "bands");
    for (int l = 0; l < report->bands; l++)
        if (c->json)
            json_rounded(c->json, NULL, report->band[l], 6);
        else
            printf(" %.4f", report->band[l]);
    if (c->json)
        json_end(c->json);
    else
        putchar('\n');
}

static int check_harmonics(checker *c, const char *path, const kiln_file_info *info,
                           const kiln_engine *engine)
{
    kiln_check_sh_report report;
    kiln_sh sh = {.bands = info->sh_bands, .irradiance = info->sh_irradiance};
    for (int i = 0; i < sh.bands * sh.bands; i++)
        for (int k = 0; k < 3; k++)
            sh.c[i][k] = (double)info->sh[i][k];
    if (kiln_check_sh(c->work->context, &c->panorama, &sh, engine, &report, &c->work->error))
        return CLI_FAILED;
    bool good = judge(c, "harmonics", within(c, &report.findings, report.rms));
    if (c->json)
        json_rounded(c->json, "rms", report.rms, 6);
    else if (!c->values->quiet)
        printf("%s: %s, %d bands of harmonics with an error of %.3g %%\n", cli_show(path).text,
               good ? "right" : "WRONG", report.bands, 100 * report.rms);
    if (c->json || !c->values->quiet)
        print_bands(c, &report);
    if (c->json) {
        print_findings_json(c->json, &report.findings);
        json_end(c->json);
    } else if (!c->values->quiet) {
        print_findings(&report.findings);
    }
    return CLI_DONE;
}

// ------------------------------------------------------------------------------------------ tables

static int check_table(checker *c, const char *path)
{
    kiln_image image = {0};
    kiln_check_table_report report;
    bool flip;
    kiln_context *context = c->work->context;
    kiln_result result = kiln_table_numbers_load(context, path, &image, &flip, &c->work->error);
    if (result == KILN_OK)
        result = kiln_check_table(context, &image, flip, &report, &c->work->error);
    if (result == KILN_OK) {
        bool good = judge(c, "table", within(c, &report.findings, report.rms));
        if (c->json) {
            json_rounded(c->json, "rms", report.rms, 6);
            json_rounded(c->json, "largest", report.largest, 6);
            print_findings_json(c->json, &report.findings);
            json_end(c->json);
        } else if (!c->values->quiet) {
            printf("%s: %s, %d x %d texels with a root mean square error of %.3g, at most %.3g\n",
                   cli_show(path).text, good ? "right" : "WRONG", image.width, image.height,
                   report.rms, report.largest);
            print_findings(&report.findings);
        }
    }
    kiln_image_free(&image);
    return result == KILN_OK ? CLI_DONE : CLI_FAILED;
}

// ------------------------------------------------------------------------------------------- files

// Checks what a file holds: levels, harmonics, or both.
static int check_content(checker *c, const char *path)
{
    kiln_file_info info = {0};
    if (c->values->table)
        return check_table(c, path);
    bool one_file = !strchr(path, '{') && !strchr(path, '%') && !cli_ends_in(path, "/");
    if (one_file && kiln_file_describe(c->work->context, path, &info, &c->work->error))
        return CLI_FAILED;
    // Files that state their engine are for that engine.
    const kiln_engine *engine = c->engine ? c->engine : kiln_engine_find(info.engine);
    int code = strcmp(info.layout, "harmonics") != 0 ? check_levels(c, path, engine) : CLI_DONE;
    if (code == CLI_DONE && info.sh_bands)
        code = check_harmonics(c, path, &info, engine);
    return code;
}

static int check_file(checker *c, const char *path)
{
    if (c->json) {
        json_object(c->json, NULL);
        json_text(c->json, "path", path);
    }
    c->good = true;
    int code = check_content(c, path);
    c->wrong += !c->good;
    if (code == CLI_FAILED && c->json) {
        json_text(c->json, "error", c->work->error.message);
    }
    if (c->json)
        json_end(c->json);
    if (code == CLI_FAILED && !cli_interrupted()) {
        cli_clear_progress(c->work);
        cli_fail("%s", c->work->error.message);
        c->work->error.message[0] = 0; // keeps cli_end_work from printing the message again
        c->failed = true;
    }
    return code;
}

// Returns the first of the files to check that is a panorama, if the file that is named in the place of
// the panorama has mip levels: the two were named in the wrong order. Returns NULL otherwise.
static const char *find_swapped(const cli_arguments *a, cli_work *work, int *level_count)
{
    kiln_file_info info;
    // Standard input can be read once only, by the check itself.
    for (int i = 0; i < a->rest_count; i++)
        if (strcmp(a->rest[i], "-") == 0)
            return NULL;
    if (kiln_file_describe(work->context, a->rest[0], &info, NULL) != KILN_OK ||
        info.level_count < 2)
        return NULL;
    *level_count = info.level_count;
    for (int i = 1; i < a->rest_count; i++)
        if (kiln_file_describe(work->context, a->rest[i], &info, NULL) == KILN_OK &&
            info.level_count == 1 && strcmp(info.layout, "panorama") == 0)
            return a->rest[i];
    return NULL;
}

static int check_files(const cli_arguments *a, const check_values *v, cli_work *work)
{
    json j = {0};
    checker c = {.work = work, .values = v, .json = v->json ? &j : NULL};
    const kiln_load_def load = {.negative = (kiln_negative)v->negative, .layer = v->layer};
    c.engine = v->engine >= 0 ? kiln_engine_at(v->engine) : NULL;
    int level_count;
    const char *panorama = v->table ? NULL : find_swapped(a, work, &level_count);
    if (panorama)
        return cli_wrong(&cli_check,
                         "%s has %d levels, and %s is a panorama: name the panorama first",
                         a->rest[0], level_count, panorama);
    int code = v->table ? CLI_GO : cli_load(work, a->rest, 1, &load, &c.panorama);
    if (code != CLI_GO)
        return code;
    if (c.json)
        json_array(c.json, NULL);
    for (int i = !v->table; i < a->rest_count && !cli_interrupted(); i++)
        check_file(&c, a->rest[i]);
    if (c.json)
        json_end(c.json);
    kiln_map_free(&c.panorama);
    int count = a->rest_count - !v->table;
    if (c.wrong && !cli_interrupted())
        cli_fail("%d of %d file%s %s wrong", c.wrong, count, count == 1 ? "" : "s",
                 c.wrong == 1 ? "is" : "are");
    return c.wrong || c.failed || cli_interrupted() ? CLI_FAILED : CLI_DONE;
}

static int run(const cli_call *call)
{
    cli_arguments a;
    cli_work work;
    check_values values;
    int code = cli_read_arguments(&a, &cli_check, call, &values);
    if (code != CLI_GO)
        return code;
    if (values.table && !a.rest_count)
        return cli_wrong(&cli_check, "no table is named, name the tables to check");
    if (values.table && (values.engine >= 0 || values.picture))
        return cli_wrong(&cli_check, "--table takes neither --for nor --picture");
    if (values.picture && !cli_ends_in(values.picture, "png"))
        return cli_wrong(&cli_check, "--picture %s: must end in .png", values.picture);
    if (values.picture && a.rest_count > 2)
        return cli_wrong(&cli_check, "--picture takes one file to check, %d are named",
                         a.rest_count - 1);
    if (a.rest_count < 2 && !values.table)
        return cli_wrong(&cli_check, "%s, name the panorama and then the files to check",
                         a.rest_count ? "no file to check is named" : "no input is named");
    if (values.picture && cli_check_folder(values.picture) != CLI_GO)
        return CLI_FAILED;
    code = cli_begin_work(&work, values.threads, values.quiet);
    if (code == CLI_GO)
        code = check_files(&a, &values, &work);
    return cli_end_work(&work, code);
}

static const cli_example examples[] = {
    {"kiln check city.exr city.ktx2", "compares the levels of a file with exact ones"},
    {"kiln check city.exr cmgen/city/", "the same for the faces that Filament's cmgen wrote"},
    {"kiln check city.exr city.ktx2 --for three --tolerance 0.001",
     "fails unless the file has three.js's axes and is within 0.1 % or tuned"},
    {"kiln check --table dfg.png", "says what a table holds and what is wrong with it"},
    {NULL, NULL}};

const cli_command cli_check = {
    .name = "check",
    .arguments = "PANORAMA FILE... [OPTION...]|--table FILE... [OPTION...]",
    .summary = "Says whether files that any tool baked from a panorama are right.",
    .about =
        "For levels kiln finds the axes and the roughness of each level, computes the exact "
        "levels, "
        "and prints the errors of each level: relative root mean square, largest, mean and at the "
        "edges of faces. Faults that kiln recognises are said in words, such as a mirrored "
        "environment or levels of the wrong roughness. The exit code is 1 if a fault was found or "
        "an error is above --tolerance, but for levels that are tuned for an engine, which "
        "are right if the engine shows less error with them than with exact levels.",
    .examples = examples,
    .options = options,
    .run = run,
};
