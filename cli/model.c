// What the commands about the reflection model share: its options, and names in source code.
#include "cli.h"

#include <ctype.h>
#include <string.h>

int cli_model(const cli_arguments *a, int option_d, int option_g, kiln_model *model)
{
    int d = (int)model->d, g = (int)model->g;
    int code = cli_choice(a, option_d, "--d", kiln_d_names(), &d);
    if (code == CLI_GO)
        code = cli_choice(a, option_g, "--g", kiln_g_names(), &g);
    *model = (kiln_model){.d = (kiln_d)d, .g = (kiln_g)g};
    return code;
}

// Lower-case words that C or GLSL ES 3.00 keeps for itself. Of its vectors, matrices and samplers GLSL
// has too many to list, so names that begin like them are out.
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

int cli_source_name(const cli_arguments *a, int option)
{
    enum { LONGEST = 47 };
    const char *name = a->value[option];
    if (!name)
        return CLI_GO;
    bool good = isalpha((unsigned char)*name) && strlen(name) <= LONGEST && !strstr(name, "__") &&
                strncmp(name, "gl_", 3) != 0 && !is_reserved(name);
    for (const char *at = name; good && *at; at++)
        good = isalnum((unsigned char)*at) || *at == '_';
    return good ? CLI_GO
                : cli_wrong(a->command,
                            "--%s is '%s', it must be letters, digits and single underscores, "
                            "%d at most, a letter first, no gl_ and no word of C's or GLSL's",
                            cli_option_name(a->command, option), name, LONGEST);
}
