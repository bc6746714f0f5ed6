// The lines of a batch. In: words of the command line, or a manifest, which is a file of JSON
// objects. Out: for each line the inputs, and the options of bake as texts, which are read by the
// rows of bake_options as those of a command line are.
#include "batch.h"
#include "manifest.h"
#include "suggest.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *batch_line_text(const batch_line *line, int option)
{
    for (int i = 0; i < line->setting_count; i++)
        if (line->setting[i].option == option)
            return line->setting[i].text;
    return NULL;
}

static int out_of_memory(void)
{
    return cli_fail("out of memory");
}

static batch_line *add_line(batch_store *store, batch_lines *lines)
{
    if (lines->count == lines->room) {
        size_t room = lines->room ? 2 * lines->room : 64;
        batch_line **larger = realloc(lines->line, room * sizeof(batch_line *));
        if (!larger)
            return NULL;
        lines->line = larger;
        lines->room = room;
    }
    batch_line *line = batch_keep(store, sizeof *line);
    if (line) {
        *line = (batch_line){.command = cli_bake};
        lines->line[lines->count++] = line;
    }
    return line;
}

static bool keep_settings(batch_store *store, const char *const text[CLI_MAX_OPTIONS],
                          batch_line *line)
{
    int count = 0;
    for (int i = 0; i < CLI_MAX_OPTIONS; i++)
        count += text[i] != NULL;
    line->setting = batch_keep(store, (size_t)count * sizeof *line->setting);
    for (int i = 0; line->setting && i < CLI_MAX_OPTIONS; i++)
        if (text[i])
            line->setting[line->setting_count++] = (batch_setting){i, text[i]};
    return line->setting != NULL;
}

int batch_add_words(batch_store *store, const char **words, int count,
                    const char *const also[CLI_MAX_OPTIONS], batch_lines *lines)
{
    batch_line *line = add_line(store, lines);
    if (!line || !keep_settings(store, also, line))
        return out_of_memory();
    line->input = words;
    line->input_count = count;
    return CLI_GO;
}

// ---------------------------------------------------------------------------------------- manifest

static int find_option(const char *name)
{
    for (int i = 0; bake_options[i].name; i++)
        if (!strcmp(bake_options[i].name, name))
            return i;
    return -1;
}

static int no_such_member(const batch_line *line, const char *key)
{
    char text[96];
    cli_suggestion suggestion = {.typed = key};
    cli_suggest(&suggestion, "input");
    for (int i = 0; bake_options[i].name; i++)
        if (bake_options[i].kind != CLI_RENAMED && bake_changes_files(i))
            cli_suggest(&suggestion, bake_options[i].name);
    return cli_wrong(&line->command, "\"%s\": no such option of bake%s", key,
                     cli_suggestion_text(&suggestion, ", ", "", text));
}

// Joins the items of a list by commas, as --roughness and --rotate take numbers.
static const char *join(batch_store *store, const manifest_member *member)
{
    size_t size = 1;
    for (int i = 0; i < member->item_count; i++) {
        if (!member->item[i].text)
            return NULL;
        size += strlen(member->item[i].text) + 1;
    }
    char *text = batch_keep(store, size);
    for (int i = 0, used = 0; text && i < member->item_count; i++)
        used +=
            snprintf(text + used, size - (size_t)used, "%s%s", i ? "," : "", member->item[i].text);
    return member->item_count ? text : NULL;
}

// Sets the text of an option from a member. The value false or null takes an option away that the
// command line gives.
static int take_option(batch_store *store, const batch_line *line, const manifest_member *member,
                       const char *text[CLI_MAX_OPTIONS])
{
    int index = find_option(member->key);
    if (index < 0)
        return no_such_member(line, member->key);
    const cli_option *option = &bake_options[index];
    if (option->kind == CLI_RENAMED)
        return cli_wrong(&line->command, "\"%s\": %s", member->key, option->help);
    if (!bake_changes_files(index))
        return cli_wrong(&line->command,
                         "\"%s\" is for the whole batch, give it on the command line", member->key);
    manifest_kind kind = member->value.kind;
    text[index] = kind == MANIFEST_LIST ? join(store, member) : member->value.text;
    if (kind == MANIFEST_FALSE || kind == MANIFEST_NULL)
        return CLI_GO;
    if (option->kind == CLI_FILE && member->value.text)
        os_use_slashes(member->value.text);
    if (kind == MANIFEST_TRUE)
        text[index] = option->kind == CLI_FLAG ? "" : option->alone;
    else if (option->kind == CLI_FLAG)
        return cli_wrong(&line->command, "\"%s\" must be true or false", member->key);
    if (!text[index])
        return cli_wrong(&line->command, "\"%s\" needs a value", member->key);
    return CLI_GO;
}

static int take_input(batch_store *store, batch_line *line, const manifest_member *member)
{
    bool list = member->value.kind == MANIFEST_LIST;
    const manifest_value *values = list ? member->item : &member->value;
    int count = list ? member->item_count : 1;
    line->input = batch_keep(store, (size_t)count * sizeof *line->input + 1);
    if (!line->input)
        return out_of_memory();
    for (int i = 0; i < count; i++) {
        if (values[i].kind != MANIFEST_TEXT || !values[i].text[0])
            return cli_wrong(&line->command,
                             "\"input\" must be the name of a file, or a list of names");
        os_use_slashes(values[i].text);
        line->input[i] = values[i].text;
    }
    line->input_count = count;
    return CLI_GO;
}

static int take_members(batch_store *store, batch_line *line, const manifest_member *members,
                        int count, const char *const also[CLI_MAX_OPTIONS])
{
    const char *text[CLI_MAX_OPTIONS];
    int code = CLI_GO;
    memcpy(text, also, sizeof text);
    for (int i = 0; i < count && code == CLI_GO; i++) {
        for (int k = 0; k < i; k++)
            if (!strcmp(members[i].key, members[k].key))
                return cli_wrong(&line->command, "\"%s\" is given twice", members[i].key);
        code = !strcmp(members[i].key, "input") ? take_input(store, line, &members[i])
                                                : take_option(store, line, &members[i], text);
    }
    if (code == CLI_GO && !line->input_count)
        return cli_wrong(&line->command, "\"input\" is missing");
    if (code == CLI_GO && !keep_settings(store, text, line))
        return out_of_memory();
    return code;
}

// Reads a whole file into the store.
static char *read_all(batch_store *store, const char *path, size_t *size)
{
    FILE *file = !strcmp(path, "-") ? stdin : os_open_file(path);
    char *bytes = NULL, *kept = NULL;
    size_t room = 1 << 16, filled = 0;
    *size = 0;
    if (!file)
        return NULL;
    for (;;) {
        char *larger = realloc(bytes, room);
        if (!larger)
            break;
        bytes = larger;
        filled += fread(bytes + filled, 1, room - filled, file);
        if (filled < room) {
            kept = ferror(file) ? NULL : batch_keep_text(store, bytes, filled);
            break;
        }
        room *= 2;
    }
    int reason = errno;
    if (file != stdin)
        fclose(file);
    free(bytes);
    errno = reason;
    *size = filled;
    return kept;
}

int batch_add_manifest(batch_store *store, const char *path,
                       const char *const also[CLI_MAX_OPTIONS], batch_lines *lines)
{
    size_t size;
    errno = 0;
    char *bytes = read_all(store, path, &size);
    manifest_member *members = malloc(MANIFEST_MEMBERS * sizeof *members);
    int code = CLI_GO;
    if (!members || (!bytes && !errno))
        code = out_of_memory();
    else if (!bytes)
        code = cli_fail("%s: cannot be read: %s", path, strerror(errno));
    manifest_reader reader = {.at = bytes, .end = bytes ? bytes + size : NULL, .line = 1};
    while (code == CLI_GO) {
        int count = manifest_read(&reader, members);
        if (count < 0)
            break;
        batch_line *line = add_line(store, lines);
        size_t room = strlen(path) + 32;
        char *place = line ? batch_keep(store, room) : NULL;
        if (!place) {
            code = out_of_memory();
            break;
        }
        snprintf(place, room, "%s, line %d", path, reader.object_line);
        line->command.place = place;
        code = take_members(store, line, members, count, also);
    }
    free(members);
    if (code == CLI_GO && reader.problem)
        code = cli_fail("%s, line %d: %s", path, reader.problem_line, reader.problem);
    return code == CLI_WRONG ? CLI_FAILED : code;
}
