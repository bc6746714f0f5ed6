// Inside a program whose locale has another decimal mark, "," or U+066B, kiln writes the same
// bytes, reads the same numbers and says the same sentences. The locales are made by localedef,
// which belongs to the C library.
#include <locale.h>
#include <sys/stat.h>

#include <kiln/brdf.h>

#include "kit/context.h"

enum { MOST = 400 };

static char home[64];

// Makes a locale NAME in the folder of this test whose decimal mark is the UTF-8 bytes `mark`, a
// character of the map below.
static void make_locale(const char *name, const char *code)
{
    static const char map[] = "<code_set_name> TINY\n<comment_char> %\n<escape_char> /\n"
                              "<mb_cur_min> 1\n<mb_cur_max> 6\nCHARMAP\n<U0020>..<U007E> /x20\n"
                              "<U066B> /xd9/xab\nEND CHARMAP\n";
    char source[256], command[512];
    snprintf(source, sizeof source,
             "comment_char %%\nescape_char /\nLC_NUMERIC\ndecimal_point \"<%s>\"\n"
             "thousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n",
             code);
    write_file(in_folder("map"), map, strlen(map));
    write_file(in_folder("source"), source, strlen(source));
    // The other categories are missing, of which localedef warns; a file LC_NUMERIC is enough.
    snprintf(
        command, sizeof command,
        "PATH=\"$PATH:/usr/sbin:/sbin\" localedef -c -i %s/source -f %s/map %s/%s >%s/said 2>&1",
        home, home, home, name, home);
    (void)!system(command);
    char path[128];
    size_t size;
    snprintf(path, sizeof path, "%s/%s/LC_NUMERIC", home, name);
    free(read_file(path, &size));
}

// Saves one file of each kind that holds numbers as text, and one of each kind that does not.
static void save_all(const char *folder)
{
    kiln_environment made = make_sky_bake(context);
    char path[256], sh[256];
    static const char *const harmonics[] = {"sh.json", "sh.txt", "sh.h"};
    for (size_t i = 0; i < sizeof harmonics / sizeof *harmonics; i++) {
        snprintf(path, sizeof path, "%s/levels%zu.ktx2", folder, i);
        snprintf(sh, sizeof sh, "%s/%s", folder, harmonics[i]);
        kiln_environment_save_def def = {.sh_path = sh};
        CHECK_OK(kiln_environment_save(context, &made, path, &def, NULL, &error));
    }
    static const char *const maps[] = {"six.exr", "six.hdr", "cube.dds"};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, maps[i]);
        CHECK_OK(kiln_map_save(context, &made.levels, path, NULL, NULL, &error));
    }
    for (int i = 0; kiln_engine_at(i); i++) {
        const kiln_engine *engine = kiln_engine_at(i);
        if (!engine_is_written(engine))
            continue;
        kiln_map source;
        kiln_environment own;
        kiln_bake_def bake = {.engine = engine, .tune = KILN_TUNE_NONE, .irradiance_size = 4};
        float roughness[KILN_MAX_LEVELS];
        kiln_prefilter_def levels;
        if (kiln_engine_levels(engine, 64, 0, roughness, &levels, &error) == KILN_OK)
            bake.levels.size = 64;
        CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 16, 1, &source, &error));
        fill_noise(&source, 7, 0, 10);
        CHECK_OK(kiln_bake(context, &source, &bake, &own, &error));
        snprintf(path, sizeof path, "%s/%s%s%s", folder, engine->name, engine->ending[0] ? "." : "",
                 engine->ending);
        kiln_environment_save_def def = {.engine = engine};
        CHECK_OK(kiln_environment_save(context, &own, path, &def, NULL, &error));
        kiln_environment_free(&own);
        kiln_map_free(&source);
    }
    kiln_environment_free(&made);
    kiln_table table;
    kiln_table_def small = {.width = 8, .height = 8};
    CHECK_OK(kiln_table_create(context, &small, &table, &error));
    static const char *const tables[] = {"t.h", "t.glsl", "t.inc", "t.ktx2", "t.exr"};
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, tables[i]);
        CHECK_OK(kiln_table_save(context, &table, path, NULL, &error));
    }
    snprintf(path, sizeof path, "%s/t_lookup.glsl", folder);
    CHECK_OK(kiln_table_lookup_save(context, &table.def, path, "t", &error));
    kiln_table_free(&table);
    kiln_fit fit;
    kiln_fit_def loose = {.error = 0.05, .max_coefficients = 12};
    CHECK_OK(kiln_fit_create(context, &loose, &fit, &error));
    snprintf(path, sizeof path, "%s/fit.h", folder);
    CHECK_OK(kiln_fit_save(context, &fit, NULL, path, &error));
}

// Checks that two folders hold the same files; returns their number.
static int check_same_folders(const char *a, const char *b)
{
    static folder_file one[MOST], two[MOST];
    int count = read_folder(a, one, MOST);
    assert_int_equal(read_folder(b, two, MOST), count);
    for (int i = 0; i < count; i++) {
        int k = 0;
        while (k < count && strcmp(one[i].name, two[k].name) != 0)
            k++;
        assert_true(k < count);
        if (one[i].size != two[k].size || memcmp(one[i].bytes, two[k].bytes, one[i].size) != 0)
            fail_msg("%s has other bytes in the locale %s", one[i].name,
                     setlocale(LC_NUMERIC, NULL));
    }
    for (int i = 0; i < count; i++) {
        free(one[i].bytes);
        free(two[i].bytes);
    }
    return count;
}

// Describes every file of a folder; `info` receives the descriptions by the order of `files`.
static void describe_all(const char *folder, const folder_file *files, int count,
                         kiln_file_info *info)
{
    for (int i = 0; i < count; i++) {
        char path[512];
        snprintf(path, sizeof path, "%.200s/%.63s", folder, files[i].name);
        if (kiln_file_describe(context, path, &info[i], &error) != KILN_OK)
            strcpy(info[i].writer, "not described");
    }
}

static void files_and_sentences_are_the_same_in_every_locale(void **state)
{
    (void)state;
    static const char *const names[] = {"comma", "arabic"}, *const codes[] = {"U002C", "U066B"},
                             *const halves[] = {"0,5", "0\xd9\xab"
                                                       "5"};
    static kiln_file_info plain[MOST], other[MOST];
    static folder_file files[MOST];
    char plain_folder[128], folder[128], text[16], message[512];
    kiln_sky_def wrong = {.turbidity = 1.25};
    kiln_map map;
    snprintf(home, sizeof home, "%s", folder_path());
    setenv("LOCPATH", home, 1);
    snprintf(plain_folder, sizeof plain_folder, "%s", in_folder("plain"));
    assert_int_equal(mkdir(plain_folder, 0777), 0);
    save_all(plain_folder);
    int count = read_folder(plain_folder, files, MOST);
    describe_all(plain_folder, files, count, plain);
    assert_int_equal(kiln_sky(context, &wrong, &map, &error), KILN_ERROR_ARGUMENT);
    snprintf(message, sizeof message, "%s", error.message);
    CHECK_SAYS(message, "1.25");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        make_locale(names[i], codes[i]);
        assert_non_null(setlocale(LC_NUMERIC, names[i]));
        snprintf(text, sizeof text, "%g", 0.5);
        assert_string_equal(text, halves[i]); // the locale is in force
        snprintf(folder, sizeof folder, "%s/%zu", home, i);
        assert_int_equal(mkdir(folder, 0777), 0);
        save_all(folder);
        assert_in_range(check_same_folders(plain_folder, folder), 40, MOST);
        describe_all(plain_folder, files, count, other);
        assert_memory_equal(plain, other, (size_t)count * sizeof *plain);
        assert_int_equal(kiln_sky(context, &wrong, &map, &error), KILN_ERROR_ARGUMENT);
        assert_string_equal(error.message, message);
        snprintf(text, sizeof text, "%g", 0.5);
        assert_string_equal(text, halves[i]); // and still is
        setlocale(LC_NUMERIC, "C");
    }
    for (int i = 0; i < count; i++)
        free(files[i].bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(
        files_and_sentences_are_the_same_in_every_locale, set_up_folder, tear_down_folder)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
