// The memory limits of control groups, read from trees of files that stand for /proc and /sys.
#include "../../cli/cgroup.h"

#include "kit/kit.h"

#include <sys/stat.h>

// Writes a text to a path below the folder of the test, whose folders are made.
static void put(const char *path, const char *text)
{
    char whole[512];
    snprintf(whole, sizeof whole, "%s%s", folder_path(), path);
    for (char *at = whole + strlen(folder_path()) + 1; (at = strchr(at, '/')) != NULL; at++) {
        *at = 0;
        (void)mkdir(whole, 0777);
        *at = '/';
    }
    write_file(whole, text, strlen(text));
}

static int begin(void **state)
{
    (void)state;
    folder_make();
    return 0;
}

static int finish(void **state)
{
    (void)state;
    folder_remove();
    return 0;
}

static const char second[] =
    "22 1 0:2 / / rw - ext4 /dev/sda rw\n"
    "30 22 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate\n";
static const char first[] = "31 22 0:27 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n"
                            "32 22 0:28 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n";

static void without_groups_there_is_no_limit(void **state)
{
    (void)state;
    assert_int_equal(cgroup_memory_limit(folder_path()), 0);
    put("/proc/self/cgroup", "0::/a\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 0);
    put("/proc/self/mountinfo", second);
    assert_int_equal(cgroup_memory_limit(folder_path()), 0);
    put("/sys/fs/cgroup/a/memory.max", "max\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 0);
    put("/sys/fs/cgroup/a/memory.max", "junk");
    assert_int_equal(cgroup_memory_limit(folder_path()), 0);
}

static void version_2_limits_by_every_group_above(void **state)
{
    (void)state;
    put("/proc/self/cgroup", "1:name=systemd:/x\n0::/a/b/c\n");
    put("/proc/self/mountinfo", second);
    put("/sys/fs/cgroup/a/b/c/memory.max", "max\n");
    put("/sys/fs/cgroup/a/b/memory.max", "536870912\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 536870912);
    put("/sys/fs/cgroup/a/memory.max", "268435456\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 268435456);
    put("/sys/fs/cgroup/a/b/c/memory.max", "1048576\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 1048576);
    put("/sys/fs/cgroup/a/b/other/memory.max", "4096\n"); // another group's
    put("/sys/fs/memory.max", "4096\n");                  // above the tree
    assert_int_equal(cgroup_memory_limit(folder_path()), 1048576);
}

static void version_1_has_a_tree_for_memory(void **state)
{
    (void)state;
    put("/proc/self/cgroup", "4:cpu,cpuacct:/c\n3:hugetlb,memory:/m/n\n0::/\n");
    put("/proc/self/mountinfo", first);
    put("/sys/fs/cgroup/cpu/c/memory.limit_in_bytes", "4096\n"); // no such limit there
    put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    put("/sys/fs/cgroup/memory/m/n/memory.limit_in_bytes", "9223372036854771712\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 0);
    put("/sys/fs/cgroup/memory/m/memory.limit_in_bytes", "73400320\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 73400320);
}

// A container sees its own group at the top of the tree, whatever its path outside is.
static void a_container_sees_a_part_of_the_tree(void **state)
{
    (void)state;
    put("/proc/self/mountinfo",
        "40 22 0:28 /docker/17 /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory\n");
    put("/proc/self/cgroup", "3:memory:/docker/17/job\n");
    put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "2097152\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 2097152);
    put("/sys/fs/cgroup/memory/job/memory.limit_in_bytes", "1048576\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 1048576);
    put("/proc/self/cgroup", "3:memory:/docker/171\n"); // not below /docker/17
    assert_int_equal(cgroup_memory_limit(folder_path()), 2097152);
    put("/proc/self/cgroup", "3:memory:/../outside\n");
    assert_int_equal(cgroup_memory_limit(folder_path()), 2097152);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(without_groups_there_is_no_limit, begin, finish),
        cmocka_unit_test_setup_teardown(version_2_limits_by_every_group_above, begin, finish),
        cmocka_unit_test_setup_teardown(version_1_has_a_tree_for_memory, begin, finish),
        cmocka_unit_test_setup_teardown(a_container_sees_a_part_of_the_tree, begin, finish),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
