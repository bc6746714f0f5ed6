// Calls every fuzz target with the files that fuzzing has found for it: replay FOLDER, with the
// files of each target in FOLDER/TARGET. A law that is broken, or a sanitizer's find, ends the
// program.
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { FILE_MOST = 4096, TOTAL_MOST = 1 << 20, COUNT_LEAST = 3 };

// Runs the target with one file, and returns the number of the file's bytes.
static size_t replay(const fuzz_target *target, const char *path)
{
    uint8_t bytes[FILE_MOST + 1];
    FILE *file = fopen(path, "rb");
    fuzz_must(file != NULL);
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    if (size > FILE_MOST) {
        fprintf(stderr, "%s: has more than %d bytes\n", path, FILE_MOST);
        exit(1);
    }
    fprintf(stderr, "%s\n", path); // the last line before a crash is the cause of the crash
    fuzz_run(target, bytes, size);
    return size;
}

// Replays the files of one target, and returns the number of their bytes.
static size_t replay_all(const fuzz_target *target, const char *folder)
{
    char path[1024];
    size_t total = 0;
    int count = 0;
    snprintf(path, sizeof path, "%s/%s", folder, target->name);
    DIR *files = opendir(path);
    for (struct dirent *entry; files && (entry = readdir(files));) {
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s/%s", folder, target->name, entry->d_name);
        total += replay(target, path);
        count++;
    }
    if (files)
        closedir(files);
    printf("%-12s %4d files %7zu bytes\n", target->name, count, total);
    if (count < COUNT_LEAST) {
        fprintf(stderr, "%s/%s: has %d files, each target must have %d or more\n", folder,
                target->name, count, COUNT_LEAST);
        exit(1);
    }
    return total;
}

int main(int argc, char **argv)
{
    size_t total = 0;
    if (argc != 2) {
        fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    for (const fuzz_target *target = fuzz_targets; target->name; target++)
        total += replay_all(target, argv[1]);
    printf("%zu bytes\n", total);
    return total > TOTAL_MOST;
}
