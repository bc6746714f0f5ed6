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

/// A sun: a texel of the panorama that is left out of the spectrum because of its brightness.
typedef struct ki_sun {
    int row, column;
    float radiance[3];
} ki_sun;

struct kiln_spectrum {
    kiln_context *context;
    int degree, size; // degree of the coefficients, and number of rows of the panorama
    // Spherical-harmonic coefficients a_lm, m >= 0, of the panorama without its suns, in rows as
    // ki_coefficient_row says.
    double *a;
    ki_sun *suns;
    int sun_count;
};

/// The weight with which a row of the panorama contributes to a latitude ring.
typedef struct ki_row_weight {
    int row;
    // true: the ring is the mirror image of a ring beyond a pole, and takes the row's texels half a
    // turn away
    bool half_turn;
    double weight;
} ki_row_weight;

/// Everything about an analysis that depends only on the size of the panorama and the degree. An
/// execution changes nothing in the analysis, so that any number of threads may execute one
/// analysis at the same time, each with a workspace of its own.
typedef struct ki_analysis {
    const ki_kernels *kernels;
    int size, degree;
    ki_legendre legendre;
    ki_rings rings;
    ki_fft fft; // Fourier transform along a latitude ring
    // Integral of exp(-i m phi) over the width of texel column 0 for each order m, [m][real,
    // imaginary].
    double *column;
    int *
        // Index in `row_weights` of the first weight of each latitude ring, [rings + 1].
        ring_start;
    // Weights of panorama rows for latitude rings, sorted by ring and then by row.
    ki_row_weight *row_weights;
} ki_analysis;

/// Prepares the analysis of panoramas with `size` rows up to `degree`. `density[l]` is the expected
/// power at degree l, for which the interpolation between latitude rings is designed, see
/// ki_taps_design.
kiln_result ki_analysis_create(kiln_context *context, int size, int degree, const double *density,
                               ki_analysis **analysis, kiln_error *error);
/// Frees an analysis. `analysis` may be NULL.
void ki_analysis_destroy(ki_analysis *analysis);

/// Creates a spectrum of the analysis' degree, with coefficients 0 and an empty list of suns.
kiln_result ki_spectrum_create(kiln_context *context, const ki_analysis *analysis,
                               kiln_spectrum **spectrum, kiln_error *error);

/// The memory that executions of one analysis use, one panorama after the other: buffers, and sums
/// over the rows that have been added so far. The threads are those of the workspace's context.
typedef struct ki_analysis_workspace ki_analysis_workspace;

/// Creates a workspace for an analysis. With `whole`, panoramas are analysed by
/// ki_analysis_execute, and the workspace has the latitude rings of one vector for each thread.
/// Else the workspace has all latitude rings, and one panorama is analysed by ki_analysis_add_rows
/// and ki_analysis_finish.
kiln_result ki_analysis_workspace_create(kiln_context *context, const ki_analysis *analysis,
                                         bool whole, ki_analysis_workspace **workspace,
                                         kiln_error *error);
/// Frees a workspace. `workspace` may be NULL.
void ki_analysis_workspace_destroy(ki_analysis_workspace *workspace);
/// Writes the spectrum of a whole panorama of `size` rows. The function allocates nothing.
void ki_analysis_execute(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                         const float *rows, kiln_spectrum *spectrum);
/// Adds the next `count` rows of a panorama to its analysis. Rows come from north to south.
kiln_result ki_analysis_add_rows(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                                 const float *rows, int count, kiln_error *error);
/// Writes the spectrum of a panorama after all its rows have been added. Fails if rows are missing.
kiln_result ki_analysis_finish(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                               kiln_spectrum *spectrum, kiln_error *error);

/// Adds the harmonics of the suns (bright texels kept out of the spectrum) up to `degree` to the
/// coefficients `a`, whose rows are laid out for that degree.
kiln_result ki_spectrum_add_suns(const kiln_spectrum *spectrum, int degree, double *a,
                                 kiln_error *error);

/// Sums |a_lm|^2 over m for each channel and each degree from 0 to `degree`: in `calm` without the suns,
/// in `all` with their harmonics. Above the degree of the spectrum only the suns are known.
kiln_result ki_spectrum_power(const kiln_spectrum *spectrum, int degree, double (*calm)[3],
                              double (*all)[3], kiln_error *error);
/// Returns the number of bytes that ki_spectrum_power allocates for `count` suns more than for none.
size_t ki_suns_power_size(size_t count);

#endif
