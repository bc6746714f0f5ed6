// What the commands about the reflection model share: its names, and names in source code.
#include "cli.h"

#include <ctype.h>
#include <string.h>

const char *const cli_d_names[] = {"ggx", "beckmann", NULL};
const char *const cli_g_names[] = {"smith", "smith-uncorrelated", "schlick-k2", "schlick-text",
                                   NULL};
const char *const cli_sheen_names[] = {"ashikhmin", "estevez", NULL};

int cli_model(const cli_arguments *a, int option_d, int option_g, kiln_model *model)
{
    int d = (int)model->d, g = (int)model->g;
    int code = cli_choice(a, option_d, "--d", cli_d_names, &d);
    if (code == CLI_GO)
        code = cli_choice(a, option_g, "--g", cli_g_names, &g);
    *model = (kiln_model){.d = (kiln_d)d, .g = (kiln_g)g};
    return code;
}

int cli_source_name(const cli_arguments *a, int option)
{
    enum { LONGEST = 47 };
    const char *name = a->value[option];
    if (!name)
        return CLI_GO;
    bool good = isalpha((unsigned char)*name) && strlen(name) <= LONGEST && !strstr(name, "__") &&
                strncmp(name, "gl_", 3) != 0;
    for (const char *at = name; good && *at; at++)
        good = isalnum((unsigned char)*at) || *at == '_';
    return good ? CLI_GO
                : cli_wrong(a->command,
                            "--%s is '%s', it must be letters, digits and single underscores, "
                            "%d at most, a letter first, no gl_",
                            cli_option_name(a->command, option), name, LONGEST);
}
