// Files. In: paths, and bytes to write. Out: the bytes of a file, files on disk that appear
// completely or not at all, or files in memory. Method: each file is written under a temporary name
// in the same folder, synchronised to disk and renamed; a set renames its first file only after
// every file is written.
#include "base/file.h"
#include "base/os.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static char small_letter(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

bool ki_ends_with(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    if (length <= tail)
        return false;
    for (path += length - tail; *ending; path++, ending++)
        if (small_letter(*path) != *ending)
            return false;
    return true;
}

kiln_result ki_file_read(kiln_context *context, const char *path, uint8_t **bytes, size_t *size,
                         kiln_error *error)
{
    *bytes = NULL;
    *size = 0;
    bool from_stdin = !strcmp(path, "-");
    if (!from_stdin && ki_os_kind_of(path) == KI_OS_FOLDER)
        return ki_fail(error, KILN_ERROR_IO, "%s: is a folder", path);
    int fd = from_stdin ? ki_os_standard_input() : ki_os_open(path);
    if (fd < 0)
        return ki_fail(error, KILN_ERROR_IO, "%s: cannot be opened: %s", path, strerror(errno));

    kiln_result result = KILN_OK;
    uint8_t *buffer = NULL;
    size_t filled = 0, capacity = 0;
    uint64_t expected = ki_os_size(fd);
    // The buffer has one byte more than the file, so that the end of a regular file is found
    // without growing the buffer.
    capacity = expected ? (size_t)(expected < SIZE_MAX ? expected : SIZE_MAX - 1) + 1 : 65536;
    buffer = ki_alloc_raw(context, capacity, 1);
    if (!buffer) {
        result = ki_fail_memory(context, error, path, capacity);
        goto done;
    }
    for (;;) {
        if (filled == capacity) {
            uint8_t *larger = ki_alloc_raw(context, capacity, 2);
            if (!larger) {
                result = ki_fail_memory(context, error, path, capacity * 2);
                goto done;
            }
            memcpy(larger, buffer, filled);
            ki_free(buffer);
            buffer = larger;
            capacity *= 2;
        }
        ptrdiff_t got = ki_os_read(fd, buffer + filled, capacity - filled);
        if (got < 0 && errno == EINTR) {
            if (ki_progress(context, "reading", 0))
                continue;
            result = ki_fail_cancelled(error, "reading");
            goto done;
        }
        if (got < 0) {
            result = ki_fail(error, KILN_ERROR_IO, "%s: cannot be read after %zu bytes: %s", path,
                             filled, strerror(errno));
            goto done;
        }
        if (got == 0)
            break;
        filled += (size_t)got;
    }
    *bytes = buffer;
    *size = filled;
    buffer = NULL;
done:
    ki_free(buffer);
    if (!from_stdin)
        ki_os_close(fd);
    return result;
}

// A member of a set: a file under its temporary name, a folder that was created, or a file in
// memory.
typedef struct set_entry {
    struct set_entry *next;
    char *path, *temporary; // temporary is NULL for entries that are not renamed
    bool is_folder;
    uint8_t *bytes;
    size_t size;
} set_entry;

struct ki_file_set {
    kiln_context *context;
    bool in_memory;
    set_entry *first, **last;
};

// Creates an entry that holds a copy of its path and `room` more bytes after the path.
static set_entry *create_entry(ki_file_set *set, const char *path, size_t room, kiln_error *error)
{
    size_t length = strlen(path) + 1;
    set_entry *entry = NULL;
    if (room <= SIZE_MAX / 2)
        entry = ki_alloc(set->context, 1, sizeof *entry + length + room);
    if (!entry) {
        ki_describe_memory(set->context, error, path, room);
        return NULL;
    }
    entry->path = (char *)(entry + 1);
    memcpy(entry->path, path, length);
    return entry;
}

static void append_entry(ki_file_set *set, set_entry *entry)
{
    *set->last = entry;
    set->last = &entry->next;
}

kiln_result ki_file_set_make_folder(ki_file_set *set, const char *path, kiln_error *error)
{
    if (set->in_memory)
        return KILN_OK;
    set_entry *entry = create_entry(set, path, 0, error);
    if (!entry)
        return KILN_ERROR_MEMORY;
    entry->is_folder = true;
    if (ki_os_make_folder(path)) {
        append_entry(set, entry);
        return KILN_OK;
    }
    int reason = errno;
    ki_free(entry);
    return reason == EEXIST ? KILN_OK
                            : ki_fail(error, KILN_ERROR_IO, "%s: the folder cannot be made: %s",
                                      path, strerror(reason));
}

// Large files are synchronised to disk during writing too. The last synchronisation cannot be
// interrupted and is therefore short.
enum { WRITE_STEP = 4 << 20, SYNC_STEP = 64 << 20 };

// Writes all bytes and synchronises. On failure returns false with errno set, to ECANCELED if the
// progress callback asked to stop.
static bool write_all(kiln_context *context, int fd, const uint8_t *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        if (!ki_progress(context, "writing", (double)done / (double)size)) {
            errno = ECANCELED;
            return false;
        }
        size_t left = size - done;
        ptrdiff_t put = ki_os_write(fd, bytes + done, left < WRITE_STEP ? left : WRITE_STEP);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return false;
        done += (size_t)put;
        if (done / SYNC_STEP != (done - (size_t)put) / SYNC_STEP && !ki_os_sync(fd))
            return false;
    }
    return ki_os_sync(fd);
}

// Creates a file PATH.kiln-PID-N.tmp whose name is not in use, and returns its descriptor.
static int create_temporary(char *name, size_t room, const char *path)
{
    for (int n = 0; n < 1000; n++) {
        snprintf(name, room, "%s.kiln-%ld-%d.tmp", path, ki_os_process(), n);
        int fd = ki_os_create(name);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

static kiln_result add_in_memory(ki_file_set *set, const char *path, const void *bytes, size_t size,
                                 kiln_error *error)
{
    set_entry *entry = create_entry(set, path, size, error);
    if (!entry)
        return KILN_ERROR_MEMORY;
    entry->bytes = (uint8_t *)entry->path + strlen(path) + 1;
    entry->size = size;
    if (size)
        memcpy(entry->bytes, bytes, size);
    append_entry(set, entry);
    return KILN_OK;
}

kiln_result ki_file_set_add(ki_file_set *set, const char *path, const void *bytes, size_t size,
                            kiln_error *error)
{
    enum { ROOM = 64 };
    if (set->in_memory)
        return add_in_memory(set, path, bytes, size, error);
    size_t length = strlen(path) + 1;
    set_entry *entry = create_entry(set, path, length + ROOM, error);
    if (!entry)
        return KILN_ERROR_MEMORY;
    entry->temporary = entry->path + length;

    ki_os_kind kind = ki_os_kind_of(path);
    if (kind != KI_OS_NOTHING && kind != KI_OS_FILE) {
        ki_free(entry);
        return ki_fail(error, KILN_ERROR_IO,
                       "%s: the path exists and is not a regular file, name another path", path);
    }
    int fd = create_temporary(entry->temporary, length + ROOM, path);
    if (fd < 0) {
        kiln_result result =
            ki_fail(error, KILN_ERROR_IO, "%s: cannot be created: %s", path, strerror(errno));
        ki_free(entry);
        return result;
    }
    bool good = write_all(set->context, fd, bytes, size);
    int reason = errno;
    good = ki_os_close(fd) && good;
    if (!good) {
        ki_os_remove(entry->temporary);
        ki_free(entry);
        if (reason == ECANCELED)
            return ki_fail_cancelled(error, "writing");
        return ki_fail(error, KILN_ERROR_IO, "%s: cannot write %zu bytes: %s", path, size,
                       strerror(reason));
    }
    append_entry(set, entry);
    return KILN_OK;
}

static void free_entries(ki_file_set *set)
{
    for (set_entry *entry = set->first, *next; entry; entry = next) {
        next = entry->next;
        ki_free(entry);
    }
    ki_free(set);
}

static void remove_folders(const ki_file_set *set)
{
    for (const set_entry *entry = set->first; entry; entry = entry->next)
        if (entry->is_folder)
            ki_os_remove_folder(entry->path);
}

// Renames all files of a set and frees the set, on failure too.
static kiln_result commit(ki_file_set *set, kiln_error *error)
{
    // The last report at which the caller can stop before any file is renamed.
    kiln_result result = KILN_OK;
    if (!ki_progress(set->context, "writing", 1))
        result = ki_fail_cancelled(error, "writing");
    for (set_entry *entry = set->first; entry; entry = entry->next) {
        if (!entry->temporary)
            continue;
        if (result == KILN_OK && !ki_os_replace(entry->temporary, entry->path))
            result = ki_fail(error, KILN_ERROR_IO,
                             "%s: the finished file cannot be renamed to this path: %s",
                             entry->path, strerror(errno));
        if (result != KILN_OK)
            ki_os_remove(entry->temporary);
    }
    if (result != KILN_OK)
        remove_folders(set);
    free_entries(set);
    return result;
}

// Removes all temporary files and frees the set.
static void abandon(ki_file_set *set)
{
    for (set_entry *entry = set->first; entry; entry = entry->next)
        if (entry->temporary)
            ki_os_remove(entry->temporary);
    remove_folders(set);
    free_entries(set);
}

// Moves the files of a set in memory to `files` and frees the set, on failure too. The entries of
// the set become the owners of the files; the list is a separate block.
static kiln_result take(ki_file_set *set, kiln_files *files, kiln_error *error)
{
    size_t count = 0, at = 0;
    for (const set_entry *entry = set->first; entry; entry = entry->next)
        count++;
    kiln_file *list = ki_alloc(set->context, count, sizeof *list);
    if (!list) {
        ki_describe_memory(set->context, error, "a list of files", count * sizeof *list);
        free_entries(set);
        return KILN_ERROR_MEMORY;
    }
    for (set_entry *entry = set->first; entry; entry = entry->next)
        list[at++] = (kiln_file){entry->path, entry->bytes, entry->size, entry};
    *files = (kiln_files){(int)count, list};
    ki_free(set);
    return KILN_OK;
}

kiln_result ki_file_set_make(kiln_context *context, ki_add_files *add, void *data,
                             kiln_files *files, kiln_error *error)
{
    ki_file_set *set = ki_alloc(context, 1, sizeof *set);
    if (files)
        *files = (kiln_files){0};
    if (!set)
        return ki_fail_memory(context, error, "a set of files", sizeof *set);
    set->context = context;
    set->in_memory = files != NULL;
    set->last = &set->first;
    kiln_result result = add(set, data, error);
    if (result == KILN_OK)
        return files ? take(set, files, error) : commit(set, error);
    abandon(set);
    return result;
}

void kiln_files_free(kiln_files *files)
{
    if (!files)
        return;
    for (int i = 0; i < files->count; i++)
        ki_free(files->file[i].owner);
    ki_free(files->file);
    *files = (kiln_files){0};
}

typedef struct one_file {
    const char *path;
    const void *bytes;
    size_t size;
} one_file;

static kiln_result add_one(ki_file_set *set, void *data, kiln_error *error)
{
    const one_file *file = data;
    return ki_file_set_add(set, file->path, file->bytes, file->size, error);
}

kiln_result ki_file_write(kiln_context *context, const char *path, const void *bytes, size_t size,
                          kiln_error *error)
{
    one_file file = {path, bytes, size};
    return ki_file_set_make(context, add_one, &file, NULL, error);
}
