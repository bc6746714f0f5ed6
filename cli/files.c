// Names of files and folders.
#include "cli.h"
#include "os.h"

#include <stdio.h>
#include <string.h>

const char *cli_ending(const char *path)
{
    const char *ending = kiln_path_ending(path);
    if (os_kind_of(path) == OS_FOLDER)
        return "/";
    return ending[0] == '.' ? ending + 1 : ending;
}

bool cli_ends_in(const char *path, const char *ending)
{
    return !strcmp(cli_ending(path), ending);
}

int cli_check_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash || !slash[1])
        return CLI_GO; // the file is in the current folder, or its folder will be created
    char folder[4096];
    size_t length = slash == path ? 1 : (size_t)(slash - path);
    if (length >= sizeof folder)
        return cli_fail("%.60s...: the path is too long, choose a shorter one", path);
    memcpy(folder, path, length);
    folder[length] = 0;
    if (strchr(folder, '%') || strchr(folder, '{'))
        return CLI_GO;
    switch (os_kind_of(folder)) {
    case OS_NOTHING:
        return cli_fail("%s: there is no folder %s, create it first", path, folder);
    case OS_UNREACHABLE:
        return cli_fail("%s: the folder %s cannot be entered", path, folder);
    case OS_FILE:
        return cli_fail("%s: %s is not a folder", path, folder);
    default:
        return CLI_GO;
    }
}

static bool say(kiln_error *error, const char *path, const char *folder, const char *what)
{
    snprintf(error->message, sizeof error->message, "%.200s: the folder %.200s %s", path, folder,
             what);
    return false;
}

bool cli_make_folders(const char *path, bool make, int *made, kiln_error *error)
{
    char folder[4096] = "";
    for (const char *slash = strchr(path + (path[0] == '/'), '/'); slash;
         slash = strchr(slash + 1, '/')) {
        size_t length = (size_t)(slash - path);
        if (length >= sizeof folder)
            return say(error, path, folder, "has a path that is too long, choose a shorter one");
        memcpy(folder, path, length);
        folder[length] = 0;
        os_kind kind = os_kind_of(folder);
        if (strpbrk(folder, "%{") || (kind == OS_NOTHING && !make))
            return true;
        if (kind == OS_FILE || kind == OS_UNREACHABLE)
            return say(error, path, folder, kind == OS_FILE ? "is a file" : "cannot be entered");
        if (kind == OS_NOTHING && os_make_folder(folder))
            ++*made;
        else if (kind == OS_NOTHING && os_kind_of(folder) != OS_FOLDER) // nor did another thread
            return say(error, path, folder, "cannot be created");
    }
    return true;
}
