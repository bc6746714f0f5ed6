// Analysis: the rows of a panorama go in, its spherical-harmonic coefficients come out.
//
// The panorama is transformed as texels of constant radiance over their solid angle. The transpose
// of an interpolation distributes the rows onto latitude rings, somewhat more rings than the degree
// requires. Each ring is Fourier-transformed, and each order is summed with the Legendre functions.
// The few texels that hold more than a thousandth of the light each ("suns") are left out of the
// transform and kept in a list. Code that filters the spectrum adds the suns exactly (points.h).
// Derivation: docs/theory/spectral.md.
#ifndef KI_SPECTRUM_H
#define KI_SPECTRUM_H

#include "sphere/fft.h"
#include "sphere/legendre.h"

/// A texel of the panorama that is left out of the spectrum because of its brightness.
typedef struct ki_sun {
    int row, column;
    float radiance[3];
} ki_sun;

struct kiln_spectrum {
    kiln_context *context;
    int degree, size; // degree of the coefficients, and number of rows of the panorama
    // Spherical-harmonic coefficients a_lm, m >= 0, see ki_coefficient_row; without the suns.
    double *a;
    ki_sun *suns;
    int sun_count;
};

/// The weight with which a row of the panorama contributes to a latitude ring.
typedef struct ki_share {
    int row;
    bool turned; // true: the ring lies across a pole and takes the texels half a turn away
    double weight;
} ki_share;

/// Everything about an analysis that depends only on the size of the panorama and the degree.
typedef struct ki_analysis {
    kiln_context *context;
    const ki_kernels *kernels;
    int size, degree;
    ki_legendre legendre;
    ki_rings rings;
    ki_fft fft; // transform of one row
    // Integral of exp(-i m phi) over the texel column 0 for each order m, [degree + 1][2].
    double *column;
    int *ring_start;  // index in `shares` of the first share of each latitude ring, [rings + 1]
    ki_share *shares; // shares, sorted by latitude ring and then by row
} ki_analysis;

/// Prepares the analysis of panoramas with `size` rows. `density` is the model of the spectrum for
/// which the interpolation is designed, see ki_taps_design.
kiln_result ki_analysis_create(kiln_context *context, int size, int degree, const double *density,
                               ki_analysis **analysis, kiln_error *error);
void ki_analysis_destroy(ki_analysis *analysis);

/// Creates a spectrum of the analysis' degree, with coefficients 0 and an empty list of suns.
kiln_result ki_spectrum_create(const ki_analysis *analysis, kiln_spectrum **spectrum,
                               kiln_error *error);

/// A panorama that is being analysed: with `whole`, any number of whole panoramas one after the
/// other, else one panorama in rows from north to south. The analysis by rows keeps all latitude
/// rings in memory, that of whole panoramas only the rings of one vector for each thread.
typedef struct ki_intake ki_intake;
kiln_result ki_intake_create(const ki_analysis *analysis, bool whole, ki_intake **intake,
                             kiln_error *error);
void ki_intake_destroy(ki_intake *intake);
/// Writes the spectrum of a whole panorama of `size` rows.
void ki_intake_whole(ki_intake *intake, const float *rows, kiln_spectrum *spectrum);
/// Adds the next `count` rows of the panorama.
kiln_result ki_intake_rows(ki_intake *intake, const float *rows, int count, kiln_error *error);
/// Writes the spectrum once all rows have been passed.
kiln_result ki_intake_finish(ki_intake *intake, kiln_spectrum *spectrum, kiln_error *error);

/// Adds the harmonics of the suns (bright texels kept out of the spectrum) up to `degree` to the
/// coefficients `a`, whose rows are those of that degree.
kiln_result ki_spectrum_add_suns(const kiln_spectrum *spectrum, int degree, double *a,
                                 kiln_error *error);

#endif
