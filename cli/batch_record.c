// What earlier runs baked. In: a job, and the record that the run which baked the job has left in
// the folder .kiln next to the job's output. Out: whether a bake would write the same files again.
// Method: the record is text: the version of kiln and the options, then for each file that was read
// or written its checksum. A file counts as unchanged if its size and times are those of the
// record, else if its checksum is. The record is written after the files: a run that is killed in
// between leaves a record that does not fit the files, and the job is baked again.
#include "batch.h"
#include "hash.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

// -------------------------------------------------------------------------------------------- text

// A text that grows.
typedef struct text {
    char *bytes;
    size_t size, room;
    bool failed;
} text;

static void append(text *t, const char *bytes)
{
    size_t size = strlen(bytes);
    if (t->size + size + 1 > t->room) {
        size_t room = 2 * (t->size + size + 1);
        char *larger = realloc(t->bytes, room);
        if (!larger) {
            t->failed = true;
            return;
        }
        t->bytes = larger;
        t->room = room;
    }
    memcpy(t->bytes + t->size, bytes, size + 1);
    t->size += size;
}

// Appends a word and a value as a line. A value with a line break in it cannot be recorded.
static void append_line(text *t, const char *word, const char *value)
{
    t->failed = t->failed || strchr(value, '\n');
    append(t, word);
    append(t, " ");
    append(t, value);
    append(t, "\n");
}

// ------------------------------------------------------------------------------------------- files

static batch_file *add_file(batch_files *files, const char *path)
{
    if (files->count == files->room) {
        int room = files->room ? 2 * files->room : 8;
        batch_file *larger = realloc(files->file, (size_t)room * sizeof *larger);
        if (!larger) {
            files->failed = true;
            return NULL;
        }
        files->file = larger;
        files->room = room;
    }
    size_t size = strlen(path) + 1;
    char *copy = malloc(size);
    if (!copy) {
        files->failed = true;
        return NULL;
    }
    memcpy(copy, path, size);
    batch_file *file = &files->file[files->count++];
    *file = (batch_file){.path = copy};
    return file;
}

static void free_files(batch_files *files)
{
    for (int i = 0; i < files->count; i++)
        free(files->file[i].path);
    free(files->file);
    *files = (batch_files){0};
}

static void add_input(void *user, const char *path)
{
    add_file(user, path);
}

static bool equal_stamps(const os_stamp *a, const os_stamp *b)
{
    return a->is_settled && b->is_settled && a->size == b->size && a->modified == b->modified &&
           a->changed == b->changed && a->identity == b->identity;
}

// Describes a file as it is now. If the stamp is that of `old`, the checksum of `old` is taken over
// without reading the file.
static bool describe(batch_file *file, const batch_file *old)
{
    if (!os_stamp_of(file->path, &file->stamp))
        return false;
    if (old && equal_stamps(&file->stamp, &old->stamp))
        file->hash = old->hash;
    else if ((old && file->stamp.size != old->stamp.size) || !hash_file(file->path, &file->hash))
        return false;
    file->is_known = true;
    return true;
}

static void append_files(text *t, const char *word, const batch_files *files)
{
    for (int i = 0; i < files->count; i++) {
        const batch_file *f = &files->file[i];
        char line[192];
        snprintf(line, sizeof line,
                 "%s %016" PRIx64 " %" PRIu64 " %" PRId64 " %" PRId64 " %" PRIu64 " %d", word,
                 f->hash, f->stamp.size, f->stamp.modified, f->stamp.changed, f->stamp.identity,
                 f->stamp.is_settled);
        append_line(t, line, f->path);
    }
}

// Reads the lines of one kind, "in" or "out", from *at on. Returns false if they are damaged.
static bool read_files(char **at, const char *word, batch_files *files)
{
    size_t length = strlen(word);
    while (!strncmp(*at, word, length) && (*at)[length] == ' ') {
        char *end = strchr(*at, '\n');
        batch_file f = {0};
        int settled, used = 0;
        if (!end || sscanf(*at + length,
                           " %" SCNx64 " %" SCNu64 " %" SCNd64 " %" SCNd64 " %" SCNu64 " %d%n",
                           &f.hash, &f.stamp.size, &f.stamp.modified, &f.stamp.changed,
                           &f.stamp.identity, &settled, &used) != 6)
            return false;
        *end = 0;
        char *path = *at + length + used;
        batch_file *added = *path == ' ' ? add_file(files, path + 1) : NULL;
        if (!added)
            return false;
        f.path = added->path;
        f.stamp.is_settled = settled == 1;
        *added = f;
        *at = end + 1;
    }
    return true;
}

// ------------------------------------------------------------------------------------------ record

// Sets the record's path: in the folder .kiln of the folder of the first output.
static void find_path(batch_record *r, const char *output)
{
    char folder[4096];
    size_t size = strlen(output);
    bool is_folder = os_kind_of(output) == OS_FOLDER || (size && output[size - 1] == '/');
    const char *slash = strrchr(output, '/');
    const char *name = is_folder ? "folder" : slash ? slash + 1 : output;
    size_t length = is_folder ? size : slash ? (size_t)(slash + 1 - output) : 0;
    if (length + 16 > sizeof folder)
        return;
    const char *end = is_folder && output[length - 1] != '/' ? "/" : "";
    snprintf(folder, sizeof folder, "%.*s%s", (int)length, output, end);
    if (snprintf(r->path, sizeof r->path, "%s.kiln/%s.record", folder, name) >=
        (int)sizeof r->path - 8)
        r->path[0] = 0;
}

// Makes the text of everything besides the files that decides what is written.
static char *make_head(const batch_job *job)
{
    text t = {0};
    append_line(&t, "kiln", kiln_version());
    for (int i = 0, p = 0; bake_options[i].name; i++) {
        const char *value =
            bake_options[i].kind == CLI_FILE ? job->path[p++] : batch_line_text(job->line, i);
        if (value && bake_changes_files(i))
            append_line(&t, bake_options[i].name, value);
    }
    if (t.failed) {
        free(t.bytes);
        return NULL;
    }
    return t.bytes;
}

void batch_record_begin(batch_record *r, const batch_job *job)
{
    *r = (batch_record){0};
    if (!batch_list_inputs(job, add_input, &r->in))
        r->in.failed = true;
    find_path(r, job->path[0]);
    r->head = make_head(job);
    if (!r->head)
        r->path[0] = 0;
}

static char *read_record(const char *path)
{
    enum { MOST = 1 << 20 };
    FILE *file = path[0] ? os_open_file(path) : NULL;
    char *bytes = file ? malloc(MOST) : NULL;
    size_t size = bytes ? fread(bytes, 1, MOST - 1, file) : 0;
    if (file)
        fclose(file);
    if (bytes)
        bytes[size] = 0;
    return bytes;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// Compares the inputs with those of the record: their order, their names and their content.
static bool same_inputs(batch_record *r, const batch_files *old)
{
    bool same = r->in.count == old->count && !r->in.failed;
    for (int i = 0; i < r->in.count && same; i++)
        same = !strcmp(base_name(r->in.file[i].path), base_name(old->file[i].path)) &&
               describe(&r->in.file[i], &old->file[i]) && r->in.file[i].hash == old->file[i].hash;
    return same;
}

// Sets the outputs to the files of the record, and compares their content.
static bool same_outputs(batch_record *r, const batch_files *old)
{
    bool same = old->count > 0;
    for (int i = 0; i < old->count && same; i++) {
        batch_file *file = add_file(&r->out, old->file[i].path);
        same = file && describe(file, &old->file[i]) && file->hash == old->file[i].hash;
    }
    return same;
}

static bool write_text(const char *path, const text *t)
{
    char part[4096 + 8], folder[4096];
    snprintf(part, sizeof part, "%s.tmp", path);
    snprintf(folder, sizeof folder, "%s", path);
    *strrchr(folder, '/') = 0;
    os_make_folder(folder);
    FILE *file = os_create_file(part);
    if (!file)
        return false;
    bool good = fwrite(t->bytes, 1, t->size, file) == t->size;
    good = fclose(file) == 0 && good && os_replace(part, path);
    if (!good)
        os_remove_file(part);
    return good;
}

static void save(const batch_record *r)
{
    text t = {0};
    append(&t, r->head);
    append_files(&t, "in", &r->in);
    append_files(&t, "out", &r->out);
    append(&t, "end\n");
    // Without a record the next run bakes again, which is no failure of this run.
    if (!t.failed)
        write_text(r->path, &t);
    free(t.bytes);
}

static bool all_settled(const batch_files *files)
{
    for (int i = 0; i < files->count; i++)
        if (!files->file[i].stamp.is_settled)
            return false;
    return true;
}

static batch_reason compare(batch_record *r, char *bytes, batch_files *in, batch_files *out)
{
    size_t version = strcspn(r->head, "\n") + 1, head = strlen(r->head);
    if (strncmp(bytes, r->head, version) != 0)
        return BATCH_OTHER_VERSION;
    char *at = bytes + head;
    if (strncmp(bytes, r->head, head) != 0 || strncmp(at, "in ", 3) != 0)
        return BATCH_OTHER_OPTIONS;
    if (!read_files(&at, "in", in) || !read_files(&at, "out", out) || strcmp(at, "end\n") != 0)
        return BATCH_NO_RECORD;
    if (!same_inputs(r, in))
        return BATCH_OTHER_INPUT;
    return same_outputs(r, out) ? BATCH_UNCHANGED : BATCH_OTHER_OUTPUT;
}

batch_reason batch_record_compare(batch_record *r, bool only_look)
{
    batch_files in = {0}, out = {0};
    char *bytes = read_record(r->path);
    batch_reason reason = bytes && r->head ? compare(r, bytes, &in, &out) : BATCH_NO_RECORD;
    // The record receives stamps that tell without reading the files that they are unchanged.
    bool stale = !all_settled(&in) || !all_settled(&out);
    bool better = all_settled(&r->in) && all_settled(&r->out);
    if (reason == BATCH_UNCHANGED && stale && better && !only_look)
        save(r);
    if (reason != BATCH_UNCHANGED)
        free_files(&r->out);
    free_files(&in);
    free_files(&out);
    free(bytes);
    return reason;
}

void batch_record_inputs(batch_record *r)
{
    for (int i = 0; i < r->in.count; i++)
        if (!r->in.file[i].is_known && !describe(&r->in.file[i], NULL))
            r->in.failed = true;
}

void batch_record_restart(batch_record *r)
{
    free_files(&r->out);
}

void batch_record_watch(void *user, const char *path, const void *bytes, size_t size)
{
    batch_record *r = user;
    batch_file *file = add_file(&r->out, path);
    if (file)
        file->hash = hash_bytes(bytes, size);
}

void batch_record_write(batch_record *r)
{
    bool good = r->path[0] && !r->in.failed && !r->out.failed && r->out.count;
    for (int i = 0; i < r->in.count && good; i++) {
        const os_stamp *before = &r->in.file[i].stamp;
        os_stamp now;
        good = os_stamp_of(r->in.file[i].path, &now) && now.size == before->size &&
               now.modified == before->modified && now.changed == before->changed;
    }
    for (int i = 0; i < r->out.count && good; i++)
        good = os_stamp_of(r->out.file[i].path, &r->out.file[i].stamp);
    if (good)
        save(r);
}

void batch_record_free(batch_record *r)
{
    free_files(&r->in);
    free_files(&r->out);
    free(r->head);
    r->head = NULL;
}
