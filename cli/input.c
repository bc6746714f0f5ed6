// Loads the input of a command: one file, folder or pattern, or six faces of a cube; and says on
// standard error what the loader found.
#include "work.h"

#include <ctype.h>
#include <string.h>

enum { FACES = 6 };

static const char *const face_words[][FACES] = {
    {"px", "nx", "py", "ny", "pz", "nz"},
    {"posx", "negx", "posy", "negy", "posz", "negz"},
    {"right", "left", "top", "bottom", "front", "back"},
    {"right", "left", "up", "down", "front", "back"},
};

// Returns whether `word` is the last word of a file name, where words are runs of letters: the last
// word of "sky_px.exr" is "px".
static bool has_word(const char *path, const char *word)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.'), *end = dot ? dot : name + strlen(name);
    size_t length = strlen(word);
    if ((size_t)(end - name) < length)
        return false;
    for (size_t i = 0; i < length; i++)
        if (tolower((unsigned char)end[(ptrdiff_t)i - (ptrdiff_t)length]) != word[i])
            return false;
    const char *before = end - length;
    return before == name || !isalpha((unsigned char)before[-1]);
}

// Finds which file is which face: by the names if all six names tell it, in the given order if no
// name does. Returns false if only some names tell a face.
static bool order_faces(const char **names, int order[FACES])
{
    for (int set = 0; set < 4; set++) {
        int found = 0;
        for (int face = 0; face < FACES; face++)
            for (int i = 0; i < FACES; i++)
                if (has_word(names[i], face_words[set][face])) {
                    order[face] = i;
                    found++;
                    break;
                }
        if (found == FACES)
            return true;
    }
    for (int face = 0; face < FACES; face++) {
        order[face] = face;
        for (int set = 0; set < 4; set++)
            for (int i = 0; i < FACES; i++)
                if (has_word(names[i], face_words[set][face]))
                    return false;
    }
    return true;
}

int cli_check_input(const cli_command *command, const char **names, int count)
{
    int order[FACES];
    if (count == 0)
        return cli_wrong(command, "no input is named, name a panorama or six faces");
    if (count != 1 && count != FACES)
        return cli_wrong(
            command, "%d inputs are named, name one file, folder or pattern, or six faces", count);
    if (count == 1)
        return CLI_GO;
    for (int i = 0; i < FACES; i++)
        if (!strcmp(names[i], "-"))
            return cli_wrong(command, "standard input (-) cannot be one of six faces");
    if (!order_faces(names, order))
        return cli_wrong(command,
                         "the names of the six inputs do not tell which face each is, end them in "
                         "px nx py ny pz nz or in right left top bottom front back");
    return CLI_GO;
}

// Says what the loader found and changed.
static void say_report(cli_work *work, const char *name, const kiln_load_report *report)
{
    kiln_note note;
    for (int i = 0; kiln_load_report_note(report, i, &note) && !work->quiet; i++)
        cli_note(work, note.warning, "%s: %s", name, note.text);
}

int cli_load(cli_work *work, const char **names, int count, const kiln_load_def *def, kiln_map *map)
{
    kiln_load_def full = *def;
    full.report = &work->loaded;
    const char *faces[FACES];
    int order[FACES];
    kiln_result result;
    if (count == FACES) {
        order_faces(names, order);
        for (int i = 0; i < FACES; i++)
            faces[i] = names[order[i]];
        result = kiln_map_load_faces(work->context, faces, &full, map, &work->error);
    } else {
        result = kiln_map_load(work->context, names[0], &full, map, &work->error);
    }
    if (result != KILN_OK)
        return CLI_FAILED;
    say_report(work, count == FACES ? faces[0] : names[0], &work->loaded);
    return CLI_GO;
}
