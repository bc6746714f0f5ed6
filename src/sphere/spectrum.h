// Analysis: a panorama's rows in, its spherical-harmonic coefficients out.
//
// The panorama is transformed as what it is, texels of uniform radiance over their solid angle. Its
// rows are spread onto a few more rings than the degree asks for by the transpose of an
// interpolation, each ring is Fourier-transformed, and each order is summed with the Legendre
// functions. The few texels that hold more than a thousandth of the light each ("suns") are left out
// and kept as a list: whoever filters the spectrum adds them exactly (points.h).
#ifndef KI_SPECTRUM_H
#define KI_SPECTRUM_H

#include "sphere/fft.h"
#include "sphere/legendre.h"

/// A texel of the panorama kept out of the spectrum.
typedef struct ki_sun {
    int row, column;
    float radiance[3];
} ki_sun;

struct kiln_spectrum {
    kiln_context *context;
    int degree, size; // of the panorama: rows
    double *a;        // a_lm by order, see ki_coefficient_row, m >= 0; without the suns
    ki_sun *suns;
    int sun_count;
};

/// What a ring receives from a row.
typedef struct ki_share {
    int row;
    bool turned; // across a pole: from the texels half a turn away
    double weight;
} ki_share;

/// All that depends on sizes only.
typedef struct ki_analysis {
    kiln_context *context;
    const ki_kernels *kernels;
    int size, degree;
    ki_legendre legendre;
    ki_rings rings;
    ki_fft fft;       // of a row
    double *column;   // [degree + 1][2], a column's width and place: the integral of exp(-i m phi)
    int *ring_start;  // [rings + 1], into shares
    ki_share *shares; // by ring, then by row
} ki_analysis;

/// For panoramas of `size` rows; `density` guides the interpolation, see ki_taps_design.
kiln_result ki_analysis_create(kiln_context *context, int size, int degree, const double *density,
                               ki_analysis **analysis, kiln_error *error);
void ki_analysis_destroy(ki_analysis *analysis);

/// An empty spectrum of the analysis' degree.
kiln_result ki_spectrum_create(const ki_analysis *analysis, kiln_spectrum **spectrum,
                               kiln_error *error);

/// A panorama on its way in: `whole`, any number of times, or once in rows from north to south. Rows
/// want all rings in memory, a whole one no more than the rings of a vector a thread.
typedef struct ki_intake ki_intake;
kiln_result ki_intake_create(const ki_analysis *analysis, bool whole, ki_intake **intake,
                             kiln_error *error);
void ki_intake_destroy(ki_intake *intake);
/// Writes the spectrum of a whole panorama, `size` rows.
kiln_result ki_intake_whole(ki_intake *intake, const float *rows, kiln_spectrum *spectrum,
                            kiln_error *error);
/// Takes the next rows.
kiln_result ki_intake_rows(ki_intake *intake, const float *rows, int count, kiln_error *error);
/// Writes the spectrum once all rows have come.
kiln_result ki_intake_finish(ki_intake *intake, kiln_spectrum *spectrum, kiln_error *error);

/// Adds the suns' own coefficients up to `degree` to `a`, rows as for that degree.
kiln_result ki_spectrum_add_suns(const kiln_spectrum *spectrum, int degree, double *a,
                                 kiln_error *error);

#endif
