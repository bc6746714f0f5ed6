#include "base/temporary.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static const char before[] = "kiln-", after[] = ".tmp";

size_t ki_folder_length(const char *path)
{
    size_t length = strlen(path);
    while (length && !ki_os_is_separator(path[length - 1]))
        length--;
    return length;
}

int ki_temporary_create(const char *path, char *name, size_t room)
{
    for (int n = 0; n < 1000; n++) {
        snprintf(name, room, "%.*s%s%ld-%d%s", (int)ki_folder_length(path), path, before,
                 ki_os_process(), n, after);
        int file = ki_os_create(name);
        if (file >= 0 || errno != EEXIST)
            return file;
    }
    return -1;
}

// Skips decimal digits; returns NULL if there are none.
static const char *skip_digits(const char *text)
{
    size_t count = strspn(text, "0123456789");
    return count ? text + count : NULL;
}

// Returns whether a file's name is exactly of the form "kiln-PROCESS-NUMBER.tmp".
static bool is_temporary(const char *name)
{
    if (strncmp(name, before, strlen(before)) != 0)
        return false;
    const char *at = skip_digits(name + strlen(before));
    at = at && *at == '-' ? skip_digits(at + 1) : NULL;
    return at && !strcmp(at, after);
}

static void remove_leftover(void *user, const char *name)
{
    const char *folder = user;
    char path[KI_OS_PATH];
    if (is_temporary(name) && snprintf(path, sizeof path, "%s%s", folder, name) < KI_OS_PATH)
        ki_os_remove_abandoned(path);
}

void ki_temporary_sweep(const char *path)
{
    char folder[KI_OS_PATH];
    size_t length = ki_folder_length(path);
    if (length >= sizeof folder)
        return;
    memcpy(folder, path, length);
    folder[length] = 0;
    ki_os_list_folder(length ? folder : ".", remove_leftover, folder);
}
