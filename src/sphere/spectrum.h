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

#include "image/image.h"
#include "sphere/fft.h"
#include "sphere/legendre.h"

/// A sun: a texel of the panorama that is left out of the spectrum because of its brightness.
typedef struct ki_sun {
    int row, column;
    float radiance[3];
} ki_sun;

/// Greatest number of texels that may be suns at a time. In one channel no more than 1000 texels
/// can hold a thousandth of the light each.
enum { KI_MAX_SUNS = 4096 };

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
    double *solid; // solid angle of a texel in each row of the panorama, [size]
    // Index in `row_weights` of the first weight of each latitude ring, [rings + 1].
    int *ring_start;
    // Weights of panorama rows for latitude rings, sorted by ring and then by row.
    ki_row_weight *row_weights;
} ki_analysis;

/// Prepares the analysis of panoramas with `size` rows up to `degree`.
kiln_result ki_analysis_create(kiln_context *context, int size, int degree, ki_analysis **analysis,
                               kiln_error *error);
/// Frees an analysis. `analysis` may be NULL.
void ki_analysis_destroy(ki_analysis *analysis);

/// Creates a spectrum of the analysis' degree, with coefficients 0 and an empty list of suns.
kiln_result ki_spectrum_create(kiln_context *context, const ki_analysis *analysis,
                               kiln_spectrum **spectrum, kiln_error *error);

/// The memory that executions of one analysis use, one panorama after the other: buffers, and sums
/// over the rows that have been added so far. The threads are those of the workspace's context.
typedef struct ki_analysis_workspace ki_analysis_workspace;

/// What a workspace is used for, which decides the memory that it has.
typedef enum ki_analysis_use {
    /// One panorama is analysed by ki_analysis_add_rows and ki_analysis_finish. The workspace has
    /// all latitude rings.
    KI_ANALYSIS_ROWS,
    /// Panoramas are analysed by ki_analysis_execute. The workspace has the latitude rings of one
    /// vector for each thread.
    KI_ANALYSIS_WHOLE,
    /// Panoramas are analysed as with KI_ANALYSIS_WHOLE, or row by row from both poles, in buffers
    /// that belong to the caller. ki_analysis_borrow must be called before the first analysis.
    KI_ANALYSIS_BORROWS,
} ki_analysis_use;

/// Creates a workspace for an analysis.
kiln_result ki_analysis_workspace_create(kiln_context *context, const ki_analysis *analysis,
                                         ki_analysis_use use, ki_analysis_workspace **workspace,
                                         kiln_error *error);
/// Gives a workspace that borrows its memory two buffers, which are made large enough: `orders` for
/// the Fourier coefficients of the rings, and `scratch` for the threads. The buffers may be used
/// for other purposes between the executions, and may move if ki_analysis_borrow is called again
/// before the next execution.
kiln_result ki_analysis_borrow(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                               ki_buffer *orders, ki_buffer *scratch, kiln_error *error);
/// Frees a workspace. `workspace` may be NULL.
void ki_analysis_workspace_destroy(ki_analysis_workspace *workspace);
/// Writes the spectrum of a whole panorama of `size` rows. The function allocates nothing. Returns
/// false if the caller of the library stops the work, as do the other functions that return a bool.
bool ki_analysis_execute(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                         const float *rows, kiln_spectrum *spectrum);
/// Adds the next `count` rows of a panorama to its analysis. Rows come from north to south.
kiln_result ki_analysis_add_rows(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                                 const float *rows, int count, kiln_error *error);
/// Writes the spectrum of a panorama after all its rows have been added. Fails if rows are missing.
kiln_result ki_analysis_finish(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                               kiln_spectrum *spectrum, kiln_error *error);

// Analysis of rows that come from both poles to the equator, which needs few rows in memory at a
// time. The depth of a row is its distance in rows from the pole of its hemisphere: row r has the
// depth r from the north pole and size - 1 - r from the south pole. The workspace is made for whole
// panoramas. The calls are, in this order:
//
//   ki_analysis_begin         once
//   ki_analysis_see_rows      once for each row, in any order
//   ki_analysis_add_band      once for each depth, from 0 on
//   ki_analysis_choose_suns   once
//   ki_analysis_next_sun,
//   ki_analysis_add_vector    again for the vectors of rings that contain suns
//   ki_analysis_sum_orders    once

/// Returns the number of rows, up to a depth, that must be in memory on each side to add the rings
/// that are complete at this depth.
int ki_analysis_reach(const ki_analysis *analysis);
void ki_analysis_begin(ki_analysis_workspace *workspace, kiln_spectrum *spectrum);
/// Sums the light of rows, and finds texels among them that may be suns.
void ki_analysis_see_rows(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                          const ki_rows *rows);
/// Adds all vectors of rings whose last row has a depth from `from` to `to` - 1. rows[0] holds the
/// rows from the north pole, rows[1] those from the south pole, as far as the reach says.
bool ki_analysis_add_band(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                          const ki_rows rows[2], int from, int to, kiln_spectrum *spectrum);
/// Decides which texels are suns, after all rows were seen.
void ki_analysis_choose_suns(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                             kiln_spectrum *spectrum);
/// Finds the first vector of rings from *vector on to which a sun contributes: sets *vector, and
/// `first` and `count` of the rows from which its northern and its southern rings are summed.
/// Returns false if there is none.
bool ki_analysis_next_sun(const ki_analysis *analysis, const kiln_spectrum *spectrum, int *vector,
                          ki_rows rows[2]);
/// Adds one vector of rings, without the suns, in place of what was added for it before.
bool ki_analysis_add_vector(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                            const ki_rows rows[2], int vector, kiln_spectrum *spectrum);
/// Writes the coefficients of the spectrum, after all rings were added.
bool ki_analysis_sum_orders(const ki_analysis *analysis, ki_analysis_workspace *workspace,
                            kiln_spectrum *spectrum);

/// Adds the harmonics of the suns (bright texels kept out of the spectrum) up to `degree` to the
/// coefficients `a`, whose rows are laid out for that degree.
kiln_result ki_spectrum_add_suns(const kiln_spectrum *spectrum, int degree, double *a,
                                 kiln_error *error);

/// Sums |a_lm|^2 over m for each channel and each degree from 0 to `degree`: in `calm` without the
/// suns, in `all` with their harmonics. Above the degree of the spectrum only the suns are known.
kiln_result ki_spectrum_power(const kiln_spectrum *spectrum, int degree, double (*calm)[3],
                              double (*all)[3], kiln_error *error);
/// Returns the number of bytes that ki_spectrum_power allocates for `count` suns more than for
/// none.
size_t ki_suns_power_size(size_t count);

#endif
