#include "folder.h"

#include "check.h"

#include <dirent.h>
#include <stdbool.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ROOM = 512, PATHS = 8 };

static char made[64];

void folder_make(void)
{
    strcpy(made, "/tmp/kiln-test-XXXXXX");
    assert_non_null(mkdtemp(made));
}

const char *folder_path(void)
{
    return made;
}

const char *in_folder(const char *name)
{
    static char paths[PATHS][ROOM];
    static int next;
    char *path = paths[next++ % PATHS];
    assert_true(snprintf(path, ROOM, "%s/%s", made, name) < ROOM);
    return path;
}

// Whether a name stands for the folder that holds the name, or for that folder's parent.
static bool is_dots(const char *name)
{
    return !strcmp(name, ".") || !strcmp(name, "..");
}

static void empty(const char *path)
{
    DIR *entries = opendir(path);
    assert_non_null(entries);
    for (struct dirent *entry; (entry = readdir(entries));) {
        char name[ROOM];
        struct stat status;
        if (is_dots(entry->d_name))
            continue;
        assert_true(snprintf(name, sizeof name, "%s/%s", path, entry->d_name) < ROOM);
        if (lstat(name, &status) == 0 && S_ISDIR(status.st_mode))
            empty(name);
        assert_int_equal(remove(name), 0);
    }
    closedir(entries);
}

void folder_empty(void)
{
    empty(made);
}

void folder_remove(void)
{
    empty(made);
    assert_int_equal(rmdir(made), 0);
}

int file_count(const char *path)
{
    DIR *entries = opendir(path);
    assert_non_null(entries);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(entries));)
        count += !is_dots(entry->d_name);
    closedir(entries);
    return count;
}

uint8_t *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail_msg("%s cannot be opened", path);
    struct stat status = {0};
    assert_int_equal(fstat(fileno(file), &status), 0);
    *size = (size_t)status.st_size;
    uint8_t *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    bytes[*size] = 0;
    fclose(file);
    return bytes;
}

int read_folder(const char *path, folder_file *files, int most)
{
    int count = 0;
    DIR *entries = opendir(path);
    assert_non_null(entries);
    for (struct dirent *entry; (entry = readdir(entries));) {
        char name[ROOM];
        if (entry->d_name[0] == '.')
            continue;
        assert_true(count < most);
        folder_file *file = &files[count++];
        assert_true(snprintf(name, sizeof name, "%s/%s", path, entry->d_name) < ROOM);
        snprintf(file->name, sizeof file->name, "%.63s", entry->d_name);
        file->bytes = read_file(name, &file->size);
    }
    closedir(entries);
    return count;
}

void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        fail_msg("%s cannot be opened", path);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

void check_saved_files(const kiln_files *files)
{
    for (int i = 0; i < files->count; i++) {
        size_t size;
        uint8_t *bytes = read_file(files->file[i].name, &size);
        assert_int_equal(size, files->file[i].size);
        assert_memory_equal(bytes, files->file[i].bytes, size);
        free(bytes);
        assert_int_equal(remove(files->file[i].name), 0);
    }
}

void check_same_files(const char *a, const char *b)
{
    size_t size[2];
    uint8_t *bytes[2] = {read_file(a, &size[0]), read_file(b, &size[1])};
    assert_true(size[0] > 0);
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
    free(bytes[0]);
    free(bytes[1]);
}

uint8_t *read_asset(const char *folder, const char *name, size_t *size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char path[512];
    size_t length;
    snprintf(path, sizeof path, "%s/node_modules/@pmndrs/assets/hdri/%s.exr.js", folder, name);
    uint8_t *bytes = read_file(path, &length);
    const char *at = strstr((const char *)bytes, "base64,"), *digit;
    assert_non_null(at);
    uint32_t bits = 0;
    int count = 0;
    *size = 0;
    // What is written never passes what is read.
    for (at += strlen("base64,"); *at && (digit = strchr(digits, *at)) != NULL; at++) {
        bits = bits << 6 | (uint32_t)(digit - digits);
        count += 6;
        if (count >= 8)
            bytes[(*size)++] = (uint8_t)(bits >> (count -= 8));
    }
    return bytes;
}
