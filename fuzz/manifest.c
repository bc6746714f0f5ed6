// Manifests of `kiln batch`: JSON objects one after the other.
#include "fuzz.h"

#include "manifest.h"

#include <stdlib.h>
#include <string.h>

// Checks that a text begins and ends in the reader's bytes.
static void must_be_inside(const char *text, const char *bytes, const char *end)
{
    fuzz_must(text >= bytes && text < end && memchr(text, 0, (size_t)(end - text)) != NULL);
}

static void must_be_value(const manifest_value *value, const char *bytes, const char *end)
{
    bool has_text = value->kind == MANIFEST_TEXT || value->kind == MANIFEST_NUMBER;
    fuzz_must(has_text == (value->text != NULL));
    if (has_text)
        must_be_inside(value->text, bytes, end);
}

// Reads all objects. Each takes at least its two braces, so that there are at most half as many
// objects as bytes. Lines only grow, and a problem lies in one of the lines of the bytes.
void fuzz_manifest(const uint8_t *bytes, size_t size)
{
    static manifest_member members[MANIFEST_MEMBERS];
    char *text = fuzz_text(bytes, size), *end = text + size + 1;
    manifest_reader reader = {.at = text, .end = text + size, .line = 1};
    size_t objects = 0;
    int lines = 1, before = 1, count;
    for (size_t i = 0; i < size; i++)
        lines += bytes[i] == '\n';
    while ((count = manifest_read(&reader, members)) >= 0) {
        fuzz_must(!reader.problem && count <= MANIFEST_MEMBERS && 2 * ++objects <= size);
        fuzz_must(reader.at > text && reader.at <= reader.end);
        fuzz_must(reader.object_line >= before && reader.object_line <= reader.line);
        before = reader.line;
        for (int i = 0; i < count; i++) {
            must_be_inside(members[i].key, text, end);
            must_be_value(&members[i].value, text, end);
            fuzz_must(members[i].item_count >= 0 && members[i].item_count <= MANIFEST_ITEMS);
            for (int k = 0; k < members[i].item_count; k++)
                must_be_value(&members[i].item[k], text, end);
        }
    }
    fuzz_must(reader.line <= lines);
    fuzz_must(!reader.problem || (reader.problem_line >= before && reader.problem_line <= lines));
    free(text);
}
