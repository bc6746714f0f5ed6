#include "codec/filament_sh.h"

#include "codec/decimal.h"
#include "codec/file_info.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// The factor of each basis function in Filament's polynomial is the coefficient of radiance in
// spherical harmonics, times the factor by which the cosine lobe multiplies the band, over pi,
// times the constant of the basis function.
static const double cosine[9] = {1, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};

static double basis(int i)
{
    static const double squares[9] = {1, 3, 3, 3, 15, 15, 1.25, 15, 3.75};
    return sqrt(squares[i] / (4 * KI_PI));
}

void ki_filament_sh_write(ki_writer *w, const kiln_sh *sh, bool lines)
{
    static const char *const names[9] = {"L00",  "L1-1", "L10", "L11", "L2-2",
                                         "L2-1", "L20",  "L21", "L22"};
    for (int i = 0; i < 9; i++) {
        ki_write_text(w, lines ? "(" : "");
        for (int c = 0; c < 3; c++) {
            ki_write_text(w, "%s", !c ? "" : lines ? ", " : " ");
            ki_write_number(w, sh->c[i][c] * cosine[i] * basis(i));
        }
        if (lines)
            ki_write_text(w, "); // %s, irradiance, pre-scaled base", names[i]);
        ki_write_text(w, "\n");
    }
}

bool ki_filament_sh_read(const char *text, kiln_file_info *info)
{
    float sh[9][3];
    for (int i = 0; i < 27; i++) {
        double value;
        text += strspn(text, " \t\r\n(,");
        text = ki_parse_number(text, &value);
        if (!text)
            return false;
        sh[i / 3][i % 3] = ki_info_number(value / (cosine[i / 3] * basis(i / 3)));
        // skips the text after the three numbers of "(0.1, 0.2, 0.3); // L00, irradiance"
        if (i % 3 == 2 && *text == ')')
            text += strcspn(text, "\n");
    }
    memcpy(info->sh, sh, sizeof sh);
    info->sh_bands = 3;
    info->sh_irradiance = false;
    return true;
}
