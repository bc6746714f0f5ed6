// Loads the input of a command: one file, folder or pattern, or six faces of a cube.
#include "work.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
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

// Copies the colour of a picture into a face; negative and non-finite values become 0.
static void copy_face(const kiln_image *image, float *face)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) {
            size_t channel = image->channels >= 3 ? c : 0;
            float value = image->pixels[i * (size_t)image->channels + channel];
            face[i * 3 + c] = value > 0 && isfinite(value) ? value : 0;
        }
}

static int load_faces(cli_work *work, const char **names, kiln_map *map)
{
    int code = CLI_FAILED, order[FACES];
    kiln_image image = {0};
    order_faces(names, order);
    for (int face = 0; face < FACES; face++) {
        const char *name = names[order[face]];
        if (kiln_image_load(work->context, name, &image, &work->error) != KILN_OK)
            goto done;
        int size = image.width;
        work->error.result = KILN_ERROR_FORMAT;
        if (image.width != image.height) {
            snprintf(work->error.message, sizeof work->error.message,
                     "%s: is %d x %d pixels, the face of a cube must be square", name, image.width,
                     image.height);
            goto done;
        }
        if (face && size != map->size) {
            snprintf(work->error.message, sizeof work->error.message,
                     "%s: is %d x %d pixels, but %s is %d x %d", name, size, size, names[order[0]],
                     map->size, map->size);
            goto done;
        }
        if (!face && kiln_map_create(work->context, KILN_SHAPE_CUBE, size, 1, map, &work->error))
            goto done;
        copy_face(&image, map->level[0] + (size_t)face * (size_t)size * (size_t)size * 3);
        kiln_image_free(&image);
    }
    code = CLI_GO;
done:
    kiln_image_free(&image);
    if (code != CLI_GO)
        kiln_map_free(map);
    return code;
}

int cli_load(cli_work *work, const char **names, int count, kiln_layout layout, kiln_map *map)
{
    if (count == FACES)
        return load_faces(work, names, map);
    kiln_load_def def = {.layout = layout};
    return kiln_map_load(work->context, names[0], &def, map, &work->error) == KILN_OK ? CLI_GO
                                                                                      : CLI_FAILED;
}
