// The layers of an EXR file. In: the parsed headers of its parts. Out: the layers, the layer that
// is the picture, a note about the choice, and a description of all layers.
//
// A renderer stores the picture together with other data: ambient occlusion, normals, depth. The
// picture is the first of these that the file has, and a file with two that are equally good is
// refused, because the order of names says nothing about their content:
//   1. channels R, G and B (or Y, RY and BY) without a layer, in a part named like a picture
//   2. the same in any part
//   3. a layer of R, G and B that is named like a picture, by the table below
//   4. channels without a layer of which some are R, G or B, or the channel Y
//   5. a layer of that kind that is named like a picture
//   6. the only layer of R, G and B; then of some of these; then of Y
// Y is luminance only without X and Z in the same layer, which make it a position or a normal.
#include "codec/exr.h"
#include "codec/file_info.h"
#include "codec/report.h"

#include <stdio.h>
#include <string.h>

/// Names of the layer that holds the picture, in the order of preference; upper and lower case
/// count as equal. A layer counts by the end of its name after a dot, a part without layers by its
/// own name. The comment behind a name says which programs write a layer of this name.
static const char *const picture_names[] = {
    "Composite.Combined", // the result of Blender's compositor
    "Combined",           // written by Blender and Cycles: ViewLayer.Combined
    "rgba",               // written by Arnold, and by Nuke for its main layer
    "rgb",                // written by Nuke
    "beauty",             // written by Arnold, Redshift, Octane and Maya (masterLayer.beauty)
    "RGB_color",          // written by V-Ray
    "RGB color",          // written by V-Ray in 3ds Max
    "Ci",                 // the picture in files of RenderMan
    "C",                  // the picture in files of Mantra and Karma
    "FinalImage",         // written by Unreal Engine
    "Image",              // written by Blender's file output node
    "color",
    "main",
    "default",
};
enum { PICTURE_NAMES = sizeof picture_names / sizeof *picture_names };

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static bool same_word(const char *text, size_t length, const char *word)
{
    if (strlen(word) != length)
        return false;
    for (size_t i = 0; i < length; i++)
        if (lower(text[i]) != lower(word[i]))
            return false;
    return true;
}

// -------------------------------------------------------------------------------------- the list

static ki_exr_role role_of(const char *suffix)
{
    static const struct {
        const char *word;
        ki_exr_role role;
    } words[] = {
        {"R", KI_EXR_RED},        {"Red", KI_EXR_RED},       {"G", KI_EXR_GREEN},
        {"Green", KI_EXR_GREEN},  {"B", KI_EXR_BLUE},        {"Blue", KI_EXR_BLUE},
        {"Y", KI_EXR_LUMINANCE},  {"RY", KI_EXR_RED_CHROMA}, {"BY", KI_EXR_BLUE_CHROMA},
        {"X", KI_EXR_COORDINATE}, {"Z", KI_EXR_COORDINATE},
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (same_word(suffix, strlen(suffix), words[i].word))
            return words[i].role;
    return KI_EXR_OTHER;
}

static ki_exr_kind kind_of(const ki_exr_layer *l)
{
    int colours = 0;
    for (int role = KI_EXR_RED; role <= KI_EXR_BLUE; role++)
        colours += l->channel[role] >= 0;
    bool chroma = l->channel[KI_EXR_RED_CHROMA] >= 0 || l->channel[KI_EXR_BLUE_CHROMA] >= 0;
    if (colours)
        return colours == 3 ? KI_EXR_COLOR : KI_EXR_PARTIAL;
    if (l->channel[KI_EXR_LUMINANCE] < 0)
        return KI_EXR_NO_PICTURE;
    return chroma ? KI_EXR_CHROMA : l->coordinates ? KI_EXR_NO_PICTURE : KI_EXR_GREY;
}

// Returns the layer of a name among those from `first` on, which are of one part, and adds the
// layer if there is none. Channels are sorted by name, so that the layer is nearly always the last.
static ki_exr_layer *find_layer(ki_exr_layers *layers, int first, int part, const char *name,
                                size_t length)
{
    for (int i = layers->count; i-- > first;) {
        ki_exr_layer *l = &layers->layer[i];
        if (l->length == length && !memcmp(l->name, name, length))
            return l;
    }
    ki_exr_layer *l = &layers->layer[layers->count++];
    *l = (ki_exr_layer){.part = part, .name = name, .length = length};
    for (int role = 0; role < KI_EXR_ROLES; role++)
        l->channel[role] = -1;
    return l;
}

static bool is_read(const ki_exr_part *p)
{
    return !p->deep && p->channel_count <= KI_EXR_MAX_CHANNELS;
}

static void list_part(const ki_exr_header *header, int part, ki_exr_layers *layers)
{
    const ki_exr_part *p = &header->parts[part];
    int first = layers->count;
    for (int c = 0; c < p->channel_count; c++) {
        const char *name = p->channels[c].name, *suffix = ki_exr_suffix(name);
        size_t length = suffix > name ? (size_t)(suffix - name) - 1 : 0;
        ki_exr_layer *l = find_layer(layers, first, part, name, length);
        ki_exr_role role = role_of(suffix);
        if (role == KI_EXR_COORDINATE)
            l->coordinates = true;
        else if (role < KI_EXR_ROLES && l->channel[role] < 0)
            l->channel[role] = c;
    }
    for (int i = first; i < layers->count; i++)
        layers->layer[i].kind = kind_of(&layers->layer[i]);
}

kiln_result ki_exr_list_layers(kiln_context *context, const ki_exr_header *header, const char *name,
                               ki_exr_layers *layers, kiln_error *error)
{
    size_t most = 0;
    *layers = (ki_exr_layers){0};
    for (int i = 0; i < header->part_count; i++)
        if (is_read(&header->parts[i]))
            most += (size_t)header->parts[i].channel_count;
    if (!most)
        return KILN_OK;
    layers->layer = ki_alloc_raw(context, most, sizeof *layers->layer);
    if (!layers->layer)
        return ki_fail_memory(context, error, name, most * sizeof *layers->layer);
    for (int i = 0; i < header->part_count; i++) {
        if (!ki_progress(context, "reading", 0))
            return ki_fail_cancelled(error, "reading");
        if (is_read(&header->parts[i]))
            list_part(header, i, layers);
    }
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------- names

// Returns whether a name ends in a word, at its beginning or after a dot.
static bool ends_in(const char *name, size_t length, const char *word)
{
    size_t size = strlen(word);
    return size <= length && same_word(name + length - size, size, word) &&
           (size == length || name[length - size - 1] == '.');
}

// Returns the place in the table of a layer's name, or of its part's name if the layer has none; or
// PICTURE_NAMES.
static int find_picture_name(const ki_exr_header *header, const ki_exr_layer *l)
{
    const ki_exr_part *p = &header->parts[l->part];
    const char *name = l->length ? l->name : p->name;
    size_t length = l->length ? l->length : p->name_length;
    int i = 0;
    while (i < PICTURE_NAMES && !(length && ends_in(name, length, picture_names[i])))
        i++;
    return i;
}

// Returns the name by which a caller may ask for a layer: the layer's name, or that of its part.
static const char *label(const ki_exr_header *header, const ki_exr_layer *l, char *text,
                         size_t room)
{
    const ki_exr_part *p = &header->parts[l->part];
    if (l->length)
        ki_escape_text(text, room, l->name, l->length);
    else if (header->multipart && p->name_length)
        ki_escape_text(text, room, p->name, p->name_length);
    else
        snprintf(text, room, "(no name)");
    return text;
}

// Writes the names of the layers for which `fits` returns true, as "a, b, c and 7 more".
static void list_labels(const ki_exr_header *header, const ki_exr_layers *layers,
                        bool (*fits)(const ki_exr_layer *), char *text, size_t room)
{
    char name[64];
    size_t used = 0;
    int left_out = 0;
    text[0] = 0;
    for (int i = 0; i < layers->count; i++) {
        if (!fits(&layers->layer[i]))
            continue;
        label(header, &layers->layer[i], name, sizeof name);
        if (left_out || used + strlen(name) + 24 > room)
            left_out++;
        else
            used += (size_t)snprintf(text + used, room - used, "%s%s", used ? ", " : "", name);
    }
    if (left_out)
        snprintf(text + used, room - used, " and %d more", left_out);
}

static bool is_picture(const ki_exr_layer *l)
{
    return l->kind != KI_EXR_NO_PICTURE;
}

// ---------------------------------------------------------------------------------------- choosing

// Returns how good a layer is as the picture, by the rules at the top of this file: less is better.
static int rank(const ki_exr_header *header, const ki_exr_layer *l)
{
    enum { STEP = 1000 };
    int place = find_picture_name(header, l);
    bool complete = l->kind == KI_EXR_COLOR || l->kind == KI_EXR_CHROMA;
    if (!l->length)
        return (complete ? 0 : 2 * STEP) + place;
    if (place < PICTURE_NAMES)
        return (complete ? 1 : 3) * STEP + place;
    return (complete ? 4 : l->kind == KI_EXR_PARTIAL ? 5 : 6) * STEP;
}

static kiln_result refuse_all(const ki_exr_header *header, const ki_exr_layers *layers,
                              const char *name, kiln_error *error)
{
    const ki_exr_part *p = &header->parts[0];
    if (!layers->count && p->deep)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: holds deep samples, kiln reads flat pictures only", name);
    if (!layers->count)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: has %d channels, the limit is %d", name,
                       p->channel_count, KI_EXR_MAX_CHANNELS);
    char list[256], one[48];
    size_t used = 0;
    p = &header->parts[layers->layer[0].part];
    for (int c = 0; c < p->channel_count && used + sizeof one + 2 < sizeof list; c++) {
        ki_escape_text(one, sizeof one, p->channels[c].name, strlen(p->channels[c].name));
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", c ? ", " : "", one);
    }
    return ki_fail(
        error, KILN_ERROR_UNSUPPORTED,
        "%s: has no channel R, G, B or Y; its channels are %s; --layer CHANNEL reads one "
        "of them as grey",
        name, list);
}

static kiln_result choose_by_rank(const ki_exr_header *header, const ki_exr_layers *layers,
                                  const char *name, ki_exr_layer *chosen, kiln_error *error)
{
    const ki_exr_layer *best = NULL;
    int least = 0, alike = 0;
    for (int i = 0; i < layers->count; i++) {
        const ki_exr_layer *l = &layers->layer[i];
        int r = is_picture(l) ? rank(header, l) : -1;
        if (r < 0 || (best && r > least))
            continue;
        alike = best && r == least ? alike + 1 : 1;
        best = l;
        least = r;
    }
    if (!best)
        return refuse_all(header, layers, name, error);
    char list[256];
    list_labels(header, layers, is_picture, list, sizeof list);
    if (alike > 1)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: %d of its layers may be the picture; choose one by --layer NAME: %s",
                       name, alike, list);
    *chosen = *best;
    return KILN_OK;
}

static bool is_text(const char *text, size_t length, const char *wanted)
{
    return strlen(wanted) == length && !memcmp(text, wanted, length);
}

// Returns whether `wanted` names a layer: by its whole name, by its part's name or by both with a
// dot between them; or if `loosely`, by its last components.
static bool is_named(const ki_exr_header *header, const ki_exr_layer *l, const char *wanted,
                     bool loosely)
{
    const ki_exr_part *p = &header->parts[l->part];
    size_t length = strlen(wanted), part = p->name_length;
    if (loosely)
        return l->length > length && l->name[l->length - length - 1] == '.' &&
               !memcmp(l->name + l->length - length, wanted, length);
    if (!l->length)
        return part && is_text(p->name, part, wanted);
    return is_text(l->name, l->length, wanted) ||
           (part && length > part && !memcmp(p->name, wanted, part) && wanted[part] == '.' &&
            is_text(l->name, l->length, wanted + part + 1));
}

// Finds the layers that `wanted` names. Returns their number and sets *chosen to the first one.
static int find_named(const ki_exr_header *header, const ki_exr_layers *layers, const char *wanted,
                      bool loosely, ki_exr_layer *chosen)
{
    int count = 0;
    for (int i = 0; i < layers->count; i++) {
        const ki_exr_layer *l = &layers->layer[i];
        if (is_picture(l) && is_named(header, l, wanted, loosely) && !count++)
            *chosen = *l;
    }
    return count;
}

// Finds the channels that `wanted` names, each of which may be read as grey.
static int find_channels(const ki_exr_header *header, const ki_exr_layers *layers,
                         const char *wanted, ki_exr_layer *chosen)
{
    int count = 0, part = -1;
    for (int i = 0; i < layers->count; i++) {
        // several layers may belong to one part, whose channels are searched once
        if (layers->layer[i].part == part)
            continue;
        part = layers->layer[i].part;
        for (int c = 0; c < header->parts[part].channel_count; c++) {
            const char *full = header->parts[part].channels[c].name;
            if (strcmp(full, wanted) != 0 || count++)
                continue;
            *chosen = (ki_exr_layer){.part = part,
                                     .name = full,
                                     .length = strlen(full),
                                     .kind = KI_EXR_GREY,
                                     .single = true};
            chosen->channel[KI_EXR_LUMINANCE] = c;
        }
    }
    return count;
}

static kiln_result choose_by_name(const ki_exr_header *header, const ki_exr_layers *layers,
                                  const char *wanted, const char *name, ki_exr_layer *chosen,
                                  kiln_error *error)
{
    int count = find_named(header, layers, wanted, false, chosen);
    if (!count)
        count = find_named(header, layers, wanted, true, chosen);
    if (!count)
        count = find_channels(header, layers, wanted, chosen);
    if (count == 1)
        return KILN_OK;
    char list[256], asked[64];
    list_labels(header, layers, is_picture, list, sizeof list);
    ki_escape_text(asked, sizeof asked, wanted, strlen(wanted));
    if (count)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: %d of its layers are named %s; name the part too, as PART.LAYER: %s",
                       name, count, asked, list);
    return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                   "%s: has no picture or channel named %s; its layers with a picture are: %s",
                   name, asked, list[0] ? list : "none");
}

kiln_result ki_exr_choose_layer(const ki_exr_header *header, const ki_exr_layers *layers,
                                const char *wanted, const char *name, ki_exr_layer *chosen,
                                kiln_error *error)
{
    if (!layers->count)
        return refuse_all(header, layers, name, error);
    return wanted ? choose_by_name(header, layers, wanted, name, chosen, error)
                  : choose_by_rank(header, layers, name, chosen, error);
}

// ------------------------------------------------------------------------------------- description

// Lists the channels of a layer without the layer's name: "R, G, B, A".
static void list_channels(const ki_exr_part *p, const ki_exr_layer *l, char *text, size_t room)
{
    size_t used = 0;
    int left_out = 0;
    text[0] = 0;
    for (int c = 0; c < p->channel_count; c++) {
        const char *name = p->channels[c].name, *suffix = ki_exr_suffix(name);
        size_t length = suffix > name ? (size_t)(suffix - name) - 1 : 0;
        if (length != l->length || memcmp(name, l->name, length) != 0)
            continue;
        char one[32];
        ki_escape_text(one, sizeof one, suffix, strlen(suffix));
        if (left_out || used + strlen(one) + 16 > room)
            left_out++;
        else
            used += (size_t)snprintf(text + used, room - used, "%s%s", used ? ", " : "", one);
    }
    if (left_out)
        snprintf(text + used, room - used, " and %d more", left_out);
}

// Lists the channels that are the picture, in the order of their roles: "R, G, B".
static void list_picture(const ki_exr_part *p, const ki_exr_layer *l, char *text, size_t room)
{
    bool luminance = l->kind == KI_EXR_CHROMA || l->kind == KI_EXR_GREY;
    int first = luminance ? KI_EXR_LUMINANCE : KI_EXR_RED;
    int last = l->kind == KI_EXR_CHROMA ? KI_EXR_BLUE_CHROMA : luminance ? first : KI_EXR_BLUE;
    size_t used = 0;
    text[0] = 0;
    for (int role = first; role <= last; role++) {
        char one[16];
        if (l->channel[role] < 0)
            continue;
        const char *suffix = ki_exr_suffix(p->channels[l->channel[role]].name);
        ki_escape_text(one, sizeof one, suffix, strlen(suffix));
        used += (size_t)snprintf(text + used, room - used, "%s%s", used ? ", " : "", one);
    }
}

void ki_exr_note_layer(const ki_exr_header *header, const ki_exr_layers *layers,
                       const ki_exr_layer *chosen, kiln_load_report *report)
{
    static const char *const colours[3] = {"red", "green", "blue"};
    const ki_exr_part *p = &header->parts[chosen->part];
    char name[64], channels[64];
    label(header, chosen, name, sizeof name);
    list_picture(p, chosen, channels, sizeof channels);
    if (chosen->single)
        ki_note(report, KILN_NOTE_CHOICE, false, "channel %s alone is the picture, as grey", name);
    else if (layers->count > 1 && (chosen->length || (header->multipart && p->name_length)))
        ki_note(report, KILN_NOTE_CHOICE, false,
                "layer %s (channels %s), one of %d layers, is the picture", name, channels,
                layers->count);
    else if (layers->count > 1)
        ki_note(report, KILN_NOTE_CHOICE, false,
                "channels %s, which have no layer's name, are the picture; the file has %d layers",
                channels, layers->count);
    for (int role = 0; role < 3 && chosen->kind == KI_EXR_PARTIAL; role++)
        if (chosen->channel[role] < 0)
            ki_note(report, KILN_NOTE_ASSUMPTION, true,
                    "the file has no %s channel, which is taken as 0", colours[role]);
}

void ki_exr_describe_layers(const ki_exr_header *header, const ki_exr_layers *layers,
                            const ki_exr_layer *chosen, kiln_file_info *info)
{
    info->part_count = header->part_count;
    info->layer_count = layers->count;
    for (int i = 0; i < ki_min(layers->count, KILN_MAX_LAYERS); i++) {
        const ki_exr_layer *l = &layers->layer[i];
        const ki_exr_part *p = &header->parts[l->part];
        kiln_layer_info *to = &info->layer[i];
        if (p->name_length)
            ki_escape_text(to->part, sizeof to->part, p->name, p->name_length);
        ki_escape_text(to->name, sizeof to->name, l->name, l->length);
        list_channels(p, l, to->channels, sizeof to->channels);
        to->picture = chosen && chosen->part == l->part && chosen->length == l->length &&
                      !memcmp(chosen->name, l->name, l->length);
    }
}
