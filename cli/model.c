// The reflection model by its names, as every command that takes one spells it.
#include "cli.h"

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
