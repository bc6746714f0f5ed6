// Files appear whole or not at all, also several files of one environment.
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include "kit/context.h"

enum { N = 6 }; // size of the cubes here

// A limit on the size of files stands for a full disk: the old file stays, no other appears.
static void nothing_is_half_written(void **state)
{
    (void)state;
    kiln_map cube, big, back;
    cube = make_steps(context, KILN_SHAPE_CUBE, N, 1);
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 64, 1, &big, &error));
    fill_noise(&big, 1, 0, 1000);
    CHECK_OK(kiln_map_save(context, &cube, in_folder("a.ktx2"), NULL, NULL, &error));
    CHECK_OK(kiln_map_save(context, &cube, in_folder("a.exr"), NULL, NULL, &error));
    int before = file_count(folder_path());
    struct rlimit limit, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    small = limit;
    small.rlim_cur = 4096;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    kiln_result one = kiln_map_save(context, &big, in_folder("a.ktx2"), NULL, NULL, &error);
    kiln_result six = kiln_map_save(context, &big, in_folder("a.exr"), NULL, NULL, &error);
    kiln_result fresh = kiln_map_save(context, &big, in_folder("new/"), NULL, NULL, &error);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_int_equal(one, KILN_ERROR_IO);
    assert_int_equal(six, KILN_ERROR_IO);
    assert_int_equal(fresh, KILN_ERROR_IO);
    CHECK_SAYS(error.message, "new/px.exr: cannot write");
    assert_int_equal(file_count(folder_path()), before); // "new" is gone too
    CHECK_OK(kiln_map_load(context, in_folder("a.ktx2"), NULL, &back, &error));
    check_same_levels(&cube, &back);
    kiln_map_free(&back);
    CHECK_OK(kiln_map_load(context, in_folder("a_%s.exr"), NULL, &back, &error));
    check_same_levels(&cube, &back);
    kiln_map_free(&back);
    assert_int_equal(kiln_map_save(context, &cube, in_folder("missing/a.ktx2"), NULL, NULL, &error),
                     KILN_ERROR_IO);
    CHECK_SAYS(error.message, "missing/a.ktx2");
    kiln_map_free(&cube);
    kiln_map_free(&big);
}

static void an_environments_files_appear_together(void **state)
{
    (void)state;
    kiln_environment made = make_sky_bake(context);
    char irradiance[128], sh[128];
    snprintf(irradiance, sizeof irradiance, "%s", in_folder("i.dds"));
    snprintf(sh, sizeof sh, "%s", in_folder("s.json"));
    kiln_environment_save_def def = {.irradiance_path = irradiance, .sh_path = sh};
    kiln_environment_report report;
    kiln_files files;
    CHECK_OK(kiln_environment_encode(context, &made, in_folder("a.ktx2"), &def, &files, &report,
                                     &error));
    assert_int_equal(files.count, 3);
    assert_int_equal(report.file_count, 3);
    CHECK_OK(kiln_environment_save(context, &made, in_folder("a.ktx2"), &def, &report, &error));
    check_saved_files(&files);
    kiln_files_free(&files);
    // The last of them fails: none is there.
    def.sh_path = in_folder("s.yaml");
    assert_int_equal(
        kiln_environment_save(context, &made, in_folder("a.ktx2"), &def, &report, &error),
        KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "s.yaml");
    assert_int_equal(report.file_count, 0);
    assert_int_equal(access(in_folder("a.ktx2"), F_OK), -1);
    assert_int_equal(access(irradiance, F_OK), -1);
    def = (kiln_environment_save_def){.irradiance_path = irradiance};
    kiln_map_free(&made.irradiance);
    assert_int_equal(
        kiln_environment_save(context, &made, in_folder("sub/"), &def, &report, &error),
        KILN_ERROR_ARGUMENT);
    assert_int_equal(access(in_folder("sub"), F_OK), -1); // the folder is gone too
    kiln_environment_free(&made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(nothing_is_half_written, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(an_environments_files_appear_together, set_up_folder,
                                        tear_down_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
