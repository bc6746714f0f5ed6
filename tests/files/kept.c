// What a writer owes to a folder: an overwritten file keeps its mode, a link stays, long names
// work, the folder is synchronised after the renames, and neither a full disk nor killed or
// simultaneous writers damage or leave anything.
#include "base/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "kit/clock.h"
#include "kit/context.h"

enum { N = 8, LEVELS = 2, FILES = 6 * LEVELS, MOMENTS = 200, ROUNDS = 40 };

// ------------------------------------------------------------------- calls of the system, recorded

// The linker sends the library's calls of write, fsync and rename here: F for a synchronised file,
// D for a folder, R for a renamed file.
static char calls[256];
static size_t call_count;

// What the disk refuses. `room`: bytes that the disk still takes, -1 for any number. `calls_left`:
// calls of fsync and rename before the disk fails for good, -1 for any number.
static struct {
    ssize_t room;
    int calls_left;
} disk = {-1, -1};

static void forget_calls(void)
{
    memset(calls, 0, sizeof calls);
    call_count = 0;
}

// Records a call, and returns false with errno set if the disk refuses the call.
static bool record(char c)
{
    if (call_count + 1 < sizeof calls)
        calls[call_count++] = c;
    if (disk.calls_left != 0) {
        disk.calls_left -= disk.calls_left > 0;
        return true;
    }
    errno = EIO;
    return false;
}

// A disk that has room for a part of the bytes takes this part.
ssize_t __real_write(int file, const void *bytes, size_t size);
ssize_t __wrap_write(int file, const void *bytes, size_t size);
ssize_t __wrap_write(int file, const void *bytes, size_t size)
{
    if (disk.room < 0)
        return __real_write(file, bytes, size);
    ssize_t put = __real_write(file, bytes, (size_t)disk.room < size ? (size_t)disk.room : size);
    disk.room -= put;
    if (put > 0 || !size)
        return put;
    errno = ENOSPC;
    return -1;
}

int __real_fsync(int file);
int __wrap_fsync(int file);
int __wrap_fsync(int file)
{
    struct stat status;
    assert_int_equal(fstat(file, &status), 0);
    return record(S_ISDIR(status.st_mode) ? 'D' : 'F') ? __real_fsync(file) : -1;
}

int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to)
{
    return record('R') ? __real_rename(from, to) : -1;
}

// ------------------------------------------------------------------------------------ single files

static void write_text(const char *path, const char *text)
{
    CHECK_OK(ki_file_write(context, path, text, strlen(text), &error));
}

static void check_text(const char *path, const char *text)
{
    size_t size;
    uint8_t *bytes = read_file(path, &size);
    assert_string_equal((const char *)bytes, text);
    assert_int_equal(size, strlen(text));
    free(bytes);
}

static void an_overwritten_file_keeps_its_mode(void **state)
{
    (void)state;
    static const mode_t modes[] = {0600, 0640, 0664, 0755, 0444};
    struct stat status;
    const char *path = in_folder("a.bin");
    mode_t mask = umask(022);
    write_text(path, "new");
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 07777, 0644); // of an ordinary new file
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        assert_int_equal(chmod(path, modes[i]), 0);
        write_text(path, "again");
        assert_int_equal(stat(path, &status), 0);
        assert_int_equal(status.st_mode & 07777, modes[i]);
    }
    // The right to run as the file's owner is not handed on.
    assert_int_equal(chmod(path, 04755), 0);
    write_text(path, "last");
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 07777, 0755);
    check_text(path, "last");
    umask(mask);
}

static void a_link_is_followed_and_stays(void **state)
{
    (void)state;
    struct stat status;
    assert_int_equal(mkdir(in_folder("far"), 0777), 0);
    write_text(in_folder("far/a.bin"), "old");
    assert_int_equal(symlink("far/a.bin", in_folder("one")), 0);              // relative
    assert_int_equal(symlink(in_folder("one"), in_folder("far/two")), 0);     // absolute, to a link
    assert_int_equal(symlink("../far/new.bin", in_folder("far/dangles")), 0); // to no file yet
    assert_int_equal(symlink("loop", in_folder("loop")), 0);
    write_text(in_folder("far/two"), "new");
    check_text(in_folder("far/a.bin"), "new");
    write_text(in_folder("far/dangles"), "fresh");
    check_text(in_folder("far/new.bin"), "fresh");
    static const char *const links[] = {"one", "far/two", "far/dangles", "loop"};
    for (size_t i = 0; i < sizeof links / sizeof *links; i++) {
        assert_int_equal(lstat(in_folder(links[i]), &status), 0);
        assert_true(S_ISLNK(status.st_mode));
    }
    assert_int_equal(ki_file_write(context, in_folder("loop"), "x", 1, &error), KILN_ERROR_IO);
    CHECK_SAYS(error.message, "loop: cannot be created: ");
    assert_int_equal(file_count(folder_path()), 3);    // far, one, loop
    assert_int_equal(file_count(in_folder("far")), 4); // a.bin, new.bin, two, dangles
}

static void names_may_be_as_long_as_the_file_system_allows(void **state)
{
    (void)state;
    char name[512];
    long most = pathconf(folder_path(), _PC_NAME_MAX);
    assert_in_range(most, 64, 400);
    memset(name, 'n', sizeof name);
    name[most] = 0;
    write_text(in_folder(name), "long");
    check_text(in_folder(name), "long");
    name[most] = 'n';
    name[most + 1] = 0;
    assert_int_equal(ki_file_write(context, in_folder(name), "x", 1, &error), KILN_ERROR_IO);
    assert_int_equal(file_count(folder_path()), 1);
}

static kiln_result add_three(ki_file_set *set, void *data, kiln_error *e)
{
    (void)data;
    kiln_result result = ki_file_set_add(set, in_folder("a"), "1", 1, e);
    if (result == KILN_OK)
        result = ki_file_set_make_folder(set, in_folder("sub/"), e);
    if (result == KILN_OK)
        result = ki_file_set_add(set, in_folder("sub/b"), "2", 1, e);
    return result == KILN_OK ? ki_file_set_add(set, in_folder("sub/c"), "3", 1, e) : result;
}

static void the_folder_is_synchronised_after_the_renames(void **state)
{
    (void)state;
    forget_calls();
    write_text(in_folder("one"), "1");
    assert_string_equal(calls, "FRD");
    forget_calls();
    CHECK_OK(ki_file_set_make(context, add_three, NULL, NULL, &error));
    assert_string_equal(calls, "FFFRRRDD"); // the folder of "a" and "sub", then "sub"
}

// --------------------------------------------------------------------------------------- leftovers

static void leftovers_are_removed_unless_their_writer_lives(void **state)
{
    (void)state;
    // Names of kiln's own, which no descriptor locks, and names of others.
    static const char *const left[] = {"kiln-1-0.tmp", "kiln-4194304-999.tmp"};
    static const char *const others[] = {"kiln-1-0.tmp.exr", "kiln--0.tmp", "kiln-1-.tmp",
                                         "my-kiln-1-0.tmp",  "kiln-1.tmp",  "kiln-a-0.tmp"};
    for (size_t i = 0; i < sizeof left / sizeof *left; i++)
        write_file(in_folder(left[i]), "left", 4);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        write_file(in_folder(others[i]), "other", 5);
    write_file(in_folder("kiln-77-3.tmp"), "held", 4);
    int held = open(in_folder("kiln-77-3.tmp"), O_WRONLY);
    assert_int_equal(flock(held, LOCK_EX), 0);
    assert_int_equal(symlink("kiln-a-0.tmp", in_folder("kiln-5-5.tmp")), 0);
    write_text(in_folder("made"), "made");
    for (size_t i = 0; i < sizeof left / sizeof *left; i++)
        assert_int_equal(access(in_folder(left[i]), F_OK), -1);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        check_text(in_folder(others[i]), "other");
    check_text(in_folder("kiln-77-3.tmp"), "held");
    close(held); // as if the writer had been killed
    write_text(in_folder("made"), "made");
    assert_int_equal(access(in_folder("kiln-77-3.tmp"), F_OK), -1);
    assert_int_equal(file_count(folder_path()), 6 + 1 + 1); // others, the link, made
}

// Saves a cube of two levels whose texels are all `value`, in twelve files.
static bool save_constant(kiln_context *c, float value, kiln_error *e)
{
    kiln_map cube;
    if (kiln_map_create(c, KILN_SHAPE_CUBE, N, LEVELS, &cube, e) != KILN_OK)
        return false;
    for (int k = 0; k < LEVELS; k++)
        for (size_t i = 0; i < kiln_map_texels(&cube, k) * 3; i++)
            cube.level[k][i] = value;
    bool good = kiln_map_save(c, &cube, in_folder("cube.exr"), NULL, NULL, e) == KILN_OK;
    kiln_map_free(&cube);
    return good;
}

// Returns the value of a face that was written whole: all its texels are this value.
static float face_value(const char *name)
{
    kiln_image image;
    CHECK_OK(kiln_image_load(context, in_folder(name), &image, &error));
    assert_true(image.width == N || image.width == N / 2);
    float value = image.pixels[0];
    for (int i = 0; i < image.width * image.height * image.channels; i++)
        assert_true(image.pixels[i] == value);
    kiln_image_free(&image);
    return value;
}

// Checks every picture in the folder, and returns the number of pictures with the value `wanted`.
static int check_pictures(float wanted)
{
    int count = 0;
    DIR *folder = opendir(folder_path());
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));)
        if (strstr(entry->d_name, ".exr"))
            count += face_value(entry->d_name) == wanted;
    closedir(folder);
    return count;
}

// Starts a process that saves `count` sets of files, of which the first has the value `first` in all
// texels and each further one `step` more. Waits until the process begins to save, and returns its
// number.
static pid_t start_writer(float first, float step, int count)
{
    int begun[2];
    char byte;
    assert_int_equal(pipe(begun), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child) {
        close(begun[1]);
        assert_int_equal(read(begun[0], &byte, 1), 1);
        close(begun[0]);
        return child;
    }
    close(begun[0]);
    kiln_context *own = NULL;
    kiln_error e;
    bool good = kiln_context_create(&(kiln_context_def){.thread_count = 1}, &own, NULL) == KILN_OK;
    good = good && write(begun[1], "", 1) == 1;
    for (int i = 0; good && i < count; i++)
        good = save_constant(own, first + step * (float)i, &e);
    _exit(!good);
}

// Checks that saving failed with a sentence that ends in `reason`, and that the folder holds whole
// pictures and nothing else, of which `fresh` have the value 2 and all others the value 1.
static void check_refused(bool saved, const char *reason, int fresh)
{
    assert_false(saved);
    CHECK_SAYS(error.message, reason);
    assert_int_equal(file_count(folder_path()), FILES);
    assert_int_equal(check_pictures(2), fresh);
    assert_int_equal(check_pictures(1), FILES - fresh);
}

// A disk with room for any part of a set keeps the old set.
static void a_full_disk_damages_nothing(void **state)
{
    (void)state;
    enum { MUCH = 1 << 20, STEP = 97 };
    disk.room = MUCH;
    bool saved = save_constant(context, 1, &error);
    ssize_t size = MUCH - disk.room;
    for (disk.room = -1; saved && size > 0; size -= STEP) {
        disk.room = size - 1;
        bool fits = save_constant(context, 2, &error);
        disk.room = -1;
        check_refused(fits, "No space left on device", 0);
    }
    assert_true(saved);
}

// A disk that fails from one of the 12 synchronisations or 12 renames on. A synchronisation that
// fails keeps the old set; a rename that fails keeps the new files that were renamed before.
static void a_failing_disk_damages_no_file(void **state)
{
    (void)state;
    for (int k = 0; k < 2 * FILES; k++) {
        assert_true(save_constant(context, 1, &error));
        disk.calls_left = k;
        bool saved = save_constant(context, 2, &error);
        disk.calls_left = -1;
        check_refused(saved, "Input/output error", k < FILES ? 0 : k - FILES);
    }
}

// The moments are spread over the time that saving a set takes on this machine, but over half a second
// at most.
static void a_killed_writer_damages_nothing(void **state)
{
    (void)state;
    int caught = 0, status;
    double begin = seconds_now();
    assert_true(save_constant(context, 1, &error));
    double takes = fmin(seconds_now() - begin, 0.5);
    for (int moment = 0; moment < MOMENTS; moment++) {
        pid_t child = start_writer(2, 1, 1000000);
        nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * takes * moment / MOMENTS)}, NULL);
        assert_int_equal(kill(child, SIGKILL), 0);
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status));
        if (moment % 8 == 0)
            check_pictures(0); // every file is whole
        caught += file_count(folder_path()) > FILES;
    }
    printf("%d of %d moments left temporary files\n", caught, MOMENTS);
    assert_true(caught > MOMENTS / 20);
    assert_true(save_constant(context, 5, &error));
    assert_int_equal(file_count(folder_path()), FILES);
    assert_int_equal(check_pictures(5), FILES);
}

static void two_writers_leave_one_whole_set(void **state)
{
    (void)state;
    int status;
    for (int round = 0; round < 5; round++) {
        pid_t child[2] = {start_writer(16, 0, ROUNDS), start_writer(64, 0, ROUNDS)};
        for (int i = 0; i < 2; i++) {
            assert_int_equal(waitpid(child[i], &status, 0), child[i]);
            assert_int_equal(status, 0); // no save failed
        }
        assert_int_equal(file_count(folder_path()), FILES);
        int first = check_pictures(16), second = check_pictures(64);
        if (first != FILES && second != FILES)
            fail_msg("%d files are the first writer's, %d the second's", first, second);
    }
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up_folder, tear_down_folder)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(an_overwritten_file_keeps_its_mode),
        IN_FOLDER(a_link_is_followed_and_stays),
        IN_FOLDER(names_may_be_as_long_as_the_file_system_allows),
        IN_FOLDER(the_folder_is_synchronised_after_the_renames),
        IN_FOLDER(leftovers_are_removed_unless_their_writer_lives),
        IN_FOLDER(a_full_disk_damages_nothing),
        IN_FOLDER(a_failing_disk_damages_no_file),
        IN_FOLDER(a_killed_writer_damages_nothing),
        IN_FOLDER(two_writers_leave_one_whole_set),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
