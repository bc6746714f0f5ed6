// Writes tables as source code. In: a table, or a kiln_table_def alone, and a name. Out: text of C
// or GLSL, of which table_code.c writes the functions that read a table, and this file everything
// else: the names, the comment at the top, include guards and arrays of numbers. docs/tables.md
// describes the files.
#include "table/table_source.h"

#include "codec/components.h"
#include "codec/decimal.h"
#include "table/lobes_code.h"
#include "table/table_code.h"
#include "table/table_text.h"

#include <stdio.h>
#include <string.h>

// ------------------------------------------------------------------------------------------- names

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// Returns true for an identifier that a program may use in C and in GLSL. GLSL reserves names that
// contain two underscores in a row or begin with gl_; C reserves some names that begin with an
// underscore.
static bool is_name(const char *text)
{
    if (!is_letter(text[0]) || strstr(text, "__") || !strncmp(text, "gl_", 3))
        return false;
    for (const char *at = text; *at; at++)
        if (!is_letter(*at) && !is_digit(*at) && *at != '_')
            return false;
    return true;
}

kiln_result ki_source_name_make(const char *path, const char *wanted, ki_source_name *name,
                                kiln_error *error)
{
    enum { ROOM = sizeof name->text - 16 };
    *name = (ki_source_name){0};
    if (wanted) {
        if (!is_name(wanted) || strlen(wanted) >= ROOM)
            return ki_fail(error, KILN_ERROR_ARGUMENT,
                           "the name is \"%.80s\", it must have at most %d letters, digits and "
                           "single underscores, begin with a letter, and not begin with gl_",
                           wanted, ROOM - 1);
        snprintf(name->text, sizeof name->text, "%s", wanted);
        return KILN_OK;
    }
    const char *slash = strrchr(path, '/');
    const char *from = slash ? slash + 1 : path, *end = strrchr(from, '.');
    end = end ? end : from + strlen(from);
    if (end - from > 7 && !strncmp(end - 7, "_lookup", 7))
        end -= 7;
    char *to = name->text;
    if (from == end || !is_letter(*from) || !strncmp(from, "gl_", 3))
        to += snprintf(to, sizeof name->text, "table_");
    for (; from < end && to < name->text + ROOM - 1; from++) {
        bool plain = is_letter(*from) || is_digit(*from);
        if (plain || (to > name->text && to[-1] != '_'))
            *to++ = plain ? *from : '_';
    }
    while (to > name->text && to[-1] == '_')
        to--;
    *to = 0;
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------- heads

static void write_head(const kiln_table_def *def, const char *what, ki_writer *w)
{
    char text[KI_TABLE_TEXT];
    ki_table_describe(def, text);
    ki_write_text(w, "// %s\n//   %s\n// Made by kiln %s.\n", what, text, kiln_version());
}

static void write_guard(const char *name, const char *rest, ki_writer *w)
{
    char guard[sizeof(ki_source_name) + 16];
    snprintf(guard, sizeof guard, "%s%s", name, rest);
    for (char *at = guard; *at; at++)
        if (*at >= 'a' && *at <= 'z')
            *at = (char)(*at - 'a' + 'A');
    ki_write_text(w, "#ifndef %s\n#define %s\n\n", guard, guard);
}

// ------------------------------------------------------------------------------------------ arrays

// Returns the number of values in a table.
static size_t number_count(const kiln_table *table)
{
    return (size_t)table->image.width * (size_t)table->image.height * (size_t)table->image.channels;
}

static kiln_result write_floats(const kiln_table *table, const char *suffix, ki_writer *w,
                                kiln_error *error)
{
    enum { A_LINE = 8 };
    size_t count = number_count(table);
    for (size_t i = 0; i < count; i++) {
        if (i % 65536 == 0 && !ki_go_on(w->context))
            return ki_fail_cancelled(error, "writing");
        ki_write_text(w, i % A_LINE ? " " : "    ");
        ki_write_float(w, table->image.pixels[i]);
        ki_write_text(w, "%s%s%s", suffix, i + 1 < count ? "," : "",
                      i % A_LINE == A_LINE - 1 || i + 1 == count ? "\n" : "");
    }
    return KILN_OK;
}

kiln_result ki_table_write_header(const kiln_table *table, const char *path, const char *name,
                                  ki_writer *w, kiln_error *error)
{
    enum { LIMIT = 1 << 22 };
    const kiln_table_def *def = &table->def;
    size_t count = number_count(table);
    if (count > LIMIT)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: would hold %zu numbers, the limit is %d, choose a smaller size", path,
                       count, LIMIT);
    write_head(def, "A table, row after row, slice after slice:", w);
    write_guard(name, "_H", w);
    ki_write_text(w,
                  "enum {\n    %s_width = %d,\n    %s_height = %d,\n    %s_depth = %d,\n"
                  "    %s_channels = %d\n};\n\nstatic const float %s_texels[%zu] = {\n",
                  name, def->width, name, def->height, name, def->depth, name,
                  table->image.channels, name, count);
    kiln_result result = write_floats(table, "f", w, error);
    ki_write_text(w, "};\n\n#endif\n");
    return result;
}

// Writes a table's numbers as an array of 32-bit words in hexadecimal. A word holds two numbers of
// 16 bits or four numbers of 8 bits. The first number is in the lowest bits.
static kiln_result write_words(const kiln_table *table, kiln_table_format format, size_t words,
                               ki_writer *w, kiln_error *error)
{
    enum { A_LINE = 8 };
    size_t count = number_count(table);
    uint8_t *bytes = ki_alloc(w->context, words, 4);
    if (!bytes)
        return ki_fail_memory(w->context, error, "a table's words", 4 * words);
    ki_components_pack(format, table->image.pixels, count, 1, 1, bytes);
    ki_reader r = ki_reader_make(bytes, 4 * words);
    for (size_t i = 0; i < words; i++)
        ki_write_text(w, "%s0x%08xu%s%s", i % A_LINE ? " " : "    ", ki_read_u32(&r),
                      i + 1 < words ? "," : "",
                      i % A_LINE == A_LINE - 1 || i + 1 == words ? "\n" : "");
    ki_free(bytes);
    return KILN_OK;
}

// Writes the GLSL function that returns number i of a table, which it unpacks from the array of
// 32-bit words.
static void write_unpacking(const char *name, kiln_table_format format, ki_writer *w)
{
    ki_write_text(w, ");\n\nfloat %s_number(int i)\n{\n", name);
    if (format == KILN_TABLE_FORMAT_F32)
        ki_write_text(w, "    return %s_texels[i];\n", name);
    else if (format == KILN_TABLE_FORMAT_U8)
        ki_write_text(
            w, "    return float(%s_texels[i >> 2] >> uint(8 * (i & 3)) & 255u) / 255.0;\n", name);
    else
        ki_write_text(w,
                      "    vec2 two = %s(%s_texels[i >> 1]);\n"
                      "    return (i & 1) == 0 ? two.x : two.y;\n",
                      format == KILN_TABLE_FORMAT_F16 ? "unpackHalf2x16" : "unpackUnorm2x16", name);
    ki_write_text(w, "}\n\n");
}

kiln_result ki_table_write_glsl(const kiln_table *table, kiln_table_format format, const char *path,
                                const char *name, ki_writer *w, kiln_error *error)
{
    enum { LIMIT = 1 << 16 };
    bool floats = format == KILN_TABLE_FORMAT_F32;
    size_t count = number_count(table), size = count * (size_t)ki_component_bytes(format);
    size_t words = (size + 3) / 4;
    if (size > LIMIT)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: would hold %zu bytes, the limit of a constant array is %d; choose a "
                       "smaller size, a format of fewer bits, or a texture",
                       path, size, LIMIT);
    write_head(&table->def, "A table and its lookup, GLSL ES 3.00:", w);
    const char *type = floats ? "float" : "uint";
    ki_write_text(w, "const %s %s_texels[%zu] = %s[%zu](\n", type, name, words, type, words);
    kiln_result result =
        floats ? write_floats(table, "", w, error) : write_words(table, format, words, w, error);
    write_unpacking(name, format, w);
    ki_table_write_code(&table->def, KI_TABLE_GLSL_ARRAY, name, w);
    return result;
}

void ki_table_write_lookup(const kiln_table_def *def, ki_language language, const char *name,
                           ki_writer *w)
{
    static const char *const heads[] = {
        [KI_LANGUAGE_C] = "Looks up a table in an array, C99 and C++:",
        [KI_LANGUAGE_GLSL] = "Looks up a table in a texture, GLSL ES 3.00:",
        [KI_LANGUAGE_WGSL] = "Looks up a table in a texture, WGSL:"};
    bool c = language == KI_LANGUAGE_C;
    write_head(def, heads[language], w);
    if (c) {
        write_guard(name, "_LOOKUP_H", w);
        ki_write_text(w, "#include <math.h>\n\n");
    }
    if (def->kind == KILN_TABLE_LOBES)
        ki_lobes_write_code(def, language, name, w);
    else
        ki_table_write_code(def, c ? KI_TABLE_C : KI_TABLE_GLSL_TEXTURE, name, w);
    if (c)
        ki_write_text(w, "\n#endif\n");
}
