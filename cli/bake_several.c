// Several environments by one command. In: inputs, and outputs whose paths hold {name}. Out: for
// each input one bake, whose output paths have the input's name in place of {name}.
#include "bake.h"
#include "os.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATHS = 4, NAME = 6 }; // output, irradiance, harmonics, lights; characters of "{name}"

/// The paths of one input, with memory of their own; NULL where the command line has no such path.
typedef struct job {
    const char *input;
    char *path[PATHS];
} job;

// Finds the name of an input: the last part of its path without ending. A pattern loses the place
// of the face and the characters _ - and . next to it. Sets *length.
static const char *name_of(const char *input, size_t *length)
{
    if (!strcmp(input, "-")) {
        *length = 5;
        return "stdin";
    }
    size_t size = strlen(input);
    while (size > 1 && input[size - 1] == '/')
        size--;
    size_t begin = size;
    while (begin && input[begin - 1] != '/')
        begin--;
    const char *name = input + begin, *face = strstr(name, "{face}");
    face = face ? face : strstr(name, "%s");
    size_t end = size - begin;
    if (face) {
        end = (size_t)(face - name);
        while (end && strchr("_-.", name[end - 1]))
            end--;
    } else {
        for (size_t i = end; i-- > 1 && os_kind_of(input) != OS_FOLDER;)
            if (name[i] == '.') {
                end = i;
                break;
            }
    }
    *length = end;
    return name;
}

// Returns a copy of `path` with the name in place of each {name}; NULL if memory runs out.
static char *insert(const char *path, const char *name, size_t length)
{
    char *made = malloc(strlen(path) + strlen(path) / NAME * length + 1), *to = made;
    for (; made && *path;) {
        if (!strncmp(path, "{name}", NAME)) {
            memcpy(to, name, length);
            to += length;
            path += NAME;
        } else {
            *to++ = *path++;
        }
    }
    if (made)
        *to = 0;
    return made;
}

char *bake_name_path(const char *path, const char *input)
{
    size_t length;
    const char *name = name_of(input, &length);
    return insert(path, name, length);
}

int bake_check_name(const cli_command *command, const char *input)
{
    size_t length;
    const char *name = name_of(input, &length);
    if (length && strspn(name, "./") < length)
        return CLI_GO;
    return cli_wrong(command, "%s has no name that could take the place of {name}; name the folder",
                     input);
}

static bool make_job(const bake *b, const char *input, job *made)
{
    const char *paths[PATHS] = {b->output, b->irradiance_path, b->sh_path, b->lights_path};
    made->input = input;
    for (int i = 0; i < PATHS; i++) {
        made->path[i] = paths[i] ? bake_name_path(paths[i], input) : NULL;
        if (paths[i] && !made->path[i])
            return false;
    }
    return true;
}

// Checks before the work that no two inputs write the same file, and that the folders exist.
static int check_jobs(const bake *b, const job *jobs, int count)
{
    for (int i = 0; i < count; i++)
        for (int p = 0; p < PATHS; p++) {
            const char *path = jobs[i].path[p];
            for (int k = 0; k < PATHS * i && path; k++) {
                const char *other = jobs[k / PATHS].path[k % PATHS];
                if (other && !strcmp(path, other))
                    return cli_wrong(b->arguments.command, "%s and %s would both be written to %s",
                                     jobs[k / PATHS].input, jobs[i].input, path);
            }
            int code = path ? cli_check_folder(path) : CLI_GO;
            if (code != CLI_GO)
                return code;
        }
    return CLI_GO;
}

static int run_job(const bake *b, job *j)
{
    bake one = *b;
    one.arguments.rest = &j->input;
    one.arguments.rest_count = 1;
    one.output = j->path[0];
    one.irradiance_path = j->path[1];
    one.sh_path = j->path[2];
    one.lights_path = j->path[3];
    return bake_run(&one);
}

int bake_run_several(const bake *b)
{
    int count = b->arguments.rest_count, code = CLI_GO;
    job *jobs = calloc((size_t)count, sizeof *jobs);
    for (int i = 0; jobs && i < count && code == CLI_GO; i++)
        if (!make_job(b, b->arguments.rest[i], &jobs[i]))
            code = cli_fail("out of memory");
        else
            code = bake_check_name(b->arguments.command, b->arguments.rest[i]);
    if (!jobs)
        return cli_fail("out of memory");
    if (code == CLI_GO)
        code = check_jobs(b, jobs, count);
    bool go = code == CLI_GO;
    // A failed input does not keep the others from being baked; a signal does.
    for (int i = 0; go && i < count && !cli_interrupted(); i++) {
        int one = run_job(b, &jobs[i]);
        code = one > CLI_FAILED || code == CLI_GO || code == CLI_DONE ? one : code;
    }
    for (int i = 0; i < count; i++)
        for (int p = 0; p < PATHS; p++)
            free(jobs[i].path[p]);
    free(jobs);
    return code;
}
