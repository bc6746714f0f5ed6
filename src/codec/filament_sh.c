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

void ki_filament_sh_factors(const kiln_sh *sh, double factors[9][3])
{
    for (int i = 0; i < 27; i++)
        factors[i / 3][i % 3] = sh->c[i / 3][i % 3] * cosine[i / 3] * basis(i / 3);
}

void ki_filament_sh_write(ki_writer *w, const kiln_sh *sh, bool lines)
{
    double factors[9][3];
    ki_filament_sh_factors(sh, factors);
    static const char *const names[9] = {"L00",  "L1-1", "L10", "L11", "L2-2",
                                         "L2-1", "L20",  "L21", "L22"};
    for (int i = 0; i < 9; i++) {
        ki_write_text(w, lines ? "(" : "");
        for (int c = 0; c < 3; c++) {
            ki_write_text(w, "%s", !c ? "" : lines ? ", " : " ");
            ki_write_number(w, factors[i][c]);
        }
        if (lines)
            ki_write_text(w, "); // %s, irradiance, pre-scaled base", names[i]);
        ki_write_text(w, "\n");
    }
}

void ki_filament_sh_store(double factors[9][3], kiln_file_info *info)
{
    for (int i = 0; i < 27; i++)
        info->sh[i / 3][i % 3] =
            ki_info_number(factors[i / 3][i % 3] / (cosine[i / 3] * basis(i / 3)));
    info->sh_bands = 3;
    info->sh_irradiance = false;
}

bool ki_filament_sh_read(const char *text, kiln_file_info *info)
{
    double factors[9][3];
    for (int i = 0; i < 27; i++) {
        text += strspn(text, " \t\r\n(,");
        text = ki_parse_number(text, &factors[i / 3][i % 3]);
        if (!text)
            return false;
        // skips the text after the three numbers of "(0.1, 0.2, 0.3); // L00, irradiance"
        if (i % 3 == 2 && *text == ')')
            text += strcspn(text, "\n");
    }
    ki_filament_sh_store(factors, info);
    return true;
}
