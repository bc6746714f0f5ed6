// The six files of a cube's faces. In: a folder, a pattern, or six paths. Out: the paths in the
// order +X -X +Y -Y +Z -Z, and the set of names that the paths have, from which the orientation of
// the pictures follows.
//
// All names stand in one table. A file name holds the name of a face in any case of letters, with
// any text before and after. Text after the name begins with a character that is neither a letter
// nor a digit; text before the name ends with a character that is no letter, unless the name stands
// at the end, as in "spacert.png". Six files are a set if their names differ in the face alone.
#include "codec/faces.h"

#include "base/os.h"
#include "codec/formats.h"
#include "codec/report.h"
#include "image/image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FACES = 6, WORD = 16 };

struct ki_face_set {
    const char *word[FACES]; // names of the faces +X -X +Y -Y +Z -Z, in lower case
    // true: the names are sides of the viewer, such as "right", and not axes, such as "px"
    bool named_by_side;
    bool quake; // true: the pictures are oriented as Quake and Source orient a sky
};

static const ki_face_set sets[] = {
    {.word = {"px", "nx", "py", "ny", "pz", "nz"}},
    {.word = {"posx", "negx", "posy", "negy", "posz", "negz"}},
    {.word = {"xpos", "xneg", "ypos", "yneg", "zpos", "zneg"}},
    {.word = {"pos_x", "neg_x", "pos_y", "neg_y", "pos_z", "neg_z"}},
    {.word = {"p_x", "n_x", "p_y", "n_y", "p_z", "n_z"}},
    {.word = {"positivex", "negativex", "positivey", "negativey", "positivez", "negativez"}},
    {.word = {"positive_x", "negative_x", "positive_y", "negative_y", "positive_z", "negative_z"}},
    {.word = {"plusx", "minusx", "plusy", "minusy", "plusz", "minusz"}},
    {.word = {"+x", "-x", "+y", "-y", "+z", "-z"}},
    {.word = {"x+", "x-", "y+", "y-", "z+", "z-"}},
    {.word = {"right", "left", "top", "bottom", "front", "back"}, .named_by_side = true},
    {.word = {"right", "left", "up", "down", "front", "back"}, .named_by_side = true},
    {.word = {"right1", "left2", "top3", "bottom4", "front5", "back6"}, .named_by_side = true},
    {.word = {"rt", "lf", "up", "dn", "ft", "bk"}, .named_by_side = true, .quake = true},
};

enum { SETS = sizeof sets / sizeof *sets };

// ---------------------------------------------------------------------------------- names of files

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static bool is_letter(char c)
{
    return lower(c) >= 'a' && lower(c) <= 'z';
}

static bool same_word(const char *text, const char *word, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (lower(text[i]) != word[i])
            return false;
    return true;
}

static const char *file_name(const char *path)
{
    const char *name = path;
    for (; *path; path++)
        if (ki_os_is_separator(*path))
            name = path + 1;
    return name;
}

// Finds the last place where a file name, without its ending, holds the name of a face. Returns
// NULL if there is no such place.
static const char *find_word(const char *name, const char *word)
{
    const char *dot = strrchr(name, '.'), *end = dot ? dot : name + strlen(name);
    size_t length = strlen(word);
    if ((size_t)(end - name) < length)
        return NULL;
    for (const char *at = end - length;; at--) {
        const char *after = at + length;
        bool ends = after == end || (!is_letter(*after) && !(*after >= '0' && *after <= '9'));
        bool begins = at == name || after == end || !is_letter(at[-1]) || !is_letter(*word);
        if (ends && begins && same_word(at, word, length))
            return at;
        if (at == name)
            return NULL;
    }
}

// Returns whether the text after the name of a face in a file name says a level other than 0, as in
// "px_3.exr".
static bool is_small_level(const char *after)
{
    char *end;
    if (after[0] != '_' || after[1] < '1' || after[1] > '9')
        return false;
    return strtol(after + 1, &end, 10) < KILN_MAX_LEVELS && *end == '.';
}

const ki_face_set *ki_faces_order(const char *const paths[6], int order[6])
{
    for (int s = 0; s < SETS; s++) {
        int found[FACES], count = 0;
        unsigned used = 0;
        for (int face = 0; face < FACES; face++)
            for (int i = 0; i < FACES; i++)
                if (!(used & 1U << i) && find_word(file_name(paths[i]), sets[s].word[face])) {
                    found[face] = i;
                    used |= 1U << i;
                    count++;
                    break;
                }
        if (count == FACES) {
            memcpy(order, found, sizeof found);
            return &sets[s];
        }
    }
    return NULL;
}

// Returns whether a path's file name ends in the name of a face, after a character that is no
// letter.
static bool names_a_face(const char *path)
{
    const char *name = file_name(path);
    for (int s = 0; s < SETS; s++)
        for (int face = 0; face < FACES; face++) {
            const char *word = sets[s].word[face], *at = find_word(name, word);
            const char *after = at ? at + strlen(word) : "";
            if (at && (at == name || !is_letter(at[-1])) && (!*after || *after == '.'))
                return true;
        }
    return false;
}

bool kiln_faces_order(const char *const paths[6], int order[6])
{
    for (int face = 0; face < FACES; face++)
        order[face] = face;
    if (ki_faces_order(paths, order))
        return true;
    for (int i = 0; i < FACES; i++)
        if (names_a_face(paths[i]))
            return false;
    return true;
}

// ----------------------------------------------------------------------------------------- folders

// The names of the pictures in a folder: `text` one after the other, each with its NUL, and
// pointers to them in alphabetical order.
typedef struct listing {
    ki_writer text;
    size_t count;
    const char **name;
} listing;

static void add_name(void *user, const char *name)
{
    listing *l = user;
    if (!ki_file_holds(ki_file_format_of_path(name), KI_HOLDS_PICTURE | KI_READS_PICTURE))
        return;
    ki_write(&l->text, name, strlen(name) + 1);
    l->count++;
}

// Compares names without regard to capital letters.
static int compare_names(const char *a, const char *b)
{
    while (*a && lower(*a) == lower(*b))
        a++, b++;
    return (unsigned char)lower(*a) - (unsigned char)lower(*b);
}

static int by_name(const void *a, const void *b)
{
    const char *first = *(const char *const *)a, *second = *(const char *const *)b;
    int order = compare_names(first, second);
    return order ? order : strcmp(first, second);
}

static int find_by_name(const void *key, const void *element)
{
    return compare_names(key, *(const char *const *)element);
}

static kiln_result list_folder(kiln_context *context, const char *folder, listing *l,
                               kiln_error *error)
{
    *l = (listing){.text = {.context = context}};
    if (!ki_os_list_folder(folder, add_name, l))
        return ki_fail(error, KILN_ERROR_IO, "%s: the folder cannot be opened", folder);
    l->name = ki_alloc(context, l->count + 1, sizeof *l->name);
    if (l->text.failed || !l->name)
        return ki_fail_memory(context, error, folder, l->text.size + l->count * sizeof *l->name);
    const char *at = (const char *)l->text.bytes;
    for (size_t i = 0; i < l->count; i++, at += strlen(at) + 1)
        l->name[i] = at;
    qsort(l->name, l->count, sizeof *l->name, by_name);
    return KILN_OK;
}

// The sets of files in a folder: the complete sets, of which two are kept, and else the set that
// lacks the fewest faces.
typedef struct search {
    kiln_context *context;
    const listing *listing;
    char *text; // room for the name of a file of the folder
    size_t room;
    int complete;
    const ki_face_set *set[2];
    const char *name[2][FACES];
    int most; // number of faces of the set that lacks the fewest faces
    const char *present;
    char lacking[96];
} search;

// Keeps a set of files that lacks faces if it lacks fewer than the sets found before.
static void keep_partial(search *s, const char *const name[FACES], int count, int lacking,
                         const char *at, const char *from, const ki_face_set *set, int face)
{
    if (count <= s->most)
        return;
    s->most = count;
    s->present = name[face];
    snprintf(s->lacking, sizeof s->lacking, "%.*s%s%.32s", (int)ki_min(32, (int)(at - from)), from,
             set->word[lacking], at + strlen(set->word[face]));
}

// Looks in a folder for the other five files of a set, of which the name at hand holds the name of
// `face` at `at`.
static void complete_set(search *s, const ki_face_set *set, int face, const char *from,
                         const char *at)
{
    const char *name[FACES] = {0};
    int count = 0, lacking = 0;
    for (int i = 0; i < FACES; i++) {
        snprintf(s->text, s->room, "%.*s%s%s", (int)(at - from), from, set->word[i],
                 at + strlen(set->word[face]));
        const char *const *found = bsearch(s->text, s->listing->name, s->listing->count,
                                           sizeof *s->listing->name, find_by_name);
        name[i] = found ? *found : NULL;
        count += found != NULL;
        lacking = found ? lacking : i;
    }
    if (count < FACES) {
        keep_partial(s, name, count, lacking, at, from, set, face);
    } else if (face == 0) {
        if (s->complete < 2) {
            s->set[s->complete] = set;
            memcpy(s->name[s->complete], name, sizeof name);
        }
        s->complete++;
    }
}

// Finds the sets of six face names that the folder's file names complete, and keeps the most
// complete of the partial sets for the error message. Returns false if the caller asks to stop.
static bool search_names(search *s)
{
    for (size_t i = 0; i < s->listing->count; i++) {
        if (i % 1024 == 0 && !ki_go_on(s->context))
            return false;
        for (int k = 0; k < SETS; k++)
            for (int face = 0; face < FACES; face++) {
                const char *name = s->listing->name[i], *word = sets[k].word[face];
                const char *at = find_word(name, word);
                if (at && !is_small_level(at + strlen(word)))
                    complete_set(s, &sets[k], face, name, at);
            }
    }
    return true;
}

static kiln_result say_search(const search *s, const char *folder, kiln_error *error)
{
    char endings[KI_ENDINGS_TEXT];
    if (s->complete > 1)
        return ki_fail(error, KILN_ERROR_IO,
                       "%s: holds two sets of faces, as %.64s and %.64s; name one set by a pattern "
                       "with {face}",
                       folder, s->name[0][0], s->name[1][0]);
    if (!s->complete && s->most > 1)
        return ki_fail(error, KILN_ERROR_IO,
                       "%s: holds %d of six faces, among them %.64s, and lacks others such as %s",
                       folder, s->most, s->present, s->lacking);
    if (!s->complete)
        return ki_fail(error, KILN_ERROR_IO,
                       "%s: holds no six faces; name the files px nx py ny pz nz or right left top "
                       "bottom front back, with the same text around each face (%s)",
                       folder, ki_list_endings(KI_HOLDS_PICTURE | KI_READS_PICTURE, NULL, endings));
    return KILN_OK;
}

// Joins the folder and the names of six files, none of them NULL, to paths. The analyzer of
// clang-tidy believes that names can be NULL, because it does not see that say_search fails where
// no set is complete: ki_fail, which never returns KILN_OK, lies in another file.
static kiln_result join_paths(kiln_context *context, const char *folder,
                              const char *const name[FACES], ki_face_files *files,
                              kiln_error *error)
{
    size_t length = strlen(folder), room = 0, used = 0;
    bool slash = length && ki_os_is_separator(folder[length - 1]);
    for (int i = 0; i < FACES; i++)
        room += length + strlen(name[i]) + 2; // NOLINT(clang-analyzer-core.NonNullParamChecker)
    files->owner = ki_alloc(context, room, 1);
    if (!files->owner)
        return ki_fail_memory(context, error, folder, room);
    for (int i = 0; i < FACES; i++) {
        files->path[i] = files->owner + used;
        used += 1 + (size_t)snprintf(files->owner + used, room - used, "%s%s%s", folder,
                                     slash ? "" : "/", name[i]);
    }
    return KILN_OK;
}

kiln_result ki_faces_in_folder(kiln_context *context, const char *folder, ki_face_files *files,
                               kiln_error *error)
{
    listing l;
    search s = {.context = context, .listing = &l};
    *files = (ki_face_files){0};
    kiln_result result = list_folder(context, folder, &l, error);
    for (size_t i = 0; i < l.count && result == KILN_OK; i++)
        s.room = strlen(l.name[i]) > s.room ? strlen(l.name[i]) : s.room;
    s.room += WORD + 1;
    s.text = result == KILN_OK ? ki_alloc(context, s.room, 1) : NULL;
    if (result == KILN_OK && !s.text)
        result = ki_fail_memory(context, error, folder, s.room);
    if (result == KILN_OK) {
        result = search_names(&s) ? say_search(&s, folder, error)
                                  : ki_fail_cancelled(error, "looking for six faces");
    }
    if (result == KILN_OK) {
        files->set = s.set[0];
        result = join_paths(context, folder, s.name[0], files, error);
    }
    ki_free(s.text);
    ki_free(l.name);
    ki_writer_free(&l.text);
    return result;
}

// ---------------------------------------------------------------------------------------- patterns

// The cases of letters that are tried for the name of a face: "posx", "Posx", "PosX" and "POSX".
enum { SMALL, FIRST, FIRST_AND_LAST, ALL, CASES };

static void spell(const char *word, int letters, char text[WORD])
{
    size_t length = strlen(word);
    for (size_t i = 0; i <= length; i++) {
        bool capital = letters == ALL || (letters != SMALL && i == 0) ||
                       (letters == FIRST_AND_LAST && i == length - 1);
        text[i] = capital && is_letter(word[i]) ? (char)(word[i] - 'a' + 'A') : word[i];
    }
}

// A pattern for the paths of six faces, and the room for the paths that are made from the pattern.
typedef struct pattern {
    const char *text, *place;
    size_t length, room;
    char *paths;
} pattern;

// Makes the six paths of a pattern with the names of a set, written with capital letters as
// `letters` says. Returns how many of these files exist.
static int try_pattern(const pattern *p, const ki_face_set *set, int letters)
{
    int count = 0;
    for (int face = 0; face < FACES; face++) {
        char word[WORD], *path = p->paths + p->room * (size_t)face;
        spell(set->word[face], letters, word);
        snprintf(path, p->room, "%.*s%s%s", (int)(p->place - p->text), p->text, word,
                 p->place + p->length);
        count += ki_os_kind_of(path) != KI_OS_NOTHING;
    }
    return count;
}

kiln_result ki_faces_of_pattern(kiln_context *context, const char *text, const char *place,
                                size_t length, ki_face_files *files, kiln_error *error)
{
    pattern p = {text, place, length, strlen(text) + WORD, NULL};
    *files = (ki_face_files){.set = &sets[0]};
    p.paths = files->owner = ki_alloc(context, FACES, p.room);
    if (!p.paths)
        return ki_fail_memory(context, error, "six paths", FACES * p.room);
    int most = 0, letters = SMALL;
    for (int i = 0; i < SETS; i++)
        for (int k = 0; k < CASES; k++) {
            int count = try_pattern(&p, &sets[i], k);
            bool other = most == FACES && count == FACES && k == SMALL;
            if (other)
                return ki_fail(error, KILN_ERROR_IO,
                               "%s: fits two sets of faces, with %s and with %s in place of the "
                               "face; name six files",
                               text, files->set->word[0], sets[i].word[0]);
            if (count > most) {
                files->set = &sets[i];
                letters = k;
                most = count;
            }
        }
    // Makes the paths of the set of which the most files exist. If a file is missing, the reading
    // of the set fails with the name of the file.
    try_pattern(&p, files->set, letters);
    for (size_t face = 0; face < FACES; face++)
        files->path[face] = p.paths + p.room * face;
    return KILN_OK;
}

void ki_face_files_free(ki_face_files *files)
{
    ki_free(files->owner);
    *files = (ki_face_files){0};
}

// ------------------------------------------------------------------------------------- orientation

void ki_faces_note(const ki_face_set *set, kiln_load_report *report)
{
    if (!set || !set->named_by_side)
        return;
    const char *const *w = set->word;
    ki_note(report, KILN_NOTE_ASSUMPTION, false,
            "the faces %s %s %s %s %s %s are taken as +X -X +Y -Y +Z -Z%s", w[0], w[1], w[2], w[3],
            w[4], w[5],
            set->quake ? ", oriented as Quake and Source draw a sky; other programs that use these "
                         "names may mean another order"
                       : "");
}

// Quake and Source have axes x, y and z with z up, which kiln turns to (x, z, -y). Seen from
// inside, the picture ft is to the right of rt, the picture up joins rt at its bottom edge, and dn
// at its top edge. The sides of a cube in OpenGL's orientation are these pictures with left and
// right swapped; the top is the picture with rows and columns swapped, and the bottom the picture
// with rows and columns swapped and counted from the other end.
static size_t quake_source(int face, size_t n, size_t x, size_t y)
{
    if (face == 2)
        return x * n + y;
    if (face == 3)
        return (n - 1 - x) * n + n - 1 - y;
    return y * n + n - 1 - x;
}

bool ki_face_place(kiln_context *context, const ki_face_set *set, const kiln_image *image, int face,
                   float *texels)
{
    size_t n = (size_t)image->width;
    for (size_t y = 0; y < n; y++, texels += 3 * n) {
        if (!ki_go_on(context))
            return false;
        if (!set || !set->quake) {
            memcpy(texels, image->pixels + 3 * y * n, 3 * n * sizeof *texels);
            continue;
        }
        for (size_t x = 0; x < n; x++)
            memcpy(texels + 3 * x, image->pixels + 3 * quake_source(face, n, x, y),
                   3 * sizeof *texels);
    }
    return true;
}
