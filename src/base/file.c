// Files. In: paths, and bytes to write. Out: the bytes of a file, files on disk that appear
// completely or not at all, or files in memory. Method: each file is written under a temporary name
// in the same folder, synchronised to disk and renamed, and the folder is synchronised; a set
// renames its first file only after every file is written.
#include "base/file.h"
#include "base/os.h"
#include "base/temporary.h"

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

// The caller can stop the reading of a file after each of these numbers of bytes.
enum { READ_STEP = 16 << 20 };

kiln_result ki_file_read(kiln_context *context, const char *path, uint8_t **bytes, size_t *size,
                         kiln_error *error)
{
    *bytes = NULL;
    *size = 0;
    bool from_stdin = !strcmp(path, "-");
    if (!from_stdin && ki_os_kind_of(path) == KI_OS_FOLDER)
        return ki_fail(error, KILN_ERROR_IO, "%s: is a folder, name one of its files", path);
    int fd = from_stdin ? ki_os_standard_input() : ki_os_open(path);
    if (fd < 0)
        return ki_fail(error, KILN_ERROR_IO, "%s: cannot be opened: %s", path, strerror(errno));

    kiln_result result = KILN_OK;
    uint8_t *buffer = NULL;
    size_t filled = 0, capacity = 0;
    uint64_t expected = ki_os_size(fd);
    // The buffer has one byte more than the file's size: the read that meets the end of a regular
    // file then needs no larger buffer.
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
            bool go_on = true;
            for (size_t at = 0; at < filled && go_on; at += READ_STEP) {
                go_on = !at || ki_progress(context, "reading", 0);
                memcpy(larger + at, buffer + at, filled - at < READ_STEP ? filled - at : READ_STEP);
            }
            ki_free(buffer);
            buffer = larger;
            capacity *= 2;
            if (!go_on) {
                result = ki_fail_cancelled(error, "reading");
                goto done;
            }
        }
        size_t room = capacity - filled;
        ptrdiff_t got = ki_os_read(fd, buffer + filled, room < READ_STEP ? room : READ_STEP);
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
        size_t before = filled;
        filled += (size_t)got;
        if (filled / READ_STEP != before / READ_STEP && !ki_progress(context, "reading", 0)) {
            result = ki_fail_cancelled(error, "reading");
            goto done;
        }
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

bool ki_file_open(const char *path, ki_open_file *file)
{
    uint8_t first;
    bool regular = strcmp(path, "-") != 0 && ki_os_kind_of(path) == KI_OS_FILE;
    *file = (ki_open_file){.descriptor = regular ? ki_os_open(path) : -1};
    if (file->descriptor < 0)
        return false;
    file->size = ki_os_size(file->descriptor);
    if (file->size && ki_file_read_at(file, 0, &first, 1))
        return true;
    ki_file_close(file);
    return false;
}

bool ki_file_read_at(const ki_open_file *file, uint64_t at, void *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        ptrdiff_t got =
            ki_os_read_at(file->descriptor, (uint8_t *)bytes + done, size - done, at + done);
        if (got <= 0 && !(got < 0 && errno == EINTR))
            return false;
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
}

void ki_file_close(ki_open_file *file)
{
    if (file->descriptor >= 0)
        ki_os_close(file->descriptor);
    file->descriptor = -1;
}

// A member of a set of files that appear together: a file under its temporary name, a folder that
// was created, or a file in memory.
typedef struct set_entry {
    struct set_entry *next;
    // path: the caller's path. temporary: the temporary file. target: what the temporary file is
    // renamed to, the path behind all symbolic links. `target` and `temporary` are NULL for entries
    // that are not renamed.
    char *path, *target, *temporary;
    // descriptor of the temporary file, which stays open until the file has its final name
    int file;
    bool is_folder;
    uint8_t *bytes;
    size_t size;
} set_entry;

struct ki_file_set {
    kiln_context *context;
    bool in_memory;
    void (*watch)(void *user, const char *path, const void *bytes, size_t size);
    void *watch_user;
    set_entry *first, **last;
};

// Creates an entry of a set that holds a copy of its path and has `room` more bytes after the path.
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
    // Removes separators at the end of the path, so that the part before the name is the folder
    // above.
    for (size_t n = strlen(path); n > 1 && ki_os_is_separator(path[n - 1]); n--)
        entry->path[n - 1] = 0;
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

// Large files are synchronised to disk after every 64 MiB too, because the caller cannot stop a
// synchronisation, and the last one would otherwise take long.
enum { WRITE_STEP = 4 << 20, SYNC_STEP = 64 << 20 };

// Writes all bytes and synchronises them to disk. On failure returns false with errno set; errno is
// ECANCELED if the progress callback asked to stop.
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

// Returns whether two paths of files have the same text before the file's name, and so name the
// same folder.
static bool same_folder(const char *a, const char *b)
{
    size_t length = ki_folder_length(a);
    return length == ki_folder_length(b) && !memcmp(a, b, length);
}

// Removes the temporary files that killed runs left in the folder of an entry's target, unless an
// earlier entry of the set has the same folder.
static void sweep(const ki_file_set *set, const set_entry *entry)
{
    for (const set_entry *e = set->first; e; e = e->next)
        if (e->target && same_folder(e->target, entry->target))
            return;
    ki_temporary_sweep(entry->target);
}

// Creates the entry of a file that is written under a temporary name and then renamed, with room
// for its three paths (path, target and temporary).
static kiln_result create_target(ki_file_set *set, const char *path, set_entry **entry,
                                 kiln_error *error)
{
    char target[KI_OS_PATH];
    ki_os_kind kind = ki_os_kind_of(path);
    if (kind != KI_OS_NOTHING && kind != KI_OS_FILE)
        return ki_fail(error, KILN_ERROR_IO,
                       "%s: the path exists and is not a regular file, name another path", path);
    if (!ki_os_follow(path, target))
        return ki_fail(error, KILN_ERROR_IO, "%s: cannot be created: %s", path, strerror(errno));
    size_t length = strlen(target) + 1;
    *entry = create_entry(set, path, 2 * length + KI_TEMPORARY_ROOM, error);
    if (!*entry)
        return KILN_ERROR_MEMORY;
    (*entry)->target = (*entry)->path + strlen(path) + 1;
    (*entry)->temporary = (*entry)->target + length;
    memcpy((*entry)->target, target, length);
    return KILN_OK;
}

// Closes and removes an entry's temporary file.
static void remove_temporary(const set_entry *entry)
{
    ki_os_close(entry->file);
    ki_os_remove(entry->temporary);
}

void ki_file_set_watch(ki_file_set *set,
                       void (*watch)(void *user, const char *path, const void *bytes, size_t size),
                       void *user)
{
    set->watch = watch;
    set->watch_user = user;
}

kiln_result ki_file_set_add(ki_file_set *set, const char *path, const void *bytes, size_t size,
                            kiln_error *error)
{
    if (set->watch)
        set->watch(set->watch_user, path, bytes, size);
    if (set->in_memory)
        return add_in_memory(set, path, bytes, size, error);
    set_entry *entry = NULL;
    kiln_result result = create_target(set, path, &entry, error);
    if (result != KILN_OK)
        return result;
    sweep(set, entry);
    entry->file = ki_temporary_create(entry->target, entry->temporary,
                                      strlen(entry->target) + 1 + KI_TEMPORARY_ROOM);
    if (entry->file < 0) {
        result = ki_fail(error, KILN_ERROR_IO, "%s: cannot be created: %s", path, strerror(errno));
        ki_free(entry);
        return result;
    }
    if (write_all(set->context, entry->file, bytes, size) &&
        ki_os_copy_mode(entry->file, entry->target)) {
        append_entry(set, entry);
        return KILN_OK;
    }
    int reason = errno;
    remove_temporary(entry);
    ki_free(entry);
    if (reason == ECANCELED)
        return ki_fail_cancelled(error, "writing");
    return ki_fail(error, KILN_ERROR_IO, "%s: cannot write %zu bytes: %s", path, size,
                   strerror(reason));
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

// Copies the path of the folder in which a file lies: "." for a file of the current folder.
static void copy_folder(const char *path, char folder[KI_OS_PATH])
{
    size_t length = ki_folder_length(path);
    snprintf(folder, KI_OS_PATH, "%.*s", length ? (int)length : 1, length ? path : ".");
}

// Locks the folder of a set's first file while the set is renamed: if two processes write files of
// the same names, the files that remain are all from one of them.
static int enter_folder(const ki_file_set *set)
{
    char folder[KI_OS_PATH];
    for (const set_entry *entry = set->first; entry; entry = entry->next) {
        if (!entry->target)
            continue;
        copy_folder(entry->target, folder);
        return ki_os_enter_folder(folder);
    }
    return -1;
}

// Synchronises to disk the folders in which a set has created or renamed files, each run of entries
// with the same folder once.
static kiln_result sync_folders(const ki_file_set *set, kiln_error *error)
{
    const char *synced = NULL;
    for (const set_entry *entry = set->first; entry; entry = entry->next) {
        char folder[KI_OS_PATH];
        const char *path = entry->target ? entry->target : entry->path;
        if (synced && same_folder(path, synced))
            continue;
        synced = path;
        copy_folder(path, folder);
        if (!ki_os_sync_folder(folder))
            return ki_fail(error, KILN_ERROR_IO,
                           "%s: the file is written, but the name may be lost in a power failure, "
                           "because its folder cannot be synchronised to disk: %s",
                           entry->path, strerror(errno));
    }
    return KILN_OK;
}

// Renames all temporary files of a set, or removes them all if `result` is a failure.
static kiln_result rename_all(const ki_file_set *set, kiln_result result, kiln_error *error)
{
    for (const set_entry *entry = set->first; entry; entry = entry->next) {
        if (!entry->target)
            continue;
        if (result == KILN_OK && !ki_os_replace(entry->temporary, entry->target))
            result = ki_fail(error, KILN_ERROR_IO,
                             "%s: the finished file cannot be renamed to this path: %s",
                             entry->path, strerror(errno));
        if (result == KILN_OK)
            ki_os_close(entry->file);
        else
            remove_temporary(entry);
    }
    if (result != KILN_OK)
        remove_folders(set);
    return result;
}

// Renames all files of a set and frees the set, on failure too.
static kiln_result commit(ki_file_set *set, kiln_error *error)
{
    // The last progress report at which the caller can stop before any file is renamed.
    kiln_result result = KILN_OK;
    if (!ki_progress(set->context, "writing", 1))
        result = ki_fail_cancelled(error, "writing");
    int folder = enter_folder(set);
    result = rename_all(set, result, error);
    ki_os_leave_folder(folder);
    if (result == KILN_OK)
        result = sync_folders(set, error);
    free_entries(set);
    return result;
}

// Removes all temporary files of a set and frees the set.
static void abandon(ki_file_set *set)
{
    for (set_entry *entry = set->first; entry; entry = entry->next)
        if (entry->target)
            remove_temporary(entry);
    remove_folders(set);
    free_entries(set);
}

// Moves the files of a set that is kept in memory to `files` and frees the set, on failure too. The
// entries of the set become the owners of the files' bytes; the list of files is a separate block.
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
