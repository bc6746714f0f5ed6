// In: /proc/self/cgroup, which names the process's group, /proc/self/mountinfo, which tells where
// the tree of groups is mounted, and the limits of the group and of all groups above. Out: the
// smallest limit. Method: version 2 has one tree with files memory.max, version 1 a tree for memory
// with files memory.limit_in_bytes. In a container only a part of the tree is mounted, and the
// group's path begins with the root of this part.
#include "cgroup.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM = 4096 };

// Returns whether a list of words with commas between holds a word.
static bool lists(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = list; (at = strstr(at, word)) != NULL; at += length)
        if ((at == list || at[-1] == ',') && (!at[length] || at[length] == ','))
            return true;
    return false;
}

static FILE *open_under(const char *root, const char *path)
{
    char whole[2 * ROOM];
    return snprintf(whole, sizeof whole, "%s%s", root, path) < (int)sizeof whole ? fopen(whole, "r")
                                                                                 : NULL;
}

// Reads a limit from one file. A group without a limit holds the word "max", or a number of pages
// that no machine has.
static size_t read_limit(const char *root, const char *path)
{
    char text[64] = "", *end;
    FILE *file = open_under(root, path);
    if (!file)
        return 0;
    bool got = fgets(text, sizeof text, file) != NULL;
    fclose(file);
    unsigned long long value = strtoull(text, &end, 10);
    return got && end > text && value < SIZE_MAX / 2 - (1 << 20) ? (size_t)value : 0;
}

// Sets `group` to the path of the process's group for memory. Lines are NUMBER:CONTROLLERS:PATH;
// version 2 has no controllers.
static bool find_group(const char *root, bool second, char group[ROOM])
{
    char line[ROOM];
    bool found = false;
    FILE *file = open_under(root, "/proc/self/cgroup");
    while (file && !found && fgets(line, sizeof line, file)) {
        char *controllers = strchr(line, ':'),
             *path = controllers ? strchr(controllers + 1, ':') : NULL;
        if (!path)
            continue;
        *path++ = 0;
        path[strcspn(path, "\n")] = 0;
        found = second ? !controllers[1] : lists(controllers + 1, "memory");
        if (found)
            snprintf(group, ROOM, "%s", path);
    }
    if (file)
        fclose(file);
    return found;
}

// Sets `top` to the folder where the tree of groups is mounted, and `inside` to the group in this
// tree that the folder shows. Lines are "ID PARENT DEVICE INSIDE TOP OPTIONS ... - TYPE SOURCE
// OPTIONS".
static bool find_mount(const char *root, bool second, char top[ROOM], char inside[ROOM])
{
    char line[ROOM], type[32], options[ROOM];
    bool found = false;
    FILE *file = open_under(root, "/proc/self/mountinfo");
    while (file && !found && fgets(line, sizeof line, file)) {
        const char *rest = strstr(line, " - ");
        if (!rest || sscanf(rest, " - %31s %*s %4095s", type, options) != 2 ||
            sscanf(line, "%*s %*s %*s %4095s %4095s", inside, top) != 2)
            continue;
        found =
            second ? !strcmp(type, "cgroup2") : !strcmp(type, "cgroup") && lists(options, "memory");
    }
    if (file)
        fclose(file);
    return found;
}

// The smaller of two limits, of which 0 is none.
static size_t smaller(size_t a, size_t b)
{
    return !a || (b && b < a) ? b : a;
}

// The smallest limit of a group and the groups above, of one version's tree.
static size_t tree_limit(const char *root, bool second)
{
    char group[ROOM], top[ROOM], inside[ROOM], path[3 * ROOM];
    if (!find_group(root, second, group) || !find_mount(root, second, top, inside))
        return 0;
    size_t skip = strcmp(inside, "/") != 0 ? strlen(inside) : 0;
    bool below = !strncmp(group, inside, skip) && (group[skip] == '/' || !group[skip] || !skip);
    const char *rest = below && !strstr(group, "/..") ? group + skip : "";
    snprintf(path, sizeof path, "%s%s", strcmp(top, "/") != 0 ? top : "", rest);
    size_t least = 0, shortest = strlen(path) - strlen(rest);
    for (size_t length = strlen(path);; length--) {
        if (path[length] && path[length] != '/')
            continue;
        snprintf(path + length, sizeof path - length, "/%s",
                 second ? "memory.max" : "memory.limit_in_bytes");
        least = smaller(least, read_limit(root, path));
        path[length] = 0;
        if (length <= shortest)
            return least;
    }
}

size_t cgroup_memory_limit(const char *root)
{
    return smaller(tree_limit(root, true), tree_limit(root, false));
}
