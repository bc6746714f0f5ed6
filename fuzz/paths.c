// What is read from a path: a table, standard input, six faces, whose names alone matter here, and
// a folder of six faces. The bytes of files lie in a file without a name, or for the folder in a
// folder under /tmp.
#include "fuzz.h"

#include "codec/faces.h"

#include <kiln/brdf.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MEMORY = 64 << 20 };

// Makes standard input a file of these bytes, and sets its position to the beginning.
static void make_input(const uint8_t *bytes, size_t size)
{
    FILE *file = tmpfile();
    fuzz_must(file && fwrite(bytes, 1, size, file) == size && fflush(file) == 0);
    rewind(file);
    fuzz_must(dup2(fileno(file), STDIN_FILENO) == STDIN_FILENO);
    fclose(file);
}

static void rewind_input(void)
{
    fuzz_must(lseek(STDIN_FILENO, 0, SEEK_SET) == 0);
}

// Any file on standard input is described and loaded; what its first bytes are decides how.
void fuzz_input(const uint8_t *bytes, size_t size)
{
    kiln_context *context = fuzz_context(MEMORY);
    kiln_error error = {0}, other = {0};
    kiln_file_info info;
    kiln_map map, same;
    make_input(bytes, size);
    if (kiln_file_describe(context, "-", &info, &error) == KILN_OK)
        fuzz_check_info(&info);
    rewind_input();
    kiln_result result = kiln_map_load(context, "-", NULL, &map, &error);
    kiln_result decoded = kiln_map_decode(context, bytes, size, "-", NULL, &same, &other);
    // Loading holds the bytes of the file too: it may lack memory where decoding does not, and says
    // another number of bytes that are held.
    if (result != KILN_ERROR_MEMORY && decoded != KILN_ERROR_MEMORY) {
        fuzz_must(result == decoded);
        fuzz_must(result == KILN_OK || !strcmp(error.message, other.message));
    }
    kiln_map_free(&map);
    kiln_map_free(&same);
    fuzz_end(context);
}

// A table that is loaded has the size and the channels that it says, and can be looked up.
void fuzz_table(const uint8_t *bytes, size_t size)
{
    kiln_context *context = fuzz_context(MEMORY);
    kiln_error error = {0};
    kiln_table table;
    make_input(bytes, size);
    if (kiln_table_load(context, "-", &table, &error) == KILN_OK) {
        const kiln_table_def *def = &table.def;
        double values[KILN_MAX_TABLE_VALUES];
        fuzz_must(table.image.width == def->width && def->width >= 1 && def->depth >= 1 &&
                  table.image.height == def->height * def->depth);
        for (int i = 0; i <= 4; i++)
            kiln_table_lookup(&table, i / 4.0, 1 - i / 4.0, i / 3.0, values);
        kiln_table_free(&table);
    } else {
        fuzz_must(error.message[0]);
    }
    fuzz_end(context);
}

// Returns the line that begins at *text, ends the line by a NUL, and moves *text behind the line.
// Returns "" at the end of the text.
static char *next_line(char **text)
{
    char *line = *text, *end = strchr(line, '\n');
    *text = end ? end + 1 : line + strlen(line);
    if (end)
        *end = 0;
    return line;
}

// Lines of text as the names of six faces, and the first as a pattern of names. The order is one of
// the six, each once.
void fuzz_faces(const uint8_t *bytes, size_t size)
{
    char *text = fuzz_text(bytes, size), *rest = text, *paths[6];
    int order[6];
    unsigned used = 0;
    for (int i = 0; i < 6; i++)
        paths[i] = next_line(&rest);
    kiln_faces_order((const char *const *)paths, order);
    for (int i = 0; i < 6; i++) {
        fuzz_must(order[i] >= 0 && order[i] < 6);
        used |= 1U << order[i];
    }
    fuzz_must(used == 63);

    kiln_context *context = fuzz_context(MEMORY);
    kiln_error error = {0};
    ki_face_files files = {0};
    const char *place = strstr(paths[0], "%s");
    size_t length = 2;
    if (place && ki_faces_of_pattern(context, paths[0], place, length, &files, &error) == KILN_OK)
        for (int i = 0; i < 6; i++)
            fuzz_must(strlen(files.path[i]) + length > strlen(paths[0]));
    ki_face_files_free(&files);
    fuzz_end(context);
    free(text);
}

// A folder for the files of one run, removed with them.
typedef struct workplace {
    char *folder, path[12][300];
    int count;
} workplace;

// Makes a file of these bytes, unless the name is none or the system does not take it.
static void add_file(workplace *w, const char *name, const char *bytes, size_t size)
{
    char *path = w->path[w->count];
    if (!*name || strchr(name, '/') || strlen(name) > 255)
        return;
    snprintf(path, sizeof w->path[0], "%s/%s", w->folder, name);
    FILE *file = fopen(path, "wbx");
    if (!file)
        return;
    fuzz_must(fwrite(bytes, 1, size, file) == size);
    fclose(file);
    w->count++;
}

static void remove_all(const workplace *w)
{
    for (int i = 0; i < w->count; i++)
        remove(w->path[i]);
    fuzz_must(rmdir(w->folder) == 0);
}

// Lines with the names of at most twelve files, an empty line, and the bytes that each of these
// files has. The six faces that are found are six of these files, and the folder is the same cube,
// or fails with the same result, as the six paths one by one.
void fuzz_folder(const uint8_t *bytes, size_t size)
{
    char *text = fuzz_text(bytes, size), *rest = text, *name;
    char *names[12];
    int count = 0;
    while (*(name = next_line(&rest)) && count < 12)
        names[count++] = name;
    char folder[] = "/tmp/kiln-fuzz-XXXXXX";
    workplace w = {.folder = folder};
    fuzz_must(mkdtemp(w.folder) != NULL);
    for (int i = 0; i < count; i++)
        add_file(&w, names[i], rest, (size_t)(text + size - rest));
    kiln_context *context = fuzz_context(MEMORY);
    kiln_error error = {0}, other = {0};
    ki_face_files files;
    kiln_map map, same;
    kiln_result found = ki_faces_in_folder(context, w.folder, &files, &error);
    kiln_result result = kiln_map_load(context, w.folder, NULL, &map, &error);
    fuzz_must(found == KILN_OK || found == result || result == KILN_ERROR_MEMORY);
    if (found == KILN_OK) {
        for (int i = 0; i < 6; i++)
            for (int k = 0; k <= i; k++)
                fuzz_must(access(files.path[i], R_OK) == 0 &&
                          (k == i || strcmp(files.path[i], files.path[k]) != 0));
        fuzz_must(kiln_map_load_faces(context, files.path, NULL, &same, &other) == result);
        for (size_t i = 0; result == KILN_OK && i < 3 * kiln_map_texels(&map, 0); i++)
            fuzz_must(map.level[0][i] == same.level[0][i]);
        kiln_map_free(&same);
    }
    fuzz_must(result == KILN_OK || error.message[0]);
    kiln_map_free(&map);
    ki_face_files_free(&files);
    fuzz_end(context);
    remove_all(&w);
    free(text);
}
