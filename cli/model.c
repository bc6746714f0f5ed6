// Options that several commands share: words of the reflection model's choices and of what becomes
// of negative texels, and the check of names for generated source code.
#include "cli.h"

#include <ctype.h>
#include <string.h>

const char *cli_d_word(int index)
{
    return kiln_d_names()[index];
}

const char *cli_g_word(int index)
{
    return kiln_g_names()[index];
}

const char *cli_sheen_word(int index)
{
    return kiln_sheen_names()[index];
}

const char *cli_negative_word(int index)
{
    static const char *const words[] = {
        [KILN_NEGATIVE_KEEP] = "keep", [KILN_NEGATIVE_ZERO] = "zero"};
    return index <= KILN_NEGATIVE_ZERO ? words[index] : NULL;
}

// Reserved words of C and GLSL ES 3.00 in lower case. GLSL has too many vectors, matrices and
// samplers to list: names that begin like those are rejected.
static bool is_reserved(const char *name)
{
    static const char *const words[] = {
        "active",   "asm",       "attribute",  "auto",      "bool",      "break",    "buffer",
        "case",     "cast",      "centroid",   "char",      "class",     "common",   "const",
        "continue", "default",   "discard",    "do",        "double",    "else",     "enum",
        "extern",   "external",  "false",      "filter",    "fixed",     "flat",     "float",
        "for",      "goto",      "half",       "highp",     "if",        "in",       "inline",
        "inout",    "input",     "int",        "interface", "invariant", "layout",   "long",
        "lowp",     "main",      "mediump",    "namespace", "noinline",  "out",      "output",
        "packed",   "partition", "patch",      "precision", "public",    "register", "resource",
        "restrict", "return",    "sample",     "short",     "signed",    "sizeof",   "smooth",
        "static",   "struct",    "subroutine", "superp",    "switch",    "template", "this",
        "true",     "typedef",   "uint",       "uniform",   "union",     "unsigned", "using",
        "varying",  "void",      "volatile",   "while"};
    static const char *const beginnings[] = {
        "vec",  "ivec",    "uvec",     "bvec",     "dvec",  "hvec",   "fvec",   "mat",
        "dmat", "sampler", "isampler", "usampler", "image", "iimage", "uimage", "atomic"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(name, words[i]))
            return true;
    for (size_t i = 0; i < sizeof beginnings / sizeof *beginnings; i++)
        if (!strncmp(name, beginnings[i], strlen(beginnings[i])))
            return true;
    return false;
}

int cli_check_source_name(const cli_arguments *a, int option)
{
    enum { LONGEST = 47 };
    const char *name = a->text[option];
    if (!name)
        return CLI_GO;
    bool good = isalpha((unsigned char)*name) && strlen(name) <= LONGEST && !strstr(name, "__") &&
                strncmp(name, "gl_", 3) != 0 && !is_reserved(name);
    for (const char *at = name; good && *at; at++)
        good = isalnum((unsigned char)*at) || *at == '_';
    return good ? CLI_GO
                : cli_wrong(a->command,
                            "--%s is '%s', it must be letters, digits and single underscores, at "
                            "most %d of them, begin with a letter but not with gl_, and not be a "
                            "word of C or GLSL",
                            a->command->options[option].name, name, LONGEST);
}
