// The environments of a batch. In: lines with inputs and options. Out: jobs, each of which is one
// call of bake: its inputs and the paths of its files. An input may be a pattern of names with *
// and ?, or a folder of pictures, and {name} in a path to write stands for the input's name.
#include "batch.h"

#include "hash.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A growing list of texts with memory of their own.
typedef struct names {
    char **name;
    int count, room;
    bool failed; // memory ran out
} names;

static void add_name(names *list, const char *folder, size_t length, const char *name)
{
    if (list->count == list->room) {
        int room = list->room ? 2 * list->room : 64;
        char **larger = realloc(list->name, (size_t)room * sizeof *larger);
        if (!larger) {
            list->failed = true;
            return;
        }
        list->name = larger;
        list->room = room;
    }
    char *path = malloc(length + strlen(name) + 1);
    if (!path) {
        list->failed = true;
        return;
    }
    memcpy(path, folder, length);
    memcpy(path + length, name, strlen(name) + 1);
    list->name[list->count++] = path;
}

static void free_names(names *list)
{
    for (int i = 0; i < list->count; i++)
        free(list->name[i]);
    free(list->name);
    *list = (names){0};
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

// ---------------------------------------------------------------------------------------- patterns

// Returns whether a name matches a pattern, in which * stands for any characters and ? for one. A
// dot at the beginning is matched by a dot only.
static bool matches(const char *pattern, const char *name)
{
    const char *star = NULL, *resume = NULL;
    if (name[0] == '.' && pattern[0] != '.')
        return false;
    while (*name) {
        if (*pattern == '*') {
            star = pattern++;
            resume = name;
        } else if (*pattern == '?' || *pattern == *name) {
            pattern++;
            name++;
        } else if (star) {
            pattern = star + 1;
            name = ++resume;
        } else {
            return false;
        }
    }
    while (*pattern == '*')
        pattern++;
    return !*pattern;
}

static bool is_picture(const char *name)
{
    static const char *const endings[] = {"exr", "hdr", "png", "jpg", "jpeg"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++) {
        size_t k = 0;
        while (endings[i][k] && (dot[k + 1] | 0x20) == endings[i][k])
            k++;
        if (!endings[i][k] && !dot[k + 1])
            return true;
    }
    return false;
}

typedef struct listing {
    names *list;
    const char *folder;
    size_t length;           // of the folder's path with its final slash, 0 for the current folder
    const char *pattern;     // of the names, or NULL for all pictures
    const char *begin, *end; // what the names of a set of faces begin and end with, or NULL
    size_t begin_length;
} listing;

// Returns whether a name begins and ends as those of a set of faces.
static bool is_face(const listing *l, const char *name)
{
    size_t size = strlen(name), tail = strlen(l->end);
    return size >= l->begin_length + tail && !strncmp(name, l->begin, l->begin_length) &&
           !strcmp(name + size - tail, l->end);
}

static void take_entry(void *user, const char *name)
{
    const listing *l = user;
    bool wanted;
    if (l->begin && l->end)
        wanted = is_face(l, name);
    else
        wanted = l->pattern ? matches(l->pattern, name) : name[0] != '.' && is_picture(name);
    if (wanted)
        add_name(l->list, l->folder, l->length, name);
}

// Lists a folder, given by the first `length` characters of a path, in the order of the names.
static bool list_folder(listing *l)
{
    char folder[4096] = ".";
    int first = l->list->count;
    if (l->length >= sizeof folder) {
        errno = ENAMETOOLONG;
        return false;
    }
    if (l->length) {
        memcpy(folder, l->folder, l->length);
        folder[l->length] = 0;
    }
    if (!os_list_folder(folder, take_entry, l))
        return false;
    if (l->list->count > first)
        qsort(l->list->name + first, (size_t)(l->list->count - first), sizeof *l->list->name,
              compare_names);
    return true;
}

// Copies the path of a folder with a final slash, and lists that folder. Returns false if the path
// is too long.
static bool name_folder(const char *path, char room[4096], listing *l)
{
    size_t size = strlen(path);
    const char *slash = size && path[size - 1] == '/' ? "" : "/";
    l->folder = room;
    l->length = size + strlen(slash);
    return snprintf(room, 4096, "%s%s", path, slash) < 4096;
}

static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash + 1 - path) : 0;
}

static bool keep_folder(batch_store *store, const char *path, size_t length, batch_jobs *jobs)
{
    batch_folder *folder = batch_keep(store, sizeof *folder);
    char *kept = folder ? batch_keep_text(store, path, length) : NULL;
    if (!kept)
        return false;
    *folder = (batch_folder){jobs->folder, kept};
    jobs->folder = folder;
    return true;
}

// Expands one input to names: a pattern to the files that match, a folder to its pictures.
static int expand(batch_store *store, const batch_line *line, const char *input, names *list,
                  batch_jobs *jobs)
{
    int before = list->count;
    bool folder = os_kind_of(input) == OS_FOLDER;
    size_t length = folder_length(input);
    char path[4096];
    if (!folder && (!strpbrk(input, "*?") || os_kind_of(input) == OS_FILE)) {
        add_name(list, "", 0, input);
        return CLI_GO;
    }
    if (strpbrk(input, "*?") && strcspn(input, "*?") < length)
        return cli_wrong(&line->command, "%s: * and ? may stand in the name of a file only", input);
    listing l = {.list = list, .folder = input, .length = length};
    if (!folder)
        l.pattern = input + length;
    else if (!name_folder(input, path, &l))
        return cli_wrong(&line->command, "%.60s...: the path is too long", input);
    if (!list_folder(&l))
        return cli_wrong(&line->command, "%s: cannot be listed: %s", input, strerror(errno));
    if (!keep_folder(store, l.length ? l.folder : ".", l.length ? l.length : 1, jobs))
        return cli_fail("out of memory");
    if (list->count == before && !list->failed)
        return cli_wrong(&line->command,
                         folder ? "%s: there is no picture in this folder"
                                : "%s: there is no such picture",
                         input);
    return CLI_GO;
}

// -------------------------------------------------------------------------------------------- jobs

static bool is_path(int option)
{
    return bake_options[option].kind == CLI_FILE;
}

static batch_job *add_job(batch_jobs *jobs)
{
    if (jobs->count == jobs->room) {
        size_t room = jobs->room ? 2 * jobs->room : 64;
        batch_job *larger = realloc(jobs->job, room * sizeof *larger);
        if (!larger)
            return NULL;
        jobs->job = larger;
        jobs->room = room;
    }
    batch_job *job = &jobs->job[jobs->count++];
    *job = (batch_job){0};
    return job;
}

// Makes the job of a line for some inputs. `name` is the input whose name {name} stands for, or
// NULL.
static int make_job(batch_store *store, const batch_line *line, const char **input, int count,
                    const char *name, batch_jobs *jobs)
{
    batch_job *job = add_job(jobs);
    if (!job)
        return cli_fail("out of memory");
    job->line = line;
    job->input = input;
    job->input_count = count;
    for (int i = 0, p = 0; bake_options[i].name; i++) {
        if (!is_path(i))
            continue;
        const char *path = batch_line_text(line, i);
        char *made = path && name ? bake_name_path(path, name) : NULL;
        if (path && name) {
            path = made ? batch_keep_text(store, made, strlen(made)) : NULL;
            free(made);
            if (!path)
                return cli_fail("out of memory");
        }
        job->path[p++] = path;
    }
    return CLI_GO;
}

static bool is_for_several(const batch_line *line)
{
    for (int i = 0; i < line->setting_count; i++)
        if (is_path(line->setting[i].option) && strstr(line->setting[i].text, "{name}"))
            return true;
    return false;
}

static int make_several(batch_store *store, const batch_line *line, batch_jobs *jobs)
{
    names list = {0};
    int code = CLI_GO;
    for (int i = 0; i < line->input_count && code == CLI_GO; i++)
        code = expand(store, line, line->input[i], &list, jobs);
    if (code == CLI_GO && list.failed)
        code = cli_fail("out of memory");
    const char **input =
        code == CLI_GO ? batch_keep(store, (size_t)list.count * sizeof *input + 1) : NULL;
    if (code == CLI_GO && !input)
        code = cli_fail("out of memory");
    for (int i = 0; input && i < list.count && code == CLI_GO; i++) {
        input[i] = batch_keep_text(store, list.name[i], strlen(list.name[i]));
        code = bake_check_name(&line->command, list.name[i]);
        if (code == CLI_GO)
            code = input[i] ? make_job(store, line, &input[i], 1, input[i], jobs)
                            : cli_fail("out of memory");
    }
    free_names(&list);
    return code;
}

int batch_make_jobs(batch_store *store, const batch_lines *lines, batch_jobs *jobs)
{
    int code = CLI_GO;
    for (size_t i = 0; i < lines->count && code == CLI_GO; i++) {
        const batch_line *line = lines->line[i];
        code = is_for_several(line)
                   ? make_several(store, line, jobs)
                   : make_job(store, line, line->input, line->input_count, NULL, jobs);
        if (code == CLI_WRONG && line->command.place)
            code = CLI_FAILED;
    }
    return code;
}

// ------------------------------------------------------------------------------------------ checks

// A path that a job writes.
typedef struct target {
    const char *path;
    const batch_job *job;
} target;

static int compare_targets(const void *a, const void *b)
{
    const target *one = a, *two = b;
    int order = strcmp(one->path, two->path);
    return order ? order : one->job < two->job ? -1 : one->job > two->job;
}

static int compare_path(const void *key, const void *b)
{
    return strcmp(key, ((const target *)b)->path);
}

static int check_targets(const batch_jobs *jobs, const target *targets, size_t count)
{
    for (size_t i = 1; i < count; i++)
        if (!strcmp(targets[i].path, targets[i - 1].path))
            return cli_fail("%s and %s would both be written to %s", targets[i - 1].job->input[0],
                            targets[i].job->input[0], targets[i].path);
    for (size_t i = 0; i < jobs->count; i++)
        for (int k = 0; k < jobs->job[i].input_count; k++) {
            const char *input = jobs->job[i].input[k];
            if (count && bsearch(input, targets, count, sizeof *targets, compare_path))
                return cli_fail("%s is read and written by one batch: bake it by a batch of its "
                                "own",
                                input);
        }
    return CLI_GO;
}

int batch_check_files(const batch_jobs *jobs)
{
    size_t count = 0;
    target *targets = malloc(jobs->count * BATCH_PATHS * sizeof *targets + 1);
    if (!targets)
        return cli_fail("out of memory");
    for (size_t i = 0; i < jobs->count; i++)
        for (int p = 0; p < BATCH_PATHS; p++)
            if (jobs->job[i].path[p])
                targets[count++] = (target){jobs->job[i].path[p], &jobs->job[i]};
    if (count)
        qsort(targets, count, sizeof *targets, compare_targets);
    int code = check_targets(jobs, targets, count);
    free(targets);
    return code;
}

int batch_job_bake(const batch_job *job, bake *b)
{
    const batch_line *line = job->line;
    *b = (bake){.arguments = {.command = &line->command,
                              .rest = job->input,
                              .rest_count = job->input_count},
                .makes_folders = true};
    for (int i = 0; i < line->setting_count; i++)
        b->arguments.text[line->setting[i].option] = line->setting[i].text;
    for (int i = 0, p = 0; bake_options[i].name; i++)
        if (is_path(i))
            b->arguments.text[i] = job->path[p++];
    int code = cli_fill_values(&b->arguments, b);
    if (code == CLI_GO)
        code = bake_check_options(b);
    if (code == CLI_GO && b->to_stdout)
        code = cli_wrong(&line->command, "--output -: a batch writes files, name one");
    for (int i = 0; i < job->input_count && code == CLI_GO; i++)
        if (!strcmp(job->input[i], "-"))
            code = cli_wrong(&line->command, "-: a batch reads files, name one");
    return code == CLI_WRONG && line->command.place ? CLI_FAILED : code;
}

uint64_t batch_plan_key(const batch_job *job)
{
    uint64_t key = 0;
    for (int i = 0; i < job->line->setting_count; i++) {
        const batch_setting *s = &job->line->setting[i];
        uint64_t part[3] = {key, (uint64_t)s->option, 0};
        if (!is_path(s->option))
            part[2] = hash_bytes(s->text, strlen(s->text));
        key = hash_bytes(part, sizeof part);
    }
    return key;
}

bool batch_list_inputs(const batch_job *job, void (*file)(void *user, const char *path), void *user)
{
    names list = {0};
    for (int i = 0; i < job->input_count; i++) {
        const char *input = job->input[i];
        listing l = {.list = &list, .folder = input, .length = folder_length(input)};
        const char *face = strstr(input, "{face}");
        size_t mark = face ? 6 : 2;
        face = face ? face : strstr(input, "%s");
        char path[4096];
        if (os_kind_of(input) == OS_FOLDER && name_folder(input, path, &l)) {
            list_folder(&l);
        } else if (face && face >= input + folder_length(input)) {
            l.begin = input + l.length;
            l.begin_length = (size_t)(face - l.begin);
            l.end = face + mark;
            list_folder(&l);
        } else {
            add_name(&list, "", 0, input);
        }
    }
    for (int i = 0; i < list.count && !list.failed; i++)
        file(user, list.name[i]);
    bool good = !list.failed;
    free_names(&list);
    return good;
}
